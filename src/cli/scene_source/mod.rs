//! A scene from its file, with the files that it names: paths are relative to it.

mod material;
mod mesh;

use std::path::{Path, PathBuf};

use miette::miette;

use super::command::donaldson::material::split;
use super::command::donaldson::{light_source, spectrum_source};
use super::output::print_message;
use crate::donaldson::Light;
use crate::quantity::QuantityKind;
use crate::simulate::document::{Corners, Library, Points, Resolved, SceneDocument, Source};
use crate::simulate::{Material, NoPicture};

/// Most bytes of a description.
const MOST_BYTES: u64 = 16 << 20;

/// A scene that was read.
pub(crate) struct Loaded {
    pub(crate) resolved: Resolved,
    /// Every file that was read, the description first.
    pub(crate) read: Vec<PathBuf>,
}

/// Reads a scene; says what is worth saying on stderr.
pub(crate) fn load(path: &Path) -> Result<Loaded, miette::Report> {
    let name = path.display().to_string();
    let unreadable = |error: &dyn std::fmt::Display| miette!("{name}: cannot be read: {error}");
    let bytes = std::fs::metadata(path).map_err(|error| unreadable(&error))?.len();
    if bytes > MOST_BYTES {
        return Err(miette!(
            "{name}: found {bytes} bytes; expected a scene of at most {MOST_BYTES}: put triangles into a mesh"
        ));
    }
    let text = std::fs::read_to_string(path).map_err(|error| unreadable(&error))?;
    let folder = path.parent().unwrap_or(Path::new("")).to_owned();
    let mut files = Files { folder, read: vec![path.to_owned()] };
    let resolved = SceneDocument::resolve(&name, &text, &mut files)
        .map_err(|error| miette!(help = "`bbrf schema scene` says what a scene may hold", "{error}"))?;
    resolved.remarks.iter().for_each(|remark| print_message(&format!("bbrf: {remark}")));
    resolved.warnings.iter().for_each(|warning| print_message(&format!("bbrf: warning: {warning}")));
    Ok(Loaded { resolved, read: files.read })
}

/// Why a scene has no picture, as it is told.
pub(crate) fn no_picture(place: &str, resolved: &Resolved, why: &NoPicture) -> miette::Report {
    if let Some(at) = resolved.blamed(why) {
        return miette!("{at}");
    }
    miette!("{place}: {why}")
}

/// The files beside a scene.
struct Files {
    folder: PathBuf,
    read: Vec<PathBuf>,
}

impl Files {
    /// A file that the scene names, as it can be opened from here.
    fn beside(&mut self, name: &str) -> Result<String, String> {
        let path = self.folder.join(name);
        self.read.push(PathBuf::from(split(&path.to_string_lossy()).0));
        path.to_str()
            .map(str::to_owned)
            .ok_or_else(|| format!("{}: expected a path of Unicode characters", path.display()))
    }
}

/// The message of a report, with what to do.
fn sentence(report: &miette::Report) -> String {
    match report.help() {
        Some(help) => format!("{report} ({help})"),
        None => report.to_string(),
    }
}

impl Library for Files {
    fn material(&mut self, source: &Source<'_>) -> Result<(Material, Vec<String>), String> {
        let path = self.beside(source.file)?;
        material::load(&path, source).map_err(|report| sentence(&report))
    }

    fn reflectance(&mut self, file: &str) -> Result<(Points, Vec<String>), String> {
        let path = self.beside(file)?;
        if !Path::new(split(&path).0).is_file() {
            return Err(format!("found no file {path}; expected a text of two columns (nm, share)"));
        }
        // A colour needs no uncertainty; one is named because those who estimate need it.
        let loaded = spectrum_source::load(&path, Some(QuantityKind::RadianceFactor), Some(1.0));
        let (spectrum, remarks) = loaded.map_err(|report| sentence(&report))?;
        if spectrum.kind != QuantityKind::RadianceFactor {
            return Err(format!("{path}: found `{}`; expected a radiance factor", spectrum.kind));
        }
        let points = spectrum.nm.into_iter().zip(spectrum.values).filter(|(_, value)| value.is_finite());
        Ok((points.collect(), remarks))
    }

    fn light(&mut self, name: &str) -> Result<(Light, Vec<String>), String> {
        if let Some(light) = Light::named(name) {
            return Ok((light, Vec::new()));
        }
        let path = self.beside(name)?;
        let loaded = light_source::load(&path).map_err(|report| sentence(&report))?;
        Ok((loaded.light, loaded.remarks))
    }

    fn mesh(&mut self, file: &str) -> Result<(Corners, Vec<String>), String> {
        let path = self.beside(file)?;
        mesh::load(Path::new(&path)).map(|corners| (corners, Vec::new()))
    }
}
