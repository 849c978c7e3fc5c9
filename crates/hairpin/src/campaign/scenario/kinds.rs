//! The kinds of scenarios: one row each.

use std::any::Any;
use std::collections::BTreeMap;
use std::ops::{Deref, DerefMut};
use std::sync::Arc;

use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::{Distribution, GroundDescription, KeyPath, Keys};

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

    /// All kinds; robots that do not say theirs are of the first.
    pub fn all() -> impl Iterator<Item = &'static Self> {
        KINDS.iter()
    }

    /// The JSON Schema of its scenarios.
    pub fn schema(&self) -> Value {
        (self.schema)()
    }
}

/// Hands the table of the kinds to a macro: of each its variant of [`Scenario`] with its keys, the words of
/// `robot.kind`, and the setup that is built from them. Robots that do not say their kind are of the first. Paths are
/// those below `campaign`.
macro_rules! kinds_of_robots {
    ($with:ident) => {
        $with! {
            Flight(scenario::FlightScenario) of &["quadrotor"], built by flight::FlightSetup;
            Drive(scenario::DriveScenario) of GroundDescription::KINDS, built by drive::DriveSetup;
            Arm(scenario::ArmScenario) of &["arm"], built by arm::ArmSetup;
            Boat(boat::BoatScenario) of &["boat"], built by boat::BoatSetup;
        }
    };
}

pub(in crate::campaign) use kinds_of_robots;

/// The sum of all kinds' keys, and how it is read and written.
macro_rules! kinds {
    ($($Kind:ident($($Keys:ident)::+) of $words:expr, built by $($Setup:ident)::+;)+) => {
        /// A scenario file; the robot's `kind` tells which.
        #[derive(Debug, Clone, PartialEq)]
        pub enum Scenario {
            $(#[doc = concat!("The keys of kind `", stringify!($Kind), "`.")] $Kind(Arc<crate::campaign::$($Keys)::+>),)+
        }

        /// Readers are not generic, so that those of all sections are compiled once, with this crate.
        const KINDS: &[RobotKind] = &[$(RobotKind {
            words: $words,
            read: |value| serde_json::from_value(value).map(Arc::new).map(Scenario::$Kind),
            schema: || schemars::schema_for!(crate::campaign::$($Keys)::+).to_value(),
        }),+];

        impl Deref for Scenario {
            type Target = dyn Keys;

            fn deref(&self) -> &(dyn Keys + 'static) {
                match self { $(Self::$Kind(keys) => &**keys,)+ }
            }
        }

        impl DerefMut for Scenario {
            fn deref_mut(&mut self) -> &mut (dyn Keys + 'static) {
                match self { $(Self::$Kind(keys) => Arc::<crate::campaign::$($Keys)::+>::make_mut(keys),)+ }
            }
        }

        impl Serialize for Scenario {
            fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
                match self { $(Self::$Kind(keys) => keys.as_ref().serialize(serializer),)+ }
            }
        }
    };
}

kinds_of_robots!(kinds);

impl Scenario {
    /// Its keys, if they are a `K`.
    pub fn own<K: Keys>(&self) -> Option<&K> {
        (&**self as &dyn Any).downcast_ref()
    }

    /// The same, for changes.
    pub fn own_mut<K: Keys>(&mut self) -> Option<&mut K> {
        (&mut **self as &mut dyn Any).downcast_mut()
    }

    /// Takes over who executes and what is within spec from `now`, as [`Keys::adopt`] does, and what is drawn of the
    /// spec: a limit that was drawn once is none of the limits now. Other draws are what a case was found under.
    /// `None`, and nothing is taken over: it is of another kind.
    pub fn adopt(&mut self, now: &dyn Keys) -> Option<()> {
        (**self).adopt(now)?;
        let of_spec = |key: &str| {
            KeyPath::parse(key).is_some_and(|path| path.segments().first().is_some_and(|table| table == "spec"))
        };
        let vary = self.vary_mut();
        vary.retain(|key, _| !of_spec(key));
        vary.extend(now.vary().iter().filter(|(key, _)| of_spec(key)).map(|(key, draw)| (key.clone(), draw.clone())));
        Some(())
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
