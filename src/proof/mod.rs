//! The written bytes back to parts, the parts back to space, both against the structure.
//!
//! [`prove`] knows nothing of how a job was made: it takes the files of a job directory,
//! reads DXF, SVG and PDF each for itself, takes the kerf out of the lines, finds every part
//! of `job.json` by its shape, measures axes and slits on the outline, folds the strips at
//! their axes and sets them on the axes of `structure.json`. What a slit must be is worked
//! out from the structure's angles and the sheet's thickness.
//!
//! Where connectors hold fins and strips, all parts as drawn in the DXF files are put together
//! as plates of their thickness: none may run into another. A bent strip is taken as sharply
//! folded at its axes.

mod assembled;
mod connectors;
mod figures;
mod files;
mod finding;
mod fit;
mod kerf;
mod label;
mod layout;
mod lines;
mod matching;
mod measure;
mod outline;
mod refold;
mod shape;
mod sheets;
mod strips;

pub use figures::{NodeFigure, PartFigure, SlitFigure};
pub use finding::{ProofFinding, Spot};

use crate::diagnostic::{Finding, Place, passes};
use crate::files::{FileFormat, ORDER, PREVIEW, SHEETS, sha256};
use crate::manifest::{self, Limits, Manifest, ProofEntry, Worst};
use crate::structure::{AxisRule, Structure, read_json};
use crate::tolerance::Tolerance;
use figures::micro;
use files::formats;
use lines::differences;
use miette::Diagnostic;
use serde::Serialize;
use sheets::{Files, Read};
use std::collections::{BTreeMap, BTreeSet};
use thiserror::Error;

/// The files of a job directory by their paths inside it.
pub type JobFiles = BTreeMap<String, Vec<u8>>;

/// Why a directory cannot be proved at all.
#[derive(Debug, Clone, PartialEq, Eq, Error, Diagnostic)]
#[allow(missing_docs, reason = "the messages say it")]
pub enum ProofError {
    #[error("there is no {file}")]
    #[diagnostic(
        code(job::not_a_job),
        help("give the folder that `finwright make` wrote")
    )]
    NoFile { file: &'static str },

    #[error("{file}: {message}")]
    #[diagnostic(
        code(job::bad_manifest),
        help("job.json and structure.json must be as they were written")
    )]
    BadFile { file: &'static str, message: String },

    #[error("the job was refused: it has no cut files")]
    #[diagnostic(
        code(job::refused),
        help("the findings in its job.json say why; mend them and make it again")
    )]
    Refused,
}

/// What the files of a job prove.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Proof {
    /// What was allowed.
    pub limits: Limits,
    /// The worst figures of each format.
    pub worst: Vec<Worst>,
    /// Nodes, as measured in the DXF files.
    pub nodes: Vec<NodeFigure>,
    /// Slits, as measured in the DXF files.
    pub slits: Vec<SlitFigure>,
    /// Parts, as found in the DXF files.
    pub parts: Vec<PartFigure>,
    /// SHA-256 of the files that were read, by path.
    pub files: BTreeMap<String, String>,
    /// What is wrong.
    pub findings: Vec<Finding>,
}

impl Proof {
    /// Limits and the worst figures, for `job.json`.
    pub fn entry(&self) -> ProofEntry {
        ProofEntry {
            limits: self.limits,
            worst: Some(self.worst.clone()),
            files: Some(self.files.clone()),
        }
    }

    /// Everything, for `verify --json`.
    pub fn report(&self) -> ProofReport<'_> {
        ProofReport {
            entry: self.entry(),
            passes: passes(&self.findings),
            findings: &self.findings,
            nodes: &self.nodes,
            slits: &self.slits,
            parts: &self.parts,
        }
    }
}

/// All that a proof measured, as `verify --json` prints it.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ProofReport<'a> {
    #[serde(flatten)]
    entry: ProofEntry,
    passes: bool,
    findings: &'a [Finding],
    nodes: &'a [NodeFigure],
    slits: &'a [SlitFigure],
    parts: &'a [PartFigure],
}

