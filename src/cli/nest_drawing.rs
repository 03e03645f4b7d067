//! Parts from DXF and SVG drawings.

use crate::cli::flags::drawing::DrawingArgs;
use crate::cli::nest_input::{NestInputError, Order, Task};
use crate::diagnostic::{Finding, Located, Place};
use crate::drawing::{
    Curve, DrawingError, Drawn, DrawnPart, Purpose, Reading, Rules, drawn_parts,
    read_dxf, read_svg,
};
use crate::export::LAYERS;
use crate::geometry::{Contour, Point2, Rect, Vector2, Vertex};
use crate::nest::{self, Layout, Rotations, Shape};
use crate::report::Lines;
use crate::sheets::{Operation, Path};
use crate::tolerance::ARC_SAGITTA_MM;
use crate::units::Unit;
use miette::Diagnostic;
use std::collections::BTreeMap;
use thiserror::Error;

/// Reads the bytes of a drawing; `is_dxf` or else SVG.
///
/// # Errors
/// [`DrawingError`] if the bytes are none.
pub(super) fn read(
    bytes: &[u8],
    is_dxf: bool,
    args: &DrawingArgs,
) -> Result<Drawn, DrawingError> {
    let known = LAYERS.map(|layer| layer.known());
    let reading = Reading {
        millimetres: args.units.map(Unit::millimetres),
        dpi: args.dpi.unwrap_or(96.0),
        known: &known,
    };
    let read = if is_dxf { read_dxf } else { read_svg };
    let rules = Rules { layers: args.layers.clone(), join: args.join.unwrap_or(0.0) };
    Ok(drawn_parts(read(bytes, &reading)?, &rules))
}

/// What a drawing leaves open.
#[derive(Debug, Clone, PartialEq, Error, Diagnostic)]
#[allow(missing_docs, reason = "the messages say it")]
enum DrawingNote {
    #[error("the drawing does not say its unit; it is read so that it measures {size}")]
    #[diagnostic(
        code(read::drawing_unit),
        severity(Warning),
        help(
            "compare the size; set the units in the program that drew it, or say `--units` \
             or `--dpi`"
        )
    )]
    Unit { size: String },

    #[error("{count} {kind} on the drawing cannot be read and will be missing")]
    #[diagnostic(
        code(read::drawing_unread),
        severity(Warning),
        help("turn it into lines in the plane (explode it, text to curves)")
    )]
    Unread { kind: String, count: usize },

    #[error(
        "{count} lines lie on no part and are left out; one begins at {x:.2}, {y:.2}"
    )]
    #[diagnostic(
        code(read::drawing_stray),
        severity(Warning),
        help("close the outline they belong to; ends may be 0.01 mm apart")
    )]
    Stray { count: usize, x: f64, y: f64 },

    #[error(
        "{count} lines are kept from being an outline by a gap; one of {width:.3} mm is at \
         {x:.2}, {y:.2}"
    )]
    #[diagnostic(
        code(read::drawing_gap),
        severity(Warning),
        help("close it in the program that drew it, or say `--join {join}`")
    )]
    Gap { count: usize, width: f64, join: f64, x: f64, y: f64 },

    #[error(
        "{count} outlines share an edge with another one, which has it alone; one begins at \
         {x:.2}, {y:.2}"
    )]
    #[diagnostic(
        code(read::drawing_shared),
        severity(Warning),
        help("draw each outline whole; parts are laid apart and cut one by one")
    )]
    Shared { count: usize, x: f64, y: f64 },

    #[error(
        "{count} lines lie on another one and are cut once; one begins at {x:.2}, {y:.2}"
    )]
    #[diagnostic(
        code(read::drawing_doubled),
        severity(Warning),
        help("nothing needs to be done; delete them if they were drawn by mistake")
    )]
    Doubled { count: usize, x: f64, y: f64 },

    #[error(
        "{count} closed lines lie partly in another one and are left out; one begins at \
         {x:.2}, {y:.2}"
    )]
    #[diagnostic(
        code(read::drawing_crossing),
        severity(Warning),
        help("draw what is to be cut as outlines and holes that do not cross")
    )]
    Crossing { count: usize, x: f64, y: f64 },

    #[error(
        "{count} cuts run over another cut of their part; one begins at {x:.2}, {y:.2}"
    )]
    #[diagnostic(
        code(read::drawing_over),
        severity(Warning),
        help("the laser goes there twice; delete what lies double")
    )]
    Over { count: usize, x: f64, y: f64 },

    #[error(
        "{count} holes touch the outline or another hole; one does near {x:.2}, {y:.2}"
    )]
    #[diagnostic(
        code(read::drawing_touching),
        severity(Warning),
        help("leave material between them, or draw what is left as one outline")
    )]
    Touching { count: usize, x: f64, y: f64 },

    #[error("{count} lines on {layer} are switched off and are left out")]
    #[diagnostic(
        code(read::drawing_hidden),
        severity(Warning),
        help("switch the layer on if they belong to the parts")
    )]
    Hidden { layer: String, count: usize },

    #[error("{count} lines in paper space are left out")]
    #[diagnostic(
        code(read::drawing_paper),
        severity(Advice),
        help("only what is drawn in model space is cut")
    )]
    Paper { count: usize },

    #[error("lines by layer: {list}")]
    #[diagnostic(
        code(read::drawing_layers),
        severity(Advice),
        help("`--layers NAME=cut`, `=engrave` or `=ignore` says otherwise")
    )]
    Layers { list: String },
}

