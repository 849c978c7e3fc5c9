//! Keys of a scenario that are given beside its file.

use std::path::Path;

use hairpin::campaign::scenario::Record;
use hairpin_formats::recordings;

/// A dotted key and its value as TOML.
pub type Set = (String, String);

/// The program that flies the missions. JSON's strings are TOML's.
pub fn executor(command: &str) -> Set {
    ("execute.command".to_owned(), serde_json::Value::from(command).to_string())
}

/// The logs that `pattern` names from where the process runs, as the key that it sets in the scenario of the campaign
/// in `folder`.
pub fn logs(folder: &Path, pattern: &str) -> Set {
    let logs = recordings::relative_to(folder, Path::new(""), pattern);
    ("execute.logs".to_owned(), serde_json::Value::from(logs).to_string())
}

/// Of which runs the motion is kept.
pub fn record(kept: Record) -> Set {
    ("execute.record".to_owned(), format!("\"{}\"", kept.word()))
}

/// The root seed.
pub fn seed(seed: u64) -> Set {
    ("seed".to_owned(), seed.to_string())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn commands_are_quoted_as_toml() {
        assert_eq!(executor("sh -c \"x\""), ("execute.command".to_owned(), r#""sh -c \"x\"""#.to_owned()));
    }
}
