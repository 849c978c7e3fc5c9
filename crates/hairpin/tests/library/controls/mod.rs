//! Every family of controls, every kind of speed and direction: goals that are feasible by construction are all met, by
//! the replay's own equations, within 1 cm, 0.01 rad, 0.01 1/m and the bounds.

mod made;

use std::f64::consts::{PI, TAU};

use hairpin::campaign::drive::Site;
use hairpin::campaign::goals::ground_goals;
use hairpin::feasibility::steering::shooting::families::{Answer, Parameters, Problem, Settings, solve};
use hairpin::feasibility::steering::shooting::flat::{self, Cost, Status};
use hairpin::feasibility::steering::shooting::rough;
use hairpin::feasibility::steering::shooting::solve::{Choices, Outcome};
use hairpin::feasibility::steering::shooting::{Control, Goal, Precision, Query, generate};
use hairpin::math::random::{Stream, stream};
use hairpin::robot::rover::{Response, Rover, RoverDescription, Slip};
use hairpin::trajectory::drive::{Gear, Motion, Segment};
use hairpin::trajectory::{Direction, SpeedProfile};
use hairpin::verification::{DriveClaim, DrivePiece, DriveReplay, replay_drive};
use hairpin::world::terrain::generate::{Recipe, generate as terrain};
use made::{BOUNDS, Made, polynomial, spline, time_share};
use rand::RngExt;

fn replay(problem: &Problem, segments: &[Segment]) -> DriveReplay {
    let pieces: Vec<DrivePiece> = segments
        .iter()
        .map(|segment| {
            let Motion::Arc { length_m, curvature } = segment.motion else { panic!("no turns in these families") };
            DrivePiece::Arc { length_m, curvature, direction: segment.gear.sign() }
        })
        .collect();
    let Goal { x, y, yaw, curvature } = problem.query.goal;
    let length: f64 = segments.iter().map(Segment::length_m).sum();
    let claim = DriveClaim {
        start_curvature: problem.query.start_curvature,
        crab: 0.0,
        crab_rate: problem.swing / length,
        end: [x, y, yaw],
        end_curvature: curvature,
    };
    replay_drive(&pieces, &claim)
}

fn answer(problem: &Problem, control: Control) -> Answer {
    solve(problem, control, &BOUNDS, &Settings::default(), &mut || false, &mut |_| {})
}

/// Whether an answer is what it claims to be, and its length.
fn held(problem: &Problem, answer: &Answer, told: &str) -> Option<f64> {
    if answer.status != Status::Ok {
        println!("{told}: {:?} after {} iterations: {problem:?}", answer.status, answer.iterations);
        return None;
    }
    let found = replay(problem, &answer.segments);
    let [x, y, yaw] = found.error;
    assert!(x.hypot(y) <= 0.01 && yaw.abs() <= 0.01 && found.error_curvature.abs() <= 0.01, "{told}: {found:?}");
    assert!(found.start_error_curvature.abs() < 1e-6 && found.max_jump < 1e-6, "{told}: {found:?}");
    assert!(found.max_curvature <= 1.0 + 1e-9 && found.max_curvature_rate <= 1.0 + 1e-9, "{told}: {found:?}");
    Some(found.length)
}

/// Makes and solves `count` problems; panics unless all are met, and most not much longer than the curve they were made
/// from.
fn all_met(name: &str, count: u64, control: Control, make: impl Fn(&mut Stream) -> (Made, SpeedProfile, f64)) {
    let begun = std::time::Instant::now();
    let mut ratios = Vec::new();
    let mut iterations = 0;
    for seed in 0..count {
        let mut random = stream(seed);
        let (made, speed, swing) = make(&mut random);
        let problem = made.problem(speed, swing);
        let answer = answer(&problem, control);
        iterations += answer.iterations;
        ratios.extend(held(&problem, &answer, &format!("{name}, seed {seed}")).map(|length| length / made.length));
    }
    let met = ratios.len() as u64;
    ratios.sort_by(f64::total_cmp);
    println!(
        "{name}: {met}/{count}, length {:.3} median, {:.3} worst; {:.1} iterations, {:.0} µs with making",
        ratios[ratios.len() / 2],
        ratios.last().unwrap(),
        f64::from(iterations) / count as f64,
        begun.elapsed().as_secs_f64() * 1e6 / count as f64
    );
    assert_eq!(met, count, "{name}");
    assert!(ratios[ratios.len() / 2] < 1.05, "{name}");
}

