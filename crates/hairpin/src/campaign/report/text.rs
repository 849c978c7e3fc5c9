//! Findings and cases in words and cells: as in the terminal, so in the report.

use nalgebra::{UnitQuaternion, Vector3};

use super::length::Length;
use crate::campaign::CaseResult;
use crate::campaign::digits::{number, percent};
use crate::judgement::{Measures, Violation};

/// `nose up 12°, left side down 8°`: how far the body's forward and left axes point above or below the horizon, which
/// needs no convention of signs; `upside down` is said too. The body is forward, left, up.
///
/// Angles are asin of the axis's z component in the world, to whole degrees; sides at 0° are not told. Level is
/// `level`.
pub fn attitude(world_from_body: &UnitQuaternion<f64>) -> String {
    let side = |name: &str, axis: Vector3<f64>| {
        let degrees = (world_from_body * axis).z.clamp(-1.0, 1.0).asin().to_degrees().round();
        let way = if degrees > 0.0 { "up" } else { "down" };
        (degrees != 0.0).then(|| format!("{name} {way} {}°", degrees.abs()))
    };
    let turned = (world_from_body * Vector3::z()).z < 0.0;
    let parts: Vec<String> = [side("nose", Vector3::x()), side("left side", Vector3::y())]
        .into_iter()
        .flatten()
        .chain(turned.then(|| "upside down".to_owned()))
        .collect();
    if parts.is_empty() { "level".into() } else { parts.join(", ") }
}

/// `4→5`: the leg that joins waypoints 4 and 5.
pub fn leg(leg: usize) -> String {
    format!("{leg}→{}", leg + 1)
}

/// `deviation 0.65 m > 0.50 m at t=12.34 s`; events (`crash`, `left-world`, `stalled`, `unfinished`) say what happened
/// instead.
pub fn violation(violation: &Violation) -> String {
    violation.in_words()
}

/// Headers of the table of cases, in the terminal and in the report.
pub const COLUMNS: [&str; 11] = [
    "case",
    "status",
    "max deviation m",
    "at t s",
    "leg",
    "mean deviation m",
    "overshoot m",
    "acceleration m/s²",
    "saturated",
    "time s",
    "ended",
];

/// [`COLUMNS`] where lengths are told in another unit.
pub fn columns_in(length: &Length) -> [String; 11] {
    COLUMNS.map(|name| match name.strip_suffix(" m") {
        Some(what) => format!("{what} {}", length.unit),
        None => name.to_owned(),
    })
}

/// One row of the table of cases, under [`columns_in`].
///
/// Lengths have the digits of their limit, as in the verdict. What was not measured is a dash. Cases are numbered with
/// four digits, saturation is a share in percent. Of several runs each measure is the worst of all.
pub fn cells_in(length: &Length, result: &CaseResult) -> [String; 11] {
    let measured = result.measured();
    let deviating = measured.filter(|measures| measures.deviation().is_some());
    let long = |value: Option<f64>| value.map_or("–".into(), |value| length.number(value));
    [
        result.case.to_string(),
        result.status.word().into(),
        long(deviating.map(|m| m.max_deviation)),
        deviating.map_or("–".into(), |m| format!("{:.2}", m.t_worst)),
        deviating.map_or("–".into(), |m| leg(m.leg_worst)),
        long(deviating.map(|m| m.mean_deviation)),
        long(measured.map(Measures::max_overshoot)),
        number(measured.and_then(Measures::acceleration)),
        percent(measured.and_then(|m| m.saturation_share)),
        number(measured.map(|m| m.total_time)),
        result.ended.clone(),
    ]
}

#[cfg(feature = "unit-tests")]
mod tests {
    use super::*;

    fn deviation(value: f64, limit: f64) -> Violation {
        Violation { what: "deviation".into(), value, limit, unit: "m".into(), at: 12.34, leg: 4 }
    }

    #[test]
    fn a_leg_is_told_by_its_ends() {
        assert_eq!(leg(4), "4→5");
    }

    #[test]
    fn a_violation_reads_as_in_the_contract() {
        assert_eq!(violation(&deviation(0.65, 0.5)), "deviation 0.65 m > 0.50 m at t=12.34 s");
        assert_eq!(violation(&deviation(0.5004, 0.5)), "deviation 0.5004 m > 0.5000 m at t=12.34 s");
        let crash = Violation { what: "crash".into(), value: 3.0, limit: 0.0, unit: "s".into(), at: 3.0, leg: 0 };
        assert_eq!(violation(&crash), "crash at t=3.00 s");
        let near = Violation { what: "clearance".into(), value: 0.1, limit: 0.25, unit: "m".into(), at: 1.0, leg: 0 };
        assert_eq!(violation(&near), "clearance 0.10 m < 0.25 m at t=1.00 s");
    }

    #[test]
    fn attitudes_are_said_as_people_say_them() {
        let of = |roll: f64, pitch: f64, yaw: f64| {
            let degrees = [roll, pitch, yaw].map(f64::to_radians);
            attitude(&UnitQuaternion::from_euler_angles(degrees[0], degrees[1], degrees[2]))
        };
        // Forward, left, up: a positive pitch is nose down, a positive roll lifts the left side; yaw says nothing.
        assert_eq!(of(0.0, -12.0, 130.0), "nose up 12°");
        assert_eq!(of(8.0, 0.0, -75.0), "left side up 8°");
        assert_eq!(of(-20.0, 30.0, 10.0), "nose down 30°, left side down 17°");
        assert_eq!(of(180.0, 0.0, 40.0), "upside down");
        assert_eq!(of(0.2, -0.3, 77.0), "level");
    }
}
