//! Sheets and where parts lie on them.

use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// Stock that sheets are taken from.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct StockEntry {
    /// Width, mm.
    pub width: f64,
    /// Height, mm.
    pub height: f64,
    /// Kept free along the edge, mm.
    pub margin: f64,
    /// Kept free between parts, mm.
    pub spacing: f64,
    /// How many there are; `null` if there are enough.
    #[serde(default)]
    pub count: Option<usize>,
}

/// A sheet with where parts lie on it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct SheetEntry {
    /// File stem, such as `sheet-01`.
    pub id: String,
    /// Width, mm.
    pub width: f64,
    /// Height, mm.
    pub height: f64,
    /// Paths of its files by format (`dxf`, `svg`, `png`); `null` if the service takes none.
    pub files: BTreeMap<String, Option<String>>,
    /// Share of it that becomes parts; absent in files for a service.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub utilisation: Option<f64>,
    /// Where parts lie.
    pub placements: Vec<PlacementEntry>,
}

/// A part is turned about its origin, then moved.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct PlacementEntry {
    /// The part.
    pub part: String,
    /// Which of its copies, from 1.
    #[serde(default = "one")]
    pub copy: usize,
    /// To the right, mm.
    pub x: f64,
    /// Up, mm.
    pub y: f64,
    /// Counter-clockwise.
    pub angle_deg: f64,
}

/// The same parts in files for a service or machine.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct VendorEntry {
    /// As in a template's `output.profile`.
    #[serde(default)]
    pub profile: String,
    /// Kerf in the lines, mm.
    pub kerf: f64,
    /// Path of the PDF of all sheets; `null` if the service takes none.
    #[serde(default)]
    pub pdf: Option<String>,
    /// Its sheets; of a service that takes single parts, one for each.
    pub sheets: Vec<SheetEntry>,
}

const fn one() -> usize {
    1
}
