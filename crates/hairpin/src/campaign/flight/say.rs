//! What is said of flights and their cage, and what they are measured against.

use std::collections::BTreeMap;

use nalgebra::{Point3, Vector3};
use serde_json::json;

use super::figure::figure;
use super::{FlightSetup, assumptions, homeward};
use crate::campaign::bounds::FARTHEST_M;
use crate::campaign::kind::{
    Assumptions, Axis, BEYOND, Drawing, Facts, FrameWords, Handed, Motion, Returning, RobotWords, Room, Rotor, Say,
    reached_within, surface,
};
use crate::campaign::{Case, Tally};
use crate::judgement::{Clearance, Swiftness};
use crate::math::rotation::angle_between;
use crate::robot::battery::{Battery, BatteryDescription};
use crate::robot::quadrotor::{Quadrotor, QuadrotorDescription, QuadrotorKind, RotorDescription};
use crate::simulation::{Acceptance, Controlled, ControllerKind};
use crate::trajectory::Flight;

/// No flight is carried by a faster wind, m/s.
const WIND_M_S: f64 = 50.0;

impl Say for FlightSetup {
    fn robot_words(&self) -> RobotWords<'_> {
        let Quadrotor { name, caveat, estimated, .. } = &*self.robot;
        let estimated = estimated.iter().map(String::as_str).collect();
        RobotWords {
            name,
            caveat,
            estimated,
            has_sides: true,
            unknown_shapes: assumptions::reaches_through(self).map(|[radius, margin]| {
                format!("the body may reach through the world's edges: clearance_radius_m {radius} > keep_in_margin_m {margin}").into()
            }),
            loops: Quadrotor::LOOPS,
            battery: self.battery(),
        }
    }

    fn assumptions(&self, cases: &[Case], _: &Tally) -> Assumptions {
        let mut said = Assumptions { beside: assumptions::searched_beside(self), ..Assumptions::default() };
        assumptions::claim(self, cases, &mut said.claim);
        assumptions::act(self, &mut said.act);
        said.verdict.push(reached(self));
        assumptions::verdict(self, &mut said.verdict);
        said
    }

    fn facts(&self) -> Facts {
        let (size, task) = (self.world.size(), &self.scenario.task);
        let point = |p: [f64; 3]| format!("({}, {}, {})", p[0], p[1], p[2]);
        Facts {
            world: format!("{} × {} × {} m, {} obstacles", size.x, size.y, size.z, self.scenario.world.obstacles.len()),
            task: format!("{} waypoints from {} to {} m", task.length, point(task.start_m), point(task.end_m)),
            search: None,
            proven: "reach set",
            nothing: format!("no chain of {} waypoints from start to end", task.length),
        }
    }

    /// A robot that flies has all its numbers, derived ones too.
    fn handed(&self) -> Handed {
        Handed {
            robot: json!(description(&self.robot, self.described().and_then(|robot| robot.battery))),
            world: json!(self.scenario.world),
            external_force: None,
            limits: json!(self.scenario.generate.limits),
            frame: FrameWords {
                relative_to: "cage origin",
                world: "cage",
                axes: "x and y along its edges",
                nowhere: None,
            },
            start: Point3::from(self.scenario.task.start_m),
            farthest: FARTHEST_M,
        }
    }

    fn is_outside(&self, place: &Point3<f64>) -> bool {
        self.world.wall_distance(place) < 0.0
    }

    fn edge_distance(&self, place: &Point3<f64>, _: f64) -> f64 {
        self.world.wall_distance(place)
    }

    fn drawing(&self, _: &[Point3<f64>]) -> Drawing {
        Drawing {
            low: Point3::origin(),
            size: self.world.size(),
            obstacles: self.world.obstacles().iter().map(surface).collect(),
            rotors: self.robot.rotors.iter().map(|r| Rotor { x: r.x, y: r.y, clockwise: r.spin > 0.0 }).collect(),
            wheels: Vec::new(),
            radius: self.robot.clearance_radius,
            relief: None,
            figure: Some(figure(&self.robot)),
            done: "flown",
        }
    }

    /// Speed × turn × climb of every leg flown.
    fn motion(&self) -> Motion<'_> {
        let limit = self.scenario.generate.limits.max_speed_m_s.unwrap_or(f64::INFINITY);
        Motion {
            axes: vec![
                Axis::even("speed", "m/s", 0.0, limit.min(self.robot.max_speed), 5),
                Axis::even("turn", "°", 0.0, 180.0, 4),
                Axis::of("climb", "°", &[-90.0, -45.0, -15.0, 15.0, 45.0, 90.0]),
            ],
            meet: Box::new(legs_met),
        }
    }

    fn room(&self) -> Option<Room> {
        let execute = &self.scenario.execute;
        let speed = match execute.controller_in_force().filter(|_| self.controller.is_none()) {
            Some(ControllerKind::FixedVelocity) => Some(execute.fixed_velocity_m_s),
            kind => kind.and_then(ControllerKind::cruise),
        };
        // Controllers keep to the robot's limit.
        let speed = speed.map(|speed| speed.min(self.robot.max_speed));
        let timed = !matches!(execute.controller_in_force(), Some(kind) if kind != ControllerKind::Geometric);
        Some(Room {
            flies: true,
            low: Point3::origin(),
            high: Point3::from(self.world.size()),
            margin: self.world.keep_in_margin(),
            curvature: f64::INFINITY,
            speed,
            fastest: self.scenario.generate.limits.max_speed_m_s.unwrap_or(f64::INFINITY).min(self.robot.max_speed),
            timed: self.controller.is_some() || timed,
            // What hovers by rotors alone: ground stations have one class for it.
            vehicles: &[0, 2, 3, 4, 13, 14, 15, 29, 35],
        })
    }

    fn homeward(&self, returning: &Returning) -> Option<Result<f64, &'static str>> {
        Some(homeward::height(&self.world, self.robot.clearance_radius, returning))
    }

    fn clearance(&self) -> Option<Box<Clearance<'_>>> {
        let (world, radius) = (&self.world, self.robot.clearance_radius);
        (!world.obstacles().is_empty())
            .then(|| Box::new(move |p: &Point3<f64>| world.obstacle_distance(p) - radius) as Box<Clearance<'_>>)
    }

    /// Top speed v, and ‖dv/dt‖ ≤ T/m + g + (c₁ v + c₂ v²)/m: full thrust, weight and drag, all one way.
    fn swiftness(&self) -> Swiftness {
        let robot = &*self.robot;
        let speed = Some(robot.max_speed).filter(|speed| speed.is_finite());
        let drag = speed.map_or(0.0, |v| robot.drag_linear * v + robot.drag_quadratic * v * v);
        Swiftness { speed, acceleration: Some((robot.max_thrust() + drag) / robot.mass + robot.gravity) }
    }

    /// The least of 10 v + w and v + w + 10 · ½ a h: by its top speed v, and by what it may gain in the time h from any
    /// speed that it has, in wind w.
    fn ceiling(&self, span: f64) -> Option<f64> {
        let Swiftness { speed, acceleration } = self.swiftness();
        let gained = acceleration.map_or(f64::INFINITY, |a| 0.5 * BEYOND * a * span);
        Some(WIND_M_S + (BEYOND * speed?).min(speed? + gained))
    }
}

