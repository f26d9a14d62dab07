//! The interface against its term, integrated by another way.

use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, FRAC_PI_6, PI, TAU};

use rayon::prelude::*;

use crate::simulate::Effect;
use crate::simulate::interface::{Interface, at};
use crate::simulate::random::Stream;
use crate::terms::{Denominator, Distribution, TorranceSparrow};

/// Nodes and weights of Gauss's rule on -1 to 1, by Newton's steps to the zeros of P_n.
fn legendre(count: usize) -> Vec<(f64, f64)> {
    let node = |k: usize| {
        let mut x = (PI * (k as f64 + 0.75) / (count as f64 + 0.5)).cos();
        let mut slope = 1.0;
        for _ in 0..50 {
            let (mut before, mut here) = (1.0, x);
            for n in 2..=count {
                let n = n as f64;
                (before, here) = (here, ((2.0 * n - 1.0) * x * here - (n - 1.0) * before) / n);
            }
            slope = count as f64 * (x * here - before) / (x * x - 1.0);
            x -= here / slope;
        }
        (x, 2.0 / ((1.0 - x * x) * slope * slope))
    };
    (0..count).map(node).collect()
}

/// D F G / den as it is defined, from angles alone; `norm` is that of the Gaussian which has one.
fn defined(term: &TorranceSparrow, norm: f64, phi: f64, cos_q: f64, cos_i: f64, cos_v: f64) -> f64 {
    let (m, n) = (term.roughness, term.refractive_index);
    let tangent = phi.tan();
    let d = match term.distribution {
        Distribution::GaussianHalfHeight => (-(phi / m).powi(2) * 2.0_f64.ln()).exp(),
        Distribution::Gaussian => (-(phi / m).powi(2)).exp(),
        Distribution::TorranceSparrow1967 => (-(phi.to_degrees() / m).powi(2)).exp(),
        Distribution::GaussianNormalised => (-(phi / m).powi(2)).exp() / norm,
        Distribution::Beckmann => (-(tangent / m).powi(2)).exp() / (PI * m * m * phi.cos().powi(4)),
        Distribution::TrowbridgeReitz => m * m / (PI * (phi.sin().powi(2) + m * m * phi.cos().powi(2)).powi(2)),
    };
    let g = (n * n - 1.0 + cos_q * cos_q).sqrt();
    let parallel = (cos_q * (g + cos_q) - 1.0) / (cos_q * (g - cos_q) + 1.0);
    let f = 0.5 * ((g - cos_q) / (g + cos_q)).powi(2) * (1.0 + parallel * parallel);
    let masking = (2.0 * phi.cos() * cos_v.min(cos_i) / cos_q).min(1.0);
    let under = match term.denominator {
        Denominator::CosThetaI => cos_i,
        Denominator::CosThetaV => cos_v,
        Denominator::CosICosV => cos_i * cos_v,
    };
    d * f * masking / under
}

/// The integral of exp(-phi^2 / m^2) cos(phi) over the hemisphere.
fn gaussian_norm(m: f64) -> f64 {
    let (steps, last) = (20_000, FRAC_PI_2.min(9.0 * m));
    let width = last / f64::from(steps);
    let at = |phi: f64| TAU * (-(phi / m).powi(2)).exp() * phi.cos() * phi.sin();
    // Simpson's rule.
    (0..steps).map(|k| width * f64::from(k)).map(|a| at(a) + 4.0 * at(a + width / 2.0) + at(a + width)).sum::<f64>()
        * width
        / 6.0
}

/// The integral of D F G / den over pi over all directions of light, at an angle of viewing: over the half vector, in pieces
/// between the edges of G and over the lobe, `fine` times as many as are needed.
fn quadrature(term: &TorranceSparrow, cos_v: f64, fine: usize) -> f64 {
    let sin_v = (1.0 - cos_v * cos_v).sqrt();
    let tangent = sin_v / cos_v;
    let width = term.roughness / term.distribution.roughness_from_half_width(1.0);
    let (rule, norm) = (legendre(10), gaussian_norm(term.roughness));
    let over = |from: f64, to: f64, f: &dyn Fn(f64) -> f64| {
        let (middle, half) = ((from + to) / 2.0, (to - from) / 2.0);
        rule.iter().map(|(x, weight)| weight * half * f(middle + half * x)).sum::<f64>()
    };
    let pieces = |mut breaks: Vec<f64>, f: &dyn Fn(f64) -> f64| {
        breaks.sort_by(f64::total_cmp);
        breaks.windows(2).filter(|pair| pair[1] > pair[0]).map(|pair| over(pair[0], pair[1], f)).sum::<f64>()
    };
    let at_azimuth = |psi: f64| {
        let delta = (tangent * psi.cos()).atan();
        let last = FRAC_PI_4 + delta / 2.0;
        let edges = [0.0, FRAC_PI_6 + delta / 3.0, FRAC_PI_2 - delta, last];
        let lobe = (0..12 * fine).map(|k| width * 2.0_f64.powf(k as f64 / fine as f64 - 3.0));
        // What lies beside the edge of shadowing, where light or view grazes.
        let scale = (FRAC_PI_2 - delta).min(FRAC_PI_4);
        let beside = (0..24 * fine).map(|k| scale * 2.0_f64.powf(k as f64 / fine as f64 - 3.0));
        let breaks = edges.into_iter().chain(lobe).chain(beside).filter(|phi| (0.0..=last).contains(phi)).collect();
        let value = |phi: f64| {
            let (sin, cos) = phi.sin_cos();
            let cos_q = sin_v * sin * psi.cos() + cos_v * cos;
            let cos_i = 2.0 * cos_q * cos - cos_v;
            if cos_i <= 0.0 { 0.0 } else { defined(term, norm, phi, cos_q, cos_i, cos_v) * 4.0 * cos_q * sin / PI }
        };
        pieces(breaks, &value)
    };
    // Where tan(theta) cos(psi) passes a power of 2 delta turns fast.
    let turns = (-2..22).map(|k| 2.0_f64.powi(k)).filter(|turn| *turn < tangent).map(|turn| (turn / tangent).acos());
    let turns: Vec<f64> = turns.flat_map(|psi| [psi, PI - psi]).collect();
    let even = (0..=4 * fine).map(|k| PI * k as f64 / (4 * fine) as f64);
    let crossing = FRAC_PI_6.tan() / tangent;
    let crossing = (crossing < 1.0).then(|| crossing.acos());
    2.0 * pieces(even.chain(turns).chain(crossing).collect(), &at_azimuth)
}

