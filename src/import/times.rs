//! Times as instruments and manifests write them, to RFC 3339. A time without a zone stays unfilled unless the zone is
//! stated: it is not guessed.

use jiff::civil::DateTime;
use jiff::tz::{Offset, TimeZone};

/// A text as RFC 3339; `None` where it is no time, or has no offset and none is stated.
pub(super) fn rfc3339(text: &str, zone: Option<&str>) -> Option<String> {
    let text = text.trim();
    if text.parse::<jiff::Timestamp>().is_ok() {
        return Some(text.replacen(' ', "T", 1));
    }
    let time = local(text)?;
    let zone = zone?.trim();
    let offset = if zone == "Z" { Offset::UTC } else { offset(zone)? };
    let stamp = TimeZone::fixed(offset).to_timestamp(time).ok()?;
    let suffix = if zone == "Z" { "Z" } else { zone };
    stamp.as_second().checked_abs()?;
    Some(format!("{time}{suffix}"))
}

/// A time without a zone: `2017-10-10T10:49:22`, `2017-10-10 10:49:22` or SpectraWin's `Tue Oct 10 2017 10:49:22`.
pub(super) fn local(text: &str) -> Option<DateTime> {
    let text = text.trim();
    text.parse().ok().or_else(|| DateTime::strptime("%a %b %d %Y %H:%M:%S", text).ok())
}

/// `+09:00`.
fn offset(text: &str) -> Option<Offset> {
    let (sign, rest) = match text.split_at_checked(1)? {
        ("+", rest) => (1, rest),
        ("-", rest) => (-1, rest),
        _ => return None,
    };
    let (hours, minutes) = rest.split_once(':')?;
    if hours.len() != 2 || minutes.len() != 2 {
        return None;
    }
    let (hours, minutes): (i32, i32) = (hours.parse().ok()?, minutes.parse().ok()?);
    Offset::from_seconds(sign * (hours * 3600 + minutes * 60)).ok().filter(|_| minutes < 60)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_zone_is_not_guessed() {
        let spectrawin = "Tue Oct 10 2017 10:49:22";
        assert_eq!(rfc3339(spectrawin, None), None);
        assert_eq!(rfc3339(spectrawin, Some("+09:00")).as_deref(), Some("2017-10-10T10:49:22+09:00"));
        assert_eq!(rfc3339("2017-10-10T10:49:22Z", None).as_deref(), Some("2017-10-10T10:49:22Z"));
        assert_eq!(rfc3339("yesterday", Some("Z")), None);
    }
}
