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
    /// Height of returning home, above home, m, or why there is none; `None` of what does not fly.
    returning: Option<Result<f64, &'static str>>,
    /// Radius within which a waypoint is reached, m.
    accept: f64,
    /// Waypoint, turn (degrees) and radius (m) of the turn that needs the largest one; `None` of who turns anywhere.
    turn: Option<(usize, f64, f64)>,
}

impl Limits {
    /// Of `case` as it is flown by `way`, and may be left at the height `returning`, in the world.
    pub(super) fn new(
        autopilot: Autopilot,
        room: &Room,
        (case, way, returning): (&Case, &Way, Option<Result<f64, &'static str>>),
        accept: f64,
    ) -> Self {
        Self {
            autopilot,
            flies: room.flies,
            ceiling: room.high.z - way.home.z,
            returning: returning.map(|height| height.map(|height| above_home(height, room, way))),
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
        let own = match (self.autopilot, self.flies) {
            (Autopilot::Px4, true) => vec![
                parameter("GF_ACTION", Value::Whole(2), "at the fence it stops and holds: returning would climb first"),
                parameter("GF_MAX_VER_DIST", Value::Real(self.ceiling), &ceiling),
                parameter("NAV_ACC_RAD", Value::Real(self.accept), &accept),
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
            ],
            (Autopilot::ArduPilot, false) => vec![
                parameter("FENCE_ENABLE", Value::Small(1), "the fence counts"),
                parameter("FENCE_TYPE", Value::Small(4), "the polygon"),
                parameter("FENCE_ACTION", Value::Small(2), "at the fence it holds"),
                parameter("WP_RADIUS", Value::Real(self.accept), &accept),
            ],
        };
        own.into_iter().chain(self.homeward()).collect()
    }

    /// How it comes home by itself; nothing where no height is safe.
    fn homeward(&self) -> Vec<Parameter> {
        let Some(Ok(height)) = self.returning else { return Vec::new() };
        let parameter = |name, value, why: &str| Parameter { name, value, why: why.to_owned() };
        let home = format!(
            "returning climbs to this first, which clears all obstacles of the world on a straight way home from anywhere \
             on the mission; the default of {} m is {} the ceiling",
            self.default_return(),
            if self.default_return() > self.ceiling { "above" } else { "below" }
        );
        let cone = "no cone: near home it would climb less, and meet what this height clears";
        match self.autopilot {
            Autopilot::Px4 => vec![
                parameter("RTL_RETURN_ALT", Value::Real(height), &home),
                parameter("RTL_DESCEND_ALT", Value::Real(height), "no higher than that"),
                parameter("RTL_CONE_ANG", Value::Whole(0), cone),
            ],
            Autopilot::ArduPilot => vec![
                parameter("RTL_ALT", Value::Whole((100.0 * height - 1e-6).ceil() as i32), &format!("cm; {home}")),
                parameter("RTL_CONE_SLOPE", Value::Real(0.0), cone),
            ],
        }
    }

    /// How a failsafe may come home, in a sentence's part; `None` of what does not fly.
    pub(super) fn return_words(&self) -> Option<String> {
        Some(return_words(self.autopilot, self.returning?))
    }

    /// What its user has to know, a sentence each.
    pub(super) fn told(&self, case: &str) -> Vec<String> {
        let mut told = Vec::new();
        if let Some(returning) = self.returning {
            let height = match returning {
                Ok(height) => format!(
                    ", and {height:.2} m to return at, below it and clear of all obstacles from anywhere on the mission \
                     ({}'s default is {} m)",
                    self.autopilot.name(),
                    self.default_return()
                ),
                Err(_) => String::new(),
            };
            told.push(format!(
                "case {case}: the fence of a plan is horizontal; CASE.params has the ceiling, {:.2} m above home{height}",
                self.ceiling
            ));
            told.extend(returning.err().and_then(|_| Some(format!("case {case}: {}", self.return_words()?))));
        }
        if self.is_too_wide() {
            told.push(format!("case {case}: {}", self.accept_words()));
        }
        told
    }

    fn default_return(&self) -> f64 {
        default_return(self.autopilot)
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

/// The height `height` (m, world frame) above home, m: up to the next whole centimetre, which all files and words of it
/// have, for below it something stands; never above the ceiling.
pub(super) fn above_home(height: f64, room: &Room, way: &Way) -> f64 {
    let [exact, ceiling] = [height, room.high.z].map(|z| z - way.home.z);
    ((100.0 * exact - 1e-6).ceil() / 100.0).min(ceiling.max(exact))
}

fn default_return(autopilot: Autopilot) -> f64 {
    RETURN_HEIGHT[usize::from(autopilot == Autopilot::ArduPilot)]
}

/// At which height above home (m) a failsafe may come home, in a sentence's part.
pub(super) fn return_words(autopilot: Autopilot, height: Result<f64, &'static str>) -> String {
    match height {
        Ok(height) => format!(
            "{height:.2} m above home clears all obstacles of the world on a straight way home from anywhere on the mission"
        ),
        Err(why) => format!(
            "no height is set to return at: {why}; {}'s own, {} m by default, is not safe here: let failsafes land or \
             hold, not return",
            autopilot.name(),
            default_return(autopilot)
        ),
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

#[cfg(test)]
mod tests {
    use hairpin::campaign::CaseNumber;
    use nalgebra::Point3;

    use super::*;

    #[test]
    fn a_height_of_returning_is_set_where_there_is_one() {
        let room = Room {
            flies: true,
            low: Point3::origin(),
            high: Point3::new(60.0, 60.0, 30.0),
            margin: 2.0,
            curvature: f64::INFINITY,
            speed: None,
            fastest: f64::INFINITY,
            timed: true,
            vehicles: &[0],
        };
        let case = Case::bare(CaseNumber(0), 1, vec![Point3::new(5.0, 5.0, 5.0), Point3::new(15.0, 47.0, 8.0)]);
        let way = Way { home: Point3::new(5.0, 5.0, 1.0), back: Vec::new(), land: None, blocked: None };
        let of = |autopilot, height| Limits::new(autopilot, &room, (&case, &way, Some(height)), 1.0);
        let set = |limits: &Limits| -> Vec<(&str, Value)> {
            let all = limits.parameters();
            all.iter().filter(|one| one.name.starts_with("RTL_")).map(|one| (one.name, one.value)).collect()
        };
        let over = of(Autopilot::Px4, Ok(20.32));
        let height = Value::Real(19.32);
        let wanted = [("RTL_RETURN_ALT", height), ("RTL_DESCEND_ALT", height), ("RTL_CONE_ANG", Value::Whole(0))];
        assert_eq!(set(&over), wanted, "above home");
        assert!(over.told("0000")[0].contains("19.32 m to return at"), "{:?}", over.told("0000"));
        let wanted = [("RTL_ALT", Value::Whole(1932)), ("RTL_CONE_SLOPE", Value::Real(0.0))];
        assert_eq!(set(&of(Autopilot::ArduPilot, Ok(20.32))), wanted);
        // To the nearest centimetre it would be below what it clears.
        assert_eq!(set(&of(Autopilot::ArduPilot, Ok(20.321)))[0], ("RTL_ALT", Value::Whole(1933)));
        assert_eq!(set(&of(Autopilot::Px4, Ok(20.321)))[0], ("RTL_RETURN_ALT", Value::Real(19.33)));
        assert!(of(Autopilot::Px4, Ok(20.321)).told("0000")[0].contains("19.33 m to return at"));
        assert_eq!(set(&of(Autopilot::Px4, Ok(29.999)))[0], ("RTL_RETURN_ALT", Value::Real(29.0)), "the ceiling");
        for autopilot in [Autopilot::Px4, Autopilot::ArduPilot] {
            let none = of(autopilot, Err("a beam hangs there"));
            assert_eq!(set(&none), []);
            let told = none.told("0000").join("\n");
            let words = "case 0000: no height is set to return at: a beam hangs there; ";
            assert!(told.contains(words) && none.return_words().is_some_and(|words| told.contains(&words)), "{told}");
        }
    }
}
