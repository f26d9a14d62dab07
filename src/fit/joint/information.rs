//! The information of a scan about all parameters, and the landscape that it makes.

use nalgebra::{DMatrix, DVector};
use ndarray::Array2;

use super::columns::{Cell, Columns};
use super::{Joint, LONGEST, Nuisance};
use crate::fit::curvature::Share;
use crate::fit::descent::{Height, Landscape, Slope};
use crate::fit::outcome::Fit;

/// A record's own variance is at least this share of the whole: what a subtraction leaves of nothing is rounding.
const OWN_VARIANCE: f64 = 1e-6;

/// Where each parameter stands: diffuse amplitudes, specular ones, ln r, ln(n - 1), effects.
#[derive(Debug, Clone)]
pub(super) struct Layout {
    pub(super) bands: usize,
    pub(super) diffuse: usize,
    pub(super) specular: usize,
    /// Which nuisance parameters are fitted.
    pub(super) effects: Vec<usize>,
}

impl Layout {
    pub(super) fn new(joint: &Joint<'_>, bands: usize) -> Self {
        Self {
            bands,
            diffuse: if joint.has_diffuse { bands } else { 0 },
            specular: if joint.share == Share::ShapeAndIntensity { 1 } else { bands },
            effects: (0..joint.nuisances.len()).filter(|&k| joint.nuisances[k].sigma > 0.0).collect(),
        }
    }

    pub(super) fn count(&self) -> usize {
        self.shape() + 2 + self.effects.len()
    }

    /// The place of an emission value's specular amplitude.
    pub(super) fn intensity(&self, band: usize) -> usize {
        self.diffuse + band.min(self.specular - 1)
    }

    /// The place of ln r; that of ln(n - 1) and then the effects follow.
    pub(super) fn shape(&self) -> usize {
        self.diffuse + self.specular
    }

    pub(super) fn start(&self, joint: &Joint<'_>, fit: &Fit) -> Vec<f64> {
        let diffuse = fit.bands.iter().take(self.diffuse).map(|band| band.diffuse);
        let specular = fit.bands.iter().take(self.specular).map(|band| band.intensity);
        let shape = [fit.roughness.ln(), fit.index_minus_one.ln()];
        let effects = self.effects.iter().map(|&k| {
            let Nuisance { value, sigma, effect } = joint.nuisances[k];
            // At size 0 a disc has no slope: the fit could never leave it.
            if effect.is_size() && value == 0.0 { sigma } else { value }
        });
        diffuse.chain(specular).chain(shape).chain(effects).collect()
    }

    pub(super) fn bounds(&self, joint: &Joint<'_>) -> (Vec<f64>, Vec<f64>, Vec<f64>) {
        let amplitudes = self.shape();
        let (mut low, mut high) = (vec![0.0; amplitudes], vec![f64::INFINITY; amplitudes]);
        let mut longest = vec![f64::INFINITY; amplitudes];
        for (bound, step) in joint.box_of_shape.iter().zip(LONGEST) {
            low.push(bound.0);
            high.push(bound.1);
            longest.push(step);
        }
        for &k in &self.effects {
            low.push(if joint.nuisances[k].effect.is_size() { 0.0 } else { -90.0 });
            high.push(90.0);
            longest.push(LONGEST[2]);
        }
        (low, high, longest)
    }

    /// The values of all effects, fitted or not.
    pub(super) fn effects(&self, joint: &Joint<'_>, at: &[f64]) -> Vec<f64> {
        let mut values: Vec<f64> = joint.nuisances.iter().map(|nuisance| nuisance.value).collect();
        for (place, &k) in self.effects.iter().enumerate() {
            values[k] = at[self.shape() + 2 + place];
        }
        values
    }
}

/// The scan, weighted.
pub(super) struct Scan<'a> {
    joint: Joint<'a>,
    layout: Layout,
    /// 1 over the own variance \[B, N\]; 0 for a value that is not used.
    weight: Array2<f64>,
    /// The record's scale \[B, N\], in the unit of the values.
    record: Array2<f64>,
    at: Vec<f64>,
    columns: Columns,
}

