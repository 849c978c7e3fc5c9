//! Velocities are told beside places, by executors and in logs, and have to be theirs: over every stretch they add up
//! to the way. What does not is in another unit or another frame, or was never filled in, and accelerations would be
//! judged that nobody had.
//!
//! Told velocities v and places p of a stretch of about two seconds, along each axis of the world:
//!
//! ```text
//! |Δp − Σ ½ h (v₀ + v₁)| ≤ ¼ max(|Δp|, |Σ|) + Σ (½ h |v₁ − v₀| + ¼ a h²) + 5 cm
//! ```
//!
//! The second term is what any honest way of integrating may differ by: it takes either end's velocity for the whole
//! step h, or speeds up and brakes within it by a = 4 m/s². A stretch is off that exceeds the right side, over all
//! axes, by more than a tenth of its way; where more than a third of those that move are off the promise is broken:
//! velocities are in another unit throughout, and a place that jumps once is for the judge. Steps longer than 0.2 s
//! are left out: a robot may stop at each of their ends; but not at ten in a row, all of whose velocities are 0.
//!
//! Places may also move where velocities do not: sway, tremble, be pushed. With e = p − Σ ½ h (v₀ + v₁) and the second
//! difference δ_n x = x(i + n) − 2 x(i) + x(i − n) over lags of T = n h from 0.1 to 0.4 s, root mean squares over a
//! stretch and along one axis, velocities lack a motion where
//!
//! ```text
//! δ_n e > 0.6 δ_n p + 2 √n δ_1 e + Σ ½ h |v₁ − v₀|     and     δ_n e > T² · 1 m/s²
//! ```
//!
//! The first term leaves room for velocities that are filtered or late, the second for places that are noisy or wander,
//! from one sample to the next, and jump; an acceleration of 1 m/s² in the mean that velocities lack is not noticed.

use std::fmt;

use nalgebra::{Isometry3, Vector3};
use thiserror::Error;

/// Length of a stretch, s: noise of places averages out, turns do not.
const STRETCH_S: f64 = 2.0;
/// The longest step that says something of velocities, s; stamps are rounded.
const LONGEST_STEP_S: f64 = 0.2 + 1e-6;
/// What may be braked and gained again within a step, m/s².
const WITHIN_STEP_M_S2: f64 = 4.0;
/// What noise of places may add to a stretch, m.
const NOISE_M: f64 = 0.05;
/// Part of a stretch's way that velocities may be off.
const OFF: f64 = 0.25;
/// Part of a stretch's way that may be beyond all that.
const BEYOND: f64 = 0.1;
/// One in so many stretches may be off.
const ONE_IN: usize = 3;
/// Part of the whole way within which an image of the velocities is what they should be.
const IMAGE: f64 = 0.2;
/// So many steps in a row that move, at velocities of 0, are not of a robot that stops at each of their ends.
const STOPS: usize = 10;
/// Lags over which motions are looked for that velocities lack, s.
const LAGS_S: [f64; 3] = [0.1, 0.2, 0.4];
/// Part of a motion's own bend that filtered or late velocities may lack.
const LATE: f64 = 0.6;
/// So much of what one sample wanders, times the root of the samples, is the places' noise.
const WANDERS: f64 = 2.0;
/// An acceleration (root mean square) that velocities may lack, m/s².
const LACKING_M_S2: f64 = 1.0;

/// Velocities that are not those of the places.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
pub enum Disagreement {
    /// They do not add up to the way.
    #[error(transparent)]
    Way(#[from] WrongWay),
    /// Places move where they do not.
    #[error(transparent)]
    Motion(#[from] Lacking),
}

/// Velocities that do not add up to the way of the places.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
#[error(
    "pose {} (t_s = {:.2}): v_m_s[{axis}] adds up to {told:.2} m since pose {} (t_s = {:.2}), where p_m[{axis}] moved by \
     {way:.2} m: must agree{slip}",
    .to.0, .to.1, .from.0, .from.1
)]
pub struct WrongWay {
    /// First pose of the stretch that is the farthest off, and its time, s.
    pub from: (usize, f64),
    /// Its last.
    pub to: (usize, f64),
    /// The axis.
    pub axis: usize,
    /// ∫ v dt along it, m.
    pub told: f64,
    /// What the places moved by, m.
    pub way: f64,
    /// What has become of the velocities, where that shows.
    pub slip: Misread,
}

