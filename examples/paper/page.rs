//! The page: each figure beside what the paper says and what is seen here.

use std::error::Error;
use std::fs;
use std::path::Path;

use crate::directions::{Brightest, Spectra};
use crate::experiments::{UNDER_BLACK_LIGHT, UNDER_WHITE_LIGHT};
use crate::fitted::{Fitted, read_all};
use crate::matrix::{Compared, compare};
use crate::picture::all;
use crate::sheet::{Sheet, counted, covered, percent, range, with_uncertainty};
use crate::sphere::Sphere;

/// The objects that the paper shows.
const SHOWN: [(&str, &str); 3] = [
    ("fluorescence-paper-green", "green fluorescence paper"),
    ("fluorescence-sheet-yellow", "yellow fluorescence sheet"),
    ("fluorescence-tape-red", "red fluorescence tape"),
];
const WHITE: &str = "matte-white";
const INTRODUCTION: &str = include_str!("introduction.md");

/// Writes `paper.md`, and its figures to `images/paper` beside it.
///
/// # Errors
/// When a result is not there, or something cannot be written.
pub(crate) fn write(folder: &Path, docs: &Path) -> Result<(), Box<dyn Error>> {
    let images = docs.join("images/paper");
    fs::create_dir_all(&images)?;
    let mut page = Sheet::new(INTRODUCTION, folder, &images);
    let luminescent = read_all(&folder.join(UNDER_BLACK_LIGHT))?;
    let lit = read_all(&folder.join(UNDER_WHITE_LIGHT))?;
    page.figure_2(&luminescent)?;
    page.figure_3(&luminescent)?;
    page.figure_4(&lit)?;
    page.reflection(&lit)?;
    page.figure_5(&compare(folder)?)?;
    page.figure_6()?;
    fs::write(docs.join("paper.md"), page.finish())?;
    Ok(())
}

