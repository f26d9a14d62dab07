//! Measurements: rows of acquisitions with values per emission wavelength.

use ndarray::ArcArray2;
use serde::{Deserialize, Serialize};

use super::{Conditions, DirectionTest, Id};
use crate::quantity::{
    BandpassCorrection, BandpassShape, EmissionAxis, Flags, Geometry, Quantity, Uncertainty, named, rows_plain,
};

named! {
    /// What the instrument looked at.
    Role, "role" {
        /// The sample.
        Sample = "sample",
        /// The white reference.
        White = "white",
        /// Nothing lit: the dark signal.
        Dark = "dark",
        /// The light source itself.
        Lamp = "lamp",
    }
}

/// What fell on the sample during an acquisition.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, schemars::JsonSchema)]
pub struct Excitation {
    /// The light, by its id in the document.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub light: Option<Id>,
    /// Nominal centre of a monochromatic or filtered excitation, nm.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub wavelength_nm: Option<f64>,
    /// Its full width at half maximum, nm.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub fwhm_nm: Option<f64>,
    /// Filter, free text.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub filter: Option<String>,
    /// Polarisation, free text.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub polarisation: Option<String>,
    /// The centre as calibrated, nm.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub actual_nm: Option<f64>,
    /// Shape of the slit function.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub shape: Option<BandpassShape>,
    /// Whether the values are corrected for this width.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub correction: Option<BandpassCorrection>,
}

impl Excitation {
    /// Its centre, nm: as calibrated, else nominal.
    #[must_use]
    pub fn centre_nm(&self) -> Option<f64> {
        self.actual_nm.or(self.wavelength_nm)
    }
}

/// One row of a measurement: one look of the instrument.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct Acquisition {
    /// Incidence and viewing; `None` where the source does not say.
    #[serde(with = "geometry_in_degrees")]
    #[schemars(with = "Option<[f64; 4]>")]
    pub geometry: Option<Geometry>,
    /// Index into the measurement's excitation states; `None` where the source does not say.
    pub excitation: Option<u32>,
    /// Position in the order of acquisition, from 0.
    pub order: u32,
    /// How many instrument readings this row averages.
    pub repeats: u32,
    /// When, RFC 3339.
    pub time: Option<String>,
    /// Integration time, ms.
    pub exposure_ms: Option<f64>,
    /// The instrument's quality code.
    pub quality_code: Option<i32>,
}

impl Acquisition {
    /// A row of which only the geometry and the order are known.
    #[must_use]
    pub fn at(geometry: Option<Geometry>, order: u32) -> Self {
        Self { geometry, excitation: None, order, repeats: 1, time: None, exposure_ms: None, quality_code: None }
    }
}

/// How a measurement of factors was derived from raw radiances in the same document, so that a reduction can form the
/// ratio of sums instead of the sum of ratios.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct Derivation {
    /// The measurement of sample radiances.
    pub numerator: Id,
    /// For each row of the numerator, the row of the derived measurement it was averaged into; -1 for none.
    pub numerator_row: Vec<i32>,
    /// The measurement of the reference's radiances.
    pub reference: Id,
    /// For each row of the reference, the reference group it was averaged into; -1 for none.
    pub reference_group: Vec<i32>,
    /// For each row of the derived measurement, the reference group it was divided by; -1 for none.
    pub row_reference: Vec<i32>,
    /// The measurement of dark signals whose mean was subtracted from both, if any.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub dark: Option<Id>,
}

/// A measurement: one quantity of one sample (or reference, or light), rows x emission wavelengths.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct Measurement {
    /// Identifier in the document.
    pub id: Id,
    /// Name, free text.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub title: Option<String>,
    /// What the numbers mean.
    pub quantity: Quantity,
    /// What the instrument looked at.
    pub role: Role,
    /// The sample, by id.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub sample: Option<Id>,
    /// The instrument, by id.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub instrument: Option<Id>,
    /// The white reference, by id.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub white_reference: Option<Id>,
    /// The emission axis.
    pub emission: EmissionAxis,
    /// The excitation states that rows refer to.
    #[serde(default)]
    pub excitations: Vec<Excitation>,
    /// One row per acquisition (N).
    pub acquisitions: Vec<Acquisition>,
    /// Values \[N, emission\] in the quantity's unit; NaN only where a flag says why.
    #[serde(with = "rows_plain")]
    #[schemars(with = "Vec<Vec<Option<f64>>>")]
    pub values: ArcArray2<f64>,
    /// Flag masks \[N, emission\].
    #[serde(with = "flag_rows")]
    #[schemars(with = "Vec<Vec<u16>>")]
    pub flags: ArcArray2<u16>,
    /// Uncertainty of the values.
    #[serde(default)]
    pub uncertainty: Uncertainty,
    /// Who measured, where, in what surroundings.
    #[serde(default)]
    pub conditions: Conditions,
    /// Self-test vectors: directions of some rows as unit vectors.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub direction_tests: Vec<DirectionTest>,
    /// How the values were derived from other measurements of the document.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub derivation: Option<Derivation>,
}

