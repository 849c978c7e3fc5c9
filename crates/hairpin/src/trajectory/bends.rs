//! The rows of a track where it bends: a few of them say what thousands do, by the motion
//! [between](super::between) them.
//!
//! ```text
//! within(i, j):  for every row i < r < j
//!     |p(r) − p̂(r)|² / position²  ≤ 1                       all three axes together, cubic or line
//!     |v(r) − v̂(r)|  / (share · range)  ≤ 1                 each axis, where there are velocities
//!     2 (1 − |q·q̂|) / attitude²  ≤ 1                        |q − q̂|² of unit quaternions, the nearer of both signs
//!     |c(r) − ĉ(r)|  / (share · range)  ≤ 1                 every other channel but `leg`
//! ```
//!
//! Hats are the motion between rows i and j alone. The bounds hold at the rows that were there, not between them. A
//! channel that is constant has a tolerance of 10⁻⁹ in its own unit.

use std::collections::BTreeSet;

use super::between::{VELOCITY, dot, nearer, place, rate, velocity_of};
use super::track::Track;

/// How far the motion between rows may be from the rows that are left out.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tolerances {
    /// Of positions, m.
    pub position: f64,
    /// Of attitudes, as the distance between unit quaternions: half the angle, rad.
    pub attitude: f64,
    /// Of every other column, as a share of its range.
    pub share: f64,
}

impl Default for Tolerances {
    /// 0.1 mm, a thousandth and a hundredth.
    fn default() -> Self {
        Self { position: 1e-4, attitude: 1e-3, share: 0.01 }
    }
}

/// The rows to keep so that the motion between them stays within `tolerances` of all others: both ends, those in
/// `marked`, those before and after every change of the channel `leg` and of whether `saturated` is 0, and of the rest
/// from each row the farthest one that the motion reaches within them.
///
/// Farthest as doubled and halved strides find it. Where nearer rows are reached whenever farther ones are, no choice
/// has fewer rows. Linear in rows and columns, times the logarithm of the longest stride.
pub fn bends(track: &Track, marked: &BTreeSet<usize>, tolerances: &Tolerances) -> Vec<usize> {
    let Some(last) = track.len().checked_sub(1) else { return Vec::new() };
    let columns = Columns::of(track, tolerances);
    let (mut rows, mut stride, mut errors) = (vec![0], 1, Vec::new());
    for end in always(track, marked, last).into_iter().skip(1) {
        while let from = rows[rows.len() - 1]
            && from < end
        {
            let to = columns.reach(from, end, stride, &mut errors);
            stride = to - from;
            rows.push(to);
        }
    }
    rows
}

/// The rows that are kept whatever the motion does, both ends among them.
fn always(track: &Track, marked: &BTreeSet<usize>, last: usize) -> BTreeSet<usize> {
    let mut kept: BTreeSet<usize> = marked.iter().copied().filter(|row| *row <= last).collect();
    kept.extend([0, last]);
    let mut at_changes = |channel: &str, differ: fn(f64, f64) -> bool| {
        let pairs = track.channel(channel).unwrap_or_default().windows(2).enumerate();
        kept.extend(pairs.filter(|(_, pair)| differ(pair[0], pair[1])).flat_map(|(row, _)| [row, row + 1]));
    };
    at_changes("leg", |a, b| a != b);
    at_changes("saturated", |a, b| (a == 0.0) != (b == 0.0));
    kept
}

