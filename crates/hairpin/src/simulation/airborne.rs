//! A run in mid-air: halted at a waypoint, copied there and flown on.

use nalgebra::Point3;

use super::SimulationError;
use super::close_loop::{FlySettings, Sortie};
use super::controllers::{ControllerSettings, Pilot};
use super::course::Course;
use super::disturbance::Conditions;
use super::recorder::Recorder;
use super::run::{Hand, Run, check_finite};
use crate::trajectory::Flight;
use crate::world::World;

/// A run that may be flown leg by leg, and copied wherever it halts.
///
/// ```text
/// at_start(sortie) · fly_to(w₁) · … · fly_to(wₙ) · finish()   =   fly(sortie through w₀ … wₙ), to the bit
/// ```
///
/// It halts at the moment a waypoint is reached, before anything is decided that depends on the next one. That takes a
/// controller which knows of one waypoint at a time ([`super::ControllerKind::plans_ahead`]). Copies share the log of
/// what they have flown together.
///
/// `Clone` copies plant, loops, streams and progress: what a beam carries along with a partial trajectory.
#[derive(Debug, Clone)]
pub struct Airborne {
    run: Run,
    pilot: Pilot,
    name: &'static str,
}

impl Airborne {
    /// At the first waypoint of `sortie`, which alone is looked at, at rest and hovering.
    ///
    /// `sortie.waypoints` beyond the first and its profile are not looked at. Noise, gusts and dropouts come from
    /// `seed`, as in a run that is flown at once.
    ///
    /// # Errors
    /// As [`super::fly`]; a controller that plans over all waypoints.
    pub fn at_start(
        sortie: &Sortie,
        controller: &ControllerSettings,
        conditions: &Conditions,
        settings: &FlySettings,
        seed: u64,
    ) -> Result<Self, SimulationError> {
        let name = controller.kind.word();
        if controller.kind.plans_ahead() {
            let bound = "one that flies from waypoint to waypoint";
            return Err(SimulationError::new("controller", name.into(), bound));
        }
        let Some(start) = sortie.waypoints.first() else {
            return Err(SimulationError::new("waypoints", "0".into(), "at least one"));
        };
        check_finite(&sortie.waypoints[..1])?;
        let course = Course::open(*start, settings.accept);
        let mut run = Run::new(sortie, (course, Recorder::new(0)), conditions, settings, seed)?;
        let mut pilot = Pilot::new(controller, sortie.robot)?;
        run.begin(&mut Hand { name, controller: &mut pilot, plan: None })?;
        Ok(Self { run, pilot, name })
    }

    /// Flies on in `world`, the sortie's, until `waypoint` is reached or the run ends.
    ///
    /// `waypoint` in m. After the run has ended nothing is flown any more, and no error told: [`Airborne::ended`] says
    /// so.
    ///
    /// # Errors
    /// A waypoint that is not finite; [`SimulationError::Controller`].
    pub fn fly_to(&mut self, world: &World, waypoint: Point3<f64>) -> Result<(), SimulationError> {
        check_finite(&[waypoint])?;
        self.run.course.extend(waypoint);
        self.fly_on(world)?;
        self.run.recorder.seal();
        Ok(())
    }

    /// Ends the course at the waypoint that was reached last, and flies the run to its end.
    ///
    /// # Errors
    /// [`SimulationError::Controller`].
    pub fn finish(&mut self, world: &World) -> Result<(), SimulationError> {
        self.run.course.close();
        self.fly_on(world)
    }

    fn fly_on(&mut self, world: &World) -> Result<(), SimulationError> {
        self.run.fly_on(&mut Hand { name: self.name, controller: &mut self.pilot, plan: None }, world)
    }

    /// Number of waypoints that it was told, the first included.
    pub fn waypoints(&self) -> usize {
        self.run.course.waypoints()
    }

    /// Whether the run ended: no leg will be flown any more.
    pub fn ended(&self) -> bool {
        self.run.ended.is_some()
    }

    /// The flight so far; one that was halted counts as done.
    ///
    /// A copy: the log is put together anew at each call, O(samples).
    pub fn so_far(&self) -> Flight {
        self.run.clone().into_flight()
    }
}

#[cfg(feature = "unit-tests")]
mod tests {
    use nalgebra::Vector3;

    use super::*;
    use crate::simulation::tests::{KINDS, cage, flightgoggles};
    use crate::simulation::{DiscreteGust, Gusts, fly};
    use crate::trajectory::Ended;
    use crate::world::{Obstacle, Shape};

    fn points(list: &[[f64; 3]]) -> Vec<Point3<f64>> {
        list.iter().copied().map(Point3::from).collect()
    }

