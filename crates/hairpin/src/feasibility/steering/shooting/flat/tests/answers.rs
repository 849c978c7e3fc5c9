//! Budgets, corners and numbers that make no sense: answers stay true and nothing panics.

use super::super::{Control, Settings, Status, forward};
use super::{BOUNDS, Curvatures, Goal, Query, draw, hold_to_its_word};

fn query(start: f64, x: f64, y: f64, yaw: f64, end: f64) -> Query {
    Query { start_curvature: start, goal: Goal { x, y, yaw, curvature: end } }
}

#[test]
fn where_one_is_needs_no_drive() {
    for yaw in [0.0, std::f64::consts::TAU, -2.0 * std::f64::consts::TAU] {
        let answer = forward(&query(0.3, 0.0, 0.0, yaw, 0.3), &BOUNDS, &Settings::default());
        assert_eq!((answer.status, answer.segments.len(), answer.iterations), (Status::Ok, 0, 0));
    }
}

#[test]
fn any_pose_has_a_way() {
    // Beside, behind, on the spot: forward only, so some of it is loops, but all within bounds.
    let mut failed = 0;
    for seed in 0..1000 {
        let [x, y] = [0, 1].map(|k| draw(seed, k, -4.0, 4.0));
        let goal = query(draw(seed, 2, -1.0, 1.0), x, y, draw(seed, 3, -3.2, 3.2), draw(seed, 4, -1.0, 1.0));
        let answer = forward(&goal, &BOUNDS, &Settings::default());
        if answer.status == Status::Ok {
            hold_to_its_word(&answer, &goal, &BOUNDS, &format!("seed {seed}"));
        } else {
            failed += 1;
        }
    }
    assert!(failed <= 5, "{failed} of 1000 failed");
}

#[test]
fn budgets_bound_the_steps() {
    let goal = query(0.0, 0.5, 2.0, 2.5, 0.0);
    for (iterations, starts) in [(0, 0), (0, 8), (1, 1), (3, 2), (20, 8)] {
        for control in [Control::Cubic, Control::Quintic] {
            let settings = Settings { iterations, starts, control, ..Settings::default() };
            let answer = forward(&goal, &BOUNDS, &settings);
            assert!(
                answer.iterations <= 2 * iterations * starts.min(6),
                "{iterations} {starts}: {}",
                answer.iterations
            );
            if iterations == 0 {
                assert!(matches!(answer.status, Status::NotConverged { residual } if residual > 0.01), "{answer:?}");
            }
        }
    }
}

#[test]
fn nonsense_is_never_ok() {
    let odd = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, -1.0, 0.0, 1e-300, 1e300];
    for (i, &most) in odd.iter().enumerate() {
        for &rate in &odd {
            for goal in [
                query(0.0, 2.0, 1.0, 0.5, 0.0),
                query(odd[i], 2.0, odd[i], 1.0, 0.0),
                query(0.0, 1.0, 1.0, odd[i], 0.1),
            ] {
                let bounds = Curvatures { most, most_rate: rate };
                let answer = forward(&goal, &bounds, &Settings::default());
                let sane = most > 0.0 && rate > 0.0 && [goal.goal.y, goal.goal.yaw].iter().all(|v| v.is_finite());
                assert!(sane || answer.status != Status::Ok, "{bounds:?} {goal:?}: {answer:?}");
            }
        }
    }
}

#[test]
fn far_goals_take_long_straight_middles() {
    for (x, y, yaw) in [(30.0, 3.0, 2.0), (-20.0, 10.0, 0.4), (25.0, -30.0, -1.0)] {
        let goal = query(0.8, x, y, yaw, -0.5);
        let answer = forward(&goal, &BOUNDS, &Settings::default());
        assert_eq!(answer.status, Status::Ok, "{goal:?}: {answer:?}");
        let distance = f64::hypot(x, y);
        assert!(hold_to_its_word(&answer, &goal, &BOUNDS, "far") < 1.05 * distance + 8.0);
    }
}
