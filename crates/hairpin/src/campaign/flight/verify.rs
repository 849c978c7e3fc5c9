//! Hands the written witnesses to the verification room, as plain numbers.
//!
//! What the verification room gets are coefficients, places and numbers of the body: no type of the claim goes along
//! but by copy.

use std::f64::consts::FRAC_PI_2;

use crate::campaign::Case;
use crate::campaign::kind::{Made, PlannedRows, Task, verify_task, verify_times};
use crate::campaign::scenario::EnvironmentSection;
use crate::feasibility::Limits;
use crate::robot::quadrotor::Quadrotor;
use crate::trajectory::Profile;
use crate::verification::{
    self, Body, Claim, ClearClaim, ClearSolid, Collector, EndError, Finding, FlightLimits, Leg, Proof, RotorPlace,
    Tolerances, verify_clear, verify_clear_of_surface, verify_flight_limits, verify_flight_rows,
};

use super::FlightSetup;
use super::legs::limits as limits_of;
use crate::world::{Shape, Solid};

/// Integrates the witness of `case` through the robot's equations by independent code, to the default tolerances: the
/// proof, and the end error of the whole flight with rotor lag. `None` for a case that claims no witness.
///
/// The tolerances are 0.1 mm, 0.1 mm/s and 0.001° a leg; they are the room's own defaults.
///
/// Limits and world are those of the setup that is asked, not of the case: what was planned under wider ones fails.
///
/// What was searched for begins, ends and is as long as the task has it.
pub(super) fn verify(setup: &FlightSetup, case: &Case, made: Made) -> Option<(Proof, Option<EndError>)> {
    let profile = case.profile()?;
    let body = body_of(&setup.robot);
    let waypoints: Vec<[f64; 3]> = case.waypoints.iter().map(|p| [p.x, p.y, p.z]).collect();
    let legs = legs_of(profile);
    let claim = Claim { waypoints: &waypoints, legs: &legs };
    let mut proof = verification::verify(&body, &claim, &Tolerances::default());
    proof.findings.extend(verify_flight_limits(&body, &legs, &limits(setup)));
    proof.findings.extend(outside(setup, &legs));
    let longest = setup.scenario.generate.limits.max_flight_time_s.unwrap_or(f64::INFINITY);
    verify_times(case, profile, longest, &mut proof);
    if made == Made::Searched {
        let task = &setup.scenario.task;
        verify_task(&Task { start: &task.start_m, end: Some(&task.end_m), length: task.length }, case, &mut proof);
    }
    Some((proof, verification::open_loop_with_lag(&body, &claim)))
}

/// Largest speed and tilt that plans keep; at a right angle the tilt is no limit.
fn limits(setup: &FlightSetup) -> FlightLimits {
    let Limits { max_speed, max_tilt } = limits_of(setup);
    let tilt = if max_tilt < FRAC_PI_2 { max_tilt } else { f64::INFINITY };
    FlightLimits { speed: max_speed, tilt }
}

/// What `legs` come too near to in the world: obstacles, and its walls less their margin.
///
/// Hulls and meshes are held by their triangles. Walls are boxes that stand [`ASIDE`] behind the margin: along them a
/// distance of 0 would have no direction.
fn outside(setup: &FlightSetup, legs: &[Leg]) -> Vec<Finding> {
    let near = |solid: ClearSolid, clearance: f64, what: String| {
        let found = verify_clear(&ClearClaim { legs, solids: &[solid], clearance: clearance - TOUCH });
        found.into_iter().map(move |finding| Finding { field: what.clone(), ..finding })
    };
    let mut findings = Vec::new();
    for (number, obstacle) in setup.world.obstacles().iter().enumerate() {
        let (clearance, what) = (setup.robot.clearance_radius, format!("world.obstacles[{number}].clearance"));
        let solid = match &obstacle.shape {
            Shape::Sphere { center, radius } => ClearSolid::Ball((*center).into(), *radius),
            Shape::Box { center, half_extents } => ClearSolid::Box((*center).into(), (2.0 * half_extents).into()),
            Shape::Capsule { a, b, radius } => ClearSolid::Capsule((*a).into(), (*b).into(), *radius),
            Shape::Hull(solid) | Shape::Mesh(solid) => {
                findings.extend(verify_clear_of_surface(legs, &triangles_of(solid), clearance - TOUCH, &what));
                continue;
            }
        };
        findings.extend(near(solid, clearance, what));
    }
    let (size, margin) = (setup.world.size(), setup.world.keep_in_margin());
    let edge = 4.0 * size.max() + 1.0;
    for axis in 0..3 {
        for (end, face) in [("low", margin - ASIDE - 0.5 * edge), ("high", size[axis] - margin + ASIDE + 0.5 * edge)] {
            let mut centre = [0.5 * size.x, 0.5 * size.y, 0.5 * size.z];
            centre[axis] = face;
            let wall = ClearSolid::Box(centre, [edge; 3]);
            findings.extend(near(wall, ASIDE, format!("world.walls[{axis}].{end}.clearance")));
        }
    }
    findings
}

