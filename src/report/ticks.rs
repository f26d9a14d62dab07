//! Which numbers an axis names, and how they are written.

/// A named number on an axis.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Tick {
    pub(super) value: f64,
    pub(super) label: String,
}

pub(super) fn linear_ticks(from: f64, to: f64, count: usize) -> Vec<Tick> {
    let step = nice_step((to - from) / count.max(1) as f64);
    let first = (from / step - 1e-9).ceil();
    let last = (to / step + 1e-9).floor();
    let steps = (last - first).clamp(0.0, 1000.0) as usize;
    (0..=steps)
        .map(|index| (first + index as f64) * step)
        .map(|value| Tick { value, label: number_at_step(value, step) })
        .collect()
}

/// 1, 2 or 5 times a power of ten, not less than `least`.
pub(super) fn nice_step(least: f64) -> f64 {
    let power = 10f64.powf(least.log10().floor());
    let factor = [1.0, 2.0, 5.0].into_iter().find(|factor| factor * power >= least * (1.0 - 1e-9)).unwrap_or(10.0);
    factor * power
}

/// Which multiples of the powers of ten have ticks.
pub(super) fn logarithmic_factors(from: f64, to: f64) -> &'static [f64] {
    if (to / from).log10() > 3.0 { &[1.0] } else { &[1.0, 2.0, 5.0] }
}

pub(super) fn logarithmic_ticks(from: f64, to: f64) -> Vec<Tick> {
    let factors = logarithmic_factors(from, to);
    let (first, last) = (from.log10().floor() as i32, to.log10().ceil() as i32);
    (first..=last)
        .flat_map(|decade| factors.iter().map(move |factor| factor * 10f64.powi(decade)))
        .filter(|value| (from * (1.0 - 1e-9)..=to * (1.0 + 1e-9)).contains(value))
        .map(|value| Tick { value, label: number_at_step(value, value) })
        .collect()
}

/// Zero, and on both sides powers of ten from where ratios count; multiples as well where there are few powers.
pub(super) fn around_zero_ticks(linear: f64, from: f64, to: f64) -> Vec<Tick> {
    let is_wide = (to.max(-from) / linear).log10() > 1.7;
    let side = |end: f64| {
        let ticks = if end > linear { logarithmic_ticks(linear, end) } else { Vec::new() };
        ticks.into_iter().filter(move |tick| !is_wide || is_power(tick.value))
    };
    let negative = |tick: Tick| Tick { value: -tick.value, label: format!("\u{2212}{}", tick.label) };
    let below: Vec<Tick> = side(-from).map(negative).collect();
    let zero = (from <= 0.0 && to >= 0.0).then(|| Tick { value: 0.0, label: "0".to_owned() });
    below.into_iter().rev().chain(zero).chain(side(to)).collect()
}

/// A number with the decimals that a step needs; with a power of ten where it is very large or very small.
fn number_at_step(value: f64, step: f64) -> String {
    if value == 0.0 {
        return "0".to_owned();
    }
    if !(1e-4..1e6).contains(&step.abs()) || value.abs() >= 1e6 {
        let digits = (value.abs() / step).log10().ceil().clamp(0.0, 6.0) as usize;
        return power_of_ten(&format!("{value:.digits$e}"));
    }
    let decimals = (-step.log10() + 1e-9).floor().max(-1.0) as i32 + i32::from(step < 1.0 && !is_power(step));
    let text = format!("{value:.*}", decimals.max(0) as usize);
    text.replacen('-', "\u{2212}", 1)
}

fn is_power(step: f64) -> bool {
    let exponent = step.log10();
    (exponent - exponent.round()).abs() < 1e-9
}

/// `1.5e-7` as 1.5·10⁻⁷.
pub(super) fn power_of_ten(text: &str) -> String {
    let Some((mantissa, exponent)) = text.split_once('e') else { return text.to_owned() };
    format!("{}\u{b7}10{}", mantissa.replacen('-', "\u{2212}", 1), superscript(exponent))
}

/// Digits and minus raised.
pub(super) fn superscript(text: &str) -> String {
    const RAISED: [char; 10] = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'];
    text.chars()
        .map(|c| match c {
            '-' => '⁻',
            digit => digit.to_digit(10).map_or(digit, |digit| RAISED[digit as usize]),
        })
        .collect()
}
