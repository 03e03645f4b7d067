//! From a structure to sheets: the stages in order, as far as they go.

mod judge;

pub use judge::{criteria, plan, verdict, with_remedies};

use crate::diagnostic::Finding;
use crate::gate::{self, Approved, Judged, Shut};
use crate::geometry::{Contour, Point2};
use crate::ids::{NodeId, PartId};
use crate::nest::{self, Effort, Layout, NestError, Shape, Stock};
use crate::parts::{self, Body, Making, Part, PartFinding, Plan, Step};
use crate::rigidity::Verdict;
use crate::settings::Settings;
use crate::sheets::{self, Laying, Sheet};
use crate::structure::{Draft, Structure, blame_gaps};
use crate::tolerance::ARC_SAGITTA_MM;
use crate::vendor::{self, Profile, Request, VendorSheets};
use crate::watch::{Stopped, Watch};
use judge::judged;
use std::collections::BTreeMap;

/// A structure on its way to sheets, or a coupon, as far as it came.
#[derive(Debug, Clone, PartialEq)]
pub struct Fabrication {
    /// What it is made with.
    pub settings: Settings,
    /// Everything found on the way.
    pub findings: Vec<Finding>,
    /// Names of the parts that are made again; empty if all are made.
    pub only: Vec<String>,
    /// The structure as built; `None` if the draft was none.
    pub structure: Option<Structure>,
    /// Rigid or flexible.
    pub verdict: Option<Verdict>,
    /// The parts in the order of assembly.
    pub parts: Vec<Part>,
    /// How they go together.
    pub steps: Vec<Step>,
    /// Where parts lie.
    pub layout: Layout,
    /// What the laser does.
    pub sheets: Vec<Sheet>,
    /// The same for the service or machine that the template names.
    pub vendor: Option<VendorSheets>,
}

/// Takes a structure through all stages, as far as they go.
///
/// # Errors
/// [`Stopped`] if the watch stopped the work.
/// ```
/// use finwright::design::examples;
/// use finwright::{fabrication::fabricate, settings::Settings, template};
///
/// let draft = (examples::named("three").unwrap().draft)();
/// let source = template::embedded("pmma-cast-3").unwrap();
/// let settings = Settings::new(template::read(source, "pmma-cast-3").unwrap());
/// let fabrication = fabricate(draft, settings, &mut ()).unwrap();
/// let sheets = fabrication.approved().expect("it is rigid and nothing is wrong");
/// assert!(!finwright::export::dxf(&sheets.get()[0]).is_empty());
/// ```
pub fn fabricate(
    draft: Draft,
    settings: Settings,
    watch: &mut dyn Watch,
) -> Result<Fabrication, Stopped> {
    let mut job = Fabrication::new(settings);
    watch.progress("structure", 0, 1);
    let structure = match Structure::new(draft, &job.settings.tolerance) {
        Ok((structure, findings)) => {
            job.findings = findings;
            structure
        }
        Err(refused) => return Ok(Fabrication { findings: refused.findings, ..job }),
    };
    if let Some(finding) = parts::too_small(&structure, &job.settings.fit) {
        job.findings.push(finding.into());
        return Ok(Fabrication { structure: Some(structure), ..job });
    }
    let no_such_hub = no_such_hub(&structure, &job.settings.hub_nodes);
    job.findings.extend(no_such_hub.map(Finding::from));
    let plan = plan(&structure, &job.settings);
    job.judge(&plan, watch)?;
    blame_gaps(&mut job.findings);
    watch.progress("parts", 0, 1);
    let name = structure.name().to_owned();
    job.cut(plan);
    watch.unless_stopped()?;
    job.lay_on_sheets(name, watch)?;
    Ok(job)
}

/// Takes the coupon of a template through the stages: pieces that tell kerf and clearance.
///
/// # Errors
/// [`Stopped`] if the watch stopped the work.
pub fn coupon(settings: Settings, watch: &mut dyn Watch) -> Result<Fabrication, Stopped> {
    let (fit, bend) = (&settings.fit, &settings.template.bend);
    let radii = [bend.model, bend.long_term].map(|ratio| ratio * fit.thickness);
    let parts = parts::coupon(fit, radii);
    let mut job = Fabrication { parts, ..Fabrication::new(settings) };
    job.lay_on_sheets("coupon".to_owned(), watch)?;
    Ok(job)
}

