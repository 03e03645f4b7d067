//! Which drawn contour is which part: by shape, rigidly, without mirroring.
//!
//! First each part is looked for where it is listed. What is not there is looked for among
//! the contours left over: an edge of the part is laid on an edge of equal length, and the
//! motion under which most corners agree is the part's place. A part only found turned
//! over is named as mirrored. Corners that do not agree (a slit that was moved) do not
//! hide a part: four tenths of them are enough.

use crate::geometry::{Contour, Point2, Vector2};
use crate::manifest::{Manifest, PartEntry};
use crate::proof::kerf::without_kerf;
use crate::proof::shape::{Edges, Motion, bounds};
use crate::tolerance::{ARC_SAGITTA_MM, PROOF_REACH_MM, SAME_SHAPE_MM};

/// Share of the corners that must agree.
const ENOUGH: f64 = 0.4;

/// Share above which no better match is looked for.
const SURE: f64 = 0.99;

/// One corner in so many is asked first whether a way to lay a part is worth the others.
const SAMPLE: usize = 12;

/// A part as listed.
pub(super) struct Shape<'a> {
    pub part: &'a PartEntry,
    /// Edges of the outline and of the holes.
    pub edges: Edges,
    /// Corners of the outline and of the holes.
    corners: Edges,
    area: f64,
    length: f64,
}

impl<'a> Shape<'a> {
    pub(super) fn new(part: &'a PartEntry) -> Self {
        let rings = || std::iter::once(&part.outline).chain(&part.holes);
        let outline = Contour::polygon(part.outline.iter().copied());
        Self {
            part,
            edges: Edges::new(rings()),
            corners: Edges::of_points(rings().flatten().copied()),
            area: outline.signed_area().abs(),
            length: outline.length(),
        }
    }

    /// Share of the corners of a contour, in part coordinates, that lie on the outline.
    fn agreement(&self, corners: &[Point2]) -> f64 {
        let on = corners.iter().filter(|p| self.edges.distance(**p) <= SAME_SHAPE_MM);
        on.count() as f64 / corners.len().max(1) as f64
    }
}

/// Where a copy of a part is listed.
pub(super) struct Place {
    pub shape: usize,
    pub copy: usize,
    pub sheet: usize,
    pub motion: Motion,
}

/// A contour of a sheet as it was drawn, counter-clockwise.
pub(super) struct Drawn {
    pub sheet: usize,
    pub contour: Contour,
    pub bounds: [Point2; 2],
    area: f64,
}

impl Drawn {
    pub(super) fn new(sheet: usize, contour: Contour) -> Self {
        let area = contour.signed_area();
        let contour = if area < 0.0 { contour.reversed() } else { contour };
        // Arcs may reach farther than their ends: a disc has four corners only.
        let bounds = bounds(contour.flattened(ARC_SAGITTA_MM));
        Self { sheet, contour, bounds, area: area.abs() }
    }
}

/// A part that was found.
pub(super) struct Found {
    /// Which of the places listed.
    pub place: usize,
    /// Which of the contours drawn.
    pub drawn: usize,
    /// From part to sheet coordinates.
    pub motion: Motion,
    /// The kerf that is in the drawn line.
    pub kerf: f64,
    pub is_mirrored: bool,
    /// Its outline in part coordinates, kerf undone.
    pub outline: Contour,
}

/// What is matched.
pub(super) struct Matching<'a> {
    pub shapes: Vec<Shape<'a>>,
    pub places: Vec<Place>,
    pub drawn: Vec<Drawn>,
    pub kerf: f64,
}

/// All placements of a manifest that name a part.
pub(super) fn places(manifest: &Manifest) -> Vec<Place> {
    let named = |id: &str| manifest.parts.iter().position(|part| part.id == id);
    let sheets = manifest.sheets.iter().enumerate();
    let all = sheets.flat_map(|(sheet, listed)| {
        listed.placements.iter().filter_map(move |p| {
            let motion = Motion::new(p.angle_deg.to_radians(), Vector2::new(p.x, p.y));
            Some(Place { shape: named(&p.part)?, copy: p.copy, sheet, motion })
        })
    });
    all.collect()
}

