//! Every drive that is called solved ends in its goal and keeps its bounds, by the replay, whatever was asked.

use hairpin::campaign::goals::{anywhere, flat_goal};
use hairpin::feasibility::steering::shooting::cc::{self, Gears};
use hairpin::feasibility::steering::shooting::query::{Curvatures, Goal, Query};
use hairpin::feasibility::steering::shooting::solve::{Choices, Method, Outcome, Solution, solve};
use hairpin::math::random::{Stream, stream};
use hairpin::trajectory::drive::{Gear, Motion, Segment};
use hairpin::verification::{DriveClaim, DrivePiece, DriveReplay, replay_drive};
use rand::RngExt;

fn replay(query: &Query, solution: &Solution) -> DriveReplay {
    let piece = |segment: &Segment| match segment.motion {
        Motion::Arc { length_m, curvature } => DrivePiece::Arc { length_m, curvature, direction: segment.gear.sign() },
        Motion::Turn { angle_rad } => DrivePiece::Turn { angle_rad },
    };
    let pieces: Vec<DrivePiece> = solution.segments.iter().map(piece).collect();
    let Goal { x, y, yaw, curvature } = query.goal;
    let claim = DriveClaim {
        start_curvature: query.start_curvature,
        crab: 0.0,
        crab_rate: 0.0,
        end: [x, y, yaw],
        end_curvature: curvature,
    };
    replay_drive(&pieces, &claim)
}

fn check(query: &Query, bounds: &Curvatures, solution: &Solution) -> DriveReplay {
    let found = replay(query, solution);
    let [x, y, yaw] = found.error;
    let told = format!("{query:?} {bounds:?} {solution:?} {found:?}");
    assert_eq!(solution.outcome, Outcome::Solved, "{told}");
    assert!(x.hypot(y) <= 0.01 && yaw.abs() <= 0.01 && found.error_curvature.abs() <= 0.01, "{told}");
    assert!(found.start_error_curvature.abs() < 1e-6 && found.max_jump < 1e-6, "{told}");
    assert!(found.max_curvature <= bounds.most * (1.0 + 1e-9), "{told}");
    assert!(found.max_curvature_rate <= bounds.most_rate * (1.0 + 1e-9), "{told}");
    found
}

fn random_query(random: &mut Stream, reach: f64, bend: f64) -> Query {
    let mut within = |most: f64| if most > 0.0 { random.random_range(-most..most) } else { 0.0 };
    let goal = Goal { x: within(reach), y: within(reach), yaw: within(std::f64::consts::PI), curvature: within(bend) };
    Query { start_curvature: within(bend), goal }
}

#[test]
fn random_families_replay_within_bounds() {
    for (seed, most, most_rate) in [(1, 1.0, 1.0), (2, 0.4, 0.3), (3, 2.0, 10.0)] {
        let bounds = Curvatures { most, most_rate };
        let mut random = stream(seed);
        for case in 0..400 {
            let bend = if case % 2 == 0 { 0.0 } else { most };
            let query = random_query(&mut random, [0.3, 2.0, 6.0, 20.0][case % 4] / most, bend);
            for (reversals, turns) in [(false, false), (true, false), (false, true), (true, true)] {
                for gear in [Gear::Forward, Gear::Reverse] {
                    let choices = Choices { gear, reversals, turns, ..Choices::default() };
                    let solution = solve(&query, &bounds, &choices, || false);
                    let found = check(&query, &bounds, &solution);
                    let turned = solution.segments.iter().any(|s| matches!(s.motion, Motion::Turn { .. }));
                    assert!((reversals || found.reversals == 0) && (turns || !turned), "{query:?} {solution:?}");
                    if !reversals {
                        let driven = solution.segments.iter().filter(|s| s.length_m() > 0.0);
                        assert!(driven.clone().all(|s| s.gear == gear), "{gear:?}: {query:?} {solution:?}");
                    }
                    if !turns {
                        let gears = if reversals { Gears::Both } else { Gears::Only(gear) };
                        let closed = cc::steer(&query, &bounds, gears).unwrap().length_m();
                        assert!(found.length <= 1.25 * closed + 1e-6, "{} > {closed}: {query:?}", found.length);
                    }
                }
            }
        }
    }
}

