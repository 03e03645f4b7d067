//! Every numerical slack, by its meaning.

/// How far arcs may be off when a curve is written as straight lines, mm.
pub const ARC_SAGITTA_MM: f64 = 0.002;

/// What a structure has to keep; from the template's gate where it says so.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tolerance {
    /// Worst planarity of a fin that is not mentioned, as a share of its diameter.
    pub planarity_warn: f64,
    /// Worst planarity of a fin that can be made.
    pub planarity_limit: f64,
    /// Least angle between a node axis and a fin's edge, radians.
    pub axis_edge_angle: f64,
    /// Largest kink at which two fins still count as running on, radians.
    pub straight_kink: f64,
}

impl Default for Tolerance {
    fn default() -> Self {
        Self {
            planarity_warn: 1e-4,
            planarity_limit: 1e-3,
            axis_edge_angle: 10_f64.to_radians(),
            straight_kink: 30_f64.to_radians(),
        }
    }
}

/// Lengths below this are taken for nothing: nodes in one place, faces without area, mm.
pub const NO_LENGTH_MM: f64 = 1e-6;

/// Nodes nearer than this share of the median fin length, and not joined, were meant to be.
pub const NEAR_SHARE: f64 = 0.01;

/// Folds that differ by less count as equal, radians.
pub const SAME_FOLD: f64 = 1e-6;

/// Lengths that differ by less count as equal where a choice hangs on it, mm.
pub const SAME_LENGTH_MM: f64 = 1e-6;

/// `vn` that differ by less in direction are one axis, radians: exporters round.
pub const SAME_AXIS: f64 = 1e-4;

/// Axes shorter than this point nowhere.
pub const NO_AXIS: f64 = 1e-12;

/// Nodes within this share of a structure's height of its lowest one count as lowest.
pub const SAME_HEIGHT: f64 = 1e-3;

/// Coordinates in files are multiples of this, mm.
pub const WRITTEN_MM: f64 = 1e-6;

/// How far the rounding of a placement may move an outline, mm.
pub const PLACED_MM: f64 = 2e-6;

/// Room beside the parts of a strip, mm.
pub const ROOM_MM: f64 = 1e-5;

/// How much larger than the free area a part may be by rounding and still fit it, mm: with
/// the rounding of its placement it stays within [`PLACED_MM`].
pub const EXACT_FIT_MM: f64 = 5e-7;

/// Seats on a sheet that cost less than this apart cost the same, mm.
pub const SAME_COST_MM: f64 = 1e-9;

/// How far Bézier curves may be off the arcs that they stand for, mm.
pub const BEZIER_MM: f64 = 1e-5;

/// Directions whose squared length is off 1 by less are unit vectors, but for rounding.
pub const UNIT_LENGTH: f64 = 8.0 * f64::EPSILON;

/// Farthest that anything may be from the origin, mm; there coordinates are still kept to
/// 1.2e-7 mm, less than what is written.
pub const FARTHEST_MM: f64 = 1e9;

/// A rotation that moves no point by more than this share of the body's radius is none:
/// the body touches one axis only, or one point.
pub const NO_ROTATION: f64 = 1e-10;

/// Singular values of the compatibility matrix, whose largest is 1, that count as zero.
pub const NO_RESISTANCE: f64 = 1e-11;

/// Sleeve deviation over sleeve motion below which a mode is looked at again by
/// orthogonal means before it is called resisted.
pub const SUSPECT_RESISTANCE: f64 = 1e-6;

/// Stiffness added to each unknown, as a share of its own, so that factorising a mechanism
/// does not fail.
pub const SHIFT: f64 = 1e-13;

/// Lanczos stops when a mode's residual is below this share of its eigenvalue.
pub const MODE_RESIDUAL: f64 = 1e-9;

/// Brackets of the amplification narrower than this, upper over lower, are not tightened.
pub const BRACKET_WIDTH: f64 = 1.1;

/// Sways that differ by less than this share are equal where a choice hangs on it: symmetric
/// nodes sway alike but for rounding.
pub const SAME_SWAY: f64 = 1e-6;

/// A vector that shrinks below this share of its length when made orthogonal is gone.
pub const VANISHED: f64 = 1e-10;

/// A column whose square shrinks below this share when made orthogonal by products loses
/// too many digits; it is done column by column then.
pub const NEARLY_PARALLEL: f64 = 1e-9;

/// Contact forces that miss a unit load by more than this are no equilibrium.
pub const FORCE_BALANCE: f64 = 1e-6;

/// Least weight of a sleeve when bounds are tightened; below it, bases of motions lose
/// digits.
pub const LEAST_WEIGHT: f64 = 1e-7;

