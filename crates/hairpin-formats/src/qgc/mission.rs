//! A mission as both of its file formats say it: commands of MAVLink, one after the other, about a stated home.

use crate::frames::Geodetic;

/// Frames of MAVLink's commands.
const MISSION: u8 = 2;
const RELATIVE_ALTITUDE: u8 = 3;

/// Whose mission it is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Autopilot {
    /// PX4.
    #[default]
    Px4,
    /// ArduPilot: Copter, or Rover.
    ArduPilot,
}

/// What carries it out.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Vehicle {
    /// A multirotor.
    Multirotor,
    /// A rover or a boat: QGroundControl has one class for them.
    Ground,
}

/// A mission.
#[derive(Debug, Clone, PartialEq)]
pub struct Mission {
    /// Whose.
    pub autopilot: Autopilot,
    /// What carries it out.
    pub vehicle: Vehicle,
    /// Where it begins, on the ground: heights are above it.
    pub home: Geodetic,
    /// What is done, in its order.
    pub steps: Vec<Step>,
    /// Corners of what must not be left, one after the other.
    pub fence: Vec<Geodetic>,
    /// Speed to plan for, m/s, where one is known.
    pub speed: Option<f64>,
    /// What has to be said of it, by key.
    pub note: Vec<(&'static str, String)>,
}

/// One thing that is done.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Step {
    /// Rises to the height of a place above where it stands.
    TakeOff {
        /// Where to.
        place: Geodetic,
        /// Heading, degrees from north, clockwise.
        yaw: Option<f64>,
    },
    /// Goes on at this speed over ground, m/s.
    Speed(f64),
    /// Goes on in this gear: backwards, or forwards.
    Reverse(bool),
    /// Goes to a place and on from there.
    Waypoint {
        /// The place.
        place: Geodetic,
        /// Within which it is reached, m.
        accept: f64,
        /// Heading there; `None`: as the vehicle's mode has it.
        yaw: Option<f64>,
    },
    /// Lands at a place.
    Land {
        /// The place, on the ground.
        place: Geodetic,
        /// Heading.
        yaw: Option<f64>,
    },
}

/// A command of MAVLink as a mission's item has it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Item {
    pub(super) command: u16,
    pub(super) frame: u8,
    /// The first four; `None` leaves it to the vehicle.
    pub(super) numbers: [Option<f64>; 4],
    /// Latitude, longitude and height above home of what is at a place.
    pub(super) place: Option<[f64; 3]>,
}

impl Autopilot {
    /// `MAV_AUTOPILOT`.
    pub fn firmware(self) -> u8 {
        match self {
            Self::Px4 => 12,
            Self::ArduPilot => 3,
        }
    }

    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Px4 => "PX4",
            Self::ArduPilot => "ArduPilot",
        }
    }
}

impl Vehicle {
    /// `MAV_TYPE`, the one that stands for QGroundControl's class.
    pub fn kind(self) -> u8 {
        match self {
            Self::Multirotor => 2,
            Self::Ground => 10,
        }
    }
}

impl Mission {
    /// The items that stand for its steps.
    pub(super) fn items(&self) -> Vec<Item> {
        let at = |place: &Geodetic| Some([place.lat_deg, place.lon_deg, place.alt_amsl_m - self.home.alt_amsl_m]);
        let item = |step: &Step| match step {
            Step::TakeOff { place, yaw } => Item {
                command: 22,
                frame: RELATIVE_ALTITUDE,
                numbers: [Some(0.0), Some(0.0), Some(0.0), *yaw],
                place: at(place),
            },
            // 1: speed over ground; -1: the throttle stays.
            Step::Speed(speed) => Item {
                command: 178,
                frame: MISSION,
                numbers: [Some(1.0), Some(*speed), Some(-1.0), Some(0.0)],
                place: None,
            },
            Step::Reverse(backwards) => Item {
                command: 194,
                frame: MISSION,
                numbers: [Some(f64::from(u8::from(*backwards))), Some(0.0), Some(0.0), Some(0.0)],
                place: None,
            },
            // No time to hold, and nothing to pass beside.
            Step::Waypoint { place, accept, yaw } => Item {
                command: 16,
                frame: RELATIVE_ALTITUDE,
                numbers: [Some(0.0), Some(*accept), Some(0.0), *yaw],
                place: at(place),
            },
            Step::Land { place, yaw } => Item {
                command: 21,
                frame: RELATIVE_ALTITUDE,
                numbers: [Some(0.0), Some(0.0), Some(0.0), *yaw],
                place: at(place),
            },
        };
        self.steps.iter().map(item).collect()
    }
}

/// Degrees as files have them: ten decimals are a hundredth of a millimetre.
pub(super) fn degrees(value: f64) -> String {
    format!("{value:.10}")
}

/// Metres and all other numbers.
pub(super) fn number(value: f64) -> String {
    format!("{:.5}", value + 0.0)
}
