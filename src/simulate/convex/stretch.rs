//! Where in a row nothing has to be asked of a pixel: whether light falls on it and whether it shines is known of whole stretches.
//!
//! A row of the film cuts the sphere in a circle. With t the angle along it from the side of the camera, N.U = A cos(t - t0) + b for every
//! direction U, so that the pixels at which N.U is above a number are those of one interval of t.

use std::f64::consts::FRAC_PI_2;
use std::ops::Range;

use super::sphere::Sphere;
use crate::simulate::vector::Vector;

/// By how much a cosine is taken for less, or for more, than it is: far above what rounding does to it.
const MARGIN: f64 = 1e-9;

/// Stretches of a row, by columns. What is not known of a pixel is asked of itself.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Stretches {
    /// Outside no light falls, or no sphere is.
    pub(super) lit: Range<usize>,
    /// Inside light falls, and neither it nor the view grazes. Within `lit`.
    pub(super) calm: Range<usize>,
    /// Of `calm` the part where the lobe may be seen.
    pub(super) shining: Range<usize>,
}

impl Stretches {
    /// Nothing is known of these columns.
    pub(super) fn unknown(columns: Range<usize>) -> Self {
        let none = columns.end..columns.end;
        Self { lit: columns, calm: none.clone(), shining: none }
    }

    /// Of a row under parallel light from `towards`. `half` is the unit half vector, `cut` the cosine to it below which no lobe is seen,
    /// and `steepest` the cosine of incidence and of viewing below which it grazes.
    pub(super) fn of(
        sphere: &Sphere,
        row: usize,
        columns: Range<usize>,
        [towards, half]: [Vector; 2],
        [cut, steepest]: [f64; 2],
    ) -> Self {
        // What is lit from behind is lit in two intervals.
        if towards[2] < 0.0 {
            return Self::unknown(columns);
        }
        let circle = Circle { sphere, row };
        let within = |from: &Range<usize>, inner: Range<usize>| {
            let start = inner.start.clamp(from.start, from.end);
            start..inner.end.clamp(start, from.end)
        };
        let lit = within(&columns, circle.columns_above(towards, -MARGIN));
        let [by_light, by_view] = [towards, [0.0, 0.0, 1.0]].map(|axis| circle.columns_above(axis, steepest + MARGIN));
        let calm = within(&within(&lit, by_light), by_view);
        let shining = within(&calm, circle.columns_above(half, cut - MARGIN));
        Self { lit, calm, shining }
    }
}

/// The half of a circle of the sphere that a row shows.
struct Circle<'a> {
    sphere: &'a Sphere,
    row: usize,
}

