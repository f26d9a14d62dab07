//! Can it be so? What nature does not do, beyond the stated uncertainty.
//!
//! All compare z-scores with one threshold for all values together (`significance`), so that a large clean file is as
//! quiet as a small one. Values without an uncertainty are not judged.

use std::collections::BTreeMap;

use super::super::Context;
use super::super::finding::Finder;
use super::super::significance::{Worst, worst};
use crate::container::layout::name;
use crate::dataset::{Measurement, Place, Role, Symmetry};
use crate::quantity::{Bandpass, Basis, CorrelatedOver, EmissionAxis, Finite, Geometry, Part, QuantityKind, Reference};

pub(super) type Cell = (usize, usize);

/// A value that may be judged, with its standard uncertainty.
pub(super) fn usable(measurement: &Measurement, (row, column): Cell) -> Option<(f64, f64)> {
    let flags = measurement.flags_at(row, column);
    let value = measurement.values.get((row, column)).copied().filter(|value| value.is_finite())?;
    let sigma = measurement.uncertainty.standard.as_ref()?.get((row, column)).copied().filter(|sigma| *sigma > 0.0)?;
    (flags.0 == 0 && sigma.is_finite()).then_some((value, sigma))
}

/// Relative standard uncertainty that a value shares with others, of those kinds of sharing.
pub(super) fn shared(measurement: &Measurement, column: usize, over: &[CorrelatedOver]) -> f64 {
    let components = measurement.uncertainty.components.iter().filter(|c| over.contains(&c.correlated_over));
    components.map(|component| component.relative_at(column).powi(2)).sum::<f64>().sqrt()
}

pub(super) fn degrees_of_freedom(measurement: &Measurement) -> Option<f64> {
    measurement.uncertainty.statement.degrees_of_freedom.map(Finite::get)
}

pub(super) fn report(
    found: &mut Finder,
    path: &str,
    cell: Cell,
    worst: &Worst<impl Copy>,
    what: String,
    expected: &str,
) {
    let more = if worst.beyond > 1 {
        format!("; {} values are beyond {:.1}", worst.beyond, worst.threshold)
    } else {
        String::new()
    };
    let place = Place::path(format!("{path}/{}", name::VALUE)).at_index([cell.0, cell.1]);
    found.add_scored(place, format!("{what}, z = {:.1}{more}", worst.z), expected, worst.z);
}

pub(super) const ALL: [CorrelatedOver; 3] =
    [CorrelatedOver::Wavelengths, CorrelatedOver::Acquisitions, CorrelatedOver::All];

pub(in super::super) fn negative(context: &Context<'_>, found: &mut Finder) {
    for (path, measurement, _) in context.counted().filter(|(_, _, census)| census.values.negative) {
        let Some(standard) = &measurement.uncertainty.standard else { continue };
        let judged = |((value, sigma), flags): &((&f64, &f64), &u16)| {
            value.is_finite() && **sigma > 0.0 && sigma.is_finite() && **flags == 0
        };
        let comparisons = measurement.values.iter().zip(standard).zip(&measurement.flags).filter(judged).count();
        // Only what is negative can be too negative.
        let columns = measurement.emission.len().max(1);
        let values = measurement.values.iter().enumerate();
        let below = values.filter(|(_, value)| **value < 0.0).map(move |(k, _)| (k / columns, k % columns));
        let scores = below.filter_map(|cell| {
            let (value, sigma) = usable(measurement, cell)?;
            Some((cell, -value / sigma.hypot(value * shared(measurement, cell.1, &ALL))))
        });
        if let Some(worst) = worst(comparisons, scores, degrees_of_freedom(measurement)) {
            let value = measurement.values[worst.place];
            report(found, &path, worst.place, &worst, value.to_string(), "zero or more: no light is less than none");
        }
    }
}

/// Nominal excitation of a row with its width, nm.
fn excitation(measurement: &Measurement, row: usize) -> Option<(f64, f64)> {
    let state = measurement.excitation_of(measurement.acquisitions.get(row)?)?;
    Some((state.centre_nm()?, state.fwhm_nm?))
}

