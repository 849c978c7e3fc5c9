//! What is said of drives and their ground, and what they are measured against.

use nalgebra::{Point3, Vector3};
use serde_json::json;

use super::{DriveSetup, assumptions, backwards, drawing};
use crate::campaign::bounds::FARTHEST_M;
use crate::campaign::kind::{
    Assumptions, Axis, BEYOND, Drawing, Facts, Footing, FrameWords, Handed, Motion, RobotWords, Room, Say,
    reached_within, word,
};
use crate::campaign::scenario::DriveLimits;
use crate::campaign::{Case, Tally};
use crate::judgement::{Clearance, Swiftness};
use crate::robot::rover::Rover;
use crate::simulation::Controlled;
use crate::trajectory::Track;
use crate::world::terrain::{ElevationMap, Terrain};

/// What of slopes is not modelled of what stands level wherever it is, and which of the `limits` that are given nothing
/// would ever break.
fn slopes_left_out(limits: &DriveLimits) -> String {
    let given = [
        ("generate.limits.tilt_deg", limits.tilt_deg),
        ("generate.limits.belly_clearance_m", limits.belly_clearance_m),
    ];
    let given: Vec<&str> = given.into_iter().filter_map(|(key, value)| value.map(|_| key)).collect();
    let limits = if given.is_empty() { String::new() } else { format!(", nor {} held", given.join(" and ")) };
    format!("slopes of the map are not modelled{limits}: no suspension")
}

