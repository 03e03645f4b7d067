//! Single fins in hubs and on hinges: complete, at the right angles, and they go together.

use crate::planting::{Planting, found, job};
use crate::structures::material;
use finwright::design::examples;
use finwright::diagnostic::passes;
use finwright::fabrication::{Fabrication, fabricate, with_remedies};
use finwright::geometry::{Contour, Point2, Vector2, Vertex, trig};
use finwright::ids::{FinId, NodeId};
use finwright::joint::Joint;
use finwright::nest::Effort;
use finwright::parts::{self, Body, ConnectorBody, Part, inner_radius};
use finwright::proof::prove;
use finwright::rigidity::Outcome;
use finwright::settings::Settings;
use finwright::structure::{Draft, Structure};
use finwright::template::Template;
use std::collections::{BTreeMap, BTreeSet};
use std::f64::consts::PI;

/// An embedded structure made with single fins.
fn made(name: &str, joint: Joint, template: &Template) -> Fabrication {
    let draft = (examples::named(name).unwrap().draft)();
    let effort = Effort { trials: 1, seed: 0 };
    let accepted_flexible = Some("a test".to_owned());
    let settings = Settings::new(template.clone());
    let settings = Settings { joint, effort, accepted_flexible, ..settings };
    fabricate(draft, settings, &mut ()).unwrap()
}

fn connectors(job: &Fabrication) -> impl Iterator<Item = (&Part, &ConnectorBody)> {
    job.parts.iter().filter_map(|part| match &part.body {
        Body::Connector(body) => Some((part, body)),
        _ => None,
    })
}

fn fins(job: &Fabrication) -> BTreeMap<&str, [NodeId; 2]> {
    let fins = job.parts.iter().filter_map(|part| match &part.body {
        Body::Fin(fin) => Some((part.id.as_str(), fin.nodes)),
        _ => None,
    });
    fins.collect()
}

/// Angle from one fin of a node to another, counter-clockwise about the axis, by nothing
/// but the positions of nodes.
fn angle(structure: &Structure, node: NodeId, [from, to]: [NodeId; 2]) -> f64 {
    let at = &structure.nodes()[node];
    let flat = |other: NodeId| {
        let d = structure.nodes()[other].position - at.position;
        d - at.axis * d.dot(&at.axis)
    };
    let (a, b) = (flat(from), flat(to));
    trig::atan2(at.axis.dot(&a.cross(&b)), a.dot(&b)).rem_euclid(2.0 * PI)
}

const CASES: [(&str, Joint, &str); 6] = [
    ("three", Joint::Hub, "pmma-cast-3"),
    ("five", Joint::Hub, "pmma-cast-3"),
    ("vault", Joint::Hub, "pmma-cast-3"),
    ("dome", Joint::Hub, "pmma-xt-1.5"),
    ("three", Joint::Hinge, "pmma-cast-3"),
    ("vault", Joint::Hinge, "pmma-cast-2"),
];

#[test]
fn every_fin_is_there_once_and_every_node_has_its_connector_at_the_angles_in_space() {
    for (name, joint, template) in CASES {
        let job = made(name, joint, &material(template));
        assert!(passes(&job.findings), "{name} {joint:?} {:#?}", job.findings);
        is_complete(&job, joint);
        stands_as_in_space(&job, name);
    }
}

fn is_complete(job: &Fabrication, joint: Joint) {
    let structure = job.structure.as_ref().unwrap();
    let mut cut: Vec<FinId> = fins(job).into_values().map(FinId::from).collect();
    cut.sort_unstable();
    let mut all = structure.fins().to_vec();
    all.sort_unstable();
    assert_eq!(cut, all);
    let joined = structure.nodes().iter().enumerate();
    let joined = joined.filter(|(_, node)| node.arms.len() > 1);
    let nodes: Vec<usize> =
        connectors(job).map(|(_, body)| body.node().index()).collect();
    assert_eq!(nodes, joined.map(|(k, _)| k).collect::<Vec<_>>());
    for (part, body) in connectors(job) {
        // Windows, rod, and the key hole that tells which face is up.
        let holes = if joint == Joint::Hub { body.fins.len() + 2 } else { 1 };
        assert_eq!(part.region.holes.len(), holes, "{}", part.id);
        let plates = if joint == Joint::Hub { 2 } else { 2 * body.fins.len() };
        assert_eq!((part.quantity, body.plates.copies.len()), (plates, plates));
    }
    let placed: usize = job.layout.sheets.iter().map(|s| s.placements.len()).sum();
    assert_eq!(placed, job.parts.iter().map(|part| part.quantity).sum::<usize>());
}