fn length(random: &mut Stream) -> f64 {
    random.random_range(1.0..12.0)
}

#[test]
fn cubics() {
    all_met("cubic", 200, Control::Cubic, |random| {
        let (length, shape) = (length(random), polynomial(random, 3));
        (Made::new(random, length, shape), 1.0.into(), 0.0)
    });
}

#[test]
fn quintics() {
    all_met("quintic", 200, Control::Quintic, |random| {
        let (length, shape) = (length(random), polynomial(random, 5));
        (Made::new(random, length, shape), 1.0.into(), 0.0)
    });
}

#[test]
fn knots() {
    all_met("knots", 200, Control::Knots, |random| {
        let values: Vec<f64> = (0..8).map(|_| random.random_range(-1.0..1.0)).collect();
        let length = length(random);
        (Made::new(random, length, spline(&values)), 1.0.into(), 0.0)
    });
}

#[test]
fn polynomials_of_time_at_a_constant_speed() {
    all_met("time-polynomial, constant", 200, Control::TimePolynomial, |random| {
        let (length, shape) = (length(random), polynomial(random, 5));
        (Made::new(random, length, shape), 0.3.into(), 0.0)
    });
}

/// κ as a polynomial of time under a ramp from v0 to vf.
fn on_a_ramp(random: &mut Stream) -> (Made, SpeedProfile, f64) {
    let (start, end) = (random.random_range(0.1..2.0), random.random_range(0.1..2.0));
    let (length, shape) = (length(random), polynomial(random, 5));
    let share = time_share(start, end);
    (Made::new(random, length, |sigma| shape(share(sigma))), SpeedProfile::Ramp { start, end }, 0.0)
}

#[test]
fn polynomials_of_time_on_ramps() {
    all_met("time-polynomial, v0 ≠ vf", 1000, Control::TimePolynomial, on_a_ramp);
}

#[test]
fn velocity_polynomials_on_ramps() {
    all_met("velocity-polynomial, v0 ≠ vf", 1000, Control::VelocityPolynomial, |random| {
        let (start, end) = (random.random_range(0.2..1.0), random.random_range(0.2..1.0));
        let (length, omega) = (length(random), polynomial(random, 5));
        let speed = move |u: f64| start + (end - start) * u;
        let share = time_share(start, end);
        let made = Made::new(random, length, |sigma| omega(share(sigma)) / speed(share(sigma)));
        (made, SpeedProfile::Ramp { start, end }, 0.0)
    });
}

#[test]
fn arc_length_families_with_other_curvatures_at_the_end() {
    all_met("quintic, kf ≠ 0", 1000, Control::Quintic, |random| {
        let (length, shape) = (length(random), polynomial(random, 5));
        (Made::new(random, length, move |u| shape(u) + 0.2), 1.0.into(), 0.0)
    });
}

#[test]
fn directions_that_turn() {
    all_met("quintic, linear direction", 1000, Control::Quintic, |random| {
        let (length, shape) = (length(random), polynomial(random, 5));
        let swing = random.random_range(-0.25..0.25) * PI;
        (Made::new(random, length, shape), 1.0.into(), swing)
    });
    all_met("knots, linear direction", 200, Control::Knots, |random| {
        let values: Vec<f64> = (0..8).map(|_| random.random_range(-1.0..1.0)).collect();
        let length = length(random);
        let swing = random.random_range(-0.25..0.25) * PI;
        (Made::new(random, length, spline(&values)), 1.0.into(), swing)
    });
}

