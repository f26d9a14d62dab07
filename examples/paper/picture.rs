//! Figures for the page, at half the size that `bbrf report` draws them in.

use std::error::Error;
use std::fs;
use std::io::BufWriter;
use std::path::{Path, PathBuf};

/// The figures in a folder whose file names end so, by name.
///
/// # Errors
/// When the folder cannot be read.
pub(crate) fn all(folder: &Path, ending: &str) -> Result<Vec<PathBuf>, Box<dyn Error>> {
    let mut paths: Vec<PathBuf> = Vec::new();
    for entry in fs::read_dir(folder).map_err(|error| format!("{}: {error}", folder.display()))? {
        paths.push(entry?.path());
    }
    paths.retain(|path| path.to_string_lossy().ends_with(ending));
    paths.sort();
    Ok(paths)
}

/// The first of them.
///
/// # Errors
/// When there is none.
pub(crate) fn find(folder: &Path, ending: &str) -> Result<PathBuf, Box<dyn Error>> {
    let first = all(folder, ending)?.into_iter().next();
    first.ok_or_else(|| format!("{}: no figure *{ending}", folder.display()).into())
}

/// Writes a PNG of eight bits a channel again, each two by two pixels as their mean.
///
/// # Errors
/// When it cannot be read or written, or has other than eight bits.
pub(crate) fn halve(from: &Path, to: &Path) -> Result<(), Box<dyn Error>> {
    let mut reader = png::Decoder::new(std::io::BufReader::new(fs::File::open(from)?)).read_info()?;
    let mut pixels = vec![0; reader.output_buffer_size().ok_or("too large a figure")?];
    let info = reader.next_frame(&mut pixels)?;
    if info.bit_depth != png::BitDepth::Eight {
        return Err(format!("{}: expected eight bits a channel", from.display()).into());
    }
    let channels = info.color_type.samples();
    let (width, height) = (info.width as usize / 2, info.height as usize / 2);
    let at = |x: usize, y: usize, channel: usize| u16::from(pixels[y * info.line_size + x * channels + channel]);
    let mut half = Vec::with_capacity(width * height * channels);
    for (y, x) in (0..height).flat_map(|y| (0..width).map(move |x| (2 * y, 2 * x))) {
        for channel in 0..channels {
            let sum = at(x, y, channel) + at(x + 1, y, channel) + at(x, y + 1, channel) + at(x + 1, y + 1, channel);
            half.push(((sum + 2) / 4) as u8);
        }
    }
    let mut encoder = png::Encoder::new(BufWriter::new(fs::File::create(to)?), width as u32, height as u32);
    encoder.set_color(info.color_type);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_compression(png::Compression::High);
    encoder.write_header()?.write_image_data(&half)?;
    Ok(())
}
