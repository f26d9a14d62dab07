//! Of a hundred clean files one raises an alarm of physics, however many values it holds: noise alone, on values that lie
//! on the edge of what nature allows, seen by the validator as it is called. `BBRF_TRIALS` sets the number of files.
#![cfg(feature = "write")]
#![allow(clippy::unwrap_used, reason = "a test")]

#[path = "../conformance/mod.rs"]
mod conformance;
#[path = "common/scans.rs"]
mod scans;

use bbrf::container::document_bytes;
use bbrf::dataset::Document;
use bbrf::validate::validate_bytes;
use scans::Random;

/// Standard uncertainty of every value.
const SIGMA: f64 = 0.002;

/// The clean file with noise in place of its values: an elastic scan that is reciprocal, symmetric and steady, and a density
/// of a surface that does not fluoresce. `shift` departs from it at one value, in standard uncertainties.
fn noisy(random: &mut Random, shift: f64) -> Document {
    let mut document = conformance::clean();
    document.models.clear();
    for (index, level) in [(1, 0.4), (2, 0.0)] {
        let measurement = &mut document.measurements[index];
        let shape = measurement.values.dim();
        measurement.uncertainty.components.clear();
        measurement.uncertainty.standard = Some(ndarray::ArcArray2::from_elem(shape, SIGMA));
        measurement.flags = ndarray::ArcArray2::zeros(shape);
        measurement.values = ndarray::ArcArray2::from_shape_simple_fn(shape, || level + SIGMA * random.normal());
    }
    document.measurements[2].values[(0, 0)] -= shift * SIGMA;
    document
}

fn alarms(document: &Document) -> Vec<&'static str> {
    let report = validate_bytes(document_bytes(document).unwrap().0);
    let rules = report.findings.iter().map(|finding| finding.rule);
    rules.filter(|rule| rule.contains(":physics.")).collect()
}

#[test]
fn noise_alone_raises_one_alarm_in_a_hundred_files() {
    let files: usize = std::env::var("BBRF_TRIALS").ok().and_then(|text| text.parse().ok()).unwrap_or(200);
    let mut random = Random::new(20_261_122);
    let alarmed: Vec<_> =
        (0..files).map(|_| alarms(&noisy(&mut random, 0.0))).filter(|rules| !rules.is_empty()).collect();
    // One in a hundred, and four standard deviations of a count.
    let expected = files as f64 / 100.0;
    println!("{} of {files} files: {alarmed:?}", alarmed.len());
    assert!(alarmed.len() as f64 <= expected + 4.0 * expected.sqrt(), "{alarmed:?}");
    // The comparisons were made: the same noise with one value ten uncertainties below nothing.
    assert!(alarms(&noisy(&mut random, 10.0)).contains(&"bbrf:1.0:physics.negative"));
}
