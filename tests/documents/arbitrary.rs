//! Arbitrary documents: whatever the types allow that `Document::check` finds consistent.

use bbrf::dataset::tree::{Array, Data, Dataset, Group};
use bbrf::dataset::*;
use bbrf::quantity::*;
use bbrf::terms::{Denominator, Distribution, TermKind};
use ndarray::Array2;
use proptest::collection::vec;
use proptest::option::of;
use proptest::prelude::*;
use proptest::sample::select;

/// Any bits, so any NaN with its payload; and the ordinary numbers more often.
fn number() -> impl Strategy<Value = f64> {
    prop_oneof![
        4 => -1e3..1e3,
        2 => any::<u64>().prop_map(f64::from_bits),
        1 => select(vec![0.0, -0.0, f64::NAN, -f64::NAN, f64::INFINITY, f64::MIN_POSITIVE, 5e-324]),
        1 => any::<u64>().prop_map(|bits| f64::from_bits(0x7ff0_0000_0000_0001 | bits)),
    ]
}

/// Any finite number.
fn finite() -> impl Strategy<Value = Finite> {
    number().prop_filter_map("finite", |number| Finite::try_from(number).ok())
}

fn numbers(most: usize) -> impl Strategy<Value = Vec<f64>> {
    vec(number(), 0..=most)
}

fn text() -> impl Strategy<Value = String> {
    let shapes = [
        "",
        " ",
        "a",
        "größer, kleiner",
        "蛍光",
        "e\u{301}",
        "tab\tline\nend ",
        "👩‍🔬",
        "\u{feff}",
        "\u{1}",
        "{\"a\":1}",
    ];
    prop_oneof![
        select(shapes.to_vec()).prop_map(str::to_owned),
        vec(any::<char>().prop_filter("no NUL", |c| *c != '\0'), 0..12).prop_map(|chars| chars.into_iter().collect()),
    ]
}

fn name() -> impl Strategy<Value = Id> {
    "[A-Za-z0-9_][A-Za-z0-9_.-]{0,20}".prop_map(|text| Id::new(text).unwrap())
}

/// Up to three ids that differ.
fn names() -> impl Strategy<Value = Vec<Id>> {
    proptest::collection::btree_set(name(), 0..4).prop_map(|set| set.into_iter().rev().collect())
}

fn choice(of: &[Id]) -> BoxedStrategy<Option<Id>> {
    if of.is_empty() { Just(None).boxed() } else { proptest::option::of(select(of.to_vec())).boxed() }
}

fn wavelengths() -> impl Strategy<Value = WavelengthAxis> {
    let bandpass = prop_oneof![
        Just(Bandpass::Unstated),
        (numbers(5), select(BandpassShape::ALL), select(BandpassCorrection::ALL))
            .prop_map(|(fwhm_nm, shape, correction)| Bandpass::Stated { fwhm_nm, shape, correction }),
    ];
    (numbers(6), bandpass, numbers(6)).prop_map(|(nm, bandpass, actual_nm)| WavelengthAxis { nm, bandpass, actual_nm })
}

fn emission() -> impl Strategy<Value = EmissionAxis> {
    let band = (number(), number()).prop_map(|(from_nm, to_nm)| Band { from_nm, to_nm });
    prop_oneof![
        wavelengths().prop_map(EmissionAxis::Wavelengths),
        of(band).prop_map(|band| EmissionAxis::Band { band }),
    ]
}

fn reference() -> impl Strategy<Value = Reference> {
    prop_oneof![
        select(vec![Reference::SameGeometry, Reference::None, Reference::Unstated]),
        (-90.0..=90.0, -90.0..=90.0)
            .prop_map(|(theta_i_deg, theta_v_deg)| Reference::FixedGeometry { theta_i_deg, theta_v_deg }),
    ]
}

