//! The sheets of one format: read, scaled back, matched with what is listed.

use crate::drawing::Drawing;
use crate::geometry::Point2;
use crate::manifest::{Manifest, PartEntry};
use crate::proof::finding::{ProofFinding, Spot};
use crate::proof::layout::Laid;
use crate::proof::lines::drawing_findings;
use crate::proof::matching::{Drawn, Found, Matching, Shape, places};
use crate::proof::shape::bounds;
use crate::tolerance::{ARC_SAGITTA_MM, IN_PLACE_MM, SAME_SCALE};
use std::collections::{BTreeMap, BTreeSet};

/// The files of one format.
pub(super) struct Files {
    pub format: &'static str,
    /// Path and drawing of each sheet; `None` if there is none to read.
    pub sheets: Vec<(String, Option<Drawing>)>,
}

/// The files of one format with the parts found in them.
pub(super) struct Read<'a> {
    pub manifest: &'a Manifest,
    pub files: Files,
    pub matching: Matching<'a>,
    pub found: Vec<Found>,
    /// Contours that are no part, by index.
    pub(super) left_over: Vec<usize>,
    pub(super) scale: f64,
}

/// Factors that confusion of units gives, most usual first.
const UNIT_FACTORS: [f64; 8] =
    [25.4, 1.0 / 25.4, 10.0, 0.1, 1000.0, 0.001, 72.0 / 25.4, 25.4 / 72.0];

impl<'a> Read<'a> {
    pub(super) fn new(manifest: &'a Manifest, mut files: Files) -> Self {
        let shapes: Vec<Shape> = manifest.parts.iter().map(Shape::new).collect();
        let places = places(manifest);
        let kerf = manifest.material.kerf;
        let mut matching = Matching { shapes, places, drawn: Vec::new(), kerf };
        let scale = scale(&matching, &outlines(&files));
        if let Some(scale) = scale {
            let drawings = files.sheets.iter_mut().filter_map(|sheet| sheet.1.as_mut());
            for vertex in
                drawings.flat_map(|d| &mut d.curves).flat_map(|c| &mut c.vertices)
            {
                vertex.point /= scale;
            }
        }
        matching.drawn = outlines(&files);
        let found = matching.found();
        let used: BTreeSet<usize> = found.iter().map(|found| found.drawn).collect();
        let left_over = (0..matching.drawn.len()).filter(|k| !used.contains(k)).collect();
        let scale = scale.unwrap_or(1.0);
        Self { manifest, files, matching, found, left_over, scale }
    }

    /// The file in which a part was found.
    pub(super) fn file(&self, found: &Found) -> &str {
        &self.files.sheets[self.matching.drawn[found.drawn].sheet].0
    }

