//! Logs of robots that really moved.

use std::path::PathBuf;

use hairpin_cli::commands::judge_log::{lines, object as said_of};
use hairpin_jobs::judge_log::{Against, Altitude, FrameSettings, LogSettings};
use hairpin_jobs::sets::Set;
use pyo3::prelude::*;
use serde_json::json;

use crate::plain::object;
use crate::wait::Waiting;

/// Which logs are judged, and how.
#[derive(FromPyObject)]
pub(crate) struct Logs {
    path: PathBuf,
    campaign: Option<PathBuf>,
    mission: PathBuf,
    robot: Option<String>,
    world: Option<String>,
    case: Option<String>,
    source: Option<String>,
    turn_deg: f64,
    offset_m: [f64; 3],
    /// Heights are those above the sea.
    amsl: bool,
    from_s: Option<f64>,
    to_s: Option<f64>,
    page: Option<PathBuf>,
}

impl Logs {
    fn settings(self, sets: Vec<Set>) -> LogSettings {
        let Self { path, campaign, mission, robot, world, case, source, .. } = self;
        let altitude = if self.amsl { Altitude::Amsl } else { Altitude::Relative };
        LogSettings {
            path,
            against: campaign.map_or(Against::Mission { file: mission, robot }, Against::Campaign),
            world,
            sets,
            case,
            frame: FrameSettings { turn_deg: self.turn_deg, offset_m: self.offset_m, altitude },
            source,
            from_s: self.from_s,
            to_s: self.to_s,
            page: self.page,
        }
    }
}

/// Judges logs; gives what `judge LOG --json` says, and under `lines` what it says in words.
#[pyfunction]
pub(crate) fn judge_log(py: Python<'_>, logs: Logs, sets: Vec<Set>, waiting: Waiting) -> PyResult<Bound<'_, PyAny>> {
    let settings = logs.settings(sets);
    let said = waiting.wait(py, |watch| {
        let judged = hairpin_jobs::judge_log::judge_log(&settings, watch)?;
        let mut said = said_of(&judged);
        said["lines"] = json!(lines(&judged));
        Ok(said)
    })?;
    object(py, &said)
}
