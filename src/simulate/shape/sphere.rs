//! A sphere.

use super::{Meeting, Ray, Start};
use crate::simulate::vector::{Vector, along, dot, minus, scaled};

/// From so many radii on a sphere is met relative to its centre.
const FAR: f64 = 100.0;

/// A sphere.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ball {
    /// Centre.
    pub centre: Vector,
    /// Radius, above 0.
    pub radius: f64,
}

impl Ball {
    /// The square under the root as a difference of lengths across the ray (Haines et al. 2019, Precision improvements for ray/sphere
    /// intersection): it keeps its digits for a small sphere far away.
    #[inline]
    pub(in crate::simulate) fn meet(&self, ray: &Ray, own: Option<&Start>, limit: f64) -> Option<Meeting> {
        let to_centre = minus(self.centre, ray.from);
        let middle = dot(to_centre, ray.towards);
        if own.is_none() && middle.abs() > FAR * self.radius {
            return self.meet_from_afar(ray, to_centre, middle, limit);
        }
        let distance = if let Some(start) = own {
            let inwards = dot(start.outward, ray.towards);
            if inwards >= 0.0 {
                return None;
            }
            -2.0 * self.radius * inwards
        } else {
            let across = minus(to_centre, scaled(ray.towards, middle));
            let square = self.radius * self.radius - dot(across, across);
            if square <= super::GRAZING * self.radius * self.radius {
                return None;
            }
            let half = square.sqrt();
            let product = dot(to_centre, to_centre) - self.radius * self.radius;
            // The nearer end without cancelling: the product of both ends over the farther.
            let far = middle + if middle >= 0.0 { half } else { -half };
            let (low, high) = if middle >= 0.0 { (product / far, far) } else { (far, product / far) };
            if product > 0.0 && low > 0.0 { low } else { high }
        };
        if !(distance > 0.0 && distance < limit) {
            return None;
        }
        let place = along(ray.from, ray.towards, distance);
        let outward = scaled(minus(place, self.centre), 1.0 / self.radius);
        let length = dot(outward, outward).sqrt();
        Some(Meeting { distance, place, outward: scaled(outward, 1.0 / length), part: 0 })
    }

    /// The same from the place of the ray that is nearest to the centre, where the numbers are no larger than the sphere. Rounded once
    /// each, and a second time along the ray, that place keeps all its digits.
    fn meet_from_afar(&self, ray: &Ray, to_centre: Vector, middle: f64, limit: f64) -> Option<Meeting> {
        let less = |way: Vector, by: f64| [0, 1, 2].map(|k| (-by).mul_add(ray.towards[k], way[k]));
        let across = less(to_centre, middle);
        let across = less(across, dot(across, ray.towards));
        let square = self.radius * self.radius - dot(across, across);
        let half = square.max(0.0).sqrt();
        let distance = middle - half;
        if square <= super::GRAZING * self.radius * self.radius || !(distance > 0.0 && distance < limit) {
            return None;
        }
        let outward = scaled(along(across, ray.towards, half), -1.0 / self.radius);
        let outward = scaled(outward, 1.0 / dot(outward, outward).sqrt());
        Some(Meeting { distance, place: along(self.centre, outward, self.radius), outward, part: 0 })
    }
}
