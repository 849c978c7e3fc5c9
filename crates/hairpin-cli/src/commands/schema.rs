//! `hairpin schema`: JSON Schema from the types that read the files.

use hairpin_formats::atomic::json_text;
use hairpin_formats::schema::{
    arm_scenario_schema, arm_schema, car_schema, differential_drive_schema, drive_scenario_schema, robot_schema,
    rover_schema, scenario_schema,
};
use hairpin_jobs::Problem;

use crate::args::{Document, Schema};
use crate::console;
use crate::exit::DONE;

/// Runs the command.
pub(crate) fn run(schema: &Schema) -> Result<u8, Problem> {
    let schema = match schema.document {
        Document::Scenario => scenario_schema(),
        Document::RoverScenario => drive_scenario_schema(),
        Document::ArmScenario => arm_scenario_schema(),
        Document::Robot => robot_schema(),
        Document::Rover => rover_schema(),
        Document::Arm => arm_schema(),
        Document::Car => car_schema(),
        Document::DifferentialDrive => differential_drive_schema(),
    };
    console::say_text(&json_text(&schema).map_err(Problem::input)?);
    Ok(DONE)
}
