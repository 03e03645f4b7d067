//! Ends of strips that cannot lap stand in discs.

use crate::planting::{Planting, found, job};
use crate::structures::material;
use finwright::design::examples;
use finwright::diagnostic::passes;
use finwright::fabrication::{Fabrication, fabricate, plan};
use finwright::ids::NodeId;
use finwright::nest::Effort;
use finwright::parts::{self, Body, ConnectorBody, Part};
use finwright::proof::prove;
use finwright::rigidity::{Model, RigidBody};
use finwright::settings::Settings;
use finwright::structure::{AxisRule, Draft, read_json};
use finwright::template::Template;
use std::collections::BTreeSet;

fn made(draft: Draft, template: &Template) -> Fabrication {
    with_hubs(draft, template, &[])
}

fn with_hubs(draft: Draft, template: &Template, hubs: &[NodeId]) -> Fabrication {
    let effort = Effort { trials: 1, seed: 0 };
    let accepted_flexible = Some("a test".to_owned());
    let settings = Settings::new(template.clone()).with_hubs(hubs.iter().copied());
    let settings = Settings { effort, accepted_flexible, ..settings };
    fabricate(draft, settings, &mut ()).unwrap()
}

fn example(name: &str) -> Draft {
    (examples::named(name).unwrap().draft)()
}

fn fixture(name: &str) -> Draft {
    let path = format!("{}/fixtures/{name}", env!("CARGO_MANIFEST_DIR"));
    read_json(&std::fs::read_to_string(path).unwrap(), AxisRule::File).unwrap().0
}

fn connectors(job: &Fabrication) -> Vec<(&Part, &ConnectorBody)> {
    let parts = job.parts.iter().filter_map(|part| match &part.body {
        Body::Connector(body) => Some((part, body)),
        _ => None,
    });
    parts.collect()
}

/// Names of the parts that end at a node, one for each end.
fn ending(job: &Fabrication, node: NodeId) -> Vec<String> {
    let ends =
        |part: &Part| part.body.tips().iter().filter(|t| t.axis.node == node).count();
    let ends = job.parts.iter().flat_map(|p| std::iter::repeat_n(p.id.clone(), ends(p)));
    ends.collect()
}

#[test]
fn every_end_that_cannot_lap_stands_in_discs_and_every_strip_ends_there() {
    let jobs = [
        made(example("three"), &material("pmma-cast-3")),
        made(example("five"), &material("pmma-cast-3")),
        made(example("dome"), &material("pmma-xt-1.5")),
        made(fixture("ring.json"), &material("pmma-xt-1.5")),
    ];
    for job in &jobs {
        let name = job.structure.as_ref().unwrap().name();
        assert!(passes(&job.findings), "{name} {:#?}", job.findings);
        let codes: BTreeSet<&str> =
            job.findings.iter().map(|f| f.code.as_str()).collect();
        assert!(!codes.contains("parts::strip_end_unheld"), "{name} {codes:?}");
        assert!(!connectors(job).is_empty(), "{name} has loose ends");
        let structure = job.structure.as_ref().unwrap();
        for (part, body) in connectors(job) {
            let node = body.node();
            let (mut held, mut ends) = (body.fins.clone(), ending(job, node));
            held.sort();
            ends.sort();
            assert_eq!(held, ends, "{name} {}", part.id);
            assert_eq!(held.len(), structure.nodes()[node].arms.len(), "{name} {node}");
            assert_eq!((part.quantity, body.plates.copies.len()), (2, 2));
            for other in &job.parts {
                let Body::Strip(strip) = &other.body else { continue };
                let lapped = strip.slits.iter().any(|(slit, _)| slit.node == node);
                assert!(!lapped, "{name}: {} laps at {node}", other.id);
            }
        }
    }
    let [three, five, _, ring] = &jobs;
    assert!(connectors(three).iter().any(|(_, hub)| hub.fins.len() == 3));
    assert!(connectors(five).iter().any(|(_, hub)| hub.fins.len() == 5));
    let twice = |hub: &ConnectorBody| {
        hub.fins.len() > hub.fins.iter().collect::<BTreeSet<_>>().len()
    };
    assert!(connectors(ring).iter().any(|(_, hub)| twice(hub)), "both ends of a ring");
}

#[test]
fn a_hub_that_was_asked_for_cuts_the_strips_that_ran_through() {
    let template = material("pmma-cast-3");
    let job = made(example("three"), &template);
    let lapped = job.parts.iter().find_map(|part| match &part.body {
        Body::Strip(strip) => {
            let inner = &strip.axes[1..strip.axes.len() - 1];
            let slit = |node| strip.slits.iter().any(|(slit, _)| slit.node == node);
            inner.iter().map(|axis| axis.node).find(|&node| slit(node))
        }
        _ => None,
    });
    let node = lapped.unwrap();
    let asked = with_hubs(example("three"), &template, &[node]);
    assert!(passes(&asked.findings), "{:#?}", asked.findings);
    assert_eq!(ending(&asked, node).len(), 4);
    let fins = |job: &Fabrication| job.structure.as_ref().unwrap().fins().to_vec();
    assert_eq!(fins(&job), fins(&asked));
    let strips = |job: &Fabrication| job.structure.as_ref().unwrap().strips().len();
    assert_eq!(strips(&asked), strips(&job) + 2, "two strips were cut in two");
}

