//! An answer, and what its replay holds it to.

use std::time::Duration;

use hairpin::campaign::drive::drive_piece;
use hairpin::feasibility::steering::clear::Intrusion;
use hairpin::feasibility::steering::shooting::Control;
use hairpin::feasibility::steering::shooting::families::{Parameters, Problem};
use hairpin::feasibility::steering::shooting::query::Curvatures;
use hairpin::feasibility::steering::shooting::solve::Solution;
use hairpin::trajectory::SpeedProfile;
use hairpin::trajectory::drive::Segment;
use hairpin::verification::{DriveClaim, DrivePiece, DriveReplay};
use hairpin::world::terrain::{KeepOuts, NoGround};
use hairpin_formats::steering::{Asked, Status};

use super::pace::direction;

/// An answer before it is put into a file or into words.
pub struct Answered {
    /// Whether there is one.
    pub status: Status,
    /// Without one where the question has no answer.
    pub drive: Option<(Solution, DriveReplay)>,
    /// What solving took.
    pub solving: Duration,
    /// What stands in the way; its excess in its unit.
    pub limit: Option<(&'static str, Option<f64>)>,
    /// Which place to keep out of that is.
    pub near: Option<Near>,
    /// The drive that the ground lets go no further, and after how many metres.
    pub stopped: Option<Box<(Solution, f64)>>,
    /// Where that is for want of ground: the place.
    pub(super) no_ground: Option<NoGround>,
    /// The bounds that were in force.
    pub bounds: Curvatures,
    /// Curvatures that would be feasible, where those asked for are not.
    pub nearest: Option<[f64; 2]>,
    /// Its speeds; without them where they make no profile.
    pub profile: Option<SpeedProfile>,
    /// The controls' own parameters, and by how much the segments differ from them in curvature, 1/m.
    pub parameters: Option<(Parameters, f64)>,
    /// What the drive costs by the measure that was asked for.
    pub cost: Option<f64>,
}

impl Answered {
    /// Without a drive.
    pub(super) fn new(
        status: Status,
        limit: Option<(&'static str, Option<f64>)>,
        bounds: Curvatures,
        solving: Duration,
    ) -> Self {
        let (drive, near, stopped, nearest, profile) = (None, None, None, None, None);
        let (no_ground, parameters, cost) = (None, None, None);
        Self { status, drive, solving, limit, near, stopped, no_ground, bounds, nearest, profile, parameters, cost }
    }
}

impl Answered {
    /// By how much the replay misses the goal's place, m.
    pub fn missed_m(&self) -> Option<f64> {
        let (_, DriveReplay { error: [x, y, _], .. }) = self.drive.as_ref()?;
        Some(libm::hypot(*x, *y))
    }
}

/// A place to keep out of that a drive comes too near to.
#[derive(Debug, Clone, PartialEq)]
pub struct Near {
    /// Its name.
    pub place: String,
    /// What is missing to stay clear, m.
    pub depth: f64,
    /// Metres driven before.
    pub after_m: f64,
    /// Parameters that the family has to spare for going around it; `None` for the default, which has chains of
    /// clothoids.
    pub spare: Option<u32>,
}

impl Near {
    pub(super) fn new(intrusion: &Intrusion, keep_outs: &KeepOuts, control: Control, problem: &Problem) -> Self {
        let place = keep_outs.list().get(intrusion.place).map_or_else(String::new, |place| place.name.clone());
        let default = control == Control::Quintic && problem.swing == 0.0;
        let spare = (!default).then(|| problem.spare(control));
        Self { place, depth: intrusion.depth, after_m: intrusion.after_m, spare }
    }

    /// As a limit, with what it is exceeded by.
    pub(super) fn limit(&self) -> (&'static str, Option<f64>) {
        ("keep_out", Some(self.depth))
    }
}

/// What the replay holds a drive to; with `free_end` its last curvature is as it comes.
pub(super) fn claim(asked: &Asked, segments: &[Segment], free_end: bool) -> DriveClaim {
    let length: f64 = segments.iter().map(Segment::length_m).sum();
    let direction = direction(asked);
    let last = segments.last().map_or(asked.k0, |last| last.curvature_at(last.length_m()));
    DriveClaim {
        start_curvature: asked.k0,
        crab: direction.start,
        crab_rate: direction.rate(length),
        end: asked.goal,
        end_curvature: if free_end { last } else { asked.kf },
    }
}

/// A drive as plain numbers.
pub(super) fn pieces(solution: &Solution) -> Vec<DrivePiece> {
    solution.segments.iter().map(drive_piece).collect()
}