/// Emission wavelengths with the width of the bandpass, nm.
fn emission(measurement: &Measurement) -> Option<Vec<(f64, f64)>> {
    let EmissionAxis::Wavelengths(axis) = &measurement.emission else { return None };
    let Bandpass::Stated { fwhm_nm, .. } = &axis.bandpass else { return None };
    let width = |column: usize| fwhm_nm.get(column).or(fwhm_nm.last()).copied();
    axis.nm.iter().enumerate().map(|(column, nm)| Some((*nm, width(column)?))).collect()
}

pub(in super::super) fn anti_stokes(context: &Context<'_>, found: &mut Finder) {
    for (path, measurement) in context.measurements().filter(|(_, m)| m.role == Role::Sample) {
        let Some(emission) = emission(measurement) else { continue };
        let rows = (0..measurement.acquisitions.len()).filter_map(|row| Some((row, excitation(measurement, row)?)));
        let beyond = rows.flat_map(|(row, (excited, excitation_width))| {
            // Triangles of that half width end a full width away from their centres.
            let below =
                move |(_, (emitted, width)): &(usize, &(f64, f64))| *emitted < excited - excitation_width - width;
            emission.iter().enumerate().filter(below).map(move |(column, _)| (row, column))
        });
        let scores: Vec<(Cell, f64)> = beyond
            .filter_map(|cell| {
                let (value, sigma) = usable(measurement, cell)?;
                Some((cell, value / sigma.hypot(value * shared(measurement, cell.1, &ALL))))
            })
            .collect();
        if let Some(worst) = worst(scores.len(), scores.iter().copied(), degrees_of_freedom(measurement)) {
            let excited = excitation(measurement, worst.place.0).map_or(f64::NAN, |excitation| excitation.0);
            let what =
                format!("{} at {} nm under {excited} nm", measurement.values[worst.place], emission[worst.place.1].0);
            report(found, &path, worst.place, &worst, what, "nothing: emission has less energy than what excites it");
        }
    }
}

/// Width of the emission axis that each value stands for, nm: half way to both neighbours.
fn steps(nm: &[(f64, f64)]) -> Vec<f64> {
    (0..nm.len())
        .map(|k| {
            let from = if k == 0 { nm[k].0 } else { nm[k - 1].0 };
            let to = nm.get(k + 1).map_or(nm[k].0, |next| next.0);
            (to - from) / 2.0
        })
        .collect()
}

/// Energy or photons out over in, for each row of a bispectral measurement, with its standard uncertainty; as a diffuser
/// would radiate them. `power` 0 keeps the basis of the values, 1 turns energy into photons, -1 photons into energy.
fn balance(measurement: &Measurement, power: i32) -> Vec<(Cell, (f64, f64))> {
    let density = measurement.quantity.kind == QuantityKind::BispectralLuminescentRadianceFactor;
    let matrix = measurement.quantity.kind == QuantityKind::DonaldsonMatrix;
    let Some(emission) = emission(measurement).filter(|_| density || matrix) else { return Vec::new() };
    let steps = steps(&emission);
    let row_sum = |row: usize| {
        let (excited, excitation_width) = excitation(measurement, row)?;
        let (mut sum, mut variance) = (0.0, 0.0);
        for (column, ((emitted, width), step)) in emission.iter().zip(&steps).enumerate() {
            // The diagonal of a matrix is reflected light, at the wavelength of incidence.
            if matrix && (emitted - excited).abs() < width + excitation_width {
                continue;
            }
            let Some((value, sigma)) = usable(measurement, (row, column)) else { continue };
            let per_value = step * (emitted / excited).powi(power) / if matrix { *width } else { 1.0 };
            sum += value * per_value;
            variance += (sigma * per_value).powi(2);
        }
        let common = sum * shared(measurement, 0, &ALL);
        Some(((row, 0), (sum, variance.sqrt().hypot(common))))
    };
    (0..measurement.acquisitions.len()).filter_map(row_sum).collect()
}