/// A node that should get a hub and is not there.
fn no_such_hub(structure: &Structure, hub_nodes: &[NodeId]) -> Option<PartFinding> {
    let count = structure.nodes().len();
    let node = hub_nodes.iter().copied().find(|node| node.index() >= count)?;
    Some(PartFinding::NoSuchNode { node, count })
}

impl Fabrication {
    /// Nothing yet.
    pub fn new(settings: Settings) -> Self {
        Self {
            settings,
            findings: Vec::new(),
            only: Vec::new(),
            structure: None,
            verdict: None,
            parts: Vec::new(),
            steps: Vec::new(),
            layout: Layout::default(),
            sheets: Vec::new(),
            vendor: None,
        }
    }

    /// Its parts with their ids.
    pub fn parts_with_ids(&self) -> impl Iterator<Item = (PartId, &Part)> {
        (0..).map(PartId::new).zip(&self.parts)
    }

    /// Whether it has a part of a kind.
    pub fn has(&self, is: impl Fn(&Body) -> bool) -> bool {
        self.parts.iter().any(|part| is(&part.body))
    }

    /// Judges the plan and notes what forbids cutting.
    fn judge(&mut self, plan: &Plan, watch: &mut dyn Watch) -> Result<(), Stopped> {
        match criteria(&plan.structure, &self.settings.template) {
            Ok(criteria) => {
                let verdict = verdict(plan, &self.settings, &criteria, watch)?;
                let accepted = self.settings.accepted_flexible.as_deref();
                self.findings.extend(judged(&verdict, accepted));
                self.verdict = Some(verdict);
            }
            Err(finding) => self.findings.push(finding.into()),
        }
        watch.unless_stopped()
    }

    /// Makes the parts of the plan.
    fn cut(&mut self, plan: Plan) {
        let settings = &self.settings;
        let fits = |outline: &[Point2]| {
            let drawn =
                settings.kerf.compensated(&Contour::polygon(outline.iter().copied()));
            let drawn = drawn.flattened(ARC_SAGITTA_MM);
            let fits = |sheet| nest::fits(&drawn, &settings.rotations, sheet).is_some();
            settings.stock.iter().any(fits)
        };
        let (fit, marking) = (&settings.fit, settings.marking);
        let making = Making { fit, marking, fits: &fits };
        let made = parts::make(&plan, &making);
        self.findings.extend(made.findings);
        let tight = parts::tight_insertions(&plan.structure, &made.parts, fit);
        self.findings.extend(tight.into_iter().map(Finding::from));
        self.structure = Some(plan.structure);
        (self.parts, self.steps) = (made.parts, made.steps);
    }

    /// Nests the parts and says what the laser does; `name` is written on the sheets.
    ///
    /// # Errors
    /// [`Stopped`] if the watch stopped the work.
    pub fn lay_on_sheets(
        &mut self,
        name: String,
        watch: &mut dyn Watch,
    ) -> Result<(), Stopped> {
        self.nest(watch)?;
        watch.progress("sheets", 0, 1);
        let frame = self.settings.frame(name);
        self.sheets = sheets::sheets(&Laying {
            parts: &self.parts,
            layout: &self.layout,
            stock: &self.settings.stock,
            kerf: self.settings.kerf,
            frame: frame.as_ref(),
        });
        self.lay_for_vendor();
        Ok(())
    }

