//! A page of the guide: text in Helvetica and filled shapes, in millimetres from the lower
//! left corner.

use crate::geometry::Point2;
use pdf_writer::{Content, Name, Str};

/// A4.
pub(super) const SIZE: [f64; 2] = [210.0, 297.0];

/// What is left free around it.
pub(super) const MARGIN: f64 = 16.0;

pub(super) const POINTS_PER_MM: f64 = 72.0 / 25.4;

/// Names of the two fonts in the resources of a page: regular and bold.
pub(super) const FONTS: [(&[u8], &[u8]); 2] =
    [(b"R", b"Helvetica"), (b"B", b"Helvetica-Bold")];

/// How text is set.
#[derive(Debug, Clone, Copy)]
pub(super) struct Set {
    /// Height of a line's letters, mm (PDF's font size).
    pub size: f64,
    /// Whether it is bold.
    pub bold: bool,
}

pub(super) const PLAIN: Set = Set { size: 3.4, bold: false };
pub(super) const BOLD: Set = Set { size: 3.6, bold: true };

/// A page that is being written.
pub(super) struct GuidePage {
    content: Content,
}

impl GuidePage {
    pub(super) fn new() -> Self {
        let mut content = Content::new();
        let scale = POINTS_PER_MM as f32;
        content.transform([scale, 0.0, 0.0, scale, 0.0, 0.0]);
        Self { content }
    }

    /// One line of text that starts at a point.
    pub(super) fn text(&mut self, at: Point2, set: Set, text: &str) {
        let [(regular, _), (bold, _)] = FONTS;
        self.content.set_fill_rgb(0.0, 0.0, 0.0);
        self.content.begin_text();
        let font = if set.bold { bold } else { regular };
        self.content.set_font(Name(font), set.size as f32);
        self.content.next_line(mm(at.x), mm(at.y));
        self.content.show(Str(&latin(text)));
        self.content.end_text();
    }

    /// A four-cornered shape, filled and with its edge.
    pub(super) fn shape(&mut self, corners: &[Point2; 4], fill: [f32; 3]) {
        let [r, g, b] = fill;
        self.content.set_fill_rgb(r, g, b);
        self.content.set_stroke_rgb(0.35, 0.4, 0.44);
        self.content.set_line_width(0.12);
        self.outline(corners);
        self.content.fill_nonzero_and_stroke();
    }

    /// The edge of a shape only.
    pub(super) fn edge(&mut self, corners: &[Point2; 4], colour: [f32; 3]) {
        let [r, g, b] = colour;
        self.content.set_stroke_rgb(r, g, b);
        self.content.set_line_width(0.3);
        self.outline(corners);
        self.content.stroke();
    }

    fn outline(&mut self, corners: &[Point2; 4]) {
        self.content.move_to(mm(corners[0].x), mm(corners[0].y));
        for corner in &corners[1..] {
            self.content.line_to(mm(corner.x), mm(corner.y));
        }
        self.content.close_path();
    }

    /// The page's content, not packed: the file can be searched like all others of a job.
    pub(super) fn bytes(self) -> Vec<u8> {
        self.content.finish().into_vec()
    }
}

/// To a hundredth: numbers without exponents, and short.
fn mm(value: f64) -> f32 {
    ((value * 100.0).round() / 100.0 + 0.0) as f32
}

/// Text in WinAnsi, which is Latin-1 for what is written here.
fn latin(text: &str) -> Vec<u8> {
    text.chars().map(|c| u8::try_from(u32::from(c)).unwrap_or(b'?')).collect()
}

/// Text broken into lines no wider than `width`, mm.
pub(super) fn lines(text: &str, set: Set, width: f64) -> Vec<String> {
    let mut lines = vec![String::new()];
    for word in text.split_whitespace() {
        let last = lines.len() - 1;
        let longer = format!("{} {word}", lines[last]);
        let longer = longer.trim_start();
        if lines[last].is_empty() || measured(longer, set) <= width {
            lines[last] = longer.to_owned();
        } else {
            lines.push(word.to_owned());
        }
    }
    lines
}

/// Width of a line, mm; bold letters are wider by a tenth at most.
fn measured(text: &str, set: Set) -> f64 {
    let units: u32 = text.chars().map(letter_width).sum();
    f64::from(units) * set.size / 1000.0 * if set.bold { 1.1 } else { 1.0 }
}

/// Width of a letter of Helvetica in thousandths of its size (Adobe's font metrics).
fn letter_width(letter: char) -> u32 {
    match letter {
        'i' | 'j' | 'l' | '\'' => 222,
        ' ' | '!' | ',' | '.' | '/' | ':' | ';' | 'I' | 'f' | 't' | '[' | ']' => 278,
        '-' | '(' | ')' | 'r' => 333,
        'c' | 'k' | 's' | 'v' | 'x' | 'y' | 'z' | 'J' => 500,
        'F' | 'T' | 'Z' => 611,
        'A' | 'B' | 'E' | 'K' | 'P' | 'S' | 'V' | 'X' | 'Y' | '&' => 667,
        'C' | 'D' | 'H' | 'N' | 'R' | 'U' | 'w' => 722,
        'G' | 'O' | 'Q' => 778,
        'M' | 'm' => 833,
        '%' => 889,
        'W' => 944,
        '@' => 1015,
        _ => 584,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_are_no_wider_than_asked_and_hold_every_word() {
        let text =
            "Zip it in from one end, node after node, and mind the bend at node 12.";
        let broken = lines(text, PLAIN, 40.0);
        assert!(broken.len() > 1);
        assert!(broken.iter().all(|line| measured(line, PLAIN) <= 40.0));
        assert_eq!(broken.join(" "), text);
    }
}
