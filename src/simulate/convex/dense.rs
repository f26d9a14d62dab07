//! The same image as every renderer of bispectral surfaces makes it: the whole product of matrix and incident spectrum at every
//! pixel. It is what the three numbers per term are measured against, and the way for incident spectra that differ.
#![allow(clippy::needless_range_loop, reason = "a lane is an index into several arrays, and is told to be one")]

use rayon::prelude::*;

use super::lighting::{Lighting, Parallel, Point, Rays};
use super::lobe::Lobe;
use super::scene::{Colours, Scene};
use super::shade::{Frame, LANES};
use crate::simulate::film::Film;
use crate::simulate::spectral::Spectral;

/// Pixels whose sums stay in registers.
const AT_ONCE: usize = 8;
type Group = [f64; AT_ONCE];

/// Draws the total image with the spectra in full; the colours of the scene are not used. False where the specular term is one
/// that [`super::Renderer`] draws by the terms themselves; the film is then as it was.
pub fn render_dense(scene: &Scene, spectral: &Spectral, film: &mut Film) -> bool {
    let index_minus_one = scene.specular.refractive_index - 1.0;
    match scene.lighting {
        Lighting::Directional(direction) => lit_by(Parallel::new(direction, index_minus_one), scene, spectral, film),
        Lighting::Point(place) => lit_by(Point::new(place, index_minus_one), scene, spectral, film),
    }
}

fn lit_by<R: Rays>(rays: R, scene: &Scene, spectral: &Spectral, film: &mut Film) -> bool {
    let Some(lobe) = Lobe::new(scene.specular.distribution, scene.specular.roughness) else { return false };
    // No diffuse colour hides the lobe: it is evaluated wherever it is not 0.
    let colours = Colours { luminescent: [0.0; 3], diffuse: [0.0; 3], specular: [1.0; 3] };
    let frame = Frame::new(scene, rays, lobe, &colours);
    let dense = Dense { frame: &frame, scene, spectral };
    let (arch, length) = (pulp::Arch::new(), 3 * film.width());
    film.numbers_mut()
        .par_chunks_mut(length)
        .enumerate()
        .for_each(|(row, out)| arch.dispatch(DenseRow { dense: &dense, row, out }));
    true
}

struct Dense<'a, R> {
    frame: &'a Frame<R>,
    scene: &'a Scene,
    spectral: &'a Spectral,
}

struct DenseRow<'a, R> {
    dense: &'a Dense<'a, R>,
    row: usize,
    out: &'a mut [f32],
}

impl<R: Rays> pulp::WithSimd for DenseRow<'_, R> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: pulp::Simd>(self, _: S) {
        let width = self.out.len() / 3;
        self.out.fill(0.0);
        let columns = self.dense.scene.sphere.columns(self.row, width);
        let mut incident = vec![[0.0; AT_ONCE]; self.dense.spectral.excitation.len()];
        for first in columns.clone().step_by(LANES) {
            let [lit, shine] = self.dense.frame.shares::<S>(self.row, first);
            let groups = lit.as_chunks().0.iter().zip(shine.as_chunks().0);
            for (group, (lit, shine)) in groups.enumerate() {
                let first = first + group * AT_ONCE;
                let count = AT_ONCE.min(columns.end.saturating_sub(first));
                let pixels = self.dense.pixels(lit, shine, &mut incident);
                for c in 0..3 {
                    for lane in 0..count {
                        self.out[c * width + first + lane] = pixels[c][lane] as f32;
                    }
                }
            }
        }
    }
}

impl<R: Rays> Dense<'_, R> {
    /// X, Y and Z of a few pixels. Each has its own incident spectrum; that they differ by a factor only is not made use of.
    #[inline(always)]
    fn pixels(&self, lit: &Group, shine: &Group, incident: &mut [Group]) -> [Group; 3] {
        let spectral = self.spectral;
        for (incident, e) in incident.iter_mut().zip(&spectral.excitation) {
            for lane in 0..AT_ONCE {
                incident[lane] = e * lit[lane];
            }
        }
        let Some(density) = spectral.density.as_slice() else { return [[0.0; AT_ONCE]; 3] };
        let mut out = [[0.0; AT_ONCE]; 3];
        let rows = density.chunks_exact(spectral.excitation.len());
        let emissions = spectral.irradiance.iter().zip(&spectral.elastic).zip(&spectral.weights);
        for (density, ((e, elastic), weights)) in rows.zip(emissions) {
            let mut radiance = [0.0; AT_ONCE];
            for (density, incident) in density.iter().zip(incident.iter()) {
                for lane in 0..AT_ONCE {
                    radiance[lane] += density * incident[lane];
                }
            }
            for lane in 0..AT_ONCE {
                radiance[lane] += e * (elastic * lit[lane] + self.scene.specular.intensity * shine[lane]);
            }
            for c in 0..3 {
                for lane in 0..AT_ONCE {
                    out[c][lane] += weights[c] * radiance[lane];
                }
            }
        }
        out
    }
}