impl<'a> Scan<'a> {
    /// `None` where no value is left.
    pub(super) fn new(joint: &Joint<'a>, layout: &Layout, start: &[f64]) -> Option<Self> {
        let shape = layout.shape();
        let columns = joint.columns([start[shape], start[shape + 1]], &layout.effects(joint, start));
        let mut weight = Array2::zeros(joint.values.dim());
        let mut record = Array2::zeros(joint.values.dim());
        for ((band, row), &value) in joint.values.indexed_iter() {
            let (sigma, Some(cell)) = (joint.sigma[(band, row)], columns.cells[row]) else { continue };
            if !(value.is_finite() && sigma > 0.0 && sigma.is_finite()) {
                continue;
            }
            // What stands for a bound has an uncertainty of its own alone.
            let is_bound = joint.bounds.iter().any(|bound| (bound.emission, bound.geometry) == (band, row));
            let relative = if is_bound { 0.0 } else { joint.record_relative[band] };
            let own = sigma * sigma - (relative * value).powi(2);
            weight[(band, row)] = own.max(OWN_VARIANCE * sigma * sigma).recip();
            record[(band, row)] = relative * predicted(layout, start, &cell, band);
        }
        weight.iter().any(|weight| *weight > 0.0).then(|| Self {
            joint: *joint,
            layout: layout.clone(),
            weight,
            record,
            at: start.to_vec(),
            columns,
        })
    }

    /// What the prior of the effects adds: chi-square, and for each its place, pull and weight.
    fn priors(&self) -> impl Iterator<Item = (usize, f64, f64)> {
        self.layout.effects.iter().enumerate().map(|(place, &k)| {
            let at = self.layout.shape() + 2 + place;
            let Nuisance { value, sigma, .. } = self.joint.nuisances[k];
            (at, (self.at[at] - value) / sigma, sigma.recip())
        })
    }
}

fn predicted(layout: &Layout, at: &[f64], cell: &Cell, band: usize) -> f64 {
    let diffuse = if layout.diffuse > 0 { at[band] * cell.diffuse } else { 0.0 };
    diffuse + at[layout.intensity(band)] * cell.specular
}

impl Landscape for Scan<'_> {
    type Slope = Information;

    fn height(&mut self, at: &[f64]) -> Height {
        let shape = self.layout.shape();
        self.at = at.to_vec();
        self.columns = self.joint.columns([at[shape], at[shape + 1]], &self.layout.effects(&self.joint, at));
        let (mut chi_square, mut size) = (0.0, 0.0);
        for (row, cell) in self.columns.cells.iter().enumerate() {
            let Some(cell) = cell else { continue };
            let (mut rr, mut ur, mut uu) = (0.0, 0.0, 0.0);
            for band in 0..self.layout.bands {
                let (w, u) = (self.weight[(band, row)], self.record[(band, row)]);
                if w > 0.0 {
                    let r = self.joint.values[(band, row)] - predicted(&self.layout, at, cell, band);
                    rr += w * r * r;
                    ur += w * u * r;
                    uu += w * u * u;
                    size += w * self.joint.values[(band, row)].powi(2);
                }
            }
            chi_square += rr - ur * ur / (1.0 + uu);
        }
        chi_square += self.priors().map(|(_, pull, _)| pull * pull).sum::<f64>();
        Height { chi_square, noise: 4.0 * f64::EPSILON * size }
    }

    fn slope(&mut self) -> Option<Information> {
        let (layout, count) = (&self.layout, self.layout.count());
        let mut information = DMatrix::zeros(count, count);
        let mut gradient = DVector::zeros(count);
        let mut dyad = DVector::zeros(count);
        for (row, cell) in self.columns.cells.iter().enumerate() {
            let Some(cell) = cell else { continue };
            dyad.fill(0.0);
            let (mut ur, mut uu) = (0.0, 0.0);
            for band in 0..layout.bands {
                let (w, u) = (self.weight[(band, row)], self.record[(band, row)]);
                if w == 0.0 {
                    continue;
                }
                let r = self.joint.values[(band, row)] - predicted(layout, &self.at, cell, band);
                let entries = self.entries(band, row, cell);
                for (k, &(i, x)) in entries.iter().enumerate() {
                    gradient[i] -= w * x * r;
                    dyad[i] += w * u * x;
                    for &(j, y) in &entries[k..] {
                        information[(j.max(i), j.min(i))] += w * x * y;
                    }
                }
                ur += w * u * r;
                uu += w * u * u;
            }
            if uu > 0.0 {
                let k = (1.0 + uu).recip();
                gradient.axpy(k * ur, &dyad, 1.0);
                // The lower triangle alone.
                for j in 0..count {
                    let factor = k * dyad[j];
                    for i in j..count {
                        information[(i, j)] -= factor * dyad[i];
                    }
                }
            }
        }
        for (at, pull, weight) in self.priors() {
            information[(at, at)] += weight * weight;
            gradient[at] += pull * weight;
        }
        Information::new(information, gradient)
    }
}

