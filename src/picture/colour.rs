//! The colours that mean something in pictures: two scales and the tints of parts.

/// Colours from a low to a high value, evenly apart; red, green and blue to 255.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ColourScale(&'static [[f64; 3]]);

/// From pale over yellow to red: how much of what should be none.
pub const HEAT: ColourScale =
    ColourScale(&[[233.0, 240.0, 244.0], [250.0, 214.0, 92.0], [214.0, 38.0, 32.0]]);

/// Blue over pale yellow to red (after ColorBrewer's RdYlBu, for the colour-blind too).
pub const BLUE_TO_RED: ColourScale = ColourScale(&[
    [44.0, 123.0, 182.0],
    [171.0, 217.0, 233.0],
    [255.0, 255.0, 191.0],
    [253.0, 174.0, 97.0],
    [215.0, 25.0, 28.0],
]);

/// Light tints for parts, neighbours in the list well apart.
pub const TINTS: [[u8; 3]; 8] = [
    [221, 234, 247],
    [253, 235, 208],
    [223, 242, 223],
    [245, 224, 236],
    [255, 247, 205],
    [226, 225, 245],
    [214, 242, 240],
    [240, 232, 220],
];

impl ColourScale {
    /// The colour of a share from 0 to 1; what is beyond has the colour of the end.
    pub fn at(&self, share: f64) -> [f64; 3] {
        let Self(stops) = self;
        let place = share.clamp(0.0, 1.0) * (stops.len() - 1) as f64;
        let stop = (place as usize).min(stops.len() - 2);
        let share = place - stop as f64;
        std::array::from_fn(|k| {
            stops[stop][k] * (1.0 - share) + stops[stop + 1][k] * share
        })
    }

    /// Its colours from low to high, as shares of full light.
    pub fn stops(&self) -> Vec<[f64; 3]> {
        self.0.iter().map(|stop| stop.map(|light| light / 255.0)).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_scale_ends_where_its_colours_do() {
        let is = |found: [f64; 3], wanted: [f64; 3]| {
            assert!(found.iter().zip(wanted).all(|(a, b)| (a - b).abs() < 1e-9));
        };
        is(HEAT.at(-1.0), [233.0, 240.0, 244.0]);
        is(HEAT.at(0.5), [250.0, 214.0, 92.0]);
        is(BLUE_TO_RED.at(7.0), [215.0, 25.0, 28.0]);
        is(BLUE_TO_RED.at(0.125), [107.5, 170.0, 207.5]);
    }
}
