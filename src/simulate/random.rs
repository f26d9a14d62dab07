//! Random numbers with an address: the same for a pixel, a sample and an effect, whatever else is drawn and in whatever order.
//!
//! SplitMix64 (Steele, Lea, Flood, Fast splittable pseudorandom number generators, OOPSLA 2014), started at a hash of the address.

use super::effect::Effect;

/// The stream of one sample of one effect at one pixel.
#[derive(Debug, Clone, Copy)]
pub(super) struct Stream(u64);

const STEP: u64 = 0x9e37_79b9_7f4a_7c15;

fn mix(mut bits: u64) -> u64 {
    bits = (bits ^ (bits >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    bits = (bits ^ (bits >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    bits ^ (bits >> 31)
}

impl Stream {
    pub(super) fn new(seed: u64, pixel: u64, sample: u64, effect: Effect) -> Self {
        let address = [seed, pixel, sample, effect as u64];
        Self(address.into_iter().fold(0, |state, part| mix(state.wrapping_add(STEP) ^ mix(part.wrapping_add(STEP)))))
    }

    /// Even in \[0, 1).
    #[inline]
    pub(super) fn uniform(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(STEP);
        (mix(self.0) >> 11) as f64 * (1.0 / (1_u64 << 53) as f64)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn streams_of_neighbours_have_nothing_in_common() {
        let first = |pixel, sample, effect| Stream::new(1, pixel, sample, effect).uniform();
        let mut all = Vec::new();
        for pixel in 0..100 {
            for sample in 0..50 {
                all.push((first(pixel, sample, Effect::Surround), first(pixel, sample, Effect::Interreflection)));
            }
        }
        let mean = |of: &dyn Fn(&(f64, f64)) -> f64| all.iter().map(of).sum::<f64>() / all.len() as f64;
        // Standard deviations of the means of 5000: .0041 of a number and of its product with another .0012.
        assert!((mean(&|one| one.0) - 0.5).abs() < 0.02);
        assert!((mean(&|one| (one.0 - 0.5) * (one.1 - 0.5))).abs() < 0.006);
        let next: Vec<f64> = all.windows(2).map(|pair| (pair[0].0 - 0.5) * (pair[1].0 - 0.5)).collect();
        assert!((next.iter().sum::<f64>() / next.len() as f64).abs() < 0.006);
    }
}
