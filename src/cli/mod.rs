//! The command: what was typed, what is read and written, what is said.

mod advise;
mod at_scale;
mod check;
mod console;
mod coupon;
mod design;
mod embedded;
mod flags;
mod input;
mod jobdir;
mod make;
mod nest;
mod nest_drawing;
mod nest_input;
mod nest_keys;
mod nest_progress;
mod outcome;
mod picture;
mod planarise;
mod rigidity;
mod run;
mod verify;

pub use flags::Cli;
pub use run::run;
