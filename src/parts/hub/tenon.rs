//! The tenon: the end of a fin that stands in the windows of two discs.
//!
//! The end edge stops at the setback; beside the tenon the fin is notched from its bottom and
//! top edge to take in the discs' rings.

use crate::geometry::Vertex;
use crate::parts::chain::{quarter, reversed, without_doubles};
use crate::parts::end::EndFrame;
use crate::parts::hub::dimensions::Hub;

/// The end from the bottom edge over the end edge to the top edge.
pub(crate) fn tenon(frame: &EndFrame, hub: &Hub, relief: f64) -> Vec<Vertex> {
    let mut chain = notch(frame, hub, 0, relief);
    chain.extend(reversed(&notch(frame, hub, 1, relief)));
    without_doubles(&mut chain);
    chain
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
