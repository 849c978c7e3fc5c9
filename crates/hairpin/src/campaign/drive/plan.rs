//! The planned motion of a drive: its commands followed on the ground, step by step.

use nalgebra::{Isometry3, Point3, Translation3, Vector3};

use super::DriveSetup;
use crate::campaign::{Case, Timed};
use crate::feasibility::steering::shooting::rough::{Driven, Steps};
use crate::math::rotation::{quaternion_from_euler, unit_quaternion};
use crate::robot::rover::Settled;
use crate::trajectory::drive::{Drive, DriveLeg, Gear, Motion, Planar, Segment};
use crate::trajectory::{Channel, Track, TrackError};
use crate::world::terrain::Terrain;

/// Steps of a planned path: a tenth of a second's way at walking speed, and 3° in turns.
const STEPS: Steps = Steps { length: 0.1, angle: 0.05, least: 4 };

/// One sample of the plan.
struct Sample {
    t: f64,
    leg: usize,
    at: Planar,
    settled: Settled,
}

/// The planned motion with the channels `leg`, `vx_m_s`, `vy_m_s`, `vz_m_s`, `curvature_1_m`. Where the ground does not carry
/// a leg to its end, as in a folder that was edited, it ends there. A case without a drive is drawn along its straight legs.
///
/// # Errors
/// A case whose numbers are no track.
pub(in crate::campaign) fn track(setup: &DriveSetup, case: &Case) -> Result<Track, TrackError> {
    let straight;
    let drive = match &case.drive {
        Some(drive) => drive,
        None => {
            straight = straight_legs(setup, &case.waypoints);
            &straight
        }
    };
    let samples = samples(setup, drive);
    let mut columns: [Vec<f64>; 5] = Default::default();
    let (mut times, mut poses) = (Vec::with_capacity(samples.len()), Vec::with_capacity(samples.len()));
    let places: Vec<Point3<f64>> = samples.iter().map(|s| Point3::new(s.at.x, s.at.y, s.settled.z)).collect();
    for (i, sample) in samples.iter().enumerate() {
        times.push(sample.t);
        let attitude = quaternion_from_euler(sample.settled.roll, sample.settled.pitch, sample.at.yaw);
        let attitude = unit_quaternion(&attitude);
        poses.push(Isometry3::from_parts(Translation3::from(places[i]), attitude));
        let (before, after) = (i.saturating_sub(1), (i + 1).min(samples.len() - 1));
        let elapsed = samples[after].t - samples[before].t;
        let velocity = if elapsed > 0.0 { (places[after] - places[before]) / elapsed } else { Vector3::zeros() };
        let row = [sample.leg as f64, velocity.x, velocity.y, velocity.z, sample.at.curvature];
        for (column, value) in columns.iter_mut().zip(row) {
            column.push(value);
        }
    }
    let names = ["leg", "vx_m_s", "vy_m_s", "vz_m_s", "curvature_1_m"];
    let channels = names.into_iter().zip(columns).map(|(name, values)| Channel { name: name.into(), values });
    Track::new(times, poses, channels.collect())
}

/// The timed reference of a mission at `rate` (Hz).
pub(in crate::campaign) fn timed(setup: &DriveSetup, case: &Case, rate: f64) -> Vec<Timed> {
    let Ok(track) = track(setup, case) else { return Vec::new() };
    let (Some(end), Some(velocity)) = (track.times().last(), velocities(&track)) else { return Vec::new() };
    let times = track.times();
    let count = (end * rate).floor() as usize;
    (0..=count)
        .map(|k| k as f64 / rate)
        .map(|t| {
            let after = times.partition_point(|time| *time < t).min(times.len() - 1);
            let before = after.saturating_sub(1);
            let span = times[after] - times[before];
            let share = if span > 0.0 { ((t - times[before]) / span).clamp(0.0, 1.0) } else { 1.0 };
            let position = track.position(before) + (track.position(after) - track.position(before)) * share;
            Timed { t, position, velocity: velocity(after) }
        })
        .collect()
}

