//! Single fins: every fin of a structure is a part of its own, held by connectors.

mod seated;

use crate::diagnostic::Finding;
use crate::geometry::{Contour, Region};
use crate::parts::clearance::sharp_angles;
use crate::parts::connector::Connector;
use crate::parts::finding::PartFinding;
use crate::parts::fit::Fit;
use crate::parts::part::{Body, FinBody, Part};
use crate::parts::plan::Plan;
use crate::parts::star::Star;
use crate::parts::unfold::{FlatStrip, unfold};
use crate::parts::{Bodies, Making};
use crate::structure::Structure;
use crate::tolerance::CONGRUENT_MM;
use seated::SeatedFin;
use std::collections::BTreeMap;

/// The plan of a structure of single fins: what holds them on each node that joins any. No
/// plate can hold fins that lie upon each other.
pub(super) fn plan(
    structure: &Structure,
    fit: &Fit,
    connector: &dyn Fn(Star) -> Box<dyn Connector>,
) -> Plan {
    let (stars, without): (Vec<Star>, Vec<Star>) =
        Star::all(structure, fit).partition(Star::has_room);
    let name = |fin: usize| fin_name(fin, structure.fins().len());
    let found = without.iter().flat_map(|star| sharp_angles(star, 0.0, &name, fit));
    let found = found.filter(|fact| matches!(fact, PartFinding::UponEachOther { .. }));
    let findings = found.map(Finding::from).collect();
    let connectors = stars.into_iter().map(|star| (star.node, connector(star))).collect();
    Plan { structure: structure.clone(), strips: None, connectors, findings }
}

/// The fins as parts.
pub(super) fn parts(plan: &Plan, making: &Making) -> Bodies {
    let count = plan.structure.fins().len();
    let mut shapes = Shapes::default();
    let fins = (0..count).map(|fin| part(plan, making, fin, &mut shapes));
    let (parts, unlettered) = fins.unzip();
    Bodies { parts, unlettered, findings: Vec::new() }
}

/// Names count from 1 and sort as text.
fn fin_name(fin: usize, count: usize) -> String {
    let digits = count.to_string().len().max(2);
    format!("F{:0digits$}", fin + 1)
}

/// A fin, and how many of its texts found no room on it.
fn part(
    plan: &Plan,
    making: &Making,
    fin: usize,
    shapes: &mut Shapes,
) -> (Part, (String, usize)) {
    let nodes = plan.structure.fins()[fin].ends();
    let flat = unfold(&plan.structure, &nodes, false);
    let end = |k: usize| {
        let connector = plan.connectors.get(&nodes[k])?;
        Some((connector.as_ref(), connector.star().fin(fin)?))
    };
    let seated = SeatedFin { flat: &flat, ends: [end(0), end(1)], fit: making.fit };
    let outline = seated.outline();
    let id = fin_name(fin, plan.structure.fins().len());
    let (marks, missing) = seated.marks(&id, making.marking.height);
    let setback = |k: usize| end(k).map_or(0.0, |(connector, _)| connector.setback());
    let fin = FinBody {
        nodes,
        setbacks: [setback(0), setback(1)],
        shape: shapes.named(&flat, &outline),
        axes: flat.axes,
    };
    let region = Region { outline, holes: Vec::new() };
    let missing = (id.clone(), missing);
    (Part { id, quantity: 1, region, marks, body: Body::Fin(fin) }, missing)
}

/// Outlines met so far, by the fin's length and name; congruent ones share a name.
#[derive(Default)]
struct Shapes {
    known: BTreeMap<i64, Vec<(Contour, String)>>,
    count: usize,
}

impl Shapes {
    fn named(&mut self, flat: &FlatStrip, outline: &Contour) -> String {
        let foot = flat.axes[0].foot.coords;
        let outline = outline.moved(|p| p - foot);
        let key = (flat.length() / CONGRUENT_MM).floor() as i64;
        let near = (key - 1..=key + 1).filter_map(|key| self.known.get(&key)).flatten();
        if let Some((_, name)) =
            near.into_iter().find(|(known, _)| congruent(known, &outline))
        {
            return name.clone();
        }
        self.count += 1;
        let name = format!("fin-{}", self.count);
        self.known.entry(key).or_default().push((outline, name.clone()));
        name
    }
}

fn congruent(a: &Contour, b: &Contour) -> bool {
    let pairs = a.vertices.iter().zip(&b.vertices);
    a.vertices.len() == b.vertices.len()
        && pairs.into_iter().all(|(a, b)| (a.point - b.point).norm() <= CONGRUENT_MM)
}
