//! A robot by its name, by its file, or by its numbers in the scenario itself.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::Mistake;

/// Where the robot's numbers come from. Resolved scenarios hold the table.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
#[serde(untagged)]
pub enum RobotSource<D> {
    /// A shipped name or a path.
    Name(String),
    /// The numbers themselves.
    Inline(Box<D>),
}

impl<'de, D: Deserialize<'de>> Deserialize<'de> for RobotSource<D> {
    fn deserialize<S: serde::Deserializer<'de>>(deserializer: S) -> Result<Self, S::Error> {
        struct Visitor<D>(std::marker::PhantomData<D>);
        impl<'de, D: Deserialize<'de>> serde::de::Visitor<'de> for Visitor<D> {
            type Value = RobotSource<D>;
            fn expecting(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
                f.write_str("a robot's name, a robot file, or a table with its numbers")
            }
            fn visit_str<E>(self, name: &str) -> Result<RobotSource<D>, E> {
                Ok(RobotSource::Name(name.into()))
            }
            fn visit_map<A: serde::de::MapAccess<'de>>(self, map: A) -> Result<RobotSource<D>, A::Error> {
                D::deserialize(serde::de::value::MapAccessDeserializer::new(map))
                    .map(|description| RobotSource::Inline(Box::new(description)))
            }
        }
        deserializer.deserialize_any(Visitor(std::marker::PhantomData))
    }
}

impl<D> RobotSource<D> {
    /// The numbers.
    ///
    /// # Errors
    /// A name that was not resolved before.
    pub(in crate::campaign) fn resolved(&self) -> Result<&D, Mistake> {
        match self {
            Self::Inline(description) => Ok(description),
            Self::Name(name) => Err(Mistake {
                key: "robot".into(),
                value: format!("\"{name}\""),
                bound: "resolved to its numbers first".into(),
            }),
        }
    }
}
