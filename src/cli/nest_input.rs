//! Parts and layouts from JSON (docs/nesting.md).

use crate::cli::nest_keys::{self, NestKeyError};
use crate::geometry::Point2;
use crate::nest::{
    self, Layout, NestError, NestedSheet, Placement, Remnant, Rotations, Shape, Stock,
};
use crate::report::Lines;
use miette::Diagnostic;
use serde::Deserialize;
use std::collections::BTreeMap;
use thiserror::Error;

/// Why a file is no parts and no layout.
#[derive(Debug, Error, Diagnostic)]
#[allow(missing_docs, reason = "the messages say it")]
pub(super) enum NestInputError {
    #[error("{name}: {source}")]
    #[diagnostic(
        code(read::not_parts),
        help("parts are a finwright-parts file or a strip-packing instance, as JSON")
    )]
    Json { name: String, source: serde_json::Error },

    #[error("{name}: {what}")]
    #[diagnostic(
        code(read::impossible_parts),
        help("see docs/nesting.md for the format")
    )]
    Bad { name: String, what: String },

    #[error(transparent)]
    #[diagnostic(transparent)]
    Key(#[from] NestKeyError),
}

/// What is asked for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Task {
    Sheets,
    Strip,
}

/// Parts and where they may go.
pub(super) struct Order {
    pub name: String,
    pub task: Task,
    /// What was drawn of each part, if it was not only corners.
    pub lines: Lines,
    /// One for each copy of a part.
    pub shapes: Vec<Shape>,
    pub stock: Vec<Stock>,
    pub holes_closed: bool,
    /// Of a layout.json that was read.
    pub layout: Layout,
}

type Ring = Vec<[f64; 2]>;

#[derive(Deserialize)]
struct File {
    name: Option<String>,
    spacing: Option<f64>,
    #[serde(default)]
    sheets: Vec<Sheet>,
    #[serde(default)]
    parts: Vec<Part>,
    strip_height: Option<f64>,
    #[serde(default)]
    items: Vec<Item>,
}

#[derive(Deserialize)]
struct Sheet {
    width: Option<f64>,
    height: Option<f64>,
    margin: Option<f64>,
    count: Option<usize>,
    cost: Option<f64>,
    /// Of a remnant.
    outline: Option<Ring>,
    #[serde(default)]
    holes: Vec<Ring>,
    #[serde(default)]
    placements: Vec<Placed>,
}

#[derive(Deserialize)]
struct Placed {
    part: String,
    copy: usize,
    x: f64,
    y: f64,
    angle_deg: f64,
}

#[derive(Deserialize)]
struct Part {
    id: String,
    #[serde(default = "one")]
    quantity: usize,
    outline: Ring,
    #[serde(default)]
    holes: Vec<Ring>,
    #[serde(default)]
    rotations: RotationsText,
    #[serde(default)]
    priority: i32,
}

const fn one() -> usize {
    1
}

#[derive(Deserialize, Default)]
#[serde(untagged)]
enum RotationsText {
    #[default]
    Free,
    Word(String),
    List(Vec<f64>),
}

#[derive(Deserialize)]
struct Item {
    id: serde_json::Value,
    #[serde(default = "one")]
    demand: usize,
    allowed_orientations: Option<Vec<f64>>,
    shape: ItemShape,
}

#[derive(Deserialize)]
#[serde(tag = "type", content = "data", rename_all = "snake_case")]
enum ItemShape {
    SimplePolygon(Ring),
    Polygon {
        outer: Ring,
        #[serde(default)]
        inner: Vec<Ring>,
    },
}

/// Most copies in one file: a typing error in a quantity should not fill the memory.
const MOST_COPIES: usize = 1_000_000;

/// Parts on sheets, or a strip.
///
/// # Errors
/// [`NestInputError`] if the text is neither.
pub(super) fn order(text: &str, name: &str) -> Result<Order, NestInputError> {
    let file = file(text, name)?;
    let bad =
        |what: &str| NestInputError::Bad { name: name.to_owned(), what: what.to_owned() };
    let (shapes, stock, task) = match file.strip_height {
        Some(height) if height > 0.0 => {
            let spacing = file.spacing.unwrap_or(0.0);
            let stock =
                Stock { count: Some(1), ..Stock::new([0.0, height], 0.0, spacing) };
            (file.items.iter().flat_map(Item::shapes).collect(), vec![stock], Task::Strip)
        }
        Some(_) => return Err(bad("strip_height must be larger than 0")),
        None => (
            file.parts.iter().flat_map(Part::shapes).collect(),
            file.stock_with_locked(name)?,
            Task::Sheets,
        ),
    };
    let shapes: Vec<Shape> = shapes;
    let fine = |s: &Stock| {
        let lengths = [s.width, s.height, s.margin, s.spacing];
        let fine = lengths.iter().all(|mm| (0.0..=1e6).contains(mm));
        fine && s.cost.is_finite() && s.cost >= 0.0
    };
    match () {
        () if shapes.is_empty() => Err(bad("there are no parts in it")),
        () if !stock.iter().all(fine) => {
            Err(bad("a sheet has an impossible size or cost"))
        }
        () => Ok(Order {
            name: file
                .name
                .filter(|name| is_folder_name(name))
                .unwrap_or(name.to_owned()),
            task,
            lines: Lines::new(),
            shapes,
            stock,
            holes_closed: false,
            layout: Layout::default(),
        }),
    }
}

