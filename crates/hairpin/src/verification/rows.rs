//! Rows of a planned motion, as a table keeps them, against the witness that was integrated: place, attitude, velocity
//! and leg at each row's time, and place and attitude of what rows lead to between them.
//!
//! A witness that holds says nothing of a table beside it, and executors and exports are handed the table. Polynomials
//! are evaluated here, and what they demand is the thrust's direction; the motion of other witnesses is handed in.

use nalgebra::{Matrix3, Rotation3, UnitQuaternion, Vector3};

use super::body::Body;
use super::claim::Leg;
use super::finding::{Collector, Finding};

/// What a row may be off.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RowTolerances {
    /// m.
    pub position: f64,
    /// rad.
    pub attitude: f64,
    /// m/s.
    pub velocity: f64,
}

impl Default for RowTolerances {
    /// 0.1 mm and 0.002 rad, which tables of planned motions tell of themselves, and 0.1 mm/s: more than the steps in
    /// which their rows are written.
    fn default() -> Self {
        Self { position: 1e-4, attitude: 2e-3, velocity: 1e-4 }
    }
}

/// What the steps of velocities lead to, m a second between two rows.
const DRIFT: f64 = 2e-5;
/// Times as near as this are one, s.
const SAME_TIME: f64 = 1e-6;
/// Numbers that another program wrote again may have single precision.
const SINGLE: f64 = f32::EPSILON as f64;

/// A row of a planned motion, or what two rows lead to between them; world frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PlannedRow {
    /// Since the start, s.
    pub t: f64,
    /// The leg that it says it is of, where it does.
    pub leg: Option<f64>,
    /// m.
    pub position: [f64; 3],
    /// Unit quaternion, w first.
    pub attitude: [f64; 4],
    /// m/s, where it is told.
    pub velocity: Option<[f64; 3]>,
    /// Seconds between the two rows that it lies between; 0 of a row.
    pub gap: f64,
}

/// Where the witness is at some time; world frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PlannedState {
    /// The leg.
    pub leg: usize,
    /// m.
    pub position: [f64; 3],
    /// Unit quaternion, w first; `None` where none is defined.
    pub attitude: Option<[f64; 4]>,
    /// m/s.
    pub velocity: [f64; 3],
}

/// What is off the most, by its bound.
#[derive(Debug, Clone, Copy, Default)]
struct Off {
    share: f64,
    value: f64,
    bound: f64,
    leg: usize,
    at: f64,
}

impl Off {
    fn note(&mut self, value: f64, bound: f64, leg: usize, at: f64) {
        let share = value / bound;
        if share > self.share || share.is_nan() {
            *self = Self { share, value, bound, leg, at };
        }
    }

    fn tell(&self, findings: &mut Vec<Finding>, field: &str, unit: &'static str) {
        Collector::on_leg(findings, self.leg, self.at).above(field, self.value, self.bound, unit);
    }
}

/// Holds `rows` to a motion that lasts from `start` to `end` (s) and is at `state` at each time: of every quantity that
/// is off by more than rows are written with, the row that is off the most.
///
/// Fields of findings: `legs[k].planned.position`, `.attitude`, `.velocity`, `.leg`, `.start` and `.end`, with the leg
/// and the time of the row. What is between rows has a place and an attitude alone. Linear in rows.
///
/// ```text
/// off ≤ position + ε(|p| + |v| t) + 2 · 10⁻⁵ m/s · gap,   attitude + ε,   velocity + ε|v|,   ε = 2⁻²³
/// ```
pub fn verify_rows(
    rows: &[PlannedRow],
    tolerances: &RowTolerances,
    [start, end]: [f64; 2],
    state: impl Fn(f64) -> PlannedState,
) -> Vec<Finding> {
    let mut findings = Vec::new();
    let own = || rows.iter().filter(|row| row.gap <= 0.0);
    let (Some(first), Some(last)) = (own().next(), own().next_back()) else {
        Collector::about(&mut findings, "planned").refuse("the planned motion has no rows".into());
        return findings;
    };
    let same = |t: f64| SAME_TIME + SINGLE * t.abs();
    for (field, row, at) in [("planned.start", first, start), ("planned.end", last, end)] {
        let leg = state(row.t).leg;
        Collector::on_leg(&mut findings, leg, row.t).above(field, (row.t - at).abs(), same(at), "s");
    }
    let [mut position, mut attitude, mut velocity, mut of_leg] = [Off::default(); 4];
    for row in rows {
        let now = state(row.t);
        let speed = norm(now.velocity);
        let within = tolerances.position + SINGLE * (norm(now.position) + speed * row.t.abs()) + DRIFT * row.gap;
        position.note(norm(less(row.position, now.position)), within, now.leg, row.t);
        if let Some(wanted) = now.attitude {
            attitude.note(angle(row.attitude, wanted), tolerances.attitude + SINGLE, now.leg, row.t);
        }
        if row.gap > 0.0 {
            continue;
        }
        if let Some(told) = row.velocity {
            let off = norm(less(told, now.velocity));
            velocity.note(off, tolerances.velocity + SINGLE * speed, now.leg, row.t);
        }
        // A row at a waypoint is of either leg.
        let is_of = |t: f64| row.leg == Some(state(t).leg as f64);
        if let Some(leg) = row.leg
            && !(leg == now.leg as f64 || is_of(row.t - same(row.t)) || is_of(row.t + same(row.t)))
        {
            of_leg.note((leg - now.leg as f64).abs(), 0.5, now.leg, row.t);
        }
    }
    position.tell(&mut findings, "planned.position", "m");
    attitude.tell(&mut findings, "planned.attitude", "rad");
    velocity.tell(&mut findings, "planned.velocity", "m/s");
    of_leg.tell(&mut findings, "planned.leg", "");
    findings
}

