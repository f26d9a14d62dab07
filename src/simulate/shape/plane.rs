//! A plane, or a rectangle of it.

use super::{Meeting, Ray};
use crate::simulate::vector::{Vector, along, dot, minus};

/// A plane.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Plane {
    /// A place on it: the middle of a rectangle.
    pub point: Vector,
    /// Of length 1.
    pub normal: Vector,
    /// Its ends; `None` for a plane without.
    pub rectangle: Option<Rectangle>,
}

/// The ends of a rectangle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rectangle {
    /// Directions of its sides, of length 1 and across each other.
    pub axes: [Vector; 2],
    /// Half its length along each.
    pub half: [f64; 2],
}

impl Plane {
    #[inline]
    pub(in crate::simulate) fn meet(&self, ray: &Ray, limit: f64) -> Option<Meeting> {
        let slope = dot(self.normal, ray.towards);
        if slope == 0.0 {
            return None;
        }
        let distance = dot(minus(self.point, ray.from), self.normal) / slope;
        if !(distance > 0.0 && distance < limit) {
            return None;
        }
        let place = along(ray.from, ray.towards, distance);
        if let Some(ends) = &self.rectangle {
            let aside = minus(place, self.point);
            if (0..2).any(|k| dot(aside, ends.axes[k]).abs() > ends.half[k]) {
                return None;
            }
        }
        Some(Meeting { distance, place, outward: self.normal, part: 0 })
    }

    pub(super) fn around(&self) -> Option<(Vector, f64)> {
        self.rectangle.map(|ends| (self.point, ends.half[0].hypot(ends.half[1])))
    }
}
