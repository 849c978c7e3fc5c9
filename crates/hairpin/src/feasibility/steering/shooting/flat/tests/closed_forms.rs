//! Curves that are known in closed form: lines, circles, clothoids by Fresnel's integrals.

use std::f64::consts::PI;

use super::super::{Control, Cost, Limit, Settings, Status, crab, forward, miss, turn_drive_turn};
use super::{BOUNDS, Goal, Query, hold_to_its_word, integrate};
use crate::math::simd::Simd;
use crate::trajectory::drive::{Gear, Motion, Segment};

fn query(start: f64, x: f64, y: f64, yaw: f64, end: f64) -> Query {
    Query::new(start, Goal { x, y, yaw, curvature: end }, &BOUNDS).expect("a query")
}

/// ∫₀ᴸ (cos, sin)(½ σ s²) ds by their power series.
fn fresnel(sigma: f64, length: f64) -> (f64, f64) {
    let z = 0.5 * sigma * length * length;
    let (mut cos, mut sin, mut term) = (0.0, 0.0, length);
    for n in 0..60 {
        let share = term / f64::from(2 * n + 1);
        match n % 4 {
            0 => cos += share,
            1 => sin += share,
            2 => cos -= share,
            _ => sin -= share,
        }
        term *= z / f64::from(n + 1);
    }
    (cos, sin)
}

#[test]
fn ahead_is_a_straight_line() {
    let answer = forward(&query(0.0, 5.0, 0.0, 0.0, 0.0), &BOUNDS, &Settings::default());
    assert_eq!((answer.status, answer.segments.len()), (Status::Ok, 1));
    let segment = answer.segments[0];
    assert!((segment.length_m() - 5.0).abs() < 1e-4);
    assert!((0..=10).all(|i| segment.curvature_at(0.5 * f64::from(i)).abs() < 1e-12));
}

#[test]
fn the_least_change_of_curvature_is_the_circle() {
    let (k, turn) = (0.5_f64, 1.2_f64);
    let goal = query(k, turn.sin() / k, (1.0 - turn.cos()) / k, turn, k);
    let settings = Settings { cost: Cost::Rate, iterations: 50, ..Settings::default() };
    let answer = forward(&goal, &BOUNDS, &settings);
    assert_eq!(answer.status, Status::Ok);
    let segment = answer.segments[0];
    assert!((segment.length_m() - turn / k).abs() < 1e-3, "{segment:?}");
    for i in 0..=20 {
        let s = segment.length_m() * f64::from(i) / 20.0;
        assert!((segment.curvature_at(s) - k).abs() < 3e-3, "{segment:?}");
    }
}

#[test]
fn the_judge_integrates_clothoids_like_fresnel() {
    for (sigma, length) in [(0.4, 2.0), (1.0, 1.0), (-0.3, 5.0), (0.05, 9.0)] {
        let (x, y) = fresnel(sigma, length);
        let goal = Query {
            start_curvature: 0.0,
            goal: Goal { x, y, yaw: 0.5 * sigma * length * length, curvature: sigma * length },
        };
        let whole = [Segment::clothoid(length, 0.0, sigma * length, Gear::Forward)];
        let halves = [
            Segment::clothoid(0.4 * length, 0.0, 0.4 * sigma * length, Gear::Forward),
            Segment::clothoid(0.6 * length, 0.4 * sigma * length, sigma * length, Gear::Forward),
        ];
        for segments in [&whole[..], &halves[..]] {
            let missed = miss::miss(Simd::Widest, segments, &goal);
            assert!(
                missed.position < 1e-12 && missed.yaw.abs() < 1e-12 && missed.curvature.abs() < 1e-12,
                "{missed:?}"
            );
        }
        let moved =
            Query { goal: Goal { x: x + 0.3, y: y - 0.4, yaw: goal.goal.yaw + 0.1 + 4.0 * PI, ..goal.goal }, ..goal };
        let missed = miss::miss(Simd::Widest, &whole, &moved);
        assert!((missed.position - 0.5).abs() < 1e-12 && (missed.yaw + 0.1).abs() < 1e-12, "{missed:?}");
    }
}

