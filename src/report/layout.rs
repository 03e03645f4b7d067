//! `layout.json`: where parts lie, how full the sheets are and what is left over.

use crate::geometry::{Contour, Point2};
use crate::nest::{Layout, NestError, NestedSheet, Shape, Stock};
use crate::sheets::{Operation, Path, Sheet, Stroke, placed};
use serde_json::{Value, json};
use std::collections::BTreeMap;

/// A layout with how it came about.
#[derive(Debug, Clone, PartialEq)]
pub struct Nested {
    /// Where parts lie.
    pub layout: Layout,
    /// What could not be placed.
    pub unplaced: Vec<NestError>,
    /// Units of work that were done.
    pub trials: u32,
    /// Length of the strip, mm.
    pub length: Option<f64>,
    /// Start of the random numbers.
    pub seed: u64,
}

fn mm(value: f64) -> f64 {
    (value * 1e6).round() / 1e6 + 0.0
}

fn degrees(radians: f64) -> f64 {
    (radians.to_degrees() * 1e7).round() / 1e7 + 0.0
}

/// The manifest of a layout. Shapes with one name are copies of one part.
pub fn layout_json(
    name: &str,
    shapes: &[Shape],
    stock: &[Stock],
    nested: &Nested,
) -> Value {
    let writer = Writer { shapes, stock, copies: copies(shapes) };
    let sheets = nested.layout.sheets.iter().enumerate();
    let sheets: Vec<Value> = sheets.map(|(k, sheet)| writer.sheet(k, sheet)).collect();
    let area = |s: &NestedSheet| stock[s.stock].width * stock[s.stock].height;
    let all: f64 = nested.layout.sheets.iter().map(area).sum();
    let used: f64 = nested.layout.sheets.iter().map(|s| writer.used(s)).sum();
    let outlines = |s: &NestedSheet| -> f64 {
        s.placements.iter().map(|p| ring_area(&shapes[p.shape].outline)).sum()
    };
    let closed: f64 = nested.layout.sheets.iter().map(outlines).sum();
    json!({
        "format": "finwright-layout",
        "version": 1,
        "generator": concat!("finwright ", env!("CARGO_PKG_VERSION")),
        "name": name,
        "seed": nested.seed,
        "work": nested.trials,
        "spacing": stock.first().map(|s| s.spacing),
        "utilisation": mm(used / all.max(f64::MIN_POSITIVE)),
        "length": nested.length,
        "density": nested.length.map(|_| mm(closed / all)),
        "sheets": sheets,
        "unplaced": nested.unplaced.iter().map(ToString::to_string).collect::<Vec<_>>(),
        "parts": writer.parts(),
    })
}

/// Number of each shape among those with its name, from 1.
fn copies(shapes: &[Shape]) -> Vec<usize> {
    let mut seen: BTreeMap<&str, usize> = BTreeMap::new();
    let count = |shape| {
        let count = seen.entry(shape).or_default();
        *count += 1;
        *count
    };
    shapes.iter().map(|shape| shape.name.as_str()).map(count).collect()
}

fn ring_area(ring: &[Point2]) -> f64 {
    Contour::polygon(ring.iter().copied()).signed_area().abs()
}

struct Writer<'a> {
    shapes: &'a [Shape],
    stock: &'a [Stock],
    copies: Vec<usize>,
}

