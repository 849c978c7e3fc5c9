//! Legs of boats against the robot's own equations, dense samples, and what a roadmap promises.

use nalgebra::{Point3, Vector3};
use rand::RngExt;
use wide::f64x4;

use super::proof::motion;
use super::*;
use crate::feasibility::reach::Reach;
use crate::feasibility::reach::mend::{MendedWaypoint, OldLeg, mend};
use crate::feasibility::steering::LegTiming;
use crate::math::interval::Enclosure;
use crate::math::polynomial::derivatives;
use crate::math::random::{Stream, stream};
use crate::robot::boat::{Boat, cybership};
use crate::trajectory::ProfileLeg;
use crate::world::terrain::{KeepOut, KeepOutShape, KeepOuts};

const CURRENT: [f64; 2] = [0.06, -0.04];

fn waters() -> BoatWaters {
    let circle = |name: &str, center_m, radius_m| KeepOut {
        name: name.into(),
        shape: KeepOutShape::Circle { center_m, radius_m },
    };
    let pier = KeepOutShape::Polygon { points_m: vec![[12.0, 0.0], [13.0, 0.0], [13.0, 4.0], [12.0, 4.0]] };
    let list = vec![circle("buoy", [8.0, 8.0], 0.5), KeepOut { name: "pier".into(), shape: pier }];
    let keep_outs = KeepOuts::new(list).expect("places");
    BoatWaters { size: [24.0, 16.0], keep_in: 1.0, keep_outs, current: CURRENT }
}

fn judge(boat: &Boat) -> BoatJudge {
    BoatJudge::new(boat, &waters(), BoatLimits::default())
}

fn random_leg(judge: &BoatJudge, random: &mut Stream) -> ProfileLeg {
    let mut end = || {
        let place = Point3::new(random.random_range(1.0..23.0), random.random_range(1.0..15.0), 0.0);
        let (speed, course): (f64, f64) = (random.random_range(0.0..0.45), random.random_range(-3.2..3.2));
        judge.end(&place, [speed * course.cos(), speed * course.sin()])
    };
    let (from, to) = (end(), end());
    let way = libm::hypot(to.place[0] - from.place[0], to.place[1] - from.place[1]);
    BoatJudge::connect(&from, &to, way / random.random_range(0.1..0.4))
}

/// u, v, r through the water at τ.
fn through_water(leg: &ProfileLeg, tau: f64) -> Vector3<f64> {
    let (at, v) = (leg.derivative(tau, 0), leg.derivative(tau, 1));
    let (sin, cos) = at.z.sin_cos();
    let (x, y) = (v.x - CURRENT[0], v.y - CURRENT[1]);
    Vector3::new(cos * x + sin * y, cos * y - sin * x, v.z)
}

#[test]
fn forces_are_those_that_make_the_robot_move_so() {
    let boat = cybership();
    let (judge, map) = (judge(&boat), ForceMap::new(&boat, CURRENT));
    let mut random = stream(5);
    for seed in 0..300 {
        let leg = random_leg(&judge, &mut random);
        let tau = leg.duration * random.random_range(0.01..0.99);
        let demand = map.demand(&motion(|axis, order| leg.derivative(tau, order)[axis]));
        let found = boat.acceleration(&through_water(&leg, tau), &Vector3::from(demand.forces));
        let h = 1e-4;
        let numeric = (through_water(&leg, tau + h) - through_water(&leg, tau - h)) / (2.0 * h);
        assert!((found - numeric).norm() < 1e-6, "leg {seed}: {found} {numeric}");
    }
}

