//! A surface that is its own mirror image: one sector is meshed, with lines along the
//! mirrors, and reflected.

use crate::design::axes::wanted as wanted_axes;
use crate::design::chain::{Designed, Mesh, Search};
use crate::design::planarise::PlanariseError;
use crate::design::surface::{Measures, Polygons, Surface, clean};
use crate::design::wishes::{Align, SingularWish, Size, Wishes};
use crate::diagnostic::passes;
use crate::geometry::{Point3, Vector3};
use crate::structure::Draft;
use crate::tolerance::{ON_MIRROR, SYMMETRIC};
use crate::watch::Watch;
use nalgebra::Matrix3;
use std::collections::BTreeMap;

/// Most mirrors that are looked for: two cut a surface into quarters.
const MOST: usize = 2;

/// A plane of symmetry.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Mirror {
    middle: Point3,
    normal: Vector3,
}

impl Mirror {
    fn height(&self, p: Point3) -> f64 {
        (p - self.middle).dot(&self.normal)
    }

    fn turned(&self, v: Vector3) -> Vector3 {
        v - self.normal * (2.0 * v.dot(&self.normal))
    }

    fn reflected(&self, p: Point3) -> Point3 {
        p - self.normal * (2.0 * self.height(p))
    }
}

/// A part of a surface that its mirror images make whole.
pub(super) struct Sector {
    pub surface: Surface,
    mirrors: Vec<Mirror>,
    /// Points nearer to a mirror lie on it, mm.
    near: f64,
}

/// A reflected mesh, and by mirror the node on the other side of each.
pub(super) struct Whole {
    pub draft: Draft,
    partners: Vec<Vec<usize>>,
}

impl Sector {
    /// The sector of a surface; `None` if it has no mirror, or falls apart when cut.
    pub(super) fn of(surface: &Surface, measures: &Measures) -> Option<Self> {
        let mirrors = mirrors(surface, measures);
        let near = ON_MIRROR * measures.area().sqrt();
        let mut polygons = Polygons {
            positions: surface.positions.clone(),
            faces: surface.triangles.iter().map(|t| t.to_vec()).collect(),
            axes: surface.axes.clone(),
        };
        for mirror in &mirrors {
            polygons = half(&polygons, mirror, near);
        }
        let (cut, _) = clean(polygons).ok().filter(|_| !mirrors.is_empty())?;
        let on = |p: Point3| mirrors.iter().any(|m| m.height(p).abs() <= 2.0 * near);
        let surface = cut.following_boundary(on);
        Some(Self { surface, mirrors, near })
    }

    /// How many nodes the sector has to have that the whole has so many, with cells of this
    /// size.
    pub(super) fn nodes(&self, whole: usize, cell: f64) -> usize {
        let along: f64 = self
            .surface
            .lines()
            .iter()
            .flat_map(|line| &line.sides)
            .map(|&side| self.surface.length(side))
            .sum();
        let images = f64::from(1 << self.mirrors.len());
        ((whole as f64 + images / 2.0 * (along / cell + 1.0)) / images) as usize
    }

    /// A mesh of the sector with its mirror images, last mirror first.
    pub(super) fn reflected(&self, mut draft: Draft) -> Whole {
        let mut partners: Vec<Vec<usize>> = Vec::new();
        for mirror in self.mirrors.iter().rev() {
            let count = draft.positions.len();
            let mut partner: Vec<usize> = (0..count).collect();
            for node in 0..count {
                let (p, axis) = (draft.positions[node], draft.axes[node]);
                let height = mirror.height(p);
                if height.abs() <= 2.0 * self.near {
                    draft.positions[node] = p - mirror.normal * height;
                    let across = mirror.normal * axis.dot(&mirror.normal);
                    draft.axes[node] = (axis - across).try_normalize(0.0).unwrap_or(axis);
                } else {
                    partner[node] = draft.positions.len();
                    partner.push(node);
                    draft.positions.push(mirror.reflected(p));
                    draft.axes.push(mirror.turned(axis));
                }
            }
            // The images of what the mirrors before paired are paired alike.
            for before in &mut partners {
                for node in 0..count {
                    if partner[node] != node {
                        before.push(partner[before[node]]);
                    }
                }
            }
            let images: Vec<Vec<usize>> = draft
                .faces
                .iter()
                .map(|face| face.iter().rev().map(|&node| partner[node]).collect())
                .collect();
            draft.faces.extend(images);
            partners.push(partner);
        }
        Whole { draft, partners }
    }

