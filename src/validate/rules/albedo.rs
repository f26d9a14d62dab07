//! Does the elastic part send back more light than fell in? Where terms were fitted, by their integral over all viewing
//! directions; where values are there for enough of these, by theirs.
//!
//! A total may hold more than 1: what is emitted at one wavelength was absorbed at another. So only the part `elastic`
//! is judged.

use std::collections::BTreeMap;

use super::super::Context;
use super::super::finding::Finder;
use super::super::significance::worst;
use super::hemisphere::{Cells, cells};
use super::physics::{ALL, Cell, degrees_of_freedom, report, shared, usable};
use crate::container::layout::name;
use crate::dataset::{Document, FittedTerm, Measurement, Model, Place, Symmetry};
use crate::quantity::{Direction, Geometry, Part, QuantityKind, Reference};
use crate::terms::{Evaluation, Term, TermKind, TorranceSparrow};

const EXPECTED: &str = "at most 1: the elastic part of what falls in";

/// So many angles of incidence of a file are tried, the flattest first: there a specular term is largest.
const MOST_ANGLES: usize = 24;

fn is_elastic(measurement: &Measurement) -> bool {
    measurement.quantity.part == Part::Elastic
}

/// Incidence with every polar angle once, from the flattest on; none from the horizon.
fn incidences(measurement: &Measurement) -> Vec<Direction> {
    let geometries = measurement.acquisitions.iter().filter_map(|row| row.geometry);
    let mut directions: Vec<Direction> = geometries.map(|geometry| geometry.incidence).collect();
    directions.retain(|direction| direction.cos_theta() > 0.0);
    directions.sort_by(|a, b| b.theta_deg().total_cmp(&a.theta_deg()));
    directions.dedup_by(|a, b| a.theta_deg() == b.theta_deg());
    directions.truncate(MOST_ANGLES);
    directions
}

/// Albedos of specular terms of intensity 1, by their shape: a spectral fit has one shape for all wavelengths.
#[derive(Default)]
struct Shapes(BTreeMap<[u64; 4], Option<Evaluation>>);

impl Shapes {
    fn albedo(&mut self, position: usize, term: &Term, incidence: &Direction) -> Option<Evaluation> {
        let Term::TorranceSparrow(specular) = *term else { return term.directional_albedo(incidence).ok() };
        let unit = Term::TorranceSparrow(TorranceSparrow { intensity: 1.0, ..specular });
        let numbers = [specular.roughness, specular.refractive_index, incidence.theta_deg()].map(f64::to_bits);
        let key = [position as u64, numbers[0], numbers[1], numbers[2]];
        let of_one = (*self.0.entry(key).or_insert_with(|| unit.directional_albedo(incidence).ok()))?;
        let [share, by_roughness, by_index] = of_one.by;
        let intensity = specular.intensity;
        Some(Evaluation { value: intensity * share, by: [share, intensity * by_roughness, intensity * by_index] })
    }
}

/// Albedo of all terms with its standard uncertainty; `None` where one of the two is not known.
fn of_terms(model: &Model, emission: usize, incidence: &Direction, shapes: &mut Shapes) -> Option<(f64, f64)> {
    let (mut albedo, mut slopes, mut relative) = (0.0, Vec::new(), 0.0_f64);
    let counts = |term: &FittedTerm| term.kind != TermKind::Luminescent && term.is_seen_at(emission);
    for (position, fitted) in model.terms.iter().enumerate().filter(|(_, term)| counts(term)) {
        let of_term = shapes.albedo(position, &fitted.term_at(emission).ok()?, incidence)?;
        albedo += of_term.value;
        for (parameter, slope) in fitted.kind.parameters().iter().zip(of_term.by) {
            let (u, shared) = uncertainty(fitted, parameter.name, emission)?;
            slopes.push((model.covariance_name(position, parameter.name), slope, u));
            relative = relative.max(shared);
        }
    }
    let independent = propagated(model, emission, &slopes);
    Some((albedo, independent.hypot(albedo * relative)))
}

/// Standard uncertainty of a parameter, and what it shares with all values.
fn uncertainty(term: &FittedTerm, parameter: &str, emission: usize) -> Option<(f64, f64)> {
    let parameter = term.parameters.iter().find(|fitted| fitted.name == parameter)?;
    let at = |numbers: &[f64]| if numbers.len() == 1 { numbers.first() } else { numbers.get(emission) }.copied();
    let shared = at(&parameter.shared_relative_uncertainty).unwrap_or(0.0);
    at(&parameter.standard_uncertainty).filter(|u| u.is_finite()).map(|u| (u, shared))
}

/// Linear propagation through the covariance; where it does not have every parameter, the sum of the magnitudes, which
/// no correlation exceeds.
fn propagated(model: &Model, emission: usize, slopes: &[(String, f64, f64)]) -> f64 {
    let index = |name: &String| model.covariance_parameters.iter().position(|known| known == name);
    let places: Option<Vec<usize>> = slopes.iter().map(|(name, ..)| index(name)).collect();
    let variance = places.and_then(|places| {
        let covariance = model.covariance_at(emission)?;
        let mut sum = 0.0;
        for (i, (_, first, _)) in places.iter().zip(slopes) {
            for (j, (_, second, _)) in places.iter().zip(slopes) {
                sum += first * second * covariance.get((*i, *j))?;
            }
        }
        (sum >= 0.0).then_some(sum)
    });
    variance.map_or_else(|| slopes.iter().map(|(_, slope, u)| (slope * u).abs()).sum(), f64::sqrt)
}

