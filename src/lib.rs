//! finwright: from a torsion-free support structure to laser-cut sheets.

pub mod export;
pub mod geometry;
pub mod nest;
pub mod sheets;
pub mod watch;
