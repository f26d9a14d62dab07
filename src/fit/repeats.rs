//! Geometries that were measured more than once: what they scatter by, beside what was stated.

use std::collections::BTreeMap;

use ndarray::Array2;

use crate::quantity::Geometry;

/// A geometry that was measured more than once.
#[derive(Debug, Clone, PartialEq)]
pub struct Repeated {
    /// Its directions.
    pub geometry: Geometry,
    /// Indices of its rows.
    pub rows: Vec<usize>,
    /// Standard deviation of its values in units of the stated uncertainties, over all emission values.
    pub scatter: f64,
}

/// All of them.
#[derive(Debug, Clone, PartialEq)]
pub struct Repeats {
    /// In the order in which they were first measured.
    pub geometries: Vec<Repeated>,
    /// Standard deviation of the values about the mean of their geometry, in units of the stated uncertainties; 1 where
    /// those are right.
    pub scatter: f64,
    /// How many values beyond the first of each geometry.
    pub degrees_of_freedom: usize,
}

/// What repeats say of the stated uncertainties.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Verdict {
    /// The values scatter more than is stated.
    TooSmall,
    /// The values scatter less.
    Larger,
    /// Neither is shown.
    Agrees,
}

impl Repeats {
    /// Standard uncertainty of the scatter: that of a standard deviation from normal errors, scatter/sqrt(2 nu) (GUM E.4.3).
    #[must_use]
    pub fn scatter_uncertainty(&self) -> f64 {
        self.scatter / (2.0 * self.degrees_of_freedom as f64).sqrt()
    }

    /// What is shown by more than three of what a right statement would scatter by.
    #[must_use]
    pub fn verdict(&self) -> Verdict {
        let by_chance = 3.0 / (2.0 * self.degrees_of_freedom as f64).sqrt();
        match self.scatter {
            scatter if scatter > 1.0 + by_chance => Verdict::TooSmall,
            scatter if scatter < 1.0 - by_chance => Verdict::Larger,
            _ => Verdict::Agrees,
        }
    }

    /// Groups rows of one geometry: values and their uncertainties \[B, N\], of which those count that can be fitted. `None`
    /// where no geometry has two values.
    pub(super) fn of(geometry: &[Geometry], values: &Array2<f64>, sigma: &Array2<f64>) -> Option<Self> {
        let key = |geometry: &Geometry| {
            let Geometry { incidence, viewing } = geometry;
            // Positive and negative zero are one angle.
            [incidence.theta_deg(), incidence.phi_deg(), viewing.theta_deg(), viewing.phi_deg()]
                .map(|angle| (angle + 0.0).to_bits())
        };
        let mut groups: BTreeMap<[u64; 4], Vec<usize>> = BTreeMap::new();
        for (row, geometry) in geometry.iter().enumerate() {
            groups.entry(key(geometry)).or_default().push(row);
        }
        let mut groups: Vec<Vec<usize>> = groups.into_values().filter(|rows| rows.len() > 1).collect();
        groups.sort();
        let (mut square, mut degrees_of_freedom) = (0.0, 0);
        let mut geometries = Vec::new();
        for rows in groups {
            let (sum, freedom) = spread(&rows, values, sigma);
            if freedom > 0 {
                square += sum;
                degrees_of_freedom += freedom;
                let scatter = (sum / freedom as f64).sqrt();
                geometries.push(Repeated { geometry: geometry[rows[0]], rows, scatter });
            }
        }
        let scatter = (square / degrees_of_freedom as f64).sqrt();
        (degrees_of_freedom > 0).then_some(Self { geometries, scatter, degrees_of_freedom })
    }
}

/// Sum of squares about the weighted mean of each emission value, and its degrees of freedom.
fn spread(rows: &[usize], values: &Array2<f64>, sigma: &Array2<f64>) -> (f64, usize) {
    let (mut square, mut freedom) = (0.0, 0);
    for emission in 0..values.nrows() {
        let both = rows.iter().map(|row| (values[(emission, *row)], sigma[(emission, *row)]));
        let pairs: Vec<(f64, f64)> =
            both.filter(|(value, sigma)| value.is_finite() && sigma.is_finite() && *sigma > 0.0).collect();
        if pairs.len() > 1 {
            let weight: f64 = pairs.iter().map(|(_, sigma)| sigma.powi(-2)).sum();
            let mean = pairs.iter().map(|(value, sigma)| value * sigma.powi(-2)).sum::<f64>() / weight;
            square += pairs.iter().map(|(value, sigma)| ((value - mean) / sigma).powi(2)).sum::<f64>();
            freedom += pairs.len() - 1;
        }
    }
    (square, freedom)
}