impl Circle<'_> {
    /// The columns whose middles have a normal with N.U above `least`, for U of length 1 that does not point away from the camera.
    fn columns_above(&self, axis: Vector, least: f64) -> Range<usize> {
        let (radius, up) = (self.sphere.radius(), self.sphere.up(self.row));
        let circle = (radius * radius - up * up).max(0.0).sqrt();
        let across = axis[0].hypot(axis[2]) * circle;
        let level = least * radius - axis[1] * up;
        // An axis across the circle, or a circle that is a point: all or nothing. And a cosine above 1 is met nowhere.
        if across <= level.abs() {
            return if level > 0.0 { 0..0 } else { self.sphere.columns_between(-f64::INFINITY, f64::INFINITY) };
        }
        let (middle, half) = (axis[0].atan2(axis[2]), (level / across).acos());
        // What reaches behind the sphere reaches beyond its edge on the film, which the view's own cosine is for.
        let right = |t: f64| if t.abs() < FRAC_PI_2 { circle * t.sin() } else { f64::INFINITY.copysign(t) };
        self.sphere.columns_between(right(middle - half), right(middle + half))
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::simulate::vector::{dot, unit};

    const STEEPEST: f64 = 1.0 / 256.0;

    fn direction() -> impl Strategy<Value = Vector> {
        let any =
            (-1.0..1.0_f64, -1.0..1.0_f64, -0.1..1.0_f64).prop_filter_map("a length", |(x, y, z)| unit([x, y, z]));
        let axes = prop::sample::select(vec![
            [1.0, 0.0, 0.0],
            [0.0, 1.0, 0.0],
            [0.0, -1.0, 0.0],
            [0.0, 0.0, 1.0],
            [0.0, 0.0, -1.0],
            [0.6, 0.8, 0.0],
            [-0.8, 0.0, 0.6],
        ]);
        prop_oneof![3 => any, 1 => axes]
    }

    proptest! {
        #![proptest_config(ProptestConfig { cases: 4000, ..ProptestConfig::default() })]

        #[test]
        fn what_is_said_of_a_stretch_holds_for_each_of_its_pixels(
            towards in direction(),
            aside in (-30.0..70.0_f64, -30.0..70.0_f64),
            radius in prop_oneof![0.01..60.0_f64, Just(20.0), Just(20.5), 1e3..1e6_f64],
            is_whole in any::<bool>(),
            cut in prop_oneof![0.0..1.0_f64, Just(0.0), Just(1.0), Just(2.0)],
        ) {
            let centre = if is_whole { [aside.0.round(), aside.1.round()] } else { [aside.0, aside.1] };
            let sphere = Sphere::new(centre, radius).unwrap();
            // Where light and view are opposite there is no half vector; any will do.
            let half = unit([towards[0], towards[1], towards[2] + 1.0]).unwrap_or([1.0, 0.0, 0.0]);
            for row in 0..40 {
                let columns = sphere.columns(row, 40);
                let found = Stretches::of(&sphere, row, columns.clone(), [towards, half], [cut, STEEPEST]);
                let Stretches { lit, calm, shining } = &found;
                prop_assert!(columns.start <= lit.start && lit.end <= columns.end, "{found:?} of {columns:?}");
                prop_assert!(lit.start <= calm.start && calm.end <= lit.end && calm.start <= calm.end, "{found:?}");
                prop_assert!(calm.start <= shining.start && shining.end <= calm.end, "{found:?}");
                for column in columns {
                    let normal = sphere.normal(sphere.right(column as f64 + 0.5), sphere.up(row));
                    let cosines = [dot(normal, towards), normal[2]];
                    let is_lit = cosines[0] >= 0.0 && normal[2] > 0.0;
                    prop_assert!(lit.contains(&column) || !is_lit, "{column} in row {row}: {found:?}, {cosines:?}");
                    let is_calm = cosines.iter().all(|cosine| *cosine >= STEEPEST);
                    prop_assert!(!calm.contains(&column) || is_calm, "{column} in row {row}: {found:?}, {cosines:?}");
                    let may_shine = dot(normal, half) >= cut;
                    prop_assert!(
                        !calm.contains(&column) || shining.contains(&column) || !may_shine,
                        "{column} in row {row}: {found:?}, {cosines:?}"
                    );
                }
            }
        }
    }

    /// Half of the pixels and more of a sphere are known without a look at them.
    #[test]
    fn nearly_all_of_a_large_sphere_is_known() {
        let sphere = Sphere::filling(400, 400).unwrap();
        let (towards, half) = ([0.6, 0.0, 0.8], unit([0.6, 0.0, 1.8]).unwrap());
        let (mut known, mut all, mut shines) = (0, 0, 0);
        for row in 0..400 {
            let columns = sphere.columns(row, 400);
            all += columns.len();
            let Stretches { lit, calm, shining } =
                Stretches::of(&sphere, row, columns.clone(), [towards, half], [0.97, STEEPEST]);
            known += calm.len() + columns.len() - lit.len();
            shines += shining.len();
        }
        assert!(known > 97 * all / 100 && shines > all / 50 && shines < all / 15, "{known} of {all}, {shines} shine");
    }
}
