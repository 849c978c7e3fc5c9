//! Honest claims are proven, every forgery is found, and equations and integrator agree with others.

use nalgebra::{Matrix3, SMatrix, SVector, Vector3};
use rand::RngExt;

use super::body::{State, level};
use super::demand::demand;
use super::gauss::Gauss;
use super::replay::Flyer;
use super::*;
use crate::math::random::stream;

/// FlightGoggles' numbers (drone.yaml of mit-aera/FlightGoggles): quadratic drag.
fn flightgoggles() -> Body {
    let place = |x, y, spin| RotorPlace { x, y, spin };
    Body {
        mass: 1.0,
        gravity: 9.81,
        inertia: [0.0049, 0.0049, 0.0069],
        rotors: [place(0.08, 0.08, 1.0), place(-0.08, 0.08, -1.0), place(-0.08, -0.08, 1.0), place(0.08, -0.08, -1.0)],
        thrust_coefficient: 1.91e-6,
        moment_coefficient: 2.6e-7,
        rotor_speed: (0.0, 2200.0),
        drag_linear: 0.0,
        drag_quadratic: 0.1,
        aerodynamic_moment: 0.003,
        rotor_time_constant: 0.02,
    }
}

/// A plus layout with both kinds of drag.
fn plus() -> Body {
    let place = |x, y, spin| RotorPlace { x, y, spin };
    Body {
        mass: 0.8,
        inertia: [2.32e-3, 2.6e-3, 4.0e-3],
        rotors: [place(0.2, 0.0, 1.0), place(0.0, 0.2, -1.0), place(-0.2, 0.0, 1.0), place(0.0, -0.2, -1.0)],
        drag_linear: 0.15,
        drag_quadratic: 0.02,
        ..flightgoggles()
    }
}

/// The 7th-order polynomial between two states with a = −D(v)/m and j = −(∂D/∂v) a/m, by solving its eight conditions.
fn join(body: &Body, from: ([f64; 3], Vector3<f64>), to: ([f64; 3], Vector3<f64>), duration: f64) -> Leg {
    let level = |v: &Vector3<f64>| {
        let speed = v.norm();
        let a = -v * (body.drag_linear + body.drag_quadratic * speed) / body.mass;
        let along = if speed > 0.0 { v * (v.dot(&a) / speed) } else { Vector3::zeros() };
        let j = -(a * (body.drag_linear + body.drag_quadratic * speed) + along * body.drag_quadratic) / body.mass;
        (a, j)
    };
    // In units of the duration, where the conditions are well scaled.
    let matrix = SMatrix::<f64, 8, 8>::from_fn(|row, column| {
        let (order, at_end) = (row % 4, row >= 4);
        let falling: f64 = (0..order).map(|k| column as f64 - k as f64).product();
        if at_end || column == order { falling } else { 0.0 }
    });
    let solver = matrix.lu();
    let ((a0, j0), (a1, j1)) = (level(&from.1), level(&to.1));
    let coefficients = std::array::from_fn(|axis| {
        let t = duration;
        let conditions = SVector::<f64, 8>::from([
            from.0[axis],
            from.1[axis] * t,
            a0[axis] * t * t,
            j0[axis] * t.powi(3),
            to.0[axis],
            to.1[axis] * t,
            a1[axis] * t * t,
            j1[axis] * t.powi(3),
        ]);
        let solution = solver.solve(&conditions).unwrap();
        std::array::from_fn(|i| solution[i] / t.powi(i as i32))
    });
    Leg { duration, coefficients }
}

type Flown = (Vec<[f64; 3]>, Vec<Leg>);

/// Waypoints and the legs through them, rest to rest.
fn flight(body: &Body, seed: u64, legs: usize) -> Flown {
    let mut random = stream(seed);
    let mut draw = |low: f64, high: f64| Vector3::from([(); 3].map(|_| random.random_range(low..high)));
    let mut waypoints = vec![[3.0, 3.0, 3.0]];
    let mut velocities = vec![Vector3::zeros()];
    let mut durations = Vec::new();
    for leg in 0..legs {
        let (step, velocity) = (draw(-3.0, 3.0), draw(-1.5, 1.5));
        let last: [f64; 3] = waypoints[leg];
        waypoints.push(std::array::from_fn(|axis| last[axis] + step[axis]));
        velocities.push(if leg + 1 == legs { Vector3::zeros() } else { velocity });
        durations.push(2.0 + draw(0.0, 1.0).x);
    }
    let legs = (0..legs)
        .map(|k| join(body, (waypoints[k], velocities[k]), (waypoints[k + 1], velocities[k + 1]), durations[k]))
        .collect();
    (waypoints, legs)
}

fn prove(body: &Body, (waypoints, legs): &Flown) -> Proof {
    verify(body, &Claim { waypoints, legs }, &Tolerances::default())
}

