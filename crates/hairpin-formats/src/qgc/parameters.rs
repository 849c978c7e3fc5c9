//! QGroundControl's parameter files: `vehicle`, `component`, name, value and type with tabs between, `#` for comments.

/// What the files' names end with.
pub const ENDING: &str = ".params";

/// A value with the type of MAVLink that autopilots give it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Value {
    /// `MAV_PARAM_TYPE_INT8`.
    Small(i8),
    /// `MAV_PARAM_TYPE_INT32`.
    Whole(i32),
    /// `MAV_PARAM_TYPE_REAL32`.
    Real(f64),
}

/// A parameter that a mission asks for.
#[derive(Debug, Clone, PartialEq)]
pub struct Parameter {
    /// Its name.
    pub name: &'static str,
    /// Its value.
    pub value: Value,
    /// Why, in a line.
    pub why: String,
}

impl std::fmt::Display for Value {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Small(value) => write!(f, "{value}"),
            Self::Whole(value) => write!(f, "{value}"),
            Self::Real(value) => write!(f, "{value:.3}"),
        }
    }
}

/// The text: `head` as comments, then the parameters, each below why.
pub fn text(head: &[String], parameters: &[Parameter]) -> String {
    let mut text = String::new();
    for line in head {
        text += &comment(line);
    }
    text += "#\n# Vehicle-Id Component-Id Name Value Type\n";
    for Parameter { name, value, why } in parameters {
        let kind = match value {
            Value::Small(_) => 2,
            Value::Whole(_) => 6,
            Value::Real(_) => 9,
        };
        text += &comment(&format!("{name}: {why}"));
        text += &format!("1\t1\t{name}\t{value}\t{kind}\n");
    }
    text
}

/// A line of its own, whatever is in it.
fn comment(line: &str) -> String {
    format!("# {}\n", line.replace(|c: char| c.is_control(), " "))
}
