//! What depends on direction, from the table that `bbrf export --to csv` wrote.

use std::collections::BTreeMap;
use std::error::Error;
use std::path::Path;

/// Signed angles of incidence and viewing, degrees: the mirror direction is where they are equal.
type Angles = (i32, i32);

/// Spectra of one scan by direction.
#[derive(Debug)]
pub(crate) struct Spectra(BTreeMap<Angles, Vec<Value>>);

#[derive(Debug)]
struct Value {
    nm: f64,
    value: f64,
    sigma: f64,
}

/// How the mean wavelength of the emission scatters over directions, nm.
#[derive(Debug)]
pub(crate) struct Shape {
    /// Standard deviation over the directions.
    pub(crate) scatter_nm: f64,
    /// The same as the stated uncertainties of the values make it, root mean square.
    pub(crate) stated_nm: f64,
}

/// Where the brightest views are.
#[derive(Debug, Default)]
pub(crate) struct Brightest {
    /// Incidences looked at.
    pub(crate) incidences: usize,
    /// Brightest in the mirror direction or a neighbour of it.
    pub(crate) at_mirror: usize,
    /// Brightest on the mirror's side, further from the normal.
    pub(crate) beyond: usize,
}

impl Brightest {
    pub(crate) fn add(&mut self, other: &Self) {
        self.incidences += other.incidences;
        self.at_mirror += other.at_mirror;
        self.beyond += other.beyond;
    }
}

impl Spectra {
    /// Reads the values in a band.
    ///
    /// # Errors
    /// When the table cannot be read or lacks a column.
    pub(crate) fn read(path: &Path, (from, to): (f64, f64)) -> Result<Self, Box<dyn Error>> {
        let mut reader = csv::ReaderBuilder::new().comment(Some(b'#')).from_path(path)?;
        let header = reader.headers()?.clone();
        let column = |name: &str| header.iter().position(|one| one == name).ok_or(format!("no column {name}"));
        let names = ["theta_i_deg", "phi_i_deg", "theta_v_deg", "phi_v_deg", "emission_nm", "value", "sigma"];
        let columns = names.map(column);
        let mut spectra: BTreeMap<Angles, Vec<Value>> = BTreeMap::new();
        for record in reader.records() {
            let record = record?;
            let mut cell = [0.0; 7];
            for (cell, column) in cell.iter_mut().zip(&columns) {
                *cell = record.get(column.clone()?).unwrap_or_default().parse()?;
            }
            let [theta_i, phi_i, theta_v, phi_v, nm, value, sigma] = cell;
            if (from..=to).contains(&nm) {
                let angles = (signed(theta_i, phi_i, 180.0), signed(theta_v, phi_v, 0.0));
                spectra.entry(angles).or_default().push(Value { nm, value, sigma });
            }
        }
        Ok(Self(spectra))
    }

    /// How the mean wavelength of the spectrum scatters over directions: not at all, if its shape is the same everywhere.
    pub(crate) fn shape(&self) -> Shape {
        let centroids: Vec<(f64, f64)> = self.0.values().map(|spectrum| centroid(spectrum)).collect();
        let count = centroids.len() as f64;
        let mean = centroids.iter().map(|(nm, _)| nm).sum::<f64>() / count;
        let scatter = centroids.iter().map(|(nm, _)| (nm - mean).powi(2)).sum::<f64>() / (count - 1.0);
        let stated = centroids.iter().map(|(_, sigma)| sigma.powi(2)).sum::<f64>() / count;
        Shape { scatter_nm: scatter.sqrt(), stated_nm: stated.sqrt() }
    }

    /// Where the brightest view lies at incidences of 20 to 60 degrees to either side.
    pub(crate) fn brightest(&self) -> Brightest {
        let mut brightest = Brightest::default();
        for theta_i in (-60..=60).step_by(10).filter(|theta_i: &i32| theta_i.abs() >= 20) {
            let views = self.0.iter().filter(|((i, _), _)| *i == theta_i);
            let total = |spectrum: &[Value]| spectrum.iter().map(|one| one.value).sum::<f64>();
            let Some(((_, theta_v), _)) = views.max_by(|one, other| total(one.1).total_cmp(&total(other.1))) else {
                continue;
            };
            let further = (theta_v - theta_i) * theta_i.signum();
            brightest.incidences += 1;
            brightest.at_mirror += usize::from(further.abs() <= 10);
            brightest.beyond += usize::from(further > 10);
        }
        brightest
    }
}

/// A polar angle, positive on the side of `positive_deg`.
fn signed(theta_deg: f64, phi_deg: f64, positive_deg: f64) -> i32 {
    let sign = if (phi_deg - positive_deg).abs() < 90.0 { 1.0 } else { -1.0 };
    (sign * theta_deg).round() as i32
}

/// The mean wavelength of a spectrum and its standard uncertainty by independent errors of the values, nm.
fn centroid(spectrum: &[Value]) -> (f64, f64) {
    let total: f64 = spectrum.iter().map(|one| one.value).sum();
    let mean = spectrum.iter().map(|one| one.value * one.nm).sum::<f64>() / total;
    let variance: f64 = spectrum.iter().map(|one| ((one.nm - mean) * one.sigma / total).powi(2)).sum();
    (mean, variance.sqrt())
}
