//! The receipt while it is being written.

use std::collections::BTreeSet;

use crate::dataset::{Assumption, InputFile, Notice, Place, Receipt};

/// More notices of one kind than this are counted and not listed one by one.
pub(crate) const LISTED: usize = 20;

/// What an import read, assumed and could not fill, so far.
#[derive(Debug, Default)]
pub(crate) struct Notes {
    receipt: Receipt,
    /// The unfilled fields once more: of thousands of samples, each has some.
    unfilled: BTreeSet<String>,
}

impl Notes {
    /// A file that was read.
    pub(crate) fn input(&mut self, input: InputFile) {
        if !self.receipt.inputs.iter().any(|known| known.name == input.name) {
            self.receipt.inputs.push(input);
        }
    }

    /// Something taken for granted.
    pub(crate) fn assume(&mut self, place: Place, text: impl Into<String>) {
        self.receipt.assumptions.push(Assumption { text: text.into(), place });
    }

    /// Something worth a look.
    pub(crate) fn notice(&mut self, place: Place, text: impl Into<String>) {
        self.receipt.notices.push(Notice { text: text.into(), place });
    }

    /// A field of the document that stays empty.
    pub(crate) fn unfilled(&mut self, path: impl Into<String>) {
        let path = path.into();
        if self.unfilled.insert(path.clone()) {
            self.receipt.unfilled.push(path);
        }
    }

    /// The receipt.
    pub(crate) fn finish(mut self) -> Receipt {
        self.receipt.tool = format!("bbrf import {}", env!("CARGO_PKG_VERSION"));
        self.receipt
    }
}

/// A list in a sentence, cut after [`LISTED`].
pub(crate) fn listed(items: &[String]) -> String {
    let shown = items.iter().take(LISTED).cloned().collect::<Vec<_>>().join(", ");
    if items.len() > LISTED { format!("{shown} and {} more", items.len() - LISTED) } else { shown }
}
