//! The same document gives the same bytes: again and again, between other documents, on several threads, and in another
//! process. The rule `structure.bytes` rests on it.
#![cfg(feature = "write")]
#![allow(clippy::unwrap_used, reason = "a test")]

mod documents;

use bbrf::container::document_bytes;
use bbrf::dataset::Document;
use documents::{arbitrary_document, small};
use proptest::strategy::{Strategy, ValueTree};
use proptest::test_runner::{Config, RngAlgorithm, TestRng, TestRunner};

fn some_documents(count: usize) -> Vec<Document> {
    let rng = TestRng::from_seed(RngAlgorithm::ChaCha, &[11; 32]);
    let mut runner = TestRunner::new_with_rng(Config { failure_persistence: None, ..Config::default() }, rng);
    let strategy = arbitrary_document();
    let arbitrary = (0..count).map(|_| strategy.new_tree(&mut runner).unwrap().current());
    [small(), Document::default()].into_iter().chain(arbitrary).collect()
}

fn bytes(document: &Document) -> Vec<u8> {
    document_bytes(document).unwrap().0
}

/// FNV-1a.
fn hash(bytes: &[u8]) -> u64 {
    bytes.iter().fold(0xcbf2_9ce4_8422_2325, |hash, byte| (hash ^ u64::from(*byte)).wrapping_mul(0x0100_0000_01b3))
}

/// Fills the free memory with something else than zero, so that what the library leaves unset shows.
fn litter(seed: u8) {
    let blocks: Vec<Vec<u8>> = (4..13).flat_map(|power| (0..64).map(move |_| vec![seed | 1; 1 << power])).collect();
    drop(std::hint::black_box(blocks));
}

#[test]
fn again_and_between_others() {
    let documents = some_documents(12);
    let first: Vec<Vec<u8>> = documents.iter().map(bytes).collect();
    for round in 0..40_u8 {
        for (document, first) in documents.iter().zip(&first) {
            litter(round);
            assert!(bytes(document) == *first, "round {round}: other bytes");
        }
    }
}

#[test]
fn on_several_threads() {
    let documents = some_documents(6);
    let first: Vec<Vec<u8>> = documents.iter().map(bytes).collect();
    std::thread::scope(|scope| {
        for offset in 0..4 {
            let (documents, first) = (&documents, &first);
            scope.spawn(move || {
                for step in 0..60 {
                    let at = (step + offset) % documents.len();
                    litter(0xff);
                    assert!(bytes(&documents[at]) == first[at], "other bytes on thread {offset}");
                }
            });
        }
    });
}

/// Prints the hashes that the other process compares.
#[test]
fn in_other_processes() {
    const CHILD: &str = "BBRF_DETERMINISM_CHILD";
    let hashes: Vec<String> =
        some_documents(6).iter().map(|document| format!("{:x}", hash(&bytes(document)))).collect();
    if let Ok(path) = std::env::var(CHILD) {
        std::fs::write(path, hashes.join(" ")).unwrap();
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    for child in 0..5 {
        let path = folder.path().join(child.to_string());
        let mut command = std::process::Command::new(std::env::current_exe().unwrap());
        command.args(["in_other_processes", "--exact", "--test-threads=1"]).env(CHILD, &path);
        // The C library fills what it hands out with this byte, where it knows the variable.
        let status = command.env("MALLOC_PERTURB_", (child * 50).to_string()).output().unwrap().status;
        assert!(status.success());
        assert_eq!(std::fs::read_to_string(&path).unwrap(), hashes.join(" "), "process {child} wrote other bytes");
    }
}
