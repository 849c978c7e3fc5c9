//! A planned motion as a table keeps it, as plain numbers for the verification room.

use crate::trajectory::Track;
use crate::verification::{Collector, Finding, PlannedRow, PlannedState, RowTolerances, verify_rows};

const VELOCITY: [&str; 3] = ["vx_m_s", "vy_m_s", "vz_m_s"];
const LEG: &str = "leg";
/// Stamps as near as this are one, s.
const SAME_TIME: f64 = 1e-6;

/// The rows of a planned motion that are kept of a case.
#[derive(Debug, Clone, Copy)]
pub struct PlannedRows<'a> {
    /// They themselves.
    pub rows: &'a Track,
    /// The time between samples, s, where only the rows are there that stand for such samples.
    pub period: Option<f64>,
}

impl PlannedRows<'_> {
    /// All rows, and between those that are farther apart than samples the sample nearest to the middle: what was left
    /// out there is off the most about there.
    pub(in crate::campaign) fn with_middles(&self) -> Vec<PlannedRow> {
        let stamps = self.period.filter(|period| *period > 0.0).map(|period| {
            let middle = move |pair: &[f64]| {
                let sample = (0.5 * (pair[0] + pair[1]) / period).round() * period;
                let is_between = sample > pair[0] + 0.5 * period && sample < pair[1] - 0.5 * period;
                is_between.then_some(sample)
            };
            self.rows.times().windows(2).filter_map(middle).collect()
        });
        self.with(stamps.unwrap_or_default())
    }

    /// All rows, and what they lead to at the `stamps` (s) between them.
    fn with(&self, stamps: Vec<f64>) -> Vec<PlannedRow> {
        let (rows, columns) = (self.rows, Columns::of(self.rows));
        let row = |i: usize| {
            let values: Vec<f64> = rows.channels().iter().map(|channel| channel.values[i]).collect();
            columns.row(rows.times()[i], &rows.poses()[i], &values, 0.0)
        };
        let between = |t: f64| {
            let next = rows.times().partition_point(|time| *time <= t);
            let (from, to) = (rows.times().get(next.checked_sub(1)?)?, rows.times().get(next)?);
            let (pose, values) = rows.at(t)?;
            Some(columns.row(t, &pose, &values, to - from))
        };
        (0..rows.len()).map(row).chain(stamps.into_iter().filter_map(between)).collect()
    }

    /// Holds the rows, and what they lead to wherever `planned` has a stamp, to `planned`: the motion of the case's
    /// witness.
    ///
    /// Where all samples are there the rows are held alone.
    pub(in crate::campaign) fn against(&self, planned: &Track, tolerances: &RowTolerances) -> Vec<Finding> {
        let (Some(first), Some(last)) = (planned.times().first(), planned.times().last()) else {
            let mut findings = Vec::new();
            Collector::about(&mut findings, "planned").refuse("its witness has no motion to hold rows to".into());
            return findings;
        };
        let stamps = if self.period.is_some() { planned.times().to_vec() } else { Vec::new() };
        let columns = Columns::of(planned);
        let state = |t: f64| {
            let (pose, values) = planned.at(t).expect("it has stamps");
            let PlannedRow { position, attitude, velocity, .. } = columns.row(t, &pose, &values, 0.0);
            let stamp = planned.times().partition_point(|time| *time <= t + SAME_TIME).max(1) - 1;
            let leg = columns.leg.map_or(0.0, |leg| planned.channels()[leg].values[stamp]);
            PlannedState {
                leg: leg as usize,
                position,
                attitude: Some(attitude),
                velocity: velocity.unwrap_or([0.0; 3]),
            }
        };
        verify_rows(&self.with(stamps), tolerances, [*first, *last], state)
    }
}

/// Which channels are read.
struct Columns {
    leg: Option<usize>,
    velocity: Option<[usize; 3]>,
}

impl Columns {
    fn of(track: &Track) -> Self {
        let place = |name: &str| track.channels().iter().position(|channel| channel.name == name);
        let velocity = match VELOCITY.map(place) {
            [Some(x), Some(y), Some(z)] => Some([x, y, z]),
            _ => None,
        };
        Self { leg: place(LEG), velocity }
    }

    fn row(&self, t: f64, pose: &nalgebra::Isometry3<f64>, values: &[f64], gap: f64) -> PlannedRow {
        let q = pose.rotation.quaternion();
        PlannedRow {
            t,
            leg: self.leg.map(|leg| values[leg]),
            position: pose.translation.vector.into(),
            attitude: [q.w, q.i, q.j, q.k],
            velocity: self.velocity.map(|velocity| velocity.map(|axis| values[axis])),
            gap,
        }
    }
}

#[cfg(feature = "unit-tests")]
mod tests {
    use nalgebra::{Isometry3, Translation3, UnitQuaternion};

    use super::*;
    use crate::trajectory::Channel;
    use crate::trajectory::between::period;

    /// Round a circle of 1 m at 1 m/s, a row every `step` s of `parts`.
    fn circle(step: f64, parts: usize) -> Track {
        let times: Vec<f64> = (0..=parts).map(|k| step * k as f64).collect();
        let pose = |t: &f64| {
            let (sin, cos) = libm::sincos(*t);
            Isometry3::from_parts(Translation3::new(sin, -cos, 0.0), UnitQuaternion::identity())
        };
        let column = |name: &str, of: fn(f64) -> f64| Channel {
            name: name.into(),
            values: times.iter().map(|t| of(*t)).collect(),
        };
        let channels = vec![
            column(LEG, |_| 0.0),
            column("vx_m_s", libm::cos),
            column("vy_m_s", libm::sin),
            column("vz_m_s", |_| 0.0),
        ];
        Track::new(times.clone(), times.iter().map(pose).collect(), channels).unwrap()
    }

    /// One row in ten stands for all; every column that is off, a row that is not there and a place that rows no longer
    /// lead to are found.
    #[test]
    fn kept_rows_are_held_to_the_motion_between_them_too() {
        let planned = circle(0.02, 100);
        let kept: Vec<usize> = (0..=10).map(|k| 10 * k).collect();
        let rows = planned.picked(&kept);
        let told = |rows: &Track| {
            let findings = PlannedRows { rows, period: period(&planned) }.against(&planned, &RowTolerances::default());
            findings.into_iter().map(|finding| finding.field).collect::<Vec<_>>().join(" ")
        };
        assert_eq!(told(&rows), "");
        assert_eq!(PlannedRows { rows: &rows, period: period(&planned) }.with_middles().len(), 21);
        let shifted = |at: usize, x: f64| {
            let poses = rows.poses().iter().enumerate().map(|(i, pose)| match i == at {
                true => Translation3::new(x, 0.0, 0.0) * *pose,
                false => *pose,
            });
            Track::new(rows.times().to_vec(), poses.collect(), rows.channels().to_vec()).unwrap()
        };
        assert_eq!(told(&shifted(5, 3.0)), "legs[0].planned.position");
        assert_eq!(told(&shifted(10, 0.001)), "legs[0].planned.position");
        assert_eq!(told(&planned.picked(&[0, 10, 20, 90, 100])), "legs[0].planned.position");
        assert_eq!(told(&planned.picked(&kept[..10])), "legs[0].planned.end");
        let mut channels = rows.channels().to_vec();
        channels[3].values[4] = 0.01;
        let climbing = Track::new(rows.times().to_vec(), rows.poses().to_vec(), channels).unwrap();
        assert!(told(&climbing).contains("planned.velocity"), "{}", told(&climbing));
    }
}
