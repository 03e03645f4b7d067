//! finwright: from a torsion-free support structure to laser-cut sheets.

pub mod cli;
pub mod design;
pub mod diagnostic;
pub mod export;
pub mod gate;
pub mod geometry;
pub mod job;
pub mod lettering;
pub mod nest;
pub mod parts;
pub mod report;
pub mod sheets;
pub mod structure;
pub mod template;
pub mod tolerance;
pub mod units;
pub mod watch;