impl Scan<'_> {
    /// The derivatives of one prediction that are not 0, by place, in ascending order.
    fn entries(&self, band: usize, row: usize, cell: &Cell) -> Vec<(usize, f64)> {
        let layout = &self.layout;
        let (intensity, shape) = (layout.intensity(band), layout.shape());
        let (a, c) = (if layout.diffuse > 0 { self.at[band] } else { 0.0 }, self.at[intensity]);
        let mut entries = Vec::with_capacity(4 + layout.effects.len());
        if layout.diffuse > 0 {
            entries.push((band, cell.diffuse));
        }
        entries.push((intensity, cell.specular));
        entries.push((shape, c * cell.by_r));
        entries.push((shape + 1, c * cell.by_m));
        for (place, column) in self.columns.by_effect.iter().enumerate() {
            let (diffuse, specular) = column[row];
            entries.push((shape + 2 + place, a * diffuse + c * specular));
        }
        entries
    }
}

/// Chi-square to second order: half its gradient, and the information matrix.
#[derive(Debug, Clone)]
pub(super) struct Information {
    pub(super) matrix: DMatrix<f64>,
    gradient: DVector<f64>,
}

impl Information {
    /// From the lower triangle; `None` where it is no number.
    fn new(mut matrix: DMatrix<f64>, gradient: DVector<f64>) -> Option<Self> {
        matrix.fill_upper_triangle_with_lower_triangle();
        let finite = matrix.iter().chain(gradient.iter()).all(|x| x.is_finite());
        finite.then_some(Self { matrix, gradient })
    }

    /// The inverse of the information about parameters that are free; 0 elsewhere. `None` where a combination of them is
    /// not known at all.
    pub(super) fn covariance(&self, free: &[usize]) -> Option<DMatrix<f64>> {
        let scale: Vec<f64> = free.iter().map(|&k| self.matrix[(k, k)].sqrt()).collect();
        if scale.contains(&0.0) {
            return None;
        }
        let scaled =
            DMatrix::from_fn(free.len(), free.len(), |i, j| self.matrix[(free[i], free[j])] / (scale[i] * scale[j]));
        let inverse = scaled.cholesky()?.inverse();
        let mut covariance = DMatrix::zeros(self.matrix.nrows(), self.matrix.ncols());
        for (i, &k) in free.iter().enumerate() {
            for (j, &l) in free.iter().enumerate() {
                covariance[(k, l)] = inverse[(i, j)] / (scale[i] * scale[j]);
            }
        }
        Some(covariance)
    }
}

impl Slope for Information {
    fn gradient(&self) -> &[f64] {
        self.gradient.as_slice()
    }

    fn step(&self, pinned: &[Option<f64>], damping: f64, step: &mut [f64]) {
        for (step, pin) in step.iter_mut().zip(pinned) {
            *step = pin.unwrap_or(0.0);
        }
        let moves = |k: &usize| pinned[*k].is_none() && self.matrix[(*k, *k)] > 0.0;
        let free: Vec<usize> = (0..pinned.len()).filter(moves).collect();
        let held: Vec<usize> = (0..pinned.len()).filter(|k| pinned[*k].is_some_and(|pin| pin != 0.0)).collect();
        let scale: Vec<f64> = free.iter().map(|&k| self.matrix[(k, k)].sqrt()).collect();
        let right = DVector::from_fn(free.len(), |i, _| {
            let carried: f64 = held.iter().map(|&k| self.matrix[(free[i], k)] * step[k]).sum();
            -(self.gradient[free[i]] + carried) / scale[i]
        });
        // Columns that agree to rounding: a little damping tells them apart.
        for extra in [0.0, 1e-14, 1e-12, 1e-10, 1e-8, 1e-4] {
            let scaled = DMatrix::from_fn(free.len(), free.len(), |i, j| {
                let x = self.matrix[(free[i], free[j])] / (scale[i] * scale[j]);
                if i == j { x + damping + extra } else { x }
            });
            if let Some(cholesky) = scaled.cholesky() {
                let solution = cholesky.solve(&right);
                for (i, &k) in free.iter().enumerate() {
                    step[k] = solution[i] / scale[i];
                }
                return;
            }
        }
    }

    fn decrease(&self, step: &[f64]) -> f64 {
        let step = DVector::from_column_slice(step);
        -(2.0 * self.gradient.dot(&step) + (&self.matrix * &step).dot(&step))
    }
}
