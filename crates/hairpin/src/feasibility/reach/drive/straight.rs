//! What straight legs between turns in place demand: the scores of reach sets that know of no commands.

use std::cell::RefCell;
use std::collections::BTreeMap;

use nalgebra::Point3;

use super::settings::{DriveLimits, DriveSettings, DriveSite};
use super::stress::Demands;
use super::watch::{Met, watch};
use crate::math::random::hashed_unit;
use crate::trajectory::drive::{Gear, Motion, Planar, Segment};
use crate::trajectory::{SpeedProfile, Timing};

/// Scores of straight legs of one graph, each followed on the ground when it is first asked for.
///
/// Slope, roll and slip are met along the line; the speed is that of a turn in place and a line from rest to rest;
/// curvature does not change, and no gear. A line that the body cannot follow is as steep as its ends are apart in
/// height.
pub struct StraightLegs<'a> {
    site: DriveSite<'a>,
    settings: DriveSettings,
    /// As the settings, but that nothing is refused.
    lax: DriveSettings,
    met: RefCell<BTreeMap<(u32, u32), Met>>,
}

impl<'a> StraightLegs<'a> {
    /// Of the vehicle at `site`, scored as `settings` say; of their limits only the tilt that scores 1 counts.
    pub fn new(site: DriveSite<'a>, settings: &DriveSettings) -> Self {
        let mut lax = settings.clone();
        lax.limits =
            DriveLimits { tilt: f64::INFINITY, joint: f64::INFINITY, clearance: f64::NEG_INFINITY, wheels: false };
        let site = DriveSite { radius: f64::NEG_INFINITY, ..site };
        Self { site, settings: settings.clone(), lax, met: RefCell::default() }
    }

    /// The score of the leg between two waypoints, each with its index, after a turn in place by `turn` rad.
    ///
    /// A pure number by the settings' score; lines are kept by their two indices, which must belong to one graph.
    pub fn stress(&self, from: (u32, &Point3<f64>), to: (u32, &Point3<f64>), turn: f64) -> f64 {
        let way = to.1 - from.1;
        let distance = libm::hypot(way.x, way.y);
        let kept = self.met.borrow().get(&(from.0, to.0)).copied();
        let met = kept.unwrap_or_else(|| self.follow(from.1, to.1, distance));
        self.met.borrow_mut().insert((from.0, to.0), met);
        let settings = &self.settings;
        let full = settings.full_tilt();
        settings.score.of(&Demands {
            slope: met.slope / full,
            roll: met.roll / full,
            curvature_change: 0.0,
            slip: met.slip,
            speed: distance / (self.duration(distance, turn) * settings.speed),
            reversals: 0.0,
            random: hashed_unit(settings.seed, &[from.0.into(), to.0.into()]),
        })
    }

    /// What the body meets along the line, in the mean of the directions allowed.
    fn follow(&self, from: &Point3<f64>, to: &Point3<f64>, distance: f64) -> Met {
        let direction = mean(self.settings.directions);
        let yaw = libm::atan2(to.y - from.y, to.x - from.x) - direction;
        let start = Planar { x: from.x, y: from.y, yaw, curvature: 0.0 };
        let line = [Segment::straight(distance, Gear::Forward)];
        let speed = SpeedProfile::from(self.settings.speed);
        watch(&self.site, &self.lax, &start, &line, &speed, direction.into())
            .unwrap_or_else(|_| Met { slope: libm::atan2((to.z - from.z).abs(), distance), ..Met::default() })
    }

    /// Seconds of a turn and a line, from rest to rest.
    fn duration(&self, distance: f64, turn: f64) -> f64 {
        let settings = &self.settings;
        let segments = [
            Segment { motion: Motion::Turn { angle_rad: turn }, gear: Gear::Forward },
            Segment::straight(distance, Gear::Forward),
        ];
        let response = &self.site.rover.response;
        let profiles = settings.pace.over(settings.speed, &[0.0; 2], &[&segments], response);
        let driving: f64 = profiles.iter().map(|profile| Timing::new(profile, &segments).time_at(distance)).sum();
        driving + turn.abs() / settings.turn_rate
    }
}

/// Of two directions. Straight legs have one: what turns on the way is for drives.
fn mean([low, high]: [f64; 2]) -> f64 {
    if low == high { low } else { 0.5 * (low + high) }
}
