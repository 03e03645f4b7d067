//! What is given to the energy, and where nodes and axes are: what its
//! [terms](crate::design::planarise::terms) look at.

use crate::design::planarise::matrix::SIZE;
use crate::design::planarise::surface::{Foot, Surface};
use crate::geometry::{Point3, Vector3};

/// Derivative of a row by a node's position and axis.
pub(super) type Slope = [f64; SIZE];

/// Positions and axes.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct State {
    pub positions: Vec<Point3>,
    pub axes: Vec<Vector3>,
}

/// A fin with how far it reaches at its ends.
#[derive(Debug, Clone, Copy)]
pub(super) struct Fin {
    pub ends: [usize; 2],
    /// Below and above, at both ends.
    pub reach: [[f64; 2]; 2],
}

/// Where a node comes down.
#[derive(Debug, Clone, Copy)]
pub(super) struct Feet {
    /// On the given surface.
    pub surface: Option<Foot>,
    /// On the boundary, and the direction inside the surface away from it.
    pub boundary: Option<(Point3, Vector3)>,
}

/// What is given, with nodes in the order of elimination.
pub(super) struct Given {
    pub start: State,
    pub fins: Vec<Fin>,
    /// Edges of the mesh.
    pub edges: Vec<[usize; 2]>,
    pub surface: Surface,
    /// How far each node may move.
    pub reach: Vec<f64>,
    /// Whether each node's position and axis are free.
    pub free: Vec<[bool; 2]>,
    /// The place of each node of the mesh.
    pub place: Vec<usize>,
}

/// Where nodes and axes are now, for terms to look at.
pub(super) struct At<'a> {
    pub given: &'a Given,
    pub now: &'a State,
    pub feet: &'a [Feet],
}

impl Given {
    /// The same with node `order[k]` as the `k`-th.
    pub(super) fn renumbered(mut self, order: &[usize]) -> Self {
        order.iter().enumerate().for_each(|(k, &node)| self.place[node] = k);
        let fins = self.fins.iter_mut().map(|fin| &mut fin.ends);
        for node in fins.chain(&mut self.edges).flatten() {
            *node = self.place[*node];
        }
        Self {
            start: State {
                positions: order.iter().map(|&node| self.start.positions[node]).collect(),
                axes: order.iter().map(|&node| self.start.axes[node]).collect(),
            },
            surface: self.surface.renumbered(order),
            reach: order.iter().map(|&node| self.reach[node]).collect(),
            free: order.iter().map(|&node| self.free[node]).collect(),
            ..self
        }
    }

    /// Pairs of nodes that a row may couple.
    pub(super) fn coupled(&self) -> Vec<[usize; 2]> {
        self.fins.iter().map(|fin| fin.ends).chain(self.edges.iter().copied()).collect()
    }
}

/// A derivative by position and by axis.
pub(super) fn slope(position: Vector3, axis: Vector3) -> Slope {
    [position.x, position.y, position.z, axis.x, axis.y, axis.z]
}