impl Located for DrawingNote {
    fn place(&self) -> Place {
        Place::default()
    }
}

/// A little more than a width, as one types it.
fn wider(width: f64) -> f64 {
    (width * 11.0).ceil() / 10.0
}

/// Parts drawn farther out than this are moved to the origin, mm: there coordinates are
/// finer, and none is refused for its place.
const FAR_MM: f64 = 100_000.0;

/// The parts of some drawings, `P1` and on, and what the drawings leave open.
///
/// # Errors
/// [`NestInputError`] if there is no closed line in one of them.
pub(super) fn order(
    drawings: &[(String, Drawn)],
    args: &DrawingArgs,
) -> Result<(Order, Vec<Finding>), NestInputError> {
    let (mut lines, mut shapes, mut notes) = (Lines::new(), Vec::new(), Vec::new());
    for (name, drawn) in drawings {
        if drawn.parts.is_empty() {
            let all = all_notes(drawn).into_iter().map(|note| note.to_string());
            let what = "there is no closed line on the drawing".to_owned();
            let what = std::iter::once(what).chain(all).collect::<Vec<_>>().join("; ");
            return Err(NestInputError::Bad { name: name.clone(), what });
        }
        let of = if drawings.len() > 1 { format!("{name}-") } else { String::new() };
        for (k, part) in drawn.parts.iter().enumerate() {
            let name = format!("{of}P{}", k + 1);
            let part = at_hand(part);
            let rotations = args.rotations.clone().unwrap_or(Rotations::Free);
            let shape = shape(&name, &part, rotations);
            shapes.extend(vec![shape; args.quantity.unwrap_or(1) as usize]);
            lines.insert(name, paths(&part));
        }
        notes.extend(all_notes(drawn).into_iter().map(Finding::from));
    }
    let name = drawings.first().map(|(name, _)| name.clone()).unwrap_or_default();
    let order = Order {
        name,
        task: Task::Sheets,
        lines,
        shapes,
        stock: Vec::new(),
        holes_closed: false,
        layout: Layout::default(),
    };
    Ok((order, notes))
}

/// The part, moved to the origin if it was drawn far from it.
fn at_hand(part: &DrawnPart) -> DrawnPart {
    let corners: Vec<Point2> = part.outline.vertices.iter().map(|v| v.point).collect();
    let Rect { min, max } = Rect::around(&corners);
    let is_far = min.coords.amax().max(max.coords.amax()) > FAR_MM;
    let by = if is_far { -min.coords } else { Vector2::zeros() };
    let moved = |contour: &Contour| contour.moved(|p| p + by);
    let marks = part.marks.iter().map(|(purpose, curve)| {
        let vertices = moved(&curve.contour()).vertices;
        (*purpose, Curve { vertices, ..curve.clone() })
    });
    DrawnPart {
        outline: moved(&part.outline),
        holes: part.holes.iter().map(moved).collect(),
        marks: marks.collect(),
    }
}

fn shape(name: &str, part: &DrawnPart, rotations: Rotations) -> Shape {
    // What stays tangled is refused by its name later on.
    let plain =
        |ring: Vec<Point2>, is_hole| nest::without_loops(&ring, is_hole).unwrap_or(ring);
    let hole = |hole: &Contour| plain(hole.flattened(ARC_SAGITTA_MM), true);
    Shape {
        name: name.to_owned(),
        outline: plain(part.outline.enclosing_polygon(ARC_SAGITTA_MM), false),
        holes: part.holes.iter().map(hole).collect(),
        rotations,
        priority: 0,
    }
}

/// All lines of a part as they are cut: marks, holes, the outline.
fn paths(part: &DrawnPart) -> Vec<(Operation, Path)> {
    let marks = part.marks.iter().map(|(purpose, curve)| mark(*purpose, curve));
    let holes = part.holes.iter();
    let holes = holes.map(|hole| (Operation::CutInner, Path::Closed(hole.clone())));
    let outline = (Operation::CutOuter, Path::Closed(part.outline.clone()));
    marks.chain(holes).chain([outline]).collect()
}

