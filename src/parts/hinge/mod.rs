//! Eye plates on a rod, two for each fin of a node.

pub(super) mod plate;
