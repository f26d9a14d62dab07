//! What geometries leave undetermined, in words: the null space, and parameters that are told in theory alone.

use super::guess::Guess;
use super::prediction::Directions;
use crate::quantity::Geometry;
use crate::terms::{REFRACTIVE_INDEX, ROUGHNESS, Term, TorranceSparrow};

/// A share of a direction below this is not worth naming.
const WORTH_NAMING: f64 = 0.02;
/// A relative standard uncertainty beyond this says only that nothing is known.
const NOTHING: f64 = 1.0;

pub(super) fn sentences(guess: &Guess, geometry: &[Geometry], directions: &Directions, sigma: &[f64]) -> Vec<String> {
    let mut list = Vec::new();
    for (k, one) in guess.parameters().iter().enumerate() {
        if directions.norms[k] == 0.0 {
            let why = reason(guess, geometry, one.parameter);
            list.push(format!("{}: not determined, no value changes with it{why}", one.name));
        }
    }
    for direction in directions.null() {
        list.extend(combination(guess, directions, direction));
    }
    for (k, one) in guess.parameters().iter().enumerate() {
        let relative = sigma[k] / one.scale.abs();
        if relative > NOTHING {
            let why = reason(guess, geometry, one.parameter);
            list.push(format!(
                "{}: not determined, its predicted standard uncertainty ({}) is above its own size ({}){why}",
                one.name,
                short(sigma[k]),
                short(one.scale)
            ));
        }
    }
    list
}

/// A direction of several parameters along which no value changes; `None` for that of a parameter alone.
fn combination(guess: &Guess, directions: &Directions, direction: &[f64]) -> Option<String> {
    // Back from columns of length 1 to relative changes of the parameters.
    let relative: Vec<f64> = direction
        .iter()
        .zip(&directions.norms)
        .map(|(part, norm)| if *norm > 0.0 && part.abs() > WORTH_NAMING { part / norm } else { 0.0 })
        .collect();
    let named: Vec<usize> = (0..relative.len()).filter(|k| relative[*k] != 0.0).collect();
    let first = *named.first()?;
    if named.len() < 2 {
        return None;
    }
    let name = |k: usize| guess.parameters()[k].name.as_str();
    let shown = |k: usize| {
        let one = &guess.parameters()[k];
        let of = if one.parameter == REFRACTIVE_INDEX.name { " - 1" } else { "" };
        format!("{}{of} by {:+.3} %", one.name, relative[k] / relative[first])
    };
    let names: Vec<&str> = named.iter().map(|k| name(*k)).collect();
    let changes: Vec<String> = named.iter().map(|k| shown(*k)).collect();
    Some(format!("{}: only together determined; no value changes with {}", names.join(" and "), changes.join(" and ")))
}

/// Why a roughness or an index is not seen, and what would show it.
fn reason(guess: &Guess, geometry: &[Geometry], parameter: &str) -> String {
    let specular = guess.terms().iter().find_map(|term| match term {
        Term::TorranceSparrow(term) => Some(*term),
        _ => None,
    });
    match specular {
        Some(term) if parameter == ROUGHNESS.name => roughness(&term, geometry),
        _ => String::new(),
    }
}

fn roughness(term: &TorranceSparrow, geometry: &[Geometry]) -> String {
    // What D changes by with ln r is largest near phi = w, where exp(-x^2) x^2 has its top.
    let half_width = term.roughness / term.distribution.roughness_from_half_width(1.0);
    let best = half_width.to_degrees() / std::f64::consts::LN_2.sqrt();
    let angles = geometry.iter().map(|geometry| geometry.half_angles().phi.to_degrees()).filter(|phi| *phi > 1e-9);
    let smallest = angles.fold(f64::INFINITY, f64::min);
    let seen = if smallest.is_finite() {
        format!("the smallest half-vector angle beside 0 is {smallest:.3} degrees")
    } else {
        "no half-vector angle differs from 0".to_owned()
    };
    format!(
        "; {seen}, and the lobe is seen at about {best:.3} degrees: measure with theta_v about {:.3} degrees off the mirror \
         direction",
        2.0 * best
    )
}

/// A number in four digits, as people write it.
fn short(x: f64) -> String {
    let size = x.abs();
    if (1e-3..1e4).contains(&size) {
        let digits = (3.0 - size.log10().floor()).clamp(0.0, 6.0) as usize;
        format!("{x:.digits$}")
    } else {
        format!("{x:.3e}")
    }
}
