//! Parts of any drawing, ours or another program's, for nesting.
//!
//! Which closed line is an outline and which a hole follows from what lies in what, never
//! from layers alone: other programs name and colour theirs as they like. What is done along
//! a line follows from what the caller says, from our layers, from a name that says "cut" or
//! "engrave", and else from the line: closed ones are cut, open ones engraved.

use crate::drawing::chain::{ends, joined};
use crate::drawing::gaps::{Gap, explain};
use crate::drawing::overlap::meetings;
use crate::drawing::ring::Ring;
use crate::drawing::{Curve, Drawing, Source, is_cut};
use crate::geometry::{Contour, Point2};
use crate::tolerance::{ARC_SAGITTA_MM, JOINED_MM};
use std::collections::BTreeMap;

/// What is done along a line.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Purpose {
    /// It is cut.
    Cut,
    /// It is scored.
    Score,
    /// It is engraved.
    Engrave,
    /// Nothing.
    Ignore,
}

/// What the caller says about a drawing.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Rules {
    /// What is done along lines of a layer, or of a colour written `#ff0000`.
    pub layers: Vec<(String, Purpose)>,
    /// Widest gap that is closed, mm.
    pub join: f64,
}

/// A part with all its lines, mm.
#[derive(Debug, Clone, PartialEq)]
pub struct DrawnPart {
    /// Counter-clockwise.
    pub outline: Contour,
    /// Clockwise.
    pub holes: Vec<Contour>,
    /// What is engraved or scored on it, and open cuts.
    pub marks: Vec<(Purpose, Curve)>,
}

/// What is on a drawing.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Drawn {
    /// In the order of their outlines in the file.
    pub parts: Vec<DrawnPart>,
    /// A point of each line that lies on no part.
    pub stray: Vec<Point2>,
    /// Gaps in lines that lie on no part.
    pub gaps: Vec<Gap>,
    /// A point of each line that begins and ends on the outline of a part beside it.
    pub shared: Vec<Point2>,
    /// A point of each line that lies on another one and is cut once.
    pub doubled: Vec<Point2>,
    /// A point of each closed line left out because it lies partly in others.
    pub crossing: Vec<Point2>,
    /// A point of each cut that runs over another one of its part.
    pub over: Vec<Point2>,
    /// A point of each hole that touches the outline or another hole.
    pub touching: Vec<Point2>,
    /// What is no line (text, pictures), by kind, with its count.
    pub unread: BTreeMap<String, usize>,
    /// Lines on what is switched off, by layer, with their count.
    pub hidden: BTreeMap<String, usize>,
    /// Lines in paper space.
    pub paper: usize,
    /// How many lines of each layer and colour serve each purpose.
    pub layers: BTreeMap<(Source, Purpose), usize>,
    /// Whether the file says in which unit it is; if not, it was taken for mm (DXF) or
    /// 1/96 inch (SVG).
    pub says_unit: bool,
}

impl Rules {
    /// What is done along a line, if its layer or colour says it.
    fn purpose(&self, curve: &Curve) -> Option<Purpose> {
        let Source { name, rgb } = &curve.source;
        let colour = rgb.map(|[r, g, b]| format!("#{r:02x}{g:02x}{b:02x}"));
        let names = [name.as_str(), curve.layer, colour.as_deref().unwrap_or("")];
        let names = names.map(str::to_lowercase);
        let said = |rule: &&(String, Purpose)| names.contains(&rule.0.to_lowercase());
        if let Some((_, purpose)) = self.layers.iter().find(said) {
            return Some(*purpose);
        }
        match curve.layer {
            "ENGRAVE" => return Some(Purpose::Engrave),
            "SCORE" => return Some(Purpose::Score),
            "SHEET" => return Some(Purpose::Ignore),
            layer if is_cut(layer) => return Some(Purpose::Cut),
            _ => {}
        }
        let name = name.to_lowercase();
        let says = |words: &[&str]| words.iter().any(|word| name.contains(word));
        match () {
            () if says(&["engrav", "etch"]) => Some(Purpose::Engrave),
            () if says(&["cut"]) => Some(Purpose::Cut),
            () => None,
        }
    }
}