fn stands_as_in_space(job: &Fabrication, name: &str) {
    let (structure, fins) = (job.structure.as_ref().unwrap(), fins(job));
    for (_, body) in connectors(job) {
        let node = body.node();
        let far = |fin: &String| {
            let [i, j] = fins[fin.as_str()];
            if i == node { j } else { i }
        };
        let first = far(&body.fins[0]);
        for (fin, at) in body.fins.iter().zip(&body.star.fins) {
            let needed = angle(structure, node, [first, far(fin)]);
            let off = (at.bearing - needed + PI).rem_euclid(2.0 * PI) - PI;
            assert!(off.to_degrees().abs() < 0.01, "{name} {node} {fin} {off}");
        }
        let held: BTreeSet<&String> = body.fins.iter().collect();
        assert_eq!(held.len(), structure.nodes()[node].arms.len());
    }
}

#[test]
fn a_window_that_is_turned_and_a_fin_that_is_swapped_collide() {
    let template = material("pmma-cast-3");
    let job = made("five", Joint::Hub, &template);
    let structure = job.structure.as_ref().unwrap();
    let fit = &job.settings.fit;
    let hits = |parts: &[Part]| parts::collisions(structure, parts, fit);
    assert!(hits(&job.parts).is_empty());
    let nth = job.parts.iter().position(|part| part.id == "N20").unwrap();

    let mut turned = job.parts.clone();
    // The clearance lets a fin of this disc turn by 0.6 degrees.
    let turn = nalgebra::Rotation2::new(1_f64.to_radians());
    for hole in &mut turned[nth].region.holes {
        *hole = hole.moved(|p| turn * p);
    }
    assert!(hits(&turned).iter().any(|hit| format!("{hit:?}").contains("N20")));

    let mut narrow = job.parts.clone();
    let holes = &mut narrow[nth].region.holes;
    *holes = holes.iter().map(|hole| shrunk(hole, 0.03)).collect();
    assert!(hits(&narrow).iter().any(|hit| format!("{hit:?}").contains("N20")));

    let mut swapped = job.parts.clone();
    let ids = [&swapped[0].id, &swapped[7].id].map(Clone::clone);
    let [first, second] = ids;
    (swapped[0].id, swapped[7].id) = (second, first);
    assert!(!hits(&swapped).is_empty());
}

/// A clockwise hole with its line moved inward.
fn shrunk(hole: &Contour, by: f64) -> Contour {
    finwright::geometry::offset::offset(hole, by)
}

#[test]
fn files_of_hubs_and_hinges_prove_themselves() {
    for example in
        ["three --joint hub", "five --joint hinge", "three --joint hinge --hubs 0,5"]
    {
        let proof = prove(&job(example)).unwrap();
        assert!(proof.findings.is_empty(), "{example} {:#?}", proof.findings);
        for worst in &proof.worst {
            assert!(worst.slot_deg < 0.001 && worst.node_gap_mm < 0.001, "{worst:?}");
            assert!(worst.fin_mm < 0.001 && worst.outline_mm < 0.01, "{worst:?}");
        }
    }
}

/// The place of a part on the first sheet.
fn place_of(planting: &Planting, id: &str) -> usize {
    let placements = planting.manifest["sheets"][0]["placements"].as_array().unwrap();
    placements.iter().position(|placement| placement["part"] == id).unwrap()
}

#[test]
fn a_turned_disc_a_wrong_angle_and_swapped_fins_are_found() {
    let files = job("three --joint hub");
    let placed = Planting::of(files.clone());
    let placements = placed.manifest["sheets"][0]["placements"].as_array().unwrap();
    let hub = placements.iter().map(|p| p["part"].as_str().unwrap());
    let hub = hub.filter(|part| part.starts_with('N')).max().unwrap().to_owned();

    let mut turned = Planting::of(files.clone());
    let nth = place_of(&turned, &hub);
    let center = turned.to_sheet(nth, Point2::origin());
    let turn = nalgebra::Rotation2::new(5_f64.to_radians());
    for line in turned.lines.iter_mut().filter(|line| line.layer.starts_with("CUT")) {
        if (line.middle() - center).norm() < 14.0 {
            line.contour = line.contour.moved(|p| center + turn * (p - center));
        }
    }
    found(&turned.proof(), "proof::slot_turned", &hub);

    let connector = |planting: &mut Planting| {
        let parts = planting.manifest["parts"].as_array_mut().unwrap();
        let nth = parts.iter().position(|part| part["id"] == hub.as_str()).unwrap();
        planting.manifest["parts"][nth]["connector"].take()
    };
    let put = |planting: &mut Planting, value: serde_json::Value| {
        let parts = planting.manifest["parts"].as_array_mut().unwrap();
        let part = parts.iter_mut().find(|part| part["id"] == hub.as_str()).unwrap();
        part["connector"] = value;
    };
    let mut wrong = Planting::of(files.clone());
    let mut listed = connector(&mut wrong);
    let angle = listed["slots"][1]["angle_deg"].as_f64().unwrap();
    listed["slots"][1]["angle_deg"] = (angle + 0.02).into();
    put(&mut wrong, listed);
    found(&wrong.proof(), "proof::slot_turned", &hub);

    let mut swapped = Planting::of(files);
    let mut listed = connector(&mut swapped);
    let first = listed["slots"][0]["fin"].take();
    listed["slots"][0]["fin"] = listed["slots"][1]["fin"].take();
    listed["slots"][1]["fin"] = first;
    put(&mut swapped, listed);
    found(&swapped.proof(), "proof::slot_turned", &hub);
}

