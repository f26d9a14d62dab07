//! What a picture of spectra looks like: its planes as X, Y and Z.

use super::film::{Film, NoFilm};
use super::grid::Grid;
use super::picture::{Kept, Layer, Picture};
use super::scene::Scene;

/// Why there is no film.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum NoLayer {
    /// It was not drawn.
    #[error("layer `{0}` was not drawn; expected one of the layers of the picture")]
    Missing(Layer),
    /// The size.
    #[error(transparent)]
    Film(#[from] NoFilm),
}

impl Picture {
    /// A layer as X, Y and Z, white having a Y of 1; `scene` is what was drawn.
    ///
    /// # Errors
    /// [`NoLayer`].
    pub fn film(&self, scene: &Scene, layer: Layer) -> Result<Film, NoLayer> {
        let planes = self.layer(layer).ok_or(NoLayer::Missing(layer))?;
        let mut film = Film::new(self.width, self.height)?;
        let weights = match self.kept {
            Kept::Colour => None,
            Kept::Spectra => Some(self.weights(scene)),
        };
        let width = self.width;
        for (at, out) in film.numbers_mut().chunks_exact_mut(width).enumerate() {
            let (row, c) = (at / 3, at % 3);
            match &weights {
                None => out.copy_from_slice(&planes[c][row * width..(row + 1) * width]),
                Some(weights) => {
                    for (column, out) in out.iter_mut().enumerate() {
                        let sum: f64 = weights[c]
                            .iter()
                            .zip(planes)
                            .map(|(w, plane)| w * f64::from(plane[row * width + column]))
                            .sum();
                        *out = sum as f32;
                    }
                }
            }
        }
        Ok(film)
    }

    /// X, Y and Z of spectral radiance, a white of Y 1.
    fn weights(&self, scene: &Scene) -> [Vec<f64>; 3] {
        let grid = match self.nm.as_slice() {
            [first, second, .., last] => Grid::new(*first, *last, second - first).ok(),
            [first, last] => Grid::new(*first, *last, last - first).ok(),
            _ => None,
        };
        let grid = grid.filter(|grid| grid.nm().len() == self.nm.len()).unwrap_or_else(|| scene.grid.clone());
        let scale = std::f64::consts::PI / scene.white().xyz[1];
        grid.weights(scene.observer).map(|list| list.into_iter().map(|weight| weight * scale).collect())
    }
}
