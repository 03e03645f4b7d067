//! Rigid strips, half-lapped where they cross; ends that cannot lap stand in discs
//! (`docs/strips.md`).
//!
//! Every strip is unfolded, slits are cut where strips cross, rounded and flared, what is too
//! long for the stock is spliced, and each part gets written on it what the maker needs.

mod bend;
mod finding;
mod held;
mod insertion;
mod join;
mod mark;
mod meeting;
mod passage;
mod placement;
mod rank;
mod seam;
mod splice;
mod strength;
mod strip;
pub(super) mod strips;

pub use bend::bends;
pub use finding::LapFinding;
pub use insertion::{Insertion, insertion, tight_insertions};

use crate::diagnostic::Finding;
use crate::ids::NodeId;
use crate::parts::connector::Connector;
use crate::parts::fit::Fit;
use crate::parts::part::{Body, Part};
use crate::parts::plan::Plan;
use crate::parts::{Bodies, Making};
use crate::structure::Structure;
use placement::{Joined, placed};
use splice::Whole;
use std::collections::BTreeMap;
use strength::Slitted;
use strip::Pieces;
use strips::Strips;

/// Half-lapped strips; the nodes `asked` get hubs, and so do those where ends of strips
/// cannot lap.
pub(super) fn plan(structure: &Structure, asked: &[NodeId], fit: &Fit) -> Plan {
    let Joined { structure, strips, findings } = placed(structure, asked, fit);
    let boxed = |(&node, hub): (&NodeId, &_)| {
        let hub: Box<dyn Connector> = Box::new(Clone::clone(hub));
        (node, hub)
    };
    let connectors = strips.hubs.iter().map(boxed).collect();
    let findings = findings.into_iter().map(Finding::from).collect();
    Plan { structure, strips: Some(strips), connectors, findings }
}

/// The strips as parts, in the order of assembly.
pub(super) fn parts(strips: &Strips, making: &Making) -> Bodies {
    let Strips { flat, joinery, hubs } = strips;
    let mut findings: Vec<Finding> = Vec::new();
    let mut parts = Vec::new();
    for (rank, &strip) in joinery.order.iter().enumerate() {
        let name = joinery.names[strip].as_str();
        let (flat, joints) = (&flat[strip], &joinery.joints[strip]);
        let slitted =
            Slitted { name, strip: flat, slits: &joints.slits, fit: making.fit };
        findings.extend(strength::weaknesses(&slitted).into_iter().map(Finding::from));
        let whole = Whole { name, strip: flat, joints, fit: making.fit, hubs };
        let pieces = splice::pieces(&whole, making.fits).unwrap_or_else(|finding| {
            findings.push(finding.into());
            vec![whole.uncut()]
        });
        parts.extend(Pieces { strip, rank, flat, making, name }.parts(pieces));
    }
    name_partners(&mut parts, &joinery.names);
    Bodies { parts, unlettered: Vec::new(), findings }
}

/// Tells each slit which part comes into it: of a spliced strip, the piece at that node.
fn name_partners(parts: &mut [Part], names: &[String]) {
    let mut at: BTreeMap<(usize, NodeId), String> = BTreeMap::new();
    for part in parts.iter() {
        let Body::Strip(strip) = &part.body else { continue };
        let slits = strip.slits.iter();
        at.extend(slits.map(|(s, _)| ((strip.strip, s.node), part.id.clone())));
    }
    for part in parts {
        let Body::Strip(strip) = &mut part.body else { continue };
        for (slit, partner) in &mut strip.slits {
            let piece = at.get(&(slit.partner, slit.node));
            *partner = piece.unwrap_or(&names[slit.partner]).clone();
        }
    }
}
