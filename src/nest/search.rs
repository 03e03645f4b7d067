//! From a sound layout to a denser one: sheets are emptied, and the last one is pressed
//! together so that a rectangle of it is left over.

use crate::nest::crowd::{Crowd, Pose, Prepared, prepared};
use crate::nest::separate::Budget;
use crate::nest::turned::{Bounds, Turned};
use crate::nest::{Layout, NestedSheet, Placement, Shape, Stock};

/// More parts than this are left as they are: the search keeps a table of all pairs.
pub(super) const MOST_PARTS: usize = 1500;
/// Attempts to do without a sheet.
const ATTEMPTS: usize = 2;

/// The sheets of a layout as rooms side by side.
fn rooms(sheets: &[usize], stock: &[Stock]) -> Vec<Bounds> {
    let mut left = 0.0;
    let apart = stock.iter().map(|s| 2.0 * s.spacing + 1.0).fold(0.0, f64::max);
    sheets
        .iter()
        .map(|&kind| {
            let s = &stock[kind];
            let room = [
                left + s.margin,
                s.margin,
                left + s.width - s.margin,
                s.height - s.margin,
            ];
            left += s.width + apart;
            room
        })
        .collect()
}

/// A denser layout of the same parts, or the same one. Not checked yet.
pub(super) fn denser(
    layout: &Layout,
    shapes: &[Shape],
    stock: &[Stock],
    seed: u64,
    budget: &mut Budget,
) -> Option<Layout> {
    let spacing = stock.iter().map(|s| s.spacing).fold(0.0, f64::max);
    let sheets: Vec<usize> = layout.sheets.iter().map(|sheet| sheet.stock).collect();
    let rooms = rooms(&sheets, stock);
    let shapes_used = layout.sheets.iter().flat_map(|s| &s.placements).map(|p| p.shape);
    let used: Vec<usize> = shapes_used.collect();
    if used.len() != shapes.len() || used.len() > MOST_PARTS || sheets.is_empty() {
        return None;
    }
    let prepared = prepared(shapes, spacing).ok()?;
    let mut crowd = Crowd::new(&prepared, rooms, spacing, seed);
    for (room, sheet) in layout.sheets.iter().enumerate() {
        for placement in &sheet.placements {
            let pose = crowd.pose(placement, room, [stock[sheet.stock].margin; 2]);
            crowd.put(placement.shape, pose);
        }
    }
    let mut search = Search { crowd, sheets, stock, shapes: &prepared };
    if search.crowd.total() > 0.0 && !search.crowd.separate(budget) {
        return None;
    }
    search.run(budget);
    Some(search.layout())
}

struct Search<'a> {
    crowd: Crowd<'a>,
    /// Stock of each room.
    sheets: Vec<usize>,
    stock: &'a [Stock],
    shapes: &'a [Prepared],
}

