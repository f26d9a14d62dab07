//! Files are written and validated over all cores at once, and nobody waits for ever.
#![cfg(feature = "write")]
#![allow(clippy::unwrap_used, reason = "a test")]

mod documents;

use std::sync::mpsc;
use std::time::Duration;

use bbrf::container::document_bytes;
use bbrf::dataset::{Document, Measurement};
use bbrf::validate::{Status, validate_bytes};
use rayon::ThreadPoolBuilder;
use rayon::iter::{IntoParallelIterator, ParallelIterator};

/// Chunks are made over all cores, the library is used by one thread at a time: whoever has it must not wait for others.
#[test]
fn writers_and_validators_do_not_wait_for_each_other() {
    let (done, finished) = mpsc::channel();
    std::thread::spawn(move || {
        let scan = Measurement { id: documents::id("scan"), ..documents::scan(60, 41) };
        let document = Document { measurements: vec![scan], models: Vec::new(), ..documents::small() };
        let (bytes, _) = document_bytes(&document).unwrap();
        // Chunks said to have no checksum: read as before, and made again for the comparison with the writer's bytes.
        let mut damaged = bytes.clone();
        let is_chunk_index = |at: &usize| bytes[*at..].starts_with(b"TREE\x01\x00");
        (0..bytes.len()).filter(is_chunk_index).for_each(|index| damaged[index + 28] ^= 4);
        let pool = ThreadPoolBuilder::new().num_threads(3).build().unwrap();
        let valid = pool.install(|| {
            let work = (0..100).into_par_iter().map(|k| {
                if k % 2 == 0 {
                    document_bytes(&document).unwrap().0 == bytes
                } else {
                    validate_bytes(damaged.as_slice()).status() != Status::Valid
                }
            });
            work.collect::<Vec<bool>>()
        });
        done.send(valid).unwrap();
    });
    let results = finished.recv_timeout(Duration::from_secs(300)).expect("writers and validators wait for each other");
    assert_eq!(results, vec![true; 100]);
}
