//! What is said of an arm in its cell.

use nalgebra::{Point3, Vector3};
use serde_json::json;

use super::figure::figure;
use super::{ArmSetup, assumptions, plan};
use crate::campaign::bounds::FARTHEST_M;
use crate::campaign::digits::number;
use crate::campaign::kind::{
    Assumptions, Axis, Drawing, Facts, FrameWords, Handed, Motion, Programs, RobotWords, Say, surface,
};
use crate::campaign::scenario::{ArmMode, Keys, ProgramMethod, Target};
use crate::campaign::{Case, Tally};
use crate::judgement::Clearance;
use crate::robot::arm::Arm;
use crate::simulation::Controlled;
use crate::trajectory::Track;
use crate::world::cell::Region;
use crate::world::{Obstacle, Shape};

/// Below this share of its fastest a joint stands.
const STANDS: f64 = 0.01;

impl Say for ArmSetup {
    /// A tool has no nose and no left side.
    fn robot_words(&self) -> RobotWords<'_> {
        let arm = &self.station.arm;
        // In Cartesian mode no link is looked at.
        let looked_at = self.scenario.generate.mode == ArmMode::Joint && arm.has_stand_ins();
        let words = !self.scenario.world.keep_out_mm.is_empty() && self.scenario.generate.mode == ArmMode::Joint;
        RobotWords {
            name: &arm.name,
            caveat: &arm.caveat,
            estimated: arm.estimated.iter().map(String::as_str).collect(),
            has_sides: false,
            unknown_shapes: match (looked_at, words) {
                (true, true) => Some("link shapes estimated; keep-outs in words hold for the tool alone".into()),
                (true, false) => Some("link shapes estimated".into()),
                (false, true) => Some("keep-outs in words hold for the tool alone".into()),
                (false, false) => None,
            },
            loops: Arm::LOOPS,
            battery: None,
        }
    }

    fn assumptions(&self, cases: &[Case], tally: &Tally) -> Assumptions {
        let (mut said, mut search) = (Assumptions::default(), Vec::new());
        assumptions::claim(self, tally, &mut said.claim);
        assumptions::search(self, cases, tally, &mut search);
        assumptions::act(self, &mut said.act);
        assumptions::verdict(self, &mut said.verdict);
        Assumptions { search: Some(search), ..said }
    }

    fn facts(&self) -> Facts {
        let (tool, moves) = (&self.station.tool, &self.scenario.generate.moves);
        Facts {
            world: format!(
                "{} obstacles and keep-outs, tool `{}` of radius {} mm",
                self.station.cell.parts.len(),
                tool.name,
                number(Some(1e3 * tool.radius))
            ),
            task: format!(
                "{} points, speeds {}, zones {}",
                self.station.points.len(),
                moves.speeds.join(", "),
                moves.zones.join(", ")
            ),
            search: Some(match self.scenario.generate.search.method {
                ProgramMethod::Heaviest => format!(
                    "heaviest path through {} points, cost {}",
                    self.asked_points(),
                    self.scenario.generate.cost.word()
                ),
                ProgramMethod::Worst => {
                    let search = self.scenario.search();
                    let target = search.target.as_ref().map_or("the limits of spec".into(), Target::word);
                    format!(
                        "programs through {} points, by {} executions for {target}",
                        self.asked_points(),
                        self.scenario.searched_executions(),
                    )
                }
            }),
            proven: "proven clear",
            nothing: "no program from home to home".into(),
        }
    }

    /// Arms stand where they stand: their scenarios have no place on Earth.
    fn handed(&self) -> Handed {
        Handed {
            robot: json!(self.scenario.robot),
            world: json!(self.scenario.world),
            external_force: None,
            limits: json!({}),
            frame: FrameWords {
                relative_to: "arm's base",
                world: "cell",
                axes: "",
                nowhere: Some("the arm's base: z up, m; programs are in their work object, mm"),
            },
            start: Point3::origin(),
            farthest: FARTHEST_M,
        }
    }

    fn is_outside(&self, _: &Point3<f64>) -> bool {
        false
    }

    fn posed(&self, case: &Case, planned: Track) -> Track {
        plan::posed(self, case, planned)
    }

    /// The cell around what is drawn: half-spaces, keep-outs in words and what has no surface of its own are left to
    /// the words.
    fn drawing(&self, places: &[Point3<f64>]) -> Drawing {
        let (mut low, mut high) = (Point3::origin(), Point3::origin());
        for place in places {
            (low, high) = (low.inf(place), high.sup(place));
        }
        let mut obstacles = Vec::new();
        for part in &self.station.cell.parts {
            if let Some(bounds) = part.region.bounds() {
                (low, high) = (low.inf(&bounds.min), high.sup(&bounds.max));
            }
            let shape = match &part.region {
                Region::Shape(shape) => Some(shape.clone()),
                // Drawn as the capsule around it: a picture, not a proof.
                Region::Cylinder { a, b, radius } => Some(Shape::Capsule { a: *a, b: *b, radius: *radius }),
                Region::HalfSpace { .. } | Region::Beyond { .. } | Region::Words(_) => None,
            };
            obstacles.extend(shape.map(|shape| surface(&Obstacle { name: part.name.clone(), shape })));
        }
        let margin = Vector3::repeat(0.1);
        Drawing {
            low: low - margin,
            size: high - low + 2.0 * margin,
            obstacles,
            rotors: Vec::new(),
            wheels: Vec::new(),
            radius: self.station.tool.radius,
            relief: None,
            figure: Some(figure(&self.station)),
            done: "moved",
        }
    }

    /// Joint × place in its range × speed × direction of every sample, reversals with the speed that they came from.
    fn motion(&self) -> Motion<'_> {
        Motion {
            axes: vec![
                Axis::worded("joint", &["1", "2", "3", "4", "5", "6"]),
                Axis::even("place in range", "%", 0.0, 100.0, 8),
                Axis::even("speed", "% of limit", 0.0, 100.0, 4),
                Axis::worded("direction", &["rising", "falling", "reversing"]),
            ],
            meet: Box::new(|_, flight, meet| joints_met(self, &flight.track, meet)),
        }
    }

    /// What is proven clear of an arm's plan is not measured again along its recordings.
    fn clearance(&self) -> Option<Box<Clearance<'_>>> {
        None
    }

    fn programs(&self) -> Option<&dyn Programs> {
        Some(self)
    }
}

