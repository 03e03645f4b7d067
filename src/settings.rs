//! What a job is made with: the inner form of a template, made once and passed to all stages.

use crate::ids::NodeId;
use crate::joint::Joint;
use crate::nest::{Effort, Rotations, Stock};
use crate::parts::{Fit, MarkKind, Marking};
use crate::rigidity::Fingerprint;
use crate::sheets::{Frame, Kerf};
use crate::structure::Structure;
use crate::template::{FoldMarks, Template};
use crate::tolerance::Tolerance;

/// What a job is made with.
#[derive(Debug, Clone, PartialEq)]
pub struct Settings {
    /// The template as read.
    pub template: Template,
    /// How fins are joined.
    pub joint: Joint,
    /// Nodes that get hubs whatever meets there, ascending.
    pub hub_nodes: Vec<NodeId>,
    /// How hard to nest.
    pub effort: Effort,
    /// Why the structure may be flexible.
    pub accepted_flexible: Option<String>,
    /// What makes a draft a structure.
    pub tolerance: Tolerance,
    /// What material and joint ask of parts.
    pub fit: Fit,
    /// How parts are marked.
    pub marking: Marking,
    /// How far lines stand off.
    pub kerf: Kerf,
    /// Sheets to choose from.
    pub stock: Vec<Stock>,
    /// How parts may be turned: grain must run along them.
    pub rotations: Rotations,
}

impl Settings {
    /// A template with lap joints, hubs where it asks for them and the normal effort.
    pub fn new(template: Template) -> Self {
        Self {
            joint: Joint::Lap,
            hub_nodes: ascending(template.joint.hub_nodes.clone()),
            effort: Effort { trials: 8, seed: 0 },
            accepted_flexible: None,
            tolerance: tolerance(&template),
            fit: fit(&template),
            marking: marking(&template),
            kerf: Kerf::from_width_mm(template.material.kerf_mm),
            stock: stock(&template),
            rotations: rotations(&template),
            template,
        }
    }

    /// With hubs on more nodes.
    #[must_use]
    pub fn with_hubs(mut self, nodes: impl IntoIterator<Item: Into<NodeId>>) -> Self {
        self.hub_nodes.extend(nodes.into_iter().map(Into::into));
        Self { hub_nodes: ascending(self.hub_nodes), ..self }
    }

    /// Of a structure made with these settings.
    pub fn fingerprint(&self, structure: &Structure) -> Fingerprint {
        let mut asked = self.hub_nodes.clone();
        asked.retain(|node| !self.template.joint.hub_nodes.contains(node));
        Fingerprint::of(structure, self.joint, &self.template.source, &asked)
    }

    /// What is written around each sheet of a job of this name, if anything is.
    pub fn frame(&self, job: String) -> Option<Frame> {
        let material = &self.template.material;
        let note = if material.kerf_mm > 0.0 {
            format!("kerf {} mm is in the lines: cut on the line", material.kerf_mm)
        } else {
            "no kerf in the lines".to_owned()
        };
        let accepted = self.accepted_flexible.iter();
        let accepted = accepted.map(|reason| format!("flexible, accepted: {reason}"));
        let notes = std::iter::once(note).chain(accepted).collect();
        let frame = Frame { job, material: material.name.clone(), notes };
        self.template.output.frame.then_some(frame)
    }
}

fn ascending(mut nodes: Vec<NodeId>) -> Vec<NodeId> {
    nodes.sort_unstable();
    nodes.dedup();
    nodes
}

fn rotations(template: &Template) -> Rotations {
    if template.material.grain {
        Rotations::Only(vec![0.0, std::f64::consts::PI])
    } else {
        Rotations::Free
    }
}

fn tolerance(template: &Template) -> Tolerance {
    Tolerance {
        planarity_warn: template.gate.planarity_warn_percent / 100.0,
        planarity_limit: template.gate.planarity_limit_percent / 100.0,
        ..Tolerance::default()
    }
}

fn stock(template: &Template) -> Vec<Stock> {
    let sheets = template.sheet.iter().map(|sheet| {
        let size = [sheet.width_mm, sheet.height_mm];
        Stock {
            count: sheet.count,
            ..Stock::new(size, sheet.margin_mm, sheet.spacing_mm)
        }
    });
    sheets.collect()
}

fn fit(template: &Template) -> Fit {
    let (material, joint, gate) = (&template.material, &template.joint, &template.gate);
    Fit {
        thickness: material.thickness_mm,
        clearance: material.clearance_mm,
        web: material.web_mm,
        web_least: material.web_least_mm,
        relief: material.relief_radius_mm,
        overhang: joint.overhang_mm,
        lap_split: joint.lap_split,
        depth_allowance: joint.depth_allowance_mm,
        chamfer: joint.mouth_chamfer_mm,
        chamfer_angle: joint.mouth_chamfer_deg.to_radians(),
        setback: joint.setback_mm,
        connector_thickness: joint.connector_thickness_mm,
        rod_diameter: joint.rod_diameter_mm,
        disc_slot: joint.disc_slot_mm.unwrap_or(3.0 * material.thickness_mm),
        fin_angle_least: gate.fin_angle_least_deg.to_radians(),
        crossing_warn: gate.crossing_warn_deg.to_radians(),
        crossing_least: gate.crossing_least_deg.to_radians(),
        bend_model: template.bend.model,
        bend_crack: template.bend.crack,
    }
}

fn marking(template: &Template) -> Marking {
    Marking {
        height: template.output.lettering_mm,
        folds: match template.bend.fold_marks {
            FoldMarks::None => None,
            FoldMarks::Engrave => Some(MarkKind::Engrave),
            FoldMarks::Score => Some(MarkKind::Score),
        },
    }
}
