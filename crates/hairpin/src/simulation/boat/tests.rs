//! Runs of boats: physics against closed forms and finer steps, controllers by their step responses, and how runs end.

use nalgebra::{Point3, Vector2};

use super::controllers::Helmsman;
use super::*;
use crate::math::polynomial::septic;
use crate::robot::boat::{Boat, cybership};
use crate::simulation::OwnController;
use crate::trajectory::{Ended, Flight, Profile, ProfileLeg};
use crate::world::terrain::{KeepOut, KeepOutShape, KeepOuts};

const KINDS: [BoatControllerKind; 2] = [BoatControllerKind::LineOfSight, BoatControllerKind::Tracking];

fn points(list: &[[f64; 2]]) -> Vec<Point3<f64>> {
    list.iter().map(|[x, y]| Point3::new(*x, *y, 0.0)).collect()
}

/// From rest to rest along each leg, at a mean of 0.06 m/s: turning as it goes, it goes sideways.
fn plan(waypoints: &[Point3<f64>]) -> Profile {
    let heading = |k: usize| {
        let way = waypoints[(k + 1).min(waypoints.len() - 1)] - waypoints[k.min(waypoints.len() - 2)];
        libm::atan2(way.y, way.x)
    };
    let leg = |k: usize| {
        let duration = (waypoints[k + 1] - waypoints[k]).norm() / 0.06;
        let rest = |value: f64| [value, 0.0, 0.0, 0.0];
        let axis = |i: usize| septic(&rest(waypoints[k][i]), &rest(waypoints[k + 1][i]), duration);
        let turn = septic(&rest(heading(k)), &rest(heading(k + 1)), duration);
        ProfileLeg { duration, coefficients: [axis(0), axis(1), turn] }
    };
    Profile { legs: (0..waypoints.len() - 1).map(leg).collect() }
}

struct Scene {
    boat: Boat,
    keep_outs: KeepOuts,
    waypoints: Vec<Point3<f64>>,
    profile: Profile,
    conditions: BoatConditions,
    settings: SailSettings,
}

impl Scene {
    fn through(list: &[[f64; 2]]) -> Self {
        let waypoints = points(list);
        let profile = plan(&waypoints);
        let (conditions, settings) = (BoatConditions::default(), SailSettings::default());
        Self { boat: cybership(), keep_outs: KeepOuts::default(), waypoints, profile, conditions, settings }
    }

    fn with_current(self, current: [f64; 2]) -> Self {
        Self { conditions: BoatConditions { current, ..self.conditions }, ..self }
    }

    fn sortie(&self) -> BoatSortie<'_> {
        BoatSortie {
            boat: &self.boat,
            nominal: &self.boat,
            size: [30.0, 20.0],
            keep_outs: &self.keep_outs,
            waypoints: &self.waypoints,
            profile: Some(&self.profile),
        }
    }

    fn sail(&self, kind: BoatControllerKind) -> Flight {
        let controller = BoatController { kind, speed: None };
        sail(&self.sortie(), &controller, &self.conditions, &self.settings, 3).expect("a run")
    }
}

/// Largest distance from the planned place at the same time, m.
fn behind(flight: &Flight, plan: &Profile) -> f64 {
    let track = &flight.track;
    let off = |i: usize| {
        let (leg, tau) = plan.locate(track.times()[i]).expect("a leg");
        let wanted = plan.legs[leg].position(tau);
        let at = track.position(i);
        libm::hypot(wanted.x - at.x, wanted.y - at.y)
    };
    (0..track.len()).map(off).fold(0.0, f64::max)
}

/// Largest distance from the line between two waypoints, m, of what was sailed `from` s to `to` s.
fn astray(flight: &Flight, a: [f64; 2], b: [f64; 2], from: f64, to: f64) -> f64 {
    let (along, track) = (Vector2::new(b[0] - a[0], b[1] - a[1]).normalize(), &flight.track);
    let during = (0..track.len()).filter(|i| (from..to).contains(&track.times()[*i]));
    let off = |i: usize| {
        let at = track.position(i);
        (along.x * (at.y - a[1]) - along.y * (at.x - a[0])).abs()
    };
    during.map(off).fold(0.0, f64::max)
}

