//! Files, damaged copies of them, and which part of a file the damage hits.

#![allow(unreachable_pub, reason = "shared by tests")]

mod random;
mod regions;
mod run;

pub use random::Random;
pub use regions::{REGIONS, Region};
pub use run::{Outcome, Tally, run};

use std::ops::Range;
use std::sync::OnceLock;

use bbrf::container::{Limits, inspect};
use bbrf::validate::{Finding, validate_bytes};

/// A file before it is damaged.
pub struct Base {
    pub name: &'static str,
    pub bytes: Vec<u8>,
    pub digest: String,
    /// What the validator says of it undamaged.
    pub findings: Vec<Finding>,
    /// True for a file of this standard's writer, of which every byte is known.
    pub ours: bool,
    parts: Vec<(Region, Vec<Range<usize>>)>,
    content: OnceLock<String>,
}

/// Every group, dataset and attribute that the reader sees, also what is not digested.
fn content(bytes: &[u8]) -> String {
    inspect(bytes, &Limits::default()).map_or_else(|error| error.to_string(), |found| format!("{:?}", found.tree))
}

impl Base {
    pub fn new(name: &'static str, bytes: Vec<u8>, ours: bool) -> Self {
        let report = validate_bytes(&bytes);
        let parts = regions::of_file(&bytes);
        Self {
            name,
            digest: report.digest.unwrap(),
            findings: report.findings,
            parts,
            ours,
            bytes,
            content: OnceLock::new(),
        }
    }

    /// Where the content of a damaged copy first differs from that of the file; `None` where it is the same.
    pub fn changed_content(&self, damaged: &[u8]) -> Option<String> {
        let before = self.content.get_or_init(|| content(&self.bytes));
        let after = content(damaged);
        let at = before.bytes().zip(after.bytes()).position(|(a, b)| a != b);
        let at = at.or((before.len() != after.len()).then_some(before.len().min(after.len())))?;
        let around = |text: &str| {
            let bytes = &text.as_bytes()[at.saturating_sub(60)..(at + 30).min(text.len())];
            String::from_utf8_lossy(bytes).into_owned()
        };
        Some(format!("...{}... was ...{}...", around(&after), around(before)))
    }

    /// Bytes of a region.
    pub fn size_of(&self, region: Region) -> usize {
        self.parts.iter().filter(|part| part.0 == region).flat_map(|part| &part.1).map(Range::len).sum()
    }

    /// A copy that really differs, and where. Every region has the same share, however few bytes it has.
    pub fn damaged(&self, random: &mut Random) -> (Region, Vec<u8>) {
        loop {
            let (region, ranges) = random.of(&self.parts);
            let mut left = random.below(ranges.iter().map(Range::len).sum());
            let hit = ranges.iter().find_map(|range| {
                let at = range.start + left;
                left = left.saturating_sub(range.len());
                (at < range.end).then_some(at)
            });
            let damaged = harmed(&self.bytes, hit.unwrap(), random);
            if damaged != self.bytes {
                return (*region, damaged);
            }
        }
    }
}

fn harmed(bytes: &[u8], at: usize, random: &mut Random) -> Vec<u8> {
    let mut damaged = bytes.to_vec();
    let mut fill = |length: usize, value: u8| {
        let end = (at + length).min(damaged.len());
        damaged[at..end].fill(value);
    };
    match random.below(8) {
        0 => fill(4, 0xff),
        1 => fill(4, 0),
        2 => fill(512, 0),
        3 => fill(4096, 0),
        4 => damaged.truncate(at),
        5 => damaged[at] = random.next() as u8,
        6 => damaged[at..].iter_mut().take(8).for_each(|byte| *byte = random.next() as u8),
        _ => damaged[at] ^= 1 << random.below(8),
    }
    damaged
}
