//! From a measurement to a model: what a user reads of a fit is true.
#![allow(unreachable_pub, clippy::unwrap_used)]

mod common {
    pub mod documents;
    pub mod scans;
}

use bbrf::dataset::{Document, Model, Reduction};
use bbrf::fit::{FitError, FitOptions, fit_measurement};
use bbrf::quantity::{Component, CorrelatedOver, Geometry, Part, Reference, SignHabit};
use bbrf::terms::TermKind;
use common::documents::scan_document;
use common::scans::{Random, Truth, measure, paper_grid};
use ndarray::Array2;

const FIXED: Reference = Reference::FixedGeometry { theta_i_deg: 0.0, theta_v_deg: 45.0 };

fn document(grid: &[Geometry], values: Vec<f64>, sigma: Option<Vec<f64>>, reference: Reference) -> Document {
    let column = |values: Vec<f64>| Array2::from_shape_vec((grid.len(), 1), values).unwrap();
    scan_document(grid, reference, column(values), sigma.map(column))
}

fn fit(document: &Document, options: &FitOptions) -> Result<Model, FitError> {
    fit_measurement(document, &document.measurements[0], options)
}

fn paper_sphere() -> Truth {
    Truth { albedo: 0.8, intensity: 30.0, roughness: 0.05, index_minus_one: 0.45 }
}

#[test]
fn a_model_holds_everything_that_is_needed_to_check_it() {
    let grid = paper_grid();
    let (values, sigma) = measure(&paper_sphere(), &grid, 0.01, &mut Random::new(1));
    let document = document(&grid, values, Some(sigma), FIXED);
    let model = fit(&document, &FitOptions { data_digest: "sha256:abc".into(), ..FitOptions::default() }).unwrap();
    assert!(model.converged);
    assert_eq!(model.data_digest, "sha256:abc");
    assert_eq!(model.residuals.count, 272);
    assert!((model.residuals.reduced_chi_square - 1.0).abs() < 0.3, "{}", model.residuals.reduced_chi_square);
    let names = [
        "lambertian.albedo",
        "torrance-sparrow.intensity",
        "torrance-sparrow.roughness",
        "torrance-sparrow.refractive_index",
    ];
    assert_eq!(model.covariance_parameters, names);
    let specular = &model.terms[1];
    for (k, parameter) in specular.parameters.iter().enumerate() {
        let variance = model.covariance[(0, k + 1, k + 1)];
        assert_eq!(parameter.standard_uncertainty[0], variance.sqrt(), "{}", parameter.name);
        let truth = [30.0, 0.05, 1.45][k];
        let off = (parameter.value[0] - truth) / parameter.standard_uncertainty[0];
        assert!(off.abs() < 4.0, "{}: {off} standard uncertainties off", parameter.name);
    }
    assert!(model.identifiability.is_empty(), "{:?}", model.identifiability);
}

#[test]
fn an_unstated_reference_refuses_unless_one_is_assumed_and_then_says_so() {
    let grid = paper_grid();
    let (values, sigma) = measure(&paper_sphere(), &grid, 0.01, &mut Random::new(1));
    let document = document(&grid, values, Some(sigma), Reference::Unstated);
    let error = fit(&document, &FitOptions::default()).unwrap_err();
    assert!(error.to_string().contains("same-geometry"), "{error}");
    let model = fit(&document, &FitOptions { assume_reference: Some(FIXED), ..FitOptions::default() }).unwrap();
    assert!(model.identifiability.iter().any(|finding| finding.contains("assumed")), "{:?}", model.identifiability);
}

#[test]
fn a_diffuser_is_reported_without_a_specular_term() {
    let grid = paper_grid();
    let truth = Truth { intensity: 0.0, ..paper_sphere() };
    let (values, sigma) = measure(&truth, &grid, 0.01, &mut Random::new(2));
    let document = document(&grid, values, Some(sigma), FIXED);
    let model = fit(&document, &FitOptions::default()).unwrap();
    assert_eq!(model.terms.len(), 1);
    assert!(model.identifiability.iter().any(|finding| finding.contains("no specular term seen")));
    let separability = model.separability.unwrap();
    assert!(separability.cosine_relative_rms < 0.01 && separability.constancy_relative_rms < 0.01, "{separability:?}");
    assert!(separability.rank_one_relative_rms < 0.015);
    assert!((separability.cosine_amplitude - 0.8).abs() < 0.01);
}

