//! How a spectrum becomes the number that is fitted: a band, V(lambda), or every wavelength.
//!
//! A band of a factor is a ratio of sums, not a sum of ratios. Since factor = radiance / p, where p is what the
//! perfect diffuser would radiate (the reference's radiance over its certified factor), that ratio is the mean of the
//! factor weighted with p; p comes from the reference's rows in the same document.

mod truncation;
mod weighted_sum;

use std::fmt;
use std::str::FromStr;

use ndarray::Array2;

use super::bound::{Bound, bound_at};
use super::{Document, Measurement};
use crate::quantity::{Band, CorrelatedOver, EmissionAxis, Geometry, QuantityKind, Reference};
use truncation::Truncation;
use weighted_sum::WeightedSum;

/// What is asked for.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum Reduction {
    /// The band in which the mean signal exceeds a tenth of its peak.
    #[default]
    Auto,
    /// A stated band.
    Band(Band),
    /// Weighted with V(lambda).
    Luminance,
    /// Every wavelength by itself.
    None,
}

/// A text that names no reduction.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("`{0}` is no reduction; expected `auto`, `band:FROM-TO` in nm with FROM below TO, `luminance` or `none`")]
pub struct UnknownReduction(String);

impl FromStr for Reduction {
    type Err = UnknownReduction;

    fn from_str(text: &str) -> Result<Self, UnknownReduction> {
        let unknown = || UnknownReduction(text.to_owned());
        match text {
            "auto" => Ok(Self::Auto),
            "luminance" => Ok(Self::Luminance),
            "none" => Ok(Self::None),
            _ => {
                let (from, to) =
                    text.strip_prefix("band:").and_then(|band| band.split_once('-')).ok_or_else(unknown)?;
                let number = |text: &str| text.trim().parse::<f64>().ok().filter(|nm| nm.is_finite() && *nm > 0.0);
                match (number(from), number(to)) {
                    (Some(from_nm), Some(to_nm)) if from_nm < to_nm => Ok(Self::Band(Band { from_nm, to_nm })),
                    _ => Err(unknown()),
                }
            }
        }
    }
}

impl fmt::Display for Reduction {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Auto => f.write_str("auto"),
            Self::Band(band) => write!(f, "band:{band}"),
            Self::Luminance => f.write_str("luminance"),
            Self::None => f.write_str("none"),
        }
    }
}

/// Why a measurement cannot be reduced.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ReduceError {
    /// Not a quantity that the terms describe.
    #[error("measurement `{measurement}` holds `{kind}`; a model of the terms needs a radiance or a radiance factor")]
    NotFittable {
        /// Which measurement.
        measurement: String,
        /// What it holds.
        kind: QuantityKind,
    },
    /// No row has a known geometry and a usable value.
    #[error(
        "measurement `{measurement}`: none of its {rows} rows has a known geometry and a usable value {}",
        within(.reduction)
    )]
    NothingLeft {
        /// Which measurement.
        measurement: String,
        /// How many rows it has.
        rows: usize,
        /// What was asked for.
        reduction: String,
    },
    /// The band holds no wavelength.
    #[error(
        "measurement `{measurement}`: no usable value {}; its axis runs from {from} to {to} nm", within(.reduction)
    )]
    EmptyBand {
        /// Which measurement.
        measurement: String,
        /// What was asked for.
        reduction: String,
        /// First wavelength, nm.
        from: f64,
        /// Last wavelength, nm.
        to: f64,
    },
    /// Every usable emission value is truncated by the instrument's floor.
    #[error("measurement `{measurement}`: {why}; reduce it to a band with more light, or measure longer")]
    Truncated {
        /// Which measurement.
        measurement: String,
        /// Where and how much.
        why: String,
    },
    /// A band was asked of a measurement that is already a band.
    #[error(
        "measurement `{measurement}` is one band already and cannot be reduced to {reduction}; leave `--reduce` out"
    )]
    AlreadyReduced {
        /// Which measurement.
        measurement: String,
        /// What was asked for.
        reduction: String,
    },
}

