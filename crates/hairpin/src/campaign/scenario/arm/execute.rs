//! `[execute]`: who runs the programs, and how often.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::campaign::scenario::{FlakySection, Record, Steering};

/// `[execute]`: our virtual controller, or logs of a real one.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct ArmExecute {
    /// virtual, or yours: python:FILE | command:CMD.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub controller: Option<Steering<ArmControllerKind>>,
    /// Turns of a controller of yours in a second; 100 if not given.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub control_rate_hz: Option<f64>,
    /// Wall-clock limit of a run by a controller of yours.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub timeout_s: Option<f64>,
    /// CSV logs of a real controller, relative to the scenario file; `*` stands for CASE-RUN or, where there is one
    /// run, CASE: `nightly/*.csv`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub logs: Option<String>,
    /// as-recorded | offset-removed: whether logs' clocks and the program's are one, or differ by what is estimated.
    #[serde(skip_serializing_if = "LogClock::is_shared")]
    pub log_clock: LogClock,
    /// Runs per program; the noise band comes from the repeats. Run 0 is nominal, `[vary]` is drawn for the others.
    /// One if not given, two where anything is drawn for runs.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub repeat: Option<u64>,
    /// trapezoid | s-curve.
    pub profile: TimeLawName,
    /// Time constant of the axes' servo lag, where the arm's file has none of its own (`joints.lag_s`).
    pub servo_lag_s: f64,
    /// Jitter of the virtual controller: standard deviation of measured positions.
    pub noise_mm: f64,
    /// What is wrong with the virtual arm.
    #[serde(skip_serializing_if = "FaultSection::is_none")]
    pub faults: FaultSection,
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

impl Default for ArmExecute {
    fn default() -> Self {
        Self {
            controller: None,
            control_rate_hz: None,
            timeout_s: None,
            logs: None,
            log_clock: LogClock::AsRecorded,
            repeat: None,
            profile: TimeLawName::SCurve,
            servo_lag_s: 0.005,
            noise_mm: 0.01,
            faults: FaultSection::default(),
            baseline: None,
            flaky: None,
            record: Record::All,
        }
    }
}

/// Controllers of ours.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum ArmControllerKind {
    /// The virtual one.
    Virtual,
}

/// Whose clock logs are on.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum LogClock {
    /// The program's: it began at 0, and a late start is late. An offset is estimated and told.
    #[default]
    AsRecorded,
    /// Another one: the estimated offset is taken off the times, and that is told.
    OffsetRemoved,
}

impl LogClock {
    fn is_shared(&self) -> bool {
        *self == Self::AsRecorded
    }
}

/// Speed profiles of moves.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum TimeLawName {
    /// Constant acceleration.
    Trapezoid,
    /// Bounded jerk.
    SCurve,
}

/// `faults = { … }`: none unless given.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct FaultSection {
    /// Axis, from 1, that has backlash or is slow.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub axis: Option<u64>,
    /// Backlash of that axis.
    pub backlash_deg: f64,
    /// Share of its speed that the axis lacks, 0 to 1.
    pub slower: f64,
    /// By how much the real tool's point is off the declared one.
    pub tool_offset_mm: [f64; 3],
    /// By how much the program starts late.
    pub start_delay_s: f64,
}

impl FaultSection {
    /// Whether nothing is wrong.
    pub fn is_none(&self) -> bool {
        *self == Self::default()
    }
}