fn exceeds_one(context: &Context<'_>, found: &mut Finder, power: impl Fn(Basis) -> Option<i32>, expected: &str) {
    for (path, measurement) in context.measurements() {
        let Some(power) = power(measurement.quantity.basis) else { continue };
        let sums: BTreeMap<Cell, (f64, f64)> = balance(measurement, power).into_iter().collect();
        let scores =
            sums.iter().filter(|(_, (_, sigma))| *sigma > 0.0).map(|(cell, (sum, sigma))| (*cell, (sum - 1.0) / sigma));
        if let Some(worst) = worst(sums.len(), scores, degrees_of_freedom(measurement)) {
            let sum = sums.get(&worst.place).map_or(f64::NAN, |sum| sum.0);
            report(found, &path, worst.place, &worst, format!("{sum:.4} out of 1 over the row"), expected);
        }
    }
}

pub(in super::super) fn energy_balance(context: &Context<'_>, found: &mut Finder) {
    let power = |basis| match basis {
        Basis::Energy => Some(0),
        Basis::Photon => Some(-1),
        Basis::Unstated => None,
    };
    exceeds_one(context, found, power, "at most the energy that fell in");
}

pub(in super::super) fn photon_balance(context: &Context<'_>, found: &mut Finder) {
    let power = |basis| match basis {
        Basis::Energy => Some(1),
        Basis::Photon => Some(0),
        Basis::Unstated => None,
    };
    exceeds_one(context, found, power, "at most one photon for each that fell in");
}

/// A geometry as a key, in units of 1e-9 degrees, so that angles with rounding agree.
type Key = [i64; 4];

fn key(angles: [f64; 4]) -> Key {
    let [theta_i, phi_i, theta_v, phi_v] = angles;
    let unit = |degrees: f64| (degrees * 1e9).round() as i64;
    let azimuth = |theta: f64, phi: f64| if theta == 0.0 { 0 } else { unit(phi.rem_euclid(360.0)) % 360_000_000_000 };
    [unit(theta_i), azimuth(theta_i, phi_i), unit(theta_v), azimuth(theta_v, phi_v)]
}

fn angles(geometry: &Geometry) -> [f64; 4] {
    let (i, v) = (geometry.incidence, geometry.viewing);
    [i.theta_deg(), i.phi_deg(), v.theta_deg(), v.phi_deg()]
}

/// Compares every row with the first whose geometry maps onto it, value by value; `factor` brings a row's values into
/// the quantity that must agree. What all rows share cancels; the scale of a record does not.
fn compare(
    measurement: &Measurement,
    images: impl Fn(&Geometry) -> Vec<[f64; 4]>,
    factor: impl Fn(&Geometry) -> f64,
) -> Vec<((Cell, usize), f64)> {
    let mut by_key: BTreeMap<(Option<u32>, Key), usize> = BTreeMap::new();
    let mut scores = Vec::new();
    for (row, acquisition) in measurement.acquisitions.iter().enumerate() {
        let Some(geometry) = &acquisition.geometry else { continue };
        let partner =
            images(geometry).into_iter().find_map(|image| by_key.get(&(acquisition.excitation, key(image))).copied());
        if let Some((partner, other)) = partner.and_then(|p| Some((p, measurement.acquisitions[p].geometry?))) {
            let (this, that) = (factor(geometry), factor(&other));
            for column in 0..measurement.emission.len() {
                let pair = usable(measurement, (row, column)).zip(usable(measurement, (partner, column)));
                let Some(((a, sigma_a), (b, sigma_b))) = pair else { continue };
                let scale = shared(measurement, column, &[CorrelatedOver::Wavelengths]);
                let sigma = |value: f64, sigma: f64, factor: f64| (factor * sigma).hypot(factor * value * scale);
                let spread = sigma(a, sigma_a, this).hypot(sigma(b, sigma_b, that));
                scores.push((((row, column), partner), (a * this - b * that).abs() / spread));
            }
        }
        by_key.entry((acquisition.excitation, key(angles(geometry)))).or_insert(row);
    }
    scores
}