/// Holds the rows of a flight's planned motion to its polynomials and to the attitudes that they demand.
///
/// `legs` are those of a claim that holds. Without legs nothing is claimed, and nothing found.
pub fn verify_flight_rows(body: &Body, legs: &[Leg], rows: &[PlannedRow]) -> Vec<Finding> {
    let Some(clock) = Clock::new(legs.iter().map(|leg| leg.duration)) else { return Vec::new() };
    verify_rows(rows, &RowTolerances::default(), [0.0, clock.end], |t| {
        let (leg, tau) = clock.due(t);
        let taylor = legs[leg].taylor(tau);
        let velocity = taylor.map(|p| p[1]);
        let attitude = thrust_attitude(body, Vector3::from(velocity), Vector3::from(taylor.map(|p| 2.0 * p[2])));
        PlannedState { leg, position: taylor.map(|p| p[0]), attitude, velocity }
    })
}

/// z along the thrust m (p̈ + g e₃) + (c₁ + c₂|v|) v, x without a part along the world's y: yaw 0.
///
/// `None` in free fall and where the thrust points along y.
fn thrust_attitude(body: &Body, v: Vector3<f64>, acceleration: Vector3<f64>) -> Option<[f64; 4]> {
    let lifted = acceleration + Vector3::new(0.0, 0.0, body.gravity);
    let force = lifted * body.mass + v * (body.drag_linear + body.drag_quadratic * v.norm());
    let z = force.try_normalize(1e-9)?;
    let x = Vector3::new(z.z, 0.0, -z.x).try_normalize(1e-6)?;
    let axes = Rotation3::from_matrix_unchecked(Matrix3::from_columns(&[x, z.cross(&x), z]));
    let q = UnitQuaternion::from_rotation_matrix(&axes);
    Some([q.w, q.i, q.j, q.k])
}

/// Which leg is due when.
#[derive(Debug)]
pub(super) struct Clock {
    /// When each leg begins, s.
    starts: Vec<f64>,
    /// When the last one ends, s.
    pub(super) end: f64,
}

impl Clock {
    /// Of legs that take `durations`, s; `None` without legs.
    pub(super) fn new(durations: impl Iterator<Item = f64>) -> Option<Self> {
        let (mut starts, mut end) = (Vec::new(), 0.0);
        for duration in durations {
            starts.push(end);
            end += duration;
        }
        (!starts.is_empty()).then_some(Self { starts, end })
    }

    /// The leg at `t`, and the time since it began, s; before the start and after the end as there.
    pub(super) fn due(&self, t: f64) -> (usize, f64) {
        let leg = self.starts.partition_point(|start| *start <= t).max(1) - 1;
        let ends = self.starts.get(leg + 1).copied().unwrap_or(self.end);
        (leg, t.min(ends).max(self.starts[leg]) - self.starts[leg])
    }
}

fn less(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|i| a[i] - b[i])
}

fn norm(v: [f64; 3]) -> f64 {
    Vector3::from(v).norm()
}

/// Between two attitudes, rad: twice the distance of their quaternions, whichever of ±q is nearer; of larger angles
/// less, and never 0.
fn angle(a: [f64; 4], b: [f64; 4]) -> f64 {
    let distance = |sign: f64| {
        let square: f64 = a.iter().zip(b).map(|(a, b)| (a - sign * b) * (a - sign * b)).sum();
        square.sqrt()
    };
    2.0 * distance(1.0).min(distance(-1.0))
}

