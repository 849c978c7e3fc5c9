//! Foxglove's schemas (docs.foxglove.dev, "Schemas"; `foxglove-sdk`, `schemas/proto`) as the descriptors that a file
//! must carry, for the messages that are written and all that they may hold.

use super::protobuf::Message;

/// `name`, number, type; `*` before a type: any number of them.
type Field = (&'static str, u32, &'static str);

const GOOGLE: [(&str, &str); 2] =
    [("google/protobuf/timestamp.proto", "Timestamp"), ("google/protobuf/duration.proto", "Duration")];
const TIME: [Field; 2] = [("seconds", 1, "int64"), ("nanos", 2, "int32")];

const STAMP: &str = "google.protobuf.Timestamp";
const SPAN: &str = "google.protobuf.Duration";

#[rustfmt::skip]
const MESSAGES: [(&str, &[Field]); 20] = [
    ("Vector3", &[("x", 1, "double"), ("y", 2, "double"), ("z", 3, "double")]),
    ("Point3", &[("x", 1, "double"), ("y", 2, "double"), ("z", 3, "double")]),
    ("Quaternion", &[("x", 1, "double"), ("y", 2, "double"), ("z", 3, "double"), ("w", 4, "double")]),
    ("Color", &[("r", 1, "double"), ("g", 2, "double"), ("b", 3, "double"), ("a", 4, "double")]),
    ("Pose", &[("position", 1, "foxglove.Vector3"), ("orientation", 2, "foxglove.Quaternion")]),
    ("KeyValuePair", &[("key", 1, "string"), ("value", 2, "string")]),
    ("PoseInFrame", &[("timestamp", 1, STAMP), ("frame_id", 2, "string"), ("pose", 3, "foxglove.Pose")]),
    ("PosesInFrame", &[("timestamp", 1, STAMP), ("frame_id", 2, "string"), ("poses", 3, "*foxglove.Pose")]),
    ("FrameTransform", &[
        ("timestamp", 1, STAMP), ("parent_frame_id", 2, "string"), ("child_frame_id", 3, "string"),
        ("translation", 4, "foxglove.Vector3"), ("rotation", 5, "foxglove.Quaternion"),
    ]),
    ("SceneUpdate", &[("deletions", 1, "*foxglove.SceneEntityDeletion"), ("entities", 2, "*foxglove.SceneEntity")]),
    ("SceneEntityDeletion", &[
        ("timestamp", 1, STAMP), ("type", 2, "=foxglove.SceneEntityDeletion.Type"), ("id", 3, "string"),
    ]),
    ("SceneEntity", &[
        ("timestamp", 1, STAMP), ("frame_id", 2, "string"), ("id", 3, "string"), ("lifetime", 4, SPAN),
        ("frame_locked", 5, "bool"), ("metadata", 6, "*foxglove.KeyValuePair"),
        ("arrows", 7, "*foxglove.ArrowPrimitive"), ("cubes", 8, "*foxglove.CubePrimitive"),
        ("spheres", 9, "*foxglove.SpherePrimitive"), ("cylinders", 10, "*foxglove.CylinderPrimitive"),
        ("lines", 11, "*foxglove.LinePrimitive"), ("triangles", 12, "*foxglove.TriangleListPrimitive"),
        ("texts", 13, "*foxglove.TextPrimitive"), ("models", 14, "*foxglove.ModelPrimitive"),
    ]),
    ("ArrowPrimitive", &[
        ("pose", 1, "foxglove.Pose"), ("shaft_length", 2, "double"), ("shaft_diameter", 3, "double"),
        ("head_length", 4, "double"), ("head_diameter", 5, "double"), ("color", 6, "foxglove.Color"),
    ]),
    ("CubePrimitive", &[("pose", 1, "foxglove.Pose"), ("size", 2, "foxglove.Vector3"), ("color", 3, "foxglove.Color")]),
    ("SpherePrimitive", &[("pose", 1, "foxglove.Pose"), ("size", 2, "foxglove.Vector3"), ("color", 3, "foxglove.Color")]),
    ("CylinderPrimitive", &[
        ("pose", 1, "foxglove.Pose"), ("size", 2, "foxglove.Vector3"), ("bottom_scale", 3, "double"),
        ("top_scale", 4, "double"), ("color", 5, "foxglove.Color"),
    ]),
    ("LinePrimitive", &[
        ("type", 1, "=foxglove.LinePrimitive.Type"), ("pose", 2, "foxglove.Pose"), ("thickness", 3, "double"),
        ("scale_invariant", 4, "bool"), ("points", 5, "*foxglove.Point3"), ("color", 6, "foxglove.Color"),
        ("colors", 7, "*foxglove.Color"), ("indices", 8, "*fixed32"),
    ]),
    ("TriangleListPrimitive", &[
        ("pose", 1, "foxglove.Pose"), ("points", 2, "*foxglove.Point3"), ("color", 3, "foxglove.Color"),
        ("colors", 4, "*foxglove.Color"), ("indices", 5, "*fixed32"),
    ]),
    ("TextPrimitive", &[
        ("pose", 1, "foxglove.Pose"), ("billboard", 2, "bool"), ("font_size", 3, "double"),
        ("scale_invariant", 4, "bool"), ("color", 5, "foxglove.Color"), ("text", 6, "string"),
    ]),
    ("ModelPrimitive", &[
        ("pose", 1, "foxglove.Pose"), ("scale", 2, "foxglove.Vector3"), ("color", 3, "foxglove.Color"),
        ("override_color", 4, "bool"), ("url", 5, "string"), ("media_type", 6, "string"), ("data", 7, "bytes"),
    ]),
];