fn quantity() -> impl Strategy<Value = Quantity> {
    let light = prop_oneof![
        Just(ReferenceLight::Same),
        Just(ReferenceLight::Unstated),
        name()
            .prop_filter("names that mean something else", |id| !matches!(id.as_str(), "same" | "unstated"))
            .prop_map(|id| ReferenceLight::Light(id.to_string())),
    ];
    (
        select(QuantityKind::ALL),
        select(Part::ALL),
        select(NormalisedAt::ALL),
        select(Basis::ALL),
        reference(),
        light,
        numbers(6),
    )
        .prop_map(|(kind, part, normalised_at, basis, reference, reference_light, certified_factor)| Quantity {
            kind,
            part,
            normalised_at,
            basis,
            reference,
            reference_light,
            certified_factor,
        })
}

fn geometry() -> impl Strategy<Value = Geometry> {
    (0.0..=180.0, 0.0..360.0, 0.0..=90.0, 0.0..360.0)
        .prop_map(|(a, b, c, d)| Geometry::from_degrees(a, b, c, d).unwrap())
}

fn acquisition() -> impl Strategy<Value = Acquisition> {
    (of(geometry()), of(any::<u32>()), any::<u32>(), any::<u32>(), of(text()), of(number()), of(any::<i32>())).prop_map(
        |(geometry, excitation, order, repeats, time, exposure_ms, quality_code)| Acquisition {
            geometry,
            excitation,
            order,
            repeats,
            time,
            exposure_ms,
            quality_code,
        },
    )
}

fn excitation(lights: &[Id]) -> impl Strategy<Value = Excitation> + use<> {
    let slit = (of(number()), of(select(BandpassShape::ALL)), of(select(BandpassCorrection::ALL)));
    (choice(lights), of(number()), of(number()), of(text()), of(text()), slit).prop_map(
        |(light, wavelength_nm, fwhm_nm, filter, polarisation, (actual_nm, shape, correction))| Excitation {
            light,
            wavelength_nm,
            fwhm_nm,
            filter,
            polarisation,
            actual_nm,
            shape,
            correction,
        },
    )
}

fn statement() -> impl Strategy<Value = Statement> {
    let kinds = (of(select(ErrorDistribution::ALL)), of(select(EvaluationType::ALL)));
    (of(finite()), of(finite()), of(finite()), kinds).prop_map(
        |(coverage_factor, coverage_probability, degrees_of_freedom, (distribution, evaluation))| Statement {
            coverage_factor,
            coverage_probability,
            distribution,
            degrees_of_freedom,
            evaluation,
        },
    )
}

fn calibration() -> impl Strategy<Value = Calibration> {
    let texts = (of(text()), of(text()), of(text()), of(text()), of(text()), of(text()));
    (texts, of(finite()), statement()).prop_map(|(texts, relative_standard_uncertainty, statement)| Calibration {
        subject: texts.0,
        artefact: texts.1,
        certificate: texts.2,
        laboratory: texts.3,
        date: texts.4,
        expires: texts.5,
        relative_standard_uncertainty,
        statement,
    })
}

fn conditions() -> impl Strategy<Value = Conditions> {
    let texts = (of(text()), of(text()), of(text()), of(text()), of(text()));
    (texts, of(finite()), of(finite()), of(finite())).prop_map(
        |(texts, temperature_celsius, humidity_percent, relative_drift)| Conditions {
            operator: texts.0,
            laboratory: texts.1,
            temperature_celsius,
            humidity_percent,
            environment: texts.2,
            viewing_polarisation: texts.3,
            relative_drift,
            drift_handling: texts.4,
        },
    )
}

fn vector() -> impl Strategy<Value = [f64; 3]> {
    (number(), number(), number()).prop_map(|(x, y, z)| [x, y, z])
}

fn direction_test() -> impl Strategy<Value = DirectionTest> {
    (any::<u32>(), vector(), vector()).prop_map(|(row, incidence, viewing)| DirectionTest { row, incidence, viewing })
}

