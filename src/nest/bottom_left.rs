//! One sheet filled bottom-left: parts are let down onto what lies there.
//!
//! The sheet is cut into columns. Of what lies on it only the upper profile counts; of a
//! part its lower and upper profile, over whole columns, so that rounding to columns
//! never lets two parts come too near. The lower profile is lowered by a disc of the
//! spacing.

use crate::geometry::{Motion, Point2, Rect};
use crate::nest::{NestedSheet, Placement, Shape, Stock, rotation};
use crate::tolerance::{EXACT_FIT_MM, PLACED_MM, SAME_COST_MM};

/// Width of a column, mm.
const COLUMN: f64 = 1.0;

/// A sheet with what lies on it.
#[derive(Debug, Clone)]
pub(super) struct OpenSheet {
    pub(super) stock: usize,
    pub(super) placements: Vec<Placement>,
    sheet: Stock,
    /// Height up to which each column is taken; minus infinity where nothing lies.
    profile: Vec<f64>,
}

/// A turned part over columns, its leftmost point at the left of the first column.
struct Profile {
    angle: f64,
    /// Of the turned part.
    left: f64,
    width: f64,
    lower: Vec<f64>,
    upper: Vec<f64>,
    /// The lower profile, lowered by the spacing; reaches `reach` columns further on both
    /// sides.
    lowered: Vec<f64>,
    reach: usize,
}

/// A place for a part and what it costs.
struct Position {
    cost: f64,
    turn: usize,
    column: usize,
    height: f64,
}

impl OpenSheet {
    pub(super) fn new(stock: usize, sheet: &Stock) -> Self {
        let columns = ((sheet.width - 2.0 * sheet.margin) / COLUMN).floor().max(0.0);
        let profile = vec![f64::NEG_INFINITY; columns as usize];
        Self { stock, placements: Vec::new(), sheet: sheet.clone(), profile }
    }

    pub(super) fn nested(self) -> NestedSheet {
        NestedSheet { stock: self.stock, placements: self.placements }
    }

    /// How high the sheet is filled, mm.
    pub(super) fn filled(&self) -> f64 {
        self.profile.iter().copied().fold(0.0, f64::max)
    }

    /// Lays a part where it costs least; `false` if it does not fit.
    pub(super) fn place(&mut self, index: usize, shape: &Shape) -> bool {
        let angles = rotation::good(&shape.outline, &shape.rotations, &self.sheet);
        let profiles: Vec<Profile> = angles
            .into_iter()
            .map(|angle| self.profile_of(&shape.outline, angle))
            .collect();
        let positions =
            profiles.iter().enumerate().filter_map(|(turn, p)| self.position(turn, p));
        let best =
            positions.min_by(|a, b| a.cost.total_cmp(&b.cost).then(a.turn.cmp(&b.turn)));
        let Some(position) = best else { return false };
        let profile = &profiles[position.turn];
        for (k, upper) in profile.upper.iter().enumerate() {
            let taken = &mut self.profile[position.column + k];
            *taken = taken.max(position.height + upper);
        }
        self.placements.push(Placement {
            shape: index,
            angle: profile.angle,
            x: up(self.sheet.margin + position.column as f64 * COLUMN - profile.left),
            y: up(position.height),
        });
        true
    }

    fn profile_of(&self, outline: &[Point2], angle: f64) -> Profile {
        Profile::new(outline, angle, self.sheet.spacing, self.profile.len())
    }

