//! Heights of logs that have none: a planar odometry tells where on a map a vehicle was, and what drives is as high as
//! the ground there. Taken as 0 m they would be deviations from a plan that goes up and down with the map.

use hairpin::campaign::{Footing, OnGround, Setup};
use hairpin::math::rotation::euler_from_quaternion;
use hairpin_formats::logs::{LogFrame, LoggedMotion, Sample, Span};
use nalgebra::{Point3, UnitQuaternion};

/// The ground that the heights of a log are taken from.
pub(crate) struct Heights<'a> {
    footing: &'a dyn Footing,
}

impl<'a> Heights<'a> {
    /// The ground of `setup`, where its robot drives on one and `motion` has no heights: there is no column of them, or
    /// all are 0, as planar estimators publish them. `lift_m` is what they are moved by by name, which makes them
    /// somebody's word.
    pub(crate) fn of(setup: &'a Setup, (frame, motion): (&LogFrame, &LoggedMotion), lift_m: f64) -> Option<Self> {
        let is_flat = motion.samples.iter().all(|sample| sample.p_m.z == 0.0);
        let is_untold = is_flat && lift_m == 0.0 && !matches!(frame, LogFrame::Enu(_));
        setup.footing().filter(|_| is_untold).map(|footing| Self { footing })
    }

    /// Refuses a motion without heights of what flies: at 0 m it would be another one.
    ///
    /// # Errors
    /// In a sentence.
    pub(crate) fn needed(setup: &Setup, motion: &LoggedMotion) -> Result<(), String> {
        match &motion.no_heights {
            Some(why) if setup.room().is_some_and(|room| room.flies) => {
                Err(format!("{why}: heights of what flies are needed, as `z_m`, m upwards in the world's frame"))
            }
            _ => Ok(()),
        }
    }

    /// Puts `samples`, in the world's frame, on the ground; gives the moments at which the vehicle cannot stand on it,
    /// whose heights nobody knows. Off the map they are as high above it as they were last: that they are off it is
    /// told by their places.
    pub(crate) fn put(&self, samples: &mut [Sample]) -> Vec<Span> {
        let places: Vec<[f64; 2]> = samples.iter().map(|sample| [sample.p_m.x, sample.p_m.y]).collect();
        let told: Vec<Option<f64>> = samples.iter().map(|sample| sample.attitude.map(yaw)).collect();
        let OnGround { heights, lost } = OnGround::of(self.footing, &places, &told);
        for (sample, height) in samples.iter_mut().zip(heights) {
            sample.p_m.z = height;
        }
        lost.into_iter().map(|i| Span { from_s: samples[i].t_s, to_s: samples[i].t_s }).collect()
    }

    /// What is told of it.
    pub(crate) fn in_words(&self, samples: &[Sample], lost: usize) -> String {
        let whose = samples.iter().all(|sample| sample.attitude.is_some()).then_some("log");
        let lost = match lost {
            0 => String::new(),
            lost => format!("; at {lost} of {} samples it cannot stand on it, and they are not judged", samples.len()),
        };
        format!("the log has no heights: they are {}{lost}", OnGround::in_words(whose))
    }
}

/// The ground under `waypoints` of what drives: heights of its missions are the ground's.
pub(super) fn on_ground(setup: &Setup, waypoints: &mut [Point3<f64>]) {
    let Some(footing) = setup.footing() else { return };
    for place in waypoints {
        place.z = footing.ground(place.x, place.y).unwrap_or(place.z);
    }
}

fn yaw(turn: UnitQuaternion<f64>) -> f64 {
    euler_from_quaternion(&[turn.w, turn.i, turn.j, turn.k])[2]
}
