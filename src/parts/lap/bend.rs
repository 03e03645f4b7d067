//! How tightly a strip bends at a node: its fold spread over the fins beside it, less the
//! slit.

use crate::ids::NodeId;
use crate::parts::part::StripBody;
use crate::parts::slit::Slit;
use crate::parts::unfold::FlatAxis;

/// Radius of the bend, mm, from the lengths of the fins beside the node, the width of its
/// slit and its fold; infinite where nothing folds.
pub(crate) fn radius(lengths: &[f64], slit: f64, fold: f64) -> f64 {
    let mean = lengths.iter().sum::<f64>() / lengths.len().max(1) as f64;
    (mean - slit).max(0.0) / fold.abs()
}

/// The node and the radius of each bend of a strip's part, mm.
pub fn bends(strip: &StripBody) -> Vec<(NodeId, f64)> {
    let length = |pair: &[FlatAxis]| (pair[1].foot - pair[0].foot).norm();
    let bend = |place: usize| {
        let node = strip.axes[place].node;
        let fold = strip.folds.iter().find(|fold| fold.node == node)?;
        let beside = place.saturating_sub(1)..(place + 2).min(strip.axes.len());
        let lengths: Vec<f64> = strip.axes[beside].windows(2).map(length).collect();
        let slit = strip.slits.iter().find(|(slit, _)| slit.node == node);
        let slit = slit.map_or(0.0, |(slit, _)| Slit::width(slit));
        (!lengths.is_empty()).then(|| (node, radius(&lengths, slit, fold.angle)))
    };
    (0..strip.axes.len()).filter_map(bend).collect()
}
