//! What the text of the specification says about rules.

use bbrf::validate::RULES;

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
