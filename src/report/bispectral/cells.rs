//! The cells of a matrix, those that hold reflected light told from the others.

use ndarray::Array2;

use crate::dataset::Measurement;
use crate::donaldson::{Floor, Matrix, Overlap};
use crate::quantity::{Flag, Part};
use crate::report::ReportError;
use crate::report::canvas::Area;
use crate::report::colours::Colours;
use crate::report::scale::{Scale, extent};

/// The most cells that are drawn along an axis; more are drawn in blocks.
const MOST: usize = 160;
/// Up to so many times the noise a colour scale is linear: noise is seen for what it is, and does not look like light.
const NOISE_IS_LINEAR: f64 = 3.0;

/// The cells of a matrix \[excitation, emission\], wavelengths in nm, ascending.
#[derive(Debug, Clone)]
pub(super) struct Cells {
    pub(super) id: String,
    pub(super) excitation_nm: Vec<f64>,
    pub(super) emission_nm: Vec<f64>,
    /// What lies clear of the reflected light; NaN elsewhere and where there is no value.
    pub(super) luminescent: Array2<f64>,
    /// What lies next to the diagonal: reflected light, and what luminescence there is; NaN elsewhere.
    pub(super) reflected: Array2<f64>,
    /// True where a luminescent value was interpolated.
    pub(super) is_marked: Array2<bool>,
    /// Standard uncertainties, where stated.
    pub(super) sigma: Option<Array2<f64>>,
    /// The noise where no light can be.
    pub(super) floor: Floor,
    /// The emission width that the values hold, nm.
    pub(super) width_nm: Vec<f64>,
    /// How many measured cells one drawn cell stands for, along excitation and emission.
    pub(super) block: (usize, usize),
}

impl Cells {
    /// The cells of a measurement. Where its bandpasses are unstated, where reflected light is is found in the values, as a
    /// separation does.
    pub(super) fn of(measurement: &Measurement) -> Result<Self, ReportError> {
        let matrix = Matrix::of_any_size(measurement).map_err(|source| ReportError::Matrix { source })?;
        let ascends = |nm: &[f64]| nm.windows(2).all(|pair| pair[0] < pair[1]) && nm.iter().all(|nm| nm.is_finite());
        if !ascends(&matrix.emission_nm) || !ascends(&matrix.excitation_nm) {
            return Err(ReportError::NotAscending { measurement: measurement.id.to_string() });
        }
        let overlap = Overlap::of(&matrix);
        let shape = matrix.values.dim();
        let is_mixed = measurement.quantity.part != Part::Luminescent;
        let is_reflected = |(i, j): (usize, usize)| {
            let is_equal = (matrix.excitation_nm[i] - matrix.emission_nm[j]).abs() < 1e-6;
            is_mixed && (is_equal || overlap.holds(&matrix, i, j))
        };
        let at = |(i, j): (usize, usize)| (matrix.rows[i], j);
        let is_marked = |cell| measurement.flags[at(cell)] == Flag::Interpolated.bit();
        let value = |cell| if is_marked(cell) { measurement.values[at(cell)] } else { matrix.values[cell] };
        let only = |wanted: bool| {
            Array2::from_shape_fn(shape, |cell| if is_reflected(cell) == wanted { value(cell) } else { f64::NAN })
        };
        Ok(Self {
            id: measurement.id.to_string(),
            luminescent: only(false),
            reflected: only(true),
            is_marked: Array2::from_shape_fn(shape, |cell| is_marked(cell) && !is_reflected(cell)),
            floor: Floor::of(&matrix, &overlap),
            width_nm: matrix.emission_width_nm(),
            sigma: matrix.sigma,
            excitation_nm: matrix.excitation_nm,
            emission_nm: matrix.emission_nm,
            block: (1, 1),
        })
    }

    /// The luminescent value of a cell, or the reflected one.
    pub(super) fn is_missing(&self, cell: (usize, usize)) -> bool {
        !self.luminescent[cell].is_finite() && !self.reflected[cell].is_finite()
    }

    /// The same with so many cells that they can be drawn: means of blocks. A block with reflected light shows its highest.
    pub(super) fn thinned(&self) -> Self {
        let (rows, columns) = self.luminescent.dim();
        let block = (rows.div_ceil(MOST).max(1), columns.div_ceil(MOST).max(1));
        if block == (1, 1) {
            return self.clone();
        }
        let shape = (rows.div_ceil(block.0), columns.div_ceil(block.1));
        let cells = |(i, j): (usize, usize)| {
            let columns = j * block.1..((j + 1) * block.1).min(columns);
            (i * block.0..((i + 1) * block.0).min(rows)).flat_map(move |i| columns.clone().map(move |j| (i, j)))
        };
        let reflected =
            Array2::from_shape_fn(shape, |at| cells(at).fold(f64::NAN, |most, c| most.max(self.reflected[c])));
        let mean = |at: (usize, usize)| {
            let finite = cells(at).map(|cell| self.luminescent[cell]).filter(|value| value.is_finite());
            let (sum, count) = finite.fold((0.0, 0.0), |(sum, count), value| (sum + value, count + 1.0));
            if reflected[at].is_finite() { f64::NAN } else { sum / count }
        };
        let centres = |nm: &[f64], size: usize| {
            nm.chunks(size).map(|part| part.iter().sum::<f64>() / part.len() as f64).collect()
        };
        Self {
            luminescent: Array2::from_shape_fn(shape, mean),
            is_marked: Array2::from_shape_fn(shape, |at| cells(at).any(|cell| self.is_marked[cell])),
            reflected,
            excitation_nm: centres(&self.excitation_nm, block.0),
            emission_nm: centres(&self.emission_nm, block.1),
            block,
            ..self.clone()
        }
    }

    /// In words, where one drawn cell stands for several.
    pub(super) fn blocks_in_words(&self) -> String {
        match self.block {
            (1, 1) => String::new(),
            (i, j) => format!("; drawn in blocks of {i} x {j} (excitation x emission), each its mean"),
        }
    }

    /// Colours of the luminescence: through zero, linear within the noise. `None` where no cell holds any.
    pub(super) fn luminescent_colours(&self) -> Option<Colours> {
        let (low, high) = extent(self.luminescent.iter().copied())?;
        let most = low.abs().max(high.abs());
        if most <= 0.0 {
            return Some(Colours::AroundZero(1.0));
        }
        let noise = if self.floor.rms > 0.0 { NOISE_IS_LINEAR * self.floor.rms } else { most / 30.0 };
        let linear = noise.clamp(most / 1000.0, most);
        // A sliver on the side that is hardly there would have no room for a tick.
        let (from, to) = (low.min(0.0).min(-0.1 * linear), high.max(0.0).max(0.1 * linear));
        Some(Colours::Signed(Scale::AroundZero { linear, from, to }))
    }

    /// Greys of the reflected light, from zero. `None` where no cell holds any.
    pub(super) fn reflected_colours(&self) -> Option<Colours> {
        let (_, high) = extent(self.reflected.iter().copied())?;
        Some(Colours::Greys(Scale::Linear { from: 0.0, to: if high > 0.0 { high } else { 1.0 } }))
    }
}

/// A swatch of a legend with its text.
pub(super) fn swatch(left: f64, y: f64) -> Area {
    Area::new(left, y, 24.0, 18.0)
}