impl Matching<'_> {
    /// The parts found, in the order of the places listed.
    pub(super) fn found(&self) -> Vec<Found> {
        let mut free = vec![true; self.drawn.len()];
        let mut found: Vec<Found> = Vec::new();
        let take = |hit: Option<Found>, free: &mut Vec<bool>, found: &mut Vec<Found>| {
            if let Some(hit) = hit {
                free[hit.drawn] = false;
                found.push(hit);
            }
        };
        for place in 0..self.places.len() {
            take(self.in_place(place, &free), &mut free, &mut found);
        }
        for mirrored in [false, true] {
            for place in 0..self.places.len() {
                if found.iter().all(|hit| hit.place != place) {
                    take(self.elsewhere(place, &free, mirrored), &mut free, &mut found);
                }
            }
        }
        found.sort_by_key(|hit| hit.place);
        found
    }

    /// A part where it is listed.
    fn in_place(&self, place: usize, free: &[bool]) -> Option<Found> {
        let listed = &self.places[place];
        let shape = &self.shapes[listed.shape];
        let [low, high] =
            bounds(shape.part.outline.iter().map(|p| listed.motion.apply(*p)));
        let near = |drawn: &Drawn| {
            let low_off = (drawn.bounds[0] - low).abs().max();
            drawn.sheet == listed.sheet
                && low_off.max((drawn.bounds[1] - high).abs().max())
                    < 4.0 * PROOF_REACH_MM
        };
        let near = (0..self.drawn.len()).filter(|&k| free[k] && near(&self.drawn[k]));
        let hits = near.filter_map(|drawn| {
            let hit = Try { shape, drawn: &self.drawn[drawn], is_mirrored: false };
            let kerfs = self.kerfs(shape, &self.drawn[drawn]);
            let (kerf, share) = best(kerfs, |kerf| hit.agreement(kerf, &listed.motion))?;
            let (outline, motion) = hit.settled(kerf, listed.motion);
            (share >= ENOUGH).then_some((
                share,
                Found { place, drawn, motion, kerf, is_mirrored: false, outline },
            ))
        });
        hits.max_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, found)| found)
    }

    /// A part among all contours that are still free: of those that agree all over the one
    /// nearest to where it is listed, else the one that agrees best.
    fn elsewhere(&self, place: usize, free: &[bool], is_mirrored: bool) -> Option<Found> {
        let listed = &self.places[place];
        let shape = &self.shapes[listed.shape];
        let [low, high] =
            bounds(shape.part.outline.iter().map(|p| listed.motion.apply(*p)));
        let home = nalgebra::center(&low, &high);
        let away = |&k: &usize| {
            let [low, high] = self.drawn[k].bounds;
            let other_sheet = self.drawn[k].sheet != listed.sheet;
            (other_sheet, (nalgebra::center(&low, &high) - home).norm())
        };
        let like = |drawn: &Drawn| (drawn.area / shape.area - 1.0).abs() < 0.1;
        let mut like: Vec<usize> =
            (0..self.drawn.len()).filter(|&k| free[k] && like(&self.drawn[k])).collect();
        like.sort_by(|a, b| {
            let (a, b) = (away(a), away(b));
            a.0.cmp(&b.0).then(a.1.total_cmp(&b.1))
        });
        let mut best: Option<(f64, Found)> = None;
        for drawn in like {
            let hit = Try { shape, drawn: &self.drawn[drawn], is_mirrored };
            for kerf in self.kerfs(shape, &self.drawn[drawn]) {
                let Some((share, motion)) = hit.laid(kerf) else { continue };
                if share < ENOUGH || best.as_ref().is_some_and(|(most, _)| share <= *most)
                {
                    continue;
                }
                let (outline, motion) = hit.settled(kerf, motion);
                let found = Found { place, drawn, motion, kerf, is_mirrored, outline };
                if share > SURE {
                    return Some(found);
                }
                best = Some((share, found));
            }
        }
        best.map(|(_, found)| found)
    }

    /// Kerfs that may be in a line: the listed one, the other way, none, or what the area
    /// says.
    fn kerfs(&self, shape: &Shape, drawn: &Drawn) -> Vec<f64> {
        let by_area = 2.0 * (drawn.area - shape.area) / shape.length;
        let kerfs = [self.kerf, -self.kerf, 0.0, by_area];
        kerfs.into_iter().filter(|kerf| kerf.abs() < 2.0 * PROOF_REACH_MM).collect()
    }
}

