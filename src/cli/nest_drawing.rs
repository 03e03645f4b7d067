//! Parts from DXF and SVG drawings (contract §5).

use crate::cli::nest_input::{NestInputError, Order, Task};
use crate::diagnostic::{Finding, Located, Place};
use crate::drawing::{self, Curve, Drawn};
use crate::geometry::{Contour, Point2, Vertex};
use crate::nest::{self, Layout, Rotations, Shape};
use crate::report::Lines;
use crate::sheets::{Operation, Path};
use crate::tolerance::ARC_SAGITTA_MM;
use miette::Diagnostic;
use thiserror::Error;

/// What a drawing leaves open.
#[derive(Debug, Clone, PartialEq, Error, Diagnostic)]
#[allow(missing_docs, reason = "the messages say it")]
enum DrawingNote {
    #[error("the drawing does not say its unit; it is read so that it measures {size}")]
    #[diagnostic(
        code(read::drawing_unit),
        severity(Warning),
        help(
            "compare the size; set the units in the program that drew it and save again"
        )
    )]
    Unit { size: String },

    #[error("{count} {kind} on the drawing cannot be read and will be missing")]
    #[diagnostic(
        code(read::drawing_unread),
        severity(Warning),
        help("turn it into lines (explode blocks and text, splines to polylines)")
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
}

impl Located for DrawingNote {
    fn place(&self) -> Place {
        Place::default()
    }
}

/// The parts of a drawing, `P1` and on, and what it leaves open.
///
/// # Errors
/// [`NestInputError`] if there is no closed line in it.
pub(super) fn order(
    drawn: &Drawn,
    name: &str,
) -> Result<(Order, Vec<Finding>), NestInputError> {
    if drawn.parts.is_empty() {
        let what = "there is no closed line on the drawing".to_owned();
        return Err(NestInputError::Bad { name: name.to_owned(), what });
    }
    let mut lines = Lines::new();
    let mut shapes = Vec::new();
    for (k, part) in drawn.parts.iter().enumerate() {
        let name = format!("P{}", k + 1);
        let holes = part.holes.iter();
        // What stays tangled is refused by its name later on.
        let plain = |ring: Vec<Point2>, is_hole| {
            nest::without_loops(&ring, is_hole).unwrap_or(ring)
        };
        let hole = |hole: &Contour| plain(hole.flattened(ARC_SAGITTA_MM), true);
        shapes.push(Shape {
            name: name.clone(),
            outline: plain(part.outline.enclosing_polygon(ARC_SAGITTA_MM), false),
            holes: holes.clone().map(hole).collect(),
            rotations: Rotations::Free,
            priority: 0,
        });
        let holes = holes.map(|hole| (Operation::CutInner, Path::Closed(hole.clone())));
        let outline = (Operation::CutOuter, Path::Closed(part.outline.clone()));
        let all = part.marks.iter().map(mark).chain(holes).chain([outline]);
        lines.insert(name, all.collect());
    }
    let notes = notes(drawn, &shapes).into_iter().map(Finding::from).collect();
    let name = name.to_owned();
    let (stock, layout) = (Vec::new(), Layout::default());
    let order = Order {
        name,
        task: Task::Sheets,
        lines,
        shapes,
        stock,
        holes_closed: false,
        layout,
    };
    Ok((order, notes))
}

fn notes(drawn: &Drawn, shapes: &[Shape]) -> Vec<DrawingNote> {
    let mut notes = Vec::new();
    if !drawn.says_unit {
        let points = || shapes.iter().flat_map(|shape| &shape.outline);
        let low =
            points().fold([f64::INFINITY; 2], |l, p| [l[0].min(p.x), l[1].min(p.y)]);
        let high =
            points().fold([f64::NEG_INFINITY; 2], |h, p| [h[0].max(p.x), h[1].max(p.y)]);
        let size = format!("{:.1} x {:.1} mm", high[0] - low[0], high[1] - low[1]);
        notes.push(DrawingNote::Unit { size });
    }
    let unread = drawn.unread.iter();
    notes.extend(
        unread.map(|(kind, count)| DrawingNote::Unread {
            kind: kind.clone(),
            count: *count,
        }),
    );
    if let Some(first) = drawn.stray.first() {
        notes.push(DrawingNote::Stray {
            count: drawn.stray.len(),
            x: first.x,
            y: first.y,
        });
    }
    notes
}

/// Open cuts are cut before the outline; what is on no layer of ours is engraved, which can
/// do no harm.
fn mark(curve: &Curve) -> (Operation, Path) {
    let operation = match curve.layer {
        "SCORE" => Operation::Score,
        layer if drawing::is_cut(layer) => Operation::CutInner,
        _ => Operation::Engrave,
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
