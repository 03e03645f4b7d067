//! The digital assembly: all parts put together as plates of their thickness, in space.

mod assembled;
mod collide;
mod solid;

pub use assembled::{AssembledPart, Collision, Member, NodePlates, SlotFit};
pub use collide::collide;

use crate::parts::finding::PartFinding;
use crate::parts::fit::Fit;
use crate::parts::part::{Body, ConnectorBody, Part};
use crate::parts::plate::Plates;
use crate::structure::Structure;
use crate::tolerance::ARC_SAGITTA_MM;

/// All pairs of parts that would run into each other.
pub fn collisions(structure: &Structure, parts: &[Part], fit: &Fit) -> Vec<PartFinding> {
    let built: Vec<AssembledPart> = parts.iter().filter_map(assembled).collect();
    let Fit { thickness, clearance, relief, .. } = *fit;
    let hits = collide(structure, &built, &SlotFit { thickness, clearance, relief });
    let finding = |Collision { parts: [first, second], nodes, depth_mm }| {
        PartFinding::Collide { first, second, nodes, depth_mm }
    };
    hits.into_iter().map(finding).collect()
}

fn assembled(part: &Part) -> Option<AssembledPart<'_>> {
    let member = match &part.body {
        Body::Fin(_) | Body::Strip(_) => Member::Fins {
            nodes: part.body.nodes(),
            tips: part.body.tips(),
            is_strip: matches!(part.body, Body::Strip(_)),
        },
        Body::Connector(connector) => Member::Plates(plates(connector)),
        Body::Coupon => return None,
    };
    let rings = part.region.contours().map(|c| c.flattened(ARC_SAGITTA_MM)).collect();
    Some(AssembledPart { name: &part.id, rings, member })
}

fn plates(connector: &ConnectorBody) -> NodePlates<'_> {
    let Plates { form, thickness, copies, .. } = &connector.plates;
    let fins = connector.star.fins.iter().map(|fin| fin.to);
    NodePlates {
        node: connector.node(),
        form: *form,
        thickness: *thickness,
        stands: connector.fins.iter().map(String::as_str).zip(fins).collect(),
        copies: copies.clone(),
    }
}
