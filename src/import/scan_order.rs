//! Scan orders: `theta_i=-80:80:10; theta_v=-80:80:10; skip=retro; serpentine; repeats=2`, assigned to files in the
//! natural order of their names. The first angle is the outer loop. The number of files must be that of the loop.

use super::angles::Written;
use super::error::{ImportError, fault, quoted};
use super::number::value;
use crate::dataset::Place;
use crate::quantity::SignHabit;

/// More looks than this are not one scan.
const MAX_LOOKS: usize = 1_000_000;

/// One look of a scan.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Look {
    /// Signed angles, degrees.
    pub(super) angles: Written,
    /// Number of the repeat, from 1; `None` without repeats.
    pub(super) repeat: Option<u32>,
}

struct Loop {
    outer_is_incidence: bool,
    outer: Vec<f64>,
    inner: Vec<f64>,
    skip_retro: bool,
    serpentine: bool,
    repeats: u32,
}

/// The looks of a scan order, in the order of acquisition.
///
/// # Errors
/// [`ImportError::Call`] for what is no scan order.
pub(super) fn looks(text: &str, habit: SignHabit) -> Result<Vec<Look>, ImportError> {
    let scan = parse(text)?;
    let mut looks = Vec::new();
    for (turn, outer) in scan.outer.iter().enumerate() {
        let backwards = scan.serpentine && turn % 2 == 1;
        for index in 0..scan.inner.len() {
            let inner = scan.inner[if backwards { scan.inner.len() - 1 - index } else { index }];
            let (i, v) = if scan.outer_is_incidence { (*outer, inner) } else { (inner, *outer) };
            if scan.skip_retro && v == retro(i, habit) {
                continue;
            }
            for repeat in 1..=scan.repeats {
                let repeat = (scan.repeats > 1).then_some(repeat);
                looks.push(Look { angles: Written::Signed(i, v), repeat });
            }
        }
    }
    Ok(looks)
}

fn retro(theta_i: f64, habit: SignHabit) -> f64 {
    match habit {
        SignHabit::MirrorAtEqual => -theta_i,
        SignHabit::RetroAtEqual => theta_i,
    }
}

fn parse(text: &str) -> Result<Loop, ImportError> {
    let mut angles: Vec<(&str, Vec<f64>)> = Vec::new();
    let (mut skip_retro, mut serpentine, mut repeats) = (false, false, 1);
    for part in text.split(';').map(str::trim).filter(|part| !part.is_empty()) {
        let (key, value) = part.split_once('=').map_or((part, ""), |(key, value)| (key.trim(), value.trim()));
        match (key, value) {
            ("theta_i" | "theta_v", range) if angles.iter().all(|(name, _)| *name != key) => {
                angles.push((key, steps(range).ok_or_else(|| wrong(part))?));
            }
            ("skip", "retro") => skip_retro = true,
            ("serpentine", "") => serpentine = true,
            ("repeats", count) => {
                repeats = count.parse().ok().filter(|count| (1..=1000).contains(count)).ok_or_else(|| wrong(part))?;
            }
            _ => return Err(wrong(part)),
        }
    }
    let [(first, outer), (_, inner)] = <[_; 2]>::try_from(angles).map_err(|_| wrong(text))?;
    if outer.len().saturating_mul(inner.len()).saturating_mul(repeats as usize) > MAX_LOOKS {
        return Err(wrong(text));
    }
    Ok(Loop { outer_is_incidence: first == "theta_i", outer, inner, skip_retro, serpentine, repeats })
}

/// `-80:80:10`: first, last, step; or one angle, or several with commas.
fn steps(text: &str) -> Option<Vec<f64>> {
    let parts: Vec<f64> = text.split([':', ',']).map(value).collect::<Option<_>>()?;
    if !text.contains(':') {
        return Some(parts);
    }
    let &[first, last, step] = parts.as_slice() else { return None };
    let count = ((last - first) / step).round();
    let fits = step != 0.0 && (0.0..10_000.0).contains(&count) && (first + count * step - last).abs() < 1e-9;
    fits.then(|| (0..=count as usize).map(|index| first + step * index as f64).collect())
}

fn wrong(found: &str) -> ImportError {
    ImportError::Call(fault(
        Place::file("--scan-order"),
        quoted(found),
        "`theta_i=FIRST:LAST:STEP; theta_v=FIRST:LAST:STEP`, then optionally `skip=retro`, `serpentine`, `repeats=N`",
        "as in `theta_i=-80:80:10; theta_v=-80:80:10; skip=retro`",
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_papers_grid_has_272_looks() {
        let order = "theta_i=-80:80:10; theta_v=-80:80:10; skip=retro";
        let found = looks(order, SignHabit::MirrorAtEqual).unwrap();
        assert_eq!(found.len(), 272);
        assert_eq!(found[0].angles, Written::Signed(-80.0, -80.0));
        let other = looks(order, SignHabit::RetroAtEqual).unwrap();
        assert_eq!(other[0].angles, Written::Signed(-80.0, -70.0));
    }

    #[test]
    fn a_serpentine_turns_back() {
        let found = looks("theta_v=0:20:10;theta_i=0:10:10;serpentine;repeats=2", SignHabit::MirrorAtEqual).unwrap();
        let angles: Vec<Written> = found.iter().step_by(2).map(|look| look.angles).collect();
        let pairs = [(0.0, 0.0), (10.0, 0.0), (10.0, 10.0), (0.0, 10.0), (0.0, 20.0), (10.0, 20.0)];
        assert_eq!(angles, pairs.map(|(i, v)| Written::Signed(i, v)));
    }

    #[test]
    fn what_is_no_order_is_refused() {
        for text in ["", "theta_i=0:10:3;theta_v=0", "theta_i=0;theta_i=0", "theta_i=0:1e9:1;theta_v=0", "up"] {
            assert!(looks(text, SignHabit::MirrorAtEqual).is_err(), "{text}");
        }
    }
}
