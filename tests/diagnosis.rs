//! What a fit rests on: leverages add up, an outlier is found, profiles meet their intervals, and the page says it.
#![allow(unreachable_pub, clippy::unwrap_used)]

mod common {
    pub mod documents;
    pub mod scans;
}

use std::path::Path;

use assert_cmd::Command;
use bbrf::container::write_file;
use bbrf::dataset::Document;
use bbrf::fit::{
    Diagnosis, FitOptions, Fitter, GeometrySet, Profiled, Share, Terms, diagnose_measurement, fit_measurement,
};
use bbrf::quantity::{Geometry, Reference, SignHabit};
use bbrf::report::diagnosis_page;
use bbrf::terms::{Denominator, Distribution};
use common::documents::measured_document;
use common::scans::{Random, Truth, measure, paper_grid};
use ndarray::{Array2, ArrayView1, Axis};

const BOTH: Terms = Terms { diffuse: true, specular: true };
const FIXED: Reference = Reference::FixedGeometry { theta_i_deg: 0.0, theta_v_deg: 45.0 };
const TRUTH: Truth = Truth { albedo: 0.5, intensity: 20.0, roughness: 0.15, index_minus_one: 0.5 };

fn set(grid: &[Geometry]) -> GeometrySet {
    GeometrySet::new(grid, &Reference::None, Distribution::GaussianHalfHeight, Denominator::CosThetaI).unwrap()
}

fn diagnose(grid: &[Geometry], values: &[f64], sigma: Option<&[f64]>) -> Diagnosis {
    let row = |values| ArrayView1::from(values).insert_axis(Axis(0));
    Fitter::new(&set(grid), BOTH).diagnose(row(values), sigma.map(row), 0.95).unwrap()
}

fn total(table: &Array2<f64>) -> f64 {
    table.iter().filter(|value| value.is_finite()).sum()
}

#[test]
fn leverages_add_up_to_the_number_of_parameters() {
    let grid = paper_grid();
    let (mut values, sigma) = measure(&TRUTH, &grid, 0.01, &mut Random::new(1));
    values[17] = f64::NAN;
    for sigma in [Some(&sigma[..]), None] {
        let diagnosis = diagnose(&grid, &values, sigma);
        assert_eq!(diagnosis.parameters, 4);
        assert!((total(&diagnosis.leverage) - 4.0).abs() < 1e-10, "{}", total(&diagnosis.leverage));
        assert!(diagnosis.leverage.iter().all(|h| h.is_nan() || (0.0..=1.0 + 1e-12).contains(h)));
        assert!(diagnosis.leverage[(0, 17)].is_nan() && diagnosis.residual[(0, 17)].is_nan());
    }
    // Three emission values: two amplitudes each, roughness and index in common; or one intensity for all.
    let bands = Array2::from_shape_fn((3, 272), |(b, k)| values[k] * (1.0 + 0.2 * b as f64));
    for (share, parameters) in [(Share::Shape, 8), (Share::ShapeAndIntensity, 6)] {
        let set = set(&grid);
        let diagnosis = Fitter::new(&set, BOTH).sharing(share).diagnose(bands.view(), None, 0.95).unwrap();
        assert_eq!(diagnosis.parameters, parameters);
        assert!((total(&diagnosis.leverage) - parameters as f64).abs() < 1e-9);
    }
}

/// The hat value is by its definition what the prediction moves by.
#[test]
fn a_leverage_is_what_a_prediction_moves_by_when_its_value_does() {
    let grid = paper_grid();
    let (values, sigma) = measure(&TRUTH, &grid, 0.001, &mut Random::new(2));
    let before = diagnose(&grid, &values, Some(&sigma));
    for k in [3, 100, 135, 200, 271] {
        let mut moved = values.clone();
        moved[k] += 0.5 * sigma[k];
        let after = diagnose(&grid, &moved, Some(&sigma));
        let by = (after.predicted[(0, k)] - before.predicted[(0, k)]) / (0.5 * sigma[k]);
        let leverage = before.leverage[(0, k)];
        assert!((by - leverage).abs() < 0.02 * leverage + 1e-4, "{k}: {by} {leverage}");
    }
}

#[test]
fn a_planted_outlier_is_the_most_influential_value() {
    let grid = paper_grid();
    let mut random = Random::new(3);
    for trial in 0..30 {
        let truth = Truth::random(&mut random);
        let (mut values, sigma) = measure(&truth, &grid, 0.01, &mut random);
        let planted = (random.uniform() * 272.0) as usize;
        values[planted] *= 2.0;
        let diagnosis = diagnose(&grid, &values, Some(&sigma));
        assert_eq!(diagnosis.most_influential(1), [(0, planted)], "trial {trial}");
    }
}

