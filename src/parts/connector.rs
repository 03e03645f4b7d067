//! Single fins, and the connectors that hold them and the ends of strips on the node axes.
//!
//! A *hub* is a pair of slotted discs: one shape, pushed onto the fins of a node along its
//! axis, one from below and one from above, a rod through both. A window crosses its fin
//! squarely, so its width is the thickness and the clearance at any angle, and the disc is
//! its own angle gauge. A *hinge* is a stack of eye plates on a rod, two for each fin
//! (docs/formulas.md §2.4). A node with one fin needs neither.

use crate::diagnostic::{Finding, passes};
use crate::geometry::{Contour, Region};
use crate::ids::{FinId, NodeId};
use crate::parts::assembly::built::collisions;
use crate::parts::assembly::copy::copies;
use crate::parts::clearance;
use crate::parts::fin::Seated;
use crate::parts::fit::Fit;
use crate::parts::hinge::plate::Hinge;
use crate::parts::hub::dimensions::Hub;
use crate::parts::hub::disc;
use crate::parts::lap::placement::Plan;
use crate::parts::part::{Body, ConnectorBody, FinBody, Part};
use crate::parts::star::Around;
use crate::parts::steps::steps;
use crate::parts::unfold::{FlatStrip, unfold};
use crate::parts::{Made, Making, crossing_outline};
use crate::structure::Structure;
use crate::tolerance::CONGRUENT_MM;
use std::collections::BTreeMap;

/// What holds the fins of a node.
#[derive(Debug, Clone, PartialEq)]
pub enum Connector {
    /// Two slotted discs.
    Hub(Hub),
    /// Eye plates on a rod.
    Hinge(Hinge),
}

impl Connector {
    /// The fins it holds.
    pub fn around(&self) -> &Around {
        match self {
            Self::Hub(hub) => &hub.around,
            Self::Hinge(hinge) => &hinge.around,
        }
    }

    /// Where fins stop, from the axis, mm.
    pub fn setback(&self) -> f64 {
        match self {
            Self::Hub(hub) => hub.setback,
            Self::Hinge(hinge) => hinge.setback,
        }
    }

    /// Thickness of its plates, mm.
    pub fn thickness(&self) -> f64 {
        match self {
            Self::Hub(hub) => hub.thickness,
            Self::Hinge(hinge) => hinge.thickness,
        }
    }

    /// Radius of a disc or an eye, mm.
    pub fn radius(&self) -> f64 {
        match self {
            Self::Hub(hub) => hub.radius,
            Self::Hinge(hinge) => hinge.radius,
        }
    }

    /// How far it reaches along a fin, from the axis, mm.
    pub fn reach(&self) -> f64 {
        match self {
            Self::Hub(hub) => hub.notch[1],
            Self::Hinge(hinge) => hinge.tail(),
        }
    }
}

/// Makes the parts of a structure of single fins: hubs on the nodes that `is_hub` names,
/// hinges on all others.
pub fn connected(
    structure: &Structure,
    is_hub: &dyn Fn(NodeId) -> bool,
    making: &Making,
) -> Made {
    let fins = structure.fins();
    let connectors = connectors(structure, is_hub, making.fit);
    let names: Vec<String> =
        (0..fins.len()).map(|fin| fin_name(fin, fins.len())).collect();
    let (mut parts, unlettered) = fin_parts(structure, making, &connectors, &names);
    let crossing = parts.iter().filter_map(crossing_outline).map(Finding::from);
    let crossing: Vec<Finding> = crossing.collect();
    let holding =
        Holding { structure, making, connectors, names, slits: BTreeMap::new() };
    let mut findings = holding.plates(&mut parts, unlettered);
    findings.extend(crossing);
    Made { steps: steps(&parts), structure: structure.clone(), parts, findings }
}

/// Adds the discs of a plan of strips to their parts.
pub(crate) fn discs(plan: &Plan, parts: &mut Vec<Part>, making: &Making) -> Vec<Finding> {
    if plan.hubs.is_empty() {
        return Vec::new();
    }
    let structure = &plan.structure;
    let mut part_of: BTreeMap<FinId, &str> = BTreeMap::new();
    for part in parts.iter() {
        let nodes = part.body.nodes();
        let fins = nodes.windows(2).map(|w| FinId::between(w[0], w[1]));
        part_of.extend(fins.map(|fin| (fin, part.id.as_str())));
    }
    let names = structure.fins().iter().map(|fin| part_of.get(fin).copied());
    let names = names.map(|name| name.unwrap_or_default().to_owned()).collect();
    let hub = |node: NodeId| plan.hubs.get(&node).cloned().map(Connector::Hub);
    let connectors = structure.mesh().nodes().map(hub).collect();
    let slits = plan.slits();
    Holding { structure, making, connectors, names, slits }.plates(parts, Vec::new())
}

/// What holds the parts of a structure.
pub(crate) struct Holding<'a> {
    pub structure: &'a Structure,
    pub making: &'a Making<'a>,
    /// By node.
    pub connectors: Vec<Option<Connector>>,
    /// The part of each fin.
    pub names: Vec<String>,
    /// What slits take of a fin at its first node, mm.
    pub slits: BTreeMap<[NodeId; 2], f64>,
}

