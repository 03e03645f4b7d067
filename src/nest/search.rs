//! From a sound layout to a better one: what found no place is tried again, sheets are
//! exchanged for cheaper ones or emptied, and the last one is pressed together so that a
//! rectangle of it is left over.

use crate::nest::crowd::{Crowd, Pose};
use crate::nest::random::Random;
use crate::nest::separate::{Budget, UNIT};
use crate::nest::turned::Turned;
use crate::nest::yard::Yard;
use crate::nest::{Layout, Placement, Shape, Stock};
use crate::tolerance::ROOM_MM;

/// More parts than this are searched in groups: the crowd keeps a table of all pairs.
pub(super) const MOST_PARTS: usize = 1500;

/// A better layout of the given parts (in rising order), or `None`. Not checked yet.
pub(super) fn denser(
    layout: &Layout,
    parts: Vec<usize>,
    (shapes, stock): (&[Shape], &[Stock]),
    seed: u64,
    budget: &mut Budget,
) -> Option<Layout> {
    let sheets: Vec<usize> = layout.sheets.iter().map(|sheet| sheet.stock).collect();
    if sheets.is_empty() {
        return None;
    }
    let priorities = parts.iter().map(|&k| shapes[k].priority).collect();
    let yard = Yard::new(shapes, parts, stock)?;
    let mut crowd = yard.crowd(&sheets, Random::new(seed));
    crowd.work = budget.done * UNIT;
    yard.put(&mut crowd, layout);
    if crowd.total() > 0.0 && !crowd.separate(budget) {
        return None;
    }
    let mut search = Search { yard: &yard, crowd, sheets, priorities };
    search.run(shapes, budget);
    Some(yard.layout(&search.crowd, &search.sheets))
}

/// Units for each act of the first round.
const FIRST: u64 = 50;
/// Share of the material up to which other sheets are tried before the emptiest is pressed
/// together, and beyond which they are not tried at all.
const ROOMY: f64 = 0.62;
const FULLEST: f64 = 0.9;
/// Pressing gets so many times the units of an exchange.
const PRESSED: u64 = 4;

pub(super) struct Search<'a> {
    pub(super) yard: &'a Yard<'a>,
    pub(super) crowd: Crowd<'a>,
    /// Stock of each room.
    pub(super) sheets: Vec<usize>,
    /// Of each part.
    pub(super) priorities: Vec<i32>,
}

