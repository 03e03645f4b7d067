//! Each structure moved, turned, mirrored, renumbered, with its faces shuffled and its
//! strips reversed: the parts stay the same.

use crate::structures::{made, material, triangles};
use finwright::design::examples;
use finwright::fabrication::Fabrication;
use finwright::geometry::{Point3, Vector3};
use finwright::ids::NodeId;
use finwright::parts::Body;
use finwright::structure::{Draft, Structure};
use finwright::tolerance::Tolerance;
use nalgebra::{Rotation3, Unit};

/// What must not depend on how a structure lies in space or is numbered.
#[derive(Debug)]
struct Sizes {
    strips: usize,
    parts: usize,
    findings: Vec<(String, usize)>,
    /// Sorted: absolute folds in degrees, slit widths in mm, part areas in mm².
    folds: Vec<f64>,
    widths: Vec<f64>,
    areas: Vec<f64>,
    cut_length: f64,
}

impl Sizes {
    fn of(job: &Fabrication) -> Self {
        let bodies = || {
            job.parts.iter().filter_map(|part| match &part.body {
                Body::Strip(body) => Some(body),
                _ => None,
            })
        };
        let sorted = |values: Vec<f64>| {
            let mut values = values;
            values.sort_by(f64::total_cmp);
            values
        };
        let mut findings: Vec<(String, usize)> = Vec::new();
        for finding in &job.findings {
            match findings.iter_mut().find(|(code, _)| *code == finding.code) {
                Some((_, count)) => *count += 1,
                None => findings.push((finding.code.clone(), 1)),
            }
        }
        findings.sort();
        let folds =
            bodies().flat_map(|b| b.folds.iter().map(|f| f.angle.abs().to_degrees()));
        let widths = bodies().flat_map(|b| b.slits.iter().map(|(slit, _)| slit.width()));
        let length = |part: &finwright::parts::Part| part.region.outline.length();
        Self {
            strips: job.structure.as_ref().map_or(0, |s| s.strips().len()),
            parts: job.parts.len(),
            findings,
            folds: sorted(folds.collect()),
            widths: sorted(widths.collect()),
            areas: sorted(job.parts.iter().map(|p| p.region.area()).collect()),
            cut_length: job.parts.iter().map(length).sum(),
        }
    }

    /// Asserts that another structure has the same sizes: counts exactly, folds to 1e-6
    /// degrees, widths to 1e-6 mm, areas and the cut length to the given shares.
    fn same(&self, other: &Self, area_share: f64, length_share: f64, what: &str) {
        assert_eq!(self.strips, other.strips, "{what}: strips");
        assert_eq!(self.parts, other.parts, "{what}: parts");
        assert_eq!(self.findings, other.findings, "{what}: findings");
        let close = |name: &str, a: &[f64], b: &[f64], slack: &dyn Fn(f64) -> f64| {
            assert_eq!(a.len(), b.len(), "{what}: number of {name}");
            for (k, (a, b)) in a.iter().zip(b).enumerate() {
                assert!((a - b).abs() <= slack(*a), "{what}: {name} {k}: {a} {b}");
            }
        };
        close("folds", &self.folds, &other.folds, &|_| 1e-6);
        close("slit widths", &self.widths, &other.widths, &|_| 1e-6);
        close("areas", &self.areas, &other.areas, &|area| area * area_share);
        close("cut length", &[self.cut_length], &[other.cut_length], &|l| {
            l * length_share
        });
    }
}

/// The draft with every point and direction mapped.
fn mapped(
    mut draft: Draft,
    point: impl Fn(Point3) -> Point3,
    vector: impl Fn(Vector3) -> Vector3,
) -> Draft {
    draft.positions = draft.positions.into_iter().map(point).collect();
    draft.axes = draft.axes.into_iter().map(vector).collect();
    draft
}

fn moved(draft: Draft) -> Draft {
    let shift = Vector3::new(1234.5, -777.7, 88.8);
    mapped(draft, |p| p + shift, |v| v)
}

fn turned(draft: Draft) -> Draft {
    let turn = Rotation3::from_axis_angle(
        &Unit::new_normalize(Vector3::new(1.0, 2.0, -0.7)),
        1.1,
    );
    mapped(draft, |p| turn * p, |v| turn * v)
}

