//! What an autopilot has to be told beside a mission: a ceiling, which fences have not, what it does at the fence, how
//! it comes home, and how near a waypoint has to be passed.

use hairpin::campaign::Case;
use hairpin::campaign::kind::Room;
use hairpin::math::rotation::angle_between;
use hairpin_formats::qgc::mission::Autopilot;
use hairpin_formats::qgc::parameters::{Parameter, Value};
use nalgebra::Vector3;

use super::way::Way;

/// What returning home does to the height of a PX4 that nobody told otherwise, and of an ArduPilot, m.
const RETURN_HEIGHT: [f64; 2] = [60.0, 15.0];

/// The limits of one mission.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Limits {
    autopilot: Autopilot,
    flies: bool,
    /// Above home, m.
    ceiling: f64,
    /// Height of returning home, above home, m.
    return_height: f64,
    /// Radius within which a waypoint is reached, m.
    accept: f64,
    /// Waypoint, turn (degrees) and radius (m) of the turn that needs the largest one; `None` of who turns anywhere.
    turn: Option<(usize, f64, f64)>,
}

impl Limits {
    pub(super) fn new(autopilot: Autopilot, room: &Room, (case, way): (&Case, &Way), accept: f64) -> Self {
        let highest = case.waypoints.iter().chain(&way.back).map(|place| place.z).fold(way.home.z, f64::max);
        let ceiling = room.high.z - way.home.z;
        Self {
            autopilot,
            flies: room.flies,
            ceiling,
            return_height: (highest - way.home.z).min((ceiling - room.margin).max(0.0)),
            accept,
            turn: widest_turn(room, case),
        }
    }

    /// As the autopilot calls them.
    pub(super) fn parameters(&self) -> Vec<Parameter> {
        let parameter = |name, value, why: &str| Parameter { name, value, why: why.to_owned() };
        let accept = self.accept_words();
        let ceiling =
            format!("the ceiling of the world, {:.2} m above home: fences of a plan are horizontal", self.ceiling);
        let home = format!(
            "returning climbs to this first; the default of {} m is {} the ceiling",
            self.default_return(),
            if self.default_return() > self.ceiling { "above" } else { "below" }
        );
        match (self.autopilot, self.flies) {
            (Autopilot::Px4, true) => vec![
                parameter("GF_ACTION", Value::Whole(2), "at the fence it stops and holds: returning would climb first"),
                parameter("GF_MAX_VER_DIST", Value::Real(self.ceiling), &ceiling),
                parameter("NAV_ACC_RAD", Value::Real(self.accept), &accept),
                parameter("RTL_RETURN_ALT", Value::Real(self.return_height), &home),
                parameter("RTL_DESCEND_ALT", Value::Real(self.return_height), "no higher than that"),
            ],
            (Autopilot::Px4, false) => vec![
                parameter("GF_ACTION", Value::Whole(2), "at the fence it stops"),
                parameter("NAV_ACC_RAD", Value::Real(self.accept), &accept),
            ],
            (Autopilot::ArduPilot, true) => vec![
                parameter("FENCE_ENABLE", Value::Small(1), "the fence counts"),
                parameter("FENCE_TYPE", Value::Small(5), "ceiling and polygon"),
                parameter("FENCE_ACTION", Value::Small(4), "at the fence it brakes: returning would climb first"),
                parameter("FENCE_ALT_MAX", Value::Real(self.ceiling), &ceiling),
                parameter("WPNAV_RADIUS", Value::Real(100.0 * self.accept), &format!("cm; {accept}")),
                parameter("RTL_ALT", Value::Whole((100.0 * self.return_height).round() as i32), &format!("cm; {home}")),
            ],
            (Autopilot::ArduPilot, false) => vec![
                parameter("FENCE_ENABLE", Value::Small(1), "the fence counts"),
                parameter("FENCE_TYPE", Value::Small(4), "the polygon"),
                parameter("FENCE_ACTION", Value::Small(2), "at the fence it holds"),
                parameter("WP_RADIUS", Value::Real(self.accept), &accept),
            ],
        }
    }

    /// What its user has to know, a sentence each.
    pub(super) fn told(&self, case: &str, flies: bool) -> Vec<String> {
        let mut told = Vec::new();
        if flies {
            told.push(format!(
                "case {case}: the fence of a plan is horizontal; CASE.params has the ceiling, {:.2} m above home, and \
                 {:.2} m to return at, below it ({}'s default is {} m)",
                self.ceiling,
                self.return_height,
                self.autopilot.name(),
                self.default_return()
            ));
        }
        if self.is_too_wide() {
            told.push(format!("case {case}: {}", self.accept_words()));
        }
        told
    }

    fn default_return(&self) -> f64 {
        RETURN_HEIGHT[usize::from(self.autopilot == Autopilot::ArduPilot)]
    }

    fn is_too_wide(&self) -> bool {
        self.turn.is_some_and(|(_, _, radius)| radius > self.accept)
    }

    fn accept_words(&self) -> String {
        let Self { accept, turn, .. } = self;
        let Some((waypoint, degrees, radius)) = turn.filter(|(_, _, radius)| *radius > 0.0) else {
            return format!("a waypoint is reached within {accept} m, as it was executed");
        };
        let verdict =
            if self.is_too_wide() { "wider than the acceptance radius of" } else { "within the acceptance radius of" };
        let needs = if radius.is_finite() {
            format!("needs {radius:.2} m to turn into the next leg")
        } else {
            "has no way into the next leg but reversing".into()
        };
        format!(
            "at waypoint {waypoint} the turn of {degrees:.0}° at the vehicle's least radius {needs}, {verdict} {accept} m"
        )
    }
}

/// The turn that needs the largest acceptance radius: who cannot turn tighter than 1/κ leaves a leg tan(turn/2)/κ
/// before its end.
fn widest_turn(room: &Room, case: &Case) -> Option<(usize, f64, f64)> {
    if room.flies || !room.curvature.is_finite() {
        return None;
    }
    let flat = |from: usize| {
        let way = case.waypoints[from + 1] - case.waypoints[from];
        Vector3::new(way.x, way.y, 0.0)
    };
    let turn = |waypoint: usize| {
        let turn = angle_between(&flat(waypoint - 1), &flat(waypoint));
        let needed = libm::tan(0.5 * turn) / room.curvature;
        (waypoint, turn.to_degrees(), if turn.to_degrees() < 179.0 { needed } else { f64::INFINITY })
    };
    (1..case.waypoints.len().saturating_sub(1)).map(turn).max_by(|a, b| a.2.total_cmp(&b.2))
}
