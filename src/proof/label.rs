//! Which name is lettered on a part: the font's own strokes found again, in any size and
//! turn, but not mirrored.

use crate::geometry::predicates::contains;
use crate::geometry::{Point2, Vector2};
use crate::lettering::letter;
use crate::manifest::PartEntry;
use crate::proof::finding::ProofFinding;
use crate::proof::shape::Edges;
use crate::proof::sheets::Read;
use crate::tolerance::{ARC_SAGITTA_MM, SAME_SHAPE_MM};

/// The marks on one part.
pub(super) struct Marks {
    strokes: Vec<Vec<Point2>>,
    corners: Edges,
}

impl Marks {
    pub(super) fn new(strokes: Vec<Vec<Point2>>) -> Self {
        let corners = Edges::of_points(strokes.iter().flatten().copied());
        Self { strokes, corners }
    }

    /// The same marks seen from behind.
    pub(super) fn mirrored(&self) -> Self {
        let behind = |p: &Point2| Point2::new(-p.x, p.y);
        let strokes = self.strokes.iter().map(|s| s.iter().map(behind).collect());
        Self::new(strokes.collect())
    }

    /// Whether the text is among the marks.
    pub(super) fn read(&self, text: &str) -> bool {
        let Ok(lettering) = letter(text, 1.0) else { return false };
        let length = |s: &[Point2]| (s[1] - s[0]).norm();
        let sides = lettering.strokes.iter().flat_map(|stroke| {
            stroke.windows(2).enumerate().map(move |(k, side)| (stroke.len(), k, side))
        });
        // The longest side of the text tells size and turn best.
        let longest = sides.max_by(|a, b| length(a.2).total_cmp(&length(b.2)));
        let Some((count, k, side)) = longest else { return false };
        let alike = self.strokes.iter().filter(|stroke| stroke.len() == count);
        alike.into_iter().any(|stroke| {
            let seen = [stroke[k], stroke[k + 1]];
            length(&seen) > 0.0 && self.fits(&lettering.strokes, [side[0], side[1]], seen)
        })
    }

    /// Whether all strokes of the text are strokes of the marks, once its side `from` is
    /// laid on `to`. Corners alone would not do: those of a 3 are corners of an 8.
    fn fits(&self, text: &[Vec<Point2>], from: [Point2; 2], to: [Point2; 2]) -> bool {
        let (a, b) = (from[1] - from[0], to[1] - to[0]);
        let turn = Vector2::new(a.dot(&b), a.perp(&b)) / a.norm_squared();
        let place = |p: &Point2| {
            let p = p - from[0];
            let q =
                Vector2::new(turn.x * p.x - turn.y * p.y, turn.y * p.x + turn.x * p.y);
            to[0] + q
        };
        let text: Vec<Vec<Point2>> =
            text.iter().map(|stroke| stroke.iter().map(place).collect()).collect();
        text.iter().flatten().all(|p| self.corners.distance(*p) <= SAME_SHAPE_MM)
            && text.iter().all(|stroke| self.strokes.iter().any(|own| same(own, stroke)))
    }
}

/// Whether two strokes have the same corners, in either direction.
fn same(a: &[Point2], b: &[Point2]) -> bool {
    let near = |(p, q): (&Point2, &Point2)| (p - q).norm() <= SAME_SHAPE_MM;
    a.len() == b.len()
        && (a.iter().zip(b).all(near) || a.iter().zip(b.iter().rev()).all(near))
}

impl Read<'_> {
    /// Parts that bear the name of another one, or their own from behind: a part that is its
    /// own mirror image can be told by nothing else.
    pub(super) fn labels(&self) -> Vec<ProofFinding> {
        let mut findings = Vec::new();
        let mut marks: Vec<Vec<Vec<Point2>>> = vec![Vec::new(); self.found.len()];
        let hulls: Vec<(usize, [Point2; 2], Vec<Point2>)> = self
            .found
            .iter()
            .map(|found| {
                let drawn = &self.matching.drawn[found.drawn];
                (drawn.sheet, drawn.bounds, drawn.contour.flattened(ARC_SAGITTA_MM))
            })
            .collect();
        for (sheet, (_, drawing)) in self.files.sheets.iter().enumerate() {
            let curves = drawing.iter().flat_map(|drawing| &drawing.curves);
            for curve in curves.filter(|curve| curve.layer == "ENGRAVE") {
                let p = curve.vertices[0].point;
                let inside = (0..hulls.len()).filter(|&k| {
                    let (on, [low, high], hull) = &hulls[k];
                    let boxed =
                        low.x <= p.x && p.x <= high.x && low.y <= p.y && p.y <= high.y;
                    *on == sheet && boxed && contains(hull, p)
                });
                // Where parts lie over each other, marks are those of the one in its place.
                let moved = |k: &usize| self.moved(&self.found[*k]);
                let inside = inside.min_by(|a, b| moved(a).total_cmp(&moved(b)));
                if let Some(owner) = inside {
                    let home = curve.closed.then(|| curve.vertices[0]);
                    let corners = curve.vertices.iter().chain(&home);
                    marks[owner].push(corners.map(|v| v.point).collect());
                }
            }
        }
        let names: Vec<[String; 2]> = self.manifest.parts.iter().map(lettered).collect();
        for (found, strokes) in self.found.iter().zip(marks) {
            let marks = Marks::new(strokes);
            let own = self.matching.places[found.place].shape;
            if names[own].iter().any(|text| marks.read(text)) {
                continue;
            }
            if !found.is_mirrored
                && names[own].iter().any(|text| marks.mirrored().read(text))
            {
                findings.push(ProofFinding::PartMirrored { spot: self.spot(found) });
                continue;
            }
            let other = (0..names.len()).find(|&k| k != own && marks.read(&names[k][0]));
            if let Some(other) = other {
                let (spot, reads) =
                    (self.spot(found), self.manifest.parts[other].id.clone());
                findings.push(ProofFinding::WrongLabel { spot, reads });
            }
        }
        findings
    }
}

/// The texts a part may be lettered with, the surer one first: strips have an arrow behind
/// their name.
fn lettered(part: &PartEntry) -> [String; 2] {
    let label = if part.label.is_empty() { &part.id } else { &part.label };
    let arrow = format!("{label}\u{2191}");
    if part.run().is_some() { [arrow, label.clone()] } else { [label.clone(), arrow] }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_name_is_read_in_any_size_and_turn_but_not_from_behind() {
        let place = |p: &Point2| Point2::new(300.0 - p.y, 20.0 + p.x);
        let strokes = letter("S03\u{2191}", 2.4).unwrap().strokes;
        let turned = strokes.iter().map(|s| s.iter().map(place).collect()).collect();
        let marks = Marks::new(turned);
        assert!(marks.read("S03\u{2191}"));
        assert!(!marks.read("S08\u{2191}"));
        let eight = letter("S08\u{2191}", 2.4).unwrap().strokes;
        assert!(!Marks::new(eight).read("S03\u{2191}"));
        assert!(!marks.mirrored().read("S03\u{2191}"));
        assert!(marks.mirrored().mirrored().read("S03\u{2191}"));
    }
}
