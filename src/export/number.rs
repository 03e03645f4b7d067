//! Numbers as cut files carry them.

/// A length or coordinate in mm, to 1e-6 mm.
pub(super) fn length(mm: f64) -> String {
    number(mm, 6)
}

/// A bulge, to 1e-10: the tangent of a quarter of an angle kept to 1e-7 degrees.
pub(super) fn bulge(tangent: f64) -> String {
    number(tangent, 10)
}

/// Plain decimals without an exponent, trailing zeros or a negative zero.
fn number(value: f64, decimals: usize) -> String {
    debug_assert!(value.is_finite(), "a sheet holds finite numbers only");
    let text = format!("{value:.decimals$}");
    match text.trim_end_matches('0').trim_end_matches('.') {
        "-0" => "0".to_owned(),
        trimmed => trimmed.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_plain_and_short() {
        let written =
            [0.0, -0.0, -4e-7, 100.0, -12.5, 1.0 / 3.0, 1e-6, 123_456.0].map(length);
        assert_eq!(
            written,
            ["0", "0", "0", "100", "-12.5", "0.333333", "0.000001", "123456"]
        );
        assert_eq!(bulge(0.414_213_562_373_095), "0.4142135624");
    }
}
