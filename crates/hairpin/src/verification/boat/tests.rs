//! Proofs of boats' witnesses: a sound one holds, and whatever is tampered with is found where it was done.

use super::*;
use crate::verification::{FlatPlace, Tolerances};

/// CyberShip II, with room in its thrusters.
fn hull() -> BoatHull {
    BoatHull {
        mass: [25.8, 33.8, 23.8 * 0.046, 2.76],
        surge: [-0.72253, -1.32742, -5.86643],
        sway_by_sway: [-0.88965, -36.47287, -0.805],
        sway_by_yaw: [-7.25, -0.845, -3.45],
        yaw_by_sway: [0.0313, 3.95645, 0.13],
        yaw_by_yaw: [-1.9, 0.08, -0.75],
        forces: [[-2.0, 2.0], [-1.5, 1.5], [-1.5, 1.5]],
        time_constant: 0.3,
        radius: 0.644,
    }
}

/// The polynomial of degree 7 from value and rate to value and rate, without second and third derivatives.
fn axis([p, v]: [f64; 2], [q, w]: [f64; 2], t: f64) -> [f64; 8] {
    let (e0, e1) = (q - p - v * t, (w - v) * t);
    let c = [35.0 * e0 - 15.0 * e1, -84.0 * e0 + 39.0 * e1, 70.0 * e0 - 34.0 * e1, -20.0 * e0 + 10.0 * e1];
    let over = |i: i32| c[i as usize] / t.powi(4 + i);
    [p, v, 0.0, 0.0, over(0), over(1), over(2), over(3)]
}

const CURRENT: [f64; 2] = [0.05, -0.03];
const WAYPOINTS: [[f64; 2]; 3] = [[3.0, 3.0], [9.0, 5.0], [8.0, 11.0]];

/// Through a corner at 0.15 m/s, and whole turns added to the second leg's heading.
fn legs() -> [BoatLeg; 2] {
    let passing = [0.12, 0.09];
    let heading = f64::atan2(passing[1] - CURRENT[1], passing[0] - CURRENT[0]);
    let turn = std::f64::consts::TAU;
    let first = [
        axis([3.0, 0.0], [9.0, passing[0]], 45.0),
        axis([3.0, 0.0], [5.0, passing[1]], 45.0),
        axis([0.3, 0.0], [heading, 0.0], 45.0),
    ];
    let second = [
        axis([9.0, passing[0]], [8.0, 0.0], 80.0),
        axis([5.0, passing[1]], [11.0, 0.0], 80.0),
        axis([heading + turn, 0.0], [1.7 + turn, 0.0], 80.0),
    ];
    [BoatLeg { duration: 45.0, coefficients: first }, BoatLeg { duration: 80.0, coefficients: second }]
}

fn claim<'a>(legs: &'a [BoatLeg], places: &'a [FlatPlace]) -> BoatClaim<'a> {
    BoatClaim {
        waypoints: &WAYPOINTS,
        legs,
        current: CURRENT,
        max_speed: 0.5,
        waters: ([1.0, 1.0], [14.0, 14.0]),
        places,
    }
}

fn tolerances() -> Tolerances {
    Tolerances { accuracy: 1e-8, ..Tolerances::default() }
}

fn fields(hull: &BoatHull, claim: &BoatClaim) -> Vec<String> {
    verify_boat(hull, claim, &tolerances()).findings.into_iter().map(|finding| finding.field).collect()
}

#[test]
fn a_sound_claim_is_proven_and_told_to_the_last_digit() {
    let (hull, legs) = (hull(), legs());
    let proof = verify_boat(&hull, &claim(&legs, &[]), &tolerances());
    assert!(proof.ok(), "{:?}", proof.findings);
    assert!(proof.position.value < 1e-7 && proof.path.value < 1e-7, "{proof:?}");
    let whole = proof.open_loop.expect("sailed");
    assert!(whole.position < 1e-5 && whole.velocity < 1e-6 && whole.attitude < 1e-6, "{whole:?}");
    // Thrusters that lag lose the way, and by how much is told.
    let lagging = boat_with_lag(&hull, &claim(&legs, &[])).expect("it lags");
    assert!((1e-3..0.5).contains(&lagging.position), "{lagging:?}");
    assert!(boat_with_lag(&BoatHull { time_constant: 0.0, ..hull }, &claim(&legs, &[])).is_none());
}

