//! A whole scan: every geometry, the white plate before and after, the dark, the manifest and the truth.

mod instrument;
pub(crate) mod lamp;
pub(crate) mod objects;
mod optics;
mod random;
mod truth;

use std::ops::RangeInclusive;
use std::path::Path;
use std::{fs, io};

use instrument::Reading;
use lamp::Lamp;
use objects::Object;
use optics::{Spectra, WAVELENGTHS, WHITE_FACTOR};
use random::Random;

/// Readings of the white plate before, and again after the scan.
const WHITES: usize = 3;
/// The geometry of the white plate, signed angles in degrees.
const WHITE_GEOMETRY: (i32, i32) = (0, 45);
/// The one geometry at which the instrument says "noisy" (code 30).
const NOISY_GEOMETRY: (i32, i32) = (-60, 40);
/// What one record takes, s: the simulated clock, which starts with the century.
const SECONDS_PER_RECORD: usize = 20;

/// A record and where it stands in the manifest.
#[derive(Debug)]
struct Record {
    file: String,
    role: &'static str,
    /// Signed angles, degrees; a dark record has none.
    angles: Option<(i32, i32)>,
    repeat: usize,
    reading: Reading,
}

/// How an object is looked at.
#[derive(Debug)]
pub(crate) struct Setup<'a> {
    /// What shines on it.
    pub(crate) lamp: &'a Lamp,
    /// Signed angles of incidence and viewing, degrees, in the order of acquisition.
    pub(crate) geometries: Vec<(i32, i32)>,
    /// True where the white plate is read, too, so that there is something to divide by.
    pub(crate) with_white: bool,
}

impl<'a> Setup<'a> {
    /// All directions in the plane under a lamp, and the white plate.
    pub(crate) fn whole(lamp: &'a Lamp) -> Self {
        Self { lamp, geometries: geometries().collect(), with_white: true }
    }
}

/// A simulated scan.
#[derive(Debug)]
pub(crate) struct Scan {
    title: &'static str,
    lamp: &'static str,
    with_white: bool,
    /// In the order of acquisition.
    records: Vec<Record>,
    truth: serde_json::Value,
}

impl Scan {
    /// Simulates an object as `setup` looks at it; `number` chooses the noise.
    pub(crate) fn simulate(setup: &Setup<'_>, number: usize, object: &Object) -> Self {
        let spectra = Spectra::of(object, setup.lamp);
        let mut scan = Self {
            title: object.title,
            lamp: setup.lamp.title,
            with_white: setup.with_white,
            records: Vec::new(),
            truth: truth::truth(object, &spectra),
        };
        let dark = vec![0.0; WAVELENGTHS];
        scan.take(number, "dark_1", "dark", None, 1, &dark);
        scan.take_whites(number, 1..=WHITES, &spectra);
        for &(theta_i, theta_v) in &setup.geometries {
            let radiance = spectra.radiance(object, f64::from(theta_i), f64::from(theta_v));
            scan.take(number, &format!("ti{theta_i}_tv{theta_v}"), "sample", Some((theta_i, theta_v)), 1, &radiance);
        }
        scan.take_whites(number, WHITES + 1..=2 * WHITES, &spectra);
        scan.take(number, "dark_2", "dark", None, 2, &dark);
        scan
    }

    fn take_whites(&mut self, number: usize, repeats: RangeInclusive<usize>, spectra: &Spectra) {
        if self.with_white {
            let white = spectra.white_radiance(f64::from(WHITE_GEOMETRY.0));
            for repeat in repeats {
                self.take(number, &format!("white_{repeat}"), "white", Some(WHITE_GEOMETRY), repeat, &white);
            }
        }
    }

    fn take(
        &mut self,
        number: usize,
        name: &str,
        role: &'static str,
        angles: Option<(i32, i32)>,
        repeat: usize,
        radiance: &[f64],
    ) {
        let noisy = role == "sample" && angles == Some(NOISY_GEOMETRY);
        let reading = Reading::take(radiance, noisy, &mut Random::of(number, self.records.len()));
        self.records.push(Record { file: format!("raw/{name}.txt"), role, angles, repeat, reading });
    }

    /// Writes `scan.csv`, `truth.json` and the records below `raw/`.
    ///
    /// # Errors
    /// What the file system says.
    pub(crate) fn write(&self, folder: &Path) -> io::Result<()> {
        fs::create_dir_all(folder.join("raw"))?;
        for record in &self.records {
            fs::write(folder.join(&record.file), record.reading.d5_text())?;
        }
        fs::write(folder.join("scan.csv"), self.manifest())?;
        fs::write(folder.join("truth.json"), format!("{:#}\n", self.truth))
    }

    fn manifest(&self) -> String {
        let mut text = format!(
            "# title: Simulated scan: {title}\n\
             # sample: {title}\n\
             # simulated: true\n\
             # angles: signed, mirror-at-equal\n\
             # instrument: PR-650 (simulated)\n\
             # light: {}\n\
             # part: total\n",
            self.lamp,
            title = self.title,
        );
        if self.with_white {
            text.push_str(&format!(
                "# reference: fixed-geometry({},{})\n\
                 # reference-light: same\n\
                 # certified-factor: {WHITE_FACTOR}\n\
                 # certified-relative-uncertainty: 0.005\n",
                WHITE_GEOMETRY.0, WHITE_GEOMETRY.1,
            ));
        }
        text.push_str("file,record,role,theta_i_deg,theta_v_deg,repeat,time,exposure_ms\n");
        for (order, record) in self.records.iter().enumerate() {
            let angles = record.angles.map_or(",".to_owned(), |(i, v)| format!("{i},{v}"));
            let (file, role, repeat) = (&record.file, record.role, record.repeat);
            let (time, exposure) = (clock(order), record.reading.exposure_ms);
            text.push_str(&format!("{file},1,{role},{angles},{repeat},{time},{exposure}\n"));
        }
        text
    }
}

/// The 17 x 17 signed angles without the retro diagonal, the incidence slowest.
fn geometries() -> impl Iterator<Item = (i32, i32)> {
    let angles = || (-80..=80).step_by(10);
    angles().flat_map(move |i| angles().filter(move |v| *v != -i).map(move |v| (i, v)))
}

/// The simulated clock, RFC 3339.
fn clock(order: usize) -> String {
    let seconds = order * SECONDS_PER_RECORD;
    format!("2000-01-01T{:02}:{:02}:{:02}Z", 9 + seconds / 3600, seconds / 60 % 60, seconds % 60)
}
