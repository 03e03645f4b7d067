//! `job.json`: everything an outside program needs to predict each cut line and to fold
//! each part back onto the structure. One set of types is written and read; their JSON
//! schema is docs/job.schema.json.
//!
//! Lengths are millimetres to 1e-6, angles degrees to 1e-7, times seconds, masses
//! kilograms. Keys stand in alphabetical order.

mod part;
mod place;
mod points;
mod proved;
mod run;
mod step;

pub use part::{ConnectorEntry, ConnectorKind, CopyEntry, PartEntry, SlotEntry};
pub use place::{PlacementEntry, SheetEntry, StockEntry, VendorEntry};
pub use proved::{Limits, ProofEntry, Worst};
pub use run::{AxisEntry, FoldEntry, OpenEdge, RunEntry, SlitEntry, SpliceEntry};
pub use step::{
    BendEntry, HardwareEntry, InsertionEntry, OntoEntry, StepEntry, StripStepEntry,
    Whence,
};

use crate::diagnostic::Finding;
use crate::joint::Joint;
use crate::rigidity::VerdictEntry;
use serde::{Deserialize, Serialize};

/// What stands in `format`.
pub const FORMAT: &str = "finwright-job";

/// What stands in `version`.
pub const VERSION: u64 = 1;

/// The whole of `job.json`. Fields that a proof can do without may be absent when it is
/// read.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct Manifest {
    /// Always `finwright-job`.
    pub format: String,
    /// Always 1.
    pub version: u64,
    /// `structure`, or `coupon` for pieces that tell kerf and clearance.
    #[serde(default)]
    pub kind: String,
    /// Name and version of the program.
    #[serde(default)]
    pub generator: String,
    /// The structure's file.
    #[serde(default)]
    pub input: SourceEntry,
    /// The template.
    #[serde(default)]
    pub template: SourceEntry,
    /// Seed of the nesting.
    #[serde(default)]
    pub seed: u64,
    /// Such as `1:50`.
    #[serde(default)]
    pub scale: String,
    /// How fins are joined.
    #[serde(default)]
    pub joint: Joint,
    /// The sheet material.
    pub material: MaterialEntry,
    /// Stock that the layout chose from.
    #[serde(default)]
    pub sheet_stock: Vec<StockEntry>,
    /// Rigid or flexible; `null` if it was not judged.
    #[serde(default)]
    pub verdict: Option<VerdictEntry>,
    /// The parts that were made again; `null` if all were made.
    #[serde(default)]
    pub only: Option<Vec<String>>,
    /// Why the structure may be flexible.
    #[serde(default)]
    pub accepted_flexible: Option<String>,
    /// Everything found on the way.
    #[serde(default)]
    pub findings: Vec<Finding>,
    /// What the files prove.
    #[serde(default)]
    pub proof: ProofEntry,
    /// The parts.
    pub parts: Vec<PartEntry>,
    /// The sheets with where parts lie.
    pub sheets: Vec<SheetEntry>,
    /// The same parts in files for a service.
    #[serde(default)]
    pub order: Option<VendorEntry>,
    /// The steps in order.
    #[serde(default)]
    pub assembly: Vec<StepEntry>,
    /// What is bought.
    #[serde(default)]
    pub hardware: Vec<HardwareEntry>,
    /// Figures of the whole job.
    #[serde(default)]
    pub totals: Totals,
}

/// A file that the job was made from.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct SourceEntry {
    /// Its name without its folder.
    pub name: String,
    /// SHA-256 of its bytes, hexadecimal.
    pub sha256: String,
}

/// The sheet material.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct MaterialEntry {
    /// Its name.
    #[serde(default)]
    pub name: String,
    /// Thickness of the sheets, mm.
    pub thickness: f64,
    /// Full width of what the laser burns away, mm.
    pub kerf: f64,
    /// How much wider a slit is than what it holds, mm.
    pub clearance: f64,
}

/// Lengths, time, mass and cost of the whole job.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(default)]
pub struct Totals {
    /// Pieces that are cut.
    pub parts: usize,
    /// Sheets that are used.
    pub sheets: usize,
    /// Length of all cuts, mm.
    pub cut_length: f64,
    /// Length of all engraving and scores, mm.
    pub engrave_length: f64,
    /// Time of the laser along the lines, s.
    pub seconds: f64,
    /// Mass of the parts, kg.
    pub mass: f64,
    /// Price of the sheets used; `null` if one has no price.
    pub cost: Option<f64>,
}

impl Manifest {
    /// The manifest as if the files for a service were the job's own, with what it says of
    /// them; `None` if there are none.
    pub fn for_vendor(&self) -> Option<(Self, VendorEntry)> {
        let vendor = self.order.clone()?;
        let manifest = Self {
            material: MaterialEntry { kerf: vendor.kerf, ..self.material.clone() },
            sheet_stock: Vec::new(),
            sheets: vendor.sheets.clone(),
            order: None,
            ..self.clone()
        };
        Some((manifest, vendor))
    }
}

/// A number to so many parts of one, never `-0`.
pub(crate) fn rounded(value: f64, parts: f64) -> f64 {
    (value * parts).round() / parts + 0.0
}

/// A length as written, mm.
pub(crate) fn mm(value: f64) -> f64 {
    rounded(value, 1e6)
}

/// An angle as written, degrees.
pub(crate) fn degrees(radians: f64) -> f64 {
    rounded(radians.to_degrees(), 1e7)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// `UPDATE_DOCS=1 cargo test --lib manifest` writes it anew.
    #[test]
    fn the_schema_in_the_docs_is_that_of_the_types() {
        let settings = schemars::generate::SchemaSettings::draft2020_12().for_serialize();
        let schema = settings.into_generator().into_root_schema_for::<Manifest>();
        let text = serde_json::to_string_pretty(&schema).unwrap() + "\n";
        let path = concat!(env!("CARGO_MANIFEST_DIR"), "/docs/job.schema.json");
        if std::env::var_os("UPDATE_DOCS").is_some() {
            std::fs::write(path, &text).unwrap();
        }
        assert!(std::fs::read_to_string(path).is_ok_and(|written| written == text));
    }
}