/// A layout.json with the parts that lie on its sheets.
///
/// # Errors
/// [`NestInputError`] if the text is none.
pub(super) fn layout(text: &str, name: &str) -> Result<Order, NestInputError> {
    let file = file(text, name)?;
    let shapes: Vec<Shape> = file.parts.iter().flat_map(Part::shapes).collect();
    let mut layout = Layout::default();
    for (stock, placements) in file.placements(name)?.into_iter().enumerate() {
        layout.sheets.push(NestedSheet { stock, placements });
    }
    let stock = file.stock();
    let (name, task) = (name.to_owned(), Task::Sheets);
    let lines = Lines::new();
    Ok(Order { name, task, lines, shapes, stock, holes_closed: false, layout })
}

/// Refuses JSON among several files.
///
/// # Errors
/// [`NestInputError`] if there are several.
pub(super) fn only(names: &[String]) -> Result<(), NestInputError> {
    match names {
        [_] => Ok(()),
        _ => Err(NestInputError::Bad {
            name: names.join(", "),
            what: "several files must all be drawings (.dxf, .svg)".to_owned(),
        }),
    }
}

fn file(text: &str, name: &str) -> Result<File, NestInputError> {
    if let Some(fault) = nest_keys::fault(text) {
        return Err(fault.into());
    }
    let file: File = serde_json::from_str(text)
        .map_err(|source| NestInputError::Json { name: name.to_owned(), source })?;
    let copies =
        file.parts.iter().map(|p| p.quantity).chain(file.items.iter().map(|i| i.demand));
    match copies.fold(0_usize, usize::saturating_add) {
        count if count > MOST_COPIES => Err(NestInputError::Bad {
            name: name.to_owned(),
            what: format!("{count} copies are more than {MOST_COPIES}"),
        }),
        _ => Ok(file),
    }
}

fn is_folder_name(name: &str) -> bool {
    let fine = |c: char| c.is_alphanumeric() || "-_ ".contains(c);
    !name.trim().is_empty() && name.chars().all(fine)
}

impl File {
    fn stock(&self) -> Vec<Stock> {
        self.sheets.iter().map(|sheet| sheet.stock(self.spacing.unwrap_or(2.0))).collect()
    }

    /// The stock with what lies on it already.
    fn stock_with_locked(&self, name: &str) -> Result<Vec<Stock>, NestInputError> {
        let locked = self.placements(name)?;
        let with = |(stock, locked)| Stock { locked, ..stock };
        Ok(self.stock().into_iter().zip(locked).map(with).collect())
    }

    /// What lies on each sheet; every copy of a part only once.
    fn placements(&self, name: &str) -> Result<Vec<Vec<Placement>>, NestInputError> {
        let bad = |what: String| NestInputError::Bad { name: name.to_owned(), what };
        let copies =
            |p: &Part| (1..=p.quantity).map(|copy| (p.id.clone(), copy)).collect();
        let ids = self.parts.iter().flat_map::<Vec<_>, _>(copies);
        let mut index: BTreeMap<(String, usize), usize> = ids.zip(0..).collect();
        let mut all = Vec::new();
        for sheet in &self.sheets {
            let by = sheet.corner();
            let placement = |p: &Placed| {
                let (part, copy) = (&p.part, p.copy);
                let unknown =
                    || bad(format!("{part} copy {copy} is no part of it, or lies twice"));
                let shape = index.remove(&(part.clone(), copy)).ok_or_else(unknown)?;
                let (x, y) = (p.x - by[0], p.y - by[1]);
                Ok(Placement { shape, angle: p.angle_deg.to_radians(), x, y })
            };
            all.push(
                sheet
                    .placements
                    .iter()
                    .map(placement)
                    .collect::<Result<_, NestInputError>>()?,
            );
        }
        Ok(all)
    }
}