#[test]
fn a_highlight_is_not_separable() {
    let grid = paper_grid();
    let (values, sigma) = measure(&paper_sphere(), &grid, 0.01, &mut Random::new(2));
    let document = document(&grid, values, Some(sigma), FIXED);
    let separability = fit(&document, &FitOptions::default()).unwrap().separability.unwrap();
    assert!(separability.rank_one_relative_rms > 0.2, "{separability:?}");
}

#[test]
fn a_luminescent_factor_is_fitted_with_the_luminescent_term() {
    let grid = paper_grid();
    let truth = Truth { intensity: 0.0, ..paper_sphere() };
    let (values, sigma) = measure(&truth, &grid, 0.01, &mut Random::new(2));
    let mut document = document(&grid, values, Some(sigma), FIXED);
    document.measurements[0].quantity.part = Part::Luminescent;
    let model = fit(&document, &FitOptions::default()).unwrap();
    assert_eq!(model.terms[0].kind, TermKind::Luminescent);
    let both = vec![TermKind::Lambertian, TermKind::Luminescent];
    let error = fit(&document, &FitOptions { terms: both, ..FitOptions::default() }).unwrap_err();
    assert_eq!(error, FitError::TwoDiffuseTerms);
}

#[test]
fn what_all_values_share_is_kept_apart() {
    let grid = paper_grid();
    let (values, sigma) = measure(&paper_sphere(), &grid, 0.01, &mut Random::new(1));
    let mut document = document(&grid, values, Some(sigma), FIXED);
    let alone = fit(&document, &FitOptions::default()).unwrap();
    document.measurements[0].uncertainty.components.push(Component::new(
        "certificate",
        vec![0.02],
        CorrelatedOver::All,
    ));
    let shared = fit(&document, &FitOptions::default()).unwrap();
    assert_eq!(alone.covariance, shared.covariance);
    assert_eq!(shared.terms[0].parameters[0].shared_relative_uncertainty, [0.02]);
    assert!(shared.terms[1].parameters[1].shared_relative_uncertainty.is_empty(), "a roughness has no scale");
}

#[test]
fn a_scan_near_the_normal_says_that_it_cannot_know_the_index() {
    let grid: Vec<Geometry> =
        paper_grid().into_iter().filter(|g| g.incidence.theta_deg() <= 30.0 && g.viewing.theta_deg() <= 30.0).collect();
    let (values, sigma) = measure(&paper_sphere(), &grid, 0.01, &mut Random::new(4));
    let document = document(&grid, values, Some(sigma), FIXED);
    let model = fit(&document, &FitOptions::default()).unwrap();
    let finding = model.identifiability.iter().find(|finding| finding.starts_with("refractive index"));
    assert!(finding.is_some_and(|text| text.contains("measure beyond 60 degrees")), "{:?}", model.identifiability);
}

#[test]
fn without_uncertainties_the_residuals_give_the_scale_and_it_is_said() {
    let grid = paper_grid();
    let (values, _) = measure(&paper_sphere(), &grid, 0.01, &mut Random::new(1));
    let document = document(&grid, values, None, FIXED);
    let model = fit(&document, &FitOptions::default()).unwrap();
    assert!(model.identifiability[0].contains("no uncertainties"));
    assert!(model.residuals.reduced_chi_square.is_nan());
    assert!(model.terms[0].parameters[0].standard_uncertainty[0] > 0.0);
}

#[test]
fn nothing_to_fit_is_an_error_with_the_reason() {
    let geometry = Geometry::from_signed(0.0, 20.0, SignHabit::MirrorAtEqual).unwrap();
    let few = document(&[geometry; 3], vec![1.0, 1.1, 0.9], Some(vec![0.1; 3]), FIXED);
    let error = fit(&few, &FitOptions::default()).unwrap_err().to_string();
    assert!(error.contains("3 usable values for 4 parameters"), "{error}");
    let band = FitOptions { reduction: "band:500-600".parse::<Reduction>().unwrap(), ..FitOptions::default() };
    assert!(fit(&few, &band).unwrap_err().to_string().contains("--reduce"));
}

