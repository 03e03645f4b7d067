//! Templates: what a material, a machine and a joint ask, in one TOML file each.
//!
//! The embedded ones stand in `templates/`, every value with its source; their keys are
//! described in `templates/README.md`. [`read`] says everything that is wrong with a file
//! at once, and names the nearest known key for an unknown one.

mod error;
mod keys;

pub use error::{TemplateErrors, TemplateFault};
pub use keys::PROFILES;
pub(crate) use keys::nearest;

use crate::files::sha256;
use crate::ids::NodeId;
use crate::tolerance::{PROOF_LIMIT_DEG, PROOF_LIMIT_MM};
use serde::Deserialize;

/// What a job is cut from, on and for.
#[derive(Debug, Clone, PartialEq, Deserialize)]
pub struct Template {
    /// Name of the file, without its ending.
    #[serde(skip)]
    pub name: String,
    /// The text it was read from.
    #[serde(skip)]
    pub source: String,
    /// The sheet material.
    pub material: Material,
    /// How tightly it bends.
    pub bend: Bend,
    /// How strips are joined.
    pub joint: JointDefaults,
    /// Sheets in stock.
    pub sheet: Vec<SheetStock>,
    /// What is drawn.
    #[serde(default)]
    pub output: Output,
    /// What is let through.
    #[serde(default)]
    pub gate: Gate,
}

/// The sheet material and what the laser does to it.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[allow(missing_docs, reason = "templates/README.md describes every key")]
pub struct Material {
    pub name: String,
    pub thickness_mm: f64,
    pub thickness_least_mm: f64,
    pub thickness_most_mm: f64,
    pub kerf_mm: f64,
    pub clearance_mm: f64,
    pub web_mm: f64,
    pub web_least_mm: f64,
    pub relief_radius_mm: f64,
    pub e_modulus_mpa: f64,
    pub density_kg_m3: f64,
    pub cut_speed_mm_s: f64,
    pub engrave_speed_mm_s: f64,
    #[serde(default)]
    pub price_per_m2: Option<f64>,
    #[serde(default)]
    pub grain: bool,
}

/// Bend limits as radius over thickness, and what is drawn along folds.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[allow(missing_docs, reason = "templates/README.md describes every key")]
pub struct Bend {
    pub long_term: f64,
    pub model: f64,
    pub crack: f64,
    pub fold_marks: FoldMarks,
}

/// What is drawn along the lines where a strip folds.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum FoldMarks {
    /// Nothing.
    None,
    /// An engraved line.
    Engrave,
    /// A line cut part of the way through.
    Score,
}

/// How strips and fins are joined.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[allow(missing_docs, reason = "templates/README.md describes every key")]
pub struct JointDefaults {
    pub overhang_mm: f64,
    #[serde(default = "half")]
    pub lap_split: f64,
    pub depth_allowance_mm: f64,
    pub mouth_chamfer_mm: f64,
    pub mouth_chamfer_deg: f64,
    pub setback_mm: f64,
    pub connector_thickness_mm: f64,
    pub rod_diameter_mm: f64,
    #[serde(default)]
    pub disc_slot_mm: Option<f64>,
    #[serde(default)]
    pub hub_nodes: Vec<NodeId>,
}

/// A size of sheet in stock.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[allow(missing_docs, reason = "templates/README.md describes every key")]
pub struct SheetStock {
    pub width_mm: f64,
    pub height_mm: f64,
    pub margin_mm: f64,
    pub spacing_mm: f64,
    #[serde(default)]
    pub count: Option<usize>,
    #[serde(default)]
    pub price: Option<f64>,
}

/// What is drawn, and in which files.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(default)]
#[allow(missing_docs, reason = "templates/README.md describes every key")]
pub struct Output {
    pub profile: String,
    pub frame: bool,
    pub lettering_mm: f64,
    pub one_file_per: String,
}