/// Every sample of every joint that moves, and where it turns back the fastest that it was on the way there.
///
/// Rates are differences between neighbouring samples, rad/s, as shares of the joint's limit. What is met are bins
/// of \[joint + ½, % of the range, % of the fastest, direction\]: 0.5 rising, 1.5 falling, 2.5 a reversal, which
/// counts with the fastest speed of the stroke before it. Samples slower than 1 % of the limit count for nothing and
/// end no stroke. Joints without a channel are left out.
fn joints_met(setup: &ArmSetup, track: &Track, meet: &mut dyn FnMut(&[f64])) {
    let times = track.times();
    for (axis, limit, angles) in setup.joints(track) {
        let place = |angle: f64| 100.0 * (angle - limit.lower) / (limit.upper - limit.lower);
        // The direction of the stroke, +1 or −1, and the largest share of the joint's fastest in it.
        let (mut direction, mut fastest) = (0.0, 0.0_f64);
        for i in 1..times.len().min(angles.len()) {
            let rate = (angles[i] - angles[i - 1]) / (times[i] - times[i - 1]);
            let speed = rate.abs() / limit.speed;
            if speed < STANDS {
                continue;
            }
            let (at, joint) = (place(angles[i]), axis as f64 - 0.5);
            if direction * rate < 0.0 {
                meet(&[joint, at, 100.0 * fastest, 2.5]);
                fastest = 0.0;
            }
            (direction, fastest) = (rate.signum(), fastest.max(speed));
            meet(&[joint, at, 100.0 * speed, if rate > 0.0 { 0.5 } else { 1.5 }]);
        }
    }
}
