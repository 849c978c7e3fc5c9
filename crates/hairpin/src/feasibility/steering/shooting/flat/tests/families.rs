//! Random queries that are feasible by construction are answered, within bounds, and mirrored answers are mirrored.

use super::super::{Control, Cost, Settings, Status, forward, mirror};
use super::{BOUNDS, draw, hold_to_its_word, query_of};
use crate::feasibility::steering::shooting::query::Query;
use crate::math::simd::Simd;

/// Largest of |κ| and |κ′| along a curve, by samples.
fn sharpest(length: f64, curvature: impl Fn(f64) -> f64) -> f64 {
    let n = 4000;
    let at = |i: i32| curvature(length * f64::from(i) / f64::from(n));
    let rate = |i: i32| (at(i + 1) - at(i)).abs() * f64::from(n) / length;
    (0..n).map(|i| at(i).abs().max(rate(i))).fold(at(n).abs(), f64::max) * 1.001
}

/// A polynomial of fifth order, scaled to the bounds.
fn quintic(seed: u64) -> (Query, f64) {
    let length = draw(seed, 0, 1.0, 12.0);
    let a: [f64; 6] = std::array::from_fn(|k| draw(seed, 1 + k as u64, -1.0, 1.0));
    let raw = |s: f64| {
        let t = 2.0 * s / length - 1.0;
        a.iter().enumerate().map(|(k, a)| a * (k as f64 * t.clamp(-1.0, 1.0).acos()).cos()).sum::<f64>()
    };
    let scale = draw(seed, 9, 0.5, 1.0) / sharpest(length, raw);
    (query_of(length, |s| scale * raw(s)), length)
}

/// Curvature piecewise linear, with rates anywhere in ±1.
fn chain(seed: u64) -> (Query, f64) {
    let length = draw(seed, 0, 1.0, 12.0);
    let mut knots = vec![(0.0, draw(seed, 1, -1.0, 1.0))];
    let mut last = knots[0];
    while last.0 < length {
        let step = draw(seed, 10 + 2 * knots.len() as u64, 0.2, 2.0);
        let rate = draw(seed, 11 + 2 * knots.len() as u64, -1.0, 1.0);
        last = (last.0 + step, (last.1 + rate * step).clamp(-1.0, 1.0));
        knots.push(last);
    }
    let curvature = |s: f64| {
        let i = knots.iter().position(|knot| knot.0 >= s).unwrap_or(knots.len() - 1).max(1);
        let ((s0, k0), (s1, k1)) = (knots[i - 1], knots[i]);
        k0 + (k1 - k0) * (s - s0) / (s1 - s0)
    };
    (query_of(length, curvature), length)
}

/// A sum of sines, scaled to the bounds.
fn sines(seed: u64) -> (Query, f64) {
    let length = draw(seed, 0, 1.0, 12.0);
    let waves: [[f64; 3]; 4] = std::array::from_fn(|i| {
        let i = 3 * i as u64;
        [draw(seed, 1 + i, -1.0, 1.0), draw(seed, 2 + i, 0.0, 2.0), draw(seed, 3 + i, 0.0, 6.3)]
    });
    let raw = |s: f64| waves.iter().map(|[a, w, phase]| a * (w * s + phase).sin()).sum::<f64>();
    let scale = 1.0 / sharpest(length, raw);
    (query_of(length, |s| scale * raw(s)), length)
}

/// A query by seed, with the length of the curve that it was made from.
type Family = fn(u64) -> (Query, f64);

const FAMILIES: [(&str, Family); 3] = [("quintic", quintic), ("chain", chain), ("sines", sines)];

#[test]
fn all_feasible_queries_are_answered_within_bounds_and_shortly() {
    for (name, family) in FAMILIES {
        let mut ratios: Vec<f64> = (0..400)
            .map(|seed| {
                let (query, length) = family(seed);
                let answer = forward(&query, &BOUNDS, &Settings::default());
                assert_eq!(answer.status, Status::Ok, "{name}, seed {seed}: {query:?}");
                hold_to_its_word(&answer, &query, &BOUNDS, &format!("{name}, seed {seed}")) / length
            })
            .collect();
        ratios.sort_by(f64::total_cmp);
        assert!(ratios[200] < 1.02 && ratios[360] < 1.3, "{name}: median {}, p90 {}", ratios[200], ratios[360]);
    }
}

#[test]
fn neither_side_nor_machine_changes_a_bit() {
    for (name, family) in FAMILIES {
        for seed in 0..100 {
            let query = family(seed).0;
            let answer = forward(&query, &BOUNDS, &Settings::default());
            let mirrored = forward(&mirror::query(&query), &BOUNDS, &Settings::default());
            assert_eq!(mirror::answer(mirrored), answer, "{name}, seed {seed}");
            let settings = Settings { simd: Simd::Portable, ..Settings::default() };
            assert_eq!(forward(&query, &BOUNDS, &settings), answer, "{name}, seed {seed}");
        }
    }
}

