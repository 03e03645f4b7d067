//! What the page says in words and tables.

use crate::diagnostic::{Finding, Severity};
use crate::fabrication::Fabrication;
use crate::geometry::Contour;
use crate::ids::PartId;
use crate::joint::Joint;
use crate::manifest::Worst;
use crate::parts::{Body, Opening, Part};
use crate::report::connectors::hardware;
use crate::report::fins;
use crate::report::page::Page;
use crate::report::page::html::{self, details, table};
use crate::rigidity::{Outcome, Verdict};

/// The most important figures side by side.
pub(super) fn summary(page: &Page) -> String {
    let totals = &page.manifest.totals;
    let minutes = (totals.seconds / 60.0).ceil();
    let mut cards = vec![
        ("parts", totals.parts.to_string()),
        (if totals.sheets == 1 { "sheet" } else { "sheets" }, totals.sheets.to_string()),
        ("to cut", format!("{:.1} m", totals.cut_length / 1000.0)),
        ("on the machine", format!("{minutes} min")),
        ("mass", format!("{:.2} kg", totals.mass)),
    ];
    let cost = totals.cost.filter(|cost| *cost > 0.0);
    cards.push(("material", cost.map_or("not priced".to_owned(), |c| format!("{c:.2}"))));
    // What was never made has no figures: a zero would be read as a fact.
    let known = match (totals.parts, totals.sheets) {
        (0, _) => 0,
        (_, 0) => 1,
        _ => cards.len(),
    };
    cards.truncate(known);
    let card = |(name, value): &(&str, String)| {
        format!("<div class=\"card\"><b>{}</b>{name}</div>", html::text(value))
    };
    format!("<div class=\"cards\">{}</div>\n", cards.iter().map(card).collect::<String>())
}

/// Rigid or not, and what that means in millimetres.
pub(super) fn verdict(job: &Fabrication, joint: Joint) -> String {
    let Some(verdict) = &job.verdict else {
        return "<p>It was not judged: other faults come first.</p>\n".to_owned();
    };
    let name = verdict.outcome().name();
    let mut text = format!(
        "<p class=\"verdict {name}\"><strong>{name}</strong> {}</p>\n<p>{}</p>\n",
        html::text(meaning(verdict.outcome())),
        html::text(verdict.summary().trim_start_matches(name).trim_start_matches(": "))
    );
    if let Some(reason) = &job.settings.accepted_flexible {
        let reason = html::text(reason);
        text += &format!("<p>Accepted as flexible on purpose: <q>{reason}</q></p>\n");
    }
    if let Some(stiff) = verdict.stiff_in_words() {
        text += &format!("<p>For comparison, {}.</p>\n", html::text(&stiff));
    }
    text += &remedies(verdict);
    text + &format!("<p class=\"small\">Joint: {}.</p>\n", joint.words())
}

const fn meaning(outcome: Outcome) -> &'static str {
    match outcome {
        Outcome::Rigid => {
            "Joints have play. Built, no node looked at moves farther for it than allowed."
        }
        Outcome::Grey => {
            "The bounds do not decide it: it may sway a little more than allowed. Look at the \
             softest motion below, and build a corner first."
        }
        Outcome::Flexible => {
            "The play of the joints adds up: parts can be moved by hand farther than allowed."
        }
        Outcome::Mechanism => {
            "It moves without any resistance: it does not stand by itself."
        }
    }
}

fn remedies(verdict: &Verdict) -> String {
    let lines = verdict.remedies_in_words();
    if lines.is_empty() {
        return String::new();
    }
    let items = lines.iter().map(|line| format!("<li>{}</li>", html::text(line)));
    format!("<p>What would help:</p><ul>{}</ul>\n", items.collect::<String>())
}

