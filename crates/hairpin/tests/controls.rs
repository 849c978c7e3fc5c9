//! Every family of controls, every kind of speed and direction: goals that are feasible by construction are all met, by the
//! replay's own equations, within 1 cm, 0.01 rad, 0.01 1/m and the bounds.

use std::f64::consts::{PI, TAU};

use hairpin::feasibility::steering::shooting::families::{Answer, Problem, Settings, solve};
use hairpin::feasibility::steering::shooting::flat::Status;
use hairpin::feasibility::steering::shooting::{Control, Curvatures, Goal, Query};
use hairpin::math::random::{Stream, stream};
use hairpin::trajectory::SpeedProfile;
use hairpin::trajectory::drive::{Motion, Segment};
use hairpin::verification::{DriveClaim, DrivePiece, DriveReplay, replay_drive};
use rand::RngExt;

const BOUNDS: Curvatures = Curvatures { most: 1.0, most_rate: 1.0 };

/// A curve: κ over the share of its metres, κ at the ends exactly, metres.
struct Made {
    curvature: Vec<f64>,
    length: f64,
}

const SAMPLES: usize = 4001;

impl Made {
    /// κ = `shape` over the share σ of the metres, scaled so that the bounds hold with some room.
    fn new(random: &mut Stream, length: f64, shape: impl Fn(f64) -> f64) -> Self {
        let raw: Vec<f64> = (0..SAMPLES).map(|i| shape(i as f64 / (SAMPLES - 1) as f64)).collect();
        let h = length / (SAMPLES - 1) as f64;
        let rate = raw.windows(2).map(|pair| (pair[1] - pair[0]).abs() / h).fold(0.0, f64::max);
        let sharpest = raw.iter().map(|k| k.abs()).fold(rate, f64::max) * 1.002;
        let scale = random.random_range(0.4..1.0) / sharpest;
        Self { curvature: raw.iter().map(|k| k * scale).collect(), length }
    }

    /// Where it ends, x, y, ψ, with a direction of travel that turns evenly from 0 to `swing`: Simpson's rule.
    fn end(&self, swing: f64) -> [f64; 3] {
        let h = 2.0 * self.length / (SAMPLES - 1) as f64;
        let [mut x, mut y, mut yaw] = [0.0; 3];
        for (i, k) in self.curvature.windows(3).step_by(2).enumerate() {
            let s = i as f64 * h;
            let way = |s: f64| swing * s / self.length;
            let middle = yaw + h / 24.0 * (5.0 * k[0] + 8.0 * k[1] - k[2]);
            let last = yaw + h / 6.0 * (k[0] + 4.0 * k[1] + k[2]);
            let at = [yaw + way(s), middle + way(s + 0.5 * h), last + way(s + h)];
            x += h / 6.0 * (at[0].cos() + 4.0 * at[1].cos() + at[2].cos());
            y += h / 6.0 * (at[0].sin() + 4.0 * at[1].sin() + at[2].sin());
            yaw = last;
        }
        [x, y, yaw]
    }

    fn problem(&self, speed: SpeedProfile, swing: f64) -> Problem {
        let [x, y, yaw] = self.end(swing);
        let goal = Goal { x, y, yaw: yaw.rem_euclid(TAU), curvature: self.curvature[SAMPLES - 1] };
        let query = Query::new(self.curvature[0], goal, &BOUNDS).unwrap();
        Problem { query, speed, swing, free_end: false }
    }
}

/// A sum of Chebyshev polynomials up to `order`, of u in [0, 1].
fn polynomial(random: &mut Stream, order: usize) -> impl Fn(f64) -> f64 + use<> {
    let a: Vec<f64> = (0..=order).map(|_| random.random_range(-1.0..1.0)).collect();
    move |u: f64| {
        let angle = (2.0 * u - 1.0).clamp(-1.0, 1.0).acos();
        a.iter().enumerate().map(|(k, a)| a * (k as f64 * angle).cos()).sum()
    }
}

/// The natural cubic spline through `y` at even places of [0, 1], by dense elimination of its bends.
fn spline(y: &[f64]) -> impl Fn(f64) -> f64 + use<> {
    let n = y.len() - 1;
    let h = 1.0 / n as f64;
    let mut rows = vec![vec![0.0; n + 2]; n + 1];
    (rows[0][0], rows[n][n]) = (1.0, 1.0);
    for k in 1..n {
        (rows[k][k - 1], rows[k][k], rows[k][k + 1]) = (1.0, 4.0, 1.0);
        rows[k][n + 1] = 6.0 * (y[k - 1] - 2.0 * y[k] + y[k + 1]) / (h * h);
    }
    for k in 0..=n {
        for other in 0..=n {
            if other != k {
                let (factor, lead) = (rows[other][k] / rows[k][k], rows[k].clone());
                rows[other].iter_mut().zip(&lead).for_each(|(value, lead)| *value -= factor * lead);
            }
        }
    }
    let bends: Vec<f64> = (0..=n).map(|k| rows[k][n + 1] / rows[k][k]).collect();
    let y = y.to_vec();
    move |u| {
        let k = ((u / h) as usize).min(n - 1);
        let (right, left) = (u / h - k as f64, k as f64 + 1.0 - u / h);
        let bent = |t: f64, m: f64| (t.powi(3) - t) * h * h / 6.0 * m;
        left * y[k] + right * y[k + 1] + bent(left, bends[k]) + bent(right, bends[k + 1])
    }
}

/// The share of the time at a share of the metres, by bisection of the speed's own integral.
fn time_share(speed: impl Fn(f64) -> f64, share: f64) -> f64 {
    let metres = |u: f64| (0..400).map(|i| speed((f64::from(i) + 0.5) / 400.0 * u) * u / 400.0).sum::<f64>();
    let whole = metres(1.0);
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..50 {
        let middle = 0.5 * (low + high);
        if metres(middle) < share * whole { low = middle } else { high = middle }
    }
    0.5 * (low + high)
}

/// Time shares at the samples of a curve.
fn time_shares(speed: impl Fn(f64) -> f64) -> impl Fn(f64) -> f64 {
    let table: Vec<f64> = (0..=200).map(|i| time_share(&speed, f64::from(i) / 200.0)).collect();
    move |share: f64| {
        // The table is a start; one step of Newton's method from it would do, interpolation of third order does, too.
        let at = (share * 200.0).clamp(0.0, 200.0);
        let k = (at as usize).clamp(1, 198);
        let t = at - k as f64;
        let [a, b, c, d] = [table[k - 1], table[k], table[k + 1], table[k + 2]];
        -t * (t - 1.0) * (t - 2.0) / 6.0 * a + (t + 1.0) * (t - 1.0) * (t - 2.0) / 2.0 * b
            - (t + 1.0) * t * (t - 2.0) / 2.0 * c
            + (t + 1.0) * t * (t - 1.0) / 6.0 * d
    }
}

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

/// Makes and solves `count` problems; panics unless all are met, and most not much longer than the curve they were made from.
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
    // u of v² = v0² + (vf² − v0²) σ.
    let share = |sigma: f64| {
        let v = f64::sqrt(start * start + (end * end - start * start) * sigma);
        sigma * (start + end) / (start + v)
    };
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
        let share = time_shares(speed);
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
