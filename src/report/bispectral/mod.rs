//! The figures of a Donaldson matrix, as the paper's Fig. 5: a surface and a map over excitation and emission, with the sums
//! over either axis beside it, and the stored factors.
//!
//! Reflected light is a line of another kind and a hundred times higher than luminescence: it is drawn apart, in greys and
//! on a scale of its own.

mod cells;
mod factors;
mod map;
mod margins;
mod panel;
mod relief;

use super::fitted::Drawn;
use super::html::significant;
use super::subject;
use crate::dataset::{Document, Measurement};
use cells::Cells;
pub use factors::factor_figures;

/// The map and the surface of a matrix.
#[must_use]
pub fn matrix_figures(document: &Document, measurement: &Measurement) -> Drawn {
    let mut drawn = Drawn::default();
    let subject = subject::of_measurement(document, measurement);
    match Cells::of(measurement) {
        Ok(cells) => {
            drawn.take(map::bispectral_map(&cells, &subject));
            drawn.take(relief::bispectral_surface(&cells, &subject));
        }
        Err(error) => drawn.not_drawn.push(error.in_full()),
    }
    drawn.prefixed(measurement.id.as_str())
}

/// The largest luminescent value in words, for a caption that is read without the picture.
fn strongest(cells: &Cells) -> String {
    let finite = cells.luminescent.indexed_iter().filter(|(_, value)| value.is_finite());
    let most = finite.max_by(|a, b| a.1.total_cmp(b.1));
    most.map_or_else(
        || "No cell holds luminescence alone.".to_owned(),
        |((i, j), value)| {
            format!(
                "Luminescence is strongest at excitation {} nm and emission {} nm: {}.",
                cells.excitation_nm[i],
                cells.emission_nm[j],
                significant(*value, 3)
            )
        },
    )
}