/// Everything found, the worst first.
pub(super) fn findings(mut all: Vec<&Finding>) -> String {
    if all.is_empty() {
        return "<p>Nothing to say: no error, no warning, no note.</p>\n".to_owned();
    }
    all.sort_by_key(|finding| std::cmp::Reverse(finding.severity));
    let rows: Vec<Vec<String>> = all.into_iter().map(finding).collect();
    let (caption, heads) = (
        format!("{} finding{}", rows.len(), if rows.len() == 1 { "" } else { "s" }),
        ["", "what was found", "what to do", "parts"],
    );
    let body = table(&caption, &heads, &rows);
    // A page of warnings would hide what follows.
    if rows.len() > 12 { details(&caption, &body) } else { body }
}

fn finding(finding: &Finding) -> Vec<String> {
    let word = match finding.severity {
        Severity::Error => "error",
        Severity::Warning => "warning",
        Severity::Note => "note",
    };
    let parts = finding.place.parts.iter().take(8).map(|id| html::part(id));
    vec![
        format!("<span class=\"{word}\">{word}</span>"),
        format!(
            "{}<br><code>{}</code>",
            html::text(&finding.message),
            html::text(&finding.code)
        ),
        html::text(&finding.help),
        parts.collect::<Vec<_>>().join(" "),
    ]
}

/// What to buy.
pub(super) fn order(page: &Page) -> String {
    let material = &page.source.template.material;
    let stock = page.job.settings.stock.iter().enumerate();
    let rows = stock.filter_map(|(index, sheet)| {
        let used = page.job.layout.sheets.iter().filter(|s| s.stock == index).count();
        let size =
            format!("{} × {} × {} mm", sheet.width, sheet.height, material.thickness_mm);
        (used > 0).then(|| vec![used.to_string(), size, html::text(&material.name)])
    });
    let rows: Vec<Vec<String>> = rows.collect();
    if rows.is_empty() {
        return "<p>No sheet was filled.</p>\n".to_owned();
    }
    let bought = hardware(&page.job.parts).into_iter().map(|item| {
        vec![item.quantity.to_string(), item.name(), format!("{}, steel", item.kind)]
    });
    let rows: Vec<Vec<String>> = rows.into_iter().chain(bought).collect();
    let text = table("To order", &["count", "size", "what"], &rows);
    let used = page.manifest.sheets.iter();
    let used: Vec<f64> = used.filter_map(|sheet| sheet.utilisation).collect();
    let mean = 100.0 * used.iter().sum::<f64>() / used.len().max(1) as f64;
    let (least, most) = (material.thickness_least_mm, material.thickness_most_mm);
    text + &format!(
        "<p>{mean:.0} % of them become parts. Measure the thickness before you cut: sheets sold as \
         {} mm may have {least} to {most} mm. Slits are for {} mm, kerf {} mm, clearance {} mm; \
         a coupon (<code>finwright coupon</code>) tells yours.</p>\n",
        material.thickness_mm,
        material.thickness_mm,
        material.kerf_mm,
        material.clearance_mm
    )
}

/// The bill of parts.
pub(super) fn parts(page: &Page) -> String {
    let job = page.job;
    let sheets = fins::sheets(job);
    let row = |(id, part): (PartId, &Part)| {
        let cut: f64 = part.region.contours().map(Contour::length).sum();
        let [length, height] = part.extent();
        let nodes = part.body.nodes().iter().map(ToString::to_string).collect::<Vec<_>>();
        vec![
            html::part(&part.id),
            format!("{length:.1}"),
            format!("{height:.1}"),
            format!("{cut:.0}"),
            sheets.get(&id).map_or(String::new(), |sheet| (sheet + 1).to_string()),
            nodes.join(" "),
        ]
    };
    let rows: Vec<Vec<String>> = job.parts_with_ids().map(row).collect();
    if rows.is_empty() {
        return "<p>No part was made.</p>\n".to_owned();
    }
    let heads = ["part", "length mm", "height mm", "cut mm", "sheet", "nodes in order"];
    let caption = match job.has(|body| matches!(body, Body::Fin(_))) {
        true => "Fins, then connectors by their nodes",
        false => "Parts in the order of assembly",
    };
    table(caption, &heads, &rows)
}

