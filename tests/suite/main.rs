//! What must hold for the whole: the order of modules, laws, variations of each structure,
//! golden drawings, the command line.

mod architecture;
mod golden;
mod laws;
mod plane;
mod structures;
mod transcripts;
mod variations;
