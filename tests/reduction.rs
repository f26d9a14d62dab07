//! A band of a factor is a ratio of sums; V(lambda) is the CIE's; what cannot be reduced says why.
#![allow(clippy::unwrap_used)]

use bbrf::dataset::{
    Acquisition, Bound, Derivation, Document, Id, Mask, Measurement, ReduceError, Reduction, Role, Side, reduce,
};
use bbrf::quantity::{
    Band, Bandpass, Component, CorrelatedOver, EmissionAxis, Flag, Geometry, Part, Quantity, QuantityKind, Reference,
    SignHabit, Uncertainty, WavelengthAxis,
};
use ndarray::{Array2, array};

fn measurement(id: &str, kind: QuantityKind, role: Role, nm: &[f64], values: Array2<f64>) -> Measurement {
    let rows = values.nrows() as u32;
    let geometry = |k: u32| Geometry::from_signed(10.0 * f64::from(k % 9), 20.0, SignHabit::MirrorAtEqual).unwrap();
    let emission = EmissionAxis::Wavelengths(WavelengthAxis::new(nm.to_vec(), Bandpass::Unstated).unwrap());
    let acquisitions = (0..rows).map(|k| Acquisition::at(Some(geometry(k)), k)).collect();
    Measurement::new(Id::new(id).unwrap(), role, Quantity::absolute(kind, Part::Total), emission, acquisitions, values)
}

/// Two rows, three wavelengths; the white radiates 1, 2, 5 and is certified at 0.5.
fn scan() -> Document {
    let nm = [500.0, 510.0, 520.0];
    let white = measurement("white", QuantityKind::SpectralRadiance, Role::White, &nm, array![[1.0, 2.0, 5.0]]);
    let radiance = measurement(
        "radiance",
        QuantityKind::SpectralRadiance,
        Role::Sample,
        &nm,
        array![[1.0, 1.0, 1.0], [2.0, 0.0, 4.0]],
    );
    let mut factor =
        measurement("scan", QuantityKind::RadianceFactor, Role::Sample, &nm, array![[0.5, 0.25, 0.1], [1.0, 0.0, 0.4]]);
    factor.quantity.reference = Reference::FixedGeometry { theta_i_deg: 0.0, theta_v_deg: 45.0 };
    factor.quantity.certified_factor = vec![0.5];
    factor.derivation = Some(Derivation {
        numerator: Id::new("radiance").unwrap(),
        numerator_row: vec![0, 1],
        reference: Id::new("white").unwrap(),
        reference_group: vec![0],
        row_reference: vec![0, 0],
        dark: None,
    });
    Document { measurements: vec![white, radiance, factor], ..Document::default() }
}

fn band(from_nm: f64, to_nm: f64) -> Reduction {
    Reduction::Band(Band { from_nm, to_nm })
}

#[test]
fn a_band_is_a_ratio_of_sums() {
    let document = scan();
    let reduced = reduce(&document, document.measurement("scan").unwrap(), band(500.0, 520.0)).unwrap();
    // sum of sample radiances over sum of white radiances, times the certified factor.
    assert!((reduced.values[(0, 0)] - 0.5 * 3.0 / 8.0).abs() < 1e-15);
    assert!((reduced.values[(0, 1)] - 0.5 * 6.0 / 8.0).abs() < 1e-15);
    assert_eq!(reduced.reduction, "band:500-520");
    assert_eq!(reduced.kind, QuantityKind::BandRadianceFactor);
}

#[test]
fn the_default_band_is_where_the_signal_exceeds_a_tenth_of_its_peak() {
    let nm: Vec<f64> = (0..9).map(|k| 500.0 + 10.0 * f64::from(k)).collect();
    let spectrum = [0.05, 0.2, 0.6, 1.0, 0.5, 0.11, 0.09, 0.5, 0.0];
    let values = Array2::from_shape_fn((2, 9), |(row, k)| spectrum[k] * (row + 1) as f64);
    let measurement = measurement("m", QuantityKind::SpectralRadiance, Role::Sample, &nm, values);
    let document = Document { measurements: vec![measurement], ..Document::default() };
    let reduced = reduce(&document, &document.measurements[0], Reduction::Auto).unwrap();
    // The run around the peak: the second hump behind a gap is not part of it.
    assert_eq!(reduced.reduction, "band:510-550");
    assert!((reduced.values[(0, 0)] - 10.0 * 2.41).abs() < 1e-12, "a radiance is summed times its step");
    assert_eq!(reduced.kind, QuantityKind::BandRadiance);
}

#[test]
fn luminance_weights_with_the_efficiency_of_the_eye() {
    let nm: Vec<f64> = (0..401).map(|k| 380.0 + f64::from(k)).collect();
    let values = Array2::from_elem((1, 401), 1.0);
    let measurement = measurement("m", QuantityKind::SpectralRadiance, Role::Sample, &nm, values);
    let document = Document { measurements: vec![measurement], ..Document::default() };
    let reduced = reduce(&document, &document.measurements[0], Reduction::Luminance).unwrap();
    // The integral of V(lambda) is 106.857 nm (CIE 018:2019), times 683 lm/W.
    let expected = 683.002 * 106.857;
    assert!((reduced.values[(0, 0)] / expected - 1.0).abs() < 1e-4, "{}", reduced.values[(0, 0)] / 683.002);
    assert_eq!(reduced.kind, QuantityKind::Luminance);
}

