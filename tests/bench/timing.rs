//! How times are taken: after warming up, in rounds in which each contender has its turn, so that a disturbance meets all
//! of them, and as medians.

use std::time::Instant;

/// How long a measurement lasts at least, in milliseconds: short work is done several times. Threads that have slept
/// need some frames until they run side by side.
const SHORTEST: f64 = 150.0;
/// How often work is done in one measurement at most.
const MOST_RUNS: u32 = 1000;

/// Milliseconds that some work takes, when it is done `runs` times.
pub fn milliseconds(runs: u32, mut work: impl FnMut()) -> f64 {
    let start = Instant::now();
    for _ in 0..runs {
        work();
    }
    start.elapsed().as_secs_f64() * 1e3 / f64::from(runs)
}

/// How often work that takes so long is done in one measurement.
pub fn runs_for(milliseconds: f64) -> u32 {
    (SHORTEST / milliseconds.max(1e-6)).ceil().clamp(1.0, f64::from(MOST_RUNS)) as u32
}

/// The value in the middle; 0 if there is none.
pub fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    match values.len() {
        0 => 0.0,
        n if n.is_multiple_of(2) => f64::midpoint(values[n / 2 - 1], values[n / 2]),
        n => values[n / 2],
    }
}
