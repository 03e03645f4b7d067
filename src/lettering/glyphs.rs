//! The shapes of the single-stroke font, drawn for this project.
//!
//! A glyph is written as strokes parted by `,`; a stroke as points parted by a space;
//! a point as a column digit and a row. Rows `0` to `8` go from the baseline to the top
//! of the capitals, `9` and `A` hold their accents, `a` and `b` lie one and two units
//! below the baseline. Small letters are six units high.
//!
//! Corners are cut where a pen would bend: few points, little engraving time. No line
//! of a glyph is drawn twice. A full stop is a square of one unit, the dot of an i a
//! stroke one unit long.

/// Height of the capitals in grid units.
pub(super) const CAP_ROWS: i32 = 8;
/// The lowest row.
pub(super) const LOWEST_ROW: i32 = -2;
/// The highest row, taken only by accents on capitals.
pub(super) const HIGHEST_ROW: i32 = 10;

/// A point on the grid: column and row.
pub(super) type GridPoint = (i32, i32);

/// One character as it is drawn.
#[derive(Debug, Clone, Copy)]
pub(super) struct Glyph {
    /// Width in grid units, without the gap to the next glyph.
    pub(super) width: i32,
    strokes: &'static str,
    accent: &'static str,
}

impl Glyph {
    /// How a character is drawn, or `None` where the font lacks it.
    pub(super) fn of(character: char) -> Option<Self> {
        plain(character).or_else(|| accented(character))
    }

    /// The strokes, each a chain of grid points.
    pub(super) fn strokes(&self) -> impl Iterator<Item = Vec<GridPoint>> {
        self.strokes
            .split(',')
            .chain(self.accent.split(','))
            .map(|stroke| stroke.split_whitespace().filter_map(grid_point).collect())
            .filter(|points: &Vec<GridPoint>| !points.is_empty())
    }
}

fn plain(character: char) -> Option<Glyph> {
    let row = PLAIN.iter().find(|row| row.0 == character)?;
    Some(Glyph { width: row.1, strokes: row.2, accent: "" })
}

fn accented(character: char) -> Option<Glyph> {
    let row = ACCENTED.iter().find(|row| row.0 == character)?;
    Some(Glyph { accent: row.2, ..plain(row.1)? })
}

fn grid_point(written: &str) -> Option<GridPoint> {
    let &[column, row] = written.as_bytes() else { return None };
    let digit = |letter: u8| i32::from(letter) - i32::from(b'0');
    let row = match row {
        b'A' => HIGHEST_ROW,
        b'a' => -1,
        b'b' => LOWEST_ROW,
        _ => digit(row),
    };
    Some((digit(column), row))
}

