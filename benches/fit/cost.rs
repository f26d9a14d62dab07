//! What accuracy costs in time inside the fit, as one figure: `BBRF_UPDATE=1 cargo bench --bench fit -- cost` writes it to
//! docs/images, without it to target.

use bbrf::fit::{Effort, Fitter, GeometrySet};
use bbrf::quantity::Geometry;
use bbrf::report::{CurveText, Knob, Setting, trade};
use ndarray::Array2;

use crate::common::families::in_plane;
use crate::common::scans::{Random, Truth, measure, paper_grid};
use crate::timing::time;
use crate::{BOTH, tables, trials};

/// One setting of the fit and of its scans.
struct Run {
    grid: Vec<Geometry>,
    set: GeometrySet,
    wavelengths: usize,
    scans: usize,
}

/// Truths of which the usual scan knows the roughness to 3 %, narrow lobes among them: beyond that an error is no ellipse, and
/// its bound says little.
fn truths(count: usize) -> Vec<(Truth, f64)> {
    let (grid, mut random) = (paper_grid(), Random::new(99));
    let draw = || Truth { roughness: random.log_between(0.02, 0.4), ..Truth::random(&mut random) };
    let with_bound = |truth: Truth| (truth, truth.cramer_rao(&grid, 0.01)[2]);
    let is_known = |(truth, bound): &(Truth, f64)| *bound < 0.03 * truth.roughness;
    std::iter::repeat_with(draw).map(with_bound).filter(is_known).take(count).collect()
}

impl Run {
    fn of(grid: Vec<Geometry>, effort: Effort, wavelengths: usize, scans: usize) -> Self {
        Self { set: tables(&grid).with_effort(effort), grid, wavelengths, scans }
    }

    /// Every run draws the same truths. The error is that of the roughness, r.m.s. over the scans, in units of what the
    /// Cramer-Rao bound of the usual scan is for each.
    fn measured(&self, label: &str) -> Setting {
        let truths = truths(self.scans);
        let mut random = Random::new(100);
        let data: Vec<(Array2<f64>, Array2<f64>)> =
            truths.iter().map(|(truth, _)| self.scan(truth, &mut random)).collect();
        let fitter = Fitter::new(&self.set, BOTH);
        let mut square = 0.0;
        let timed = time(self.scans, |k| {
            let ((values, sigma), (truth, unit)) = (&data[k], &truths[k]);
            let fit = fitter.fit_bands(values.view(), Some(sigma.view())).unwrap();
            // Where no lobe is found there is no roughness either: an error of all of it.
            let error = if fit.has_specular() { fit.roughness - truth.roughness } else { truth.roughness };
            square += (error / unit).powi(2);
        });
        let bound = |(truth, unit): &(Truth, f64)| (truth.cramer_rao(&self.grid, 0.01)[2] / unit).powi(2);
        let bound = truths.iter().map(bound).sum::<f64>() / self.wavelengths as f64;
        let root_mean = |square: f64| (square / self.scans as f64).sqrt();
        let setting = Setting {
            cost: timed.wall[1],
            result: root_mean(square),
            bound: root_mean(bound),
            label: label.to_owned(),
        };
        let [low, median, high] = timed.wall;
        println!(
            "   {label}: {median:.1} us [{low:.1} .. {high:.1}]; r.m.s. error {:.4}, Cramer-Rao {:.4} ({} scans)",
            setting.result, setting.bound, self.scans
        );
        setting
    }

    fn scan(&self, truth: &Truth, random: &mut Random) -> (Array2<f64>, Array2<f64>) {
        let rows: Vec<_> = (0..self.wavelengths).map(|_| measure(truth, &self.grid, 0.01, random)).collect();
        let shape = (self.wavelengths, self.grid.len());
        (Array2::from_shape_fn(shape, |(b, k)| rows[b].0[k]), Array2::from_shape_fn(shape, |(b, k)| rows[b].1[k]))
    }
}

pub fn run() {
    let (usual, count) = (Effort::default(), trials(1000).min(4000));
    let at = |effort: Effort| Run::of(paper_grid(), effort, 1, count);
    let tolerance = [1e6, 1e4, 1e2, 1.0, 1e-2, 1e-4, 1e-8, 1e-14]
        .map(|tolerance| at(Effort { tolerance, ..usual }).measured(&format!("{tolerance:.0e}")));
    let nodes = [(1, 1, 1), (2, 1, 1), (4, 1, 1), (8, 1, 1), (8, 3, 2), (12, 3, 2), (24, 5, 2), (48, 9, 4)];
    let nodes = nodes.map(|(roughness_nodes, index_nodes, starts)| {
        let label = format!("{roughness_nodes}x{index_nodes}x{starts}");
        at(Effort { roughness_nodes, index_nodes, starts, ..usual }).measured(&label)
    });
    let geometries = [10.0, 8.0, 5.0, 4.0, 2.5].map(|step| {
        let grid = in_plane(step, 80.0);
        let label = format!("{} geometries", grid.len());
        Run::of(grid, usual, 1, count.div_ceil(if step < 4.0 { 4 } else { 1 })).measured(&label)
    });
    let wavelengths = [1, 3, 10, 30, 100].map(|wavelengths| {
        let label = format!("{wavelengths} wavelengths");
        Run::of(paper_grid(), usual, wavelengths, (2 * count / wavelengths).clamp(count.div_ceil(4), count))
            .measured(&label)
    });
    draw(&[
        ("tolerance of the polish", tolerance.to_vec()),
        ("nodes of roughness x index x polished", nodes.to_vec()),
        ("geometries", geometries.to_vec()),
        ("wavelengths with one roughness", wavelengths.to_vec()),
    ]);
}

fn draw(knobs: &[(&str, Vec<Setting>)]) {
    let knobs: Vec<Knob> =
        knobs.iter().map(|(name, settings)| Knob { name: (*name).to_owned(), settings: settings.clone() }).collect();
    let text = CurveText {
        name: "fit-cost".to_owned(),
        title: "What accuracy costs in time inside the fit".to_owned(),
        subtitle: "Random scans with 1 % noise; 272 geometries, 1 wavelength, 12x3 nodes with 2 polished and a tolerance of 1e-8 \
                   where nothing else is said"
            .to_owned(),
        x: "median time of a fit (us), one thread".to_owned(),
        y: "r.m.s. error of the roughness (Cramer-Rao bound of the usual scan)".to_owned(),
        caption: String::new(),
    };
    let figure = trade(&knobs, "Cramer-Rao bound of each setting", &text).unwrap();
    let root = std::path::Path::new(env!("CARGO_MANIFEST_DIR"));
    let folder = root.join(if std::env::var_os("BBRF_UPDATE").is_some() { "docs/images" } else { "target" });
    let path = folder.join("fit_cost.png");
    std::fs::write(&path, figure.to_png().unwrap()).unwrap();
    println!("   drawn: {}", path.display());
}
