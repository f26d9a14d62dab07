//! The ladder of a file: bytes and times of the ways to store it.

use super::ladder::{Ladder, Meaning, Task};
use super::measured::{Candidate, measured};
use super::timing::Patience;
use crate::container::{Foreign, Limits, ReadError, Storing, WriteError, read_bytes, rewrite_storing};
use crate::dataset::{Document, NotSingle};

/// Levels of deflate.
const LEVELS: [u32; 5] = [0, 1, 4, 6, 9];
/// Bytes of a chunk; the usual one is among the levels.
const CHUNKS: [usize; 3] = [1 << 14, 1 << 17, 1 << 23];

/// Why a document cannot be stored in one of the ways.
#[derive(Debug, thiserror::Error)]
pub enum NoStorageLadder {
    /// It cannot be written.
    #[error(transparent)]
    Write(#[from] WriteError),
    /// What was written cannot be read.
    #[error(transparent)]
    Read(#[from] ReadError),
}

/// What each way of storing a document costs, with what its file holds beside the standard.
///
/// # Errors
/// [`NoStorageLadder`].
pub fn storage_ladder(
    document: &Document,
    foreign: &Foreign,
    subject: String,
    patience: Patience,
) -> Result<Ladder, NoStorageLadder> {
    let (single, refused) = match in_single(document) {
        Ok(single) => (Some(single), None),
        Err(refused) => (None, Some(refused)),
    };
    let limits = Limits::default();
    let mut candidates = Vec::new();
    for (storing, knob) in ways() {
        let stored = if storing.single { single.as_ref() } else { Some(document) };
        let Some(stored) = stored else { continue };
        let bytes = rewrite_storing(stored, foreign, storing)?;
        let error = largest_change(document, &read_bytes(bytes.clone(), &limits)?.document);
        candidates.push(Candidate {
            name: name(storing),
            knob: knob.to_owned(),
            options: options(storing),
            error: Some(error),
            second_error: None,
            bytes: Some(bytes.len() as u64),
            note: None,
            work: Box::new(move || {
                std::hint::black_box(rewrite_storing(stored, foreign, storing).is_ok());
            }),
            times: 1.0,
            read: Some(Box::new(move || {
                std::hint::black_box(read_bytes(bytes.clone(), &limits).is_ok());
            })),
        });
    }
    let without = refused.map_or(String::new(), |refused| format!("; single precision is no rung: {refused}"));
    let meaning = Meaning {
        reference: format!("the values of the file{without}"),
        error: "largest relative change of a value or of a standard uncertainty after writing and reading".to_owned(),
        axis: "largest relative change".to_owned(),
        second_error: None,
        time: "seconds to write into memory, digests and the check that it reads back among them".to_owned(),
        read_time: Some("seconds to read from memory, its digests verified".to_owned()),
    };
    Ok(measured(Task::Storage, subject, meaning, candidates, patience))
}

fn in_single(document: &Document) -> Result<Document, NotSingle> {
    let mut rounded = document.clone();
    rounded.round_to_single()?;
    Ok(rounded)
}

fn ways() -> Vec<(Storing, &'static str)> {
    let usual = Storing::default();
    let levels = LEVELS.map(|compression| (Storing { compression, ..usual }, "level of deflate"));
    let chunks = CHUNKS.map(|chunk_bytes| (Storing { chunk_bytes, ..usual }, "size of a chunk"));
    let single = LEVELS.map(|compression| (Storing { compression, single: true, ..usual }, "single precision"));
    levels.into_iter().chain(chunks).chain(single).collect()
}

fn name(storing: Storing) -> String {
    let usual = Storing::default();
    let precision = if storing.single { ", single" } else { "" };
    if storing.chunk_bytes == usual.chunk_bytes {
        format!("deflate {}{precision}", storing.compression)
    } else {
        format!("chunk {} KiB{precision}", storing.chunk_bytes >> 10)
    }
}

/// What `bbrf migrate` is told. A level is always named: without any option a current file is left as it is.
fn options(storing: Storing) -> Vec<String> {
    let mut options = vec!["--compression".to_owned(), storing.compression.to_string()];
    if storing.chunk_bytes != Storing::default().chunk_bytes {
        options.extend(["--chunk".to_owned(), storing.chunk_bytes.to_string()]);
    }
    if storing.single {
        options.push("--single".to_owned());
    }
    options
}

/// The largest relative change of a value or an uncertainty; infinite where a number came or went.
fn largest_change(before: &Document, after: &Document) -> f64 {
    let arrays = |document: &Document| -> Vec<ndarray::ArcArray2<f64>> {
        let of = |one: &crate::dataset::Measurement| {
            [Some(one.values.clone()), one.uncertainty.standard.clone()].into_iter().flatten()
        };
        document.measurements.iter().flat_map(of).collect()
    };
    let change = |(a, b): (&f64, &f64)| {
        if a.to_bits() == b.to_bits() || a == b || (a.is_nan() && b.is_nan()) {
            0.0
        } else {
            let change = ((b - a) / a).abs();
            if change.is_nan() { f64::INFINITY } else { change }
        }
    };
    let pairs = arrays(before).into_iter().zip(arrays(after));
    pairs.map(|(a, b)| a.iter().zip(b.iter()).map(change).fold(0.0, f64::max)).fold(0.0, f64::max)
}