/// The value with the greatest share; the first of equal ones.
fn best(values: Vec<f64>, share: impl Fn(f64) -> f64) -> Option<(f64, f64)> {
    let mut best: Option<(f64, f64)> = None;
    for value in values {
        let share = share(value);
        if best.is_none_or(|(_, most)| share > most) {
            best = Some((value, share));
        }
        if share > SURE {
            break;
        }
    }
    best
}

/// A part laid on a contour.
struct Try<'a> {
    shape: &'a Shape<'a>,
    drawn: &'a Drawn,
    is_mirrored: bool,
}

impl Try<'_> {
    /// The drawn contour without its kerf; turned over, if that is tried.
    fn without_kerf(&self, kerf: f64) -> Contour {
        let contour = without_kerf(&self.drawn.contour, kerf);
        if !self.is_mirrored {
            return contour;
        }
        contour.reversed().moved(|p| Point2::new(-p.x, p.y))
    }

    fn agreement(&self, kerf: f64, motion: &Motion) -> f64 {
        self.shape.agreement(&self.local(kerf, motion))
    }

    fn local(&self, kerf: f64, motion: &Motion) -> Vec<Point2> {
        let contour = self.without_kerf(kerf);
        contour.vertices.iter().map(|vertex| motion.back(vertex.point)).collect()
    }

    /// The best way to lay long edges of the part on edges of equal length.
    fn laid(&self, kerf: f64) -> Option<(f64, Motion)> {
        let contour = self.without_kerf(kerf);
        let mut own: Vec<[Point2; 2]> = sides(&self.shape.part.outline);
        own.sort_by(|a, b| (b[1] - b[0]).norm().total_cmp(&(a[1] - a[0]).norm()));
        let drawn: Vec<Point2> = contour.vertices.iter().map(|v| v.point).collect();
        let mut best: Option<(f64, Motion)> = None;
        for side in own.iter().take(LONG_EDGES) {
            let length = (side[1] - side[0]).norm();
            let equal =
                |s: &[Point2; 2]| ((s[1] - s[0]).norm() - length).abs() < SAME_SHAPE_MM;
            for other in sides(&drawn).into_iter().filter(equal) {
                let motion = Motion::between(*side, other);
                let back = |p: &Point2| motion.back(*p);
                let few: Vec<Point2> = drawn.iter().step_by(SAMPLE).map(back).collect();
                if self.shape.agreement(&few) < ENOUGH / 2.0 {
                    continue;
                }
                let corners: Vec<Point2> = drawn.iter().map(back).collect();
                let share = self.shape.agreement(&corners);
                if best.is_none_or(|(most, _)| share > most) {
                    best = Some((share, motion));
                }
                if share > SURE {
                    return best;
                }
            }
        }
        best
    }

    /// The contour in part coordinates, and the motion that fits its corners best.
    fn settled(&self, kerf: f64, start: Motion) -> (Contour, Motion) {
        let contour = self.without_kerf(kerf);
        let mut motion = start;
        for _ in 0..2 {
            let pairs = contour.vertices.iter().filter_map(|vertex| {
                let (off, corner) =
                    self.shape.corners.nearest(motion.back(vertex.point))?;
                (off <= SAME_SHAPE_MM).then_some((corner, vertex.point))
            });
            motion = Motion::fitted(&pairs.collect::<Vec<_>>()).unwrap_or(motion);
        }
        (contour.moved(|p| motion.back(p)), motion)
    }
}

/// How many of a part's longest edges are tried.
const LONG_EDGES: usize = 6;

fn sides(ring: &[Point2]) -> Vec<[Point2; 2]> {
    let next = ring.iter().cycle().skip(1);
    ring.iter().zip(next).map(|(a, b)| [*a, *b]).collect()
}
