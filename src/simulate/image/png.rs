//! A film of X, Y and Z as a PNG in sRGB.

use png::{BitDepth, ColorType, Encoder, EncodingError, SrgbRenderingIntent};

use super::Notes;
use super::gamut::{Gamut, OutOfGamut};
use super::srgb::{Srgb, encoded};
use crate::quantity::named;
use crate::simulate::film::Film;

named! {
    /// Bits per channel.
    Depth, "depth" {
        /// 256 steps.
        Eight = "8",
        /// 65,536 steps.
        Sixteen = "16",
    }
}

/// How a film becomes a PNG.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Png {
    /// From the scene's white to the display's.
    pub display: Srgb,
    /// What becomes of colours that cannot be shown.
    pub gamut: Gamut,
    /// Bits per channel.
    pub depth: Depth,
}

/// Why there is no PNG.
#[derive(Debug, thiserror::Error)]
pub enum NoPng {
    /// A note that the format has no place for.
    #[error(
        "a note named `{0}` cannot be stored in a PNG; expected a name of 1 to 79 ASCII letters, digits and signs, without spaces"
    )]
    Note(String),
    /// The encoder's own.
    #[error("the image cannot be written as PNG: {0}")]
    Encoding(#[from] EncodingError),
}

impl Png {
    /// The bytes of the file, and what of the image the display cannot show. The planes of the film are X, Y and Z.
    ///
    /// # Errors
    /// [`NoPng`].
    pub fn encode(&self, film: &Film, notes: &Notes) -> Result<(Vec<u8>, OutOfGamut), NoPng> {
        let (samples, out_of_gamut) = self.samples(film);
        let mut bytes = Vec::new();
        // The longest side of a film fits.
        let mut encoder = Encoder::new(&mut bytes, film.width() as u32, film.height() as u32);
        encoder.set_color(ColorType::Rgb);
        encoder.set_depth(match self.depth {
            Depth::Eight => BitDepth::Eight,
            Depth::Sixteen => BitDepth::Sixteen,
        });
        encoder.set_source_srgb(SrgbRenderingIntent::RelativeColorimetric);
        for (name, text) in notes {
            if !(1..=79).contains(&name.len()) || !name.bytes().all(|byte| byte.is_ascii_graphic()) {
                return Err(NoPng::Note(name.clone()));
            }
            encoder.add_itxt_chunk(name.clone(), text.clone())?;
        }
        let mut writer = encoder.write_header()?;
        writer.write_image_data(&samples)?;
        writer.finish()?;
        Ok((bytes, out_of_gamut))
    }

    /// Red, green and blue of each pixel, the higher byte first.
    fn samples(&self, film: &Film) -> (Vec<u8>, OutOfGamut) {
        let count = film.width() * film.height();
        let mut out_of_gamut = OutOfGamut::new(self.gamut, count);
        let mut samples = Vec::with_capacity(if self.depth == Depth::Eight { 3 } else { 6 } * count);
        for row in 0..film.height() {
            let [x, y, z] = [0, 1, 2].map(|plane| film.row(row, plane));
            for ((x, y), z) in x.iter().zip(y).zip(z) {
                let linear = self.display.linear([*x, *y, *z].map(f64::from));
                for value in out_of_gamut.brought_in(linear, &self.display).map(encoded) {
                    match self.depth {
                        Depth::Eight => samples.push((255.0 * value).round() as u8),
                        Depth::Sixteen => samples.extend(((65_535.0 * value).round() as u16).to_be_bytes()),
                    }
                }
            }
        }
        (samples, out_of_gamut)
    }
}