#[test]
fn what_is_left_out_is_named_and_counted_once() {
    let mut grid = paper_grid();
    let (mut values, sigma) = measure(&paper_sphere(), &grid, 0.01, &mut Random::new(1));
    let mut sigma = sigma;
    sigma[0] = 0.0;
    sigma[1] = f64::NAN;
    sigma[2] = f64::INFINITY;
    values[3] = f64::NAN;
    for (theta_i, theta_v) in [(90.0, 10.0), (100.0, 10.0)] {
        grid.push(Geometry::from_degrees(theta_i, 180.0, theta_v, 0.0).unwrap());
        values.push(0.5);
        sigma.push(0.01);
    }
    let over_same = |v: &f64, g: &Geometry| v / g.incidence.cos_theta().abs().max(0.1);
    let values: Vec<f64> = values.iter().zip(&grid).map(|(v, g)| over_same(v, g)).collect();
    let document = document(&grid, values, Some(sigma), Reference::SameGeometry);
    let model = fit(&document, &FitOptions::default()).unwrap();
    let said = |text: &str| model.identifiability.iter().any(|finding| finding.contains(text));
    for text in [
        "1 whose standard uncertainty (sigma) is 0",
        "2 whose standard uncertainty (sigma) is empty",
        "1 at a grazing geometry",
        "2 without a number that may be used",
    ] {
        assert!(said(text), "{text}: {:?}", model.identifiability);
    }
    assert_eq!((model.residuals.count, model.residuals.left_out), (274 - 6, 6));
}

#[test]
fn a_diffuse_term_keeps_the_grazing_values_that_a_specular_one_cannot_have() {
    let mut grid = paper_grid();
    grid.push(Geometry::from_degrees(90.0, 180.0, 10.0, 0.0).unwrap());
    let values: Vec<f64> = (0..grid.len()).map(|k| 0.5 + 0.001 * f64::from(k as u32 % 3)).collect();
    let document = document(&grid, values, Some(vec![0.01; 273]), Reference::SameGeometry);
    for terms in [vec![TermKind::Lambertian], Vec::new()] {
        let model = fit(&document, &FitOptions { terms, ..FitOptions::default() }).unwrap();
        assert_eq!((model.terms.len(), model.residuals.count, model.residuals.left_out), (1, 273, 0));
    }
}

#[test]
fn uncertainties_of_zero_throughout_are_named_in_the_refusal() {
    let grid = paper_grid();
    let (values, _) = measure(&paper_sphere(), &grid, 0.01, &mut Random::new(1));
    let document = document(&grid, values, Some(vec![0.0; 272]), FIXED);
    let error = fit(&document, &FitOptions::default()).unwrap_err().to_string();
    assert!(error.contains("272 whose standard uncertainty (sigma) is 0"), "{error}");
}

#[test]
fn a_parameter_on_its_bound_has_no_ordinary_uncertainty_and_it_is_said() {
    let grid = paper_grid();
    let on_bound = |model: &Model, term: usize, parameter: usize, text: &str| {
        assert!(model.identifiability.iter().any(|finding| finding.contains(text)), "{:?}", model.identifiability);
        let parameter = &model.terms[term].parameters[parameter];
        assert!(parameter.standard_uncertainty[0].is_nan(), "{parameter:?}");
    };
    // An offset below zero asks for a negative albedo.
    let (values, _) = measure(&paper_sphere(), &grid, 0.0, &mut Random::new(1));
    let lowered = values.iter().map(|value| value - 1.0).collect();
    let model = fit(&document(&grid, lowered, Some(vec![0.01; 272]), FIXED), &FitOptions::default()).unwrap();
    assert_eq!(model.terms[0].parameters[0].value, [0.0]);
    on_bound(&model, 0, 0, "the amplitude of the diffuse term ended on its bound, 0");
    assert!(model.terms[1].parameters[0].standard_uncertainty[0] > 0.0, "the others have theirs");
    // An index beyond the searched box.
    let metal = Truth { index_minus_one: 30.0, intensity: 2.0, ..paper_sphere() };
    let (values, sigma) = measure(&metal, &grid, 0.001, &mut Random::new(1));
    let model = fit(&document(&grid, values, Some(sigma), FIXED), &FitOptions::default()).unwrap();
    on_bound(&model, 1, 2, "refractive index 6.0000 lies on the edge of the searched box");
    assert!(!model.converged);
}