/// Proves the files of a job.
///
/// # Errors
/// [`ProofError`] if there is no manifest or no structure to prove against. Everything
/// else that is wrong is a finding.
/// ```
/// use finwright::diagnostic::passes;
/// use finwright::{design::examples, job, proof, settings::Settings, template};
///
/// let source = template::embedded("pmma-cast-3").unwrap();
/// let specification = job::Specification {
///     input: job::Input::embedded(examples::named("three").unwrap(), &job::InputOptions::default()),
///     settings: Settings::new(template::read(source, "pmma-cast-3").unwrap()),
///     planarise: false,
///     apply_remedies: false,
///     only: Vec::new(),
/// };
/// let job = job::make(specification, &mut ()).unwrap();
/// let mut files: proof::JobFiles = job.files.into_iter().collect();
/// assert!(passes(&proof::prove(&files).unwrap().findings));
/// files.remove("sheets/sheet-01.dxf");
/// assert!(!passes(&proof::prove(&files).unwrap().findings));
/// ```
pub fn prove(files: &JobFiles) -> Result<Proof, ProofError> {
    let manifest = read_manifest(files)?;
    let structure = read_structure(files, &manifest)?;
    let mut facts = Vec::new();
    let mut proof = Proof { limits: manifest.proof.limits, ..Proof::default() };
    let written = manifest.proof.files.as_ref();
    for (path, bytes) in files.iter().filter(|(path, _)| is_proved(path)) {
        let digest = sha256(bytes);
        if written.is_some_and(|files| files.get(path).is_some_and(|was| *was != digest))
        {
            facts.push(ProofFinding::FileChanged { spot: Spot::file(path) });
        }
        proof.files.insert(path.clone(), digest);
    }
    let pdf = FileFormat::Pdf.path(SHEETS, "");
    let drawn = formats(&manifest, Some(&pdf), files, &mut facts);
    let mut told = Told { facts, known: BTreeSet::new() };
    let structure = structure.as_ref();
    let own = Group { manifest: &manifest, structure, name: "" };
    own.prove(drawn, &mut proof, &mut told);
    if let Some((manifest, vendor)) = manifest.for_vendor() {
        let pdf = vendor.pdf.as_deref();
        let drawn = formats(&manifest, pdf, files, &mut told.facts);
        // Figures of nodes, slits and parts are those of the job's own files.
        let mut figures = Proof::default();
        let ordered = Group { manifest: &manifest, structure, name: "order " };
        ordered.prove(drawn, &mut figures, &mut told);
        proof.worst.extend(figures.worst);
    }
    proof.findings = told.facts.into_iter().map(Finding::from).collect();
    Ok(proof)
}

/// What has been found so far: what stands in all formats is told once, with the first
/// file it was found in.
struct Told {
    facts: Vec<ProofFinding>,
    known: BTreeSet<Key>,
}

type Key = (String, Vec<String>, Vec<usize>, Option<[i64; 2]>);

/// Files that hold the same parts in several formats.
struct Group<'a> {
    manifest: &'a Manifest,
    structure: Option<&'a Structure>,
    /// Before the names of its formats.
    name: &'static str,
}

impl Group<'_> {
    fn prove(&self, formats: Vec<Files>, proof: &mut Proof, told: &mut Told) {
        let reads: Vec<Read> =
            formats.into_iter().map(|files| Read::new(self.manifest, files)).collect();
        for (k, read) in reads.iter().enumerate() {
            let mut found = read.findings();
            if k > 0 {
                found.extend(differences(&reads[0], read));
            }
            let mut worst = Worst {
                format: format!("{}{}", self.name, read.files.format),
                parts: read.found.len(),
                ..Worst::default()
            };
            if let Some(structure) = self.structure {
                let refolded = strips::refold(read, structure, &mut worst);
                found.extend(refolded.findings);
                let turned = connectors::check(read, structure, &mut worst);
                found.extend(turned);
                if k == 0 {
                    let hits = assembled::check(read, structure, &found);
                    found.extend(hits);
                    (proof.nodes, proof.slits) = (refolded.nodes, refolded.slits);
                }
            }
            let (parts, off) = part_figures(read, &found, &mut worst);
            found.extend(off);
            if k == 0 {
                proof.parts = parts;
            }
            proof.worst.push(worst);
            let news = |fact: &ProofFinding| told.known.insert(key(fact));
            told.facts.extend(found.into_iter().filter(news));
        }
    }
}