/// Cook's distance by its definition: the fit without the value.
#[test]
fn an_influence_is_how_far_the_fit_moves_without_the_value() {
    let grid = paper_grid();
    let (values, sigma) = measure(&TRUTH, &grid, 0.01, &mut Random::new(4));
    let whole = diagnose(&grid, &values, Some(&sigma));
    for (_, k) in whole.most_influential(4) {
        let mut without = values.clone();
        without[k] = f64::NAN;
        let other = diagnose(&grid, &without, Some(&sigma));
        let moved = whole.predicted.iter().zip(&other.predicted).zip(&sigma).map(|((a, b), s)| ((a - b) / s).powi(2));
        let distance = moved.sum::<f64>() / 4.0;
        let predicted = whole.influence[(0, k)];
        assert!((distance / predicted - 1.0).abs() < 0.15, "{k}: {distance} {predicted}");
    }
}

#[test]
fn a_profile_meets_its_level_at_the_ends_of_the_interval() {
    let grid = paper_grid();
    let (values, sigma) = measure(&TRUTH, &grid, 0.03, &mut Random::new(5));
    let diagnosis = diagnose(&grid, &values, Some(&sigma));
    let parameters: Vec<Profiled> = diagnosis.profiles.iter().map(|curve| curve.parameter).collect();
    let all = [Profiled::Diffuse, Profiled::Intensity, Profiled::Roughness, Profiled::IndexMinusOne];
    assert_eq!(parameters, all);
    for curve in &diagnosis.profiles {
        assert!(curve.points.is_sorted_by(|a, b| a.0 < b.0), "{curve:?}");
        assert!((curve.level - 3.841_458_820_694_124).abs() < 1e-9);
        // Between the points around each end the root of the rise is nearly straight.
        for end in [curve.interval.low, curve.interval.high] {
            let after = curve.points.iter().position(|point| point.0 >= end).unwrap();
            let [a, b] = [curve.points[after - 1], curve.points[after]]
                .map(|(x, y)| (x, y.sqrt() * if x < curve.best { -1.0 } else { 1.0 }));
            let root = a.1 + (b.1 - a.1) * (end - a.0) / (b.0 - a.0);
            assert!((root.abs() / curve.level.sqrt() - 1.0).abs() < 0.02, "{:?}: {root}", curve.parameter);
        }
    }
}

fn document(grid: &[Geometry], bands: usize, noise: f64, seed: u64) -> Document {
    let brighter = |band: usize| Truth { albedo: TRUTH.albedo * (1.0 + 0.1 * band as f64), ..TRUTH };
    let truths: Vec<Truth> = (0..bands).map(brighter).collect();
    let mut document = measured_document(grid, FIXED, &truths, noise, &mut Random::new(seed));
    document.measurements[0].title = Some("A <sheet> & its twin".to_owned());
    document
}

fn page_of(document: &Document, options: &FitOptions) -> String {
    let measurement = &document.measurements[0];
    let model = fit_measurement(document, measurement, options).unwrap();
    let diagnosis = diagnose_measurement(document, measurement, options).unwrap();
    diagnosis_page(document, &model, &diagnosis)
}

/// Every element that is opened is closed, in order; nothing runs and nothing is fetched.
fn assert_is_one_whole_page(html: &str) {
    let mut open: Vec<&str> = Vec::new();
    for tag in html.split('<').skip(1) {
        let inside = tag.split('>').next().unwrap();
        let name = inside.trim_start_matches('/').split([' ', '/', '\n']).next().unwrap();
        let is_void = inside.starts_with('!') || inside.ends_with('/') || ["meta", "br"].contains(&name);
        if inside.starts_with('/') {
            assert_eq!(open.pop(), Some(name), "…{}", &tag[..tag.len().min(80)]);
        } else if !is_void {
            open.push(name);
        }
    }
    assert_eq!(open, Vec::<&str>::new());
    assert!(html.starts_with("<!doctype html>") && html.trim_end().ends_with("</html>"));
    let forbidden = ["<script", "src=", "href=\"http", "@import", "onclick", "NaN", "inf,", "Infinity"];
    assert_eq!(forbidden.iter().find(|word| html.contains(**word)), None);
}

fn figures(html: &str) -> Vec<&str> {
    html.split("id=\"figure-").skip(1).map(|rest| rest.split('"').next().unwrap()).collect()
}

