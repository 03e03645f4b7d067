//! The connectors of a plan as parts, and whether they and the fins have room.

use crate::diagnostic::{Finding, passes};
use crate::ids::{FinId, NodeId};
use crate::parts::Making;
use crate::parts::assembly::collisions;
use crate::parts::clearance::{FinClearance, long_setbacks, sharp_angles};
use crate::parts::connector::{Connector, PlateText};
use crate::parts::finding::PartFinding;
use crate::parts::part::{Body, ConnectorBody, Part, crossing_outline};
use crate::parts::plan::Plan;
use crate::parts::star::shortest;
use std::collections::BTreeMap;

/// Adds the plates of all connectors to the parts they hold and says what is wrong with both;
/// `unlettered` are texts that found no room on those.
pub(super) fn add_plates(
    plan: &Plan,
    making: &Making,
    parts: &mut Vec<Part>,
    mut unlettered: Vec<(String, usize)>,
) -> Vec<Finding> {
    if plan.connectors.is_empty() && plan.strips.is_some() {
        return Vec::new();
    }
    let names = fin_names(plan, parts);
    let mut facts = lacks(plan, making, &names);
    let first = parts.len();
    for connector in plan.connectors.values() {
        let (part, missing) = part(connector.as_ref(), making, &names);
        unlettered.push((part.id.clone(), missing));
        parts.push(part);
    }
    facts.extend(without_room(&unlettered));
    facts.extend(parts[first..].iter().filter_map(crossing_outline));
    let mut findings: Vec<Finding> = facts.into_iter().map(Finding::from).collect();
    // Where connectors have no room it was said already; parts that overlap say no more.
    if passes(&findings) {
        let found = collisions(&plan.structure, parts, making.fit);
        findings.extend(found.into_iter().map(Finding::from));
    }
    findings
}

/// The name of the part that each fin is on.
fn fin_names(plan: &Plan, parts: &[Part]) -> Vec<String> {
    let mut part_of: BTreeMap<FinId, &str> = BTreeMap::new();
    for part in parts {
        let nodes = part.body.nodes();
        let fins = nodes.windows(2).map(|w| FinId::between(w[0], w[1]));
        part_of.extend(fins.map(|fin| (fin, part.id.as_str())));
    }
    let names = plan.structure.fins().iter().map(|fin| part_of.get(fin).copied());
    names.map(|name| name.unwrap_or_default().to_owned()).collect()
}

/// The plates of a connector, and how many of their texts found no room.
fn part(connector: &dyn Connector, making: &Making, names: &[String]) -> (Part, usize) {
    let star = connector.star();
    let name = format!("N{}", star.node);
    let fins: Vec<String> =
        star.fins.iter().map(|fin| names[fin.index].clone()).collect();
    let text = PlateText { name: &name, fins: &fins, height: making.marking.height };
    let (marks, missing) = connector.marks(&text, making.fit);
    let body = ConnectorBody {
        star: star.clone(),
        plates: connector.plates(),
        reach: connector.reach(),
        rod: making.fit.rod_diameter,
        words: connector.words(&name),
        fins,
    };
    let part = Part {
        id: name,
        quantity: body.plates.copies.len(),
        region: connector.region(making.fit),
        marks,
        body: Body::Connector(body),
    };
    (part, missing)
}

/// Connectors without room: between fins, on the axis, on the sheet, along fins.
fn lacks(plan: &Plan, making: &Making, names: &[String]) -> Vec<PartFinding> {
    let fit = making.fit;
    let name = |fin: usize| names[fin].clone();
    let mut all = Vec::new();
    for connector in plan.connectors.values() {
        all.extend(sharp_angles(connector.star(), connector.setback(), &name, fit));
        all.extend(connector.lacks(making));
    }
    let slits = plan.slits();
    let clearance = |(fin, id): (usize, &FinId)| {
        let nodes = id.ends();
        let held = || nodes.iter().filter_map(|node| plan.connectors.get(node));
        held().next()?;
        let slit = |at: [NodeId; 2]| slits.get(&at).copied().unwrap_or_default();
        let slits = slit(nodes) + slit([nodes[1], nodes[0]]);
        Some(FinClearance {
            part: name(fin),
            nodes,
            length: shortest(&plan.structure, nodes),
            taken: held().map(|connector| connector.reach()).sum::<f64>() + slits,
            lost: held().map(|connector| connector.setback()).sum(),
        })
    };
    let fins = plan.structure.fins().iter().enumerate();
    let fins: Vec<FinClearance> = fins.filter_map(clearance).collect();
    all.extend(fins.iter().filter_map(|fin| fin.touching(fit)));
    all.extend(long_setbacks(&fins, fit));
    all
}

/// What is said of names that found no room, all at once: on a small model there are many.
fn without_room(missing: &[(String, usize)]) -> Option<PartFinding> {
    let parts: Vec<String> =
        missing.iter().filter(|(_, n)| *n > 0).map(|(part, _)| part.clone()).collect();
    let count = missing.iter().map(|(_, count)| count).sum();
    (count > 0).then_some(PartFinding::Unlettered { parts, count })
}
