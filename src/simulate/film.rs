//! The image: three planes of single precision, kept in one piece of memory that can be used again.

/// Most pixels along one side.
pub const LONGEST_SIDE: usize = 32_768;

/// Three numbers per pixel, without a unit of its own: what the colours of the scene are in.
///
/// Memory holds row after row, and in each row the three planes one after another, so that one thread has one row in one
/// piece. A film that is used again is written in full.
#[derive(Debug, Clone, PartialEq)]
pub struct Film {
    width: usize,
    height: usize,
    numbers: Vec<f32>,
}

/// A size that is no image.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("an image of {width} x {height} pixels; expected 1 to {LONGEST_SIDE} along each side")]
pub struct NoFilm {
    /// Pixels in a row.
    pub width: usize,
    /// Rows.
    pub height: usize,
}

impl Film {
    /// A black image.
    ///
    /// # Errors
    /// [`NoFilm`] for an empty image and for one with too many pixels along a side.
    pub fn new(width: usize, height: usize) -> Result<Self, NoFilm> {
        if !(1..=LONGEST_SIDE).contains(&width) || !(1..=LONGEST_SIDE).contains(&height) {
            return Err(NoFilm { width, height });
        }
        Ok(Self { width, height, numbers: vec![0.0; 3 * width * height] })
    }

    /// An image from its pixels, by column and row.
    ///
    /// # Errors
    /// As [`Film::new`].
    pub fn from_pixels(
        width: usize,
        height: usize,
        mut pixel: impl FnMut(usize, usize) -> [f32; 3],
    ) -> Result<Self, NoFilm> {
        let mut film = Self::new(width, height)?;
        for (row, planes) in film.numbers.chunks_exact_mut(3 * width).enumerate() {
            for column in 0..width {
                for (plane, value) in pixel(column, row).into_iter().enumerate() {
                    planes[plane * width + column] = value;
                }
            }
        }
        Ok(film)
    }

    /// Pixels in a row.
    #[must_use]
    pub fn width(&self) -> usize {
        self.width
    }

    /// Rows.
    #[must_use]
    pub fn height(&self) -> usize {
        self.height
    }

    /// One row of one of the three planes; empty outside the image.
    #[must_use]
    pub fn row(&self, row: usize, plane: usize) -> &[f32] {
        if row >= self.height || plane >= 3 {
            return &[];
        }
        let first = (3 * row + plane) * self.width;
        &self.numbers[first..first + self.width]
    }

    /// The three numbers of a pixel; `None` outside the image.
    #[must_use]
    pub fn pixel(&self, column: usize, row: usize) -> Option<[f32; 3]> {
        let at = |plane: usize| self.row(row, plane).get(column).copied();
        Some([at(0)?, at(1)?, at(2)?])
    }

    /// All numbers, rows of three planes each.
    #[must_use]
    pub fn numbers(&self) -> &[f32] {
        &self.numbers
    }

    pub(super) fn numbers_mut(&mut self) -> &mut [f32] {
        &mut self.numbers
    }
}
