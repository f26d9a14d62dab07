//! From a scene to a film: the rows shared out between threads, each by the way that covers the scene.

use rayon::prelude::*;

use super::generic;
use super::lighting::{Lighting, Parallel, Point, Rays};
use super::lobe::Lobe;
use super::scene::{Component, Scene};
use super::shade::{Frame, Row};
use crate::quantity::named;
use crate::simulate::film::Film;
use crate::terms::Undefined;

/// Rows that a thread takes at least.
const ROWS_AT_ONCE: usize = 8;
/// n - 1 beyond which a product in the loop may leave the range of numbers.
const INDEX_MINUS_ONE: std::ops::RangeInclusive<f64> = 1e-9..=1e3;

named! {
    /// How an image was made.
    Method, "method" {
        /// Several pixels at once; to one unit in the last place what the terms give.
        Lanes = "lanes",
        /// The terms pixel by pixel.
        Generic = "generic",
    }
}

/// Draws scenes.
#[derive(Debug, Clone, Copy)]
pub struct Renderer {
    method: Method,
    arch: pulp::Arch,
}

impl Default for Renderer {
    fn default() -> Self {
        Self { method: Method::Lanes, arch: pulp::Arch::new() }
    }
}

impl Renderer {
    /// The same without vector instructions beyond those that the program was built for: the same image to one unit in the last
    /// place, and later. For comparisons.
    #[must_use]
    pub fn plain(self) -> Self {
        Self { arch: pulp::Arch::Scalar, ..self }
    }

    /// The same by the terms pixel by pixel, for comparisons.
    #[must_use]
    pub fn generic(self) -> Self {
        Self { method: Method::Generic, ..self }
    }

    /// True where several pixels are drawn at once, and not the terms pixel by pixel.
    #[must_use]
    pub fn covers(&self, scene: &Scene) -> bool {
        self.lobe(scene).is_some()
    }

    fn lobe(&self, scene: &Scene) -> Option<Lobe> {
        let specular = &scene.specular;
        let is_covered = self.method == Method::Lanes && INDEX_MINUS_ONE.contains(&(specular.refractive_index - 1.0));
        if is_covered { Lobe::new(specular.distribution, specular.roughness) } else { None }
    }

    /// Draws one component of a scene on all of a film, with the threads of the current `rayon` pool; the image does not
    /// depend on their number. Says by which way: a specular term with a roughness or index far from any surface's is drawn
    /// by the terms themselves.
    ///
    /// # Errors
    /// [`Undefined`] where a term has no value; the film then holds nothing of use.
    pub fn render(&self, scene: &Scene, component: Component, film: &mut Film) -> Result<Method, Undefined> {
        let index_minus_one = scene.specular.refractive_index - 1.0;
        match scene.lighting {
            Lighting::Directional(direction) => {
                self.lit_by(Parallel::new(direction, index_minus_one), scene, component, film)
            }
            Lighting::Point(place) => self.lit_by(Point::new(place, index_minus_one), scene, component, film),
        }
    }

    fn lit_by<R: Rays>(
        &self,
        rays: R,
        scene: &Scene,
        component: Component,
        film: &mut Film,
    ) -> Result<Method, Undefined> {
        let colours = scene.of(component);
        let length = 3 * film.width();
        let rows = film.numbers_mut().par_chunks_mut(length).with_min_len(ROWS_AT_ONCE).enumerate();
        let Some(lobe) = self.lobe(scene) else {
            rows.try_for_each(|(row, out)| generic::fill(scene, &rays, &colours, row, out))?;
            return Ok(Method::Generic);
        };
        let frame = Frame::new(scene, rays, lobe, &colours);
        rows.for_each(|(row, out)| self.arch.dispatch(Row { frame: &frame, row, out }));
        Ok(Method::Lanes)
    }
}