/// Corners of the triangles of a surface, m.
fn triangles_of(solid: &Solid) -> Vec<[[f64; 3]; 3]> {
    let vertices = solid.vertices();
    solid.triangles().iter().map(|corners| corners.map(|at| vertices[at as usize].into())).collect()
}

/// How far behind the margin the walls stand that are held, m, and what rounding may take, m.
const ASIDE: f64 = 1.0;
const TOUCH: f64 = 1e-6;

/// Holds the rows that are kept of the planned motion of `case` to its polynomials and the attitudes that they demand,
/// by independent code; nothing for a case that claims no witness.
pub(super) fn verify_planned(robot: &Quadrotor, case: &Case, kept: &PlannedRows) -> Vec<Finding> {
    let Some(profile) = case.profile() else { return Vec::new() };
    verify_flight_rows(&body_of(robot), &legs_of(profile), &kept.with_middles())
}

fn legs_of(profile: &Profile) -> Vec<Leg> {
    profile.legs.iter().map(|leg| Leg { duration: leg.duration, coefficients: leg.coefficients }).collect()
}

/// The seam between claim and proof: numbers alone. SI; rotor speeds in rad/s, spins ± 1.
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

/// A shape that a search places, along the cage's axes: centre, and radius or edges, m.
enum Sought {
    Ball([f64; 3], f64),
    Box([f64; 3], [f64; 3]),
}

impl Sought {
    fn solid(&self) -> ClearSolid {
        match *self {
            Self::Ball(centre, radius) => ClearSolid::Ball(centre, radius),
            Self::Box(centre, size) => ClearSolid::Box(centre, size),
        }
    }
}