/// Sorts the lines of a drawing into parts.
pub fn drawn_parts(drawing: Drawing, rules: &Rules) -> Drawn {
    let within = rules.join.max(JOINED_MM);
    // Lines on layers of other programs may be cut lines as well.
    let drawing = joined(drawing, within, |curve| match rules.purpose(curve) {
        Some(Purpose::Cut) if is_cut(curve.layer) && rules.join <= JOINED_MM => None,
        purpose @ (None | Some(Purpose::Cut)) => Some((curve.layer, purpose)),
        _ => None,
    });
    let mut drawn = Drawn {
        paper: drawing.paper,
        hidden: drawing.hidden,
        says_unit: drawing.says_unit,
        doubled: drawing.doubled.iter().map(|curve| curve.vertices[0].point).collect(),
        ..Drawn::default()
    };
    for ((kind, _), count) in drawing.unread {
        *drawn.unread.entry(kind).or_default() += count;
    }
    let (mut rings, mut others) = (Vec::new(), Vec::new());
    for curve in drawing.curves {
        let said = rules.purpose(&curve);
        let by_shape = if curve.closed { Purpose::Cut } else { Purpose::Engrave };
        let purpose = said.unwrap_or(by_shape);
        *drawn.layers.entry((curve.source.clone(), purpose)).or_default() += 1;
        match purpose {
            Purpose::Ignore => {}
            Purpose::Cut if curve.closed => rings.push(Ring::new(&curve)),
            _ => others.push((curve, purpose, said)),
        }
    }
    let rings = without_doubles(rings, &mut drawn);
    let part_of = sort(&rings, &mut drawn);
    let open = marked(others, (&rings, &part_of), &mut drawn);
    (drawn.shared, drawn.gaps) = explain(&open, &rings);
    for part in &drawn.parts {
        let cuts = part.marks.iter().filter(|(purpose, _)| *purpose == Purpose::Cut);
        let cuts: Vec<&Curve> = cuts.map(|(_, cut)| cut).collect();
        let [over, touching] = meetings((&part.outline, &part.holes), &cuts);
        drawn.over.extend(over);
        drawn.touching.extend(touching);
    }
    drawn
}

/// Adds lines that are no outline to the parts they lie on; open ones on none come back.
fn marked(
    lines: Vec<(Curve, Purpose, Option<Purpose>)>,
    (rings, part_of): (&[Ring], &[Option<usize>]),
    drawn: &mut Drawn,
) -> Vec<Curve> {
    let mut open = Vec::new();
    for (curve, purpose, said) in lines {
        let may_be_cut = said.is_none_or(|said| said == Purpose::Cut) && !curve.closed;
        let at = curve.vertices[0].point;
        if may_be_cut && rings.iter().any(|ring| lies_on(&curve, ring)) {
            drawn.doubled.push(at);
            continue;
        }
        let around = rings.iter().enumerate().filter(|(_, ring)| ring.contains(at));
        let innermost = around.min_by(|(_, a), (_, b)| a.area.total_cmp(&b.area));
        // On material, the innermost line around is an outline.
        match innermost.and_then(|(inner, _)| part_of[inner]) {
            Some(part) => drawn.parts[part].marks.push((purpose, curve)),
            None => {
                drawn.stray.push(at);
                open.extend(may_be_cut.then_some(curve));
            }
        }
    }
    open
}

/// The rings without those that lie on an earlier one.
fn without_doubles(rings: Vec<Ring>, drawn: &mut Drawn) -> Vec<Ring> {
    let mut order: Vec<usize> = (0..rings.len()).collect();
    let left = |k: usize| rings[k].bounds.min.x;
    order.sort_by(|&a, &b| left(a).total_cmp(&left(b)).then(a.cmp(&b)));
    let mut is_double = vec![false; rings.len()];
    for (at, &k) in order.iter().enumerate() {
        let near =
            order[at + 1..].iter().take_while(|&&l| left(l) - left(k) <= JOINED_MM);
        for &l in near {
            if rings[k].is_same(&rings[l]) {
                is_double[k.max(l)] = true;
            }
        }
    }
    let mut kept = Vec::new();
    for (ring, is_double) in rings.into_iter().zip(is_double) {
        if is_double {
            drawn.doubled.push(ring.contour.vertices[0].point);
        } else {
            kept.push(ring);
        }
    }
    kept
}

/// Makes outlines of rings that lie in an even number of others, and holes of the rest; the
/// part of each ring that is an outline.
fn sort(rings: &[Ring], drawn: &mut Drawn) -> Vec<Option<usize>> {
    let around = |ring: &Ring| -> Vec<usize> {
        let mut around: Vec<usize> =
            (0..rings.len()).filter(|&k| rings[k].surrounds(ring)).collect();
        around.sort_by(|&a, &b| rings[a].area.total_cmp(&rings[b].area));
        around
    };
    let depths: Vec<Vec<usize>> = rings.iter().map(around).collect();
    let is_outline = |k: usize| depths[k].len().is_multiple_of(2);
    let mut part_of: Vec<Option<usize>> = vec![None; rings.len()];
    for (k, ring) in rings.iter().enumerate().filter(|(k, _)| is_outline(*k)) {
        part_of[k] = Some(drawn.parts.len());
        let outline = ring.turned(true);
        drawn.parts.push(DrawnPart { outline, holes: Vec::new(), marks: Vec::new() });
    }
    for (k, ring) in rings.iter().enumerate().filter(|(k, _)| !is_outline(*k)) {
        match depths[k].first().and_then(|&outer| part_of[outer]) {
            Some(part) => drawn.parts[part].holes.push(ring.turned(false)),
            // It crosses others, or it would lie in none or in all that they lie in.
            None => drawn.crossing.push(ring.contour.vertices[0].point),
        }
    }
    part_of
}

