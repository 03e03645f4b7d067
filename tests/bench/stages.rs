//! How long each stage takes and how it grows: `cargo bench --bench stages`.
//!
//! Patches of a sphere with radial axes, nodes 28 mm apart, 1,000 to 10,000 fins, on the
//! default template; the median of five runs each, as time passed and as time of all cores
//! (Linux only), which other work on the machine disturbs less. By hand, never a test.

use finwright::fabrication::fabricate;
use finwright::geometry::{Point3, Vector3};
use finwright::nest::Effort;
use finwright::settings::Settings;
use finwright::structure::Draft;
use finwright::watch::Watch;
use std::time::{Duration, Instant};

/// Notes when each stage begins, and how much the cores had worked by then.
struct Clock(Vec<(&'static str, Instant, f64)>);

/// Seconds that all cores have spent on this program; 0 where the system does not tell.
fn worked() -> f64 {
    let stat = std::fs::read_to_string("/proc/self/stat").unwrap_or_default();
    let fields = stat.rsplit(')').next().unwrap_or_default().split_whitespace();
    // Fields 14 and 15 of the whole line, in hundredths of a second.
    let ticks: f64 = fields.skip(11).take(2).filter_map(|f| f.parse::<f64>().ok()).sum();
    ticks / 100.0
}

impl Watch for Clock {
    fn progress(&mut self, stage: &'static str, _done: usize, _total: usize) {
        if self.0.last().is_none_or(|(last, ..)| *last != stage) {
            self.0.push((stage, Instant::now(), worked()));
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

/// A stage with its seconds, passed and worked.
type Span = (&'static str, [f64; 2]);

/// Seconds of each stage of one run, passed and worked, in order, and the number of fins.
fn run(fins: usize) -> (usize, Vec<Span>) {
    let source = finwright::template::embedded("pmma-cast-3").unwrap_or_default();
    let Ok(template) = finwright::template::read(source, "pmma-cast-3") else {
        return (0, Vec::new());
    };
    let mut clock = Clock(Vec::new());
    let effort = Effort { trials: 1, seed: 0 };
    let settings = Settings { effort, ..Settings::new(template) };
    let Ok(job) = fabricate(patch(fins), settings, &mut clock) else {
        return (0, Vec::new());
    };
    clock.progress("export", 0, 1);
    if let Ok(sheets) = job.approved() {
        let files = finwright::export::cut_files(&sheets, clock.threads());
        std::hint::black_box(files.ok());
    }
    clock.progress("end", 0, 1);
    let span = |pair: &[(&'static str, Instant, f64)]| {
        let time: Duration = pair[1].1 - pair[0].1;
        (pair[0].0, [time.as_secs_f64(), pair[1].2 - pair[0].2])
    };
    let fins = job.structure.map_or(0, |s| s.fins().len());
    (fins, clock.0.windows(2).map(span).collect())
}

/// The middle one.
fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}

/// Slope of the straight line nearest to the points.
fn slope(points: &[[f64; 2]]) -> f64 {
    let mean = |k: usize| points.iter().map(|p| p[k]).sum::<f64>() / points.len() as f64;
    let (x, y) = (mean(0), mean(1));
    points.iter().map(|p| (p[0] - x) * (p[1] - y)).sum::<f64>()
        / points.iter().map(|p| (p[0] - x) * (p[0] - x)).sum::<f64>()
}

#[allow(clippy::print_stdout, reason = "a benchmark prints its table")]
fn main() {
    for (kind, name) in ["passed", "worked by all cores"].into_iter().enumerate() {
        println!("median seconds {name}:");
        let mut logs = Vec::new();
        for fins in [1_000, 3_000, 10_000] {
            let runs: Vec<_> = (0..5).map(|_| run(fins)).collect();
            let of = |take: &dyn Fn(&[Span]) -> f64| {
                median(runs.iter().map(|(_, spans)| take(spans)).collect())
            };
            let (count, spans) = &runs[0];
            let mut text = format!("{count:6} fins");
            for (stage, (name, _)) in spans.iter().enumerate() {
                text += &format!("  {name} {:.3}", of(&|spans| spans[stage].1[kind]));
            }
            let but_nest = |spans: &[(&'static str, [f64; 2])]| {
                let rest = spans.iter().filter(|(name, _)| *name != "nest");
                rest.map(|(_, seconds)| seconds[kind]).sum()
            };
            let all = of(&but_nest);
            println!("{text}  all but nest {all:.3}");
            logs.push([(*count as f64).log10(), all.log10()]);
        }
        println!("fitted exponent, all but nest: {:.3}", slope(&logs));
    }
}
