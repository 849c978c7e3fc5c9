//! What a leg of a boat must keep to, and the evidence when it does not.

/// Limits that a task adds to those of the boat and the waters.
///
/// `max_speed` is over ground, so that a current ahead slows nothing that it forbids.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BoatLimits {
    /// Largest speed over ground, m/s; infinite: no cap.
    pub max_speed: f64,
    /// Share of the thrusters' limits that plans use, in (0, 1]: what is left is the controller's.
    pub thrust_share: f64,
}

impl Default for BoatLimits {
    fn default() -> Self {
        Self { max_speed: f64::INFINITY, thrust_share: 1.0 }
    }
}

/// What can be violated. Signed margins: ≥ 0 is feasible.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum BoatLimit {
    /// The speed over ground, m/s.
    Speed,
    /// The force ahead or astern, N.
    Surge,
    /// The force to the sides, N.
    Sway,
    /// The moment, N·m.
    Yaw,
    /// The keep-in margin of the waters, m.
    Waters,
    /// The clearance to a place to keep out of, m.
    KeepOut,
    /// The duration of a leg, s.
    Duration,
}

impl BoatLimit {
    /// All, in the order in which they are told.
    pub const ALL: [Self; 7] =
        [Self::Speed, Self::Surge, Self::Sway, Self::Yaw, Self::Waters, Self::KeepOut, Self::Duration];

    /// The name in reports, and the unit of its margin.
    ///
    /// Units are those of the margins of [`BoatInfeasible`].
    pub fn name_and_unit(self) -> (&'static str, &'static str) {
        match self {
            Self::Speed => ("speed", "m/s"),
            Self::Surge => ("surge force", "N"),
            Self::Sway => ("sway force", "N"),
            Self::Yaw => ("yaw moment", "N m"),
            Self::Waters => ("keep-in margin", "m"),
            Self::KeepOut => ("clearance", "m"),
            Self::Duration => ("duration", "s"),
        }
    }
}

/// Why a leg is refused.
///
/// `Violates` is a fact about the leg; `Unproven` is one about the effort: the leg may be feasible, and is refused.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum BoatInfeasible {
    /// A limit is violated at `at`, s since the leg began: its signed margin is below 0.
    Violates {
        /// Which limit.
        limit: BoatLimit,
        /// When, s.
        at: f64,
        /// How far inside, < 0.
        margin: f64,
    },
    /// The bound between samples did not decide within its budget.
    Unproven {
        /// The limit that came nearest.
        limit: BoatLimit,
        /// When, s.
        at: f64,
        /// Margin there, ≥ 0.
        margin: f64,
    },
}

impl BoatInfeasible {
    /// The evidence for a limit with signed margin `margin` at `at`.
    pub(super) fn at(limit: BoatLimit, at: f64, margin: f64) -> Self {
        if margin >= 0.0 { Self::Unproven { limit, at, margin } } else { Self::Violates { limit, at, margin } }
    }

    /// The limit in question.
    pub fn limit(&self) -> BoatLimit {
        match *self {
            Self::Violates { limit, .. } | Self::Unproven { limit, .. } => limit,
        }
    }
}

/// `sway force violated by 0.31 N at 4.120 s`.
impl std::fmt::Display for BoatInfeasible {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let (name, unit) = self.limit().name_and_unit();
        match *self {
            Self::Violates { at, margin, .. } => write!(f, "{name} violated by {:.4} {unit} at {at:.3} s", -margin),
            Self::Unproven { at, margin, .. } => {
                write!(f, "{name} within {margin:.2e} {unit} of its limit at {at:.3} s, not proven")
            }
        }
    }
}