impl Sheet {
    /// The lower left corner of the rectangle around it, where coordinates begin.
    fn corner(&self) -> [f64; 2] {
        let points = self.outline.iter().flatten();
        let low = points
            .fold([f64::INFINITY; 2], |low, &[x, y]| [low[0].min(x), low[1].min(y)]);
        low.map(|mm| if mm.is_finite() { mm } else { 0.0 })
    }

    fn stock(&self, spacing: f64) -> Stock {
        let [left, low] = self.corner();
        let moved = |ring: &Ring, is_outer| -> Vec<Point2> {
            let ring: Ring = ring.iter().map(|&[x, y]| [x - left, y - low]).collect();
            points(&ring, is_outer)
        };
        let whole = || match (self.width, self.height) {
            (Some(w), Some(h)) if !self.holes.is_empty() => {
                Some(vec![[0.0, 0.0], [w, 0.0], [w, h], [0.0, h]])
            }
            _ => None,
        };
        let remnant = self.outline.clone().or_else(whole).map(|outline| Remnant {
            outline: moved(&outline, true),
            holes: self.holes.iter().map(|hole| moved(hole, false)).collect(),
        });
        let corners = || remnant.iter().flat_map(|remnant| &remnant.outline);
        let (right, top) =
            corners().fold((0.0, 0.0), |(x, y): (f64, f64), p| (x.max(p.x), y.max(p.y)));
        let size = [self.width.unwrap_or(right), self.height.unwrap_or(top)];
        let mut stock = Stock::new(size, self.margin.unwrap_or(5.0), spacing);
        (stock.count, stock.remnant) = (self.count, remnant);
        stock.cost = self.cost.unwrap_or(stock.area() / 1e6);
        stock
    }
}

impl Order {
    /// Takes out the parts that cannot be nested and says why.
    ///
    /// # Errors
    /// If one of them is locked.
    pub(super) fn refuse(&mut self) -> Result<Vec<NestError>, NestError> {
        let why: Vec<Option<NestError>> =
            self.shapes.iter().map(nest::outline_fault).collect();
        for locked in self.stock.iter_mut().flat_map(|stock| &mut stock.locked) {
            if let Some(error) = &why[locked.shape] {
                return Err(error.clone());
            }
            locked.shape -= why[..locked.shape].iter().flatten().count();
        }
        let mut is_fine = why.iter().map(Option::is_none);
        self.shapes.retain(|_| is_fine.next().unwrap_or(true));
        Ok(why.into_iter().flatten().collect())
    }
}

impl Part {
    fn shapes(&self) -> Vec<Shape> {
        let rotations = match &self.rotations {
            RotationsText::List(degrees) if !degrees.is_empty() => degrees_only(degrees),
            RotationsText::Word(word) if word == "locked" => degrees_only(&[0.0]),
            _ => Rotations::Free,
        };
        let rings = [&self.outline].into_iter().chain(&self.holes);
        let mut shapes = copies(&self.id, self.quantity, rings.collect(), rotations);
        shapes.iter_mut().for_each(|shape| shape.priority = self.priority);
        shapes
    }
}

impl Item {
    fn shapes(&self) -> Vec<Shape> {
        let rotations =
            self.allowed_orientations.as_deref().map_or(Rotations::Free, degrees_only);
        let rings = match &self.shape {
            ItemShape::SimplePolygon(ring) => vec![ring],
            ItemShape::Polygon { outer, inner } => {
                [outer].into_iter().chain(inner).collect()
            }
        };
        let id = self.id.as_str().map_or_else(|| self.id.to_string(), str::to_owned);
        copies(&id, self.demand, rings, rotations)
    }
}

fn degrees_only(degrees: &[f64]) -> Rotations {
    Rotations::Only(degrees.iter().map(|degrees| degrees.to_radians()).collect())
}

fn copies(id: &str, count: usize, rings: Vec<&Ring>, rotations: Rotations) -> Vec<Shape> {
    let mut rings = rings.into_iter().enumerate().map(|(k, ring)| points(ring, k == 0));
    let outline = rings.next().unwrap_or_default();
    let (name, holes, priority) = (id.to_owned(), rings.collect(), 0);
    let shape = Shape { name, outline, holes, rotations, priority };
    vec![shape; count]
}

/// Without repeated points; counter-clockwise as asked.
fn points(ring: &Ring, counter_clockwise: bool) -> Vec<Point2> {
    let mut points: Vec<Point2> = ring.iter().map(|&[x, y]| Point2::new(x, y)).collect();
    points.dedup();
    while points.len() > 1 && points.first() == points.last() {
        points.pop();
    }
    let next = points.iter().cycle().skip(1);
    let twice: f64 = points.iter().zip(next).map(|(a, b)| a.coords.perp(&b.coords)).sum();
    if (twice < 0.0) == counter_clockwise {
        points.reverse();
    }
    points
}
