//! Steps of assembly and what is bought for them.

use serde::{Deserialize, Serialize};

/// A part that goes in.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct StepEntry {
    /// From 1.
    pub step: usize,
    /// The part.
    pub part: String,
    /// Whence it comes.
    #[serde(default)]
    pub from: Whence,
    /// Of a fin or a connector, which of its copies go in: from and to, from 1 upward.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub copies: Option<[usize; 2]>,
    /// Of a strip, how it goes in.
    #[serde(default, flatten)]
    pub strip: Option<StripStepEntry>,
}

/// How a strip goes in.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct StripStepEntry {
    /// From 1: strips of one rank go in before those of the next.
    pub rank: usize,
    /// The strips that stand and that it slides onto.
    pub onto: Vec<OntoEntry>,
    /// How; `null` if it goes onto nothing.
    pub insertion: Option<InsertionEntry>,
}

/// Whence a part comes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "lowercase")]
pub enum Whence {
    /// Along the axes, downwards.
    #[default]
    Above,
    /// Upwards.
    Below,
}

/// A part that stands.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct OntoEntry {
    /// The node where they cross.
    pub node: usize,
    /// The part.
    pub part: String,
}

/// How a strip slides onto others.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct InsertionEntry {
    /// `push` straight down, or `zip` in node after node.
    pub mode: String,
    /// Largest angle of a node axis from the direction of the push.
    pub spread_deg: f64,
    /// How far that takes a slit sideways, mm.
    pub sideways_mm: f64,
    /// How much wider a slit is than what it holds, mm.
    pub clearance_mm: f64,
    /// The tightest bend on the way; `null` if nothing bends.
    pub bend: Option<BendEntry>,
}

/// A bend on the way in.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct BendEntry {
    /// It bends most after this node.
    pub after_node: usize,
    /// Radius, mm.
    pub radius_mm: f64,
    /// Radius over thickness.
    pub over_thickness: f64,
}

/// Something that is bought.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct HardwareEntry {
    /// `rod`, `nut` or `washer`.
    pub kind: String,
    /// Of the thread, mm.
    pub diameter: f64,
    /// Whole mm; `null` of what comes as it is.
    pub length: Option<u64>,
    /// How many.
    pub quantity: usize,
    /// Where a rod goes.
    pub nodes: Vec<usize>,
}