/// A vehicle that looks another way than it goes: the path is that of one which looks along its way.
#[test]
fn directions_that_stay() {
    for seed in 0..1000 {
        let mut random = stream(seed);
        let (length, shape) = (length(&mut random), polynomial(&mut random, 5));
        let made = Made::new(&mut random, length, shape);
        let crab = random.random_range(-PI..PI);
        let along = made.problem(1.0.into(), 0.0).query;
        // The same way in the body's frame, which is turned back by the direction.
        let (sin, cos) = crab.sin_cos();
        let Goal { x, y, .. } = along.goal;
        let goal = Goal { x: cos * x - sin * y, y: sin * x + cos * y, ..along.goal };
        let query = flat::crab(&Query { goal, ..along }, crab);
        let problem = Problem { query, speed: 1.0.into(), swing: 0.0, free_end: false };
        let solution = generate(&problem, Control::Quintic, &BOUNDS, &Choices::default(), || false, |_| {}).solution;
        assert_eq!(solution.outcome, Outcome::Solved, "seed {seed}");
        let pieces: Vec<DrivePiece> = solution.segments.iter().map(hairpin::campaign::drive::drive_piece).collect();
        let claim = DriveClaim {
            start_curvature: along.start_curvature,
            crab,
            crab_rate: 0.0,
            end: [goal.x, goal.y, goal.yaw],
            end_curvature: goal.curvature,
        };
        let found = replay_drive(&pieces, &claim);
        let [x, y, yaw] = found.error;
        assert!(
            x.hypot(y) <= 0.01 && yaw.abs() <= 0.01 && found.error_curvature.abs() <= 0.01,
            "seed {seed}: {found:?}"
        );
        assert!(found.max_curvature <= 1.0 + 1e-9 && found.max_curvature_rate <= 1.0 + 1e-9, "seed {seed}: {found:?}");
    }
}

#[test]
fn from_rest_to_rest() {
    let speed = SpeedProfile::Trapezoid { start: 0.0, cruise: 0.5, end: 0.0, acceleration: 0.3 };
    for control in [Control::TimePolynomial, Control::VelocityPolynomial] {
        let name = format!("{}, from rest to rest", control.name());
        all_met(&name, 200, control, |random| {
            // Curvatures with even ends: at rest κ̇ = 0 where κ′ is bounded.
            let length = random.random_range(2.0..10.0);
            let a: [f64; 3] = std::array::from_fn(|_| random.random_range(-1.0..1.0));
            let shape = move |u: f64| a[0] + a[1] * (PI * u).cos() + a[2] * (2.0 * PI * u).cos();
            let mut made = Made::new(random, length, shape);
            made.curvature.iter_mut().for_each(|k| *k *= 0.6);
            (made, speed, 0.0)
        });
    }
}

#[test]
fn mirrored_problems_have_mirrored_answers() {
    let ramp = SpeedProfile::Ramp { start: 0.4, end: 1.0 };
    for control in
        [Control::Cubic, Control::Quintic, Control::TimePolynomial, Control::Knots, Control::VelocityPolynomial]
    {
        for seed in 0..40 {
            let mut random = stream(seed);
            let (length, shape) = (length(&mut random), polynomial(&mut random, 3));
            let problem = Made::new(&mut random, length, shape).problem(ramp, 0.2);
            let Goal { x, y, yaw, curvature } = problem.query.goal;
            let goal = Goal { x, y: -y, yaw: -yaw, curvature: -curvature };
            let query = Query { start_curvature: -problem.query.start_curvature, goal };
            let other = answer(&Problem { query, swing: -problem.swing, ..problem }, control);
            let this = answer(&problem, control);
            assert_eq!((this.status, this.iterations), (other.status, other.iterations), "{control:?}, seed {seed}");
            for (a, b) in this.segments.iter().zip(other.segments.iter()) {
                let [Motion::Arc { length_m: one, curvature: a }, Motion::Arc { length_m: two, curvature: b }] =
                    [a.motion, b.motion]
                else {
                    panic!("arcs")
                };
                assert!(one == two && a.iter().zip(&b).all(|(a, b)| *a == -*b), "{control:?}, seed {seed}");
            }
        }
    }
}