#[test]
fn halved_steps_come_to_the_same_place() {
    let boat = cybership();
    let run = |step: f64| {
        let start = BoatPlant::new(&boat, Vector2::new(1.0, 2.0), 0.7, Vector2::new(0.1, -0.05)).held();
        let mut plant = start.with_step(step);
        plant.push = Vector2::new(0.2, 0.1);
        for k in 0..300 {
            let command = BoatCommand { surge: 1.5, sway: if k % 40 < 20 { 0.8 } else { -0.8 }, yaw: 0.3 };
            plant.advance(&command, 0.1);
        }
        plant.position()
    };
    let (usual, fine) = (run(0.02), run(0.0025));
    assert!((usual - fine).norm() < 1e-4, "{usual} {fine}");
}

#[test]
fn what_is_held_stays_where_it_is_and_thrust_lags() {
    let boat = cybership();
    let mut plant = BoatPlant::new(&boat, Vector2::zeros(), 0.4, Vector2::new(0.1, 0.05)).held();
    let thrust = plant.thrust();
    plant.advance(&thrust.into(), 30.0);
    assert!(plant.position().norm() < 1e-9 && plant.over_ground().norm() < 1e-9, "{}", plant.position());
    // One time constant.
    let mut plant = BoatPlant::new(&boat, Vector2::zeros(), 0.0, Vector2::zeros());
    plant.advance(&BoatCommand { surge: 1.0, ..BoatCommand::default() }, 0.3);
    assert!((plant.thrust().x - (1.0 - (-1f64).exp())).abs() < 1e-9);
}

#[test]
fn the_autopilot_finds_its_line_across_a_current() {
    let [a, b] = [[2.0, 10.0], [26.0, 10.0]];
    let still = Scene::through(&[a, b]).sail(BoatControllerKind::LineOfSight);
    assert_eq!(still.ended, Ended::Done);
    assert!(astray(&still, a, b, 0.0, 200.0) < 0.01);
    let drifting = Scene::through(&[a, b]).with_current([0.0, 0.08]).sail(BoatControllerKind::LineOfSight);
    assert_eq!(drifting.ended, Ended::Done);
    let reached = drifting.reached[1].expect("reached");
    // Carried off at first, and back: the integral finds the angle of crab, slowly.
    let ([first, last], worst) = ([0.5, 0.9].map(|share| share * reached), astray(&drifting, a, b, 0.0, reached));
    let [middle, end] = [astray(&drifting, a, b, first, last), astray(&drifting, a, b, last, reached)];
    assert!((0.3..1.0).contains(&worst) && middle < 0.7 * worst && end < 0.35 * worst, "{worst} {middle} {end}");
}

#[test]
fn the_autopilot_settles_on_a_leg_across() {
    let corner = [[2.0, 5.0], [12.0, 5.0], [12.0, 18.0]];
    let flight = Scene::through(&corner).sail(BoatControllerKind::LineOfSight);
    assert_eq!(flight.ended, Ended::Done);
    let [turned, reached] = [1, 2].map(|k| flight.reached[k].expect("reached"));
    let overshoot = astray(&flight, corner[1], corner[2], turned + 5.0, reached);
    assert!((0.5..2.0).contains(&overshoot), "{overshoot}");
    assert!(astray(&flight, corner[1], corner[2], reached - 6.0, reached) < 0.3 * overshoot);
}

#[test]
fn a_waypoint_that_was_missed_is_gone_back_to() {
    // Back at an acute angle, by a radius that its turn does not pass within.
    let mut scene = Scene::through(&[[3.0, 8.0], [15.0, 8.0], [11.0, 9.0], [20.0, 12.0]]);
    scene.settings.accept = 0.3;
    let flight = scene.sail(BoatControllerKind::LineOfSight);
    assert_eq!(flight.ended, Ended::Done);
    let times: Vec<f64> = flight.reached.iter().map(|t| t.expect("reached")).collect();
    assert!(times[2] - times[1] > 20.0, "{times:?}");
}

