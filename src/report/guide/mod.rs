//! `assembly.pdf`: the steps of assembly on paper, one figure each, parts named as engraved.

mod page;

use crate::fabrication::Fabrication;
use crate::geometry::{Point2, Vector2};
use crate::ids::PartId;
use crate::parts::Body;
use crate::report::fins;
use crate::report::manifest::JobSource;
use crate::report::picture::Picture;
use crate::report::steps::{Step, standing, steps};
use page::{BOLD, FONTS, GuidePage, MARGIN, PLAIN, POINTS_PER_MM, SIZE, Set, lines};
use pdf_writer::{Finish, Name, Pdf, Rect, Ref};

/// Figures beside and below each other on a page.
const GRID: [usize; 2] = [2, 3];

/// Between figures, mm.
const GAP: f64 = 8.0;

/// Lines of text below a figure; a step that goes onto more parts than fit says how many.
const LINES: usize = 7;

/// From line to line, as a share of the size of the letters.
const LEADING: f64 = 1.3;

const NEW: [f32; 3] = [1.0, 0.62, 0.25];
const NEW_EDGE: [f32; 3] = [0.72, 0.3, 0.0];
const STANDING: [f32; 3] = [0.93, 0.95, 0.96];

/// The guide of a job; `None` if nothing is to be assembled.
pub fn guide(job: &Fabrication, source: &JobSource) -> Option<Vec<u8>> {
    let structure = job.structure.as_ref()?;
    let steps = steps(job, source.template);
    if steps.is_empty() {
        return None;
    }
    let room = cell();
    let picture = Picture::new(job, structure, room.x);
    // As large as the figure's place allows in height as well.
    let height = room.y - f64::from(LINES as u32 + 1) * PLAIN.size * LEADING;
    let width = room.x * (height / picture.size[1]).min(1.0);
    let picture = Picture::new(job, structure, width);
    let mut pages = vec![title(job, source, steps.len())];
    let numbered: Vec<(usize, &Step)> = steps.iter().enumerate().collect();
    for chunk in numbered.chunks(GRID[0] * GRID[1]) {
        let mut page = GuidePage::new();
        for (place, (k, step)) in chunk.iter().enumerate() {
            let standing = standing(job, &steps, *k);
            let figure = Figure { job, picture: &picture, standing: &standing };
            figure.draw(&mut page, corner(place), (*k, step));
        }
        pages.push(page);
    }
    pages.extend(list(job, &steps));
    Some(bound(pages))
}

/// Size of a figure's place.
fn cell() -> Vector2 {
    let [columns, rows] = GRID.map(|count| count as f64);
    let room = |all: f64, count: f64| (all - 2.0 * MARGIN - (count - 1.0) * GAP) / count;
    Vector2::new(room(SIZE[0], columns), room(SIZE[1], rows))
}

/// Upper left corner of a figure's place.
fn corner(place: usize) -> Point2 {
    let (column, row) = ((place % GRID[0]) as f64, (place / GRID[0]) as f64);
    let step = cell() + Vector2::new(GAP, GAP);
    Point2::new(MARGIN + column * step.x, SIZE[1] - MARGIN - row * step.y)
}

struct Figure<'a> {
    job: &'a Fabrication,
    picture: &'a Picture,
    standing: &'a [PartId],
}

