//! Parts on sheets of stock.
//!
//! The caller gives shapes and stock and gets a [`Layout`] that has passed the exact
//! [`check`]; how it is found is this module's own business. First parts are laid bottom-left for a
//! sound layout (`initial`). Then parts are let overlap and separated again on fewer or
//! smaller sheets (`search`), and the emptiest sheet is compacted so that a
//! rectangle of it is left over. Work is counted in evaluations, never in seconds.

mod bin_exchange;
mod bottom_left;
mod budget;
mod check;
mod collision_shape;
mod compaction;
mod convex;
mod convex_decomposition;
mod error;
mod groups;
mod hole_filling;
mod initial;
mod instance;
mod interlock;
mod leftover;
mod outline;
mod random;
mod rotation;
mod search;
mod separation;
mod state;
mod stock;
mod triangulation;

pub use check::{LayoutFault, check};
pub use error::NestError;
pub use leftover::leftovers;
pub use outline::{outline_fault, stock_fault, without_loops};
pub use rotation::fits;
pub use stock::{Remnant, Stock};

use crate::geometry::{Motion, Point2, Vector2};
use crate::tolerance::{ROOM_MM, WRITTEN_MM};
use crate::watch::Watch;
use budget::Budget;

/// A part as the nester sees it.
#[derive(Debug, Clone, PartialEq)]
pub struct Shape {
    /// Name for messages.
    pub name: String,
    /// The curve that must keep its distance (the drawn cut line, arcs flattened),
    /// counter-clockwise, mm.
    pub outline: Vec<Point2>,
    /// Holes in it, in which other parts may lie.
    pub holes: Vec<Vec<Point2>>,
    /// By which angles it may be rotated.
    pub rotations: Rotations,
    /// Parts of higher priority are placed first when there is not room for all.
    pub priority: i32,
}

/// How a part may be rotated on the sheet.
#[derive(Debug, Clone, PartialEq)]
pub enum Rotations {
    /// By any angle.
    Free,
    /// Only by these angles, radians.
    Only(Vec<f64>),
}

/// Where a part lies: rotated about its origin, then moved.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Placement {
    /// Index into the shapes given.
    pub shape: usize,
    /// Counter-clockwise turn, radians; a multiple of 1e-7 degrees.
    pub angle: f64,
    /// Then moved right, mm; a multiple of 1e-6.
    pub x: f64,
    /// Then moved up, mm; a multiple of 1e-6.
    pub y: f64,
}

impl Placement {
    /// From the part's coordinates to the sheet's.
    pub fn motion(&self) -> Motion {
        Motion::new(self.angle, Vector2::new(self.x, self.y))
    }
}

/// One sheet of a layout.
#[derive(Debug, Clone, PartialEq)]
pub struct NestedSheet {
    /// Index into the stock given.
    pub stock: usize,
    /// What lies on it.
    pub placements: Vec<Placement>,
}

/// All parts on sheets.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Layout {
    /// In order of cutting.
    pub sheets: Vec<NestedSheet>,
}

/// How hard to search, counted in work, not time: the same effort gives the same layout on
/// every machine.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Effort {
    /// Units of work, 20,000 evaluations each; 1 is the first
    /// layout without any search; `u32::MAX` until the watch has enough. A search that is
    /// given a number ends before it when nothing gets better any more.
    pub trials: u32,
    /// Start of the random numbers.
    pub seed: u64,
}

/// What a search found.
#[derive(Debug, Clone, PartialEq)]
pub struct Solution {
    /// Sound: it has passed the check.
    pub layout: Layout,
    /// What could not be placed, and why.
    pub unplaced: Vec<NestError>,
    /// Trials that give the same result again ([`Effort::trials`]).
    pub trials: u32,
}

/// Parts in a strip of fixed height.
#[derive(Debug, Clone, PartialEq)]
pub struct PackedStrip {
    /// Where the parts lie, on one sheet as long as the strip.
    pub layout: Layout,
    /// Length of the strip, margin included, mm.
    pub length: f64,
    /// Trials that give the same result again.
    pub trials: u32,
}

/// Lays all shapes on sheets of the stock; earlier entries of the stock are opened first,
/// and a sheet whose parts fit a smaller size becomes one.
///
/// # Errors
/// [`NestError`] names a shape that fits no sheet, what is left when the stock is used up,
/// or that the watch stopped the search before there was a layout.
/// ```
/// use finwright::geometry::Point2;
/// use finwright::nest::{Effort, Rotations, Shape, Stock, nest};
///
/// let square = [(0.0, 0.0), (50.0, 0.0), (50.0, 50.0), (0.0, 50.0)];
/// let shape = |name: &str| Shape {
///     name: name.to_owned(),
///     outline: square.map(|(x, y)| Point2::new(x, y)).to_vec(),
///     holes: Vec::new(),
///     rotations: Rotations::Free,
///     priority: 0,
/// };
/// let stock = Stock::new([120.0, 60.0], 2.0, 2.0);
/// let effort = Effort { trials: 1, seed: 0 };
/// let layout = nest(&[shape("a"), shape("b")], &[stock], &effort, &mut ()).unwrap();
/// assert_eq!(layout.sheets.len(), 1);
/// ```
pub fn nest(
    shapes: &[Shape],
    stock: &[Stock],
    effort: &Effort,
    watch: &mut dyn Watch,
) -> Result<Layout, NestError> {
    let found = search(shapes, stock, effort, watch)?;
    match found.unplaced.into_iter().next() {
        Some(error) => Err(error),
        None => Ok(watch.unless_stopped().map(|()| found.layout)?),
    }
}

