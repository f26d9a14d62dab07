//! The conformance kit: a clean document, faults made in it one at a time, and what must be found in each. Any reader or
//! validator can be scored with the files; see `examples/conformance_kit.rs`.
#![allow(
    dead_code,
    unused_imports,
    unreachable_pub,
    clippy::expect_used,
    clippy::unwrap_used,
    clippy::panic,
    reason = "a program for tests"
)]

mod clean;
mod faults;
pub mod golden;
pub mod score;

use bbrf::container::tree::{Data, Group};
use bbrf::container::{Limits, document_bytes, inspect, sign_tree, tree_bytes};
use bbrf::dataset::Document;

pub use clean::{clean, id};
pub use faults::{FAULTS, hemisphere};

/// How a fault is made.
#[derive(Debug, Clone, Copy)]
pub enum Edit {
    /// In the document, which is then written with its digests.
    Document(fn(&mut Document)),
    /// In the file as its groups and datasets, which are then digested as they are: somebody else wrote it so.
    Tree(fn(&mut Group)),
    /// In the file as its groups and datasets, with the digests of the clean file: somebody changed it.
    Changed(fn(&mut Group)),
    /// In the bytes.
    Bytes(fn(&mut Vec<u8>)),
}

/// One file with one fault.
#[derive(Debug, Clone, Copy)]
pub struct Fault {
    /// The rule that finds it, without its version.
    pub rule: &'static str,
    /// What was done, in words that can be a file name.
    pub what: &'static str,
    /// How.
    pub edit: Edit,
}

impl Fault {
    /// Name of the file.
    pub fn file_name(&self) -> String {
        format!("{}={}.bbrf", self.rule, self.what)
    }

    /// The bytes of the file.
    pub fn bytes(&self) -> Vec<u8> {
        match self.edit {
            Edit::Document(change) => {
                let mut document = clean();
                change(&mut document);
                written(&document)
            }
            Edit::Tree(change) => {
                let mut tree = clean_tree();
                change(&mut tree);
                sign_tree(&mut tree);
                tree_bytes(&tree).unwrap()
            }
            Edit::Changed(change) => {
                let mut tree = clean_tree();
                sign_tree(&mut tree);
                change(&mut tree);
                tree_bytes(&tree).unwrap()
            }
            Edit::Bytes(change) => {
                let mut bytes = clean_bytes();
                change(&mut bytes);
                bytes
            }
        }
    }
}

/// The clean file.
pub fn clean_bytes() -> Vec<u8> {
    written(&clean())
}

fn written(document: &Document) -> Vec<u8> {
    // A faulty document is written as it is: parts that do not fit together are faults, too.
    bbrf::container::unchecked_bytes(document).unwrap_or_else(|| document_bytes(document).unwrap().0)
}

/// The clean file as groups and datasets with their dimension scales.
fn clean_tree() -> Group {
    bbrf::container::document_tree(&clean()).unwrap()
}

/// A dataset's numbers, to change them.
pub fn numbers<'a>(group: &'a mut Group, name: &str) -> &'a mut [f64] {
    match &mut group.dataset_mut(name).expect("the dataset").array.data {
        Data::F64(numbers) => numbers,
        other => panic!("{name} is {other:?}"),
    }
}

/// What is found in a file by our own validator.
pub fn found(bytes: &[u8]) -> Vec<&'static str> {
    let mut rules: Vec<&str> =
        bbrf::validate::validate_bytes(bytes).findings.iter().map(|finding| finding.rule).collect();
    rules.dedup();
    rules.into_iter().map(|rule| rule.rsplit(':').next().unwrap_or(rule)).collect()
}

/// Reads the tree back, for tests.
pub fn tree_of(bytes: &[u8]) -> Group {
    inspect(bytes, &Limits::default()).unwrap().tree
}
