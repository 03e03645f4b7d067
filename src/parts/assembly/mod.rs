//! All parts put together as plates of their thickness, placed in space.

pub(super) mod built;
pub(super) mod collisions;
pub(super) mod copy;
mod solid;
