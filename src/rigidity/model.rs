//! Bodies and the points they share: what a structure is, as a mechanism.
//!
//! A *pin* is a node axis, given by its two ends, with the bodies that meet on it. In hubs
//! each fin also shares a third point, off the axis, with its hub: a *slot*. Both are
//! [`Coupling`]s. Notes: `docs/rigidity.md`.

use crate::geometry::{Point3, Vector3};
use crate::ids::{FinId, NodeId, StripId};
use crate::structure::Structure;
use std::collections::{BTreeMap, BTreeSet};

/// A rigid body of a model.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum RigidBody {
    /// A strip, by its number.
    Strip(StripId),
    /// A fin, by its nodes.
    Fin(FinId),
    /// The hub of a node.
    Hub(NodeId),
    /// A body of a linkage, by its number.
    Link(usize),
}

impl std::fmt::Display for RigidBody {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Strip(strip) => write!(f, "strip {strip}"),
            Self::Fin(fin) => write!(f, "fin {fin}"),
            Self::Hub(node) => write!(f, "hub {node}"),
            Self::Link(body) => write!(f, "body {body}"),
        }
    }
}

/// Points that move together with every body on it, up to the play.
#[derive(Debug, Clone, PartialEq)]
pub struct Coupling {
    /// The node it is at.
    pub node: NodeId,
    /// Two points, the lower and the upper end of the axis, or the one point of a slot; mm.
    pub points: Vec<Point3>,
    /// The bodies on it, ascending.
    pub bodies: Vec<usize>,
    /// Whether the ground holds it.
    pub held: bool,
    /// Where the node lies between the two points, from 0 to 1.
    pub share: f64,
}

impl Coupling {
    /// Whether it is a node axis.
    pub fn is_pin(&self) -> bool {
        self.points.len() == 2
    }

    /// A point that some bodies of a pin share, off its axis by half its length.
    fn slot_of(&self, bodies: Vec<usize>) -> Self {
        let axis = self.points[1] - self.points[0];
        let away = across(axis) * (axis.norm() / 2.0);
        let points = vec![self.place() + away];
        Self { node: self.node, points, bodies, held: false, share: 0.0 }
    }

    /// The node's place on it, mm.
    pub fn place(&self) -> Point3 {
        let (first, last) = (self.points[0], self.points[self.points.len() - 1]);
        first + (last - first) * self.share
    }
}

/// Bodies and the couplings between them.
#[derive(Debug, Clone, PartialEq)]
pub struct Model {
    /// What each body is.
    pub bodies: Vec<RigidBody>,
    /// Pins first, in the order of their nodes, then slots.
    pub couplings: Vec<Coupling>,
    /// The couplings of each body, ascending.
    pub incidence: Vec<Vec<usize>>,
}

impl Model {
    /// Puts bodies and couplings together.
    pub fn new(bodies: Vec<RigidBody>, couplings: Vec<Coupling>) -> Self {
        let mut incidence = vec![Vec::new(); bodies.len()];
        for (k, coupling) in couplings.iter().enumerate() {
            for &body in &coupling.bodies {
                incidence[body].push(k);
            }
        }
        Self { bodies, couplings, incidence }
    }

    /// A structure of strips. `unheld` are ends, as strip and node, that nothing holds;
    /// they count as no incidence. On the nodes that `moment_arms` names all strips end in
    /// a hub.
    pub fn of_strips(
        structure: &Structure,
        unheld: &BTreeSet<(StripId, NodeId)>,
        moment_arms: &BTreeMap<NodeId, f64>,
    ) -> Self {
        let (bodies, on) = strips(structure, unheld);
        let fins = structure.strips().iter().enumerate().flat_map(|(index, strip)| {
            strip.steps().map(move |step| (FinId::from(step), index))
        });
        Self::in_hubs(structure, bodies, on, &fins.collect(), moment_arms)
    }

    /// A structure of single fins: in hubs on the nodes that `moment_arms` names, on rods
    /// elsewhere. A moment arm, mm, is how far from the axis the slot holds its fin; it is
    /// never taken for more than a third of the fin.
    pub fn of_fins(structure: &Structure, moment_arms: &BTreeMap<NodeId, f64>) -> Self {
        let fins = structure.fins().iter().enumerate().map(|(index, fin)| (*fin, index));
        let (bodies, on) = self::fins(structure);
        Self::in_hubs(structure, bodies, on, &fins.collect(), moment_arms)
    }

    /// Bodies of which each carries some fins, in hubs on the nodes that have moment arms.
    fn in_hubs(
        structure: &Structure,
        mut bodies: Vec<RigidBody>,
        mut on: On,
        carrier: &BTreeMap<FinId, usize>,
        moment_arms: &BTreeMap<NodeId, f64>,
    ) -> Self {
        let mut slots = Vec::new();
        for (&node, moment_arm) in moment_arms {
            let hub = bodies.len();
            bodies.push(RigidBody::Hub(node));
            on.entry(node).or_default().push(hub);
            slots.extend(hub_slots(structure, node, *moment_arm, carrier, hub));
        }
        Self::joined(structure, bodies, on, slots)
    }

