//! Sheets as bins side by side, and the parts that may lie in them.

use crate::geometry::{Point2, Rect};
use crate::nest::collision_shape::{CollisionShape, WALL, collision_shapes};
use crate::nest::random::Random;
use crate::nest::state::{Item, OverlapState};
use crate::nest::{Layout, NestedSheet, Placement, Shape, Stock};

/// All that a state is made from.
pub(super) struct Instance<'a> {
    pub(super) stock: &'a [Stock],
    /// Index of each item's shape among those given.
    pub(super) parts: Vec<usize>,
    /// Parts, each once, then the walls of remnants.
    pub(super) shapes: Vec<CollisionShape>,
    /// What of `shapes` each part is.
    which: Vec<usize>,
    /// The wall of each kind of stock.
    walls: Vec<Option<usize>>,
    spacing: f64,
}

impl<'a> Instance<'a> {
    /// For some of the shapes; `None` if rings cross.
    pub(super) fn new(
        shapes: &[Shape],
        parts: Vec<usize>,
        stock: &'a [Stock],
    ) -> Option<Self> {
        let spacing = stock.iter().map(|s| s.spacing).fold(0.0, f64::max);
        let chosen: Vec<Shape> = parts.iter().map(|&k| shapes[k].clone()).collect();
        let (mut shapes, which) = collision_shapes(&chosen, spacing)?;
        let mut walls = Vec::new();
        for remnant in stock.iter().map(|s| s.remnant.as_ref()) {
            walls.push(remnant.map(|_| shapes.len()));
            if let Some(remnant) = remnant {
                shapes.push(CollisionShape::wall(remnant)?);
            }
        }
        Some(Self { stock, parts, shapes, which, walls, spacing })
    }

    /// The left edge of each sheet in the state's coordinates, and the bin on it.
    fn bins(&self, sheets: &[usize]) -> Vec<(f64, Rect)> {
        let apart = self.stock.iter().map(|s| 2.0 * s.spacing.max(s.margin));
        let apart = 2.0 * WALL + 1.0 + apart.fold(0.0, f64::max);
        let mut left = 0.0;
        let bin = |&kind: &usize| {
            let Stock { width, height, margin, .. } = self.stock[kind];
            let (min, max) = (
                Point2::new(left + margin, margin),
                Point2::new(left + width - margin, height - margin),
            );
            let here = left;
            left += width + apart;
            (here, Rect { min, max })
        };
        sheets.iter().map(bin).collect()
    }

    /// A state on these sheets: walls and locked parts are in place, all others nowhere.
    pub(super) fn state(&self, sheets: &[usize], random: Random) -> OverlapState<'_> {
        let part = |&shape: &usize| Item::part(shape, self.spacing);
        let mut items: Vec<Item> = self.which.iter().map(part).collect();
        let (lefts, bins): (Vec<f64>, Vec<Rect>) = self.bins(sheets).into_iter().unzip();
        let mut places = Vec::new();
        for (&kind, &left) in sheets.iter().zip(&lefts) {
            for placement in &self.stock[kind].locked {
                if let Some(part) = self.item(placement.shape) {
                    items[part].fixed = true;
                    places.push((part, left, *placement));
                }
            }
            if let Some(wall) = self.walls[kind] {
                let still = Placement { shape: wall, angle: 0.0, x: 0.0, y: 0.0 };
                places.push((items.len(), left, still));
                items.push(Item::wall(wall, self.stock[kind].margin));
            }
        }
        let mut state = OverlapState::new(&self.shapes, items, bins, random);
        for (item, left, placement) in places {
            let shape = &self.shapes[state.items[item].shape];
            state.put(item, shape.pose(&placement, [left, 0.0]));
        }
        state
    }

    /// The item that is a shape.
    fn item(&self, shape: usize) -> Option<usize> {
        self.parts.binary_search(&shape).ok()
    }

    /// Puts parts where a layout has them, sheet after sheet in a bin each.
    pub(super) fn put(&self, state: &mut OverlapState, layout: &Layout) {
        let sheets: Vec<usize> = layout.sheets.iter().map(|s| s.stock).collect();
        for ((left, _), sheet) in self.bins(&sheets).into_iter().zip(&layout.sheets) {
            for placement in &sheet.placements {
                if let Some(part) = self.item(placement.shape)
                    && !state.items[part].fixed
                {
                    let shape = &self.shapes[self.which[part]];
                    state.put(part, shape.pose(placement, [left, 0.0]));
                }
            }
        }
    }

    /// The layout that a state on these sheets is; locked parts as they were given.
    pub(super) fn layout(&self, state: &OverlapState, sheets: &[usize]) -> Layout {
        let bins = self.bins(sheets);
        let mut nested: Vec<NestedSheet> = sheets
            .iter()
            .map(|&stock| {
                let placements = self.stock[stock].locked.clone();
                NestedSheet { stock, placements }
            })
            .collect();
        for (part, &index) in self.parts.iter().enumerate() {
            let Item { pose, shape, fixed, .. } = state.items[part];
            if fixed || pose.is_nowhere() {
                continue;
            }
            let bin = state.bin_at(pose.x);
            let placement =
                self.shapes[shape].placement(index, pose, [-bins[bin].0, 0.0]);
            nested[bin].placements.push(placement);
        }
        nested.retain(|sheet| !sheet.placements.is_empty());
        Layout { sheets: nested }
    }
}
