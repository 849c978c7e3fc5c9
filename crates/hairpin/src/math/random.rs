//! Reproducible random streams: every consumer names its own, so that no result depends on order or threads.
//!
//! Whoever draws asks for a stream by root seed, purpose and number, and draws from that alone. So a case can be drawn
//! again by itself, threads may take cases in any order, and a new consumer changes no numbers of the old ones. PCG:
//! O'Neill, "PCG: A Family of Simple Fast Space-Efficient Statistically Good Algorithms for Random Number Generation"
//! (HMC-CS-2014-0905).

use rand::Rng;
use rand_pcg::Pcg64Mcg;

/// The generator of every stream: PCG XSL 128/64 (MCG), equal on every machine.
pub type Stream = Pcg64Mcg;

/// The seed of case number `case` under the root seed: the first 8 bytes (little-endian) of
/// BLAKE3(`root` as u64 LE ‖ `case` as u64 LE). It never depends on worker, shard or order.
///
/// The same as any language with BLAKE3 computes: what a report names as a case's seed can be checked from outside.
pub fn case_seed(root: u64, case: u64) -> u64 {
    let mut hasher = blake3::Hasher::new();
    hasher.update(&root.to_le_bytes());
    hasher.update(&case.to_le_bytes());
    first_u64(&hasher)
}

/// The seed of a stream with a purpose of its own (`label`), number `index` of its kind, under `root`.
///
/// BLAKE3(`root` as u64 LE ‖ `label` ‖ `index` as u64 LE), the first 8 bytes. Labels are never reused for another
/// purpose, nor renamed: the name is the stream.
pub fn named_seed(root: u64, label: &str, index: u64) -> u64 {
    let mut hasher = blake3::Hasher::new();
    hasher.update(&root.to_le_bytes());
    hasher.update(label.as_bytes());
    hasher.update(&index.to_le_bytes());
    first_u64(&hasher)
}

/// The generator for `seed`: its 128-bit state is BLAKE3 of the seed, so that neighbouring seeds share nothing.
///
/// ```
/// use hairpin::math::random::{named_seed, stream, unit};
///
/// let draws = |index| { let mut s = stream(named_seed(1, "documentation", index)); [unit(&mut s), unit(&mut s)] };
/// assert_eq!(draws(0), draws(0));
/// assert_ne!(draws(0), draws(1));
/// ```
pub fn stream(seed: u64) -> Stream {
    let digest = blake3::hash(&seed.to_le_bytes());
    let mut state = [0u8; 16];
    state.copy_from_slice(&digest.as_bytes()[..16]);
    Stream::new(u128::from_le_bytes(state))
}

/// A uniform number in [0, 1) from the 53 leading bits of the next word.
///
/// A multiple of 2⁻⁵³; 0 is possible, 1 is not.
pub fn unit(stream: &mut Stream) -> f64 {
    (stream.next_u64() >> 11) as f64 * (1.0 / (1u64 << 53) as f64)
}

/// A uniform number in [0, 1) that is a pure function of `seed` and `words` (SplitMix64 finaliser over each word):
/// a random score per leg without any state, the same whenever it is asked for.
///
/// Steele, Lea, Flood, "Fast Splittable Pseudorandom Number Generators" (OOPSLA 2014). Not for cryptography, nor for
/// long sequences.
pub fn hashed_unit(seed: u64, words: &[u64]) -> f64 {
    let mut h = seed;
    for &word in words {
        h = mix(h ^ mix(word.wrapping_add(0x9e37_79b9_7f4a_7c15)));
    }
    (mix(h) >> 11) as f64 * (1.0 / (1u64 << 53) as f64)
}

/// `N` independent standard normal numbers by Marsaglia's polar method, with `libm`: the same bits on every machine.
///
/// Pairs by rejection from the unit disc (accepted with π/4): the number of words taken varies, so a stream that draws
/// normals has no fixed position for what follows. An odd `N` throws the last partner away. Marsaglia and Bray, SIAM
/// Review 6(3), 1964.
pub fn standard_normals<const N: usize>(stream: &mut Stream) -> [f64; N] {
    let mut out = [0.0; N];
    for pair in out.chunks_mut(2) {
        let (x, y, scale) = loop {
            let [x, y] = [0, 1].map(|_| (stream.next_u64() >> 11) as f64 * (2.0 / (1u64 << 53) as f64) - 1.0);
            let s = x * x + y * y;
            if s > 0.0 && s < 1.0 {
                break (x, y, (-2.0 * libm::log(s) / s).sqrt());
            }
        };
        pair[0] = x * scale;
        if let Some(second) = pair.get_mut(1) {
            *second = y * scale;
        }
    }
    out
}

fn mix(mut z: u64) -> u64 {
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

fn first_u64(hasher: &blake3::Hasher) -> u64 {
    let digest = hasher.finalize();
    let mut first = [0u8; 8];
    first.copy_from_slice(&digest.as_bytes()[..8]);
    u64::from_le_bytes(first)
}

#[cfg(feature = "unit-tests")]
mod tests {
    use super::*;

    #[test]
    fn case_seeds_are_those_of_any_blake3() {
        // By the Python package `blake3`: int.from_bytes(blake3(pack("<QQ", 10, case)).digest()[:8], "little").
        assert_eq!([0, 1].map(|case| case_seed(10, case)), [10_123_337_457_212_612_031, 7_583_018_901_256_657_888]);
    }

    #[test]
    fn streams_differ_and_repeat() {
        assert_eq!(stream(7).next_u64(), stream(7).next_u64());
        assert_ne!(stream(7).next_u64(), stream(8).next_u64());
        assert_ne!(case_seed(1, 0), case_seed(0, 1));
        assert_ne!(named_seed(1, "graph", 0), named_seed(1, "wind", 0));
    }

    #[test]
    fn normals_have_the_moments_of_a_normal() {
        let mut stream = stream(11);
        let n = 60_000;
        let all: Vec<f64> = (0..n / 3).flat_map(|_| standard_normals::<3>(&mut stream)).collect();
        let moment = |k: i32| all.iter().map(|x| x.powi(k)).sum::<f64>() / n as f64;
        // Standard errors of the first four: 1, √2, √15, √96 over √n; four of them are allowed.
        for (k, (expected, spread)) in [(0.0, 1.0), (1.0, 1.42), (0.0, 3.88), (3.0, 9.8)].into_iter().enumerate() {
            let found = moment(k as i32 + 1);
            assert!((found - expected).abs() < 4.0 * spread / (n as f64).sqrt(), "moment {}: {found}", k + 1);
        }
    }

    #[test]
    fn hashed_units_are_uniform() {
        let n = 100_000;
        let mean = (0..n).map(|i| hashed_unit(3, &[i, 5])).sum::<f64>() / n as f64;
        assert!((mean - 0.5).abs() < 0.005, "{mean}");
    }
}