/// A motion of the places that velocities lack.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
#[error(
    "pose {} (t_s = {:.2}): since pose {} (t_s = {:.2}) p_m[{axis}] sways by {off:.3} m within {lag:.2} s (root mean square \
     {acceleration:.1} m/s²) where v_m_s[{axis}] does not: must agree; leave \"v_m_s\" out where velocities are not known",
    .to.0, .to.1, .from.0, .from.1
)]
pub struct Lacking {
    /// First pose of the stretch where most is lacking, and its time, s.
    pub from: (usize, f64),
    /// Its last.
    pub to: (usize, f64),
    /// The axis.
    pub axis: usize,
    /// Root mean square of the second difference that velocities lack, m …
    pub off: f64,
    /// … over this lag, s.
    pub lag: f64,
    /// The acceleration that it is, m/s².
    pub acceleration: f64,
}

impl Disagreement {
    /// As it is told of a log.
    pub fn in_words(&self) -> String {
        let axis = |axis: usize| ["x", "y", "z"][axis];
        match self {
            Self::Way(WrongWay { from, to, axis: along, told, way, slip }) => format!(
                "velocities along {} add up to {told:.2} m from t = {:.2} to {:.2} s, where positions move by {way:.2} m{}",
                axis(*along),
                from.1,
                to.1,
                if *slip == Misread::Zero { "; they are 0 throughout".into() } else { slip.to_string() }
            ),
            Self::Motion(Lacking { from, to, axis: along, off, lag, acceleration }) => format!(
                "positions sway along {} from t = {:.2} to {:.2} s, by {off:.3} m within {lag:.2} s ({acceleration:.1} m/s², \
                 root mean squares), where velocities do not",
                axis(*along),
                from.1,
                to.1
            ),
        }
    }
}

/// What velocities look like that are not those of the places.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Misread {
    /// 0 throughout.
    Zero,
    /// km/h.
    KilometresAnHour,
    /// In the body's axes.
    Body,
    /// x north, y east, z down.
    Ned,
    /// z down alone.
    Down,
    /// x and y changed places.
    Swapped,
    /// Something else.
    Unknown,
}

impl fmt::Display for Misread {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Zero => "; they are 0 throughout: leave \"v_m_s\" out where velocities are not known",
            Self::KilometresAnHour => "; they look like km/h",
            Self::Body => "; they look like velocities in the body's axes, where the world's are due",
            Self::Ned => "; they look like NED's (x and y change places, z points down): here x is east, y north, z up",
            Self::Down => "; they look as if z pointed down: here it points up",
            Self::Swapped => "; they look as if x and y were in each other's place",
            Self::Unknown => "",
        })
    }
}

/// Steps that lie behind each other.
#[derive(Clone, Copy)]
struct Stretch {
    from: usize,
    to: usize,
    span: f64,
    way: Vector3<f64>,
    told: Vector3<f64>,
    /// The same if they are in the body's axes.
    turned: Vector3<f64>,
    slack: Vector3<f64>,
}

/// How velocities disagree with the places beside them, if they do; as many of each.
pub fn disagreement(times: &[f64], poses: &[Isometry3<f64>], velocities: &[[f64; 3]]) -> Option<Disagreement> {
    let way = wrong_way(times, poses, velocities).map(Disagreement::Way);
    way.or_else(|| lacking(times, poses, velocities).map(Disagreement::Motion))
}

