//! What a scan cannot tell, in its intervals, and data that say nothing, through fits of observations.

use bbrf::fit::{Bound, DataError, Fitter, GeometrySet, Loss, Observations, Observed, Side, Stop, Terms};
use bbrf::quantity::{Geometry, Reference, SignHabit};
use bbrf::terms::{Denominator, Distribution};
use ndarray::{Array2, ArrayView1, Axis};
use proptest::prelude::*;

use crate::fits::{BOTH, paper_sphere, set};
use crate::scans::{Random, Truth, measure, paper_grid};

const LOSSES: [Loss; 3] = [Loss::Squares, Loss::Huber, Loss::Tukey];

fn observe(set: &GeometrySet, values: &[f64], sigma: Option<&[f64]>, loss: Loss) -> Result<Observed, DataError> {
    let row = |values| ArrayView1::from(values).insert_axis(Axis(0));
    let data = Observations { values: row(values), sigma: sigma.map(row), bounds: &[], loss };
    Fitter::new(set, BOTH).fit_observed(&data, 0.95)
}

/// A curvature on the edge of the box is no uncertainty, and an interval that ended there would deny what lies beyond.
#[test]
fn an_interval_whose_parameter_ended_on_its_bound_is_open_there_and_closed_on_the_other_side() {
    let grid = paper_grid();
    let set = set(&grid);
    let metal = Truth { index_minus_one: 30.0, intensity: 2.0, ..paper_sphere() };
    let (values, sigma) = measure(&metal, &grid, 0.02, &mut Random::new(1));
    for loss in LOSSES {
        let Observed { fit, intervals, .. } = observe(&set, &values, Some(&sigma), loss).unwrap();
        assert_eq!((fit.stop, fit.at_bound), (Stop::AtBound, [false, true]), "{}", loss.name());
        let index = intervals.index_minus_one.unwrap();
        assert!(index.high_open && !index.low_open && index.contains(30.0), "{}: {index:?}", loss.name());
        assert!(index.low > 1.0, "{}: {index:?}", loss.name());
    }
}

/// F is F(0) everywhere: any index will do, and so will any intensity.
#[test]
fn a_co_located_scan_has_open_intervals_of_index_and_intensity() {
    let grid: Vec<_> = (0..9)
        .flat_map(|step| {
            let theta = 10.0 * f64::from(step);
            [(theta, 0.0), (theta, 90.0), (theta, 180.0)]
        })
        .map(|(theta, phi)| Geometry::from_degrees(theta, phi, theta, phi).unwrap())
        .collect();
    let truth = Truth { albedo: 0.5, intensity: 20.0, roughness: 0.3, index_minus_one: 0.5 };
    let (values, sigma) = measure(&truth, &grid, 0.01, &mut Random::new(3));
    let set = set(&grid);
    for loss in LOSSES {
        let intervals = observe(&set, &values, Some(&sigma), loss).unwrap().intervals;
        let (index, intensity) = (intervals.index_minus_one.unwrap(), intervals.intensity.unwrap());
        assert!(index.low_open && index.high_open, "{}: {index:?}", loss.name());
        assert!(intensity.low_open && intensity.high_open, "{}: {intensity:?}", loss.name());
        let (diffuse, roughness) = (intervals.diffuse.unwrap(), intervals.roughness.unwrap());
        assert!(diffuse.is_closed() && roughness.is_closed(), "{}: {diffuse:?} {roughness:?}", loss.name());
    }
}

/// Below 30 degrees the data do not contradict an index of 6: at 3 % noise a symmetric uncertainty would.
#[test]
fn a_scan_near_the_normal_has_an_open_interval_of_the_index() {
    let is_near = |g: &Geometry| g.incidence.theta_deg() <= 30.0 && g.viewing.theta_deg() <= 30.0;
    let grid: Vec<Geometry> = paper_grid().into_iter().filter(is_near).collect();
    let set = set(&grid);
    for loss in LOSSES {
        let truth = Truth { albedo: 0.5, intensity: 3.0, roughness: 0.1, index_minus_one: 0.5 };
        let (values, sigma) = measure(&truth, &grid, 0.03, &mut Random::new(5));
        let index = observe(&set, &values, Some(&sigma), loss).unwrap().intervals.index_minus_one.unwrap();
        assert!(!index.is_closed() && index.contains(0.5), "{}: {index:?}", loss.name());
    }
}

