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
    scenario_schema_for_editors(Some("arm"))
}

/// What a scenario file may say of a robot whose `kind` is `word`: [`scenario_schema_of`], with what is read before
/// that is asked, an arm's URDF.
pub fn scenario_schema_for_editors(word: Option<&str>) -> Value {
    let mut schema = scenario_schema_of(word);
    schema.pointer_mut("/$defs/ArmDescription").into_iter().for_each(or_by_urdf);
    schema
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
    let mut schema = schemars::schema_for!(ArmDescription).to_value();
    or_by_urdf(&mut schema);
    schema
}

/// Lets an arm's table name a URDF instead of what every arm has: with the keys that say how that is read, and any of
/// the arm's own to go over it.
fn or_by_urdf(arm: &mut Value) {
    let text = |what: &str| json!({ "type": "string", "description": what });
    let pair = json!({ "type": "array", "minItems": 2, "maxItems": 2, "items": { "type": ["string", "integer"] } });
    let needed = arm["required"].take();
    if let Some(arm) = arm.as_object_mut() {
        arm.remove("required");
        arm.insert("anyOf".into(), json!([{ "required": needed }, { "required": ["urdf"] }]));
    }
    let properties = &mut arm["properties"];
    properties["urdf"] = text("A URDF file, relative to this one, in place of the keys that an arm needs.");
    properties["tip"] = text("Of a URDF: the link that is the flange; found if not given.");
    properties["base"] = text("Of a URDF: the link that the arm stands on; the root if not given.");
    properties["packages"] = json!({ "anyOf": [{ "type": "string" }, { "type": "array", "items": { "type": "string" } }],
        "description": "Of a URDF: folders that packages of meshes lie in (package://NAME/...)." });
    properties["srdf"] =
        text("Of a URDF: an SRDF whose disable_collisions are pairs that are not held against each other.");
    properties["exclude"] = json!({ "type": "array", "items": pair,
        "description": "Pairs of bodies that are not held against each other: 0 the base, 1 to 6 the links, 7 the tool; of a URDF by links' names, too." });
}

/// The schema of a quadrotor's file.
pub fn robot_schema() -> Value {
    schemars::schema_for!(QuadrotorDescription).to_value()
}