fn wrong_way(times: &[f64], poses: &[Isometry3<f64>], velocities: &[[f64; 3]]) -> Option<WrongWay> {
    let longest = if never_stops(poses, velocities) { f64::INFINITY } else { LONGEST_STEP_S };
    let stretches = stretches(times, poses, velocities, longest);
    let count = |of: &dyn Fn(&Stretch) -> bool| stretches.iter().filter(|one| of(one)).count();
    if ONE_IN * count(&Stretch::is_off) <= count(&Stretch::moves) {
        return None;
    }
    let places = stretches.iter().flat_map(|one| (0..3).map(move |axis| (one, axis)));
    let (worst, axis) = places.max_by(|a, b| a.0.beyond(a.1).total_cmp(&b.0.beyond(b.1)))?;
    Some(WrongWay {
        from: (worst.from, times[worst.from]),
        to: (worst.to, times[worst.to]),
        axis,
        told: worst.told[axis],
        way: worst.way[axis],
        slip: misread(&stretches),
    })
}

/// Whether velocities are 0 throughout while places move on for [`STOPS`] steps in a row.
fn never_stops(poses: &[Isometry3<f64>], velocities: &[[f64; 3]]) -> bool {
    let moves = |pair: &[Isometry3<f64>]| (pair[1].translation.vector - pair[0].translation.vector).norm() > NOISE_M;
    let moving: Vec<bool> = poses.windows(2).map(moves).collect();
    velocities.iter().all(|v| *v == [0.0; 3]) && moving.windows(STOPS).any(|row| row.iter().all(|moves| *moves))
}

/// The motion that velocities lack most, of one stretch and along one axis.
fn lacking(times: &[f64], poses: &[Isometry3<f64>], velocities: &[[f64; 3]]) -> Option<Lacking> {
    let (mut from, mut found) = (0, Vec::new());
    for i in 1..=times.len() {
        let goes_on = i < times.len() && times[i] - times[i - 1] <= LONGEST_STEP_S;
        if goes_on && times[i] - times[from] <= STRETCH_S {
            continue;
        }
        if i - from > 2 {
            found.extend(lacking_in(&times[from..i], &poses[from..i], &velocities[from..i], from));
        }
        from = i;
    }
    found.into_iter().max_by(|a, b| a.acceleration.total_cmp(&b.acceleration))
}

/// The same in a stretch without long steps, whose first sample has the number `first`.
fn lacking_in(times: &[f64], poses: &[Isometry3<f64>], velocities: &[[f64; 3]], first: usize) -> Option<Lacking> {
    let last = times.len() - 1;
    let step = (times[last] - times[0]) / last as f64;
    let mut worst = None::<Lacking>;
    for axis in [0, 1, 2] {
        let places: Vec<f64> = poses.iter().map(|pose| pose.translation.vector[axis]).collect();
        let (mut left, mut slack) = (vec![places[0]], vec![0.0]);
        let mut added = 0.0;
        for i in 1..=last {
            let (h, a, b) = (times[i] - times[i - 1], velocities[i - 1][axis], velocities[i][axis]);
            added += 0.5 * h * (a + b);
            left.push(places[i] - added);
            slack.push(slack[i - 1] + 0.5 * h * (b - a).abs());
        }
        let of_one = second_difference(&left, 1);
        for lag in LAGS_S {
            let n = (lag / step).round() as usize;
            if n < 2 || 2 * n > last / 2 {
                continue;
            }
            let lag = n as f64 * step;
            let off = second_difference(&left, n);
            let within = (slack[last] / last as f64) * (2 * n) as f64;
            let room = LATE * second_difference(&places, n) + WANDERS * (n as f64).sqrt() * of_one + within;
            let acceleration = off / (lag * lag);
            let is_worse = worst.is_none_or(|worst| acceleration > worst.acceleration);
            if off > room && acceleration > LACKING_M_S2 && is_worse {
                let at = |i: usize| (first + i, times[i]);
                worst = Some(Lacking { from: at(0), to: at(last), axis, off, lag, acceleration });
            }
        }
    }
    worst
}

