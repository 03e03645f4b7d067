//! Levenberg–Marquardt on the energy, then a polish that looks at planarity alone.
//!
//! Damping follows what a step gained against what it promised (Nielsen 1999, Damping
//! parameter in Marquardt's method): planar fins lie along curved valleys of the energy,
//! where damping that is eased by a fixed factor fails at every other step.
//! Damping is one number for all unknowns (lengths are in fin lengths, axes of length one),
//! so that it depends neither on the directions of the coordinates nor on the numbering.
//! Planarity weighs more from round to round until the target is met; the polish then takes
//! the shortest way to exact planarity.

use crate::design::planarise::energy::Energy;
use crate::design::planarise::given::{Feet, State};
use crate::design::planarise::matrix::{NormalMatrix, SIZE};
use crate::geometry::Vector3;
use crate::sparse::{Cholesky, Ordering};
use crate::tolerance::{LEAST_DAMPING, PLANAR};
use crate::watch::{Stopped, Watch};

/// Damping to begin with, and the most it is eased by one step.
const FIRST_DAMPING: f64 = 0.001;
const EASE: f64 = 0.1;
/// Damping keeps below this (and above [`LEAST_DAMPING`]): beyond, no step can be told
/// from none.
const MOST_DAMPING: f64 = 1e6;
/// A round has settled when a step lowers the energy by less than this share.
const SETTLED: f64 = 0.01;
/// When the target is met, a step must gain this much per fin as well: a change of some
/// thousandths of a fin length, or of a radian, is not worth another step.
const WORTH: f64 = 0.00001;
/// Planarity weighs this much more in each round, for this many rounds.
const RAISE: f64 = 4.0;
const ROUNDS: usize = 5;
/// Steps of the polish.
const POLISH_STEPS: usize = 12;

/// A step of the search.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Iteration {
    /// Whether planarity alone counted.
    pub polish: bool,
    /// How much planarity weighed.
    pub weight: f64,
    /// The sum of squares where the step led.
    pub energy: f64,
    /// Worst planarity there, as a share of a fin's diameter.
    pub worst: f64,
    /// Damping of the step.
    pub damping: f64,
    /// Whether the step was taken.
    pub taken: bool,
}

/// Where the search ended.
pub(super) struct Found {
    pub state: State,
    pub history: Vec<Iteration>,
}

/// Why the search did not end.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Broken {
    Stopped(Stopped),
    TooLarge,
}

impl From<Stopped> for Broken {
    fn from(stopped: Stopped) -> Self {
        Self::Stopped(stopped)
    }
}

/// Nodes and axes with what is known about them.
struct Place {
    state: State,
    feet: Vec<Feet>,
    energy: f64,
    worst: f64,
}

struct Search<'a> {
    energy: &'a mut Energy,
    constant: NormalMatrix,
    matrix: NormalMatrix,
    factor: Cholesky,
    target: f64,
    damping: f64,
    /// By how much damping grows if the next step fails.
    stiffen: f64,
    polish: bool,
    history: Vec<Iteration>,
    most: usize,
    watch: &'a mut dyn Watch,
}

/// Finds nodes and axes whose fins are planar to `target`, in about `most` steps.
pub(super) fn descend(
    energy: &mut Energy,
    target: f64,
    most: usize,
    watch: &mut dyn Watch,
) -> Result<Found, Broken> {
    let (constant, matrix) = (energy.constant(), energy.constant());
    let factor = Cholesky::analysed(&matrix.lower, Ordering::AsNumbered);
    let factor = factor.ok_or(Broken::TooLarge)?;
    let mut state = energy.given.start.clone();
    let mut search = Search {
        energy,
        constant,
        matrix,
        factor,
        target,
        damping: FIRST_DAMPING,
        stiffen: 2.0,
        polish: false,
        history: Vec::new(),
        most,
        watch,
    };
    let mut best = (f64::INFINITY, state.clone());
    for _ in 0..ROUNDS {
        let end = search.round(state)?;
        state = end.state;
        if end.worst < best.0 {
            best = (end.worst, state.clone());
        }
        if end.worst <= target {
            break;
        }
        search.energy.planarity.weight *= RAISE;
    }
    let state = search.polished(best.1)?;
    Ok(Found { state, history: search.history })
}