/// The state at the end of a family's own parameters, x, y, ψ, by the midpoint rule in steps of 1 ms.
fn reference(parameters: &Parameters, speed: &SpeedProfile) -> [f64; 3] {
    let value = |c: &[f64], t: f64| c.iter().rev().fold(0.0, |sum, c| sum * t + c);
    let mut state = [0.0_f64; 3];
    let mut advance = |dt: f64, v: f64, omega: f64| {
        let middle = state[2] + 0.5 * dt * omega;
        state = [state[0] + dt * v * middle.cos(), state[1] + dt * v * middle.sin(), state[2] + dt * omega];
    };
    let steps = |duration: f64| ((duration / 0.001).ceil(), duration / (duration / 0.001).ceil());
    match parameters {
        Parameters::Velocity { linear, angular, duration } => {
            let (count, dt) = steps(*duration);
            for i in 0..count as usize {
                let t = (i as f64 + 0.5) * dt;
                advance(dt, value(linear, t), value(angular, t));
            }
        }
        Parameters::Time { curvature, duration } => {
            let (count, dt) = steps(*duration);
            // A ramp: v = v0 + (vf − v0) t/T.
            for i in 0..count as usize {
                let t = (i as f64 + 0.5) * dt;
                let v = speed.start() + (speed.end() - speed.start()) * t / duration;
                advance(dt, v, v * value(curvature, t));
            }
        }
        Parameters::ArcLength { curvature, length } => {
            let duration = speed.over(*length).duration();
            let (count, dt) = steps(duration);
            for i in 0..count as usize {
                let s = speed.over(*length).place_at((i as f64 + 0.5) * dt);
                let v = speed.over(*length).speed_at(s);
                advance(dt, v, v * value(curvature, s));
            }
        }
        Parameters::Knots { curvature, length } => {
            let spline = spline(curvature);
            let (count, dt) = steps(speed.over(*length).duration());
            for i in 0..count as usize {
                let s = speed.over(*length).place_at((i as f64 + 0.5) * dt);
                let v = speed.over(*length).speed_at(s);
                advance(dt, v, v * spline(s / length));
            }
        }
    }
    state
}

/// The families' own parameters, integrated in their own terms in steps of 1 ms, end where their segments do.
#[test]
fn a_reference_in_steps_of_a_millisecond_agrees_within_a_tenth_of_the_precision() {
    for control in [Control::Cubic, Control::TimePolynomial, Control::Knots, Control::VelocityPolynomial] {
        for seed in 0..25 {
            let mut random = stream(100 + seed);
            let speed = SpeedProfile::Ramp { start: random.random_range(0.2..1.0), end: random.random_range(0.2..1.0) };
            let (length, shape) = (length(&mut random), polynomial(&mut random, 3));
            let problem = Made::new(&mut random, length, move |u| 0.5 * shape(u)).problem(speed, 0.0);
            let answer = answer(&problem, control);
            let told = format!("{control:?}, seed {seed}: {answer:?}");
            if answer.status != Status::Ok {
                assert_eq!(control, Control::Cubic, "{told}");
                continue;
            }
            let [x, y, yaw] = reference(&answer.parameters, &speed);
            let Goal { x: gx, y: gy, yaw: gyaw, .. } = problem.query.goal;
            let turned = (yaw - gyaw + PI).rem_euclid(TAU) - PI;
            assert!((x - gx).hypot(y - gy) < 0.001 && turned.abs() < 0.001, "{x} {y} {yaw}, {told}");
            assert!(answer.fit_error < 1e-6, "{told}");
        }
    }
}

