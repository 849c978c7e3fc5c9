//! Vehicles, grounds and plans, and what driving them comes to.

use hairpin::feasibility::steering::shooting::flat;
use hairpin::feasibility::steering::shooting::query::{Curvatures, Goal, Query};
use hairpin::feasibility::steering::shooting::solve::{Choices, Outcome, solve};
use hairpin::judgement::{Measures, Reference, Settings, measure};
use hairpin::robot::ground::CarDescription;
use hairpin::robot::rover::{Rover, RoverDescription};
use hairpin::simulation::ground::{
    DriveSettings, GroundConditions, GroundController, GroundSortie, drive, planned_track,
};
use hairpin::trajectory::drive::{Gear, Motion, Planar, Segment, SegmentList};
use hairpin::trajectory::{Direction, Drive, DriveLeg, Flight};
use hairpin::world::terrain::{ElevationMap, Grid, HoleRule, KeepOuts};
use nalgebra::Point3;

pub(crate) fn shipped(name: &str) -> Rover {
    let path = format!("{}/../../data/robots/rover/{name}.toml", env!("CARGO_MANIFEST_DIR"));
    let text = std::fs::read_to_string(path).expect("a shipped rover");
    toml::from_str::<RoverDescription>(&text).expect("its keys").build().expect("its numbers")
}

/// h = a x + b y on ±20 m.
pub(crate) fn plane(a: f64, b: f64) -> ElevationMap {
    let grid = Grid { columns: 81, rows: 81, first_center: [-20.0, -20.0], cell: [0.5, 0.5] };
    let heights: Vec<f32> = (0..81 * 81)
        .map(|i| {
            let (row, column) = (80 - i / 81, i % 81);
            (a * (-20.0 + 0.5 * column as f64) + b * (-20.0 + 0.5 * row as f64)) as f32
        })
        .collect();
    ElevationMap::new(grid, &heights, HoleRule::Error).expect("a map")
}

pub(crate) fn robot_file(name: &str) -> String {
    let path = format!("{}/../../data/robots/ground/{name}.toml", env!("CARGO_MANIFEST_DIR"));
    std::fs::read_to_string(path).expect("a shipped robot")
}

pub(crate) fn car() -> Rover {
    toml::from_str::<CarDescription>(&robot_file("car")).expect("its keys").build().expect("its numbers").vehicle()
}

/// One leg a list of segments, from the origin; the legs' ends are where flat geometry leads.
pub(crate) fn plan(legs: &[Vec<Segment>], speed: f64) -> Drive {
    let mut at = Planar { curvature: legs[0][0].curvature_at(0.0), ..Planar::default() };
    let legs = legs
        .iter()
        .map(|segments| {
            let from = at;
            for segment in segments {
                at = after(&at, segment);
            }
            DriveLeg { from, to: at, segments: segments.clone(), speed: speed.into(), direction: 0.0.into() }
        })
        .collect();
    Drive { legs, speed, turn_rate: 0.3 }
}

fn after(from: &Planar, segment: &Segment) -> Planar {
    let mut at = *from;
    match segment.motion {
        Motion::Turn { angle_rad } => at.yaw += angle_rad,
        Motion::Arc { length_m, .. } => {
            let n = 2000;
            let h = segment.gear.sign() * length_m / f64::from(n);
            for i in 0..n {
                let s = length_m * (f64::from(i) + 0.5) / f64::from(n);
                let yaw = at.yaw + 0.5 * h * segment.curvature_at(s);
                (at.x, at.y) = (at.x + h * yaw.cos(), at.y + h * yaw.sin());
                at.yaw += h * segment.curvature_at(s);
            }
            at.curvature = segment.curvature_at(length_m);
        }
    }
    at
}

/// An answer of the flat solver within |κ| ≤ 1, |κ'| ≤ 1.
pub(crate) fn flat_answer(from: &Planar, to: &Planar, gear: Gear, direction: Direction) -> Option<SegmentList> {
    flat_answer_within(Curvatures { most: 1.0, most_rate: 1.0 }, from, to, gear, direction)
}

pub(crate) fn flat_answer_within(
    bounds: Curvatures,
    from: &Planar,
    to: &Planar,
    gear: Gear,
    direction: Direction,
) -> Option<SegmentList> {
    assert_eq!(direction, Direction::default(), "the plans here go straight ahead");
    let (sin, cos) = from.yaw.sin_cos();
    let (dx, dy) = (to.x - from.x, to.y - from.y);
    let goal = Goal {
        x: cos * dx + sin * dy,
        y: cos * dy - sin * dx,
        yaw: to.yaw - from.yaw,
        curvature: to.curvature.clamp(-bounds.most, bounds.most),
    };
    let query = Query::new(from.curvature.clamp(-bounds.most, bounds.most), goal, &bounds).ok()?;
    let choices = Choices { gear, flat: flat::Settings::default(), ..Choices::default() };
    let solution = solve(&query, &bounds, &choices, || false);
    (solution.outcome == Outcome::Solved).then_some(solution.segments)
}

pub(crate) const CONTROLLERS: [(&str, GroundController<'static>); 3] = [
    ("pure-pursuit", GroundController::PurePursuit),
    ("stanley", GroundController::Stanley),
    ("predictive", GroundController::Predictive(&flat_answer)),
];

pub(crate) struct Site {
    pub(crate) vehicle: Rover,
    pub(crate) nominal: Rover,
    pub(crate) map: ElevationMap,
    pub(crate) conditions: GroundConditions,
}

impl Site {
    pub(crate) fn new(rover: &str, map: ElevationMap) -> Self {
        let rover = shipped(rover);
        Self { vehicle: rover.clone(), nominal: rover, map, conditions: GroundConditions::default() }
    }

    pub(crate) fn run(&self, plan: &Drive, controller: &GroundController, seed: u64) -> (Flight, Measures) {
        let none = KeepOuts::new(vec![]).expect("none");
        let sortie = GroundSortie {
            vehicle: &self.vehicle,
            nominal: &self.nominal,
            terrain: &self.map,
            keep_outs: &none,
            clearance_radius: 0.0,
            drive: plan,
        };
        let flight = drive(&sortie, controller, &self.conditions, &DriveSettings::default(), seed).expect("a drive");
        let path = planned_track(&self.nominal, &self.map, plan).expect("a plan");
        let last = path.channel("leg").expect("legs").to_vec();
        // Waypoints: where each leg of the plan begins, and where the last ends.
        let mut waypoints: Vec<Point3<f64>> = vec![];
        for (i, leg) in last.iter().enumerate() {
            if *leg as usize == waypoints.len() {
                waypoints.push(path.position(i.saturating_sub(1)));
            }
        }
        waypoints.push(path.position(path.len() - 1));
        let settings = Settings { reference: Reference::Path(&path), ..Settings::default() };
        let measures = measure(&flight.track, &waypoints, &settings).expect("measures");
        (flight, measures)
    }
}
