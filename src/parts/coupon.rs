//! A coupon: pieces that tell kerf and clearance of a material and a machine.
//!
//! Piece `a` is a comb whose notches differ in width; the plug `p` is as wide as the
//! middle one. With the kerf right, plug and middle notch are equal; a kerf that is smaller
//! by x leaves the plug larger by x and each notch smaller by x, so the notch that just
//! holds the plug is wider by 2x. Pieces `b` to `e` have slits for plates that cross at 90,
//! 75, 60 and 45 degrees (the triangle `g` has these angles) with rising clearance, shaped
//! as in a job. `f` is bent, `t` is read, `s` goes into the slits.

use crate::geometry::{Contour, Point2, Region, Vector2};
use crate::ids::NodeId;
use crate::lettering::{letter, width};
use crate::parts::fit::Fit;
use crate::parts::mark::{Mark, MarkKind};
use crate::parts::outline::{Closure, End, Piece, outline};
use crate::parts::part::{Body, Part};
use crate::parts::slit::{Opening, Slit};
use crate::parts::unfold::FlatAxis;
use std::collections::BTreeMap;

/// Notches of the kerf comb; the middle one is for the kerf of the template.
const NOTCHES: usize = 9;

/// From one notch to the next the kerf differs by this, mm.
const KERF_STEP: f64 = 0.025;

/// Slits of each piece; the middle one has the clearance of the template.
const SLITS: usize = 7;

/// From one slit to the next the clearance differs by this, mm.
const CLEARANCE_STEP: f64 = 0.05;

/// Pieces with slits and the angle at which plates cross in them, degrees.
const ANGLES: [(char, f64); 4] = [('b', 90.0), ('c', 75.0), ('d', 60.0), ('e', 45.0)];

/// Width of the plug and depth of the notches, mm.
const PLUG: f64 = 10.0;

/// A notch or slit that fitted: its number and the letter of its piece, as in `3b`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct CouponMark {
    /// From 1, left to right.
    pub number: usize,
    /// The piece.
    pub piece: char,
}

/// What a coupon told, mm.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Fitted {
    /// The machine's kerf.
    pub kerf: f64,
    /// Clearance that gives the fit that was liked.
    pub clearance: f64,
}

impl std::str::FromStr for CouponMark {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        let wrong =
            || format!("{text:?} is no place on the coupon; write 5a for notch 5 of a");
        let piece = text.chars().last().ok_or_else(wrong)?.to_ascii_lowercase();
        let number =
            text[..text.len() - piece.len_utf8()].parse().map_err(|_| wrong())?;
        let count = match piece {
            'a' => NOTCHES,
            'b'..='e' => SLITS,
            _ => return Err(format!("{text:?}: notches and slits are on pieces a to e")),
        };
        if (1..=count).contains(&number) {
            Ok(Self { number, piece })
        } else {
            Err(format!("{text:?}: piece {piece} has numbers 1 to {count}"))
        }
    }
}

impl CouponMark {
    /// Steps from the middle one.
    fn steps(self, count: usize) -> f64 {
        self.number as f64 - (count / 2 + 1) as f64
    }
}

impl Fitted {
    /// Kerf and clearance from what fitted on a coupon made with `made`.
    ///
    /// A slit on the coupon is wider than drawn by what the kerf was taken too small, so the
    /// clearance grows by it; several slits are averaged.
    pub fn read(made: Self, marks: &[CouponMark]) -> Self {
        let mean = |values: Vec<f64>| {
            (!values.is_empty()).then(|| values.iter().sum::<f64>() / values.len() as f64)
        };
        let of =
            |combs: bool| marks.iter().filter(move |mark| (mark.piece == 'a') == combs);
        let kerf =
            mean(of(true).map(|m| made.kerf - m.steps(NOTCHES) * KERF_STEP).collect());
        let kerf = kerf.unwrap_or(made.kerf);
        let wider = of(false).map(|m| m.steps(SLITS) * CLEARANCE_STEP).collect();
        let clearance = mean(wider).map(|by| made.clearance + by + kerf - made.kerf);
        Self { kerf, clearance: clearance.unwrap_or(made.clearance) }
    }
}

