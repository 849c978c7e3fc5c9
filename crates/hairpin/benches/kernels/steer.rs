//! What one boundary-value query on flat ground costs: three families that are feasible by construction, 1–12 m.

use hairpin::feasibility::steering::shooting::flat::{Settings, forward};
use hairpin::feasibility::steering::shooting::{Curvatures, Goal, Query};
use hairpin::math::random::hashed_unit;

const BOUNDS: Curvatures = Curvatures { most: 1.0, most_rate: 1.0 };
const QUERIES: u64 = 10_000;

fn draw(seed: u64, name: u64, from: f64, to: f64) -> f64 {
    from + (to - from) * hashed_unit(seed, &[name])
}

/// The query whose answer is the curve of that length and curvature.
fn query(length: f64, curvature: impl Fn(f64) -> f64) -> Query {
    let steps = 1000;
    let h = length / f64::from(steps);
    let (mut x, mut y, mut yaw) = (0.0, 0.0, 0.0_f64);
    for i in 0..steps {
        let k = curvature((f64::from(i) + 0.5) * h);
        x += h * (yaw + 0.5 * h * k).cos();
        y += h * (yaw + 0.5 * h * k).sin();
        yaw += h * k;
    }
    let end = curvature(length).clamp(-1.0, 1.0);
    Query::new(curvature(0.0).clamp(-1.0, 1.0), Goal { x, y, yaw, curvature: end }, &BOUNDS).expect("a query")
}

/// The factor that brings |κ| and |κ′| within the bounds.
fn scale(length: f64, curvature: impl Fn(f64) -> f64) -> f64 {
    let n = 2000;
    let at = |i: i32| curvature(length * f64::from(i) / f64::from(n));
    let rate = |i: i32| (at(i + 1) - at(i)).abs() * f64::from(n) / length;
    0.999 / (0..n).map(|i| at(i).abs().max(rate(i))).fold(at(n).abs(), f64::max)
}

fn quintic(seed: u64) -> Query {
    let length = draw(seed, 0, 1.0, 12.0);
    let a: [f64; 6] = std::array::from_fn(|k| draw(seed, 1 + k as u64, -1.0, 1.0));
    let raw = |s: f64| {
        let t = (2.0 * s / length - 1.0).clamp(-1.0, 1.0);
        a.iter().enumerate().map(|(k, a)| a * (k as f64 * t.acos()).cos()).sum::<f64>()
    };
    let scale = draw(seed, 9, 0.5, 1.0) * scale(length, raw);
    query(length, |s| scale * raw(s))
}

fn chain(seed: u64) -> Query {
    let length = draw(seed, 0, 1.0, 12.0);
    let mut last = (0.0, draw(seed, 1, -1.0, 1.0));
    let mut knots = vec![last];
    while last.0 < length {
        let step = draw(seed, 10 + 2 * knots.len() as u64, 0.2, 2.0);
        let rate = draw(seed, 11 + 2 * knots.len() as u64, -1.0, 1.0);
        last = (last.0 + step, (last.1 + rate * step).clamp(-1.0, 1.0));
        knots.push(last);
    }
    query(length, |s| {
        let i = knots.iter().position(|knot| knot.0 >= s).unwrap_or(knots.len() - 1).max(1);
        let ((s0, k0), (s1, k1)) = (knots[i - 1], knots[i]);
        k0 + (k1 - k0) * (s - s0) / (s1 - s0)
    })
}

fn sines(seed: u64) -> Query {
    let length = draw(seed, 0, 1.0, 12.0);
    let wave = |i: u64| [draw(seed, 1 + i, -1.0, 1.0), draw(seed, 2 + i, 0.0, 2.0), draw(seed, 3 + i, 0.0, 6.3)];
    let waves = [0, 3, 6, 9].map(wave);
    let raw = |s: f64| waves.iter().map(|[a, w, phase]| a * (w * s + phase).sin()).sum::<f64>();
    let scale = scale(length, raw);
    query(length, |s| scale * raw(s))
}

fn run(bencher: divan::Bencher, family: fn(u64) -> Query) {
    let queries: Vec<Query> = (0..QUERIES).map(family).collect();
    let settings = Settings::default();
    bencher.counter(divan::counter::ItemsCount::new(queries.len())).bench_local(|| {
        for query in &queries {
            divan::black_box(forward(divan::black_box(query), &BOUNDS, &settings));
        }
    });
}

#[divan::bench(sample_count = 20, sample_size = 1)]
fn ten_thousand_quintics(bencher: divan::Bencher) {
    run(bencher, quintic);
}

#[divan::bench(sample_count = 20, sample_size = 1)]
fn ten_thousand_clothoid_chains(bencher: divan::Bencher) {
    run(bencher, chain);
}

#[divan::bench(sample_count = 20, sample_size = 1)]
fn ten_thousand_sums_of_sines(bencher: divan::Bencher) {
    run(bencher, sines);
}
