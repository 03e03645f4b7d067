//! Planar fins from any quad-dominant mesh: the global optimisation of Figure 2c in
//! "Freeform Shading and Lighting Systems from Planar Quads".
//!
//! [`planarise`] takes a mesh with axes in its nodes and moves nodes and axes, as little as
//! it can, until every fin is plane. It does not judge whether the result can be made
//! ([`Structure::new`](crate::structure::Structure::new) does), and it changes neither
//! faces nor numbering. Planar fins cost two equations per node of five freedoms, so that
//! they exist near any mesh; how near is what the energy asks (docs/planarise.md).

mod descent;
mod energy;
mod figures;
mod finding;
mod given;
mod judge;
mod matrix;
mod needed;
mod options;
pub(in crate::design) mod picture;
mod setup;
mod surface;
mod terms;

pub use descent::Iteration;
pub use figures::{Figures, Spread};
pub use finding::{DesignFinding, Reason};
pub use needed::planarised_if_needed;
pub use options::{Options, Weights, Wish};
pub use picture::{PictureError, picture};
pub use setup::smoothed_axes;
pub(in crate::design) use surface::shares;
pub use terms::WISHES;

use crate::design::planarise::descent::{Broken, descend};
use crate::design::planarise::given::State;
use crate::diagnostic::Finding;
use crate::geometry::Mesh;
use crate::ids::NodeId;
use crate::structure::{Draft, Refused, SoundDraft};
use crate::watch::{Stopped, Watch};

/// A mesh whose fins are as plane as they could be made.
#[derive(Debug, Clone, PartialEq)]
pub struct Planarised {
    /// The mesh with its fins listed; depth and numbering are as given.
    pub draft: Draft,
    /// What was reached, and at what price.
    pub figures: Figures,
    /// Every system that was solved.
    pub history: Vec<Iteration>,
    /// What could not be reached, and what has to be looked at.
    pub findings: Vec<Finding>,
}

/// Why there is no result.
#[derive(Debug, Clone, PartialEq)]
pub enum PlanariseError {
    /// The watch stopped the work.
    Stopped(Stopped),
    /// The mesh has faults that must be mended first.
    Refused(Vec<Finding>),
}

impl From<Refused> for PlanariseError {
    fn from(refused: Refused) -> Self {
        Self::Refused(refused.findings)
    }
}

impl From<DesignFinding> for PlanariseError {
    fn from(fact: DesignFinding) -> Self {
        Self::Refused(vec![fact.into()])
    }
}

/// Makes the fins of a mesh plane.
///
/// A mesh whose fins are plane to [`Options::target`] comes back as it is. The result does
/// not depend on where the mesh lies, how large it is or how it is numbered, but for
/// rounding.
///
/// # Errors
/// [`PlanariseError::Refused`] with all findings if the mesh is no oriented surface (flipped faces,
/// one-sided, fans that meet in a point) or has faults of its own;
/// [`PlanariseError::Stopped`] if the watch stopped the work.
/// ```
/// use finwright::design::{examples, planarise::{Options, planarise}};
///
/// let draft = (examples::named("sphere-patch").unwrap().draft)();
/// let planar = planarise(draft, &Options::default(), &mut ()).unwrap();
/// assert!(planar.findings.is_empty());
/// ```
pub fn planarise(
    draft: Draft,
    options: &Options,
    watch: &mut dyn Watch,
) -> Result<Planarised, PlanariseError> {
    planarise_sound(SoundDraft::new(draft)?, options, watch)
}

/// Makes the fins of a mesh plane that has been judged.
fn planarise_sound(
    sound: SoundDraft,
    options: &Options,
    watch: &mut dyn Watch,
) -> Result<Planarised, PlanariseError> {
    let (draft, mesh) = (sound.draft(), sound.mesh());
    must_be_a_surface(mesh)?;
    let given = State {
        positions: draft.positions.clone(),
        axes: draft.axes.iter().map(|axis| axis.normalize()).collect(),
    };
    let fins = setup::fins(draft, mesh, options.boundary_fins);
    if fins.is_empty() {
        return Err(DesignFinding::NoInnerFin { edges: mesh.edge_count() }.into());
    }
    let mut task = setup::task(draft, mesh, options, &fins);
    let before = Spread::of(task.energy.planarities(&task.energy.given.start));
    let (mut result, mut history) = (given.clone(), Vec::new());
    if before.worst > options.target {
        let found = descend(&mut task.energy, options.target, options.steps, watch);
        let found = found.map_err(|broken| match broken {
            Broken::Stopped(stopped) => PlanariseError::Stopped(stopped),
            Broken::TooLarge => DesignFinding::TooLarge { fins: fins.len() }.into(),
        })?;
        result = task.placed(&given, &found.state);
        history = found.history;
    }
    let judged = judge::Judged { mesh, given: &given, result: &result, task: &task };
    let figures = judged.figures(before);
    let findings =
        judged.findings(&fins, options).into_iter().map(Finding::from).collect();
    let mut draft = Draft::from(sound);
    let axes =
        if history.is_empty() { std::mem::take(&mut draft.axes) } else { result.axes };
    let draft = Draft { positions: result.positions, axes, ..draft }.with_fins(&fins);
    Ok(Planarised { draft, figures, history, findings })
}

/// One side, and one fan around every node.
fn must_be_a_surface(mesh: &Mesh) -> Result<(), DesignFinding> {
    // One-sided meshes have been refused as `structure::not_orientable`.
    let turned = mesh.turned_faces().unwrap_or_else(|one_sided| one_sided.faces.into());
    if !turned.is_empty() {
        return Err(DesignFinding::FacesTurned { faces: turned });
    }
    let split: Vec<NodeId> = mesh.non_manifold_nodes().map(|(node, _)| node).collect();
    if split.is_empty() {
        Ok(())
    } else {
        Err(DesignFinding::SeveralFans { nodes: split })
    }
}
