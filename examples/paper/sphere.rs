//! What `bbrf render` said of the sphere.

use std::error::Error;
use std::fs;
use std::path::Path;

use bbrf::simulate::document::SceneDocument;
use serde_json::Value;

/// The sphere in numbers.
pub(crate) struct Sphere {
    /// Luminescence in the Y of the whole image.
    pub(crate) luminescent_share: f64,
    /// The interface in it.
    pub(crate) specular_share: f64,
    /// Y where the specular layer is brightest; white is 1.
    pub(crate) highlight: f64,
    /// Column and row of that pixel.
    pub(crate) pixel: (f64, f64),
    /// The pixel in which the normal halves the way from the light to the eye.
    pub(crate) mirror: (f64, f64),
    /// Distance of the highlight's x and y from the light's.
    pub(crate) from_light: f64,
    /// Pixels of the luminescent layer, of those on the sphere, that are no colours of sRGB.
    pub(crate) outside: f64,
}

impl Sphere {
    /// Reads `render.json` and the scene.
    ///
    /// # Errors
    /// When one of them is not as it should be.
    pub(crate) fn read(record: &Path, scene: &Path) -> Result<Self, Box<dyn Error>> {
        let record: Value = serde_json::from_str(&fs::read_to_string(record)?)?;
        let scene: SceneDocument = toml::from_str(&fs::read_to_string(scene)?)?;
        let layers = record["layers"].as_array().ok_or("no layers")?;
        let layer = |name: &str| layers.iter().find(|layer| layer["layer"] == name).ok_or(format!("no layer {name}"));
        let number = |value: &Value| value.as_f64().ok_or("no number");
        let mean = |name: &str| Ok::<f64, Box<dyn Error>>(number(&layer(name)?["mean"][1])?);
        let at = &layer("specular")?["brightest"];
        let xy = |xyz: &Value| -> Result<[f64; 2], &str> {
            let (x, y, z) = (number(&xyz[0])?, number(&xyz[1])?, number(&xyz[2])?);
            Ok([x / (x + y + z), y / (x + y + z)])
        };
        let (highlight, light) = (xy(&at["xyz"])?, xy(&record["white"])?);
        let pixels = |one: &Value| number(&one["out_of_gamut"]["pixels"]);
        Ok(Self {
            luminescent_share: mean("luminescent")? / mean("total")?,
            specular_share: mean("specular")? / mean("total")?,
            highlight: number(&at["xyz"][1])?,
            pixel: (number(&at["column"])?, number(&at["row"])?),
            mirror: mirror(&scene).ok_or("no parallel light, or no camera along parallel lines")?,
            from_light: (highlight[0] - light[0]).hypot(highlight[1] - light[1]),
            outside: pixels(layer("luminescent")?)? / on_the_sphere(&scene).ok_or("no sphere")?,
        })
    }
}

/// The scene is seen along -z, with y up: the pixel where the half vector is the normal.
fn mirror(scene: &SceneDocument) -> Option<(f64, f64)> {
    let [x, y, z] = scene.lights.first()?.towards?;
    let length = x.hypot(y).hypot(z);
    let half = [x / length, y / length, z / length + 1.0];
    let size = half[0].hypot(half[1]).hypot(half[2]);
    let pixels = scene.film.width as f64 / scene.camera.width?;
    let at = |middle: usize, part: f64| (middle as f64 / 2.0 + pixels * part / size - 0.5).round();
    Some((at(scene.film.width, half[0]), at(scene.film.height, -half[1])))
}

fn on_the_sphere(scene: &SceneDocument) -> Option<f64> {
    let radius = scene.objects.first()?.sphere?.radius * scene.film.width as f64 / scene.camera.width?;
    Some(std::f64::consts::PI * radius * radius)
}
