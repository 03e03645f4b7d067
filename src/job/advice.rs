//! The smallest scale at which a structure can be made, and what binds there.
//!
//! Material does not scale: as a model shrinks, webs thin out, bends tighten and slits draw
//! near. Each of these checks passes from some scale upward, so the scale is found by steps
//! and then by halving, with the real stages at each. (A model too large for its stock fails
//! for other reasons; the search ends below that.)

use crate::diagnostic::{Finding, Severity};
use crate::fabrication::fabricate;
use crate::nest::Effort;
use crate::settings::Settings;
use crate::structure::Draft;
use crate::watch::{Stopped, Watch};
use std::collections::BTreeMap;

/// One scale that was tried.
#[derive(Debug, Clone, PartialEq)]
pub struct Tried {
    /// Times the draft as given.
    pub factor: f64,
    /// Errors found there, by code: how many, and the first of them.
    pub fails: BTreeMap<String, (usize, Finding)>,
}

/// What was found out.
#[derive(Debug, Clone, PartialEq)]
pub struct Advice {
    /// All scales tried, small to large.
    pub tried: Vec<Tried>,
}

impl Advice {
    /// The smallest factor that passes and has none that fails above it in the search.
    pub fn least(&self) -> Option<f64> {
        let passing = self.tried.iter().rev().skip_while(|tried| !tried.fails.is_empty());
        let passing = passing.take_while(|tried| tried.fails.is_empty());
        passing.last().map(|tried| tried.factor)
    }

    /// The largest scale below [`Advice::least`] that fails: what binds.
    pub fn binding(&self) -> Option<&Tried> {
        let least = self.least().unwrap_or(f64::INFINITY);
        self.tried.iter().rev().find(|t| t.factor < least && !t.fails.is_empty())
    }
}

/// What is asked.
pub struct Question<'a> {
    /// The structure, mm at the scale that was typed.
    pub draft: &'a Draft,
    /// What it is made with.
    pub settings: &'a Settings,
    /// Depth below and above in mm of the model, if it does not scale along.
    pub depth: Option<[f64; 2]>,
}

/// From one scale to the next: ten to a decade.
const STEP: f64 = 1.258_925_411_794_167_3;

/// Steps at most, up or down: a factor of a hundred.
const STEPS: u32 = 20;

/// Halvings between the last that fails and the first that passes: to 1.5 %.
const HALVINGS: u32 = 4;

/// Looks for the smallest scale that passes, in steps from the one given.
///
/// # Errors
/// [`Stopped`] if the watch stopped the work.
pub fn smallest_scale(
    question: &Question,
    watch: &mut dyn Watch,
) -> Result<Advice, Stopped> {
    let mut tried = vec![question.at(1.0, watch)?];
    let passes = |tried: &Tried| tried.fails.is_empty();
    let down = passes(&tried[0]);
    for step in 1..=STEPS {
        watch.progress("scales", step as usize, (STEPS + HALVINGS) as usize);
        let last = tried[tried.len() - 1].factor;
        let next = question.at(if down { last / STEP } else { last * STEP }, watch)?;
        let turned = passes(&next) != down;
        tried.push(next);
        if turned {
            break;
        }
    }
    let ends = tried.len().checked_sub(2).map(|k| [tried[k].factor, tried[k + 1].factor]);
    let turned = passes(&tried[tried.len() - 1]) != down;
    if let Some([a, b]) = ends.filter(|_| turned) {
        let (mut fails, mut holds) = (a.min(b), a.max(b));
        for _ in 0..HALVINGS {
            let middle = question.at((fails * holds).sqrt(), watch)?;
            *(if passes(&middle) { &mut holds } else { &mut fails }) = middle.factor;
            tried.push(middle);
        }
    }
    tried.sort_by(|a, b| a.factor.total_cmp(&b.factor));
    Ok(Advice { tried })
}

impl Question<'_> {
    fn at(&self, factor: f64, watch: &mut dyn Watch) -> Result<Tried, Stopped> {
        let mut draft = self.draft.clone().scaled(factor);
        if let Some([below, above]) = self.depth {
            draft = draft.with_depth(below, above);
        }
        let effort = Effort { trials: 1, seed: 0 };
        let settings = Settings { effort, ..self.settings.clone() };
        let job = fabricate(draft, settings, watch)?;
        let mut fails: BTreeMap<String, (usize, Finding)> = BTreeMap::new();
        for finding in job.findings.into_iter().filter(|f| f.severity == Severity::Error)
        {
            fails.entry(finding.code.clone()).or_insert((0, finding)).0 += 1;
        }
        Ok(Tried { factor, fails })
    }
}