fn terms(widths: &[f64]) -> Vec<TorranceSparrow> {
    let mut all = Vec::new();
    for distribution in Distribution::ALL {
        for denominator in Denominator::ALL {
            for width in widths {
                all.push(TorranceSparrow {
                    intensity: 1.0,
                    roughness: distribution.roughness_from_half_width(*width),
                    refractive_index: 1.45,
                    distribution: *distribution,
                    denominator: *denominator,
                });
            }
        }
    }
    all
}

#[test]
fn light_from_all_around_at_an_interface_is_the_integral_of_its_term() {
    // Where a wide lobe and the horizon meet a few points of Gauss's rule are few: those of the quadrature, too.
    const PROMISED: [(f64, f64); 13] = [
        (0.0, 1e-6),
        (10.0, 5e-6),
        (26.0, 5e-6),
        (45.0, 5e-5),
        (60.0, 2e-4),
        (75.0, 2e-4),
        (80.0, 2e-4),
        (85.0, 5e-4),
        (88.0, 5e-4),
        (89.0, 5e-4),
        (89.5, 5e-4),
        (89.9, 5e-4),
        (89.99, 5e-4),
    ];
    let cosines = PROMISED.map(|(angle, _)| angle.to_radians().cos());
    let one = |(number, term): (usize, TorranceSparrow)| {
        let table = Interface::new(&term).surrounded();
        let mut own = 0.0;
        let errors = cosines.map(|cosine| {
            let expected = quadrature(&term, cosine, 2);
            if number % 7 == 0 {
                own = f64::max(own, (quadrature(&term, cosine, 3) / expected - 1.0).abs());
            }
            (at(&table, cosine) / expected - 1.0).abs()
        });
        let tabulated = table.iter().copied().fold(0.0, f64::max);
        let between = (0..4000).map(|k| at(&table, 10.0_f64.powf(-6.0 * f64::from(k) / 4000.0))).fold(0.0, f64::max);
        assert!(between < 1.01 * tabulated, "{term:?}: {between} between places of at most {tabulated}");
        (term, errors, own)
    };
    let found: Vec<_> = terms(&[0.002, 0.01, 0.05, 0.3, 1.0]).into_par_iter().enumerate().map(one).collect();
    let own = found.iter().map(|one| one.2).fold(0.0, f64::max);
    println!("the quadrature, and half as fine again: {own:.1e}");
    for (k, (angle, promised)) in PROMISED.into_iter().enumerate() {
        let (term, errors, _) = found.iter().max_by(|a, b| a.1[k].total_cmp(&b.1[k])).unwrap();
        println!("at {angle} degrees: largest error {:.1e}, {term:?}", errors[k]);
        assert!(errors[k] < promised, "{term:?} at {angle} degrees: {}", errors[k]);
    }
    assert!(own < 2e-4, "{own}");
}

#[test]
fn directions_drawn_at_an_interface_have_the_integral_of_its_term_as_their_mean() {
    let normal = [0.0, 0.0, 1.0];
    let terms = terms(&[0.01, 0.05, 0.3, 1.0]);
    let of_term = |(number, term): (usize, &TorranceSparrow)| {
        let interface = Interface::new(term);
        [1.0_f64, 0.6, 0.3].map(|cosine| {
            let view = [(1.0 - cosine * cosine).sqrt(), 0.0, cosine];
            let mut random = Stream::new(7, number as u64, (100.0 * cosine) as u64, Effect::Specular);
            let count = 20_000;
            let (mut sum, mut squares) = (0.0, 0.0);
            for _ in 0..count {
                let numbers = [random.uniform(), random.uniform()];
                let weight = interface.draw(normal, view, numbers).map_or(0.0, |drawn| drawn.1);
                sum += weight;
                squares += weight * weight;
            }
            let count = f64::from(count);
            let mean = sum / count;
            let sigma = ((squares / count - mean * mean) / count).sqrt();
            let z = (mean - quadrature(term, cosine, 1)) / sigma;
            assert!(z.abs() < 5.0, "{term:?} at {cosine}: {z} standard deviations of {sigma}");
            z.abs()
        })
    };
    let all: Vec<f64> = terms.par_iter().enumerate().map(of_term).collect::<Vec<_>>().concat();
    let largest = all.iter().copied().fold(0.0, f64::max);
    println!("{} means of drawn directions: largest deviation {largest:.2} standard errors", all.len());
}
