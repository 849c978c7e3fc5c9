//! The motion between rows of a track, and its rows at even times.
//!
//! Between two rows positions and velocities follow the cubic that has both rows' (Hermite); without velocities, where
//! they turn round at a sample, and of everything else, the straight line. Attitudes are the line's, made rotations
//! again. Where a leg begins between two samples, velocities are those of the samples, on the line between them: legs
//! are planned apart and join within a tolerance, and the cubic through a place that jumps is faster than both.

use nalgebra::{Isometry3, Quaternion, Translation3, UnitQuaternion, Vector3};

use super::track::{Channel, Track};

/// Channels of the velocity, m/s, world frame.
pub(super) const VELOCITY: [&str; 3] = ["vx_m_s", "vy_m_s", "vz_m_s"];

/// `None` where one of the three is missing: then positions go in straight lines.
pub(super) fn velocity_of(track: &Track) -> Option<[&[f64]; 3]> {
    let [x, y, z] = VELOCITY.map(|name| track.channel(name));
    Some([x?, y?, z?])
}

/// Between the `ends` at `share`: on the cubic that has both ways a span at their `speeds`, or on the line.
///
/// ```text
/// p(σ) = a + (b − a) σ + σ(1 − σ) [(1 − σ)(v − (b − a)) − σ (w − (b − a))],   σ ∈ [0, 1]
/// ```
///
/// `speeds` \[v, w\] are derivatives by σ: velocities times the span, m. Hermite's cubic, written as the line and
/// what bends it, so that equal ends with no speed come back exactly.
pub(super) fn place(share: f64, [a, b]: [f64; 2], speeds: Option<[f64; 2]>) -> f64 {
    let line = a + (b - a) * share;
    let Some([v, w]) = speeds else { return line };
    let (back, way) = (1.0 - share, b - a);
    line + share * back * (back * (v - way) - share * (w - way))
}

/// The derivative of [`place`] by the share.
pub(super) fn rate(share: f64, [a, b]: [f64; 2], [v, w]: [f64; 2]) -> f64 {
    let (back, way) = (1.0 - share, b - a);
    let (p, q) = (v - way, w - way);
    way + (back - share) * (back * p - share * q) - share * back * (p + q)
}