impl Holding<'_> {
    /// Adds the plates to the parts they hold and says what is wrong with both;
    /// `unlettered` are texts that found no room on those.
    fn plates(
        &self,
        parts: &mut Vec<Part>,
        mut unlettered: Vec<(String, usize)>,
    ) -> Vec<Finding> {
        let mut facts = clearance::findings(self);
        let first = parts.len();
        for connector in self.connectors.iter().flatten() {
            let (part, missing) = plate(connector, self.making, &self.names);
            unlettered.push((part.id.clone(), missing));
            parts.push(part);
        }
        facts.extend(clearance::unlettered(&unlettered));
        let mut findings: Vec<Finding> = facts.into_iter().map(Finding::from).collect();
        let crossing = parts[first..].iter().filter_map(crossing_outline);
        findings.extend(crossing.map(Finding::from));
        // Where connectors have no room it was said already; parts that overlap say no more.
        if passes(&findings) {
            let collisions = collisions(self.structure, parts, self.making.fit);
            findings.extend(collisions.into_iter().map(Finding::from));
        }
        findings
    }
}

/// What holds the fins of each node, if it joins any.
fn connectors(
    structure: &Structure,
    is_hub: &dyn Fn(NodeId) -> bool,
    fit: &Fit,
) -> Vec<Option<Connector>> {
    let fins = structure.fins().iter().enumerate();
    let index: BTreeMap<FinId, usize> = fins.map(|(k, fin)| (*fin, k)).collect();
    let connector = |node: NodeId| {
        let around = Around::new(structure, &index, node, fit)?;
        Some(if is_hub(node) {
            Connector::Hub(Hub::new(around, fit))
        } else {
            Connector::Hinge(Hinge::new(around, fit))
        })
    };
    structure.mesh().nodes().map(connector).collect()
}

/// How far from the axis each hub holds its fins against turning, by node, mm: a plate with
/// play in a window turns as if a pin at the window's length held it.
pub fn levers(
    structure: &Structure,
    is_hub: &dyn Fn(NodeId) -> bool,
    fit: &Fit,
) -> BTreeMap<NodeId, f64> {
    let connectors = connectors(structure, is_hub, fit).into_iter().flatten();
    let lever = |connector| match connector {
        Connector::Hub(hub) => Some((hub.around.node, hub.slot)),
        Connector::Hinge(_) => None,
    };
    connectors.filter_map(lever).collect()
}

/// Names count from 1 and sort as text.
fn fin_name(fin: usize, count: usize) -> String {
    let digits = count.to_string().len().max(2);
    format!("F{:0digits$}", fin + 1)
}

/// The fins, and how many of its texts found no room on each.
fn fin_parts(
    structure: &Structure,
    making: &Making,
    connectors: &[Option<Connector>],
    names: &[String],
) -> (Vec<Part>, Vec<(String, usize)>) {
    let mut shapes = Shapes::default();
    let fins = structure.fins().iter().enumerate();
    let parts = fins.map(|(fin, id)| {
        let nodes = id.ends();
        let flat = unfold(structure, &nodes, false);
        let end = |k: usize| {
            let connector = connectors[nodes[k]].as_ref()?;
            Some((connector, connector.around().spoke(fin)?))
        };
        let seated = Seated { flat: &flat, ends: [end(0), end(1)], fit: making.fit };
        let outline = seated.outline();
        let id = names[fin].clone();
        let (marks, missing) = seated.marks(&id, making.marking.height);
        let setback = |k: usize| end(k).map_or(0.0, |(connector, _)| connector.setback());
        let body = FinBody {
            nodes,
            setbacks: [setback(0), setback(1)],
            shape: shapes.named(&flat, &outline),
            axes: flat.axes,
        };
        let region = Region { outline, holes: Vec::new() };
        let part = Part { id, quantity: 1, region, marks, body: Body::Fin(body) };
        let missing = (part.id.clone(), missing);
        (part, missing)
    });
    parts.unzip()
}

/// The plate of a connector, and how many of its texts found no room on it.
fn plate(connector: &Connector, making: &Making, fins: &[String]) -> (Part, usize) {
    let node = connector.around().node;
    let id = format!("N{node}");
    let height = making.marking.height;
    let (region, (marks, missing)) = match connector {
        Connector::Hub(hub) => (
            disc::region(hub, making.fit),
            disc::marks(hub, making.fit, &id, fins, height),
        ),
        Connector::Hinge(hinge) => {
            let mark = hinge.marks(&id, height);
            let missing = usize::from(mark.is_none());
            (hinge.region(making.fit), (mark.into_iter().collect(), missing))
        }
    };
    let copies = copies(connector);
    let named = connector.around().spokes.iter().map(|spoke| fins[spoke.fin].clone());
    let body = ConnectorBody {
        fins: named.collect(),
        connector: connector.clone(),
        rod: making.fit.rod_diameter,
        copies,
    };
    let quantity = body.copies.len();
    (Part { id, quantity, region, marks, body: Body::Connector(body) }, missing)
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