/// Root mean square of x(i + n) − 2 x(i) + x(i − n); there are more than 2n values.
fn second_difference(values: &[f64], n: usize) -> f64 {
    let count = values.len() - 2 * n;
    let squares = (0..count).map(|i| {
        let bend = values[i + 2 * n] - 2.0 * values[i + n] + values[i];
        bend * bend
    });
    (squares.sum::<f64>() / count as f64).sqrt()
}

impl Stretch {
    fn beginning(from: usize) -> Self {
        let none = Vector3::zeros();
        Self { from, to: from, span: 0.0, way: none, told: none, turned: none, slack: none }
    }

    /// What it moves by places or by velocities, m.
    fn length(&self) -> f64 {
        self.way.norm().max(self.told.norm())
    }

    fn moves(&self) -> bool {
        self.length() > NOISE_M
    }

    fn is_off(&self) -> bool {
        self.moves() && (0..3).map(|axis| self.beyond(axis)).sum::<f64>() > BEYOND * self.length()
    }

    /// By how much, m, it is off along an axis beyond what any honest integration is.
    fn beyond(&self, axis: usize) -> f64 {
        let (way, told) = (self.way[axis], self.told[axis]);
        let within = OFF * way.abs().max(told.abs()) + self.slack[axis] + NOISE_M;
        ((way - told).abs() - within).max(0.0)
    }
}

/// The steps that say something, none longer than `longest` s, in stretches.
fn stretches(times: &[f64], poses: &[Isometry3<f64>], velocities: &[[f64; 3]], longest: f64) -> Vec<Stretch> {
    let mut all = Vec::new();
    let mut own = Stretch::beginning(0);
    for i in 1..times.len() {
        let step = times[i] - times[i - 1];
        if step <= longest {
            let [before, after] = [i - 1, i].map(|k| Vector3::from(velocities[k]));
            own.span += step;
            own.way += poses[i].translation.vector - poses[i - 1].translation.vector;
            own.told += 0.5 * step * (before + after);
            own.turned += 0.5 * step * (poses[i - 1].rotation * before + poses[i].rotation * after);
            own.slack += 0.5 * step * (after - before).abs();
            own.slack.add_scalar_mut(0.25 * WITHIN_STEP_M_S2 * step * step);
        }
        own.to = i;
        if own.span >= STRETCH_S || i + 1 == times.len() {
            all.push(std::mem::replace(&mut own, Stretch::beginning(i)));
        }
    }
    all
}

/// What a slip made of a stretch's way, undone.
type Image = fn(&Stretch) -> Vector3<f64>;

/// The slip whose mending comes nearest to the places, if it comes near.
fn misread(stretches: &[Stretch]) -> Misread {
    let sum = |of: &dyn Fn(&Stretch) -> f64| stretches.iter().map(of).sum::<f64>();
    let whole = sum(&|one| one.way.norm());
    if sum(&|one| one.told.norm()) < 0.01 * whole {
        return Misread::Zero;
    }
    let images: [(Misread, Image); 5] = [
        (Misread::KilometresAnHour, |one| one.told / 3.6),
        (Misread::Ned, |one| Vector3::new(one.told.y, one.told.x, -one.told.z)),
        (Misread::Down, |one| Vector3::new(one.told.x, one.told.y, -one.told.z)),
        (Misread::Swapped, |one| Vector3::new(one.told.y, one.told.x, one.told.z)),
        (Misread::Body, |one| one.turned),
    ];
    let off = images.map(|(slip, image)| (slip, sum(&|one| (one.way - image(one)).norm())));
    let nearest = off.into_iter().min_by(|a, b| a.1.total_cmp(&b.1));
    nearest.filter(|(_, off)| *off <= IMAGE * whole).map_or(Misread::Unknown, |(slip, _)| slip)
}

#[cfg(test)]
mod tests {
    use nalgebra::{Translation3, UnitQuaternion};

    use super::*;

