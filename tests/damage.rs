//! Whatever happens to the bytes: an error, the same document, or a report that it differs. Never a panic, never a hang.
//!
//! `BBRF_DAMAGED` sets the number of damaged copies, `BBRF_DAMAGED_FROM` the first (a failure names it); `make soak-damage`
//! asks for 100,000. Figures: `docs/damage.md`.
#![cfg(feature = "write")]
#![allow(clippy::unwrap_used, reason = "a test")]

#[path = "../conformance/mod.rs"]
mod conformance;
mod damaged;
mod documents;

use std::path::Path;
use std::process::Command;

use bbrf::container::{Limits, document_bytes, read_bytes};
use bbrf::dataset::{Document, Measurement};
use bbrf::validate::{Severity, Status, validate_bytes};
use damaged::{Base, Outcome, REGIONS, Random, Tally, run};

/// Resident memory that a process may reach in which every core reads damaged copies of files of about a megabyte.
const MOST_MEMORY_KIB: u64 = 1 << 20;

/// Small files and a large one, as this standard's writer makes them.
fn ours() -> Vec<Base> {
    let large = Measurement { id: documents::id("large"), ..documents::scan(50, 401) };
    let mut document: Document = documents::small();
    document.measurements.push(large);
    vec![
        Base::new("small", document_bytes(&documents::small()).unwrap().0, true),
        Base::new("every part", conformance::clean_bytes(), true),
        Base::new("large", document_bytes(&document).unwrap().0, true),
    ]
}

/// The file with every part as h5py writes it: object headers, heaps and indices of the oldest form, without checksums;
/// texts in the global heap. None where there is no h5py.
fn theirs() -> Vec<Base> {
    let Ok(python) = std::env::var("BBRF_PYTHON") else {
        eprintln!("skipped the files of h5py: BBRF_PYTHON does not name a Python interpreter (make test sets it)");
        return Vec::new();
    };
    let folder = tempfile::tempdir().unwrap();
    let clean = folder.path().join("clean.bbrf");
    std::fs::write(&clean, conformance::clean_bytes()).unwrap();
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("conformance/encodings.py");
    let encodings = ["bounds-earliest", "variable-strings"];
    let output = Command::new(python).arg(script).arg(&clean).arg(folder.path()).args(encodings).output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let bytes = |name: &str| std::fs::read(folder.path().join(format!("{name}.bbrf"))).unwrap();
    encodings.map(|name| Base::new(name, bytes(name), false)).into()
}

/// Largest resident memory of this process so far.
fn memory_kib() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    status.lines().find_map(|line| line.strip_prefix("VmHWM:")?.trim().strip_suffix(" kB")?.trim().parse().ok())
}

fn print(bases: &[Base], tally: &Tally) {
    println!("| file | part | bytes | copies | refused | reported | same document, said | same document |");
    println!("|---|---|---|---|---|---|---|---|");
    for base in bases {
        for region in REGIONS {
            let count = |outcome| tally.outcomes.get(&(base.name, region, outcome)).copied().unwrap_or_default();
            let counts = [Outcome::Refused, Outcome::Reported, Outcome::SameSaid, Outcome::Same].map(count);
            let [refused, reported, said, same] = counts;
            println!(
                "| {} | {} | {} | {} | {refused} | {reported} | {said} | {same} |",
                base.name,
                format!("{region:?}").to_lowercase(),
                base.size_of(region),
                counts.iter().sum::<u64>(),
            );
        }
    }
    println!("broken promises: {}; longest: {:.0} ms", tally.broken.len(), tally.longest.as_secs_f64() * 1e3);
}

#[test]
fn damage_is_reported_or_without_effect() {
    let mut bases = ours();
    bases.extend(theirs());
    let number = |name: &str| std::env::var(name).ok().and_then(|text| text.parse::<u64>().ok());
    let from = number("BBRF_DAMAGED_FROM").unwrap_or(0);
    let count = number("BBRF_DAMAGED").unwrap_or(1000);
    let tally = run(&bases, from..from + count);
    print(&bases, &tally);
    assert!(tally.broken.is_empty(), "{:#?}", &tally.broken[..tally.broken.len().min(20)]);
    assert_eq!(tally.outcomes.values().sum::<u64>(), count);
    if let Some(memory) = memory_kib() {
        println!("largest resident memory: {} MiB", memory >> 10);
        assert!(memory < MOST_MEMORY_KIB, "{memory} KiB");
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
    let mut seen_by_bytes = 0;
    for at in (index..index + 120).step_by(5).chain((heap..heap + 120).step_by(5)) {
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

/// Copies that once passed: the index says that a chunk begins at another row, libhdf5 then reads fill values, and this
/// reader, which has one chunk for the whole array, sees nothing.
#[test]
fn a_chunk_at_another_row_is_found() {
    let bases = ours();
    for base in &bases {
        let is_chunk_index = |at: &usize| base.bytes[*at..].starts_with(b"TREE\x01\x00");
        let indices = (0..base.bytes.len()).filter(is_chunk_index).step_by(9).take(3);
        // Behind 24 bytes of the node and 8 of size and filters stand the first row, 64 bits, and the offsets on other axes.
        for at in indices.flat_map(|index| index + 32..index + 44) {
            let mut flipped = base.bytes.clone();
            flipped[at] ^= 1 << (at % 8);
            let report = validate_bytes(&flipped);
            assert_ne!(report.status(), Status::Valid, "{}: a flip at {at} passes: {:?}", base.name, report.findings);
        }
    }
}
