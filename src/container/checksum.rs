//! The checksum behind every chunk, as fast as the values are read.

use hdf5_reader::checksum::fletcher32 as of_the_library;

/// Sums that run side by side.
const LANES: usize = 8;
/// Words of a lane that its second sum, in 32 bits, has room for: 65535 (n + 1) n / 2 is below 2^32.
const ROUNDS: usize = 360;

/// Fletcher's checksum as HDF5 defines it (`H5_checksum_fletcher32`): two sums modulo 65535 over big-endian words of 16
/// bits, the second over the first. One long chain of additions in the libraries; here eight chains, whose sums are put
/// together for each block.
pub(super) fn fletcher32(data: &[u8]) -> u32 {
    let (blocks, rest) = data.as_chunks::<{ 2 * LANES * ROUNDS }>();
    let (mut first, mut second, mut nothing) = (0_u64, 0_u64, true);
    for block in blocks {
        let (mut sums, mut sums_of_sums) = ([0_u32; LANES], [0_u32; LANES]);
        for words in block.as_chunks::<2>().0.as_chunks::<LANES>().0 {
            for ((sum, over), word) in sums.iter_mut().zip(&mut sums_of_sums).zip(words) {
                *sum += u32::from(u16::from_be_bytes(*word));
                *over += *sum;
            }
        }
        second += first * (LANES * ROUNDS) as u64;
        for (lane, (sum, over)) in sums.iter().zip(sums_of_sums).enumerate() {
            first += u64::from(*sum);
            second += LANES as u64 * u64::from(over) - lane as u64 * u64::from(*sum);
        }
        nothing &= first == 0;
        (first, second) = (first % 65535, second % 65535);
    }
    // What does not fill a block is summed by the library, behind the sums of the blocks.
    let words = rest.len().div_ceil(2) as u64;
    let last = of_the_library(rest);
    second = (second + first * words + u64::from(last >> 16)) % 65535;
    first = (first + u64::from(last & 0xffff)) % 65535;
    // HDF5 folds its sums instead of dividing: only where nothing was added are they zero.
    let folded = |sum: u64| if sum == 0 && !(nothing && last == 0) { 65535 } else { sum as u32 };
    folded(second) << 16 | folded(first)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_is_the_checksum_of_the_library_for_any_bytes_of_any_length() {
        const BLOCK: usize = 2 * LANES * ROUNDS;
        let mut state = 1_u64;
        let mut random = |length: usize| -> Vec<u8> {
            let mut next = || {
                state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
                (state >> 56) as u8
            };
            (0..length).map(|_| next()).collect()
        };
        for length in [0, 1, 2, 3, BLOCK - 1, BLOCK, BLOCK + 1, BLOCK + 2, 3 * BLOCK, 100_001] {
            for bytes in [random(length), vec![0; length], vec![255; length], vec![128; length]] {
                let leading = bytes.first().copied().unwrap_or(0);
                assert_eq!(fletcher32(&bytes), of_the_library(&bytes), "{length} bytes from {leading} on");
            }
        }
    }
}
