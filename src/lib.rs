//! finwright: from a torsion-free support structure to laser-cut sheets.

pub mod design;
pub mod diagnostic;
pub mod geometry;
pub mod lettering;
pub mod nest;
pub mod parts;
pub mod sheets;
pub mod structure;
pub mod tolerance;
pub mod units;
pub mod watch;
