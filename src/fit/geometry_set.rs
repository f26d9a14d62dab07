//! What depends on the geometries alone, built once and used by every fit over them.

use ndarray::Array2;

use super::effort::{Effort, spaced};
use super::samples::LANES;
use crate::quantity::{Geometry, HalfAngles, Reference};
use crate::terms::{Denominator, Distribution, Lobe, Undefined, diffuse_factor, fresnel, specular_factor};

/// Ends of the starting grid in n - 1.
const INDEX_NODES: (f64, f64) = (0.15, 1.2);
/// Its widest lobe, as a half width at half height in rad.
const WIDEST_NODE: f64 = 1.0;
/// A lobe narrower than the smallest half-vector angle over this is seen by no other point of the grid.
const NARROWEST_NODE: f64 = 4.4;
/// The box of n - 1.
pub(super) const INDEX_BOX: (f64, f64) = (1e-3, 5.0);
/// The box of the roughness, as a half width at half height in rad.
const HALF_WIDTH_BOX: (f64, f64) = (2e-3, 3.0);
/// Angles closer than this are one: the difference changes D by less than its rounding.
const SAME_ANGLE: f64 = 4e-15;

/// Why geometries cannot be fitted over.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum SetError {
    /// No geometry has a value of every term.
    #[error("none of the {0} geometries has a value of every term")]
    NothingDefined(usize),
    /// The reference convention refuses.
    #[error(transparent)]
    Reference(#[from] crate::quantity::ConversionRefused),
}

/// Points with the same half-vector angle, a run of the sorted points.
#[derive(Debug, Clone, Copy)]
pub(super) struct Segment {
    pub(super) start: usize,
    pub(super) end: usize,
    pub(super) half: HalfAngles,
}

/// Geometries under one reference convention, distribution and denominator, with the tables of the starting grid.
#[derive(Debug, Clone)]
pub struct GeometrySet {
    pub(super) distribution: Distribution,
    /// Input index of each sorted point.
    pub(super) order: Vec<usize>,
    /// Input indices of geometries where a term is undefined; they take no part.
    undefined: Vec<usize>,
    inputs: usize,
    /// Angular factor of a diffuse term of amplitude 1, per sorted and padded point; 0 in the padding.
    pub(super) diffuse: Vec<f64>,
    /// G over denominator and reference, per sorted and padded point; 0 in the padding.
    pub(super) masked: Vec<f64>,
    pub(super) segments: Vec<Segment>,
    /// Distinct angles between L and Q, and which one each sorted point has.
    pub(super) halves: Vec<HalfAngles>,
    pub(super) half_of: Vec<u32>,
    pub(super) effort: Effort,
    pub(super) grid: Grid,
    pub(super) roughness_box: (f64, f64),
    /// Smallest half-vector angle that is not 0, rad; infinite where there is none.
    pub(super) smallest_angle: f64,
}

/// Tables of the starting grid.
#[derive(Debug, Clone, Default)]
pub(super) struct Grid {
    pub(super) roughness: Vec<f64>,
    /// Nodes of n - 1.
    pub(super) index_minus_one: Vec<f64>,
    /// D \[roughness node, segment\].
    pub(super) distribution: Array2<f64>,
    /// F G over denominator and reference \[index node, sorted point\].
    pub(super) specular: Array2<f64>,
}

struct Point {
    input: usize,
    half: HalfAngles,
    diffuse: f64,
    masked: f64,
}

impl GeometrySet {
    /// Tables for N geometries.
    ///
    /// A geometry where a term has no value (grazing against a reference in the same geometry, L = -V) takes no part
    /// and is listed by [`GeometrySet::undefined`].
    ///
    /// # Errors
    /// [`SetError`] when the reference is unstated, or no geometry is left.
    pub fn new(
        geometry: &[Geometry],
        reference: &Reference,
        distribution: Distribution,
        denominator: Denominator,
    ) -> Result<Self, SetError> {
        let specular = |geometry: &Geometry, half: &HalfAngles| specular_factor(denominator, geometry, half, reference);
        Self::with_specular(geometry, reference, distribution, specular)
    }

    /// Tables for a diffuse term alone, which has a value where a specular one has none.
    ///
    /// # Errors
    /// As [`GeometrySet::new`].
    pub fn diffuse(geometry: &[Geometry], reference: &Reference) -> Result<Self, SetError> {
        Self::with_specular(geometry, reference, Distribution::GaussianHalfHeight, |_, _| Ok(0.0))
    }

    fn with_specular(
        geometry: &[Geometry],
        reference: &Reference,
        distribution: Distribution,
        specular: impl Fn(&Geometry, &HalfAngles) -> Result<f64, Undefined>,
    ) -> Result<Self, SetError> {
        let mut points = Vec::with_capacity(geometry.len());
        let mut undefined = Vec::new();
        for (input, geometry) in geometry.iter().enumerate() {
            let half = geometry.half_angles();
            let factors =
                diffuse_factor(geometry, reference).and_then(|diffuse| Ok((diffuse, specular(geometry, &half)?)));
            match factors {
                Ok((diffuse, masked)) => points.push(Point { input, half, diffuse, masked }),
                Err(Undefined::Reference(refused)) => return Err(refused.into()),
                Err(_) => undefined.push(input),
            }
        }
        if points.is_empty() {
            return Err(SetError::NothingDefined(geometry.len()));
        }
        points.sort_by(|a, b| a.half.phi.total_cmp(&b.half.phi));
        Ok(Self::from_points(&points, undefined, distribution))
    }

