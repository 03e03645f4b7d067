//! The steps of assembly with a picture each.

use crate::fabrication::Fabrication;
use crate::ids::PartId;
use crate::report::page::html;
use crate::report::picture::Picture;
use crate::report::steps::{Step, standing};
use std::fmt::Write;

/// Width of a picture, in its own units.
const WIDTH: f64 = 400.0;

/// The steps as figures; their pictures share one drawing of each part.
pub(super) fn steps(job: &Fabrication, steps: &[Step]) -> String {
    let Some(structure) = &job.structure else { return String::new() };
    if steps.is_empty() {
        return "<p>There are no parts to assemble.</p>\n".to_owned();
    }
    let picture = Picture::new(job, structure, WIDTH);
    let figures = steps.iter().enumerate().map(|(k, step)| {
        let shown = standing(job, steps, k);
        figure(job, &picture, step, (k, &shown))
    });
    drawings(job, &picture) + &figures.collect::<String>()
}

/// Each part once, as a path.
fn drawings(job: &Fabrication, picture: &Picture) -> String {
    let mut paths = vec![String::new(); job.parts.len()];
    for panel in &picture.panels {
        let at =
            panel.corners.map(|p| format!("{:.1} {:.1}", p.x, picture.size[1] - p.y));
        paths[panel.part] += &format!("M{}Z", at.join("L"));
    }
    let mut text = String::from("<svg class=\"defs\" aria-hidden=\"true\"><defs>\n");
    for (index, path) in paths.iter().enumerate() {
        // Writing to a string cannot fail.
        let _ = writeln!(text, "<path id=\"p{index}\" d=\"{path}\"/>");
    }
    text + "</defs></svg>\n"
}

fn figure(
    job: &Fabrication,
    picture: &Picture,
    step: &Step,
    (k, shown): (usize, &[PartId]),
) -> String {
    let [width, height] = picture.size;
    let ids = step.parts.iter().map(|&part| job.parts[part].id.as_str());
    let ids: Vec<&str> = ids.collect();
    let used = |part: &PartId| format!("<use href=\"#p{part}\"/>");
    let onto =
        step.onto.iter().map(|(node, part)| format!("{} at {node}", html::part(part)));
    let onto: Vec<String> = onto.collect();
    let onto = match onto.is_empty() {
        true => String::new(),
        false => format!("<br>Onto {}.", onto.join(", ")),
    };
    let tight = if step.is_tight { " class=\"tight\"" } else { "" };
    let pad = 4.0;
    format!(
        "<figure class=\"step\"><svg viewBox=\"{:.0} {:.0} {:.0} {:.0}\" role=\"img\" \
         aria-label=\"step {}: {} goes in\"><g class=\"done\">{}</g><g class=\"new\">{}</g></svg>\
         <figcaption><b>{}.</b> {} <span{tight}>{}</span>{onto}</figcaption></figure>\n",
        -pad,
        -pad,
        width + 2.0 * pad,
        height + 2.0 * pad,
        k + 1,
        html::text(&ids.join(", ")),
        shown.iter().map(used).collect::<String>(),
        step.parts.iter().map(used).collect::<String>(),
        k + 1,
        ids.iter().map(|id| html::part(id)).collect::<Vec<_>>().join(" "),
        html::text(&step.words),
    )
}
