//! The ways of driving a leg, and the flat drives of each: what the controls are, which gears there are, what turns in
//! place do.

use std::f64::consts::TAU;

use super::settings::{DriveSettings, Manoeuvres};
use crate::feasibility::steering::shooting::families::Problem;
use crate::feasibility::steering::shooting::solve::{Choices, Outcome, solve};
use crate::feasibility::steering::shooting::{Control, Curvatures, Query, flat, generate};
use crate::trajectory::drive::{Gear, Motion, Segment, SegmentList};

/// One way of driving a leg.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Way {
    /// In one gear, by the controls of the settings.
    Along(Gear),
    /// Forward and in reverse, by lines, arcs and clothoids.
    Reversals,
    /// Turns in place before and after a line.
    TurnDriveTurn(Gear),
    /// A turn in place, and the arc that then arrives in the heading; the wheels swing where the vehicle stands.
    TurnArc(Gear),
}

impl Way {
    /// The way that `segments` are driven, as far as they tell: changes of gear that a way may have and does not need
    /// leave no trace.
    ///
    /// Turns are asked first, then changes of gear. Where nothing is driven the gear is the settings'.
    pub(super) fn of(settings: &DriveSettings, segments: &[Segment]) -> Self {
        let turns = segments.iter().any(|segment| matches!(segment.motion, Motion::Turn { .. }));
        let mut gears = segments.iter().filter(|segment| segment.length_m() > 0.0).map(|segment| segment.gear);
        let gear = gears.next().unwrap_or_else(|| settings.gear());
        match (turns, settings.control) {
            (true, Control::Arc) => Self::TurnArc(gear),
            (true, _) => Self::TurnDriveTurn(gear),
            (false, _) if gears.any(|other| other != gear) => Self::Reversals,
            (false, _) => Self::Along(gear),
        }
    }

    /// Whether it drives in one gear and does not turn in place.
    pub(super) fn gear(self) -> Option<Gear> {
        if let Self::Along(gear) = self { Some(gear) } else { None }
    }

    /// The flat drive of `query`, whose direction of travel turns by `swing` (rad): where the controls do not know of
    /// that, as one that looks along the mean direction.
    ///
    /// `query` is in the frame of the start. `None` where it is none within the bounds, or the solver finds no answer.
    pub(super) fn steer(self, settings: &DriveSettings, query: &Query, swing: f64) -> Option<SegmentList> {
        let bounds = &settings.bounds;
        let query = Query::new(query.start_curvature, query.goal, bounds).ok()?;
        let mean = if swing == 0.0 { query } else { flat::crab(&query, 0.5 * swing) };
        let plain = Choices { flat: settings.flat, families: settings.families, ..Choices::default() };
        let solution = match self {
            Self::Along(gear) => {
                let problem = Problem { query, speed: settings.speed.into(), swing, free_end: false };
                let choices = Choices { gear, ..plain };
                generate(&problem, settings.control, bounds, &choices, || false, |_| {}).solution
            }
            Self::Reversals => solve(&mean, bounds, &Choices { reversals: true, arcs: false, ..plain }, || false),
            Self::TurnDriveTurn(gear) => {
                solve(&mean, bounds, &Choices { gear, turns: true, arcs: false, ..plain }, || false)
            }
            Self::TurnArc(gear) => return turn_arc(&mean, bounds, gear),
        };
        (solution.outcome == Outcome::Solved).then_some(solution.segments)
    }
}

/// The ways of driving, in the order in which they are tried.
///
/// Cheapest manoeuvre first: forward, reverse, changes of gear, turns in place.
pub(super) fn ways(settings: &DriveSettings) -> impl Iterator<Item = Way> {
    let Manoeuvres { forward, reverse, turn_in_place } = settings.manoeuvres;
    let along = !matches!(settings.control, Control::Arc | Control::TurnDriveTurn);
    let arcs = settings.control == Control::Arc;
    let gear = settings.gear();
    [
        (along && forward, Way::Along(Gear::Forward)),
        (along && reverse, Way::Along(Gear::Reverse)),
        // Other controls than the default do not change gear on the way.
        (settings.control == Control::Quintic && forward && reverse, Way::Reversals),
        (!arcs && turn_in_place, Way::TurnDriveTurn(gear)),
        (arcs && turn_in_place, Way::TurnArc(gear)),
        (arcs && turn_in_place && forward && reverse, Way::TurnArc(gear.opposite())),
    ]
    .into_iter()
    .filter_map(|(allowed, way)| allowed.then_some(way))
}

