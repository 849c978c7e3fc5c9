//! Vehicles and controls, switched to and fro: each does what is its own, and does it again after the others.

use hairpin::campaign::drive::Site;
use hairpin::feasibility::steering::shooting::families::{self, Parameters};
use hairpin::feasibility::steering::shooting::flat::{self, Control, Cost};
use hairpin::feasibility::steering::shooting::rough::{Answer, Settings, Status};
use hairpin::feasibility::steering::shooting::solve::{Choices, Outcome, solve};
use hairpin::feasibility::steering::shooting::{Control as Family, Goal, Query, generate};
use hairpin::robot::rover::Suspension;
use hairpin::trajectory::SpeedProfile;
use hairpin::trajectory::drive::{Gear, Motion, Segment, SegmentList};
use hairpin_formats::library;
use hairpin_formats::scenario::rover_for;
use hairpin_jobs::Problem;

use super::check::{Check, Test};
use super::subject::Subject;
use crate::drives::BOUNDS;

/// Rounds of switching.
const ROUNDS: usize = 3;

/// R9: the supplied vehicle.
pub(super) fn loads(subject: &Subject) -> Test {
    let rover = &subject.rocky8;
    let (six, base) = (matches!(rover.suspension, Suspension::RockerBogie(_)), rover.suspension.wheelbase());
    let check = Check::new(
        format!(
            "`{}` read: a rocker-bogie of six wheels over {:.3} m, |κ| ≤ {} 1/m, {} m/s; {}",
            rover.name,
            base.unwrap_or(f64::NAN),
            rover.limits.curvature,
            rover.default_speed,
            rover.source
        ),
        "six wheels on a rocker-bogie",
        six && base.is_some(),
    );
    Test::new("R9", "R-9", "the supplied rocky8 is loaded and used (R4 … R8, R10, R11 drive it)", check)
}

/// A parameterisation of the controls, how it answers, and how its answers can be told from the others'.
struct Kind {
    name: &'static str,
    answer: fn(&Query) -> SegmentList,
    own: fn(&[Segment]) -> bool,
}

fn forward(query: &Query, settings: flat::Settings<'_>) -> SegmentList {
    flat::forward(query, &BOUNDS, &settings).segments
}

/// The answer of a family that has a search of its own, under a speed that doubles on the way; nothing if its
/// parameters are not `own`.
fn generated(query: &Query, family: Family, own: fn(&Parameters) -> bool) -> SegmentList {
    let speed = SpeedProfile::Ramp { start: 0.2, end: 0.4 };
    let problem = families::Problem { query: *query, speed, swing: 0.0, free_end: false };
    let found = generate(&problem, family, &BOUNDS, &Choices::default(), || false, |_| {});
    let solved = found.solution.outcome == Outcome::Solved && found.parameters.as_ref().is_some_and(own);
    if solved { found.solution.segments } else { SegmentList::EMPTY }
}

/// a₀ … a₅ of a drive of one arc.
fn only_arc(segments: &[Segment]) -> Option<[f64; 6]> {
    match segments {
        [Segment { motion: Motion::Arc { curvature, .. }, .. }] => Some(*curvature),
        _ => None,
    }
}

fn has_turn(segments: &[Segment]) -> bool {
    segments.iter().any(|segment| matches!(segment.motion, Motion::Turn { .. }))
}

fn linear(segments: &[Segment]) -> bool {
    segments.iter().all(|s| matches!(s.motion, Motion::Arc { curvature, .. } if curvature[2..] == [0.0; 4]))
}