    /// The cheapest column for a turned part: low, and with little lost below it.
    fn position(&self, turn: usize, profile: &Profile) -> Option<Position> {
        let columns = profile.lower.len();
        let width = self.sheet.width - 2.0 * self.sheet.margin;
        let ceiling = self.sheet.height - self.sheet.margin + EXACT_FIT_MM;
        let floor = self.sheet.margin;
        let highest = profile.upper.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let lowest = profile.lower.iter().copied().fold(f64::INFINITY, f64::min);
        let mut best: Option<Position> = None;
        for column in 0..=self.profile.len().checked_sub(columns)? {
            if column as f64 * COLUMN + profile.width > width + EXACT_FIT_MM {
                break;
            }
            let height = self.rest(column, profile).max(floor - lowest);
            if height + highest > ceiling {
                continue;
            }
            let lost: f64 = (0..columns)
                .map(|k| {
                    let below = self.profile[column + k].max(floor);
                    height + profile.lower[k] - below
                })
                .sum();
            let cost = height + highest + lost / columns as f64;
            if best.as_ref().is_none_or(|best| cost < best.cost - SAME_COST_MM) {
                best = Some(Position { cost, turn, column, height });
            }
        }
        best
    }

    /// How high a part must be to clear what lies below it.
    fn rest(&self, column: usize, profile: &Profile) -> f64 {
        let first = column as isize - profile.reach as isize;
        let below = profile.lowered.iter().enumerate().filter_map(|(k, lowered)| {
            let column = usize::try_from(first + k as isize).ok()?;
            Some(self.profile.get(column)? - lowered)
        });
        below.fold(f64::NEG_INFINITY, f64::max)
    }
}

/// To 1e-6 mm as written in files, never down.
fn up(length: f64) -> f64 {
    (length * 1e6).ceil() / 1e6
}

impl Profile {
    /// The last of at most so many columns is as wide as it needs to be.
    fn new(outline: &[Point2], angle: f64, spacing: f64, most: usize) -> Self {
        let rotation = Motion::rotation(angle);
        let turned: Vec<Point2> = outline.iter().map(|&p| rotation.apply(p)).collect();
        let bounds = Rect::around(&turned);
        let (left, width) = (bounds.min.x, bounds.size().x);
        let columns = ((width / COLUMN).floor() as usize + 1).min(most.max(1));
        let mut lower = vec![f64::INFINITY; columns];
        let mut upper = vec![f64::NEG_INFINITY; columns];
        for (a, b) in turned.iter().zip(turned.iter().cycle().skip(1)) {
            let (a, b) = if a.x <= b.x { (a, b) } else { (b, a) };
            let column =
                |x: f64| (((x - left) / COLUMN).floor() as usize).min(columns - 1);
            for k in column(a.x)..=column(b.x) {
                let at = |x: f64| {
                    let share = if b.x > a.x { (x - a.x) / (b.x - a.x) } else { 0.0 };
                    a.y + (b.y - a.y) * share.clamp(0.0, 1.0)
                };
                let start = left + k as f64 * COLUMN;
                let end = if k + 1 < columns { start + COLUMN } else { b.x };
                let mut ends = vec![at(start.max(a.x)), at(end.min(b.x))];
                if b.x <= a.x {
                    ends.push(b.y);
                }
                for y in ends {
                    lower[k] = lower[k].min(y);
                    upper[k] = upper[k].max(y);
                }
            }
        }
        // The column that rounding may have missed by a hair.
        let spacing = spacing + PLACED_MM;
        let reach = (spacing / COLUMN).ceil() as usize + 1;
        let lowered = lowered(&lower, spacing, reach);
        Self { angle, left, width, lower, upper, lowered, reach }
    }
}

/// The profile lowered by a disc of radius `spacing`, conservatively over whole columns.
fn lowered(lower: &[f64], spacing: f64, reach: usize) -> Vec<f64> {
    let columns = lower.len();
    let drop = |apart: usize| {
        let gap = apart.saturating_sub(1) as f64 * COLUMN;
        (gap < spacing).then(|| (spacing * spacing - gap * gap).sqrt())
    };
    (0..columns + 2 * reach)
        .map(|k| {
            let own = k.saturating_sub(2 * reach)..=k.min(columns - 1);
            own.filter_map(|c| Some(lower[c] - drop((c + reach).abs_diff(k))?))
                .fold(f64::INFINITY, f64::min)
        })
        .collect()
}
