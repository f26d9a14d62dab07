//! Markdown, for a comment on a change or a page of a lab's notebook.

use crate::validate::Checked;

/// The report as Markdown: a heading and a table for each file.
#[must_use]
pub fn markdown(files: &[Checked]) -> String {
    let mut text = String::from("# bbrf validate\n");
    for file in files {
        text.push_str(&format!("\n## {}\n\n{}\n", cell(&file.file), cell(&file.verdict())));
        if file.report.findings.is_empty() {
            continue;
        }
        text.push_str("\n| severity | rule | place | found | expected | what to do |\n|---|---|---|---|---|---|\n");
        for finding in &file.report.findings {
            let place = crate::dataset::Place { file: None, ..finding.place.clone() };
            let cells = [
                finding.severity.name().to_owned(),
                format!("{} `{}`", finding.alias, finding.rule),
                format!("`{}`", cell(&place.to_string()).replace('`', "'")),
                cell(&finding.found),
                cell(&finding.expected),
                cell(&finding.advice),
            ];
            text.push_str(&format!("| {} |\n", cells.join(" | ")));
        }
    }
    text
}

/// Text that cannot leave its cell.
fn cell(text: &str) -> String {
    text.replace('\\', "\\\\").replace('|', "\\|").replace('<', "&lt;").replace(['\n', '\r'], " ")
}
