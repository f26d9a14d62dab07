//! What the text of the specification says about rules.

use bbrf::validate::{RULES, Severity, rule};

/// What stands in place of a rule where no program can check.
const UNCHECKED: &str = "[not machine-checkable]";

/// The sentences of the specification, with the line each begins near: paragraphs and list items are put together,
/// tables, headings and code are left out.
fn sentences(text: &str) -> Vec<(usize, String)> {
    let (mut blocks, mut in_code): (Vec<(usize, String)>, bool) = (Vec::new(), false);
    let mut open = false;
    for (number, line) in text.lines().enumerate() {
        if line.starts_with("```") {
            in_code = !in_code;
            open = false;
            continue;
        }
        if in_code || line.trim().is_empty() || line.starts_with('#') || line.starts_with('|') {
            open = false;
            continue;
        }
        let item = line.trim_start().starts_with("- ");
        match blocks.last_mut().filter(|_| open && !item) {
            Some((_, block)) => *block = format!("{block} {}", line.trim()),
            None => blocks.push((number + 1, line.trim().to_owned())),
        }
        open = true;
    }
    blocks.iter().flat_map(|(line, block)| block.split(". ").map(|sentence| (*line, sentence.to_owned()))).collect()
}

/// Rules named in a sentence, as `BB0401`.
fn named(sentence: &str) -> Vec<String> {
    let starts = sentence.match_indices("BB").map(|(at, _)| at);
    let alias = |at: usize| sentence.get(at..at + 6).filter(|alias| alias[2..].bytes().all(|b| b.is_ascii_digit()));
    starts.filter_map(alias).map(str::to_owned).collect()
}

/// The severities of the rules that a sentence names in brackets.
fn severities(sentence: &str) -> Vec<Severity> {
    let brackets = sentence.split('[').skip(1).filter_map(|rest| rest.split(']').next());
    let rules = brackets.flat_map(named).filter_map(|alias| rule(&alias));
    rules.map(|rule| rule.severity).collect()
}

/// What is wrong with the rules of a sentence: a MUST is checked by an error, a SHOULD alone by less.
fn misgraded(sentence: &str) -> Option<&'static str> {
    let severities = severities(sentence);
    let has_error = severities.contains(&Severity::Error);
    let must = ["MUST", "REQUIRED", "SHALL"].iter().any(|word| sentence.contains(word));
    if must && !severities.is_empty() && !has_error {
        return Some("a MUST without a rule of severity error");
    }
    (sentence.contains("SHOULD") && !must && !severities.is_empty() && severities.iter().all(|s| *s == Severity::Error))
        .then_some("a SHOULD with errors alone")
}

/// Sentences that demand something without saying what checks it, and names of rules that are none.
pub fn faults(text: &str) -> Vec<String> {
    let mut faults = Vec::new();
    for (line, sentence) in sentences(text) {
        let demands = sentence.contains("MUST") || sentence.contains("REQUIRED") || sentence.contains("SHALL");
        let in_brackets = sentence.contains("[BB") || sentence.contains(UNCHECKED);
        // The sentence that explains the words themselves.
        if demands && !in_brackets && !sentence.contains("RFC 2119") {
            faults.push(format!("near line {line}: no rule and no mark: {sentence}"));
        }
        if let Some(why) = misgraded(&sentence).filter(|_| !sentence.contains(UNCHECKED)) {
            faults.push(format!("near line {line}: {why}: {sentence}"));
        }
        for alias in named(&sentence).into_iter().filter(|alias| RULES.iter().all(|rule| rule.alias != alias)) {
            faults.push(format!("near line {line}: there is no rule {alias}"));
        }
    }
    faults
}

/// Rules that the text does not mention.
pub fn uncovered(text: &str) -> Vec<String> {
    let mentioned = named(text);
    let left = RULES.iter().filter(|rule| !mentioned.iter().any(|alias| alias == rule.alias));
    left.map(|rule| format!("{} {}", rule.alias, rule.name())).collect()
}
