//! `[execute]`: who sails the trajectories, and how often.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::campaign::scenario::{FlakySection, Record, Steering, TIMEOUT_S};
use crate::simulation::boat::BoatControllerKind;

/// `[execute]`: a controller of ours in our simulator, or a command that speaks the executor protocol.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct BoatExecute {
    /// line-of-sight | tracking, or yours: python:FILE | command:CMD.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub controller: Option<Steering<BoatControllerKind>>,
    /// Turns of a controller of yours in a second; 100 if not given.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub control_rate_hz: Option<f64>,
    /// A program that speaks the executor protocol, as a shell would split it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub command: Option<String>,
    /// Runs per case; run 0 is nominal, `[vary]` is drawn for the others. One if not given, two where anything is
    /// drawn for runs.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub repeat: Option<u64>,
    /// A waypoint counts as reached inside this radius.
    pub accept_m: f64,
    /// Time limit of a run; twice the planned time and a minute if not given.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub time_limit_s: Option<f64>,
    /// Speed of `line-of-sight`; the boat's own if not given.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub speed_m_s: Option<f64>,
    /// Steady force at the body's origin, east and north, that the plan does not know: wind, a tow.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub external_force_n: Option<[f64; 2]>,
    /// Whether controllers see noisy numbers: 1 cm and 0.2°, 5 mm/s and 0.2°/s.
    pub noise: bool,
    /// Whether leaving the waters is a crash.
    pub walls: bool,
    /// Wall-clock limit per mission of `command`, and of a controller of yours.
    pub timeout_s: f64,
    /// Processes of `command`, in the loop of a search and in executing; as many as threads if not given.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub processes: Option<u64>,
    /// The older name of `processes`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub workers: Option<u64>,
    /// Random feasible cases that are run alike, for the stress to stand beside; 0: none, 20 if not given.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub baseline: Option<u64>,
    /// Every violation is run again so often with other noise: how often does it come again?
    #[serde(skip_serializing_if = "Option::is_none")]
    pub flaky: Option<FlakySection>,
    /// all | worst | none: of which runs the motion is kept, beside what was measured of all.
    #[serde(skip_serializing_if = "Record::is_all")]
    pub record: Record,
}

impl Default for BoatExecute {
    fn default() -> Self {
        Self {
            controller: None,
            control_rate_hz: None,
            command: None,
            repeat: None,
            accept_m: 1.0,
            time_limit_s: None,
            speed_m_s: None,
            external_force_n: None,
            noise: false,
            walls: false,
            timeout_s: TIMEOUT_S,
            processes: None,
            workers: None,
            baseline: None,
            flaky: None,
            record: Record::All,
        }
    }
}

impl BoatExecute {
    /// Who sails: as given, `line-of-sight` where nothing is, `None` where a command does.
    pub(in crate::campaign::boat) fn steering_in_force(&self) -> Option<Steering<BoatControllerKind>> {
        Steering::in_force(self.controller.as_ref(), self.command.as_deref(), BoatControllerKind::LineOfSight)
    }

    /// The one of ours that sails.
    pub(in crate::campaign::boat) fn controller_in_force(&self) -> Option<BoatControllerKind> {
        self.steering_in_force()?.ours()
    }

    /// The word of who sails.
    pub(in crate::campaign::boat) fn controller_word(&self) -> Option<&str> {
        let (given, command) = (self.controller.as_ref(), self.command.as_deref());
        Steering::word_in_force(given, command, BoatControllerKind::LineOfSight, BoatControllerKind::word)
    }
}
