//! `execute.controller`: a controller of ours by its word, or code of the user's.

use std::borrow::Cow;

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::{DeserializeOwned, IntoDeserializer};
use serde::{Deserialize, Deserializer, Serialize, Serializer};

use super::PYTHON;

/// What begins the name of a program of the user's that steers.
pub const COMMAND: &str = "command:";
/// The key of who steers.
pub const CONTROLLER_KEY: &str = "execute.controller";

/// Who steers.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Steering<K> {
    /// A controller of ours.
    Ours(K),
    /// Code of the user's.
    Users(UserSteering),
}

/// `python:FILE`, a function of the user's, or `command:CMD`, a program that answers line by line.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct UserSteering(String);

impl UserSteering {
    /// As scenarios have it.
    pub fn word(&self) -> &str {
        &self.0
    }

    /// The Python file.
    pub fn file(&self) -> Option<&str> {
        self.0.strip_prefix(PYTHON)
    }

    /// The command line.
    pub fn command(&self) -> Option<&str> {
        self.0.strip_prefix(COMMAND)
    }

    /// Names the copy of a Python file in a campaign's folder.
    pub fn rename(&mut self, copy: &str) {
        self.0 = format!("{PYTHON}{copy}");
    }
}

impl<K: Copy> Steering<K> {
    /// Who steers: as given; `otherwise` where nothing is, and nobody of these where a command executes.
    pub(in crate::campaign) fn in_force(given: Option<&Self>, command: Option<&str>, otherwise: K) -> Option<Self> {
        match (given, command) {
            (None, Some(_)) => None,
            (None, None) => Some(Self::Ours(otherwise)),
            (Some(given), _) => Some(given.clone()),
        }
    }

    /// The word of who steers, as [`Self::in_force`] has it; `word` has those of ours.
    pub(in crate::campaign) fn word_in_force<'a>(
        given: Option<&'a Self>,
        command: Option<&str>,
        otherwise: K,
        word: fn(K) -> &'static str,
    ) -> Option<&'a str> {
        let ours = || Self::in_force(given, command, otherwise)?.ours().map(word);
        Self::users(given).map(UserSteering::word).or_else(ours)
    }

    /// The one of ours.
    pub fn ours(&self) -> Option<K> {
        match self {
            Self::Ours(kind) => Some(*kind),
            Self::Users(_) => None,
        }
    }
}

impl<K> Steering<K> {
    /// The user's.
    pub(in crate::campaign) fn users(given: Option<&Self>) -> Option<&UserSteering> {
        match given {
            Some(Self::Users(users)) => Some(users),
            _ => None,
        }
    }

    /// The same, to be renamed.
    pub(in crate::campaign) fn users_mut(given: Option<&mut Self>) -> Option<&mut UserSteering> {
        match given {
            Some(Self::Users(users)) => Some(users),
            _ => None,
        }
    }
}

impl<K: Serialize> Serialize for Steering<K> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self {
            Self::Ours(kind) => kind.serialize(serializer),
            Self::Users(users) => serializer.serialize_str(users.word()),
        }
    }
}

impl<'de, K: DeserializeOwned> Deserialize<'de> for Steering<K> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let word = String::deserialize(deserializer)?;
        if word.starts_with(PYTHON) || word.starts_with(COMMAND) {
            return Ok(Self::Users(UserSteering(word)));
        }
        K::deserialize(word.into_deserializer()).map(Self::Ours)
    }
}

impl<K: JsonSchema> JsonSchema for Steering<K> {
    fn schema_name() -> Cow<'static, str> {
        format!("{}OrYours", K::schema_name()).into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        json_schema!({
            "description": "A controller of hairpin's; `python:FILE`, a function of your own; or `command:CMD`, a program of your own.",
            "anyOf": [
                generator.subschema_for::<K>(),
                { "type": "string", "pattern": format!("^{PYTHON}") },
                { "type": "string", "pattern": format!("^{COMMAND}") },
            ],
        })
    }
}

#[cfg(feature = "unit-tests")]
mod tests {
    use serde_json::json;

    use super::*;
    use crate::simulation::ControllerKind;

    #[test]
    fn words_of_ours_and_the_users_come_back() {
        for word in ["minimum-snap", "python:a/pd.py", "command:./pd --fast"] {
            let read: Steering<ControllerKind> = serde_json::from_value(json!(word)).unwrap();
            assert_eq!(serde_json::to_value(&read).unwrap(), json!(word));
            assert_eq!(read.ours().is_some(), word == "minimum-snap");
        }
        let wrong = serde_json::from_value::<Steering<ControllerKind>>(json!("geometrical")).unwrap_err().to_string();
        assert!(wrong.contains("unknown variant `geometrical`"), "{wrong}");
    }
}
