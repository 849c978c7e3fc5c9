//! Models of learned scores: the file that `score = "learned:FILE"` names.

use std::path::PathBuf;
use std::sync::Arc;

use hairpin::campaign::Attached;
use hairpin::campaign::learn::{NAME, ScoreModel};
use hairpin::campaign::scenario::LEARNED;

use super::attached::{Wrong, attached};
use super::whole::read_file;

/// Reads the model of `score`, if that is learned; `key` is its key. A resolved scenario's is [`NAME`].
pub(super) fn read(
    key: &str,
    score: &mut String,
    find: &dyn Fn(&str) -> PathBuf,
) -> Result<Option<Attached<ScoreModel>>, Wrong> {
    let Some(file) = score.strip_prefix(LEARNED) else { return Ok(None) };
    let wrong = |bound: String| Wrong { key: key.to_owned(), value: score.clone(), bound, at: None };
    let bytes = read_file(&find(file)).map_err(|why| wrong(format!("`{file}` cannot be read: {why}")))?;
    let model: ScoreModel = serde_json::from_slice(&bytes).map_err(|error| wrong(format!("`{file}`: {error}")))?;
    let model = attached(Arc::new(model), bytes, NAME, score);
    *score = format!("{LEARNED}{NAME}");
    Ok(Some(model))
}
