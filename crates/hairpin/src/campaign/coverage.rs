//! What a test set exercised: cells of a grid over how the robot moved, and which of them were met.
//!
//! Flights: speed × turn × climb of every leg flown. Drives: slope × curvature × slip of every sample. Arms: joint ×
//! place in its range × speed × direction of every sample, reversals with the speed that they came from.

use std::collections::{BTreeMap, BTreeSet};

use nalgebra::{Point3, Vector3};
use serde::{Deserialize, Serialize};

use super::arm::ArmSetup;
use super::setup::Kind;
use super::{Run, Setup};
use crate::math::rotation::angle_between;
use crate::trajectory::{Flight, Track};

/// Joints of an arm.
const JOINTS: usize = 6;
/// Below this share of its fastest a joint stands.
const STANDS: f64 = 0.01;

/// One axis of the grid.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Axis {
    /// What is counted: `speed`.
    pub name: String,
    /// Its unit; empty where values are numbered.
    pub unit: String,
    /// Bounds of the cells, rising, one more than there are; what lies beyond belongs to the outermost.
    pub edges: Vec<f64>,
    /// Names of the cells, where these are no ranges.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub words: Vec<String>,
}

/// The grid of a robot's motion.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Grid {
    /// Its axes.
    pub axes: Vec<Axis>,
}

/// What all cases of a campaign met.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Coverage {
    /// The grid.
    pub grid: Grid,
    /// Cells of the grid.
    pub cells: usize,
    /// Cells that were met.
    pub hit: usize,
    /// How many cases met each of these, by number.
    pub cases: BTreeMap<usize, usize>,
}

impl Coverage {
    /// Whether its parts fit together, as those of a file that was edited may not.
    pub fn fits(&self) -> bool {
        let sound = |axis: &Axis| {
            let rising = axis.edges.windows(2).all(|pair| pair[0] < pair[1]);
            axis.edges.len() >= 2 && rising && (axis.words.is_empty() || axis.words.len() == axis.cells())
        };
        let axes = &self.grid.axes;
        let cells = axes.iter().try_fold(1_usize, |cells, axis| cells.checked_mul(axis.edges.len().saturating_sub(1)));
        axes.iter().all(sound)
            && cells == Some(self.cells)
            && self.hit == self.cases.len()
            && self.cases.keys().all(|cell| *cell < self.cells)
    }
}

impl Axis {
    fn even(name: &str, unit: &str, from: f64, to: f64, cells: usize) -> Self {
        let edges = (0..=cells).map(|i| from + (to - from) * i as f64 / cells as f64).collect();
        Self { name: name.into(), unit: unit.into(), edges, words: Vec::new() }
    }

    fn of(name: &str, unit: &str, edges: &[f64]) -> Self {
        Self { name: name.into(), unit: unit.into(), edges: edges.to_vec(), words: Vec::new() }
    }

    fn worded(name: &str, words: &[&str]) -> Self {
        let edges = (0..=words.len()).map(|i| i as f64).collect();
        Self { name: name.into(), unit: String::new(), edges, words: words.iter().map(|word| (*word).into()).collect() }
    }

    /// `1.2 … 2.4`, or the word of cell number `place`.
    pub fn in_words(&self, place: usize) -> String {
        match self.words.get(place) {
            Some(word) => word.clone(),
            None => format!("{} … {}", rounded(self.edges[place]), rounded(self.edges[place + 1])),
        }
    }

    /// Cells along it.
    pub fn cells(&self) -> usize {
        self.edges.len() - 1
    }

    /// The cell that `value` lies in.
    fn cell(&self, value: f64) -> usize {
        self.edges.partition_point(|edge| *edge <= value).saturating_sub(1).min(self.cells() - 1)
    }
}

impl Grid {
    /// The grid for the robot of `setup`, over what it can do.
    pub fn of(setup: &Setup) -> Self {
        let axes = match setup.kind() {
            Kind::Flight(setup) => {
                let limit = setup.scenario.generate.limits.max_speed_m_s.unwrap_or(f64::INFINITY);
                vec![
                    Axis::even("speed", "m/s", 0.0, limit.min(setup.robot.max_speed), 5),
                    Axis::even("turn", "°", 0.0, 180.0, 4),
                    Axis::of("climb", "°", &[-90.0, -45.0, -15.0, 15.0, 45.0, 90.0]),
                ]
            }
            Kind::Drive(setup) => {
                let most = setup.bounds().most;
                vec![
                    Axis::even("slope", "°", 0.0, setup.tilt().to_degrees().min(45.0), 5),
                    Axis::even("curvature", "1/m", -most, most, 5),
                    Axis::of("slip", "", &[0.0, 0.05, 0.1, 0.2, 0.4, 1.0]),
                ]
            }
            Kind::Arm(_) => vec![
                Axis::worded("joint", &["1", "2", "3", "4", "5", "6"]),
                Axis::even("place in range", "%", 0.0, 100.0, 8),
                Axis::even("speed", "% of limit", 0.0, 100.0, 4),
                Axis::worded("direction", &["rising", "falling", "reversing"]),
            ],
        };
        Self { axes }
    }

    /// Cells in all.
    pub fn cells(&self) -> usize {
        self.axes.iter().map(Axis::cells).product()
    }