impl Figure<'_> {
    fn draw(&self, page: &mut GuidePage, at: Point2, (k, step): (usize, &Step)) {
        let ids = step.parts.iter().map(|&part| self.job.parts[part].id.as_str());
        let head = format!("{}   {}", k + 1, ids.collect::<Vec<_>>().join(" "));
        page.text(at - Vector2::new(0.0, BOLD.size), BOLD, &head);
        let down = 1.6 * BOLD.size + self.picture.size[1];
        let origin = at.coords - Vector2::new(0.0, down);
        let panels = || self.picture.panels.iter();
        let place = |corners: &[Point2; 4]| corners.map(|p| p + origin);
        for panel in panels() {
            if step.parts.contains(&panel.part) {
                page.shape(&place(&panel.corners), NEW);
            } else if self.standing.contains(&panel.part) {
                page.shape(&place(&panel.corners), STANDING);
            }
        }
        // What stands in front hides it: its edges show through.
        for panel in panels().filter(|panel| step.parts.contains(&panel.part)) {
            page.edge(&place(&panel.corners), NEW_EDGE);
        }
        let mut line = Point2::from(origin);
        for text in self.words(step) {
            line.y -= PLAIN.size * LEADING;
            page.text(line, PLAIN, &text);
        }
    }

    /// What is written below the figure.
    fn words(&self, step: &Step) -> Vec<String> {
        let onto: Vec<String> =
            step.onto.iter().map(|(node, part)| format!("{part} at {node}")).collect();
        let mut text = step.words.clone();
        if !onto.is_empty() {
            text += &format!(" Onto {}.", onto.join(", "));
        }
        let mut lines = lines(&text, PLAIN, cell().x);
        if lines.len() > LINES {
            lines.truncate(LINES);
            if let Some(last) = lines.last_mut() {
                *last = format!("... {} nodes in all, see the report", onto.len());
            }
        }
        lines
    }
}

/// How to read the steps: of strips, ...
const HOW_STRIPS: [&str; 3] = [
    "The engraved face looks along travel × axis: read the part's name upright and the \
     nodes run from left to right, their axes upward.",
    "\"S03 at 12\" means: at node 12 the slit that is open below slides over the slit of S03 \
     that is open above.",
    "Zip means: start at one end and push the strip down node after node, letting the free end \
     stand off. Do not force it flat in one go.",
];

/// ... of single fins, ...
const HOW_FINS: [&str; 2] = [
    "Read a fin's name upright: its arrow points up the node axes, and each end bears the \
     name of its node.",
    "\"F03 at 12\" means: at node 12 the connector also takes fin F03, which stands already.",
];

/// ... and of connectors.
const HOW_CONNECTORS: &str = "Connectors look up with their letters. A disc bears beside each \
    window the name of the part that stands there; the key holes of both discs of a node lie \
    above each other.";

const NO_STRESS: &str = "Put nothing under stress that was cleaned with alcohol or solvent: \
    acrylic crazes. Work on a flat board, and dry-fit before you glue.";

/// What it is and how to read it.
fn title(job: &Fabrication, source: &JobSource, steps: usize) -> GuidePage {
    let mut page = GuidePage::new();
    let name = job.structure.as_ref().map_or("", |structure| structure.name());
    let size = job.structure.as_ref().map(|s| s.size_text()).unwrap_or_default();
    let material = &source.template.material;
    let head = Set { size: 9.0, bold: true };
    let mut at = Point2::new(MARGIN, SIZE[1] - MARGIN - head.size);
    page.text(at, head, name);
    let facts = [
        format!("{size}, scale {}", source.scale),
        format!(
            "Parts: {}. Sheets: {} of {}.",
            job.parts.len(),
            job.sheets.len(),
            material.name
        ),
        job.verdict.as_ref().map(|verdict| verdict.summary()).unwrap_or_default(),
    ];
    let mut how: Vec<&str> = match job.has(|body| matches!(body, Body::Fin(_))) {
        true => HOW_FINS.to_vec(),
        false => HOW_STRIPS.to_vec(),
    };
    let connected = job.has(|body| matches!(body, Body::Connector(_)));
    how.extend(connected.then_some(HOW_CONNECTORS).into_iter().chain([NO_STRESS]));
    let order = format!(
        "The parts go in one after the other in {steps} steps. Each figure shows in grey what \
         stands already and in orange the parts that go in; where something stands in front of \
         them, their edges show through. Every part is engraved with its name."
    );
    at.y -= 6.0;
    let how = how.into_iter().map(str::to_owned);
    for text in facts.into_iter().chain([order]).chain(how) {
        at.y -= PLAIN.size * 0.7;
        for line in lines(&text, PLAIN, SIZE[0] - 2.0 * MARGIN) {
            at.y -= PLAIN.size * LEADING;
            page.text(at, PLAIN, &line);
        }
    }
    whole(job, &mut page);
    page
}

