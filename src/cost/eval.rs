//! The ladder of predictions: a matrix under many lights.

use ndarray::Array2;

use super::ladder::{Ladder, Meaning, Task};
use super::measured::{Candidate, measured};
use super::timing::Patience;
use crate::donaldson::{
    By, Colour, Extend, Light, Luminescence, Matrix, NotSeparated, Observer, Operator, Prediction, Reradiation,
    Separate, Separated, Way, separate,
};
use crate::quantity::QuantityKind;

/// Lights that are predicted together while time is taken: the table stays in a cache, and a light comes from memory.
const BLOCK: usize = 512;
/// Steps of the samples, nm.
const STEPS: [f64; 5] = [1.0, 2.0, 5.0, 10.0, 20.0];
/// Numbers of factors beside those of the separation.
const RANKS: [usize; 3] = [1, 2, 3];

/// What an eval ladder is made of.
#[derive(Debug)]
pub struct EvalLadder<'a> {
    /// What it is called.
    pub subject: String,
    /// The matrix.
    pub matrix: &'a Matrix,
    /// Its two parts.
    pub separated: &'a Separated,
    /// Which luminescence.
    pub luminescence: Luminescence,
    /// The lights over which errors are the largest.
    pub lights: &'a [Light],
    /// What they do where they have no value.
    pub extend: Extend,
    /// Who sees the colours.
    pub observer: Observer,
    /// How many predictions the time is of.
    pub count: f64,
}

/// Why there is no ladder.
#[derive(Debug, thiserror::Error)]
pub enum NoEvalLadder {
    /// Nothing to compare.
    #[error("no light gives a colour of `{0}`; expected one that the observer sees, and a matrix with an elastic part")]
    NoColour(String),
    /// A number of factors that the matrix does not have.
    #[error(transparent)]
    Separate(#[from] NotSeparated),
}

/// What each way to predict costs.
///
/// # Errors
/// [`NoEvalLadder`].
pub fn eval_ladder(asked: &EvalLadder<'_>, patience: Patience) -> Result<Ladder, NoEvalLadder> {
    let exact = Reradiation::of(asked.matrix, asked.separated, asked.luminescence);
    let exact: (Vec<Prediction>, Reradiation) =
        (asked.lights.iter().map(|light| exact.under(light, asked.extend)).collect(), exact);
    let (reference, surface) = &exact;
    if reference.iter().all(|one| one.colour(asked.observer).is_none()) {
        return Err(NoEvalLadder::NoColour(asked.subject.clone()));
    }
    let lights = asked.lights;
    let mut candidates = vec![Candidate {
        name: "integrals".to_owned(),
        knob: "exact".to_owned(),
        options: Vec::new(),
        error: Some(0.0),
        second_error: Some(0.0),
        bytes: None,
        note: Some("with all uncertainties".to_owned()),
        work: Box::new(move || {
            // All of them: lights of more wavelengths take longer.
            lights.iter().for_each(|light| drop(std::hint::black_box(surface.under(light, asked.extend))));
        }),
        times: asked.count / lights.len().max(1) as f64,
        read: None,
    }];
    let ways =
        |by: By| STEPS.iter().flat_map(move |step| [false, true].map(|single| Way { by, step_nm: *step, single }));
    for way in ways(By::Product).chain(ways(By::Colour)) {
        candidates.extend(candidate(asked, reference, surface, None, way));
    }
    let mut ranks: Vec<usize> = RANKS.iter().copied().chain([asked.separated.factors.rank()]).collect();
    ranks.sort_unstable();
    ranks.dedup();
    for rank in ranks {
        // A rank that the matrix cannot have is no rung.
        let Ok(separated) = with_rank(asked, rank) else { continue };
        let surface = Reradiation::of(asked.matrix, &separated, asked.luminescence);
        for step_nm in [5.0, 10.0] {
            let way = Way { by: By::Factors, step_nm, single: false };
            candidates.extend(candidate(asked, reference, &surface, Some(&separated), way));
        }
    }
    Ok(measured(Task::Eval, asked.subject.clone(), meaning(asked), candidates, patience))
}

fn with_rank(asked: &EvalLadder<'_>, rank: usize) -> Result<Separated, NotSeparated> {
    if asked.separated.factors.rank() == rank {
        return Ok(asked.separated.clone());
    }
    separate(asked.matrix, Separate { rank: Some(rank) })
}

fn meaning(asked: &EvalLadder<'_>) -> Meaning {
    let names: Vec<&str> = asked.lights.iter().map(Light::name).collect();
    Meaning {
        reference: format!(
            "the exact integrals of `bbrf donaldson predict`, luminescence `{}`, under {}",
            asked.luminescence,
            names.join(", ")
        ),
        error: format!("largest CIE 1976 colour difference over these lights, {} degree observer", asked.observer),
        axis: "largest colour difference (CIE 1976)".to_owned(),
        second_error: Some(
            "largest r.m.s. difference of the radiance under a light, both as samples, over its r.m.s.; none where there is \
             no radiance"
                .to_owned(),
        ),
        time: format!(
            "seconds for {} predictions (radiance and X, Y, Z) on one thread, by blocks of {BLOCK} lights that are samples already",
            asked.count
        ),
        read_time: None,
    }
}

fn candidate(
    asked: &EvalLadder<'_>,
    reference: &[Prediction],
    surface: &Reradiation,
    separated: Option<&Separated>,
    way: Way,
) -> Option<Candidate<'static>> {
    let widths = asked.matrix.emission_width_nm();
    let factors = separated.map(|separated| (&separated.factors, widths.as_slice()));
    let operator = Operator::new(surface, factors, asked.observer, way)?;
    let rows: Vec<Vec<f64>> = asked.lights.iter().map(|light| operator.sampled(light, asked.extend)).collect();
    let (error, second_error) = errors(&operator, &rows, reference, asked.observer);
    let precision = if way.single { ", single" } else { "" };
    let rank = separated.map(|separated| separated.factors.rank());
    let of_rank = rank.map_or(String::new(), |rank| format!(" {rank}"));
    let mut options = vec!["--by".to_owned(), way.by.to_string(), "--step".to_owned(), way.step_nm.to_string()];
    options.extend(rank.into_iter().flat_map(|rank| ["--rank".to_owned(), rank.to_string()]));
    options.extend(way.single.then(|| "--single".to_owned()));
    // Mixtures of the lights, as what falls in from all around is; their weights do not matter for the time.
    let mixed = |(row, k): (usize, usize)| {
        let (one, other) = (&rows[row % rows.len()], &rows[(row / rows.len()) % rows.len()]);
        one[k] + (1.0 + (row % 7) as f64) / 8.0 * other[k]
    };
    let block = operator.samples(&Array2::from_shape_fn((BLOCK, operator.nm().len()), mixed));
    Some(Candidate {
        name: format!("{}{of_rank} {} nm{precision}", way.by, way.step_nm),
        knob: format!("{}{precision}", way.by),
        options,
        error,
        second_error,
        bytes: None,
        note: None,
        work: Box::new(move || {
            std::hint::black_box(operator.apply_only(&block));
        }),
        times: asked.count / BLOCK as f64,
        read: None,
    })
}

