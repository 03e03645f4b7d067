//! What connectors leave of fins, and the angles at which fins leave a node.

use crate::ids::NodeId;
use crate::parts::finding::PartFinding;
use crate::parts::fit::Fit;
use crate::parts::star::Star;
use crate::tolerance::{SAME_LENGTH_MM, UPON_EACH_OTHER};

/// Most of a fin that setbacks may take before it is said.
const SETBACK_SHARE: f64 = 0.25;

/// Fins too near each other for the web between their windows.
pub(crate) fn sharp_angles(
    star: &Star,
    setback_mm: f64,
    name: &dyn Fn(usize) -> String,
    fit: &Fit,
) -> Vec<PartFinding> {
    let least = fit.fin_angle_least;
    let sectors = star.sectors().into_iter().enumerate();
    sectors
        .filter(|&(_, angle)| angle < least)
        .map(|(place, angle)| {
            let next = (place + 1) % star.fins.len();
            let fins = [place, next].map(|k| name(star.fins[k].index));
            if angle < UPON_EACH_OTHER {
                return PartFinding::UponEachOther { fins, node: star.node };
            }
            PartFinding::AngleTooSmall {
                fins,
                node: star.node,
                angle_deg: angle.to_degrees(),
                setback_mm,
                least_deg: least.to_degrees(),
            }
        })
        .collect()
}

/// What connectors leave of one fin, mm.
pub(crate) struct FinClearance {
    pub part: String,
    pub nodes: [NodeId; 2],
    /// Least length across the axes of its nodes.
    pub length: f64,
    /// What connectors take with their plates.
    pub taken: f64,
    /// What the fin is cut back by.
    pub lost: f64,
}

impl FinClearance {
    /// Connectors that leave no web between them.
    pub(crate) fn touching(&self, fit: &Fit) -> Option<PartFinding> {
        let least_mm = fit.web_least;
        let web_mm = self.length - self.taken;
        (web_mm < least_mm - SAME_LENGTH_MM).then(|| PartFinding::Touch {
            part: self.part.clone(),
            nodes: self.nodes,
            length_mm: self.length,
            web_mm,
            least_mm,
            grow: (self.taken + least_mm) / self.length,
        })
    }

    fn lost_share(&self) -> f64 {
        self.lost / self.length
    }
}

/// Fins that lose more than a quarter, told by the worst.
pub(crate) fn long_setbacks(fins: &[FinClearance], fit: &Fit) -> Option<PartFinding> {
    let short = || fins.iter().filter(|fin| fin.lost_share() > SETBACK_SHARE);
    let worst = short().max_by(|a, b| a.lost_share().total_cmp(&b.lost_share()))?;
    let grow = worst.lost_share() / SETBACK_SHARE;
    Some(PartFinding::SetbackTooLong {
        part: worst.part.clone(),
        nodes: worst.nodes,
        count: short().count(),
        length_mm: worst.length,
        lost_mm: worst.lost,
        grow,
        thinner_mm: fit.thickness / grow,
    })
}
