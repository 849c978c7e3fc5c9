//! The shortest way from two states to a drive: `cargo run --example 01_steer_rover`.

use hairpin::campaign::drive::replay_flat;
use hairpin::feasibility::steering::shooting::solve::{Choices, Outcome, solve};
use hairpin::feasibility::steering::shooting::{Curvatures, Goal, Query, Refusal};
use hairpin::trajectory::drive::Motion;

fn main() -> Result<(), Refusal> {
    let vehicle = Curvatures { most: 1.0, most_rate: 1.0 };
    // One metre ahead, one to the left, turned left by 45°, wheels straight at both ends.
    let goal = Goal { x: 1.0, y: 1.0, yaw: 0.785, curvature: 0.0 };
    let query = Query::new(0.0, goal, &vehicle)?;
    let drive = solve(&query, &vehicle, &Choices { reversals: true, ..Choices::default() }, || false);
    if drive.outcome == Outcome::Solved {
        for segment in drive.segments.iter() {
            match segment.motion {
                Motion::Arc { length_m, curvature } => println!("{:?} {length_m:.3} m, {curvature:.3?}", segment.gear),
                Motion::Turn { angle_rad } => println!("turn by {angle_rad:.3} rad"),
            }
        }
        let replay = replay_flat(&query, 0.0, &drive.segments);
        let [x, y, yaw] = replay.error;
        println!("{:.3} m; replayed, it ends {:.1e} m and {yaw:.1e} rad from the goal", replay.length, x.hypot(y));
    }
    Ok(())
}
