//! How far from a node axis plates must stop to stay clear of each other.
//!
//! Seen along the axis every fin is a bar that starts on the axis. Two bars of thicknesses
//! t and u at the angle b meet in a corner; the first is clear of the second from
//! r = (u + t cos b) / (2 sin b) on. For equal plates this
//! is t / (2 tan(b/2)), and nothing from 180° on.

use crate::geometry::trig;
use std::f64::consts::PI;

/// Distance from the axis at which a plate of `thickness` is clear of one of
/// `other_thickness` that leaves the axis at the angle `between`, radians in (0, 2π); mm.
pub(crate) fn clear_of(thickness: f64, other_thickness: f64, between: f64) -> f64 {
    let between = between.min(2.0 * PI - between);
    let sin = trig::sin(between);
    if sin <= 0.0 {
        return 0.0;
    }
    ((other_thickness + thickness * trig::cos(between)) / (2.0 * sin)).max(0.0)
}

/// Distance from the axis at which the plate at place `me` is clear of all others, which
/// leave the axis at the `bearings`, radians; all plates are `thickness` thick; mm.
pub(crate) fn setback(bearings: &[f64], me: usize, thickness: f64) -> f64 {
    let others = bearings.iter().enumerate().filter(|&(other, _)| other != me);
    let clear = others.map(|(_, bearing)| {
        let between = (bearing - bearings[me]).rem_euclid(2.0 * PI);
        clear_of(thickness, thickness, between)
    });
    clear.fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Thickness, angle in degrees, setback: by the half-angle formula t / (2 tan(b/2)) in
    /// another program (numpy), to 1e-4 mm.
    const TABLE: [(f64, f64, f64); 18] = [
        (2.0, 25.0, 4.510709),
        (2.0, 45.0, 2.414214),
        (2.0, 60.0, 1.732051),
        (2.0, 90.0, 1.000000),
        (2.0, 120.0, 0.577350),
        (2.0, 150.0, 0.267949),
        (3.0, 25.0, 6.766063),
        (3.0, 45.0, 3.621320),
        (3.0, 60.0, 2.598076),
        (3.0, 90.0, 1.500000),
        (3.0, 120.0, 0.866025),
        (3.0, 150.0, 0.401924),
        (5.0, 25.0, 11.276771),
        (5.0, 45.0, 6.035534),
        (5.0, 60.0, 4.330127),
        (5.0, 90.0, 2.500000),
        (5.0, 120.0, 1.443376),
        (5.0, 150.0, 0.669873),
    ];

    #[test]
    fn setbacks_are_those_of_the_half_angle_formula() {
        for (thickness, degrees, wanted) in TABLE {
            let found = setback(&[0.3, 0.3 + degrees.to_radians()], 0, thickness);
            assert!((found - wanted).abs() < 1e-4, "{thickness} {degrees} {found}");
        }
    }

    #[test]
    fn the_nearest_neighbour_on_either_side_decides() {
        let bearings = [0.0, 100.0, 220.0, 330.0].map(f64::to_radians);
        let found = setback(&bearings, 0, 3.0);
        assert!((found - clear_of(3.0, 3.0, 30_f64.to_radians())).abs() < 1e-12);
        assert!(setback(&[0.0, PI], 0, 3.0).abs() < 1e-12);
    }

    #[test]
    fn unlike_plates_touch_with_one_corner() {
        // A thin plate across a thick one stops at the thick one's face.
        assert!((clear_of(1.0, 5.0, PI / 2.0) - 2.5).abs() < 1e-12);
        assert!((clear_of(5.0, 1.0, PI / 2.0) - 0.5).abs() < 1e-12);
    }
}
