//! The kinds of scenarios: two lines each.

use std::any::Any;
use std::collections::BTreeMap;
use std::ops::{Deref, DerefMut};
use std::sync::Arc;

use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::{ArmScenario, Distribution, DriveScenario, FlightScenario, GroundDescription, Keys};

/// What tells one kind of scenarios from others: what `robot.kind` says.
#[derive(Debug, Clone, Copy)]
pub struct RobotKind {
    /// Words of `robot.kind`.
    pub words: &'static [&'static str],
    read: fn(Value) -> serde_json::Result<Scenario>,
    schema: fn() -> Value,
}

impl RobotKind {
    /// The kind of robot files whose `kind` is `word`.
    pub fn of_word(word: Option<&str>) -> &'static Self {
        let named = word.and_then(|word| KINDS.iter().find(|kind| kind.words.contains(&word)));
        named.unwrap_or(&KINDS[0])
    }

    /// The JSON Schema of its scenarios.
    pub fn schema(&self) -> Value {
        (self.schema)()
    }
}

/// Of each kind a variant of [`Scenario`] with its keys, and the words of `robot.kind`. Robots that do not say their
/// kind are of the first.
macro_rules! kinds {
    ($($(#[$what:meta])+ $Kind:ident($Keys:ty) of $words:expr;)+) => {
        /// A scenario file; the robot's `kind` tells which.
        #[derive(Debug, Clone, PartialEq)]
        pub enum Scenario {
            $($(#[$what])+ $Kind(Arc<$Keys>),)+
        }

        /// Readers are not generic, so that those of all sections are compiled once, with this crate.
        const KINDS: &[RobotKind] = &[$(RobotKind {
            words: $words,
            read: |value| serde_json::from_value(value).map(Arc::new).map(Scenario::$Kind),
            schema: || schemars::schema_for!($Keys).to_value(),
        }),+];

        impl Deref for Scenario {
            type Target = dyn Keys;

            fn deref(&self) -> &(dyn Keys + 'static) {
                match self { $(Self::$Kind(keys) => &**keys,)+ }
            }
        }

        impl DerefMut for Scenario {
            fn deref_mut(&mut self) -> &mut (dyn Keys + 'static) {
                match self { $(Self::$Kind(keys) => Arc::<$Keys>::make_mut(keys),)+ }
            }
        }

        impl Serialize for Scenario {
            fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
                match self { $(Self::$Kind(keys) => keys.as_ref().serialize(serializer),)+ }
            }
        }
    };
}

kinds! {
    /// Of what flies.
    Flight(FlightScenario) of &["quadrotor"];
    /// Of what drives.
    Drive(DriveScenario) of GroundDescription::KINDS;
    /// Of an arm.
    Arm(ArmScenario) of &["arm"];
}

impl Scenario {
    /// Its keys, if they are a `K`.
    pub fn own<K: Keys>(&self) -> Option<&K> {
        (&**self as &dyn Any).downcast_ref()
    }

    /// The same, for changes.
    pub fn own_mut<K: Keys>(&mut self) -> Option<&mut K> {
        (&mut **self as &mut dyn Any).downcast_mut()
    }

    /// The same scenario with these distributions.
    pub fn with_vary(mut self, vary: BTreeMap<String, Distribution>) -> Self {
        *self.vary_mut() = vary;
        self
    }
}

impl<'de> Deserialize<'de> for Scenario {
    fn deserialize<D: serde::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        use serde::de::Error;
        let value = Value::deserialize(deserializer)?;
        let kind = value.get("robot").and_then(|robot| robot.get("kind")).and_then(Value::as_str);
        (RobotKind::of_word(kind).read)(value).map_err(D::Error::custom)
    }
}

/// Of the struct of a kind's keys, [`Keys::section`] and [`Keys::put_section`].
macro_rules! sections {
    ($($name:ident),+ $(,)?) => {
        fn section(&self, name: &str) -> Option<serde_json::Value> {
            let value = match name {
                $(stringify!($name) => serde_json::to_value(&self.$name),)+
                _ => return None,
            };
            Some(value.unwrap_or_else(|error| unreachable!("every scenario is a tree of strings and numbers: {error}")))
        }

        fn put_section(&mut self, name: &str, value: serde_json::Value) -> serde_json::Result<()> {
            match name {
                $(stringify!($name) => self.$name = serde_json::from_value(value)?,)+
                // As the reader of the whole says it.
                _ => drop(serde_json::from_value::<Self>([(name, value)].into_iter().collect())?),
            }
            Ok(())
        }
    };
}

pub(super) use sections;

/// The keys of the whole, in the order of the file.
pub(in crate::campaign) const SECTIONS: [&str; 9] =
    ["hairpin", "robot", "seed", "world", "task", "generate", "execute", "vary", "spec"];
