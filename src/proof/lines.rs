//! Lines that are no part's outline: drawn twice, open, holes, and what differs between
//! formats.

use crate::drawing::{Curve, Drawing, is_cut};
use crate::export::LAYERS;
use crate::geometry::Contour;
use crate::geometry::predicates::contains;
use crate::proof::finding::{ProofFinding, Spot};
use crate::proof::kerf::without_kerf;
use crate::proof::matching::Found;
use crate::proof::shape::Edges;
use crate::proof::sheets::{Read, finite};
use crate::tolerance::{ARC_SAGITTA_MM, IN_PLACE_MM, SAME_SHAPE_MM};

impl Read<'_> {
    /// Lines beside those of the parts: drawn twice, open, or of nothing known.
    pub(super) fn extra_lines(&self) -> Vec<ProofFinding> {
        let mut findings = Vec::new();
        for (sheet, (file, drawing)) in self.files.sheets.iter().enumerate() {
            let Some(drawing) = drawing else { continue };
            let mine = || {
                let found = self.found.iter();
                found.filter(move |found| self.matching.drawn[found.drawn].sheet == sheet)
            };
            let edges: Vec<(&str, Edges)> = mine()
                .map(|found| {
                    let drawn = &self.matching.drawn[found.drawn].contour;
                    (self.id(found), Edges::new([drawn.flattened(ARC_SAGITTA_MM)]))
                })
                .collect();
            let left = self.left_over.iter().map(|&k| &self.matching.drawn[k]);
            let left = left.filter(|drawn| drawn.sheet == sheet);
            let left = left.map(|drawn| (drawn.contour.clone(), true));
            let open = drawing.curves.iter().filter(|c| is_cut(c.layer) && !c.closed);
            let open = open.chain(&drawing.doubled).map(|c| (c.contour(), false));
            for (line, closed) in left.chain(open) {
                let at = line.vertices[0].point;
                let length_mm = line_length(&line, closed);
                let over = edges.iter().find(|(_, edges)| lies_on(&line, closed, edges));
                let spot = Spot::file(file).at(at);
                findings.push(match (over, closed) {
                    (Some((part, _)), _) => {
                        ProofFinding::DoubledLine { spot: spot.part(part), length_mm }
                    }
                    (None, true) => ProofFinding::UnknownContour { spot },
                    (None, false) => ProofFinding::OpenLine { spot, length_mm },
                });
            }
        }
        findings
    }

    /// The holes drawn in a part, on the sheet, clockwise, kerf undone.
    pub(super) fn holes_of(&self, found: &Found) -> Vec<Contour> {
        let drawn = &self.matching.drawn[found.drawn];
        let Some(drawing) = &self.files.sheets[drawn.sheet].1 else { return Vec::new() };
        let hull = drawn.contour.flattened(ARC_SAGITTA_MM);
        let inner = drawing.curves.iter().filter(|c| c.layer == "CUT_INNER" && c.closed);
        let inner = inner.filter(|c| contains(&hull, c.vertices[0].point));
        inner
            .map(|hole| {
                let contour = hole.contour();
                let ccw = contour.signed_area() > 0.0;
                let contour = if ccw { contour.reversed() } else { contour };
                // Drawn clockwise, a hole grows back by what its line was drawn inside.
                without_kerf(&contour, found.kerf)
            })
            .collect()
    }

    /// Holes that are drawn in a part against those listed.
    pub(super) fn holes(&self) -> Vec<ProofFinding> {
        let mut findings = Vec::new();
        for found in &self.found {
            let shape = &self.matching.shapes[self.matching.places[found.place].shape];
            let inner = self.holes_of(found);
            let listed = shape.part.holes.len();
            if inner.len() != listed {
                let (spot, found) = (self.spot(found), inner.len());
                findings.push(ProofFinding::HolesDiffer { spot, found, listed });
            }
            for nominal in inner {
                let off = nominal
                    .vertices
                    .iter()
                    .map(|v| (shape.edges.distance(found.motion.back(v.point)), v.point));
                let worst = off.max_by(|a, b| a.0.total_cmp(&b.0));
                if let Some((by_mm, at)) = worst.filter(|w| w.0 > SAME_SHAPE_MM) {
                    let spot = self.spot(found).at(at);
                    findings.push(ProofFinding::OutlineDiffers {
                        spot,
                        by_mm: finite(by_mm),
                    });
                }
            }
        }
        findings
    }
}

fn line_length(line: &Contour, closed: bool) -> f64 {
    let steps = line.vertices.len() - usize::from(!closed);
    line.segments().take(steps).map(|segment| segment.length()).sum()
}

/// Whether a line runs along edges all its way: corners and the middles between them.
fn lies_on(line: &Contour, closed: bool, edges: &Edges) -> bool {
    let steps = line.vertices.len() - usize::from(!closed);
    line.segments().take(steps).all(|s| {
        let middle = nalgebra::center(&s.from, &s.to);
        let straight = s.bulge == 0.0;
        [Some(s.from), Some(s.to), straight.then_some(middle)]
            .into_iter()
            .flatten()
            .all(|p| edges.distance(p) <= SAME_SHAPE_MM)
    })
}

/// What a drawing says of itself.
pub(super) fn drawing_findings(
    file: &str,
    drawing: &Drawing,
    format: &str,
) -> Vec<ProofFinding> {
    let mut findings = Vec::new();
    if !drawing.says_unit && format != "pdf" {
        findings.push(ProofFinding::UnitMissing { spot: Spot::file(file) });
    }
    for ((kind, layer), count) in &drawing.unread {
        let (kind, layer, count) = (kind.clone(), (*layer).to_owned(), *count);
        let spot = Spot::file(file);
        findings.push(ProofFinding::UnreadEntity { spot, kind, layer, count });
    }
    let lines = drawing.curves.iter().filter(|curve| curve.layer.is_empty()).count();
    if lines > 0 {
        findings.push(ProofFinding::UnknownLayer { spot: Spot::file(file), lines });
    }
    findings
}

/// What differs between two formats: lengths of layers and places of parts.
pub(super) fn differences(first: &Read, other: &Read) -> Vec<ProofFinding> {
    let mut findings = Vec::new();
    let sheets = first.files.sheets.iter().zip(&other.files.sheets);
    for ((_, a), (file, b)) in sheets {
        let (Some(a), Some(b)) = (a, b) else { continue };
        for layer in LAYERS.iter().filter(|layer| layer.operation.is_some()) {
            let length = |drawing: &Drawing| -> f64 {
                let curves = drawing.curves.iter();
                curves.filter(|c| c.layer == layer.name).map(Curve::length).sum()
            };
            let (a, b) = (length(a), length(b));
            if (a - b).abs() > crate::tolerance::SAME_LENGTH * a.max(b).max(1.0) {
                let what = format!("the length of all lines on {}", layer.name);
                let spot = Spot::file(file);
                findings.push(ProofFinding::FormatsDiffer {
                    spot,
                    what,
                    by: (b - a).abs(),
                });
            }
        }
    }
    for found in &other.found {
        let twin = first.found.iter().find(|twin| twin.place == found.place);
        let Some(twin) = twin.filter(|twin| !twin.is_mirrored && !found.is_mirrored)
        else {
            continue;
        };
        let shape = &first.matching.shapes[first.matching.places[found.place].shape];
        let by = twin.motion.apart(&found.motion, &shape.part.outline);
        if by > IN_PLACE_MM {
            let (spot, what) = (other.spot(found), "the place of the part".to_owned());
            findings.push(ProofFinding::FormatsDiffer { spot, what, by });
        }
    }
    findings
}
