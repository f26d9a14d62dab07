//! Wall time of each call with its spread, and the time on a processor per call, which other work on the machine changes less.

use std::time::Instant;

/// Times in microseconds.
pub struct Timed {
    /// First decile, median, ninth decile of the calls.
    pub wall: [f64; 3],
    /// Mean time on a processor.
    pub cpu: f64,
}

/// Calls `f` with 0, 1, 2, ... and times each call.
pub fn time(count: usize, mut f: impl FnMut(usize)) -> Timed {
    let mut calls = Vec::with_capacity(count);
    let cpu = on_processor();
    for k in 0..count {
        let begin = Instant::now();
        f(k);
        calls.push(begin.elapsed().as_secs_f64() * 1e6);
    }
    let cpu = (on_processor() - cpu) / 1e3 / count as f64;
    calls.sort_by(f64::total_cmp);
    Timed { wall: [0.1, 0.5, 0.9].map(|share| calls[((count - 1) as f64 * share) as usize]), cpu }
}

/// Nanoseconds that this thread has run; NaN where the system does not say.
fn on_processor() -> f64 {
    let text = std::fs::read_to_string("/proc/thread-self/schedstat").unwrap_or_default();
    text.split_whitespace().next().and_then(|word| word.parse().ok()).unwrap_or(f64::NAN)
}

impl std::fmt::Display for Timed {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let [low, median, high] = self.wall;
        write!(f, "{median:.1} us [{low:.1} .. {high:.1}], processor {:.1} us", self.cpu)
    }
}
