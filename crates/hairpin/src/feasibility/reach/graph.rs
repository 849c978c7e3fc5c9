//! A graph's waypoints by coordinate, and the box test over all of them at once.

use multiversion::multiversion;
use nalgebra::{Point3, Vector3};

/// Waypoints per word of the box test's answer.
const WORD: usize = 64;

/// Waypoints, one array per coordinate, padded to whole words with points that are in no box.
#[derive(Debug, Clone)]
pub(crate) struct Graph {
    words: Vec<[[f64; WORD]; 3]>,
    len: usize,
}

impl Graph {
    pub(crate) fn new(points: &[Point3<f64>]) -> Self {
        let mut words = vec![[[f64::NAN; WORD]; 3]; points.len().div_ceil(WORD)];
        for (i, point) in points.iter().enumerate() {
            for axis in 0..3 {
                words[i / WORD][axis][i % WORD] = point[axis];
            }
        }
        Self { words, len: points.len() }
    }

    pub(crate) fn len(&self) -> usize {
        self.len
    }

    #[inline]
    pub(crate) fn point(&self, index: u32) -> Vector3<f64> {
        let word = &self.words[index as usize / WORD];
        let lane = index as usize % WORD;
        Vector3::new(word[0][lane], word[1][lane], word[2][lane])
    }

    /// Calls `each` with every waypoint in the box, in rising order.
    #[inline]
    pub(crate) fn inside(&self, min: &Vector3<f64>, max: &Vector3<f64>, mut each: impl FnMut(u32)) {
        let (min, max) = ([min.x, min.y, min.z], [max.x, max.y, max.z]);
        for (number, word) in self.words.iter().enumerate() {
            let mut bits = in_box(word, min, max);
            while bits != 0 {
                each((number * WORD) as u32 + bits.trailing_zeros());
                bits &= bits - 1;
            }
        }
    }
}

/// Bit i: waypoint i of the word lies in the box.
#[multiversion(targets("x86_64+avx512f+avx512vl+avx512dq+avx512bw", "x86_64+avx2", "aarch64+neon"))]
fn in_box(word: &[[f64; WORD]; 3], min: [f64; 3], max: [f64; 3]) -> u64 {
    let mut bits = 0u64;
    for group in 0..WORD / 8 {
        let mut byte = 0u8;
        for lane in 0..8 {
            let i = group * 8 + lane;
            let (x, y, z) = (word[0][i], word[1][i], word[2][i]);
            let inside = (x >= min[0]) & (x <= max[0]) & (y >= min[1]) & (y <= max[1]) & (z >= min[2]) & (z <= max[2]);
            byte |= (inside as u8) << lane;
        }
        bits |= (byte as u64) << (group * 8);
    }
    bits
}
