//! From a description to the scene that is drawn.

use std::collections::HashSet;

use super::description::{CameraSection, FilmSection, SceneDocument, View};
use super::place::{NotAScene, Places, Step};
use crate::donaldson::Light;
use crate::simulate::camera::{Camera, NoCamera, Projection};
use crate::simulate::film::LONGEST_SIDE;
use crate::simulate::grid::Grid;
use crate::simulate::material::Material;
use crate::simulate::picture::{Kept, NoPicture};
use crate::simulate::scene::{Body, MOST, NotDrawn, Scene};
use crate::simulate::vector::{Vector, unit};
use crate::simulate::white::WhiteOf;

/// Most pixels of an image.
const MOST_PIXELS: usize = 1 << 28;
/// Most samples of a pixel.
const MOST_SAMPLES: u32 = 1 << 20;

/// What an eye sees nearly all of its light in, nm: outside is a thousandth of Y under daylight.
const VISIBLE_NM: [f64; 2] = [400.0, 700.0];

/// Which material of which file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Source<'a> {
    /// The file as the scene names it.
    pub file: &'a str,
    /// Id of a model.
    pub model: Option<&'a str>,
    /// Id of a matrix.
    pub matrix: Option<&'a str>,
    /// True where the scene states an interface of its own: that of a model is then not asked for.
    pub has_interface: bool,
}

/// Triangles of a file: three numbers of places each.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Corners {
    /// Places.
    pub places: Vec<[f64; 3]>,
    /// Which three make a triangle.
    pub triangles: Vec<[usize; 3]>,
}

/// A value at each wavelength: (nm, value), ascending.
pub type Points = Vec<(f64, f64)>;

