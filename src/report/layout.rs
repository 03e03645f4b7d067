//! `layout.json`: where parts lie, how full the sheets are and what is left over.

use crate::files::{FileFormat, SHEETS};
use crate::geometry::{Contour, Point2};
use crate::manifest::{degrees, mm};
use crate::nest::{
    self, Layout, NestError, NestedSheet, Remnant, Rotations, Shape, Stock,
};
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
    let area = |s: &NestedSheet| stock[s.stock].area();
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
        "cost": mm(nested.layout.sheets.iter().map(|s| stock[s.stock].cost).sum()),
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

fn net_area(outline: &[Point2], holes: &[Vec<Point2>]) -> f64 {
    ring_area(outline) - holes.iter().map(|hole| ring_area(hole)).sum::<f64>()
}

fn ring(points: &[Point2]) -> Vec<Value> {
    points.iter().map(|p| json!([mm(p.x), mm(p.y)])).collect()
}

struct Writer<'a> {
    shapes: &'a [Shape],
    stock: &'a [Stock],
    copies: Vec<usize>,
}

impl Writer<'_> {
    fn used(&self, sheet: &NestedSheet) -> f64 {
        let shapes = sheet.placements.iter().map(|p| &self.shapes[p.shape]);
        shapes.map(|shape| net_area(&shape.outline, &shape.holes)).sum()
    }

    fn sheet(&self, index: usize, nested: &NestedSheet) -> Value {
        let stock = &self.stock[nested.stock];
        let id = sheet_id(index);
        let file = |format: FileFormat| format.path(SHEETS, &id);
        let placements = nested.placements.iter().map(|p| {
            let mut placement = json!({
                "part": self.shapes[p.shape].name,
                "copy": self.copies[p.shape],
                "x": mm(p.x),
                "y": mm(p.y),
                "angle_deg": degrees(p.angle),
            });
            if stock.locked.contains(p) {
                placement["locked"] = true.into();
            }
            placement
        });
        let mut sheet = json!({
            "id": id,
            "width": stock.width,
            "height": stock.height,
            "margin": stock.margin,
            "files": {"dxf": file(FileFormat::Dxf), "svg": file(FileFormat::Svg), "png": file(FileFormat::Png), "free": free_file(&id)},
            "cost": stock.cost,
            "utilisation": mm(self.used(nested) / stock.area()),
            "offcut": stock.remnant.is_none().then(|| self.offcut(nested)),
            "free": nest::leftovers(nested, self.shapes, stock)
                .iter()
                .map(|region| json!({
                    "area": mm(net_area(&region.outline, &region.holes)),
                    "outline": ring(&region.outline),
                    "holes": region.holes.iter().map(|hole| ring(hole)).collect::<Vec<_>>(),
                }))
                .collect::<Vec<_>>(),
            "placements": placements.collect::<Vec<_>>(),
        });
        if let Some(Remnant { outline, holes }) = &stock.remnant {
            sheet["outline"] = ring(outline).into();
            sheet["holes"] =
                holes.iter().map(|hole| ring(hole)).collect::<Vec<_>>().into();
        }
        sheet
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
        let exact =
            |ring: &Vec<Point2>| ring.iter().map(|p| [p.x, p.y]).collect::<Vec<_>>();
        let firsts = self.shapes.iter().zip(&self.copies).filter(|(_, copy)| **copy == 1);
        let part = |(shape, _): (&Shape, &usize)| {
            json!({
                "id": shape.name,
                "quantity": quantity[shape.name.as_str()],
                "priority": shape.priority,
                "rotations": match &shape.rotations {
                    Rotations::Free => json!("free"),
                    Rotations::Only(angles) => {
                        angles.iter().map(|&angle| degrees(angle)).collect::<Vec<_>>().into()
                    }
                },
                "outline": exact(&shape.outline),
                "holes": shape.holes.iter().map(exact).collect::<Vec<_>>(),
            })
        };
        firsts.map(part).collect()
    }
}

fn free_file(sheet: &str) -> String {
    format!("free/{sheet}.png")
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
        let mut strokes: Vec<Stroke> = Vec::new();
        for p in &nested.placements {
            let shape = &shapes[p.shape];
            let drawn = lines.get(&shape.name).cloned().unwrap_or_else(|| rings(shape));
            strokes.extend(drawn.into_iter().map(|(operation, path)| {
                let path = path.moved(|corner| placed(p, corner));
                Stroke { operation, part: p.shape.into(), path }
            }));
        }
        strokes.sort_by_key(|stroke| stroke.operation);
        let frame = border(&stock[nested.stock]);
        Sheet { id: sheet_id(index), width, height, strokes, frame }
    };
    layout.sheets.iter().enumerate().map(sheet).collect()
}

/// The edges of a sheet.
fn border(stock: &Stock) -> Vec<Path> {
    let closed =
        |ring: &Vec<Point2>| Path::Closed(Contour::polygon(ring.iter().copied()));
    if stock.remnant.is_some() {
        return stock.edges().map(closed).collect();
    }
    let (w, h) = (stock.width, stock.height);
    let corners = [(0.0, 0.0), (w, 0.0), (w, h), (0.0, h)];
    vec![closed(&corners.map(|(x, y)| Point2::new(x, y)).to_vec())]
}

/// Maps of the free space, and the paths of their pictures: what is free is tinted, parts
/// are only lines.
pub fn free_maps(
    shapes: &[Shape],
    stock: &[Stock],
    layout: &Layout,
    lines: &Lines,
) -> Vec<(String, Sheet)> {
    let sheets = layout_sheets(shapes, stock, layout, lines).into_iter();
    let map = |(mut sheet, nested): (Sheet, &NestedSheet)| {
        sheet.strokes.iter_mut().for_each(|stroke| stroke.operation = Operation::Score);
        let regions = nest::leftovers(nested, shapes, &stock[nested.stock]);
        for (part, Remnant { outline, holes }) in regions.iter().enumerate() {
            let edges = std::iter::once(outline).chain(holes);
            sheet.strokes.extend(edges.map(|ring| Stroke {
                operation: Operation::CutOuter,
                part: part.into(),
                path: Path::Closed(Contour::polygon(ring.iter().copied())),
            }));
        }
        (free_file(&sheet.id), sheet)
    };
    sheets.zip(&layout.sheets).map(map).collect()
}
