//! What has to be said about a result.

use crate::design::planarise::figures::{Figures, Spread};
use crate::design::planarise::finding::{DesignFinding, Reason};
use crate::design::planarise::given::State;
use crate::design::planarise::options::Options;
use crate::design::planarise::setup::Task;
use crate::design::planarise::surface::Surface;
use crate::geometry::{Mesh, Point3, Vector3, trig};
use crate::ids::{FaceId, FinId, NodeId};
use crate::structure::area_vector;

/// A result beside what was given.
pub(super) struct Judged<'a> {
    pub mesh: &'a Mesh,
    pub given: &'a State,
    pub result: &'a State,
    pub task: &'a Task,
}

impl Judged<'_> {
    fn planarities(&self) -> Vec<f64> {
        let inside = self.task.inside(self.given, self.result);
        self.task.energy.planarities(&inside).collect()
    }

    /// What was reached, and at what price.
    pub(super) fn figures(&self, before: Spread) -> Figures {
        let (given, result) = (self.given, self.result);
        let nodes = 0..given.positions.len();
        let moves =
            nodes.clone().map(|k| (result.positions[k] - given.positions[k]).norm());
        let turns = nodes.map(|k| angle(result.axes[k], given.axes[k]));
        let (moves, turns) = (median_and_most(moves), median_and_most(turns));
        let planarities = self.planarities();
        Figures {
            fins: planarities.len(),
            fin_length: self.task.unit,
            before,
            after: Spread::of(planarities.into_iter()),
            moves,
            median_turn: turns[0],
            largest_turn: turns[1],
            distance: self.distance(),
            largest_tilt: self.tilts().fold(0.0, f64::max),
            reversed_faces: self.reversed().count(),
        }
    }

    /// What could not be reached, and what has to be looked at.
    pub(super) fn findings(
        &self,
        fins: &[FinId],
        options: &Options,
    ) -> Vec<DesignFinding> {
        let mut findings = Vec::new();
        findings.extend(self.not_reached(fins, options));
        findings.extend(self.reversed().map(|face| DesignFinding::FaceReversed { face }));
        let limit_deg = options.tilt_limit.to_degrees();
        let tilts = self.tilts().map(f64::to_degrees).enumerate();
        // The limit is a soft wall: one degree beyond it is as good as reached.
        let tilted = tilts.filter(|&(_, tilt_deg)| tilt_deg > limit_deg + 1.0);
        findings.extend(tilted.map(|(node, tilt_deg)| {
            let node = NodeId::new(node);
            DesignFinding::AxisNearTangent { node, tilt_deg, limit_deg }
        }));
        findings
    }

    fn not_reached(&self, fins: &[FinId], options: &Options) -> Option<DesignFinding> {
        let planarities = self.planarities();
        let count = planarities.iter().filter(|&&share| share > options.target).count();
        let worst = planarities.iter().enumerate().max_by(|a, b| a.1.total_cmp(b.1));
        let (place, &share) = worst.filter(|_| count > 0)?;
        let fin = fins[place];
        let [i, j] = fin.ends();
        let diameter_mm =
            self.task.energy.given.fins[place].reach.iter().flatten().sum::<f64>() / 2.0
                * self.task.unit;
        let length = (self.result.positions[i] - self.result.positions[j]).norm();
        Some(DesignFinding::NotReached {
            fin,
            count,
            percent: share * 100.0,
            off_mm: share * (diameter_mm * diameter_mm + length * length).sqrt(),
            target_percent: options.target * 100.0,
            reason: self.reason(fin, options),
        })
    }

    fn reason(&self, fin: FinId, options: &Options) -> Reason {
        let inside = &self.task.energy.given;
        let place = &inside.place;
        let on_rim = || {
            let [i, j] = fin.ends();
            let side = self.mesh.half_edge(i, j).or(self.mesh.half_edge(j, i));
            side.is_some_and(|side| self.mesh.is_boundary_edge(self.mesh.edge(side)))
        };
        let held = |&node: &NodeId| inside.free[place[node]] != [true; 2];
        let tilts: Vec<f64> = self.tilts().collect();
        let tilted = |&node: &NodeId| tilts[node] >= options.tilt_limit;
        let far = |&node: &NodeId| {
            let moved = (self.result.positions[node] - self.given.positions[node]).norm();
            moved >= inside.reach[place[node]] * self.task.unit
        };
        let corners = |face: &FaceId| self.mesh.corners(*face);
        let beside = |face: &FaceId| fin.ends().iter().all(|k| corners(face).contains(k));
        let find =
            |claim: &dyn Fn(&NodeId) -> bool| fin.ends().into_iter().find(|k| claim(k));
        if let Some(face) = self.reversed().find(beside) {
            Reason::Reversed(face)
        } else if let Some(node) = find(&tilted) {
            Reason::Tangent(node)
        } else if let Some(node) = find(&held) {
            Reason::Held(node)
        } else if on_rim() {
            Reason::Boundary
        } else {
            find(&far).map_or(Reason::Crowded, Reason::Limit)
        }
    }

    /// Faces that look the other way, or have a corner that does.
    fn reversed(&self) -> impl Iterator<Item = FaceId> + '_ {
        let folded = |face: &[NodeId], positions: &[Point3], normal: Vector3| {
            let corner = |k: usize| {
                let at = positions[face[k]];
                let before = positions[face[(k + face.len() - 1) % face.len()]];
                let after = positions[face[(k + 1) % face.len()]];
                (after - at).cross(&(before - at)).dot(&normal) < 0.0
            };
            (0..face.len()).filter(|&k| corner(k)).count()
        };
        self.mesh.faces().filter(move |&face| {
            let corners = self.mesh.corners(face);
            let normal = area_vector(&self.given.positions, corners);
            let turned = area_vector(&self.result.positions, corners).dot(&normal) <= 0.0;
            let before = folded(corners, &self.given.positions, normal);
            let after = folded(corners, &self.result.positions, normal);
            turned || after > before
        })
    }

    /// Angle between each axis and the normal of the new surface, on the axis' side.
    fn tilts(&self) -> impl Iterator<Item = f64> + '_ {
        let positions = &self.result.positions;
        self.mesh.nodes().map(|node| {
            let faces = self.mesh.faces_at(node);
            let is_loose = faces.len() == 0;
            let areas = faces.map(|face| area_vector(positions, self.mesh.corners(face)));
            let normal: Vector3 = areas.sum();
            let axis = self.result.axes[node];
            if is_loose { 0.0 } else { angle(axis, normal * normal.dot(&axis)) }
        })
    }

    /// The largest distance between the two surfaces, sampled both ways.
    fn distance(&self) -> f64 {
        let corners = vec![false; self.given.positions.len()];
        let one_way = |from: &State, to: &State| {
            let surface = Surface::new(self.mesh, &to.positions, &corners);
            let off = |(node, point): (usize, Point3)| {
                surface.foot(node, point).map_or(0.0, |foot| (foot.point - point).norm())
            };
            self.samples(from).map(off).fold(0.0, f64::max)
        };
        one_way(self.result, self.given).max(one_way(self.given, self.result))
    }

    /// Nodes and middles of edges and faces, each with a node that is near.
    fn samples<'s>(
        &'s self,
        state: &'s State,
    ) -> impl Iterator<Item = (usize, Point3)> + 's {
        let middle = |nodes: &[NodeId]| {
            let sum: Vector3 = nodes.iter().map(|&k| state.positions[k].coords).sum();
            (nodes[0].index(), Point3::from(sum / nodes.len() as f64))
        };
        let nodes = state.positions.iter().copied().enumerate();
        let edges = self.mesh.edges().map(move |edge| middle(&self.mesh.ends(edge)));
        let faces = self.mesh.faces().map(move |face| middle(self.mesh.corners(face)));
        nodes.chain(edges).chain(faces)
    }
}

/// Angle between two vectors, radians.
fn angle(a: Vector3, b: Vector3) -> f64 {
    trig::atan2(a.cross(&b).norm(), a.dot(&b))
}

fn median_and_most(values: impl Iterator<Item = f64>) -> [f64; 2] {
    let mut values: Vec<f64> = values.collect();
    values.sort_by(f64::total_cmp);
    let most = values.last().copied().unwrap_or(0.0);
    [values.get(values.len() / 2).copied().unwrap_or(0.0), most]
}
