//! Trajectories of the Crazyflie's high-level commander: pieces of four polynomials of seventh degree, x, y, z and yaw
//! of the time since the piece began. As rows of text, as its scripts have them, and compressed, as its memory has them
//! (bitcraze/crazyflie-firmware, docs/functional-areas/trajectory_formats.md).
//!
//! ```text
//! CSV          duration, 8 coefficients of x, of y, of z, of yaw, lowest order first; s, m, rad
//! compressed   x, y, z in mm and yaw in 0.1° at the start, 2 bytes each; then for each piece
//!              a byte of four kinds (x in the lowest two bits): 0 constant, 1 linear, 2 cubic, 3 of seventh degree,
//!              the duration in ms, 2 bytes, and the control points of its Bézier curves but the first, 2 bytes each
//! ```
//!
//! All integers are signed and begin with their lowest byte.

mod compressed;
mod fit;

#[cfg(test)]
mod tests;

pub use compressed::{Compressed, compress};
pub use fit::{Fitted, TOLERANCE, fit_profile, fit_track};

/// What the files' names end with.
pub const ENDING: &str = ".poly4d.csv";
/// What those of compressed trajectories end with.
pub const COMPRESSED_ENDING: &str = ".poly4d.bin";
/// Bytes of a piece that is not compressed, and of the memory that a Crazyflie has for them by default.
pub const PIECE_BYTES: usize = 132;
/// See [`PIECE_BYTES`].
pub const MEMORY_BYTES: usize = 4096;

/// A piece of a trajectory.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Piece {
    /// s.
    pub duration: f64,
    /// Of x, y, z (m) and yaw (rad), lowest order first.
    pub coefficients: [[f64; 8]; 4],
}

impl Piece {
    /// x, y, z and yaw after `tau` s, in single precision as the Crazyflie computes them.
    pub fn single(&self, tau: f64) -> [f64; 4] {
        self.coefficients.map(|c| f64::from(c.iter().rev().fold(0.0_f32, |sum, c| sum * tau as f32 + *c as f32)))
    }

    /// The same as they are meant.
    pub fn at(&self, tau: f64) -> [f64; 4] {
        self.coefficients.map(|c| c.iter().rev().fold(0.0, |sum, c| sum * tau + c))
    }
}

/// The text of pieces in their order; numbers are those of single precision.
pub fn text(pieces: &[Piece]) -> String {
    let names = ["x", "y", "z", "yaw"].map(|axis| (0..8).map(|i| format!("{axis}^{i}")).collect::<Vec<_>>().join(","));
    let mut text = format!("Duration,{}\n", names.join(","));
    for Piece { duration, coefficients } in pieces {
        text += &format!("{}", *duration as f32);
        for value in coefficients.iter().flatten() {
            text += &format!(",{}", *value as f32 + 0.0);
        }
        text.push('\n');
    }
    text
}
