//! Heights of logs that have none: a planar odometry tells where on a map a vehicle was, and what drives is as high as
//! the ground there. Taken as 0 m they would be deviations from a plan that goes up and down with the map.

use hairpin::campaign::{Footing, Setup};
use hairpin::math::rotation::euler_from_quaternion;
use hairpin_formats::logs::{LogFrame, LoggedMotion, Sample, Span};
use nalgebra::{Point3, UnitQuaternion};

/// A way as long as this tells the heading of a log without attitudes, m.
const WAY_M: f64 = 0.05;

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
        let headings = headings(samples);
        let way: Vec<[f64; 3]> =
            samples.iter().zip(headings).map(|(sample, yaw)| [sample.p_m.x, sample.p_m.y, yaw]).collect();
        let (mut lost, mut above, mut last) = (Vec::new(), 0.0, 0.0);
        for (sample, rest) in samples.iter_mut().zip(self.footing.resting(&way)) {
            let ground = self.footing.ground(sample.p_m.x, sample.p_m.y);
            match (rest, ground) {
                (Some(rest), _) => (last, above) = (rest, ground.map_or(above, |ground| rest - ground)),
                (None, Some(ground)) => {
                    last = ground + above;
                    lost.push(Span { from_s: sample.t_s, to_s: sample.t_s });
                }
                (None, None) => {}
            }
            sample.p_m.z = last;
        }
        lost
    }

    /// What is told of it.
    pub(crate) fn in_words(&self, samples: &[Sample], lost: usize) -> String {
        let by = if samples.iter().all(|sample| sample.attitude.is_some()) {
            "the log's headings"
        } else {
            "the headings of its way"
        };
        let lost = match lost {
            0 => String::new(),
            lost => format!("; at {lost} of {} samples it cannot stand on it, and they are not judged", samples.len()),
        };
        format!("the log has no heights: they are those of the vehicle on the map's ground, with {by}{lost}")
    }
}

/// The ground under `waypoints` of what drives: heights of its missions are the ground's.
pub(super) fn on_ground(setup: &Setup, waypoints: &mut [Point3<f64>]) {
    let Some(footing) = setup.footing() else { return };
    for place in waypoints {
        place.z = footing.ground(place.x, place.y).unwrap_or(place.z);
    }
}

/// ψ of each sample: the attitude's, or of its way where that is not told, rad.
fn headings(samples: &[Sample]) -> Vec<f64> {
    let mut headings = Vec::with_capacity(samples.len());
    let Some(first) = samples.first() else { return headings };
    let (mut from, mut heading) = (first.p_m, None);
    for sample in samples {
        let way = sample.p_m.xy() - from.xy();
        if way.norm() >= WAY_M {
            let turned = libm::atan2(way.y, way.x);
            if heading.is_none() {
                // Before it has moved it stands as it sets off.
                headings.fill(turned);
            }
            (from, heading) = (sample.p_m, Some(turned));
        }
        headings.push(heading.unwrap_or(0.0));
    }
    let yaw_of = |turn: UnitQuaternion<f64>| euler_from_quaternion(&[turn.w, turn.i, turn.j, turn.k])[2];
    let told = |(sample, way): (&Sample, f64)| sample.attitude.map_or(way, yaw_of);
    samples.iter().zip(headings).map(told).collect()
}
