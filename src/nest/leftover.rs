//! What is left of a sheet: its free space as remnants for the next time.
//!
//! The sheet's and the parts' outlines are triangulated together, with corners close to each
//! other. Free triangles hang together where the edge between them is wider than a hand's
//! breadth of use: webs between parts are cut off there, so what is returned lies wholly in
//! the free space.

use crate::geometry::predicates::contains;
use crate::geometry::ring::{area, signed_area};
use crate::geometry::{Point2, Rect};
use crate::nest::check::placed;
use crate::nest::outline::fault;
use crate::nest::triangulation::Triangulation;
use crate::nest::{NestedSheet, Remnant, Shape, Stock};
use crate::tolerance::WRITTEN_MM;

/// Narrower places are of no use, mm.
const WIDTH: f64 = 20.0;
/// Smaller pieces are of no use, mm².
const AREA: f64 = 4.0 * WIDTH * WIDTH;

/// The free space of a sheet, the largest piece first; drop-outs of holes are not in it.
pub fn leftovers(nested: &NestedSheet, shapes: &[Shape], stock: &Stock) -> Vec<Remnant> {
    let mut rings: Vec<Vec<Point2>> = stock.edges().cloned().collect();
    if rings.is_empty() {
        let (w, h) = (stock.width, stock.height);
        let corners = [(0.0, 0.0), (w, 0.0), (w, h), (0.0, h)];
        rings.push(corners.map(|(x, y)| Point2::new(x, y)).to_vec());
    }
    rings.extend(outermost(nested, shapes));
    let rings: Vec<Vec<Point2>> = rings.iter().map(|ring| divided(ring)).collect();
    let Some(triangulation) = Triangulation::new(&rings) else { return Vec::new() };
    let open = triangulation.wide_free_faces();
    let mut free: Vec<Remnant> = regions(
        triangulation.rings(|face| open[face]).iter().map(|ring| straightened(ring)),
    );
    free.retain(|r| net(r) >= AREA && fault(&r.outline, &r.holes).is_none());
    free.sort_by(|a, b| net(b).total_cmp(&net(a)));
    free
}

fn net(region: &Remnant) -> f64 {
    area(&region.outline) - region.holes.iter().map(|hole| area(hole)).sum::<f64>()
}

/// Outlines of the parts that do not lie in a hole of another.
fn outermost(nested: &NestedSheet, shapes: &[Shape]) -> Vec<Vec<Point2>> {
    let outline = |p: &crate::nest::Placement| placed(&shapes[p.shape].outline, p);
    let all: Vec<Vec<Point2>> = nested.placements.iter().map(outline).collect();
    let boxes: Vec<Rect> = all.iter().map(Rect::around).collect();
    let is_inside = |k: usize| {
        let p = all[k][0];
        let around = |other: usize| boxes[other].contains(p) && contains(&all[other], p);
        (0..all.len()).any(|other| other != k && around(other))
    };
    (0..all.len()).filter(|&k| !is_inside(k)).map(|k| all[k].clone()).collect()
}

/// A ring with corners at most half a useful width apart, so that edges across a corridor
/// are about as long as it is wide.
fn divided(ring: &[Point2]) -> Vec<Point2> {
    let next = ring.iter().cycle().skip(1);
    let edge = |(a, b): (&Point2, &Point2)| {
        let count = ((b - a).norm() / (WIDTH / 2.0)).ceil().max(1.0);
        let (a, way) = (*a, (b - a) / count);
        (0..count as usize).map(move |k| a + way * k as f64)
    };
    ring.iter().zip(next).flat_map(edge).collect()
}

/// Without the corners that lie on a straight line.
fn straightened(ring: &[Point2]) -> Vec<Point2> {
    let mut kept: Vec<Point2> = Vec::new();
    for (k, &p) in ring.iter().enumerate() {
        let next = ring[(k + 1) % ring.len()];
        let before = kept.last().copied().unwrap_or(ring[ring.len() - 1]);
        let chord = next - before;
        let off = chord.perp(&(p - before)).abs() / chord.norm();
        if off.is_nan() || off >= WRITTEN_MM || (p - before).dot(&(next - p)) <= 0.0 {
            kept.push(p);
        }
    }
    kept
}