#[test]
fn the_tracker_keeps_to_its_plan_in_a_current_and_comes_back_when_pushed() {
    let mut scene = Scene::through(&[[3.0, 3.0], [12.0, 5.0], [6.0, 12.0], [16.0, 15.0]]).with_current([0.06, -0.04]);
    let flight = scene.sail(BoatControllerKind::Tracking);
    assert_eq!(flight.ended, Ended::Done);
    assert!(behind(&flight, &scene.profile) < 0.02, "{}", behind(&flight, &scene.profile));
    scene.conditions.external_force = [0.0, 0.3];
    let flight = scene.sail(BoatControllerKind::Tracking);
    assert_eq!(flight.ended, Ended::Done);
    let (off, end) = (behind(&flight, &scene.profile), flight.track.position(flight.track.len() - 1));
    assert!((0.02..0.2).contains(&off), "{off}");
    assert!(libm::hypot(end.x - 16.0, end.y - 15.0) < 0.02, "{end}");
}

#[test]
fn ours_as_a_strangers_sail_alike_and_noise_is_drawn_by_the_seed() {
    let mut scene = Scene::through(&[[3.0, 3.0], [10.0, 5.0], [6.0, 10.0]]);
    scene.conditions.noise = true;
    for kind in KINDS {
        let settings = BoatController { kind, speed: None };
        let own = OwnController::new("ours", move |boat| Helmsman::new(&settings, boat).expect("a controller"));
        let theirs = sail_with(&scene.sortie(), &own, &scene.conditions, &scene.settings, 3).expect("a run");
        let ours = scene.sail(kind);
        assert_eq!(ours, theirs, "{kind:?}");
        let other = sail(&scene.sortie(), &settings, &scene.conditions, &scene.settings, 4).expect("a run");
        assert_ne!(ours, other, "{kind:?}");
    }
}

#[test]
fn runs_end_at_places_to_keep_out_of_at_walls_and_in_time() {
    let buoy = KeepOutShape::Circle { center_m: [8.0, 5.5], radius_m: 0.3 };
    let mut scene = Scene::through(&[[3.0, 5.0], [12.0, 5.0], [12.0, 21.0]]);
    scene.settings.time_limit = 40.0;
    assert_eq!(scene.sail(BoatControllerKind::LineOfSight).ended, Ended::Time);
    scene.settings.time_limit = 600.0;
    let left = scene.sail(BoatControllerKind::LineOfSight);
    assert!(left.ended == Ended::Done && left.left_world.is_some());
    scene.settings.walls = true;
    assert_eq!(scene.sail(BoatControllerKind::LineOfSight).ended, Ended::Wall);
    scene.keep_outs = KeepOuts::new(vec![KeepOut { name: "buoy".into(), shape: buoy }]).expect("a place");
    let hit = scene.sail(BoatControllerKind::LineOfSight);
    assert_eq!(hit.ended, Ended::Obstacle);
    let last = hit.track.position(hit.track.len() - 1);
    assert!(libm::hypot(last.x - 8.0, last.y - 5.5) <= 0.3 + scene.boat.radius);
}

#[test]
fn mistakes_are_named() {
    let scene = Scene::through(&[[3.0, 5.0], [12.0, 5.0]]);
    let told = |sortie: &BoatSortie, speed, conditions: &BoatConditions, settings: &SailSettings| {
        let controller = BoatController { kind: BoatControllerKind::Tracking, speed };
        sail(sortie, &controller, conditions, settings, 0).expect_err("a mistake").field()
    };
    let (sortie, conditions, settings) = (scene.sortie(), scene.conditions, scene.settings);
    assert_eq!(told(&sortie, Some(-1.0), &conditions, &settings), "speed");
    assert_eq!(told(&sortie, None, &conditions, &SailSettings { accept: 0.0, ..settings }), "accept");
    let storm = BoatConditions { current: [f64::NAN, 0.0], ..conditions };
    assert_eq!(told(&sortie, None, &storm, &settings), "current");
    let planless = BoatSortie { profile: None, ..sortie };
    assert_eq!(told(&planless, None, &conditions, &settings), "controller");
    let nowhere = points(&[[f64::NAN, 0.0], [1.0, 1.0]]);
    assert_eq!(told(&BoatSortie { waypoints: &nowhere, ..sortie }, None, &conditions, &settings), "waypoints");
}
