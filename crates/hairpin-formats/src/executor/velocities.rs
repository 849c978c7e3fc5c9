//! Velocities are told beside places, and have to be theirs: over every stretch of a flight they add up to the way.
//! What does not is in another unit or another frame, and accelerations would be judged that nobody flew.
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
//! are left out: a robot may stop at each of their ends.

use std::fmt;

use nalgebra::{Isometry3, Vector3};
use thiserror::Error;

/// Length of a stretch, s: noise of places averages out, turns do not.
const STRETCH_S: f64 = 2.0;
/// The longest step that says something of velocities, s.
const LONGEST_STEP_S: f64 = 0.2;
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

/// Velocities that are not those of the places.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
#[error(
    "pose {} (t_s = {:.2}): v_m_s[{axis}] adds up to {told:.2} m since pose {} (t_s = {:.2}), where p_m[{axis}] moved by \
     {way:.2} m: must agree{slip}",
    .to.0, .to.1, .from.0, .from.1
)]
pub struct Disagreement {
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

/// How the velocities of a flight disagree with its places, if they do.
pub(super) fn disagreement(times: &[f64], poses: &[Isometry3<f64>], velocities: &[[f64; 3]]) -> Option<Disagreement> {
    let stretches = stretches(times, poses, velocities);
    let count = |of: &dyn Fn(&Stretch) -> bool| stretches.iter().filter(|one| of(one)).count();
    if ONE_IN * count(&Stretch::is_off) <= count(&Stretch::moves) {
        return None;
    }
    let places = stretches.iter().flat_map(|one| (0..3).map(move |axis| (one, axis)));
    let (worst, axis) = places.max_by(|a, b| a.0.beyond(a.1).total_cmp(&b.0.beyond(b.1)))?;
    Some(Disagreement {
        from: (worst.from, times[worst.from]),
        to: (worst.to, times[worst.to]),
        axis,
        told: worst.told[axis],
        way: worst.way[axis],
        slip: misread(&stretches),
    })
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

/// The steps that say something, in stretches.
fn stretches(times: &[f64], poses: &[Isometry3<f64>], velocities: &[[f64; 3]]) -> Vec<Stretch> {
    let mut all = Vec::new();
    let mut own = Stretch::beginning(0);
    for i in 1..times.len() {
        let step = times[i] - times[i - 1];
        if step <= LONGEST_STEP_S {
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
    fn told(step: f64, read: impl Fn(Vector3<f64>, &UnitQuaternion<f64>) -> Vector3<f64>) -> Option<Disagreement> {
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
        disagreement(&times, &poses, &velocities)
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
        // A robot may stop at each of its samples where these are that far apart.
        assert_eq!(told(0.5, |_, _| Vector3::zeros()), None);
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
}
