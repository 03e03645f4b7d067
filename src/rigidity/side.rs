//! Work on several threads whose results do not depend on how many there are.

use std::ops::Range;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Runs `task` for 0 to `count` - 1, each thread with a state of its own; results in order.
pub(super) fn side_by_side<S, T: Send>(
    threads: usize,
    count: usize,
    state: impl Fn() -> S + Sync,
    task: impl Fn(&mut S, usize) -> T + Sync,
) -> Vec<T> {
    if threads < 2 || count < 2 {
        let mut state = state();
        return (0..count).map(|k| task(&mut state, k)).collect();
    }
    let next = AtomicUsize::new(0);
    let worker = || {
        let mut state = state();
        let mut mine = Vec::new();
        loop {
            let k = next.fetch_add(1, Ordering::Relaxed);
            if k >= count {
                return mine;
            }
            mine.push((k, task(&mut state, k)));
        }
    };
    let mut results: Vec<(usize, T)> = std::thread::scope(|scope| {
        let workers: Vec<_> = (1..threads).map(|_| scope.spawn(worker)).collect();
        let mut all = worker();
        for other in workers {
            match other.join() {
                Ok(results) => all.extend(results),
                Err(panic) => std::panic::resume_unwind(panic),
            }
        }
        all
    });
    results.sort_by_key(|(k, _)| *k);
    results.into_iter().map(|(_, result)| result).collect()
}

/// `make` for ranges that cover `0..count`, side by side, put together in order.
pub(super) fn in_parts<T: Send>(
    count: usize,
    threads: usize,
    make: impl Fn(Range<usize>) -> Vec<T> + Sync,
) -> Vec<T> {
    if threads < 2 || count < 2000 {
        return make(0..count);
    }
    let share = count.div_ceil(threads);
    let part = |k: usize| (k * share).min(count)..((k + 1) * share).min(count);
    let parts = side_by_side(threads, threads, || (), |(), k| make(part(k)));
    parts.into_iter().flatten().collect()
}