/// Arrays of every type that an extension may hold.
fn array() -> impl Strategy<Value = Array> {
    let data = prop_oneof![
        vec(any::<u8>(), 0..5).prop_map(|values| Data::U8(values.into())),
        vec(any::<i64>(), 0..5).prop_map(|values| Data::I64(values.into())),
        vec(any::<f32>(), 0..5).prop_map(|values| Data::F32(values.into())),
        numbers(5).prop_map(|values| Data::F64(values.into())),
        vec(text(), 0..4).prop_map(Data::Text),
    ];
    (data, any::<bool>())
        .prop_map(|(data, scalar)| if scalar && data.len() == 1 { Array::scalar(data) } else { Array::vector(data) })
}

fn extension(domain: Id) -> impl Strategy<Value = Extension> {
    let attributes = || proptest::collection::btree_map("[a-z]{1,8}", array(), 0..3);
    let dataset = (array(), attributes()).prop_map(|(array, attributes)| Dataset { attributes, ..Dataset::new(array) });
    let datasets = proptest::collection::btree_map("d[a-z]{1,8}", dataset, 0..3);
    (attributes(), datasets).prop_map(move |(attributes, datasets)| {
        let child = Group { attributes: attributes.clone(), ..Group::default() };
        let content =
            Group { attributes, datasets: datasets.into_iter().collect(), groups: vec![("child".into(), child)] };
        Extension { domain: domain.clone(), content }
    })
}

fn component() -> impl Strategy<Value = Component> {
    let over = select(vec![CorrelatedOver::Wavelengths, CorrelatedOver::Acquisitions, CorrelatedOver::All]);
    (text(), numbers(6), over, statement()).prop_map(|(name, relative, correlated_over, statement)| Component {
        name,
        relative,
        correlated_over,
        statement,
    })
}

fn matrix(rows: usize, columns: usize) -> impl Strategy<Value = Array2<f64>> {
    vec(number(), rows * columns).prop_map(move |values| Array2::from_shape_vec((rows, columns), values).unwrap())
}

#[derive(Debug, Clone)]
struct Names {
    samples: Vec<Id>,
    instruments: Vec<Id>,
    lights: Vec<Id>,
    references: Vec<Id>,
    measurements: Vec<Id>,
    models: Vec<Id>,
    factorisations: Vec<Id>,
}

fn derivation(measurements: &[Id]) -> impl Strategy<Value = Derivation> + use<> {
    let rows = || vec(any::<i32>(), 0..5);
    (select(measurements.to_vec()), rows(), select(measurements.to_vec()), rows(), rows(), choice(measurements))
        .prop_map(|(numerator, numerator_row, reference, reference_group, row_reference, dark)| Derivation {
            numerator,
            numerator_row,
            reference,
            reference_group,
            row_reference,
            dark,
        })
}

fn measurement(id: Id, names: &Names) -> impl Strategy<Value = Measurement> + use<> {
    let head = (
        of(text()),
        quantity(),
        select(Role::ALL),
        choice(&names.samples),
        choice(&names.instruments),
        choice(&names.references),
        vec(excitation(&names.lights), 0..4),
        of(derivation(&names.measurements)),
        (vec(component(), 0..3), statement(), conditions(), vec(direction_test(), 0..3)),
    );
    let body = (vec(acquisition(), 0..6), emission()).prop_flat_map(|(rows, emission)| {
        let shape = (rows.len(), emission.len());
        let flags =
            vec(any::<u16>(), shape.0 * shape.1).prop_map(move |flags| Array2::from_shape_vec(shape, flags).unwrap());
        (Just(rows), Just(emission), matrix(shape.0, shape.1), of(matrix(shape.0, shape.1)), flags)
    });
    (head, body).prop_map(move |(head, (acquisitions, emission, values, standard, flags))| {
        let (title, quantity, role, sample, instrument, white_reference, excitations, derivation, more) = head;
        let (components, statement, conditions, direction_tests) = more;
        // A statement about uncertainties that are not there has no place.
        let statement = if standard.is_some() { statement } else { Statement::default() };
        Measurement {
            id: id.clone(),
            title,
            quantity,
            role,
            sample,
            instrument,
            white_reference,
            emission,
            excitations,
            acquisitions,
            values: values.into_shared(),
            flags: flags.into_shared(),
            uncertainty: Uncertainty {
                standard: standard.map(|standard| standard.into_shared()),
                statement,
                components,
            },
            conditions,
            direction_tests,
            derivation,
        }
    })
}

