//! The stages in order and nothing else.

mod judge;

pub use judge::{criteria, model, verdict, with_remedies};

use crate::diagnostic::Finding;
use crate::gate::{self, Approved, Judged, Shut};
use crate::geometry::{Contour, Point2};
use crate::joint::Joint;
use crate::nest::{self, Effort, Layout, NestError, Shape, Stock};
use crate::parts::{self, Body, ConnectorFinding, Making, Part, Step};
use crate::rigidity::{Fingerprint, Stopped, Verdict};
pub use crate::setting::fit;
use crate::setting::{frame, marking, stock, tolerance, turns};
use crate::sheets::{self, Kerf, Laying, Sheet};
use crate::structure::{Draft, Structure};
use crate::template::Template;
use crate::tolerance::ARC_SAGITTA_MM;
use crate::vendor::{self, Profile, Request, VendorSheets};
use crate::watch::Watch;
use judge::{has_hub, judged};

/// What a job is made from.
pub struct Order<'a> {
    /// The structure as read, mm at model scale.
    pub draft: Draft,
    /// Material, stock and joint.
    pub template: &'a Template,
    /// How fins are joined.
    pub joint: Joint,
    /// How hard to nest.
    pub effort: Effort,
    /// Why the structure may be flexible.
    pub accepted_flexible: Option<String>,
}

/// How far a job came.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Job {
    /// Everything found on the way.
    pub findings: Vec<Finding>,
    /// Names of the parts that are made again; empty if all are made.
    pub only: Vec<String>,
    /// Why the structure may be flexible, as ordered.
    pub accepted_flexible: Option<String>,
    /// The structure as built; `None` if the draft was none.
    pub structure: Option<Structure>,
    /// Rigid or flexible.
    pub verdict: Option<Verdict>,
    /// The parts in the order of assembly.
    pub parts: Vec<Part>,
    /// How they go together.
    pub steps: Vec<Step>,
    /// Stock that the layout chose from.
    pub stock: Vec<Stock>,
    /// Where parts lie.
    pub layout: Layout,
    /// What the laser does.
    pub sheets: Vec<Sheet>,
    /// The same for the service or machine that the template names.
    pub vendor: Option<VendorSheets>,
}

/// The work was stopped from outside.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Interrupted;

/// Takes a structure through all stages, as far as they go.
///
/// # Errors
/// [`Interrupted`] if the watch stopped the work.
pub fn run(order: Order, watch: &mut dyn Watch) -> Result<Job, Interrupted> {
    let template = order.template;
    let accepted_flexible = order.accepted_flexible;
    let mut job = Job { stock: stock(template), accepted_flexible, ..Job::default() };
    watch.progress("structure", 0, 1);
    let structure = match Structure::new(order.draft, &tolerance(template)) {
        Ok((structure, findings)) => {
            job.findings = findings;
            structure
        }
        Err(refused) => return Ok(Job { findings: refused.findings, ..job }),
    };
    if let Some(finding) = parts::too_small(&structure, &fit(template)) {
        job.findings.push(finding.into());
        return Ok(Job { structure: Some(structure), ..job });
    }
    job.findings.extend(no_such_hub(&structure, template).map(Finding::from));
    job.judge(&structure, order.joint, template, watch)?;
    watch.progress("parts", 0, 1);
    let name = structure.name().to_owned();
    job.cut(structure, order.joint, template);
    if watch.stopped() {
        return Err(Interrupted);
    }
    on_sheets(job, template, name, &order.effort, watch)
}

/// Takes the coupon of a template through the stages: pieces that tell kerf and clearance.
///
/// # Errors
/// [`Interrupted`] if the watch stopped the work.
pub fn coupon(
    template: &Template,
    effort: &Effort,
    watch: &mut dyn Watch,
) -> Result<Job, Interrupted> {
    let thickness = template.material.thickness_mm;
    let radii = [template.bend.model, template.bend.long_term].map(|r| r * thickness);
    let parts = parts::coupon(&fit(template), radii);
    let job = Job { stock: stock(template), parts, ..Job::default() };
    on_sheets(job, template, "coupon".to_owned(), effort, watch)
}

/// Nests the parts of a job and says what the laser does.
pub(crate) fn on_sheets(
    mut job: Job,
    template: &Template,
    name: String,
    effort: &Effort,
    watch: &mut dyn Watch,
) -> Result<Job, Interrupted> {
    let kerf = Kerf::from_width_mm(template.material.kerf_mm);
    lay(&mut job, kerf, template, effort, watch)?;
    watch.progress("sheets", 0, 1);
    let frame = frame(template, name, job.accepted_flexible.as_deref());
    job.sheets = sheets::sheets(&Laying {
        parts: &job.parts,
        layout: &job.layout,
        stock: &job.stock,
        kerf,
        frame: template.output.frame.then_some(&frame),
    });
    job.lay_for_vendor(template);
    Ok(job)
}

/// A node that should get a hub and is not there.
fn no_such_hub(structure: &Structure, template: &Template) -> Option<ConnectorFinding> {
    let count = structure.nodes().len();
    let node = template.joint.hub_nodes.iter().copied().find(|&node| node >= count)?;
    Some(ConnectorFinding::NoSuchNode { node, count })
}

