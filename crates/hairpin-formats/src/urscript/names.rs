//! Names of URScript's own functions, by what they do to motion.

use crate::listing::{Doubt, Unmodelled};

/// Functions that neither move the arm nor change how it moves.
pub(super) const HARMLESS: [&str; 14] = [
    "popup",
    "set_analog_out",
    "set_configurable_digital_out",
    "set_digital_out",
    "set_standard_analog_out",
    "set_standard_digital_out",
    "set_tool_digital_out",
    "sleep",
    "socket_close",
    "socket_open",
    "socket_send_string",
    "sync",
    "textmsg",
    "write_output_boolean_register",
];

/// Functions that give a value and do nothing, beside [`READING`], and words that may stand before brackets.
const VALUES: [&str; 41] = [
    "abs",
    "acos",
    "and",
    "asin",
    "atan",
    "atan2",
    "binary_list_to_integer",
    "ceil",
    "cos",
    "d2r",
    "floor",
    "force",
    "integer_to_binary_list",
    "interpolate_pose",
    "inv",
    "length",
    "log",
    "norm",
    "normalize",
    "not",
    "or",
    "point_dist",
    "pose_add",
    "pose_dist",
    "pose_inv",
    "pose_sub",
    "pose_trans",
    "pow",
    "r2d",
    "random",
    "rotvec2rpy",
    "rpy2rotvec",
    "sin",
    "size",
    "socket_get_var",
    "sqrt",
    "tan",
    "time",
    "transpose",
    "wrench_trans",
    "xor",
];

/// What the names of functions begin with that read.
const READING: [&str; 7] = ["get_", "is_", "modbus_get_", "read_", "socket_read_", "str_", "to_"];

/// Functions that change motion in ways that no model here has, by what their names begin with.
const CHANGES: [(Unmodelled, &[&str]); 8] = [
    (Unmodelled::Conveyors, &["track_conveyor", "stop_conveyor", "set_conveyor", "conveyor_"]),
    (Unmodelled::ForceControl, &["force_mode", "end_force_mode", "screw_driving", "tool_contact", "zero_ftsensor"]),
    (
        Unmodelled::Guidance,
        &["servo", "speed", "freedrive", "end_freedrive", "teach_mode", "end_teach_mode", "path_offset"],
    ),
    (Unmodelled::Interpolation, &["movep", "optimove"]),
    (Unmodelled::Payload, &["set_payload", "set_target_payload", "set_gravity"]),
    (Unmodelled::Restarts, &["stopj", "stopl", "undo"]),
    (Unmodelled::Displacements, &["set_tcp", "set_base", "pose_"]),
    (Unmodelled::ExternalAxes, &["axis_group"]),
];

/// Whether a call amid others neither moves the arm nor changes how it moves.
pub(super) fn is_quiet(name: &str) -> bool {
    VALUES.contains(&name) || HARMLESS.contains(&name) || READING.iter().any(|begin| name.starts_with(begin))
}

/// Why a statement is not followed.
pub(super) fn not_followed(statement: &str) -> Doubt {
    let end = statement.find(|c: char| !(c.is_alphanumeric() || c == '_'));
    let name = &statement[..end.unwrap_or(statement.len())];
    let known = CHANGES.iter().find(|(_, begins)| begins.iter().any(|begin| name.starts_with(begin)));
    (known.map(|(what, _)| *what), format!("`{}` is not followed", name.escape_default()))
}
