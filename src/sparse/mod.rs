//! Sparse symmetric systems: order of elimination, factor, solves, eigenvalues.
//!
//! In: [`Triplets`], or a [`SymmetricMatrix`] made of them. Out: a [`Cholesky`] factor, whose pattern is analysed once
//! and which takes any number of matrices and right-hand sides, on one thread. A complex
//! system is a real one with two unknowns, `re` and `im`, for each.
//!
//! Where one large matrix meets many right-hand sides (`rigidity`), its unknowns come in
//! *groups* that are eliminated together, such as the six of a pin, its blocks from
//! `Entries`; `Factor` works on all threads, solves for eight right-hand sides at once and
//! gives blocks of its inverse, and `largest` finds eigenvectors of what can be applied to
//! a `Block`. One `Symbolic` serves any number of factors. Why both:
//! docs/decisions/0016-own-multifrontal-factor.md.
//!
//! The room knows nothing of bodies, meshes or energies.
//!
//! | file | what it does | source |
//! |---|---|---|
//! | `matrix` | triplets, compressed columns | |
//! | `cholesky` | factor of a matrix in compressed columns | `faer` |
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
mod cholesky;
mod error;
mod etree;
mod factor;
mod front;
mod inverse;
mod lanczos;
mod matrix;
mod ordering;
mod panel;
mod parallel;
mod solve;
mod symbolic;
mod tall;

pub use cholesky::{Cholesky, Ordering};
pub use error::NotPositiveDefinite;
pub use matrix::{SymmetricMatrix, Triplets};

pub(crate) use block::{Block, orthonormalise, project_out};
pub(crate) use error::Halt;
pub(crate) use etree::Last;
pub(crate) use factor::Factor;
pub(crate) use lanczos::{Operator, largest, random_block};
pub(crate) use ordering::elimination_order;
pub(crate) use panel::RHS;
pub(crate) use parallel::{map_chunks, map_range, worthwhile};
pub(crate) use symbolic::{Entries, Symbolic};
