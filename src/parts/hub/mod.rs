//! Two slotted discs that hold the fins of a node.

pub(super) mod dimensions;
pub(super) mod disc;
pub(super) mod tenon;