fn light(id: Id) -> impl Strategy<Value = Light> {
    let spectrum = (quantity(), wavelengths(), numbers(6), vec(any::<u16>(), 0..6))
        .prop_map(|(quantity, axis, values, flags)| LightSpectrum { quantity, axis, values, flags });
    let numbers = (of(finite()), of(finite()), of(finite()));
    (of(text()), of(text()), of(text()), numbers, vec(calibration(), 0..3), of(spectrum)).prop_map(
        move |(title, make, polarisation, numbers, calibration, spectrum)| Light {
            id: id.clone(),
            title,
            make,
            distance_mm: numbers.0,
            beam_diameter_mm: numbers.1,
            solid_angle_sr: numbers.2,
            polarisation,
            calibration,
            spectrum,
        },
    )
}

fn sample(id: Id) -> impl Strategy<Value = Sample> {
    let texts = (of(text()), of(text()), of(text()), of(text()));
    let numbers = (of(finite()), of(finite()), of(finite()));
    (texts, numbers, of(select(Symmetry::ALL)), any::<bool>()).prop_map(move |(texts, numbers, symmetry, simulated)| {
        Sample {
            id: id.clone(),
            title: texts.0,
            material: texts.1,
            mark: texts.2,
            holder: texts.3,
            width_mm: numbers.0,
            height_mm: numbers.1,
            thickness_mm: numbers.2,
            symmetry,
            simulated,
        }
    })
}

fn instrument(id: Id) -> impl Strategy<Value = Instrument> {
    let texts = (of(text()), of(text()), of(text()), of(text()));
    let numbers = (of(finite()), of(finite()), of(finite()), of(finite()));
    (texts, numbers, vec(calibration(), 0..3)).prop_map(move |(texts, numbers, calibration)| Instrument {
        id: id.clone(),
        model: texts.0,
        serial: texts.1,
        aperture: texts.2,
        accessories: texts.3,
        distance_mm: numbers.0,
        visual_field_deg: numbers.1,
        solid_angle_sr: numbers.2,
        stray_light_relative: numbers.3,
        calibration,
    })
}

fn white_reference(id: Id) -> impl Strategy<Value = WhiteReference> {
    let texts = (of(text()), of(text()), of(text()));
    (texts, numbers(4), numbers(4), of(finite()), vec(calibration(), 0..3)).prop_map(
        move |(texts, certified_nm, certified_factor, certified_relative_uncertainty, calibration)| WhiteReference {
            id: id.clone(),
            title: texts.0,
            material: texts.1,
            certificate: texts.2,
            certified_nm,
            certified_factor,
            certified_relative_uncertainty,
            calibration,
        },
    )
}

fn parameter() -> impl Strategy<Value = FittedParameter> {
    (text(), text(), numbers(3), numbers(3), numbers(3), numbers(3), numbers(3)).prop_map(
        |(name, unit, value, standard_uncertainty, shared, interval_low, interval_high)| FittedParameter {
            name,
            unit,
            value,
            standard_uncertainty,
            shared_relative_uncertainty: shared,
            interval_low,
            interval_high,
        },
    )
}

fn term() -> impl Strategy<Value = FittedTerm> {
    (select(TermKind::ALL), of(select(Distribution::ALL)), of(select(Denominator::ALL)), vec(parameter(), 0..4))
        .prop_map(|(kind, distribution, denominator, parameters)| FittedTerm {
            kind,
            distribution,
            denominator,
            parameters,
        })
}

