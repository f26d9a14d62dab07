//! Whatever happens to the bytes: an error, the same document, or a report that it differs. Never a panic.
#![cfg(feature = "write")]
#![allow(clippy::unwrap_used, reason = "a test")]

mod documents;

use bbrf::container::{Limits, digest, document_bytes, read_bytes};
use bbrf::validate::{Severity, Status, validate_bytes};

/// A small generator with a fixed seed, so that a failure can be repeated (splitmix64).
struct Random(u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    fn below(&mut self, bound: usize) -> usize {
        (self.next() % bound as u64) as usize
    }
}

fn damaged(bytes: &[u8], random: &mut Random) -> Vec<u8> {
    let mut damaged = bytes.to_vec();
    let at = random.below(bytes.len());
    let mut fill = |length: usize, value: u8| {
        let end = (at + length).min(damaged.len());
        damaged[at..end].fill(value);
    };
    match random.below(6) {
        0 => fill(4, 0xff),
        1 => fill(4, 0),
        2 => fill(512, 0),
        3 => damaged.truncate(at),
        4 => damaged[at] = random.next() as u8,
        _ => damaged[at] ^= 1 << random.below(8),
    }
    damaged
}

#[test]
fn damage_is_reported_or_without_effect() {
    let document = documents::small();
    let (bytes, _) = document_bytes(&document).unwrap();
    let original = digest(&document).unwrap();
    let cases = std::env::var("BBRF_PROPTEST_CASES").ok().and_then(|text| text.parse().ok()).unwrap_or(600);
    for seed in 0..cases {
        let damaged = damaged(&bytes, &mut Random(seed));
        let Ok(opened) = read_bytes(&damaged, &Limits::default()) else { continue };
        if opened.mismatched.is_empty() {
            assert_eq!(opened.computed_digest, original, "seed {seed}: another document passes for whole");
            assert!(documents::same(&opened.document, &document), "seed {seed}");
        } else {
            let report = validate_bytes(&damaged);
            let errors = report.findings.iter().filter(|finding| finding.severity != Severity::Info).count();
            assert!(errors > 0, "seed {seed}: {:?}", opened.mismatched);
        }
    }
}

/// Also where HDF5 has no checksum and this reader would see nothing, as in the index of chunks.
#[test]
fn no_flipped_bit_is_valid() {
    let (bytes, _) = document_bytes(&documents::small()).unwrap();
    assert_eq!(validate_bytes(&bytes).status(), Status::Valid);
    let index = bytes.windows(4).position(|window| window == b"TREE").unwrap();
    let heap = bytes.windows(4).position(|window| window == b"GCOL").unwrap();
    let mut random = Random(97);
    let sampled: Vec<usize> = (0..400).map(|_| random.below(bytes.len())).collect();
    let unchecked = (index..index + 120).step_by(5).chain((heap..heap + 120).step_by(5));
    let mut seen_by_bytes = 0;
    for at in sampled.into_iter().chain(unchecked) {
        let mut flipped = bytes.clone();
        flipped[at] ^= 1 << random.below(8);
        let report = validate_bytes(&flipped);
        assert_ne!(report.status(), Status::Valid, "a flip at {at} passes: {:?}", report.findings);
        let errors = report.findings.iter().filter(|finding| finding.severity == Severity::Error);
        seen_by_bytes += usize::from(errors.map(|finding| finding.alias).eq(["BB0011"]));
    }
    assert!(seen_by_bytes > 10, "only {seen_by_bytes} flips were the rule's own");
}

#[test]
fn every_truncation_is_an_error() {
    let (bytes, _) = document_bytes(&documents::small()).unwrap();
    for length in (0..bytes.len()).step_by(61) {
        assert!(read_bytes(&bytes[..length], &Limits::default()).is_err(), "cut at {length}");
    }
}
