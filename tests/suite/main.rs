//! What must hold for the whole: the order of modules, laws, variations of each structure,
//! golden drawings, the command line, and what is said about bad input.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

mod architecture;
mod circles;
mod connectors;
mod design;
mod diagnostics;
mod drawings;
mod gate;
mod golden;
mod held;
mod holes;
mod laws;
mod meshes;
mod nest;
mod nest_keys;
mod peers;
mod planarise;
mod plane;
mod planting;
mod proof;
mod refusals;
mod regressions;
mod replacement;
mod report;
mod spoilt;
mod structures;
mod threads;
mod transcripts;
mod variations;
mod vendor;