/// Rings sorted into outlines, which run counter-clockwise, and the holes in them.
fn regions(rings: impl Iterator<Item = Vec<Point2>>) -> Vec<Remnant> {
    let (outer, inner): (Vec<_>, Vec<_>) = rings.partition(|r| signed_area(r) > 0.0);
    let region = |outline| Remnant { outline, holes: Vec::new() };
    let mut regions: Vec<Remnant> = outer.into_iter().map(region).collect();
    for hole in inner {
        let around = regions.iter_mut().filter(|r| contains(&r.outline, hole[0]));
        let smallest =
            around.min_by(|a, b| area(&a.outline).total_cmp(&area(&b.outline)));
        if let Some(region) = smallest {
            region.holes.push(hole);
        }
    }
    regions
}

impl Triangulation {
    /// Free faces that are reached through wide edges, and tips of corners beside them; no
    /// two parts of the region meet in a corner only.
    fn wide_free_faces(&self) -> Vec<bool> {
        let wide = |k: usize| !self.edges[k].fixed && self.edges[k].length > WIDTH;
        let mut open = vec![false; self.faces.len()];
        for k in (0..self.edges.len()).filter(|&k| wide(k)) {
            self.edges[k].faces.iter().for_each(|&face| open[face] = self.inside[face]);
        }
        let mut fixed = vec![0; self.faces.len()];
        for edge in self.edges.iter().filter(|edge| edge.fixed) {
            edge.faces.iter().for_each(|&face| fixed[face] += 1);
        }
        for edge in self.edges.iter().filter(|edge| !edge.fixed) {
            let [a, b] = edge.faces;
            for (face, tip) in [(a, b), (b, a)] {
                if open[face] && self.inside[tip] && fixed[tip] == 2 {
                    open[tip] = true;
                }
            }
        }
        while self.part_pinches(&mut open) {}
        open
    }

    /// Takes out the faces at corners where the region only touches itself.
    fn part_pinches(&self, open: &mut [bool]) -> bool {
        let mut ends = vec![0; self.points.len()];
        for edge in &self.edges {
            if open[edge.faces[0]] != open[edge.faces[1]] {
                edge.ends.iter().for_each(|&corner| ends[corner] += 1);
            }
        }
        let mut parted = false;
        for (face, corners) in self.faces.iter().enumerate() {
            if open[face] && corners.iter().any(|&corner| ends[corner] > 2) {
                (open[face], parted) = (false, true);
            }
        }
        parted
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::nest::{Placement, Rotations};

    #[test]
    fn a_slot_between_parts_is_no_free_space_and_the_rest_is() {
        let corners = [(0.0, 0.0), (100.0, 0.0), (100.0, 190.0), (0.0, 190.0)];
        let plate = Shape {
            name: "plate".into(),
            outline: corners.map(|(x, y)| Point2::new(x, y)).to_vec(),
            holes: Vec::new(),
            rotations: Rotations::Free,
            priority: 0,
        };
        let at = |x| Placement { shape: 0, angle: 0.0, x, y: 5.0 };
        let nested = NestedSheet { stock: 0, placements: vec![at(5.0), at(107.0)] };
        let stock = Stock::new([500.0, 200.0], 5.0, 2.0);
        let free = leftovers(&nested, &[plate], &stock);
        let areas: Vec<f64> = free.iter().map(net).collect();
        // 500 - 207 mm wide; the strips along the edges are too narrow to count.
        let wanted = 293.0 * 200.0;
        assert_eq!(areas.len(), 1, "{areas:?}");
        assert!((areas[0] - wanted).abs() < 0.01 * wanted, "{areas:?}");
    }
}