fn mirrored(draft: Draft) -> Draft {
    let mut draft =
        mapped(draft, |p| Point3::new(-p.x, p.y, p.z), |v| Vector3::new(-v.x, v.y, v.z));
    for face in &mut draft.faces {
        face.reverse();
    }
    draft
}

/// A shuffle of 0..count that is the same each time.
fn shuffle(count: usize) -> Vec<usize> {
    let mut order: Vec<usize> = (0..count).collect();
    let mut state = 1_u64;
    for k in (1..count).rev() {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
        order.swap(k, (state >> 33) as usize % (k + 1));
    }
    order
}

fn renumbered(draft: Draft) -> Draft {
    let to = shuffle(draft.positions.len());
    let spread = |list: &[f64]| {
        let mut spread = list.to_vec();
        (0..list.len()).for_each(|k| spread[to[k]] = list[k]);
        spread
    };
    let mut renumbered = draft.clone();
    for (k, &new) in to.iter().enumerate() {
        renumbered.positions[new] = draft.positions[k];
        renumbered.axes[new] = draft.axes[k];
    }
    renumbered.below = spread(&draft.below);
    renumbered.above = spread(&draft.above);
    let fins = renumbered.fins.iter_mut().flatten().flatten();
    let strips = renumbered.strips.iter_mut().flatten().flatten();
    let named = fins.chain(strips).chain(renumbered.fixed.iter_mut().flatten());
    for node in named.chain(renumbered.faces.iter_mut().flatten()) {
        *node = to[*node];
    }
    renumbered
}

fn faces_shuffled(mut draft: Draft) -> Draft {
    let order = shuffle(draft.faces.len());
    draft.faces = order.into_iter().map(|k| draft.faces[k].clone()).collect();
    for (k, face) in draft.faces.iter_mut().enumerate() {
        let count = face.len();
        face.rotate_left(k % count);
    }
    draft
}

/// The strips that were found, before discs cut any, spelled out and walked the other way.
fn strips_reversed(draft: &Draft) -> Draft {
    let structure = Structure::new(draft.clone(), &Tolerance::default());
    let (structure, _) = structure.expect("it is sound");
    let strips = structure.strips().iter().map(|strip| {
        let seam = strip.closed.then(|| strip.nodes[0]);
        strip.nodes.iter().copied().chain(seam).rev().map(NodeId::index).collect()
    });
    Draft { strips: Some(strips.collect()), ..draft.clone() }
}

type Variation = (&'static str, fn(Draft) -> Draft);
const VARIATIONS: [Variation; 5] = [
    ("moved", moved),
    ("turned", turned),
    ("mirrored", mirrored),
    ("renumbered", renumbered),
    ("faces shuffled", faces_shuffled),
];

/// Areas and lengths may change by what the mouth of a slit takes from a sloping edge when
/// top and bottom change places.
const AREA: f64 = 5e-5;
const LENGTH: f64 = 1e-4;

#[test]
fn embedded_structures_keep_their_parts_under_every_variation() {
    let template = material("pmma-cast-3");
    for example in &examples::ALL {
        let draft = (example.draft)();
        let sizes = Sizes::of(&made(draft.clone(), &template));
        for (name, vary) in VARIATIONS {
            let varied = Sizes::of(&made(vary(draft.clone()), &template));
            sizes.same(&varied, AREA, LENGTH, &format!("{} {name}", example.name));
        }
        let reversed = Sizes::of(&made(strips_reversed(&draft), &template));
        sizes.same(&reversed, AREA, LENGTH, &format!("{} strips reversed", example.name));
    }
}

/// Where all pairs of fins are equally straight, node numbers decide; how the mesh lies in
/// space, and in which order its faces come, do not.
#[test]
fn equal_pairs_are_chosen_by_numbers_and_never_by_rounding() {
    let template = material("card-1.5");
    let draft = triangles(6, 5);
    let sizes = Sizes::of(&made(draft.clone(), &template));
    for (name, vary) in VARIATIONS.into_iter().filter(|(name, _)| *name != "renumbered") {
        let varied = Sizes::of(&made(vary(draft.clone()), &template));
        sizes.same(&varied, AREA, LENGTH, &format!("triangles {name}"));
    }
}