/// A node that moves less than this share of the one that moves most stands still.
pub const STANDS_STILL: f64 = 1e-6;

/// Figures of rigidity below this are rounding and are written as 0.
pub const ROUNDING: f64 = 1e-13;

/// Planes of a drawing that lean by less, as rise over run, are the drawing's own.
pub const UPRIGHT: f64 = 1e-6;

/// Ends of lines that count as joined when a drawing is read back, mm.
pub const JOINED_MM: f64 = 0.01;

/// How far a drawn corner may be off the listed shape to count as the same corner when a
/// part is looked for, mm.
pub const SAME_SHAPE_MM: f64 = 0.02;

/// How far a drawn line may be off where it should be unless the template says otherwise, mm:
/// slits, corners, axes, kerf.
pub const PROOF_LIMIT_MM: f64 = 0.01;

/// How far folds may be off unless the template says otherwise, degrees.
pub const PROOF_LIMIT_DEG: f64 = 0.001;

/// How far a slot of a connector may be turned from its fin, degrees.
pub const SLOT_TURN_DEG: f64 = 0.01;

/// How far a corner, wall or hole is searched from where it should be, mm.
pub const PROOF_REACH_MM: f64 = 1.5;

/// How far a part may lie from where it is listed and count as in its place, mm.
pub const IN_PLACE_MM: f64 = 0.01;

/// How far lengths on one layer may differ between formats, as a share.
pub const SAME_LENGTH: f64 = 2e-4;

/// Slack of spacing and margin in files read back, mm.
pub const SPACING_SLACK_MM: f64 = 1e-3;

/// Sides of a drawn line whose directions differ by less meet without a corner, radians.
pub const SMOOTH_CORNER: f64 = 1e-6;

/// Scales of a whole drawing that differ by less are taken for equal.
pub const SAME_SCALE: f64 = 2e-3;

/// Fins whose corners differ by less have one shape, mm: a tenth of a common clearance.
pub const CONGRUENT_MM: f64 = 0.01;

/// Fins that leave a node nearer to each other than this lie upon each other, radians:
/// plates would have to stop 570 times their thickness from the axis.
pub const UPON_EACH_OTHER: f64 = 1.75e-3;

/// Plates that reach into each other by less only touch, mm: rounding of planar fins.
pub const PLATES_TOUCH_MM: f64 = 1e-3;

/// A fin counts as exactly plane below this share of its diameter.
pub const PLANAR: f64 = 1e-9;

/// Fins that are plane to this share of their diameter need no planarising: 0.01 %, some
/// hundredths of a millimetre on the largest sheet.
pub const PLANAR_ENOUGH: f64 = 1e-4;

/// Damping of normal equations whose rows are in fin lengths: less cannot be told from none.
pub const LEAST_DAMPING: f64 = 1e-8;

/// Angle by which a boundary turns at a corner of the base mesh, radians.
pub const CORNER_TURN: f64 = std::f64::consts::FRAC_PI_4;
/// Distance that the nester keeps beyond what is asked, for the rounding of placements to
/// 1e-6 mm and 1e-7 degrees, mm.
pub const NEST_SLACK_MM: f64 = 2e-5;

/// How far the nester's simplified outline may be outside the true one, mm, ...
pub const NEST_SIMPLIFY_MM: f64 = 0.02;

/// ... and as a share of the part's size.
pub const NEST_SIMPLIFY: f64 = 2e-4;

/// Share by which a loss is followed beyond its bound, for rounding.
pub const NEST_BOUND: f64 = 1e-9;

/// Share of its area that loops of a drawn line may make for it to be nested all the same.
pub const NEST_LOOPS: f64 = 1e-3;

/// Vertices of a surface nearer to each other than this share of its diagonal are one.
pub const WELD: f64 = 1e-6;

/// Triangles with less than this share of the square of a surface's diagonal have no area.
pub const NO_AREA: f64 = 1e-14;

/// Axes that change by less than this over a whole surface are parallel, radians.
pub const PARALLEL_AXES: f64 = 1e-6;

/// Weight of no direction at all, that a field without a goal may be found.
pub const LEAST_GOAL: f64 = 1e-9;

/// Stiffness that holds a map which nothing pins, beside that of even spacing.
pub const PINNED: f64 = 1e-10;

/// Fins of a designed structure are plane to this share of their diameter: 1e-6 %.
pub const DESIGNED_PLANAR: f64 = 1e-8;

/// How far a mirror image may lie off its surface, as a share of the root of its area, and
/// how far axes and mirrors may be off their directions.
pub const SYMMETRIC: f64 = 1e-4;

/// Vertices nearer to a mirror than this share of the root of the area lie on it.
pub const ON_MIRROR: f64 = 1e-5;
