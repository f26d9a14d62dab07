//! What the lines of a serial capture are.

use super::number::value;

/// What a line of a capture is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    /// Nothing but prompts.
    Prompt,
    /// An echoed command.
    Command,
    /// Digits alone, as `000`.
    Acknowledgement,
    /// `qq,U`: a spectrum of the PR-650 follows.
    Status,
    /// `wwww.,value`.
    Row,
    /// One number: an integral.
    Number,
    /// A status with three or more further numbers.
    Report,
    /// None of these.
    Unknown,
}

/// True where a line can be the first of a capture.
pub(super) fn starts_capture(text: &str) -> bool {
    let bare = strip(text);
    let fields: Vec<&str> = bare.split(',').map(str::trim).collect();
    text.trim().starts_with('>')
        || match kind(bare) {
            Kind::Status => true,
            Kind::Report => is_status_code(fields[0]) && is_unit(fields[1]),
            Kind::Command => fields.len() == 1 && is_measuring_command(bare),
            _ => false,
        }
}

fn is_measuring_command(text: &str) -> bool {
    let digits = text.get(1..).unwrap_or("");
    text.starts_with(['D', 'M', 'd', 'm'])
        && (1..=3).contains(&digits.len())
        && digits.bytes().all(|b| b.is_ascii_digit())
}

/// A line without prompts and blanks at its ends.
pub(super) fn strip(text: &str) -> &str {
    text.trim_matches(|c: char| c == '>' || c.is_whitespace())
}

/// A quality code: two digits on the PR-650, five on later models, or negative.
pub(super) fn is_status_code(field: &str) -> bool {
    let digits = field.strip_prefix('-').unwrap_or(field);
    let plain = !digits.is_empty() && digits.bytes().all(|byte| byte.is_ascii_digit());
    plain && (matches!(digits.len(), 1 | 2 | 5) || field.starts_with('-') && digits.len() <= 5)
}

fn is_unit(field: &str) -> bool {
    (1..=4).contains(&field.len()) && field.bytes().all(|byte| byte.is_ascii_digit())
}

/// What a stripped line is.
pub(super) fn kind(text: &str) -> Kind {
    let Some(first) = text.chars().next() else { return Kind::Prompt };
    if first.is_ascii_alphabetic() {
        return Kind::Command;
    }
    let fields: Vec<&str> = text.split(',').map(str::trim).collect();
    match fields.as_slice() {
        [only] if only.bytes().all(|byte| byte.is_ascii_digit()) => Kind::Acknowledgement,
        [only] if value(only).is_some() => Kind::Number,
        [code, unit] if is_status_code(code) && is_unit(unit) => Kind::Status,
        [_, _] if first.is_ascii_digit() => Kind::Row,
        [_, _, _, ..] => Kind::Report,
        _ => Kind::Unknown,
    }
}

/// `pppp,bbb.b,ffff.,wwww.,iii.` without the command that asked for it: the count agrees with the range.
pub(super) fn is_range_report(fields: &[&str]) -> bool {
    let numbers: Vec<f64> = fields.iter().filter_map(|field| value(field)).collect();
    match numbers.as_slice() {
        &[points, _, first, last, step] => step > 0.0 && first >= 100.0 && (last - first) / step + 1.0 == points,
        _ => false,
    }
}

/// The header of a later model without its rows: peak wavelength and a photon count beyond every chromaticity.
pub(super) fn is_later_header(fields: &[&str]) -> bool {
    fields.len() == 5 && fields[4].contains(['e', 'E']) && fields[2..].iter().all(|field| value(field).is_some())
}
