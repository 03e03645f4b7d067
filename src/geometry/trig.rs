//! Trigonometry that gives the same bits on every machine.
//!
//! The standard library's functions come from the system and may differ in the last
//! place; sheets must not. These are `libm`'s, compiled in.

/// Sine of an angle in radians.
pub fn sin(angle: f64) -> f64 {
    libm::sin(angle)
}

/// Cosine of an angle in radians.
pub fn cos(angle: f64) -> f64 {
    libm::cos(angle)
}

/// Tangent of an angle in radians.
pub fn tan(angle: f64) -> f64 {
    libm::tan(angle)
}

/// Angle of the vector `(x, y)` in radians, in (-π, π].
pub fn atan2(y: f64, x: f64) -> f64 {
    libm::atan2(y, x)
}

/// Arc tangent in radians.
pub fn atan(tangent: f64) -> f64 {
    libm::atan(tangent)
}
