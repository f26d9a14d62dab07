//! Many damaged copies on all cores: what became of each, how long the longest took, and who hung.

use std::collections::BTreeMap;
use std::ops::Range;
use std::panic::catch_unwind;
use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{Duration, Instant};

use bbrf::container::{Limits, read_bytes};
use bbrf::validate::{Severity, Status, validate_bytes};

use super::{Base, Random, Region};

/// A copy that takes longer has hung the program.
const PATIENCE: Duration = Duration::from_secs(60);

/// What was made of a damaged copy.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Outcome {
    /// No document is given out.
    Refused,
    /// A document is given out together with the places where it is not as it was written.
    Reported,
    /// The document is the undamaged one, to the bit, and the validator says that the bytes are not.
    SameSaid,
    /// The document is the undamaged one, to the bit.
    Same,
}

/// How many copies ended how, by file and region.
#[derive(Debug, Default)]
pub struct Tally {
    pub outcomes: BTreeMap<(&'static str, Region, Outcome), u64>,
    /// Sentences on copies that broke a promise.
    pub broken: Vec<String>,
    pub longest: Duration,
}

/// Damages copies of the files in turn; the number of a copy says what is done to it.
pub fn run(bases: &[Base], copies: Range<u64>) -> Tally {
    let (next, tally) = (AtomicU64::new(copies.start), Mutex::new(Tally::default()));
    let workers = std::thread::available_parallelism().map_or(1, usize::from);
    let under_way: Vec<Mutex<Option<(u64, Instant)>>> = (0..workers).map(|_| Mutex::new(None)).collect();
    std::thread::scope(|scope| {
        let work = |mine: &Mutex<Option<(u64, Instant)>>| {
            loop {
                let seed = next.fetch_add(1, Ordering::Relaxed);
                if seed >= copies.end {
                    *mine.lock().unwrap() = None;
                    return;
                }
                let begun = Instant::now();
                *mine.lock().unwrap() = Some((seed, begun));
                let base = turn(bases, seed);
                let (region, damaged) = base.damaged(&mut Random(seed));
                let judged = catch_unwind(|| judge(base, &damaged));
                let mut tally = tally.lock().unwrap();
                tally.longest = tally.longest.max(begun.elapsed());
                match judged.unwrap_or_else(|_| Err("a panic".to_owned())) {
                    Ok(outcome) => *tally.outcomes.entry((base.name, region, outcome)).or_default() += 1,
                    Err(what) => tally.broken.push(format!("seed {seed}, {}, {region:?}: {what}", base.name)),
                }
            }
        };
        let workers: Vec<_> = under_way.iter().map(|mine| scope.spawn(move || work(mine))).collect();
        while !workers.iter().all(std::thread::ScopedJoinHandle::is_finished) {
            std::thread::sleep(Duration::from_millis(20));
            for mine in &under_way {
                if let Some((seed, _)) = mine.lock().unwrap().filter(|(_, begun)| begun.elapsed() > PATIENCE) {
                    // A thread cannot be ended; the process can.
                    eprintln!("seed {seed} hangs");
                    std::process::abort();
                }
            }
        }
    });
    tally.into_inner().unwrap()
}

/// Each file in turn; a large one has a tenth of the copies of another, because each takes so much longer.
fn turn(bases: &[Base], seed: u64) -> &Base {
    let large = |base: &&Base| base.bytes.len() > 1 << 20;
    let turns: Vec<&Base> =
        (0..10).flat_map(|round| bases.iter().filter(move |base| round == 0 || !large(base))).collect();
    turns[(seed % turns.len() as u64) as usize]
}

/// # Errors
/// A sentence where something that is stored changed and nothing says so.
fn judge(base: &Base, damaged: &[u8]) -> Result<Outcome, String> {
    let report = validate_bytes(damaged);
    let said = report.findings != base.findings;
    if base.ours && report.status() == Status::Valid {
        return Err(format!("passes as valid: {:?}", report.findings));
    }
    if let Some(what) = (!said).then(|| base.changed_content(damaged)).flatten() {
        return Err(format!("the validator says nothing of changed content: {what}"));
    }
    if report.findings.iter().any(|finding| finding.alias == "BB0001") {
        // The same bytes, refused by what both begin with.
        return Ok(Outcome::Refused);
    }
    match read_bytes(damaged, &Limits::default()) {
        Err(_) => Ok(Outcome::Refused),
        Ok(opened) if !opened.mismatched.is_empty() => {
            let grave = report.findings.iter().filter(|finding| finding.severity != Severity::Info);
            let grave_before = base.findings.iter().filter(|finding| finding.severity != Severity::Info);
            if grave.count() <= grave_before.count() {
                return Err(format!("the reader objects and the validator does not: {:?}", opened.mismatched));
            }
            Ok(Outcome::Reported)
        }
        Ok(opened) if opened.computed_digest.as_str() != base.digest => Err("another document passes".to_owned()),
        Ok(_) if said => Ok(Outcome::SameSaid),
        Ok(_) => Ok(Outcome::Same),
    }
}
