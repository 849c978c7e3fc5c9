//! The rows of a track where it bends, and the motion between them: a few rows say what thousands do.
//!
//! Between two rows positions and velocities follow the cubic that has both rows' (Hermite); without velocities, and of
//! everything else, the straight line. Attitudes are the line's, made rotations again.

use std::collections::BTreeSet;

use nalgebra::{Isometry3, Quaternion, Translation3, UnitQuaternion};

use super::track::{Channel, Track};

const VELOCITY: [&str; 3] = ["vx_m_s", "vy_m_s", "vz_m_s"];

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
/// `marked`, those before and after every change of the channel `leg` and of whether `saturated` is 0, and where the
/// rest is worst met, one after the other.
///
/// Linear in rows, columns and the logarithm of the rows that are kept.
pub fn bends(track: &Track, marked: &BTreeSet<usize>, tolerances: &Tolerances) -> Vec<usize> {
    let Some(last) = track.len().checked_sub(1) else { return Vec::new() };
    let mut kept: BTreeSet<usize> = marked.iter().copied().filter(|row| *row <= last).collect();
    kept.extend([0, last]);
    let mut at_changes = |channel: &str, differ: fn(f64, f64) -> bool| {
        let pairs = track.channel(channel).unwrap_or_default().windows(2).enumerate();
        kept.extend(pairs.filter(|(_, pair)| differ(pair[0], pair[1])).flat_map(|(row, _)| [row, row + 1]));
    };
    at_changes("leg", |a, b| a != b);
    at_changes("saturated", |a, b| (a == 0.0) != (b == 0.0));
    let columns = Columns::of(track, tolerances);
    let mut open: Vec<(usize, usize)> = kept.iter().copied().zip(kept.iter().copied().skip(1)).collect();
    let mut errors = Vec::new();
    while let Some((from, to)) = open.pop() {
        if let Some(worst) = columns.worst_between(from, to, &mut errors) {
            kept.insert(worst);
            open.extend([(from, worst), (worst, to)]);
        }
    }
    kept.into_iter().collect()
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

    /// The row between two that are kept where the motion between them is farthest off; `None` where it is near enough
    /// everywhere. Errors are squares of tolerances.
    fn worst_between(&self, from: usize, to: usize, errors: &mut Vec<f64>) -> Option<usize> {
        if to - from < 2 {
            return None;
        }
        let (inside, span) = (from + 1..to, self.times[to] - self.times[from]);
        let share = |row: usize| (self.times[row] - self.times[from]) / span;
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
        for (values, scale) in &self.others {
            let (a, slope) = (values[from], values[to] - values[from]);
            for (error, row) in errors.iter_mut().zip(inside.clone()) {
                let off = (a + slope * share(row) - values[row]) * scale;
                *error = error.max(off * off);
            }
        }
        let worst = errors.iter().enumerate().max_by(|a, b| a.1.total_cmp(b.1))?;
        (*worst.1 > 1.0).then_some(from + 1 + worst.0)
    }

    fn attitude_of(&self, row: usize) -> [f64; 4] {
        std::array::from_fn(|i| self.attitude[i][row])
    }
}

fn velocity_of(track: &Track) -> Option<[&[f64]; 3]> {
    let [x, y, z] = VELOCITY.map(|name| track.channel(name));
    Some([x?, y?, z?])
}

/// Between the `ends` at `share`: on the cubic that has both ways a span at their `speeds`, or on the line.
fn place(share: f64, [a, b]: [f64; 2], speeds: Option<[f64; 2]>) -> f64 {
    let line = a + (b - a) * share;
    let Some([v, w]) = speeds else { return line };
    let (back, way) = (1.0 - share, b - a);
    line + share * back * (back * (v - way) - share * (w - way))
}

/// The derivative of [`place`] by the share.
fn rate(share: f64, [a, b]: [f64; 2], [v, w]: [f64; 2]) -> f64 {
    let (back, way) = (1.0 - share, b - a);
    let (p, q) = (v - way, w - way);
    way + (back - share) * (back * p - share * q) - share * back * (p + q)
}

