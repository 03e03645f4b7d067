//! What is seen of a nest while it is searched: how many sheets, how full, and a picture.

use crate::cli::console::Terminal;
use crate::cli::nest_input::Order;
use crate::export::{self, PngLook};
use crate::geometry::Vector2;
use crate::nest::{Layout, Shape, Stock};
use crate::report::{Lines, layout_sheets};
use crate::sheets::{Sheet, Stroke};
use crate::watch::Watch;
use std::any::Any;
use std::path::{Path, PathBuf};

/// Between two sheets in the picture, mm.
const APART: f64 = 20.0;

/// The first Ctrl-C ends the search, which then gives the best so far; so does the last of
/// the units that were asked for.
pub(super) struct Progress {
    pub(super) terminal: Terminal,
    units: Option<usize>,
    done: usize,
    snapshot: Option<Snapshot>,
}

/// A picture of the best layout so far.
struct Snapshot {
    path: PathBuf,
    shapes: Vec<Shape>,
    stock: Vec<Stock>,
    lines: Lines,
    /// Why the last one could not be written.
    failure: Option<String>,
}

impl Progress {
    pub(super) fn new(
        terminal: Terminal,
        units: Option<usize>,
        snapshot: Option<&Path>,
        order: &Order,
    ) -> Self {
        let snapshot = snapshot.map(|path| Snapshot {
            path: path.to_owned(),
            shapes: order.shapes.clone(),
            stock: order.stock.clone(),
            lines: order.lines.clone(),
            failure: None,
        });
        Self { terminal, units, done: 0, snapshot }
    }

    /// Why there is no picture of the last layout.
    pub(super) fn failure(&self) -> Option<&str> {
        self.snapshot.as_ref()?.failure.as_deref()
    }
}

impl Watch for Progress {
    fn progress(&mut self, stage: &'static str, done: usize, total: usize) {
        self.done = done;
        self.terminal.progress(stage, done, self.units.unwrap_or(total));
    }

    fn stopped(&self) -> bool {
        false
    }

    fn threads(&self) -> usize {
        self.terminal.threads()
    }

    fn enough(&self) -> bool {
        let is_full = self.units.is_some_and(|units| self.done >= units);
        is_full || self.terminal.enough() || self.terminal.stopped()
    }

    fn better(&mut self, found: &dyn Any) {
        let Some((layout, filled)) = found.downcast_ref::<(Layout, f64)>() else {
            return;
        };
        let sheets = layout.sheets.len();
        self.terminal.note(&format!("{sheets} sheet(s), {:.1} % filled", 100.0 * filled));
        if let Some(snapshot) = &mut self.snapshot {
            let written = snapshot.write(layout);
            snapshot.failure = written.err();
        }
    }
}

impl Snapshot {
    /// As a whole or not at all, so that a viewer never sees half of it.
    fn write(&self, layout: &Layout) -> Result<(), String> {
        let sheets = layout_sheets(&self.shapes, &self.stock, layout, &self.lines);
        let look = PngLook { px_per_mm: 1.0, ..PngLook::default() };
        let bytes =
            export::png(&side_by_side(&sheets), &look).map_err(|e| e.to_string())?;
        let place = |error: std::io::Error| format!("{}: {error}", self.path.display());
        let part = self.path.with_extension("part");
        std::fs::write(&part, bytes).map_err(place)?;
        std::fs::rename(&part, &self.path).map_err(place)
    }
}

/// All sheets on one, in about as many rows as columns.
fn side_by_side(sheets: &[Sheet]) -> Sheet {
    let columns = (sheets.len() as f64).sqrt().ceil().max(1.0) as usize;
    let [mut width, mut height] = [0.0_f64; 2];
    let (mut strokes, mut frame) = (Vec::new(), Vec::new());
    for row in sheets.chunks(columns) {
        let mut by = Vector2::new(0.0, height);
        for sheet in row {
            strokes.extend(sheet.strokes.iter().map(|stroke| {
                let path = stroke.path.moved(|p| p + by);
                Stroke { path, ..stroke.clone() }
            }));
            frame.extend(sheet.frame.iter().map(|path| path.moved(|p| p + by)));
            by.x += sheet.width + APART;
            width = width.max(by.x - APART);
            height = height.max(by.y + sheet.height);
        }
        height += APART;
    }
    let id = "snapshot".into();
    Sheet { id, width, height: (height - APART).max(0.0), strokes, frame }
}
