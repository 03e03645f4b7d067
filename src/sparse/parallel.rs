//! Workspace on several threads whose results do not depend on how many there are.

use std::ops::Range;
use std::sync::{Mutex, PoisonError};

/// Below so many unknowns threads cost more than they save.
const FEW: usize = 5000;

/// How many of the threads are worth it for so many unknowns.
pub(crate) fn worthwhile(threads: usize, unknowns: usize) -> usize {
    if unknowns < FEW { 1 } else { threads }
}

/// Runs `task` on each item, each thread with a state of its own; results in order.
pub(crate) fn map_items<I: Send, S, T: Send>(
    threads: usize,
    items: impl ExactSizeIterator<Item = I> + Send,
    state: impl Fn() -> S + Sync,
    task: impl Fn(&mut S, I) -> T + Sync,
) -> Vec<T> {
    if threads < 2 || items.len() < 2 {
        let mut state = state();
        return items.map(|item| task(&mut state, item)).collect();
    }
    let items = Mutex::new(items.enumerate());
    let next = || items.lock().unwrap_or_else(PoisonError::into_inner).next();
    let worker = || {
        let mut state = state();
        let mut mine = Vec::new();
        while let Some((k, item)) = next() {
            mine.push((k, task(&mut state, item)));
        }
        mine
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

/// The same for 0 to `count` - 1.
pub(crate) fn map_range<S, T: Send>(
    threads: usize,
    count: usize,
    state: impl Fn() -> S + Sync,
    task: impl Fn(&mut S, usize) -> T + Sync,
) -> Vec<T> {
    map_items(threads, 0..count, state, task)
}

/// `make` for ranges that cover `0..count`, side by side, put together in order.
pub(crate) fn map_chunks<T: Send>(
    count: usize,
    threads: usize,
    make: impl Fn(Range<usize>) -> Vec<T> + Sync,
) -> Vec<T> {
    if threads < 2 || count < 2000 {
        return make(0..count);
    }
    let share = count.div_ceil(threads);
    let part = |k: usize| (k * share).min(count)..((k + 1) * share).min(count);
    let parts = map_range(threads, threads, || (), |(), k| make(part(k)));
    parts.into_iter().flatten().collect()
}
