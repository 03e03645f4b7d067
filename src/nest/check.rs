//! The exact check: nothing is written that has not passed it.
//!
//! All outlines of a sheet, as they will be written, become constraints of one Delaunay
//! triangulation (`spade`, exact predicates): outlines that cross conflict there. What
//! does not cross may still lie inside another part. Distances are taken from each corner
//! to the edges near it, for the least distance of two disjoint polygons is always at a
//! corner of one of them. (The shortest edge of the triangulation between two parts is
//! *not* their distance: a corner that faces the middle of a long edge need not be joined
//! to it.)

use crate::geometry::predicates::{contains, segments_meet};
use crate::geometry::{Point2, Rect};
use crate::nest::{Layout, NestedSheet, Placement, Shape, Stock};
use crate::tolerance::PLACED_MM;
use spade::{
    ConstrainedDelaunayTriangulation, FloatTriangulation, HasPosition, Triangulation,
};
use std::collections::BTreeMap;
use thiserror::Error;

/// Something wrong with a layout.
#[derive(Debug, Clone, PartialEq, Error)]
#[allow(missing_docs, reason = "the messages say what the fields are")]
pub enum LayoutFault {
    #[error("sheet {}: {first} and {second} overlap", sheet + 1)]
    Overlap { sheet: usize, first: String, second: String },
    #[error("sheet {}: {first} and {second} are {distance:.6} mm apart", sheet + 1)]
    TooNear { sheet: usize, first: String, second: String, distance: f64 },
    #[error("sheet {}: the lines of {name} cross each other", sheet + 1)]
    CrossesItself { sheet: usize, name: String },
    #[error("sheet {}: {name} reaches into the margin by {by:.6} mm", sheet + 1)]
    InMargin { sheet: usize, name: String, by: f64 },
    #[error("sheet {}: {name} reaches over the edge of the remnant", sheet + 1)]
    OverEdge { sheet: usize, name: String },
    #[error("sheet {}: the outlines cannot be triangulated: {reason}", sheet + 1)]
    Unreadable { sheet: usize, reason: String },
}

/// A corner of a placed outline.
struct Corner {
    at: spade::Point2<f64>,
    owner: usize,
}

impl HasPosition for Corner {
    type Scalar = f64;

    fn position(&self) -> spade::Point2<f64> {
        self.at
    }
}

/// Everything wrong with a layout.
pub fn check(layout: &Layout, shapes: &[Shape], stock: &[Stock]) -> Vec<LayoutFault> {
    let sheets = layout.sheets.iter().enumerate();
    sheets
        .flat_map(|(sheet, nested)| {
            let stock = &stock[nested.stock];
            let mut rings = rings(nested, shapes);
            let owner = nested.placements.len();
            let edge = |(k, points): (usize, &Vec<Point2>)| Ring {
                owner,
                is_hole: k > 0,
                points: points.clone(),
            };
            rings.extend(stock.edges().enumerate().map(edge));
            Checked { sheet, nested, shapes, stock, rings }.faults()
        })
        .collect()
}

/// All rings of a sheet where they lie: of each part the outline, then its holes.
fn rings(nested: &NestedSheet, shapes: &[Shape]) -> Vec<Ring> {
    let of = |(owner, p): (usize, &Placement)| {
        let shape = &shapes[p.shape];
        let ring = |points: &[Point2], is_hole| Ring {
            owner,
            is_hole,
            points: placed(points, p),
        };
        let holes = shape.holes.iter().map(|hole| ring(hole, true));
        std::iter::once(ring(&shape.outline, false)).chain(holes).collect::<Vec<_>>()
    };
    nested.placements.iter().enumerate().flat_map(of).collect()
}

/// An outline where it lies.
pub(super) fn placed(outline: &[Point2], placement: &Placement) -> Vec<Point2> {
    let motion = placement.motion();
    outline.iter().map(|&p| motion.apply(p)).collect()
}

/// One closed line of a part, or of the remnant they lie on.
struct Ring {
    /// Index of the placement; one more than the last for the remnant.
    owner: usize,
    is_hole: bool,
    points: Vec<Point2>,
}

