//! The structure: nodes with axes, planar fins between them, strips of fins.
//!
//! A *torsion-free support structure* has a node axis in every vertex of a base mesh
//! and a planar fin on every edge that contains the axes of both its ends
//! ("Freeform Shading and Lighting Systems from Planar Quads"). [`Structure::new`] judges a
//! [`Draft`] whole and either makes a [`Structure`] or says everything that is wrong.
//! Reading and writing files' text is here too; touching files is not.

mod check;
mod crossing;
mod draft;
mod finding;
pub mod interop;
mod json;
mod meeting;
mod node;
mod obj;
mod read;
mod sound;
mod strips;
mod surface;
mod weld;

pub use check::planarity;
pub use crossing::FinTree;
pub use draft::{DesignRecord, Draft, area_vector};
pub use finding::{FaceFault, StructureFinding};
pub use json::{read_json, write_json};
pub use node::{Arm, Node};
pub use obj::{AxisRule, ObjOptions, read_obj, write_obj};
pub use read::{ReadError, ReadNote};
pub use sound::SoundDraft;
pub use strips::Strip;
pub use weld::blame_gaps;

use crate::diagnostic::{Finding, passes, short};
use crate::geometry::{Mesh, Point3, Vector3};
use crate::ids::{FinId, NodeId};
use crate::structure::sound::collect;
use crate::tolerance::Tolerance;
use thiserror::Error;

/// A torsion-free support structure, mm at model scale.
///
/// # Guarantees
/// All numbers are finite, all indices in range, axes have unit length, no fin is
/// listed twice, every fin lies on exactly one strip, and no strip visits a node twice
/// (but for the seam of a closed one).
#[derive(Debug, Clone, PartialEq)]
pub struct Structure {
    name: String,
    nodes: Vec<Node>,
    mesh: Mesh,
    fins: Vec<FinId>,
    strips: Vec<Strip>,
    fixed: Vec<NodeId>,
    families: Option<Vec<Option<u8>>>,
    design: Option<DesignRecord>,
}

/// A draft that is no structure.
#[derive(Debug, Clone, PartialEq, Error)]
#[error("the structure has faults that must be mended first")]
pub struct Refused {
    /// Everything found, worst or not.
    pub findings: Vec<Finding>,
}

impl Structure {
    /// Judges a draft.
    ///
    /// # Errors
    /// [`Refused`] with all findings if one of them leaves no structure to speak of.
    /// Faults of shape (fins out of plane, crossing, ...) do not: they are returned as
    /// findings beside the structure, so that it can still be looked at.
    pub fn new(
        draft: Draft,
        tolerance: &Tolerance,
    ) -> Result<(Self, Vec<Finding>), Refused> {
        Self::of(SoundDraft::new(draft)?, tolerance)
    }

    /// The structure of a draft that has been judged.
    ///
    /// # Errors
    /// As [`Structure::new`]: listed strips may not fit the fins.
    pub fn of(
        mut sound: SoundDraft,
        tolerance: &Tolerance,
    ) -> Result<(Self, Vec<Finding>), Refused> {
        let mut findings = std::mem::take(&mut sound.findings);
        let (structure, traced) = Self::build(sound, tolerance);
        findings.extend(collect(traced));
        if !passes(&findings) {
            return Err(Refused { findings });
        }
        findings.extend(collect(check::shape(&structure, tolerance)));
        findings.extend(collect(crossing::fins_that_cross(&structure)));
        blame_gaps(&mut findings);
        Ok((structure, findings))
    }

    fn build(sound: SoundDraft, tolerance: &Tolerance) -> (Self, Vec<StructureFinding>) {
        let SoundDraft { draft, mesh, .. } = sound;
        let fins = draft.fin_ids();
        let boundary = mesh.boundary_nodes();
        let nodes = node::join(&draft, &fins);
        let fixed = match draft.fixed {
            Some(fixed) => fixed.into_iter().map(NodeId::new).collect(),
            None => mesh.nodes().filter(|&node| boundary[node]).collect(),
        };
        let (strips, findings) = match draft.strips {
            Some(chains) => strips::given(&chains, &fins),
            None => {
                let families = draft.families.iter().flatten().copied();
                let families = fins.iter().copied().zip(families).collect();
                (strips::traced(&nodes, &boundary, &families, tolerance), Vec::new())
            }
        };
        let (strips, split) = meeting::without_self_meetings(strips, &nodes);
        let findings = findings.into_iter().chain(split).collect();
        let Draft { name, families, design, .. } = draft;
        let built = Self { name, nodes, mesh, fins, strips, fixed, families, design };
        (built, findings)
    }

    /// Name of the job.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The nodes, as numbered in the input.
    pub fn nodes(&self) -> &[Node] {
        &self.nodes
    }

    /// The base mesh.
    pub fn mesh(&self) -> &Mesh {
        &self.mesh
    }

    /// The fins.
    pub fn fins(&self) -> &[FinId] {
        &self.fins
    }

    /// The strips; every fin is on one.
    pub fn strips(&self) -> &[Strip] {
        &self.strips
    }

    /// Nodes held by the ground.
    pub fn fixed(&self) -> &[NodeId] {
        &self.fixed
    }

    /// Family of the base mesh, 1 or 2, of each fin, where it can be told; `None` if nobody
    /// said so of any.
    pub fn families(&self) -> Option<&[Option<u8>]> {
        self.families.as_deref()
    }

    /// Where it comes from, if that was said.
    pub const fn design(&self) -> Option<&DesignRecord> {
        self.design.as_ref()
    }

    /// The corners of the fin from `i` to `j`: bottom of `i`, bottom of `j`, top of `j`,
    /// top of `i`.
    pub fn corners(&self, [i, j]: [NodeId; 2]) -> [Point3; 4] {
        let (a, b) = (&self.nodes[i], &self.nodes[j]);
        [a.bottom(), b.bottom(), b.top(), a.top()]
    }

    /// Length of a fin along the base mesh, mm.
    pub fn length(&self, fin: FinId) -> f64 {
        let [i, j] = fin.ends();
        (self.nodes[i].position - self.nodes[j].position).norm()
    }

    /// Width, depth and height of its nodes, for people: `504 x 308 x 52 mm`.
    pub fn size_text(&self) -> String {
        let extent = |k: usize| {
            let along = || {
                self.nodes.iter().filter(|n| !n.arms.is_empty()).map(|n| n.position[k])
            };
            let high = along().fold(f64::NEG_INFINITY, f64::max);
            (high - along().fold(f64::INFINITY, f64::min)).max(0.0)
        };
        let [x, y, z] = [0, 1, 2].map(|k| short((extent(k) * 10.0).round() / 10.0));
        format!("{x} x {y} x {z} mm")
    }

    /// The same structure with other strips.
    #[must_use]
    pub fn with_strips(self, strips: Vec<Strip>) -> Self {
        Self { strips, ..self }
    }

    /// Signed turn at `at` from the fin `from`-`at` to the fin `at`-`to`, radians:
    /// positive toward travel × axis (docs/structure.md).
    pub fn fold(&self, from: NodeId, at: NodeId, to: NodeId) -> f64 {
        strips::fold(&self.nodes, [from, at, to])
    }

    /// Direction of a fin at one of its ends, across the node axis, of unit length.
    pub fn direction(&self, at: NodeId, to: NodeId) -> Vector3 {
        node::across(&self.nodes[at], self.nodes[to].position)
    }
}