#[test]
fn the_verdict_counts_with_the_discs() {
    let template = material("pmma-cast-3");
    let draft = example("three");
    let job = made(draft, &template);
    let structure = job.structure.as_ref().unwrap();
    let model = plan(structure, &job.settings).model();
    let hubs =
        model.bodies.iter().filter(|body| matches!(body, RigidBody::Hub(_))).count();
    assert_eq!(hubs, connectors(&job).len());
    let slots = model.couplings.iter().filter(|knot| !knot.is_pin());
    let ends: usize = connectors(&job).iter().map(|(_, body)| body.fins.len()).sum();
    assert_eq!(slots.count(), ends);
    // Without them the ends would hang in the air: no body of theirs is on the node's pin.
    let (node, loose) = (connectors(&job)[0].1.node(), Default::default());
    let bare = Model::of_strips(structure, &loose, &Default::default());
    let on = |model: &Model| model.couplings[model.pin(node).unwrap()].bodies.len();
    assert_eq!(on(&model), on(&bare) + 1);
    assert!(job.approved().is_ok(), "judged as it is cut");
    let settings = job.settings.clone().with_hubs([0_usize]);
    let other = Fabrication { settings, ..job };
    assert!(other.approved().is_err(), "judged with other hubs");
}

#[test]
fn ends_without_room_for_discs_are_told_with_the_reason() {
    let draft = example("three").with_depth(2.5, 2.5);
    let job = made(draft, &material("pmma-cast-3"));
    let loose = job.findings.iter().find(|f| f.code == "parts::strip_end_unheld");
    let message = &loose.unwrap().message;
    assert!(message.contains("discs have no room"), "{message}");
    assert!(connectors(&job).is_empty());
}

#[test]
fn a_slot_of_another_strip_or_a_closed_window_makes_parts_collide() {
    let template = material("pmma-cast-3");
    let job = made(example("three"), &template);
    let structure = job.structure.as_ref().unwrap();
    let fit = &job.settings.fit;
    let hits = |parts: &[Part]| parts::collisions(structure, parts, fit);
    assert!(hits(&job.parts).is_empty());
    let nth =
        job.parts.iter().position(|p| matches!(p.body, Body::Connector(_))).unwrap();
    let mut turned = job.parts.clone();
    let turn = nalgebra::Rotation2::new(1_f64.to_radians());
    for hole in &mut turned[nth].region.holes {
        *hole = hole.moved(|p| turn * p);
    }
    assert!(!hits(&turned).is_empty(), "a disc turned by a degree");
    let mut closed = job.parts.clone();
    closed[nth].region.holes.truncate(1);
    assert!(!hits(&closed).is_empty(), "a disc without windows");
    let mut low = job.parts.clone();
    let Body::Connector(body) = &mut low[nth].body else { panic!("it was one") };
    body.plates.copies[1].height -= 1.0;
    assert!(!hits(&low).is_empty(), "a disc below the floor of its notches");
}

#[test]
fn files_with_held_ends_prove_themselves_and_a_wrong_slot_is_found() {
    for name in ["three", "fixtures/ring.json"] {
        let proof = prove(&job(name)).unwrap();
        assert!(proof.findings.is_empty(), "{name} {:#?}", proof.findings);
        for worst in &proof.worst {
            assert!(worst.slot_deg < 0.001 && worst.node_gap_mm < 0.001, "{worst:?}");
            assert!(worst.fin_mm < 0.001 && worst.outline_mm < 0.01, "{worst:?}");
        }
    }
    let mut planting = Planting::of(job("three"));
    let parts = planting.manifest["parts"].as_array_mut().unwrap();
    let hub = parts.iter_mut().find(|part| part["kind"] == "connector").unwrap();
    let id = hub["id"].as_str().unwrap().to_owned();
    let slot = &mut hub["connector"]["slots"][1];
    slot["angle_deg"] = (slot["angle_deg"].as_f64().unwrap() + 0.02).into();
    found(&planting.proof(), "proof::slot_turned", &id);

    let mut planting = Planting::of(job("three"));
    let parts = planting.manifest["parts"].as_array_mut().unwrap();
    let hub = parts.iter_mut().find(|part| part["kind"] == "connector").unwrap();
    let height = &mut hub["connector"]["copies"][1]["height"];
    *height = (height.as_f64().unwrap() - 0.5).into();
    found(&planting.proof(), "proof::parts_collide", &id);
}
