//! What the written files prove.

use crate::tolerance::{PROOF_LIMIT_DEG, PROOF_LIMIT_MM};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// Limits, and once the files are read back the worst figures and the files' digests.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(default)]
pub struct ProofEntry {
    /// How far they may be off.
    pub limits: Limits,
    /// The worst figures of each format.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub worst: Option<Vec<Worst>>,
    /// SHA-256 of the files that were read, hexadecimal, by path.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub files: Option<BTreeMap<String, String>>,
}

/// How far what is measured may be off; it comes from the template.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(default)]
pub struct Limits {
    /// Axes, corners of fins, slits, kerf, mm.
    pub axes_and_slits_mm: f64,
    /// Folds, degrees.
    pub folds_deg: f64,
}

impl Default for Limits {
    fn default() -> Self {
        Self { axes_and_slits_mm: PROOF_LIMIT_MM, folds_deg: PROOF_LIMIT_DEG }
    }
}

/// The worst of everything measured in the files of one format.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(default)]
pub struct Worst {
    /// `dxf`, `svg` or `pdf`; `order ` before it for files that are made for a service.
    pub format: String,
    /// Parts found.
    pub parts: usize,
    /// Largest distance between the axes of two parts at one node, folded and placed, mm.
    pub node_gap_mm: f64,
    /// Largest distance of such an axis from the structure's, mm.
    pub node_off_mm: f64,
    /// Largest difference between a fin's corners, flat, and those in the structure, mm.
    pub fin_mm: f64,
    /// Largest distance of a slit from where the structure needs it, mm.
    pub slit_off_mm: f64,
    /// Least room in a slit beside what comes in, mm; wanted is the clearance.
    pub slit_play_least_mm: f64,
    /// Most room in a slit beside what comes in, mm.
    pub slit_play_most_mm: f64,
    /// Largest difference between the angle of a slot of a connector and the fin's, degrees.
    pub slot_deg: f64,
    /// Largest distance between a drawn outline and the part's shape, mm.
    pub outline_mm: f64,
    /// Largest distance of a part from where it is listed, mm.
    pub moved_mm: f64,
}
