//! From settings to a ladder.

use super::best::mark_best;
use super::ladder::{Ladder, Meaning, Rung, Task};
use super::timing::{Patience, Timing, Work, take_turns};

/// A setting, ready to be timed.
pub struct Candidate<'a> {
    /// As [`Rung::name`].
    pub name: String,
    /// As [`Rung::knob`].
    pub knob: String,
    /// As [`Rung::options`].
    pub options: Vec<String>,
    /// As [`Rung::error`].
    pub error: Option<f64>,
    /// As [`Rung::second_error`].
    pub second_error: Option<f64>,
    /// As [`Rung::bytes`].
    pub bytes: Option<u64>,
    /// As [`Rung::note`].
    pub note: Option<String>,
    /// What is timed.
    pub work: Work<'a>,
    /// How often `work` is contained in what the ladder calls its time.
    pub times: f64,
    /// What is timed as reading.
    pub read: Option<Work<'a>>,
}

impl std::fmt::Debug for Candidate<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Candidate").field("name", &self.name).field("error", &self.error).finish_non_exhaustive()
    }
}

/// Times the candidates in turns and marks the best. The ladder has no command yet: whoever knows it adds it.
#[must_use]
pub fn measured(
    task: Task,
    subject: String,
    meaning: Meaning,
    candidates: Vec<Candidate<'_>>,
    patience: Patience,
) -> Ladder {
    let (mut rungs, mut works, mut reads) = (Vec::new(), Vec::new(), Vec::new());
    let unknown =
        Timing { median: f64::NAN, first_quartile: f64::NAN, third_quartile: f64::NAN, repeats: 0, settled: false };
    for (place, candidate) in candidates.into_iter().enumerate() {
        let Candidate { name, knob, options, error, second_error, bytes, note, work, times, read } = candidate;
        works.push(work);
        reads.extend(read.map(|read| (place, read)));
        let rung = Rung {
            name,
            knob,
            options,
            error: error.filter(|error| error.is_finite()),
            second_error: second_error.filter(|error| error.is_finite()),
            time: unknown,
            read_time: None,
            bytes,
            is_best: false,
            note,
        };
        rungs.push((rung, times));
    }
    let (places, mut reads): (Vec<usize>, Vec<Work<'_>>) = reads.into_iter().unzip();
    let count = works.len();
    works.append(&mut reads);
    let timings = take_turns(&mut works, patience);
    for ((rung, times), timing) in rungs.iter_mut().zip(&timings[..count]) {
        rung.time = timing.scaled(*times);
    }
    for (place, timing) in places.into_iter().zip(&timings[count..]) {
        rungs[place].0.read_time = Some(*timing);
    }
    let mut rungs: Vec<Rung> = rungs.into_iter().map(|(rung, _)| rung).collect();
    mark_best(&mut rungs);
    Ladder { task, subject, machine: machine(), command: Vec::new(), meaning, rungs }
}

/// The processor and how many of it may be used.
fn machine() -> String {
    let text = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let model = text.lines().find_map(|line| line.strip_prefix("model name")?.split_once(':'));
    let model = model.map_or(std::env::consts::ARCH, |(_, name)| name.trim());
    match std::thread::available_parallelism().map_or(1, std::num::NonZero::get) {
        1 => format!("{model}, 1 thread"),
        count => format!("{model}, {count} threads"),
    }
}