#[test]
fn other_vehicles_are_as_well_served() {
    // Ten times as large: the same curves, ten times as long.
    let bounds = super::Curvatures { most: 0.1, most_rate: 0.01 };
    for seed in 0..100 {
        let mut query = quintic(seed).0;
        query.start_curvature *= 0.1;
        query.goal.curvature *= 0.1;
        query.goal.x *= 10.0;
        query.goal.y *= 10.0;
        let answer = forward(&query, &bounds, &Settings::default());
        assert_eq!(answer.status, Status::Ok, "seed {seed}");
        hold_to_its_word(&answer, &query, &bounds, &format!("seed {seed}"));
    }
}

#[test]
fn costs_fall_and_ends_and_bounds_stay() {
    for (cost, order) in [(Cost::Curvature, 0), (Cost::Rate, 1)] {
        let mut cheaper = 0;
        for seed in 0..100 {
            let query = quintic(seed).0;
            let plain = forward(&query, &BOUNDS, &Settings::default());
            let settings = Settings { cost, iterations: 50, ..Settings::default() };
            let refined = forward(&query, &BOUNDS, &settings);
            assert_eq!(refined.status, Status::Ok, "seed {seed}");
            hold_to_its_word(&refined, &query, &BOUNDS, &format!("{cost:?}, seed {seed}"));
            let [before, after] = [&plain, &refined].map(|answer| path_cost(&answer.segments, order));
            assert!(after <= before * (1.0 + 1e-9), "{cost:?}, seed {seed}: {before} -> {after}");
            cheaper += usize::from(after < 0.99 * before);
        }
        assert!(cheaper > 5, "{cost:?}: {cheaper} of 100 are cheaper");
    }
}

/// ∫κ² or ∫κ′² ds by the midpoint rule.
fn path_cost(segments: &[crate::trajectory::drive::Segment], order: usize) -> f64 {
    let n = 4000;
    let mut sum = 0.0;
    for segment in segments {
        let h = segment.length_m() / f64::from(n);
        for i in 0..n {
            let s = (f64::from(i) + 0.5) * h;
            let value = match order {
                0 => segment.curvature_at(s),
                _ => (segment.curvature_at(s + 0.5 * h) - segment.curvature_at(s - 0.5 * h)) / h,
            };
            sum += value * value * h;
        }
    }
    sum
}

#[test]
fn cubics_say_what_they_exceed() {
    let (mut met, mut over) = (0, 0);
    for seed in 0..400 {
        let query = if seed % 2 == 0 { quintic(seed).0 } else { chain(seed).0 };
        let settings = Settings { control: Control::Cubic, ..Settings::default() };
        let answer = forward(&query, &BOUNDS, &settings);
        assert!(answer.segments.len() <= 1);
        match answer.status {
            Status::Ok => {
                met += 1;
                hold_to_its_word(&answer, &query, &BOUNDS, &format!("seed {seed}"));
                let super::Motion::Arc { curvature, .. } = answer.segments[0].motion else { panic!("an arc") };
                assert!(curvature[4].abs() + curvature[5].abs() < 1e-12, "seed {seed}: {curvature:?}");
            }
            Status::Infeasible { limit, excess } => {
                over += 1;
                let replay = super::replay(&answer.segments, &query);
                assert!(replay.miss.iter().all(|miss| *miss < 1e-3), "seed {seed}: {replay:?}");
                let index = usize::from(limit == super::super::Limit::CurvatureRate);
                assert!((replay.bends[index] - 1.0 - excess).abs() < 1e-3 * (1.0 + excess), "seed {seed}: {replay:?}");
            }
            Status::NotConverged { residual } => {
                let replay = super::replay(&answer.segments, &query);
                assert!((replay.miss[0] - residual).abs() < 1e-6 * (1.0 + residual), "seed {seed}: {replay:?}");
            }
        }
    }
    assert!(met > 100 && over > 5, "{met} met, {over} over a limit");
}

#[test]
fn goals_of_many_radii_are_reached_by_arcs_and_chains() {
    let (mut solved, mut single) = (0, 0);
    for seed in 0..300 {
        // Long curves of low order: 30 to 100 m.
        let length = draw(seed, 0, 30.0, 100.0);
        let (a, b) = (draw(seed, 1, -0.1, 0.1), draw(seed, 2, -0.1, 0.1) / length);
        let query = query_of(length, |s| a + b * s);
        let answer = forward(&query, &BOUNDS, &Settings::default());
        solved += usize::from(answer.status == Status::Ok);
        single += usize::from(answer.segments.len() == 1);
        hold_to_its_word(&answer, &query, &BOUNDS, &format!("seed {seed}"));
    }
    assert!(solved >= 295 && single > 100, "{solved} solved, {single} by one arc");
}