/// Arrays of a measurement that do not fit together.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("measurement `{measurement}`: `{array}` has shape {found:?}; expected {expected:?} (acquisitions x emission)")]
pub struct ShapeError {
    /// Which measurement.
    pub measurement: String,
    /// Which array.
    pub array: &'static str,
    /// Its shape.
    pub found: Vec<usize>,
    /// The shape it should have.
    pub expected: Vec<usize>,
}

impl Measurement {
    /// Values of a quantity with everything else unknown: no flag, no uncertainty, no reference to other parts.
    #[must_use]
    pub fn new(
        id: Id,
        role: Role,
        quantity: Quantity,
        emission: EmissionAxis,
        acquisitions: Vec<Acquisition>,
        values: impl Into<ArcArray2<f64>>,
    ) -> Self {
        let values = values.into();
        Self {
            id,
            title: None,
            quantity,
            role,
            sample: None,
            instrument: None,
            white_reference: None,
            emission,
            excitations: Vec::new(),
            acquisitions,
            flags: ArcArray2::zeros(values.raw_dim()),
            values,
            uncertainty: Uncertainty::default(),
            conditions: Conditions::default(),
            direction_tests: Vec::new(),
            derivation: None,
        }
    }

    /// Rows x emission values.
    #[must_use]
    pub fn shape(&self) -> (usize, usize) {
        (self.acquisitions.len(), self.emission.len())
    }

    /// What fell on the sample in a row; `None` where the source does not say.
    #[must_use]
    pub fn excitation_of(&self, row: &Acquisition) -> Option<&Excitation> {
        self.excitations.get(usize::try_from(row.excitation?).ok()?)
    }

    /// The flags of one value; none where the index is outside.
    #[must_use]
    pub fn flags_at(&self, row: usize, emission: usize) -> Flags {
        Flags(self.flags.get((row, emission)).copied().unwrap_or(0))
    }

    /// Checks that all arrays have the shape of rows x emission.
    ///
    /// # Errors
    /// [`ShapeError`] naming the first array that does not.
    pub fn check_shape(&self) -> Result<(), ShapeError> {
        let (rows, columns) = self.shape();
        let check = |array: &'static str, found: &[usize]| {
            if found == [rows, columns] {
                Ok(())
            } else {
                let measurement = self.id.to_string();
                Err(ShapeError { measurement, array, found: found.to_vec(), expected: vec![rows, columns] })
            }
        };
        check("values", self.values.shape())?;
        check("flags", self.flags.shape())?;
        self.uncertainty.standard.as_ref().map_or(Ok(()), |standard| check("uncertainty.standard", standard.shape()))
    }
}

/// A geometry in JSON: four angles in degrees \[theta_i, phi_i, theta_v, phi_v\].
mod geometry_in_degrees {
    use serde::{Deserialize, Deserializer, Serialize, Serializer, de::Error};

    use crate::quantity::Geometry;

    pub(super) fn serialize<S: Serializer>(geometry: &Option<Geometry>, serializer: S) -> Result<S::Ok, S::Error> {
        geometry
            .map(|g| [g.incidence.theta_deg(), g.incidence.phi_deg(), g.viewing.theta_deg(), g.viewing.phi_deg()])
            .serialize(serializer)
    }

    pub(super) fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Option<Geometry>, D::Error> {
        let angles: Option<[f64; 4]> = Deserialize::deserialize(deserializer)?;
        angles.map(|[a, b, c, d]| Geometry::from_degrees(a, b, c, d).map_err(D::Error::custom)).transpose()
    }
}

/// Flag masks in JSON as rows.
mod flag_rows {
    use ndarray::ArcArray2;
    use serde::{Deserialize, Deserializer, Serialize, Serializer, de::Error};

    pub(super) fn serialize<S: Serializer>(array: &ArcArray2<u16>, serializer: S) -> Result<S::Ok, S::Error> {
        array.rows().into_iter().map(|row| row.to_vec()).collect::<Vec<_>>().serialize(serializer)
    }

    pub(super) fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<ArcArray2<u16>, D::Error> {
        let rows: Vec<Vec<u16>> = Deserialize::deserialize(deserializer)?;
        let shape = (rows.len(), rows.first().map_or(0, Vec::len));
        ArcArray2::from_shape_vec(shape, rows.into_iter().flatten().collect()).map_err(D::Error::custom)
    }
}