    /// Directions of the whole, of those in the sector's triangles.
    fn directions(
        &self,
        surface: &Surface,
        directions: &[[Vector3; 2]],
    ) -> Vec<[Vector3; 2]> {
        let of = |corners: &[usize; 3]| {
            let sum: Vector3 = corners.iter().map(|&k| surface.positions[k].coords).sum();
            let beyond = |p: Point3, mirror: &&Mirror| mirror.height(p) < 0.0;
            let mut at = Point3::from(sum / 3.0);
            let mut over = Vec::new();
            for mirror in &self.mirrors {
                if beyond(at, &mirror) {
                    at = mirror.reflected(at);
                    over.push(mirror);
                }
            }
            let pair = directions[self.surface.nearest_triangle(at)];
            pair.map(|d| over.iter().fold(d, |d, mirror| mirror.turned(d)))
        };
        surface.triangles.iter().map(of).collect()
    }

    /// Takes out what rounding has done to the symmetry of a draft.
    pub(super) fn evened(&self, draft: &mut Draft, whole: &Whole) {
        for (mirror, partners) in self.mirrors.iter().rev().zip(&whole.partners) {
            let (positions, axes) = (draft.positions.clone(), draft.axes.clone());
            for (node, &other) in partners.iter().enumerate() {
                let image = mirror.reflected(positions[other]);
                draft.positions[node] = nalgebra::center(&positions[node], &image);
                let axis = axes[node] + mirror.turned(axes[other]);
                draft.axes[node] = axis.try_normalize(0.0).unwrap_or(axes[node]);
            }
        }
    }
}

impl Search<'_> {
    /// A design that is its own mirror image; `None` if that is not asked for or the surface
    /// is not, or if there is none that is valid.
    pub(super) fn mirrored(
        &self,
        watch: &mut dyn Watch,
    ) -> Result<Option<Designed>, PlanariseError> {
        let plain =
            self.wishes.singular == SingularWish::Auto && !self.surface.has_lines();
        let sector = (self.wishes.symmetry && plain)
            .then(|| Sector::of(self.surface, &self.measures))
            .flatten();
        let Some(sector) = sector else { return Ok(None) };
        let size = match self.wishes.size {
            Size::Nodes(count) => Size::Nodes(sector.nodes(count, self.cell())),
            cell => cell,
        };
        let wishes = Wishes { size, ..self.wishes.clone() };
        let part = Search {
            surface: &sector.surface,
            measures: Measures::of(&sector.surface),
            name: self.name,
            wishes: &wishes,
        };
        let part = match part.designed(watch) {
            Ok(part) => part,
            Err(PlanariseError::Refused(_)) => return Ok(None),
            Err(stopped) => return Err(stopped),
        };
        let followed =
            part.findings.iter().all(|f| f.code != "design::following_given_up");
        let wanted = part.figures.edge.wanted;
        let cells = [wanted, wanted / self.wishes.aspect];
        let cell = (cells[0] * cells[1]).sqrt();
        let Ok(axes) = wanted_axes(self.surface, &self.measures, cell) else {
            return Ok(None);
        };
        let whole = sector.reflected(part.before);
        let nearest = |&p: &Point3| self.surface.nearest_triangle(p);
        let mesh = Mesh {
            before: whole.draft.clone(),
            starts: whole.draft.positions.iter().map(nearest).collect(),
            directions: sector.directions(self.surface, &part.directions),
            axes,
            cells,
            aligned: self.wishes.align != Align::None,
        };
        let even = |draft: &mut Draft| sector.evened(draft, &whole);
        let mut designed = self.finished(mesh, &even, watch)?;
        designed.findings.extend(part.findings);
        let sound = passes(&designed.findings) && designed.figures.reversed == 0;
        Ok((sound && followed).then_some(designed))
    }
}

