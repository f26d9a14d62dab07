//! The same image by the terms themselves, pixel by pixel in double precision: what the inner loop has to equal, and what draws
//! the scenes that it does not cover.

use super::lighting::Rays;
use super::scene::{Colours, Scene};
use crate::quantity::{Direction, Geometry, Reference};
use crate::simulate::vector::{Vector, cross, dot, length};
use crate::terms::{Term, Undefined};

/// Writes a row of three planes.
pub(super) fn fill<R: Rays>(
    scene: &Scene,
    rays: &R,
    colours: &Colours,
    row: usize,
    out: &mut [f32],
) -> Result<(), Undefined> {
    out.fill(0.0);
    let width = out.len() / 3;
    for column in scene.sphere.columns(row, width) {
        let normal = scene.sphere.normal(scene.sphere.right(column as f64 + 0.5), scene.sphere.up(row));
        if normal[2] <= 0.0 {
            continue;
        }
        for (c, value) in pixel(scene, rays, colours, normal)?.into_iter().enumerate() {
            out[c * width + column] = value as f32;
        }
    }
    Ok(())
}

fn pixel<R: Rays>(scene: &Scene, rays: &R, colours: &Colours, normal: Vector) -> Result<[f64; 3], Undefined> {
    let Some(shares) = shares(scene, rays, normal)? else { return Ok([0.0; 3]) };
    Ok([0, 1, 2].map(|c| shares.diffuse * colours.base()[c] + shares.specular * colours.specular[c]))
}

/// What the terms are multiplied by at a point of the surface.
#[derive(Debug, Clone, Copy)]
pub(super) struct Shares {
    /// cos(theta_i) times the strength of the light.
    pub(super) diffuse: f64,
    /// c_s D G F / den, too.
    pub(super) specular: f64,
}

/// `None` where no light falls.
pub(super) fn shares<R: Rays>(scene: &Scene, rays: &R, normal: Vector) -> Result<Option<Shares>, Undefined> {
    let beam = rays.beam(normal);
    // Angles in degrees would round a point just below the horizon onto it.
    if dot(normal, beam.towards) < 0.0 {
        return Ok(None);
    }
    let Some(geometry) = geometry(normal, beam.towards) else { return Ok(None) };
    let at = |term: Term| term.evaluate(&geometry, &Reference::None).map(|found| found.value * beam.strength);
    let diffuse = at(Term::Lambertian { albedo: 1.0 })?;
    let specular = if scene.specular.intensity == 0.0 { 0.0 } else { at(Term::TorranceSparrow(scene.specular))? };
    Ok(Some(Shares { diffuse, specular }))
}

/// The geometry in the surface's own frame, with viewing at azimuth 0.
fn geometry(normal: Vector, towards: Vector) -> Option<Geometry> {
    let camera = [0.0, 0.0, 1.0];
    let (from_light, from_camera) = (cross(normal, towards), cross(normal, camera));
    let theta = |across: Vector, along: f64| length(across).atan2(along).to_degrees();
    let azimuth = dot(normal, cross(camera, towards)).atan2(dot(from_light, from_camera)).to_degrees();
    let azimuth = if azimuth < 0.0 { azimuth + 360.0 } else { azimuth } % 360.0;
    let incidence = Direction::from_degrees(theta(from_light, dot(normal, towards)), azimuth).ok()?;
    let viewing = Direction::from_degrees(theta(from_camera, normal[2]), 0.0).ok()?;
    Some(Geometry { incidence, viewing })
}
