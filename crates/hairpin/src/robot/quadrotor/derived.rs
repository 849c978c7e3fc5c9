//! What a robot file leaves out, derived from what it has by stated physical models. All of it is marked `estimated`.
//!
//! A file of mass, layout, thrust to weight and top speed is enough to fly. What is filled in here decides details of a
//! flight, not whether it is one; how far each guess is from known robots stands beside it.

use nalgebra::Vector3;

use super::Rotor;
use crate::math::power::square;

/// Largest rotor speed where none is given, rad/s. Only kf·w² enters the motion, so that the choice shifts no result.
pub(super) const ROTOR_SPEED: f64 = 2000.0;

/// Rotor lag where none is given, s: between the 0.020 of the shipped FlightGoggles and the Crazyflie's 0.072.
pub(super) const ROTOR_TIME_CONSTANT: f64 = 0.03;

/// Share of the mass in each motor with its rotor; the rest is the body.
const MOTOR_SHARE: f64 = 0.1;

/// Air at sea level, kg/m³.
const AIR_DENSITY: f64 = 1.225;

/// Radius of rotors, m: 0.45 of the smallest distance between two, so that they do not touch.
pub(super) fn rotor_radius(rotors: &[Rotor; 4]) -> f64 {
    let mut smallest = f64::INFINITY;
    for (i, a) in rotors.iter().enumerate() {
        for b in &rotors[i + 1..] {
            smallest = smallest.min(libm::hypot(a.x - b.x, a.y - b.y));
        }
    }
    0.45 * smallest
}

/// Distance of the farthest rotor from the centre of mass, m.
pub(super) fn arm(rotors: &[Rotor; 4]) -> f64 {
    rotors.iter().map(|rotor| libm::hypot(rotor.x, rotor.y)).fold(0.0, f64::max)
}

/// Principal moments of inertia, kg·m²: four motors of a tenth of the mass each as points at the rotors, the rest a
/// uniform solid ball of half the arm's radius. Within a third of the figures that the shipped FlightGoggles and
/// Crazyflie have from their sources.
pub(super) fn inertia(mass: f64, rotors: &[Rotor; 4]) -> Vector3<f64> {
    let motor = MOTOR_SHARE * mass;
    let ball = 0.4 * (mass - 4.0 * motor) * square(0.5 * arm(rotors));
    let sum = |f: fn(&Rotor) -> f64| motor * rotors.iter().map(f).sum::<f64>() + ball;
    Vector3::new(sum(|r| r.y * r.y), sum(|r| r.x * r.x), sum(|r| r.x * r.x + r.y * r.y))
}

/// km = kf · 0.1 · rotor diameter, N·m/(rad/s)²: torque over thrust taken as a tenth of the diameter. A low guess: with
/// it yaw is weak; the shipped FlightGoggles and Crazyflie have 9 and 6 times as much from their sources.
pub(super) fn moment_coefficient(thrust_coefficient: f64, rotors: &[Rotor; 4]) -> f64 {
    thrust_coefficient * 0.2 * rotor_radius(rotors)
}

/// Quadratic drag, N·s²/m²: at top speed in level flight full thrust leaves √(thrust² − weight²) against the drag.
pub(super) fn drag_from_top_speed(thrust: f64, weight: f64, top_speed: f64) -> f64 {
    level_pull(thrust, weight) / (top_speed * top_speed)
}

/// Quadratic drag without a top speed to tell, N·s²/m²: ½ρ times the area of the four rotor discs.
pub(super) fn drag_from_discs(rotors: &[Rotor; 4]) -> f64 {
    0.5 * AIR_DENSITY * 4.0 * std::f64::consts::PI * square(rotor_radius(rotors))
}

/// The speed, m/s, at which drag c₁ v + c₂ v² equals what full thrust leaves in level flight; +∞ without drag.
pub(super) fn top_speed(thrust: f64, weight: f64, linear: f64, quadratic: f64) -> f64 {
    let pull = level_pull(thrust, weight);
    2.0 * pull / (linear + (linear * linear + 4.0 * quadratic * pull).sqrt())
}

/// Horizontal part of a full thrust whose vertical part carries the weight, N.
fn level_pull(thrust: f64, weight: f64) -> f64 {
    ((thrust - weight) * (thrust + weight)).max(0.0).sqrt()
}
