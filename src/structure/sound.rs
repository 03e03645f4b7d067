//! A draft that makes sense, judged once.

use crate::diagnostic::{Finding, passes};
use crate::geometry::Mesh;
use crate::structure::draft::Draft;
use crate::structure::{Refused, StructureFinding, check};

/// A draft whose numbers, indices and faces make sense, with how its faces hang together
/// and what was found on the way. Its fins may still be out of plane or cross.
#[derive(Debug, Clone, PartialEq)]
pub struct SoundDraft {
    pub(super) draft: Draft,
    pub(super) mesh: Mesh,
    pub(super) findings: Vec<Finding>,
}

impl SoundDraft {
    /// Judges a draft.
    ///
    /// # Errors
    /// [`Refused`] with all findings if one of them leaves no structure to speak of.
    pub fn new(draft: Draft) -> Result<Self, Refused> {
        let mut findings = collect(check::numbers(&draft));
        let mesh = Mesh::new(draft.positions.len(), &draft.faces);
        // Corners out of range are among the findings.
        let Ok(mesh) = mesh else { return Err(Refused { findings }) };
        if passes(&findings) {
            findings.extend(collect(check::mesh(&draft, &mesh)));
        }
        if passes(&findings) {
            Ok(Self { draft, mesh, findings })
        } else {
            Err(Refused { findings })
        }
    }

    /// The draft.
    pub const fn draft(&self) -> &Draft {
        &self.draft
    }

    /// How its faces hang together.
    pub const fn mesh(&self) -> &Mesh {
        &self.mesh
    }
}

impl From<SoundDraft> for Draft {
    fn from(sound: SoundDraft) -> Self {
        sound.draft
    }
}

pub(super) fn collect(facts: Vec<StructureFinding>) -> Vec<Finding> {
    facts.into_iter().map(Finding::from).collect()
}