fn separability() -> impl Strategy<Value = Separability> {
    let lists = (numbers(3), numbers(3), numbers(3), numbers(3), numbers(3), numbers(3));
    (lists, (number(), number(), number(), number())).prop_map(|(lists, numbers)| Separability {
        theta_i_deg: lists.0,
        mean_over_viewing: lists.1,
        spread_over_viewing: lists.2,
        theta_v_deg: lists.3,
        mean_over_incidence: lists.4,
        spread_over_incidence: lists.5,
        cosine_amplitude: numbers.0,
        cosine_relative_rms: numbers.1,
        constancy_relative_rms: numbers.2,
        rank_one_relative_rms: numbers.3,
    })
}

/// A matrix attached to a model, of whatever the document has.
fn attachment(measurements: &[Id], factorisations: &[Id]) -> BoxedStrategy<Option<Attachment>> {
    if factorisations.is_empty() {
        return Just(None).boxed();
    }
    let ids = (select(factorisations.to_vec()), select(measurements.to_vec()), select(measurements.to_vec()));
    let attachment = (ids, text(), text(), select(ReflectanceSource::ALL), vec(text(), 0..3)).prop_map(
        |(ids, elastic_digest, luminescent_digest, reflectance, consistency)| Attachment {
            factorisation: ids.0,
            elastic: ids.1,
            elastic_digest,
            luminescent: ids.2,
            luminescent_digest,
            reflectance,
            consistency,
        },
    );
    of(attachment).boxed()
}

fn model(id: Id, measurements: &[Id], factorisations: &[Id]) -> impl Strategy<Value = Model> + use<> {
    let head = (of(text()), select(measurements.to_vec()), text(), text(), reference(), text(), emission());
    let middle = (
        vec(term(), 0..3),
        vec(text(), 0..3),
        (0_usize..3, 0_usize..3, 0_usize..3).prop_flat_map(|(tables, rows, columns)| {
            let shape = (tables, rows, columns);
            matrix(tables * rows, columns).prop_map(move |all| all.into_shape_with_order(shape).unwrap())
        }),
        (number(), number(), any::<u64>(), any::<u64>()),
    );
    let tail = (
        any::<bool>(),
        text(),
        vec(text(), 0..3),
        of(separability()),
        of(text()),
        vec(parameter(), 0..3),
        attachment(measurements, factorisations),
    );
    (head, middle, tail).prop_map(move |(head, middle, tail)| Model {
        id: id.clone(),
        title: head.0,
        measurement: head.1,
        data_digest: head.2,
        reduction: head.3,
        mask: tail.4,
        reference: head.4,
        unit: head.5,
        emission: head.6,
        terms: middle.0,
        nuisances: tail.5,
        covariance_parameters: middle.1,
        covariance: middle.2.into_shared(),
        residuals: Residuals {
            rms: middle.3.0,
            reduced_chi_square: middle.3.1,
            count: middle.3.2,
            left_out: middle.3.3,
        },
        converged: tail.0,
        method: tail.1,
        identifiability: tail.2,
        separability: tail.3,
        donaldson: tail.6,
    })
}

fn place() -> impl Strategy<Value = Place> {
    (of(text()), of(any::<u64>()), of(any::<u64>()), of(text()), vec(any::<u64>(), 0..3))
        .prop_map(|(file, line, byte, path, index)| Place { file, line, byte, path, index })
}

fn receipt() -> impl Strategy<Value = Receipt> {
    let input = (text(), text(), any::<u64>(), text(), any::<u64>())
        .prop_map(|(name, sha256, bytes, dialect, records)| InputFile { name, sha256, bytes, dialect, records });
    let assumption = (text(), place()).prop_map(|(text, place)| Assumption { text, place });
    let notice = (text(), place()).prop_map(|(text, place)| Notice { text, place });
    (text(), vec(input, 0..3), vec(assumption, 0..3), vec(text(), 0..3), vec(notice, 0..3)).prop_map(
        |(tool, inputs, assumptions, unfilled, notices)| Receipt { tool, inputs, assumptions, unfilled, notices },
    )
}

