//! Scores of the user's own: the Python file that `score = "python:FILE"` names.
//!
//! The file defines `score(leg)` and, if legs leave something to the next, `left(leg)`; `leg` is a dictionary. Both
//! must be functions of the leg alone.

use std::collections::HashMap;
use std::path::PathBuf;
use std::sync::{Arc, Mutex};

use hairpin::campaign::scenario::PYTHON;
use hairpin::campaign::user_score::{LegFacts, NAME};
use hairpin::campaign::{Attached, LegScorer, UserCode};

use super::attached::{Wrong, attached};
use super::python::{Python, held};
use super::whole::read_file;

/// Legs whose scores are kept, so that one that is asked for again costs no question.
const MOST_KNOWN: usize = 1 << 20;

/// Reads the score of the user's own that `score` names, if it does; `key` is its key. A resolved scenario's is
/// [`NAME`]. One that stands `alone` finds no other Python files beside it.
pub(super) fn read(
    key: &str,
    score: &mut String,
    find: &dyn Fn(&str) -> PathBuf,
    alone: bool,
) -> Result<Option<Attached<dyn LegScorer>>, Wrong> {
    let Some(file) = score.strip_prefix(PYTHON) else { return Ok(None) };
    let path = find(file);
    let wrong = |bound: String| Wrong { key: key.to_owned(), value: score.clone(), bound, at: None };
    let bytes = read_file(&path).map_err(|why| wrong(format!("`{file}` cannot be read: {why}")))?;
    let user = attached(Arc::new(PythonScore::new((path, alone), score)) as Arc<dyn LegScorer>, bytes, NAME, score);
    *score = format!("{PYTHON}{NAME}");
    Ok(Some(user))
}

/// What is known of a leg, as bits.
type Key = [u64; 20];

struct PythonScore {
    python: Python,
    known: Mutex<HashMap<Key, [f64; 2]>>,
}

impl PythonScore {
    fn new(file: (PathBuf, bool), given: &str) -> Self {
        Self { python: Python::new(file, given, "score"), known: Mutex::default() }
    }
}

fn key(leg: &LegFacts) -> Key {
    let LegFacts { v_in_m_s, v_out_m_s, turn_rad, length_m, climb_m, slope_in, ground, duration_s, .. } = *leg;
    let places = [leg.from_m, leg.to_m, leg.start_m, leg.end_m];
    let mut key = [0; 20];
    let numbers = [v_in_m_s, v_out_m_s, turn_rad, length_m, climb_m, slope_in, ground, duration_s];
    for (bits, number) in key.iter_mut().zip(numbers.iter().chain(places.as_flattened())) {
        *bits = number.to_bits();
    }
    key
}

impl LegScorer for PythonScore {
    fn own_and_left(&self, legs: &[LegFacts]) -> Vec<[f64; 2]> {
        let keys: Vec<Key> = legs.iter().map(key).collect();
        let mut parts: Vec<Option<[f64; 2]>> = {
            let known = held(&self.known);
            keys.iter().map(|key| known.get(key).copied()).collect()
        };
        let unknown: Vec<usize> = (0..legs.len()).filter(|place| parts[*place].is_none()).collect();
        if !unknown.is_empty() {
            let asked: Vec<&LegFacts> = unknown.iter().map(|place| &legs[*place]).collect();
            let answers = self.python.ask::<[f64; 2]>(&asked, asked.len()).unwrap_or_default();
            let mut known = held(&self.known);
            if known.len() + answers.len() > MOST_KNOWN {
                known.clear();
            }
            for (place, answer) in unknown.into_iter().zip(answers) {
                known.insert(keys[place], answer);
                parts[place] = Some(answer);
            }
        }
        parts.into_iter().map(|part| part.unwrap_or([f64::NAN; 2])).collect()
    }
}

impl UserCode for PythonScore {
    fn trouble(&self) -> Option<String> {
        self.python.trouble()
    }

    fn try_out(&self) -> Result<(), String> {
        self.python.try_out()
    }

    fn stop(&self) {
        self.python.stop();
    }
}
