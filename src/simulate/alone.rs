//! A sphere alone under one light without extent, seen along parallel lines: drawn by [`super::convex`], many pixels at once.

use super::camera::Projection;
use super::choice::Choice;
use super::convex::{Colours, Component, Lighting, Renderer, Scene as OneBody, Sphere};
use super::effect::Effect;
use super::film::Film;
use super::picture::{LARGEST, Layer};
use super::scene::Scene;
use super::shape::{Ball, Shape};
use super::source::Place;
use super::trace::BRIGHTEST;
use super::transport::{Act, FILM, Ways};
use super::vector::{Vector, dot, length, minus};
use crate::terms::{Denominator, Distribution, TorranceSparrow};

/// The interface of a body without one: its colour is 0.
const NONE: TorranceSparrow = TorranceSparrow {
    intensity: 1.0,
    roughness: 0.1,
    refractive_index: 1.5,
    distribution: Distribution::GaussianHalfHeight,
    denominator: Denominator::CosThetaI,
};

/// Where the sphere and its light are, as the camera sees them, and the strength of the light at one radius.
struct Alone {
    sphere: Sphere,
    lighting: Lighting,
    strength: f64,
}

/// True where the scene is drawn so.
pub(super) fn is_alone(scene: &Scene, choice: &Choice) -> bool {
    !choice.by_pixel && Alone::of(scene).is_some()
}

impl Alone {
    fn of(scene: &Scene) -> Option<Self> {
        let ([body], [source]) = (scene.bodies.as_slice(), scene.sources.as_slice()) else { return None };
        let (Shape::Sphere(Ball { centre, radius }), Projection::Orthographic { width }) =
            (&body.shape, scene.camera.projection)
        else {
            return None;
        };
        let [right, up, forward] = scene.camera.axes;
        let seen = |way: Vector| [dot(way, right), dot(way, up), -dot(way, forward)];
        let middle = seen(minus(*centre, scene.camera.place));
        if middle[2] + radius >= 0.0 {
            return None;
        }
        let pixels = scene.size.0 as f64 / width;
        let corner = [scene.size.0 as f64 / 2.0, scene.size.1 as f64 / 2.0];
        let at = [corner[0] + middle[0] * pixels, corner[1] - middle[1] * pixels];
        let sphere = Sphere::new(at, radius * pixels).ok()?;
        let (lighting, strength) = match source.place {
            Place::Directional(towards) => (Lighting::Directional(seen(towards)), 1.0),
            Place::Point(place, reference) => {
                let way = minus(place, *centre).map(|x| x / radius);
                // Next to the surface, and within it, the strength is that of places and not of pixels.
                (length(way) > 1.001)
                    .then(|| (Lighting::Point(seen(way)), (reference / radius).powi(2).min(BRIGHTEST)))?
            }
            Place::Surround => return None,
        };
        Some(Self { sphere, lighting, strength })
    }
}

/// The planes of layers, each of X, Y and Z; `None` where the scene is not drawn so.
pub(super) fn draw(
    scene: &Scene,
    choice: &Choice,
    ways: &mut Ways<'_>,
    layers: &[Layer],
) -> Option<Vec<Vec<Vec<f32>>>> {
    if choice.by_pixel {
        return None;
    }
    let Alone { sphere, lighting, strength } = Alone::of(scene)?;
    let material = scene.bodies[0].material;
    let term = scene.materials[material].specular.filter(|_| choice.has(Effect::Specular));
    let mut colour = |act: Act, is_drawn: bool| {
        let way = ways.further(FILM, act, material);
        let lit = ways.lit(way, 0);
        [0, 1, 2].map(|c| if is_drawn { strength * lit[c] } else { 0.0 })
    };
    let colours = Colours {
        luminescent: colour(Act::Luminescent, choice.has(Effect::Luminescence)),
        diffuse: colour(Act::Diffuse, choice.has(Effect::Diffuse)),
        specular: colour(Act::Specular, term.is_some()),
    };
    // The intensity is in the colour.
    let specular = TorranceSparrow { intensity: 1.0, ..term.unwrap_or(NONE) };
    let body = OneBody::new(sphere, lighting, colours, specular).ok()?;
    let renderer = Renderer::default();
    if !renderer.covers(&body) {
        return None;
    }
    let (width, height) = scene.size;
    let mut film = Film::new(width, height).ok()?;
    let mut all = Vec::with_capacity(layers.len());
    for layer in layers {
        let component = match layer {
            Layer::Total => Some(Component::Total),
            Layer::Luminescent => Some(Component::Luminescent),
            Layer::Diffuse => Some(Component::Diffuse),
            Layer::Specular => Some(Component::Specular),
            // A convex body does not see itself.
            Layer::Interreflection => None,
        };
        if let Some(component) = component {
            renderer.render(&body, component, &mut film).ok()?;
        }
        let plane = |c: usize| {
            if component.is_none() {
                return vec![0.0; width * height];
            }
            let mut plane = Vec::with_capacity(width * height);
            (0..height)
                .for_each(|row| plane.extend(film.row(row, c).iter().map(|value| value.clamp(-LARGEST, LARGEST))));
            plane
        };
        all.push((0..3).map(plane).collect());
    }
    Some(all)
}