/// The pieces of a coupon. `model` and `long_term` are bend radii to try, mm.
pub fn coupon(fit: &Fit, [model, long_term]: [f64; 2]) -> Vec<Part> {
    let plug = rectangle(PLUG, 4.0 * PLUG);
    let text = format!("p{}", trimmed(PLUG));
    let mut parts = vec![comb(fit)];
    parts.extend(ANGLES.map(|(name, degrees)| slits(name, degrees, fit)));
    let bend = format!("f  R{} weeks  R{} years", trimmed(model), trimmed(long_term));
    parts.extend([
        piece('f', rectangle(160.0, 12.0), vec![text_at(&bend, 3.0, 6.0, 4.5)]),
        gauge(),
        piece('p', plug, vec![text_at(&text, 3.0, 2.0, 4.0)]),
        piece('s', rectangle(60.0, 25.0), vec![text_at("s", 3.0, 3.0, 11.0)]),
        lettering(),
    ]);
    parts
}

fn trimmed(mm: f64) -> String {
    format!("{mm:.0}")
}

fn piece(name: char, outline: Contour, texts: Vec<Vec<Vec<Point2>>>) -> Part {
    let mark = |strokes| Mark { kind: MarkKind::Engrave, strokes };
    Part {
        id: name.to_string(),
        quantity: 1,
        region: Region { outline, holes: Vec::new() },
        marks: texts.into_iter().map(mark).collect(),
        body: Body::Coupon,
    }
}

fn rectangle(width: f64, height: f64) -> Contour {
    let corners = [(0.0, 0.0), (width, 0.0), (width, height), (0.0, height)];
    Contour::polygon(corners.map(|(x, y)| Point2::new(x, y)))
}

/// A text with capitals of a height, lower left corner at a place.
fn text_at(text: &str, cap: f64, x: f64, y: f64) -> Vec<Vec<Point2>> {
    let strokes =
        letter(text, cap).map(|lettering| lettering.strokes).unwrap_or_default();
    let moved =
        |stroke: Vec<Point2>| stroke.iter().map(|p| p + Vector2::new(x, y)).collect();
    strokes.into_iter().map(moved).collect()
}

/// A text centred on x.
fn centred(text: &str, cap: f64, x: f64, y: f64) -> Vec<Vec<Point2>> {
    text_at(text, cap, x - width(text, cap).unwrap_or(0.0) / 2.0, y)
}

/// The kerf comb: notches with sharp walls, without flare, so that the plug tells.
fn comb(fit: &Fit) -> Part {
    let plain = Fit { chamfer: 0.0, ..fit.clone() };
    let widths: Vec<f64> = (0..NOTCHES)
        .map(|k| PLUG + 2.0 * KERF_STEP * (k as f64 - (NOTCHES / 2) as f64))
        .collect();
    slotted('a', "kerf", &widths, &plain)
}

fn slits(name: char, degrees: f64, fit: &Fit) -> Part {
    let angle = degrees.to_radians();
    // Straight strips: the tighter of the two angles rules both sides.
    let across = 2.0 * fit.clear_distance(angle).max(fit.kinked_half(0.0));
    let widths: Vec<f64> = (0..SLITS)
        .map(|k| {
            let more = CLEARANCE_STEP * (k as f64 - (SLITS / 2) as f64);
            // A slit as narrow as nothing is none.
            (across + fit.clearance + more).max(fit.thickness / 10.0)
        })
        .collect();
    slotted(name, &format!("{degrees:.0}\u{b0}"), &widths, fit)
}

/// A plate with slits from the top, numbered below them.
fn slotted(name: char, text: &str, widths: &[f64], fit: &Fit) -> Part {
    let depth = 12.0_f64.max(2.0 * fit.thickness);
    let below = 9.0;
    let land = 3.0 * fit.web.max(2.0);
    let axis = |node: NodeId, x: f64| FlatAxis {
        node,
        foot: Point2::new(x, 0.0),
        up: Vector2::y(),
        below: 0.0,
        above: depth + below + fit.relief,
    };
    let label = format!("{name} {text}");
    let start = 6.0 + width(&label, 3.0).unwrap_or(0.0);
    let mut x = start.max(land);
    let (mut axes, mut slits) = (vec![axis(NodeId::new(0), 0.0)], BTreeMap::new());
    let mut texts = vec![text_at(&label, 3.0, 3.0, 3.0)];
    for (k, &width) in widths.iter().enumerate() {
        x += width / 2.0;
        let half = width / 2.0;
        let node = NodeId::new(k + 1);
        let slit = Slit {
            node,
            partner: 0,
            from: Opening::Top,
            before: half,
            after: half,
            depth,
            crossing: 0.0,
        };
        slits.insert(axes.len(), slit);
        axes.push(axis(node, x));
        texts.push(centred(&node.to_string(), 3.0, x, 3.0));
        x += half + land;
    }
    axes.push(axis(NodeId::new(widths.len() + 1), x));
    let free = || Closure::End(End::Free);
    let body = Piece { axes, slits, closures: [free(), free()], beyond: [None, None] };
    piece(name, outline(&body, fit), texts)
}