fn dot(a: &[f64; 4], b: &[f64; 4]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// `b` or −b, whichever is on the side of `a`: both are the same attitude.
fn nearer(a: &[f64; 4], b: [f64; 4]) -> [f64; 4] {
    if dot(a, &b) < 0.0 { b.map(|v| -v) } else { b }
}

/// The median time between rows, s, in whole nanoseconds; `None` of less than two.
pub fn period(track: &Track) -> Option<f64> {
    let mut steps: Vec<f64> = track.times().windows(2).map(|pair| pair[1] - pair[0]).collect();
    let middle = steps.len().checked_sub(1)? / 2;
    let (_, median, _) = steps.select_nth_unstable_by(middle, f64::total_cmp);
    let nanoseconds = (*median * 1e9).round();
    Some(if nanoseconds >= 1.0 { nanoseconds / 1e9 } else { *median })
}

/// Rows at most, where a file claims a period that is none.
const MOST_ROWS: f64 = 1e7;

impl Track {
    /// The rows with these numbers, which rise.
    pub fn picked(&self, rows: &[usize]) -> Self {
        let of = |values: &[f64]| rows.iter().map(|row| values[*row]).collect::<Vec<_>>();
        let channels = self.channels().iter().map(|c| Channel { name: c.name.clone(), values: of(&c.values) });
        let poses = rows.iter().map(|row| self.poses()[*row]).collect();
        Self::new(of(self.times()), poses, channels.collect()).expect("rows of a track are a track")
    }

    /// The motion that the rows stand for, every `period` s from the first row on, and at the last. A row that stands
    /// at such a stamp comes back as it is; a leg lasts until the next row.
    pub fn at_period(&self, period: f64) -> Self {
        let (Some(first), Some(last)) = (self.times().first(), self.times().last()) else { return self.clone() };
        let steps = ((last - first) / period).floor();
        if !(period > 0.0 && steps <= MOST_ROWS) || self.len() < 2 {
            return self.clone();
        }
        let near = 1e-3 * period;
        let mut stamps: Vec<f64> = (0..=steps as usize).map(|i| first + i as f64 * period).collect();
        if last - stamps[stamps.len() - 1] > near {
            stamps.push(*last);
        }
        let between = Between::of(self);
        let mut rows = Rows::default();
        let mut after = 1;
        for stamp in stamps {
            while after + 1 < self.len() && self.times()[after] <= stamp + near {
                after += 1;
            }
            let row = [after, after - 1].into_iter().find(|row| (self.times()[*row] - stamp).abs() <= near);
            match row {
                Some(row) => rows.take(self, row),
                None => rows.fill(&between, after - 1, stamp),
            }
        }
        rows.into_track(self)
    }
}

/// A track between its rows.
struct Between<'a> {
    track: &'a Track,
    velocity: Option<[&'a [f64]; 3]>,
}

impl<'a> Between<'a> {
    fn of(track: &'a Track) -> Self {
        Self { track, velocity: velocity_of(track) }
    }

    /// Pose and channels at `stamp`, between the rows `from` and `from` + 1.
    fn at(&self, from: usize, stamp: f64) -> (Isometry3<f64>, Vec<f64>) {
        let (times, poses) = (self.track.times(), self.track.poses());
        let span = times[from + 1] - times[from];
        let share = ((stamp - times[from]) / span).clamp(0.0, 1.0);
        let [a, b] = [from, from + 1].map(|row| poses[row]);
        let ends = |axis: usize| [a.translation.vector[axis], b.translation.vector[axis]];
        let speeds = |axis: usize| self.velocity.map(|v| [v[axis][from] * span, v[axis][from + 1] * span]);
        let [x, y, z] = [0, 1, 2].map(|axis| place(share, ends(axis), speeds(axis)));
        let [p, q] = [a, b].map(|pose| std::array::from_fn(|i| pose.rotation.coords[i]));
        let q = nearer(&p, q);
        let [i, j, k, w] = std::array::from_fn(|n| p[n] + (q[n] - p[n]) * share);
        let rotation = UnitQuaternion::new_normalize(Quaternion::new(w, i, j, k));
        let value = |channel: &Channel| {
            let [a, b] = [channel.values[from], channel.values[from + 1]];
            match VELOCITY.iter().position(|name| *name == channel.name) {
                _ if channel.name == "leg" => a,
                Some(axis) => speeds(axis).map_or(a + (b - a) * share, |speeds| rate(share, ends(axis), speeds) / span),
                None => a + (b - a) * share,
            }
        };
        let values = self.track.channels().iter().map(value).collect();
        (Isometry3::from_parts(Translation3::new(x, y, z), rotation), values)
    }
}

/// Rows being gathered.
#[derive(Default)]
struct Rows {
    times: Vec<f64>,
    poses: Vec<Isometry3<f64>>,
    values: Vec<Vec<f64>>,
}

impl Rows {
    fn take(&mut self, track: &Track, row: usize) {
        if self.times.last().is_some_and(|before| *before >= track.times()[row]) {
            return;
        }
        self.times.push(track.times()[row]);
        self.poses.push(track.poses()[row]);
        self.values.push(track.channels().iter().map(|channel| channel.values[row]).collect());
    }

    fn fill(&mut self, between: &Between, from: usize, stamp: f64) {
        let (pose, values) = between.at(from, stamp);
        self.times.push(stamp);
        self.poses.push(pose);
        self.values.push(values);
    }

    fn into_track(self, of: &Track) -> Track {
        let column = |(place, channel): (usize, &Channel)| Channel {
            name: channel.name.clone(),
            values: self.values.iter().map(|row| row[place]).collect(),
        };
        let channels = of.channels().iter().enumerate().map(column).collect();
        Track::new(self.times, self.poses, channels).expect("stamps rise, and what is between finite numbers is finite")
    }
}

#[cfg(test)]
mod tests {
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