#[cfg(feature = "unit-tests")]
mod tests {
    use super::*;
    use crate::verification::body::RotorPlace;

    const BODY: Body = Body {
        mass: 1.0,
        inertia: [0.0049, 0.0049, 0.0069],
        rotors: [RotorPlace { x: 0.08, y: 0.08, spin: 1.0 }; 4],
        thrust_coefficient: 1.91e-6,
        moment_coefficient: 2.6e-7,
        rotor_speed: (0.0, 2200.0),
        rotor_time_constant: 0.02,
        drag_linear: 0.0,
        drag_quadratic: 0.0,
        aerodynamic_moment: 0.0,
        gravity: 9.81,
    };

    /// Two legs at an even 1 m/s² along x, of 2 s and 1 s: a thrust that leans forward by atan(1/9.81).
    fn legs() -> [Leg; 2] {
        let leg = |duration, from: [f64; 3]| {
            let mut coefficients = [[0.0; 8]; 3];
            coefficients[0][..3].copy_from_slice(&from);
            Leg { duration, coefficients }
        };
        [leg(2.0, [0.0, 0.0, 0.5]), leg(1.0, [2.0, 2.0, 0.5])]
    }

    fn rows() -> Vec<PlannedRow> {
        let lean = 0.5 * libm::atan2(1.0, 9.81);
        let row = |k: usize| {
            let t = 0.5 * k as f64;
            PlannedRow {
                t,
                leg: Some(if k < 4 { 0.0 } else { 1.0 }),
                position: [0.5 * t * t, 0.0, 0.0],
                attitude: [libm::cos(lean), 0.0, libm::sin(lean), 0.0],
                velocity: Some([t, 0.0, 0.0]),
                gap: 0.0,
            }
        };
        (0..=6).map(row).collect()
    }

    fn fields(change: impl FnOnce(&mut Vec<PlannedRow>)) -> String {
        let mut rows = rows();
        change(&mut rows);
        let findings = verify_flight_rows(&BODY, &legs(), &rows);
        findings.iter().map(|finding| finding.field.as_str()).collect::<Vec<_>>().join(" ")
    }

    #[test]
    fn rows_of_the_witness_hold_and_each_column_that_is_off_is_found() {
        assert_eq!(verify_flight_rows(&BODY, &legs(), &rows()), []);
        assert_eq!(fields(|rows| rows[3].position[2] = 3.0), "legs[0].planned.position");
        assert_eq!(fields(|rows| rows[5].velocity = Some([2.5, 0.01, 0.0])), "legs[1].planned.velocity");
        assert_eq!(fields(|rows| rows[5].attitude = [1.0, 0.0, 0.0, 0.0]), "legs[1].planned.attitude");
        assert_eq!(fields(|rows| rows[1].leg = Some(1.0)), "legs[0].planned.leg");
        assert_eq!(fields(|rows| rows[2].t = 1.01), "legs[0].planned.position legs[0].planned.velocity");
        assert_eq!(fields(|rows| rows.truncate(6)), "legs[1].planned.end");
        assert_eq!(fields(|rows| *rows = rows.split_off(1)), "legs[0].planned.start");
        assert_eq!(fields(Vec::clear), "the planned motion has no rows");
    }

    /// What single precision and the other sign of a quaternion make of a row, and the leg of a row at a waypoint.
    #[test]
    fn what_means_the_same_is_the_same() {
        let again = fields(|rows| {
            for row in &mut *rows {
                row.t = f64::from(row.t as f32);
                row.position = row.position.map(|x| f64::from((x + 4e-6) as f32));
                row.attitude = row.attitude.map(|x| -f64::from(x as f32));
            }
            rows[4].leg = Some(0.0);
        });
        assert_eq!(again, "");
    }

    /// The row that is off the most is told, with its time and its bound; between rows no velocity is.
    #[test]
    fn the_worst_row_is_told() {
        let mut all = rows();
        all[1].position[1] = 0.5;
        all[5].position[1] = -3.0;
        all[6].gap = 0.5;
        all[6].velocity = Some([9.0; 3]);
        all.push(PlannedRow { gap: 0.0, ..rows()[6] });
        let findings = verify_flight_rows(&BODY, &legs(), &all);
        let [Finding { value, bound, leg, at, .. }] = &findings[..] else { panic!("{findings:?}") };
        assert!((*value - 3.0).abs() < 1e-9 && *bound < 2e-4, "{findings:?}");
        assert_eq!((*leg, *at), (1, 2.5));
    }
}