pub(in super::super) fn of_models(context: &Context<'_>, found: &mut Finder) {
    let Some(document) = context.document() else { return };
    for model in document.models.iter().filter(|model| model.unit == "1") {
        let measurement = document.measurement(model.measurement.as_str());
        let Some(measurement) = measurement.filter(|measurement| is_elastic(measurement)) else { continue };
        let (incidences, mut shapes) = (incidences(measurement), Shapes::default());
        let cells = (0..model.emission.len()).flat_map(|emission| incidences.iter().map(move |i| (emission, i)));
        let albedos: Vec<_> = cells
            .filter_map(|(emission, i)| Some(((emission, i), of_terms(model, emission, i, &mut shapes)?)))
            .filter(|(_, (_, sigma))| *sigma > 0.0)
            .collect();
        let scores = albedos.iter().map(|(cell, (albedo, sigma))| ((*cell, *albedo), (albedo - 1.0) / sigma));
        if let Some(worst) = worst(albedos.len(), scores, None) {
            let ((emission, incidence), albedo) = worst.place;
            let place = Place::path(format!("/{}/{}", name::MODEL, model.id)).at_index([emission]);
            let what = format!("an albedo of {albedo:.4} at theta_i = {} degrees", incidence.theta_deg());
            found.add_scored(place, format!("{what}, z = {:.1}", worst.z), EXPECTED, worst.z);
        }
    }
}

/// What brings a value to pi times the radiance over the irradiance of the surface; `None` where that is not known.
fn per_irradiance(measurement: &Measurement, geometry: &Geometry) -> Option<f64> {
    let quantity = &measurement.quantity;
    if quantity.kind == QuantityKind::Brdf {
        return Some(std::f64::consts::PI);
    }
    let stated = matches!(quantity.reference, Reference::SameGeometry | Reference::FixedGeometry { .. });
    let lit = quantity.reference.lit_fraction(geometry).ok().filter(|_| stated && quantity.kind.is_factor())?;
    Some(lit / geometry.incidence.cos_theta())
}

fn symmetry(document: &Document, measurement: &Measurement) -> Option<Symmetry> {
    let id = measurement.sample.as_ref()?;
    document.samples.iter().find(|sample| sample.id == *id)?.symmetry
}

/// Albedo of one emission value with its uncertainty, to which the coarseness of the directions adds; `None` where a
/// part of the hemisphere has no usable value.
fn of_values(measurement: &Measurement, hemisphere: &Cells, column: usize) -> Option<(f64, f64)> {
    let usable_at = |row: &usize| usable(measurement, (*row, column)).map(|(value, sigma)| (*row, value, sigma));
    let mut weights: BTreeMap<usize, (f64, f64, f64)> = BTreeMap::new();
    let (mut first, mut second) = (0.0, 0.0);
    for near in &hemisphere.nearest {
        let mut rows = near.iter().filter_map(usable_at);
        let (row, value, sigma) = rows.next()?;
        let geometry = measurement.acquisitions[row].geometry?;
        let scale = per_irradiance(measurement, &geometry)? / hemisphere.nearest.len() as f64;
        let entry = weights.entry(row).or_insert((0.0, value, sigma));
        entry.0 += scale;
        first += scale * value;
        second += scale * rows.next()?.1;
    }
    let noise: f64 = weights.values().map(|(weight, _, sigma)| (weight * sigma).powi(2)).sum();
    let common = first * shared(measurement, column, &ALL);
    // What another choice among the near directions gives bounds what lies between them.
    Some((first, noise.sqrt().hypot(common).hypot(first - second)))
}

pub(in super::super) fn of_measurements(context: &Context<'_>, found: &mut Finder) {
    let Some(document) = context.document() else { return };
    for (path, measurement) in context.measurements().filter(|(_, measurement)| is_elastic(measurement)) {
        if measurement.uncertainty.standard.is_none() {
            continue;
        }
        let mut albedos: Vec<(Cell, (f64, f64))> = Vec::new();
        for hemisphere in cells(measurement, symmetry(document, measurement)) {
            let columns = 0..measurement.emission.len();
            let of_column = |column| Some(((hemisphere.row, column), of_values(measurement, &hemisphere, column)?));
            albedos.extend(columns.filter_map(of_column));
        }
        let scores = albedos.iter().map(|(cell, (albedo, sigma))| ((*cell, *albedo), (albedo - 1.0) / sigma));
        if let Some(worst) = worst(albedos.len(), scores, degrees_of_freedom(measurement)) {
            let (cell, albedo) = worst.place;
            let what = format!("an albedo of {albedo:.4} over the viewing directions of this incidence");
            report(found, &path, cell, &worst, what, EXPECTED);
        }
    }
}
