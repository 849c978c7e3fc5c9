//! Memory and start: what a vehicle on its map takes of the machine before its first answer, and while it answers.

use std::hint::black_box;
use std::time::Instant;

use hairpin::campaign::drive::Site;
use hairpin::feasibility::steering::shooting::rough::Settings;
use hairpin_formats::scenario::rover_for;
use hairpin_jobs::Problem;

use super::check::{Check, Test};
use super::subject::{RequirementsSettings, Subject};
use crate::memory::resident;

/// Answers after which the memory is read.
const ANSWERS: usize = 200;
/// The source's requirement, MB; its test plan allows twice as much.
const MOST_MB: f64 = 10.0;
/// What one solver may take beside the map, MB. Its heap alone is counted by a test of the library, `flight_software`:
/// nothing but its vehicle's names.
const WORKSPACE_MB: f64 = 2.0;
/// The source's requirement, s.
const LONGEST_S: f64 = 1.0;

/// The subject, made under the clock and the eyes of the system's accounts, from `before` MB on.
pub(super) fn measured(settings: &RequirementsSettings, before: f64) -> Result<(Subject, [Test; 2]), Problem> {
    let begun = Instant::now();
    let subject = Subject::new(settings)?;
    let made = begun.elapsed().as_secs_f64();
    let with_map = resident("RssAnon:");
    let goals = subject.goals(&subject.rocky8, 1, 1)?;
    let (start, goal) = &goals[0];
    let again = Instant::now();
    let rover = rover_for("rocky8")?;
    let site = Site::straight(&rover, &subject.ground);
    black_box(site.drive(start, goal, &Settings::default()));
    let first = again.elapsed().as_secs_f64();
    for _ in 0..ANSWERS {
        black_box(site.drive(start, goal, &Settings::default()));
    }
    let after = resident("RssAnon:");
    let (megabytes, workspace) = (after - before, after - with_map);
    let cells = subject.ground.grid().columns * subject.ground.grid().rows;
    let memory = Check::new(
        format!(
            "the process grew by {megabytes:.2} MB: by {:.2} MB for the map of {cells} cells and all vehicles, by {workspace:.2} MB for a solver with \
             a vehicle of its own, its stack included, and {ANSWERS} answers",
            with_map - before
        ),
        format!("≤ {MOST_MB} MB, of it ≤ {WORKSPACE_MB} MB beside the data"),
        megabytes <= MOST_MB && workspace <= WORKSPACE_MB,
    );
    let total = made + first;
    let start = Check::new(
        format!(
            "{:.2} ms from the vehicle's file to its first answer, {:.0} ms with the map and all vehicles",
            1e3 * first,
            1e3 * total
        ),
        format!("< {LONGEST_S} s"),
        total < LONGEST_S,
    );
    let tests = [
        Test::new("R7", "R-6", "memory, by the system's account of the process", memory),
        Test::new("R8", "R-7", "time to start", start),
    ];
    Ok((subject, tests))
}
