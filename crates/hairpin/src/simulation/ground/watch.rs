//! What a drive has come to: waypoints that were reached, the leg that is being driven, and what ends the run.

use nalgebra::Point3;

use super::plant::{Plant, Stands};
use super::sortie::{DriveSettings, GroundSortie};
use crate::math::power::square;
use crate::robot::rover::Rover;
use crate::simulation::controller::{Reference, Schedule};
use crate::trajectory::{Ended, Track};
use crate::world::terrain::Terrain;

/// Less than this is no progress, m and rad.
/// Of place and heading.
pub(super) const PROGRESS: [f64; 2] = [0.01, std::f64::consts::PI / 180.0];

/// Watches one run.
///
/// Looked at once a turn; what happened between two looks is told by chords and least values.
pub(super) struct Watch<'a> {
    sortie: &'a GroundSortie<'a>,
    settings: &'a DriveSettings,
    plan: &'a Track,
    /// Where legs begin and end, on the ground, m.
    waypoints: Vec<Point3<f64>>,
    reached: Vec<Option<f64>>,
    /// Of the controller, where it follows something.
    ///
    /// `None` for controllers that go from waypoint to waypoint.
    schedule: Option<Schedule>,
    leg: usize,
    next: usize,
    /// When the course was over, s.
    over: Option<f64>,
    /// Where the body was when it last moved on: s; x, y, ψ.
    moved: (f64, [f64; 3]),
    before: [f64; 2],
    /// How it stood at its worst since the last sample.
    ///
    /// Margin in rad, clearance in m; below 0 the vehicle has tipped or touched.
    pub(super) least: Stands,
}

impl<'a> Watch<'a> {
    /// From `place` (x, y, ψ) on, along `plan`.
    pub(super) fn new(
        sortie: &'a GroundSortie<'a>,
        settings: &'a DriveSettings,
        plan: &'a Track,
        place: [f64; 3],
    ) -> Self {
        let legs = &sortie.drive.legs;
        let ends = legs.iter().map(|leg| [leg.to.x, leg.to.y]);
        let start = legs[0].from;
        let on_ground = |[x, y]: [f64; 2]| {
            let height = sortie.terrain.patch(x, y).map_or(0.0, |ground| ground.height);
            Point3::new(x, y, height)
        };
        let waypoints: Vec<Point3<f64>> = std::iter::once([start.x, start.y]).chain(ends).map(on_ground).collect();
        let mut reached = vec![None; waypoints.len()];
        reached[0] = Some(0.0);
        Self {
            sortie,
            settings,
            plan,
            waypoints,
            reached,
            schedule: None,
            leg: 0,
            next: 1,
            over: None,
            moved: (0.0, place),
            before: [place[0], place[1]],
            least: Stands::FREE,
        }
    }

    /// Where the run is to go.
    pub(super) fn reference(&self) -> Reference<'_, Rover> {
        let accept = self.settings.accept;
        Reference { waypoints: &self.waypoints, next: self.next, accept, plan: Some(self.plan) }
    }

    /// Takes the controller's word for where it is.
    ///
    /// Legs without a schedule follow from the waypoints that were reached.
    ///
    /// The leg is cut to those that there are; a controller's leg may go back.
    pub(super) fn heed(&mut self, schedule: Option<Schedule>) {
        self.schedule = schedule;
        if let Some(schedule) = schedule {
            self.leg = schedule.leg.min(self.waypoints.len() - 2);
            self.next = self.leg + 1;
        }
    }

    /// The leg being driven; after the last waypoint, the last.
    pub(super) fn leg(&self) -> usize {
        self.leg
    }

    /// When each waypoint was reached.
    pub(super) fn into_reached(self) -> Vec<Option<f64>> {
        self.reached
    }

    /// Takes note of the vehicle at `t`, and says whether the run ends there.
    ///
    /// In this order: tip-over, belly contact, places to keep out of (by the chord since the last look), the end of the
    /// course, time, no progress.
    ///
    /// Stuck is who has moved no more than 1 cm and turned no more than 1° for `patience` seconds, from where that
    /// began, not from look to look.
    pub(super) fn note(&mut self, t: f64, plant: &Plant) -> Option<Ended> {
        if self.least.margin < 0.0 {
            return Some(Ended::TipOver);
        }
        if self.least.clearance < 0.0 {
            return Some(Ended::BellyContact);
        }
        let at = [plant.x, plant.y];
        let before = std::mem::replace(&mut self.before, at);
        let touched = || self.sortie.keep_outs.segment_distance(before, at) <= self.sortie.clearance_radius;
        if self.settings.keep_outs && touched() {
            return Some(Ended::Obstacle);
        }
        let over = self.progress(t, at, plant.speed == 0.0);
        if over && self.over.is_none() {
            self.over = Some(t);
        }
        let rounding = 1e-9;
        if self.over.is_some_and(|over| t >= over + self.settings.linger - rounding) {
            return Some(if self.reached.iter().all(Option::is_some) { Ended::Done } else { Ended::Time });
        }
        if self.settings.time_limit.is_some_and(|limit| t >= limit - rounding) {
            return Some(Ended::Time);
        }
        let place = [at[0], at[1], plant.yaw];
        let way = (square(place[0] - self.moved.1[0]) + square(place[1] - self.moved.1[1])).sqrt();
        if way > PROGRESS[0] || (place[2] - self.moved.1[2]).abs() > PROGRESS[1] || self.over.is_some() {
            self.moved = (t, place);
        }
        (t - self.moved.0 > self.settings.patience).then_some(Ended::Stuck)
    }

    /// Which waypoints are reached at `at`, and whether that was all.
    ///
    /// Distances are over the ground plan: z is not compared.
    ///
    /// With a schedule both ends of the current leg are looked at, and the course is over where the schedule is and the
    /// vehicle stands; without one waypoints are reached in their order, and the course ends with the last.
    fn progress(&mut self, t: f64, at: [f64; 2], stands: bool) -> bool {
        let accept = square(self.settings.accept);
        let within = |p: &Point3<f64>| square(p.x - at[0]) + square(p.y - at[1]) <= accept;
        let last = self.waypoints.len() - 1;
        match self.schedule {
            Some(schedule) => {
                for k in self.leg..=self.leg + 1 {
                    if self.reached[k].is_none() && within(&self.waypoints[k]) {
                        self.reached[k] = Some(t);
                    }
                }
                schedule.over && stands
            }
            None => {
                while self.next <= last && within(&self.waypoints[self.next]) {
                    self.reached[self.next] = Some(t);
                    self.next += 1;
                }
                self.leg = (self.next - 1).min(last - 1);
                self.next > last
            }
        }
    }
}
