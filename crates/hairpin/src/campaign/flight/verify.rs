//! Hands the written witnesses to the verification room, as plain numbers.

use crate::campaign::Case;
use crate::robot::quadrotor::Quadrotor;
use crate::verification::{self, Body, Claim, EndError, Leg, Proof, RotorPlace, Tolerances};

/// Integrates the witness of `case` through the robot's equations by independent code, to the default tolerances: the proof,
/// and the end error of the whole flight with rotor lag. `None` for a case that claims no witness.
pub(in crate::campaign) fn verify(robot: &Quadrotor, case: &Case) -> Option<(Proof, Option<EndError>)> {
    let profile = case.profile.as_ref()?;
    let body = body_of(robot);
    let waypoints: Vec<[f64; 3]> = case.waypoints.iter().map(|p| [p.x, p.y, p.z]).collect();
    let legs: Vec<Leg> =
        profile.legs.iter().map(|leg| Leg { duration: leg.duration, coefficients: leg.coefficients }).collect();
    let claim = Claim { waypoints: &waypoints, legs: &legs };
    let proof = verification::verify(&body, &claim, &Tolerances::default());
    Some((proof, verification::open_loop_with_lag(&body, &claim)))
}

fn body_of(robot: &Quadrotor) -> Body {
    Body {
        mass: robot.mass,
        inertia: robot.inertia.into(),
        rotors: robot.rotors.map(|rotor| RotorPlace { x: rotor.x, y: rotor.y, spin: rotor.spin }),
        thrust_coefficient: robot.thrust_coefficient,
        moment_coefficient: robot.moment_coefficient,
        rotor_speed: robot.rotor_speed,
        rotor_time_constant: robot.rotor_time_constant,
        drag_linear: robot.drag_linear,
        drag_quadratic: robot.drag_quadratic,
        aerodynamic_moment: robot.aerodynamic_moment,
        gravity: robot.gravity,
    }
}
