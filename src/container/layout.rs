//! The one table of every path and attribute name of the standard, with type, unit and meaning. Reader, writer, rules
//! and the tables of the specification take the names from here.

use std::borrow::Cow;
use std::collections::HashMap;
use std::sync::LazyLock;

use super::fields::entries;
use crate::dataset::{Conditions, Instrument, Light, Sample, WhiteReference};
use crate::quantity::Statement;

/// Version of the standard that is written.
pub const VERSION: &str = "1.0";
/// The major version that is understood.
pub const MAJOR: u64 = 1;
/// The minor version that is understood in full.
pub const MINOR: u64 = 0;
/// Value of the root attribute `Conventions`.
pub const CONVENTIONS: &str = "CF-1.11 BBRF-1.0";

/// The version that a file states, as major and minor; `None` where the text has another form.
#[must_use]
pub fn parse_version(text: &str) -> Option<(u64, u64)> {
    let (major, minor) = text.split_once('.')?;
    Some((major.parse().ok()?, minor.parse().ok()?))
}

/// Names of groups, datasets and attributes.
#[allow(missing_docs)]
pub mod name {
    pub const SAMPLE: &str = "sample";
    pub const INSTRUMENT: &str = "instrument";
    pub const LIGHT: &str = "light";
    pub const WHITE_REFERENCE: &str = "white_reference";
    pub const MEASUREMENT: &str = "measurement";
    pub const MODEL: &str = "model";
    pub const FACTORISATION: &str = "factorisation";
    pub const PROVENANCE: &str = "provenance";
    pub const DERIVATION: &str = "derivation";
    pub const SEPARABILITY: &str = "separability";
    pub const DONALDSON: &str = "donaldson";
    pub const TERM: &str = "term_";
    pub const PARAMETER: &str = "parameter_";
    pub const COMPONENT: &str = "value_u_shared_";
    pub const INDEX: &str = "_index";

    pub const CONVENTIONS: &str = "Conventions";
    pub const BBRF_VERSION: &str = "bbrf_version";
    pub const DIGEST: &str = "digest";
    pub const SHA256: &str = "sha256";
    pub const TITLE: &str = "title";
    pub const LICENSE: &str = "license";
    pub const CITATION: &str = "citation";
    pub const CONTACT: &str = "contact";
    pub const EXTENSION: &str = "extension";
    pub const POSITION: &str = "position";
    pub const UNITS: &str = "units";
    pub const SI_FACTOR: &str = "unit_si_factor";
    pub const SI_EXPONENTS: &str = "unit_si_exponents";
    pub const LONG_NAME: &str = "long_name";
    pub const COORDINATES: &str = "coordinates";
    pub const ANCILLARY: &str = "ancillary_variables";
    pub const FLAG_MASKS: &str = "flag_masks";
    pub const FLAG_MEANINGS: &str = "flag_meanings";

    pub const CERTIFIED_WAVELENGTH: &str = "certified_wavelength";
    pub const CERTIFIED_FACTOR: &str = "certified_factor";

    pub const QUANTITY: &str = "quantity";
    pub const PART: &str = "part";
    pub const NORMALISED_AT: &str = "normalised_at";
    pub const BASIS: &str = "basis";
    pub const REFERENCE: &str = "reference";
    pub const REFERENCE_LIGHT: &str = "reference_light";
    pub const ROLE: &str = "role";

