//! What ends a run, and the note that the waters were left.

use nalgebra::Vector2;

use super::sortie::{BoatSortie, SailSettings};
use crate::simulation::course::Course;
use crate::trajectory::Ended;

/// Farther than this from the origin nothing is simulated any more, m.
const FARTHEST: f64 = 1e5;

/// Watches one run.
///
/// Looked at once a turn of the controller, so that ends are known to a period.
#[derive(Debug, Clone)]
pub(super) struct Watch<'a> {
    sortie: &'a BoatSortie<'a>,
    settings: &'a SailSettings,
    before: Vector2<f64>,
    pub(super) left: Option<f64>,
}

impl<'a> Watch<'a> {
    pub(super) fn new(sortie: &'a BoatSortie<'a>, settings: &'a SailSettings) -> Self {
        let start = sortie.waypoints[0];
        Self { sortie, settings, before: Vector2::new(start.x, start.y), left: None }
    }

    /// Whether the run ends at `t` with the boat at `at`. Chords between looks are held against what it must not meet.
    ///
    /// In this order: numbers lost or 100 km off, a keep-out by the chord since the last look, the edge of the waters,
    /// the end of the course and `linger`, the time limit. Touching a keep-out is meeting it.
    pub(super) fn note(&mut self, t: f64, at: &Vector2<f64>, course: &Course) -> Option<Ended> {
        let far = at.norm_squared();
        if far.is_nan() || far >= FARTHEST * FARTHEST {
            return Some(Ended::OffMap);
        }
        let before = std::mem::replace(&mut self.before, *at);
        let inside = (0..2).all(|i| (0.0..=self.sortie.size[i]).contains(&at[i]));
        if !inside && self.left.is_none() {
            self.left = Some(t);
        }
        let places = self.sortie.keep_outs;
        if places.segment_distance([before.x, before.y], [at.x, at.y]) <= self.sortie.boat.radius {
            return Some(Ended::Obstacle);
        }
        if !inside && self.settings.walls {
            return Some(Ended::Wall);
        }
        let rounding = 1e-9;
        if course.over().is_some_and(|over| t >= over + self.settings.linger - rounding) {
            return Some(course.outcome());
        }
        (t >= self.settings.time_limit - rounding).then_some(Ended::Time)
    }
}
