//! A sphere of radius 1 as a film sees it from afar: which pixels it covers, and the normal at each.
//!
//! x points to the right, y up and z to the camera. Normals are made as they are needed: reading them from memory would take
//! longer.

use std::ops::Range;

use crate::simulate::shape::GRAZING;
use crate::simulate::vector::Vector;

/// The sphere on a film, seen along parallel lines (orthographically).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sphere {
    /// Centre, in pixels from the left edge and from the upper edge.
    centre: [f64; 2],
    /// Radius, pixels.
    radius: f64,
    inverse: f64,
    /// Square of the depth, pixels, from which on a pixel is on the sphere.
    least: f64,
}

/// Numbers that are no place on a film.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error(
    "a sphere of radius {radius} pixels around ({}, {}); expected a radius from 0.001 to 1e6 and a centre within 1e6 pixels",
    centre[0],
    centre[1]
)]
pub struct NoSphere {
    /// Centre, pixels.
    pub centre: [f64; 2],
    /// Radius, pixels.
    pub radius: f64,
}

impl Sphere {
    /// A sphere by its centre (pixels from the left and the upper edge; the middle of the first pixel is at 0.5, 0.5) and its
    /// radius in pixels. It may reach beyond the film.
    ///
    /// # Errors
    /// [`NoSphere`] for numbers that no film has a place for.
    pub fn new(centre: [f64; 2], radius: f64) -> Result<Self, NoSphere> {
        let near = centre.iter().all(|value| value.abs() <= 1e6);
        if !near || !(1e-3..=1e6).contains(&radius) {
            return Err(NoSphere { centre, radius });
        }
        Ok(Self { centre, radius, inverse: 1.0 / radius, least: GRAZING * radius * radius })
    }

    /// The largest sphere on a film.
    ///
    /// # Errors
    /// [`NoSphere`] for a film without pixels.
    pub fn filling(width: usize, height: usize) -> Result<Self, NoSphere> {
        Self::new([width as f64 / 2.0, height as f64 / 2.0], width.min(height) as f64 / 2.0)
    }

    /// Pixels.
    pub(super) fn radius(&self) -> f64 {
        self.radius
    }

    /// The columns whose middles are not farther to the left or right of the centre than so many pixels.
    pub(super) fn columns_between(&self, left: f64, right: f64) -> Range<usize> {
        // A negative number becomes 0.
        let first = (self.centre[0] + left - 0.5).ceil() as usize;
        let last = (self.centre[0] + right + 0.5).floor() as usize;
        first..last.max(first)
    }

    /// How far a row lies above the centre, pixels.
    #[inline(always)]
    pub(super) fn up(&self, row: usize) -> f64 {
        self.centre[1] - (row as f64 + 0.5)
    }

    /// How far the middle of a column lies to the right of the centre, pixels; `middle` is the number of the column and a half.
    #[inline(always)]
    pub(super) fn right(&self, middle: f64) -> f64 {
        middle - self.centre[0]
    }

    /// The normal at a pixel whose middle is so far from the centre. Where z is 0 the pixel is not on the sphere: one that is
    /// seen at exactly 90 degrees has no extent on the film. The differences of squares are those of pixels, which for a sphere
    /// placed on whole and half pixels are exact up to the edge.
    #[inline(always)]
    pub(super) fn normal(&self, right: f64, up: f64) -> Vector {
        let depth = (self.radius * self.radius - up * up) - right * right;
        // As a choice, which is one instruction; `max` looks for NaN, too.
        let depth = if depth > self.least { depth } else { 0.0 };
        self.normal_with(right, up, depth.sqrt() * self.inverse)
    }

    /// The normal where its z is known: a root is dear.
    #[inline(always)]
    pub(super) fn normal_with(&self, right: f64, up: f64, z: f64) -> Vector {
        [right * self.inverse, up * self.inverse, z]
    }

    /// Columns of a row outside which the sphere is not; one more at each end than it needs, for the rounding of the root.
    pub(super) fn columns(&self, row: usize, width: usize) -> Range<usize> {
        let up = self.up(row);
        let square = self.radius * self.radius - up * up;
        if square.is_nan() || square <= 0.0 {
            return 0..0;
        }
        let half = square.sqrt();
        // A negative number becomes 0.
        let first = (self.centre[0] - half - 1.5).floor() as usize;
        let last = (self.centre[0] + half + 1.5).ceil() as usize;
        first.min(width)..last.min(width)
    }
}
