//! `parts.csv`: the bill of parts.

use crate::fabrication::Fabrication;
use crate::geometry::Contour;
use crate::ids::NodeId;
use crate::report::connectors::hardware;
use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write;

/// One line per part: what it is, how large, on which sheet, which nodes; then what is
/// bought besides.
pub fn bill(job: &Fabrication, material: &str) -> String {
    let mut sheets: BTreeMap<usize, BTreeSet<&str>> = BTreeMap::new();
    for (sheet, nested) in job.sheets.iter().zip(&job.layout.sheets) {
        for placement in &nested.placements {
            sheets.entry(placement.shape).or_default().insert(&sheet.id);
        }
    }
    let mut text = String::from(
        "part,kind,quantity,material,length_mm,height_mm,area_mm2,cut_length_mm,sheet,nodes\n",
    );
    for (index, part) in job.parts.iter().enumerate() {
        let sheet = sheets.get(&index).into_iter().flatten().copied();
        let sheet = sheet.collect::<Vec<_>>().join(" ");
        let [length, height] = part.extent();
        let cut: f64 = part.region.contours().map(Contour::length).sum();
        let kind = part.body.kind();
        let nodes = joined(&part.body.nodes());
        // Writing to a string cannot fail.
        let _ = writeln!(
            text,
            "{},{kind},{},{},{length:.1},{height:.1},{:.1},{cut:.1},{sheet},{}",
            part.id,
            part.quantity,
            quoted(material),
            part.region.area(),
            nodes
        );
    }
    for item in hardware(&job.parts) {
        let length = item.length.map(|mm| format!("{mm}.0")).unwrap_or_default();
        let (name, nodes) = (item.name(), joined(&item.nodes));
        let (kind, quantity) = (item.kind, item.quantity);
        let _ = writeln!(text, "{name},{kind},{quantity},steel,{length},,,,,{nodes}");
    }
    text
}

fn joined(nodes: &[NodeId]) -> String {
    nodes.iter().map(NodeId::to_string).collect::<Vec<_>>().join(" ")
}

/// A CSV field.
fn quoted(text: &str) -> String {
    if text.contains([',', '"', '\n']) {
        format!("\"{}\"", text.replace('"', "\"\""))
    } else {
        text.to_owned()
    }
}