#[test]
fn a_table_of_zeros_has_no_separability_and_says_why() {
    let grid = paper_grid();
    let document = document(&grid, vec![0.0; 272], Some(vec![0.01; 272]), FIXED);
    let model = fit(&document, &FitOptions::default()).unwrap();
    assert!(model.separability.is_none());
    let said = model.identifiability.iter().any(|finding| finding.contains("separability: undefined"));
    assert!(said, "{:?}", model.identifiability);
}

#[test]
fn whatever_the_magnitude_a_fit_is_finite_or_refused() {
    let grid = paper_grid();
    let (values, sigma) = measure(&paper_sphere(), &grid, 0.01, &mut Random::new(1));
    let mut fitted = 0;
    for exponent in (-300..=300).step_by(20) {
        let scale = 10_f64.powi(exponent);
        let scaled = |numbers: &[f64]| numbers.iter().map(|number| number * scale).collect::<Vec<f64>>();
        for sigma in [None, Some(sigma.clone()), Some(scaled(&sigma)), Some(vec![scale; 272])] {
            let Ok(model) = fit(&document(&grid, scaled(&values), sigma, FIXED), &FitOptions::default()) else {
                continue;
            };
            fitted += 1;
            let numbers = model.terms.iter().flat_map(|term| &term.parameters).flat_map(|parameter| &parameter.value);
            assert!(numbers.chain([&model.residuals.rms]).all(|number| number.is_finite()), "1e{exponent}: {model:?}");
        }
    }
    assert!(fitted > 10);
    let mut one_wild = values;
    one_wild[7] = 1e300;
    let error = fit(&document(&grid, one_wild, Some(sigma), FIXED), &FitOptions::default()).unwrap_err().to_string();
    assert!(error.contains("value of 1e300") && error.contains("1e60"), "{error}");
}

#[test]
fn a_stated_reference_is_not_overruled() {
    let grid = paper_grid();
    let (values, sigma) = measure(&paper_sphere(), &grid, 0.01, &mut Random::new(1));
    let document = document(&grid, values, Some(sigma), FIXED);
    let asked = |reference| fit(&document, &FitOptions { assume_reference: Some(reference), ..FitOptions::default() });
    assert!(asked(FIXED).is_ok());
    let error = asked(Reference::SameGeometry).unwrap_err().to_string();
    assert!(error.contains("fixed-geometry(0,45)") && error.contains("same-geometry"), "{error}");
}

#[test]
fn a_term_is_named_once() {
    let grid = paper_grid();
    let (values, sigma) = measure(&paper_sphere(), &grid, 0.01, &mut Random::new(1));
    let document = document(&grid, values, Some(sigma), FIXED);
    let terms = vec![TermKind::Lambertian, TermKind::Lambertian];
    let error = fit(&document, &FitOptions { terms, ..FitOptions::default() }).unwrap_err();
    assert_eq!(error, FitError::SameTermTwice(TermKind::Lambertian));
}

/// What was measured more than once scatters by what it scatters by, whatever is stated.
#[test]
fn repeats_that_scatter_more_than_is_stated_are_said() {
    let grid = [paper_grid(), paper_grid()[..60].to_vec()].concat();
    let (values, sigma) = measure(&paper_sphere(), &grid, 0.01, &mut Random::new(5));
    let said = |of_stated: f64| {
        let stated = sigma.iter().map(|sigma| of_stated * sigma).collect();
        let model = fit(&document(&grid, values.clone(), Some(stated), FIXED), &FitOptions::default()).unwrap();
        model.identifiability.iter().find(|sentence| sentence.contains("more than once")).cloned()
    };
    assert_eq!((said(1.0), said(2.0)), (None, None));
    let sentence = said(0.5).unwrap();
    assert!(sentence.contains("60 geometries") && sentence.contains("too small"), "{sentence}");
}
