//! Runs that are steered together: whoever of them comes to a turn last asks for all.
//!
//! A run waits at its turn until all that are under way have come to theirs, so that one question has the states of all
//! of them and one answer their commands. Each stays on a thread of its own, and nothing in the simulator knows of it:
//! as many are under way as there are threads that fly. A run must not wait for another one's end.

use std::collections::HashMap;
use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};

use serde_json::{Map, Value, json};

/// The commands of the runs that ask, in their order, each by itself right or wrong.
pub type Commands = Vec<Result<Value, String>>;

/// What a run is asked with at its turn.
#[derive(Debug, Clone)]
pub struct Turn {
    /// Its number, from [`Convoy::join`].
    pub run: u64,
    /// s.
    pub t_s: f64,
    /// A table of keys.
    pub state: Value,
    /// A table of keys.
    pub reference: Value,
}

/// The runs that are under way.
#[derive(Debug, Default)]
pub struct Convoy {
    here: Mutex<Here>,
    answered: Condvar,
}

#[derive(Debug, Default)]
struct Here {
    last: u64,
    under_way: usize,
    asked: Vec<Turn>,
    answers: HashMap<u64, Result<Value, String>>,
}

impl Convoy {
    /// The number of a run that sets out, which `tell` is told before any turn is asked that it has to come to.
    ///
    /// # Errors
    /// As of `tell`: then it is not under way.
    pub fn join(&self, tell: impl FnOnce(u64) -> Result<(), String>) -> Result<u64, String> {
        let mut here = self.here();
        here.last += 1;
        tell(here.last)?;
        here.under_way += 1;
        Ok(here.last)
    }

    /// A run is over, or given up.
    pub fn leave(&self) {
        self.here().under_way -= 1;
        self.answered.notify_all();
    }

    /// The command of the run whose turn it is, of those that `ask` gives of all; an error of `ask` is that of each.
    ///
    /// # Errors
    /// Why there is none.
    pub fn turn(&self, turn: Turn, ask: impl Fn(&[Turn]) -> Result<Commands, String>) -> Result<Value, String> {
        let run = turn.run;
        let mut here = self.here();
        here.asked.push(turn);
        loop {
            if let Some(answer) = here.answers.remove(&run) {
                return answer;
            }
            if here.asked.len() < here.under_way {
                here = self.answered.wait(here).unwrap_or_else(PoisonError::into_inner);
                continue;
            }
            let mut asked = std::mem::take(&mut here.asked);
            // The order in which threads come is nobody's.
            asked.sort_by_key(|turn| turn.run);
            let commands = ask(&asked).unwrap_or_else(|why| vec![Err(why); asked.len()]);
            here.answers.extend(asked.iter().map(|turn| turn.run).zip(commands));
            self.answered.notify_all();
        }
    }

    fn here(&self) -> MutexGuard<'_, Here> {
        self.here.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// The turns as one question: of each key a list with an entry of each run.
pub fn columns(turns: &[Turn]) -> Value {
    let runs: Vec<u64> = turns.iter().map(|turn| turn.run).collect();
    let times: Vec<f64> = turns.iter().map(|turn| turn.t_s).collect();
    let state = stacked(turns.iter().map(|turn| &turn.state));
    let reference = stacked(turns.iter().map(|turn| &turn.reference));
    json!({ "runs": runs, "t_s": times, "state": state, "reference": reference })
}

fn stacked<'a>(tables: impl Iterator<Item = &'a Value> + Clone) -> Value {
    let keys = tables.clone().next().and_then(Value::as_object);
    let column = |key: &String| (key.clone(), tables.clone().map(|table| table[key].clone()).collect());
    Value::Object(keys.into_iter().flat_map(Map::keys).map(column).collect())
}

/// The commands of `count` runs, of an answer that has a list with an entry of each of them for every key.
///
/// An entry that is null, or has one in it, was no finite number.
///
/// # Errors
/// That it is no such answer.
pub fn commands(answer: &Map<String, Value>, count: usize) -> Result<Commands, String> {
    let columns = answer.iter().map(|(key, values)| {
        let rows = values.as_array().filter(|rows| rows.len() == count);
        rows.map(|rows| (key, rows)).ok_or_else(|| format!("its `{key}` must have a row for each of {count} runs"))
    });
    let columns = columns.collect::<Result<Vec<_>, _>>()?;
    let row = |run: usize| {
        let keys: Map<String, Value> = columns.iter().map(|(key, rows)| ((*key).clone(), rows[run].clone())).collect();
        let has_gap = |value: &Value| value.is_null() || value.as_array().is_some_and(|row| row.contains(&Value::Null));
        if keys.values().any(has_gap) {
            return Err("its answer has numbers that are not finite".to_owned());
        }
        Ok(Value::Object(keys))
    };
    Ok((0..count).map(row).collect())
}
