//! The excitation spectrum that is known: a factorisation of a file, or two columns.

use miette::miette;

use super::super::{light_source, material};
use crate::cli::opened::open;
use crate::dataset::Factorisation;
use crate::donaldson::Light;
use crate::donaldson::estimate::{Axes, Lit};
use crate::quantity::QuantityKind;

/// The spectrum on the axis of the matrix, 1 at its peak; 0 where it has no value.
pub(super) fn load(name: &str, axes: &Axes) -> Result<Vec<f64>, miette::Report> {
    let (path, id) = material::split(name);
    if path.ends_with(".bbrf") {
        let document = open(path.as_ref())?.document;
        let ids = || {
            material::or_none(
                document.factorisations.iter().map(|one| one.id.to_string()).collect::<Vec<_>>().join(", "),
            )
        };
        let factors = match (id, document.factorisations.as_slice()) {
            (Some(id), _) => document.factorisation(id),
            (None, [one]) => Some(one),
            (None, _) => None,
        };
        let factors = factors.ok_or_else(|| {
            miette!(
                help = "`bbrf donaldson separate -o` adds one beside its matrix",
                "--excitation {name}: expected one factorisation; the file has: {}",
                ids()
            )
        })?;
        return of_factors(name, factors, axes);
    }
    let loaded = light_source::load(name)?;
    scaled(name, &Lit::of(&loaded.light, axes))
}

fn of_factors(name: &str, factors: &Factorisation, axes: &Axes) -> Result<Vec<f64>, miette::Report> {
    if factors.rank() != 1 {
        return Err(miette!(
            "--excitation {name}: `{}` has {} factors; expected one: an estimate from few lights is of one dye",
            factors.id,
            factors.rank()
        ));
    }
    let values = factors.excitation.row(0).to_vec();
    let light = Light::new(name, QuantityKind::RelativeSpectrum, factors.excitation_nm.clone(), values, None)
        .map_err(|error| miette!("--excitation {name}: {error}"))?;
    scaled(name, &Lit::of(&light, axes))
}

/// Its mean in each cell, over the largest.
fn scaled(name: &str, lit: &Lit) -> Result<Vec<f64>, miette::Report> {
    let last = lit.excitation.len() - 1;
    // The cells at both ends are half ones.
    let whole = |(k, value): (usize, &f64)| if k == 0 || k == last { 2.0 * value } else { *value };
    let values: Vec<f64> = lit.excitation.iter().enumerate().map(whole).collect();
    let most = values.iter().copied().fold(0.0, f64::max);
    if most > 0.0 {
        Ok(values.iter().map(|value| value / most).collect())
    } else {
        Err(miette!("--excitation {name}: nothing above 0 from the first excitation to the last; expected a spectrum"))
    }
}
