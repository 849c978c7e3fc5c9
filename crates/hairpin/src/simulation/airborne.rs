//! A run in mid-air: flown to its end, or halted at a waypoint, copied there and flown on.

use nalgebra::Point3;

use super::SimulationError;
use super::close_loop::{ClosedLoop, FlySettings, Sortie};
use super::controllers::ControllerSettings;
use super::course::Course;
use super::disturbance::Conditions;
use super::hazard::Hazards;
use super::recorder::Recorder;
use crate::trajectory::{Ended, Flight};
use crate::world::World;

/// Time between two looks at waypoints and hazards, s.
const WATCH_PERIOD: f64 = 0.01;

/// Flies one run: the same bytes for the same arguments.
///
/// The run ends `linger` seconds after its course is over, at the time limit, or at a crash: below the ground (z < 0; a
/// take-off from the floor may dip), the robot's clearance radius in an obstacle, body z downwards for more than
/// 0.5 s or a state that is no longer finite (`tumble`), outside the world's sides or ceiling with `walls`. The log has
/// the channels of [`Flight`], and body rates; `saturated` is the share of rotors at a limit since the sample before.
///
/// # Errors
/// Settings out of bounds; fewer than two waypoints or one that is not finite; a profile with another number of legs; a
/// rotor layout that cannot hover; a course without a minimum-snap curve where one is needed.
pub fn fly(
    sortie: &Sortie,
    controller: &ControllerSettings,
    conditions: &Conditions,
    settings: &FlySettings,
    seed: u64,
) -> Result<Flight, SimulationError> {
    check_course(sortie)?;
    let course = Course::new(sortie.waypoints, settings.accept);
    let recorder = Recorder::new((settings.time_limit / settings.log_period) as usize + 2);
    let mut airborne = Airborne::new(sortie, (course, recorder), controller, conditions, settings, seed)?;
    airborne.fly_on(sortie.world);
    Ok(airborne.into_flight())
}

/// A run that may be flown leg by leg, and copied wherever it halts.
///
/// ```text
/// at_start(sortie) · fly_to(w₁) · … · fly_to(wₙ) · finish()   =   fly(sortie through w₀ … wₙ), to the bit
/// ```
///
/// It halts at the moment a waypoint is reached, before anything is decided that depends on the next one. That takes a controller
/// which knows of one waypoint at a time ([`super::ControllerKind::plans_ahead`]). Copies share the log of what they have flown together.
///
/// `Clone` copies plant, loops, streams and progress: what a beam carries along with a partial trajectory.
#[derive(Debug, Clone)]
pub struct Airborne {
    run: ClosedLoop,
    course: Course,
    hazards: Hazards,
    recorder: Recorder,
    settings: FlySettings,
    /// Ticks between two looks at the course, two samples of the log, two turns of the outer loop; and those to the next.
    every: Due,
    to: Due,
    tick: u64,
    ended: Option<Ended>,
}

/// Ticks.
#[derive(Debug, Clone, Copy)]
struct Due {
    watch: u64,
    log: u64,
    turn: u64,
}

impl Airborne {
    /// At the first waypoint of `sortie`, which alone is looked at, at rest and hovering.
    ///
    /// # Errors
    /// As [`fly`]; a controller that plans over all waypoints.
    pub fn at_start(
        sortie: &Sortie,
        controller: &ControllerSettings,
        conditions: &Conditions,
        settings: &FlySettings,
        seed: u64,
    ) -> Result<Self, SimulationError> {
        if controller.kind.plans_ahead() {
            let bound = "one that flies from waypoint to waypoint";
            return Err(SimulationError::new("controller", controller.kind.word().into(), bound));
        }
        let Some(start) = sortie.waypoints.first() else {
            return Err(SimulationError::new("waypoints", "0".into(), "at least one"));
        };
        check_finite(&sortie.waypoints[..1])?;
        let course = Course::open(*start, settings.accept);
        Self::new(sortie, (course, Recorder::new(0)), controller, conditions, settings, seed)
    }

    fn new(
        sortie: &Sortie,
        (course, recorder): (Course, Recorder),
        controller: &ControllerSettings,
        conditions: &Conditions,
        settings: &FlySettings,
        seed: u64,
    ) -> Result<Self, SimulationError> {
        settings.check()?;
        conditions.check()?;
        let run = ClosedLoop::new(sortie, controller, conditions, settings, seed)?;
        let ticks = |period: f64| ((period / run.period).round() as u64).max(1);
        let every =
            Due { watch: ticks(WATCH_PERIOD), log: ticks(settings.log_period), turn: ticks(run.pilot.period()) };
        let start = sortie.waypoints[0].coords;
        let hazards = Hazards::new(sortie.robot.clearance_radius, settings.walls, &start);
        let to = Due { watch: 0, log: 0, turn: 0 };
        Ok(Self { run, course, hazards, recorder, settings: *settings, every, to, tick: 0, ended: None })
    }

