//! The bodies, as a scene describes them.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::description::{one, up};
use super::place::{NotAScene, Step};
use super::resolve::Resolver;
use crate::simulate::shape::{Ball, Cuboid, Mesh, Plane, Rectangle, Shape};
use crate::simulate::vector::{Vector, along, cross, unit};

/// A body: one of `sphere`, `plane`, `box` and `mesh`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(extend("oneOf" = [{"required": ["sphere"]}, {"required": ["plane"]}, {"required": ["box"]}, {"required": ["mesh"]}]))]
pub struct ObjectSection {
    /// What reports call it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub name: Option<String>,
    /// The name of its material.
    pub material: String,
    /// A sphere.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub sphere: Option<SphereSection>,
    /// A plane without end, or a rectangle.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub plane: Option<PlaneSection>,
    /// A box.
    #[serde(default, rename = "box", skip_serializing_if = "Option::is_none")]
    pub cuboid: Option<BoxSection>,
    /// Triangles of a file.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub mesh: Option<MeshSection>,
}

/// A sphere.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SphereSection {
    /// Centre.
    pub centre: [f64; 3],
    /// Radius, above 0.
    pub radius: f64,
}

/// A plane; a rectangle where it has a size.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PlaneSection {
    /// A place on it: the middle of a rectangle.
    pub point: [f64; 3],
    /// Its normal, of any length.
    pub normal: [f64; 3],
    /// Width and height of a rectangle.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub size: Option<[f64; 2]>,
    /// Where the height of a rectangle goes; y where it is not given.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub up: Option<[f64; 3]>,
}

/// A box.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct BoxSection {
    /// Centre.
    pub centre: [f64; 3],
    /// Lengths along x, y and z, above 0.
    pub size: [f64; 3],
    /// Degrees that it is turned about x, then about y, then about z, axes that stay where they are; by the right hand.
    #[serde(default)]
    pub rotate_deg: [f64; 3],
}

/// Triangles.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MeshSection {
    /// A Wavefront OBJ file; its faces are cut into triangles, its materials and normals are passed over.
    pub file: String,
    /// What its corners are multiplied with, above 0.
    #[serde(default = "one")]
    pub scale: f64,
    /// What is added then.
    #[serde(default, rename = "move")]
    pub shift: [f64; 3],
}

impl ObjectSection {
    pub(super) fn resolve(self, at: Step<'_>, with: &mut Resolver<'_, '_>) -> Result<Shape, NotAScene> {
        let way = [Step::Key("object"), at];
        let given = [self.sphere.is_some(), self.plane.is_some(), self.cuboid.is_some(), self.mesh.is_some()];
        with.one_of(&way, given, "`sphere`, `plane`, `box` and `mesh`")?;
        let inner = |key: &'static str| [way[0], at, Step::Key(key)];
        if let Some(SphereSection { centre, radius }) = self.sphere {
            let radius = with.above_0(&inner("sphere"), "radius", radius)?;
            return Ok(Shape::Sphere(Ball { centre, radius }));
        }
        if let Some(plane) = self.plane {
            return Ok(Shape::Plane(plane.resolve(&inner("plane"), with)?));
        }
        if let Some(BoxSection { centre, size, rotate_deg }) = self.cuboid {
            for side in size {
                with.above_0(&inner("box"), "size", side)?;
            }
            let axes = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(|axis| turned(axis, rotate_deg));
            return Ok(Shape::Box(Cuboid { centre, axes, half: size.map(|side| side / 2.0) }));
        }
        let Some(mesh) = self.mesh else { return Err(with.error(&way, "mesh", "expected a body")) };
        let way = inner("mesh");
        let scale = with.above_0(&way, "scale", mesh.scale)?;
        let corners = with.library.mesh(&mesh.file).map_err(|why| with.error(&way, "file", why))?;
        let corners = with.said(&mesh.file, corners);
        let places: Vec<Vector> = corners.places.iter().map(|place| along(mesh.shift, *place, scale)).collect();
        let made = Mesh::new(&places, &corners.triangles);
        made.map(Shape::Mesh).map_err(|why| with.error(&way, "file", format!("{}: {why}", mesh.file)))
    }
}

impl PlaneSection {
    fn resolve(self, way: &[Step<'_>], with: &mut Resolver<'_, '_>) -> Result<Plane, NotAScene> {
        let normal = with.direction(way, "normal", self.normal)?;
        let Some(size) = self.size else {
            return match self.up {
                Some(_) => Err(with.error(way, "up", "found without `size`; expected it for a rectangle only")),
                None => Ok(Plane { point: self.point, normal, rectangle: None }),
            };
        };
        for side in size {
            with.above_0(way, "size", side)?;
        }
        let upwards = with.direction(way, "up", self.up.unwrap_or(up()))?;
        // Of nearly parallel directions only rounding is across.
        let across =
            Some(cross(upwards, normal)).filter(|across| across.iter().any(|part| part.abs() > 1e-9)).and_then(unit);
        let key = if self.up.is_some() { "up" } else { "normal" };
        let across = across.ok_or_else(|| {
            with.error(
                way,
                key,
                "found `normal` and `up` (y where it is not given) in one direction; expected two directions",
            )
        })?;
        let rectangle = Rectangle { axes: [across, cross(normal, across)], half: size.map(|side| side / 2.0) };
        Ok(Plane { point: self.point, normal, rectangle: Some(rectangle) })
    }
}

/// A vector turned about x, then y, then z.
fn turned(vector: Vector, degrees: [f64; 3]) -> Vector {
    let mut turned = vector;
    for (axis, degrees) in degrees.into_iter().enumerate() {
        let (sine, cosine) = exact_sine_and_cosine(degrees);
        let (a, b) = ((axis + 1) % 3, (axis + 2) % 3);
        (turned[a], turned[b]) = (cosine * turned[a] - sine * turned[b], sine * turned[a] + cosine * turned[b]);
    }
    turned
}

/// Whole quarters of a turn without rounding.
fn exact_sine_and_cosine(degrees: f64) -> (f64, f64) {
    match degrees.rem_euclid(360.0) {
        0.0 => (0.0, 1.0),
        90.0 => (1.0, 0.0),
        180.0 => (0.0, -1.0),
        270.0 => (-1.0, 0.0),
        other => other.to_radians().sin_cos(),
    }
}
