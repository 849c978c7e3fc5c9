//! Families of controls among places to keep out of, held to a trace of their own.

use std::f64::consts::{PI, TAU};

use hairpin::feasibility::steering::clear::{Hazards, generate};
use hairpin::feasibility::steering::shooting::families::Problem;
use hairpin::feasibility::steering::shooting::solve::{Choices, Outcome};
use hairpin::feasibility::steering::shooting::{Control, Curvatures, Goal, Query};
use hairpin::math::random::hashed_unit;
use hairpin::trajectory::SpeedProfile;
use hairpin::trajectory::drive::{Planar, Segment};
use hairpin::world::terrain::{KeepOut, KeepOutShape, KeepOuts};

const BOUNDS: Curvatures = Curvatures { most: 1.0, most_rate: 1.0 };

fn circle(x: f64, y: f64, radius_m: f64) -> KeepOut {
    KeepOut { name: "rock".into(), shape: KeepOutShape::Circle { center_m: [x, y], radius_m } }
}

fn query(x: f64, y: f64, yaw: f64) -> Query {
    Query { start_curvature: 0.0, goal: Goal { x, y, yaw, curvature: 0.0 } }
}

/// Where a drive forward leads, and the least distance to what is kept out of, by many small steps.
fn traced(segments: &[Segment], keep_outs: &KeepOuts) -> (Planar, f64) {
    let (mut x, mut y, mut yaw) = (0.0_f64, 0.0_f64, 0.0_f64);
    let mut least = keep_outs.distance(x, y);
    for segment in segments {
        let count = (segment.length_m() / 1e-3).ceil().max(1.0);
        let h = segment.length_m() / count;
        for i in 0..count as u64 {
            let bend = segment.curvature_at((i as f64 + 0.5) * h);
            x += h * (yaw + 0.5 * h * bend).cos();
            y += h * (yaw + 0.5 * h * bend).sin();
            yaw += h * bend;
            least = least.min(keep_outs.distance(x, y));
        }
    }
    (Planar { x, y, yaw, curvature: 0.0 }, least)
}

#[test]
fn families_with_parameters_to_spare_go_around_and_those_without_say_so() {
    let ramp = SpeedProfile::Ramp { start: 0.5, end: 1.0 };
    let families = [
        (Control::Knots, 1.0.into(), 0.0, 4),
        (Control::TimePolynomial, ramp, 0.0, 2),
        (Control::VelocityPolynomial, ramp, 0.0, 2),
        (Control::Quintic, 1.0.into(), 0.3, 2),
        (Control::Cubic, 1.0.into(), 0.0, 0),
        (Control::Arc, 1.0.into(), 0.0, 0),
    ];
    for (control, speed, swing, spare) in families {
        let (mut asked, mut clear) = (0, 0);
        for seed in 0..12 {
            let unit = |i: u64| 2.0 * hashed_unit(seed, &[i]) - 1.0;
            let yaw = if control == Control::Arc { 0.0 } else { 0.4 * unit(0) };
            let y = if control == Control::Arc { 0.0 } else { unit(1) };
            let keep_outs =
                KeepOuts::new(vec![circle(3.5 + 0.5 * unit(2), 0.5 * y + 0.2 * unit(3), 0.4)]).expect("a rock");
            let hazards = Hazards { keep_outs: &keep_outs, start: Planar::default(), direction: 0.0, radius: 0.3 };
            let problem = Problem { query: query(7.0, y, yaw), speed, swing, free_end: false };
            assert_eq!(problem.spare(control), spare, "{control:?}");
            let choices = Choices::default();
            let (found, near) = generate(&problem, control, &BOUNDS, &choices, &hazards, || false, |_| {});
            let nothing = KeepOuts::default();
            let open = Hazards { keep_outs: &nothing, ..hazards };
            let (plain, _) = generate(&problem, control, &BOUNDS, &choices, &open, || false, |_| {});
            assert_eq!(found.solution.outcome, Outcome::Solved, "{control:?} {seed}");
            if swing == 0.0 && traced(&plain.solution.segments, &keep_outs).1 > hazards.radius {
                assert_eq!(
                    plain.solution.segments, found.solution.segments,
                    "{control:?} {seed}: nothing is in the way"
                );
                continue;
            }
            asked += 1;
            clear += usize::from(near.is_none());
            if swing == 0.0 {
                // The trace is without a direction that turns.
                let (end, least) = traced(&found.solution.segments, &keep_outs);
                assert!(
                    (end.x - 7.0).hypot(end.y - y) < 0.01 && ((end.yaw - yaw + PI).rem_euclid(TAU) - PI).abs() < 0.01,
                    "{control:?} {seed}: {end:?}"
                );
                assert_eq!(near.is_none(), least >= hazards.radius - 1e-3, "{control:?} {seed}: {least}");
            }
        }
        println!("{control:?}: {clear} of {asked} clear");
        let wanted = if spare == 0 { 0 } else { asked - asked / 4 };
        assert!(asked >= 6 && clear >= wanted && (spare > 0 || clear == 0), "{control:?}: {clear} of {asked}");
    }
}