    /// Round a square of 4 m, climbing, at 2 m/s with a nose that turns with it; `step` s between poses, `read` tells
    /// the velocity from the world's and the attitude.
    fn told(step: f64, read: impl Fn(Vector3<f64>, &UnitQuaternion<f64>) -> Vector3<f64>) -> Option<WrongWay> {
        let (mut times, mut poses, mut velocities) = (Vec::new(), Vec::new(), Vec::new());
        let mut place = Vector3::zeros();
        for i in 0..=(16.0 / step) as usize {
            let t = i as f64 * step;
            let heading = (t / 2.0).floor() * std::f64::consts::FRAC_PI_2 + 0.5;
            let turned = UnitQuaternion::from_axis_angle(&Vector3::z_axis(), heading);
            let v = turned * Vector3::new(2.0, 0.0, 0.0) + Vector3::new(0.0, 0.0, 0.5);
            times.push(t);
            poses.push(Isometry3::from_parts(Translation3::from(place), turned));
            velocities.push(read(v, &turned).into());
            place += v * step;
        }
        match disagreement(&times, &poses, &velocities) {
            Some(Disagreement::Way(found)) => Some(found),
            Some(Disagreement::Motion(found)) => panic!("{found}"),
            None => None,
        }
    }

    type Read<'a> = dyn Fn(Vector3<f64>, &UnitQuaternion<f64>) -> Vector3<f64> + 'a;

    /// Each slip is named; what is right passes however it is sampled, delayed or noisy.
    #[test]
    fn velocities_are_those_of_the_places() {
        let slip = |read: &Read<'_>| [0.01, 0.05, 0.1].map(|step| told(step, read).map(|found| found.slip));
        let ned = |v: Vector3<f64>| Vector3::new(v.y, v.x, -v.z);
        assert_eq!(slip(&|v, _| v), [None; 3]);
        assert_eq!(slip(&|v, _| 1.1 * v), [None; 3]);
        assert_eq!(slip(&|_, _| Vector3::zeros()), [Some(Misread::Zero); 3]);
        assert_eq!(slip(&|v, _| 3.6 * v), [Some(Misread::KilometresAnHour); 3]);
        assert_eq!(slip(&|v, _| ned(v)), [Some(Misread::Ned); 3]);
        assert_eq!(slip(&|v, _| Vector3::new(v.y, v.x, v.z)), [Some(Misread::Swapped); 3]);
        assert_eq!(slip(&|v, q| q.inverse() * v), [Some(Misread::Body); 3]);
        assert_eq!(slip(&|v, _| Vector3::new(-v.x, -v.y, v.z)), [Some(Misread::Unknown); 3]);
        // A robot may stop at each of its samples where these are that far apart, if they are few.
        assert_eq!(told(2.0, |_, _| Vector3::zeros()), None);
        assert_eq!(told(0.5, |_, _| Vector3::zeros()).map(|found| found.slip), Some(Misread::Zero));
        let sentence = told(0.05, |v, _| 3.6 * v).unwrap().to_string();
        assert!(sentence.contains("must agree; they look like km/h"), "{sentence}");
        assert!(sentence.contains(" m since pose ") && sentence.contains("v_m_s["), "{sentence}");
    }

    /// A place that jumps once is not a velocity in another unit.
    #[test]
    fn a_jump_is_for_the_judge() {
        let times: Vec<f64> = (0..=500).map(|i| f64::from(i) * 0.02).collect();
        let mut poses: Vec<_> = times.iter().map(|t| Isometry3::translation(2.0 * t, 0.0, 1.0)).collect();
        poses[500] = Isometry3::translation(90.0, 90.0, 90.0);
        assert_eq!(disagreement(&times, &poses, &vec![[2.0, 0.0, 0.0]; 501]), None);
        assert!(disagreement(&times, &poses, &vec![[0.0; 3]; 501]).is_some());
    }