/// What makes two findings one, whatever format they were found in.
fn key(fact: &ProofFinding) -> Key {
    let code = fact.code().map(|code| code.to_string()).unwrap_or_default();
    let place: Place = crate::diagnostic::Located::place(fact);
    let at = place.at.map(|at| at.map(|mm| mm.round() as i64));
    let of_the_file = code.ends_with("formats_differ") || code.ends_with("file_missing");
    let code = if of_the_file { format!("{code} {}", fact.spot().file) } else { code };
    (code, place.parts, place.nodes, at)
}

fn is_proved(path: &str) -> bool {
    let folder = path.split_once('/').map(|(folder, _)| folder);
    let is_drawing = matches!(folder, Some(SHEETS | ORDER)) && FileFormat::is_cut(path);
    path == "structure.json" || is_drawing
}

fn read_manifest(files: &JobFiles) -> Result<Manifest, ProofError> {
    let file = "job.json";
    let bytes = files.get(file).ok_or(ProofError::NoFile { file })?;
    let bad = |message: String| ProofError::BadFile { file, message };
    let manifest: Manifest =
        serde_json::from_slice(bytes).map_err(|error| bad(error.to_string()))?;
    if manifest.format != manifest::FORMAT || manifest.version != manifest::VERSION {
        let found = format!("format {:?}, version {}", manifest.format, manifest.version);
        return Err(bad(found));
    }
    let no_files = !files.keys().any(|path| path.ends_with(".dxf"));
    if no_files && files.keys().any(|path| path.split('/').next() == Some(PREVIEW)) {
        return Err(ProofError::Refused);
    }
    Ok(manifest)
}

/// The structure, if the job has parts that go back into one.
fn read_structure(
    files: &JobFiles,
    manifest: &Manifest,
) -> Result<Option<Structure>, ProofError> {
    let file = "structure.json";
    if manifest.parts.iter().all(|part| part.run().is_none()) {
        return Ok(None);
    }
    let bytes = files.get(file).ok_or(ProofError::NoFile { file })?;
    let bad = |message: String| ProofError::BadFile { file, message };
    let text = std::str::from_utf8(bytes).map_err(|error| bad(error.to_string()))?;
    let (draft, _) =
        read_json(text, AxisRule::File).map_err(|error| bad(error.to_string()))?;
    match Structure::new(draft, &Tolerance::default()) {
        Ok((structure, _)) => Ok(Some(structure)),
        Err(refused) => {
            let first = refused.findings.into_iter().next();
            Err(bad(first.map(|finding| finding.message).unwrap_or_default()))
        }
    }
}

/// Figures of each part, and where its outline is off and nothing else says so.
fn part_figures(
    read: &Read,
    told: &[ProofFinding],
    worst: &mut Worst,
) -> (Vec<PartFigure>, Vec<ProofFinding>) {
    let mut findings = Vec::new();
    let figures = read.found.iter().map(|found| {
        let id = read.id(found);
        let spots = told.iter().map(ProofFinding::spot);
        let slits = spots
            .filter(|spot| spot.node.is_some() && spot.parts.iter().any(|p| p == id));
        let slits: Vec<_> = slits.filter_map(|spot| spot.at).collect();
        let (outline_mm, off) = outline::deviations(read, found, &slits);
        findings.extend(off);
        let moved_mm = sheets::finite(read.moved(found));
        worst.outline_mm = worst.outline_mm.max(micro(outline_mm));
        worst.moved_mm = worst.moved_mm.max(micro(moved_mm));
        PartFigure {
            part: id.to_owned(),
            copy: read.matching.places[found.place].copy,
            file: read.file(found).to_owned(),
            moved_mm: micro(moved_mm),
            kerf_mm: micro(found.kerf),
            outline_mm: micro(outline_mm),
        }
    });
    (figures.collect(), findings)
}