impl Search<'_> {
    fn place(&self, state: State) -> Place {
        let feet = self.energy.feet(&state);
        let energy = self.energy.value(&state, &feet);
        let worst = self.energy.planarities(&state).fold(0.0, f64::max);
        Place { state, feet, energy, worst }
    }

    /// Steps until they gain little.
    fn round(&mut self, state: State) -> Result<Place, Broken> {
        let mut place = self.place(state);
        self.damping = FIRST_DAMPING;
        while self.history.len() < self.most {
            let Some(next) = self.step(&place)? else { break };
            let gain = place.energy - next.energy;
            let share = gain / place.energy;
            place = next;
            let little = gain < WORTH * self.energy.given.fins.len() as f64;
            if share < SETTLED || (little && place.worst <= self.target) {
                break;
            }
        }
        Ok(place)
    }

    /// Planarity alone, by the shortest way; ends with the best that was met.
    fn polished(&mut self, state: State) -> Result<State, Broken> {
        self.energy.silence_wishes();
        self.constant = self.energy.constant();
        (self.polish, self.damping) = (true, FIRST_DAMPING);
        let mut place = self.place(unit_axes(state));
        for _ in 0..POLISH_STEPS {
            if place.worst <= PLANAR {
                break;
            }
            let Some(mut next) = self.step(&place)? else { break };
            next = self.place(unit_axes(next.state));
            if next.worst >= place.worst {
                break;
            }
            place = next;
        }
        Ok(place.state)
    }

    /// The next place with less energy; `None` if there is none to be found.
    fn step(&mut self, from: &Place) -> Result<Option<Place>, Broken> {
        self.matrix.copy_from(&self.constant);
        let pull = self.energy.linearise(&from.state, &from.feet, &mut self.matrix);
        let mut shifted = 0.0;
        while self.damping <= MOST_DAMPING {
            self.watch.progress("planarise", self.history.len(), self.most);
            self.watch.unless_stopped()?;
            self.matrix.shift(self.damping - shifted);
            shifted = self.damping;
            let mut change: Vec<f64> = pull.iter().map(|pull| -pull).collect();
            let factored = self.factor.factorise(&self.matrix.lower).is_ok();
            let next = factored.then(|| {
                self.factor.solve(&mut change);
                self.place(moved(&from.state, &change))
            });
            let promised: f64 = change
                .iter()
                .zip(&pull)
                .map(|(x, pull)| x * (self.damping * x - pull))
                .sum();
            let next = next.filter(|next| next.energy < from.energy);
            let reached = next.as_ref().unwrap_or(from);
            self.history.push(Iteration {
                polish: self.polish,
                weight: self.energy.planarity.weight,
                energy: reached.energy,
                worst: reached.worst,
                damping: self.damping,
                taken: next.is_some(),
            });
            let Some(next) = next else {
                self.damping *= self.stiffen;
                self.stiffen *= 2.0;
                continue;
            };
            let kept = (from.energy - next.energy) / promised;
            let ease = (1.0 - (2.0 * kept - 1.0).powi(3)).max(EASE);
            self.damping = (self.damping * ease).max(LEAST_DAMPING);
            self.stiffen = 2.0;
            return Ok(Some(next));
        }
        Ok(None)
    }
}

fn moved(state: &State, change: &[f64]) -> State {
    let mut moved = state.clone();
    for (node, change) in change.chunks_exact(SIZE).enumerate() {
        moved.positions[node] += Vector3::new(change[0], change[1], change[2]);
        moved.axes[node] += Vector3::new(change[3], change[4], change[5]);
    }
    moved
}

fn unit_axes(mut state: State) -> State {
    for axis in &mut state.axes {
        axis.normalize_mut();
    }
    state
}