#[test]
fn a_coefficient_that_is_off_is_found() {
    let hull = hull();
    for axis in 0..3 {
        for i in [0, 1, 4, 5, 6, 7] {
            let mut legs = legs();
            if legs[0].coefficients[axis][i] == 0.0 {
                continue;
            }
            legs[0].coefficients[axis][i] *= 1.0 + 1e-6;
            let found = fields(&hull, &claim(&legs, &[]));
            assert!(
                found.iter().any(|field| field.starts_with("legs[0].") || field.starts_with("legs[1].start")),
                "axis {axis}, order {i}: {found:?}"
            );
        }
    }
}

#[test]
fn limits_are_held_to_the_last_digit() {
    let (mut hull, legs) = (hull(), legs());
    // The largest force to port that this claim demands, from samples.
    let claim = claim(&legs, &[]);
    let sampled = |k: usize| {
        let tau = 80.0 * k as f64 / 20_000.0;
        super::demand::demand(&hull, &claim, &legs[1].taylor(tau)).forces[1][0]
    };
    let most = (0..=20_000).map(sampled).fold(0.0, f64::max);
    assert!((0.05..1.5).contains(&most), "{most}");
    hull.forces[1][1] = most * (1.0 + 1e-6);
    assert_eq!(fields(&hull, &claim), Vec::<String>::new());
    hull.forces[1][1] = most * (1.0 - 1e-6);
    assert_eq!(fields(&hull, &claim), ["legs[1].sway"]);
    let slow = BoatClaim { max_speed: 0.2, ..claim };
    assert!(fields(&super::tests::hull(), &slow).iter().all(|field| field.ends_with(".speed")));
    let weak = BoatHull { forces: [[-0.01, 0.01], [-1.5, 1.5], [-1.5, 1.5]], ..super::tests::hull() };
    assert_eq!(fields(&weak, &claim), ["legs[0].surge", "legs[1].surge"]);
}

#[test]
fn waters_and_places_are_kept_to_the_millimetre() {
    let (hull, legs) = (hull(), legs());
    // Where the way comes nearest to a place beside it, from samples.
    let nearest = |p: [f64; 2]| {
        let away = |k: usize| {
            let [x, y, _] = legs[0].taylor(45.0 * k as f64 / 20_000.0);
            libm::hypot(x[0] - p[0], y[0] - p[1])
        };
        (0..=20_000).map(away).fold(f64::INFINITY, f64::min)
    };
    let centre = [6.0, 6.5];
    let room = nearest(centre) - hull.radius;
    assert!(room > 0.2, "{room}");
    let disc = |radius: f64| [FlatPlace::Disc(centre, radius)];
    assert_eq!(fields(&hull, &claim(&legs, &disc(room - 1e-3))), Vec::<String>::new());
    assert_eq!(fields(&hull, &claim(&legs, &disc(room + 1e-3))), ["legs[0].keep_out[0].clearance"]);
    // A square around the disc's middle whose corner points at the way, and one that holds a waypoint.
    let square = |[x, y]: [f64; 2], half: f64| {
        FlatPlace::Polygon(vec![[x - half, y - half], [x + half, y - half], [x + half, y + half], [x - half, y + half]])
    };
    assert_eq!(fields(&hull, &claim(&legs, &[square(centre, 0.2)])), Vec::<String>::new());
    let found = fields(&hull, &claim(&legs, &[square([9.0, 5.0], 2.0)]));
    assert_eq!(found, ["legs[0].keep_out[0].clearance", "legs[1].keep_out[0].clearance"]);
    let narrow = BoatClaim { waters: ([1.0, 1.0], [9.5, 14.0]), ..claim(&legs, &[]) };
    assert_eq!(fields(&hull, &narrow), ["legs[1].waters"]);
}

#[test]
fn what_is_no_claim_is_told_and_panics_nowhere() {
    let (hull, legs) = (hull(), legs());
    assert_eq!(fields(&hull, &claim(&legs[..1], &[])), ["legs"]);
    let mut broken = legs;
    broken[1].duration = -1.0;
    assert_eq!(fields(&hull, &claim(&broken, &[])), ["legs[1]"]);
    let massless = BoatHull { mass: [0.0; 4], ..hull };
    assert_eq!(fields(&massless, &claim(&legs, &[])), ["hull"]);
    let nowhere = BoatClaim { current: [f64::NAN, 0.0], ..claim(&legs, &[]) };
    assert_eq!(fields(&hull, &nowhere), ["hull"]);
    let void = [FlatPlace::Disc([f64::NAN, 0.0], 1.0)];
    assert_eq!(fields(&hull, &claim(&legs, &void)).len(), 2);
}
