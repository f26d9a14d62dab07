//! From a description to the scene that is drawn.

use std::collections::HashSet;

use super::description::{CameraSection, FilmSection, SceneDocument, View};
use super::place::{NotAScene, Places, Step};
use crate::donaldson::Light;
use crate::simulate::camera::{Camera, Projection};
use crate::simulate::film::LONGEST_SIDE;
use crate::simulate::grid::Grid;
use crate::simulate::material::Material;
use crate::simulate::picture::Kept;
use crate::simulate::scene::{Body, MOST, Scene};
use crate::simulate::vector::{Vector, unit};

/// Most pixels of an image.
const MOST_PIXELS: usize = 1 << 28;
/// Most samples of a pixel.
const MOST_SAMPLES: u32 = 1 << 20;

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
}

/// On the way to a scene.
pub(super) struct Resolver<'a, 'text> {
    pub(super) library: &'a mut dyn Library,
    places: &'a Places<'text>,
    grid: Grid,
    remarks: Vec<String>,
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
    let mut with = Resolver { library, places, grid, remarks: Vec::new() };
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
    for (k, light) in lights.into_iter().enumerate() {
        let name = light.name.clone().unwrap_or_else(|| format!("light {}", k + 1));
        names.take(k, &name)?;
        sources.push(light.resolve(Step::Item(k), name, &mut with)?);
    }
    super::lights::check_units(&sources, places)?;
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
    let Resolver { grid, remarks, .. } = with;
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
    let warnings = super::super::losses::of(&scene);
    Ok(Resolved { scene, kept: film.kept, exposure: film.exposure, remarks, warnings })
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
    Camera::new(camera.from, camera.at, camera.up, projection)
        .map_err(|why| places.error(&[Step::Key("camera")], why.to_string()))
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
