//! `# key: value` lines: what tables and manifests state once for all their rows. The same keys are the options of a
//! call, so that every importer fills the same settings.

use std::str::FromStr;

use super::angles::Angles;
use super::details::{self, Detail};
use super::error::{ImportError, fault, quoted};
use super::number::value;
use crate::dataset::Place;
use crate::quantity::{Band, Basis, NormalisedAt, Part, Quantity, QuantityKind, Reference, ReferenceLight, named};

/// What the source or the caller states once. `None` is what nobody stated.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Settings {
    /// What the numbers are.
    pub quantity: Option<QuantityKind>,
    /// Which part of the radiated light.
    pub part: Option<Part>,
    /// Where a ratio is normalised.
    pub normalised_at: Option<NormalisedAt>,
    /// Energy or photons.
    pub basis: Option<Basis>,
    /// Geometry of the reference.
    pub reference: Option<Reference>,
    /// Light of the reference.
    pub reference_light: Option<ReferenceLight>,
    /// Certified radiance factor of the reference: a number for all wavelengths, or the name of a two-column file.
    pub certified_factor: Option<String>,
    /// Its relative standard uncertainty.
    pub certified_relative_uncertainty: Option<f64>,
    /// Number of the certificate.
    pub certificate: Option<String>,
    /// How angles are written.
    pub angles: Option<Angles>,
    /// Title of the document.
    pub title: Option<String>,
    /// Name of the sample.
    pub sample: Option<String>,
    /// Material of the sample.
    pub material: Option<String>,
    /// Where the sample's mark is.
    pub mark: Option<String>,
    /// SPDX identifier of the data's licence.
    pub license: Option<String>,
    /// How to cite the data.
    pub citation: Option<String>,
    /// Identifier of the measurement in the document.
    pub id: Option<String>,
    /// Make and model of the instrument.
    pub instrument: Option<String>,
    /// Its serial number.
    pub serial: Option<String>,
    /// Name of the light that all rows are measured under.
    pub light: Option<String>,
    /// Excitation wavelength of all rows, nm.
    pub excitation_nm: Option<f64>,
    /// Its full width at half maximum, nm.
    pub excitation_fwhm_nm: Option<f64>,
    /// Filter before the light.
    pub filter: Option<String>,
    /// Bandpass of the instrument (full width at half maximum), nm.
    pub bandpass_nm: Option<f64>,
    /// The band of values without a wavelength.
    pub band: Option<Band>,
    /// Offset of the times from UTC, as in `+09:00` or `Z`.
    pub time_zone: Option<String>,
    /// True when the numbers were computed and not measured.
    pub simulated: Option<bool>,
    /// What a table's uncertainties are multiples of the standard uncertainty by; 1 where nothing is said.
    pub coverage_factor: Option<f64>,
    /// What the first column of a matrix holds.
    pub rows: Option<MatrixRows>,
    /// Particulars by the names of the document's fields, as `instrument.distance-mm`.
    pub details: Vec<Detail>,
    /// Where each key was stated, the later ones behind.
    pub places: Vec<(String, Place)>,
}

named! {
    /// Which wavelengths stand down the first column of a matrix; the others stand along its first row.
    MatrixRows, "rows" {
        /// Each row is an emission wavelength.
        Emission = "emission",
        /// Each row is an excitation wavelength.
        Excitation = "excitation",
    }
}

/// Every key, in the spelling of the messages; `_` may stand for `-` and the other way round.
pub const KEYS: &[&str] = &[
    "quantity",
    "part",
    "normalised-at",
    "basis",
    "reference",
    "reference-light",
    "certified-factor",
    "certified-relative-uncertainty",
    "certificate",
    "angles",
    "title",
    "sample",
    "material",
    "mark",
    "license",
    "citation",
    "id",
    "instrument",
    "serial",
    "light",
    "excitation-nm",
    "excitation-fwhm-nm",
    "filter",
    "bandpass-nm",
    "band-nm",
    "time-zone",
    "simulated",
    "coverage-factor",
    "rows",
];

/// Why a key was not taken: what was expected.
pub(crate) enum KeyFault {
    Unknown,
    Value(String),
}

