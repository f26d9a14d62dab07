//! The excitation spectrum that is known: a factorisation of a file, or two columns.

use miette::miette;

use super::super::{light_source, material};
use crate::cli::opened::open;
use crate::dataset::Factorisation;
use crate::donaldson::estimate::Axes;

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
    scaled(name, loaded.light.nm(), loaded.light.values(), axes)
}

fn of_factors(name: &str, factors: &Factorisation, axes: &Axes) -> Result<Vec<f64>, miette::Report> {
    if factors.rank() != 1 {
        return Err(miette!(
            "--excitation {name}: `{}` has {} factors; expected one: an estimate from few lights is of one dye",
            factors.id,
            factors.rank()
        ));
    }
    scaled(name, &factors.excitation_nm, &factors.excitation.row(0).to_vec(), axes)
}

/// Its values at the excitations, straight between its own wavelengths, over the largest; 0 outside and where noise is below 0.
fn scaled(name: &str, nm: &[f64], values: &[f64], axes: &Axes) -> Result<Vec<f64>, miette::Report> {
    let at = |wanted: &f64| {
        let after = nm.partition_point(|one| one < wanted);
        match (nm.get(after), after) {
            (Some(one), _) if one == wanted => values[after],
            (None, _) | (_, 0) => 0.0,
            (Some(one), _) => {
                let part = (wanted - nm[after - 1]) / (one - nm[after - 1]);
                values[after - 1] + part * (values[after] - values[after - 1])
            }
        }
    };
    let values: Vec<f64> = axes.excitation_nm.iter().map(|nm| at(nm).max(0.0)).collect();
    let most = values.iter().copied().fold(0.0, f64::max);
    if most > 0.0 && most.is_finite() {
        Ok(values.iter().map(|value| value / most).collect())
    } else {
        Err(miette!("--excitation {name}: nothing above 0 from the first excitation to the last; expected a spectrum"))
    }
}
