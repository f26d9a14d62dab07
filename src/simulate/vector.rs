//! Three numbers, x to the right, y up, z to the camera. The order of the sums is fixed here, so that every path to an image
//! has the same side of the horizon at the same pixel.

/// A direction or a place.
pub(in crate::simulate) type Vector = [f64; 3];

#[inline(always)]
pub(in crate::simulate) fn dot(a: Vector, b: Vector) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

#[inline(always)]
pub(in crate::simulate) fn minus(a: Vector, b: Vector) -> Vector {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

#[inline(always)]
pub(in crate::simulate) fn scaled(a: Vector, factor: f64) -> Vector {
    [a[0] * factor, a[1] * factor, a[2] * factor]
}

pub(in crate::simulate) fn cross(a: Vector, b: Vector) -> Vector {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

pub(in crate::simulate) fn length(a: Vector) -> f64 {
    a[0].hypot(a[1]).hypot(a[2])
}