fn provenance() -> impl Strategy<Value = Provenance> {
    let step = (text(), text(), of(text())).prop_map(|(tool, action, time)| Step { tool, action, time });
    (vec(receipt(), 0..3), vec(step, 0..3)).prop_map(|(receipts, steps)| Provenance { receipts, steps })
}

/// One part for each id.
fn factorisation(id: Id, measurements: &[Id]) -> impl Strategy<Value = Factorisation> + use<> {
    let measurements = measurements.to_vec();
    (0_usize..3, 0_usize..4, wavelengths()).prop_flat_map(move |(k, rows, emission)| {
        let columns = emission.nm.len();
        let arrays = (matrix(k, rows), matrix(k, rows), matrix(k, columns), matrix(k, columns));
        let lists = (vec(number(), rows), vec(number(), columns), vec(number(), columns));
        let rest = (of(text()), select(measurements.clone()), text(), text(), vec(text(), 0..3));
        let id = id.clone();
        (arrays, lists, rest, (number(), number(), number(), any::<u64>())).prop_map(
            move |(arrays, lists, rest, numbers)| Factorisation {
                id: id.clone(),
                title: rest.0,
                measurement: rest.1,
                data_digest: rest.2,
                excitation_nm: lists.0,
                emission: emission.clone(),
                excitation: arrays.0.into_shared(),
                excitation_u: arrays.1.into_shared(),
                emission_factor: arrays.2.into_shared(),
                emission_factor_u: arrays.3.into_shared(),
                elastic: lists.1,
                elastic_u: lists.2,
                reach_nm: numbers.0,
                floor: numbers.1,
                residual_rms: numbers.2,
                residual_count: numbers.3,
                method: rest.3,
                findings: rest.4,
            },
        )
    })
}

fn parts<T: std::fmt::Debug + 'static, S: Strategy<Value = T> + 'static>(
    ids: &[Id],
    part: impl Fn(Id) -> S,
) -> BoxedStrategy<Vec<T>> {
    ids.iter().map(|id| part(id.clone()).boxed()).collect::<Vec<_>>().boxed()
}

/// Any consistent document.
pub fn document() -> impl Strategy<Value = Document> {
    let all = (names(), names(), names(), names(), names(), names(), names());
    all.prop_flat_map(|(samples, instruments, lights, references, measurements, models, factorisations)| {
        let models = if measurements.is_empty() { vec![] } else { models };
        let factorisations = if measurements.is_empty() { vec![] } else { factorisations };
        let names = Names { samples, instruments, lights, references, measurements, models, factorisations };
        let head = (of(text()), of(text()), of(text()), of(text()), provenance());
        let extensions = vec(name(), 0..2).prop_flat_map(|mut names| {
            names.sort();
            names.dedup();
            names.into_iter().map(|name| extension(name).boxed()).collect::<Vec<_>>()
        });
        let parts = (
            parts(&names.samples, sample),
            parts(&names.instruments, instrument),
            parts(&names.lights, light),
            parts(&names.references, white_reference),
            parts(&names.measurements, |id| measurement(id, &names)),
            parts(&names.models, |id| model(id, &names.measurements, &names.factorisations)),
            parts(&names.factorisations, |id| factorisation(id, &names.measurements)),
        );
        (head, parts, extensions)
    })
    .prop_map(|((title, license, citation, contact, provenance), parts, extensions)| Document {
        title,
        license,
        citation,
        contact,
        samples: parts.0,
        instruments: parts.1,
        lights: parts.2,
        white_references: parts.3,
        measurements: parts.4,
        models: parts.5,
        factorisations: parts.6,
        provenance,
        extensions,
    })
}
