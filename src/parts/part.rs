//! A part: one flat shape to be cut, with its marks and its way back into space.

use crate::geometry::{Region, Vector2, predicates};
use crate::ids::NodeId;
use crate::parts::finding::PartFinding;
use crate::parts::mark::Mark;
use crate::parts::plate::Plates;
use crate::parts::slit::Slit;
use crate::parts::star::Star;
use crate::parts::unfold::{FlatAxis, Fold};
use crate::tolerance::ARC_SAGITTA_MM;

/// A flat shape of sheet material, nominal: kerf is not in it yet. Its labelled face
/// looks at the reader.
#[derive(Debug, Clone, PartialEq)]
pub struct Part {
    /// Name, engraved on it.
    pub id: String,
    /// How many are cut.
    pub quantity: usize,
    /// Its shape.
    pub region: Region,
    /// Marks on its labelled face.
    pub marks: Vec<Mark>,
    /// What it is in the structure.
    pub body: Body,
}

impl Part {
    /// Length and height of its shape, mm.
    pub fn extent(&self) -> [f64; 2] {
        let points = || self.region.outline.vertices.iter().map(|vertex| vertex.point);
        let low = points().reduce(|a, b| a.inf(&b)).unwrap_or_default();
        let high = points().fold(low, |a, b| a.sup(&b));
        [high.x - low.x, high.y - low.y]
    }
}

/// What a part is in the structure.
#[derive(Debug, Clone, PartialEq)]
pub enum Body {
    /// A run of fins.
    Strip(StripBody),
    /// A single fin.
    Fin(FinBody),
    /// The plates of a connector.
    Connector(ConnectorBody),
    /// A piece to try a material with, no part of a structure.
    Coupon,
}

impl Body {
    /// The word for it in files.
    pub const fn kind(&self) -> &'static str {
        match self {
            Self::Strip(_) => "strip",
            Self::Fin(_) => "fin",
            Self::Connector(_) => "connector",
            Self::Coupon => "coupon",
        }
    }

    /// The nodes it reaches, in order along it.
    pub fn nodes(&self) -> Vec<NodeId> {
        match self {
            Self::Strip(strip) => strip.axes.iter().map(|axis| axis.node).collect(),
            Self::Fin(fin) => fin.nodes.to_vec(),
            Self::Connector(connector) => vec![connector.node()],
            Self::Coupon => Vec::new(),
        }
    }

    /// Where it ends on node axes: both ends of a fin, those of a strip that no splice made.
    pub fn tips(&self) -> Vec<Tip> {
        match self {
            Self::Fin(fin) => tips(&fin.axes, fin.setbacks, [true; 2]),
            Self::Strip(strip) => {
                // Travel runs to the right: a splice at the left leads to the first node.
                let node = |k: usize| strip.axes[k].node;
                let last = strip.axes.len() - 1;
                let own = |end: usize, k: usize| {
                    strip.splices.iter().all(|splice| splice[1 - end] != node(k))
                };
                tips(&strip.axes, strip.setbacks, [own(0, 0), own(1, last)])
            }
            Self::Connector(_) | Self::Coupon => Vec::new(),
        }
    }
}

fn tips(axes: &[FlatAxis], setbacks: [f64; 2], own: [bool; 2]) -> Vec<Tip> {
    let Some(last) = axes.len().checked_sub(1).filter(|&last| last > 0) else {
        return Vec::new();
    };
    let ends = [(0, 1, 1.0), (last, last - 1, -1.0)];
    let tips = ends.into_iter().zip(setbacks).zip(own).filter(|(_, own)| *own);
    tips.map(|(((place, next, way), setback), _)| {
        let axis = axes[place];
        Tip { axis, inward: axis.right() * way, to: axes[next].node, setback }
    })
    .collect()
}

/// An end of a flat part on a node axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tip {
    /// The axis.
    pub axis: FlatAxis,
    /// Unit vector across the axis, into the part.
    pub inward: Vector2,
    /// The node at the other end of its fin.
    pub to: NodeId,
    /// How far the part stops from the axis, mm.
    pub setback: f64,
}

/// A single fin, flat.
#[derive(Debug, Clone, PartialEq)]
pub struct FinBody {
    /// Its nodes, from left to right.
    pub nodes: [NodeId; 2],
    /// Where their axes lie.
    pub axes: Vec<FlatAxis>,
    /// How far it stops from each axis, mm.
    pub setbacks: [f64; 2],
    /// Fins of one shape share this name.
    pub shape: String,
}

/// The plates of a node; their origin is the node axis. A disc's first fin runs along x, an
/// eye's only one.
#[derive(Debug, Clone, PartialEq)]
pub struct ConnectorBody {
    /// The node and the fins that it holds.
    pub star: Star,
    /// Names of the parts with these fins, in their order.
    pub fins: Vec<String>,
    /// Its plates.
    pub plates: Plates,
    /// How far it reaches along a fin, from the axis, mm.
    pub reach: f64,
    /// Diameter of the rod through its plates, mm.
    pub rod: f64,
    /// How it goes together with its fins, in sentences.
    pub words: String,
}

impl ConnectorBody {
    /// The node.
    pub const fn node(&self) -> NodeId {
        self.star.node
    }
}

/// A run of fins, flat.
#[derive(Debug, Clone, PartialEq)]
pub struct StripBody {
    /// Index of the strip in the structure.
    pub strip: usize,
    /// Where the node axes lie.
    pub axes: Vec<FlatAxis>,
    /// One per node between two fins of the strip.
    pub folds: Vec<Fold>,
    /// Slits with the part that each receives.
    pub slits: Vec<(Slit, String)>,
    /// Fins that are cut in two here, by their nodes in the direction of travel.
    pub splices: Vec<[NodeId; 2]>,
    /// Whether first and last axis are one in space.
    pub closed: bool,
    /// Place in the order of assembly, from 0; pieces of one strip share it.
    pub rank: usize,
    /// How far it stops from its first and last axis, mm; 0 where it reaches the axis or
    /// was spliced.
    pub setbacks: [f64; 2],
}

/// Says that a cut line crosses itself.
pub(crate) fn crossing_outline(part: &Part) -> Option<PartFinding> {
    let simple = predicates::is_simple(&part.region.outline.flattened(ARC_SAGITTA_MM));
    let node = *part.body.nodes().first()?;
    (!simple).then(|| PartFinding::OutlineCrossesItself { part: part.id.clone(), node })
}