    pub(super) fn id(&self, found: &Found) -> &'a str {
        let part: &'a PartEntry =
            self.matching.shapes[self.matching.places[found.place].shape].part;
        &part.id
    }

    pub(super) fn spot(&self, found: &Found) -> Spot {
        let [low, high] = self.matching.drawn[found.drawn].bounds;
        Spot::file(self.file(found))
            .part(self.id(found))
            .at(nalgebra::center(&low, &high))
    }

    /// Everything about the sheets as drawings.
    pub(super) fn findings(&self) -> Vec<ProofFinding> {
        let mut findings = Vec::new();
        for (file, drawing) in &self.files.sheets {
            let Some(drawing) = drawing else { continue };
            findings.extend(drawing_findings(file, drawing, self.files.format));
        }
        if self.scale.to_bits() != 1.0_f64.to_bits() {
            let file = self.files.sheets.first().map_or("", |sheet| &sheet.0);
            let parts =
                self.found.iter().map(|found| self.id(found).to_owned()).collect();
            let spot = Spot { parts, ..Spot::file(file) };
            findings.push(ProofFinding::Scaled { spot, factor: self.scale });
        }
        findings.extend(self.missing());
        findings.extend(self.found.iter().flat_map(|found| self.misplaced(found)));
        findings.extend(self.kerfs());
        findings.extend(self.extra_lines());
        findings.extend(self.holes());
        findings.extend(self.labels());
        for sheet in 0..self.files.sheets.len() {
            findings.extend(self.layout(sheet));
        }
        findings
    }

    /// Parts that are not there; where most of a sheet's are not, the sheet is another one.
    fn missing(&self) -> Vec<ProofFinding> {
        let there: BTreeSet<usize> = self.found.iter().map(|found| found.place).collect();
        let mut findings = Vec::new();
        for (sheet, (file, drawing)) in self.files.sheets.iter().enumerate() {
            if drawing.is_none() {
                continue;
            }
            let places = self.matching.places.iter().enumerate();
            let listed: Vec<_> =
                places.filter(|(_, place)| place.sheet == sheet).collect();
            let missing: Vec<_> =
                listed.iter().filter(|(k, _)| !there.contains(k)).collect();
            let name = |place: &crate::proof::matching::Place| {
                self.matching.shapes[place.shape].part.id.clone()
            };
            if 2 * missing.len() > listed.len() {
                let parts = missing.iter().map(|(_, place)| name(place)).collect();
                let spot = Spot { parts, ..Spot::file(file) };
                let (missing, listed) = (missing.len(), listed.len());
                findings.push(ProofFinding::OtherJob { spot, missing, listed });
                continue;
            }
            findings.extend(missing.iter().map(|(_, place)| {
                let outline = &self.matching.shapes[place.shape].part.outline;
                let [low, high] = bounds(outline.iter().map(|p| place.motion.apply(*p)));
                let at = nalgebra::center(&low, &high);
                let spot = Spot::file(file).part(&name(place)).at(at);
                ProofFinding::PartMissing { spot }
            }));
        }
        findings
    }

    /// How far a part lies from where it is listed, mm; infinity on another sheet.
    pub(super) fn moved(&self, found: &Found) -> f64 {
        let place = &self.matching.places[found.place];
        if self.matching.drawn[found.drawn].sheet != place.sheet || found.is_mirrored {
            return f64::INFINITY;
        }
        let outline = &self.matching.shapes[place.shape].part.outline;
        found.motion.apart(&place.motion, outline)
    }

    fn misplaced(&self, found: &Found) -> Option<ProofFinding> {
        let spot = self.spot(found);
        if found.is_mirrored {
            return Some(ProofFinding::PartMirrored { spot });
        }
        let by_mm = self.moved(found);
        if by_mm <= IN_PLACE_MM {
            return None;
        }
        let drawn = &self.matching.drawn[found.drawn];
        let middle = nalgebra::center(&drawn.bounds[0], &drawn.bounds[1]);
        let others = self.matching.places.iter().enumerate();
        let mut others =
            others.filter(|(k, place)| *k != found.place && place.sheet == drawn.sheet);
        // Another part lies here by the list, and does not by the drawing.
        let over = others.find(|(k, place)| {
            let outline = &self.matching.shapes[place.shape].part.outline;
            let [low, high] = bounds(outline.iter().map(|p| place.motion.apply(*p)));
            let is_here = (nalgebra::center(&low, &high) - middle).norm()
                < (high - low).norm() / 10.0;
            let away = self.found.iter().find(|other| other.place == *k);
            is_here && away.is_none_or(|other| self.moved(other) > IN_PLACE_MM)
        });
        Some(match over {
            Some((_, place)) => {
                let other = self.matching.shapes[place.shape].part.id.clone();
                ProofFinding::PartsSwapped { spot, other }
            }
            None => ProofFinding::PartMoved { spot, by_mm: finite(by_mm) },
        })
    }

    /// Kerfs that are not the listed one: together, if they are equal all over a file.
    fn kerfs(&self) -> Vec<ProofFinding> {
        let listed_mm = self.matching.kerf;
        let limit_mm = self.manifest.proof.limits.axes_and_slits_mm;
        let mut wrong: BTreeMap<(String, i64), Vec<&Found>> = BTreeMap::new();
        for found in &self.found {
            if (found.kerf - listed_mm).abs() > limit_mm {
                let key =
                    (self.file(found).to_owned(), (found.kerf * 1e3).round() as i64);
                wrong.entry(key).or_default().push(found);
            }
        }
        let finding = |((file, kerf), all): ((String, i64), Vec<&Found>)| {
            let parts = all.iter().map(|found| self.id(found).to_owned()).collect();
            let at = self.spot(all[0]).at;
            let spot = Spot { parts, at, ..Spot::file(&file) };
            ProofFinding::KerfWrong { spot, kerf_mm: kerf as f64 / 1e3, listed_mm }
        };
        wrong.into_iter().map(finding).collect()
    }

    /// Spacing and margin on one sheet, for the stock of its size.
    fn layout(&self, sheet: usize) -> Vec<ProofFinding> {
        let listed = &self.manifest.sheets[sheet];
        let same = |a: f64, b: f64| (a - b).abs() < IN_PLACE_MM;
        let stock = self.manifest.sheet_stock.iter();
        let stock = stock
            .filter(|s| same(s.width, listed.width) && same(s.height, listed.height));
        let stock = stock.min_by(|a, b| {
            a.margin.total_cmp(&b.margin).then(a.spacing.total_cmp(&b.spacing))
        });
        let Some(stock) = stock else { return Vec::new() };
        let here = self.found.iter();
        let here = here.filter(|found| self.matching.drawn[found.drawn].sheet == sheet);
        let rings = here.map(|found| {
            let contour = &self.matching.drawn[found.drawn].contour;
            (self.id(found).to_owned(), contour.flattened(ARC_SAGITTA_MM))
        });
        let rings = rings.collect();
        Laid { file: &self.files.sheets[sheet].0, rings, stock }.findings()
    }
}