#[test]
fn a_flagged_value_is_never_a_value() {
    let mut document = scan();
    document.measurements[2].flags[(1, 2)] = Flag::Saturated.bit();
    let reduced = reduce(&document, document.measurement("scan").unwrap(), band(500.0, 520.0)).unwrap();
    assert_eq!((reduced.rows, reduced.left_out), (vec![0], 1));
    document.measurements[2].flags.fill(Flag::BelowDetection.bit());
    let error = reduce(&document, document.measurement("scan").unwrap(), band(500.0, 520.0)).unwrap_err();
    assert!(matches!(error, ReduceError::EmptyBand { .. }), "{error}");
}

#[test]
fn the_scale_of_a_record_is_independent_between_rows_and_the_white_is_shared() {
    let mut document = scan();
    document.measurements[2].uncertainty = Uncertainty {
        standard: Some(ndarray::ArcArray2::zeros((2, 3))),
        components: vec![
            Component::new("record scale", vec![0.01], CorrelatedOver::Wavelengths),
            Component::new("certificate", vec![0.02], CorrelatedOver::All),
        ],
        ..Uncertainty::default()
    };
    let reduced = reduce(&document, document.measurement("scan").unwrap(), band(500.0, 520.0)).unwrap();
    let sigma = reduced.sigma.unwrap();
    assert!((sigma[(0, 1)] / reduced.values[(0, 1)] - 0.01).abs() < 1e-15);
    assert!((reduced.shared_relative[0] - 0.02).abs() < 1e-15);
}

#[test]
fn a_factor_without_its_reference_says_what_its_band_means() {
    let mut document = scan();
    document.measurements[2].derivation = None;
    let reduced = reduce(&document, document.measurement("scan").unwrap(), band(500.0, 520.0)).unwrap();
    assert!((reduced.values[(0, 0)] - (0.5 + 0.25 + 0.1) / 3.0).abs() < 1e-15);
    assert!(reduced.notes[0].contains("equal-energy"), "{:?}", reduced.notes);
}

#[test]
fn every_wavelength_keeps_its_gaps() {
    let mut document = scan();
    document.measurements[2].flags[(1, 2)] = Flag::Saturated.bit();
    let reduced = reduce(&document, document.measurement("scan").unwrap(), Reduction::None).unwrap();
    assert_eq!(reduced.values.dim(), (3, 2));
    assert!(reduced.values[(2, 1)].is_nan() && reduced.values[(2, 0)] == 0.1);
}

#[test]
fn reductions_are_spelled_as_on_the_command_line() {
    assert_eq!("band:500-620".parse::<Reduction>(), Ok(band(500.0, 620.0)));
    for wrong in ["band:620-500", "band:500", "band:a-b", "v", "band:0-500"] {
        let error = wrong.parse::<Reduction>().unwrap_err();
        assert!(error.to_string().contains("luminance"), "{error}");
    }
}

/// Where the floor is a number with an uncertainty, it is a bound to be fitted; where it is not, the wavelength is lost.
#[test]
fn a_wavelength_that_the_floor_truncates_keeps_its_bounds_or_is_left_out_and_said() {
    // A signal in units of its noise in forty rows, how many of them are on the floor, and what stands for the floor.
    let scan = |signal: f64, below: usize, floor: f64| {
        let mut measurement = measurement(
            "m",
            QuantityKind::SpectralRadiance,
            Role::Sample,
            &[400.0, 500.0],
            Array2::from_shape_fn((40, 2), |(_, column)| if column == 0 { signal } else { 100.0 }),
        );
        measurement.uncertainty.standard = Some(ndarray::ArcArray2::ones((40, 2)));
        for row in 0..below {
            measurement.values[(row, 0)] = floor;
            measurement.flags[(row, 0)] = Flag::BelowDetection.bit();
        }
        Document { measurements: vec![measurement], ..Document::default() }
    };
    let columns = |document: &Document| {
        let reduced = reduce(document, &document.measurements[0], Reduction::None).unwrap();
        (reduced.emission.wavelengths().unwrap().to_vec(), reduced.left_out_emission, reduced.notes)
    };
    let (nm, left_out, notes) = columns(&scan(1.5, 3, f64::NAN));
    assert_eq!((nm, left_out), (vec![500.0], 1));
    assert!(
        notes[0].starts_with("1 of 2 emission values get no model") && notes[0].contains("400 nm (3)"),
        "{notes:?}"
    );
    assert_eq!(columns(&scan(15.0, 3, f64::NAN)).0, [400.0, 500.0], "far above the floor little is missing");
    assert_eq!(columns(&scan(1.5, 0, 1.0)).2, Vec::<String>::new());
    let bounded = scan(1.5, 3, 1.0);
    assert_eq!(columns(&bounded).0, [400.0, 500.0]);
    let reduced = reduce(&bounded, &bounded.measurements[0], Reduction::None).unwrap();
    let expected =
        [0, 1, 2].map(|geometry| Bound { emission: 0, geometry, side: Side::AtMost, bound: 1.0, sigma: 1.0 });
    assert_eq!(reduced.bounds, expected);
    assert!(expected.iter().all(|bound| reduced.values[(0, bound.geometry)].is_nan()), "a bound is no value");
    let mut dark = scan(1.5, 3, f64::NAN);
    dark.measurements[0].values.fill(f64::NAN);
    dark.measurements[0].flags.fill(Flag::BelowDetection.bit());
    let error = reduce(&dark, &dark.measurements[0], Reduction::None).unwrap_err();
    assert!(matches!(error, ReduceError::Truncated { .. }) && error.to_string().contains("500 nm (40)"), "{error}");
}

