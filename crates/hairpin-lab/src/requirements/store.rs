//! The regression store: solved problems that are kept with the project, solved again and compared.

use std::fs;
use std::path::Path;

use hairpin::campaign::drive::{Site, replay_flat};
use hairpin::feasibility::steering::shooting::rough::{Settings, Status};
use hairpin::feasibility::steering::shooting::solve::{Choices, Outcome, solve};
use hairpin::feasibility::steering::shooting::{Goal, Query};
use hairpin::robot::rover::Rover;
use hairpin::trajectory::drive::{Gear, Motion, Planar, Segment, SegmentList};
use hairpin::world::terrain::ElevationMap;
use hairpin::world::terrain::generate::generate;
use hairpin_formats::atomic;
use hairpin_formats::steering::{Piece, Stored, parse_stored, stored_text};
use hairpin_jobs::Problem;

use super::subject::{CRATERS, RequirementsSettings, Subject, bounds, flat_queries, late, level};
use crate::drives::met;

/// A file of the store.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct File {
    name: &'static str,
    text: &'static str,
    /// Problems that are asked when it is made.
    asked: usize,
    vehicle: Vehicle,
    what: &'static str,
}

/// Who drives in a file, and on what.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Vehicle {
    Generic,
    LateGeneric,
    Rocky8,
    LateRocky8,
}

macro_rules! file {
    ($name:literal, $asked:literal, $vehicle:expr, $what:literal) => {
        File {
            name: concat!($name, ".csv"),
            text: include_str!(concat!("../../../../data/regression/", $name, ".csv")),
            asked: $asked,
            vehicle: $vehicle,
            what: $what,
        }
    };
}

/// On level ground, without dynamics and with.
pub(super) const FLAT: &[File] = &[
    file!(
        "flat",
        300,
        Vehicle::Generic,
        "generic on flat ground; two of three are ends of smooth curves, the rest lie anywhere"
    ),
    file!("flat-dynamics", 100, Vehicle::LateGeneric, "generic with latency and steering lag on flat ground"),
];
/// On rough ground without dynamics.
pub(super) const ROUGH: &[File] =
    &[file!("rough", 200, Vehicle::Rocky8, "rocky8 on the generator's craters, as `hairpin requirements` makes them")];
/// On rough ground with dynamics.
pub(super) const ROUGH_DYNAMICS: &[File] = &[file!(
    "rough-dynamics",
    100,
    Vehicle::LateRocky8,
    "rocky8 with latency, steering lag and slip on the same craters"
)];

/// Controls are the same within this: m, rad, and 1/m over the length.
const SAME: f64 = 1e-6;
/// Another drive may be longer by this factor.
const LONGER: f64 = 1.01;

/// How drives of today compare with stored ones.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Compared {
    same: usize,
    /// Another drive, solved and not longer.
    other: usize,
    worse: usize,
}

impl Compared {
    pub(super) fn good(&self) -> bool {
        self.worse == 0 && self.same + self.other > 0
    }

    pub(super) fn words(&self) -> String {
        let Self { same, other, worse } = self;
        format!(
            "of {} stored solutions {same} are the same, {other} others as good, {worse} worse",
            same + other + worse
        )
    }
}

impl Vehicle {
    fn rover(self, subject: &Subject) -> Rover {
        match self {
            Self::Generic => subject.generic.clone(),
            Self::LateGeneric => late(&subject.generic),
            Self::Rocky8 => subject.rocky8.clone(),
            Self::LateRocky8 => subject.late.clone(),
        }
    }
}

/// Solves the problems of `files` again. Rough ones are on the embedded ground, whatever map was given.
pub(super) fn compare(subject: &Subject, files: &[File]) -> Result<Compared, Problem> {
    let mut compared = Compared::default();
    for file in files {
        let rover = file.vehicle.rover(subject);
        let ground = ground(file.vehicle)?;
        for stored in parse_stored(file.text).map_err(|wrong| Problem::input(format!("{}: {wrong}", file.name)))? {
            match again(&rover, &ground, &stored) {
                Some(drive) if same(&drive, &stored.pieces) => compared.same += 1,
                Some(drive) if length(&drive) <= LONGER * stored.length_m() + SAME => compared.other += 1,
                _ => compared.worse += 1,
            }
        }
    }
    Ok(compared)
}

/// Solves the problems of the regression store again and writes their drives into `folder`; a sentence for each file.
///
/// # Errors
/// A folder that cannot be written.
pub fn write_regression(folder: &Path) -> Result<Vec<String>, Problem> {
    let subject = &Subject::new(&RequirementsSettings { queries: 0, terrain: None })?;
    fs::create_dir_all(folder).map_err(|error| Problem::input(format!("{}: {error}", folder.display())))?;
    let mut lines = Vec::new();
    for file in FLAT.iter().chain(ROUGH).chain(ROUGH_DYNAMICS) {
        let rover = file.vehicle.rover(subject);
        let ground = ground(file.vehicle)?;
        let problems = problems(subject, file, &rover)?;
        let drives: Vec<Stored> = problems
            .into_iter()
            .filter_map(|problem| Some(Stored { pieces: again(&rover, &ground, &problem)?, ..problem }))
            .collect();
        let comment = format!(
            "{}: {}.\n{} of {} problems, those whose drive the replay confirms; made by hairpin requirements rover --write-regression.",
            file.name,
            file.what,
            drives.len(),
            file.asked
        );
        atomic::write(&folder.join(file.name), stored_text(&comment, &drives).as_bytes())?;
        lines.push(format!("{}: {} of {} problems solved", file.name, drives.len(), file.asked));
    }
    Ok(lines)
}