#[test]
fn what_is_plain_is_a_single_arc_and_what_is_not_has_a_reason() {
    let bounds = Curvatures { most: 1.0, most_rate: 1.0 };
    let query = |x, y, yaw| Query { start_curvature: 0.0, goal: Goal { x, y, yaw, curvature: 0.0 } };
    let reversing = Choices { reversals: true, ..Choices::default() };
    let plain = solve(&query(6.0, 1.0, 0.2), &bounds, &reversing, || false);
    assert_eq!(plain.method, Method::SingleArc);
    let aside = query(0.0, 1.0, 0.0);
    let (forward, free) =
        (solve(&aside, &bounds, &Choices::default(), || false), solve(&aside, &bounds, &reversing, || false));
    let (forward_m, free_m) = (check(&aside, &bounds, &forward).length, check(&aside, &bounds, &free).length);
    assert!(free.method == Method::Clothoids && free_m < 0.6 * forward_m, "{free_m} {forward_m}");
    // Stopped at once there is the start value; stopped after the arc what came nearest, or the arc if it is good.
    let start = solve(&query(4.0, 2.0, 0.5), &bounds, &reversing, || true);
    assert!(start.outcome == Outcome::Stopped && !start.segments.is_empty(), "{start:?}");
    let mut asked = 0;
    let late = solve(&aside, &bounds, &reversing, || {
        asked += 1;
        asked > 1
    });
    assert_eq!((asked, late.method), (2, Method::SingleArc));
    // Without the arc there is still an answer, and it says that none was tried.
    let closed = solve(&query(6.0, 1.0, 0.2), &bounds, &Choices { arcs: false, ..reversing }, || false);
    assert_eq!((closed.method, closed.arc), (Method::Clothoids, None));
    check(&query(6.0, 1.0, 0.2), &bounds, &closed);
}

#[test]
fn of_equal_lengths_the_least_turning_and_the_fewest_stops_win() {
    let bounds = Curvatures { most: 1.0, most_rate: 1.0 };
    let query = |x, y, yaw, k| Query { start_curvature: k, goal: Goal { x, y, yaw, curvature: k } };
    let both = Choices { reversals: true, turns: true, ..Choices::default() };
    let turned = |solution: &Solution| {
        let of = |segment: &Segment| if segment.length_m() > 0.0 { 0.0 } else { segment.turn_rad().abs() };
        solution.segments.iter().map(of).sum::<f64>()
    };
    for choices in [both, Choices { arcs: false, ..both }, Choices { gear: Gear::Reverse, ..both }] {
        for (asked, most) in [
            (query(-2.0, 0.0, 0.0, 0.0), 0.0),
            (query(2.0, 0.0, 0.0, 0.0), 0.0),
            (query(-2.0, 0.5, 0.0, 0.0), 2.0 * 0.25_f64.atan() + 1e-9),
            (query(-2.0, 0.0, 0.3, 0.0), 0.3 + 1e-9),
            (query(2.0, 0.0, -0.3, 0.0), 0.3 + 1e-9),
        ] {
            let solution = solve(&asked, &bounds, &choices, || false);
            check(&asked, &bounds, &solution);
            assert!(turned(&solution) <= most, "{asked:?} {choices:?}: {solution:?}");
        }
    }
    // Back along the circle that both ends are on: no way to straight wheels and back is as short.
    let (sin, cos) = (-0.75_f64).sin_cos();
    let bent = query(2.0 * sin, 2.0 * (1.0 - cos), -0.75, 0.5);
    let solution = solve(&bent, &bounds, &both, || false);
    let found = check(&bent, &bounds, &solution);
    assert!((found.length - 1.5).abs() < 1e-6 && found.reversals == 0, "{solution:?}");
    // Among words with cusps none as long as the shortest stands less often.
    let stops = |path: &cc::Path| {
        let mut gears = Vec::new();
        path.segments(|segment| gears.push(segment.gear));
        gears.windows(2).filter(|pair| pair[0] != pair[1]).count()
    };
    let grid = [-2.0, -1.0, -0.5, 0.0, 0.5, 1.0, 2.0];
    for (x, y) in grid.iter().flat_map(|x| grid.map(|y| (*x, y))) {
        for eighth in -4..=4 {
            let asked = query(x, y, f64::from(eighth) * std::f64::consts::FRAC_PI_4, 0.0);
            let Some(best) = cc::steer(&asked, &bounds, Gears::Both) else { continue };
            cc::every(&asked, &bounds, Gears::Both, |path| {
                let same = (path.length_m() - best.length_m()).abs() < 1e-9;
                assert!(!same || stops(&path) >= stops(&best), "{asked:?}: {best:?} {path:?}");
            });
        }
    }
}