    fn cell(&self, values: &[f64]) -> usize {
        self.axes.iter().zip(values).fold(0, |cell, (axis, value)| cell * axis.cells() + axis.cell(*value))
    }

    /// The cell number of each axis.
    pub fn places(&self, cell: usize) -> Vec<usize> {
        let mut rest = cell;
        let mut places: Vec<usize> = (self.axes.iter().rev())
            .map(|axis| {
                let place = rest % axis.cells();
                rest /= axis.cells();
                place
            })
            .collect();
        places.reverse();
        places
    }

    /// The cells that a run of a case over `waypoints` met; none where the executor failed.
    pub fn met(&self, setup: &Setup, waypoints: &[Point3<f64>], run: &Run) -> BTreeSet<usize> {
        let Ok(flight) = &run.outcome else { return BTreeSet::new() };
        let mut met = BTreeSet::new();
        let mut meet = |values: &[f64]| {
            met.insert(self.cell(values));
        };
        match setup.kind() {
            Kind::Flight(_) => of_flight(waypoints, flight, &mut meet),
            Kind::Drive(_) => of_drive(&flight.track, &mut meet),
            Kind::Arm(setup) => of_arm(&setup, &flight.track, &mut meet),
        }
        met
    }

    /// What all cases met, each case once a cell.
    pub fn coverage<'a>(self, cases: impl IntoIterator<Item = &'a BTreeSet<usize>>) -> Coverage {
        let mut by_cell = BTreeMap::new();
        for cell in cases.into_iter().flatten() {
            *by_cell.entry(*cell).or_insert(0) += 1;
        }
        Coverage { cells: self.cells(), hit: by_cell.len(), cases: by_cell, grid: self }
    }
}

/// Every leg that was flown: its mean speed, the turn from the leg before, and how steep it is.
fn of_flight(waypoints: &[Point3<f64>], flight: &Flight, meet: &mut dyn FnMut(&[f64])) {
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

/// Every sample: the tilt of the body, the curvature of its way, the slip of its wheels.
fn of_drive(track: &Track, meet: &mut dyn FnMut(&[f64])) {
    let column = |name| track.channel(name).unwrap_or_default();
    let (curvature, slip) = (column("curvature_1_m"), column("slip"));
    for (i, pose) in track.poses().iter().enumerate() {
        let up = (pose.rotation * Vector3::z()).z.clamp(-1.0, 1.0);
        let of = |values: &[f64]| values.get(i).copied().unwrap_or(0.0);
        meet(&[libm::acos(up).to_degrees(), of(curvature), of(slip).abs()]);
    }
}

/// Every sample of every joint that moves, and where it turns back the fastest that it was on the way there.
fn of_arm(setup: &ArmSetup, track: &Track, meet: &mut dyn FnMut(&[f64])) {
    let times = track.times();
    for joint in 0..JOINTS {
        let Some(angles) = track.channel(&format!("q{}_rad", joint + 1)) else { continue };
        let limit = &setup.station.arm.limits[joint];
        let place = |angle: f64| 100.0 * (angle - limit.lower) / (limit.upper - limit.lower);
        // The direction of the stroke, +1 or −1, and the largest share of the joint's fastest in it.
        let (mut direction, mut fastest) = (0.0, 0.0_f64);
        for i in 1..times.len().min(angles.len()) {
            let rate = (angles[i] - angles[i - 1]) / (times[i] - times[i - 1]);
            let speed = rate.abs() / limit.speed;
            if speed < STANDS {
                continue;
            }
            let (at, joint) = (place(angles[i]), joint as f64 + 0.5);
            if direction * rate < 0.0 {
                meet(&[joint, at, 100.0 * fastest, 2.5]);
                fastest = 0.0;
            }
            (direction, fastest) = (rate.signum(), fastest.max(speed));
            meet(&[joint, at, 100.0 * speed, if rate > 0.0 { 0.5 } else { 1.5 }]);
        }
    }
}

/// To three decimals, without zeros behind.
fn rounded(edge: f64) -> f64 {
    (1e3 * edge).round() / 1e3
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_are_numbered_as_their_places_are() {
        let grid = Grid {
            axes: vec![
                Axis::even("speed", "m/s", 0.0, 10.0, 5),
                Axis::of("climb", "°", &[-90.0, 0.0, 90.0]),
                Axis::worded("direction", &["rising", "falling", "reversing"]),
            ],
        };
        assert_eq!(grid.cells(), 30);
        let all: BTreeSet<Vec<usize>> = (0..30).map(|cell| grid.places(cell)).collect();
        assert_eq!(all.len(), 30);
        let cell = grid.cell(&[3.9, 12.0, 2.5]);
        assert_eq!(grid.places(cell), [1, 1, 2]);
        // What lies on an edge belongs to the cell above, what lies beyond to the outermost.
        assert_eq!(grid.places(grid.cell(&[2.0, -90.0, 0.0])), [1, 0, 0]);
        assert_eq!(grid.places(grid.cell(&[99.0, 99.0, -3.0])), [4, 1, 0]);
        let sets = [BTreeSet::from([1, 2]), BTreeSet::from([2])];
        let coverage = grid.coverage(&sets);
        assert_eq!((coverage.hit, coverage.cells, coverage.cases[&2], coverage.cases[&1]), (2, 30, 2, 1));
    }
}
