//! What became of the legs that were asked for, so that an empty answer has its reasons.

use std::fmt;

/// Why a leg is none, in the order in which it is found out.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum LegRefusal {
    /// Every drive within the bounds of curvature is longer than the longest detour.
    Detour,
    /// The solver found no drive within the bounds of curvature whose motion ends there.
    Unsolved,
    /// The drive leaves the map.
    MapEdge,
    /// The drive meets cells without data.
    NoData,
    /// The suspension finds no rest somewhere on the way.
    NoRest,
    /// The path bends more than allowed.
    Curvature,
    /// At the commanded speed the direction of travel turns faster than the wheels are steered.
    Steering,
    /// The wheels would need more torque than they have.
    Torque,
    /// A wheel is steered farther than its joint goes.
    SteerAngle,
    /// A wheel is steered faster than its joint turns.
    SteerRate,
    /// A wheel turns faster than it may.
    WheelSpeed,
    /// A wheel's speed changes faster than it may.
    WheelAcceleration,
    /// The body tilts more than allowed.
    Tilt,
    /// A rocker or bogie turns more than allowed.
    Joint,
    /// The body's underside comes nearer to the ground than allowed.
    Belly,
    /// The drive enters a keep-out.
    KeepOut,
}

impl LegRefusal {
    /// All, in order.
    pub const ALL: [Self; 16] = [
        Self::Detour,
        Self::Unsolved,
        Self::MapEdge,
        Self::NoData,
        Self::NoRest,
        Self::Curvature,
        Self::Steering,
        Self::Torque,
        Self::SteerAngle,
        Self::SteerRate,
        Self::WheelSpeed,
        Self::WheelAcceleration,
        Self::Tilt,
        Self::Joint,
        Self::Belly,
        Self::KeepOut,
    ];

    /// What it says of a leg, as in "12 …".
    ///
    /// In the plural, without the number.
    pub fn says(self) -> &'static str {
        match self {
            Self::Detour => "would need a longer way round than allowed",
            Self::Unsolved => "have no drive within the bounds of curvature that was found",
            Self::MapEdge => "leave the map",
            Self::NoData => "meet cells without data",
            Self::NoRest => "pass places where the wheels find no rest",
            Self::Curvature => "bend more than allowed",
            Self::Steering => "turn their direction of travel faster than the wheels are steered",
            Self::Torque => "need more torque than the wheels have",
            Self::SteerAngle => "steer a wheel farther than `robot.wheels.steer_limit_deg`",
            Self::SteerRate => "steer a wheel faster than `robot.wheels.steer_rate_deg_s`",
            Self::WheelSpeed => "turn a wheel faster than `robot.wheels.speed_rad_s`",
            Self::WheelAcceleration => "change a wheel's speed faster than `robot.wheels.acceleration_rad_s2`",
            Self::Tilt => "tilt more than allowed",
            Self::Joint => "turn a joint more than allowed",
            Self::Belly => "come too near to the ground with their underside",
            Self::KeepOut => "enter a keep-out",
        }
    }
}

/// Legs of one graph by what became of them.
///
/// asked = feasible + Σ refused.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct DriveTally {
    /// Pairs of headed waypoints at a leg's distance that were asked for.
    pub asked: u64,
    /// Those that are legs.
    pub feasible: u64,
    /// Boundary-value problems that were solved for them, or tried.
    pub solves: u64,
    refused: [u64; LegRefusal::ALL.len()],
}

impl DriveTally {
    /// Legs refused for `reason`. Each refused leg has one reason: of the ways of driving it, the one that came
    /// farthest.
    pub fn refused(&self, reason: LegRefusal) -> u64 {
        self.refused[reason as usize]
    }

    /// The sum of both.
    pub fn add(&mut self, other: &Self) {
        self.asked += other.asked;
        self.feasible += other.feasible;
        self.solves += other.solves;
        for (sum, more) in self.refused.iter_mut().zip(other.refused) {
            *sum += more;
        }
    }

    /// One leg and what became of it.
    pub(super) fn count<T>(&mut self, outcome: &Result<T, LegRefusal>) {
        self.asked += 1;
        match outcome {
            Ok(_) => self.feasible += 1,
            Err(reason) => self.refused[*reason as usize] += 1,
        }
    }
}

impl fmt::Display for DriveTally {
    /// "of 40 legs 3 are feasible; 20 tilt more than allowed, 17 leave the map".
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.asked == 0 {
            return write!(f, "no two waypoints are at a leg's distance");
        }
        write!(f, "of {} legs {} are feasible", self.asked, self.feasible)?;
        let mut reasons = LegRefusal::ALL.map(|reason| (self.refused(reason), reason));
        reasons.sort_by_key(|(count, _)| std::cmp::Reverse(*count));
        for (index, (count, reason)) in reasons.iter().filter(|(count, _)| *count > 0).enumerate() {
            write!(f, "{} {count} {}", if index == 0 { ";" } else { "," }, reason.says())?;
        }
        Ok(())
    }
}