#[test]
fn arcs_and_turns_are_values_like_the_others_and_say_what_they_lack() {
    let choices = Choices::default();
    let ask = |control: Control, goal: Goal, choices: &Choices| {
        let query = Query::new(0.0, goal, &BOUNDS).unwrap();
        let problem = Problem { query, speed: 1.0.into(), swing: 0.0, free_end: false };
        generate(&problem, control, &BOUNDS, choices, || false, |_| {}).solution
    };
    let mut random = stream(7);
    for _ in 0..200 {
        let (kappa, length) = (random.random_range(-1.0..1.0), random.random_range(0.5..2.5));
        let goal = Goal {
            x: f64::sin(kappa * length) / kappa,
            y: (1.0 - f64::cos(kappa * length)) / kappa,
            yaw: kappa * length,
            curvature: kappa,
        };
        let arc = ask(Control::Arc, goal, &choices);
        assert!(arc.outcome == Outcome::Solved && arc.segments.len() == 1, "{goal:?} {arc:?}");
        let aside = ask(Control::Arc, Goal { yaw: goal.yaw + 0.5, ..goal }, &choices);
        assert!(matches!(aside.arc, Some(Status::Infeasible { limit: flat::Limit::Yaw, .. })), "{aside:?}");
        // The same goals by turns; and in reverse, where only that is allowed.
        let turns = ask(Control::TurnDriveTurn, Goal { curvature: 0.0, ..goal }, &choices);
        assert!(turns.outcome == Outcome::Solved && turns.segments.iter().any(|s| s.turn_rad() != 0.0), "{turns:?}");
        let behind = Goal { x: -goal.x, yaw: -goal.yaw, ..goal };
        for control in [Control::Knots, Control::Cubic] {
            let start = Goal { curvature: 0.0, ..behind };
            let back = ask(control, start, &Choices { gear: Gear::Reverse, ..choices });
            assert!(back.segments.iter().all(|segment| segment.gear == Gear::Reverse), "{back:?}");
            let either = ask(control, start, &Choices { reversals: true, ..choices });
            assert!(either.outcome == Outcome::Solved || back.outcome != Outcome::Solved, "{back:?} {either:?}");
        }
    }
}

fn rocky8(lags: bool) -> Rover {
    let path = format!("{}/../../data/robots/rover/rocky8.toml", env!("CARGO_MANIFEST_DIR"));
    let text = std::fs::read_to_string(path).expect("a shipped rover");
    let rover = toml::from_str::<RoverDescription>(&text).expect("its keys").build().expect("its numbers");
    if !lags {
        return rover;
    }
    let steering_rate = 30.0_f64.to_radians();
    let response = Response { latency: 0.2, steering_time_constant: 0.2, steering_rate, ..rover.response };
    Rover { slip: Slip { at_20_deg: 0.3, side_at_20_deg: 0.15 }, response, ..rover }
}

/// On cratered ground: goals that were driven under the same speeds and directions are met again, slip, latency and lag
/// included.
#[test]
fn speeds_and_directions_are_met_on_the_ground() {
    let recipe =
        Recipe { size_m: 30.0, relief_m: 0.5, crater_area_m2: 150.0, rock_cover: 0.0, seed: 3, ..Recipe::default() };
    let map = terrain(&recipe).expect("a map");
    let ramp = SpeedProfile::Ramp { start: 0.1, end: 0.4 };
    let trapezoid = SpeedProfile::Trapezoid { start: 0.0, cruise: 0.3, end: 0.0, acceleration: 0.1 };
    let turning = Direction { start: 0.3, end: -0.3 };
    let mut least = 40;
    for (name, control, speed, direction, lags) in [
        ("ramp, lags", Control::Quintic, ramp, 0.0.into(), true),
        ("rest to rest, lags", Control::Quintic, trapezoid, 0.0.into(), true),
        ("turning direction", Control::Quintic, 0.3.into(), turning, false),
        ("turning direction, ramp, lags", Control::Knots, ramp, turning, true),
        ("polynomial of time", Control::TimePolynomial, ramp, 0.0.into(), false),
    ] {
        let rover = rocky8(lags);
        let site = Site { rover: &rover, map: &map, speed, direction };
        let goals = ground_goals(&site, 40, &mut stream(23));
        let bounds = site.bounds();
        let precision = Precision { position: 1e-5, yaw: 1e-5, curvature: 1e-5 };
        let choices = Choices { flat: flat::Settings { precision, ..flat::Settings::default() }, ..Choices::default() };
        let mut met = 0;
        for (start, goal) in &goals {
            let mut steer = |query: &Query| {
                let query = Query::new(query.start_curvature, query.goal, &bounds).ok()?;
                let problem = Problem { query, speed, swing: direction.swing(), free_end: false };
                let solution = generate(&problem, control, &bounds, &choices, || false, |_| {}).solution;
                (solution.outcome == Outcome::Solved).then_some(solution.segments)
            };
            let answer = site.solve(start, goal, &bounds, &rough::Settings::default(), &mut steer);
            if answer.status != rough::Status::Ok {
                println!("{name}: {:?} after {} predictions", answer.status, answer.iterations);
                continue;
            }
            let replay = site.replay(start, goal, &answer.segments).expect("a way");
            let [x, y, yaw] = replay.error;
            let good = x.hypot(y) <= 0.01 && yaw.abs() <= 0.01 && replay.error_curvature.abs() <= 0.01;
            if !good {
                println!("{name}: {replay:?}");
            }
            met += usize::from(good);
        }
        println!("{name}: {met} of {}", goals.len());
        least = least.min(met);
        assert_eq!(goals.len(), 40, "{name}");
    }
    assert!(least >= 36, "{least} of 40");
}

