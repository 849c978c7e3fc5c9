//! What a program says, as types. Lines of poses are most of what is read, so each is read into the fields of its own
//! type at once, without a tree of values between.

use std::borrow::Cow;
use std::str::FromStr;

use serde::de::{Error, SeqAccess, Unexpected, Visitor};
use serde::{Deserialize, Deserializer};
use serde_json::Value;

/// The values of `type`.
const KINDS: [&str; 5] = ["ready", "pose", "poses", "end", "error"];
/// The largest whole number up to which all are floating-point numbers, too.
const MOST_WHOLE: f64 = 9_007_199_254_740_992.0;
/// Columns of a row of `poses`.
const COLUMNS: usize = 12;

/// What the executor says. Fields that we do not know are ignored. From protocol 2 on, answers say by `case` and `run`
/// what they are of.
#[derive(Debug, Clone, PartialEq)]
pub enum FromExecutor {
    /// The answer to `hello` and, with case and run, to `reset`.
    Ready(ReadyMessage),
    /// Where the robot is.
    Pose(PoseMessage),
    /// The same, many at once.
    Poses(PosesMessage),
    /// The flight is over.
    End(EndMessage),
    /// The mission could not be flown.
    Error(ErrorMessage),
}

/// `ready`.
#[derive(Debug, Clone, PartialEq, Deserialize)]
pub struct ReadyMessage {
    /// Version of the protocol it speaks.
    #[serde(default, deserialize_with = "whole")]
    pub protocol: Option<u64>,
    /// What it calls itself.
    #[serde(default)]
    pub name: String,
    /// Which version of it this is, in words of its own or as a number.
    pub version: Option<Value>,
    /// Whether the same mission is the same flight, to the bit.
    pub deterministic: Option<bool>,
    /// Whether missions are to come with their timed motion.
    pub timed: Option<bool>,
    /// Of which case.
    pub case: Option<Value>,
    /// Of which run.
    pub run: Option<Value>,
}

/// One pose in the world frame.
#[derive(Debug, Clone, PartialEq, Deserialize)]
pub struct PoseMessage {
    /// Stamp: 0 at the start, strictly rising.
    pub t_s: f64,
    /// Position.
    pub p_m: [f64; 3],
    /// Attitude, `world_from_body`, w first. It counts as unknown unless every pose has it.
    pub q_wxyz: Option<[f64; 4]>,
    /// Velocity; differentiated from positions unless every pose has it.
    pub v_m_s: Option<[f64; 3]>,
    /// The leg being flown, numbered by its first waypoint: in all poses, never falling, or in none; then it is
    /// assigned along the path.
    #[serde(default, deserialize_with = "whole")]
    pub leg: Option<u64>,
    /// Of which case.
    pub case: Option<Value>,
    /// Of which run.
    pub run: Option<Value>,
}

/// Many poses at once.
#[derive(Debug, Clone, PartialEq, Deserialize)]
pub struct PosesMessage {
    /// A row each.
    pub poses: Vec<Row>,
    /// Of which case.
    pub case: Option<Value>,
    /// Of which run.
    pub run: Option<Value>,
}

/// `[t, x, y, z, qw, qx, qy, qz, vx, vy, vz, leg]`, `null` where it is not known.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Row {
    numbers: [Option<f64>; COLUMNS],
    /// How many there were.
    count: usize,
}

/// `end`.
#[derive(Debug, Clone, PartialEq, Deserialize)]
pub struct EndMessage {
    /// Why.
    pub reason: EndReason,
    /// Whether that is what is assumed where nobody said it.
    #[serde(default)]
    pub assumed: bool,
    /// Of which case.
    pub case: Option<Value>,
    /// Of which run.
    pub run: Option<Value>,
}

/// Why the flight is over.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum EndReason {
    /// The last waypoint was reached.
    Done,
    /// The time limit came first.
    Time,
    /// It crashed.
    Crash,
}

/// `error`.
#[derive(Debug, Clone, PartialEq, Deserialize)]
pub struct ErrorMessage {
    /// Why.
    pub message: String,
    /// Of which case.
    pub case: Option<Value>,
    /// Of which run.
    pub run: Option<Value>,
}

/// `value` where it is whole: languages that have but one kind of number write `1.0` for 1.
pub(super) fn as_whole(value: f64) -> Option<u64> {
    ((0.0..=MOST_WHOLE).contains(&value) && value.fract() == 0.0).then_some(value as u64)
}

