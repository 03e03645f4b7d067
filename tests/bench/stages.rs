//! How long each stage takes and how it grows: `cargo bench --bench stages`.
//!
//! Patches of a sphere with radial axes, nodes 28 mm apart, 1,000 to 10,000 fins, on the
//! default template; the least of three runs each. By hand, never a test.

use finwright::geometry::{Point3, Vector3};
use finwright::job::{self, Order};
use finwright::nest::Effort;
use finwright::structure::Draft;
use finwright::watch::Watch;
use std::time::{Duration, Instant};

/// Notes when each stage begins.
struct Clock(Vec<(&'static str, Instant)>);

impl Watch for Clock {
    fn progress(&mut self, stage: &'static str, _done: usize, _total: usize) {
        if self.0.last().is_none_or(|(last, _)| *last != stage) {
            self.0.push((stage, Instant::now()));
        }
    }

    fn stopped(&self) -> bool {
        false
    }
}

/// A square patch of a sphere with about this many fins.
fn patch(fins: usize) -> Draft {
    let count = ((fins as f64 / 2.0).sqrt() as usize) + 1;
    let size = 28.0 * count as f64;
    let radius = 2.0 * size;
    let at = |k: usize| size * (k as f64 / (count - 1) as f64 - 0.5) / (2.0 * radius);
    let nodes = (0..count).flat_map(|j| (0..count).map(move |i| (i, j)));
    let axes: Vec<Vector3> = nodes
        .map(|(i, j)| {
            let (u, v) = (at(i), at(j));
            let share = 1.0 + u * u + v * v;
            Vector3::new(2.0 * u, 2.0 * v, 1.0 - u * u - v * v) / share
        })
        .collect();
    let cells = (0..count - 1).flat_map(|j| (0..count - 1).map(move |i| j * count + i));
    Draft {
        name: "patch".into(),
        positions: axes.iter().map(|a| Point3::from(a * radius)).collect(),
        axes,
        faces: cells.map(|k| vec![k, k + 1, k + count + 1, k + count]).collect(),
        ..Draft::default()
    }
    .with_depth(16.0, 16.0)
}

/// Seconds of each stage of one run, in order, and the number of fins.
fn run(fins: usize) -> (usize, Vec<(&'static str, f64)>) {
    let source = finwright::template::embedded("pmma-cast-3").unwrap_or_default();
    let Ok(template) = finwright::template::read(source, "pmma-cast-3") else {
        return (0, Vec::new());
    };
    let mut clock = Clock(Vec::new());
    let effort = Effort { trials: 1, seed: 0 };
    let order = Order {
        draft: patch(fins),
        template: &template,
        effort,
        accepted_flexible: None,
    };
    let job = job::run(order, &mut clock).ok().unwrap_or_default();
    clock.progress("export", 0, 1);
    if let Some(sheets) = finwright::gate::approve(&job.sheets, &job.findings) {
        std::hint::black_box(finwright::export::cut_files(&sheets));
    }
    clock.progress("end", 0, 1);
    let span = |pair: &[(&'static str, Instant)]| {
        let time: Duration = pair[1].1 - pair[0].1;
        (pair[0].0, time.as_secs_f64())
    };
    let fins = job.structure.map_or(0, |s| s.fins().len());
    (fins, clock.0.windows(2).map(span).collect())
}

#[allow(clippy::print_stdout, reason = "a benchmark prints its table")]
fn main() {
    let mut logs = Vec::new();
    for fins in [1_000, 3_000, 10_000] {
        let runs: Vec<_> = (0..3).map(|_| run(fins)).collect();
        let least = |stage: usize| {
            runs.iter().map(|(_, spans)| spans[stage].1).fold(f64::INFINITY, f64::min)
        };
        let (count, spans) = &runs[0];
        let mut text = format!("{count:6} fins");
        let mut all_but_nest = 0.0;
        for (stage, (name, _)) in spans.iter().enumerate() {
            let seconds = least(stage);
            text += &format!("  {name} {seconds:.3} s");
            all_but_nest += if *name == "nest" { 0.0 } else { seconds };
        }
        println!("{text}  all but nest {all_but_nest:.3} s");
        logs.push(((*count as f64).log10(), all_but_nest.log10()));
    }
    let mean =
        |of: fn(&(f64, f64)) -> f64| logs.iter().map(of).sum::<f64>() / logs.len() as f64;
    let (x, y) = (mean(|p| p.0), mean(|p| p.1));
    let slope = logs.iter().map(|p| (p.0 - x) * (p.1 - y)).sum::<f64>()
        / logs.iter().map(|p| (p.0 - x) * (p.0 - x)).sum::<f64>();
    println!("fitted exponent, all but nest: {slope:.3}");
}