/// Drag turns round at once where a leg along a line, set out on backwards, stands still; no step of the integration
/// may straddle that.
#[test]
fn legs_that_turn_back_along_their_line_are_proven() {
    for body in [flightgoggles(), plus()] {
        for seed in 0..4 {
            let mut random = stream(seed);
            let way = Vector3::from([(); 3].map(|_| random.random_range(-1.0..1.0))).normalize();
            let [first, second] = [Vector3::repeat(3.0), Vector3::repeat(3.0) - way * 4.0];
            let points = [first, second, second + way, second + way * 3.0].map(|point| [point.x, point.y, point.z]);
            let speeds = [0.0, -1.0, 0.3, 0.0].map(|speed| way * speed);
            let durations = [4.0, 2.2, 4.0];
            let leg = |k: usize| join(&body, (points[k], speeds[k]), (points[k + 1], speeds[k + 1]), durations[k]);
            let proof = prove(&body, &(points.to_vec(), (0..3).map(leg).collect()));
            assert!(proof.ok(), "seed {seed}: {:?}", proof.findings);
            assert!(proof.position.value < 1e-8, "seed {seed}: {proof:?}");
        }
    }
}

#[test]
fn honest_flights_are_proven_far_inside_the_tolerances() {
    for body in [flightgoggles(), plus()] {
        for seed in 0..10 {
            let proof = prove(&body, &flight(&body, seed, 10));
            assert!(proof.ok(), "seed {seed}: {:?}", proof.findings);
            let errors = [proof.position, proof.velocity, proof.attitude, proof.rates, proof.path];
            assert!(errors.iter().all(|worst| worst.value < 1e-7), "seed {seed}: {proof:?}");
            let end = proof.open_loop.unwrap();
            assert!(end.position < 1e-3 && end.velocity < 1e-3 && end.attitude < 1e-3, "seed {seed}: {end:?}");
            assert!(proof.fastest_rotor.value < 2200.0 && proof.slowest_rotor.value > 0.0);
        }
    }
}

#[test]
fn any_coefficient_off_by_one_percent_is_found() {
    for (seed, body) in [(1, flightgoggles()), (2, plus())] {
        let honest = flight(&body, seed, 5);
        let mut forged = 0;
        for leg in 0..5 {
            for axis in 0..3 {
                for i in 0..8 {
                    for factor in [1.01, 0.99] {
                        let mut forgery = honest.clone();
                        let coefficient = &mut forgery.1[leg].coefficients[axis][i];
                        if coefficient.abs() < 1e-6 {
                            continue;
                        }
                        *coefficient *= factor;
                        forged += 1;
                        assert!(!prove(&body, &forgery).ok(), "seed {seed}, leg {leg}, axis {axis}, c{i} × {factor}");
                    }
                }
            }
        }
        assert!(forged > 200, "only {forged} coefficients to forge");
    }
}

#[test]
fn a_coefficient_of_a_millionth_is_found_as_well() {
    // An almost still axis: every coefficient is about 1e-6.
    let body = flightgoggles();
    for i in 4..8 {
        for duration in [0.8, 4.0] {
            let still = Vector3::zeros();
            let from = [3.0, 3.0, 3.0];
            let mut scale = 1.0;
            // Scale the displacement so that this coefficient is 1e-6.
            let unit = join(&body, (from, still), ([3.0, 4.0, 3.0], still), duration).coefficients[1][i].abs();
            scale /= unit / 1e-6;
            let to = [3.0, 3.0 + scale, 3.0];
            let mut leg = join(&body, (from, still), (to, still), duration);
            assert!((leg.coefficients[1][i].abs() - 1e-6).abs() < 1e-9);
            assert!(prove(&body, &(vec![from, to], vec![leg])).ok());
            leg.coefficients[1][i] *= 1.01;
            assert!(!prove(&body, &(vec![from, to], vec![leg])).ok(), "c{i} = 1e-6, T = {duration}");
        }
    }
}

#[test]
fn forged_times_waypoints_and_robots_are_found() {
    let body = flightgoggles();
    let honest = flight(&body, 3, 4);
    let forge = |change: &dyn Fn(&mut Flown)| {
        let mut forgery = honest.clone();
        change(&mut forgery);
        prove(&body, &forgery)
    };
    assert!(prove(&body, &honest).ok());
    assert!(!forge(&|f| f.1[2].duration *= 1.001).ok());
    assert!(!forge(&|f| f.0[3][1] += 1e-6).ok());
    assert!(!forge(&|f| f.1.swap(1, 2)).ok());
    let drop_leg = forge(&|f| f.1.truncate(3));
    assert_eq!(drop_leg.findings[0].field, "legs");
    assert_eq!(forge(&|f| f.1[1].coefficients[2][4] = f64::NAN).findings[0].field, "legs[1]");
    assert_eq!(forge(&|f| f.1[1].duration = -1.0).findings[0].field, "legs[1]");
    assert_eq!(forge(&|f| f.0[0][0] = f64::INFINITY).findings[0].field, "waypoints[0]");
    assert!(!forge(&|f| f.1[0].coefficients[0][7] = 1e300).ok());
    assert!(!forge(&|f| f.1.clear()).ok());
    // The drag that the flight was planned with is part of the claim.
    assert!(!prove(&Body { drag_quadratic: 0.099, ..body }, &honest).ok());
    let inline = body.rotors.map(|r| RotorPlace { y: 0.0, ..r });
    assert_eq!(prove(&Body { rotors: inline, ..body }, &honest).findings[0].field, "body");
}

