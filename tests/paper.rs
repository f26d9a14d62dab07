//! The paper's experiment on simulated objects, from raw records to the page, as `make paper` runs it: fewer objects.

#![cfg(unix)]
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test may panic, also in its helpers")]

#[path = "../examples/paper/directions.rs"]
mod directions;
#[path = "../examples/paper/experiments.rs"]
mod experiments;
#[path = "../examples/paper/fitted.rs"]
mod fitted;
#[path = "../examples/paper/lamps.rs"]
mod lamps;
#[path = "../examples/paper/matrix.rs"]
mod matrix;
#[path = "../examples/paper/page.rs"]
mod page;
#[path = "../examples/paper/picture.rs"]
mod picture;
#[path = "../testdata/simulated_scan/scan/mod.rs"]
mod scan;
#[path = "../examples/paper/sheet.rs"]
mod sheet;
#[path = "../examples/paper/sphere.rs"]
mod sphere;
#[path = "../examples/paper/yellow_paint.rs"]
mod yellow_paint;

use std::fs;
use std::path::Path;
use std::process::Command;
use std::sync::LazyLock;

use directions::Spectra;
use experiments::{UNDER_BLACK_LIGHT, UNDER_WHITE_LIGHT};
use fitted::{Fitted, read_all};
use tempfile::TempDir;

/// The objects that the paper shows in its figures.
const OBJECTS: [&str; 4] =
    ["fluorescence-paper-green", "fluorescence-sheet-yellow", "fluorescence-tape-red", "matte-white"];

/// Raw records of these objects, and what the commands made of them.
static WORKED: LazyLock<TempDir> = LazyLock::new(|| {
    let folder = tempfile::tempdir().unwrap();
    experiments::simulate(folder.path(), &experiments::of(|name| OBJECTS.contains(&name))).unwrap();
    let script = concat!(env!("CARGO_MANIFEST_DIR"), "/scripts/paper.sh");
    let run = Command::new("bash").arg(script).arg(env!("CARGO_BIN_EXE_bbrf")).arg(folder.path()).output().unwrap();
    assert!(run.status.success(), "{}", String::from_utf8_lossy(&run.stderr));
    folder
});

fn fits(group: &str) -> Vec<Fitted> {
    let fits = read_all(&WORKED.path().join(group)).unwrap();
    assert!(fits.len() >= 3, "{group}: {} fits", fits.len());
    fits
}

fn spectra(group: &str, fit: &Fitted) -> Spectra {
    Spectra::read(&WORKED.path().join(group).join(fit.object.name).join("spectra.csv"), fit.band_nm).unwrap()
}

#[test]
fn luminescence_is_a_cosine_of_incidence_and_the_same_from_every_view() {
    for fit in fits(UNDER_BLACK_LIGHT) {
        let name = fit.object.name;
        assert!(fit.from_cosine < 0.005, "{name}: {} from a cosine", fit.from_cosine);
        assert!(fit.from_constant < 0.005, "{name}: {} from a constant", fit.from_constant);
        assert!((0.7..1.3).contains(&fit.reduced_chi_square), "{name}: {}", fit.reduced_chi_square);
    }
}

#[test]
fn the_shape_of_the_emission_depends_on_no_direction() {
    for fit in fits(UNDER_BLACK_LIGHT) {
        let shape = spectra(UNDER_BLACK_LIGHT, &fit).shape();
        let ratio = shape.scatter_nm / shape.stated_nm;
        assert!((0.8..1.2).contains(&ratio), "{}: {shape:?}", fit.object.name);
    }
}

#[test]
fn what_was_put_in_is_found_within_the_stated_uncertainty() {
    for group in [UNDER_BLACK_LIGHT, UNDER_WHITE_LIGHT] {
        for fit in fits(group) {
            for one in &fit.parameters {
                let (name, deviation) = (fit.object.name, one.deviation());
                assert!(deviation.abs() < 3.5, "{group}, {name}: {one:?} is off by {deviation} standard uncertainties");
            }
        }
    }
}

#[test]
fn a_glossy_tape_is_brightest_in_the_mirror_direction_and_its_luminescence_is_not() {
    let is_tape = |fit: &Fitted| fit.object.name == "fluorescence-tape-red";
    let lit = fits(UNDER_WHITE_LIGHT).into_iter().find(is_tape).unwrap();
    let brightest = spectra(UNDER_WHITE_LIGHT, &lit).brightest();
    assert_eq!(brightest.at_mirror, brightest.incidences);
    let excited = fits(UNDER_BLACK_LIGHT).into_iter().find(is_tape).unwrap();
    let brightest = spectra(UNDER_BLACK_LIGHT, &excited).brightest();
    assert!(brightest.at_mirror < brightest.incidences, "{brightest:?}");
}

#[test]
fn a_matte_white_is_not_sufficiently_a_cosine_until_its_interface_is_told_apart() {
    let white = fits(UNDER_WHITE_LIGHT).into_iter().find(|fit| fit.object.name == "matte-white").unwrap();
    assert!(white.from_cosine > 0.02, "{}", white.from_cosine);
    assert!((0.7..1.3).contains(&white.reduced_chi_square), "{}", white.reduced_chi_square);
}

#[test]
fn intervals_of_the_estimated_matrix_hold_the_truth() {
    let found = matrix::compare(WORKED.path()).unwrap();
    for covered in [&found.reflectance, &found.emission, &found.excitation, &found.cells] {
        assert!(covered.held * 100 >= covered.of * 90, "{found:?}");
    }
    let (peak, truth) = found.peak_nm;
    assert!((peak - truth).abs() <= 10.0, "{found:?}");
}

#[test]
fn the_page_shows_every_figure_beside_what_is_said_and_what_is_seen() {
    let docs = tempfile::tempdir().unwrap();
    page::write(WORKED.path(), docs.path()).unwrap();
    let text = fs::read_to_string(docs.path().join("paper.md")).unwrap();
    let sections: Vec<&str> = text.split("\n## ").skip(1).collect();
    for figure in ["Fig. 2", "Fig. 3", "Fig. 4", "Fig. 5"] {
        let section = sections.iter().find(|section| section.starts_with(figure)).unwrap();
        assert!(
            section.contains("**The paper**") && section.contains("**Here**") && section.contains("!["),
            "{section}"
        );
    }
    for image in text.split("](").skip(1).filter_map(|rest| rest.split_once(')')) {
        assert!(is_picture(&docs.path().join(image.0)), "{}", image.0);
    }
    assert!(!text.contains("NaN") && !text.contains("inf "), "{text}");
}

fn is_picture(path: &Path) -> bool {
    let reader = png::Decoder::new(std::io::BufReader::new(fs::File::open(path).unwrap())).read_info();
    reader.is_ok_and(|reader| reader.info().width > 300)
}