#[test]
fn enclosures_hold_every_moment_and_shrink_with_the_square() {
    let boat = cybership();
    let (judge, map) = (judge(&boat), ForceMap::new(&boat, CURRENT));
    let mut random = stream(6);
    let (mut wide, mut narrow) = (0.0, 0.0);
    for seed in 0..300 {
        let leg = random_leg(&judge, &mut random);
        for (level, share) in [0.05, 0.005].into_iter().enumerate() {
            let half = share * leg.duration;
            let centre = random.random_range(half..leg.duration - half);
            let d = leg.coefficients.map(|c| derivatives(&c, f64x4::splat(centre)));
            let of = |axis: usize, order: usize| Enclosure::taylor(&d[axis][order..], f64x4::splat(half));
            let bound = map.demand(&motion(of));
            let sum = if level == 0 { &mut wide } else { &mut narrow };
            *sum += bound.forces.iter().map(|force| force.rest.to_array()[0]).sum::<f64>();
            for k in 0..=40 {
                let tau = centre + half * (f64::from(k) / 20.0 - 1.0);
                let demand = map.demand(&motion(|axis, order| leg.derivative(tau, order)[axis]));
                let pairs = bound.forces.iter().zip(demand.forces).chain([(&bound.speed, demand.speed)]);
                for (bound, value) in pairs {
                    let (low, high) = (bound.lower().to_array()[0], bound.upper().to_array()[0]);
                    assert!((low - 1e-9..=high + 1e-9).contains(&value), "leg {seed}: {value} in [{low}, {high}]");
                }
            }
        }
    }
    assert!(narrow < wide / 60.0, "{wide} {narrow}");
}

#[test]
fn accepted_legs_keep_every_limit_and_violations_are_real() {
    let boat = cybership();
    let (judge, map, waters) = (judge(&boat), ForceMap::new(&boat, CURRENT), waters());
    let (mut accepted, mut violated, mut unproven) = (0, 0, 0);
    let mut random = stream(7);
    for seed in 0..6000 {
        let leg = random_leg(&judge, &mut random);
        let margins = |tau: f64| {
            let demand = map.demand(&motion(|axis, order| leg.derivative(tau, order)[axis]));
            let bounds = boat.thrust.bounds();
            let force = |i: usize| (demand.forces[i] - bounds[i][0]).min(bounds[i][1] - demand.forces[i]);
            let p = leg.position(tau);
            let wall = (p.x - 1.0).min(23.0 - p.x).min(p.y - 1.0).min(15.0 - p.y);
            [force(0), force(1), force(2), wall, waters.keep_outs.distance(p.x, p.y) - boat.radius]
        };
        match judge.prove(&leg) {
            Ok(()) => {
                accepted += 1;
                for k in 0..=500 {
                    let tau = leg.duration * f64::from(k) / 500.0;
                    let found = margins(tau);
                    assert!(found.iter().all(|margin| *margin > -2e-9), "leg {seed} at {tau}: {found:?}");
                }
            }
            Err(BoatInfeasible::Violates { at, margin, .. }) => {
                violated += 1;
                assert!(margin < 0.0 && margins(at).iter().any(|margin| *margin < 1e-9), "leg {seed} at {at}");
            }
            Err(BoatInfeasible::Unproven { .. }) => unproven += 1,
        }
    }
    assert!(accepted > 100 && violated > 1000 && unproven < 3, "{accepted} {violated} {unproven}");
}

#[test]
fn at_waypoints_a_force_ahead_is_all_it_takes() {
    let boat = cybership();
    let (judge, map) = (judge(&boat), ForceMap::new(&boat, CURRENT));
    let from = judge.end(&Point3::new(3.0, 3.0, 0.0), [0.0; 2]);
    let to = judge.end(&Point3::new(6.0, 6.0, 0.0), [0.2, 0.1]);
    assert!(from.heading.is_none());
    let leg = BoatJudge::connect(&from, &to, 20.0);
    let [surge, sway, yaw] = map.demand(&motion(|axis, order| leg.derivative(20.0, order)[axis])).forces;
    assert!(surge > 0.05 && sway.abs() < 1e-9 && yaw.abs() < 1e-9, "{surge} {sway} {yaw}");
    // From rest it points where it goes.
    assert!((leg.coefficients[2][0] - std::f64::consts::FRAC_PI_4).abs() < 1e-12);
    assert!(matches!(
        judge.judge(&from, &to, f64::NAN),
        Err(BoatInfeasible::Violates { limit: BoatLimit::Duration, .. })
    ));
    let told = judge.judge(&from, &to, 9.0).expect_err("too fast for its thrusters").to_string();
    assert!(told.contains("violated by"), "{told}");
}