/// What a file of the store asks.
fn problems(subject: &Subject, file: &File, rover: &Rover) -> Result<Vec<Stored>, Problem> {
    let problem = |start: &Planar, goal: &Planar, reversals| Stored {
        start: [start.x, start.y, start.yaw, start.curvature],
        goal: [goal.x, goal.y, goal.yaw, goal.curvature],
        reversals,
        pieces: Vec::new(),
    };
    Ok(match file.vehicle {
        Vehicle::Generic | Vehicle::LateGeneric => flat_queries(&bounds(rover), file.asked, 41)
            .into_iter()
            .map(|(Query { start_curvature, goal }, reversals)| {
                let start = Planar { curvature: start_curvature, ..Planar::default() };
                let goal = Planar { x: goal.x, y: goal.y, yaw: goal.yaw, curvature: goal.curvature };
                problem(&start, &goal, reversals && file.vehicle == Vehicle::Generic)
            })
            .collect(),
        Vehicle::Rocky8 | Vehicle::LateRocky8 => {
            subject.goals(rover, file.asked, 42)?.iter().map(|(start, goal)| problem(start, goal, false)).collect()
        }
    })
}

/// The ground of a file; none for drives in the plane without dynamics.
fn ground(vehicle: Vehicle) -> Result<Option<ElevationMap>, Problem> {
    match vehicle {
        Vehicle::Generic => Ok(None),
        Vehicle::LateGeneric => level().map(Some),
        Vehicle::Rocky8 | Vehicle::LateRocky8 => generate(&CRATERS).map(Some).map_err(Problem::input),
    }
}

/// The drive that solves a problem today, if its replay confirms it.
fn again(rover: &Rover, ground: &Option<ElevationMap>, problem: &Stored) -> Option<Vec<Piece>> {
    let [[sx, sy, syaw, k0], [x, y, yaw, kf]] = [problem.start, problem.goal];
    let (start, goal) = (Planar { x: sx, y: sy, yaw: syaw, curvature: k0 }, Planar { x, y, yaw, curvature: kf });
    let segments = match ground {
        None => {
            let query = Query { start_curvature: k0, goal: Goal { x, y, yaw, curvature: kf } };
            let choices = Choices { reversals: problem.reversals, ..Choices::default() };
            let solution = solve(&query, &bounds(rover), &choices, || false);
            let replay = replay_flat(&query, 0.0, &solution.segments);
            (solution.outcome == Outcome::Solved && met(replay.error, replay.error_curvature))
                .then_some(solution.segments)?
        }
        Some(map) => {
            let site = Site::straight(rover, map);
            let answer = site.drive(&start, &goal, &Settings::default());
            let replay = site.replay(&start, &goal, &answer.segments).ok()?;
            (answer.status == Status::Ok && met(replay.error, replay.error_curvature)).then_some(answer.segments)?
        }
    };
    Some(pieces(&segments))
}

fn pieces(segments: &SegmentList) -> Vec<Piece> {
    let piece = |segment: &Segment| match segment.motion {
        Motion::Arc { length_m, curvature } => {
            Piece::Arc { length_m, curvature, direction: if segment.gear == Gear::Forward { 1 } else { -1 } }
        }
        Motion::Turn { angle_rad } => Piece::Turn { angle_rad },
    };
    segments.iter().map(piece).collect()
}

fn length(pieces: &[Piece]) -> f64 {
    pieces.iter().map(|piece| if let Piece::Arc { length_m, .. } = piece { *length_m } else { 0.0 }).sum()
}

/// Whether both drives are the same within [`SAME`].
fn same(found: &[Piece], stored: &[Piece]) -> bool {
    let near = |pair: (&Piece, &Piece)| match pair {
        (
            Piece::Arc { length_m, curvature, direction },
            Piece::Arc { length_m: other_m, curvature: other, direction: other_direction },
        ) => {
            // Coefficients count by what they bend over the length.
            let mut power = 1.0;
            let bent_alike = curvature.iter().zip(other).all(|(a, b)| {
                let difference = (a - b).abs() * power;
                power *= length_m;
                difference < SAME
            });
            direction == other_direction && (length_m - other_m).abs() < SAME && bent_alike
        }
        (Piece::Turn { angle_rad }, Piece::Turn { angle_rad: other }) => (angle_rad - other).abs() < SAME,
        _ => false,
    };
    found.len() == stored.len() && found.iter().zip(stored).all(near)
}
