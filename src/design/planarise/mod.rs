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
mod judge;
mod matrix;
mod mesh;
mod needed;
mod options;
mod picture;
mod setup;
mod surface;

pub use descent::Step;
pub use figures::{Figures, Spread};
pub use finding::{DesignFinding, Reason};
pub use needed::planarised_if_needed;
pub use options::{Options, Weights};
pub use picture::{PictureError, picture};
pub use setup::smoothed_axes;

use crate::design::planarise::descent::{Broken, descend};
use crate::design::planarise::energy::State;
use crate::design::planarise::mesh::{Fault, Mesh};
use crate::diagnostic::{Finding, passes};
use crate::structure::{Draft, draft_findings};
use crate::watch::Watch;

/// A mesh whose fins are as plane as they could be made.
#[derive(Debug, Clone, PartialEq)]
pub struct Planarised {
    /// The mesh with its fins listed; depth and numbering are as given.
    pub draft: Draft,
    /// What was reached, and at what price.
    pub figures: Figures,
    /// Every system that was solved.
    pub history: Vec<Step>,
    /// What could not be reached, and what has to be looked at.
    pub findings: Vec<Finding>,
}

/// Why there is no result.
#[derive(Debug, Clone, PartialEq)]
pub enum Stopped {
    /// The watch stopped the work.
    Interrupted,
    /// The mesh has faults that must be mended first.
    Refused(Vec<Finding>),
}

/// Makes the fins of a mesh plane.
///
/// A mesh whose fins are plane to [`Options::target`] comes back as it is. The result does
/// not depend on where the mesh lies, how large it is or how it is numbered, but for
/// rounding.
///
/// # Errors
/// [`Stopped::Refused`] with all findings if the mesh is no oriented surface (flipped faces,
/// one-sided, fans that meet in a point) or has faults of its own;
/// [`Stopped::Interrupted`] if the watch stopped the work.
pub fn planarise(
    draft: Draft,
    options: &Options,
    watch: &mut dyn Watch,
) -> Result<Planarised, Stopped> {
    let refused = |fact: DesignFinding| Stopped::Refused(vec![fact.into()]);
    let findings = draft_findings(&draft);
    if !passes(&findings) {
        return Err(Stopped::Refused(findings));
    }
    let mesh =
        Mesh::new(draft.positions.len(), &draft.faces).map_err(|fault| match fault {
            Fault::Turned(faces) => refused(DesignFinding::FacesTurned { faces }),
            // Those have been refused as `structure::not_orientable`.
            Fault::OneSided(faces) => {
                refused(DesignFinding::FacesTurned { faces: faces.to_vec() })
            }
            Fault::Fans(nodes) => refused(DesignFinding::SeveralFans { nodes }),
        })?;
    let given = State {
        positions: draft.positions.clone(),
        axes: draft.axes.iter().map(|axis| axis.normalize()).collect(),
    };
    let fins = setup::fins(&draft, &mesh, options.boundary_fins);
    if fins.is_empty() {
        return Err(refused(DesignFinding::NoInnerFin { edges: mesh.edges.len() }));
    }
    let mut task = setup::task(&draft, &mesh, options, &fins);
    let before = Spread::of(task.energy.planarities(&task.energy.start));
    let (mut result, mut history) = (given.clone(), Vec::new());
    if before.worst > options.target {
        let found = descend(&mut task.energy, options.target, options.steps, watch);
        let found = found.map_err(|broken| match broken {
            Broken::Interrupted => Stopped::Interrupted,
            Broken::TooLarge => refused(DesignFinding::TooLarge { fins: fins.len() }),
        })?;
        result = task.placed(&given, &found.state);
        history = found.history;
    }
    let judged =
        judge::Judged { mesh: &mesh, given: &given, result: &result, task: &task };
    let figures = judged.figures(before);
    let findings =
        judged.findings(&fins, options).into_iter().map(Finding::from).collect();
    let axes = if history.is_empty() { draft.axes } else { result.axes };
    let draft = Draft { positions: result.positions, axes, fins: Some(fins), ..draft };
    Ok(Planarised { draft, figures, history, findings })
}