impl Settings {
    /// Takes one key.
    pub(crate) fn set(&mut self, key: &str, text: &str) -> Result<(), KeyFault> {
        let name = canonical(key);
        let text = text.trim();
        match name.as_str() {
            "quantity" => self.quantity = Some(member(text)?),
            "part" => self.part = Some(member(text)?),
            "normalised-at" => self.normalised_at = Some(member(text)?),
            "basis" => self.basis = Some(member(text)?),
            "reference" => self.reference = Some(member(text)?),
            "reference-light" => self.reference_light = Some(member(text)?),
            "certified-factor" => self.certified_factor = Some(text.to_owned()),
            "certified-relative-uncertainty" => self.certified_relative_uncertainty = Some(positive(text)?),
            "certificate" => self.certificate = Some(text.to_owned()),
            "angles" => self.angles = Some(member(text)?),
            "title" => self.title = Some(text.to_owned()),
            "sample" => self.sample = Some(text.to_owned()),
            "material" => self.material = Some(text.to_owned()),
            "mark" => self.mark = Some(text.to_owned()),
            "license" => self.license = Some(text.to_owned()),
            "citation" => self.citation = Some(text.to_owned()),
            "id" => self.id = Some(text.to_owned()),
            "instrument" => self.instrument = Some(text.to_owned()),
            "serial" => self.serial = Some(text.to_owned()),
            "light" => self.light = Some(text.to_owned()),
            "excitation-nm" => self.excitation_nm = Some(positive(text)?),
            "excitation-fwhm-nm" => self.excitation_fwhm_nm = Some(positive(text)?),
            "filter" => self.filter = Some(text.to_owned()),
            "bandpass-nm" => self.bandpass_nm = Some(positive(text)?),
            "band-nm" => self.band = Some(band(text)?),
            "time-zone" => self.time_zone = Some(text.to_owned()),
            "simulated" => self.simulated = Some(yes_or_no(text)?),
            "coverage-factor" => self.coverage_factor = Some(positive(text)?),
            "rows" => self.rows = Some(member(text)?),
            _ => return Err(KeyFault::Unknown),
        }
        Ok(())
    }

    /// Takes one key that the caller states, in the spelling of [`KEYS`].
    ///
    /// # Errors
    /// [`ImportError::Call`] for an unknown key or a value that it cannot have.
    pub fn state(&mut self, key: &str, text: &str) -> Result<(), ImportError> {
        self.take(key, text, Place::file("the call"))
    }

    /// Takes a key from a file; the same as [`Settings::set`] with the message.
    pub(crate) fn take(&mut self, key: &str, text: &str, place: Place) -> Result<(), ImportError> {
        let name = canonical(key);
        if details::is_detail(&name) {
            self.details.push(Detail { key: name, text: text.trim().to_owned(), place });
            return Ok(());
        }
        self.places.push((name, place.clone()));
        self.set(key, text).map_err(|why| {
            let (found, expected) = match why {
                KeyFault::Unknown => {
                    let parts = details::PARTS.map(|part| format!("{part}.FIELD")).join(", ");
                    (format!("the unknown key {}", quoted(key)), format!("one of: {}, {parts}", KEYS.join(", ")))
                }
                KeyFault::Value(expected) => (format!("{} as the value of {}", quoted(text), quoted(key)), expected),
            };
            ImportError::Call(fault(place, found, expected, "correct the key, or take the line out"))
        })
    }

    /// Takes a key from a file; the same key may come again with the same value only. `taken` holds the keys so far.
    pub(crate) fn take_once(
        &mut self,
        key: &str,
        text: &str,
        place: Place,
        taken: &mut Vec<(String, String, Place)>,
    ) -> Result<(), ImportError> {
        let name = canonical(key);
        let text = text.trim();
        if let Some((_, before, at)) = taken.iter().find(|(known, before, _)| *known == name && before != text) {
            return Err(ImportError::Contradiction(fault(
                place,
                format!("{} as {} where {at} says {}", quoted(key), quoted(text), quoted(before)),
                "one value for a key",
                "take one of the two lines out",
            )));
        }
        self.take(key, text, place.clone())?;
        taken.push((name, text.to_owned(), place));
        Ok(())
    }

    /// The keys that these settings and `other` both state, with different values: key, value here, value there.
    pub(crate) fn contradicts(&self, other: &Self) -> Vec<(&'static str, String, String)> {
        let mut found = Vec::new();
        macro_rules! compare {
            ($($field:ident),+) => { $(
                if let (Some(here), Some(there)) = (&self.$field, &other.$field)
                    && here != there
                {
                    found.push((stringify!($field), quoted(&here.to_string()), quoted(&there.to_string())));
                }
            )+ };
        }
        compare!(
            quantity,
            part,
            normalised_at,
            basis,
            reference,
            reference_light,
            certified_factor,
            certified_relative_uncertainty,
            certificate,
            angles,
            title,
            sample,
            material,
            mark,
            license,
            citation,
            id,
            instrument,
            serial,
            light,
            excitation_nm,
            excitation_fwhm_nm,
            filter,
            bandpass_nm,
            band,
            time_zone,
            simulated,
            coverage_factor,
            rows
        );
        found
    }