/// What a scene names, from wherever it is kept. Each gives what was asked for with remarks on how it was read, or a sentence on
/// why not.
pub trait Library {
    /// A material; its name is given by the scene.
    ///
    /// # Errors
    /// A sentence with the file, what was found and what was expected; so with the others.
    fn material(&mut self, source: &Source<'_>) -> Result<(Material, Vec<String>), String>;
    /// A reflectance: (nm, share), ascending.
    ///
    /// # Errors
    /// A sentence.
    fn reflectance(&mut self, file: &str) -> Result<(Points, Vec<String>), String>;
    /// A spectrum of light.
    ///
    /// # Errors
    /// A sentence.
    fn light(&mut self, name: &str) -> Result<(Light, Vec<String>), String>;
    /// Triangles.
    ///
    /// # Errors
    /// A sentence.
    fn mesh(&mut self, file: &str) -> Result<(Corners, Vec<String>), String>;
}

/// A scene, and how its image is shown.
#[derive(Debug, Clone, PartialEq)]
pub struct Resolved {
    /// The scene.
    pub scene: Scene,
    /// What the picture keeps.
    pub kept: Kept,
    /// What the PNG multiplies the light with.
    pub exposure: f64,
    /// How things were read, in words.
    pub remarks: Vec<String>,
    /// What is missing, in words.
    pub warnings: Vec<String>,
    /// Where each material stands in the description.
    materials_at: Vec<NotAScene>,
}

impl Resolved {
    /// Why there is no picture, with the place in the description that is to blame, where one is.
    #[must_use]
    pub fn blamed(&self, why: &NoPicture) -> Option<NotAScene> {
        let NoPicture::Scene(NotDrawn::Brighter { material, .. }) = why else { return None };
        let number = self.scene.materials.iter().position(|one| one.name == *material)?;
        Some(NotAScene { problem: why.to_string(), ..self.materials_at.get(number)?.clone() })
    }
}

/// On the way to a scene.
pub(super) struct Resolver<'a, 'text> {
    pub(super) library: &'a mut dyn Library,
    places: &'a Places<'text>,
    grid: Grid,
    remarks: Vec<String>,
    warnings: Vec<String>,
}

pub(super) fn resolve(
    document: SceneDocument,
    places: &Places<'_>,
    library: &mut dyn Library,
) -> Result<Resolved, NotAScene> {
    let SceneDocument { film, camera, wavelengths, observer, bounces, materials, lights, objects } = document;
    check_film(&film, places)?;
    let grid = Grid::new(wavelengths.from, wavelengths.to, wavelengths.step)
        .map_err(|why| places.error(&[Step::Key("wavelengths")], why.to_string()))?;
    let camera = look(&camera, places)?;
    for (key, count) in [("material", materials.len()), ("light", lights.len()), ("object", objects.len())] {
        if !(1..=MOST).contains(&count) {
            return Err(places.error(&[Step::Key(key)], format!("found {count}; expected 1 to {MOST}")));
        }
    }
    let mut with = Resolver { library, places, grid, remarks: Vec::new(), warnings: Vec::new() };
    let mut names = Names::new("material", places);
    for (k, material) in materials.iter().enumerate() {
        names.take(k, &material.name)?;
    }
    let all: Vec<String> = materials.iter().map(|material| material.name.clone()).collect();
    let materials = materials
        .into_iter()
        .enumerate()
        .map(|(k, material)| material.resolve(Step::Item(k), &mut with))
        .collect::<Result<Vec<Material>, NotAScene>>()?;
    let mut names = Names::new("light", places);
    let mut sources = Vec::with_capacity(lights.len());
    let spectra: Vec<String> = lights.iter().map(|light| light.spectrum.clone()).collect();
    for (k, light) in lights.into_iter().enumerate() {
        let name = light.name.clone().unwrap_or_else(|| format!("light {}", k + 1));
        names.take(k, &name)?;
        sources.push(light.resolve(Step::Item(k), name, &mut with)?);
    }
    super::lights::check_units(&sources, &spectra, places)?;
    let mut names = Names::new("object", places);
    let mut bodies = Vec::with_capacity(objects.len());
    for (k, object) in objects.into_iter().enumerate() {
        let name = object.name.clone().unwrap_or_else(|| format!("object {}", k + 1));
        names.take(k, &name)?;
        let material = all.iter().position(|name| *name == object.material).ok_or_else(|| {
            let way = [Step::Key("object"), Step::Item(k)];
            with.error(&way, "material", format!("found `{}`; expected one of: {}", object.material, all.join(", ")))
        })?;
        bodies.push(Body { name, shape: object.resolve(Step::Item(k), &mut with)?, material });
    }
    let Resolver { grid, mut remarks, mut warnings, .. } = with;
    let size = (film.width, film.height);
    let scene = Scene {
        bodies,
        materials,
        sources,
        camera,
        size,
        grid,
        observer,
        samples: film.samples,
        bounces,
        seed: film.seed,
    };
    scene.check().map_err(|why| places.error(&[Step::Key("light")], why.to_string()))?;
    if scene.white_of() == WhiteOf::Daylight {
        remarks.push(
            "the lights have no colour that an eye adapts to: white is a perfect diffuser under D65 of the same irradiance".to_owned(),
        );
    }
    let is_used = |k: &usize| scene.bodies.iter().any(|body| body.material == *k);
    let unused = (0..scene.materials.len()).filter(|k| !is_used(k));
    remarks.extend(unused.map(|k| format!("material `{}` is on no object", scene.materials[k].name)));
    let nm = scene.grid.nm();
    let (first, last) = (nm[0], nm[nm.len() - 1]);
    if first > VISIBLE_NM[0] || last < VISIBLE_NM[1] {
        warnings.push(format!(
            "the wavelengths of the scene are {first} to {last} nm: colours are of that part of the light alone; expected {} to {} \
             for what an eye sees",
            VISIBLE_NM[0], VISIBLE_NM[1]
        ));
    }
    warnings.extend(super::super::losses::of(&scene));
    let at = |k: usize| places.error(&[Step::Key("material"), Step::Item(k)], "");
    let materials_at = (0..scene.materials.len()).map(at).collect();
    Ok(Resolved { scene, kept: film.kept, exposure: film.exposure, remarks, warnings, materials_at })
}

fn check_film(film: &FilmSection, places: &Places<'_>) -> Result<(), NotAScene> {
    let wrong = |key: &str, problem: String| Err(places.error(&[Step::Key("film"), Step::Key(key)], problem));
    for (key, side) in [("width", film.width), ("height", film.height)] {
        if !(1..=LONGEST_SIDE).contains(&side) {
            return wrong(key, format!("found {side}; expected 1 to {LONGEST_SIDE} pixels"));
        }
    }
    if film.width * film.height > MOST_PIXELS {
        return wrong(
            "height",
            format!("found {} x {} pixels; expected at most {MOST_PIXELS} in all", film.width, film.height),
        );
    }
    if !(1..=MOST_SAMPLES).contains(&film.samples) {
        return wrong("samples", format!("found {}; expected 1 to {MOST_SAMPLES}", film.samples));
    }
    if film.exposure <= 0.0 {
        return wrong("exposure", format!("found {}; expected a number above 0", film.exposure));
    }
    Ok(())
}

fn look(camera: &CameraSection, places: &Places<'_>) -> Result<Camera, NotAScene> {
    let wrong = |key: &str, problem: &str| places.error(&[Step::Key("camera"), Step::Key(key)], problem);
    let projection = match (camera.projection, camera.width, camera.width_deg) {
        (View::Orthographic, Some(width), None) => Projection::Orthographic { width },
        (View::Perspective, None, Some(width_deg)) => Projection::Perspective { width_deg },
        (View::Orthographic, ..) => {
            return Err(wrong("projection", "found \"orthographic\"; expected `width` beside it, and no `width_deg`"));
        }
        (View::Perspective, ..) => {
            return Err(wrong("projection", "found \"perspective\"; expected `width_deg` beside it, and no `width`"));
        }
    };
    Camera::new(camera.from, camera.at, camera.up, projection).map_err(|why| {
        let key = match (&why, projection) {
            (NoCamera::Direction, _) => "at",
            (NoCamera::Up, _) => "up",
            (NoCamera::Width(_), Projection::Orthographic { .. }) => "width",
            (NoCamera::Width(_), Projection::Perspective { .. }) => "width_deg",
        };
        wrong(key, &why.to_string())
    })
}

impl Resolver<'_, '_> {
    pub(super) fn error(&self, way: &[Step<'_>], key: &str, problem: impl Into<String>) -> NotAScene {
        let way: Vec<Step<'_>> = way.iter().copied().chain([Step::Key(key)]).collect();
        self.places.error(&way, problem)
    }

    /// Keeps the remarks on what was read.
    pub(super) fn said<T>(&mut self, what: &str, (found, remarks): (T, Vec<String>)) -> T {
        self.remarks.extend(remarks.into_iter().map(|remark| format!("{what}: {remark}")));
        found
    }

    /// That something ends within the wavelengths of the scene.
    pub(super) fn note_range(&mut self, what: &str, nm: &[f64]) {
        let (Some(first), Some(last)) = (nm.first(), nm.last()) else { return };
        let grid = self.grid.nm();
        if *first > grid[0] || *last < grid[grid.len() - 1] {
            let sentence = format!("{what} is known from {first} to {last} nm; outside it is that of the nearest");
            self.remarks.push(sentence);
        }
    }

    /// That noise, or a mistake, lies below 0: it is drawn as it is.
    pub(super) fn note_negative(&mut self, what: &str, values: &[f64]) {
        let below = values.iter().filter(|value| **value < 0.0);
        let (count, least) = below.fold((0, 0.0_f64), |(count, least), value| (count + 1, least.min(*value)));
        if count > 0 {
            let all = values.len();
            self.warnings
                .push(format!("{what} has {count} of {all} values below 0, the least {least}: drawn as they are"));
        }
    }

    /// Exactly one of several keys.
    pub(super) fn one_of<const N: usize>(
        &self,
        way: &[Step<'_>],
        given: [bool; N],
        keys: &str,
    ) -> Result<(), NotAScene> {
        match given.iter().filter(|is_given| **is_given).count() {
            1 => Ok(()),
            count => Err(self.places.error(way, format!("found {count} of {keys}; expected exactly one"))),
        }
    }

    pub(super) fn above_0(&self, way: &[Step<'_>], key: &str, number: f64) -> Result<f64, NotAScene> {
        if number > 0.0 {
            return Ok(number);
        }
        Err(self.error(way, key, format!("found {number}; expected a number above 0")))
    }

    /// Of length 1.
    pub(super) fn direction(&self, way: &[Step<'_>], key: &str, vector: Vector) -> Result<Vector, NotAScene> {
        unit(vector).ok_or_else(|| {
            let [x, y, z] = vector;
            self.error(
                way,
                key,
                format!("found [{x}, {y}, {z}], which has no direction; expected a vector that is not 0"),
            )
        })
    }
}

/// Names of one list, each once.
struct Names<'a, 'text> {
    list: &'static str,
    places: &'a Places<'text>,
    taken: HashSet<String>,
}

impl<'a, 'text> Names<'a, 'text> {
    fn new(list: &'static str, places: &'a Places<'text>) -> Self {
        Self { list, places, taken: HashSet::new() }
    }

    fn take(&mut self, k: usize, name: &str) -> Result<(), NotAScene> {
        let problem = match name {
            "" => "found an empty name; expected one".to_owned(),
            _ if self.taken.insert(name.to_owned()) => return Ok(()),
            _ => format!("found a second {} `{name}`; expected another name", self.list),
        };
        Err(self.places.error(&[Step::Key(self.list), Step::Item(k), Step::Key("name")], problem))
    }
}
