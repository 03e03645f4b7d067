//! Parts of any drawing, ours or another program's, for nesting.
//!
//! Which closed line is an outline and which a hole follows from what lies in what, never
//! from layers alone: other programs name and colour theirs as they like.

use crate::drawing::{
    Curve, DrawingError, KnownLayer, is_cut, joined, read_dxf, read_svg,
};
use crate::geometry::predicates::contains;
use crate::geometry::{Contour, Point2};
use crate::tolerance::ARC_SAGITTA_MM;

/// The formats that are read.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Format {
    /// ASCII DXF.
    Dxf,
    /// SVG.
    Svg,
}

/// A part with all its lines, mm.
#[derive(Debug, Clone, PartialEq)]
pub struct DrawnPart {
    /// Counter-clockwise.
    pub outline: Contour,
    /// Clockwise.
    pub holes: Vec<Contour>,
    /// What is engraved or scored on it, and open cuts.
    pub marks: Vec<Curve>,
}

/// What is on a drawing.
#[derive(Debug, Clone, PartialEq)]
pub struct Drawn {
    /// In the order of their outlines in the file.
    pub parts: Vec<DrawnPart>,
    /// A point of each line that lies on no part.
    pub stray: Vec<Point2>,
    /// What is no line (splines, blocks, text), by kind, with its count.
    pub unread: Vec<(String, usize)>,
    /// Whether the file says in which unit it is; if not, it was taken for mm (DXF) or
    /// 1/96 inch (SVG).
    pub says_unit: bool,
}

/// A closed line that is cut.
struct Ring {
    contour: Contour,
    polygon: Vec<Point2>,
    area: f64,
}

impl Ring {
    fn new(curve: &Curve) -> Self {
        let contour = curve.contour();
        let (polygon, area) =
            (contour.flattened(ARC_SAGITTA_MM), contour.signed_area().abs());
        Self { contour, polygon, area }
    }

    /// The line as it runs around material, or around a hole.
    fn turned(&self, counter_clockwise: bool) -> Contour {
        if (self.contour.signed_area() > 0.0) == counter_clockwise {
            self.contour.clone()
        } else {
            self.contour.reversed()
        }
    }
}

/// Reads the parts of a drawing.
///
/// # Errors
/// [`DrawingError`] if the bytes are no drawing of this format.
pub fn drawn_parts(
    bytes: &[u8],
    format: Format,
    known: &[KnownLayer],
) -> Result<Drawn, DrawingError> {
    let drawing = match format {
        Format::Dxf => read_dxf(bytes, known)?,
        Format::Svg => read_svg(bytes, known)?,
    };
    // Lines on layers of other programs may be cut lines as well.
    let drawing = joined(drawing, str::is_empty);
    let curves = || drawing.curves.iter().filter(|curve| curve.layer != "SHEET");
    let is_ring =
        |curve: &&Curve| curve.closed && (is_cut(curve.layer) || curve.layer.is_empty());
    let rings: Vec<Ring> = curves().filter(is_ring).map(Ring::new).collect();
    let around = |p: Point2, smaller: f64| -> Vec<usize> {
        let larger =
            |k: &usize| rings[*k].area > smaller && contains(&rings[*k].polygon, p);
        let mut around: Vec<usize> = (0..rings.len()).filter(larger).collect();
        around.sort_by(|&a, &b| rings[a].area.total_cmp(&rings[b].area));
        around
    };
    let depths: Vec<Vec<usize>> =
        rings.iter().map(|r| around(r.contour.vertices[0].point, r.area)).collect();
    let mut part_of: Vec<Option<usize>> = vec![None; rings.len()];
    let mut parts = Vec::new();
    for (k, ring) in
        rings.iter().enumerate().filter(|(k, _)| depths[*k].len().is_multiple_of(2))
    {
        part_of[k] = Some(parts.len());
        let outline = ring.turned(true);
        parts.push(DrawnPart { outline, holes: Vec::new(), marks: Vec::new() });
    }
    for (k, ring) in
        rings.iter().enumerate().filter(|(k, _)| !depths[*k].len().is_multiple_of(2))
    {
        if let Some(part) = depths[k].first().and_then(|&outer| part_of[outer]) {
            parts[part].holes.push(ring.turned(false));
        }
    }
    let mut stray = Vec::new();
    for curve in curves().filter(|curve| !is_ring(curve)) {
        let at = curve.vertices[0].point;
        // On material, the innermost line around is an outline.
        match around(at, 0.0).first().and_then(|&inner| part_of[inner]) {
            Some(part) => parts[part].marks.push(curve.clone()),
            None => stray.push(at),
        }
    }
    let unread = drawing.unread.into_iter().map(|((kind, _), count)| (kind, count));
    Ok(Drawn { parts, stray, unread: unread.collect(), says_unit: drawing.says_unit })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::drawing::LAYERS;

    #[test]
    fn what_lies_in_what_makes_parts_holes_and_marks() {
        let svg = r##"<svg xmlns="http://www.w3.org/2000/svg" width="100mm" height="100mm" viewBox="0 0 100 100">
            <circle cx="50" cy="50" r="40" fill="none" stroke="#123456"/>
            <circle cx="50" cy="50" r="30" fill="none" stroke="#123456"/>
            <rect x="40" y="40" width="20" height="20" fill="none" stroke="#123456"/>
            <path d="M 42 42 L 58 58" fill="none" stroke="#00ffff"/>
            <path d="M 12 50 L 18 50" fill="none" stroke="#00ffff"/>
            <path d="M 1 1 L 9 1" fill="none" stroke="#00ffff"/>
            </svg>"##;
        let drawn = drawn_parts(svg.as_bytes(), Format::Svg, &LAYERS).unwrap();
        let [ring, square] = drawn.parts.as_slice() else { panic!("{drawn:?}") };
        assert_eq!((ring.holes.len(), square.holes.len()), (1, 0));
        assert!(ring.outline.signed_area() > 0.0 && ring.holes[0].signed_area() < 0.0);
        assert!(ring.outline.vertices.iter().all(|v| v.bulge > 0.0), "arcs stay arcs");
        assert_eq!((ring.marks.len(), square.marks.len()), (1, 1));
        assert_eq!(square.marks[0].layer, "ENGRAVE");
        assert_eq!((drawn.stray.len(), drawn.says_unit), (1, true));
    }

    #[test]
    fn lines_of_another_program_are_joined_to_outlines() {
        let line = |a: [i32; 2], b: [i32; 2]| {
            format!("0 LINE 8 0 10 {} 20 {} 11 {} 21 {} ", a[0], a[1], b[0], b[1])
        };
        let corners = [[0, 0], [30, 0], [30, 20], [0, 20]];
        let sides: String =
            (0..4).map(|k| line(corners[k], corners[(k + 1) % 4])).collect();
        let text = format!("0 SECTION 2 ENTITIES {sides}0 SPLINE 8 0 0 ENDSEC 0 EOF");
        let text = text.split_whitespace().collect::<Vec<_>>().join("\n");
        let drawn = drawn_parts(text.as_bytes(), Format::Dxf, &LAYERS).unwrap();
        assert_eq!(drawn.parts.len(), 1);
        assert!((drawn.parts[0].outline.signed_area() - 600.0).abs() < 1e-9);
        assert_eq!((drawn.unread, drawn.says_unit), (vec![("SPLINE".into(), 1)], false));
    }
}
