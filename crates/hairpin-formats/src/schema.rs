//! The JSON Schema of scenario and robot files, made from the types that read them.

use hairpin::campaign::scenario::RobotKind;
use hairpin::robot::arm::ArmDescription;
use hairpin::robot::ground::{CarDescription, DifferentialDriveDescription};
use hairpin::robot::quadrotor::QuadrotorDescription;
use hairpin::robot::rover::RoverDescription;
use serde_json::{Value, json};

/// The schema of a scenario file of flights, for editors; `hairpin schema` prints it.
pub fn scenario_schema() -> Value {
    scenario_schema_of(None)
}

/// The schema of a scenario file of drives.
pub fn drive_scenario_schema() -> Value {
    scenario_schema_of(Some("rover"))
}

/// The schema of a scenario file of an arm.
pub fn arm_scenario_schema() -> Value {
    scenario_schema_of(Some("arm"))
}

/// The schema of the scenario files of robots whose `kind` is `word`.
pub fn scenario_schema_of(word: Option<&str>) -> Value {
    with_made_by(RobotKind::of_word(word).schema())
}

fn with_made_by(mut schema: Value) -> Value {
    let made_by =
        json!({ "type": "object", "description": "Written by hairpin into a campaign's scenario; not read." });
    if let Some(properties) = schema.get_mut("properties").and_then(Value::as_object_mut) {
        properties.insert("made_by".into(), made_by);
    }
    schema
}

/// The schema of a rover's file.
pub fn rover_schema() -> Value {
    schemars::schema_for!(RoverDescription).to_value()
}

/// The schema of a car's file.
pub fn car_schema() -> Value {
    schemars::schema_for!(CarDescription).to_value()
}

/// The schema of a differential drive's file.
pub fn differential_drive_schema() -> Value {
    schemars::schema_for!(DifferentialDriveDescription).to_value()
}

/// The schema of an arm's file.
pub fn arm_schema() -> Value {
    schemars::schema_for!(ArmDescription).to_value()
}

/// The schema of a quadrotor's file.
pub fn robot_schema() -> Value {
    schemars::schema_for!(QuadrotorDescription).to_value()
}