/// ∫κ² ds or ∫κ′² ds of commands.
fn costs(segments: &[Segment], cost: Cost) -> f64 {
    const STEPS: usize = 200;
    let mut sum = 0.0;
    for segment in segments {
        let h = segment.length_m() / STEPS as f64;
        for i in 0..STEPS {
            let s = h * (i as f64 + 0.5);
            let value = match cost {
                Cost::Curvature => segment.curvature_at(s),
                _ => (segment.curvature_at(s + 1e-4) - segment.curvature_at(s - 1e-4)) / 2e-4,
            };
            sum += h * value * value;
        }
    }
    sum
}

#[test]
fn families_with_parameters_to_spare_lower_costs_and_keep_their_goals() {
    let ramp = SpeedProfile::Ramp { start: 0.5, end: 1.5 };
    // Of four parameters to spare more comes than of two; without a cost a drive is the smoothest near its start value
    // already.
    for (control, speed, cost, most) in [
        (Control::Knots, 1.0.into(), Cost::Curvature, 0.99),
        (Control::Knots, 1.0.into(), Cost::Rate, 1.0001),
        (Control::TimePolynomial, ramp, Cost::Curvature, 1.0001),
    ] {
        let (mut count, mut shares) = (0, Vec::new());
        for seed in 0..40 {
            let mut random = stream(seed);
            let (length, shape) = (random.random_range(3.0..10.0), polynomial(&mut random, 3));
            let problem = Made::new(&mut random, length, shape).problem(speed, 0.0);
            let plain = answer(&problem, control);
            let settings = Settings { cost, ..Settings::default() };
            let cheap = solve(&problem, control, &BOUNDS, &settings, &mut || false, &mut |_| {});
            let told = format!("{control:?} {cost:?}, seed {seed}");
            let (Some(before), Some(after)) = (held(&problem, &plain, &told), held(&problem, &cheap, &told)) else {
                continue;
            };
            // Half as long again as the first start value, which need not be the shortest.
            assert!(after < 2.2 * before, "{told}: {after} m, {before} m");
            let share = costs(&cheap.segments, cost) / costs(&plain.segments, cost);
            count += 1;
            // The midpoint rule's own error.
            assert!(share < 1.0 + 1e-3, "{told}: dearer by {share}");
            shares.push(share);
        }
        shares.sort_by(f64::total_cmp);
        println!("{control:?} {cost:?}: {count} lowered, to {:.3} in the median", shares[count / 2]);
        assert!(count >= 38, "{control:?} {cost:?}: {count}");
        assert!(shares[count / 2] < most, "{control:?} {cost:?}: {}", shares[count / 2]);
    }
}