#[test]
fn without_a_specular_term_there_is_no_interval_of_index_roughness_and_intensity() {
    let grid = paper_grid();
    let set = set(&grid);
    let matt = Truth { intensity: 0.0, ..paper_sphere() };
    let (values, sigma) = measure(&matt, &grid, 0.01, &mut Random::new(14));
    for loss in LOSSES {
        let Observed { fit, intervals, .. } = observe(&set, &values, Some(&sigma), loss).unwrap();
        assert!(!fit.has_specular());
        assert_eq!((intervals.roughness, intervals.index_minus_one, intervals.intensity), (None, None, None));
        let diffuse = intervals.diffuse.unwrap();
        assert!(diffuse.is_closed() && diffuse.contains(0.8), "{}: {diffuse:?}", loss.name());
    }
}

/// 0/0 and N - p < 0 somewhere; a median of nothing, a scale of 0.
#[test]
fn observations_that_say_nothing_are_refused_with_the_reason() {
    let grid = paper_grid();
    let set = set(&grid);
    for loss in LOSSES {
        for (value, sigma) in
            [(f64::NAN, 0.01), (0.5, 0.0), (0.5, -1.0), (0.5, f64::NAN), (0.5, f64::INFINITY), (f64::INFINITY, 0.01)]
        {
            let error = observe(&set, &[value; 272], Some(&[sigma; 272]), loss).unwrap_err();
            let DataError::TooFew { usable: 0, parameters: 4, left_out } = error else { panic!("{error:?}") };
            assert_eq!(left_out.total(), 272, "{value} {sigma}");
        }
        let mut four = vec![f64::NAN; 272];
        four[..4].fill(0.5);
        assert!(matches!(observe(&set, &four, None, loss), Err(DataError::TooFew { usable: 4, .. })));
        let length = Err(DataError::Length { found: 0, expected: 272 });
        assert_eq!(observe(&set, &[], None, loss), length);
        let (values, two) = (Array2::from_elem((2, 272), 0.5), Array2::from_elem((1, 272), 0.5));
        let data = Observations { values: values.view(), sigma: Some(two.view()), bounds: &[], loss };
        let error = Fitter::new(&set, BOTH).fit_observed(&data, 0.95).unwrap_err();
        assert_eq!(error, DataError::Rows { found: 1, expected: 2 });
        let none = Array2::zeros((0, 272));
        let data = Observations { values: none.view(), sigma: None, bounds: &[], loss };
        let error = Fitter::new(&set, BOTH).fit_observed(&data, 0.95).unwrap_err();
        assert!(matches!(error, DataError::TooFew { usable: 0, .. }), "{error:?}");
    }
}

/// One angle a hundred times, all values equal, all 0, each twice: without a spread there is no scale to weigh by.
#[test]
fn observations_without_variety_or_noise_have_finite_amplitudes() {
    let one = vec![Geometry::from_signed(20.0, 10.0, SignHabit::MirrorAtEqual).unwrap(); 100];
    let twice = paper_grid().repeat(2);
    for (grid, value) in [(one.clone(), 0.7), (one, 0.0), (paper_grid(), 0.7), (paper_grid(), 0.0), (twice, 0.7)] {
        let set = set(&grid);
        for loss in LOSSES {
            for sigma in [None, Some(vec![0.01; grid.len()])] {
                let values = vec![value; grid.len()];
                let fit = observe(&set, &values, sigma.as_deref(), loss).unwrap().fit;
                assert!(fit.chi_square.is_finite() && fit.bands[0].diffuse.is_finite(), "{} {fit:?}", loss.name());
                assert!(fit.bands[0].diffuse >= 0.0 && fit.bands[0].intensity >= 0.0, "{} {fit:?}", loss.name());
            }
        }
    }
}

