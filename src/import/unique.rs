//! Identifiers from names that may come again.

use std::collections::{BTreeMap, BTreeSet};

use crate::dataset::Id;

/// Gives every name an identifier that no other has: `red`, `red-2`, `red-3`.
#[derive(Debug, Default)]
pub(super) struct UniqueIds {
    taken: BTreeSet<Id>,
    next: BTreeMap<Id, u64>,
}

impl UniqueIds {
    /// The identifier of the next thing of that name.
    pub(super) fn of(&mut self, name: &str) -> Id {
        let base = Id::from_title(name);
        let mut id = base.clone();
        let next = self.next.entry(base.clone()).or_insert(2);
        // Room for the number in the 64 characters of an identifier.
        let short: String = base.as_str().chars().take(43).collect();
        while !self.taken.insert(id.clone()) {
            id = Id::from_title(&format!("{short}-{next}"));
            *next += 1;
        }
        id
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_that_come_again_get_numbers() {
        let mut ids = UniqueIds::default();
        let found: Vec<String> = ["Red", "red", "Red-2", "RED", "blue"].map(|name| ids.of(name).to_string()).into();
        assert_eq!(found, ["red", "red-2", "red-2-2", "red-3", "blue"]);
    }
}