/// Every leg that was flown: its mean speed, the turn from the leg before, and how steep it is.
///
/// Speed is the leg's length over the time between both arrivals; turn in 0 … 180°, 0 for the first leg; climb in −90 …
/// 90°. Legs of which an arrival is missing are left out.
///
/// Angles in °, speeds in m/s.
fn legs_met(waypoints: &[Point3<f64>], flight: &Flight, meet: &mut dyn FnMut(&[f64])) {
    let mut before = Vector3::zeros();
    for (leg, pair) in waypoints.windows(2).enumerate() {
        let way = pair[1] - pair[0];
        let times = flight.reached.get(leg).copied().flatten().zip(flight.reached.get(leg + 1).copied().flatten());
        if let Some((from, to)) = times.filter(|(from, to)| to > from) {
            let turn = if leg == 0 { 0.0 } else { angle_between(&before, &way).to_degrees() };
            let climb = libm::atan2(way.z, libm::hypot(way.x, way.y)).to_degrees();
            meet(&[way.norm() / (to - from), turn, climb]);
        }
        before = way;
    }
}

impl FlightSetup {
    /// As its file has it.
    fn described(&self) -> Option<&QuadrotorDescription> {
        self.scenario.robot.resolved().ok()
    }

    fn battery(&self) -> Option<Battery> {
        self.described()?.battery().ok()?
    }
}

/// All numbers of a robot.
///
/// As its file would have them with nothing left out, so that an executor derives nothing.
///
/// Keys that were derived are written as if they had been given; `estimated` is empty in it.
fn description(robot: &Quadrotor, battery: Option<BatteryDescription>) -> QuadrotorDescription {
    let rotor =
        |rotor: &crate::robot::quadrotor::Rotor| RotorDescription { x_m: rotor.x, y_m: rotor.y, spin: rotor.spin };
    QuadrotorDescription {
        kind: QuadrotorKind::Quadrotor,
        name: robot.name.clone(),
        source: String::new(),
        caveat: robot.caveat.clone(),
        mass_kg: robot.mass,
        rotors: robot.rotors.iter().map(rotor).collect(),
        inertia_kg_m2: Some(robot.inertia.into()),
        thrust_coefficient_n_s2: Some(robot.thrust_coefficient),
        moment_coefficient_n_m_s2: Some(robot.moment_coefficient),
        rotor_speed_rad_s: Some([robot.rotor_speed.0, robot.rotor_speed.1]),
        thrust_to_weight: None,
        rotor_time_constant_s: Some(robot.rotor_time_constant),
        drag_linear_n_s_m: Some(robot.drag_linear),
        drag_quadratic_n_s2_m2: Some(robot.drag_quadratic),
        aerodynamic_moment_n_m_s2: Some(robot.aerodynamic_moment),
        force_noise_n2_s: Some(robot.force_noise),
        moment_noise_n2_m2_s: Some(robot.moment_noise),
        max_speed_m_s: Some(robot.max_speed),
        clearance_radius_m: Some(robot.clearance_radius),
        gravity_m_s2: Some(robot.gravity),
        battery,
        estimated: BTreeMap::new(),
    }
}

/// Where a waypoint counts as reached: what a program of the user's does with the radius is its own business.
fn reached(setup: &FlightSetup) -> String {
    let execute = &setup.scenario.execute;
    let ours = if setup.controller.is_some() { None } else { execute.controller_in_force() };
    match ours.map(ControllerKind::acceptance) {
        Some(Acceptance::Cylinder { height }) => {
            format!("A waypoint counts as reached within {} m from above and {height} m in height.", execute.accept_m)
        }
        _ => reached_within(execute.accept_m, execute.command.is_some() && setup.controller.is_none()),
    }
}
