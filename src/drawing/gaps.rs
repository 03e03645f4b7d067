//! Why open lines that lie on no part are not closed: a gap, or an edge of another part.

use crate::drawing::Curve;
use crate::drawing::chain::ends;
use crate::drawing::ring::Ring;
use crate::geometry::Point2;
use rstar::RTree;
use rstar::primitives::GeomWithData;

/// An open line that a small gap keeps from being closed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Gap {
    /// One end of the gap.
    pub at: Point2,
    /// Its width, mm.
    pub width: f64,
}

/// Gaps wider than this are no slips, mm.
const WIDEST_GAP: f64 = 10.0;

/// Why open lines that lie on no part are not closed: a point of each that begins and ends on
/// an outline, and the gaps of the others.
pub(super) fn explain(open: &[Curve], rings: &[Ring]) -> (Vec<Point2>, Vec<Gap>) {
    let (mut shared, mut gaps) = (Vec::new(), Vec::new());
    let ends_of =
        |(k, curve)| ends(curve).map(|p: Point2| GeomWithData::new([p.x, p.y], k));
    let tree = RTree::bulk_load(open.iter().enumerate().flat_map(ends_of).collect());
    for (k, curve) in open.iter().enumerate() {
        let [from, to] = ends(curve);
        if rings.iter().any(|r| r.is_under(from)) && rings.iter().any(|r| r.is_under(to))
        {
            shared.push(from);
            continue;
        }
        let own = (curve.vertices.len() > 2)
            .then(|| Gap { at: from, width: (to - from).norm() });
        let others = [from, to].into_iter().filter_map(|at| {
            let mut near = tree.nearest_neighbor_iter([at.x, at.y]);
            let [x, y] = *near.find(|end| end.data != k)?.geom();
            Some(Gap { at, width: (Point2::new(x, y) - at).norm() })
        });
        let nearest = others.chain(own).min_by(|a, b| a.width.total_cmp(&b.width));
        gaps.extend(nearest.filter(|gap| gap.width <= WIDEST_GAP));
    }
    (shared, gaps)
}