    fn stormy() -> Conditions {
        let gusts = Some(Gusts { std: 1.0, correlation: 1.0 });
        let gust = DiscreteGust { velocity: Vector3::y(), start: 2.0, duration: 3.0 };
        Conditions { wind: Vector3::x(), gusts, discrete_gust: Some(gust), noise: true }
    }

    /// Leg by leg, from a copy each time, while another copy flies elsewhere: the same as at once.
    #[test]
    fn flown_leg_by_leg_is_flown_at_once_to_the_bit() {
        let robot = flightgoggles();
        let far = points(&[[5.0, 5.0, 5.0], [12.0, 6.0, 7.0], [6.0, 14.0, 4.0], [16.0, 15.0, 12.0], [9.0, 4.0, 9.0]]);
        // The third waypoint lies within the acceptance radius of the second, the last within that of the start.
        let near = points(&[[5.0, 5.0, 5.0], [12.0, 6.0, 7.0], [12.4, 6.0, 7.0], [4.0, 12.0, 6.0], [5.2, 5.1, 5.0]]);
        let wall = Obstacle { name: "wall".into(), shape: Shape::cuboid([9.0, 10.0, 5.0], [6.0, 0.5, 10.0]).unwrap() };
        let walled = World::new(Vector3::repeat(30.0), 0.0, vec![wall]).unwrap();
        let mut endings = Vec::new();
        for kind in KINDS.into_iter().filter(|kind| !kind.plans_ahead()) {
            for (course, world, conditions, time_limit, step) in [
                (&far, &cage(), Conditions::default(), 90.0, 0.001),
                (&far, &cage(), stormy(), 90.0, 0.0005),
                (&near, &cage(), stormy(), 90.0, 0.001),
                (&far, &walled, Conditions::default(), 90.0, 0.001),
                (&far, &cage(), Conditions::default(), 6.0, 0.001),
            ] {
                let sortie = Sortie { robot: &robot, world, waypoints: course, profile: None };
                let controller = ControllerSettings { kind, ..ControllerSettings::default() };
                let settings = FlySettings { time_limit, step, log_period: 0.013, ..FlySettings::default() };
                let whole = fly(&sortie, &controller, &conditions, &settings, 3).unwrap();
                let mut run = Airborne::at_start(&sortie, &controller, &conditions, &settings, 3).unwrap();
                for waypoint in &course[1..] {
                    let mut elsewhere = run.clone();
                    elsewhere.fly_to(world, Point3::new(2.0, 2.0, 3.0)).unwrap();
                    let mut next = run.clone();
                    next.fly_to(world, *waypoint).unwrap();
                    assert!(elsewhere.so_far() != next.so_far() || run.ended());
                    run = next;
                    let (so_far, length) = (run.so_far().track, run.so_far().track.len());
                    assert_eq!(so_far.times(), &whole.track.times()[..length], "{kind:?}");
                    assert_eq!(so_far.poses(), &whole.track.poses()[..length], "{kind:?}");
                }
                run.finish(world).unwrap();
                assert_eq!(run.so_far(), whole, "{kind:?}, {time_limit} s");
                endings.push(whole.ended);
            }
        }
        for ended in [Ended::Done, Ended::Obstacle, Ended::Time] {
            assert!(endings.contains(&ended), "{ended:?} is not among {endings:?}");
        }
    }

    #[test]
    fn who_plans_over_all_waypoints_is_not_flown_leg_by_leg() {
        let (robot, world, waypoints) = (flightgoggles(), cage(), points(&[[5.0; 3], [9.0; 3]]));
        let sortie = Sortie { robot: &robot, world: &world, waypoints: &waypoints, profile: None };
        for kind in KINDS {
            let controller = ControllerSettings { kind, ..ControllerSettings::default() };
            let begun = Airborne::at_start(&sortie, &controller, &Conditions::default(), &FlySettings::default(), 0);
            assert_eq!(begun.is_err(), kind.plans_ahead(), "{kind:?}");
            if let Err(error) = begun {
                assert!(error.to_string().contains(kind.word()) && error.field() == "controller", "{error}");
            }
        }
        let controller = ControllerSettings::default();
        let begin = |waypoints| {
            let sortie = Sortie { waypoints, ..sortie };
            Airborne::at_start(&sortie, &controller, &Conditions::default(), &FlySettings::default(), 0)
        };
        let nameless = points(&[[f64::NAN; 3]]);
        assert!(begin(&[]).is_err() && begin(&nameless).is_err());
        let nowhere = Point3::new(f64::INFINITY, 0.0, 0.0);
        assert!(begin(&waypoints).unwrap().fly_to(&world, nowhere).is_err());
    }
}