/// As [`nest`], but lays what can be laid and says what cannot.
///
/// # Errors
/// [`NestError::Stopped`] before there was a layout; [`NestError::Unsound`] if none passed
/// the check.
pub fn search(
    shapes: &[Shape],
    stock: &[Stock],
    effort: &Effort,
    watch: &mut dyn Watch,
) -> Result<Solution, NestError> {
    if let Some(error) = stock_fault(shapes, stock) {
        return Err(error);
    }
    let initial = initial::initial_layout(shapes, stock, effort, watch)?;
    if effort.trials <= 1 {
        let unplaced = unplaced(&initial, shapes, stock);
        return Ok(Solution { layout: initial, unplaced, trials: 1 });
    }
    let mut budget = budget(effort, watch);
    budget.show(initial.clone(), shapes, stock);
    let parts = (0..shapes.len()).filter(|&k| fits_any(&shapes[k], stock)).collect();
    let denser =
        groups::denser(&initial, parts, (shapes, stock), effort.seed, &mut budget);
    let trials = trials(&budget);
    let sound = |layout: &Layout| check(layout, shapes, stock).is_empty();
    let layout = denser.filter(sound).unwrap_or(initial);
    let unplaced = unplaced(&layout, shapes, stock);
    Ok(Solution { layout, unplaced, trials })
}

fn fits_any(shape: &Shape, stock: &[Stock]) -> bool {
    stock.iter().any(|sheet| fits(&shape.outline, &shape.rotations, sheet).is_some())
}

/// Why each part that is on no sheet is on none.
fn unplaced(layout: &Layout, shapes: &[Shape], stock: &[Stock]) -> Vec<NestError> {
    let mut is_on = vec![false; shapes.len()];
    let on = layout.sheets.iter().flat_map(|sheet| &sheet.placements);
    on.for_each(|placement| is_on[placement.shape] = true);
    let (large, left): (Vec<&Shape>, Vec<&Shape>) = shapes
        .iter()
        .zip(&is_on)
        .filter(|(_, is_on)| !**is_on)
        .map(|(shape, _)| shape)
        .partition(|shape| !fits_any(shape, stock));
    let large = large.into_iter().map(|shape| NestError::too_large(shape, stock));
    large.chain(left.into_iter().map(NestError::used_up)).collect()
}

/// Packs all shapes into a strip as high as the sheet and as short as can be; the sheet's
/// width does not count.
///
/// # Errors
/// [`NestError`] names a shape that does not fit the height, or the fault if the result
/// did not pass the check.
pub fn strip(
    shapes: &[Shape],
    sheet: &Stock,
    effort: &Effort,
    watch: &mut dyn Watch,
) -> Result<PackedStrip, NestError> {
    let endless = Stock { width: 1e9, ..sheet.clone() };
    for shape in shapes {
        if fits(&shape.outline, &shape.rotations, &endless).is_none() {
            return Err(NestError::too_large(shape, &[endless]));
        }
    }
    let unsound = |fault: String| NestError::Unsound { fault };
    let mut budget = budget(effort, watch);
    let packed = search::strip(shapes, sheet, effort.seed, &mut budget);
    let trials = trials(&budget);
    let (placements, length) =
        packed.ok_or_else(|| unsound("an outline crosses itself".into()))?;
    let length = ((length + ROOM_MM) / WRITTEN_MM).ceil() * WRITTEN_MM;
    let layout = Layout { sheets: vec![NestedSheet { stock: 0, placements }] };
    match check(&layout, shapes, &[Stock { width: length, ..sheet.clone() }]).first() {
        None => Ok(PackedStrip { layout, length, trials }),
        Some(fault) => Err(unsound(fault.to_string())),
    }
}

fn budget<'a>(effort: &Effort, watch: &'a mut dyn Watch) -> Budget<'a> {
    let units = match effort.trials {
        u32::MAX => u64::MAX,
        trials => u64::from(trials),
    };
    Budget::new(units, watch)
}

/// The units that lead here again: one more than were filled if the search ended by itself.
fn trials(budget: &Budget) -> u32 {
    let units = budget.done + u64::from(!budget.over);
    u32::try_from(units).unwrap_or(u32::MAX)
}