/// Beyond reach a distance is not known, but at least that much.
pub(super) fn finite(mm: f64) -> f64 {
    if mm.is_finite() { mm } else { crate::tolerance::PROOF_REACH_MM }
}

/// The closed outlines of all sheets.
fn outlines(files: &Files) -> Vec<Drawn> {
    let sheets = files.sheets.iter().enumerate();
    let curves = sheets.flat_map(|(sheet, (_, drawing))| {
        let curves = drawing.iter().flat_map(|drawing| &drawing.curves);
        curves.map(move |curve| (sheet, curve))
    });
    let outer = curves.filter(|(_, curve)| curve.closed && curve.layer == "CUT_OUTER");
    outer.map(|(sheet, curve)| Drawn::new(sheet, curve.contour())).collect()
}

/// How much too large everything is drawn, if it is: by the extent of all cut lines, else
/// by their middle size, if that is a known confusion of units.
fn scale(matching: &Matching, drawn: &[Drawn]) -> Option<f64> {
    let listed = matching.places.iter().filter(|place| place.sheet == 0).map(|place| {
        let outline = &matching.shapes[place.shape].part.outline;
        bounds(outline.iter().map(|p| place.motion.apply(*p)))
    });
    let listed: Vec<[Point2; 2]> = listed.collect();
    let drawn: Vec<[Point2; 2]> =
        drawn.iter().filter(|drawn| drawn.sheet == 0).map(|drawn| drawn.bounds).collect();
    let middle = |boxes: &[[Point2; 2]]| {
        let mut sizes: Vec<f64> =
            boxes.iter().map(|[low, high]| (high - low).norm()).collect();
        sizes.sort_by(f64::total_cmp);
        sizes.get(sizes.len() / 2).copied()
    };
    let extent = |boxes: &[[Point2; 2]]| {
        let [low, high] = bounds(boxes.iter().flatten().copied());
        high - low
    };
    let ratio = middle(&drawn)? / middle(&listed)?;
    let known =
        |ratio: f64| UNIT_FACTORS.into_iter().find(|f| (ratio / f - 1.0).abs() < 0.1);
    let (wide, high) = {
        let (drawn, listed) = (extent(&drawn), extent(&listed));
        let kerf = matching.kerf;
        (drawn.x / (listed.x + kerf), drawn.y / (listed.y + kerf))
    };
    let even = drawn.len() == listed.len() && (wide / high - 1.0).abs() < SAME_SCALE;
    match known(ratio) {
        Some(factor) => Some(factor),
        None if even && (wide - 1.0).abs() > SAME_SCALE => Some((wide + high) / 2.0),
        None => None,
    }
}
