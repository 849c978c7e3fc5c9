//! Campaigns by `published` and by `hull` with other states at the waypoints (`estimate`), leg by leg against ends that
//! are integrated here.

use crate::campaigns::{asked, distance_to_hull, of, run, scenario};
use hairpin::campaign::flight::FlightSetup;
use hairpin::campaign::generate::Known;
use hairpin::campaign::{Case, Evidence, Setup};
use nalgebra::{UnitQuaternion, Vector3};
use serde_json::{Value, json};

/// Farther outside than this the hull does not hold a displacement, m: what two integrators may differ by.
const OUTSIDE: f64 = 0.02;

/// Where a run of constant rotor speeds ends.
#[derive(Clone, Copy)]
struct End {
    place: Vector3<f64>,
    attitude: UnitQuaternion<f64>,
    rates: Vector3<f64>,
}

/// Total thrust over mass and the moments over inertia of every combination of `resolution` speeds per rotor.
fn inputs(setup: &Setup, resolution: u32) -> Vec<(f64, Vector3<f64>)> {
    let robot = &setup.own::<FlightSetup>().expect("a flight").robot;
    let (low, high) = robot.rotor_speed;
    let speed = |level: u32| low + (high - low) * f64::from(level) / f64::from(resolution - 1);
    let one = |number: u32| {
        let (mut thrust, mut moments) = (0.0, Vector3::zeros());
        for (i, rotor) in (0..).zip(&robot.rotors) {
            let square = speed(number / resolution.pow(i) % resolution).powi(2);
            let lift = robot.thrust_coefficient * square;
            thrust += lift;
            moments += Vector3::new(lift * rotor.y, -lift * rotor.x, robot.moment_coefficient * square * rotor.spin);
        }
        (thrust / robot.mass, moments.component_div(&robot.inertia))
    };
    (0..resolution.pow(4)).map(one).collect()
}

/// The rigid body without drag for 1 s from rest at the origin: a rotation vector and a midpoint rule a step.
fn fly(setup: &Setup, (pull, turn): (f64, Vector3<f64>), start: &End) -> End {
    const STEPS: i32 = 1000;
    let h = 1.0 / f64::from(STEPS);
    let robot = &setup.own::<FlightSetup>().expect("a flight").robot;
    let inertia = robot.inertia;
    let turning = |w: &Vector3<f64>| turn - w.cross(&inertia.component_mul(w)).component_div(&inertia);
    let (mut end, mut velocity) = (*start, Vector3::zeros());
    for _ in 0..STEPS {
        let middle = end.rates + turning(&end.rates) * (0.5 * h);
        let halfway = end.attitude * UnitQuaternion::from_scaled_axis(middle * (0.5 * h));
        let acceleration = halfway * Vector3::z() * pull - Vector3::z() * robot.gravity;
        end.place += (velocity + acceleration * (0.5 * h)) * h;
        velocity += acceleration * h;
        end.attitude *= UnitQuaternion::from_scaled_axis(middle * h);
        end.rates += turning(&middle) * h;
    }
    end
}

/// One Euler step of 1 s of the Euler angles from level rest, each quantity from those already stepped: no angle but
/// those that one second of the rates makes.
fn leap(setup: &Setup, (pull, turn): (f64, Vector3<f64>)) -> Vector3<f64> {
    let [roll, pitch, yaw] = [turn.x, turn.y, turn.z];
    let up = UnitQuaternion::from_euler_angles(roll, pitch, yaw) * Vector3::z();
    up * pull - Vector3::z() * setup.own::<FlightSetup>().expect("a flight").robot.gravity
}

const LEVEL: [i32; 6] = [0; 6];

/// Ends of all runs from the middle of a cell: 0.1 rad of attitude, 1 rad/s of rates.
fn ends(setup: &Setup, cell: &[i32; 6]) -> Vec<End> {
    let middle = |first: usize, edge: f64| Vector3::from_fn(|i, _| f64::from(cell[first + i]) * edge);
    let attitude = UnitQuaternion::from_scaled_axis(middle(0, 0.1));
    let start = End { place: Vector3::zeros(), attitude, rates: middle(3, 1.0) };
    inputs(setup, 2).into_iter().map(|input| fly(setup, input, &start)).collect()
}

fn places(ends: &[End]) -> Vec<Vector3<f64>> {
    ends.iter().map(|end| end.place).collect()
}

