//! Angles, areas and frames of the triangles of a surface.

use crate::design::surface::{Surface, next, previous};
use crate::geometry::{Vector2, Vector3, trig};
use std::f64::consts::{PI, TAU};

/// What fields need to know of a surface. Directions in a triangle are angles from its
/// first side, counter-clockwise, radians.
#[derive(Debug, Clone)]
pub struct Measures {
    /// Area of each triangle, mm².
    pub areas: Vec<f64>,
    /// Frame of each triangle: along its first side, across it to the left, and its normal.
    pub frames: Vec<[Vector3; 3]>,
    /// Where the corners of each triangle lie in its frame.
    pub corners: Vec<[Vector2; 3]>,
    /// Angle of the corner from which each half-edge starts.
    pub angles: Vec<f64>,
    /// Direction of each half-edge in the frame of its triangle.
    pub directions: Vec<f64>,
    /// By how much each inner half-edge turns a direction that is carried from its triangle
    /// to the one beyond; 0 on the boundary.
    pub transports: Vec<f64>,
    /// Cotangents weight of each edge between triangles: edge over distance of the centres
    /// of the circles around the two triangles, kept within bounds.
    pub couplings: Vec<f64>,
    /// 2 π less the angles around each vertex (π less on the boundary).
    pub defects: Vec<f64>,
}

/// Bounds of a coupling: centres that fall together, or beyond one another.
const LEAST_DISTANCE: f64 = 0.05;
const MOST_COUPLING: f64 = 5.0;

impl Measures {
    /// Measures a surface.
    pub fn of(surface: &Surface) -> Self {
        let count = surface.triangles.len();
        let (mut frames, mut corners) =
            (Vec::with_capacity(count), Vec::with_capacity(count));
        let mut areas = Vec::with_capacity(count);
        for &[a, b, c] in &surface.triangles {
            let [a, b, c] = [a, b, c].map(|vertex| surface.positions[vertex]);
            let (along, to) = (b - a, c - a);
            let cross = along.cross(&to);
            let (x, normal) = (along.normalize(), cross.normalize());
            let y = normal.cross(&x);
            frames.push([x, y, normal]);
            let second = Vector2::new(along.norm(), 0.0);
            corners.push([
                Vector2::zeros(),
                second,
                Vector2::new(to.dot(&x), to.dot(&y)),
            ]);
            areas.push(cross.norm() / 2.0);
        }
        let mut measures = Self {
            areas,
            frames,
            corners,
            angles: Vec::new(),
            directions: Vec::new(),
            transports: Vec::new(),
            couplings: Vec::new(),
            defects: Vec::new(),
        };
        measures.angles = (0..3 * count).map(|side| measures.angle(side)).collect();
        measures.directions = (0..3 * count)
            .map(|side| {
                let along = measures.along(side);
                trig::atan2(along.y, along.x)
            })
            .collect();
        measures.across(surface);
        measures
    }

    /// The vector of a half-edge in the frame of its triangle.
    pub fn along(&self, side: usize) -> Vector2 {
        let corners = &self.corners[side / 3];
        corners[next(side) % 3] - corners[side % 3]
    }

    fn angle(&self, side: usize) -> f64 {
        let (a, b) = (self.along(side), -self.along(previous(side)));
        trig::atan2(a.perp(&b), a.dot(&b))
    }

    fn across(&mut self, surface: &Surface) {
        let cotangent = |side: usize| 1.0 / trig::tan(self.angles[previous(side)]);
        let of = |side: usize| {
            let Some(twin) = surface.twin(side) else { return (0.0, 0.0) };
            // Half a turn the one way and the other, so that there and back is nothing.
            let half = if side < twin { PI } else { -PI };
            let turn = self.directions[twin] + half - self.directions[side];
            let distance = (cotangent(side) + cotangent(twin)) / 2.0;
            (turn, (1.0 / distance.max(LEAST_DISTANCE)).min(MOST_COUPLING))
        };
        let across: Vec<(f64, f64)> = (0..surface.side_count()).map(of).collect();
        self.transports = across.iter().map(|of| of.0).collect();
        self.couplings = across.iter().map(|of| of.1).collect();
        let defect = |vertex: usize| {
            let around: f64 = surface.fan(vertex).map(|side| self.angles[side]).sum();
            if surface.on_boundary(vertex) { PI - around } else { TAU - around }
        };
        self.defects = (0..surface.positions.len()).map(defect).collect();
    }

    /// Area of the whole surface, mm².
    pub fn area(&self) -> f64 {
        self.areas.iter().sum()
    }

    /// Slopes of the three functions that are 1 at a corner of a triangle and 0 at the
    /// others, in its frame.
    pub fn slopes(&self, triangle: usize) -> [Vector2; 3] {
        let twice = 2.0 * self.areas[triangle];
        [0, 1, 2].map(|k| {
            let opposite = self.along(next(3 * triangle + k));
            Vector2::new(-opposite.y, opposite.x) / twice
        })
    }
}