    pub const ACQUISITION: &str = "acquisition";
    pub const WAVELENGTH: &str = "wavelength_emission";
    pub const FWHM: &str = "wavelength_emission_fwhm";
    pub const WAVELENGTH_ACTUAL: &str = "wavelength_emission_actual";
    pub const CORRECTION: &str = "bandpass_correction";
    pub const SHAPE: &str = "bandpass_shape";
    pub const BAND: &str = "band";
    pub const FROM_NM: &str = "from_nm";
    pub const TO_NM: &str = "to_nm";
    pub const THETA_I: &str = "theta_i";
    pub const PHI_I: &str = "phi_i";
    pub const THETA_V: &str = "theta_v";
    pub const PHI_V: &str = "phi_v";
    pub const STATED: &str = "stated";
    pub const EXCITATION: &str = "excitation";
    pub const ORDER: &str = "order";
    pub const REPEATS: &str = "repeats";
    pub const TIME: &str = "time";
    pub const EXPOSURE: &str = "exposure";
    pub const QUALITY_CODE: &str = "quality_code";
    pub const EXCITATION_STATE: &str = "excitation_state";
    pub const EXCITATION_STATED: &str = "excitation_stated";
    pub const EXCITATION_LIGHT: &str = "excitation_light";
    pub const EXCITATION_WAVELENGTH: &str = "excitation_wavelength";
    pub const EXCITATION_FWHM: &str = "excitation_fwhm";
    pub const EXCITATION_FILTER: &str = "excitation_filter";
    pub const EXCITATION_POLARISATION: &str = "excitation_polarisation";
    pub const EXCITATION_ACTUAL: &str = "excitation_actual";
    pub const EXCITATION_SHAPE: &str = "excitation_shape";
    pub const EXCITATION_CORRECTION: &str = "excitation_correction";
    pub const DIRECTION_TEST: &str = "direction_test";
    pub const DIRECTION_TEST_ROW: &str = "direction_test_row";
    pub const DIRECTION_TEST_INCIDENCE: &str = "direction_test_incidence";
    pub const DIRECTION_TEST_VIEWING: &str = "direction_test_viewing";
    pub const XYZ: &str = "xyz";
    pub const VALUE: &str = "value";
    pub const VALUE_U: &str = "value_u";
    pub const VALUE_FLAG: &str = "value_flag";
    pub const CAUSE: &str = "cause";
    pub const CORRELATED_OVER: &str = "correlated_over";
    pub const NUMERATOR: &str = "numerator";
    pub const NUMERATOR_ROW: &str = "numerator_row";
    pub const REFERENCE_GROUP: &str = "reference_group";
    pub const ROW_REFERENCE: &str = "row_reference";
    pub const DARK: &str = "dark";

    pub const DATA_DIGEST: &str = "data_digest";
    pub const REDUCTION: &str = "reduction";
    pub const UNIT: &str = "unit";
    pub const CONVERGED: &str = "converged";
    pub const METHOD: &str = "method";
    pub const KIND: &str = "kind";
    pub const DISTRIBUTION: &str = "distribution";
    pub const DENOMINATOR: &str = "denominator";
    pub const PARAMETER_NAME: &str = "parameter";
    pub const SUFFIX_U: &str = "_u";
    pub const SUFFIX_SHARED: &str = "_u_shared";
    pub const SUFFIX_LOW: &str = "_low";
    pub const SUFFIX_HIGH: &str = "_high";
    pub const MASK: &str = "mask";
    pub const NUISANCE: &str = "nuisance_";
    pub const COVARIANCE: &str = "covariance";
    pub const COVARIANCE_PARAMETERS: &str = "covariance_parameters";
    pub const COVARIANCE_ROW: &str = "covariance_row";
    pub const COVARIANCE_COLUMN: &str = "covariance_column";
    pub const FACTOR: &str = "factor";
    pub const WAVELENGTH_EXCITATION: &str = "wavelength_excitation";
    pub const EXCITATION_FACTOR: &str = "excitation_factor";
    pub const EMISSION_FACTOR: &str = "emission_factor";
    pub const ELASTIC: &str = "elastic";
    pub const ELASTIC_DIGEST: &str = "elastic_digest";
    pub const LUMINESCENT: &str = "luminescent";
    pub const LUMINESCENT_DIGEST: &str = "luminescent_digest";
    pub const REFLECTANCE: &str = "reflectance";
    pub const CONSISTENCY: &str = "consistency";
    pub const REACH: &str = "reach";
    pub const FLOOR: &str = "floor";
    pub const RESIDUAL_RMS: &str = "residual_rms";
    pub const REDUCED_CHI_SQUARE: &str = "residual_reduced_chi_square";
    pub const RESIDUAL_COUNT: &str = "residual_count";
    pub const RESIDUAL_LEFT_OUT: &str = "residual_left_out";
    pub const IDENTIFIABILITY: &str = "identifiability";
    pub const MEAN_OVER_VIEWING: &str = "mean_over_viewing";
    pub const SPREAD_OVER_VIEWING: &str = "spread_over_viewing";
    pub const MEAN_OVER_INCIDENCE: &str = "mean_over_incidence";
    pub const SPREAD_OVER_INCIDENCE: &str = "spread_over_incidence";
    pub const COSINE_AMPLITUDE: &str = "cosine_amplitude";
    pub const COSINE_RELATIVE_RMS: &str = "cosine_relative_rms";
    pub const CONSTANCY_RELATIVE_RMS: &str = "constancy_relative_rms";
    pub const RANK_ONE_RELATIVE_RMS: &str = "rank_one_relative_rms";
    pub const RECEIPTS: &str = "receipts";
    pub const STEPS: &str = "steps";
}

