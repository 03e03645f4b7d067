//! Sheets as rooms side by side, and the parts that may lie in them.

use crate::nest::crowd::{Crowd, Member};
use crate::nest::prepared::{Prepared, WALL, prepared};
use crate::nest::random::Random;
use crate::nest::turned::Bounds;
use crate::nest::{Layout, NestedSheet, Placement, Shape, Stock};

/// All that a crowd is made from.
pub(super) struct Yard<'a> {
    pub(super) stock: &'a [Stock],
    /// Index of each member's shape among those given.
    pub(super) parts: Vec<usize>,
    /// Parts, each once, then the walls of remnants.
    pub(super) shapes: Vec<Prepared>,
    /// What of `shapes` each part is.
    which: Vec<usize>,
    /// The wall of each kind of stock.
    walls: Vec<Option<usize>>,
    spacing: f64,
}

impl<'a> Yard<'a> {
    /// For some of the shapes; `None` if rings cross.
    pub(super) fn new(
        shapes: &[Shape],
        parts: Vec<usize>,
        stock: &'a [Stock],
    ) -> Option<Self> {
        let spacing = stock.iter().map(|s| s.spacing).fold(0.0, f64::max);
        let chosen: Vec<Shape> = parts.iter().map(|&k| shapes[k].clone()).collect();
        let (mut shapes, which) = prepared(&chosen, spacing)?;
        let mut walls = Vec::new();
        for remnant in stock.iter().map(|s| s.remnant.as_ref()) {
            walls.push(remnant.map(|_| shapes.len()));
            if let Some(remnant) = remnant {
                shapes.push(Prepared::wall(remnant)?);
            }
        }
        Some(Self { stock, parts, shapes, which, walls, spacing })
    }

    /// The left edge of each sheet in the crowd's coordinates, and the room on it.
    fn rooms(&self, sheets: &[usize]) -> Vec<(f64, Bounds)> {
        let apart = self.stock.iter().map(|s| 2.0 * s.spacing.max(s.margin));
        let apart = 2.0 * WALL + 1.0 + apart.fold(0.0, f64::max);
        let mut left = 0.0;
        let room = |&kind: &usize| {
            let Stock { width, height, margin, .. } = self.stock[kind];
            let room = [left + margin, margin, left + width - margin, height - margin];
            let here = left;
            left += width + apart;
            (here, room)
        };
        sheets.iter().map(room).collect()
    }

    /// A crowd on these sheets: walls and locked parts are in place, all others nowhere.
    pub(super) fn crowd(&self, sheets: &[usize], random: Random) -> Crowd<'_> {
        let part = |&shape: &usize| Member::part(shape, self.spacing);
        let mut members: Vec<Member> = self.which.iter().map(part).collect();
        let (lefts, rooms): (Vec<f64>, Vec<Bounds>) =
            self.rooms(sheets).into_iter().unzip();
        let mut places = Vec::new();
        for (&kind, &left) in sheets.iter().zip(&lefts) {
            for placement in &self.stock[kind].locked {
                if let Some(part) = self.member(placement.shape) {
                    members[part].fixed = true;
                    places.push((part, left, *placement));
                }
            }
            if let Some(wall) = self.walls[kind] {
                let still = Placement { shape: wall, angle: 0.0, x: 0.0, y: 0.0 };
                places.push((members.len(), left, still));
                members.push(Member::wall(wall, self.stock[kind].margin));
            }
        }
        let mut crowd = Crowd::new(&self.shapes, members, rooms, random);
        for (member, left, placement) in places {
            let shape = &self.shapes[crowd.members[member].shape];
            crowd.put(member, shape.pose(&placement, [left, 0.0]));
        }
        crowd
    }

    /// The member that is a shape.
    fn member(&self, shape: usize) -> Option<usize> {
        self.parts.binary_search(&shape).ok()
    }

    /// Puts parts where a layout has them, sheet after sheet in a room each.
    pub(super) fn put(&self, crowd: &mut Crowd, layout: &Layout) {
        let sheets: Vec<usize> = layout.sheets.iter().map(|s| s.stock).collect();
        for ((left, _), sheet) in self.rooms(&sheets).into_iter().zip(&layout.sheets) {
            for placement in &sheet.placements {
                if let Some(part) = self.member(placement.shape)
                    && !crowd.members[part].fixed
                {
                    let shape = &self.shapes[self.which[part]];
                    crowd.put(part, shape.pose(placement, [left, 0.0]));
                }
            }
        }
    }

    /// The layout that a crowd on these sheets is; locked parts as they were given.
    pub(super) fn layout(&self, crowd: &Crowd, sheets: &[usize]) -> Layout {
        let rooms = self.rooms(sheets);
        let mut nested: Vec<NestedSheet> = sheets
            .iter()
            .map(|&stock| {
                let placements = self.stock[stock].locked.clone();
                NestedSheet { stock, placements }
            })
            .collect();
        for (part, &index) in self.parts.iter().enumerate() {
            let Member { pose, shape, fixed, .. } = crowd.members[part];
            if fixed || pose.is_nowhere() {
                continue;
            }
            let room = crowd.room_at(pose.x);
            let placement =
                self.shapes[shape].placement(index, pose, [-rooms[room].0, 0.0]);
            nested[room].placements.push(placement);
        }
        nested.retain(|sheet| !sheet.placements.is_empty());
        Layout { sheets: nested }
    }
}