#[test]
fn rotor_limits_are_held_to_the_last_part_in_ten_thousand() {
    let body = flightgoggles();
    let honest = flight(&body, 4, 6);
    let proof = prove(&body, &honest);
    let fastest = proof.fastest_rotor;
    let above = Body { rotor_speed: (0.0, fastest.value * 1.0001), ..body };
    assert!(prove(&above, &honest).ok());
    let below = prove(&Body { rotor_speed: (0.0, fastest.value * 0.9999), ..body }, &honest);
    assert_eq!(below.findings.len(), 1, "{:?}", below.findings);
    assert_eq!((below.findings[0].leg, below.findings[0].unit), (fastest.leg, "rad/s"));
    let idle = prove(&Body { rotor_speed: (proof.slowest_rotor.value * 1.0001, 2200.0), ..body }, &honest);
    assert!(idle.findings[0].field.ends_with(".min"), "{:?}", idle.findings);
    // A dive that would need rotors to pull, and one through free fall.
    let down = |drop: f64| {
        let (from, to) = ([3.0, 3.0, 20.0], [3.0, 3.0, 20.0 - drop]);
        let still = Vector3::zeros();
        prove(&body, &(vec![from, to], vec![join(&body, (from, still), (to, still), 1.0)]))
    };
    assert!(down(0.5).ok());
    assert!(!down(4.0).ok());
}

/// What `demand` gets from series, by central differences of rotation matrices.
#[test]
fn rotor_speeds_agree_with_differences_of_attitudes() {
    for (seed, body) in [(5, flightgoggles()), (6, plus())] {
        let (_, legs) = flight(&body, seed, 4);
        let mixer = body.mixer().unwrap();
        for leg in &legs {
            for share in [0.15, 0.4, 0.77] {
                let tau = share * leg.duration;
                let force = |t: f64| {
                    let p = leg.taylor(t);
                    let v = Vector3::from(p.map(|c| c[1]));
                    let a = Vector3::from(p.map(|c| 2.0 * c[2]));
                    (a + Vector3::z() * body.gravity) * body.mass
                        + v * (body.drag_linear + body.drag_quadratic * v.norm())
                };
                let attitude = |t: f64| {
                    // z-y-x Euler angles with yaw 0: R = R_y(θ) R_x(φ).
                    let z = force(t).normalize();
                    let (roll, pitch) = ((-z.y).asin(), z.x.atan2(z.z));
                    nalgebra::Rotation3::from_euler_angles(roll, pitch, 0.0).into_inner()
                };
                let h = 1e-4;
                let rates = |t: f64| {
                    let turning: Matrix3<f64> =
                        attitude(t).transpose() * (attitude(t + h) - attitude(t - h)) / (2.0 * h);
                    0.5 * Vector3::new(turning.m32 - turning.m23, turning.m13 - turning.m31, turning.m21 - turning.m12)
                };
                let omega = rates(tau);
                let slope = (rates(tau + h) - rates(tau - h)) / (2.0 * h);
                let inertia = Vector3::from(body.inertia);
                let moments = inertia.component_mul(&slope)
                    + omega.cross(&inertia.component_mul(&omega))
                    + omega * (body.aerodynamic_moment * omega.norm());
                let squares = demand(&body, &mixer, leg, tau).unwrap().squares;
                let thrusts = squares.map(|s| s * body.thrust_coefficient);
                let arm = |f: &dyn Fn(&RotorPlace) -> f64| {
                    body.rotors.iter().zip(thrusts).map(|(rotor, thrust)| f(rotor) * thrust).sum::<f64>()
                };
                let found = Vector3::new(
                    arm(&|r| r.y),
                    arm(&|r| -r.x),
                    arm(&|r| r.spin * body.moment_coefficient / body.thrust_coefficient),
                );
                assert!((found - moments).norm() < 2e-6, "seed {seed}: {found} {moments}");
                assert!((arm(&|_| 1.0) - force(tau).norm()).abs() < 1e-9);
            }
        }
    }
}

