//! `[spec]` as a table of limits, or the word that says that nothing is to be judged: asking for nothing by leaving all
//! limits out would look like passing.

use std::borrow::Cow;
use std::fmt;
use std::marker::PhantomData;
use std::ops::{Deref, DerefMut};

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::value::MapAccessDeserializer;
use serde::de::{Error, MapAccess, Visitor};
use serde::{Deserialize, Deserializer, Serialize, Serializer};

/// The word for no limits.
const NONE: &str = "none";

/// What a scenario asks of its runs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Asked {
    /// At least one limit.
    Limits,
    /// No limit, in so many words: `spec = "none"`.
    Nothing,
    /// No limit, without a word of it.
    Unsaid,
}

/// `[spec]`: a table of limits, or `spec = "none"`. It reads as its limits, of which `none` has not one.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Spec<L> {
    limits: L,
    none: bool,
}

impl<L> Spec<L> {
    /// What is asked for where `limited` tells whether there is a limit.
    pub(in crate::campaign) fn asked(&self, limited: bool) -> Asked {
        match (self.none, limited) {
            (true, _) => Asked::Nothing,
            (false, true) => Asked::Limits,
            (false, false) => Asked::Unsaid,
        }
    }
}

impl<L> From<L> for Spec<L> {
    fn from(limits: L) -> Self {
        Self { limits, none: false }
    }
}

impl<L> Deref for Spec<L> {
    type Target = L;

    fn deref(&self) -> &L {
        &self.limits
    }
}

impl<L> DerefMut for Spec<L> {
    fn deref_mut(&mut self) -> &mut L {
        &mut self.limits
    }
}

impl<L: Serialize> Serialize for Spec<L> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        if self.none { serializer.serialize_str(NONE) } else { self.limits.serialize(serializer) }
    }
}

impl<'de, L: Deserialize<'de> + Default> Deserialize<'de> for Spec<L> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Reader<L>(PhantomData<L>);
        impl<'de, L: Deserialize<'de> + Default> Visitor<'de> for Reader<L> {
            type Value = Spec<L>;

            fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
                f.write_str("a table of limits, or \"none\"")
            }

            fn visit_str<E: Error>(self, word: &str) -> Result<Spec<L>, E> {
                let none = word == NONE;
                let refused = || E::invalid_value(serde::de::Unexpected::Str(word), &self);
                none.then(|| Spec { limits: L::default(), none }).ok_or_else(refused)
            }

            fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<Spec<L>, A::Error> {
                L::deserialize(MapAccessDeserializer::new(map)).map(Spec::from)
            }
        }
        deserializer.deserialize_any(Reader(PhantomData))
    }
}

impl<L: JsonSchema> JsonSchema for Spec<L> {
    fn schema_name() -> Cow<'static, str> {
        format!("Asked{}", L::schema_name()).into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let limits = generator.subschema_for::<L>();
        json_schema!({ "anyOf": [limits, { "const": NONE, "description": "Nothing but crashes and leaving the world is judged." }] })
    }
}