/// Character, width, strokes.
const PLAIN: &[(char, i32, &str)] = &[
    (' ', 2, ""),
    ('!', 0, "00 01, 03 08"),
    ('"', 2, "06 08, 26 28"),
    ('#', 6, "10 28, 40 58, 03 63, 05 65"),
    ('$', 4, "46 37 17 06 05 14 34 43 42 31 11 02, 28 20"),
    ('%', 6, "00 68, 07 18 27 16 07, 41 52 61 50 41"),
    ('&', 6, "60 16 17 28 38 47 46 03 01 10 30 63"),
    ('\'', 0, "06 08"),
    ('(', 2, "28 06 02 20"),
    (')', 2, "08 26 22 00"),
    ('*', 4, "23 27, 04 46, 06 44"),
    ('+', 4, "04 44, 22 26"),
    (',', 1, "11 0b"),
    ('-', 3, "04 34"),
    ('.', 1, "00 10 11 01 00"),
    ('/', 4, "00 48"),
    ('0', 5, "20 30 52 56 38 28 06 02 20, 12 46"),
    ('1', 5, "16 38 30, 10 50"),
    ('2', 5, "06 28 38 56 55 00 50"),
    ('3', 5, "06 28 38 56 55 34 53 52 30 20 02, 24 34"),
    ('4', 5, "40 48 02 52"),
    ('5', 5, "58 08 05 35 53 52 30 20 02"),
    ('6', 5, "56 38 28 06 02 20 30 52 53 35 25 03"),
    ('7', 5, "08 58 20"),
    ('8', 5, "34 53 52 30 20 02 03 24 05 06 28 38 56 55 34 24"),
    ('9', 5, "02 20 30 52 56 38 28 06 05 23 33 55"),
    (':', 1, "00 10 11 01 00, 05 15 16 06 05"),
    (';', 1, "11 0b, 05 15 16 06 05"),
    ('<', 4, "47 04 41"),
    ('=', 4, "03 43, 05 45"),
    ('>', 4, "07 44 01"),
    ('?', 4, "06 18 38 46 45 23, 20 21"),
    ('@', 6, "50 20 02 06 28 48 66 63 52 43 45 35 24 23 32 43"),
    ('A', 6, "00 13 38 53 60, 13 53"),
    ('B', 5, "00 08 38 47 45 34 04, 34 44 53 51 40 00"),
    ('C', 5, "56 38 28 06 02 20 30 52"),
    ('D', 5, "00 08 38 56 52 30 00"),
    ('E', 4, "48 08 00 40, 04 34"),
    ('F', 4, "48 08 00, 04 34"),
    ('G', 5, "56 38 28 06 02 20 30 52 54 34"),
    ('H', 5, "00 08, 50 58, 04 54"),
    ('I', 4, "08 48, 28 20, 00 40"),
    ('J', 4, "18 48 42 30 10 02"),
    ('K', 5, "00 08, 58 03, 25 50"),
    ('L', 4, "08 00 40"),
    ('M', 6, "00 08 33 68 60"),
    ('N', 5, "00 08 50 58"),
    ('O', 6, "20 40 62 66 48 28 06 02 20"),
    ('P', 5, "00 08 38 56 55 33 03"),
    ('Q', 6, "20 40 62 66 48 28 06 02 20, 33 60"),
    ('R', 5, "00 08 38 56 55 33 03, 33 50"),
    ('S', 5, "56 38 28 06 05 24 34 53 52 30 20 02"),
    ('T', 6, "08 68, 38 30"),
    ('U', 5, "08 02 20 30 52 58"),
    ('V', 6, "08 30 68"),
    ('W', 8, "08 20 46 60 88"),
    ('X', 5, "00 58, 08 50"),
    ('Y', 6, "08 34 68, 34 30"),
    ('Z', 5, "08 58 00 50, 14 44"),
    ('[', 2, "28 08 00 20"),
    ('\\', 4, "08 40"),
    (']', 2, "08 28 20 00"),
    ('^', 4, "05 28 45"),
    ('_', 5, "0a 5a"),
    ('`', 1, "08 16"),
    ('a', 4, "05 16 36 44 40, 43 13 02 01 10 30 41"),
    ('b', 4, "08 00, 04 16 36 44 42 30 10 02"),
    ('c', 4, "45 36 16 04 02 10 30 41"),
    ('d', 4, "48 40, 44 36 16 04 02 10 30 42"),
    ('e', 4, "03 43 44 36 16 04 02 10 30 41"),
    ('f', 3, "38 28 17 10, 06 36"),
    ('g', 4, "46 4a 3b 1b 0a, 44 36 16 04 02 10 30 42"),
    ('h', 4, "08 00, 04 16 36 44 40"),
    ('i', 2, "06 16 11 20, 17 18"),
    ('j', 2, "26 2a 1b 0b, 27 28"),
    ('k', 4, "08 00, 46 02, 24 40"),
    ('l', 2, "08 01 10 20"),
    ('m', 6, "00 06, 04 16 26 34 30, 34 46 56 64 60"),
    ('n', 4, "00 06, 04 16 36 44 40"),
    ('o', 4, "10 30 42 44 36 16 04 02 10"),
    ('p', 4, "0b 06, 04 16 36 44 42 30 10 02"),
    ('q', 4, "4b 46, 44 36 16 04 02 10 30 42"),
    ('r', 3, "00 06, 04 16 36"),
    ('s', 4, "45 36 16 05 04 13 33 42 41 30 10 01"),
    ('t', 3, "18 11 20 30, 06 36"),
    ('u', 4, "06 02 10 30 42, 46 40"),
    ('v', 4, "06 20 46"),
    ('w', 6, "06 20 34 40 66"),
    ('x', 4, "00 46, 06 40"),
    ('y', 4, "06 20, 46 20 1b"),
    ('z', 4, "06 46 00 40"),
    ('{', 3, "38 28 17 15 04 13 11 20 30"),
    ('|', 2, "1b 19"),
    ('}', 3, "08 18 27 25 34 23 21 10 00"),
    ('~', 6, "03 15 25 43 53 65"),
    ('°', 3, "15 25 36 37 28 18 07 06 15"),
    ('×', 4, "02 46, 06 42"),
    ('±', 4, "05 45, 23 27, 01 41"),
    ('·', 1, "04 14 15 05 04"),
    ('µ', 4, "0b 06, 02 10 30 42, 46 40"),
    ('→', 6, "04 64, 46 64 42"),
    ('↑', 4, "20 28, 06 28 46"),
    ('ß', 4, "00 06 18 28 37 35 24 34 43 41 30 20"),
];