fn report_pair(
    found: &mut Finder,
    path: &str,
    measurement: &Measurement,
    scores: Vec<((Cell, usize), f64)>,
    expected: &str,
) {
    let scores = scores.iter().copied();
    if let Some(worst) = worst(scores.len(), scores, degrees_of_freedom(measurement)) {
        let ((row, column), partner) = worst.place;
        let (a, b) = (measurement.values[(row, column)], measurement.values[(partner, column)]);
        report(found, path, (row, column), &worst, format!("{a} here and {b} in row {partner}"), expected);
    }
}

pub(in super::super) fn reciprocity(context: &Context<'_>, found: &mut Finder) {
    for (path, measurement) in context.measurements().filter(|(_, m)| m.quantity.part == Part::Elastic) {
        // The factor over what the reference received, times cos(theta_i) over it, is pi times the BRDF, which is reciprocal.
        let factor: fn(&Geometry) -> f64 = match (measurement.quantity.kind, measurement.quantity.reference) {
            (QuantityKind::Brdf, _) => |_| 1.0,
            (kind, Reference::SameGeometry) if kind.is_factor() => |_| 1.0,
            (kind, Reference::FixedGeometry { .. }) if kind.is_factor() => {
                |geometry| 1.0 / geometry.incidence.cos_theta()
            }
            _ => continue,
        };
        let exchanged = |g: &Geometry| {
            let [theta_i, phi_i, theta_v, phi_v] = angles(g);
            // As it is, and turned by half a turn, in which an in-plane scan finds its partners.
            vec![[theta_v, phi_v, theta_i, phi_i], [theta_v, phi_v + 180.0, theta_i, phi_i + 180.0]]
        };
        let own_image = |row: &((Cell, usize), f64)| row.0.0.0 != row.0.1;
        let scores = compare(measurement, exchanged, factor).into_iter().filter(own_image).collect();
        report_pair(
            found,
            &path,
            measurement,
            scores,
            "equal after division by cos(theta_i): incidence and viewing may be exchanged",
        );
    }
}

pub(in super::super) fn symmetry(context: &Context<'_>, found: &mut Finder) {
    let Some(document) = context.document() else { return };
    for (path, measurement) in context.measurements().filter(|(_, m)| m.role == Role::Sample) {
        let sample = measurement.sample.as_ref().and_then(|id| document.samples.iter().find(|part| part.id == *id));
        let images: fn(&Geometry) -> Vec<[f64; 4]> = match sample.and_then(|sample| sample.symmetry) {
            Some(Symmetry::Mirror) => |g| {
                let [theta_i, phi_i, theta_v, phi_v] = angles(g);
                vec![[theta_i, -phi_i, theta_v, -phi_v]]
            },
            Some(Symmetry::Isotropic) => |g| {
                let [theta_i, phi_i, theta_v, phi_v] = angles(g);
                let half_turn = [theta_i, phi_i + 180.0, theta_v, phi_v + 180.0];
                vec![half_turn, [theta_i, -phi_i, theta_v, -phi_v], [theta_i, 180.0 - phi_i, theta_v, 180.0 - phi_v]]
            },
            Some(Symmetry::None) | None => continue,
        };
        let scores = compare(measurement, images, |_| 1.0);
        report_pair(found, &path, measurement, scores, "equal: the sample is declared symmetric");
    }
}

pub(in super::super) fn drift(context: &Context<'_>, found: &mut Finder) {
    for (path, measurement) in context.measurements().filter(|(_, m)| m.role == Role::Sample) {
        let scores = compare(measurement, |geometry| vec![angles(geometry)], |_| 1.0);
        report_pair(
            found,
            &path,
            measurement,
            scores,
            "equal: it is the same geometry again, so lamp or sample changed",
        );
    }
}