#[test]
fn a_bound_without_a_place_or_a_weight_is_refused_by_name() {
    let grid = paper_grid();
    let set = set(&grid);
    let (values, sigma) = measure(&paper_sphere(), &grid, 0.01, &mut Random::new(15));
    let fitter = Fitter::new(&set, BOTH);
    let bound = Bound { emission: 0, geometry: 3, side: Side::AtMost, bound: 0.5, sigma: 0.01 };
    let observe = |bounds: &[Bound], sigma: Option<&[f64]>| {
        let row = |values| ArrayView1::from(values).insert_axis(Axis(0));
        let data = Observations { values: row(&values[..]), sigma: sigma.map(row), bounds, loss: Loss::Squares };
        fitter.fit_observed(&data, 0.95)
    };
    let problem = |result: Result<Observed, DataError>| match result {
        Err(DataError::Bound { problem, .. }) => problem,
        other => panic!("{other:?}"),
    };
    assert!(problem(observe(&[Bound { geometry: 272, ..bound }], Some(&sigma))).contains("no such value"));
    assert!(problem(observe(&[Bound { emission: 1, ..bound }], Some(&sigma))).contains("no such value"));
    assert!(problem(observe(&[bound, bound], Some(&sigma))).contains("another bound"));
    assert!(problem(observe(&[bound], None)).contains("no uncertainties"));
    let huge = observe(&[Bound { bound: 1e200, ..bound }], Some(&sigma));
    assert!(matches!(huge, Err(DataError::OutOfRange { .. })), "{huge:?}");
    // What is no number, or has no weight, is left out as a value would be.
    for bad in [Bound { bound: f64::NAN, ..bound }, Bound { sigma: 0.0, ..bound }, Bound { sigma: -1.0, ..bound }] {
        let fit = observe(&[bad], Some(&sigma)).unwrap().fit;
        assert_eq!((fit.left_out.total(), fit.degrees_of_freedom), (1, 267.0), "{bad:?}");
    }
}

fn any_number() -> impl Strategy<Value = f64> {
    prop_oneof![
        4 => 0.0..3.0_f64,
        1 => any::<f64>(),
        1 => prop_oneof![Just(0.0), Just(-0.0), Just(f64::NAN), Just(f64::INFINITY), Just(1e-300), Just(1e59)],
    ]
}

fn any_bound() -> impl Strategy<Value = Bound> {
    (0..3_usize, 0..14_usize, any::<bool>(), any_number(), any_number()).prop_map(
        |(emission, geometry, up, bound, sigma)| {
            let side = if up { Side::AtLeast } else { Side::AtMost };
            Bound { emission, geometry, side, bound, sigma }
        },
    )
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, ..ProptestConfig::default() })]

    /// Whatever is observed: a fit with finite amplitudes, or an error; never a panic, never a negative amplitude.
    #[test]
    fn whatever_is_observed_is_fitted_or_refused(
        angles in prop::collection::vec((-90.0..90.0_f64, -90.0..90.0_f64), 1..14),
        numbers in prop::collection::vec(any_number(), 28),
        uncertainties in prop::option::of(prop::collection::vec(any_number(), 28)),
        bounds in prop::collection::vec(any_bound(), 0..5),
        (emissions, loss, specular) in (1..3_usize, 0..3_usize, any::<bool>()),
    ) {
        let grid: Vec<Geometry> =
            angles.iter().map(|(i, v)| Geometry::from_signed(*i, *v, SignHabit::MirrorAtEqual).unwrap()).collect();
        let form = (Distribution::GaussianHalfHeight, Denominator::CosThetaI);
        let Ok(set) = GeometrySet::new(&grid, &Reference::SameGeometry, form.0, form.1) else { return Ok(()) };
        let array = |list: &[f64]| Array2::from_shape_fn((emissions, grid.len()), |(e, g)| list[e * grid.len() + g]);
        let (values, sigma) = (array(&numbers), uncertainties.as_deref().map(array));
        let sigma = sigma.as_ref().map(|sigma| sigma.view());
        let data = Observations { values: values.view(), sigma, bounds: &bounds, loss: LOSSES[loss] };
        let fitter = Fitter::new(&set, Terms { diffuse: true, specular });
        if let Ok(observed) = fitter.fit_observed(&data, 0.95) {
            for band in &observed.fit.bands {
                prop_assert!(band.diffuse.is_finite() && band.diffuse >= 0.0, "{observed:?}");
                prop_assert!(band.intensity.is_finite() && band.intensity >= 0.0, "{observed:?}");
            }
            prop_assert!(observed.fit.chi_square >= 0.0, "{observed:?}");
        }
    }
}