impl Default for Output {
    fn default() -> Self {
        Self {
            profile: "generic".to_owned(),
            frame: true,
            lettering_mm: 3.0,
            one_file_per: "sheet".to_owned(),
        }
    }
}

/// What is let through.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(default)]
#[allow(missing_docs, reason = "templates/README.md describes every key")]
pub struct Gate {
    pub play_mm: Option<f64>,
    pub sway_limit: String,
    pub planarity_warn_percent: f64,
    pub planarity_limit_percent: f64,
    pub crossing_warn_deg: f64,
    pub crossing_least_deg: f64,
    pub fin_angle_least_deg: f64,
    pub proof_mm: f64,
    pub proof_deg: f64,
}

impl Default for Gate {
    fn default() -> Self {
        Self {
            play_mm: None,
            sway_limit: "L/50".to_owned(),
            planarity_warn_percent: 0.01,
            planarity_limit_percent: 0.1,
            crossing_warn_deg: 45.0,
            crossing_least_deg: 30.0,
            fin_angle_least_deg: 25.0,
            proof_mm: PROOF_LIMIT_MM,
            proof_deg: PROOF_LIMIT_DEG,
        }
    }
}

const fn half() -> f64 {
    0.5
}

/// The embedded templates, the default one first.
const EMBEDDED: [(&str, &str); 7] = [
    ("pmma-cast-3", include_str!("../../templates/pmma-cast-3.toml")),
    ("pmma-cast-2", include_str!("../../templates/pmma-cast-2.toml")),
    ("pmma-xt-1.5", include_str!("../../templates/pmma-xt-1.5.toml")),
    ("petg-1", include_str!("../../templates/petg-1.toml")),
    ("birch-ply-3", include_str!("../../templates/birch-ply-3.toml")),
    ("mdf-3", include_str!("../../templates/mdf-3.toml")),
    ("card-1.5", include_str!("../../templates/card-1.5.toml")),
];

impl Template {
    /// SHA-256 of its text, hexadecimal.
    pub fn sha256(&self) -> String {
        sha256(self.source.as_bytes())
    }
}

/// Names of the embedded templates.
pub fn names() -> Vec<&'static str> {
    EMBEDDED.iter().map(|(name, _)| *name).collect()
}

/// Text of an embedded template.
pub fn embedded(name: &str) -> Option<&'static str> {
    EMBEDDED.iter().find(|(known, _)| *known == name).map(|(_, source)| *source)
}

/// Reads a template.
///
/// # Errors
/// [`TemplateErrors`] with everything that is wrong with it.
/// ```
/// use finwright::template;
///
/// let source = template::embedded("pmma-cast-3").unwrap();
/// assert_eq!(template::read(source, "pmma-cast-3").unwrap().material.thickness_mm, 3.0);
/// let misspelt = source.replace("kerf_mm", "kerv_mm");
/// assert!(template::read(&misspelt, "mine").is_err());
/// ```
pub fn read(source: &str, name: &str) -> Result<Template, TemplateErrors> {
    let wrong = |faults| TemplateErrors { name: name.to_owned(), faults };
    let table: toml::Table = source
        .parse()
        .map_err(|error: toml::de::Error| wrong(vec![keys::syntax(source, &error)]))?;
    let mut faults = keys::faults(&table, source);
    if !faults.is_empty() {
        return Err(wrong(faults));
    }
    let template: Template = toml::from_str(source)
        .map_err(|error| wrong(vec![keys::syntax(source, &error)]))?;
    faults.extend(keys::contradictions(&template));
    if faults.is_empty() {
        Ok(Template { name: name.to_owned(), source: source.to_owned(), ..template })
    } else {
        Err(wrong(faults))
    }
}

/// The error for a template that is not there, with the nearest name that is.
pub fn unknown_name(name: &str) -> TemplateErrors {
    let nearest = likest(name);
    let fault = TemplateFault::UnknownName { found: name.to_owned(), nearest };
    TemplateErrors { name: name.to_owned(), faults: vec![fault] }
}

