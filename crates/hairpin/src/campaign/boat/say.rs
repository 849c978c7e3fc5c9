//! What is said of boats and their waters, and what they are measured against.

use nalgebra::Point3;
use serde_json::json;

use super::{BoatSetup, assumptions, drawing};
use crate::campaign::bounds::LARGEST_WATERS_M;
use crate::campaign::kind::{
    Assumptions, Axis, BEYOND, Drawing, Facts, FrameWords, Handed, Motion, RobotWords, Room, Say,
};
use crate::campaign::{Case, Tally};
use crate::judgement::Clearance;
use crate::robot::boat::Boat;
use crate::simulation::Controlled;
use crate::trajectory::Track;

/// No boat is carried by a faster current, nor driven by wind at more than that, m/s.
const CARRIED_M_S: f64 = 10.0;

impl Say for BoatSetup {
    /// Ten times its top speed through the water, and what carries it.
    fn ceiling(&self, _span: f64) -> Option<f64> {
        Some(BEYOND * self.boat.top_speed + CARRIED_M_S)
    }

    fn robot_words(&self) -> RobotWords<'_> {
        let boat = &self.boat;
        let estimated = boat.estimated.iter().map(String::as_str).collect();
        let loops = Boat::LOOPS;
        RobotWords {
            name: &boat.name,
            caveat: &boat.caveat,
            estimated,
            has_sides: false,
            unknown_shapes: assumptions::reaches_over(self)
                .then_some("the hull may reach over the waters' edges".into()),
            loops,
            battery: None,
        }
    }

    fn assumptions(&self, _: &[Case], _: &Tally) -> Assumptions {
        let mut said = Assumptions::default();
        assumptions::claim(self, &mut said.claim);
        assumptions::act(self, &mut said.act);
        assumptions::verdict(self, &mut said.verdict);
        said
    }

    fn facts(&self) -> Facts {
        let (world, task) = (&self.scenario.world, &self.scenario.task);
        let ([x, y], [east, north]) = (world.size_m, world.current());
        let point = |[x, y]: [f64; 2]| format!("({x}, {y})");
        Facts {
            world: format!("{x} × {y} m, {} keep-outs, current ({east}, {north}) m/s", world.keep_out.len()),
            task: format!("{} waypoints from {} to {} m", task.length, point(task.start_m), point(task.end_m)),
            search: None,
            proven: "reach set",
            nothing: format!("no chain of {} waypoints from start to end", task.length),
        }
    }

    fn handed(&self) -> Handed {
        let [x, y] = self.scenario.task.start_m;
        Handed {
            robot: json!(self.scenario.robot),
            world: json!(self.scenario.world),
            external_force: self.scenario.execute.external_force_n.map(|[east, north]| [east, north, 0.0]),
            limits: json!(self.scenario.generate.limits),
            frame: FrameWords { relative_to: "map origin", world: "map", axes: "x east, y north", nowhere: None },
            start: Point3::new(x, y, 0.0),
            farthest: LARGEST_WATERS_M,
        }
    }

    fn is_outside(&self, place: &Point3<f64>) -> bool {
        !(0..2).all(|axis| (0.0..=self.scenario.world.size_m[axis]).contains(&place[axis]))
    }

    fn edge_distance(&self, place: &Point3<f64>, _: f64) -> f64 {
        let beyond = |axis: usize| place[axis].min(self.scenario.world.size_m[axis] - place[axis]);
        beyond(0).min(beyond(1))
    }

    fn drawing(&self, _: &[Point3<f64>]) -> Drawing {
        drawing::waters(self)
    }

    /// Speed × drift × rate of turn of every sample.
    fn motion(&self) -> Motion<'_> {
        Motion {
            axes: vec![
                Axis::even("speed", "m/s", 0.0, self.boat.top_speed, 5),
                Axis::of("drift", "°", &[0.0, 5.0, 15.0, 30.0, 60.0, 180.0]),
                Axis::of("rate of turn", "°/s", &[0.0, 1.0, 3.0, 6.0, 12.0, 90.0]),
            ],
            meet: Box::new(|_, flight, meet| samples_met(&flight.track, meet)),
        }
    }

    fn room(&self) -> Option<Room> {
        let world = &self.scenario.world;
        let [x, y] = world.size_m;
        Some(Room {
            flies: false,
            low: Point3::new(0.0, 0.0, f64::NEG_INFINITY),
            high: Point3::new(x, y, f64::INFINITY),
            margin: world.keep_in_margin_m,
            curvature: f64::INFINITY,
            speed: None,
            fastest: self.scenario.generate.limits.max_speed_m_s.unwrap_or(f64::INFINITY),
            timed: true,
            // Ground stations have one class for rovers and boats.
            vehicles: &[0, 10, 11],
        })
    }

    fn clearance(&self) -> Option<Box<Clearance<'_>>> {
        let (places, radius) = (&self.keep_out, self.boat.radius);
        (!places.is_empty())
            .then(|| Box::new(move |p: &Point3<f64>| places.distance(p.x, p.y) - radius) as Box<Clearance<'_>>)
    }
}

/// Every sample: speed over ground, the angle between bow and motion through the water, the rate of turn.
///
/// m/s, deg and deg/s. A channel that is missing counts as 0.
///
/// Drift is atan2(|sway|, surge) in 0 … 180°, of the motion through the water: 180° is straight astern.
fn samples_met(track: &Track, meet: &mut dyn FnMut(&[f64])) {
    let column = |name| track.channel(name).unwrap_or_default();
    let (vx, vy) = (column("vx_m_s"), column("vy_m_s"));
    let (ahead, aside, turn) = (column("surge_m_s"), column("sway_m_s"), column("r_rad_s"));
    for i in 0..track.len() {
        let of = |values: &[f64]| values.get(i).copied().unwrap_or(0.0);
        let drift = libm::atan2(of(aside).abs(), of(ahead)).to_degrees();
        meet(&[libm::hypot(of(vx), of(vy)), drift, of(turn).abs().to_degrees()]);
    }
}
