//! The radiance factor of a scan: sample over white, times the certified factor, with its uncertainty and the shared
//! parts of it kept apart.

use ndarray::Array2;

use super::Options;
use super::certificate;
use super::error::ImportError;
use super::mean::{Mean, Spread};
use super::noise::{Noise, RECORD_SCALE, kept};
use super::plan::{Plan, geometry_key};
use super::raw::record_scale;
use super::receipt::{Notes, listed};
use super::reference::{self, Groups};
use super::repeats::acquisitions;
use crate::dataset::{Acquisition, Conditions, Derivation, Id, Measurement, Role, WhiteReference};
use crate::quantity::{
    Basis, Component, CorrelatedOver, Flag, Flags, NormalisedAt, Quantity, QuantityKind, Uncertainty,
    ratio_to_reference,
};

/// A reference below this many of its standard uncertainties is below detection: nothing is divided by it.
const DETECTION_SIGMAS: f64 = 3.0;

/// The white reference and the factor that is derived from the raw measurements.
///
/// # Errors
/// [`ImportError`] where the stated reference contradicts the white's geometry or the certificate cannot be read.
pub(super) fn derive(
    plan: &Plan,
    raw: &[Measurement],
    noise: Option<&Noise>,
    options: &Options,
    notes: &mut Notes,
) -> Result<(WhiteReference, Measurement), ImportError> {
    let of = |role: Role| raw.iter().find(|measurement| measurement.role == role);
    let (Some(sample), Some(white)) = (of(Role::Sample), of(Role::White)) else {
        return Err(ImportError::Document(crate::dataset::DocumentError::DanglingReference {
            from: "scan".to_owned(),
            list: "measurements",
            id: "white".to_owned(),
        }));
    };
    let certificate = certificate::read(plan, sample, notes)?;
    let groups = reference::groups(plan, sample, white, options.repeats, notes)?;
    let division = Division::new(sample, white, of(Role::Dark), &groups, noise, notes);
    division.note_dark(plan, notes);
    let measurement = division.measurement(plan, sample, &groups, &certificate, notes);
    Ok((certificate.reference, measurement))
}

/// Means of everything that is divided.
struct Division<'a> {
    sample: &'a Measurement,
    white: &'a Measurement,
    dark: Option<&'a Measurement>,
    rows: Vec<Mean>,
    references: Vec<Mean>,
    dark_mean: Option<Mean>,
    spread: Spread,
}

impl<'a> Division<'a> {
    fn new(
        sample: &'a Measurement,
        white: &'a Measurement,
        dark: Option<&'a Measurement>,
        groups: &Groups,
        noise: Option<&Noise>,
        notes: &mut Notes,
    ) -> Self {
        let all = groups.sample.iter().map(|rows| (sample, rows)).chain(groups.white.iter().map(|rows| (white, rows)));
        let spread = Spread::of(all, noise.is_some());
        notes.assume(crate::dataset::Place::default(), spread.describe());
        let dark_rows: Vec<usize> = dark.map_or_else(Vec::new, |dark| (0..dark.acquisitions.len()).collect());
        let dark_mean = dark.map(|dark| Mean::of(dark, &dark_rows, &spread));
        let rows = groups.sample.iter().map(|rows| Mean::of(sample, rows, &spread)).collect();
        let references = groups.white.iter().map(|rows| Mean::of(white, rows, &spread)).collect();
        Self { sample, white, dark, rows, references, dark_mean, spread }
    }

    /// A mean with the mean dark signal taken off: value and independent standard uncertainty.
    fn signal(&self, mean: &Mean, column: usize) -> (f64, f64) {
        let (value, sigma) = (mean.value[column], mean.sigma[column]);
        let dark = self.dark_mean.as_ref().map(|dark| (dark.value[column], dark.sigma[column]));
        match dark {
            // A dark signal on the floor is an upper bound: between zero and it everything is as likely.
            Some((floor, _)) if self.dark_is_bound(column) && floor.is_finite() => {
                (value, sigma.hypot(floor / 3.0_f64.sqrt()))
            }
            Some((dark, dark_sigma)) if dark.is_finite() => {
                let dark_sigma = if dark_sigma.is_finite() { dark_sigma } else { 0.0 };
                (value - dark, sigma.hypot(dark_sigma))
            }
            _ => (value, sigma),
        }
    }

    /// True where the mean dark signal is itself on the floor.
    fn dark_is_bound(&self, column: usize) -> bool {
        self.dark_mean.as_ref().is_some_and(|dark| dark.flags[column].contains(Flag::BelowDetection))
    }

