//! How far two pictures are from each other.

use super::picture::{Kept, Layer, Picture};
use super::plan::lab_distance;

impl Picture {
    /// CIELAB distance (1976) of each pixel of the total from that of another picture, white being that of this one; `None` for pictures
    /// of another size, without a total, or of spectra.
    #[must_use]
    pub fn lab_distances(&self, other: &Self) -> Option<Vec<f64>> {
        let is_colour = self.kept == Kept::Colour && other.kept == Kept::Colour;
        if !is_colour || (self.width, self.height) != (other.width, other.height) {
            return None;
        }
        let (one, other) = (self.layer(Layer::Total)?, other.layer(Layer::Total)?);
        let at = |planes: &[Vec<f32>], k: usize| [0, 1, 2].map(|c| f64::from(planes[c][k]) / self.white[c]);
        Some((0..self.width * self.height).map(|k| lab_distance(at(one, k), at(other, k))).collect())
    }
}