/// The points of a line, and those half way between.
fn along(curve: &Curve) -> Vec<Point2> {
    let mut line = curve.contour();
    line.vertices.last_mut().into_iter().for_each(|last| last.bulge = 0.0);
    let points = line.flattened(ARC_SAGITTA_MM);
    let halves = points.windows(2).map(|pair| nalgebra::center(&pair[0], &pair[1]));
    points.iter().copied().chain(halves).collect()
}

/// Whether the whole of an open line lies on a ring.
fn lies_on(curve: &Curve, ring: &Ring) -> bool {
    let is_under = |p: &Point2| ring.is_under(*p);
    ends(curve).iter().all(is_under) && along(curve).iter().all(is_under)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::drawing::{DrawingError, LAYERS, Reading, read_dxf, read_svg};

    fn parts(read: Result<Drawing, DrawingError>) -> Drawn {
        drawn_parts(read.unwrap(), &Rules::default())
    }

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
        let drawn = parts(read_svg(svg.as_bytes(), &Reading::of(&LAYERS)));
        let [ring, square] = drawn.parts.as_slice() else { panic!("{drawn:?}") };
        assert_eq!((ring.holes.len(), square.holes.len()), (1, 0));
        assert!(ring.outline.signed_area() > 0.0 && ring.holes[0].signed_area() < 0.0);
        assert!(ring.outline.vertices.iter().all(|v| v.bulge > 0.0), "arcs stay arcs");
        assert_eq!((ring.marks.len(), square.marks.len()), (1, 1));
        assert_eq!(square.marks[0].0, Purpose::Engrave);
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
        let drawn = parts(read_dxf(text.as_bytes(), &Reading::of(&LAYERS)));
        assert_eq!(drawn.parts.len(), 1);
        assert!((drawn.parts[0].outline.signed_area() - 600.0).abs() < 1e-9);
        assert_eq!((drawn.unread.len(), drawn.says_unit), (1, false));
    }

    /// A drawing with these paths, the sheet 200 mm wide and high.
    fn paths(paths: &[&str]) -> Drawn {
        let paths: String = paths.iter().map(|d| format!("<path d='{d}'/>")).collect();
        let text = format!("<svg width='200mm' viewBox='0 0 200 200'>{paths}</svg>");
        parts(read_svg(text.as_bytes(), &Reading::of(&LAYERS)))
    }

    #[test]
    fn what_is_drawn_twice_is_cut_once_and_told() {
        let drawn = paths(&["M0 0h80v30h-80z", "M80 30v-30h-80v30z", "M20 0h40"]);
        assert_eq!((drawn.parts.len(), drawn.doubled.len()), (1, 2));
        assert!(drawn.parts[0].marks.is_empty() && drawn.stray.is_empty());
    }

    #[test]
    fn gaps_and_shared_edges_are_told_where_they_are() {
        let drawn = paths(&["M0 0h80v30h-80v-29.7", "M100 0h20v9h-20z", "M120 0h9v9h-9"]);
        assert_eq!((drawn.parts.len(), drawn.stray.len()), (1, 2));
        assert!((drawn.gaps[0].width - 0.3).abs() < 1e-9 && drawn.shared.len() == 1);
    }

    #[test]
    fn a_ring_that_lies_partly_in_a_hole_is_told() {
        let drawn =
            paths(&["M0 0h90v90h-90z", "M20 20L190 50L20 80V50z", "M99 45h40v9h-40z"]);
        let [part] = &drawn.parts[..] else { panic!("{drawn:?}") };
        assert_eq!((part.holes.len(), drawn.crossing.len()), (1, 1));
    }

    #[test]
    fn a_hole_that_touches_its_outline_is_a_hole() {
        let drawn = paths(&["M0 0h80v30h-80z", "M0 10 l9 -4 v8 z"]);
        assert_eq!((drawn.parts.len(), drawn.parts[0].holes.len()), (1, 1));
    }
}
