//! `parts.csv`: the bill of parts.

use crate::geometry::Contour;
use crate::job::Job;
use crate::parts::Body;
use std::collections::BTreeMap;
use std::fmt::Write;

/// One line per part: what it is, how large, on which sheet, which nodes.
pub fn bill(job: &Job, material: &str) -> String {
    let sheets: BTreeMap<usize, &str> = job
        .sheets
        .iter()
        .zip(&job.layout.sheets)
        .flat_map(|(sheet, nested)| {
            nested.placements.iter().map(|p| (p.shape, sheet.id.as_str()))
        })
        .collect();
    let mut text = String::from(
        "part,kind,quantity,material,length_mm,height_mm,area_mm2,cut_length_mm,sheet,nodes\n",
    );
    for (index, part) in job.parts.iter().enumerate() {
        let sheet = sheets.get(&index).copied().unwrap_or_default();
        let [length, height] = part.extent();
        let cut: f64 = part.region.contours().map(Contour::length).sum();
        let (kind, axes) = match &part.body {
            Body::Strip(body) => ("strip", body.axes.as_slice()),
            Body::Coupon => ("coupon", [].as_slice()),
        };
        let nodes: Vec<String> = axes.iter().map(|a| a.node.to_string()).collect();
        // Writing to a string cannot fail.
        let _ = writeln!(
            text,
            "{},{kind},{},{},{length:.1},{height:.1},{:.1},{cut:.1},{sheet},{}",
            part.id,
            part.quantity,
            quoted(material),
            part.region.area(),
            nodes.join(" ")
        );
    }
    text
}

/// A CSV field.
fn quoted(text: &str) -> String {
    if text.contains([',', '"', '\n']) {
        format!("\"{}\"", text.replace('"', "\"\""))
    } else {
        text.to_owned()
    }
}
