//! Laws that hold for every structure, on structures drawn at random.

use crate::plane::{apart, area, contains, cuts};
use crate::structures::{any, made, material};
use finwright::fabrication::Fabrication;
use finwright::geometry::{Contour, Mesh, Segment};
use finwright::geometry::{Point2, Point3, Vector3, Vertex, trig};
use finwright::ids::{FinId, NodeId};
use finwright::parts::{Body, Opening, Slit, StripBody};
use finwright::sheets::{Kerf, placed};
use finwright::structure::{
    AxisRule, ObjOptions, Structure, read_json, read_obj, write_json, write_obj,
};
use finwright::tolerance::Tolerance;
use finwright::units::Unit;
use proptest::prelude::{Just, ProptestConfig, prop_assert, prop_assert_eq, proptest};
use std::collections::BTreeMap;
use std::f64::consts::{FRAC_PI_8, PI};

const THICKNESS: f64 = 3.0;
const CLEARANCE: f64 = 0.1;
const KERF: f64 = 0.18;

fn job(draft: finwright::structure::Draft) -> Fabrication {
    made(draft, &material("pmma-cast-3"))
}

fn structure(job: &Fabrication) -> &Structure {
    job.structure.as_ref().expect("made() asks for one")
}

fn bodies(job: &Fabrication) -> impl Iterator<Item = &StripBody> {
    job.parts.iter().filter_map(|part| match &part.body {
        Body::Strip(body) => Some(body),
        _ => None,
    })
}