    /// Finds the parts their places, or says why there are none.
    fn nest(&mut self, watch: &mut dyn Watch) -> Result<(), Stopped> {
        let copies = self.parts.iter().enumerate();
        let copies: Vec<usize> =
            copies.flat_map(|(k, part)| std::iter::repeat_n(k, part.quantity)).collect();
        let settings = &self.settings;
        let shapes: Vec<Shape> =
            copies.iter().map(|&k| shape(&self.parts[k], settings)).collect();
        // Parts that cross themselves cannot lie soundly, and that was said of them already.
        let crossing = "parts::outline_crosses_itself";
        let crossing = self.findings.iter().any(|found| found.code == crossing);
        match nest::search(&shapes, &settings.stock, &settings.effort, watch) {
            Ok(found) => {
                watch.unless_stopped()?;
                self.layout = found.layout;
                if let Some(error) = found.unplaced.into_iter().next() {
                    let finding = self.not_placed(error, &shapes, watch);
                    self.findings.push(finding);
                }
            }
            Err(NestError::Stopped(stopped)) => return Err(stopped),
            Err(NestError::Unsound { .. }) if crossing => {}
            Err(error) => self.findings.push(error.into()),
        }
        // From here on a placement means a part; which copy it is, nobody can tell.
        let sheets = self.layout.sheets.iter_mut();
        let placements = sheets.flat_map(|sheet| &mut sheet.placements);
        placements.for_each(|placement| placement.shape = copies[placement.shape]);
        Ok(())
    }

    /// Why not all parts are on sheets. Where the stock is used up, they are laid on as many
    /// sheets as it takes: for the pictures, and to say how many.
    fn not_placed(
        &mut self,
        error: NestError,
        shapes: &[Shape],
        watch: &mut dyn Watch,
    ) -> Finding {
        let used_up = matches!(error, NestError::StockUsedUp { .. });
        let finding = Finding::from(error);
        let endless = |sheet: &Stock| Stock { count: None, ..sheet.clone() };
        let stock: Vec<Stock> = self.settings.stock.iter().map(endless).collect();
        let first = Effort { trials: 1, ..self.settings.effort };
        let all = used_up.then(|| nest::search(shapes, &stock, &first, watch));
        let Some(Ok(all)) = all else { return finding };
        self.layout = all.layout;
        let mut sizes: BTreeMap<usize, usize> = BTreeMap::new();
        self.layout.sheets.iter().for_each(|s| *sizes.entry(s.stock).or_default() += 1);
        let size = |(&kind, count): (&usize, &usize)| {
            let Stock { width, height, .. } = &stock[kind];
            format!("{count} of {width} x {height} mm")
        };
        let sizes = sizes.iter().map(size).collect::<Vec<_>>().join(" and ");
        let help = format!("all parts would take {sizes}: {}", finding.help);
        Finding { help, ..finding }
    }

    /// Makes the sheets for the service that the template names, if it names one.
    fn lay_for_vendor(&mut self) {
        let output = &self.settings.template.output;
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
            stock: &self.settings.stock,
            kerf_mm: self.settings.template.material.kerf_mm,
        };
        let vendor = vendor::vendor_sheets(&request);
        let found = vendor::check(&vendor, &request);
        self.findings.extend(found.into_iter().map(Finding::from));
        self.vendor = Some(vendor);
    }

    /// The sheets, if findings and verdict let them pass; the verdict must be about the
    /// structure and the settings as they stand here.
    ///
    /// # Errors
    /// [`Shut`] says why not.
    pub fn approved(&self) -> Result<Approved<&Vec<Sheet>>, Shut> {
        self.pass(&self.sheets)
    }

    /// The sheets for the vendor, if there are any and they pass.
    pub fn approved_vendor(&self) -> Option<Approved<&VendorSheets>> {
        self.pass(self.vendor.as_ref()?).ok()
    }

    fn pass<T>(&self, work: T) -> Result<Approved<T>, Shut> {
        let structure = self.structure.as_ref().ok_or(Shut::Findings)?;
        let judged = Judged {
            fingerprint: &self.settings.fingerprint(structure),
            verdict: self.verdict.as_ref(),
            accepted: self.settings.accepted_flexible.as_deref(),
        };
        gate::approve(work, &self.findings, judged)
    }
}

/// A part as the nester sees it: the line that will be drawn.
fn shape(part: &Part, settings: &Settings) -> Shape {
    let kerf = settings.kerf;
    let drawn = kerf.compensated(&part.region.outline);
    let outline = drawn.enclosing_polygon(ARC_SAGITTA_MM);
    let holes = part.region.holes.iter();
    let hole = |hole| kerf.compensated(hole).flattened(ARC_SAGITTA_MM);
    let holes = holes.map(hole).collect();
    let rotations = settings.rotations.clone();
    Shape { name: part.id.clone(), outline, holes, rotations, priority: 0 }
}