/// Enumerations within messages, with their values from 0.
const TYPES: [(&str, &[&str]); 2] =
    [("SceneEntityDeletion", &["MATCHING_ID", "ALL"]), ("LinePrimitive", &["LINE_STRIP", "LINE_LOOP", "LINE_LIST"])];

/// The `FileDescriptorSet` of all messages (google/protobuf/descriptor.proto).
pub(super) fn descriptors() -> Vec<u8> {
    let google = GOOGLE.map(|(file, name)| {
        let file = Message::default().string(1, file).string(2, "google.protobuf");
        file.message(4, &descriptor(name, &TIME)).string(12, "proto3")
    });
    let file = Message::default().string(1, "foxglove/hairpin.proto").string(2, "foxglove");
    let file = GOOGLE.iter().fold(file, |file, (name, _)| file.string(3, name));
    let file = file.messages(4, MESSAGES.iter().map(|(name, fields)| descriptor(name, fields)));
    Message::default().messages(1, google).message(1, &file.string(12, "proto3")).into_bytes()
}

fn descriptor(name: &str, fields: &[Field]) -> Message {
    let message = Message::default().string(1, name).messages(2, fields.iter().map(field));
    let values = TYPES.iter().filter(|(of, _)| *of == name).map(|(_, values)| {
        let value = |(number, value): (u64, &&str)| Message::default().string(1, value).integer(2, number);
        Message::default().string(1, "Type").messages(2, (0..).zip(*values).map(value))
    });
    message.messages(4, values)
}

fn field((name, number, kind): &Field) -> Message {
    const OPTIONAL: u64 = 1;
    const REPEATED: u64 = 3;
    let (label, kind) = kind.strip_prefix('*').map_or((OPTIONAL, *kind), |kind| (REPEATED, kind));
    let (code, of) = match kind {
        "double" => (1, None),
        "int64" => (3, None),
        "int32" => (5, None),
        "fixed32" => (7, None),
        "bool" => (8, None),
        "string" => (9, None),
        "bytes" => (12, None),
        other => other.strip_prefix('=').map_or((11, Some(other)), |name| (14, Some(name))),
    };
    let field = Message::default().string(1, name).integer(3, u64::from(*number)).integer(4, label).integer(5, code);
    match of {
        Some(of) => field.string(6, &format!(".{of}")),
        None => field,
    }
}
