//! A box.

use super::{Meeting, Ray, Start};
use crate::simulate::vector::{Vector, along, dot, minus, scaled};

/// A box with sides along three directions.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cuboid {
    /// Centre.
    pub centre: Vector,
    /// Directions of its sides, of length 1 and across each other.
    pub axes: [Vector; 3],
    /// Half its length along each.
    pub half: [f64; 3],
}

impl Cuboid {
    #[inline]
    pub(in crate::simulate) fn meet(&self, ray: &Ray, own: Option<&Start>, limit: f64) -> Option<Meeting> {
        if own.is_some_and(|start| dot(start.outward, ray.towards) >= 0.0) {
            return None;
        }
        let from = minus(ray.from, self.centre);
        let (mut enter, mut leave) = ((f64::NEG_INFINITY, 0), (f64::INFINITY, 0));
        for k in 0..3 {
            let (place, speed) = (dot(from, self.axes[k]), dot(ray.towards, self.axes[k]));
            if speed == 0.0 {
                if place.abs() > self.half[k] {
                    return None;
                }
                continue;
            }
            let side = self.half[k].copysign(speed);
            let (first, last) = ((-side - place) / speed, (side - place) / speed);
            if first > enter.0 {
                enter = (first, k);
            }
            if last < leave.0 {
                leave = (last, k);
            }
        }
        if enter.0 > leave.0 {
            return None;
        }
        let goes_in = own.is_none() && enter.0 > 0.0;
        let ((distance, k), sign) = if goes_in { (enter, -1.0) } else { (leave, 1.0) };
        if !(distance > 0.0 && distance < limit) {
            return None;
        }
        let outward = scaled(self.axes[k], sign * 1.0_f64.copysign(dot(ray.towards, self.axes[k])));
        let place = along(ray.from, ray.towards, distance);
        Some(Meeting { distance, place, outward, part: 2 * k + usize::from(goes_in) })
    }

    pub(super) fn holds(&self, place: Vector) -> bool {
        let from = minus(place, self.centre);
        (0..3).all(|k| dot(from, self.axes[k]).abs() <= self.half[k])
    }
}
