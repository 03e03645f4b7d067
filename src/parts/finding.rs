//! What can be wrong with parts, whatever joins them.

use crate::diagnostic::{Located, Place, short};
use crate::ids::NodeId;
use miette::Diagnostic;
use thiserror::Error;

/// A fact found while making parts.
#[derive(Debug, Clone, PartialEq, Error, Diagnostic)]
#[allow(missing_docs, reason = "each variant's message says what its fields are")]
pub enum PartFinding {
    #[error(
        "half of the fins are shorter than {} mm, but a slit and the web beside it take {} mm \
         of a sheet of {} mm; the whole structure is {size}",
        short(*median_mm), short(2.0 * thickness_mm), short(*thickness_mm)
    )]
    #[diagnostic(
        code(parts::model_too_small),
        help(
            "if it was drawn in another unit, say so (an OBJ file is read as mm: try \
             `--units m --scale 1:50`); else enlarge it (`--scale 10:1`) or use a thinner sheet"
        )
    )]
    ModelTooSmall { median_mm: f64, thickness_mm: f64, size: String },

    #[error("the cut line of {part} would cross itself near node {node}")]
    #[diagnostic(
        code(parts::outline_crosses_itself),
        help("slits and edges are too near each other; enlarge the structure")
    )]
    OutlineCrossesItself { part: String, node: NodeId },

    #[error(
        "{} and {} leave node {node} at {angle_deg:.1}°; they would have to stop {setback_mm:.1} \
         mm from the axis",
        fins[0], fins[1]
    )]
    #[diagnostic(
        code(parts::fin_angle_too_small),
        help(
            "at least {}° (`gate.fin_angle_least_deg`) are needed for a web between their \
             windows; turn the mesh's edges apart, or join them by half-laps (`--joint lap`)",
            short(*least_deg)
        )
    )]
    AngleTooSmall {
        fins: [String; 2],
        node: NodeId,
        angle_deg: f64,
        setback_mm: f64,
        least_deg: f64,
    },

    #[error("{} and {} leave node {node} in one direction", fins[0], fins[1])]
    #[diagnostic(
        code(parts::fin_angle_too_small),
        help(
            "are two nodes in one place, or a face folded back? Join the nodes, or turn the \
             mesh's edges apart"
        )
    )]
    UponEachOther { fins: [String; 2], node: NodeId },

    #[error(
        "{part} is {length_mm:.1} mm long and has {web_mm:.2} mm between the connectors of nodes \
         {} and {}",
        nodes[0], nodes[1]
    )]
    #[diagnostic(
        code(parts::connectors_touch),
        help(
            "at least {least_mm} mm are needed (`material.web_least_mm`): enlarge the structure \
             {grow:.2} times, or use a thinner sheet"
        )
    )]
    Touch {
        part: String,
        nodes: [NodeId; 2],
        length_mm: f64,
        web_mm: f64,
        least_mm: f64,
        grow: f64,
    },

    #[error(
        "{count} fins lose more than a quarter of their length at their ends; {part} the most, \
         {lost_mm:.1} of {length_mm:.1} mm"
    )]
    #[diagnostic(
        code(parts::setback_too_long),
        severity(Warning),
        help(
            "light falls through the gaps around the nodes; enlarge the structure {grow:.2} \
             times, or use a sheet of {thinner_mm:.1} mm"
        )
    )]
    SetbackTooLong {
        part: String,
        nodes: [NodeId; 2],
        count: usize,
        length_mm: f64,
        lost_mm: f64,
        grow: f64,
        thinner_mm: f64,
    },

    #[error(
        "the fins of node {node} share {height_mm:.1} mm of its axis; {plates} plates with the \
         webs beside them need {needed_mm:.1} mm"
    )]
    #[diagnostic(
        code(parts::axis_too_short),
        help(
            "make the fins {needed_mm:.1} mm high there, enlarge the structure, or use thinner \
             connectors (`joint.connector_thickness_mm`); discs (`--joint hub`) take least"
        )
    )]
    AxisTooShort { node: NodeId, height_mm: f64, plates: usize, needed_mm: f64 },

    #[error("node {node} should get a hub, but there are {count} nodes, counted from 0")]
    #[diagnostic(
        code(parts::no_such_node),
        help("correct `--hubs`, or `joint.hub_nodes` in the template")
    )]
    NoSuchNode { node: NodeId, count: usize },

    #[error("the discs of node {node} are {diameter_mm:.1} mm wide and fit no sheet")]
    #[diagnostic(
        code(parts::disc_too_large),
        help(
            "turn the fins that leave it at {angle_deg:.1}° apart, use a thinner sheet of \
             material, or add a sheet of more than {diameter_mm:.0} mm to the stock"
        )
    )]
    DiscTooLarge { node: NodeId, diameter_mm: f64, angle_deg: f64 },

    #[error("{count} names found no room on {}", some(parts))]
    #[diagnostic(
        code(parts::unlettered),
        severity(Advice),
        help(
            "write them on by hand (`parts.csv` and `job.json` name all), or reduce \
             `output.lettering_mm`"
        )
    )]
    Unlettered { parts: Vec<String>, count: usize },

    #[error(
        "{first} and {second} would run {depth_mm:.2} mm into each other when assembled"
    )]
    #[diagnostic(
        code(parts::parts_collide),
        help(
            "there is no room for plates of this thickness: enlarge the structure, or use a \
             thinner sheet"
        )
    )]
    Collide { first: String, second: String, nodes: Vec<NodeId>, depth_mm: f64 },
}

/// The first few names and how many more.
fn some(parts: &[String]) -> String {
    const FEW: usize = 5;
    let named = parts.iter().take(FEW).cloned().collect::<Vec<_>>().join(", ");
    match parts.len().checked_sub(FEW) {
        Some(more) if more > 0 => format!("{named} and {more} other parts"),
        _ => named,
    }
}

impl Located for PartFinding {
    fn place(&self) -> Place {
        match self {
            Self::AngleTooSmall { fins, node, .. }
            | Self::UponEachOther { fins, node } => {
                Place { parts: fins.to_vec(), ..Place::nodes([*node]) }
            }
            Self::Touch { part, nodes, .. }
            | Self::SetbackTooLong { part, nodes, .. } => {
                Place { parts: vec![part.clone()], ..Place::fins([*nodes]) }
            }
            Self::AxisTooShort { node, .. } | Self::DiscTooLarge { node, .. } => {
                Place::nodes([*node])
            }
            Self::ModelTooSmall { .. } | Self::NoSuchNode { .. } => Place::default(),
            Self::OutlineCrossesItself { part, node } => {
                Place::part(part.clone()).at(*node)
            }
            Self::Unlettered { parts, .. } => {
                Place { parts: parts.clone(), ..Place::default() }
            }
            Self::Collide { first, second, nodes, .. } => Place {
                parts: vec![first.clone(), second.clone()],
                ..Place::nodes(nodes.clone())
            },
        }
    }
}
