//! What stands on the edge of a sheet: its border, what it is, and a bar to measure.

use crate::geometry::{Contour, Point2, Vector2};
use crate::lettering::{letter, width};
use crate::nest::Stock;
use crate::sheets::sheet::Path;

/// The text of a frame.
#[derive(Debug, Clone, PartialEq)]
pub struct Frame {
    /// Name of the job.
    pub job: String,
    /// What the sheet is made of.
    pub material: String,
    /// Whether and how the kerf is in the drawing, and whatever else must be said.
    pub notes: Vec<String>,
}

/// Length of the bar, mm.
const BAR: f64 = 50.0;

impl Frame {
    /// The border, the lettering in the lower margin and the bar.
    pub fn paths(&self, stock: &Stock, index: usize, count: usize) -> Vec<Path> {
        let corners = [
            (0.0, 0.0),
            (stock.width, 0.0),
            (stock.width, stock.height),
            (0.0, stock.height),
        ];
        let border = Contour::polygon(corners.map(|(x, y)| Point2::new(x, y)));
        let mut paths = vec![Path::Closed(border)];
        let cap = (0.6 * stock.margin).min(3.0);
        let base = 0.3 * stock.margin.min(5.0);
        let room = stock.width - 2.0 * stock.margin;
        if cap < 0.5 || room < BAR {
            return paths;
        }
        let bar = bar(Point2::new(stock.width - stock.margin - BAR, base), cap);
        paths.extend(bar);
        let label = format!("{BAR} mm");
        let label_width = width(&label, cap).expect("the font has these");
        let label_at = stock.width - stock.margin - BAR - label_width - cap;
        paths.extend(written(&label, cap, Point2::new(label_at, base)));
        let text = self.text(stock, index, count);
        let free = label_at - stock.margin - cap;
        let long = width(&text, cap).expect("the text is legible");
        let cap = if long > free { cap * free / long } else { cap };
        if cap >= 0.5 {
            paths.extend(written(&text, cap, Point2::new(stock.margin, base)));
        }
        paths
    }

    fn text(&self, stock: &Stock, index: usize, count: usize) -> String {
        let sheet = format!("sheet {}/{count}", index + 1);
        let size = format!("{} x {} mm", stock.width, stock.height);
        let fields = [self.job.clone(), sheet, self.material.clone(), size];
        let all: Vec<String> = fields.into_iter().chain(self.notes.clone()).collect();
        crate::lettering::legible(&all.join("  |  ")).0
    }
}

/// A horizontal line with a tick at each end.
fn bar(at: Point2, height: f64) -> Vec<Path> {
    let up = Vector2::new(0.0, height);
    let end = at + Vector2::new(BAR, 0.0);
    vec![Path::Open(vec![at + up, at, end, end + up])]
}

fn written(text: &str, cap: f64, at: Point2) -> Vec<Path> {
    let strokes = letter(text, cap).expect("the text is legible").strokes;
    let moved = |stroke: Vec<Point2>| stroke.iter().map(|p| at + p.coords).collect();
    strokes.into_iter().map(|stroke| Path::Open(moved(stroke))).collect()
}
