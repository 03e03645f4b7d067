//! The `finwright` command.

fn main() {}