/// A boat does not turn in no time: at rest between two legs it has the heading that both of them know.
#[test]
fn both_legs_of_a_waypoint_share_its_heading() {
    let (boat, timing) = (cybership(), LegTiming::ladder(10.0, 80.0));
    let at_rest = |x, y| MendedWaypoint { place: Point3::new(x, y, 0.0), velocity: Vector3::zeros(), kept: true };
    let waypoints = [at_rest(15.0, 4.0), at_rest(20.0, 4.0), at_rest(20.0, 12.0)];
    let over = |judge: &BoatJudge| mend(judge, &timing, &waypoints, |_| OldLeg::None);
    let [before, after] = <[ProfileLeg; 2]>::try_from(over(&judge(&boat)).expect("two legs").legs).expect("two legs");
    let headings = [before.derivative(before.duration, 0).z, after.derivative(0.0, 0).z];
    let into_the_current = libm::atan2(-CURRENT[1], -CURRENT[0]);
    for heading in headings {
        let off = libm::remainder(heading - into_the_current, std::f64::consts::TAU);
        assert!(off.abs() < 1e-9, "{headings:?}, {into_the_current}");
    }
    // In still water nothing says which, so that it is passed in motion.
    let still = BoatJudge::new(&boat, &BoatWaters { current: [0.0; 2], ..waters() }, BoatLimits::default());
    assert!(over(&still).is_none() && still.between(&Point3::origin(), [1e-17, 0.0]).is_none());
    assert!(still.between(&Point3::origin(), [0.1, 0.0]).is_some_and(|end| end.heading == Some(0.0)));
}

#[test]
fn a_roadmap_keeps_what_it_promises() {
    let boat = cybership();
    let judge = judge(&boat);
    let mut random = stream(8);
    let free = |p: &Point3<f64>| waters().keep_outs.distance(p.x, p.y) > 1.0;
    let points: Vec<Point3<f64>> =
        std::iter::repeat_with(|| Point3::new(random.random_range(2.0..22.0), random.random_range(2.0..14.0), 0.0))
            .filter(free)
            .take(12)
            .collect();
    let timing = LegTiming::ladder(10.0, 80.0);
    let settings = BoatRoadmapSettings { velocities: 4, timing, seed: 3, current: CURRENT };
    let roadmap = BoatRoadmap::new(&judge, &points, &settings);
    let mut legs = Vec::new();
    roadmap.legs(&roadmap.start(), &points, &mut legs);
    assert!(legs.len() > 5 && legs.windows(2).all(|pair| pair[0].waypoint <= pair[1].waypoint), "{}", legs.len());
    let known = roadmap.candidates(&roadmap.start()).into_iter().filter(Result::is_ok).count();
    assert_eq!(known, legs.len());
    let mut arrived = 0;
    for leg in &legs {
        let mut onward = Vec::new();
        roadmap.legs(&leg.to, &points, &mut onward);
        let arrives = onward.iter().find(|next| next.waypoint as usize + 1 == points.len());
        assert_eq!(arrives.is_some(), roadmap.may_arrive(&leg.to, 1) && leg.waypoint as usize + 1 != points.len());
        let Some(next) = arrives else { continue };
        arrived += 1;
        let profile = roadmap.profile(&[roadmap.start(), leg.to, next.to]).expect("legs");
        assert!((profile.duration() - leg.duration - next.duration).abs() < 1e-12);
        assert!(profile.legs.iter().all(|leg| judge.prove(leg).is_ok()));
        // Continuous where they meet, the heading to whole turns.
        let (before, after) = (&profile.legs[0], &profile.legs[1]);
        for order in 0..4 {
            let mut gap = before.derivative(before.duration, order) - after.derivative(0.0, order);
            gap.z = libm::remainder(gap.z, std::f64::consts::TAU);
            assert!(gap.norm() < 1e-8, "order {order}: {gap}");
        }
        assert!((0.0..=1.0).contains(&leg.features.ground));
    }
    assert!(arrived > 0);
    let again = BoatRoadmap::new(&judge, &points, &settings).knowing(roadmap.into_legs());
    let mut same = Vec::new();
    again.legs(&again.start(), &points, &mut same);
    assert_eq!(legs, same);
}