const KINDS: [Kind; 10] = [
    Kind {
        name: "fifth order",
        answer: |query| forward(query, flat::Settings::default()),
        own: |drive| only_arc(drive).is_some_and(|a| a[3] != 0.0 && a[4] != 0.0 && a[5] != 0.0),
    },
    Kind {
        name: "third order",
        answer: |query| forward(query, flat::Settings { control: Control::Cubic, ..flat::Settings::default() }),
        own: |drive| only_arc(drive).is_some_and(|a| a[2] != 0.0 && a[4].abs() + a[5].abs() < 1e-12),
    },
    Kind {
        name: "constant",
        answer: |query| forward(query, flat::Settings { control: Control::Arc, ..flat::Settings::default() }),
        own: |drive| only_arc(drive).is_some_and(|a| a[0] != 0.0 && a[1..] == [0.0; 5]),
    },
    Kind {
        name: "fifth order of least ∫κ²",
        answer: |query| forward(query, flat::Settings { cost: Cost::Curvature, ..flat::Settings::default() }),
        own: |drive| only_arc(drive).is_some_and(|a| a[5] != 0.0),
    },
    Kind {
        name: "lines, arcs and clothoids",
        answer: |query| solve(query, &BOUNDS, &Choices { arcs: false, ..Choices::default() }, || false).segments,
        own: |drive| drive.len() > 1 && linear(drive) && !has_turn(drive),
    },
    Kind {
        name: "turns in place",
        answer: |query| {
            let choices = Choices { arcs: false, turns: true, ..Choices::default() };
            solve(query, &BOUNDS, &choices, || false).segments
        },
        own: has_turn,
    },
    Kind {
        name: "spline through knots",
        answer: |query| generated(query, Family::Knots, |found| matches!(found, Parameters::Knots { .. })),
        own: |drive| drive.len() > 1 && !linear(drive) && !has_turn(drive),
    },
    Kind {
        name: "polynomial of time",
        answer: |query| generated(query, Family::TimePolynomial, |found| matches!(found, Parameters::Time { .. })),
        own: |drive| !drive.is_empty() && !linear(drive) && !has_turn(drive),
    },
    Kind {
        name: "polynomials of velocity",
        answer: |query| {
            generated(query, Family::VelocityPolynomial, |found| matches!(found, Parameters::Velocity { .. }))
        },
        own: |drive| !drive.is_empty() && !linear(drive) && !has_turn(drive),
    },
    Kind {
        name: "reverse",
        answer: |query| {
            solve(query, &BOUNDS, &Choices { gear: Gear::Reverse, ..Choices::default() }, || false).segments
        },
        own: |drive| !drive.is_empty() && drive.iter().all(|segment| segment.gear == Gear::Reverse),
    },
];

/// R12.
pub(super) fn switches_controls() -> Test {
    // A goal that a circular arc does not quite reach.
    let goal = Goal { x: 3.0, y: 1.0, yaw: 0.9, curvature: 0.1 };
    let query = Query { start_curvature: -0.05, goal };
    let first = KINDS.each_ref().map(|kind| (kind.answer)(&query));
    let (mut own, mut again) = (0, 0);
    for _ in 0..ROUNDS {
        for (kind, before) in KINDS.iter().zip(&first) {
            let drive = (kind.answer)(&query);
            own += usize::from((kind.own)(&drive));
            again += usize::from(drive == *before);
        }
    }
    let differ = (0..first.len()).all(|i| (0..i).all(|j| first[i] != first[j]));
    let all = ROUNDS * KINDS.len();
    let check = Check::new(
        format!(
            "{} kinds in {ROUNDS} rounds: {own} of {all} answers are of their own kind, {again} the same as before, {} ({})",
            KINDS.len(),
            if differ { "all kinds differ" } else { "some kinds do not differ" },
            KINDS.each_ref().map(|kind| kind.name).join(", ")
        ),
        "all",
        own == all && again == all && differ,
    );
    Test::new("R12", "R-10", "the parameterisation of the controls is switched several times", check)
}

/// R13.
pub(super) fn switches_vehicles(subject: &Subject) -> Result<Test, Problem> {
    let names: Vec<&str> = library::rovers().map(|rover| rover.name).collect();
    let rovers = names.iter().map(|name| rover_for(name)).collect::<Result<Vec<_>, _>>()?;
    let goals = subject.goals(&subject.rocky8, 8, 36)?;
    let solve = |rover, (start, goal): &(_, _)| -> Answer {
        Site::straight(rover, &subject.ground).drive(start, goal, &Settings::default())
    };
    let first: Vec<Vec<Answer>> =
        rovers.iter().map(|rover| goals.iter().map(|goal| solve(rover, goal)).collect()).collect();
    let (mut all, mut again) = (0, 0);
    for _ in 0..ROUNDS {
        for (rover, before) in rovers.iter().zip(&first) {
            for (goal, before) in goals.iter().zip(before) {
                all += 1;
                again += usize::from(solve(rover, goal) == *before);
            }
        }
    }
    let solved = first.iter().flatten().filter(|answer| answer.status == Status::Ok).count();
    let differ =
        (0..first.len()).all(|i| (0..i).all(|j| first[i].iter().zip(&first[j]).any(|(a, b)| a.segments != b.segments)));
    let asked = rovers.len() * goals.len();
    let check = Check::new(
        format!(
            "{} vehicles ({}) in {ROUNDS} rounds: {again} of {all} drives are the same as before, {}; {solved} of {asked} solved",
            rovers.len(),
            names.join(", "),
            if differ { "each vehicle has its own" } else { "some vehicles drive alike" },
        ),
        "all the same, each its own, most solved",
        again == all && differ && 10 * solved >= 8 * asked,
    );
    Ok(Test::new("R13", "R-9", "the vehicle is switched several times", check))
}
