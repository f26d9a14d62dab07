//! What the specification demands of a rule, in its own words: they stand in one place.

use super::Rule;

const SPECIFICATION: &str = include_str!("../../spec/bbrf-1.0.md");

impl Rule {
    /// The sentences of the specification that name the rule, without the marks of rules.
    #[must_use]
    pub fn demands(&self) -> Vec<String> {
        let blocks = blocks(SPECIFICATION);
        let sentences = blocks.iter().flat_map(|block| sentences(block));
        sentences.filter(|sentence| sentence.contains(self.alias)).map(|sentence| unmarked(&sentence)).collect()
    }
}

/// Paragraphs and list items, each in one line; tables, headings and code are left out.
fn blocks(text: &str) -> Vec<String> {
    let (mut blocks, mut is_open): (Vec<String>, bool) = (Vec::new(), false);
    for line in text.lines().map(str::trim) {
        if line.is_empty() || line.starts_with(['#', '|']) {
            is_open = false;
            continue;
        }
        let item = line.strip_prefix("- ");
        match blocks.last_mut().filter(|_| is_open && item.is_none()) {
            Some(block) => *block = format!("{block} {line}"),
            None => blocks.push(item.unwrap_or(line).to_owned()),
        }
        is_open = true;
    }
    blocks
}

/// A sentence ends at a point before a space. What then begins in lower case, or speaks of an `It`, belongs to it.
fn sentences(block: &str) -> Vec<String> {
    let mut sentences: Vec<String> = Vec::new();
    for part in block.split_inclusive(". ") {
        match sentences.last_mut().filter(|_| part.starts_with(char::is_lowercase) || part.starts_with("It ")) {
            Some(sentence) => sentence.push_str(part),
            None => sentences.push(part.to_owned()),
        }
    }
    sentences.iter().map(|sentence| sentence.trim().to_owned()).collect()
}

/// The sentence without ` [BB0401]` and its like.
fn unmarked(sentence: &str) -> String {
    let mut parts = sentence.split(" [");
    let mut text = parts.next().unwrap_or_default().to_owned();
    for part in parts {
        match part.split_once(']').filter(|(mark, _)| mark.starts_with("BB") || *mark == "not machine-checkable") {
            Some((_, rest)) => text.push_str(rest),
            None => text.push_str(&format!(" [{part}")),
        }
    }
    text
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test")]
mod tests {
    use super::super::{RULES, rule};

    #[test]
    fn every_rule_has_the_words_of_the_specification() {
        for rule in RULES {
            let demands = rule.demands();
            assert!(!demands.is_empty(), "{}", rule.id);
            assert!(demands.iter().all(|demand| !demand.contains("[BB")), "{demands:?}");
        }
        let shapes = rule("structure.shapes").unwrap().demands().join(" ");
        assert!(
            shapes.starts_with("`value`, `value_u` and `value_flag` of a measurement MUST have the axes"),
            "{shapes}"
        );
        assert!(shapes.ends_with("or [`acquisition`, `band`] where the spectrum was summed."), "{shapes}");
    }
}
