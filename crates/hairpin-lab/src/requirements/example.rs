//! The source's example program, in its frame and in ours.

use hairpin::campaign::drive::replay_flat;
use hairpin::feasibility::steering::shooting::solve::{Choices, Outcome, Solution, solve};
use hairpin::feasibility::steering::shooting::{Goal, Query};
use hairpin::robot::rover::Rover;
use hairpin::trajectory::drive::Motion;
use hairpin::verification::DriveReplay;
use hairpin_formats::scenario::rover_for;
use hairpin_jobs::Problem;
use serde_json::{Value, json};

use super::subject::bounds;
use crate::drives::MET;
use crate::findings::Words;

/// The source's terminal state: x forward, y right (m), yaw clockwise (rad).
const SOURCE: [f64; 3] = [1.0, 1.0, 0.785];

/// The example, solved.
pub(super) struct Example {
    rover: Rover,
    solution: Solution,
    replay: DriveReplay,
}

impl Example {
    pub(super) fn new() -> Result<Self, Problem> {
        let rover = rover_for("generic")?;
        let [x, right, clockwise] = SOURCE;
        let goal = Goal { x, y: -right, yaw: -clockwise, curvature: 0.0 };
        let query = Query::new(0.0, goal, &bounds(&rover)).map_err(Problem::input)?;
        let solution = solve(&query, &bounds(&rover), &Choices::default(), || false);
        let replay = replay_flat(&query, 0.0, &solution.segments);
        Ok(Self { rover, solution, replay })
    }

    pub(super) fn solved(&self) -> bool {
        let [x, y, yaw] = self.replay.error;
        self.solution.outcome == Outcome::Solved && libm::hypot(x, y) <= MET && yaw.abs() <= MET
    }

    /// Name and value in the source's frame and in ours.
    fn rows(&self) -> Vec<[String; 3]> {
        let row = |name: &str, source: f64, ours: f64| [name.to_owned(), format!("{source:.6}"), format!("{ours:.6}")];
        let [x, right, clockwise] = SOURCE;
        let mut rows = vec![
            row("goal x, m", x, x),
            row("goal y, m", right, -right),
            row("goal yaw, rad", clockwise, -clockwise),
            row("speed, m/s", self.rover.default_speed, self.rover.default_speed),
        ];
        for (number, segment) in self.solution.segments.iter().enumerate() {
            let Motion::Arc { length_m, curvature } = segment.motion else { continue };
            rows.push(row(&format!("segment {number}: length, m"), length_m, length_m));
            for (order, a) in curvature.iter().enumerate().filter(|(_, a)| **a != 0.0) {
                rows.push(row(&format!("segment {number}: a{order}, 1/m^{}", order + 1), -a, *a));
            }
        }
        let [ex, ey, eyaw] = self.replay.error;
        let error =
            |name: &str, source: f64, ours: f64| [name.to_owned(), format!("{source:.1e}"), format!("{ours:.1e}")];
        rows.push(error("replay: error of x, m", ex, ex));
        rows.push(error("replay: error of y, m", -ey, ey));
        rows.push(error("replay: error of yaw, rad", -eyaw, eyaw));
        rows
    }

    pub(super) fn words(&self) -> [Words; 2] {
        let mut table = vec![vec!["".into(), "x forward, y right, z down".into(), "x forward, y left, z up".into()]];
        table.extend(self.rows().into_iter().map(Vec::from));
        let outcome = if self.solved() { "solved" } else { "NOT SOLVED" };
        [Words::Table(table), Words::Text(format!("{outcome} in {} iterations", self.solution.iterations))]
    }

    pub(super) fn object(&self) -> Value {
        let rows: Vec<Value> = self
            .rows()
            .into_iter()
            .map(|[name, source, ours]| json!({ "name": name, "right_down": source, "left_up": ours }))
            .collect();
        json!({ "solved": self.solved(), "rows": rows })
    }
}