/// Corners of a fin in space, as in the plane below.
fn in_space(structure: &Structure, nodes: [NodeId; 2]) -> [Point3; 4] {
    let [a, b] = nodes.map(|k| &structure.nodes()[k]);
    let low = |n: &finwright::structure::Node| n.position - n.axis * n.below;
    let high = |n: &finwright::structure::Node| n.position + n.axis * n.above;
    [low(a), low(b), high(b), high(a)]
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 48, ..ProptestConfig::default() })]

    /// All six distances between a fin's corners are the same flat and in space, so all
    /// lengths and angles are, and so is the area of the whole strip.
    #[test]
    fn unfolding_keeps_lengths_angles_and_area(draft in any()) {
        let job = job(draft);
        for body in bodies(&job) {
            let mut fins = 0.0;
            for pair in body.axes.windows(2) {
                let flat = [pair[0].bottom(), pair[1].bottom(), pair[1].top(), pair[0].top()];
                let space = in_space(structure(&job), [pair[0].node, pair[1].node]);
                for (i, j) in [(0, 1), (1, 2), (2, 3), (3, 0), (0, 2), (1, 3)] {
                    let off = (flat[i] - flat[j]).norm() - (space[i] - space[j]).norm();
                    prop_assert!(off.abs() < 1e-9, "{:?} {off}", pair);
                }
                let [a, b, c, d] = space;
                fins += ((c - a).cross(&(d - b))).norm() / 2.0;
            }
            let low = body.axes.iter().map(|axis| axis.bottom());
            let ring: Vec<Point2> =
                low.chain(body.axes.iter().rev().map(|axis| axis.top())).collect();
            prop_assert!((area(&ring) - fins).abs() < 1e-9 * fins);
        }
    }

    /// Every fin is on one strip, and on one part or, spliced, on two.
    #[test]
    fn strips_and_parts_cover_each_fin_once(draft in any()) {
        let job = job(draft);
        let mut on_strips: BTreeMap<FinId, usize> = BTreeMap::new();
        for step in structure(&job).strips().iter().flat_map(|strip| strip.steps()) {
            *on_strips.entry(step.into()).or_default() += 1;
        }
        let mut on_parts: BTreeMap<FinId, usize> = BTreeMap::new();
        for body in bodies(&job) {
            let whole = body.axes.windows(2).map(|pair| [pair[0].node, pair[1].node]);
            for step in whole {
                *on_parts.entry(step.into()).or_default() += 1;
            }
        }
        let once: BTreeMap<_, _> =
            structure(&job).fins().iter().map(|&fin| (fin, 1)).collect();
        prop_assert_eq!(&on_strips, &once);
        prop_assert_eq!(&on_parts, &once);
    }

    /// The two slits on an axis are open to opposite edges, name each other, and together
    /// reach through, by what the template allows and no more.
    #[test]
    fn a_pair_of_slits_fills_its_axis(draft in any()) {
        let job = job(draft);
        let mut at: BTreeMap<NodeId, Vec<(&str, &Slit, &str)>> = BTreeMap::new();
        for part in &job.parts {
            let Body::Strip(body) = &part.body else { continue };
            for (slit, partner) in &body.slits {
                at.entry(slit.node).or_default().push((&part.id, slit, partner));
            }
        }
        prop_assert!(!at.is_empty());
        for (node, slits) in at {
            let [(a, first, to_b), (b, second, to_a)] = slits[..] else {
                panic!("node {node} has {} slits", slits.len())
            };
            prop_assert_eq!((a, b), (to_a, to_b));
            prop_assert!(first.from != second.from);
            let height = structure(&job).nodes()[node].height();
            let over = first.depth + second.depth - height;
            prop_assert!((over - 0.6).abs() < 1e-9, "node {node}: {over}");
        }
    }

    /// The free width in the outline is what thickness, angles and clearance ask.
    #[test]
    fn slits_are_as_wide_as_the_crossing_asks(draft in any()) {
        let job = job(draft);
        for part in &job.parts {
            let Body::Strip(body) = &part.body else { continue };
            let ring = part.region.outline.flattened(0.001);
            for (slit, partner) in &body.slits {
                let other = job.parts.iter().find(|p| p.id == *partner).expect("it is there");
                let Body::Strip(other) = &other.body else { continue };
                let [before, after] = asked(structure(&job), slit.node, body, other);
                let axis = body.axes.iter().find(|axis| axis.node == slit.node);
                let axis = axis.expect("a slit is on an axis");
                let inside = match slit.from {
                    Opening::Top => axis.top() - axis.up * (0.9 * slit.depth),
                    Opening::Bottom => axis.bottom() + axis.up * (0.9 * slit.depth),
                };
                let walls = cuts(&ring, inside, axis.right());
                let left = walls.iter().filter(|&&x| x < 0.0).fold(f64::MIN, |a, b| a.max(*b));
                let right = walls.iter().filter(|&&x| x > 0.0).fold(f64::MAX, |a, b| a.min(*b));
                prop_assert!((-left - before).abs() < 1e-6, "{} {left} {before}", part.id);
                prop_assert!((right - after).abs() < 1e-6, "{} {right} {after}", part.id);
            }
        }
    }

    /// Drawn cut lines keep their distance from each other and from the sheet's edge, and
    /// no part lies in another.
    #[test]
    fn nested_parts_are_inside_and_disjoint(draft in any()) {
        let job = job(draft);
        let kerf = Kerf::from_width_mm(KERF);
        for sheet in &job.layout.sheets {
            let stock = &job.settings.stock[sheet.stock];
            let rings = sheet.placements.iter().map(|placement| {
                let drawn = kerf.compensated(&job.parts[placement.shape].region.outline);
                drawn.moved(|p| placed(placement, p)).flattened(0.001)
            });
            let rings: Vec<Vec<Point2>> = rings.collect();
            for (k, ring) in rings.iter().enumerate() {
                for p in ring {
                    let edge = p.x.min(p.y).min(stock.width - p.x).min(stock.height - p.y);
                    prop_assert!(edge >= stock.margin - 1e-5, "{edge}");
                }
                for other in &rings[..k] {
                    let gap = apart(ring, other);
                    prop_assert!(gap >= stock.spacing - 1e-5, "{gap}");
                    prop_assert!(!contains(ring, other[0]) && !contains(other, ring[0]));
                }
            }
        }
        let placed: usize = job.layout.sheets.iter().map(|s| s.placements.len()).sum();
        prop_assert_eq!(placed, job.parts.iter().map(|part| part.quantity).sum::<usize>());
    }

    /// Moved to its right by d, a curve gains d times its length and, for all its corners
    /// and arcs, d² times the tangent of half the turn, or half the sweep.
    #[test]
    fn kerf_grows_the_area_as_it_should(draft in any(), kerf in 0.0..0.4) {
        for part in &job(draft).parts {
            let outline = &part.region.outline;
            let grown = Kerf::from_width_mm(kerf).compensated(outline);
            let d = kerf / 2.0;
            let expected = d * outline.length() + d * d * turning(outline);
            let gained = grown.signed_area() - outline.signed_area();
            prop_assert!((gained - expected).abs() < 1e-6, "{}: {gained} {expected}", part.id);
        }
    }

    /// A structure written and read is the same structure.
    #[test]
    fn what_is_written_is_read_back(draft in any()) {
        let (meant, _) = Structure::new(draft, &Tolerance::default()).expect("it is sound");
        let text = write_json(&meant);
        let json = read_json(&text, AxisRule::File).expect("we wrote it");
        let (read, _) = Structure::new(json.0, &Tolerance::default()).expect("it was sound");
        prop_assert_eq!(&meant, &read);
        prop_assert_eq!(text, write_json(&read));
        let options = ObjOptions { unit: Unit::Millimetre, axes: AxisRule::File, weld_mm: 0.0 };
        let (obj, found) = read_obj(&write_obj(&meant), &options).expect("we wrote it");
        prop_assert!(found.is_empty());
        let read = Mesh::new(obj.positions.len(), &obj.faces).expect("we wrote it");
        prop_assert_eq!(&read, meant.mesh());
        for (k, node) in meant.nodes().iter().enumerate() {
            prop_assert_eq!(obj.positions[k], node.position);
            prop_assert_eq!(obj.axes[k], node.axis);
        }
    }

    /// Slits of straight strips that cross at one angle follow the school formula
    /// t (1 + cos θ) / sin θ + c.
    #[test]
    fn straight_strips_follow_the_school_formula(lean in 0.0..30.0_f64, side in Just(60.0)) {
        let shift = side * trig::tan(lean.to_radians());
        let nodes = (0..9).map(|k| (f64::from(k % 3), f64::from(k / 3)));
        let draft = finwright::structure::Draft {
            name: "lean".into(),
            positions: nodes.map(|(i, j)| Point3::new(side * i + shift * j, side * j, 0.0)).collect(),
            axes: vec![Vector3::z(); 9],
            faces: crate::structures::grid(3, 3),
            ..Default::default()
        };
        let job = job(draft.with_depth(15.0, 15.0));
        let angle = (90.0 - lean).to_radians();
        let width = THICKNESS * (1.0 + trig::cos(angle)) / trig::sin(angle) + CLEARANCE;
        for (slit, _) in bodies(&job).flat_map(|body| &body.slits) {
            prop_assert!((slit.width() - width).abs() < 1e-9, "{} {width}", slit.width());
        }
    }
}

