//! From a mesh and options to the energy that is minimised.

use crate::design::planarise::energy::Energy;
use crate::design::planarise::given::{Fin, Given, State};
use crate::design::planarise::matrix::node_order;
use crate::design::planarise::options::Options;
use crate::design::planarise::surface::{Surface, rim_beside, unit};
use crate::design::planarise::terms::{Planarity, wishes};
use crate::geometry::{Mesh, Point3, Vector3, trig};
use crate::ids::{FinId, NodeId};
use crate::structure::Draft;
use crate::tolerance::CORNER_TURN;

/// The energy with how it is numbered and scaled.
pub(super) struct Task {
    pub energy: Energy,
    /// Median fin length: the unit of length inside.
    pub unit: f64,
    /// The node of the mesh that comes as the `k`-th.
    order: Vec<usize>,
}

impl Task {
    /// What was found, numbered and scaled as the mesh is.
    pub(super) fn placed(&self, given: &State, found: &State) -> State {
        let mut placed = given.clone();
        for (k, &node) in self.order.iter().enumerate() {
            let moved = found.positions[k] - self.energy.given.start.positions[k];
            placed.positions[node] += moved * self.unit;
            if self.energy.given.free[k][1] {
                placed.axes[node] = unit(found.axes[k]);
            }
        }
        placed
    }

    /// Numbered and scaled as inside.
    pub(super) fn inside(&self, given: &State, state: &State) -> State {
        let mut inside = self.energy.given.start.clone();
        for (k, &node) in self.order.iter().enumerate() {
            let moved = state.positions[node] - given.positions[node];
            inside.positions[k] += moved / self.unit;
            inside.axes[k] = state.axes[node];
        }
        inside
    }
}

/// The fins to be planarised: those listed, or the edges of the faces.
pub(super) fn fins(draft: &Draft, mesh: &Mesh, boundary_fins: bool) -> Vec<FinId> {
    match draft.fins {
        Some(_) => draft.fin_ids(),
        None => {
            let wanted = |&edge: &_| boundary_fins || !mesh.is_boundary_edge(edge);
            mesh.edges().filter(wanted).map(|edge| mesh.ends(edge).into()).collect()
        }
    }
}

/// Axes smoothed over their neighbours: each round brings every axis half way to the mean
/// of those around it.
pub fn smoothed_axes(draft: &Draft, rounds: usize) -> Vec<Vector3> {
    let mut around = vec![Vec::new(); draft.positions.len()];
    for fin in (Draft { fins: None, ..draft.clone() }).fin_ids() {
        let [i, j] = fin.ends();
        // The larger one; corners out of range are left for the check of the draft.
        if j.index() < around.len() {
            around[i].push(j);
            around[j].push(i);
        }
    }
    let mut axes: Vec<Vector3> = draft.axes.iter().map(|&axis| unit(axis)).collect();
    for _ in 0..rounds {
        let smoothed = axes.iter().zip(&around).map(|(axis, around)| {
            let sum: Vector3 = around.iter().map(|&k| axes[k]).sum();
            if around.is_empty() { *axis } else { unit(axis + unit(sum)) }
        });
        axes = smoothed.collect();
    }
    axes
}

/// Sets the energy up.
pub(super) fn task(
    draft: &Draft,
    mesh: &Mesh,
    options: &Options,
    fins: &[FinId],
) -> Task {
    let nodes = draft.positions.len();
    let unit_length = median_length(draft, fins);
    let middle: Vector3 = draft.positions.iter().map(|p| p.coords / nodes as f64).sum();
    let inside = |p: &Point3| Point3::from((p.coords - middle) / unit_length);
    let positions: Vec<Point3> = draft.positions.iter().map(inside).collect();
    let axes: Vec<Vector3> = draft.axes.iter().map(|axis| axis.normalize()).collect();
    let corners = corners(mesh, &positions);
    let reach =
        |node: usize| [draft.below[node] / unit_length, draft.above[node] / unit_length];
    let fins = fins.iter().map(|fin| fin.ends().map(NodeId::index));
    let fins: Vec<Fin> = fins.map(|ends| Fin { ends, reach: ends.map(reach) }).collect();
    let edges: Vec<[usize; 2]> =
        mesh.edges().map(|edge| mesh.ends(edge).map(NodeId::index)).collect();
    let mut free: Vec<[bool; 2]> = corners.iter().map(|corner| [!corner, true]).collect();
    options.fixed_nodes.iter().filter(|&&k| k < nodes).for_each(|&k| free[k][0] = false);
    options.fixed_axes.iter().filter(|&&k| k < nodes).for_each(|&k| free[k][1] = false);
    let given = Given {
        surface: Surface::new(mesh, &positions, &corners),
        reach: far(&positions, &fins, &edges, options),
        start: State { positions, axes },
        fins,
        edges,
        free,
        place: (0..nodes).collect(),
    };
    let order = node_order(nodes, &given.coupled());
    let given = given.renumbered(&order);
    let energy = Energy {
        planarity: Planarity::new(&options.weights),
        wishes: wishes(&given, options),
        given,
    };
    Task { energy, unit: unit_length, order }
}

fn median_length(draft: &Draft, fins: &[FinId]) -> f64 {
    let length = |fin: &FinId| {
        let [a, b] = fin.ends().map(|node| draft.positions[node]);
        (a - b).norm()
    };
    let mut lengths: Vec<f64> = fins.iter().map(length).collect();
    lengths.sort_by(f64::total_cmp);
    lengths[lengths.len() / 2]
}

/// How far each node may move: a share of its shortest edge.
fn far(
    positions: &[Point3],
    fins: &[Fin],
    edges: &[[usize; 2]],
    options: &Options,
) -> Vec<f64> {
    let mut shortest = vec![1.0_f64; positions.len()];
    for &[i, j] in fins.iter().map(|fin| &fin.ends).chain(edges) {
        let length = (positions[i] - positions[j]).norm();
        shortest[i] = shortest[i].min(length);
        shortest[j] = shortest[j].min(length);
    }
    shortest.into_iter().map(|length| length * options.move_limit).collect()
}

/// Boundary nodes where the boundary turns: they stay.
fn corners(mesh: &Mesh, positions: &[Point3]) -> Vec<bool> {
    let turns = |node: NodeId| {
        let Some([a, b]) = rim_beside(mesh, node) else { return false };
        let (to, from) = (positions[a] - positions[node], positions[node] - positions[b]);
        trig::atan2(to.cross(&from).norm(), to.dot(&from)) > CORNER_TURN
    };
    mesh.nodes().map(turns).collect()
}
