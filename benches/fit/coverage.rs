//! How often 95 % intervals cover the truth; every trial counts.

use rayon::prelude::*;

use crate::common::families::Family;
use crate::common::scans::Random;
use crate::precision::NAMES;
use crate::{tables, trials, with_intervals};

/// What became of one interval.
#[derive(Clone, Copy, PartialEq)]
enum Interval {
    Closed(bool),
    Open(bool),
    /// None is given: no specular term is seen.
    None,
}

pub fn run() {
    let families = [("standard box, 1 %", Family::standard(0.01)), ("standard box, 5 %", Family::standard(0.05)), {
        let family = Family::whole_box();
        (family.name, family)
    }];
    for (name, family) in families {
        let set = tables(&family.grid);
        let count = trials(10_000);
        let found: Vec<[Interval; 4]> = (0..count)
            .into_par_iter()
            .map(|trial| {
                let scan = family.scan(&mut Random::new(5 + 15_485_863 * trial as u64));
                let (_, i) = with_intervals(&set, &scan.values, &scan.sigma);
                let truth = scan.truth.as_array();
                let intervals = [i.diffuse, i.intensity, i.roughness, i.index_minus_one];
                std::array::from_fn(|k| match intervals[k] {
                    None => Interval::None,
                    Some(interval) if interval.is_closed() => Interval::Closed(interval.contains(truth[k])),
                    Some(interval) => Interval::Open(interval.contains(truth[k])),
                })
            })
            .collect();
        println!(
            "95 % intervals, {name}: {count} scans; the share itself scatters by {:.4}",
            (0.0475 / count as f64).sqrt()
        );
        for (k, name) in NAMES.into_iter().enumerate() {
            let of = |wanted: Interval| found.iter().filter(|found| found[k] == wanted).count();
            let (closed, open) = (of(Interval::Closed(true)), of(Interval::Open(true)));
            let (all_closed, all_open) = (closed + of(Interval::Closed(false)), open + of(Interval::Open(false)));
            let given = all_closed + all_open;
            let percent = |part: usize, whole: usize| 100.0 * part as f64 / whole.max(1) as f64;
            println!(
                "   {name}: {:.2} % of {given} given cover ({:.2} % of {all_closed} closed, {:.2} % of {all_open} open); \
                 none given {}",
                percent(closed + open, given),
                percent(closed, all_closed),
                percent(open, all_open),
                of(Interval::None)
            );
        }
    }
}