impl Say for DriveSetup {
    fn robot_words(&self) -> RobotWords<'_> {
        let rover = &self.rover;
        RobotWords {
            name: &rover.name,
            caveat: &rover.caveat,
            estimated: rover.estimated.clone(),
            has_sides: true,
            unknown_shapes: self.leaves_slopes_out.then(|| slopes_left_out(&self.scenario.generate.limits).into()),
            loops: Rover::LOOPS,
            battery: None,
        }
    }

    fn assumptions(&self, _: &[Case], _: &Tally) -> Assumptions {
        let mut said = Assumptions { beside: assumptions::searched_beside(self), ..Assumptions::default() };
        assumptions::claim(self, &mut said.claim);
        assumptions::act(self, &mut said.act);
        said.verdict.push(reached_within(self.scenario.execute.accept_m, self.scenario.execute.command.is_some()));
        assumptions::verdict(self, &mut said.verdict);
        said
    }

    fn facts(&self) -> Facts {
        let (low, high) = self.map.extent();
        let cell = self.map.grid().cell;
        let (terrain, task) = (&self.scenario.world.terrain, &self.scenario.task);
        let name = terrain.file.clone().or_else(|| terrain.generator.map(|name| format!("generator {}", word(&name))));
        let ([shortest, longest], start) = (task.leg_m, &task.start);
        let end = task.end_m.map_or("anywhere".into(), |[x, y]| format!("({x}, {y}) m"));
        let ends = if task.end_m.is_none() { "from the start" } else { "from start to end" };
        Facts {
            world: format!(
                "{}: {:.1} × {:.1} m in cells of {:.3} m, {} keep-outs",
                name.unwrap_or_default(),
                high[0] - low[0],
                high[1] - low[1],
                cell[0],
                self.keep_out.list().len()
            ),
            task: format!(
                "{} waypoints from ({}, {}) m to {end}, legs of {shortest} … {longest} m",
                task.length, start.x_m, start.y_m
            ),
            search: None,
            proven: "reach set",
            nothing: format!("no chain of {} waypoints {ends}", task.length),
        }
    }

    /// A robot that drives has its file's numbers, and its map is the campaign folder's.
    fn handed(&self) -> Handed {
        let start = &self.scenario.task.start;
        let height = self.map.patch(start.x_m, start.y_m).map_or(0.0, |patch| patch.height);
        Handed {
            robot: json!(self.scenario.robot),
            world: json!(self.scenario.world),
            external_force: self.scenario.execute.external_force_n,
            limits: json!(self.scenario.generate.limits),
            frame: FrameWords { relative_to: "map origin", world: "map", axes: "x east, y north", nowhere: None },
            start: Point3::new(start.x_m, start.y_m, height),
            farthest: farthest(&self.map),
        }
    }

    fn backwards(&self, case: &Case, track: &Track) -> Option<String> {
        backwards::backwards(self, case, track)
    }

    fn is_outside(&self, place: &Point3<f64>) -> bool {
        self.map.patch(place.x, place.y).is_err()
    }

    fn edge_distance(&self, place: &Point3<f64>, within: f64) -> f64 {
        self.map.edge_distance([place.x, place.y], within)
    }

    fn drawing(&self, places: &[Point3<f64>]) -> Drawing {
        drawing::ground(self, places)
    }

    /// Slope × curvature × slip of every sample.
    fn motion(&self) -> Motion<'_> {
        let most = self.bounds().most;
        Motion {
            axes: vec![
                Axis::even("slope", "°", 0.0, self.tilt().to_degrees().min(45.0), 5),
                Axis::even("curvature", "1/m", -most, most, 5),
                Axis::of("slip", "", &[0.0, 0.05, 0.1, 0.2, 0.4, 1.0]),
            ],
            meet: Box::new(|_, flight, meet| samples_met(&flight.track, meet)),
        }
    }

    fn room(&self) -> Option<Room> {
        let (low, high) = self.map.extent();
        Some(Room {
            flies: false,
            low: Point3::new(low[0], low[1], f64::NEG_INFINITY),
            high: Point3::new(high[0], high[1], f64::INFINITY),
            margin: 0.0,
            curvature: if self.rover.limits.turns_in_place { f64::INFINITY } else { self.bounds().most },
            speed: None,
            fastest: self.most_speed(),
            timed: true,
            vehicles: &[0, 10],
        })
    }

    fn clearance(&self) -> Option<Box<Clearance<'_>>> {
        let (places, radius) = (&self.keep_out, self.radius());
        (!self.scenario.world.keep_out.is_empty())
            .then(|| Box::new(move |p: &Point3<f64>| places.distance(p.x, p.y) - radius) as Box<Clearance<'_>>)
    }

    fn footing(&self) -> Option<&dyn Footing> {
        Some(self)
    }

    /// The vehicle's own limit of speed. How suddenly bumps turn its velocity nothing bounds.
    fn swiftness(&self) -> Swiftness {
        Swiftness { speed: Some(self.rover.limits.speed).filter(|speed| speed.is_finite()), acceleration: None }
    }

    fn most_tilt(&self) -> Option<f64> {
        Some(self.rover.limits.tilt).filter(|tilt| tilt.is_finite())
    }

    /// Ten times its limit of speed, as it may roll down a slope: the scenario's or its file's, and where neither
    /// says one the speed that plans command.
    fn ceiling(&self, _span: f64) -> Option<f64> {
        let most = self.most_speed();
        Some(BEYOND * if most.is_finite() { most } else { self.speed() })
    }
}

/// Every sample: the tilt of the body, the curvature of its way, the slip of its wheels.
///
/// °, 1/m, and |slip| as a share; a channel that a track has not counts as 0.
///
/// Tilt is acos of the vertical part of the body's z axis, 0 … 180°.
fn samples_met(track: &Track, meet: &mut dyn FnMut(&[f64])) {
    let column = |name| track.channel(name).unwrap_or_default();
    let (curvature, slip) = (column("curvature_1_m"), column("slip"));
    for (i, pose) in track.poses().iter().enumerate() {
        let up = (pose.rotation * Vector3::z()).z.clamp(-1.0, 1.0);
        let of = |values: &[f64]| values.get(i).copied().unwrap_or(0.0);
        meet(&[libm::acos(up).to_degrees(), of(curvature), of(slip).abs()]);
    }
}

/// How far from a map's origin a place may be, m: maps of the Earth have coordinates of thousands of kilometres.
///
/// With E the largest |coordinate| of the map's extent: the usual bound while E is within it, else E and the usual
/// bound more.
fn farthest(map: &ElevationMap) -> f64 {
    let (low, high) = map.extent();
    let edge = low.iter().chain(&high).fold(0.0_f64, |most, x| most.max(x.abs()));
    if edge <= FARTHEST_M { FARTHEST_M } else { edge + FARTHEST_M }
}