/// The columns of a track, side by side.
struct Columns<'a> {
    times: &'a [f64],
    position: [Vec<f64>; 3],
    velocity: Option<[&'a [f64]; 3]>,
    attitude: [Vec<f64>; 4],
    /// Each with one by its tolerance.
    others: Vec<(&'a [f64], f64)>,
    /// One by the tolerance of velocities.
    velocity_scale: [f64; 3],
    /// One by the squares of the tolerances.
    position_scale: f64,
    attitude_scale: f64,
}

impl<'a> Columns<'a> {
    fn of(track: &'a Track, tolerances: &Tolerances) -> Self {
        let scale = |values: &[f64]| {
            let (low, high) = values.iter().fold((f64::MAX, f64::MIN), |(low, high), v| (low.min(*v), high.max(*v)));
            1.0 / (tolerances.share * (high - low)).max(1e-9)
        };
        let velocity = velocity_of(track);
        let others = track.channels().iter().filter(|channel| channel.name != "leg");
        let others = others.filter(|channel| velocity.is_none() || !VELOCITY.contains(&channel.name.as_str()));
        Self {
            times: track.times(),
            position: std::array::from_fn(|axis| track.poses().iter().map(|p| p.translation.vector[axis]).collect()),
            velocity,
            attitude: std::array::from_fn(|i| track.poses().iter().map(|p| p.rotation.coords[i]).collect()),
            others: others.map(|channel| (channel.values.as_slice(), scale(&channel.values))).collect(),
            velocity_scale: velocity.map_or([0.0; 3], |columns| columns.map(scale)),
            position_scale: 1.0 / (tolerances.position * tolerances.position),
            attitude_scale: 1.0 / (tolerances.attitude * tolerances.attitude),
        }
    }

    /// The farthest row, `end` at most, that the motion from `from` reaches with all rows between within tolerance.
    ///
    /// Strides grow from `stride` by doubling what is added, and are halved between the last that was within and the
    /// first that was not.
    ///
    /// At least `from` + 1. A stretch that is within although a shorter one is not may be passed by: the answer is
    /// within tolerance in any case.
    fn reach(&self, from: usize, end: usize, stride: usize, errors: &mut Vec<f64>) -> usize {
        let (mut within, mut beyond, mut more) = (from + 1, end + 1, (stride / 8).max(1));
        let mut next = (from + stride).clamp(within, end);
        loop {
            if self.within(from, next, errors) {
                within = next
            } else {
                beyond = next
            }
            if beyond - within <= 1 {
                return within;
            }
            next = if beyond > end { (within + more).min(end) } else { within.midpoint(beyond) };
            more *= 2;
        }
    }

    /// Whether all rows between two are within tolerance of the motion between these.
    ///
    /// Column by column, as most spans that are too long are so in the first ones. Errors are squares of tolerances.
    ///
    /// `errors` is scratch, one entry a row between. Rows that are neighbours are always within. O((to − from) ·
    /// columns).
    fn within(&self, from: usize, to: usize, errors: &mut Vec<f64>) -> bool {
        if to - from < 2 {
            return true;
        }
        let (inside, span) = (from + 1..to, self.times[to] - self.times[from]);
        let share = |row: usize| (self.times[row] - self.times[from]) / span;
        let none_over = |errors: &[f64]| errors.iter().all(|error| *error <= 1.0);
        errors.clear();
        errors.resize(inside.len(), 0.0);
        for axis in 0..3 {
            let values = &self.position[axis];
            let ends = [values[from], values[to]];
            let speeds = self.velocity.map(|columns| [columns[axis][from] * span, columns[axis][to] * span]);
            for (error, row) in errors.iter_mut().zip(inside.clone()) {
                let off = place(share(row), ends, speeds) - values[row];
                *error += off * off * self.position_scale;
            }
        }
        if !none_over(errors) {
            return false;
        }
        if let Some(columns) = self.velocity {
            for ((axis, values), scale) in columns.into_iter().enumerate().zip(self.velocity_scale) {
                let ends = [self.position[axis][from], self.position[axis][to]];
                let speeds = [values[from] * span, values[to] * span];
                for (error, row) in errors.iter_mut().zip(inside.clone()) {
                    let off = (rate(share(row), ends, speeds) / span - values[row]) * scale;
                    *error = error.max(off * off);
                }
            }
        }
        let [a, b] = [from, to].map(|row| self.attitude_of(row));
        let b = nearer(&a, b);
        for (error, row) in errors.iter_mut().zip(inside.clone()) {
            let (share, q) = (share(row), self.attitude_of(row));
            let at: [f64; 4] = std::array::from_fn(|i| a[i] + (b[i] - a[i]) * share);
            let cosine = dot(&at, &q).abs() / (dot(&at, &at) * dot(&q, &q)).sqrt();
            *error = error.max(2.0 * (1.0 - cosine) * self.attitude_scale);
        }
        none_over(errors)
            && self.others.iter().all(|(values, scale)| {
                let (a, slope) = (values[from], values[to] - values[from]);
                let off = |row: usize| (a + slope * share(row) - values[row]) * scale;
                inside.clone().all(|row| off(row).abs() <= 1.0)
            })
    }

    fn attitude_of(&self, row: usize) -> [f64; 4] {
        std::array::from_fn(|i| self.attitude[i][row])
    }
}

#[cfg(feature = "unit-tests")]
mod tests {
    use nalgebra::{Isometry3, Translation3, UnitQuaternion};

    use super::super::between::period;
    use super::super::track::Channel;
    use super::*;

    /// A helix that is flown ever faster, turning as it goes.
    fn helix(rows: usize) -> Track {
        let times: Vec<f64> = (0..rows).map(|i| i as f64 * 0.01).collect();
        let angle = |t: f64| 0.4 * t + 0.05 * t * t;
        let poses = times.iter().map(|t| {
            let (sin, cos) = angle(*t).sin_cos();
            let turn = UnitQuaternion::from_euler_angles(0.1 * sin, 0.0, angle(*t));
            Isometry3::from_parts(Translation3::new(3.0 * cos, 3.0 * sin, 0.2 * t), turn)
        });
        let poses = poses.collect();
        let speed = |t: f64| 3.0 * (0.4 + 0.1 * t);
        let channel = |name: &str, of: &dyn Fn(f64) -> f64| Channel {
            name: name.into(),
            values: times.iter().map(|t| of(*t)).collect(),
        };
        let channels = vec![
            channel("leg", &|t| (t / 2.0).floor()),
            channel("vx_m_s", &|t| -speed(t) * angle(t).sin()),
            channel("vy_m_s", &|t| speed(t) * angle(t).cos()),
            channel("vz_m_s", &|_| 0.2),
            channel("rotor1_rad_s", &|t| 900.0 + 40.0 * (0.7 * t).sin()),
            channel("saturated", &|t| if (3.0..3.5).contains(&t) { 0.25 } else { 0.0 }),
        ];
        Track::new(times, poses, channels).unwrap()
    }

    #[test]
    fn a_few_rows_stand_for_all() {
        let (track, tolerances) = (helix(1001), Tolerances::default());
        let rows = bends(&track, &BTreeSet::from([123]), &tolerances);
        assert!(rows.len() < 150 && rows.contains(&123), "{} rows", rows.len());
        for change in [199, 200, 399, 400, 299, 300, 349, 350] {
            assert!(rows.contains(&change), "row {change}: a leg or a saturation ends or begins");
        }
        let again = track.picked(&rows).at_period(period(&track).unwrap());
        assert_eq!(again.len(), track.len());
        assert_eq!(again.channel("leg"), track.channel("leg"));
        for row in 0..track.len() {
            assert!((again.times()[row] - track.times()[row]).abs() < 1e-9);
            let off = again.position(row) - track.position(row);
            assert!(off.norm() <= 1e-4, "row {row}: {off}");
            assert!(again.poses()[row].rotation.angle_to(&track.poses()[row].rotation) <= 2.02e-3, "row {row}");
            let speed = [1, 2].map(|i| (again.channels()[i].values[row] - track.channels()[i].values[row]).abs());
            assert!(speed.iter().all(|off| *off < 0.05), "row {row}: {speed:?}");
            let rotor = again.channels()[4].values[row] - track.channels()[4].values[row];
            assert!(rotor.abs() <= 0.8, "row {row}: {rotor}");
        }
        for row in rows {
            assert_eq!(again.poses()[row], track.poses()[row], "a row that is kept comes back as it is");
        }
    }

    /// Each row is as far from the one before as it may be: none can be left out.
    #[test]
    fn no_row_is_to_spare() {
        let (track, tolerances) = (helix(1001), Tolerances::default());
        let rows = bends(&track, &BTreeSet::new(), &tolerances);
        let (columns, always, mut errors) =
            (Columns::of(&track, &tolerances), always(&track, &[].into(), 1000), vec![]);
        for three in rows.windows(3) {
            assert!(columns.within(three[0], three[1], &mut errors), "{three:?}");
            let spare = columns.within(three[0], three[2], &mut errors) && !always.contains(&three[1]);
            assert!(!spare, "row {} of {three:?}", three[1]);
        }
    }

    #[test]
    fn stamps_that_are_uneven_become_even() {
        let track = helix(401).picked(&(0..401).filter(|row| row % 7 != 3 || *row == 0).collect::<Vec<_>>());
        let even = track.at_period(period(&track).unwrap());
        assert_eq!(even.len(), 401);
        let off = (0..401).map(|row| (even.position(row) - helix(401).position(row)).norm()).fold(0.0, f64::max);
        assert!(off < 1e-6, "{off}");
        let one = track.picked(&[5]);
        assert_eq!((period(&one), one.at_period(0.01)), (None, one.clone()));
        assert_eq!(track.at_period(f64::NAN), track);
    }
}
