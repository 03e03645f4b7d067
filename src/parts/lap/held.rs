//! The end of a strip that stands in discs.

use crate::parts::end::EndFrame;
use crate::parts::hub::dimensions::Hub;
use crate::parts::hub::tenon::tenon;
use crate::parts::outline::HeldEnd;
use crate::parts::unfold::FlatAxis;

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
        cut: tenon(&frame, hub, relief),
        setback: hub.setback,
        heights: [start(far[0], low + relief), start(far[1], high - relief)],
    }
}
