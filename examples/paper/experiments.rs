//! What is looked at under which lamp.

use std::path::Path;
use std::{fs, io};

use crate::lamps::{ARTIFICIAL_SUN, BLACK_LIGHT, INCANDESCENT};
use crate::scan::lamp::{DIODES, Lamp};
use crate::scan::objects::{OBJECTS, Object};
use crate::scan::{Scan, Setup};
use crate::yellow_paint::YELLOW_PAINT;

/// The folder of scans under the 375 nm diode alone, as in the paper's section 2.
pub(crate) const UNDER_BLACK_LIGHT: &str = "black-light";
/// The folder of scans under a lamp with visible light, too, where surfaces also reflect.
pub(crate) const UNDER_WHITE_LIGHT: &str = "white-light";
/// The folder of the paint under two lamps, as in the paper's section 4.
const TWO_LAMPS: &str = "two-lamps";

/// One object under one lamp.
#[derive(Debug)]
pub(crate) struct Experiment {
    folder: String,
    object: &'static Object,
    setup: Setup<'static>,
}

/// What the paper measured, of the objects whose names are `wanted`, and each of them under visible light; and the paint.
pub(crate) fn of(wanted: impl Fn(&str) -> bool) -> Vec<Experiment> {
    let mut experiments = Vec::new();
    for object in OBJECTS.iter().filter(|object| wanted(object.name)) {
        if object.yield_at_centre > 0.0 {
            // Below the black light the white plate is beneath the floor of the instrument: there is nothing to divide by.
            let setup = Setup { with_white: false, ..Setup::whole(&BLACK_LIGHT) };
            experiments.push(Experiment::new(UNDER_BLACK_LIGHT, object.name, object, setup));
        }
        experiments.push(Experiment::new(UNDER_WHITE_LIGHT, object.name, object, Setup::whole(&DIODES)));
    }
    for (name, lamp) in [("incandescent", &INCANDESCENT), ("artificial-sun", &ARTIFICIAL_SUN)] {
        let setup = Setup { geometries: vec![(0, 45)], ..Setup::whole(lamp) };
        experiments.push(Experiment::new(TWO_LAMPS, name, &YELLOW_PAINT, setup));
    }
    experiments
}

/// Writes the raw records of the experiments, and the spectrum of the lamp, which another instrument is taken to have measured.
///
/// # Errors
/// What the file system says.
pub(crate) fn simulate(folder: &Path, experiments: &[Experiment]) -> io::Result<()> {
    for (number, experiment) in experiments.iter().enumerate() {
        let folder = folder.join(&experiment.folder);
        // From 1000 on, so that no noise is that of the scan in testdata.
        Scan::simulate(&experiment.setup, 1000 + number, experiment.object).write(&folder)?;
        fs::write(folder.join("lamp.csv"), spectrum(experiment.setup.lamp))?;
    }
    Ok(())
}

impl Experiment {
    fn new(group: &str, name: &str, object: &'static Object, setup: Setup<'static>) -> Self {
        Self { folder: format!("{group}/{name}"), object, setup }
    }
}

/// Two columns: nm, W m-2 nm-1.
fn spectrum(lamp: &Lamp) -> String {
    (300..=800).map(|nm| format!("{nm},{:.6e}\n", (lamp.irradiance)(f64::from(nm)))).collect()
}
