//! Tables over two wavelengths: what BFC files, iccMAX profiles and texts of matrices have in common once their numbers
//! are read. Each excitation wavelength becomes a row of a measurement with an excitation state of its own.

use ndarray::Array2;

use super::error::{ImportError, fault, fault_of};
use super::keys::Settings;
use super::receipt::Notes;
use super::record::Details;
use super::source::Source;
use super::{Options, details, parts, table_csv};
use crate::dataset::{Acquisition, Document, Excitation, Id, Measurement, Place, Role};
use crate::quantity::{EmissionAxis, Flag, Quantity, WavelengthAxis};

/// Values over excitation and emission wavelengths.
#[derive(Debug)]
pub(super) struct Grid {
    /// Excitation wavelengths, nm.
    pub(super) excitation_nm: Vec<f64>,
    /// Emission wavelengths, nm.
    pub(super) emission_nm: Vec<f64>,
    /// Values \[excitation, emission\]; NaN where the source has none.
    pub(super) values: Array2<f64>,
}

/// What a source says of a matrix beside its numbers.
#[derive(Debug)]
pub(super) struct Said {
    /// The identifier, where no setting gives one.
    pub(super) id: Id,
    /// Its name.
    pub(super) title: Option<String>,
    /// What the numbers are.
    pub(super) quantity: Quantity,
    /// When, RFC 3339.
    pub(super) time: Option<String>,
    /// Who.
    pub(super) operator: Option<String>,
    /// Where the matrix begins.
    pub(super) place: Place,
}

impl Grid {
    /// The table from numbers that stand row by row, as in the file; with `emission` the rows are emission wavelengths.
    /// `None` where there are not as many numbers as cells.
    pub(super) fn from_rows(emission: bool, rows_nm: Vec<f64>, columns_nm: Vec<f64>, values: Vec<f64>) -> Option<Self> {
        let values = Array2::from_shape_vec((rows_nm.len(), columns_nm.len()), values).ok()?;
        Some(if emission {
            let values = values.reversed_axes().as_standard_layout().into_owned();
            Self { excitation_nm: columns_nm, emission_nm: rows_nm, values }
        } else {
            Self { excitation_nm: rows_nm, emission_nm: columns_nm, values }
        })
    }
}

/// The measurement of a table of values.
///
/// # Errors
/// [`ImportError::Malformed`] unless both axes ascend.
pub(super) fn measurement(grid: Grid, said: Said, options: &Options) -> Result<Measurement, ImportError> {
    let settings = &options.settings;
    let ascending = |nm: Vec<f64>| {
        let axis = WavelengthAxis::new(nm, parts::bandpass(settings, None));
        axis.map_err(|error| {
            ImportError::Malformed(fault_of(said.place.clone(), &error, "sort rows and columns by it"))
        })
    };
    let excitation = ascending(grid.excitation_nm)?;
    let states = excitation.nm.iter().map(|nm| Excitation {
        light: settings.light.as_deref().map(Id::from_title),
        wavelength_nm: Some(*nm),
        fwhm_nm: settings.excitation_fwhm_nm,
        filter: settings.filter.clone(),
        ..Excitation::default()
    });
    let rows = (0_u32..).zip(&excitation.nm).map(|(order, _)| Acquisition {
        excitation: Some(order),
        time: said.time.clone(),
        ..Acquisition::at(options.geometry, order)
    });
    let mut quantity = said.quantity;
    quantity.certified_factor = table_csv::certified(settings, &said.place)?;
    let emission = EmissionAxis::Wavelengths(ascending(grid.emission_nm)?);
    let mut measurement = Measurement::new(said.id, Role::Sample, quantity, emission, rows.collect(), grid.values);
    measurement.flags = measurement.values.map(|value| if value.is_nan() { Flag::NotMeasured.bit() } else { 0 }).into();
    measurement.title = said.title;
    measurement.excitations = states.collect();
    measurement.conditions.operator = said.operator;
    Ok(measurement)
}

/// The document of one file of matrices, each with the name of its sample where the file says it, and with what the
/// file says of the instrument.
///
/// # Errors
/// [`ImportError::Call`] for a particular that no part has.
pub(super) fn document(
    measurements: Vec<(Measurement, Option<String>)>,
    instrument: &Details,
    settings: &Settings,
    notes: &mut Notes,
) -> Result<Document, ImportError> {
    let mut document = parts::document(settings);
    for (mut measurement, sample) in measurements {
        let named = Settings { sample: settings.sample.clone().or(sample), ..settings.clone() };
        parts::attach_sample(&mut document, &mut measurement, &named, notes);
        parts::attach_instrument(&mut document, &mut measurement, Some(instrument), settings, notes);
        parts::attach_lights(&mut document, &measurement, settings);
        parts::list_unfilled(&measurement, notes);
        document.measurements.push(measurement);
    }
    details::fill(&mut document, &settings.details)?;
    Ok(document)
}

/// What is stated goes before what the format says.
pub(super) fn stated(settings: &Settings, base: Quantity) -> Quantity {
    Quantity {
        kind: base.kind,
        part: settings.part.unwrap_or(base.part),
        normalised_at: settings.normalised_at.unwrap_or(base.normalised_at),
        basis: settings.basis.unwrap_or(base.basis),
        reference: settings.reference.unwrap_or(base.reference),
        reference_light: settings.reference_light.clone().unwrap_or(base.reference_light),
        certified_factor: Vec::new(),
    }
}

/// A matrix has its own excitation wavelengths, no angles and no uncertainties: keys that state them contradict it.
pub(super) fn refuse_settings(source: &Source, settings: &Settings, what: &str) -> Result<(), ImportError> {
    let given = [
        ("excitation-nm", settings.excitation_nm.is_some()),
        ("band-nm", settings.band.is_some()),
        ("angles", settings.angles.is_some()),
        ("coverage-factor", settings.coverage_factor.is_some()),
        ("certificate", settings.certificate.is_some()),
        ("certified-relative-uncertainty", settings.certified_relative_uncertainty.is_some()),
    ];
    let Some((key, _)) = given.into_iter().find(|(_, given)| *given) else { return Ok(()) };
    Err(ImportError::Call(fault(
        settings.place_of(key, source.at_line(1)),
        format!("`{key}` with {what}"),
        "what the file does not say itself and a matrix can have",
        "leave it out",
    )))
}

/// The quantity that a format fixes cannot be stated otherwise.
pub(super) fn refuse_quantity(source: &Source, settings: &Settings, fixed: &Quantity) -> Result<(), ImportError> {
    let Some(stated) = settings.quantity.filter(|stated| *stated != fixed.kind) else { return Ok(()) };
    Err(ImportError::Contradiction(fault(
        settings.place_of("quantity", source.at_line(1)),
        format!("the quantity {stated}"),
        format!("{}, which this format holds", fixed.kind),
        "leave it out",
    )))
}
