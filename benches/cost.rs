//! What accuracy costs in time, as `bbrf cost` measures it, of the simulated scan, of a made-up matrix, model and scene:
//! `BBRF_UPDATE=1 cargo bench --bench cost` writes docs/cost.md and its figures, without it they go to target.
#![allow(missing_docs, unreachable_pub, clippy::unwrap_used)]

#[path = "../tests/common"]
mod common {
    pub mod bispectral;
    pub mod completed;
    pub mod documents;
    pub mod matrices;
    pub mod scans;
    pub mod scenes;
}

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use bbrf::container::Foreign;
use bbrf::cost::{
    EvalLadder, Ladder, ModelLadder, Patience, Rung, Timing, eval_ladder, fit_ladder, image_ladder, model_ladder,
    storage_ladder,
};
use bbrf::dataset::Reduction;
use bbrf::donaldson::{Extend, Light, Luminescence, Matrix, Observer, Separate, separate};
use bbrf::fit::FitOptions;
use bbrf::import::{Options, import};
use bbrf::report::ladder_figure;
use bbrf::simulate::{Body, Bounces, Grid, Place, Plane, Rectangle, Scene, Shape};
use common::completed::{angles, complete, completed, with_matrix};
use common::matrices::Bispectral;
use common::scenes;

const LIGHTS: [&str; 8] = ["D65", "A", "D50", "C", "E", "FL2", "FL11", "LED-B3"];

const HEAD: &str = "\
# What accuracy costs in time

`bbrf cost fit|eval|image|storage FILE` measures it on your own file; this page is the same measured on the simulated scan of
`testdata` and on the made-up matrix, model and scene of the tests. `make bench` writes it anew. What the knobs inside the fit do over a
thousand random scans, beside the Cramer-Rao bound, is in `docs/fit_cost.md`.

A rung is a setting that another command can be told: `bbrf fit` (`--nodes`, `--tolerance`, `--reduce`), `bbrf donaldson predict`
(`--by`, `--step`, `--rank`, `--single`), `bbrf eval --light` (`--values`, `--by`, `--step`), `bbrf render` (`--everything`, `--by-pixel`,
`--max-delta-e`, `--step`, `--bounces`, `--samples`) or `bbrf migrate` (`--compression`, `--chunk`, `--single`). `--json` has the words of
each. Rungs take turns while they are timed, so that what slows the machine slows all alike, until the 95 % interval of the median is
within 3 % of it or time runs out (`?`). Times are medians with quartiles; on another machine they are others, and errors are the same.

`*` marks the rungs that no other beats in every respect (errors, time, reading, bytes); those without it are there to show that they need
not be taken. `--max-error` answers with the cheapest rung within an error, `--budget` with the most accurate within a time.
Of a complete model the rungs with one light for all geometries beat those with a light for each, but serve only who has one light.
";

fn main() {
    let patience = Patience { seconds: 2.0, ..Patience::default() };
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let scan = import(&[root.join("testdata/simulated_scan/scan.csv")], &Options::default()).unwrap();
    let measurement = scan.measurement("scan").unwrap();
    let fit = |reduction: Reduction| {
        let options = FitOptions { reduction, ..FitOptions::default() };
        fit_ladder(&scan, measurement, &options, patience).unwrap()
    };
    let orange = common::bispectral::document().measurements.remove(0);
    let matrix = Matrix::of(&orange).unwrap();
    let separated = separate(&matrix, Separate::default()).unwrap();
    let lights: Vec<Light> = LIGHTS.iter().map(|name| Light::named(name).unwrap()).collect();
    let eval = EvalLadder {
        subject: "orange, 49 x 41".to_owned(),
        matrix: &matrix,
        separated: &separated,
        luminescence: Luminescence::Full,
        lights: &lights,
        extend: Extend::Zero,
        observer: Observer::Two,
        count: 1e6,
    };
    let (whole, _) = completed(with_matrix(Bispectral::usual(2).measured(1e-4, 1)));
    let model = ModelLadder {
        subject: "a complete model".to_owned(),
        model: &complete(&whole),
        light: &Light::named("FL11").unwrap(),
        extend: Extend::Zero,
        geometries: &angles(),
        count: 1e6,
    };
    let ladders = [
        ("fit", "A fit of one band", fit(Reduction::Auto)),
        ("fit-spectral", "A fit of every wavelength", fit(Reduction::None)),
        ("eval", "A million predictions", eval_ladder(&eval, patience).unwrap()),
        ("model", "A million evaluations of a complete model", model_ladder(&model, patience).unwrap()),
        (
            "image",
            "An image",
            image_ladder(&room(), "ball, wall and floor, 160 x 120 pixels, 16 samples".to_owned(), patience).unwrap(),
        ),
        (
            "storage",
            "A file",
            storage_ladder(&scan, &Foreign::default(), "the simulated scan".to_owned(), patience).unwrap(),
        ),
    ];
    let folder = root.join(if std::env::var_os("BBRF_UPDATE").is_some() { "docs" } else { "target" });
    let mut page = HEAD.to_owned();
    for (name, title, ladder) in &ladders {
        write_section(&mut page, &folder, name, title, ladder);
    }
    print!("{page}");
    std::fs::write(folder.join("cost.md"), page).unwrap();
}