/// Largest colour difference, and largest relative difference of the radiance, to exact predictions.
fn errors(
    operator: &Operator,
    rows: &[Vec<f64>],
    reference: &[Prediction],
    observer: Observer,
) -> (Option<f64>, Option<f64>) {
    let lights = Array2::from_shape_fn((rows.len(), operator.nm().len()), |(row, k)| rows[row][k]);
    let (radiance, xyz) = operator.apply(&operator.samples(&lights));
    let (mut of_colour, mut of_radiance) = (None, None);
    let larger = |worst: Option<f64>, found: f64| Some(worst.map_or(found, |worst: f64| worst.max(found)));
    for (row, exact) in reference.iter().enumerate() {
        let Some(expected) = exact.colour(observer) else { continue };
        let found = operator.colour(&rows[row], [0, 1, 2].map(|c| xyz[(row, c)]));
        let difference = |found: Colour| found.difference(&expected).map(|difference| difference.de76);
        // A colour that is lost is no rung's small error.
        let Some(difference) = found.and_then(difference) else { return (None, None) };
        of_colour = larger(of_colour, difference);
        if let Some(radiance) = &radiance {
            let difference = relative(operator, radiance.row(row), exact);
            of_radiance = difference.map_or(of_radiance, |difference| larger(of_radiance, difference));
        }
    }
    (of_colour, of_radiance)
}

/// R.m.s. difference of a radiance to the exact one, over its r.m.s.: the exact one is sampled as a light is, so that a line counts with
/// its energy and not with its height. `None` where the exact one has no value.
fn relative(operator: &Operator, radiance: ndarray::ArrayView1<'_, f64>, exact: &Prediction) -> Option<f64> {
    let visible = &exact.visible;
    let total = visible.elastic.iter().zip(&visible.luminescent).map(|(elastic, luminescent)| elastic + luminescent);
    let exact = Light::new("radiance", QuantityKind::RelativeSpectrum, visible.nm.clone(), total.collect(), None);
    let expected = operator.sampled(&exact.ok()?, Extend::Zero);
    let from = operator.nm().partition_point(|nm| *nm < operator.visible_nm()[0]);
    let pairs = radiance.iter().zip(&expected[from..]);
    let (difference, whole) = pairs.fold((0.0, 0.0), |(difference, whole), (found, expected)| {
        (difference + (found - expected).powi(2), whole + expected.powi(2))
    });
    Some((difference / whole).sqrt())
}