#[test]
fn the_page_of_a_scan_shows_residuals_leverage_influence_and_profiles() {
    let grid: Vec<Geometry> = [paper_grid(), paper_grid()[..40].to_vec()].concat();
    let document = document(&grid, 1, 0.02, 7);
    let html = page_of(&document, &FitOptions::default());
    assert_is_one_whole_page(&html);
    let expected = [
        "residual-map",
        "leverage-map",
        "residuals-half-vector",
        "residuals-facet",
        "residuals-predicted",
        "residuals-order",
        "residuals-normal",
        "profile-albedo",
        "profile-intensity",
        "profile-roughness",
        "profile-refractive-index",
    ];
    assert_eq!(figures(&html), expected);
    assert!(html.contains("A &lt;sheet&gt; &amp; its twin") && !html.contains("<sheet>"));
    assert!(html.contains("40 geometries have several values") && html.contains("in agreement"));
    let influential = html.split("Cook&#39;s distance</th>").nth(1).unwrap().split("</table>").next().unwrap();
    assert_eq!(influential.matches("<tr>").count(), 10);
    assert!(html.contains("95 % interval: "), "the interval is on the figures");
}

#[test]
fn the_page_of_a_scan_that_cannot_tell_the_index_says_that_its_interval_is_open() {
    let is_near = |g: &&Geometry| g.incidence.theta_deg() <= 30.0 && g.viewing.theta_deg() <= 30.0;
    let grid: Vec<Geometry> = paper_grid().iter().filter(is_near).copied().collect();
    let html = page_of(&document(&grid, 1, 0.03, 8), &FitOptions::default());
    assert_is_one_whole_page(&html);
    assert!(html.contains("open") && html.contains("end of what can be searched"), "{html}");
    assert!(html.contains("No geometry was measured twice"));
}

#[test]
fn the_page_of_a_spectral_fit_shows_each_wavelength() {
    let document = document(&paper_grid(), 5, 0.02, 9);
    let options = FitOptions { reduction: "none".parse().unwrap(), ..FitOptions::default() };
    let html = page_of(&document, &options);
    assert_is_one_whole_page(&html);
    let names = figures(&html);
    for name in ["reduced-chi-square", "lambertian-albedo", "torrance-sparrow-intensity", "profile-roughness"] {
        assert!(names.contains(&name), "{name} is not among {names:?}");
    }
    assert!(html.contains("wavelength (nm)</th>"), "influential values have their wavelength");
}

/// Directions out of the plane have no map, a diffuser no lobe: the rest is there.
#[test]
fn what_cannot_be_drawn_is_said_and_the_rest_is_drawn() {
    let grid: Vec<Geometry> = (0..40)
        .map(|k| Geometry::from_degrees(f64::from(k % 8) * 10.0, 0.0, 5.0 + f64::from(k % 5) * 15.0, 30.0).unwrap())
        .collect();
    let mut document = document(&grid, 1, 0.02, 10);
    let flat = Array2::from_shape_fn((40, 1), |(k, _)| 0.5 * grid[k].incidence.cos_theta());
    document.measurements[0].values = flat.into_shared();
    let html = page_of(&document, &FitOptions::default());
    assert_is_one_whole_page(&html);
    assert!(html.contains("Not drawn") && html.contains("leave the plane"));
    assert!(figures(&html).contains(&"profile-albedo") && !figures(&html).contains(&"profile-roughness"));
}

fn bbrf() -> Command {
    Command::cargo_bin("bbrf").unwrap()
}

fn written(folder: &Path) -> std::path::PathBuf {
    let grid: Vec<Geometry> = paper_grid();
    assert!(
        grid.iter().all(|g| g.signed_deg().is_some())
            && Geometry::from_signed(0.0, 0.0, SignHabit::MirrorAtEqual).is_ok()
    );
    let file = folder.join("scan.bbrf");
    write_file(&document(&grid, 1, 0.02, 11), &file).unwrap();
    file
}

#[test]
fn the_command_writes_the_page_and_never_over_what_it_reads() {
    let folder = tempfile::tempdir().unwrap();
    let file = written(folder.path());
    let page = folder.path().join("page.html");
    bbrf().arg("fit").arg(&file).arg("--diagnose").arg(&page).assert().success();
    assert_is_one_whole_page(&std::fs::read_to_string(&page).unwrap());
    let before = std::fs::read(&file).unwrap();
    bbrf().arg("fit").arg(&file).arg("--diagnose").arg(&file).assert().failure();
    assert_eq!(std::fs::read(&file).unwrap(), before);
    let out = folder.path().join("out.bbrf");
    bbrf().arg("fit").arg(&file).arg("-o").arg(&out).arg("--diagnose").arg(&out).assert().failure();
    assert!(!out.exists());
    bbrf().arg("fit").arg(&file).arg(&file).arg("--diagnose").arg(&page).assert().failure();
    // Nothing of a page is left where it cannot be written.
    bbrf().arg("fit").arg(&file).arg("--diagnose").arg(folder.path().join("no/such/page.html")).assert().failure();
}
