//! The sections of a scenario by name: what every kind's keys answer alike.

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

pub(in crate::campaign) use sections;

/// The keys of the whole, in the order of the file.
pub(in crate::campaign) const SECTIONS: [&str; 9] =
    ["hairpin", "robot", "seed", "world", "task", "generate", "execute", "vary", "spec"];
