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

/// Folds that differ by less count as equal, radians.
pub const SAME_FOLD: f64 = 1e-6;