/// Planes through the middle of the surface in which it is its own image, at right angles
/// to one another.
fn mirrors(surface: &Surface, measures: &Measures) -> Vec<Mirror> {
    let centre = |t: &[usize; 3]| -> Vector3 {
        t.iter().map(|&k| surface.positions[k].coords / 3.0).sum()
    };
    let by_area = || surface.triangles.iter().map(centre).zip(&measures.areas);
    let sum: Vector3 = by_area().map(|(c, &area)| c * area).sum();
    let middle = Point3::from(sum / measures.area());
    let spread = |(c, &area): (Vector3, &f64)| {
        let arm = c - middle.coords;
        arm * arm.transpose() * area
    };
    let spread: Matrix3<f64> = by_area().map(spread).sum();
    let principal = spread.symmetric_eigen().eigenvectors;
    let principal = principal.column_iter().map(|axis| axis.into_owned());
    let candidates =
        [Vector3::x(), Vector3::y(), Vector3::z()].into_iter().chain(principal);
    let mut found: Vec<Mirror> = Vec::new();
    for normal in candidates {
        let mirror = Mirror { middle, normal };
        let apart = |m: &Mirror| m.normal.dot(&normal).abs() < SYMMETRIC;
        if found.len() < MOST
            && found.iter().all(apart)
            && is_mirror(surface, measures, &mirror)
        {
            found.push(mirror);
        }
    }
    found
}

/// Whether the image of every vertex lies on the surface and every axis is one's image.
fn is_mirror(surface: &Surface, measures: &Measures, mirror: &Mirror) -> bool {
    let far = SYMMETRIC * measures.area().sqrt();
    let heights = surface.positions.iter().map(|&p| mirror.height(p));
    let (low, high) = heights.fold((0.0_f64, 0.0_f64), |(a, b), h| (a.min(h), b.max(h)));
    if (low + high).abs() > far || high <= far {
        return false;
    }
    let start = surface.nearest_triangle(mirror.reflected(surface.positions[0]));
    // From vertex to neighbour, so that feet are found near one another.
    let mut feet = vec![None; surface.positions.len()];
    let mut open = vec![(0, start)];
    while let Some((vertex, start)) = open.pop() {
        if feet[vertex].is_some() {
            continue;
        }
        let image = mirror.reflected(surface.positions[vertex]);
        let foot = surface.foot(image, start);
        feet[vertex] = Some(foot);
        if (surface.point(foot) - image).norm() > far {
            return false;
        }
        if let Some(axes) = &surface.axes {
            let off = surface.between(axes, foot) - mirror.turned(axes[vertex]);
            if off.norm() > SYMMETRIC {
                return false;
            }
        }
        open.extend(surface.fan(vertex).map(|side| (surface.tip(side), foot.triangle)));
    }
    true
}

/// The part of a surface on the upper side of a mirror; vertices near it are moved onto it.
fn half(polygons: &Polygons, mirror: &Mirror, near: f64) -> Polygons {
    let mut part = polygons.clone();
    part.faces.clear();
    let height: Vec<f64> = part
        .positions
        .iter_mut()
        .map(|p| {
            let height = mirror.height(*p);
            if height.abs() > near {
                return height;
            }
            *p -= mirror.normal * height;
            0.0
        })
        .collect();
    let mut cuts: BTreeMap<[usize; 2], usize> = BTreeMap::new();
    for face in &polygons.faces {
        let mut kept = Vec::new();
        for (&a, &b) in face.iter().zip(face.iter().cycle().skip(1)) {
            if height[a] >= 0.0 {
                kept.push(a);
            }
            if height[a] * height[b] < 0.0 {
                let [a, b] = [a.min(b), a.max(b)];
                let share = height[a] / (height[a] - height[b]);
                kept.push(*cuts.entry([a, b]).or_insert_with(|| {
                    let (p, q) = (part.positions[a], part.positions[b]);
                    part.positions.push(p + (q - p) * share);
                    if let Some(axes) = &mut part.axes {
                        axes.push(axes[a] * (1.0 - share) + axes[b] * share);
                    }
                    part.positions.len() - 1
                }));
            }
        }
        let above = face.iter().any(|&k| height[k] > 0.0);
        if above && kept.len() > 2 {
            part.faces.push(kept);
        }
    }
    part
}