/// The optional fields of a row, in the order of their bits in `stated`.
pub const ROW_FIELDS: [&str; 5] = [GEOMETRY, name::EXCITATION, name::TIME, name::EXPOSURE, name::QUALITY_CODE];
const GEOMETRY: &str = "geometry";
/// The optional fields of an excitation state, in the order of their bits in `excitation_stated`.
pub const EXCITATION_FIELDS: [&str; 8] =
    ["light", "wavelength", "fwhm", "filter", "polarisation", "actual", "shape", "correction"];

/// Attributes that other programs add when they write or rewrite a file. They are no content.
pub const FOREIGN_ATTRIBUTES: [&str; 6] =
    ["DIMENSION_LIST", "REFERENCE_LIST", "CLASS", "NAME", "_FillValue", "_NCProperties"];

/// True for an attribute that carries no content of the standard: foreign ones and the digests themselves.
#[must_use]
pub fn is_outside_digest(attribute: &str) -> bool {
    FOREIGN_ATTRIBUTES.contains(&attribute)
        || attribute.starts_with("_Netcdf4")
        || attribute == name::SHA256
        || attribute == name::DIGEST
}

/// Attributes with words for people, and the versions that a file follows. They may be spelled otherwise, and belong to
/// no digest: a better sentence, or a later version, leaves the content what it is.
pub const DESCRIPTIONS: [&str; 3] = [name::CONVENTIONS, name::BBRF_VERSION, name::LONG_NAME];

/// True for an attribute that describes content and is none.
#[must_use]
pub fn is_description(attribute: &str) -> bool {
    DESCRIPTIONS.contains(&attribute)
}

/// What an entry of the table is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// A group.
    Group,
    /// A dataset of that element type.
    Dataset(&'static str),
    /// An attribute of that element type.
    Attribute(&'static str),
}

/// One row of the table.
#[derive(Debug, Clone)]
pub struct Entry {
    /// Path; `*` stands for an identifier or a number, `@` precedes an attribute.
    pub path: Cow<'static, str>,
    /// Group, dataset or attribute, and its type.
    pub kind: Kind,
    /// Unit, `1` for none; empty for texts and groups; `*` where the quantity gives it.
    pub unit: &'static str,
    /// What it is.
    pub meaning: Cow<'static, str>,
}

const fn group(path: &'static str, meaning: &'static str) -> Entry {
    Entry { path: Cow::Borrowed(path), kind: Kind::Group, unit: "", meaning: Cow::Borrowed(meaning) }
}

const fn dataset(path: &'static str, kind: &'static str, unit: &'static str, meaning: &'static str) -> Entry {
    Entry { path: Cow::Borrowed(path), kind: Kind::Dataset(kind), unit, meaning: Cow::Borrowed(meaning) }
}

const fn attribute(path: &'static str, kind: &'static str, unit: &'static str, meaning: &'static str) -> Entry {
    Entry { path: Cow::Borrowed(path), kind: Kind::Attribute(kind), unit, meaning: Cow::Borrowed(meaning) }
}

#[path = "layout_table.rs"]
mod written;

/// Every path of the standard: the arrays, which are written down one by one, and the fields of the descriptions, which
/// the types of the document give.
pub fn table() -> &'static [Entry] {
    static TABLE: LazyLock<Vec<Entry>> = LazyLock::new(|| {
        let mut table = written::TABLE.to_vec();
        table.extend(entries::<Sample>("/sample/*"));
        table.extend(entries::<Instrument>("/instrument/*"));
        table.extend(entries::<Light>("/light/*"));
        table.extend(entries::<WhiteReference>("/white_reference/*"));
        table.extend(entries::<Conditions>("/measurement/*"));
        table.extend(entries::<Statement>("/**/value_u"));
        table.extend(entries::<Statement>("/measurement/*/value_u_shared_*"));
        table.sort_by_key(|entry| written::order(&entry.path));
        table
    });
    &TABLE
}

