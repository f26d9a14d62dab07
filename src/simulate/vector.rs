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

#[inline(always)]
pub(in crate::simulate) fn plus(a: Vector, b: Vector) -> Vector {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

/// a + factor * b.
#[inline(always)]
pub(in crate::simulate) fn along(a: Vector, b: Vector, factor: f64) -> Vector {
    [a[0] + factor * b[0], a[1] + factor * b[1], a[2] + factor * b[2]]
}

/// The vector of length 1; `None` where there is no direction.
pub(in crate::simulate) fn unit(a: Vector) -> Option<Vector> {
    let length = length(a);
    (length > 0.0 && length.is_finite()).then(|| scaled(a, 1.0 / length))
}

/// Two directions across a unit vector and across each other (Duff et al. 2017, Building an orthonormal basis, revisited).
pub(in crate::simulate) fn across(n: Vector) -> [Vector; 2] {
    let sign = 1.0_f64.copysign(n[2]);
    let a = -1.0 / (sign + n[2]);
    let b = n[0] * n[1] * a;
    [[1.0 + sign * n[0] * n[0] * a, sign * b, -sign * n[0]], [b, sign + n[1] * n[1] * a, -n[1]]]
}
