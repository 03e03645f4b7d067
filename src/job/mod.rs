//! The whole way: from a specification to everything that a job directory holds, as named
//! bytes.
//!
//! [`make`] takes a structure, [`coupon`] a template; both go through the gate, write the
//! files for the laser and prove them. Whoever calls puts the files where they belong and
//! says what was found.

mod advice;
mod error;
mod input;
mod replacement;

pub use advice::{Advice, Question, Tried, smallest_scale};
pub use error::{JobError, NoSuchPart};
pub use input::{Depth, Fix, Input, InputOptions, Origin, Scale};

use crate::design::planarise::{Options, planarised_if_needed};
use crate::diagnostic::{Finding, passes};
use crate::export::{self, File};
use crate::fabrication::{self, Fabrication, fabricate};
use crate::gate::approve_loose;
use crate::json::{self, UnwritableJson};
use crate::manifest::Manifest;
use crate::proof::{Proof, ProofFinding, Spot, prove};
use crate::report::{self, JobSource, Page};
use crate::settings::Settings;
use crate::structure::write_json;
use crate::vendor;
use crate::watch::{Stopped, Watch};

/// What is to be made.
#[derive(Debug, Clone, PartialEq)]
pub struct Specification {
    /// The structure.
    pub input: Input,
    /// What it is made with.
    pub settings: Settings,
    /// Whether fins that are not plane enough for the template are made so.
    pub planarise: bool,
    /// Whether fins on rods get hubs on as many nodes as it takes to be rigid.
    pub apply_remedies: bool,
    /// Names of the parts to make again; empty for all.
    pub only: Vec<String>,
}

/// How a job ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum End {
    /// It may be cut.
    Approved,
    /// Something forbids it; there are stamped pictures instead of files for the laser.
    Refused,
}

/// Everything there is of a job.
#[derive(Debug, Clone, PartialEq)]
pub struct Job {
    /// From the structure to sheets.
    pub fabrication: Fabrication,
    /// How it ended.
    pub end: End,
    /// What the files for the laser prove, if there are any and they could be read.
    pub proof: Option<Proof>,
    /// Found in those files.
    pub proof_findings: Vec<Finding>,
    /// `job.json`.
    pub manifest: Manifest,
    /// The files of the job directory; none if there is no structure to make parts of.
    pub files: Vec<File>,
}

/// Code of what is said of axes that were not in the file; no longer true once fins were
/// made plane.
pub const AXES_FROM_NORMALS: &str = "structure::axes_from_normals";

/// Takes a structure as far as sheets: whatever can be found out about it.
///
/// # Errors
/// [`Stopped`] if the watch stopped the work.
pub fn check(
    specification: Specification,
    watch: &mut dyn Watch,
) -> Result<Fabrication, Stopped> {
    let Specification { input, mut settings, planarise, apply_remedies, .. } =
        specification;
    let Input { mut draft, lists_fins, mut findings, .. } = input;
    if planarise {
        let target = settings.tolerance.planarity_warn;
        // A structure in our own format says what its fins are; a mesh does not.
        let options = Options { target, boundary_fins: lists_fins, ..Options::default() };
        let (planar, found) = planarised_if_needed(draft, &options, watch)?;
        if found.iter().any(|finding| finding.code == "design::planarised") {
            findings.retain(|finding| finding.code != AXES_FROM_NORMALS);
        }
        draft = planar;
        findings.extend(found);
    }
    if apply_remedies {
        settings = fabrication::with_remedies(&draft, settings, watch)?;
    }
    let mut fabrication = fabricate(draft, settings, watch)?;
    fabrication.findings.splice(0..0, findings);
    Ok(fabrication)
}

/// Makes a structure into files.
///
/// # Errors
/// [`JobError`] if the watch stopped the work, if one of the parts to make again is not
/// there, or if a picture cannot be drawn. What forbids cutting is no error but a finding.
pub fn make(
    mut specification: Specification,
    watch: &mut dyn Watch,
) -> Result<Job, JobError> {
    let origin = specification.input.origin.clone();
    let only = std::mem::take(&mut specification.only);
    let mut fabrication = check(specification, watch)?;
    if !only.is_empty() && !fabrication.parts.is_empty() {
        let only = replacement::named(&fabrication, &only)?;
        replacement::keep(&mut fabrication, only, watch)?;
    }
    watch.progress("export", 0, 1);
    let cut = match fabrication.approved() {
        Ok(sheets) if !sheets.get().is_empty() => {
            let vendor = fabrication.approved_vendor();
            let vendor = vendor.iter().flat_map(vendor::files);
            Some(
                export::cut_files(&sheets, watch.threads())?
                    .into_iter()
                    .chain(vendor)
                    .collect(),
            )
        }
        _ => None,
    };
    let mut job = written(fabrication, &origin, cut, watch.threads())?;
    if job.fabrication.structure.is_none() {
        job.files.clear();
    } else {
        job.add_pages(&origin);
    }
    watch.unless_stopped()?;
    Ok(job)
}

