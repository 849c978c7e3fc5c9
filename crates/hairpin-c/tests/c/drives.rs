//! Drives: the command's own, to the bit; nothing from the heap; budgets that hold.

use std::fs;

use allocation_counter::measure;
use hairpin::campaign::goals::{anywhere, flat_goal};
use hairpin::feasibility::steering::shooting::{Curvatures, Query};
use hairpin::math::random::stream;
use hairpin::robot::rover::{Rover, RoverDescription};
use hairpin::trajectory::drive::{Motion, Segment};
use hairpin::world::terrain::{ElevationMap, Grid as Cells, HoleRule};
use hairpin_c::drive::{
    Drive, DrivenSegment, HAIRPIN_BLOCKED, HAIRPIN_BUDGET_SPENT, HAIRPIN_INFEASIBLE, HAIRPIN_SOLVED, State,
};
use hairpin_c::map::Grid;
use hairpin_c::refusal::HAIRPIN_OK;
use hairpin_c::settings::{SteerSettings, hairpin_steer_defaults, hairpin_steer_fixed_budget};
use hairpin_c::steer::hairpin_confirm;
use hairpin_formats::steering::{Asked, Frame, Status};
use hairpin_jobs::steer::Vehicle;

use crate::called::{Steerer, name};

const BOUNDS: Curvatures = Curvatures { most: 1.0, most_rate: 1.0 };
pub(crate) const HERE: State = State { x_m: 0.0, y_m: 0.0, yaw_rad: 0.0, curvature_1_m: 0.0 };

pub(crate) fn file(name: &str) -> String {
    let path = format!("{}/../../data/robots/rover/{name}.toml", env!("CARGO_MANIFEST_DIR"));
    fs::read_to_string(path).expect("a shipped rover")
}

/// Hills on which a rocker-bogie leans, 24 m a side.
pub(crate) fn hills() -> (Grid, Vec<f32>) {
    let height = |cell: usize| {
        let (x, y) = ((cell % 60) as f64 * 0.4, (cell / 60) as f64 * 0.4);
        (0.4 * libm::sin(0.5 * x) * libm::cos(0.4 * y)) as f32
    };
    (Grid { columns: 60, rows: 60, first_center_m: [0.0; 2], cell_m: [0.4; 2] }, (0..3600).map(height).collect())
}

fn states(query: &Query) -> (State, State) {
    let goal = &query.goal;
    let start = State { curvature_1_m: query.start_curvature, ..HERE };
    (start, State { x_m: goal.x, y_m: goal.y, yaw_rad: goal.yaw, curvature_1_m: goal.curvature })
}

/// Drives that are there, drives of any kind.
fn queries() -> Vec<(State, State)> {
    let mut random = stream(5);
    let query = |i: i32| if i % 2 == 0 { flat_goal(&mut random, &BOUNDS) } else { anywhere(&mut random, &BOUNDS, 0.0) };
    (0..120).map(query).map(|query| states(&query)).collect()
}

/// From places of the hills to others near them.
pub(crate) fn on_the_hills() -> Vec<(State, State)> {
    let from = |i: f64| State { x_m: 8.0 + 0.7 * i, y_m: 10.0 + 0.3 * i, yaw_rad: 0.4 * i, curvature_1_m: 0.0 };
    let to = |i: f64, from: &State| {
        let (sin, cos) = libm::sincos(from.yaw_rad + 0.2);
        State { x_m: from.x_m + 3.0 * cos, y_m: from.y_m + 3.0 * sin, yaw_rad: from.yaw_rad + 0.1 * i, ..*from }
    };
    (0..8).map(f64::from).map(|i| (from(i), to(i, &from(i)))).collect()
}

pub(crate) fn asked(start: &State, goal: [f64; 3], kf: f64) -> Asked {
    Asked {
        start: Some([start.x_m, start.y_m, start.yaw_rad]),
        goal,
        k0: start.curvature_1_m,
        kf,
        free_end: false,
        v0: None,
        vf: None,
        direction: 0.0,
        direction_end: None,
        frame: Frame::Enu,
        max_curvature: None,
        tolerance_m: None,
    }
}

pub(crate) fn rover(name: &str) -> Rover {
    toml::from_str::<RoverDescription>(&file(name)).expect("its keys").build().expect("its numbers")
}

