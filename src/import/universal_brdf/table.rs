//! Points to rows and columns. Points of one geometry, one wavelength of illumination and one polarisation are one
//! acquisition, with a column for each wavelength of detection; the k-th repeat of a point goes into the k-th such
//! acquisition. Where both wavelengths are equal at every point, the column alone holds them.

use std::collections::BTreeMap;

use ndarray::Array2;

use super::columns::Columns;
use super::file::File;
use crate::dataset::{Acquisition, Excitation, Id, Measurement, Role};
use crate::import::error::{ImportError, fault, fault_of};
use crate::quantity::{Bandpass, EmissionAxis, Flag, Flags, Geometry, Quantity, Uncertainty, WavelengthAxis};

/// What a row is: angles, wavelength of illumination, its polarisation; then the number of the repeat.
type Key<'a> = ([u64; 4], Option<u64>, Option<&'a str>);

/// What holds for all rows.
pub(super) struct Common {
    pub(super) id: Id,
    pub(super) quantity: Quantity,
    pub(super) bandpass: Bandpass,
    pub(super) band: EmissionAxis,
    pub(super) excitation: Excitation,
}

/// The measurement of some points of a file.
///
/// # Errors
/// [`ImportError`] where the points share so few wavelengths that the table would be all but empty.
pub(super) fn measurement(
    file: &File,
    columns: &Columns,
    points: &[usize],
    common: &Common,
) -> Result<Measurement, ImportError> {
    let emission = emission(file, columns, points, common)?;
    let mut rows = Rows::default();
    let cells: Vec<(usize, usize)> =
        points.iter().map(|point| rows.cell(file, columns, *point, &emission, common)).collect::<Result<_, _>>()?;
    let shape = (rows.acquisitions.len(), emission.len());
    // Rows with wavelengths of their own would fill a square with NaN.
    let total = shape.0.saturating_mul(shape.1);
    if total > 1_000_000 && total / 64 > points.len() {
        return Err(ImportError::Malformed(fault(
            file.at("data"),
            format!("{} points on {} geometries x {} wavelengths", points.len(), shape.0, shape.1),
            "geometries that share their wavelengths",
            "put geometries with other wavelengths into a file of their own",
        )));
    }
    let mut values = Array2::from_elem(shape, f64::NAN);
    let mut sigma = columns.sigma.as_ref().map(|_| Array2::from_elem(shape, f64::NAN));
    let mut flags = Array2::from_elem(shape, Flag::NotMeasured.bit());
    for (point, cell) in points.iter().zip(cells) {
        values[cell] = columns.value[*point];
        let own = columns.flags.as_ref().map_or(Flags::NONE, |flags| flags[*point]);
        let missing = columns.value[*point].is_nan() && !own.explains_absence();
        flags[cell] = if missing { own.with(Flag::NotMeasured).0 } else { own.0 };
        if let (Some(sigma), Some(column)) = (&mut sigma, &columns.sigma) {
            sigma[cell] = column[*point];
        }
    }
    let mut measurement =
        Measurement::new(common.id.clone(), Role::Sample, common.quantity.clone(), emission, rows.acquisitions, values);
    measurement.flags = flags.into_shared();
    measurement.uncertainty =
        Uncertainty { standard: sigma.map(|sigma| sigma.into_shared()), ..Uncertainty::default() };
    measurement.excitations = rows.excitations;
    Ok(measurement)
}

fn emission(file: &File, columns: &Columns, points: &[usize], common: &Common) -> Result<EmissionAxis, ImportError> {
    let Some(column) = &columns.emission_nm else { return Ok(common.band.clone()) };
    let mut nm: Vec<f64> = points.iter().map(|point| column[*point]).collect();
    nm.sort_by(f64::total_cmp);
    nm.dedup();
    let axis = WavelengthAxis::new(nm, common.bandpass.clone());
    axis.map(EmissionAxis::Wavelengths).map_err(|error| {
        ImportError::Malformed(fault_of(file.at("data.wavelength_r.values"), &error, "correct the wavelengths"))
    })
}

#[derive(Default)]
struct Rows<'a> {
    acquisitions: Vec<Acquisition>,
    excitations: Vec<Excitation>,
    states: BTreeMap<(Option<u64>, Option<&'a str>), u32>,
    /// The acquisitions of a key in the order of their repeats.
    index: BTreeMap<Key<'a>, Vec<usize>>,
    /// How many values each cell of a key has had.
    seen: BTreeMap<(Key<'a>, usize), usize>,
}

impl<'a> Rows<'a> {
    /// The row and column of a point.
    fn cell(
        &mut self,
        file: &File,
        columns: &'a Columns,
        point: usize,
        emission: &EmissionAxis,
        common: &Common,
    ) -> Result<(usize, usize), ImportError> {
        let column = match (emission.wavelengths(), &columns.emission_nm) {
            (Some(axis), Some(nm)) => axis.partition_point(|known| *known < nm[point]),
            _ => 0,
        };
        let [theta_i, phi_i, theta_v, phi_v] = columns.angles.each_ref().map(|column| column[point] + 0.0);
        let geometry = Geometry::from_degrees(theta_i, phi_i, theta_v, phi_v)
            .map_err(|error| ImportError::Malformed(fault_of(file.at("data"), &error, "correct the angle")))?;
        let excitation_nm = columns.excitation_nm.as_ref().filter(|_| !columns.is_elastic).map(|nm| nm[point]);
        let polarisation = columns.polarisation_i.as_ref().map(|states| states[point].as_str());
        let angles = [theta_i, phi_i, theta_v, phi_v].map(f64::to_bits);
        let key = (angles, excitation_nm.map(f64::to_bits), polarisation);
        let repeat = self.seen.entry((key, column)).or_insert(0);
        *repeat += 1;
        let repeat = *repeat - 1;
        if let Some(row) = self.index.get(&key).and_then(|rows| rows.get(repeat)) {
            return Ok((*row, column));
        }
        let row = self.acquisitions.len();
        self.index.entry(key).or_default().push(row);
        let mut acquisition = Acquisition::at(Some(geometry), u32::try_from(row).unwrap_or(u32::MAX));
        acquisition.excitation = self.state(excitation_nm, polarisation, common);
        self.acquisitions.push(acquisition);
        Ok((row, column))
    }

    /// The index of an excitation state; none where nothing is known of it.
    fn state(&mut self, nm: Option<f64>, polarisation: Option<&'a str>, common: &Common) -> Option<u32> {
        let state = Excitation {
            wavelength_nm: nm.or(common.excitation.wavelength_nm),
            polarisation: polarisation.map(str::to_owned),
            ..common.excitation.clone()
        };
        if state == Excitation::default() {
            return None;
        }
        let next = u32::try_from(self.excitations.len()).ok()?;
        let index = *self.states.entry((nm.map(f64::to_bits), polarisation)).or_insert(next);
        if index == next {
            self.excitations.push(state);
        }
        Some(index)
    }
}
