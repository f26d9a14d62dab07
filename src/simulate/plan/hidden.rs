//! Places that a body hides from a light, all of them.

use super::super::shape::{Plane, Rectangle, Shape};
use super::super::source::{Place, Source};
use super::super::vector::{Vector, along, cross, dot, length, minus, scaled, unit};
use super::cone::angle;

/// True where a body hides a light from every place of a ball; false also where that is not known.
pub(super) fn hides(shape: &Shape, centre: Vector, radius: f64, source: &Source) -> bool {
    match shape {
        Shape::Sphere(ball) => ball_hides(ball.centre, ball.radius, centre, radius, source),
        Shape::Box(cuboid) => {
            let within = cuboid.half.iter().copied().fold(f64::INFINITY, f64::min);
            ball_hides(cuboid.centre, within, centre, radius, source)
                || (0..3).any(|k| {
                    let (a, b) = ((k + 1) % 3, (k + 2) % 3);
                    let half = [cuboid.half[a], cuboid.half[b]];
                    let ends = Rectangle { axes: [cuboid.axes[a], cuboid.axes[b]], half };
                    rectangle_hides(cuboid.centre, cuboid.axes[k], &ends, centre, radius, source)
                })
        }
        Shape::Plane(Plane { point, normal, rectangle: Some(ends) }) => {
            rectangle_hides(*point, *normal, ends, centre, radius, source)
        }
        _ => false,
    }
}

/// The same of a ball.
fn ball_hides(at: Vector, wide: f64, centre: Vector, radius: f64, source: &Source) -> bool {
    let way = minus(at, centre);
    if length(way) <= wide + radius {
        return false;
    }
    match source.place {
        Place::Directional(towards) => {
            let ahead = dot(way, towards);
            ahead > 0.0 && length(along(way, towards, -ahead)) + radius < wide
        }
        Place::Point(place, _) => {
            let (to, from) = (minus(centre, place), minus(at, place));
            let (far, near) = (length(to), length(from));
            // The light outside the ball, and the ball wholly beyond it within the cone of the shadow.
            near > wide
                && far > near + radius
                && far > radius
                && angle(scaled(to, 1.0 / far), scaled(from, 1.0 / near)) + (radius / far).asin() < (wide / near).asin()
        }
        Place::Surround => false,
    }
}

/// The same of a rectangle.
fn rectangle_hides(
    point: Vector,
    normal: Vector,
    ends: &Rectangle,
    centre: Vector,
    radius: f64,
    source: &Source,
) -> bool {
    let height = dot(minus(centre, point), normal);
    if height.abs() <= radius {
        return false;
    }
    match source.place {
        Place::Directional(towards) => {
            let slope = dot(towards, normal);
            if slope * height >= 0.0 {
                return false;
            }
            // Where the lines from the ball towards the light go through the plane.
            let place = minus(along(centre, towards, -height / slope), point);
            (0..2).all(|k| {
                let wide = radius * 1.0_f64.hypot(dot(towards, ends.axes[k]) / slope);
                dot(place, ends.axes[k]).abs() + wide < ends.half[k]
            })
        }
        Place::Point(place, _) => {
            let above = dot(minus(place, point), normal);
            if above * height >= 0.0 {
                return false;
            }
            // The shadow of each edge is a plane through the light.
            let from = minus(centre, place);
            (0..2).all(|k| {
                [1.0, -1.0].into_iter().all(|sign| {
                    let edge = along(point, ends.axes[k], sign * ends.half[k]);
                    let outward = unit(cross(minus(edge, place), ends.axes[1 - k]));
                    outward.is_some_and(|outward| {
                        let inside = dot(minus(point, place), outward);
                        let outward = if inside > 0.0 { scaled(outward, -1.0) } else { outward };
                        dot(from, outward) + radius < 0.0
                    })
                })
            })
        }
        Place::Surround => false,
    }
}