#[test]
fn radii_of_discs_are_those_of_the_closed_formula() {
    // (w + u cos(b/2)) / (2 sin(b/2)) in another program, web w = t, window u = t + 0.1.
    const TABLE: [(f64, [f64; 6]); 3] = [
        (2.0, [9.3565, 5.1481, 3.8187, 2.4642, 1.7609, 1.3166]),
        (3.0, [13.9219, 7.6617, 5.6847, 3.6713, 2.6269, 1.9682]),
        (5.0, [23.0529, 12.6891, 9.4167, 6.0855, 4.359, 3.2715]),
    ];
    const ANGLES: [f64; 6] = [25.0, 45.0, 60.0, 90.0, 120.0, 150.0];
    for (thickness, radii) in TABLE {
        for (degrees, wanted) in ANGLES.into_iter().zip(radii) {
            let found = inner_radius(degrees.to_radians(), thickness + 0.1, thickness);
            assert!((found - wanted).abs() < 1e-4, "{thickness} {degrees} {found}");
            // And the corners of two windows really leave that web.
            let corner = |bearing: f64, side: f64| {
                let turn = nalgebra::Rotation2::new(bearing);
                turn * Vector2::new(found, side * (thickness + 0.1) / 2.0)
            };
            let web = (corner(0.0, 1.0) - corner(degrees.to_radians(), -1.0)).norm();
            assert!((web - thickness).abs() < 1e-9, "{thickness} {degrees} {web}");
        }
    }
}

#[test]
fn hubs_on_a_hinged_structure_hold_it_and_the_gate_knows() {
    let draft = || {
        let draft = (examples::named("three").unwrap().draft)();
        Draft { fixed: Some(vec![6, 24, 30, 54, 60, 84]), ..draft }
    };
    let made = |settings: &Settings| {
        let effort = Effort { trials: 1, seed: 0 };
        let accepted_flexible = Some("a test".to_owned());
        let settings = Settings { effort, accepted_flexible, ..settings.clone() };
        fabricate(draft(), settings, &mut ()).unwrap()
    };
    let outcome = |job: &Fabrication| job.verdict.as_ref().unwrap().outcome();
    let mut template = material("pmma-cast-3");
    template.gate.play_mm = Some(0.015);
    let hinges = Settings { joint: Joint::Hinge, ..Settings::new(template) };
    let loose = made(&hinges);
    assert_eq!(outcome(&loose), Outcome::Mechanism);

    let every: Vec<usize> = (0..91).collect();
    let all = made(&hinges.clone().with_hubs(every));
    let hubs = Settings { joint: Joint::Hub, ..hinges.clone() };
    assert_eq!(outcome(&all), outcome(&made(&hubs)));

    let cured = with_remedies(&draft(), hinges.clone(), &mut ()).unwrap();
    let few = cured.hub_nodes.len();
    let job = made(&cured);
    assert!(job.verdict.as_ref().unwrap().passes(), "{few} hubs");
    let hubs = connectors(&job).filter(|(part, _)| part.quantity == 2);
    assert!(few < 91 && hubs.count() >= few);
    assert!(job.approved().is_ok());
    let without = Fabrication { settings: hinges, ..job };
    assert!(without.approved().is_err(), "judged with hubs");
}

#[test]
fn steps_name_every_part_once() {
    for joint in [Joint::Hub, Joint::Hinge] {
        let job = made("three", joint, &material("pmma-cast-3"));
        let mut copies: BTreeMap<usize, usize> = BTreeMap::new();
        for step in &job.steps {
            *copies.entry(step.part.index()).or_default() +=
                step.copies[1] + 1 - step.copies[0];
        }
        let all = job.parts.iter().map(|part| part.quantity).enumerate();
        assert_eq!(copies, all.collect());
    }
}

#[test]
fn circles_stay_circles() {
    // Kerf moves an arc exactly only if it meets its neighbours without a corner.
    let job = made("three", Joint::Hub, &material("pmma-cast-3"));
    let (part, _) = connectors(&job).next().unwrap();
    let arcs = |contour: &Contour| contour.segments().filter_map(|s| s.arc()).count();
    assert_eq!(arcs(&part.region.outline), part.region.outline.vertices.len());
    let grown = finwright::geometry::offset::offset(&part.region.outline, 0.09);
    let radius = |v: &Vertex| v.point.coords.norm();
    let radii: Vec<f64> = grown.vertices.iter().map(radius).collect();
    assert!(radii.iter().all(|r| (r - radii[0]).abs() < 1e-9));
}
