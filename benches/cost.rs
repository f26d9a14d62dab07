//! What accuracy costs in time, as `bbrf cost` measures it, of the simulated scan and of a made-up matrix: `BBRF_UPDATE=1 cargo bench
//! --bench cost` writes docs/cost.md and its figures, without it they go to target.
#![allow(missing_docs, unreachable_pub, clippy::unwrap_used)]

#[path = "../tests/common/bispectral.rs"]
mod bispectral;

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use bbrf::container::Foreign;
use bbrf::cost::{EvalLadder, Ladder, Patience, Rung, eval_ladder, fit_ladder, storage_ladder};
use bbrf::dataset::Reduction;
use bbrf::donaldson::{Extend, Light, Luminescence, Matrix, Observer, Separate, separate};
use bbrf::fit::FitOptions;
use bbrf::import::{Options, import};
use bbrf::report::ladder_figure;

const LIGHTS: [&str; 8] = ["D65", "A", "D50", "C", "E", "FL2", "FL11", "LED-B3"];

const HEAD: &str = "\
# What accuracy costs in time

`bbrf cost fit|eval|storage FILE` measures it on your own file; this page is the same measured on the simulated scan of `testdata` and
on the made-up matrix of the tests. `BBRF_UPDATE=1 cargo bench --bench cost` writes it anew (`make bench` prints it). What the knobs
inside the fit do over a thousand random scans, beside the Cramer-Rao bound, is in `docs/fit_cost.md`.

A rung is a setting that `bbrf fit` (`--nodes`, `--tolerance`, `--reduce`), `bbrf donaldson predict` (`--by`, `--step`, `--rank`,
`--single`) or `bbrf migrate` (`--compression`, `--chunk`, `--single`) can be told. Rungs take turns while they are timed, so that what slows
the machine slows all alike, until the 95 % interval of the median is within 3 % of it or time runs out (`?`). Times are medians with
quartiles. `*` marks the rungs that no other beats in every respect. `--max-error` takes the cheapest rung within an error, `--budget`
the most accurate within a time.
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
    let orange = bispectral::document().measurements.remove(0);
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
    let ladders = [
        ("fit", "A fit of one band", fit(Reduction::Auto)),
        ("fit-spectral", "A fit of every wavelength", fit(Reduction::None)),
        ("eval", "A million predictions", eval_ladder(&eval, patience).unwrap()),
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
    writeln!(page, "\n| | rung | error | second | time | read | bytes | |\n|---|---|---|---|---|---|---|---|").unwrap();
    ladder.rungs.iter().for_each(|rung| writeln!(page, "{}", row(rung)).unwrap());
}

fn row(rung: &Rung) -> String {
    let error = |error: Option<f64>| match error {
        None => "-".to_owned(),
        Some(0.0) => "0".to_owned(),
        Some(error) => format!("{error:.1e}"),
    };
    let time = |time: &bbrf::cost::Timing| {
        let [median, low, high] =
            [time.median, time.first_quartile, time.third_quartile].map(|seconds| format!("{:.3}", seconds * 1e3));
        format!("{median} ms ({low} to {high}){}", if time.settled { "" } else { " ?" })
    };
    let mark = if rung.is_best { "*" } else { "" };
    let read = rung.read_time.as_ref().map_or(String::new(), time);
    let bytes = rung.bytes.map_or(String::new(), |bytes| bytes.to_string());
    let (first, second) = (error(rung.error), error(rung.second_error));
    let note = rung.note.clone().unwrap_or_default();
    format!("| {mark} | {} | {first} | {second} | {} | {read} | {bytes} | {note} |", rung.name, time(&rung.time))
}