impl Writer<'_> {
    fn used(&self, sheet: &NestedSheet) -> f64 {
        let net = |shape: &Shape| {
            let holes: f64 = shape.holes.iter().map(|hole| ring_area(hole)).sum();
            ring_area(&shape.outline) - holes
        };
        sheet.placements.iter().map(|p| net(&self.shapes[p.shape])).sum()
    }

    fn sheet(&self, index: usize, nested: &NestedSheet) -> Value {
        let stock = &self.stock[nested.stock];
        let id = sheet_id(index);
        let file = |ending: &str| format!("sheets/{id}.{ending}");
        let placements = nested.placements.iter().map(|p| {
            json!({
                "part": self.shapes[p.shape].name,
                "copy": self.copies[p.shape],
                "x": mm(p.x),
                "y": mm(p.y),
                "angle_deg": degrees(p.angle),
            })
        });
        json!({
            "id": id,
            "width": stock.width,
            "height": stock.height,
            "margin": stock.margin,
            "files": {"dxf": file("dxf"), "svg": file("svg"), "png": file("png")},
            "utilisation": mm(self.used(nested) / (stock.width * stock.height)),
            "offcut": self.offcut(nested),
            "placements": placements.collect::<Vec<_>>(),
        })
    }

    /// The larger rectangle that can be cut off to the right of all parts, or above them.
    fn offcut(&self, nested: &NestedSheet) -> Value {
        let stock = &self.stock[nested.stock];
        let corners = nested.placements.iter().flat_map(|p| {
            self.shapes[p.shape].outline.iter().map(|&corner| placed(p, corner))
        });
        let (right, top) =
            corners.fold((0.0, 0.0), |(x, y): (f64, f64), p| (x.max(p.x), y.max(p.y)));
        let (x, y) = (right + stock.spacing, top + stock.spacing);
        let (width, height) = ((stock.width - x).max(0.0), (stock.height - y).max(0.0));
        if width * stock.height >= height * stock.width {
            json!({"x": mm(x), "y": 0.0, "width": mm(width), "height": stock.height})
        } else {
            json!({"x": 0.0, "y": mm(y), "width": stock.width, "height": mm(height)})
        }
    }

    fn parts(&self) -> Vec<Value> {
        let mut quantity: BTreeMap<&str, usize> = BTreeMap::new();
        for shape in self.shapes {
            *quantity.entry(&shape.name).or_default() += 1;
        }
        let ring =
            |ring: &Vec<Point2>| ring.iter().map(|p| [p.x, p.y]).collect::<Vec<_>>();
        let firsts = self.shapes.iter().zip(&self.copies).filter(|(_, copy)| **copy == 1);
        let part = |(shape, _): (&Shape, &usize)| {
            json!({
                "id": shape.name,
                "quantity": quantity[shape.name.as_str()],
                "outline": ring(&shape.outline),
                "holes": shape.holes.iter().map(ring).collect::<Vec<_>>(),
            })
        };
        firsts.map(part).collect()
    }
}

fn sheet_id(index: usize) -> String {
    format!("sheet-{:02}", index + 1)
}

/// The lines of each part that has others than its flattened outline and holes, by name.
pub type Lines = BTreeMap<String, Vec<(Operation, Path)>>;

/// The lines of a part as the nester sees it.
fn rings(shape: &Shape) -> Vec<(Operation, Path)> {
    let closed =
        |ring: &Vec<Point2>| Path::Closed(Contour::polygon(ring.iter().copied()));
    let holes = shape.holes.iter().map(|hole| (Operation::CutInner, closed(hole)));
    holes.chain([(Operation::CutOuter, closed(&shape.outline))]).collect()
}

/// The sheets of a layout as lines to cut.
pub fn layout_sheets(
    shapes: &[Shape],
    stock: &[Stock],
    layout: &Layout,
    lines: &Lines,
) -> Vec<Sheet> {
    let sheet = |(index, nested): (usize, &NestedSheet)| {
        let Stock { width, height, .. } = stock[nested.stock];
        let corners = [(0.0, 0.0), (width, 0.0), (width, height), (0.0, height)];
        let border = Contour::polygon(corners.map(|(x, y)| Point2::new(x, y)));
        let mut strokes: Vec<Stroke> = Vec::new();
        for p in &nested.placements {
            let shape = &shapes[p.shape];
            let drawn = lines.get(&shape.name).cloned().unwrap_or_else(|| rings(shape));
            strokes.extend(drawn.into_iter().map(|(operation, path)| {
                let path = path.moved(|corner| placed(p, corner));
                Stroke { operation, part: p.shape, path }
            }));
        }
        strokes.sort_by_key(|stroke| stroke.operation);
        let frame = vec![Path::Closed(border)];
        Sheet { id: sheet_id(index), width, height, strokes, frame }
    };
    layout.sheets.iter().enumerate().map(sheet).collect()
}