/// The same rotor speeds into a quaternion form of the equations and somebody else's Runge-Kutta.
#[test]
fn integrator_and_equations_agree_with_others() {
    use differential_equations::prelude::*;
    struct Quaternion<'a> {
        body: Body,
        leg: &'a Leg,
    }
    impl ODE<f64, [f64; 13]> for Quaternion<'_> {
        fn diff(&self, t: f64, y: &[f64; 13], dydt: &mut [f64; 13]) {
            let b = &self.body;
            let squares = demand(b, &b.mixer().unwrap(), self.leg, t).unwrap().squares;
            let thrusts = squares.map(|s| s * b.thrust_coefficient);
            let (w, x, y_, z) = (y[6], y[7], y[8], y[9]);
            let (p, q, r) = (y[10], y[11], y[12]);
            let total: f64 = thrusts.iter().sum();
            let up = [2.0 * (x * z + w * y_), 2.0 * (y_ * z - w * x), w * w - x * x - y_ * y_ + z * z];
            let speed = (y[3] * y[3] + y[4] * y[4] + y[5] * y[5]).sqrt();
            let rate = (p * p + q * q + r * r).sqrt();
            for i in 0..3 {
                let gravity = if i == 2 { b.gravity } else { 0.0 };
                dydt[i] = y[3 + i];
                dydt[3 + i] =
                    (up[i] * total - (b.drag_linear + b.drag_quadratic * speed) * y[3 + i]) / b.mass - gravity;
            }
            dydt[6] = 0.5 * (-x * p - y_ * q - z * r);
            dydt[7] = 0.5 * (w * p + y_ * r - z * q);
            dydt[8] = 0.5 * (w * q + z * p - x * r);
            dydt[9] = 0.5 * (w * r + x * q - y_ * p);
            let arm = |f: &dyn Fn(&RotorPlace) -> f64| -> f64 {
                b.rotors.iter().zip(thrusts).map(|(rotor, thrust)| f(rotor) * thrust).sum()
            };
            let [ix, iy, iz] = b.inertia;
            let ratio = b.moment_coefficient / b.thrust_coefficient;
            let aero = b.aerodynamic_moment * rate;
            dydt[10] = (arm(&|r| r.y) - (iz - iy) * q * r - aero * p) / ix;
            dydt[11] = (arm(&|r| -r.x) - (ix - iz) * p * r - aero * q) / iy;
            dydt[12] = (arm(&|r| r.spin * ratio) - (iy - ix) * p * q - aero * r) / iz;
        }
    }
    let body = flightgoggles();
    let (waypoints, legs) = flight(&body, 7, 2);
    let flyer = Flyer { body: &body, mixer: body.mixer().unwrap(), gauss: Gauss::new(), accuracy: 1e-10 };
    // Not from the claimed start: the path must be a general one.
    let mut start: State = level(waypoints[0], [0.4, -0.3, 0.2]);
    start[15] = 0.3;
    start[16] = -0.2;
    let ours = flyer.replay(&legs[0], &start, &start).unwrap().end;
    let mut y0 = [0.0; 13];
    y0[..6].copy_from_slice(&start[..6]);
    y0[6] = 1.0;
    y0[10..].copy_from_slice(&start[15..]);
    let equations = Quaternion { body, leg: &legs[0] };
    let solution = IVP::ode(&equations, 0.0, legs[0].duration, y0)
        .method(ExplicitRungeKutta::dop853().rtol(1e-12).atol(1e-12))
        .solve()
        .unwrap();
    let theirs = solution.y.last().unwrap();
    for i in 0..6 {
        assert!((ours[i] - theirs[i]).abs() < 1e-8, "component {i}: {} {}", ours[i], theirs[i]);
    }
    for i in 0..3 {
        assert!((ours[15 + i] - theirs[10 + i]).abs() < 1e-8);
    }
    assert!(ours[10].abs() < 0.999, "the attitude must have gone somewhere: {ours:?}");
}

#[test]
fn rotor_lag_moves_the_end_and_without_lag_it_does_not() {
    let body = flightgoggles();
    let (waypoints, legs) = flight(&body, 8, 2);
    let claim = Claim { waypoints: &waypoints, legs: &legs };
    let with = |lag: f64| open_loop_with_lag(&Body { rotor_time_constant: lag, ..body }, &claim).unwrap().position;
    let exact = verify(&body, &claim, &Tolerances::default()).open_loop.unwrap().position;
    assert!((with(0.0) - exact).abs() < 1e-6);
    let (small, large) = (with(1e-3), with(2e-3));
    assert!(small > 1e-6 && (1.5..2.7).contains(&(large / small)), "{small} {large}: first order in the lag");
    assert!(open_loop_with_lag(&body, &Claim { waypoints: &waypoints[1..], legs: &legs }).is_none());
}