/// Turns by α and follows the circle through start and goal that arrives in the goal's heading ψ.
///
/// With β the bearing of the goal and d its distance: η = ψ − β, α = β − η, κ = 2 sin η/d, L = d η/sin η. The circle's
/// curvature ends with the turn of no angle behind it, where the wheels swing back.
///
/// Frame of the start, x ahead. Three segments: a turn of α in [−π, π], the arc, and a turn of 0. `None` for a goal in
/// the start's place, κ beyond the bound, or an arc of more than 1.8 π. The rate of curvature is not asked: wheels
/// swing at rest.
fn turn_arc(query: &Query, bounds: &Curvatures, gear: Gear) -> Option<SegmentList> {
    // In reverse, the mirror image about the y axis.
    let sign = gear.sign();
    let goal = &query.goal;
    let (x, yaw) = (sign * goal.x, sign * goal.yaw);
    let distance = libm::hypot(x, goal.y);
    let bearing = libm::atan2(goal.y, x);
    let half = libm::remainder(yaw - bearing, TAU);
    let curvature = 2.0 * libm::sin(half) / distance;
    if distance == 0.0 || !(curvature.abs() <= bounds.most && half.abs() <= LARGEST_HALF) {
        return None;
    }
    let length_m = if half.abs() < 1e-6 { distance } else { distance * half / libm::sin(half) };
    let turn = |angle_rad: f64| Segment { motion: Motion::Turn { angle_rad: sign * angle_rad }, gear: Gear::Forward };
    let mut segments = SegmentList::EMPTY;
    let arc = Segment { gear, ..Segment::clothoid(length_m, curvature, curvature, gear) };
    [turn(libm::remainder(bearing - half, TAU)), arc, turn(0.0)].into_iter().for_each(|segment| segments.add(segment));
    Some(segments)
}

/// Half of the largest turn of an arc, rad: nine tenths of a circle go round their chord by a long way.
const LARGEST_HALF: f64 = 0.9 * std::f64::consts::PI;

#[cfg(feature = "unit-tests")]
mod tests {
    use super::*;
    use crate::feasibility::steering::shooting::Goal;

    /// Where `segments` lead in the plane, by fine steps.
    fn end(segments: &[Segment]) -> [f64; 3] {
        let [mut x, mut y, mut yaw] = [0.0_f64; 3];
        for segment in segments {
            yaw += segment.turn_rad();
            let h = segment.gear.sign() * segment.length_m() / 5000.0;
            for i in 0..5000 {
                let bend = segment.curvature_at(segment.length_m() * (f64::from(i) + 0.5) / 5000.0);
                let middle = yaw + 0.5 * h * bend;
                (x, y, yaw) = (x + h * middle.cos(), y + h * middle.sin(), yaw + h * bend);
            }
        }
        [x, y, yaw]
    }

    #[test]
    fn a_turn_and_an_arc_arrive_in_every_heading_there_is_one_for() {
        let bounds = Curvatures { most: 1.0, most_rate: 1.0 };
        let mut found = 0;
        for gear in [Gear::Forward, Gear::Reverse] {
            for i in 0..60 {
                let (bearing, yaw) = (0.37 * f64::from(i), 0.91 * f64::from(i));
                let goal = Goal { x: 3.0 * bearing.cos(), y: 3.0 * bearing.sin(), yaw, curvature: 0.0 };
                let Some(segments) = turn_arc(&Query { start_curvature: 0.0, goal }, &bounds, gear) else { continue };
                found += 1;
                let [x, y, turned] = end(&segments);
                let off = libm::remainder(turned - yaw, TAU);
                assert!((x - goal.x).abs() + (y - goal.y).abs() + off.abs() < 1e-6, "{gear:?} {i}: {x} {y} {off}");
                assert!(segments.iter().filter(|s| s.length_m() > 0.0).all(|s| s.gear == gear));
            }
        }
        // All but those that would go nearly all the way round.
        assert!(found > 100, "{found}");
        let close = Goal { x: 0.5, y: 0.0, yaw: 1.5, curvature: 0.0 };
        assert_eq!(turn_arc(&Query { start_curvature: 0.0, goal: close }, &bounds, Gear::Forward), None);
    }
}