/// Every slit with its reason.
pub(super) fn slits(page: &Page) -> String {
    let material = &page.source.template.material;
    let measured = page.proof.map_or(&[][..], |proof| proof.slits.as_slice());
    let mut rows = Vec::new();
    for part in &page.job.parts {
        let Body::Strip(body) = &part.body else { continue };
        for (slit, partner) in &body.slits {
            let drawn = measured
                .iter()
                .find(|s| s.part == part.id && s.node == slit.node.index());
            rows.push(vec![
                html::part(&part.id),
                slit.node.to_string(),
                html::part(partner),
                format!("{:.1}", slit.crossing.to_degrees()),
                match slit.from {
                    Opening::Top => "top".to_owned(),
                    Opening::Bottom => "bottom".to_owned(),
                },
                format!("{:.2}", slit.depth),
                format!("{:.3}", slit.width()),
                format!("{:+.3}", slit.offset()),
                drawn.map_or(String::new(), |s| format!("{:.3}", s.width_mm)),
                drawn.map_or(String::new(), |s| format!("{:.3}", s.play_mm)),
            ]);
        }
    }
    if rows.is_empty() {
        return "<p>No part has a slit.</p>\n".to_owned();
    }
    let heads = [
        "part",
        "node",
        "takes",
        "crossing °",
        "open at",
        "depth mm",
        "width mm",
        "offset mm",
        "drawn mm",
        "play mm",
    ];
    let why = format!(
        "<p>Plates of {} mm that cross at an angle b need t (1 + cos b) / (2 sin b) beside the \
         axis, on each side against both neighbours; the clearance of {} mm is added. Where the \
         sides differ, the slit is off the axis by the offset. \
         <em>Drawn</em> and <em>play</em> were measured in the DXF files.</p>\n",
        material.thickness_mm, material.clearance_mm
    );
    let caption = format!("{} slits and why they are as wide as they are", rows.len());
    why + &details(&caption, &table(&caption, &heads, &rows))
}

/// What the files prove.
pub(super) fn proof(page: &Page) -> String {
    let Some(proof) = page.proof else {
        return "<p>No cut file was written, so there is nothing to prove.</p>\n"
            .to_owned();
    };
    let file = |(path, digest): (&String, &String)| {
        vec![html::text(path), format!("<code>{}</code>", html::text(digest))]
    };
    let files: Vec<Vec<String>> = proof.files.iter().map(file).collect();
    let figure = |(name, of): Figure| {
        let cells = proof.worst.iter().map(|worst| format!("{:.4}", of(worst)));
        std::iter::once(name.to_owned()).chain(cells).collect::<Vec<_>>()
    };
    let rows: Vec<Vec<String>> = FIGURES.into_iter().map(figure).collect();
    let formats = proof.worst.iter().map(|w| w.format.to_uppercase());
    let heads: Vec<String> =
        std::iter::once("largest, mm".to_owned()).chain(formats).collect();
    let heads: Vec<&str> = heads.iter().map(String::as_str).collect();
    let passes = crate::diagnostic::passes(&proof.findings);
    let end = if passes {
        "It folds into the structure."
    } else {
        "It is not what it should be."
    };
    format!(
        "<p><strong>{end}</strong> The written files were read back, the kerf taken out, each part \
         found by its shape, folded at its axes and set on the structure. \
         <code>finwright verify</code> does it again on this folder, edited or not.</p>\n{}{}",
        table("Worst figures by format", &heads, &rows),
        details(
            "Files as they were written (SHA-256)",
            &table("Files", &["file", "SHA-256"], &files)
        )
    )
}

/// What is measured, and its figure.
type Figure = (&'static str, fn(&Worst) -> f64);

const FIGURES: [Figure; 7] = [
    ("gap between the axes that meet at a node", |worst| worst.node_gap_mm),
    ("axis from its place in the structure", |worst| worst.node_off_mm),
    ("corner of a fin", |worst| worst.fin_mm),
    ("slit from its place", |worst| worst.slit_off_mm),
    ("least play in a slit", |worst| worst.slit_play_least_mm),
    ("most play in a slit", |worst| worst.slit_play_most_mm),
    ("outline from the part's shape", |worst| worst.outline_mm),
];
