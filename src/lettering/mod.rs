//! Lettering for engraving: one line of text as strokes a laser follows once.
//!
//! The font is single-stroke and proportional, made to be read when 3 mm high: 0 has a
//! slash, 1 a flag and a foot, I serifs. It knows printable ASCII and what drawings and
//! names in the neighbourhood need: `° × ± · µ → ↑ ä ö ü Ä Ö Ü ß é è à ç ñ`.
//!
//! Not for setting paragraphs: no line breaks, no kerning.

mod glyphs;

use crate::geometry::Point2;
use crate::lettering::glyphs::{CAP_ROWS, Glyph, HIGHEST_ROW, LOWEST_ROW};

/// How far `g j p q y ç µ , ; _ |` reach below the baseline at most, in cap heights.
pub const DESCENT: f64 = -LOWEST_ROW as f64 / CAP_ROWS as f64;

/// How far accents on capitals reach above the baseline at most, in cap heights.
pub const ASCENT: f64 = HIGHEST_ROW as f64 / CAP_ROWS as f64;

/// Space between two characters in grid units.
const GAP: i32 = 2;

/// What stands in for a character the font lacks.
const STAND_IN: char = '_';

/// Strokes of one line of lettering, baseline on the x axis, starting at the origin.
///
/// # Guarantees
///
/// Every stroke has at least two points and lies within 0 to `width` and within
/// -[`DESCENT`] to [`ASCENT`] cap heights. No two strokes run over each other.
#[derive(Debug, Clone, PartialEq)]
pub struct Lettering {
    /// Open chains of straight lines, in reading order, mm; a closed shape ends where it
    /// starts.
    pub strokes: Vec<Vec<Point2>>,
    /// From the start of the first character to the end of the last, mm.
    pub width: f64,
    /// From the baseline to the top, mm: the cap height, or more under accents.
    pub height: f64,
}

/// The text holds a character that the font lacks.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error, miette::Diagnostic)]
#[error("the engraving font has no {character:?} (U+{:04X})", u32::from(*character))]
#[diagnostic(
    code(lettering::unknown_character),
    help(
        "use printable ASCII, one of `° × ± · µ → ↑` or one of `ä ö ü Ä Ö Ü ß é è à ç ñ`"
    )
)]
pub struct UnknownCharacter {
    /// The first such character.
    pub character: char,
}

/// Draws one line of text with capitals `cap_height` mm high.
///
/// # Errors
///
/// If the font lacks a character; [`legible`] makes a text it can draw.
/// ```
/// let line = finwright::lettering::letter("S01", 4.0).unwrap();
/// assert_eq!(line.height, 4.0);
/// assert!(finwright::lettering::letter("\u{1F600}", 4.0).is_err());
/// ```
pub fn letter(text: &str, cap_height: f64) -> Result<Lettering, UnknownCharacter> {
    let unit = cap_height / f64::from(CAP_ROWS);
    let glyphs = glyphs(text)?;
    let mut strokes = Vec::new();
    let mut pen = 0;
    for glyph in &glyphs {
        let on_sheet = |(column, row): (i32, i32)| {
            Point2::new(f64::from(pen + column) * unit, f64::from(row) * unit)
        };
        strokes.extend(glyph.strokes().map(|s| s.into_iter().map(on_sheet).collect()));
        pen += glyph.width + GAP;
    }
    let height =
        strokes.iter().flatten().fold(cap_height, |top, p: &Point2| top.max(p.y));
    Ok(Lettering { strokes, width: f64::from(columns(&glyphs)) * unit, height })
}

/// Width of [`letter`]'s line without drawing it, mm.
///
/// # Errors
///
/// If the font lacks a character.
pub fn width(text: &str, cap_height: f64) -> Result<f64, UnknownCharacter> {
    Ok(f64::from(columns(&glyphs(text)?)) * (cap_height / f64::from(CAP_ROWS)))
}

/// The text with `_` for each character the font lacks, and whether there was one.
pub fn legible(text: &str) -> (String, bool) {
    let known = |c: char| if Glyph::of(c).is_some() { c } else { STAND_IN };
    let legible: String = text.chars().map(known).collect();
    let changed = legible != text;
    (legible, changed)
}

fn glyphs(text: &str) -> Result<Vec<Glyph>, UnknownCharacter> {
    text.chars().map(|c| Glyph::of(c).ok_or(UnknownCharacter { character: c })).collect()
}

/// Width of a line in grid units; no gap follows the last glyph.
fn columns(glyphs: &[Glyph]) -> i32 {
    let advances: i32 = glyphs.iter().map(|glyph| glyph.width + GAP).sum();
    (advances - GAP).max(0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use miette::Diagnostic;

    const BEYOND_ASCII: &str = "°×±·µ→↑äöüÄÖÜßéèàçñ";

    fn whole_font() -> String {
        (' '..='~').chain(BEYOND_ASCII.chars()).collect()
    }

    fn length(stroke: &[Point2]) -> f64 {
        stroke.windows(2).map(|w| (w[1] - w[0]).norm()).sum()
    }

    #[test]
    fn printable_ascii_and_the_promised_others_can_be_lettered() {
        for character in whole_font().chars() {
            let lettering = letter(&character.to_string(), 3.0).unwrap();
            assert_eq!(lettering.strokes.is_empty(), character == ' ', "{character}");
        }
    }

    #[test]
    fn strokes_stay_within_width_height_and_descent() {
        let line = letter(&whole_font(), 3.0).unwrap();
        for point in line.strokes.iter().flatten() {
            assert!((0.0..=line.width).contains(&point.x), "{point}");
            assert!((-DESCENT * 3.0..=line.height).contains(&point.y), "{point}");
        }
        assert!(line.height <= ASCENT * 3.0);
    }

    #[test]
    fn a_dot_is_long_enough_to_be_seen() {
        let line = letter(&whole_font(), 3.0).unwrap();
        assert!(line.strokes.iter().all(|stroke| length(stroke) >= 0.3));
    }

    #[test]
    fn the_width_is_known_without_drawing() {
        for text in ["", " ", "i", "S03 N117", &whole_font()] {
            let drawn = letter(text, 2.5).unwrap().width;
            assert!((width(text, 2.5).unwrap() - drawn).abs() <= 0.0, "{text}");
        }
    }

    #[test]
    fn figures_are_equally_wide() {
        let widths: Vec<_> = ('0'..='9').map(|c| width(&c.to_string(), 8.0)).collect();
        assert!(widths.iter().all(|&w| w == Ok(5.0)));
    }

    #[test]
    fn an_unknown_character_is_an_error_that_names_it() {
        let error = letter("Bogen ☃ 3", 3.0).unwrap_err();
        assert_eq!(error, UnknownCharacter { character: '☃' });
        assert_eq!(error.to_string(), "the engraving font has no '☃' (U+2603)");
        assert_eq!(error.code().unwrap().to_string(), "lettering::unknown_character");
        assert_eq!(width("a\tb", 3.0), Err(UnknownCharacter { character: '\t' }));
    }

    #[test]
    fn a_legible_text_can_always_be_lettered() {
        let cases =
            [("S03", "S03", false), ("a_b", "a_b", false), ("Łódź", "__d_", true)];
        for (text, expected, changed) in cases {
            assert_eq!(legible(text), (expected.to_owned(), changed));
            assert!(letter(expected, 3.0).is_ok());
        }
    }
}