    fn joined(
        structure: &Structure,
        bodies: Vec<RigidBody>,
        on: On,
        slots: Vec<Coupling>,
    ) -> Self {
        let fixed: BTreeSet<NodeId> = structure.fixed().iter().copied().collect();
        let mut couplings = Vec::new();
        for (node, bodies) in on {
            let held = fixed.contains(&node);
            // A node with one body only is no pin, unless the ground is the other one.
            if bodies.len() < 2 && !held {
                continue;
            }
            let at = &structure.nodes()[node];
            let (points, share) = (vec![at.bottom(), at.top()], at.below / at.height());
            couplings.push(Coupling { node, points, bodies, held, share });
        }
        couplings.extend(slots);
        Self::new(bodies, couplings)
    }

    /// The points of a body, in the order of its couplings.
    pub fn points(&self, body: usize) -> Vec<Point3> {
        self.points_of(body).collect()
    }

    /// The same, one by one.
    pub(super) fn points_of(&self, body: usize) -> impl Iterator<Item = Point3> + '_ {
        let couplings = self.incidence[body].iter();
        couplings.flat_map(|&k| self.couplings[k].points.iter().copied())
    }

    /// How many node axes there are.
    pub fn pins(&self) -> usize {
        self.couplings.iter().filter(|coupling| coupling.is_pin()).count()
    }

    /// Whether the ground holds anything.
    pub fn is_supported(&self) -> bool {
        self.couplings.iter().any(|coupling| coupling.held)
    }

    /// The pin of a node, if it is one.
    pub fn pin(&self, node: NodeId) -> Option<usize> {
        self.couplings
            .iter()
            .position(|coupling| coupling.is_pin() && coupling.node == node)
    }

    /// The same with two bodies of a pin made one as far as turning about its axis goes,
    /// by a slot that both share.
    #[must_use]
    pub fn welded(mut self, pin: usize, bodies: [usize; 2]) -> Self {
        let slot = self.couplings[pin].slot_of(bodies.to_vec());
        self.couplings.push(slot);
        Self::new(self.bodies, self.couplings)
    }

    /// The same with all bodies of every pin made one in that way.
    #[must_use]
    pub fn stiff(mut self) -> Self {
        let joints = self
            .couplings
            .iter()
            .filter(|coupling| coupling.is_pin() && coupling.bodies.len() > 1);
        let slots: Vec<Coupling> =
            joints.map(|pin| pin.slot_of(pin.bodies.clone())).collect();
        self.couplings.extend(slots);
        Self::new(self.bodies, self.couplings)
    }

    /// The same with a node held by the ground.
    #[must_use]
    pub fn with_held(mut self, node: NodeId) -> Self {
        for coupling in &mut self.couplings {
            coupling.held |= coupling.node == node && coupling.is_pin();
        }
        self
    }
}

/// A unit vector across `axis`.
fn across(axis: Vector3) -> Vector3 {
    let smallest = axis.iamin();
    let mut away = Vector3::zeros();
    away[smallest] = 1.0;
    axis.cross(&away).normalize()
}

type On = BTreeMap<NodeId, Vec<usize>>;

fn strips(
    structure: &Structure,
    unheld: &BTreeSet<(StripId, NodeId)>,
) -> (Vec<RigidBody>, On) {
    let mut on = On::new();
    for (index, strip) in structure.strips().iter().enumerate() {
        for &node in &strip.nodes {
            if !unheld.contains(&(StripId::new(index), node)) {
                on.entry(node).or_default().push(index);
            }
        }
    }
    let strips = (0..structure.strips().len()).map(StripId::new);
    (strips.map(RigidBody::Strip).collect(), on)
}

fn fins(structure: &Structure) -> (Vec<RigidBody>, On) {
    let mut on = On::new();
    for (index, fin) in structure.fins().iter().enumerate() {
        for node in fin.ends() {
            on.entry(node).or_default().push(index);
        }
    }
    (structure.fins().iter().copied().map(RigidBody::Fin).collect(), on)
}

/// A slot in a hub for each fin of its node.
fn hub_slots(
    structure: &Structure,
    node: NodeId,
    moment_arm: f64,
    carrier: &BTreeMap<FinId, usize>,
    hub: usize,
) -> Vec<Coupling> {
    let at = &structure.nodes()[node];
    let slot = |to: NodeId| {
        let body = *carrier.get(&FinId::between(node, to))?;
        let length = (structure.nodes()[to].position - at.position).norm();
        let out = moment_arm.min(length / 3.0);
        let points = vec![at.position + structure.direction(node, to) * out];
        Some(Coupling { node, points, bodies: vec![body, hub], held: false, share: 0.0 })
    };
    let mut ends: Vec<NodeId> = at.arms.iter().map(|arm| arm.to).collect();
    // In the order of the fins, whichever way the node looks at them.
    ends.sort_unstable_by_key(|&to| FinId::between(node, to));
    ends.into_iter().filter_map(slot).collect()
}