pub(super) fn dot(a: &[f64; 4], b: &[f64; 4]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// `b` or −b, whichever is on the side of `a`: both are the same attitude.
pub(super) fn nearer(a: &[f64; 4], b: [f64; 4]) -> [f64; 4] {
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

    /// Pose and channels at `t` (s) on the motion that the rows stand for; before the first row and after the last one
    /// as there, `None` without rows. A leg lasts until the next row.
    pub fn at(&self, t: f64) -> Option<(Isometry3<f64>, Vec<f64>)> {
        if self.len() < 2 {
            let values = self.channels().iter().filter_map(|channel| channel.values.first().copied());
            return self.poses().first().map(|pose| (*pose, values.collect()));
        }
        let next = self.times().partition_point(|time| *time <= t);
        Some(Between::of(self, None).at(next.clamp(1, self.len() - 1) - 1, t))
    }

    /// The motion that the rows stand for, every `period` s from the first row on, at the last, and where it turns
    /// round at a sample. A row that stands at such a stamp comes back as it is; a leg lasts until the next row.
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
        let between = Between::of(self, Some(period));
        let tips = (0..self.len() - 1).filter_map(|from| between.tip(from)).map(|row| self.times()[row]);
        let even = |tip: &f64| {
            let k = ((tip - first) / period).round();
            (tip - first - k * period).abs() <= near || (tip - last).abs() <= near
        };
        stamps.extend(tips.filter(|tip| !even(tip)));
        stamps.sort_by(f64::total_cmp);
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
    /// The time between samples, of which rows were picked, s.
    period: Option<f64>,
}

/// A mean velocity is that of one end within this share of it.
const SAME: f64 = 0.05;

impl<'a> Between<'a> {
    fn of(track: &'a Track, period: Option<f64>) -> Self {
        Self { track, velocity: velocity_of(track), period }
    }

    /// The row at which the velocity turns round, where it is one of two neighbouring samples and not between them: a
    /// vehicle that changes its gear. The cubic through both velocities would overshoot by half of them.
    ///
    /// The way from the one to the other is driven as at the end whose velocity its mean is; the other end is the tip.
    fn tip(&self, from: usize) -> Option<usize> {
        if !self.is_one_sample(from) {
            return None;
        }
        let velocity = self.velocity?;
        let [v, w] = [from, from + 1].map(|row| Vector3::from(velocity.map(|axis| axis[row])));
        let span = self.track.times()[from + 1] - self.track.times()[from];
        let mean = (self.track.position(from + 1) - self.track.position(from)) / span;
        let [as_before, as_after] = [v, w].map(|end| (mean - end).norm() <= SAME * end.norm());
        match v.dot(&w) < 0.0 {
            true if as_after => Some(from),
            true if as_before => Some(from + 1),
            _ => None,
        }
    }

    /// Whether the rows `from` and `from` + 1 are neighbouring samples, as far as it is known what samples are.
    fn is_one_sample(&self, from: usize) -> bool {
        let span = self.track.times()[from + 1] - self.track.times()[from];
        self.period.is_some_and(|period| span <= 1.5 * period)
    }

    /// Whether another leg begins between neighbouring samples.
    fn joins(&self, from: usize) -> bool {
        let differ = |legs: &[f64]| legs[from] != legs[from + 1];
        self.is_one_sample(from) && self.track.channel("leg").is_some_and(differ)
    }

    /// Pose and channels at `stamp`, between the rows `from` and `from` + 1.
    ///
    /// Base of all resampling: poses by [`place`] and by normalised linear interpolation of quaternions, velocities by
    /// the cubic's derivative, `leg` from the row before, all others linear. Linear quaternions turn unevenly by a
    /// share of the angle cubed: little at the spacing that rows have.
    fn at(&self, from: usize, stamp: f64) -> (Isometry3<f64>, Vec<f64>) {
        let (times, poses) = (self.track.times(), self.track.poses());
        let span = times[from + 1] - times[from];
        let share = ((stamp - times[from]) / span).clamp(0.0, 1.0);
        let [a, b] = [from, from + 1].map(|row| poses[row]);
        let ends = |axis: usize| [a.translation.vector[axis], b.translation.vector[axis]];
        let (tip, joins) = (self.tip(from), self.joins(from));
        let speeds = |axis: usize| match tip {
            Some(_) => Some([ends(axis)[1] - ends(axis)[0]; 2]),
            None => self.velocity.map(|v| [v[axis][from] * span, v[axis][from + 1] * span]),
        };
        let [x, y, z] = [0, 1, 2].map(|axis| place(share, ends(axis), speeds(axis)));
        let [p, q] = [a, b].map(|pose| std::array::from_fn(|i| pose.rotation.coords[i]));
        let q = nearer(&p, q);
        let [i, j, k, w] = std::array::from_fn(|n| p[n] + (q[n] - p[n]) * share);
        let rotation = UnitQuaternion::new_normalize(Quaternion::new(w, i, j, k));
        let value = |channel: &Channel| {
            let [a, b] = [channel.values[from], channel.values[from + 1]];
            match (VELOCITY.iter().position(|name| *name == channel.name), tip) {
                _ if channel.name == "leg" => a,
                (Some(_), Some(tip)) if tip == from => b,
                (Some(_), Some(_)) => a,
                (Some(axis), None) if !joins => {
                    speeds(axis).map_or(a + (b - a) * share, |speeds| rate(share, ends(axis), speeds) / span)
                }
                _ => a + (b - a) * share,
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
    /// Passed over where it does not come after the last row that was gathered: two stamps may lie near one row.
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

#[cfg(feature = "unit-tests")]
mod tests {
    use super::*;

    /// Forwards at 1 m/s for a second, and back at once at that speed; then softly round, which is a cubic.
    #[test]
    fn a_change_of_gear_does_not_overshoot() {
        let along = |places: [f64; 4], speeds: [f64; 4]| {
            let poses = places.map(|x| Isometry3::translation(x, 0.0, 0.0)).to_vec();
            let channel = |name: &str, values: [f64; 4]| Channel { name: name.into(), values: values.to_vec() };
            let channels = VELOCITY.into_iter().zip([speeds, [0.0; 4], [0.0; 4]]);
            let channels = channels.map(|(name, values)| channel(name, values)).collect();
            Track::new(vec![0.0, 1.0, 2.0, 3.0], poses, channels).unwrap()
        };
        let fastest = |track: &Track, period: f64| {
            let speeds = track.at_period(period);
            speeds.channel(VELOCITY[0]).unwrap().iter().fold(0.0_f64, |most, speed| most.max(speed.abs()))
        };
        let geared = along([0.0, 1.0, 0.0, -1.0], [1.0, 1.0, -1.0, -1.0]);
        assert!((fastest(&geared, 0.9) - 1.0).abs() < 1e-12);
        // The tip itself is there, between the even stamps, and the way is no shorter.
        let even = geared.at_period(0.9);
        assert_eq!(even.times()[1..3], [0.9, 1.0]);
        assert!((even.position(2).x - 1.0).abs() < 1e-12 && even.len() == 6, "{:?}", even.times());
        // Of rows that stand for ten samples each nothing is known between them.
        assert!(fastest(&geared, 0.1) > 1.2);
        let soft = along([0.0, 1.0, 1.0, 0.0], [1.0, 1.0, -1.0, -1.0]);
        assert!(soft.at_period(0.9).position(2).x > 1.0, "between 1 and 2 s it goes on and comes back");
    }

    /// Two legs of 1 m/s, the second of which begins a quarter of a metre farther on than the first ends.
    #[test]
    fn a_joint_is_no_faster_than_the_legs() {
        let poses = [0.0, 1.0, 2.25, 3.25].map(|x| Isometry3::translation(x, 0.0, 0.0)).to_vec();
        let channel = |name: &str, values: [f64; 4]| Channel { name: name.into(), values: values.to_vec() };
        let velocities = VELOCITY.into_iter().zip([[1.0; 4], [0.0; 4], [0.0; 4]]);
        let mut channels: Vec<Channel> = velocities.map(|(name, values)| channel(name, values)).collect();
        let fastest = |channels: Vec<Channel>| {
            let track = Track::new(vec![0.0, 1.0, 2.0, 3.0], poses.clone(), channels).unwrap();
            let even = track.at_period(0.75);
            assert!(even.position(2).x > 1.5 && even.times().len() == 5, "{:?}", even.times());
            even.channel(VELOCITY[0]).unwrap().iter().fold(0.0_f64, |most, speed| most.max(*speed))
        };
        assert!(fastest(channels.clone()) > 1.3, "on one leg it goes on as the rows have it");
        channels.push(channel("leg", [0.0, 0.0, 1.0, 1.0]));
        assert_eq!(fastest(channels), 1.0);
    }
}
