//! Timed set points as CSV, for a companion computer that streams them: the only file of a flight or drive for an
//! autopilot that keeps when things happen.

use nalgebra::{Point3, Vector3};

/// What the files' names end with.
pub const ENDING: &str = ".setpoints.csv";
/// The columns: `t` in s, all else by its name; north, east and down of the stated home, yaw from north, clockwise.
pub const HEAD: &str =
    "t,north_m,east_m,down_m,v_north_m_s,v_east_m_s,v_down_m_s,a_north_m_s2,a_east_m_s2,a_down_m_s2,yaw_rad";

/// A moment.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Setpoint {
    /// Stamp, s.
    pub t: f64,
    /// North, east, down of home, m.
    pub position: Point3<f64>,
    /// m/s.
    pub velocity: Vector3<f64>,
    /// m/s².
    pub acceleration: Vector3<f64>,
    /// From north, clockwise, rad.
    pub yaw: f64,
}

/// The text of set points in their order.
pub fn text(setpoints: &[Setpoint]) -> String {
    let mut text = format!("{HEAD}\n");
    for Setpoint { t, position: p, velocity: v, acceleration: a, yaw } in setpoints {
        let vectors = [p.coords, *v, *a].map(|v| format!("{:.6},{:.6},{:.6}", v.x + 0.0, v.y + 0.0, v.z + 0.0));
        text += &format!("{t:.6},{},{:.6}\n", vectors.join(","), yaw + 0.0);
    }
    text
}