/// Where a reduction looks, in a sentence.
fn within(reduction: &str) -> String {
    match reduction {
        "none" | "auto" => "at any wavelength".to_owned(),
        "luminance" => "where V(lambda) is above zero".to_owned(),
        band => format!("in {band}"),
    }
}

/// The numbers that are fitted: columns x rows, one column per emission value that is left.
#[derive(Debug, Clone, PartialEq)]
pub struct Reduced {
    /// What the numbers are.
    pub kind: QuantityKind,
    /// The reference convention of the numbers.
    pub reference: Reference,
    /// How they were formed, as stored with a model: `band:500-620`, `luminance`, `none`.
    pub reduction: String,
    /// What a reader should know of how they were formed, one sentence each.
    pub notes: Vec<String>,
    /// Emission axis of the numbers.
    pub emission: EmissionAxis,
    /// The measurement's rows that are used (N).
    pub rows: Vec<usize>,
    /// Their geometries (N).
    pub geometry: Vec<Geometry>,
    /// Values \[emission, N\]; NaN where a single value may not be used.
    pub values: Array2<f64>,
    /// Standard uncertainty \[emission, N\] independent between rows; `None` where the measurement has none.
    pub sigma: Option<Array2<f64>>,
    /// Readings of which one side is known (below detection, saturated); `values` holds NaN there. None where the
    /// measurement has no uncertainties.
    pub bounds: Vec<Bound>,
    /// Relative standard uncertainty that the emission values of a row share, one per emission value: a part of `sigma`.
    pub record_relative: Vec<f64>,
    /// Relative standard uncertainty shared by all rows, one per emission value.
    pub shared_relative: Vec<f64>,
    /// Rows of the measurement that are not used.
    pub left_out: usize,
    /// Emission values of the measurement that are not used.
    pub left_out_emission: usize,
}

/// Reduces a measurement of a document.
///
/// # Errors
/// [`ReduceError`] when nothing usable is left or the quantity is not one that the terms describe.
pub fn reduce(document: &Document, measurement: &Measurement, reduction: Reduction) -> Result<Reduced, ReduceError> {
    check_kind(measurement)?;
    match &measurement.emission {
        EmissionAxis::Band { .. } => match reduction {
            Reduction::Auto | Reduction::None => keep_columns(measurement, "none".to_owned()),
            _ => Err(ReduceError::AlreadyReduced {
                measurement: measurement.id.to_string(),
                reduction: reduction.to_string(),
            }),
        },
        EmissionAxis::Wavelengths(axis)
            if reduction == Reduction::None || (reduction == Reduction::Auto && axis.nm.len() == 1) =>
        {
            keep_columns(measurement, "none".to_owned())
        }
        EmissionAxis::Wavelengths(axis) => WeightedSum::new(document, measurement, &axis.nm, reduction)?.reduced(),
    }
}

fn check_kind(measurement: &Measurement) -> Result<(), ReduceError> {
    let kind = measurement.quantity.kind;
    match kind {
        QuantityKind::SpectralRadiance
        | QuantityKind::BandRadiance
        | QuantityKind::Luminance
        | QuantityKind::RelativeSpectrum
        | QuantityKind::RadianceFactor
        | QuantityKind::LuminanceFactor
        | QuantityKind::BandRadianceFactor => Ok(()),
        _ => Err(ReduceError::NotFittable { measurement: measurement.id.to_string(), kind }),
    }
}

/// A value that may be fitted, or NaN.
fn usable(measurement: &Measurement, row: usize, column: usize) -> f64 {
    let value = measurement.values[(row, column)];
    if measurement.flags_at(row, column).may_be_fitted() && value.is_finite() { value } else { f64::NAN }
}