/// Finds the parts their places, or says why there are none.
fn lay(
    job: &mut Job,
    kerf: Kerf,
    template: &Template,
    effort: &Effort,
    watch: &mut dyn Watch,
) -> Result<(), Interrupted> {
    let copies = job.parts.iter().enumerate();
    let copies: Vec<usize> =
        copies.flat_map(|(k, part)| std::iter::repeat_n(k, part.quantity)).collect();
    let shapes: Vec<Shape> =
        copies.iter().map(|&k| shape(&job.parts[k], kerf, template)).collect();
    // Parts that cross themselves cannot lie soundly, and that was said of them already.
    let crossing =
        job.findings.iter().any(|found| found.code == "parts::outline_crosses_itself");
    match nest::nest(&shapes, &job.stock, effort, watch) {
        Ok(layout) => job.layout = layout,
        Err(NestError::Stopped) => return Err(Interrupted),
        Err(NestError::Unsound { .. }) if crossing => {}
        Err(error) => job.findings.push(error.into()),
    }
    // From here on a placement means a part; which copy it is, nobody can tell.
    let placements = job.layout.sheets.iter_mut().flat_map(|sheet| &mut sheet.placements);
    placements.for_each(|placement| placement.shape = copies[placement.shape]);
    Ok(())
}

impl Job {
    /// Whether it has a part of a kind.
    pub fn has(&self, is: impl Fn(&Body) -> bool) -> bool {
        self.parts.iter().any(|part| is(&part.body))
    }

    /// Makes the sheets for the service that the template names, if it names one.
    fn lay_for_vendor(&mut self, template: &Template) {
        let output = &template.output;
        let Some(profile) = Profile::named(&output.profile) else { return };
        let per_part = output.one_file_per == "part";
        if self.sheets.is_empty() || profile.is_generic() && !per_part {
            return;
        }
        let request = Request {
            profile,
            per_part,
            parts: &self.parts,
            layout: &self.layout,
            stock: &self.stock,
            kerf_mm: template.material.kerf_mm,
        };
        let vendor = vendor::vendor_sheets(&request);
        let found = vendor::check(&vendor, &request);
        self.findings.extend(found.into_iter().map(Finding::from));
        self.vendor = Some(vendor);
    }

    /// Makes the structure into parts.
    fn cut(&mut self, structure: Structure, joint: Joint, template: &Template) {
        let (fit, turns) = (fit(template), turns(template));
        let kerf = Kerf::from_width_mm(template.material.kerf_mm);
        let stock = &self.stock;
        let fits = |outline: &[Point2]| {
            let drawn = kerf.compensated(&Contour::polygon(outline.iter().copied()));
            let drawn = drawn.flattened(ARC_SAGITTA_MM);
            stock.iter().any(|sheet| nest::fits(&drawn, &turns, sheet).is_some())
        };
        let making = Making { fit: &fit, marking: marking(template), fits: &fits };
        let made = match joint {
            Joint::Lap => parts::strips(&structure, &template.joint.hub_nodes, &making),
            Joint::Hinge | Joint::Hub => {
                let is_hub = |node: usize| has_hub(joint, template, node);
                parts::connected(&structure, &is_hub, &making)
            }
        };
        self.findings.extend(made.findings);
        let tight = parts::tight_insertions(&made.structure, &made.parts, &fit);
        self.findings.extend(tight.into_iter().map(Finding::from));
        self.structure = Some(made.structure);
        (self.parts, self.steps) = (made.parts, made.steps);
    }

    /// The sheets, if findings and verdict let them pass; the verdict must be about the
    /// structure as it stands in the job, with this joint and template.
    ///
    /// # Errors
    /// [`Shut`] says why not.
    pub fn approved(
        &self,
        joint: Joint,
        template: &Template,
    ) -> Result<Approved<&Vec<Sheet>>, Shut> {
        self.pass(&self.sheets, joint, template)
    }

    /// The sheets for the vendor, if there are any and they pass.
    pub fn approved_vendor(
        &self,
        joint: Joint,
        template: &Template,
    ) -> Option<Approved<&VendorSheets>> {
        self.pass(self.vendor.as_ref()?, joint, template).ok()
    }

    fn pass<T>(
        &self,
        work: T,
        joint: Joint,
        template: &Template,
    ) -> Result<Approved<T>, Shut> {
        let structure = self.structure.as_ref().ok_or(Shut::Findings)?;
        let fingerprint = Fingerprint::of(structure, joint, &template.source);
        let judged = Judged {
            fingerprint: &fingerprint,
            verdict: self.verdict.as_ref(),
            accepted: self.accepted_flexible.as_deref(),
        };
        gate::approve(work, &self.findings, judged)
    }

    /// Judges the structure and notes what forbids cutting.
    fn judge(
        &mut self,
        structure: &Structure,
        joint: Joint,
        template: &Template,
        watch: &mut dyn Watch,
    ) -> Result<(), Interrupted> {
        match verdict(structure, joint, (template, None), watch) {
            Ok(Err(Stopped)) => return Err(Interrupted),
            Ok(Ok(verdict)) => {
                let accepted = self.accepted_flexible.as_deref();
                self.findings.extend(judged(&verdict, accepted));
                self.verdict = Some(verdict);
            }
            Err(finding) => self.findings.push(finding.into()),
        }
        if watch.stopped() { Err(Interrupted) } else { Ok(()) }
    }
}

/// A part as the nester sees it: the line that will be drawn.
fn shape(part: &Part, kerf: Kerf, template: &Template) -> Shape {
    let drawn = kerf.compensated(&part.region.outline);
    let outline = drawn.enclosing_polygon(ARC_SAGITTA_MM);
    let holes = part.region.holes.iter();
    let hole = |hole| kerf.compensated(hole).flattened(ARC_SAGITTA_MM);
    let holes = holes.map(hole).collect();
    Shape { name: part.id.clone(), outline, holes, turns: turns(template), priority: 0 }
}