fn velocities(track: &Track) -> Option<impl Fn(usize) -> Vector3<f64>> {
    let [x, y, z] = [track.channel("vx_m_s")?, track.channel("vy_m_s")?, track.channel("vz_m_s")?];
    Some(move |i: usize| Vector3::new(x[i], y[i], z[i]))
}

fn samples(setup: &DriveSetup, drive: &Drive) -> Vec<Sample> {
    let site = setup.site();
    let mut samples: Vec<Sample> = Vec::new();
    let mut t = 0.0;
    for (number, leg) in drive.legs.iter().enumerate() {
        let mut at = leg.from;
        if samples.is_empty() {
            let settled = setup.rest(&at).unwrap_or_default();
            samples.push(Sample { t, leg: number, at, settled });
        }
        for segment in &leg.segments {
            let mut steps: Vec<Driven> = Vec::new();
            let observe = |driven: &Driven| steps.push(*driven);
            let prediction = site.trace(&at, std::slice::from_ref(segment), STEPS, observe);
            let duration = segment.duration(drive.speed, drive.turn_rate);
            let count = steps.len() as f64;
            samples.extend(steps.iter().enumerate().map(|(i, step)| Sample {
                t: t + duration * (i as f64 + 0.5) / count,
                leg: number,
                at: step.at,
                settled: setup.on_ground(step.settled, &step.at),
            }));
            t += duration;
            match prediction {
                Ok(prediction) => at = prediction.end,
                Err(_) => return samples,
            }
        }
        // A leg's end is the waypoint, which the next one begins at.
        let settled = setup.rest(&leg.to).unwrap_or_default();
        let last = samples.last().map_or(0.0, |sample| sample.t);
        if t > last {
            samples.push(Sample { t, leg: number, at: leg.to, settled });
        }
    }
    samples
}

/// The straight way from waypoint to waypoint, turning in place at each: what a drive without a witness is drawn as.
fn straight_legs(setup: &DriveSetup, waypoints: &[Point3<f64>]) -> Drive {
    let mut yaw = setup.scenario.task.start.yaw_deg.to_radians();
    let mut legs = Vec::with_capacity(waypoints.len().saturating_sub(1));
    for pair in waypoints.windows(2) {
        let way = pair[1] - pair[0];
        let (length, heading) = (libm::hypot(way.x, way.y), libm::atan2(way.y, way.x));
        let turn = libm::remainder(heading - yaw, std::f64::consts::TAU);
        let turn = Segment { motion: Motion::Turn { angle_rad: turn }, gear: Gear::Forward };
        let place = |p: &Point3<f64>, yaw| Planar { x: p.x, y: p.y, yaw, curvature: 0.0 };
        legs.push(DriveLeg {
            from: place(&pair[0], yaw),
            to: place(&pair[1], heading),
            segments: vec![turn, Segment::straight(length, Gear::Forward)],
        });
        yaw = heading;
    }
    Drive { legs, speed: setup.speed(), turn_rate: setup.turn_rate(), direction: 0.0 }
}

impl DriveSetup<'_> {
    /// How the vehicle stands at `at`; `None` where it finds no rest.
    pub(in crate::campaign) fn rest(&self, at: &Planar) -> Option<Settled> {
        let rest = self.planner.suspension.settle_cold(self.map.as_ref(), [at.x, at.y, at.yaw]);
        Some(self.on_ground(rest.ok()?.0, at))
    }

    /// `settled` at the height of the ground, which a vehicle without wheels does not ask for.
    fn on_ground(&self, settled: Settled, at: &Planar) -> Settled {
        match self.planner.suspension.wheelbase() {
            Some(_) => settled,
            None => Settled { z: self.map.patch(at.x, at.y).map_or(0.0, |patch| patch.height), ..settled },
        }
    }
}