struct Checked<'a> {
    sheet: usize,
    nested: &'a NestedSheet,
    shapes: &'a [Shape],
    stock: &'a Stock,
    rings: Vec<Ring>,
}

impl Checked<'_> {
    fn name(&self, owner: usize) -> String {
        self.shapes[self.nested.placements[owner].shape].name.clone()
    }

    fn is_remnant(&self, owner: usize) -> bool {
        owner == self.nested.placements.len()
    }

    fn overlap(&self, first: usize, second: usize) -> LayoutFault {
        let part = [second, first].into_iter().find(|&owner| !self.is_remnant(owner));
        if self.is_remnant(first) || self.is_remnant(second) {
            let name = part.map(|part| self.name(part)).unwrap_or_default();
            return LayoutFault::OverEdge { sheet: self.sheet, name };
        }
        let (first, second) = (self.name(first), self.name(second));
        LayoutFault::Overlap { sheet: self.sheet, first, second }
    }

    fn faults(&self) -> Vec<LayoutFault> {
        let mut faults = self.in_margin();
        faults.extend(self.nested_in_another());
        match self.triangulated() {
            Ok((triangulation, crossing)) => {
                if crossing.is_empty() {
                    faults.extend(self.too_near(&triangulation));
                }
                faults.extend(crossing);
            }
            Err(fault) => faults.push(fault),
        }
        faults
    }

    fn in_margin(&self) -> Vec<LayoutFault> {
        let (margin, stock) = (self.stock.margin, self.stock);
        let out = |p: &Point2| {
            let low = (margin - p.x).max(margin - p.y);
            low.max(p.x - stock.width + margin).max(p.y - stock.height + margin)
        };
        let parts = self.rings.iter().filter(|ring| !self.is_remnant(ring.owner));
        let outlines = parts.filter(|ring| !ring.is_hole);
        let worst = |points: &[Point2]| {
            let out = points.iter().map(out);
            // Not a number is out, too.
            out.fold(f64::NEG_INFINITY, |a, b| if a >= b { a } else { b })
        };
        outlines
            .map(|ring| (ring.owner, worst(&ring.points)))
            .filter(|(_, by)| by.is_nan() || *by > PLACED_MM)
            .map(|(k, by)| LayoutFault::InMargin {
                sheet: self.sheet,
                name: self.name(k),
                by,
            })
            .collect()
    }

    /// Parts inside the material of another part, found by one corner of each; parts
    /// beside the remnant, and holes of the remnant inside a part.
    fn nested_in_another(&self) -> Vec<LayoutFault> {
        let count = self.nested.placements.len();
        let mut insides: Vec<Vec<usize>> = vec![Vec::new(); count + 1];
        let bounds: Vec<Rect> =
            self.rings.iter().map(|ring| Rect::around(&ring.points)).collect();
        let mut faults = Vec::new();
        let is_edge = |ring: &&Ring| self.is_remnant(ring.owner) == ring.is_hole;
        for inner in self.rings.iter().filter(is_edge) {
            let p = inner.points[0];
            insides.iter_mut().for_each(Vec::clear);
            for (ring, bounds) in self.rings.iter().zip(&bounds) {
                if bounds.contains(p)
                    && ring.owner != inner.owner
                    && contains(&ring.points, p)
                {
                    insides[ring.owner].push(usize::from(ring.is_hole));
                }
            }
            // In the outline and in no hole; for the remnant it must be so.
            let overlapped = insides.iter().enumerate().filter(|(outer, inside)| {
                let is_wrong = if *outer < count {
                    inside[..] == [0]
                } else {
                    self.stock.remnant.is_some() && inside[..] != [0]
                };
                is_wrong && *outer != inner.owner
            });
            faults.extend(overlapped.map(|(outer, _)| self.overlap(inner.owner, outer)));
        }
        faults
    }

    /// All outlines as constraints, and what conflicts.
    fn triangulated(
        &self,
    ) -> Result<(ConstrainedDelaunayTriangulation<Corner>, Vec<LayoutFault>), LayoutFault>
    {
        let mut corners: Vec<Corner> = Vec::new();
        let mut edges = Vec::new();
        let mut known: BTreeMap<[u64; 2], usize> = BTreeMap::new();
        let mut faults = Vec::new();
        for Ring { owner, points, .. } in &self.rings {
            let owner = *owner;
            let mut indices: Vec<usize> = Vec::new();
            for p in points {
                let key = [p.x + 0.0, p.y + 0.0].map(f64::to_bits);
                let index = *known.entry(key).or_insert(corners.len());
                if index == corners.len() {
                    corners.push(Corner { at: spade::Point2::new(p.x, p.y), owner });
                } else if corners[index].owner != owner {
                    faults.push(self.overlap(corners[index].owner, owner));
                }
                indices.push(index);
            }
            let next = indices.iter().cycle().skip(1);
            edges.extend(
                indices.iter().zip(next).map(|(&a, &b)| [a, b]).filter(|e| e[0] != e[1]),
            );
        }
        let owners: Vec<usize> = corners.iter().map(|corner| corner.owner).collect();
        let positions: Vec<Point2> =
            corners.iter().map(|corner| Point2::new(corner.at.x, corner.at.y)).collect();
        let mut conflicts = Vec::new();
        let loaded =
            ConstrainedDelaunayTriangulation::try_bulk_load_cdt(corners, edges, |edge| {
                conflicts.push(edge);
            });
        let triangulation = loaded.map_err(|error| LayoutFault::Unreadable {
            sheet: self.sheet,
            reason: error.to_string(),
        })?;
        for [a, b] in conflicts {
            let owner = owners.get(a).copied().unwrap_or(0);
            faults.extend(self.crossed(owner, positions[a], positions[b]));
        }
        Ok((triangulation, faults))
    }

    /// Whose lines a line of a part crosses: of other parts, or its own.
    fn crossed(&self, owner: usize, a: Point2, b: Point2) -> Vec<LayoutFault> {
        let crosses = |ring: &&Ring| {
            let next = ring.points.iter().cycle().skip(1);
            let mut edges = ring.points.iter().zip(next);
            ring.owner != owner && edges.any(|(c, d)| segments_meet(a, b, *c, *d))
        };
        let others = self.rings.iter().filter(crosses);
        let faults: Vec<LayoutFault> =
            others.map(|r| self.overlap(owner, r.owner)).collect();
        if !faults.is_empty() {
            return faults;
        }
        if self.is_remnant(owner) {
            let name = "the remnant".to_owned();
            return vec![LayoutFault::CrossesItself { sheet: self.sheet, name }];
        }
        vec![LayoutFault::CrossesItself { sheet: self.sheet, name: self.name(owner) }]
    }

    /// Corners nearer to an edge of another part than the spacing, or of the remnant than
    /// the margin.
    fn too_near(
        &self,
        cdt: &ConstrainedDelaunayTriangulation<Corner>,
    ) -> Vec<LayoutFault> {
        let gap = |of_remnant: bool| match of_remnant {
            true => self.stock.margin - PLACED_MM,
            false => self.stock.spacing - PLACED_MM,
        };
        let has_edge = self.stock.remnant.is_some();
        let reach = if has_edge { gap(true).max(gap(false)) } else { gap(false) };
        if reach <= 0.0 {
            return Vec::new();
        }
        let mut faults = Vec::new();
        for vertex in cdt.vertices() {
            let (at, owner) = (vertex.position(), vertex.data().owner);
            let near = cdt.get_edges_in_circle(at, reach * reach);
            for edge in near.filter(|edge| edge.is_constraint_edge()) {
                let other = edge.vertices()[0].data().owner;
                let distance = edge.distance_2(at).sqrt();
                let of_remnant = [owner, other].map(|k| self.is_remnant(k));
                if other != owner && distance < gap(of_remnant != [false; 2]) {
                    faults.push(self.near([owner, other], distance));
                }
            }
        }
        faults
    }

    fn near(&self, [first, second]: [usize; 2], distance: f64) -> LayoutFault {
        let sheet = self.sheet;
        if self.is_remnant(first) || self.is_remnant(second) {
            let name = self.name(first.min(second));
            return LayoutFault::InMargin {
                sheet,
                name,
                by: self.stock.margin - distance,
            };
        }
        let (first, second) = (self.name(first), self.name(second));
        LayoutFault::TooNear { sheet, first, second, distance }
    }
}