fn whole<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Option<u64>, D::Error> {
    struct Whole;

    impl Visitor<'_> for Whole {
        type Value = Option<u64>;

        fn expecting(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
            write!(f, "a whole number from 0")
        }

        fn visit_unit<E: Error>(self) -> Result<Option<u64>, E> {
            Ok(None)
        }

        fn visit_u64<E: Error>(self, value: u64) -> Result<Option<u64>, E> {
            Ok(Some(value))
        }

        fn visit_f64<E: Error>(self, value: f64) -> Result<Option<u64>, E> {
            as_whole(value).map(Some).ok_or_else(|| E::invalid_type(Unexpected::Float(value), &self))
        }
    }

    deserializer.deserialize_any(Whole)
}

impl FromStr for FromExecutor {
    type Err = serde_json::Error;

    fn from_str(text: &str) -> serde_json::Result<Self> {
        /// The rest is read over.
        #[derive(Deserialize)]
        struct Head<'a> {
            #[serde(rename = "type", borrow)]
            kind: Cow<'a, str>,
        }
        let kind = match leading_kind(text) {
            Some(kind) => kind.into(),
            None => serde_json::from_str::<Head>(text)?.kind,
        };
        match kind.as_ref() {
            "ready" => serde_json::from_str(text).map(Self::Ready),
            "pose" => serde_json::from_str(text).map(Self::Pose),
            "poses" => serde_json::from_str(text).map(Self::Poses),
            "end" => serde_json::from_str(text).map(Self::End),
            "error" => serde_json::from_str(text).map(Self::Error),
            other => Err(serde_json::Error::unknown_variant(other, &KINDS)),
        }
    }
}

/// The message's type, where it is what the line begins with, as most are written.
fn leading_kind(text: &str) -> Option<&'static str> {
    let after = |text: &'_ str, sign: &str| text.trim_start().strip_prefix(sign).map(str::len);
    let mut rest = text;
    for sign in ["{", "\"type\"", ":", "\""] {
        rest = &rest[rest.len() - after(rest, sign)?..];
    }
    KINDS.into_iter().find(|kind| rest.strip_prefix(kind).is_some_and(|rest| rest.starts_with('"')))
}

impl FromExecutor {
    /// The value of `type`.
    pub fn kind(&self) -> &'static str {
        match self {
            Self::Ready(_) => KINDS[0],
            Self::Pose(_) => KINDS[1],
            Self::Poses(_) => KINDS[2],
            Self::End(_) => KINDS[3],
            Self::Error(_) => KINDS[4],
        }
    }

    /// The case and the run that it is of, where it says so.
    pub fn envelope(&self) -> [Option<&Value>; 2] {
        match self {
            Self::Ready(ReadyMessage { case, run, .. })
            | Self::Pose(PoseMessage { case, run, .. })
            | Self::Poses(PosesMessage { case, run, .. })
            | Self::End(EndMessage { case, run, .. })
            | Self::Error(ErrorMessage { case, run, .. }) => [case.as_ref(), run.as_ref()],
        }
    }
}

impl Row {
    /// Its pose.
    ///
    /// # Errors
    /// What is wrong with it: another number of columns, no time or place, a leg that is no whole number.
    pub fn pose(&self) -> Result<PoseMessage, String> {
        if self.count != COLUMNS {
            return Err(format!("has {} numbers: must be {COLUMNS}", self.count));
        }
        let [t, x, y, z, qw, qx, qy, qz, vx, vy, vz, leg] = self.numbers;
        let (Some(t_s), Some(x), Some(y), Some(z)) = (t, x, y, z) else {
            return Err("has no time or no place".to_owned());
        };
        let whole = |leg: f64| match leg {
            leg if (0.0..=1e9).contains(&leg) && leg.fract() == 0.0 => Ok(leg as u64),
            _ => Err(format!("has leg = {leg}: must be a whole number from 0")),
        };
        let q_wxyz = || Some([qw?, qx?, qy?, qz?]);
        let v_m_s = || Some([vx?, vy?, vz?]);
        let leg = leg.map(whole).transpose()?;
        Ok(PoseMessage { t_s, p_m: [x, y, z], q_wxyz: q_wxyz(), v_m_s: v_m_s(), leg, case: None, run: None })
    }
}

impl<'de> Deserialize<'de> for Row {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Numbers;

        impl<'de> Visitor<'de> for Numbers {
            type Value = Row;

