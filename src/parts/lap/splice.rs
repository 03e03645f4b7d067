//! Strips longer than every sheet, cut in two inside a fin and joined by a dovetail.
//!
//! The cut lies in the middle third of a fin, never at a node. The left piece carries the
//! tail, the right piece the socket, wider by the clearance; kerf is compensated on both
//! later, as on every edge.

use crate::geometry::offset::{offset_chain, rounded};
use crate::geometry::{Point2, Vector2, Vertex, trig};
use crate::parts::fit::Fit;
use crate::parts::hub::dimensions::Hubs;
use crate::parts::lap::finding::LapFinding;
use crate::parts::lap::held::held_end;
use crate::parts::lap::join::Joints;
use crate::parts::outline::{Closure, End, Piece, outline};
use crate::parts::unfold::FlatStrip;
use crate::tolerance::{ARC_SAGITTA_MM, SAME_LENGTH_MM};
use std::f64::consts::PI;

/// How far the flanks of the tail open, radians.
const FLANK: f64 = 15.0 * PI / 180.0;

/// A strip with its joints, ready to be cut into pieces.
pub(crate) struct Whole<'a> {
    /// Name for messages.
    pub name: &'a str,
    /// The flat strip.
    pub strip: &'a FlatStrip,
    /// Its slits and ends.
    pub joints: &'a Joints,
    /// What material and joint ask.
    pub fit: &'a Fit,
    /// What holds ends that do not lap.
    pub hubs: &'a Hubs,
}

/// The strip in as few pieces as `fits` allows (one, if it fits whole).
///
/// # Errors
/// [`LapFinding::NoPlaceForSplice`] if no fin can take a splice where one is needed.
pub(crate) fn pieces(
    whole: &Whole,
    fits: &dyn Fn(&[Point2]) -> bool,
) -> Result<Vec<Piece>, LapFinding> {
    let last = whole.strip.axes.len() - 1;
    let fits = |cuts: [Option<usize>; 2]| {
        let shape = outline(&whole.piece(cuts), whole.fit);
        fits(&shape.flattened(ARC_SAGITTA_MM))
    };
    if fits([None, None]) {
        return Ok(vec![whole.piece([None, None])]);
    }
    let places: Vec<usize> = (0..last)
        .filter(|&fin| !whole.is_held(fin) && whole.tail(fin).is_some())
        .collect();
    let cuts = fewest(&places, &fits).ok_or_else(|| whole.no_place())?;
    let even = whole.evenly(&places, cuts.len());
    let ends = |cuts: &[usize]| {
        let inner = || cuts.iter().copied().map(Some);
        let starts = std::iter::once(None).chain(inner());
        let pairs: Vec<_> =
            starts.zip(inner().chain([None])).map(|(a, b)| [a, b]).collect();
        pairs
    };
    let even_fits =
        even.windows(2).all(|w| w[0] < w[1]) && ends(&even).into_iter().all(fits);
    let chosen = if even_fits { even } else { cuts };
    Ok(ends(&chosen).into_iter().map(|cuts| whole.piece(cuts)).collect())
}

/// The fewest cuts, each as far along as the piece before it allows.
fn fewest(
    places: &[usize],
    fits: &dyn Fn([Option<usize>; 2]) -> bool,
) -> Option<Vec<usize>> {
    let mut cuts: Vec<usize> = Vec::new();
    loop {
        let start = cuts.last().copied();
        if fits([start, None]) {
            return Some(cuts);
        }
        let done = places.partition_point(|&fin| start.is_some_and(|start| fin <= start));
        let later = &places[done..];
        // A longer piece never fits where a shorter one does not.
        let fitting = later.partition_point(|&fin| fits([start, Some(fin)]));
        cuts.push(later[fitting.checked_sub(1)?]);
    }
}

/// Sizes of a tail in one fin.
struct Tail {
    /// From the bottom edge to the top edge.
    cut: [Point2; 2],
    /// From the neck to the end of the tail.
    length: f64,
    neck: f64,
}