pub(crate) fn bits(drive: &Drive) -> Vec<u64> {
    let numbers = |s: &DrivenSegment| {
        let motion = s.curvature.map(f64::to_bits).into_iter().chain([s.length_m.to_bits(), s.angle_rad.to_bits()]);
        motion.chain([i64::from(s.direction) as u64]).collect::<Vec<_>>()
    };
    drive.segments[..drive.count as usize].iter().flat_map(numbers).collect()
}

pub(crate) fn bits_of(segments: &[Segment]) -> Vec<u64> {
    let numbers = |segment: &Segment| {
        let Motion::Arc { length_m, curvature } = segment.motion else { panic!("no turns were allowed") };
        let motion = curvature.map(f64::to_bits).into_iter().chain([length_m.to_bits(), 0.0_f64.to_bits()]);
        motion.chain([segment.gear.sign() as i64 as u64]).collect::<Vec<_>>()
    };
    segments.iter().flat_map(numbers).collect()
}

#[test]
fn drives_are_those_of_the_command_to_the_bit() {
    let settings = hairpin_steer_defaults();
    let (plane, command) = (Steerer::new(&file("generic"), None, &settings), Vehicle::on(rover("generic"), None, None));
    let mut compared = 0;
    for (start, goal) in queries() {
        let ours = plane.ask(&start, &goal);
        let asked = asked(&start, [goal.x_m, goal.y_m, goal.yaw_rad], goal.curvature_1_m);
        let theirs = command.answer(&asked);
        assert_eq!(ours.status == HAIRPIN_SOLVED, theirs.status == Status::Ok, "{}", name(&ours.limit));
        let Some((solution, replay)) = theirs.drive.filter(|_| theirs.status == Status::Ok) else { continue };
        // The command goes on to nearby goals where the exact one takes a long way round.
        if replay.length == ours.length_m {
            compared += 1;
            assert_eq!(bits(&ours), bits_of(&solution.segments));
            assert_eq!(
                (ours.miss_m, ours.iterations),
                (libm::hypot(replay.error[0], replay.error[1]), solution.iterations)
            );
        }
    }
    assert!(compared > 100, "{compared}");

    let (grid, heights) = hills();
    let map = ElevationMap::new(
        Cells { columns: 60, rows: 60, first_center: [0.0; 2], cell: [0.4; 2] },
        &heights,
        HoleRule::Error,
    );
    let ground = Steerer::new(&file("rocky8"), Some((&grid, &heights)), &settings);
    let command = Vehicle::on(rover("rocky8"), Some(map.expect("a map")), None);
    for (start, goal) in on_the_hills() {
        let mut ours = ground.ask(&start, &goal);
        let (sin, cos) = libm::sincos(start.yaw_rad);
        let (x, y) = (goal.x_m - start.x_m, goal.y_m - start.y_m);
        let seen = [cos * x + sin * y, cos * y - sin * x, goal.yaw_rad - start.yaw_rad];
        let theirs = command.answer(&asked(&start, seen, goal.curvature_1_m));
        let (solution, replay) = theirs.drive.expect("a drive");
        assert!(theirs.status == Status::Ok && ours.status == HAIRPIN_SOLVED, "{}", name(&ours.limit));
        // The command turns its goal into the frame of the start and back.
        let near = |a: f64, b: f64| (a - b).abs() < 1e-9;
        let length: f64 = solution.segments.iter().map(Segment::length_m).sum();
        assert!(near(ours.length_m, length) && ours.count as usize == solution.segments.len());
        // SAFETY: every pointer leads to what its type says; read and written one after the other.
        let code = unsafe { hairpin_confirm(ground.handle(), &start, &goal, &mut ours, std::ptr::null_mut()) };
        assert_eq!((code, ours.status), (HAIRPIN_OK, HAIRPIN_SOLVED));
        assert!((ours.miss_m - libm::hypot(replay.error[0], replay.error[1])).abs() < 1e-6, "{}", ours.miss_m);
    }
}