impl Sheet<'_> {
    fn figure_2(&mut self, fits: &[Fitted]) -> Result<(), Box<dyn Error>> {
        self.heading("Fig. 2: radiance over incidence and viewing");
        for (name, title) in SHOWN {
            let figures = format!("{UNDER_BLACK_LIGHT}/{name}/figures");
            let words = format!("{title}: luminescence over both angles");
            self.show(&figures, "surface.png", &format!("fig2-{name}"), &words)?;
        }
        let mut shapes = Vec::new();
        for fit in fits {
            let table = self.folder.join(UNDER_BLACK_LIGHT).join(fit.object.name).join("spectra.csv");
            shapes.push(Spectra::read(&table, fit.band_nm)?.shape());
        }
        let scatter = range(shapes.iter().map(|shape| shape.scatter_nm));
        let stated = range(shapes.iter().map(|shape| shape.stated_nm));
        self.say(&format!(
            "\n**The paper** shows these three of its twelve objects, the spectrum summed over the wavelengths at which each radiates; the \
             gap is where the detector would stand before the lamp.\n\n\
             **Here** the same three, drawn by `bbrf report`; pale facets lean on interpolated points. That a sum over wavelengths is \
             enough is seen in the spectra: the mean wavelength of the emission is the same from everywhere. Over the directions it \
             scatters by {} nm (least and most of the {}), and the stated uncertainties alone make {} nm of that.",
            scatter,
            counted(fits.len(), "object"),
            stated,
        ));
        Ok(())
    }

    fn figure_3(&mut self, fits: &[Fitted]) -> Result<(), Box<dyn Error>> {
        self.heading("Fig. 3: averaged over viewing, and over incidence");
        for (name, title) in SHOWN {
            self.averages(UNDER_BLACK_LIGHT, name, "fig3", title)?;
        }
        let worst = |departure: fn(&Fitted) -> f64| percent(fits.iter().map(departure).fold(0.0, f64::max));
        self.say(&format!(
            "**The paper** finds a cosine of the angle of incidence, and over the angle of viewing a constant, except close to 90 \
             degrees: luminescence is Lambertian.\n\n\
             **Here** the averages of all {} follow a cosine to {} of its amplitude and a constant to {} of its mean, both root mean \
             square and at worst; the Lambertian term describes all 272 geometries with a reduced chi-square of {}. The drop at the \
             edge of viewing was not put in (it may be the measured spot, which outgrows the sample at grazing angles), and is not \
             seen. The amplitude as it was found and as it was put in, radiance at normal incidence in the band:\n",
            counted(fits.len(), "object"),
            worst(|fit| fit.from_cosine),
            worst(|fit| fit.from_constant),
            range(fits.iter().map(|fit| fit.reduced_chi_square)),
        ));
        self.row("| object | band, nm | found, mW m-2 sr-1 | put in | difference, in standard uncertainties |");
        self.row("|---|---|---|---|---|");
        for fit in fits {
            let (from, to) = fit.band_nm;
            for one in &fit.parameters {
                let found = with_uncertainty(1e3 * one.found, 1e3 * one.uncertainty);
                let (put_in, difference) = (1e3 * one.truth, one.deviation());
                self.row(&format!(
                    "| {} | {from} to {to} | {found} | {put_in:.4} | {difference:+.1} |",
                    fit.object.title
                ));
            }
        }
        Ok(())
    }

    fn figure_4(&mut self, fits: &[Fitted]) -> Result<(), Box<dyn Error>> {
        let white = fits.iter().find(|fit| fit.object.name == WHITE).ok_or("no matte white")?;
        self.heading("Fig. 4: the same of a matte white");
        self.averages(UNDER_WHITE_LIGHT, WHITE, "fig4", "matte white")?;
        let [albedo, ..] = white.parameters.as_slice() else { return Err("the matte white has no albedo".into()) };
        self.say(&format!(
            "**The paper** finds a cosine of the angle of incidence approximately, yet not sufficiently, and no dependence on the \
             angle of viewing.\n\n\
             **Here** the white was given a weak interface, too. The average over viewing departs from a cosine by {}, so a cosine is \
             not sufficient here either. The average over incidence departs from a constant by {}: towards grazing views the interface \
             is seen, which the paper does not find. What is left when the fit has told the two apart is Lambertian: albedo {:.4} ± {:.4} \
             for {:.4} put in, and a reduced chi-square of {:.2}.",
            percent(white.from_cosine),
            percent(white.from_constant),
            albedo.found,
            albedo.uncertainty,
            albedo.truth,
            white.reduced_chi_square,
        ));
        Ok(())
    }

    fn reflection(&mut self, fits: &[Fitted]) -> Result<(), Box<dyn Error>> {
        self.heading("Equation (4): what the interface reflects");
        let mut total = Brightest::default();
        for fit in fits {
            let table = self.folder.join(UNDER_WHITE_LIGHT).join(fit.object.name).join("spectra.csv");
            total.add(&Spectra::read(&table, fit.band_nm)?.brightest());
        }
        self.say(&format!(
            "**The paper** supposes that the specular part of a fluorescent surface is that of Torrance and Sparrow, and measures none.\n\n\
             **Here** the same objects were looked at under a lamp with visible light, too. Of {} incidences of 20 to 60 degrees \
             the brightest view is the mirror direction or a neighbour of it at {}, and beyond it, towards grazing views, at {}: \
             the off-specular peaks of wide lobes. `bbrf fit`, without a start, finds what was put in; each difference is given in \
             the standard uncertainties that the fit states:\n",
            total.incidences, total.at_mirror, total.beyond
        ));
        let names: Vec<&str> =
            fits.first().map_or(Vec::new(), |fit| fit.parameters.iter().map(|one| one.name.as_str()).collect());
        self.row(&format!("| object | {} | differences |", names.join(" | ")));
        self.row(&format!("|---|{}---|", "---|".repeat(names.len())));
        let (mut squares, mut parameters) = (0.0, 0);
        for fit in fits {
            let cells: Vec<String> =
                fit.parameters.iter().map(|one| with_uncertainty(one.found, one.uncertainty)).collect();
            let differences: Vec<String> =
                fit.parameters.iter().map(|one| format!("{:+.1}", one.deviation())).collect();
            self.row(&format!("| {} | {} | {} |", fit.object.title, cells.join(" | "), differences.join(", ")));
            squares += fit.parameters.iter().map(|one| one.deviation().powi(2)).sum::<f64>();
            parameters += fit.parameters.len();
        }
        self.say(&format!(
            "\nRoot mean square of all {parameters} differences: {:.2} (1 is what is promised; the uncertainty of the white plate's \
             certificate, 0.5 %, is part of those of albedo and intensity, and no error of the plate was put in).",
            (squares / parameters as f64).sqrt()
        ));
        Ok(())
    }

    fn figure_5(&mut self, found: &Compared) -> Result<(), Box<dyn Error>> {
        self.heading("Fig. 5: the matrix of Lumi Yellow from two lamps");
        self.show("figures", "lumi-yellow-bispectral-surface.png", "fig5-surface", "Estimated matrix, as a surface")?;
        self.show("figures", "lumi-yellow-bispectral-map.png", "fig5-map", "Estimated matrix, as a map")?;
        self.say(&format!(
            "\n**The paper** estimates the Donaldson matrix of a paint, Lumi Yellow, from an incandescent lamp and an artificial sun, and \
             takes reflectance and luminescence from it.\n\n\
             **Here** a made-up paint of that kind was looked at under both (incidence 0, viewing 45 degrees), and `bbrf donaldson \
             estimate` was told nothing of its excitation. The emission peaks at {} nm ({} put in), and the reflectance is right to \
             {:.3}, root mean square. Of the intervals of 95 % these hold the truth: reflectance {}, emission {}, excitation {}, cells of \
             the matrix {}. Two lamps say how much is excited and not where: the intervals of the excitation spectrum are {:.2} of its peak \
             wide in the median, and the best that fits peaks at {} nm ({} put in). The figures show the \
             best; the intervals are in the file.",
            found.peak_nm.0,
            found.peak_nm.1,
            found.reflectance_rms,
            covered(&found.reflectance),
            covered(&found.emission),
            covered(&found.excitation),
            covered(&found.cells),
            found.excitation_width,
            found.excited_nm.0,
            found.excited_nm.1,
        ));
        Ok(())
    }

    /// What `bbrf render` drew, if it was run.
    fn figure_6(&mut self) -> Result<(), Box<dyn Error>> {
        let folder = self.folder.join("sphere");
        if !folder.is_dir() {
            return Ok(());
        }
        self.heading("Fig. 6: the sphere");
        for picture in all(&folder, ".png")? {
            let part = picture.file_stem().unwrap_or_default().to_string_lossy().into_owned();
            self.show("sphere", &format!("{part}.png"), &format!("fig6-{part}"), &part)?;
        }
        let found = Sphere::read(&folder.join("render.json"), &self.folder.join("sphere.toml"))?;
        self.say(&format!(
            "\n**The paper** shows a sphere of that paint under the artificial sun and its three parts, with roughness 0.05, index 1.45 \
             and specular intensity 30: luminescence differs clearly from the others, and the highlight has the colour of the light.\n\n\
             **Here** the same scene, `examples/paper/sphere.toml`, with the estimated matrix, drawn by `bbrf render`; where light and \
             camera stand the paper does not say. Of all light to the eye (Y) {} is luminescence and {} comes from the interface. The \
             highlight stands at column {}, row {}; the normal halves the way from the light to the eye at {}, {}. There the interface \
             alone is {:.2} as bright as white, and its x and y differ from the light's by {:.4}. The luminescence is greener than a \
             display: {} of its pixels on the sphere are no colours of sRGB and are shown paler.",
            percent(found.luminescent_share),
            percent(found.specular_share),
            found.pixel.0,
            found.pixel.1,
            found.mirror.0,
            found.mirror.1,
            found.highlight,
            found.from_light,
            percent(found.outside),
        ));
        Ok(())
    }
}