impl Search<'_> {
    fn run(&mut self, shapes: &[Shape], budget: &mut Budget) {
        self.take_in(budget);
        let mut units = FIRST;
        while !budget.over {
            let work = self.crowd.work;
            let (gained, cut) = self.improve(units, budget);
            if gained {
                let layout = self.yard.layout(&self.crowd, &self.sheets);
                budget.show(layout, shapes, self.yard.stock);
            }
            // Where nothing was cut short, more of the same would not help either; without an
            // evaluation the clock is not looked at.
            let idle = self.crowd.work == work;
            if idle || !(gained || cut || budget.is_endless()) {
                break;
            }
            units = if gained { units } else { units.saturating_mul(2) };
        }
    }

    /// Easy exchanges of sheets, then the emptiest sheet pressed together, and only when
    /// that gains nothing hard exchanges; whether there was a gain, and whether something
    /// was cut short.
    fn improve(&mut self, units: u64, budget: &mut Budget) -> (bool, bool) {
        let (exchanged, cut) = self.exchange(ROOMY, units, budget);
        let (pressed, too) =
            budget.within(PRESSED.saturating_mul(units), |budget| self.press(budget));
        if exchanged || pressed {
            return (true, cut || too);
        }
        let (exchanged, also) = self.exchange(FULLEST, units, budget);
        (exchanged, cut || too || also)
    }

    /// The emptiest sheet that is a bare rectangle.
    pub(super) fn emptiest(&self) -> Option<usize> {
        let plain = |room: &usize| self.yard.stock[self.sheets[*room]].is_plain();
        let plain = (0..self.sheets.len()).filter(plain).map(|k| (self.filled(k), k));
        plain.min_by(|a, b| a.0.total_cmp(&b.0).then(b.1.cmp(&a.1))).map(|(_, room)| room)
    }

    /// Presses the emptiest plain sheet together, into the others if need be, and gives it
    /// up once it is empty; `true` if more of it is free now.
    fn press(&mut self, budget: &mut Budget) -> bool {
        let Some(room) = self.emptiest().filter(|_| !budget.over) else { return false };
        let (before, whole) = (self.crowd.used(room), self.crowd.rooms[room]);
        self.crowd.compress(room, false, budget, &mut |_, _| ());
        let after = self.crowd.used(room);
        self.crowd.rooms[room] = whole;
        if self.filled(room) <= 0.0 {
            self.give_up(room);
        }
        after < before
    }

    /// Area of the parts in a room.
    pub(super) fn filled(&self, room: usize) -> f64 {
        let members = self.crowd.members.iter().filter(|m| !m.pose.is_nowhere());
        let inside = members.filter(|m| self.crowd.room_at(m.pose.x) == room);
        inside.map(|m| self.yard.shapes[m.shape].area).sum()
    }

    pub(super) fn area(&self, part: usize) -> f64 {
        self.yard.shapes[self.crowd.members[part].shape].area
    }

    /// Tries to find room for the parts that have none, by priority, then the small ones
    /// first: as many as can be. If need be, parts of lower priority make room.
    fn take_in(&mut self, budget: &mut Budget) {
        let count = self.priorities.len();
        let nowhere =
            |search: &Self, part: &usize| search.crowd.members[*part].pose.is_nowhere();
        let mut tried = vec![false; count];
        while !budget.over {
            let open = (0..count).filter(|part| !tried[*part] && nowhere(self, part));
            let next = open.max_by(|&a, &b| {
                let priority = self.priorities[a].cmp(&self.priorities[b]);
                priority.then(self.area(b).total_cmp(&self.area(a))).then(b.cmp(&a))
            });
            let Some(part) = next else { break };
            tried[part] = true;
            if self.squeeze_in(part, &[], budget) {
                continue;
            }
            let lower = self.lower_than(part);
            if !lower.is_empty() {
                self.squeeze_in(part, &lower, budget);
            }
        }
    }

    /// Parts that must make room for one of higher priority: the least important first, as
    /// much area as it needs.
    fn lower_than(&self, part: usize) -> Vec<usize> {
        let members = &self.crowd.members;
        let mut lower: Vec<usize> = (0..self.priorities.len()).collect();
        lower.retain(|&k| {
            let moves = !members[k].fixed && !members[k].pose.is_nowhere();
            moves && self.priorities[k] < self.priorities[part]
        });
        lower.sort_by_key(|&k| self.priorities[k]);
        let mut left = 1.5 * self.area(part);
        let needed = lower.iter().take_while(|&&k| {
            let more = left > 0.0;
            left -= self.area(k);
            more
        });
        let count = needed.count();
        lower.truncate(count);
        lower
    }

    /// Lets a part in, where some others are taken out for it.
    fn squeeze_in(&mut self, part: usize, others: &[usize], budget: &mut Budget) -> bool {
        let rooms: f64 = self.sheets.iter().map(|&k| self.yard.stock[k].area()).sum();
        let filled: f64 = (0..self.sheets.len()).map(|room| self.filled(room)).sum();
        let freed: f64 = others.iter().map(|&k| self.area(k)).sum();
        if filled - freed + self.area(part) > rooms {
            return false;
        }
        let before = self.crowd.poses();
        others.iter().for_each(|&other| self.crowd.take_out(other));
        let done = self.crowd.squeeze_in(part, budget);
        if !done {
            self.crowd.restore(&before);
        }
        done
    }
}

impl Crowd<'_> {
    /// Lets one more part in, where all can be separated again.
    pub(super) fn squeeze_in(&mut self, part: usize, budget: &mut Budget) -> bool {
        let before = self.poses();
        let done = self.drop_in(part) && self.separate(budget);
        if !done {
            self.restore(&before);
        }
        done
    }

    /// Puts a part where it overlaps least of some random places.
    pub(super) fn drop_in(&mut self, part: usize) -> bool {
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
    let (margin, stock) = (stock.margin, std::slice::from_ref(stock));
    let yard = Yard::new(shapes, (0..shapes.len()).collect(), stock)?;
    let mut crowd = yard.crowd(&[0], Random::new(seed));
    crowd.rooms[0][2] = margin;
    crowd.fill();
    if crowd.members.iter().any(|member| member.pose.is_nowhere()) {
        return None;
    }
    if crowd.total() <= 0.0 || crowd.separate(budget) {
        let mut shown = |crowd: &Crowd, budget: &mut Budget| {
            let stock =
                Stock { width: crowd.used(0) + margin + ROOM_MM, ..stock[0].clone() };
            budget.show(yard.layout(crowd, &[0]), shapes, &[stock]);
        };
        crowd.compress(0, budget.is_endless(), budget, &mut shown);
    }
    let layout = yard.layout(&crowd, &[0]);
    let placements = layout.sheets.into_iter().flat_map(|sheet| sheet.placements);
    Some((placements.collect(), crowd.used(0) + margin))
}
