//! `report.html`: one page that opens offline in any browser and answers what is built,
//! whether it is rigid, whether it fits, what to order and how to assemble it.
//!
//! Everything but the view in space is plain HTML and SVG and needs no script; the script
//! draws that view, plays the softest motion, and links a part in space with its place on
//! the sheet. Nothing is loaded from anywhere.

mod assembly;
mod bending;
mod drawing;
mod html;
mod scene;
mod sections;

use crate::diagnostic::Finding;
use crate::fabrication::Fabrication;
use crate::manifest::Manifest;
use crate::picture::HEAT;
use crate::proof::Proof;
use crate::report::manifest::JobSource;
use crate::report::picture::FROM;
use crate::report::steps;

/// What a page is about.
#[derive(Clone, Copy)]
pub struct Page<'a> {
    /// The job.
    pub job: &'a Fabrication,
    /// Where it came from.
    pub source: &'a JobSource<'a>,
    /// Its manifest, as written.
    pub manifest: &'a Manifest,
    /// What its files prove; `None` if no cut file was written.
    pub proof: Option<&'a Proof>,
    /// Whether the files may go to the laser.
    pub is_approved: bool,
}

const STYLE: &str = include_str!("page.css");
const SCRIPT: &str = include_str!("view.js");

/// The page as HTML.
pub fn page(page: &Page) -> String {
    let job = page.job;
    let name = job.structure.as_ref().map_or("job", |structure| structure.name());
    let sections = sections(page);
    let links =
        sections.iter().map(|(id, title, _)| format!("<a href=\"#{id}\">{title}</a> "));
    let body = sections.iter().map(|(id, title, body)| {
        format!("<section id=\"{id}\"><h2>{title}</h2>\n{body}</section>\n")
    });
    format!(
        "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
         <title>{title}</title>\n<style>\n{STYLE}</style></head>\n<body>\n\
         <header><h1>{title}</h1>\n<p>{about}</p>\n{stamp}{summary}</header>\n\
         <nav aria-label=\"sections\">{links}</nav>\n<main>\n{body}</main>\n\
         <footer><p>{generator}, template {template}, seed {seed}</p></footer>\n\
         <script>\n{script}</script>\n</body></html>\n",
        title = html::text(name),
        about = html::text(&about(page)),
        stamp = stamp(page),
        summary = sections::summary(page),
        links = links.collect::<String>(),
        body = body.collect::<String>(),
        generator = concat!("finwright ", env!("CARGO_PKG_VERSION")),
        template = html::text(&page.source.template.name),
        seed = page.source.seed,
        script = script(),
    )
}

/// The script with the camera and the colours of the other pictures.
fn script() -> String {
    let stops = HEAT.stops();
    let stops =
        stops.iter().map(|stop| stop.map(|light| format!("{light:.2}")).join(", "));
    let heat = format!("[[{}]]", stops.collect::<Vec<_>>().join("], ["));
    let [around, up] = FROM.map(|angle| angle.to_string());
    let script = SCRIPT.replace("__HEAT__", &heat);
    script.replace("__AROUND__", &around).replace("__UP__", &up)
}

/// Anchor, title and HTML of each section.
fn sections(page: &Page) -> [(&'static str, &'static str, String); 10] {
    let job = page.job;
    let told = page.proof.map_or(&[][..], |proof| proof.findings.as_slice());
    let findings: Vec<&Finding> = job.findings.iter().chain(told).collect();
    [
        ("rigid", "Is it rigid?", sections::verdict(job, page.source.joint)),
        ("space", "In space", space(page)),
        ("findings", "Findings", sections::findings(findings)),
        ("order", "What to order", sections::order(page)),
        ("sheets", "Sheets", sheets(page)),
        ("parts", "Parts", sections::parts(page)),
        ("assembly", "Assembly", assembly(page)),
        ("bends", "Bends", bending::bending(page)),
        ("slits", "Slits", sections::slits(page)),
        ("proof", "Proof", sections::proof(page)),
    ]
}

fn assembly(page: &Page) -> String {
    if !page.job.only.is_empty() {
        return "<p>These parts replace others of a whole job: its report shows where they go.</p>\n"
            .to_owned();
    }
    assembly::steps(page.job, &steps::steps(page.job, page.source.template))
}

fn sheets(page: &Page) -> String {
    let drawn = drawing::sheets(page.job);
    match (page.is_approved, page.job.sheets.is_empty()) {
        (_, true) => "<p>No sheet was filled.</p>\n".to_owned(),
        (true, false) => drawn,
        (false, false) => format!("<div class=\"refused\">{drawn}</div>"),
    }
}

fn about(page: &Page) -> String {
    let size = page.job.structure.as_ref().map(|structure| structure.size_text());
    let material = &page.source.template.material;
    let size = size.map(|size| format!("{size}, ")).unwrap_or_default();
    let only = match page.job.only.as_slice() {
        [] => String::new(),
        parts => format!("only {}: ", parts.join(", ")),
    };
    format!(
        "{only}{size}scale {}, {}, from {}",
        page.source.scale, material.name, page.source.input
    )
}

fn stamp(page: &Page) -> &'static str {
    if page.is_approved {
        ""
    } else {
        "<p class=\"stamp\">Not for cutting: the job was refused. The findings say why.</p>\n"
    }
}

/// The view with its controls, and the numbers it is drawn from.
fn space(page: &Page) -> String {
    let Some(structure) = &page.job.structure else {
        return "<p>There is no structure to show.</p>\n".to_owned();
    };
    let scene =
        scene::scene(page.job, structure, page.source.joint, page.source.template);
    let (nodes, fins) = (structure.nodes().len(), structure.fins().len());
    format!(
        "<div id=\"viewer\"><canvas id=\"view\" tabindex=\"0\" role=\"img\" \
         aria-label=\"the structure in space: {fins} fins on {nodes} nodes\"></canvas>\n{CONTROLS}</div>\n\
         <script type=\"application/json\" id=\"scene\">{}</script>\n",
        html::script(&scene)
    )
}

const CONTROLS: &str = include_str!("controls.html");
