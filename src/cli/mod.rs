//! The command: what was typed, what is read and written, what is said.

mod advise;
mod args;
mod coupon;
mod embedded;
mod input;
mod jobdir;
mod joint;
mod nest;
mod nest_drawing;
mod nest_input;
mod nest_progress;
mod picture;
mod planarise;
mod rigidity;
mod run;
mod show;
mod verify;

pub use args::Cli;
pub use run::run;
