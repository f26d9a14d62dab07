//! Why a figure cannot be drawn.

use crate::dataset::{ReduceError, TermsError, UnknownReduction};

/// Why a figure cannot be drawn.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ReportError {
    /// There is no finite number to draw.
    #[error("{figure}: there is no finite value to draw")]
    Empty {
        /// Which figure.
        figure: String,
    },
    /// Lists that belong together have different lengths.
    #[error("{figure}: `{what}` has {found} entries; expected {expected}")]
    Lengths {
        /// Which figure.
        figure: String,
        /// Which list.
        what: &'static str,
        /// Its length.
        found: usize,
        /// The length it should have.
        expected: usize,
    },
    /// A map over signed angles needs directions in the plane of incidence.
    #[error(
        "{figure}: {outside} of {total} geometries leave the plane of azimuth 0 and 180 degrees; a map over signed angles \
         needs them in it"
    )]
    NotInPlane {
        /// Which figure.
        figure: String,
        /// How many leave the plane.
        outside: usize,
        /// How many there are.
        total: usize,
    },
    /// The angles do not form a table that could be drawn cell by cell.
    #[error("{figure}: {incidences} x {viewings} different angles are too many cells for a map (at most {limit})")]
    TooManyCells {
        /// Which figure.
        figure: String,
        /// Different angles of incidence.
        incidences: usize,
        /// Different angles of viewing.
        viewings: usize,
        /// How many cells are drawn at most.
        limit: usize,
    },
    /// The measurement that a model was fitted to is not in the document.
    #[error("model `{model}`: its measurement `{measurement}` is not in the document")]
    NoMeasurement {
        /// Which model.
        model: String,
        /// The id it gives.
        measurement: String,
    },
    /// The model does not say how a spectrum became the fitted number.
    #[error("model `{model}`: its reduction cannot be done again")]
    Reduction {
        /// Which model.
        model: String,
        /// Why.
        source: UnknownReduction,
    },
    /// The fitted numbers cannot be formed again.
    #[error("model `{model}`: its data cannot be formed again")]
    Reduce {
        /// Which model.
        model: String,
        /// Why.
        source: ReduceError,
    },
    /// The numbers of a scan without a model cannot be formed.
    #[error("map over the angles")]
    Scan {
        /// Why.
        source: ReduceError,
    },
    /// At every wavelength some acquisitions have no usable value.
    #[error(
        "measurement `{measurement}`: its mean spectrum; at every wavelength more than a fiftieth of the {rows} acquisitions \
         have no usable value (missing, below detection), and the mean of the rest would be too high"
    )]
    NoWholeWavelength {
        /// Which measurement.
        measurement: String,
        /// How many acquisitions it has.
        rows: usize,
    },
    /// The model was stored over another emission axis than its data have now.
    #[error(
        "model `{model}`: stored over {stored}, while its measurement reduces to {data}; its values cannot be set beside the \
         data: fit it again"
    )]
    OtherAxis {
        /// Which model.
        model: String,
        /// The axis of the model.
        stored: String,
        /// That of the data.
        data: String,
    },
    /// Too few angles for a map.
    #[error(
        "{figure}: {incidences} x {viewings} different angles of incidence and of viewing; a map needs two of each or more"
    )]
    NoTable {
        /// Which figure.
        figure: String,
        /// Different angles of incidence.
        incidences: usize,
        /// Different angles of viewing.
        viewings: usize,
    },
    /// The measurement is no matrix that could be drawn.
    #[error("map over excitation and emission")]
    Matrix {
        /// Why.
        source: crate::donaldson::NoMatrix,
    },
    /// The wavelengths of a matrix do not ascend.
    #[error("measurement `{measurement}`: its emission wavelengths do not ascend; a map over them needs that")]
    NotAscending {
        /// Which measurement.
        measurement: String,
    },
    /// A surface needs neighbours on both axes.
    #[error(
        "measurement `{measurement}`: its surface; {excitations} x {emissions} excitations and emissions, expected two of each or \
         more"
    )]
    NoSurface {
        /// Which measurement.
        measurement: String,
        /// Excitations.
        excitations: usize,
        /// Emissions.
        emissions: usize,
    },
    /// The model cannot be evaluated.
    #[error("model `{model}`: it cannot be evaluated")]
    Terms {
        /// Which model.
        model: String,
        /// Why.
        source: TermsError,
    },
    /// The drawing's text could not be turned into outlines.
    #[error("{figure}: the SVG cannot be written: {reason}")]
    Svg {
        /// Which figure.
        figure: String,
        /// What the converter says.
        reason: String,
    },
    /// The picture could not be encoded.
    #[error("{figure}: the PNG cannot be written: {reason}")]
    Png {
        /// Which figure.
        figure: String,
        /// What the encoder says.
        reason: String,
    },
}

impl ReportError {
    /// The message with the messages of its causes, on one line.
    pub(super) fn in_full(&self) -> String {
        let mut text = self.to_string();
        let mut cause = std::error::Error::source(self);
        while let Some(error) = cause {
            text.push_str(&format!(": {error}"));
            cause = error.source();
        }
        text
    }
}
