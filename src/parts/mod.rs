//! From a structure in space to flat parts.
//!
//! [`plan`] says, once per job, how fins are grouped and what holds them; [`make`] makes the
//! parts of a plan and the steps in which they go together. A joint is a folder: `lap` for
//! strips that are slit into each other, `hub` and `hinge` for single fins with connectors on
//! the nodes. What all share stands beside them. Kerf is not the business of parts, nor
//! where they lie on a sheet.

mod assembly;
mod cell;
mod chain;
mod clearance;
mod connector;
mod connectors;
mod coupon;
mod end;
mod fin;
mod finding;
mod fit;
mod hinge;
mod hub;
mod lap;
mod mark;
mod outline;
mod part;
mod plan;
mod plate;
mod setback;
mod slit;
mod star;
mod steps;
mod unfold;

pub use assembly::{
    AssembledPart, Collision, Member, NodePlates, SlotFit, collide, collisions,
};
pub use coupon::{CouponMark, Fitted, coupon};
pub use finding::PartFinding;
pub use fit::Fit;
pub use hub::inner_radius;
pub use lap::{Insertion, LapFinding, bends, insertion, tight_insertions};
pub use mark::{Mark, MarkKind, Marking};
pub use part::{Body, ConnectorBody, FinBody, Part, StripBody, Tip};
pub use plan::Plan;
pub use plate::{PlacedPlate, PlateForm, Plates};
pub use slit::{Opening, Slit};
pub use star::{IncidentFin, Star};
pub use steps::{Step, steps};
pub use unfold::{FlatAxis, Fold};

use crate::diagnostic::Finding;
use crate::geometry::Point2;
use crate::ids::NodeId;
use crate::joint::Joint;
use crate::structure::Structure;
use part::crossing_outline;

/// What parts are made for.
pub struct Making<'a> {
    /// What material and joint ask.
    pub fit: &'a Fit,
    /// How parts are marked.
    pub marking: Marking,
    /// Whether an outline fits some sheet of the stock.
    pub fits: &'a dyn Fn(&[Point2]) -> bool,
}

/// The parts of a plan.
#[derive(Debug, Clone, PartialEq)]
pub struct Made {
    /// Strips in the order of assembly, or fins in that of the structure; then connectors in
    /// the order of nodes.
    pub parts: Vec<Part>,
    /// In which order they go together.
    pub steps: Vec<Step>,
    /// Everything found while planning and making.
    pub findings: Vec<Finding>,
}

/// Fins or strips as parts, on their way to connectors.
struct Bodies {
    parts: Vec<Part>,
    /// How many of its texts found no room on each.
    unlettered: Vec<(String, usize)>,
    findings: Vec<Finding>,
}

/// The plan of a structure with a joint; the nodes `hub_nodes` get hubs, whatever else the
/// joint asks for.
pub fn plan(
    structure: &Structure,
    joint: Joint,
    hub_nodes: &[NodeId],
    fit: &Fit,
) -> Plan {
    match joint {
        Joint::Lap => lap::plan(structure, hub_nodes, fit),
        Joint::Hinge => hinge::plan(structure, hub_nodes, fit),
        Joint::Hub => hub::plan(structure, hub_nodes, fit),
    }
}

/// Makes the parts of a plan.
pub fn make(plan: &Plan, making: &Making) -> Made {
    let bodies = match &plan.strips {
        Some(strips) => lap::parts(strips, making),
        None => fin::parts(plan, making),
    };
    let Bodies { mut parts, unlettered, findings: of_bodies } = bodies;
    let crossing = parts.iter().filter_map(crossing_outline).map(Finding::from);
    let crossing: Vec<Finding> = crossing.collect();
    let of_plates = connectors::add_plates(plan, making, &mut parts, unlettered);
    let mut findings = [plan.findings.clone(), of_bodies].concat();
    // Where fins have connectors, their room comes first: it decides how fins are cut.
    if plan.strips.is_some() {
        findings.extend(crossing.into_iter().chain(of_plates));
    } else {
        findings.extend(of_plates.into_iter().chain(crossing));
    }
    Made { steps: steps(&parts), parts, findings }
}

/// Says that a structure is too small for the sheet, rather than that each of its parts is:
/// most often its unit was misread.
pub fn too_small(structure: &Structure, fit: &Fit) -> Option<PartFinding> {
    let mut lengths: Vec<f64> =
        structure.fins().iter().map(|&fin| structure.length(fin)).collect();
    lengths.sort_by(f64::total_cmp);
    let median_mm = (lengths.get(lengths.len() / 2)? * 100.0).round() / 100.0;
    let thickness_mm = fit.thickness;
    let size = structure.size_text();
    (median_mm < 2.0 * thickness_mm).then_some(PartFinding::ModelTooSmall {
        median_mm,
        thickness_mm,
        size,
    })
}