/// The finished structure at the foot of the title.
fn whole(job: &Fabrication, page: &mut GuidePage) {
    let Some(structure) = &job.structure else { return };
    let room = Vector2::new(SIZE[0] - 2.0 * MARGIN, SIZE[1] / 2.0);
    let [width, height] = Picture::new(job, structure, room.x).size;
    let picture = Picture::new(job, structure, width * (room.y / height).min(1.0));
    for panel in &picture.panels {
        let corners = panel.corners.map(|p| p + Vector2::new(MARGIN, MARGIN));
        page.shape(&corners, STANDING);
    }
}

/// The parts with their sizes and sheets.
fn list(job: &Fabrication, steps: &[Step]) -> Vec<GuidePage> {
    const COLUMNS: [f64; 5] = [0.0, 20.0, 50.0, 80.0, 105.0];
    let sheets = fins::sheets(job);
    let rows = job.parts_with_ids().map(|(id, part)| {
        let [length, height] = part.extent();
        let sheet =
            sheets.get(&id).map_or(String::new(), |sheet| (sheet + 1).to_string());
        let step = steps.iter().position(|step| step.parts.contains(&id));
        let step = step.map_or(String::new(), |step| (step + 1).to_string());
        [part.id.clone(), format!("{length:.1}"), format!("{height:.1}"), sheet, step]
    });
    let rows: Vec<[String; 5]> = rows.collect();
    let heads = ["part", "length mm", "height mm", "sheet", "step"].map(str::to_owned);
    let step = PLAIN.size * LEADING;
    let room = ((SIZE[1] - 2.0 * MARGIN) / step) as usize - 2;
    let pages = rows.chunks(room).map(|rows| {
        let mut page = GuidePage::new();
        let mut y = SIZE[1] - MARGIN - BOLD.size;
        for (k, row) in std::iter::once(&heads).chain(rows).enumerate() {
            let set = if k == 0 { BOLD } else { PLAIN };
            for (cell, x) in row.iter().zip(COLUMNS) {
                page.text(Point2::new(MARGIN + x, y), set, cell);
            }
            y -= step;
        }
        page
    });
    pages.collect()
}

/// Pages as a PDF.
fn bound(pages: Vec<GuidePage>) -> Vec<u8> {
    let [catalog, tree] = [1, 2].map(Ref::new);
    let fonts = [3, 4].map(Ref::new);
    let mut pdf = Pdf::new();
    pdf.catalog(catalog).pages(tree);
    let ids = (5..).step_by(2).map(Ref::new).take(pages.len());
    pdf.pages(tree).kids(ids.clone()).count(pages.len() as i32);
    for (id, (_, name)) in fonts.into_iter().zip(FONTS) {
        let mut font = pdf.type1_font(id);
        font.base_font(Name(name)).encoding_predefined(Name(b"WinAnsiEncoding"));
    }
    let [width, height] = SIZE.map(|mm| (mm * POINTS_PER_MM) as f32);
    for (written, id) in pages.into_iter().zip(ids) {
        let contents = Ref::new(id.get() + 1);
        let mut page = pdf.page(id);
        page.parent(tree).contents(contents);
        page.media_box(Rect::new(0.0, 0.0, width, height));
        let mut resources = page.resources();
        let mut names = resources.fonts();
        for (font, (name, _)) in fonts.into_iter().zip(FONTS) {
            names.pair(Name(name), font);
        }
        names.finish();
        resources.finish();
        page.finish();
        pdf.stream(contents, &written.bytes());
    }
    pdf.finish()
}
