//! One question from the command line, and drives as the writers take them.

use hairpin::feasibility::steering::shooting::solve::Solution;
use hairpin::trajectory::drive::{Gear, Motion};
use hairpin::verification::trace_drive;
use hairpin_formats::frames::other_yaw;
use hairpin_formats::steering::{Asked, Frame, Piece, Stretch};

use super::answered::{self, claim};
use crate::args::{Steer, SteerFrame};
use crate::problem::Problem;

/// The question of the flags: `--from` and `--to` are poses of one map.
pub(super) fn asked(steer: &Steer, to: &str) -> Result<Asked, Problem> {
    let frame = match steer.frame {
        SteerFrame::Enu => Frame::Enu,
        SteerFrame::Ned => Frame::Ned,
    };
    let from = state("--from", steer.from.as_deref().unwrap_or("0,0,0"), frame)?;
    let free_end = to.split(',').count() == 3;
    let to = state("--to", to, frame)?;
    // From the plain origin the heading is taken as it was typed.
    let turned = to[2] - from[2];
    let plain = frame == Frame::Enu && from == [0.0; 4];
    let [x, y] = seen_from([from[0], from[1], from[2]], [to[0], to[1]]);
    let yaw = if plain { to[2] } else { libm::atan2(libm::sin(turned), libm::cos(turned)) };
    Ok(Asked {
        start: steer.from.is_some().then_some([from[0], from[1], from[2]]),
        goal: [x, y, yaw],
        k0: from[3],
        kf: to[3],
        free_end,
        v0: None,
        vf: None,
        direction: frame.left() * steer.direction,
        direction_end: steer.direction_end.map(|direction| frame.left() * direction),
        frame,
        max_curvature: steer.max_curvature,
        tolerance_m: steer.tolerance_m,
    })
}

/// A place of the map as it is seen from a start (x, y, yaw) on it.
pub(in crate::commands) fn seen_from([x, y, yaw]: [f64; 3], place: [f64; 2]) -> [f64; 2] {
    let (sin, cos) = libm::sincos(yaw);
    let (dx, dy) = (place[0] - x, place[1] - y);
    [cos * dx + sin * dy, cos * dy - sin * dx]
}

/// A goal from the start (x, y, yaw, curvature) as `--to` takes it.
pub(super) fn typed(asked: &Asked, goal: &[f64; 4]) -> [f64; 4] {
    let [x0, y0, yaw0] = asked.start.unwrap_or([0.0; 3]);
    let (sin, cos) = libm::sincos(yaw0);
    let [dx, dy, turned, curvature] = *goal;
    let place = [x0 + cos * dx - sin * dy, y0 + sin * dx + cos * dy, yaw0 + turned];
    let [x, y, yaw] = seen(asked.frame, place);
    [x, y, yaw, asked.frame.left() * curvature]
}

/// x, y and yaw on the map as `frame` has them.
pub(super) fn seen(frame: Frame, [x, y, yaw]: [f64; 3]) -> [f64; 3] {
    match frame {
        Frame::Enu => [x, y, yaw],
        Frame::Ned => [y, x, other_yaw(yaw)],
    }
}

/// X,Y,YAW or X,Y,YAW,CURVATURE in ENU, left positive.
fn state(flag: &str, text: &str, frame: Frame) -> Result<[f64; 4], Problem> {
    let refuse = || Problem::input(format!("{flag} {text}: must be X,Y,YAW or X,Y,YAW,CURVATURE in m, rad, 1/m"));
    let numbers: Option<Vec<f64>> =
        text.split(',').map(|cell| cell.trim().parse().ok().filter(|number: &f64| number.is_finite())).collect();
    let (x, y, yaw, curvature) = match numbers.ok_or_else(refuse)?[..] {
        [x, y, yaw] => (x, y, yaw, 0.0),
        [x, y, yaw, curvature] => (x, y, yaw, curvature),
        _ => return Err(refuse()),
    };
    Ok(match frame {
        Frame::Enu => [x, y, yaw, curvature],
        Frame::Ned => [y, x, other_yaw(yaw), -curvature],
    })
}

/// A drive's segments as files have them.
pub(super) fn pieces(solution: &Solution) -> Vec<Piece> {
    let of = |motion: &Motion, gear: Gear| match *motion {
        Motion::Arc { length_m, curvature } => {
            Piece::Arc { length_m, curvature, direction: if gear == Gear::Forward { 1 } else { -1 } }
        }
        Motion::Turn { angle_rad } => Piece::Turn { angle_rad },
    };
    solution.segments.iter().map(|segment| of(&segment.motion, segment.gear)).collect()
}

/// A drive as it is drawn, in the frame of its start.
pub(super) fn stretches(solution: &Solution, asked: &Asked) -> Vec<Stretch> {
    let drive = answered::pieces(solution);
    let traced = trace_drive(&drive, &claim(asked, &solution.segments, false)).into_iter();
    let drawn = traced.map(|(direction, poses)| Stretch {
        points: poses.iter().map(|[x, y, _]| [*x, *y]).collect(),
        reverse: direction < 0.0,
    });
    drawn.collect()
}