/// A triangle with the angles of the pieces c, d and e.
fn gauge() -> Part {
    const SIDE: f64 = 60.0;
    let [c, d] = [75.0_f64, 60.0].map(f64::to_radians);
    let (tan_c, tan_d) = (crate::geometry::trig::tan(c), crate::geometry::trig::tan(d));
    // Base angles 75° at the left and 60° at the right leave 45° at the top.
    let height = SIDE * tan_c * tan_d / (tan_c + tan_d);
    let top = Point2::new(height / tan_c, height);
    let corners = [Point2::origin(), Point2::new(SIDE, 0.0), top];
    let texts = vec![
        text_at("75\u{b0}", 3.0, 6.0, 4.0),
        text_at("60\u{b0}", 3.0, SIDE - 16.0, 4.0),
        centred("45\u{b0}", 3.0, top.x + 1.0, height - 17.0),
        centred("g", 3.0, SIDE / 2.0 - 4.0, 16.0),
    ];
    piece('g', Contour::polygon(corners), texts)
}

/// Lettering from small to large: the smallest that can be read goes into the template.
fn lettering() -> Part {
    let sizes = [1.5, 2.0, 2.5, 3.0, 4.0];
    let mut y = 4.0;
    let mut texts = vec![text_at("t", 3.0, 3.0, 4.0)];
    for cap in sizes {
        texts.push(text_at(&format!("S03 689 +4.5\u{b0} {cap}"), cap, 9.0, y));
        y += 2.0 * cap + 1.0;
    }
    piece('t', rectangle(70.0, y + 1.0), texts)
}

#[cfg(test)]
mod tests {
    use super::*;

    const MADE: Fitted = Fitted { kerf: 0.18, clearance: 0.1 };

    fn read(marks: &str) -> Fitted {
        let marks: Vec<CouponMark> =
            marks.split(',').map(|m| m.parse().unwrap()).collect();
        Fitted::read(MADE, &marks)
    }

    #[test]
    fn the_middle_of_everything_changes_nothing() {
        let fitted = read("5a,4b");
        assert!(
            (fitted.kerf - 0.18).abs() < 1e-12 && (fitted.clearance - 0.1).abs() < 1e-12
        );
    }

    /// A machine with another kerf, simulated: which notch holds the plug, and how wide the
    /// slit that was liked is in the next job.
    #[test]
    fn what_fitted_gives_the_same_fit_with_the_right_kerf() {
        let real_kerf = 0.23;
        // Plug and notch as cut: outlines lose, notches gain half a kerf too much per side.
        let plug = PLUG + MADE.kerf - real_kerf;
        let notch = |n: f64| PLUG + 2.0 * KERF_STEP * (n - 5.0) - MADE.kerf + real_kerf;
        let held = (1..=9).min_by(|&a, &b| {
            let off = |n: i32| (notch(f64::from(n)) - plug).abs();
            off(a).total_cmp(&off(b))
        });
        assert_eq!(held, Some(3));
        let fitted = read("3a,2b");
        assert!((fitted.kerf - real_kerf).abs() < 1e-12);
        // As cut, slit 2 was wider than the plate by this; the next job must be as well.
        let liked = MADE.clearance - 2.0 * CLEARANCE_STEP + real_kerf - MADE.kerf;
        assert!((fitted.clearance - liked).abs() < 1e-12);
    }

    #[test]
    fn places_that_are_not_on_the_coupon_are_told() {
        for wrong in ["", "a", "0a", "10a", "8b", "3f", "b3", "é"] {
            assert!(wrong.parse::<CouponMark>().is_err(), "{wrong}");
        }
        assert_eq!("3B".parse(), Ok(CouponMark { number: 3, piece: 'b' }));
    }
}