    /// Standing with places that tremble by centimetres is no motion.
    #[test]
    fn who_hovers_is_not_refused_for_its_noise() {
        let count = 3000;
        let times: Vec<f64> = (0..count).map(|i| f64::from(i) * 0.02).collect();
        let tremble = |i: i32| 0.02 * f64::from((i * 7919) % 13 - 6) / 6.0;
        let poses: Vec<_> = (0..count).map(|i| Isometry3::translation(tremble(i), tremble(i + 5), 1.0)).collect();
        assert_eq!(disagreement(&times, &poses, &vec![[0.0; 3]; count as usize]), None);
    }

    /// `rate` samples a second of a flight at 2 m/s that speeds up and brakes; at `sway` (m, 1/s) it sways, and
    /// velocities have that in so far as `seen`.
    fn swaying(rate: f64, [sway, often]: [f64; 2], seen: f64, noise: f64) -> Option<Disagreement> {
        let count = (8.0 * rate) as usize;
        let times: Vec<f64> = (0..=count).map(|i| i as f64 / rate).collect();
        let omega = std::f64::consts::TAU * often;
        let tremble = |i: usize| noise * (((i * 7919) % 1013) as f64 / 506.0 - 1.0);
        let place = |(i, t): (usize, &f64)| {
            let x = 10.0 - 10.0 * (0.4 * t).cos();
            Isometry3::translation(x + tremble(i), tremble(i + 331), 3.0 + sway * (omega * t).sin() + tremble(i + 77))
        };
        let velocity = |t: &f64| [4.0 * (0.4 * t).sin(), 0.0, seen * sway * omega * (omega * t).cos()];
        let poses: Vec<_> = times.iter().enumerate().map(place).collect();
        let velocities: Vec<_> = times.iter().map(velocity).collect();
        disagreement(&times, &poses, &velocities)
    }

    /// A sway of 5 cm twice a second, 7.9 m/s², that positions have and velocities do not.
    #[test]
    fn a_motion_that_velocities_lack_is_noticed() {
        for rate in [50.0, 100.0, 250.0] {
            let Some(Disagreement::Motion(found)) = swaying(rate, [0.05, 2.0], 0.0, 0.001) else {
                panic!("{rate} Hz: not noticed")
            };
            assert!(found.axis == 2 && (2.0..8.0).contains(&found.acceleration), "{found:?}");
            let words = Disagreement::Motion(found).in_words();
            assert!(words.starts_with("positions sway along z from t = "), "{words}");
            assert!(found.to_string().contains("must agree; leave \"v_m_s\" out"), "{found}");
        }
        // What they have, or have but for a third of it, and noise of centimetres passes.
        for rate in [10.0, 50.0, 100.0, 250.0] {
            for noise in [0.0, 0.001, 0.02] {
                assert_eq!(swaying(rate, [0.05, 2.0], 1.0, noise), None, "{rate} Hz, {noise} m");
                assert_eq!(swaying(rate, [0.05, 2.0], 0.7, noise), None, "{rate} Hz, {noise} m");
                assert_eq!(swaying(rate, [0.0, 2.0], 1.0, noise), None, "{rate} Hz, {noise} m");
            }
        }
    }

    /// An estimate that is put right by centimetres five times a second, and velocities that are a tenth of a second
    /// late.
    #[test]
    fn estimates_that_are_put_right_or_late_pass() {
        let times: Vec<f64> = (0..=800).map(|i| f64::from(i) * 0.01).collect();
        let late = |by: f64| -> Vec<[f64; 3]> {
            times.iter().map(|t| [3.0 * (1.5 * (t - by)).cos(), 3.0 * (1.5 * (t - by)).sin(), 0.0]).collect()
        };
        let place = |i: usize| {
            let (t, fix) = (times[i], 0.03 * (((i / 20 * 7919) % 13) as f64 / 6.0 - 1.0));
            Isometry3::translation(2.0 * (1.5 * t).sin() + fix, -2.0 * (1.5 * t).cos() - fix, 5.0)
        };
        let poses: Vec<_> = (0..times.len()).map(place).collect();
        assert_eq!(disagreement(&times, &poses, &late(0.0)), None);
        assert_eq!(disagreement(&times, &poses, &late(0.1)), None);
    }
}
