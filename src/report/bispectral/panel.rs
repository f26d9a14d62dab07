//! Curves beside a map or above each other: numbers over wavelengths, in a band of their uncertainty, along either axis.

use kuva::render::color::Color;

use super::margins::Margin;
use crate::report::canvas::{Canvas, clipped};
use crate::report::frame::Frame;
use crate::report::scale::{Scale, extent};

/// Radius of a single value between two gaps.
const SINGLE: f64 = 2.6;
/// A band may reach this share of the range of the numbers beyond them.
const BAND_SHARE: f64 = 0.3;

/// Which way wavelengths run.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Along {
    /// To the right.
    Across,
    /// Upwards.
    Up,
}

/// A scale from zero or below it that holds all numbers and, as far as they do not dwarf them, their bands. `None` without a number.
pub(super) fn scale_of(margins: &[&Margin]) -> Option<Scale> {
    let (low, high) = extent(margins.iter().flat_map(|margin| margin.values.iter().copied()))?;
    let (low, high) = (low.min(0.0), high.max(0.0));
    let room = BAND_SHARE * (high - low);
    let with_band = margins.iter().flat_map(|margin| {
        let known = margin.values.iter().zip(&margin.sigma);
        known.flat_map(|(value, sigma)| [value - sigma, value + sigma])
    });
    let (band_low, band_high) = extent(with_band).unwrap_or((low, high));
    Some(Scale::linear_over([low.min(band_low.max(low - room)), high.max(band_high.min(high + room))])?.widened(0.04))
}

/// A line in its band; where a number is missing it ends and begins anew.
pub(super) fn draw_margin(
    canvas: &mut Canvas,
    frame: &Frame,
    nm: &[f64],
    margin: &Margin,
    along: Along,
    colour: Color,
) {
    let point = |nm: f64, value: f64| match along {
        Along::Across => frame.point(nm, value),
        Along::Up => frame.point(value, nm),
    };
    let all: Vec<usize> = (0..nm.len()).collect();
    for piece in all.split(|k| !margin.values[*k].is_finite()).filter(|piece| !piece.is_empty()) {
        let edge = |sign: f64| {
            let sigma = |k: usize| if margin.sigma[k].is_finite() { margin.sigma[k] } else { 0.0 };
            piece.iter().map(move |k| (nm[*k], margin.values[*k] + sign * sigma(*k))).collect::<Vec<_>>()
        };
        let (upper, lower) = (edge(1.0), edge(-1.0));
        let outline = upper.iter().chain(lower.iter().rev()).map(|(nm, value)| {
            // A band that goes on beyond the frame ends at it.
            let (low, high) = match along {
                Along::Across => (frame.y.value(0.0), frame.y.value(1.0)),
                Along::Up => (frame.x.value(0.0), frame.x.value(1.0)),
            };
            point(*nm, value.clamp(low, high))
        });
        canvas.polygon(&clipped(outline.collect(), frame.area), colour.clone(), 0.25);
        match piece {
            [only] => canvas.dot(point(nm[*only], margin.values[*only]), SINGLE, colour.clone()),
            _ => {
                let line = piece.iter().map(|k| point(nm[*k], margin.values[*k])).collect();
                canvas.polyline(line, colour.clone(), 1.8);
            }
        }
    }
}
