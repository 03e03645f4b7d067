//! Sparse symmetric systems: order of elimination, factor, solves, eigenvalues.
//!
//! In: a graph of *groups* of unknowns that are eliminated together (the six of a node),
//! and blocks between them ([`Entries`]). Out: a Cholesky [`Factor`], which solves for many
//! right-hand sides at once and gives blocks of its inverse; eigenvectors of what can be
//! applied to a [`Block`] ([`largest`]). One [`Symbolic`] serves any number of factors, and
//! one factor any number of solves. The room knows nothing of bodies, meshes or energies.
//!
//! | file | what it does | source |
//! |---|---|---|
//! | `ordering` | approximate minimum degree | Amestoy, Davis and Duff 1996 (`feral-amd`) |
//! | `etree` | elimination tree, postorder | Liu 1986, 1990 |
//! | `symbolic` | column patterns, relaxed supernodes | Ashcraft and Grimes 1989 |
//! | `front` | assembly by extend-add, elimination, update matrix | Duff and Reid 1983 |
//! | `factor` | fronts in postorder, subtrees side by side | Liu 1992 |
//! | `panel`, `solve` | packed columns, triangular solves | docs/decisions/0019, 0022 |
//! | `inverse` | selected inversion | Takahashi, Fagan and Chin 1973 |
//! | `lanczos`, `basis`, `block`, `tall` | block Lanczos, full reorthogonalisation | Grimes, Lewis and Simon 1994 |
//! | `parallel` | threads that do not change the result | |

mod basis;
mod block;
mod etree;
mod factor;
mod front;
mod inverse;
mod lanczos;
mod ordering;
mod panel;
mod parallel;
mod solve;
mod symbolic;
mod tall;

pub(crate) use block::{Block, orthonormalise, project_out};
pub(crate) use factor::{Entries, Factor, Halt, Singular};
pub(crate) use lanczos::{Operator, largest, random_block};
pub(crate) use panel::RHS;
pub(crate) use parallel::{map_chunks, map_range, worthwhile};
pub(crate) use symbolic::Symbolic;
