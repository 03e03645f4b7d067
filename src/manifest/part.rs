//! Parts: their shape, and how they go back into space.

use crate::geometry::Point2;
use crate::manifest::points;
use crate::manifest::run::RunEntry;
use crate::parts::PlateForm;
use serde::{Deserialize, Serialize};

/// A part. What it is in the structure stands under `strip`, `fin` or `connector`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct PartEntry {
    /// Its name, as engraved.
    pub id: String,
    /// `strip`, `fin`, `connector` or `coupon`.
    #[serde(default)]
    pub kind: String,
    /// How many are cut.
    #[serde(default)]
    pub quantity: usize,
    /// What is engraved on it.
    #[serde(default)]
    pub label: String,
    /// Its edge without kerf, counter-clockwise, seen on the engraved face.
    #[serde(with = "points")]
    #[cfg_attr(test, schemars(with = "Vec<[f64; 2]>"))]
    pub outline: Vec<Point2>,
    /// Its holes.
    #[serde(default, with = "points")]
    #[cfg_attr(test, schemars(with = "Vec<Vec<[f64; 2]>>"))]
    pub holes: Vec<Vec<Point2>>,
    /// Of the outline less the holes, mm².
    #[serde(default)]
    pub area: f64,
    /// Of outline and holes, mm.
    #[serde(default)]
    pub cut_length: f64,
    /// Fins of one shape share this name.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub shape: Option<String>,
    /// A run of fins; `null` for a piece of a coupon.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub strip: Option<Option<RunEntry>>,
    /// A single fin.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub fin: Option<RunEntry>,
    /// The plates of a node.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub connector: Option<ConnectorEntry>,
}

impl PartEntry {
    /// Its fins; a single fin is a run of one.
    pub fn run(&self) -> Option<&RunEntry> {
        self.strip.as_ref().and_then(Option::as_ref).or(self.fin.as_ref())
    }
}

/// Whether fins stand in discs or turn about a rod.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "lowercase")]
pub enum ConnectorKind {
    /// Slotted discs.
    Hub,
    /// Plates with an eye, glued into the ends of fins.
    Hinge,
}

impl From<PlateForm> for ConnectorKind {
    fn from(form: PlateForm) -> Self {
        match form {
            PlateForm::Disc { .. } => Self::Hub,
            PlateForm::Eye { .. } => Self::Hinge,
        }
    }
}

/// The plates of a node.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct ConnectorEntry {
    /// Discs or eyes.
    pub kind: ConnectorKind,
    /// The node.
    pub node: usize,
    /// What it holds, and the angle about the axis, degrees.
    #[serde(default)]
    pub fins: Vec<(String, f64)>,
    /// Where that stands.
    #[serde(default)]
    pub slots: Vec<SlotEntry>,
    /// How far it reaches from the axis, mm.
    #[serde(default)]
    pub radius: f64,
    /// Diameter of the hole for the rod, mm.
    #[serde(default)]
    pub hole: f64,
    /// Of a plate, mm.
    #[serde(default)]
    pub thickness: f64,
    /// The plates along the axis.
    #[serde(default)]
    pub copies: Vec<CopyEntry>,
}

/// Where a fin stands in its connector.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct SlotEntry {
    /// The part.
    pub fin: String,
    /// The node at the other end of the fin there.
    #[serde(default)]
    pub to: Option<usize>,
    /// About the axis.
    pub angle_deg: f64,
    /// Across the fin, mm.
    #[serde(default)]
    pub width: f64,
    /// Along the fin, mm.
    #[serde(default)]
    pub length: f64,
}

/// One plate of a connector, placed across its axis.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct CopyEntry {
    /// Of its middle plane above the node, mm.
    pub height: f64,
    /// About the axis.
    pub angle_deg: f64,
    /// The parts it holds.
    pub fins: Vec<String>,
}