/// Cells of what the runs that end nearest to `d` carry on: several where some end at one place.
fn carried(ends: &[End], d: &Vector3<f64>, attitude: bool, rates: bool) -> Vec<[i32; 6]> {
    let least = ends.iter().map(|end| (end.place - d).norm()).fold(f64::INFINITY, f64::min);
    let cell = |end: &End| {
        let (turned, spun) = (end.attitude.scaled_axis() / 0.1, end.rates);
        std::array::from_fn(|i| match i {
            0..3 if attitude => turned[i].round() as i32,
            3.. if rates => spun[i - 3].round() as i32,
            _ => 0,
        })
    };
    ends.iter().filter(|end| (end.place - d).norm() < least + 1e-3).map(cell).collect()
}

/// What the velocity at each waypoint leaves to thrust and gravity, m.
fn displacements(case: &Case, average: bool) -> Vec<Vector3<f64>> {
    let legs: Vec<_> = case.waypoints.windows(2).map(|w| w[1] - w[0]).collect();
    let before = |k: usize| if average && k > 0 { legs[k - 1] } else { Vector3::zeros() };
    (0..legs.len()).map(|k| legs[k] - before(k)).collect()
}

/// A campaign of a robot that is slow to turn and hovers amid its speeds: its runs end among the waypoints, and plain
/// steps follow them.
fn campaign(reach: &str, estimate: Value) -> (Setup, Vec<Case>) {
    let mut generate = asked(reach, "beam", 3);
    generate["resolution"] = json!(2);
    generate["estimate"] = estimate;
    generate["search"]["waypoints"] = json!(1000);
    let mut scenario = scenario("flightgoggles", 5, generate);
    scenario["world"] = json!({ "size_m": [8, 8, 12], "keep_in_margin_m": 1.0 });
    scenario["task"]["end_m"] = json!([4.5, 4, 4]);
    scenario["robot"]["inertia_kg_m2"] = json!([0.15, 0.16, 0.2]);
    scenario["robot"]["rotor_speed_rad_s"] = json!([700, 1700]);
    let setup = of(scenario);
    let (cases, tally) = run(&setup, &Known::default());
    assert_eq!(cases.len(), 3, "{reach}: {tally:?}");
    assert!(cases.iter().all(|case| case.evidence == Evidence::HullFeasible), "{reach}");
    (setup, cases)
}

#[test]
fn published_legs_lie_in_the_hull_of_single_leaps() {
    let (setup, cases) = campaign("published", json!({}));
    let leaps: Vec<_> = inputs(&setup, 2).into_iter().map(|input| leap(&setup, input)).collect();
    let flown = places(&ends(&setup, &LEVEL));
    let mut beyond = 0;
    for case in &cases {
        for d in displacements(case, true) {
            let off = distance_to_hull(&leaps, &d);
            assert!(off < OUTSIDE, "case {}: {off} m outside", case.number);
            beyond += usize::from(distance_to_hull(&flown, &d) > OUTSIDE);
        }
    }
    assert!(beyond > 0, "every leg would do for `hull` too: too few to tell the two apart");
}

#[test]
fn at_rest_each_leg_alone_lies_in_the_hull() {
    let (setup, cases) = campaign("hull", json!({ "velocity": "zero" }));
    let flown = places(&ends(&setup, &LEVEL));
    for case in &cases {
        for d in displacements(case, false) {
            let off = distance_to_hull(&flown, &d);
            assert!(off < OUTSIDE, "case {}: {off} m outside", case.number);
        }
    }
    let moving = cases.iter().flat_map(|case| displacements(case, true));
    assert!(moving.map(|d| distance_to_hull(&flown, &d)).any(|off| off > OUTSIDE), "too few to tell");
}

#[test]
fn a_kept_state_is_that_of_the_nearest_run() {
    for (attitude, rates) in [(true, false), (false, true), (true, true)] {
        let word = |keep: bool, other: &str| if keep { "keep".to_owned() } else { other.to_owned() };
        let estimate = json!({ "attitude": word(attitude, "level"), "rates": word(rates, "zero") });
        let what = format!("{estimate}");
        let (setup, cases) = campaign("hull", estimate);
        let level = places(&ends(&setup, &LEVEL));
        let mut beyond = 0;
        for case in &cases {
            let mut cells = vec![LEVEL];
            for (leg, d) in displacements(case, true).iter().enumerate() {
                let held = |cell: &[i32; 6]| {
                    let ends = ends(&setup, cell);
                    (distance_to_hull(&places(&ends), d) < OUTSIDE).then(|| carried(&ends, d, attitude, rates))
                };
                cells = cells.iter().filter_map(held).flatten().collect();
                cells.sort_unstable();
                cells.dedup();
                assert!(!cells.is_empty(), "{what}, case {}: leg {leg} is outside", case.number);
                beyond += usize::from(distance_to_hull(&level, d) > OUTSIDE);
            }
        }
        assert!(beyond > 0, "{what}: every leg would do from level rest too, too few to tell");
    }
}
