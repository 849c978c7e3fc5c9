//! Small campaigns for the tests of jobs.

use std::path::{Path, PathBuf};
use std::sync::Mutex;

use tempfile::TempDir;

use crate::execute::{ExecuteSettings, execute};
use crate::generate::generate;
use crate::judge::judge;
use crate::sets::Set;
use crate::work::CampaignSettings;
use crate::{Unwatched, Watch};

/// Keeps what it is told.
#[derive(Default)]
pub(crate) struct Told(pub(crate) Mutex<Vec<String>>);

impl Watch for Told {
    fn warn(&self, line: &str) {
        self.0.lock().unwrap().push(line.to_owned());
    }
}

/// Two cases of the demo, each flown once, in `place`/out.
pub(crate) fn small(place: &TempDir) -> CampaignSettings {
    let set = |key: &str, value: &str| -> Set { (key.to_owned(), value.to_owned()) };
    CampaignSettings {
        scenario: "demo-quadrotor".into(),
        out: Some(place.path().join("out")),
        sets: vec![set("generate.search.cases", "2"), set("execute.repeat", "1"), set("execute.baseline", "0")],
        ..CampaignSettings::default()
    }
}

/// Small graphs of hull legs, flown from waypoint to waypoint, in a file of `place`.
pub(crate) fn small_hull(place: &Path) -> String {
    let text = r#"
hairpin = 1
robot = "flightgoggles"
seed = 3
[world]
size_m = [20, 20, 20]
[task]
start_m = [2, 2, 5]
end_m = [14, 14, 12]
length = 5
[generate]
reach = "hull"
timing = { step_s = 1.0 }
search = { method = "beam", waypoints = 80, cases = 3 }
[execute]
controller = "stable-waypoint"
[spec]
deviation = { max_m = 0.5, from = "nearest-leg" }
"#;
    let file = place.join("hull.toml");
    std::fs::write(&file, text).unwrap();
    file.to_string_lossy().into_owned()
}

/// The smallest program that executes, in `file`; `says` is what it says of itself in place of its name.
pub(crate) fn program(file: &Path, says: &str) -> Set {
    let minimal = concat!(env!("CARGO_MANIFEST_DIR"), "/../../examples/executors/minimal_executor.py");
    let minimal = std::fs::read_to_string(minimal).unwrap();
    let text = minimal.replace("name=\"minimal executor\"", says);
    assert_ne!(text, minimal);
    std::fs::write(file, text).unwrap();
    ("execute.command".to_owned(), format!("\"python3 '{}'\"", file.display()))
}

/// They are found.
pub(crate) fn generated() -> (TempDir, PathBuf) {
    let place = tempfile::tempdir().unwrap();
    let found = generate(&small(&place), &Unwatched).unwrap();
    let folder = found.work.folder.path().to_owned();
    (place, folder)
}

/// They are flown.
pub(crate) fn executed() -> (TempDir, PathBuf) {
    let (place, folder) = generated();
    execute(&ExecuteSettings { folder: folder.clone(), ..ExecuteSettings::default() }, &Unwatched).unwrap();
    (place, folder)
}

/// They are judged by a limit that all violate.
pub(crate) fn violating() -> (TempDir, PathBuf) {
    let (place, folder) = executed();
    let sets = vec![("spec.deviation.max_m".to_owned(), "0.0001".to_owned())];
    judge(&folder, &sets).unwrap();
    (place, folder)
}
