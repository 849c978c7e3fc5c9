//! The sheet of an experiment, `experiments/NAME.toml`: how large it is, and what its source printed.

use hairpin_formats::library;
use hairpin_jobs::Problem;
use serde::de::DeserializeOwned;
use thiserror::Error;
use toml::{Table, Value};

/// Why a sheet cannot be used.
#[derive(Debug, Error)]
pub(super) enum SheetError {
    /// No shipped sheet has the name.
    #[error("no experiment `{name}`, must be one of {known}")]
    Unknown {
        /// The name.
        name: String,
        /// Those that there are.
        known: String,
    },
    /// An override that is not KEY=VALUE with a TOML value.
    #[error("`{text}`, must be KEY=VALUE with a TOML value, such as points=[10,12]: {cause}")]
    Override {
        /// What was given.
        text: String,
        /// What the parser says.
        cause: String,
    },
    /// A size out of bounds.
    #[error("`{key}` = {value}: must be {bound}")]
    Bound {
        /// The key.
        key: String,
        /// What was given.
        value: String,
        /// What it must be.
        bound: String,
    },
    /// A table of the sheet does not hold what the experiment needs.
    #[error("[{table}] of experiments/{name}.toml: {cause}")]
    Content {
        /// The experiment.
        name: String,
        /// `size` or `printed`.
        table: &'static str,
        /// What the parser says.
        cause: String,
    },
}

impl SheetError {
    /// Nothing is called `name`.
    pub(super) fn unknown(name: &str) -> Self {
        let known: Vec<&str> = library::experiments().map(|sheet| sheet.name).collect();
        Self::Unknown { name: name.into(), known: known.join(", ") }
    }
}

impl From<SheetError> for Problem {
    fn from(error: SheetError) -> Self {
        Self::input(error)
    }
}

/// What a sheet says: `[size]`, with the keys of `[full]` in their place at full size and within `[bounds]`, and
/// `[printed]`.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Sheet {
    name: String,
    size: Table,
    printed: Table,
}

impl Sheet {
    /// The shipped sheet `name`; `sets` are KEY=VALUE over its sizes.
    ///
    /// # Errors
    /// No sheet has the name; an override is no TOML; a number, or one of a list, out of bounds.
    pub(super) fn shipped(name: &str, full: bool, sets: &[String]) -> Result<Self, SheetError> {
        let Some(shipped) = library::experiments().find(|sheet| sheet.name == name) else {
            return Err(SheetError::unknown(name));
        };
        let refuse = |cause: toml::de::Error| SheetError::Content {
            name: name.into(),
            table: "size",
            cause: cause.message().to_owned(),
        };
        let mut tables: Table = shipped.text.parse().map_err(refuse)?;
        let mut take = |key| match tables.remove(key) {
            Some(Value::Table(table)) => table,
            _ => Table::new(),
        };
        let (mut size, over, printed, bounds) = (take("size"), take("full"), take("printed"), take("bounds"));
        if full {
            size.extend(over);
        }
        for text in sets {
            let told = |error: toml::de::Error| error.message().to_owned();
            let one_line = if text.contains(['\n', '\r']) { Err("more than one line".into()) } else { Ok(text) };
            let set = one_line.and_then(|text| text.parse::<Table>().map_err(told));
            size.extend(set.map_err(|cause| SheetError::Override { text: text.clone(), cause })?);
        }
        bounds.iter().try_for_each(|(key, bounds)| check(key, size.get(key), bounds))?;
        Ok(Self { name: name.into(), size, printed })
    }

    /// How large the experiment is to be.
    ///
    /// # Errors
    /// A key that is missing, unknown or of another type.
    pub(super) fn size<T: DeserializeOwned>(&self) -> Result<T, SheetError> {
        self.read("size", &self.size)
    }

    /// What the source printed.
    ///
    /// # Errors
    /// As [`size`](Self::size).
    pub(super) fn printed<T: DeserializeOwned>(&self) -> Result<T, SheetError> {
        self.read("printed", &self.printed)
    }

    fn read<T: DeserializeOwned>(&self, table: &'static str, found: &Table) -> Result<T, SheetError> {
        let refuse = |error: toml::de::Error| SheetError::Content {
            name: self.name.clone(),
            table,
            cause: error.message().into(),
        };
        found.clone().try_into().map_err(refuse)
    }
}

/// Whether the number that `key` has, or each of its list, is within `bounds`, two numbers. What is neither is told by
/// whoever reads it.
fn check(key: &str, value: Option<&Value>, bounds: &Value) -> Result<(), SheetError> {
    let refuse =
        |value: &Value, bound: String| Err(SheetError::Bound { key: key.to_owned(), value: value.to_string(), bound });
    let number = |value: &Value| value.as_float().or(value.as_integer().map(|whole| whole as f64));
    let all = match value {
        Some(Value::Array(all)) if all.is_empty() => {
            return refuse(&Value::Array(Vec::new()), "one number at least".into());
        }
        Some(Value::Array(all)) => &all[..],
        Some(one) => std::slice::from_ref(one),
        None => &[],
    };
    let Some([Some(least), Some(greatest)]) =
        bounds.as_array().map(|both| [0, 1].map(|end| both.get(end).and_then(number)))
    else {
        return refuse(bounds, "two numbers under [bounds]".into());
    };
    match all.iter().find(|one| number(one).is_some_and(|number| !(least..=greatest).contains(&number))) {
        Some(wrong) => refuse(wrong, format!("{least} … {greatest}")),
        None => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[derive(Debug, serde::Deserialize, PartialEq)]
    #[serde(deny_unknown_fields)]
    struct Size {
        instances: usize,
        points: Vec<usize>,
        seed: u64,
        dfs_limit_s: f64,
        proof_limit_s: f64,
    }

    #[test]
    fn full_sizes_and_overrides_go_over_the_sheet() {
        let sheet = |full, sets: &[&str]| {
            let sets: Vec<String> = sets.iter().map(|set| (*set).into()).collect();
            Sheet::shipped("robtest-table-1", full, &sets)
        };
        let size = |full, sets: &[&str]| sheet(full, sets).unwrap().size::<Size>();
        let (small, full) = (size(false, &[]).unwrap(), size(true, &[]).unwrap());
        assert_eq!((small.instances, &small.points), (full.instances, &full.points));
        assert!(small.dfs_limit_s < full.dfs_limit_s && full.dfs_limit_s == 3600.0);
        assert_eq!(size(true, &["points=[3, 4]"]).unwrap(), Size { points: vec![3, 4], ..full });
        let told = |result: Result<Size, SheetError>| result.unwrap_err().to_string();
        assert!(told(size(false, &["instance=3"])).contains("unknown field `instance`"));
        assert!(told(size(false, &["instances=3.5"])).contains("robtest-table-1.toml"));
        for set in ["instances=0", "points=[3, 100000]", "points=[]", "proof_limit_s=nan", "dfs_limit_s=-1.0"] {
            assert!(matches!(sheet(false, &[set]), Err(SheetError::Bound { .. })), "{set}");
        }
        let told = sheet(false, &["points=[3, 100000]"]).unwrap_err().to_string();
        assert_eq!(told, "`points` = 100000: must be 1 … 1000");
        for set in ["instances", "=3", "instances=1\nx=2"] {
            assert!(matches!(sheet(false, &[set]), Err(SheetError::Override { .. })), "{set}");
        }
        assert!(Sheet::shipped("table-2", false, &[]).unwrap_err().to_string().contains("robtest-table-1"));
    }
}