    /// The quantity that is stated, with `unstated` where it is not.
    pub(crate) fn quantity(&self) -> Quantity {
        let kind = self.quantity.unwrap_or(QuantityKind::Unstated);
        let absolute = !kind.is_factor() && !is_relative_to_light(kind) && kind != QuantityKind::Unstated;
        let base = if absolute { Quantity::absolute(kind, Part::Unstated) } else { Quantity::unstated(kind) };
        Quantity {
            kind,
            part: self.part.unwrap_or(base.part),
            normalised_at: self.normalised_at.unwrap_or(base.normalised_at),
            basis: self.basis.unwrap_or(if kind == QuantityKind::Unstated { base.basis } else { basis_of(absolute) }),
            reference: self.reference.unwrap_or(base.reference),
            reference_light: self.reference_light.clone().unwrap_or(base.reference_light),
            certified_factor: Vec::new(),
        }
    }

    /// These settings where they are stated, else those of `other`.
    pub(crate) fn or(self, other: &Self) -> Self {
        let mut merged = other.clone();
        macro_rules! take {
            ($($field:ident),+) => { $(if self.$field.is_some() { merged.$field = self.$field; })+ };
        }
        take!(
            quantity,
            part,
            normalised_at,
            basis,
            reference,
            reference_light,
            certified_factor,
            certified_relative_uncertainty,
            certificate,
            angles,
            title,
            sample,
            material,
            mark,
            license,
            citation,
            id,
            instrument,
            serial,
            light,
            excitation_nm,
            excitation_fwhm_nm,
            filter,
            bandpass_nm,
            band,
            time_zone,
            simulated,
            coverage_factor,
            rows
        );
        // What is stated later goes before.
        merged.details.extend(self.details);
        merged.places.extend(self.places);
        merged
    }

    /// Where a key was stated, in the spelling of [`KEYS`]; `otherwise` where it was not.
    pub(crate) fn place_of(&self, key: &str, otherwise: Place) -> Place {
        self.places.iter().rev().find(|(known, _)| known == key).map_or(otherwise, |(_, place)| place.clone())
    }
}

/// The spelling of [`KEYS`].
fn canonical(key: &str) -> String {
    key.trim().to_ascii_lowercase().replace('_', "-")
}

/// Radiance in W is energy by its unit; whether a ratio was formed of photons must be stated.
fn basis_of(absolute: bool) -> Basis {
    if absolute { Basis::Energy } else { Basis::Unstated }
}

/// Quantities that are ratios to the incident light, whatever the reference was.
fn is_relative_to_light(kind: QuantityKind) -> bool {
    use QuantityKind::{BispectralLuminescentRadianceFactor, Brdf, Brrdf, DonaldsonMatrix, RelativeSpectrum};
    matches!(kind, Brdf | Brrdf | BispectralLuminescentRadianceFactor | DonaldsonMatrix | RelativeSpectrum)
}

fn member<T: FromStr<Err = crate::quantity::UnknownName>>(text: &str) -> Result<T, KeyFault> {
    text.parse().map_err(|error: crate::quantity::UnknownName| KeyFault::Value(error.expected))
}

fn positive(text: &str) -> Result<f64, KeyFault> {
    value(text).filter(|number| *number > 0.0).ok_or_else(|| KeyFault::Value("a positive number".to_owned()))
}

fn yes_or_no(text: &str) -> Result<bool, KeyFault> {
    match text {
        "true" | "yes" => Ok(true),
        "false" | "no" => Ok(false),
        _ => Err(KeyFault::Value("true or false".to_owned())),
    }
}

/// `500-620`.
pub(crate) fn band(text: &str) -> Result<Band, KeyFault> {
    let expected = || KeyFault::Value("two wavelengths in nm, as in 500-620".to_owned());
    let (from, to) = text.split_once('-').ok_or_else(expected)?;
    let (from, to) = (value(from).ok_or_else(expected)?, value(to).ok_or_else(expected)?);
    if from > 0.0 && to > from { Ok(Band { from_nm: from, to_nm: to }) } else { Err(expected()) }
}

/// A comment line as key and value: `# key: value`.
pub(crate) fn key_line(text: &str) -> Option<(&str, &str)> {
    let (key, value) = text.trim().strip_prefix('#')?.split_once(':')?;
    let key = key.trim();
    let plain = !key.is_empty() && key.chars().all(|c| c.is_ascii_alphanumeric() || matches!(c, '-' | '_' | '.'));
    plain.then_some((key, value.trim()))
}