/// Unit directions of a strip's two arms at a node, across the axis; past its end a strip
/// runs straight on.
fn arms(structure: &Structure, node: NodeId, body: &StripBody) -> [Vector3; 2] {
    let place =
        body.axes.iter().position(|axis| axis.node == node).expect("it comes there");
    let hub = &structure.nodes()[node];
    let toward = |place: usize| {
        let way = structure.nodes()[body.axes[place].node].position - hub.position;
        (way - hub.axis * way.dot(&hub.axis)).normalize()
    };
    let last = body.axes.len() - 1;
    match place {
        0 => [-toward(1), toward(1)],
        k if k == last => [toward(k - 1), -toward(k - 1)],
        k => [toward(k - 1), toward(k + 1)],
    }
}

fn between(a: Vector3, b: Vector3) -> f64 {
    trig::atan2(a.cross(&b).norm(), a.dot(&b))
}

/// From the axis to each wall of a slit (notes on fabrication, §4.1 and its correction).
fn asked(
    structure: &Structure,
    node: NodeId,
    own: &StripBody,
    other: &StripBody,
) -> [f64; 2] {
    let partner = arms(structure, node, other);
    let kink = PI - between(partner[0], partner[1]);
    let half = THICKNESS / (2.0 * trig::cos(kink / 2.0));
    arms(structure, node, own).map(|arm| {
        let room = partner.map(|neighbour| {
            let b = between(arm, neighbour);
            THICKNESS * (1.0 + trig::cos(b)) / (2.0 * trig::sin(b))
        });
        room.into_iter().fold(half, f64::max) + CLEARANCE / 2.0
    })
}

/// Sum of tan(turn / 2) over corners and of sweep / 2 over arcs.
fn turning(outline: &Contour) -> f64 {
    let segments: Vec<Segment> = outline.segments().collect();
    let heading = |s: &Segment, at_end: bool| {
        let chord = s.to - s.from;
        let half = 2.0 * trig::atan(s.bulge);
        trig::atan2(chord.y, chord.x) + if at_end { half } else { -half }
    };
    let corners = (0..segments.len()).map(|k| {
        let before = &segments[(k + segments.len() - 1) % segments.len()];
        trig::tan((heading(&segments[k], false) - heading(before, true)) / 2.0)
    });
    let arcs = segments.iter().map(|s| 2.0 * trig::atan(s.bulge));
    corners.sum::<f64>() + arcs.sum::<f64>()
}

#[test]
fn a_disc_grows_to_a_larger_disc() {
    let quarter = trig::tan(FRAC_PI_8);
    let corners = [(7.0, 0.0), (0.0, 7.0), (-7.0, 0.0), (0.0, -7.0)];
    let vertices = corners.map(|(x, y)| Vertex::arc(Point2::new(x, y), quarter)).to_vec();
    let grown = Kerf::from_width_mm(2.0).compensated(&Contour { vertices });
    assert!((grown.signed_area() - 64.0 * PI).abs() < 1e-9);
}
