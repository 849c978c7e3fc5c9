//! `hairpin schema`: JSON Schema from the types that read the files.

use hairpin::campaign::scenario::RobotKind;
use hairpin_formats::atomic::json_text;
use hairpin_formats::schema::{
    arm_scenario_schema, arm_schema, car_schema, differential_drive_schema, drive_scenario_schema, robot_schema,
    rover_schema, scenario_schema, scenario_schema_for_editors,
};
use hairpin_jobs::Problem;

use crate::args::{Document, Schema};
use crate::console;
use crate::exit::DONE;

/// Runs the command.
pub(crate) fn run(schema: &Schema) -> Result<u8, Problem> {
    let schema = match (&schema.kind, schema.document) {
        (Some(word), _) => scenario_schema_for_editors(Some(known(word)?)),
        (None, Document::Scenario) => scenario_schema(),
        (None, Document::RoverScenario) => drive_scenario_schema(),
        (None, Document::ArmScenario) => arm_scenario_schema(),
        (None, Document::Robot) => robot_schema(),
        (None, Document::Rover) => rover_schema(),
        (None, Document::Arm) => arm_schema(),
        (None, Document::Car) => car_schema(),
        (None, Document::DifferentialDrive) => differential_drive_schema(),
    };
    console::say_text(&json_text(&schema).map_err(Problem::input)?);
    Ok(DONE)
}

/// `word`, if robots' files may say it.
fn known(word: &str) -> Result<&str, Problem> {
    let words: Vec<&str> = RobotKind::all().flat_map(|kind| kind.words.iter().copied()).collect();
    let refuse = || Problem::input(format!("--kind {word}: must be one of {}", words.join(", ")));
    words.contains(&word).then_some(word).ok_or_else(refuse)
}