/// Makes the coupon of a template into files: pieces that tell kerf and clearance.
///
/// # Errors
/// As [`make`].
pub fn coupon(settings: Settings, watch: &mut dyn Watch) -> Result<Job, JobError> {
    let sha256 = settings.template.sha256();
    let origin = Origin { name: "coupon".to_owned(), sha256, scale: "1:1".to_owned() };
    let fabrication = fabrication::coupon(settings, watch)?;
    let findings = &fabrication.findings;
    let cut = match approve_loose(&fabrication.sheets, findings) {
        Some(sheets) => {
            let vendor = fabrication.vendor.as_ref();
            let vendor = vendor.and_then(|vendor| approve_loose(vendor, findings));
            let vendor = vendor.iter().flat_map(vendor::files);
            Some(
                export::cut_files(&sheets, watch.threads())?
                    .into_iter()
                    .chain(vendor)
                    .collect(),
            )
        }
        None => None,
    };
    written(fabrication, &origin, cut, watch.threads())
}

/// A job with its lists and, if they can be proved, its files for the laser; else with
/// stamped pictures.
fn written(
    fabrication: Fabrication,
    origin: &Origin,
    cut: Option<Vec<File>>,
    threads: usize,
) -> Result<Job, JobError> {
    let sha256 = fabrication.settings.template.sha256();
    let mut manifest =
        report::manifest(&fabrication, &source(&fabrication, origin, &sha256));
    let mut files = lists(&fabrication, &manifest)?;
    let (mut end, mut proof, mut proof_findings) = (End::Refused, None, Vec::new());
    if let Some(cut) = cut {
        let kept = files.len();
        files.extend(cut);
        (proof, proof_findings) = proved(&files, &mut manifest);
        files[0] = job_json(&manifest)?;
        if passes(&proof_findings) {
            end = End::Approved;
        } else {
            files.truncate(kept);
        }
    }
    if end == End::Refused {
        files.extend(export::stamped_previews(&fabrication.sheets, threads)?);
    }
    Ok(Job { fabrication, end, proof, proof_findings, manifest, files })
}

fn job_json(manifest: &Manifest) -> Result<File, UnwritableJson> {
    Ok(("job.json".to_owned(), json::text(manifest)?.into_bytes()))
}

/// The lists that stand in every job directory, the manifest first.
fn lists(
    fabrication: &Fabrication,
    manifest: &Manifest,
) -> Result<Vec<File>, UnwritableJson> {
    let bill = report::bill(fabrication, &fabrication.settings.template.material.name);
    let mut files =
        vec![job_json(manifest)?, ("parts.csv".to_owned(), bill.into_bytes())];
    let structure = fabrication.structure.as_ref().map(write_json);
    files.extend(structure.map(|text| ("structure.json".to_owned(), text.into_bytes())));
    Ok(files)
}

/// What files prove before they are written; the worst figures and what was found go into
/// their manifest.
fn proved(files: &[File], manifest: &mut Manifest) -> (Option<Proof>, Vec<Finding>) {
    let read = files.iter().filter(|(path, _)| !path.ends_with(".png"));
    let (proof, findings) = match prove(&read.cloned().collect()) {
        Ok(proof) => {
            manifest.proof = proof.entry();
            let findings = proof.findings.clone();
            (Some(proof), findings)
        }
        Err(error) => {
            let (spot, reason) = (Spot::file("job.json"), error.to_string());
            (None, vec![ProofFinding::Unreadable { spot, reason }.into()])
        }
    };
    manifest.findings.extend(findings.iter().cloned());
    (proof, findings)
}

fn source<'a>(
    fabrication: &'a Fabrication,
    origin: &'a Origin,
    template_sha256: &'a str,
) -> JobSource<'a> {
    let settings = &fabrication.settings;
    JobSource {
        input: &origin.name,
        input_sha256: &origin.sha256,
        template: &settings.template,
        template_sha256,
        seed: settings.effort.seed,
        scale: &origin.scale,
        joint: settings.joint,
    }
}

impl Job {
    /// Adds the report and, to what may be cut as a whole, the guide of assembly.
    fn add_pages(&mut self, origin: &Origin) {
        let job = &self.fabrication;
        let sha256 = job.settings.template.sha256();
        let source = source(job, origin, &sha256);
        let is_approved = self.end == End::Approved;
        let (manifest, proof) = (&self.manifest, self.proof.as_ref());
        let page = Page { job, source: &source, manifest, proof, is_approved };
        let page = report::page(&page).into_bytes();
        let whole = is_approved && job.only.is_empty();
        let guide = whole.then(|| report::guide(job, &source)).flatten();
        self.files.push(("report.html".to_owned(), page));
        self.files.extend(guide.map(|pdf| ("assembly.pdf".to_owned(), pdf)));
    }
}