#[test]
fn nothing_is_taken_from_the_heap() {
    let (grid, heights) = hills();
    let lagging = file("rocky8") + "\n[response]\nlatency_s = 0.2\nsteering_time_constant_s = 0.2\n";
    for settings in [hairpin_steer_defaults(), hairpin_steer_fixed_budget()] {
        let settings = SteerSettings { reversals: 1, ..settings };
        let plane = Steerer::new(&file("generic"), None, &settings);
        let ground = Steerer::new(&file("rocky8"), Some((&grid, &heights)), &settings);
        let late = Steerer::new(&lagging, Some((&grid, &heights)), &settings);
        let (flat, hilly) = (queries(), on_the_hills());
        let mut solved = 0;
        let heap = measure(|| {
            solved += flat.iter().filter(|(start, goal)| plane.ask(start, goal).status == HAIRPIN_SOLVED).count();
            for (start, goal) in &hilly[..4] {
                solved += usize::from(ground.ask(start, goal).status == HAIRPIN_SOLVED);
                solved += usize::from(late.ask(start, goal).status == HAIRPIN_SOLVED);
                // Beyond the map, and what is no question.
                let beyond = State { x_m: 40.0, ..*goal };
                assert_ne!(ground.ask(start, &beyond).status, HAIRPIN_SOLVED);
            }
        });
        assert_eq!(heap.count_total, 0, "{heap:?}");
        assert!(solved > 110, "{solved}");
    }
    // The counter counts.
    assert_eq!(measure(|| drop(std::hint::black_box(vec![1_u8; 100]))).bytes_total, 100);
}

#[test]
fn a_budget_holds_and_changes_no_drive_that_it_does_for() {
    let bounded = |most_steps, most_looks| SteerSettings { most_steps, most_looks, ..hairpin_steer_defaults() };
    let free = Steerer::new(&file("generic"), None, &hairpin_steer_defaults());
    for most in [4, 30] {
        let within = Steerer::new(&file("generic"), None, &bounded(most, 0));
        let (mut same, mut spent) = (0, 0);
        for (start, goal) in queries() {
            let (ours, all) = (within.ask(&start, &goal), free.ask(&start, &goal));
            assert!(ours.iterations <= most, "{} of {most}", ours.iterations);
            same += usize::from(all.iterations < most && bits(&ours) == bits(&all) && ours.status == all.status);
            spent += usize::from(ours.status == HAIRPIN_BUDGET_SPENT);
            assert!(all.iterations >= most || bits(&ours) == bits(&all));
        }
        assert!(same > 20, "{same} the same, {spent} spent");
    }
    let (grid, heights) = hills();
    let free = Steerer::new(&file("rocky8"), Some((&grid, &heights)), &bounded(0, u64::MAX));
    let (start, goal) = on_the_hills()[3];
    let all = free.ask(&start, &goal);
    assert!(all.status == HAIRPIN_SOLVED && all.looks > 500, "{} looks", all.looks);
    for (looks, status) in
        [(all.looks + 1, HAIRPIN_SOLVED), (all.looks - 1, HAIRPIN_BUDGET_SPENT), (40, HAIRPIN_BUDGET_SPENT)]
    {
        let within = Steerer::new(&file("rocky8"), Some((&grid, &heights)), &bounded(0, looks));
        let ours = within.ask(&start, &goal);
        assert!(ours.status == status && ours.looks <= looks, "{looks}: {} {}", ours.status, ours.looks);
        assert!(status != HAIRPIN_SOLVED || bits(&ours) == bits(&all));
    }
}

#[test]
fn what_a_drive_lacks_is_told() {
    let (grid, heights) = hills();
    let plane = Steerer::new(&file("generic"), None, &hairpin_steer_defaults());
    let sharp = plane.ask(&HERE, &State { x_m: 3.0, curvature_1_m: 1.5, ..HERE });
    assert_eq!((sharp.status, name(&sharp.limit), sharp.excess), (HAIRPIN_INFEASIBLE, "curvature_1_m".into(), 0.5));
    // A start that is there drives nowhere.
    let there = plane.ask(&HERE, &State { x_m: 0.005, ..HERE });
    assert_eq!((there.status, there.count, there.miss_m), (HAIRPIN_SOLVED, 0, 0.005));
    let ground = Steerer::new(&file("rocky8"), Some((&grid, &heights)), &hairpin_steer_defaults());
    let (start, goal) = on_the_hills()[0];
    let beyond = ground.ask(&State { x_m: 22.0, yaw_rad: 0.0, ..start }, &State { x_m: 26.0, yaw_rad: 0.0, ..goal });
    assert_eq!((beyond.status, name(&beyond.limit)), (HAIRPIN_BLOCKED, "map_edge".into()));
    assert!(beyond.stopped_after_m > 0.0 && beyond.stopped_after_m < 3.0, "{}", beyond.stopped_after_m);
}