/// What does not hold of the environment of `case`: the plan keeps the robot's radius from its obstacles, everywhere,
/// they are in the world, no more and no larger than was `asked` for, and wind and gust are no faster. Where nothing
/// was asked for, as with missions from elsewhere, any is as good as another. Nothing for a case without one.
///
/// A speed at its bound may exceed it by a share of 10⁻¹², which is rounding. Gusts last as long as was asked for: a
/// shorter one would be steeper.
///
/// Outside of the world by how much: max over axes of (½ edge − centre) and (centre + ½ edge − size), so that 0 is just
/// inside. Each finding has the name of the key, the value and its bound. Boxes lie along the cage's axes.
pub(super) fn verify_environment(setup: &FlightSetup, asked: Option<EnvironmentSection>, case: &Case) -> Vec<Finding> {
    let Some(environment) = &case.environment else { return Vec::new() };
    let mut findings = Vec::new();
    let solids: Vec<Sought> = environment
        .obstacles
        .iter()
        .filter_map(|obstacle| {
            let ball = obstacle.sphere.map(|ball| Sought::Ball(ball.center_m, ball.radius_m));
            ball.or(obstacle.cuboid.map(|cuboid| Sought::Box(cuboid.center_m, cuboid.size_m)))
        })
        .collect();
    let mut found = Collector::about(&mut findings, "environment");
    // What has no size is met by nothing.
    for (number, solid) in solids.iter().enumerate() {
        let (key, least) = match solid {
            Sought::Ball(_, radius) => ("radius_m", *radius),
            Sought::Box(_, size) => ("size_m", size.iter().copied().fold(f64::INFINITY, f64::min)),
        };
        found.unless(least > 0.0, format_args!("obstacles[{number}].{key}"), least, 0.0, "m");
    }
    // Shapes that are none of these, and what is for drives, are found by no search: that they are clear, or act, is
    // not known.
    let others = environment.obstacles.len() - solids.len() + environment.keep_out.len();
    found.above("obstacles", others as f64, 0.0, "");
    let force = environment.external_force_n.map_or(0.0, |force| force.iter().map(|part| part.abs()).sum());
    found.above("external_force_n", force, 0.0, "N");
    for (number, solid) in solids.iter().enumerate() {
        let (centre, half) = match solid {
            Sought::Ball(centre, radius) => (centre, [*radius; 3]),
            Sought::Box(centre, size) => (centre, size.map(|edge| 0.5 * edge)),
        };
        let size = setup.world.size();
        let outside = |i: usize| (half[i] - centre[i]).max(centre[i] + half[i] - size[i]);
        let outside = (0..3).map(outside).fold(f64::NEG_INFINITY, f64::max);
        found.above(format_args!("obstacles[{number}].outside"), outside, 0.0, "m");
    }
    let count = |asked: EnvironmentSection| asked.obstacles.map_or(0, |placed| placed.count);
    found.above("obstacles", solids.len() as f64, asked.map_or(f64::INFINITY, |asked| count(asked) as f64), "");
    if let Some(placed) = asked.and_then(|asked| asked.obstacles) {
        for (number, solid) in solids.iter().enumerate() {
            // A shape that was not asked for has no size at all.
            match solid {
                Sought::Ball(_, radius) => {
                    found.above(
                        format_args!("obstacles[{number}].radius_m"),
                        *radius,
                        placed.radius_m.unwrap_or_default(),
                        "m",
                    );
                }
                Sought::Box(_, size) => {
                    for (axis, (edge, most)) in size.iter().zip(placed.size_m.unwrap_or_default()).enumerate() {
                        found.above(format_args!("obstacles[{number}].size_m[{axis}]"), *edge, most, "m");
                    }
                }
            }
        }
    }
    let speed = |v: [f64; 3]| v.iter().map(|x| x * x).sum::<f64>().sqrt();
    // A vector at its bound may be rounded beyond it; what was not asked for among other things is not there.
    let most = |bound: fn(&EnvironmentSection) -> Option<f64>| {
        asked.map_or(f64::INFINITY, |asked| bound(&asked).unwrap_or_default() * (1.0 + 1e-12))
    };
    found.above("wind_m_s", environment.wind_m_s.map_or(0.0, speed), most(|asked| asked.wind_m_s), "m/s");
    if let Some(gust) = environment.discrete_gust {
        found.above("discrete_gust.velocity_m_s", speed(gust.velocity_m_s), most(|asked| asked.gust_m_s), "m/s");
        // None that began before the flight, nor a shorter one, which would be steeper.
        found.unless(gust.start_s >= 0.0, "discrete_gust.start_s", gust.start_s, 0.0, "s");
        let lasts = asked.map_or(gust.duration_s, |asked| asked.gust_s);
        let fine = gust.duration_s == lasts && lasts > 0.0;
        found.unless(fine, "discrete_gust.duration_s", gust.duration_s, lasts, "s");
    }
    let legs = match case.profile() {
        Some(profile) => legs_of(profile),
        None => straight(case),
    };
    findings.extend(verify_clear(&ClearClaim {
        legs: &legs,
        solids: &solids.iter().map(Sought::solid).collect::<Vec<_>>(),
        clearance: setup.robot.clearance_radius,
    }));
    findings
}

/// The straight legs of a case that claims no more than these; at 1 m/s where it has no times.
///
/// As polynomials of degree 1 in the time since the leg began.
///
/// Coefficients are of 1, τ, τ² … τ⁷ an axis, of which only the first two are not 0. Two waypoints at one place take
/// the least positive number of seconds, so that nothing is divided by 0.
fn straight(case: &Case) -> Vec<Leg> {
    let leg = |(number, pair): (usize, &[nalgebra::Point3<f64>])| {
        let way = pair[1] - pair[0];
        let duration = case.leg_times.get(number).copied().unwrap_or_else(|| way.norm().max(f64::MIN_POSITIVE));
        let mut coefficients = [[0.0; 8]; 3];
        for (axis, c) in coefficients.iter_mut().enumerate() {
            (c[0], c[1]) = (pair[0][axis], way[axis] / duration);
        }
        Leg { duration, coefficients }
    };
    case.waypoints.windows(2).enumerate().map(leg).collect()
}
