//! Parts as they are put together, whoever knows them: before they are drawn, or from what
//! was drawn.

use crate::geometry::Point2;
use crate::ids::NodeId;
use crate::parts::assembly::collisions::together;
use crate::parts::assembly::copy::Copy;
use crate::parts::connector::Connector;
use crate::parts::finding::ConnectorFinding;
use crate::parts::fit::Fit;
use crate::parts::part::{Body, ConnectorBody, Part, Tip};
use crate::structure::Structure;
use crate::tolerance::ARC_SAGITTA_MM;

/// A part of an assembly.
#[derive(Debug, Clone, PartialEq)]
pub struct Built<'a> {
    /// Its name.
    pub name: &'a str,
    /// Its outline and holes as polygons, mm, in the part's own frame.
    pub rings: Vec<Vec<Point2>>,
    /// What it is.
    pub role: Role<'a>,
}

/// What a part is in an assembly.
#[derive(Debug, Clone, PartialEq)]
pub enum Role<'a> {
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
    Plates(Plates<'a>),
}

/// The plates of a node.
#[derive(Debug, Clone, PartialEq)]
pub struct Plates<'a> {
    /// The node.
    pub node: NodeId,
    /// What they look like.
    pub form: Form,
    /// Thickness of one, mm.
    pub thickness: f64,
    /// What stands in them, by its name and the node at the other end of its fin; the first
    /// runs along x.
    pub stands: Vec<(&'a str, NodeId)>,
    /// Where they sit and which of those each holds.
    pub copies: Vec<Copy>,
}

/// The outer shape of a plate, mm.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Form {
    /// A disc around the axis.
    Disc {
        /// Its radius.
        radius: f64,
    },
    /// An eye around the axis with a tail along its fin.
    Eye {
        /// Radius of the eye, half the width of the tail.
        radius: f64,
        /// How far the tail reaches from the axis.
        tail: f64,
    },
}

/// How tightly parts fit, mm.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Snug {
    /// Thickness of fins.
    pub thickness: f64,
    /// What cuts are wider than that.
    pub clearance: f64,
    /// Radius of the rounded corners of cuts, where fins need not have the clearance.
    pub relief: f64,
}

/// Two parts that run into each other.
#[derive(Debug, Clone, PartialEq)]
pub struct Hit {
    /// The parts.
    pub parts: [String; 2],
    /// Nodes that both reach; all of theirs if there is none.
    pub nodes: Vec<NodeId>,
    /// How deep, mm.
    pub depth_mm: f64,
}

impl Built<'_> {
    /// The nodes it reaches.
    pub(crate) fn nodes(&self) -> Vec<NodeId> {
        match &self.role {
            Role::Fins { nodes, .. } => nodes.clone(),
            Role::Plates(plates) => vec![plates.node],
        }
    }
}

/// All pairs of parts that would run into each other.
pub fn collisions(
    structure: &Structure,
    parts: &[Part],
    fit: &Fit,
) -> Vec<ConnectorFinding> {
    let built: Vec<Built> = parts.iter().filter_map(built).collect();
    let Fit { thickness, clearance, relief, .. } = *fit;
    let hits = together(structure, &built, &Snug { thickness, clearance, relief });
    let finding = |Hit { parts: [first, second], nodes, depth_mm }| {
        ConnectorFinding::Collide { first, second, nodes, depth_mm }
    };
    hits.into_iter().map(finding).collect()
}

fn built(part: &Part) -> Option<Built<'_>> {
    let role = match &part.body {
        Body::Fin(_) | Body::Strip(_) => Role::Fins {
            nodes: part.body.nodes(),
            tips: part.body.tips(),
            is_strip: matches!(part.body, Body::Strip(_)),
        },
        Body::Connector(body) => Role::Plates(plates(body)),
        Body::Coupon => return None,
    };
    let rings = part.region.contours().map(|c| c.flattened(ARC_SAGITTA_MM)).collect();
    Some(Built { name: &part.id, rings, role })
}

fn plates(body: &ConnectorBody) -> Plates<'_> {
    let connector = &body.connector;
    let spokes = connector.around().spokes.iter();
    let radius = connector.radius();
    Plates {
        node: body.node(),
        form: match connector {
            Connector::Hub(_) => Form::Disc { radius },
            Connector::Hinge(hinge) => Form::Eye { radius, tail: hinge.tail() },
        },
        thickness: connector.thickness(),
        stands: body.fins.iter().map(String::as_str).zip(spokes.map(|s| s.to)).collect(),
        copies: body.copies.clone(),
    }
}