    /// Flies on in `world`, the sortie's, until `waypoint` is reached or the run ends.
    ///
    /// # Errors
    /// A waypoint that is not finite.
    pub fn fly_to(&mut self, world: &World, waypoint: Point3<f64>) -> Result<(), SimulationError> {
        check_finite(&[waypoint])?;
        self.course.extend(waypoint);
        self.fly_on(world);
        self.recorder.seal();
        Ok(())
    }

    /// Ends the course at the waypoint that was reached last, and flies the run to its end.
    pub fn finish(&mut self, world: &World) {
        self.course.close();
        self.fly_on(world);
    }

    /// Number of waypoints that it was told, the first included.
    pub fn waypoints(&self) -> usize {
        self.course.waypoints()
    }

    /// Whether the run ended: no leg will be flown any more.
    pub fn ended(&self) -> bool {
        self.ended.is_some()
    }

    /// The flight so far; one that was halted counts as done.
    pub fn flight(&self) -> Flight {
        self.clone().into_flight()
    }

    fn into_flight(self) -> Flight {
        Flight {
            track: self.recorder.into_track(),
            ended: self.ended.unwrap_or(Ended::Done),
            left_world: self.hazards.left_world(),
            reached: self.course.into_reached(),
        }
    }

    /// Flies until the run ends or its course halts.
    fn fly_on(&mut self, world: &World) {
        while self.ended.is_none() {
            let t = self.tick as f64 * self.run.period;
            if self.to.watch == 0 {
                let position = self.run.position();
                self.course.note(t, &position, self.run.pilot.schedule());
                if self.course.halts() {
                    return;
                }
                self.to.watch = self.every.watch;
                self.ended = self.hazards.note(world, t, &position, self.run.up()).or(self.end_of_time(t));
                if self.ended.is_some() {
                    self.run.record(&mut self.recorder, t, self.course.leg());
                    return;
                }
            }
            if self.to.log == 0 {
                self.to.log = self.every.log;
                self.run.record(&mut self.recorder, t, self.course.leg());
            }
            if self.to.turn == 0 {
                self.to.turn = self.every.turn;
                self.run.turn(self.every.turn as f64 * self.run.period, self.course.target());
            }
            let ticks = self.to.watch.min(self.to.log).min(self.to.turn);
            self.to = Due { watch: self.to.watch - ticks, log: self.to.log - ticks, turn: self.to.turn - ticks };
            self.tick += ticks;
            self.run.fly_at(self.settings.simd, ticks);
        }
    }

    fn end_of_time(&self, t: f64) -> Option<Ended> {
        let rounding = 1e-9;
        if self.course.over().is_some_and(|over| t >= over + self.settings.linger - rounding) {
            return Some(self.course.outcome());
        }
        (t >= self.settings.time_limit - rounding).then_some(Ended::Time)
    }
}

fn check_course(sortie: &Sortie) -> Result<(), SimulationError> {
    let points = sortie.waypoints;
    if points.len() < 2 {
        return Err(SimulationError::new("waypoints", points.len().to_string(), "at least two"));
    }
    check_finite(points)?;
    match sortie.profile {
        Some(profile) if profile.legs.len() + 1 != points.len() => {
            let found = format!("{} legs for {} waypoints", profile.legs.len(), points.len());
            Err(SimulationError::new("profile", found, "one leg between each two waypoints"))
        }
        _ => Ok(()),
    }
}

fn check_finite(points: &[Point3<f64>]) -> Result<(), SimulationError> {
    match points.iter().find(|point| !point.iter().all(|c| c.is_finite())) {
        Some(point) => Err(SimulationError::new("waypoints", format!("{:?}", point.coords.as_slice()), "finite")),
        None => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::Vector3;

    use super::*;
    use crate::simulation::tests::{cage, flightgoggles};
    use crate::simulation::{ControllerKind, DiscreteGust, Gusts};
    use crate::world::{Obstacle, Shape};

    const KINDS: [ControllerKind; 6] = [
        ControllerKind::UnstableWaypoint,
        ControllerKind::StableWaypoint,
        ControllerKind::FixedVelocity,
        ControllerKind::Anafi,
        ControllerKind::MinimumSnap,
        ControllerKind::Geometric,
    ];

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
                    assert!(elsewhere.flight() != next.flight() || run.ended());
                    run = next;
                    let (so_far, length) = (run.flight().track, run.flight().track.len());
                    assert_eq!(so_far.times(), &whole.track.times()[..length], "{kind:?}");
                    assert_eq!(so_far.poses(), &whole.track.poses()[..length], "{kind:?}");
                }
                run.finish(world);
                assert_eq!(run.flight(), whole, "{kind:?}, {time_limit} s");
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
                assert!(error.to_string().contains(kind.word()) && error.field == "controller", "{error}");
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