    fn from_points(points: &[Point], undefined: Vec<usize>, distribution: Distribution) -> Self {
        let segments = segments(points);
        let (halves, half_of) = distinct_halves(points);
        let mut masked: Vec<f64> = points.iter().map(|point| point.masked).collect();
        let mut diffuse: Vec<f64> = points.iter().map(|point| point.diffuse).collect();
        let mut half_of = half_of;
        let padded = points.len().next_multiple_of(LANES);
        masked.resize(padded, 0.0);
        diffuse.resize(padded, 0.0);
        half_of.resize(padded, 0);
        let smallest_angle =
            segments.iter().map(|segment| segment.half.phi).find(|&phi| phi > SAME_ANGLE).unwrap_or(f64::INFINITY);
        let width = |half_width: f64| distribution.roughness_from_half_width(half_width);
        let mut set = Self {
            distribution,
            order: points.iter().map(|point| point.input).collect(),
            inputs: points.len() + undefined.len(),
            undefined,
            diffuse,
            masked,
            segments,
            halves,
            half_of,
            effort: Effort::default(),
            grid: Grid::default(),
            roughness_box: (width(HALF_WIDTH_BOX.0), width(HALF_WIDTH_BOX.1)),
            smallest_angle,
        };
        set.grid = Grid::new(&set);
        set
    }

    /// The same with another effort of the fits over it; builds the tables of the starting grid anew.
    #[must_use]
    pub fn with_effort(mut self, effort: Effort) -> Self {
        self.effort = effort.in_range();
        self.grid = Grid::new(&self);
        self
    }

    /// How many geometries were given.
    #[must_use]
    pub fn len(&self) -> usize {
        self.inputs
    }

    /// The number of sorted points where every term is defined, padded to whole lanes.
    pub(super) fn points(&self) -> usize {
        self.diffuse.len()
    }

    /// True when no geometry was given.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.inputs == 0
    }

    /// Indices of the geometries where a term is undefined.
    #[must_use]
    pub fn undefined(&self) -> &[usize] {
        &self.undefined
    }
}

impl Grid {
    fn new(set: &GeometrySet) -> Self {
        let narrowest = (set.smallest_angle / NARROWEST_NODE).clamp(HALF_WIDTH_BOX.0, WIDEST_NODE / 2.0);
        let half_widths = spaced(narrowest, WIDEST_NODE, set.effort.roughness_nodes);
        let index_minus_one = spaced(INDEX_NODES.0, INDEX_NODES.1, set.effort.index_nodes);
        let roughness: Vec<f64> =
            half_widths.into_iter().map(|width| set.distribution.roughness_from_half_width(width)).collect();
        let lobes: Vec<Lobe> = roughness.iter().map(|roughness| set.distribution.lobe(*roughness)).collect();
        let distribution = Array2::from_shape_fn((lobes.len(), set.segments.len()), |(node, k)| {
            lobes[node].evaluate(&set.segments[k].half).value
        });
        let fresnel_of = |m: &f64| set.halves.iter().map(|half| fresnel(half, *m).value).collect::<Vec<f64>>();
        let fresnel_table: Vec<Vec<f64>> = index_minus_one.iter().map(fresnel_of).collect();
        let specular = Array2::from_shape_fn((fresnel_table.len(), set.masked.len()), |(node, point)| {
            fresnel_table[node][set.half_of[point] as usize] * set.masked[point]
        });
        Self { roughness, index_minus_one, distribution, specular }
    }
}

/// Runs of equal half-vector angle in points sorted by it.
fn segments(points: &[Point]) -> Vec<Segment> {
    let mut segments: Vec<Segment> = Vec::new();
    for (index, point) in points.iter().enumerate() {
        match segments.last_mut() {
            Some(last) if point.half.phi - last.half.phi <= SAME_ANGLE => last.end = index + 1,
            _ => segments.push(Segment { start: index, end: index + 1, half: point.half }),
        }
    }
    segments
}

/// Distinct angles between L and Q, and the index of each point's.
fn distinct_halves(points: &[Point]) -> (Vec<HalfAngles>, Vec<u32>) {
    let mut by_angle: Vec<usize> = (0..points.len()).collect();
    by_angle.sort_by(|&a, &b| points[a].half.cos_q.total_cmp(&points[b].half.cos_q));
    let mut halves: Vec<HalfAngles> = Vec::new();
    let mut half_of = vec![0_u32; points.len()];
    for index in by_angle {
        let half = points[index].half;
        if halves.last().is_none_or(|last| half.cos_q - last.cos_q > SAME_ANGLE) {
            halves.push(half);
        }
        half_of[index] = (halves.len() - 1) as u32;
    }
    (halves, half_of)
}
