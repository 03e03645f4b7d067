//! Whether the discs of a hub have room: on the axis, on the sheet, between other cuts.

use crate::geometry::Point2;
use crate::ids::NodeId;
use crate::parts::Making;
use crate::parts::chain::circle;
use crate::parts::clearance::{FinClearance, sharp_angles};
use crate::parts::finding::PartFinding;
use crate::parts::fit::Fit;
use crate::parts::hub::dimensions::Hub;
use crate::parts::star::{IncidentFin, shortest};
use crate::structure::Structure;
use crate::tolerance::ARC_SAGITTA_MM;

/// Why a hub has no room among strips, if so; `taken` is what cuts take at the other end of
/// the fin to a node, mm.
pub(crate) fn obstacle(
    structure: &Structure,
    hub: &Hub,
    taken: &dyn Fn(NodeId) -> f64,
    fit: &Fit,
) -> Option<PartFinding> {
    let nodes = |fin: usize| structure.fins()[fin].ends();
    let name = |fin: usize| format!("fin {}", structure.fins()[fin]);
    let touching = |fin: &IncidentFin| {
        let fin = FinClearance {
            part: name(fin.index),
            nodes: nodes(fin.index),
            length: shortest(structure, nodes(fin.index)),
            taken: hub.notch[1] + taken(fin.to),
            lost: hub.setback,
        };
        fin.touching(fit)
    };
    sharp_angles(&hub.star, hub.setback, &name, fit)
        .into_iter()
        .next()
        .or_else(|| short_axis(hub, fit))
        .or_else(|| hub.star.fins.iter().find_map(touching))
}

/// An axis on which two discs have no room.
pub(super) fn short_axis(hub: &Hub, fit: &Fit) -> Option<PartFinding> {
    let [low, high] = hub.between();
    let web_mm = high - low - 2.0 * fit.relief;
    let least_mm = fit.web;
    let [below, above] = hub.star.reach;
    let height_mm = below + above;
    let needed_mm = height_mm + (least_mm - web_mm);
    (web_mm < least_mm).then_some(PartFinding::AxisTooShort {
        node: hub.star.node,
        height_mm,
        plates: 2,
        needed_mm,
    })
}

/// Discs that fit no sheet.
pub(super) fn large_discs(hub: &Hub, making: &Making) -> Option<PartFinding> {
    let outline = circle(Point2::origin(), hub.radius).flattened(ARC_SAGITTA_MM);
    let angle = hub.star.sectors().into_iter().fold(f64::INFINITY, f64::min);
    (!(making.fits)(&outline)).then_some(PartFinding::DiscTooLarge {
        node: hub.star.node,
        diameter_mm: 2.0 * hub.radius,
        angle_deg: angle.to_degrees(),
    })
}