    /// Says that a dark signal was taken off, and what of it is not known.
    fn note_dark(&self, plan: &Plan, notes: &mut Notes) {
        let Some(dark) = &self.dark_mean else { return };
        let names: Vec<String> = plan.of(Role::Dark).map(|entry| entry.record.label()).collect();
        let bounds = (0..dark.value.len()).filter(|column| self.dark_is_bound(*column)).count();
        let mut text = format!(
            "the mean dark signal of {} is taken off sample and white; at {bounds} of {} wavelengths it lies on the \
             instrument's floor and is only an upper bound: nothing is taken off there and floor/sqrt(3) is added to the \
             standard uncertainty; exposure is not taken into account",
            listed(&names),
            dark.value.len()
        );
        let of = |role: Role| exposures(plan, role);
        let (darks, lit) = (of(Role::Dark), [of(Role::Sample), of(Role::White)].concat());
        if let (Some(dark), Some(lit)) = (range(&darks), range(&lit))
            && dark != lit
        {
            text += &format!(" (dark {dark}, sample and white {lit})");
        }
        notes.assume(plan.place.clone(), text);
    }

    fn measurement(
        &self,
        plan: &Plan,
        sample: &Measurement,
        groups: &Groups,
        certificate: &certificate::Certificate,
        notes: &mut Notes,
    ) -> Measurement {
        let shape = (self.rows.len(), sample.emission.len());
        let mut values = Array2::from_elem(shape, f64::NAN);
        let mut flags = Array2::from_elem(shape, 0_u16);
        let mut sigma = Array2::from_elem(shape, f64::NAN);
        let mut relative = Array2::from_elem(shape, f64::NAN);
        let mut dark_references = 0;
        for row in 0..shape.0 {
            for column in 0..shape.1 {
                let cell = self.cell(row, column, groups, certificate.at(column));
                dark_references += usize::from(cell.reference_dark);
                let at = (row, column);
                (values[at], flags[at], sigma[at], relative[at]) =
                    (cell.value, cell.flags.0, cell.sigma, cell.relative);
            }
        }
        if dark_references > 0 {
            let text = format!("{dark_references} quotients are missing: the reference is below detection there");
            notes.notice(plan.place.clone(), text);
        }
        let components = self.components(groups, &relative, certificate);
        if groups.own_reference() {
            fold_in(&mut sigma, &values, &relative);
        }
        sigma.mapv_inplace(kept);
        let title = plan.settings.title.clone();
        Measurement {
            id: plan.settings.id.as_deref().map_or_else(|| Id::from_title("scan"), Id::from_title),
            title,
            quantity: self.quantity(plan, groups, certificate),
            role: Role::Sample,
            sample: None,
            instrument: None,
            white_reference: Some(certificate.reference.id.clone()),
            emission: sample.emission.clone(),
            excitations: sample.excitations.clone(),
            acquisitions: acquisitions(self.sample, &groups.sample, &self.rows),
            values: values.into_shared(),
            flags: flags.into_shared(),
            uncertainty: Uncertainty {
                standard: self.spread.known().then(|| sigma.into_shared()),
                components,
                ..Uncertainty::default()
            },
            conditions: Conditions::default(),
            direction_tests: Vec::new(),
            derivation: Some(self.derivation(groups)),
        }
    }

    fn cell(&self, row: usize, column: usize, groups: &Groups, certified: f64) -> Cell {
        let mean = &self.rows[row];
        let missing = |flags: Flags, reference_dark: bool| Cell {
            value: f64::NAN,
            flags,
            sigma: f64::NAN,
            relative: f64::NAN,
            reference_dark,
        };
        let flags = mean.flags[column];
        let Some(reference) = groups.row_reference[row].and_then(|group| self.references.get(group)) else {
            return missing(flags.with(Flag::NotMeasured), false);
        };
        let numerator = self.signal(mean, column);
        let denominator = self.signal(reference, column);
        let reference_flags = reference.flags[column];
        let dark = reference_flags.contains(Flag::BelowDetection) || denominator.0 <= DETECTION_SIGMAS * denominator.1;
        if dark {
            return missing(flags.with(Flag::BelowDetection), true);
        }
        match ratio_to_reference(numerator, denominator, certified) {
            Some(quotient) => Cell {
                value: quotient.value,
                flags: flags.union(reference_flags),
                sigma: quotient.sigma_numerator,
                relative: quotient.relative_denominator,
                reference_dark: false,
            },
            None if numerator.0.is_finite() && denominator.0.is_finite() => {
                missing(flags.with(Flag::BelowDetection), true)
            }
            None => {
                let reason = flags.union(reference_flags);
                missing(if reason.explains_absence() { reason } else { reason.with(Flag::Invalid) }, false)
            }
        }
    }

