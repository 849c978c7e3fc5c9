//! One question in poses of a map, and drives as the writers take them.

use hairpin::feasibility::steering::shooting::solve::{Outcome, Solution};
use hairpin::trajectory::drive::{Gear, Motion};
use hairpin::verification::trace_drive;
use hairpin_formats::frames::other_yaw;
use hairpin_formats::steering::{Asked, Frame, Piece, Stretch};

use super::answered::{self, claim};

/// One question: poses of one map, in one frame.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Question {
    /// Start in the map: x, y in m, yaw in rad, curvature in 1/m; its origin if not given.
    pub from: Option<[f64; 4]>,
    /// Goal in the map, likewise.
    pub to: [f64; 4],
    /// Whether the curvature at the goal may be anything where the controls do not need it.
    pub free_end: bool,
    /// Frame of all poses and directions here.
    pub frame: Frame,
    /// Direction of travel in the body, rad.
    pub direction: f64,
    /// The same at the goal, where it turns evenly along the drive.
    pub direction_end: Option<f64>,
    /// Largest |curvature|, 1/m, where it is to be less than the vehicle's.
    pub max_curvature: Option<f64>,
    /// Distance from the goal that counts as there, m.
    pub tolerance_m: Option<f64>,
}

impl Question {
    /// As solvers are asked it.
    pub fn asked(&self) -> Asked {
        let Self { frame, free_end, max_curvature, tolerance_m, .. } = *self;
        let (from, to) = (in_enu(frame, self.from.unwrap_or_default()), in_enu(frame, self.to));
        // From the plain origin the heading is taken as it was given.
        let turned = to[2] - from[2];
        let plain = frame == Frame::Enu && from == [0.0; 4];
        let start = [from[0], from[1], from[2]];
        let [x, y] = seen_from(start, [to[0], to[1]]);
        let yaw = if plain { to[2] } else { libm::atan2(libm::sin(turned), libm::cos(turned)) };
        Asked {
            start: self.from.map(|_| start),
            goal: [x, y, yaw],
            k0: from[3],
            kf: to[3],
            free_end,
            v0: None,
            vf: None,
            direction: frame.left() * self.direction,
            direction_end: self.direction_end.map(|direction| frame.left() * direction),
            frame,
            max_curvature,
            tolerance_m,
        }
    }
}

/// x, y, yaw and curvature of `frame` in ENU, left positive.
fn in_enu(frame: Frame, [x, y, yaw, curvature]: [f64; 4]) -> [f64; 4] {
    match frame {
        Frame::Enu => [x, y, yaw, curvature],
        Frame::Ned => [y, x, other_yaw(yaw), -curvature],
    }
}

/// A place of the map as it is seen from a start (x, y, yaw) on it.
pub fn seen_from([x, y, yaw]: [f64; 3], place: [f64; 2]) -> [f64; 2] {
    let (sin, cos) = libm::sincos(yaw);
    let (dx, dy) = (place[0] - x, place[1] - y);
    [cos * dx + sin * dy, cos * dy - sin * dx]
}

/// A goal from the start (x, y, yaw, curvature) as [`Question::to`] has it.
pub fn goal_in_the_map(asked: &Asked, goal: &[f64; 4]) -> [f64; 4] {
    let [x0, y0, yaw0] = asked.start.unwrap_or([0.0; 3]);
    let (sin, cos) = libm::sincos(yaw0);
    let [dx, dy, turned, curvature] = *goal;
    let place = [x0 + cos * dx - sin * dy, y0 + sin * dx + cos * dy, yaw0 + turned];
    let [x, y, yaw] = in_frame(asked.frame, place);
    [x, y, yaw, asked.frame.left() * curvature]
}

/// x, y and yaw on the map as `frame` has them.
pub fn in_frame(frame: Frame, [x, y, yaw]: [f64; 3]) -> [f64; 3] {
    match frame {
        Frame::Enu => [x, y, yaw],
        Frame::Ned => [y, x, other_yaw(yaw)],
    }
}

/// A drive's segments as files have them, of a drive that starts with the curvature `k0`: one that is there already is
/// an arc of no length.
pub fn pieces(solution: &Solution, k0: f64) -> Vec<Piece> {
    if solution.segments.is_empty() && solution.outcome == Outcome::Solved {
        return vec![Piece::Arc { length_m: 0.0, curvature: [k0, 0.0, 0.0, 0.0, 0.0, 0.0], direction: 1 }];
    }
    let of = |motion: &Motion, gear: Gear| match *motion {
        Motion::Arc { length_m, curvature } => {
            Piece::Arc { length_m, curvature, direction: if gear == Gear::Forward { 1 } else { -1 } }
        }
        Motion::Turn { angle_rad } => Piece::Turn { angle_rad },
    };
    solution.segments.iter().map(|segment| of(&segment.motion, segment.gear)).collect()
}

/// A drive as it is drawn, in the frame of its start.
pub fn stretches(solution: &Solution, asked: &Asked) -> Vec<Stretch> {
    let drive = answered::pieces(solution);
    let traced = trace_drive(&drive, &claim(asked, &solution.segments, false)).into_iter();
    let drawn = traced.map(|(direction, poses)| Stretch {
        points: poses.iter().map(|[x, y, _]| [*x, *y]).collect(),
        reverse: direction < 0.0,
    });
    drawn.collect()
}