#[test]
fn a_saturated_value_is_a_lower_bound() {
    let mut document = scan();
    document.measurements[2].uncertainty.standard = Some(ndarray::ArcArray2::from_elem((2, 3), 0.01));
    document.measurements[2].flags[(1, 2)] = Flag::Saturated.bit();
    let reduced = reduce(&document, document.measurement("scan").unwrap(), Reduction::None).unwrap();
    let bound = document.measurements[2].values[(1, 2)];
    assert_eq!(reduced.bounds, [Bound { emission: 2, geometry: 1, side: Side::AtLeast, bound, sigma: 0.01 }]);
}

#[test]
fn masks_say_what_they_hide_and_hide_it() {
    let mut document = scan();
    document.measurements[2].acquisitions[1].geometry = Some(Geometry::from_degrees(75.0, 180.0, 10.0, 0.0).unwrap());
    for (text, hidden) in
        [("theta-i>70", vec![1]), ("rows:0", vec![0]), ("rows:0-1,theta-v>89", vec![0, 1]), ("", vec![])]
    {
        let mask: Mask = text.parse().unwrap();
        assert_eq!(mask.to_string(), text);
        let mut reduced = reduce(&document, document.measurement("scan").unwrap(), Reduction::None).unwrap();
        assert_eq!(reduced.apply(&mask), hidden.len());
        for row in 0..2 {
            assert_eq!(reduced.values.column(row).iter().all(|value| value.is_nan()), hidden.contains(&row), "{text}");
        }
    }
    for wrong in ["theta>3", "rows:3-1", "rows:x", "theta-i>far", "nonsense"] {
        assert!(wrong.parse::<Mask>().unwrap_err().to_string().contains("half-angle>DEGREES"), "{wrong}");
    }
}

#[test]
fn what_cannot_be_reduced_reads_as_a_sentence() {
    let mut document = scan();
    document.measurements[2].acquisitions.iter_mut().for_each(|row| row.geometry = None);
    let error = reduce(&document, document.measurement("scan").unwrap(), Reduction::None).unwrap_err();
    let text = error.to_string();
    assert!(text.ends_with("none of its 2 rows has a known geometry and a usable value at any wavelength"), "{text}");
}

/// A factor that is bright everywhere, and below detection in most rows at 520 nm.
#[test]
fn the_default_band_stops_where_most_rows_have_no_value() {
    let nm: Vec<f64> = (0..5).map(|k| 480.0 + 10.0 * f64::from(k)).collect();
    let mut scan = measurement("scan", QuantityKind::RadianceFactor, Role::Sample, &nm, Array2::from_elem((9, 5), 0.5));
    for row in 0..6 {
        scan.values[(row, 4)] = f64::NAN;
        scan.flags[(row, 4)] = Flag::BelowDetection.bit();
    }
    scan.quantity.reference = Reference::SameGeometry;
    let document = Document { measurements: vec![scan], ..Document::default() };
    let reduced = reduce(&document, &document.measurements[0], Reduction::Auto).unwrap();
    assert_eq!((reduced.reduction.as_str(), reduced.left_out), ("band:480-510", 0));
}

#[test]
fn one_wavelength_is_fitted_as_it_is() {
    let scan =
        measurement("scan", QuantityKind::RadianceFactor, Role::Sample, &[550.0], Array2::from_elem((9, 1), 0.5));
    let document = Document { measurements: vec![scan], ..Document::default() };
    let reduced = reduce(&document, &document.measurements[0], Reduction::Auto).unwrap();
    assert_eq!(reduced.reduction, "none");
}

#[test]
fn rows_lost_below_detection_are_counted_and_named_as_truncation() {
    let mut document = scan();
    document.measurements[2].flags[(1, 2)] = Flag::BelowDetection.bit();
    let reduced = reduce(&document, document.measurement("scan").unwrap(), band(500.0, 520.0)).unwrap();
    assert_eq!((reduced.rows.as_slice(), reduced.left_out), ([0].as_slice(), 1));
    let said = reduced.notes.iter().any(|note| note.contains("1 of 2 rows") && note.contains("truncated"));
    assert!(said, "{:?}", reduced.notes);
}
