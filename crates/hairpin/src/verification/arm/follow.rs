//! One move followed from sample to sample.

use nalgebra::Isometry3;

use super::course::{Course, apart};
use super::posture::Asked;
use super::{Arm, Wrong};

/// Samples of a straight move are this near, m and rad; of a joint move this, rad.
const STEP: [f64; 3] = [2e-3, 0.01, 0.01];
/// Samples of a move at most.
const MOST_SAMPLES: f64 = 1e5;
/// A turn of 1 rad counts as much as this way, m (docs/virtual-controller.md): 10 mm to 1.5°.
const WAY_OF_A_TURN: f64 = 0.01 / (1.5 * std::f64::consts::PI / 180.0);
/// Chords of a joint move that tell the way and turn of its tool (ibid.).
const CHORDS: usize = 8;

/// A move, and the joint angles that lead its tool along it.
///
/// `stands` are dense enough that Newton finds any share between two of them.
#[derive(Debug, Clone)]
pub(super) struct Leg {
    course: Course,
    /// `link6_from_tcp`.
    tool: Isometry3<f64>,
    /// At equal shares, rad.
    stands: Vec<[f64; 6]>,
}

impl Leg {
    /// Joint angles where it begins.
    pub(super) fn begin(&self) -> &[f64; 6] {
        &self.stands[0]
    }

    /// Joint angles where it ends.
    pub(super) fn end(&self) -> &[f64; 6] {
        &self.stands[self.stands.len() - 1]
    }

    /// `link6_from_tcp`.
    pub(super) fn tool(&self) -> &Isometry3<f64> {
        &self.tool
    }

    /// Where its tool is to be, of a move of the tool.
    pub(super) fn pose(&self, share: f64) -> Option<Isometry3<f64>> {
        match &self.course {
            Course::Joints(_) => None,
            Course::Tool(course) => Some(course.at(share)),
        }
    }
}

impl Arm<'_> {
    /// Follows `course` with a tool (`link6_from_tcp`) from the angles `begun`.
    ///
    /// Samples every 2 mm, 0.01 rad of turning or 0.01 rad of the axis that moves most. A move of the tool is followed
    /// by Newton from each sample to the next, so that no branch of the inverse is ever chosen, only kept.
    ///
    /// # Errors
    /// Where it cannot be followed.
    pub(super) fn follow(&self, course: Course, tool: Isometry3<f64>, begun: &[f64; 6]) -> Result<Leg, Wrong> {
        let steps = match &course {
            Course::Joints([from, to]) => largest(from, to) / STEP[2],
            Course::Tool(course) => (course.way() / STEP[0]).max(course.turn() / STEP[1]),
        };
        let count = steps.ceil().clamp(1.0, MOST_SAMPLES) as usize;
        let share = |sample: usize| sample as f64 / count as f64;
        let mut stands = Vec::with_capacity(count + 1);
        match &course {
            Course::Joints(ends) => stands.extend((0..=count).map(|sample| between(ends, share(sample)))),
            Course::Tool(course) => {
                let mut q = *begun;
                for sample in 0..=count {
                    let way = [share(sample.saturating_sub(1)), share(sample)];
                    let led = self.lead(course, &tool, &q, way);
                    q = led.ok_or_else(|| (share(sample), "the tool cannot be led on".to_owned()))?;
                    stands.push(q);
                }
            }
        }
        Ok(Leg { course, tool, stands })
    }

    /// The first thing that does not hold on a leg.
    ///
    /// Its share of the leg and what it is; at the samples alone.
    pub(super) fn first_wrong(&self, leg: &Leg, asked: &Asked) -> Option<Wrong> {
        // Joints pass singularities.
        let singularity = if matches!(leg.course, Course::Joints(_)) { 0.0 } else { asked.singularity };
        let asked = Asked { singularity, ..*asked };
        let last = (leg.stands.len() - 1) as f64;
        let mut stands = leg.stands.iter().enumerate();
        stands.find_map(|(sample, q)| self.wrong_at(&asked, q).map(|what| (sample as f64 / last, what)))
    }

    /// Joint angles at a share of a leg.
    ///
    /// Led on from the nearest sample; `None` where Newton loses the way.
    pub(super) fn stand(&self, leg: &Leg, share: f64) -> Option<[f64; 6]> {
        match &leg.course {
            Course::Joints(ends) => Some(between(ends, share)),
            Course::Tool(course) => {
                let last = leg.stands.len() - 1;
                let near = ((share * last as f64).round() as usize).min(last);
                self.lead(course, &leg.tool, &leg.stands[near], [near as f64 / last as f64, share])
            }
        }
    }

    /// What a leg adds to the path's parameter, m: its way or its turns, whichever counts for more.
    ///
    /// max(way, 0.01 m/1.5° · turn): a move of the tool by its own way and turn, one in joints by eight chords of its
    /// tool's way, their turns, or the largest turn of a joint.
    pub(super) fn length(&self, leg: &Leg) -> f64 {
        let (way, turn) = match &leg.course {
            Course::Tool(course) => (course.way(), course.turn()),
            Course::Joints(ends) => {
                let places: Vec<Isometry3<f64>> =
                    (0..=CHORDS).map(|i| self.place(&leg.tool, &between(ends, i as f64 / CHORDS as f64))).collect();
                let chords = places.windows(2).map(|pair| apart(&pair[0], &pair[1]));
                let (way, turn) = chords.fold((0.0, 0.0), |sum, chord| (sum.0 + chord.0, sum.1 + chord.1));
                (way, turn.max(largest(&ends[0], &ends[1])))
            }
        };
        way.max(WAY_OF_A_TURN * turn)
    }

    /// `base_from_tcp` at joint angles.
    pub(super) fn place(&self, tool: &Isometry3<f64>, q: &[f64; 6]) -> Isometry3<f64> {
        self.screws.carried(q).link(&self.screws, 6) * tool
    }
}

/// All joints in step.
fn between([from, to]: &[[f64; 6]; 2], share: f64) -> [f64; 6] {
    std::array::from_fn(|k| (1.0 - share) * from[k] + share * to[k])
}

/// Largest turn of a joint, rad.
fn largest(from: &[f64; 6], to: &[f64; 6]) -> f64 {
    (0..6).map(|k| (to[k] - from[k]).abs()).fold(0.0, f64::max)
}