            fn expecting(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
                write!(f, "a row of {COLUMNS} numbers")
            }

            fn visit_seq<A: SeqAccess<'de>>(self, mut numbers: A) -> Result<Row, A::Error> {
                let mut row = Row { numbers: [None; COLUMNS], count: 0 };
                while let Some(number) = numbers.next_element::<Option<f64>>()? {
                    if let Some(place) = row.numbers.get_mut(row.count) {
                        *place = number;
                    }
                    row.count += 1;
                }
                Ok(row)
            }
        }

        deserializer.deserialize_seq(Numbers)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Whatever the order of keys and the white space, and whatever else has the names of other messages' fields.
    #[test]
    fn a_line_is_read_by_its_type_alone() {
        let pose = |text: &str| match text.parse() {
            Ok(FromExecutor::Pose(pose)) => (pose.t_s, pose.p_m, pose.leg),
            other => panic!("{text}: {other:?}"),
        };
        for text in [
            r#"{"type":"pose","t_s":1,"p_m":[1,2,3],"leg":4}"#,
            r#" { "type" : "pose", "t_s": 1.0, "p_m": [1, 2, 3], "leg": 4, "message": 7, "poses": {}, "reason": null }"#,
            r#"{"leg":4,"reason":{"a":[1]},"p_m":[1,2,3],"t_s":1e0,"type":"pose"}"#,
            r#"{"t_s":1,"p_m":[1,2,3],"leg":4,"\u0074ype":"p\u006fse"}"#,
            r#"{"type":"pose","t_s":1,"p_m":[1,2,3],"leg":4.0}"#,
        ] {
            assert_eq!(pose(text), (1.0, [1.0, 2.0, 3.0], Some(4)));
        }
        for (text, words) in [
            (r#"{"type":"posed","t_s":1}"#, "unknown variant `posed`, expected one of `ready`, `pose`"),
            (r#"{"t_s":1}"#, "missing field `type`"),
            (r#"{"type":"pose","t_s":1}"#, "missing field `p_m`"),
            (r#"{"type":"pose","t_s":1,"p_m":[1,2]}"#, "invalid length 2"),
            (r#"{"type":"poses","poses":[[1,"2"]]}"#, "expected f64"),
            (
                r#"{"type":"pose","t_s":1,"p_m":[1,2,3],"leg":4.5}"#,
                "floating point `4.5`, expected a whole number from 0",
            ),
            (r#"{"type":"pose","t_s":1,"p_m":[1,2,3],"leg":-4}"#, "integer `-4`, expected a whole number from 0"),
            (r#"{"type":"pose","t_s":1,"p_m":[1,2,3],"leg":-1.0}"#, "floating point `-1.0`, expected a whole number"),
            (r#"{"type":"pose","t_s":1,"p_m":[1,2,3],"leg":"4"}"#, "string \"4\", expected a whole number from 0"),
            (r#"{"type":"end","reason":"done"} {}"#, "trailing characters"),
        ] {
            let error = text.parse::<FromExecutor>().unwrap_err().to_string();
            assert!(error.contains(words), "{text}: {error}");
        }
    }

    #[test]
    fn rows_are_poses() {
        let rows = |text: &str| match text.parse() {
            Ok(FromExecutor::Poses(poses)) => poses.poses.iter().map(Row::pose).collect::<Result<Vec<_>, _>>(),
            other => panic!("{text}: {other:?}"),
        };
        let two = rows(r#"{"type":"poses","poses":[[0,1,2,3,1,0,0,0,4,5,6,0],[0.5,1,2,3,null,0,0,0,null,5,6,null]]}"#);
        let two = two.unwrap();
        assert_eq!(
            (two[0].q_wxyz, two[0].v_m_s, two[0].leg),
            (Some([1.0, 0.0, 0.0, 0.0]), Some([4.0, 5.0, 6.0]), Some(0))
        );
        assert_eq!((two[1].t_s, two[1].p_m, two[1].q_wxyz, two[1].leg), (0.5, [1.0, 2.0, 3.0], None, None));
        for (text, words) in
            [("[0,1,2,3]", "has 4 numbers: must be 12"), ("[0,1,2,3,1,0,0,0,4,5,6,0,7]", "has 13 numbers")]
        {
            let error = rows(&format!(r#"{{"type":"poses","poses":[{text}]}}"#)).unwrap_err();
            assert!(error.contains(words), "{error}");
        }
    }
}
