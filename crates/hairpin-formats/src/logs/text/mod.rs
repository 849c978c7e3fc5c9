//! Logs as text: one pose a line.

mod columns;
mod csv;
mod tum;

use nalgebra::{Quaternion, UnitQuaternion};

use super::error::Fault;
use crate::bounds;

pub(super) use csv::read_csv;
pub(super) use tum::read_tum;

/// How far from 1 the length of a quaternion may be: logs round to three decimals.
const QUATERNION: f64 = 1e-2;
/// Farther than this no robot is logged from where it began: another unit, m.
const FARTHEST_M: f64 = 1e7;

/// The text, if it is one and no longer than tables may be.
pub(super) fn decode(bytes: &[u8]) -> Result<&str, Fault> {
    bounds::check_table(bytes).map_err(Fault::Unknown)?;
    std::str::from_utf8(bytes).map_err(|error| {
        let line = bytes[..error.valid_up_to()].iter().filter(|byte| **byte == b'\n').count() + 1;
        Fault::line(line, "no UTF-8 text")
    })
}

/// `world_from_body` of components that a line has, which must be of length 1.
fn attitude(w: f64, [x, y, z]: [f64; 3], line: usize) -> Result<UnitQuaternion<f64>, Fault> {
    let q = Quaternion::new(w, x, y, z);
    let length = q.norm();
    if (length - 1.0).abs() > QUATERNION {
        return Err(Fault::line(line, format!("a quaternion of length {length:.4}, must be 1")));
    }
    Ok(UnitQuaternion::from_quaternion(q))
}

/// Refuses a stamp that does not rise.
fn after(t_s: f64, before: Option<f64>, line: usize) -> Result<(), Fault> {
    match before {
        Some(before) if t_s <= before => {
            Err(Fault::line(line, format!("stamp {t_s} s after {before} s: stamps must rise")))
        }
        _ => Ok(()),
    }
}
