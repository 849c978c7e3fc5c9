//! What lines of text are held to, and the text itself.

use hairpin::campaign::bounds::SHORTEST_STEP_S;
use nalgebra::{Quaternion, UnitQuaternion};

use super::super::error::Fault;
use crate::bounds;

/// How far from 1 the length of a quaternion may be: logs round to three decimals.
const QUATERNION: f64 = 1e-2;
/// Farther than this no robot is logged from where it began: another unit, m.
pub(super) const FARTHEST_M: f64 = 1e7;

/// The text, if it is one and no longer than tables may be.
pub(in super::super) fn decode(bytes: &[u8]) -> Result<&str, Fault> {
    bounds::check_table(bytes).map_err(Fault::Unknown)?;
    std::str::from_utf8(bytes).map_err(|error| {
        let line = bytes[..error.valid_up_to()].iter().filter(|byte| **byte == b'\n').count() + 1;
        Fault::line(line, "no UTF-8 text")
    })
}

/// `world_from_body` of components that a line has, which must be of length 1.
pub(super) fn attitude(w: f64, [x, y, z]: [f64; 3], line: usize) -> Result<UnitQuaternion<f64>, Fault> {
    let q = Quaternion::new(w, x, y, z);
    let length = q.norm();
    if (length - 1.0).abs() > QUATERNION {
        return Err(Fault::line(line, format!("a quaternion of length {length:.4}, must be 1")));
    }
    Ok(UnitQuaternion::from_quaternion(q))
}

/// Refuses a stamp that does not rise, or too little to be divided by.
pub(super) fn after(t_s: f64, before: Option<f64>, line: usize) -> Result<(), Fault> {
    match before {
        Some(before) if t_s <= before => {
            Err(Fault::line(line, format!("stamp {t_s} s after {before} s: stamps must rise")))
        }
        Some(before) if t_s - before < SHORTEST_STEP_S => {
            let step = t_s - before;
            let what =
                format!("stamp {t_s:e} s is {step:e} s after the one before: must be at least {SHORTEST_STEP_S:e} s");
            Err(Fault::line(line, what))
        }
        _ => Ok(()),
    }
}

/// The step in which a number is written: of its last decimal.
pub(super) fn step(text: &str) -> f64 {
    let (digits, power) = text.split_once(['e', 'E']).unwrap_or((text, "0"));
    let decimals = digits.split_once('.').map_or(0, |(_, decimals)| decimals.len());
    let power = power.parse::<i32>().unwrap_or(0);
    libm::exp10(f64::from(power) - decimals as f64)
}
