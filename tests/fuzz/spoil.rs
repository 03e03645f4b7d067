//! Spoilt texts through every reader and stage, for as long as one likes:
//! `cargo test --bench spoil -- --minutes 10` (with overflow checks and debug assertions;
//! `cargo bench --bench spoil` is the faster build). By hand, never a test.
//!
//! `--seed N` runs one case and prints its text; `--from N` starts there.

#![allow(clippy::unwrap_used, reason = "a case that cannot go on is what is sought")]

#[path = "spoiling.rs"]
mod spoiling;

use spoiling::{Outcome, Valid};
use std::collections::BTreeMap;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{Duration, Instant};

/// A case that takes longer is reported.
const SLOW: Duration = Duration::from_secs(2);

/// A case that takes longer is taken for a hang; the run ends.
const HANG: Duration = Duration::from_secs(60);

fn option(name: &str) -> Option<f64> {
    let arguments: Vec<String> = std::env::args().collect();
    let at = arguments.iter().position(|argument| argument == name)?;
    arguments.get(at + 1)?.parse().ok()
}

/// Ends the run if one seed stays too long.
fn watch_for_hangs(seed: Arc<AtomicU64>) {
    std::thread::spawn(move || {
        let mut last = (u64::MAX, Instant::now());
        loop {
            std::thread::sleep(Duration::from_secs(1));
            let now = seed.load(Ordering::Relaxed);
            if now != last.0 {
                last = (now, Instant::now());
            } else if last.1.elapsed() > HANG {
                eprintln!("HANG: --seed {now} runs for more than {HANG:?}");
                std::process::exit(1);
            }
        }
    });
}

#[allow(clippy::print_stdout, reason = "a fuzz run prints its report")]
fn main() {
    let valid = Valid::new();
    if let Some(seed) = option("--seed") {
        let spoilt = valid.spoilt(seed as u64);
        println!("{:?}\n{}", spoilt.kind, spoilt.text);
        println!("{:?}", valid.run(&spoilt));
        return;
    }
    let until = Duration::from_secs_f64(60.0 * option("--minutes").unwrap_or(1.0));
    let first = option("--from").unwrap_or(0.0) as u64;
    let current = Arc::new(AtomicU64::new(first));
    watch_for_hangs(Arc::clone(&current));
    std::panic::set_hook(Box::new(|panic| eprintln!("  {panic}")));
    let started = Instant::now();
    let mut outcomes: BTreeMap<Outcome, usize> = BTreeMap::new();
    let (mut panics, mut slow, mut slowest) = (0, 0, Duration::ZERO);
    let mut seed = first;
    while started.elapsed() < until {
        current.store(seed, Ordering::Relaxed);
        let begun = Instant::now();
        let spoilt = valid.spoilt(seed);
        match catch_unwind(AssertUnwindSafe(|| valid.run(&spoilt))) {
            Ok(outcome) => *outcomes.entry(outcome).or_default() += 1,
            Err(_) => {
                panics += 1;
                println!("PANIC: --seed {seed}");
            }
        }
        let took = begun.elapsed();
        slowest = slowest.max(took);
        if took > SLOW {
            slow += 1;
            println!("SLOW: --seed {seed} took {took:.1?}");
        }
        seed += 1;
    }
    let cases = seed - first;
    let minutes = started.elapsed().as_secs_f64() / 60.0;
    println!("{cases} cases in {minutes:.1} minutes, seeds {first}..{seed}");
    println!("{outcomes:?}, {panics} panics, {slow} slow, the slowest {slowest:.1?}");
    std::process::exit(i32::from(panics > 0));
}