/// A fluorescent ball beside a white wall on a grey floor: direct light with its shadows, and light from body to body.
fn room() -> Scene {
    let wall = Plane {
        point: [1.3, 0.0, 0.0],
        normal: [-1.0, 0.0, 0.0],
        rectangle: Some(Rectangle { axes: [[0.0, 1.0, 0.0], [0.0, 0.0, 1.0]], half: [1.5, 1.0] }),
    };
    let wall = Body { name: "wall".to_owned(), shape: Shape::Plane(wall), material: 1 };
    let materials = vec![scenes::glowing("orange", 0.5, 590.0, 0.5), scenes::grey(0.8), scenes::grey(0.4)];
    let third = 1.0 / 3.0_f64;
    let mut lamp = scenes::white("D65", Place::Directional([-2.0 * third, -2.0 * third, third]));
    lamp.light = Light::named("D65").unwrap();
    Scene {
        size: (160, 120),
        grid: Grid::new(300.0, 780.0, 5.0).unwrap(),
        bounces: Bounces::All,
        ..scenes::scene(vec![scenes::ball([0.0; 3], 1.0, 0), wall, scenes::floor(-1.0, 2)], materials, vec![lamp])
    }
}

fn write_section(page: &mut String, folder: &Path, name: &str, title: &str, ladder: &Ladder) {
    let images: PathBuf = folder.join("images");
    std::fs::create_dir_all(&images).unwrap();
    let figure = ladder_figure(ladder).unwrap();
    std::fs::write(images.join(format!("cost_{name}.png")), figure.to_png().unwrap()).unwrap();
    let meaning = &ladder.meaning;
    writeln!(page, "\n## {title}\n\n![{}](images/cost_{name}.png)\n", figure.caption()).unwrap();
    writeln!(page, "{}, on {}.\n\n- Reference: {}.", ladder.subject, ladder.machine, meaning.reference).unwrap();
    writeln!(page, "- Error: {}.", meaning.error).unwrap();
    meaning.second_error.iter().for_each(|words| writeln!(page, "- Second error: {words}.").unwrap());
    writeln!(page, "- Time: {}.", meaning.time).unwrap();
    meaning.read_time.iter().for_each(|words| writeln!(page, "- Read: {words}.").unwrap());
    let columns: Vec<&Column> =
        COLUMNS.iter().filter(|column| ladder.rungs.iter().any(|rung| !(column.1)(rung).is_empty())).collect();
    let line = |cells: Vec<String>| format!("| {} |", cells.join(" | "));
    let header = columns.iter().map(|(title, _)| (*title).to_owned()).collect();
    writeln!(page, "\n{}\n{}", line(header), line(vec!["---".to_owned(); columns.len()])).unwrap();
    for rung in &ladder.rungs {
        writeln!(page, "{}", line(columns.iter().map(|(_, of)| of(rung)).collect())).unwrap();
    }
}

type Column = (&'static str, fn(&Rung) -> String);

/// A column without any text is left out.
const COLUMNS: [Column; 8] = [
    ("", |rung| if rung.is_best { "*" } else { "" }.to_owned()),
    ("rung", |rung| rung.name.clone()),
    ("error", |rung| error(rung.error)),
    ("second error", |rung| error(rung.second_error)),
    ("time", |rung| time(&rung.time)),
    ("reading", |rung| rung.read_time.as_ref().map_or(String::new(), time)),
    ("bytes", |rung| rung.bytes.map_or(String::new(), |bytes| bytes.to_string())),
    ("note", |rung| rung.note.clone().unwrap_or_default()),
];

fn error(error: Option<f64>) -> String {
    match error {
        None => String::new(),
        Some(0.0) => "0".to_owned(),
        Some(error) => format!("{error:.1e}"),
    }
}

fn time(time: &Timing) -> String {
    let (unit, scale) = if time.median < 1.0 { ("ms", 1e3) } else { ("s", 1.0) };
    let digits = |seconds: f64| format!("{:.3}", seconds * scale);
    let unsettled = if time.settled { "" } else { " ?" };
    let (median, low, high) = (digits(time.median), digits(time.first_quartile), digits(time.third_quartile));
    format!("{median} {unit} ({low} to {high}){unsettled}")
}