/// The row of the table for a path of a file, as in `/measurement/scan/value@units`.
#[must_use]
pub fn find(path: &str) -> Option<&'static Entry> {
    static INDEX: LazyLock<Index> = LazyLock::new(|| Index::new(table()));
    if path.starts_with("/extension/") {
        return table().iter().find(|entry| entry.path == "/extension/*");
    }
    INDEX.find(path)
}

/// The table by the last name of its paths. Of names with a `*` there are few.
struct Index {
    exact: HashMap<&'static str, Vec<Row>>,
    patterns: Vec<Row>,
}

/// A path of the table in its parts: `*` stands for one or more characters within a name, `/**` for any groups or none.
struct Row {
    entry: &'static Entry,
    anywhere: bool,
    groups: Vec<&'static str>,
    attribute: Option<&'static str>,
}

impl Index {
    fn new(table: &'static [Entry]) -> Self {
        let mut index = Self { exact: HashMap::new(), patterns: Vec::new() };
        for entry in table {
            let (object, attribute) = entry.path.split_once('@').map_or((&*entry.path, None), |(o, a)| (o, Some(a)));
            let anywhere = object.starts_with("/**");
            let groups = object.split('/').filter(|name| !name.is_empty() && *name != "**").collect();
            let row = Row { entry, anywhere, groups, attribute };
            let last = attribute.or(row.groups.last().copied()).unwrap_or("");
            if last.contains('*') {
                index.patterns.push(row);
            } else {
                index.exact.entry(last).or_default().push(row);
            }
        }
        index
    }

    fn find(&self, path: &str) -> Option<&'static Entry> {
        let (object, attribute) = path.split_once('@').map_or((path, None), |(o, a)| (o, Some(a)));
        let last = attribute.or(object.rsplit('/').next()).unwrap_or("");
        let rows = self.exact.get(last).into_iter().flatten().chain(&self.patterns);
        let names: Vec<&str> = object.split('/').filter(|name| !name.is_empty()).collect();
        rows.into_iter().find(|row| row.matches(&names, attribute)).map(|row| row.entry)
    }
}

impl Row {
    fn matches(&self, names: &[&str], attribute: Option<&str>) -> bool {
        let attribute_fits = match (self.attribute, attribute) {
            (Some(pattern), Some(name)) => name_matches(pattern, name),
            (None, None) => true,
            _ => false,
        };
        // Below `/**` only the last names are given.
        let names = if self.anywhere { &names[names.len().saturating_sub(self.groups.len())..] } else { names };
        attribute_fits
            && names.len() == self.groups.len()
            && self.groups.iter().zip(names).all(|(pattern, name)| name_matches(pattern, name))
    }
}

fn name_matches(pattern: &str, name: &str) -> bool {
    match pattern.split_once('*') {
        None => pattern == name,
        Some((before, after)) => {
            name.len() > before.len() + after.len() && name.starts_with(before) && name.ends_with(after)
        }
    }
}
