//! Parts as they are put together, whoever knows them: before they are drawn, or from what
//! was drawn.

use crate::geometry::Point2;
use crate::ids::NodeId;
use crate::parts::part::Tip;
use crate::parts::plate::{PlacedPlate, PlateForm};

/// A part of an assembly.
#[derive(Debug, Clone, PartialEq)]
pub struct AssembledPart<'a> {
    /// Its name.
    pub name: &'a str,
    /// Its outline and holes as polygons, mm, in the part's own frame.
    pub rings: Vec<Vec<Point2>>,
    /// What it is.
    pub member: Member<'a>,
}

/// What a part is in an assembly.
#[derive(Debug, Clone, PartialEq)]
pub enum Member<'a> {
    /// Fins in a row, by their nodes, with the ends of the row.
    Fins {
        /// In the direction of travel.
        nodes: Vec<NodeId>,
        /// Its ends on node axes.
        tips: Vec<Tip>,
        /// Whether it may lap with others of its kind.
        is_strip: bool,
    },
    /// The plates of a connector.
    Plates(NodePlates<'a>),
}

/// The plates of a node.
#[derive(Debug, Clone, PartialEq)]
pub struct NodePlates<'a> {
    /// The node.
    pub node: NodeId,
    /// What they look like.
    pub form: PlateForm,
    /// Thickness of one, mm.
    pub thickness: f64,
    /// What stands in them, by its name and the node at the other end of its fin; the first
    /// runs along x.
    pub stands: Vec<(&'a str, NodeId)>,
    /// Where they sit and which of those each holds.
    pub copies: Vec<PlacedPlate>,
}

/// How tightly fins fit into their slots, mm.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SlotFit {
    /// Thickness of fins.
    pub thickness: f64,
    /// What cuts are wider than that.
    pub clearance: f64,
    /// Radius of the rounded corners of cuts, where fins need not have the clearance.
    pub relief: f64,
}

/// Two parts that run into each other.
#[derive(Debug, Clone, PartialEq)]
pub struct Collision {
    /// The parts.
    pub parts: [String; 2],
    /// Nodes that both reach; all of theirs if there is none.
    pub nodes: Vec<NodeId>,
    /// How deep, mm.
    pub depth_mm: f64,
}

impl AssembledPart<'_> {
    /// The nodes it reaches.
    pub(crate) fn nodes(&self) -> Vec<NodeId> {
        match &self.member {
            Member::Fins { nodes, .. } => nodes.clone(),
            Member::Plates(plates) => vec![plates.node],
        }
    }
}