impl Search<'_> {
    fn run(&mut self, budget: &mut Budget) {
        while !budget.over && self.sheets.len() > 1 && self.can_spare() {
            if !(0..ATTEMPTS).any(|k| self.without_one(k, budget)) {
                break;
            }
        }
        while !budget.over && self.smaller(budget) {}
        if !budget.over {
            let last = self.emptiest(0);
            self.crowd.compress(last, budget);
        }
    }

    /// Whether the parts' area leaves a chance to do with one sheet less.
    fn can_spare(&self) -> bool {
        let area = |r: &Bounds| (r[2] - r[0]) * (r[3] - r[1]);
        let rooms: Vec<f64> = self.crowd.rooms.iter().map(area).collect();
        let least = rooms.iter().copied().fold(f64::INFINITY, f64::min);
        let parts: f64 = self.shapes.iter().map(|shape| shape.area).sum();
        parts < 0.9 * (rooms.iter().sum::<f64>() - least)
    }

    /// Area of the parts in a room.
    fn filled(&self, room: usize) -> f64 {
        let members = self.crowd.members.iter();
        let inside = members.filter(|m| self.crowd.room_at(m.pose.x) == room);
        inside.map(|m| self.shapes[m.shape].area).sum()
    }

    /// The emptiest room, or one of the next.
    fn emptiest(&self, rank: usize) -> usize {
        let mut order: Vec<usize> = (0..self.sheets.len()).collect();
        order.sort_by(|&a, &b| self.filled(a).total_cmp(&self.filled(b)).then(b.cmp(&a)));
        order[rank.min(order.len() - 1)]
    }

    /// Does without a sheet: its parts go where they overlap least, then all are separated.
    fn without_one(&mut self, rank: usize, budget: &mut Budget) -> bool {
        let gone = self.emptiest(rank);
        let mut sheets = self.sheets.clone();
        sheets.remove(gone);
        self.with_sheets(
            sheets,
            |room| (room != gone).then_some(room - usize::from(room > gone)),
            budget,
        )
    }

    /// Tries a cheaper size for one of the sheets.
    fn smaller(&mut self, budget: &mut Budget) -> bool {
        let area = |kind: usize| self.stock[kind].width * self.stock[kind].height;
        for room in 0..self.sheets.len() {
            let now = self.sheets[room];
            let mut kinds: Vec<usize> = (0..self.stock.len()).collect();
            kinds.retain(|&kind| {
                let used = self.sheets.iter().filter(|&&other| other == kind).count();
                let left = self.stock[kind].count.is_none_or(|count| used < count);
                let most = 0.9 * area(kind);
                left && area(kind) < area(now) && self.filled(room) < most
            });
            kinds.sort_by(|&a, &b| area(a).total_cmp(&area(b)).then(a.cmp(&b)));
            for kind in kinds {
                let mut sheets = self.sheets.clone();
                sheets[room] = kind;
                if self.with_sheets(
                    sheets,
                    |other| (other != room).then_some(other),
                    budget,
                ) {
                    return true;
                }
                if budget.over {
                    return false;
                }
            }
        }
        false
    }

    /// Goes over to other sheets; `keep` says in which new room the parts of an old one
    /// stay as they are. If they cannot all be separated, everything is as before.
    fn with_sheets(
        &mut self,
        sheets: Vec<usize>,
        keep: impl Fn(usize) -> Option<usize>,
        budget: &mut Budget,
    ) -> bool {
        let before = (self.crowd.rooms.clone(), self.crowd.poses());
        let new = rooms(&sheets, self.stock);
        let at: Vec<usize> =
            before.1.iter().map(|pose| self.crowd.room_at(pose.x)).collect();
        self.crowd.rooms.clone_from(&new);
        let mut homeless = Vec::new();
        for (part, pose) in before.1.iter().enumerate() {
            let (old, kept) = (before.0[at[part]], keep(at[part]).map(|room| new[room]));
            match kept {
                Some(room) => {
                    let x = pose.x + room[0] - old[0];
                    self.crowd.put(part, Pose { x, ..*pose });
                }
                None => homeless.push(part),
            }
        }
        let mut placed = true;
        for part in homeless {
            placed &= self.crowd.drop_in(part);
        }
        if placed && self.crowd.separate(budget) {
            self.sheets = sheets;
            return true;
        }
        self.crowd.rooms = before.0;
        self.crowd.restore(&before.1);
        false
    }

    fn layout(&self) -> Layout {
        let mut sheets: Vec<NestedSheet> = self
            .sheets
            .iter()
            .map(|&stock| NestedSheet { stock, placements: Vec::new() })
            .collect();
        for (part, member) in self.crowd.members.iter().enumerate() {
            let room = self.crowd.room_at(member.pose.x);
            let corner = [self.stock[self.sheets[room]].margin; 2];
            let placement: Placement = self.crowd.placement(part, member.pose, corner);
            sheets[room].placements.push(placement);
        }
        sheets.retain(|sheet| !sheet.placements.is_empty());
        Layout { sheets }
    }
}

impl Crowd<'_> {
    /// Puts a part where it overlaps least of some random places.
    fn drop_in(&mut self, part: usize) -> bool {
        let mut scratch = Turned::default();
        scratch.angle = f64::NAN;
        let mut best: Option<(f64, Pose)> = None;
        for _ in 0..200 {
            let Some(pose) = self.anywhere(part, &mut scratch) else { continue };
            let bound = best.map_or(f64::INFINITY, |(cost, _)| cost);
            let cost = self.cost(part, &scratch, pose, bound);
            if cost < bound {
                best = Some((cost, pose));
            }
        }
        if let Some((_, pose)) = best {
            self.put(part, pose);
        }
        best.is_some()
    }
}

/// Parts in a strip of fixed height, as short as the budget allows: the placements and the
/// length, margin included at both ends. `None` if a part does not fit or its rings cross.
pub(super) fn strip(
    shapes: &[Shape],
    stock: &Stock,
    seed: u64,
    budget: &mut Budget,
) -> Option<(Vec<Placement>, f64)> {
    let prepared = prepared(shapes, stock.spacing).ok()?;
    let margin = stock.margin;
    let room = [margin, margin, f64::INFINITY, stock.height - margin];
    let mut crowd = Crowd::new(&prepared, vec![room], stock.spacing, seed);
    crowd.rooms[0][2] = margin;
    crowd.fill();
    if crowd.members.iter().any(|member| member.turned.is_empty()) {
        return None;
    }
    if crowd.total() <= 0.0 || crowd.separate(budget) {
        crowd.compress(0, budget);
    }
    let members = crowd.members.iter().enumerate();
    let placements = members.map(|(part, m)| crowd.placement(part, m.pose, [margin; 2]));
    Some((placements.collect(), crowd.used(0) + margin))
}
