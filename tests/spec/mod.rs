//! The tables of the specification, made from the types, the registry of rules and the writer; and what the text of the
//! specification says about rules.
#![allow(
    dead_code,
    unreachable_pub,
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    reason = "each test uses some of it"
)]

pub mod digest_example;
pub mod full;
pub mod layout;
mod lists;
mod rules;
pub mod text;

use std::path::PathBuf;

/// Every table by the name of its file.
pub fn tables() -> Vec<(&'static str, String)> {
    vec![
        ("layout", layout::table()),
        ("quantities", lists::quantities()),
        ("names", lists::names()),
        ("terms", lists::terms()),
        ("provenance", lists::provenance()),
        ("rules", rules::rules()),
        ("profiles", rules::profiles()),
        ("digest_example", digest_example::table()),
    ]
}

/// The folder of the specification.
pub fn folder() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("spec")
}

/// A table in Markdown.
pub fn markdown<const N: usize>(head: [&str; N], rows: impl IntoIterator<Item = [String; N]>) -> String {
    let line = |cells: [String; N]| format!("| {} |\n", cells.map(|cell| cell.replace('|', "\\|")).join(" | "));
    let mut text = line(head.map(str::to_owned)) + &format!("|{}\n", "---|".repeat(N));
    rows.into_iter().for_each(|row| text.push_str(&line(row)));
    text
}

/// A text in the type of code; nothing for nothing.
pub fn code(text: &str) -> String {
    if text.is_empty() { String::new() } else { format!("`{text}`") }
}

/// Opens a generated file.
pub fn titled(title: &str, about: &str, body: &str) -> String {
    format!(
        "# {title}\n\n<!-- Made by `BBRF_UPDATE=1 cargo test --test generated`; do not edit. -->\n\n{about}\n\n{body}"
    )
}