/// Character, the plain character below it, accent.
const ACCENTED: &[(char, char, &str)] = &[
    ('ä', 'a', "17 18, 37 38"),
    ('ö', 'o', "17 18, 37 38"),
    ('ü', 'u', "17 18, 37 38"),
    ('Ä', 'A', "19 1A, 59 5A"),
    ('Ö', 'O', "29 2A, 49 4A"),
    ('Ü', 'U', "19 1A, 49 4A"),
    ('é', 'e', "27 39"),
    ('è', 'e', "19 27"),
    ('à', 'a', "19 27"),
    ('ç', 'c', "20 2a 1b"),
    ('ñ', 'n', "07 18 37 48"),
];

#[cfg(test)]
mod tests {
    use super::*;

    type Line = (GridPoint, GridPoint);

    fn font() -> impl Iterator<Item = (char, Glyph)> {
        let characters = PLAIN.iter().map(|r| r.0).chain(ACCENTED.iter().map(|r| r.0));
        characters.map(|c| (c, Glyph::of(c).unwrap()))
    }

    fn lines(glyph: &Glyph) -> Vec<Line> {
        let pairs = |s: Vec<GridPoint>| s.windows(2).map(|w| (w[0], w[1])).collect();
        glyph.strokes().flat_map(|s| -> Vec<Line> { pairs(s) }).collect()
    }

    /// Whether two lines share more than a point.
    fn overlap((a, b): Line, (c, d): Line) -> bool {
        let (ux, uy) = (b.0 - a.0, b.1 - a.1);
        let along = |p: GridPoint| ux * (p.0 - a.0) + uy * (p.1 - a.1);
        let across = |p: GridPoint| ux * (p.1 - a.1) - uy * (p.0 - a.0);
        let (low, high) = (along(c).min(along(d)), along(c).max(along(d)));
        across(c) == 0 && across(d) == 0 && low.max(0) < high.min(along(b))
    }

    /// Points along a glyph, in sixteenths of a grid unit.
    fn samples(glyph: &Glyph) -> Vec<GridPoint> {
        let between = |(a, b): Line| {
            (0..=16).map(move |i| (a.0 * (16 - i) + b.0 * i, a.1 * (16 - i) + b.1 * i))
        };
        lines(glyph).into_iter().flat_map(between).collect()
    }

    /// Square of how far `from` strays from `to` at most, in sixteenths of a unit.
    fn straying(from: &[GridPoint], to: &[GridPoint]) -> i32 {
        let square = |a: GridPoint, b: GridPoint| (a.0 - b.0).pow(2) + (a.1 - b.1).pow(2);
        let nearest =
            |a: &GridPoint| to.iter().map(|&b| square(*a, b)).min().unwrap_or(i32::MAX);
        from.iter().map(nearest).max().unwrap_or(0)
    }

    #[test]
    fn every_point_of_the_table_can_be_read() {
        let written = PLAIN.iter().map(|r| r.2).chain(ACCENTED.iter().map(|r| r.2));
        for word in written.flat_map(|s| s.split([' ', ','])).filter(|w| !w.is_empty()) {
            let (column, row) = grid_point(word).expect(word);
            assert!((0..=9).contains(&column), "{word}");
            assert!((LOWEST_ROW..=HIGHEST_ROW).contains(&row), "{word}");
        }
    }

    #[test]
    fn every_stroke_lies_inside_the_box_of_its_glyph() {
        for (character, glyph) in font() {
            for (column, _) in glyph.strokes().flatten() {
                assert!((0..=glyph.width).contains(&column), "{character}");
            }
        }
    }

    #[test]
    fn no_line_of_a_glyph_runs_over_another() {
        for (character, glyph) in font() {
            let lines = lines(&glyph);
            for (i, &line) in lines.iter().enumerate() {
                assert_ne!(line.0, line.1, "{character}: a line without length");
                for &other in &lines[i + 1..] {
                    assert!(!overlap(line, other), "{character}: {line:?} {other:?}");
                }
            }
        }
    }

    #[test]
    fn each_character_is_drawn_once() {
        let mut characters: Vec<char> = font().map(|(c, _)| c).collect();
        characters.sort_unstable();
        assert!(characters.windows(2).all(|w| w[0] != w[1]));
    }

    #[test]
    fn any_two_glyphs_stray_from_each_other_by_a_unit() {
        let inked: Vec<_> = font().map(|(c, g)| (c, samples(&g))).collect();
        for (i, (a, ink)) in inked.iter().enumerate() {
            for (b, other) in &inked[i + 1..] {
                let apart = straying(ink, other).max(straying(other, ink));
                assert!(apart >= 16 * 16, "{a} and {b} look alike");
            }
        }
    }
}
