//! The exact check: nothing is written that has not passed it.
//!
//! All outlines of a sheet, as they will be written, become constraints of one Delaunay
//! triangulation (`spade`, exact predicates): outlines that cross conflict there. What
//! does not cross may still lie inside another part. Distances are taken from each corner
//! to the edges near it, for the least distance of two disjoint polygons is always at a
//! corner of one of them. (The shortest edge of the triangulation between two parts is
//! *not* their distance: a corner that faces the middle of a long edge need not be joined
//! to it.)

use crate::geometry::predicates::{Side, side};
use crate::geometry::{Point2, Vector2, trig};
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
pub enum Fault {
    #[error("sheet {sheet}: {first} and {second} overlap")]
    Overlap { sheet: usize, first: String, second: String },
    #[error("sheet {sheet}: {first} and {second} are {distance:.6} mm apart")]
    TooNear { sheet: usize, first: String, second: String, distance: f64 },
    #[error("sheet {sheet}: {name} reaches into the margin by {by:.6} mm")]
    InMargin { sheet: usize, name: String, by: f64 },
    #[error("sheet {sheet}: the outlines cannot be triangulated: {reason}")]
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
pub fn check(layout: &Layout, shapes: &[Shape], stock: &[Stock]) -> Vec<Fault> {
    let sheets = layout.sheets.iter().enumerate();
    sheets
        .flat_map(|(sheet, nested)| {
            let rings =
                nested.placements.iter().map(|p| placed(&shapes[p.shape].outline, p));
            let checked = Checked {
                sheet,
                nested,
                shapes,
                stock: &stock[nested.stock],
                rings: rings.collect(),
            };
            checked.faults()
        })
        .collect()
}

/// An outline where it lies.
fn placed(outline: &[Point2], placement: &Placement) -> Vec<Point2> {
    let (sin, cos) = (trig::sin(placement.angle), trig::cos(placement.angle));
    let turn = |p: &Point2| Vector2::new(cos * p.x - sin * p.y, sin * p.x + cos * p.y);
    let shift = Vector2::new(placement.x, placement.y);
    outline.iter().map(|p| Point2::from(turn(p) + shift)).collect()
}

struct Checked<'a> {
    sheet: usize,
    nested: &'a NestedSheet,
    shapes: &'a [Shape],
    stock: &'a Stock,
    rings: Vec<Vec<Point2>>,
}

impl Checked<'_> {
    fn name(&self, ring: usize) -> String {
        self.shapes[self.nested.placements[ring].shape].name.clone()
    }

    fn overlap(&self, first: usize, second: usize) -> Fault {
        let (first, second) = (self.name(first), self.name(second));
        Fault::Overlap { sheet: self.sheet, first, second }
    }

    fn faults(&self) -> Vec<Fault> {
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

    fn in_margin(&self) -> Vec<Fault> {
        let (margin, stock) = (self.stock.margin, self.stock);
        let out = |p: &Point2| {
            let low = (margin - p.x).max(margin - p.y);
            low.max(p.x - stock.width + margin).max(p.y - stock.height + margin)
        };
        let rings = self.rings.iter().enumerate();
        rings
            .map(|(k, ring)| (k, ring.iter().map(out).fold(f64::NEG_INFINITY, f64::max)))
            .filter(|(_, by)| by.is_nan() || *by > PLACED_MM)
            .map(|(k, by)| Fault::InMargin { sheet: self.sheet, name: self.name(k), by })
            .collect()
    }

    /// Parts inside another part, found by one corner of each.
    fn nested_in_another(&self) -> Vec<Fault> {
        let bounds: Vec<(Point2, Point2)> =
            self.rings.iter().map(|r| bounds(r)).collect();
        let mut faults = Vec::new();
        for (inner, ring) in self.rings.iter().enumerate() {
            let p = ring[0];
            for (outer, &(low, high)) in bounds.iter().enumerate() {
                let near = low.x <= p.x && p.x <= high.x && low.y <= p.y && p.y <= high.y;
                if inner != outer && near && contains(&self.rings[outer], p) {
                    faults.push(self.overlap(inner, outer));
                }
            }
        }
        faults
    }

    /// All outlines as constraints, and what conflicts.
    fn triangulated(
        &self,
    ) -> Result<(ConstrainedDelaunayTriangulation<Corner>, Vec<Fault>), Fault> {
        let mut corners: Vec<Corner> = Vec::new();
        let mut edges = Vec::new();
        let mut known: BTreeMap<[u64; 2], usize> = BTreeMap::new();
        let mut faults = Vec::new();
        for (owner, ring) in self.rings.iter().enumerate() {
            let mut indices: Vec<usize> = Vec::new();
            for p in ring {
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
        let mut conflicts = Vec::new();
        let loaded =
            ConstrainedDelaunayTriangulation::try_bulk_load_cdt(corners, edges, |edge| {
                conflicts.push(edge);
            });
        let triangulation = loaded.map_err(|error| Fault::Unreadable {
            sheet: self.sheet,
            reason: error.to_string(),
        })?;
        faults.extend(conflicts.into_iter().map(|[a, _]| {
            let owner = owners.get(a).copied().unwrap_or(0);
            let second = "another part".to_owned();
            Fault::Overlap { sheet: self.sheet, first: self.name(owner), second }
        }));
        Ok((triangulation, faults))
    }

    /// Corners nearer to an edge of another part than the spacing.
    fn too_near(&self, cdt: &ConstrainedDelaunayTriangulation<Corner>) -> Vec<Fault> {
        let least = self.stock.spacing - PLACED_MM;
        if least <= 0.0 {
            return Vec::new();
        }
        let mut faults = Vec::new();
        for vertex in cdt.vertices() {
            let (at, owner) = (vertex.position(), vertex.data().owner);
            let near = cdt.get_edges_in_circle(at, least * least);
            for edge in near.filter(|edge| edge.is_constraint_edge()) {
                let other = edge.vertices()[0].data().owner;
                let distance = edge.distance_2(at).sqrt();
                if other != owner && distance < least {
                    faults.push(Fault::TooNear {
                        sheet: self.sheet,
                        first: self.name(owner),
                        second: self.name(other),
                        distance,
                    });
                }
            }
        }
        faults
    }
}

fn bounds(ring: &[Point2]) -> (Point2, Point2) {
    ring.iter().fold((ring[0], ring[0]), |(low, high), p| (low.inf(p), high.sup(p)))
}

/// Whether a polygon contains a point, exactly (crossings of a ray to the right).
fn contains(ring: &[Point2], p: Point2) -> bool {
    let edges = ring.iter().zip(ring.iter().cycle().skip(1));
    let crossed = edges.filter(|(a, b)| {
        let upward = a.y <= p.y && p.y < b.y;
        let downward = b.y <= p.y && p.y < a.y;
        (upward && side(**a, **b, p) == Side::Left)
            || (downward && side(**a, **b, p) == Side::Right)
    });
    crossed.count() % 2 == 1
}