/// The geometry of a row; none where a direction lies below the surface: there nothing can be measured, and every term
/// is 0 by definition.
fn geometry_of(measurement: &Measurement, row: usize) -> Option<Geometry> {
    measurement.acquisitions[row].geometry.filter(|geometry| !geometry.is_below_horizon())
}

/// Independent standard uncertainty of one value: its own and what its acquisition shares over wavelengths.
pub(super) fn independent_sigma(measurement: &Measurement, row: usize, column: usize) -> Option<f64> {
    let own = measurement.uncertainty.standard.as_ref()?[(row, column)];
    let scale = shared(measurement, column, |over| over == CorrelatedOver::Wavelengths);
    Some(own.hypot(scale * measurement.values[(row, column)]))
}

fn shared(measurement: &Measurement, column: usize, select: impl Fn(CorrelatedOver) -> bool) -> f64 {
    let components = measurement.uncertainty.components.iter().filter(|component| select(component.correlated_over));
    components.map(|component| component.relative_at(column).powi(2)).sum::<f64>().sqrt()
}

/// Every emission value by itself, but those that the floor truncates.
fn keep_columns(measurement: &Measurement, reduction: String) -> Result<Reduced, ReduceError> {
    let count = measurement.acquisitions.len();
    let placed: Vec<usize> = (0..count).filter(|&row| geometry_of(measurement, row).is_some()).collect();
    let truncation = Truncation::of(measurement, &placed);
    let columns = &truncation.fair;
    let has_value = |row: &usize| {
        let known = |&column: &usize| {
            usable(measurement, *row, column).is_finite() || bound_at(measurement, *row, column).is_some()
        };
        columns.iter().any(known)
    };
    let rows: Vec<usize> = placed.iter().copied().filter(has_value).collect();
    let notes = truncation.notes(measurement, placed.len());
    if columns.is_empty() && !truncation.truncated.is_empty() {
        return Err(ReduceError::Truncated { measurement: measurement.id.to_string(), why: notes.join("; ") });
    }
    if rows.is_empty() {
        return Err(nothing_left(measurement, &reduction));
    }
    let shape = (columns.len(), rows.len());
    let over_rows = |over| over != CorrelatedOver::Wavelengths;
    let over_wavelengths = |over| over == CorrelatedOver::Wavelengths;
    let bounds = columns.iter().enumerate().flat_map(|(emission, &column)| {
        let at = move |(geometry, &row): (usize, &usize)| {
            bound_at(measurement, row, column).map(|bound| Bound { emission, geometry, ..bound })
        };
        rows.iter().enumerate().filter_map(at)
    });
    let bounds: Vec<Bound> = bounds.collect();
    Ok(Reduced {
        bounds,
        record_relative: columns.iter().map(|&column| shared(measurement, column, over_wavelengths)).collect(),
        kind: measurement.quantity.kind,
        reference: measurement.quantity.reference,
        reduction,
        notes,
        emission: measurement.emission.selection(columns),
        geometry: rows.iter().filter_map(|&row| geometry_of(measurement, row)).collect(),
        values: Array2::from_shape_fn(shape, |(c, k)| usable(measurement, rows[k], columns[c])),
        sigma: measurement.uncertainty.standard.as_ref().map(|_| {
            Array2::from_shape_fn(shape, |(c, k)| {
                independent_sigma(measurement, rows[k], columns[c]).unwrap_or(f64::NAN)
            })
        }),
        shared_relative: columns.iter().map(|&column| shared(measurement, column, over_rows)).collect(),
        left_out: count - rows.len(),
        left_out_emission: truncation.left_out(),
        rows,
    })
}

fn nothing_left(measurement: &Measurement, reduction: &str) -> ReduceError {
    ReduceError::NothingLeft {
        measurement: measurement.id.to_string(),
        rows: measurement.acquisitions.len(),
        reduction: reduction.to_owned(),
    }
}