#[test]
fn mirrored_queries_have_mirrored_drives() {
    let bounds = Curvatures { most: 1.0, most_rate: 1.0 };
    let mut random = stream(4);
    for _ in 0..300 {
        let query = random_query(&mut random, 5.0, 1.0);
        let Goal { x, y, yaw, curvature } = query.goal;
        let goal = Goal { x, y: -y, yaw: -yaw, curvature: -curvature };
        let mirrored = Query { start_curvature: -query.start_curvature, goal };
        for reversals in [false, true] {
            let choices = Choices { reversals, ..Choices::default() };
            let (a, b) = (solve(&query, &bounds, &choices, || false), solve(&mirrored, &bounds, &choices, || false));
            let (a, b) = (check(&query, &bounds, &a), check(&mirrored, &bounds, &b));
            assert!((a.length - b.length).abs() < 1e-9, "{query:?}: {} {}", a.length, b.length);
        }
    }
}

/// The replay as it was: the classical Runge-Kutta method, two thousand steps and more, no step turning by more than
/// 0.01 rad of a bound of the coefficients; x, y, yaw at the end.
fn end_by_steps(segments: &[Segment]) -> [f64; 3] {
    let metres: f64 = segments.iter().map(Segment::length_m).sum();
    let mut state = [0.0; 3];
    for segment in segments {
        let Motion::Arc { length_m, curvature } = segment.motion else {
            state[2] += segment.turn_rad();
            continue;
        };
        let most: f64 = curvature.iter().rev().fold(0.0, |sum, a| sum * length_m + a.abs());
        let steps = (2000.0 * length_m / metres).max(length_m * most / 0.01).ceil().clamp(16.0, 1e6) as usize;
        let h = length_m / steps as f64;
        let sign = segment.gear.sign();
        let rate = |s: f64, yaw: f64| [sign * yaw.cos(), sign * yaw.sin(), sign * segment.curvature_at(s)];
        for step in 0..steps {
            let (s, yaw) = (length_m * step as f64 / steps as f64, state[2]);
            let k1 = rate(s, yaw);
            let k2 = rate(s + 0.5 * h, yaw + 0.5 * h * k1[2]);
            let k3 = rate(s + 0.5 * h, yaw + 0.5 * h * k2[2]);
            let k4 = rate(s + h, yaw + h * k3[2]);
            for (i, x) in state.iter_mut().enumerate() {
                *x += h / 6.0 * (k1[i] + 2.0 * (k2[i] + k3[i]) + k4[i]);
            }
        }
    }
    state
}

/// Panels and steps end in one place, of ends of random curves and of goals anywhere, by turns.
fn compare_replays(queries: usize) {
    let bounds = Curvatures { most: 1.0, most_rate: 1.0 };
    let (mut random, choices) = (stream(11), Choices { reversals: true, ..Choices::default() });
    let mut worst = [0.0_f64; 2];
    for number in 0..queries {
        let query = if number % 2 == 0 { flat_goal(&mut random, &bounds) } else { anywhere(&mut random, &bounds, 1.0) };
        let solution = solve(&query, &bounds, &choices, || false);
        let (found, end, goal) = (replay(&query, &solution), end_by_steps(&solution.segments), query.goal);
        let place = (found.error[0] - end[0] + goal.x).hypot(found.error[1] - end[1] + goal.y);
        let turned = (found.error[2] - end[2] + goal.yaw).sin().abs();
        worst = [worst[0].max(place), worst[1].max(turned)];
        // 0.01 rad a step are good for this; panels for 1e-12 m.
        assert!(place < 1e-9 && turned < 1e-10, "{number}: {query:?}: {place} {turned}");
        assert!(found.left_out <= 1e-12 && found.steps < 200, "{number}: {query:?}: {found:?}");
    }
    println!("{queries} queries: {:.1e} m, {:.1e} rad at most", worst[0], worst[1]);
}

#[test]
fn panels_end_where_thousands_of_steps_do() {
    compare_replays(120);
}

/// cargo test --release -p hairpin --test library steering -- --ignored --nocapture
#[test]
#[ignore = "a minute in a release build"]
fn panels_end_where_thousands_of_steps_do_a_hundred_thousand_times() {
    compare_replays(100_000);
}
