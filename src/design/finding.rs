//! What a design could not do, with its place and what would help.

use crate::design::planarise::PlanariseError;
use crate::diagnostic::{Located, Place};
use miette::Diagnostic;
use thiserror::Error;

/// What [`design`](super::design) finds.
#[derive(Debug, Clone, PartialEq, Error, Diagnostic)]
#[allow(missing_docs, reason = "the messages say it")]
pub enum ChainFinding {
    #[error("no directions could be found on the surface's {triangles} triangles")]
    #[diagnostic(
        code(design::no_solution),
        help(
            "look for slivers and for triangles of very different size; remesh the surface"
        )
    )]
    NoSolution { triangles: usize },

    #[error("lines cannot close around the handles of the surface")]
    #[diagnostic(
        code(design::no_whole_numbers),
        help("cut the surface open along a line where a joint may be seen")
    )]
    NoWholeNumbers,

    #[error(
        "directions turn so often that {count} whole numbers would have to be found for cells \
         of {cell_mm:.1} mm"
    )]
    #[diagnostic(
        code(design::too_many_singular),
        help("smooth the surface, or take larger cells (--cell)")
    )]
    TooManySingular { count: usize, cell_mm: f64 },

    #[error(
        "the net of lines folds over in {count} triangles, the first near ({:.1}, {:.1}, \
         {:.1}), with cells of {cell_mm:.1} mm",
        at[0],
        at[1],
        at[2]
    )]
    #[diagnostic(
        code(design::folded),
        help("take smaller cells (--cell), or smooth the surface near that place")
    )]
    Folded { count: usize, at: [f64; 3], cell_mm: f64 },

    #[error(
        "{count} lines meet no other, the first near ({:.1}, {:.1}, {:.1})",
        at[0],
        at[1],
        at[2]
    )]
    #[diagnostic(
        code(design::lines_lost),
        help("this is a fault of finwright; another --cell will most likely work")
    )]
    LinesLost { count: usize, at: [f64; 3] },

    #[error(
        "the net does not close as the surface does (Euler number {found} instead of \
         {wanted}) with cells of {cell_mm:.1} mm"
    )]
    #[diagnostic(
        code(design::holes_lost),
        help(
            "holes or necks narrower than a cell get lost: take smaller cells (--cell)"
        )
    )]
    HolesLost { found: i64, wanted: i64, cell_mm: f64 },

    #[error("{count} faces inside are no quads")]
    #[diagnostic(
        code(design::no_quads),
        help("this is a fault of finwright; another --cell will most likely work")
    )]
    NoQuads { count: usize },

    #[error("fins do not run along the boundary: with them there was no valid net")]
    #[diagnostic(
        code(design::alignment_given_up),
        severity(Warning),
        help("take smaller cells (--cell), or accept trimmed cells (--align none)")
    )]
    AlignmentGivenUp,

    #[error(
        "fins do not run along the boundary: axes would have turned by up to {turn_deg:.1}°"
    )]
    #[diagnostic(
        code(design::alignment_turns),
        severity(Warning),
        help("take smaller cells (--cell), or ask for it with --align boundary")
    )]
    AlignmentTurns { turn_deg: f64 },

    #[error("fins do not follow the lines inside: with them there was no valid net")]
    #[diagnostic(
        code(design::following_given_up),
        severity(Warning),
        help(
            "take smaller cells (--cell), or give fewer and smoother curves (--follow)"
        )
    )]
    FollowingGivenUp,

    #[error(
        "curve {curve} of the file is not on the surface: it is shorter than a triangle"
    )]
    #[diagnostic(
        code(design::curve_missed),
        severity(Warning),
        help("curves are in the surface's own units, and lie on it")
    )]
    CurveMissed { curve: usize },

    #[error(
        "the two families swap on a way around the surface, so that they cannot have lengths \
         of their own: all fins are about {cell_mm:.1} mm long"
    )]
    #[diagnostic(
        code(design::cells_alike),
        severity(Warning),
        help(
            "ask for no nodes of three and five fins (--singular none), or for one length"
        )
    )]
    CellsAlike { cell_mm: f64 },

    #[error(
        "({:.1}, {:.1}, {:.1}) is nearest to the vertex of another wanted node, or to none",
        at[0],
        at[1],
        at[2]
    )]
    #[diagnostic(
        code(design::singular_together),
        help("keep singular nodes apart by two cells, or give a finer surface")
    )]
    SingularTogether { at: [f64; 3] },

    #[error(
        "the wanted nodes have {sum} fins fewer than four each; on this closed surface it must \
         be {wanted}"
    )]
    #[diagnostic(
        code(design::singular_sum),
        help("add nodes of three fins, or of five, until the sum is right")
    )]
    SingularSum { sum: i32, wanted: i64 },

    #[error(
        "{:.0} % of the fins are 0.7 to 1.4 times as long as wanted, before {:.0} %; for it \
         axes turn by up to {:.1}°, before {:.1}°",
        after.0 * 100.0,
        before.0 * 100.0,
        after.1,
        before.1
    )]
    #[diagnostic(
        code(design::evened),
        severity(Advice),
        help("leave `--even` out if axes should keep nearer to the wanted ones")
    )]
    Evened { before: (f64, f64), after: (f64, f64) },
}

impl From<ChainFinding> for PlanariseError {
    fn from(fact: ChainFinding) -> Self {
        Self::Refused(vec![fact.into()])
    }
}

impl Located for ChainFinding {
    fn place(&self) -> Place {
        Place::default()
    }
}
