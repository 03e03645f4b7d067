//! The end of a fin that stands in the windows of two discs.
//!
//! Seen in the fin's plane, `s` runs from the axis into the fin and `z` along the axis. The
//! end edge stops at the setback; beside the tongue that stands in the window, the fin is
//! notched from its bottom and top edge to take in the discs' rings.

use crate::geometry::{Point2, Vector2, Vertex, trig};
use crate::parts::hub::dimensions::Hub;
use crate::parts::outline::{HeldEnd, reversed, without_doubles};
use crate::parts::star::Spoke;
use crate::parts::unfold::FlatAxis;
use std::f64::consts::FRAC_PI_8;

/// One end of a fin in its own frame.
pub(crate) struct EndFrame<'a> {
    pub axis: &'a FlatAxis,
    /// Unit vector across the axis, into the fin.
    pub inward: Vector2,
    /// Rise of the bottom and top edge per length across the axis.
    pub rise: [f64; 2],
}

impl<'a> EndFrame<'a> {
    /// At a left (0) or right (1) end.
    pub(crate) fn new(axis: &'a FlatAxis, end: usize, rise: [f64; 2]) -> Self {
        let inward = if end == 0 { axis.right() } else { -axis.right() };
        Self { axis, inward, rise }
    }

    pub(crate) fn at(&self, s: f64, z: f64) -> Point2 {
        self.axis.foot + self.inward * s + self.axis.up * z
    }

    /// On the bottom (0) or top (1) edge.
    pub(crate) fn on_edge(&self, s: f64, edge: usize) -> Point2 {
        let start = [-self.axis.below, self.axis.above][edge];
        self.at(s, start + self.rise[edge] * s)
    }

    /// 1 at a right end, where the way up runs counter-clockwise, -1 at a left one.
    pub(crate) fn turn(&self) -> f64 {
        -self.inward.dot(&self.axis.right()).signum()
    }
}

/// The end from the bottom edge over the end edge to the top edge.
pub(crate) fn tongue(frame: &EndFrame, hub: &Hub, relief: f64) -> Vec<Vertex> {
    let mut chain = notch(frame, hub, 0, relief);
    chain.extend(reversed(&notch(frame, hub, 1, relief)));
    without_doubles(&mut chain);
    chain
}

/// The left (0) or right (1) end of a strip on its last axis; `next` is the axis before it.
pub(crate) fn held_end(
    [axis, next]: [&FlatAxis; 2],
    end: usize,
    hub: &Hub,
    relief: f64,
) -> HeldEnd {
    let mut frame = EndFrame::new(axis, end, [0.0; 2]);
    let far = [next.bottom(), next.top()].map(|p| p - axis.foot);
    let far = far.map(|way| [way.dot(&frame.inward), way.dot(&axis.up)]);
    frame.rise = [(far[0], -axis.below), (far[1], axis.above)]
        .map(|([s, z], from)| (z - from) / s);
    let reach = hub.notch[1] + relief;
    let [low, high] = hub.between();
    // The line to the far corner must pass inside the notch.
    let start = |[s, z]: [f64; 2], floor: f64| {
        let share = (reach / s).min(0.9);
        (floor - z * share) / (1.0 - share)
    };
    HeldEnd {
        cut: tongue(&frame, hub, relief),
        setback: hub.setback,
        heights: [start(far[0], low + relief), start(far[1], high - relief)],
    }
}

/// A notch for a ring in an edge and the corner beyond it, toward the axis.
fn notch(frame: &EndFrame, hub: &Hub, edge: usize, relief: f64) -> Vec<Vertex> {
    let [near, far] = hub.notch;
    let floor = hub.between()[edge];
    let radius = relief.min((far - near) / 2.0).max(0.0);
    let beyond = if edge == 1 { floor - radius } else { floor + radius };
    // The same corner on the other edge turns the other way; so does a chain reversed.
    let turn = if edge == 1 { frame.turn() } else { -frame.turn() };
    let bulge = turn * quarter(radius);
    vec![
        Vertex::line(frame.on_edge(far, edge)),
        Vertex::arc(frame.at(far, floor), bulge),
        Vertex::line(frame.at(far - radius, beyond)),
        Vertex::arc(frame.at(near + radius, beyond), bulge),
        Vertex::line(frame.at(near, floor)),
        Vertex::line(frame.on_edge(near, edge)),
        Vertex::line(frame.on_edge(hub.setback, edge)),
    ]
}

/// Heights along the axis that notches leave for letters, whatever the slope of the edges.
pub(crate) fn writable(hub: &Hub, spoke: &Spoke, relief: f64) -> [f64; 2] {
    let [low, high] = hub.between();
    let spare = |edge: usize| relief + spoke.rise[edge].abs() * hub.radius;
    [low + spare(0), high - spare(1)]
}

/// Bulge of a quarter circle, if there is one.
pub(crate) fn quarter(radius: f64) -> f64 {
    if radius > 0.0 { trig::tan(FRAC_PI_8) } else { 0.0 }
}
