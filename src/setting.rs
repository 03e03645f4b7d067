//! What a template means to the stages.

use crate::nest::{Stock, Turns};
use crate::parts::{Fit, FoldMarks, Marking};
use crate::sheets::Frame;
use crate::template::Template;
use crate::tolerance::Tolerance;

/// Grain must run along the parts.
pub(crate) fn turns(template: &Template) -> Turns {
    if template.material.grain {
        Turns::Only(vec![0.0, std::f64::consts::PI])
    } else {
        Turns::Free
    }
}

pub(crate) fn tolerance(template: &Template) -> Tolerance {
    Tolerance {
        planarity_warn: template.gate.planarity_warn_percent / 100.0,
        planarity_limit: template.gate.planarity_limit_percent / 100.0,
        ..Tolerance::default()
    }
}

pub(crate) fn stock(template: &Template) -> Vec<Stock> {
    let sheets = template.sheet.iter().map(|sheet| {
        let size = [sheet.width_mm, sheet.height_mm];
        Stock {
            count: sheet.count,
            ..Stock::new(size, sheet.margin_mm, sheet.spacing_mm)
        }
    });
    sheets.collect()
}

/// What material and joint of a template ask of parts.
pub fn fit(template: &Template) -> Fit {
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

pub(crate) fn marking(template: &Template) -> Marking {
    Marking {
        height: template.output.lettering_mm,
        folds: match template.bend.fold_marks {
            crate::template::FoldMarks::None => FoldMarks::None,
            crate::template::FoldMarks::Engrave => FoldMarks::Engrave,
            crate::template::FoldMarks::Score => FoldMarks::Score,
        },
    }
}

pub(crate) fn frame(template: &Template, job: String, accepted: Option<&str>) -> Frame {
    let kerf = template.material.kerf_mm;
    let note = if kerf > 0.0 {
        format!("kerf {kerf} mm is in the lines: cut on the line")
    } else {
        "no kerf in the lines".to_owned()
    };
    let accepted = accepted.map(|reason| format!("flexible, accepted: {reason}"));
    let notes = std::iter::once(note).chain(accepted).collect();
    Frame { job, material: template.material.name.clone(), notes }
}