impl Whole<'_> {
    /// The strip in one piece.
    pub(crate) fn uncut(&self) -> Piece {
        self.piece([None, None])
    }

    /// The run of axes between two cut fins, with what is left of the joints.
    fn piece(&self, [left, right]: [Option<usize>; 2]) -> Piece {
        let first = left.map_or(0, |fin| fin + 1);
        let last = right.unwrap_or(self.strip.axes.len() - 1);
        let range = first..=last;
        let slits = self.joints.slits.iter().filter(|(place, _)| range.contains(place));
        let closure = |cut: Option<usize>, end: usize, gap: f64| {
            let splice = cut.and_then(|fin| self.dovetail(fin, gap));
            splice.map_or_else(|| self.closed_by(end), Closure::Splice)
        };
        Piece {
            axes: self.strip.axes[range.clone()].to_vec(),
            slits: slits.map(|(place, slit)| (place - first, *slit)).collect(),
            closures: [closure(left, 0, self.fit.clearance), closure(right, 1, 0.0)],
            beyond: [left, right.map(|fin| fin + 1)]
                .map(|place| place.map(|place| self.strip.axes[place])),
        }
    }

    /// The strip's own left (0) or right (1) end.
    fn closed_by(&self, end: usize) -> Closure {
        let axes = &self.strip.axes;
        let last = axes.len() - 1;
        let [axis, next] = [[0, 1], [last, last - 1]][end].map(|place| &axes[place]);
        match (self.joints.ends[end], self.hubs.get(&axis.node)) {
            (End::Held(_), Some(hub)) => {
                Closure::Held(held_end([axis, next], end, hub, self.fit.relief))
            }
            (end, _) => Closure::End(end),
        }
    }

    /// Whether a fin stands in discs; it takes no splice.
    fn is_held(&self, fin: usize) -> bool {
        let [first, second] = self.joints.ends.map(|end| matches!(end, End::Held(_)));
        first && fin == 0 || second && fin + 2 == self.strip.axes.len()
    }

    /// Free run of a fin between its slits: where it starts and ends along the fin.
    fn free_run(&self, fin: usize) -> [f64; 2] {
        let length = (self.strip.axes[fin + 1].foot - self.strip.axes[fin].foot).norm();
        let slit = |place: usize| self.joints.slits.get(&place);
        [
            slit(fin).map_or(0.0, |slit| slit.after),
            length - slit(fin + 1).map_or(0.0, |slit| slit.before),
        ]
    }

    fn needed(&self) -> f64 {
        2.0 * self.fit.thickness + 4.0 * self.fit.web_least.max(self.fit.thickness / 2.0)
    }

    /// The tail that a fin has room for.
    fn tail(&self, fin: usize) -> Option<Tail> {
        let (a, b) = (self.strip.axes[fin], self.strip.axes[fin + 1]);
        let length = (b.foot - a.foot).norm();
        let [start, end] = self.free_run(fin);
        let height = (a.below + a.above).min(b.below + b.above);
        let needed = self.needed();
        if end - start < needed || height < needed {
            return None;
        }
        let tail = ((end - start) / 4.0).min(height / 4.0).max(self.fit.thickness);
        let middle = (start + end) / 2.0;
        let at = (middle.clamp(length / 3.0, length * 2.0 / 3.0) - tail / 2.0) / length;
        let between = |p: Point2, q: Point2| p + (q - p) * at;
        let cut = [between(a.bottom(), b.bottom()), between(a.top(), b.top())];
        let neck = (height / 4.0).max(self.fit.thickness);
        Some(Tail { cut, length: tail, neck })
    }

    /// The cut through a fin, moved to the right by `gap`.
    fn dovetail(&self, fin: usize, gap: f64) -> Option<Vec<Vertex>> {
        let tail = self.tail(fin)?;
        let [from, to] = tail.cut;
        let up = (to - from).normalize();
        let right = Vector2::new(up.y, -up.x);
        let height = (to - from).norm();
        let head = tail.neck + 2.0 * tail.length * trig::tan(FLANK);
        let place = |y: f64, x: f64| from + up * y + right * x;
        let middle = height / 2.0;
        let chain = [
            from,
            place(middle - tail.neck / 2.0, 0.0),
            place(middle - head / 2.0, tail.length),
            place(middle + head / 2.0, tail.length),
            place(middle + tail.neck / 2.0, 0.0),
            to,
        ];
        let mut moved = offset_chain(&chain, gap);
        // The ends stay on the strip's edges.
        let next = self.strip.axes[fin + 1];
        for (end, edge) in [(0, next.bottom()), (5, next.top())] {
            let run = (edge - chain[end]).dot(&right);
            moved[end] = chain[end] + (edge - chain[end]) * (gap / run);
        }
        let radius = self.fit.relief.max(0.3);
        // Arcs keep their centres: right turns at the neck shrink, left turns grow.
        let (neck, tip) = ((radius - gap).max(0.0), (radius + gap).max(0.0));
        Some(rounded(&moved, &[0.0, neck, tip, tip, neck, 0.0]))
    }

    /// Cuts at equal lengths.
    fn evenly(&self, places: &[usize], count: usize) -> Vec<usize> {
        let axes = &self.strip.axes;
        let mut run = vec![0.0];
        for pair in axes.windows(2) {
            run.push(run[run.len() - 1] + (pair[1].foot - pair[0].foot).norm());
        }
        let total = run[run.len() - 1];
        let middle = |fin: usize| (run[fin] + run[fin + 1]) / 2.0;
        let nearest = |target: f64| {
            let off = |fin: usize| (middle(fin) - target).abs();
            let least = places.iter().map(|&fin| off(fin)).reduce(f64::min)?;
            places.iter().copied().find(|&fin| off(fin) <= least + SAME_LENGTH_MM)
        };
        let share = |k: usize| total * k as f64 / (count + 1) as f64;
        (1..=count).filter_map(|k| nearest(share(k))).collect()
    }

    fn no_place(&self) -> LapFinding {
        let length_mm = self.strip.length();
        let part = self.name.to_owned();
        LapFinding::NoPlaceForSplice { part, length_mm, needed_mm: self.needed() }
    }
}