#[test]
fn ends_of_clothoids_are_reached_by_curves_no_longer() {
    for (sigma, length) in [(0.4, 2.0), (0.9, 1.0), (-0.3, 3.0)] {
        let (x, y) = fresnel(sigma, length);
        let goal = query(0.0, x, y, 0.5 * sigma * length * length, sigma * length);
        let answer = forward(&goal, &BOUNDS, &Settings::default());
        assert_eq!(answer.status, Status::Ok, "{sigma}");
        assert!(hold_to_its_word(&answer, &goal, &BOUNDS, "a clothoid") < 1.01 * length);
    }
}

#[test]
fn single_arcs_say_what_they_cannot_choose() {
    let settings = Settings { control: Control::Arc, ..Settings::default() };
    let solve = |goal: &Query| forward(goal, &BOUNDS, &settings);
    let (k, turn) = (-0.8_f64, -4.0_f64);
    let (x, y) = (turn.sin() / k, (1.0 - turn.cos()) / k);
    let answer = solve(&query(k, x, y, turn, k));
    assert_eq!(answer.status, Status::Ok);
    assert!((answer.segments[0].length_m() - turn / k).abs() < 1e-12);
    hold_to_its_word(&answer, &query(k, x, y, turn, k), &BOUNDS, "an arc");
    let limit = |goal: &Query| match solve(goal).status {
        Status::Infeasible { limit, excess } => (limit, (excess * 1e6).round() / 1e6),
        other => panic!("{other:?}"),
    };
    assert_eq!(limit(&query(k, x, y, turn + 0.3, k)), (Limit::Yaw, 0.3));
    assert_eq!(limit(&query(k, x, y, turn, 0.0)), (Limit::EndCurvature, 0.8));
    assert_eq!(limit(&query(0.0, 0.0, 0.5, PI, 0.0)), (Limit::Curvature, 3.0));
    assert_eq!(solve(&query(0.0, -2.0, 0.0, 0.0, 0.0)).status, Status::NotConverged { residual: 2.0 });
    assert_eq!(solve(&query(0.0, 3.0, 0.0, 0.0, 0.0)).segments[0].length_m(), 3.0);
}

#[test]
fn turn_drive_turn_ends_at_the_goal() {
    for (x, y, yaw) in [(3.0, 4.0, 0.5), (-1.0, -2.0, 3.0), (0.0, 0.0, -1.0), (-2.0, 0.0, 7.0), (2.0, 0.0, 0.0)] {
        let goal = Goal { x, y, yaw, curvature: 0.0 };
        let segments = turn_drive_turn(&goal);
        let missed = miss::miss(Simd::Widest, &segments, &Query { start_curvature: 0.0, goal });
        assert!(missed.position < 1e-12 && missed.yaw.abs() < 1e-12, "{goal:?}: {missed:?}");
        for segment in segments.iter() {
            assert!(!matches!(segment.motion, Motion::Turn { angle_rad } if angle_rad.abs() > PI + 1e-12));
        }
    }
    assert_eq!(turn_drive_turn(&Goal { x: 2.0, y: 0.0, yaw: 0.0, curvature: 0.0 }).len(), 1);
}

#[test]
fn crab_drives_end_at_the_goal() {
    for (direction, length) in [(0.4, 3.0), (-1.2, 5.0), (PI / 2.0, 2.0), (PI, 4.0)] {
        let curvature = |s: f64| 0.5 * (0.9 * s + 0.3).sin();
        let [x, y, yaw] = integrate(length, direction, curvature);
        let goal = query(curvature(0.0), x, y, yaw, curvature(length));
        let answer = forward(&crab(&goal, direction), &BOUNDS, &Settings::default());
        assert_eq!(answer.status, Status::Ok, "{direction}");
        let (mut at, mut heading) = ([0.0, 0.0], 0.0);
        for segment in answer.segments.iter() {
            let [dx, dy, turn] = integrate(segment.length_m(), direction, |s| segment.curvature_at(s));
            let (sin, cos) = f64::sin_cos(heading);
            at = [at[0] + cos * dx - sin * dy, at[1] + sin * dx + cos * dy];
            heading += turn;
        }
        assert!(f64::hypot(at[0] - x, at[1] - y) < 1e-4, "{direction}: {at:?} for {x}, {y}");
        assert!((libm::remainder(heading - yaw, 2.0 * PI)).abs() < 1e-6);
    }
}