/// Open cuts are cut before the outline.
fn mark(purpose: Purpose, curve: &Curve) -> (Operation, Path) {
    let operation = match purpose {
        Purpose::Score => Operation::Score,
        Purpose::Cut => Operation::CutInner,
        Purpose::Engrave | Purpose::Ignore => Operation::Engrave,
    };
    if curve.closed {
        return (operation, Path::Closed(curve.contour()));
    }
    let mut vertices = curve.vertices.clone();
    if let Some(last) = vertices.last_mut() {
        *last = Vertex::line(last.point);
    }
    (operation, Path::Open(Contour { vertices }.flattened(ARC_SAGITTA_MM)))
}

fn all_notes(drawn: &Drawn) -> Vec<DrawingNote> {
    let mut notes = Vec::new();
    if !drawn.says_unit && !drawn.parts.is_empty() {
        let outlines = drawn.parts.iter().map(|part| &part.outline);
        let corners: Vec<Point2> = outlines
            .flat_map(|outline| outline.enclosing_polygon(ARC_SAGITTA_MM))
            .collect();
        let size = Rect::around(&corners).size();
        notes.push(DrawingNote::Unit {
            size: format!("{:.1} x {:.1} mm", size.x, size.y),
        });
    }
    let unread = drawn.unread.iter();
    notes.extend(unread.map(|(kind, &count)| {
        let kind = kind.clone();
        DrawingNote::Unread { kind, count }
    }));
    notes.extend(drawn.hidden.iter().map(|(layer, &count)| {
        let layer =
            if layer.is_empty() { "a group".to_owned() } else { format!("{layer:?}") };
        DrawingNote::Hidden { layer, count }
    }));
    if drawn.paper > 0 {
        notes.push(DrawingNote::Paper { count: drawn.paper });
    }
    let first = |points: &[Point2]| points.first().map(|p| (points.len(), p.x, p.y));
    let doubled = first(&drawn.doubled);
    notes.extend(doubled.map(|(count, x, y)| DrawingNote::Doubled { count, x, y }));
    let crossing = first(&drawn.crossing);
    notes.extend(crossing.map(|(count, x, y)| DrawingNote::Crossing { count, x, y }));
    let over = first(&drawn.over);
    notes.extend(over.map(|(count, x, y)| DrawingNote::Over { count, x, y }));
    let touching = first(&drawn.touching);
    notes.extend(touching.map(|(count, x, y)| DrawingNote::Touching { count, x, y }));
    let narrowest = drawn.gaps.iter().min_by(|a, b| a.width.total_cmp(&b.width));
    notes.extend(narrowest.map(|gap| DrawingNote::Gap {
        count: drawn.gaps.len(),
        width: gap.width,
        join: wider(gap.width),
        x: gap.at.x,
        y: gap.at.y,
    }));
    let shared = first(&drawn.shared);
    notes.extend(shared.map(|(count, x, y)| DrawingNote::Shared { count, x, y }));
    let stray = first(&drawn.stray);
    notes.extend(stray.map(|(count, x, y)| DrawingNote::Stray { count, x, y }));
    notes.extend(layers(drawn).map(|list| DrawingNote::Layers { list }));
    notes
}

/// Layers that are listed, at most.
const MOST_LISTED: usize = 12;

/// What becomes of the lines of each layer and colour; nothing where there is only one kind.
fn layers(drawn: &Drawn) -> Option<String> {
    let mut lists: BTreeMap<String, Vec<String>> = BTreeMap::new();
    for ((source, purpose), count) in &drawn.layers {
        let colour = source.rgb.map(|[r, g, b]| format!("#{r:02x}{g:02x}{b:02x}"));
        let name = (!source.name.is_empty()).then(|| source.name.clone());
        let words: Vec<String> = name.into_iter().chain(colour).collect();
        let name = if words.is_empty() { "no layer".to_owned() } else { words.join(" ") };
        let purpose = match purpose {
            Purpose::Cut => "cut",
            Purpose::Score => "scored",
            Purpose::Engrave => "engraved",
            Purpose::Ignore => "left out",
        };
        lists.entry(name).or_default().push(format!("{count} {purpose}"));
    }
    let all = lists.iter().map(|(name, counts)| format!("{name}: {}", counts.join(", ")));
    let mut all: Vec<String> = all.collect();
    if all.len() > MOST_LISTED {
        let more = all.len() - MOST_LISTED;
        all.truncate(MOST_LISTED);
        all.push(format!("and {more} more"));
    }
    let is_telling = drawn.layers.len() > 1 || drawn.parts.is_empty();
    (is_telling && !all.is_empty()).then(|| all.join("; "))
}
