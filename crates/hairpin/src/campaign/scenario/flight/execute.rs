//! `[execute]`: who flies the trajectories, and how often.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::campaign::scenario::{FlakySection, Record, Steering, TIMEOUT_S};
use crate::simulation::{ControllerKind, SegmentTimes};

/// `[execute]`: a controller of ours in our simulator, or a command that speaks the executor protocol.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct ExecuteSection {
    /// unstable-waypoint | stable-waypoint | fixed-velocity | minimum-snap | geometric | anafi | px4-mission |
    /// crazyflie-goto, or yours: python:FILE | command:CMD.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub controller: Option<Steering<ControllerKind>>,
    /// Turns of a controller of yours in a second; 100 if not given.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub control_rate_hz: Option<f64>,
    /// A program that speaks the executor protocol, as a shell would split it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub command: Option<String>,
    /// Logs flown elsewhere.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub logs: Option<String>,
    /// Runs per case; run 0 is nominal, `[vary]` is drawn for the others. One if not given, two where anything is
    /// drawn for runs.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub repeat: Option<u64>,
    /// A waypoint counts as reached inside this radius.
    pub accept_m: f64,
    /// Time limit of a run; if not given 9 s per waypoint, or where that is longer twice the plan, or half as long
    /// again as the way takes, and under `crazyflie-goto` what as many legs across the world would take.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub time_limit_s: Option<f64>,
    /// Step of the simulated physics.
    pub step_s: f64,
    /// Force and moment noise with the robot's own densities.
    pub noise: bool,
    /// Whether leaving the world is a crash.
    pub walls: bool,
    /// Speed of the fixed-velocity controller.
    pub fixed_velocity_m_s: f64,
    /// How minimum-snap sets its leg times.
    pub segment_times: SegmentTimes,
    /// Mean speed of crazyflie-goto; a tenth of the robot's top speed if not given.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub goto_speed_m_s: Option<f64>,
    /// How many times as fast as its own the loops of position and velocity of a controller of ours are; 1 if not
    /// given.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub bandwidth: Option<f64>,
    /// A command acts this much later in our simulator; 0 if not given.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub latency_s: Option<f64>,
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

impl Default for ExecuteSection {
    fn default() -> Self {
        Self {
            controller: None,
            control_rate_hz: None,
            command: None,
            logs: None,
            repeat: None,
            accept_m: 1.0,
            time_limit_s: None,
            step_s: 0.001,
            noise: false,
            walls: false,
            fixed_velocity_m_s: 2.0,
            segment_times: SegmentTimes::SqrtLength,
            goto_speed_m_s: None,
            bandwidth: None,
            latency_s: None,
            timeout_s: TIMEOUT_S,
            processes: None,
            workers: None,
            baseline: None,
            flaky: None,
            record: Record::All,
        }
    }
}

impl ExecuteSection {
    /// Who flies: as given, `stable-waypoint` where nothing is, `None` where a command does.
    pub fn steering_in_force(&self) -> Option<Steering<ControllerKind>> {
        Steering::in_force(self.controller.as_ref(), self.command.as_deref(), ControllerKind::StableWaypoint)
    }

    /// The one of ours that flies.
    pub fn controller_in_force(&self) -> Option<ControllerKind> {
        self.steering_in_force()?.ours()
    }

    /// The word of who flies.
    pub fn controller_word(&self) -> Option<&str> {
        let (given, command) = (self.controller.as_ref(), self.command.as_deref());
        Steering::word_in_force(given, command, ControllerKind::StableWaypoint, ControllerKind::word)
    }
}