    /// What is shared: the white's noise by all rows at a wavelength, its scale by everything, a record's scale by its
    /// wavelengths, the certificate by everything. With a reference for each row, its noise is independent and not here.
    fn components(
        &self,
        groups: &Groups,
        relative: &Array2<f64>,
        certificate: &certificate::Certificate,
    ) -> Vec<Component> {
        let mut components = Vec::new();
        let scale = self.spread.record_scale();
        let repeats = |means: &[Mean]| means.iter().map(|mean| mean.count).min().unwrap_or(1).max(1) as f64;
        let sample_scale = scale.unwrap_or(RECORD_SCALE) / repeats(&self.rows).sqrt();
        let white_scale = scale.unwrap_or(RECORD_SCALE) / repeats(&self.references).sqrt();
        let own = groups.own_reference();
        if self.spread.known() {
            components.push(record_scale(if own { sample_scale.hypot(white_scale) } else { sample_scale }));
        }
        if self.spread.known() && !own {
            components.push(Component::new(
                "white reference",
                relative.columns().into_iter().map(|column| root_mean_square(column.iter())).collect(),
                CorrelatedOver::Acquisitions,
            ));
            components.push(Component::new("white reference scale", vec![white_scale], CorrelatedOver::All));
        }
        if let Some(uncertainty) = certificate.reference.certified_relative_uncertainty {
            components.push(Component::new("certified factor", vec![uncertainty.get()], CorrelatedOver::All));
        }
        components
    }

    fn quantity(&self, plan: &Plan, groups: &Groups, certificate: &certificate::Certificate) -> Quantity {
        Quantity {
            kind: QuantityKind::RadianceFactor,
            part: plan.settings.part.unwrap_or(self.sample.quantity.part),
            normalised_at: NormalisedAt::Emission,
            basis: Basis::Energy,
            reference: groups.reference,
            reference_light: groups.reference_light.clone(),
            certified_factor: certificate.factor.clone(),
        }
    }

    fn derivation(&self, groups: &Groups) -> Derivation {
        let invert = |groups: &[Vec<usize>], rows: usize| {
            let mut of = vec![-1; rows];
            for (group, members) in groups.iter().enumerate() {
                for row in members {
                    of[*row] = i32::try_from(group).unwrap_or(-1);
                }
            }
            of
        };
        Derivation {
            numerator: self.sample.id.clone(),
            numerator_row: invert(&groups.sample, self.sample.acquisitions.len()),
            reference: self.white.id.clone(),
            reference_group: invert(&groups.white, self.white.acquisitions.len()),
            row_reference: groups
                .row_reference
                .iter()
                .map(|group| group.and_then(|group| i32::try_from(group).ok()).unwrap_or(-1))
                .collect(),
            dark: self.dark.map(|dark| dark.id.clone()),
        }
    }
}

struct Cell {
    value: f64,
    flags: Flags,
    sigma: f64,
    relative: f64,
    reference_dark: bool,
}

/// The known exposures of a role, ms.
fn exposures(plan: &Plan, role: Role) -> Vec<f64> {
    plan.of(role).filter_map(|entry| entry.exposure_ms.or(entry.record.details.exposure_ms)).collect()
}

fn range(exposures: &[f64]) -> Option<String> {
    let (shortest, longest) =
        (exposures.iter().copied().reduce(f64::min)?, exposures.iter().copied().reduce(f64::max)?);
    Some(if shortest == longest { format!("{shortest} ms") } else { format!("{shortest} to {longest} ms") })
}

/// Adds the reference's relative uncertainty to that of each value.
fn fold_in(sigma: &mut Array2<f64>, values: &Array2<f64>, relative: &Array2<f64>) {
    ndarray::Zip::from(sigma).and(values).and(relative).for_each(|sigma, value, relative| {
        *sigma = sigma.hypot(value * relative);
    });
}

fn root_mean_square<'a>(numbers: impl Iterator<Item = &'a f64>) -> f64 {
    let (sum, count) = numbers
        .filter(|number| number.is_finite())
        .fold((0.0, 0.0), |(sum, count), number| (sum + number * number, count + 1.0));
    if count > 0.0 { (sum / count).sqrt() } else { 0.0 }
}

/// The key by which rows of a sample are repeats of each other.
pub(super) fn repeat_key(acquisition: &Acquisition) -> (Option<[u64; 4]>, Option<u32>) {
    (acquisition.geometry.as_ref().map(geometry_key), acquisition.excitation)
}