/// What people call the materials of the templates.
const MATERIALS: [(&str, &str); 11] = [
    ("acrylic", "pmma"),
    ("acryl", "pmma"),
    ("plexi", "pmma"),
    ("plexiglas", "pmma"),
    ("plexiglass", "pmma"),
    ("perspex", "pmma"),
    ("plywood", "ply"),
    ("wood", "ply"),
    ("cardboard", "card"),
    ("paper", "card"),
    ("extruded", "xt"),
];

/// The words and numbers of a name.
fn words_and_numbers(name: &str) -> (Vec<String>, Vec<f64>) {
    let name = name.to_lowercase().replace(',', ".");
    let is_number = |c: char| c.is_ascii_digit() || c == '.';
    let numbers = name.split(|c| !is_number(c)).filter_map(|number| number.parse().ok());
    let words = name.split(|c: char| !c.is_alphabetic()).filter(|word| !word.is_empty());
    let known = |word: &str| MATERIALS.iter().find(|(other, _)| *other == word);
    let words = words.map(|word| known(word).map_or(word, |(_, known)| known).to_owned());
    (words.collect(), numbers.collect())
}

/// The embedded template of most like material and thickness; the most alike in letters
/// where names say neither.
fn likest(name: &str) -> String {
    let (words, numbers) = words_and_numbers(name);
    let score = |known: &&str| {
        let (theirs, thickness) = words_and_numbers(known);
        let common = words.iter().filter(|word| theirs.contains(word)).count();
        let off =
            |a: &f64| thickness.iter().map(|b| (a - b).abs()).fold(f64::MAX, f64::min);
        let off = numbers.iter().map(off).fold(f64::MAX, f64::min);
        (common, -off)
    };
    let best = names().into_iter().map(|known| (score(&known), known));
    // The first of equals: templates are listed in order of use.
    let best = best.reduce(|a, b| if b.0 > a.0 { b } else { a });
    match best {
        Some(((common, off), known)) if common > 0 || off == 0.0 => known.to_owned(),
        _ => nearest(name, names()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_alike_in_material_and_thickness() {
        let cases = [
            ("pmma-3mm", "pmma-cast-3"),
            ("acrylic 2 mm", "pmma-cast-2"),
            ("plywood3", "birch-ply-3"),
            ("mdf", "mdf-3"),
            ("card-1,5", "card-1.5"),
            ("pmma-cast-4", "pmma-cast-3"),
            ("pmma-xt-2", "pmma-xt-1.5"),
            ("pmma-cats-3", "pmma-cast-3"),
        ];
        for (typed, meant) in cases {
            assert_eq!(likest(typed), meant, "{typed}");
        }
    }

    #[test]
    fn a_decimal_comma_is_said() {
        let source = embedded("pmma-cast-3").unwrap();
        let source = source.replace("thickness_mm = 3.0", "thickness_mm = 3,0");
        let errors = read(&source, "mine").unwrap_err().to_string();
        assert!(errors.contains("write 3.0, not 3,0"), "{errors}");
    }

    #[test]
    fn every_embedded_template_can_be_read() {
        for name in names() {
            let read = read(embedded(name).unwrap(), name);
            assert!(read.is_ok(), "{name}: {}", read.unwrap_err());
        }
    }

    #[test]
    fn every_value_of_a_template_has_its_source_beside_it() {
        for (name, source) in EMBEDDED {
            for line in source.lines().filter(|line| line.contains('=')) {
                let commented =
                    line.split_once('#').is_some_and(|(_, why)| why.len() > 3);
                assert!(commented, "{name}: {line}");
            }
        }
    }

    #[test]
    fn the_readme_describes_every_key() {
        let readme = include_str!("../../templates/README.md");
        for (table, key) in keys::all() {
            assert!(readme.contains(&format!("`{key}`")), "[{table}] {key}");
        }
    }
}
