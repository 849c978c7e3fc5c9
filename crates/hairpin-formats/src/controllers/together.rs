//! A run of a Python function that takes many: it goes in a convoy, and one process steers them all.
//!
//! ```text
//! > {"type":"join","run":7,"mission":{…}}
//! > {"type":"control","runs":[7,8],"t_s":[…],"state":{"p_m":[[…],[…]],…},"reference":{"next":[…],…}}
//! < {"a_m_s2":[[…],[…]]}
//! ```
//!
//! What is wrong with one row costs its run; where the process fails, all that were asked with it fail, and the
//! next run has a new one.

use std::sync::Arc;
use std::sync::atomic::Ordering;
use std::time::Instant;

use hairpin::campaign::convoy::{Commands, Turn, columns, commands};
use hairpin::campaign::user_controller::Turns;
use serde_json::{Value, json};

use super::{Steersman, table};
use crate::lockstep::Lockstep;
use crate::scenario::held;

/// See the file's first line.
pub(super) struct Together {
    steersman: Arc<Steersman>,
    run: u64,
    /// It has to be over by then.
    until: Option<Instant>,
}

impl Together {
    /// # Errors
    /// Why there is no process.
    pub(super) fn begin(steersman: Arc<Steersman>, mission: &Value, until: Option<Instant>) -> Result<Self, String> {
        let run = steersman.convoy.join(|run| steersman.welcome(run, mission))?;
        Ok(Self { steersman, run, until })
    }
}

impl Turns for Together {
    fn turn(&mut self, t_s: f64, state: &Value, reference: &Value) -> Result<Value, String> {
        let turn = Turn { run: self.run, t_s, state: state.clone(), reference: reference.clone() };
        self.steersman.convoy.turn(turn, |asked| self.steersman.ask(asked, self.until))
    }

    fn finish(self: Box<Self>) {
        self.steersman.late.store(0, Ordering::Relaxed);
    }
}

impl Drop for Together {
    fn drop(&mut self) {
        self.steersman.convoy.leave();
    }
}

impl Steersman {
    /// Tells the process of a run that sets out.
    fn welcome(&self, run: u64, mission: &Value) -> Result<(), String> {
        let mut shared = held(&self.shared);
        let process = match &mut *shared {
            Some(process) => process,
            none => none.insert(self.process()?),
        };
        let told = process.tell(&json!({ "type": "join", "run": run, "mission": mission }));
        told.map_err(|why| self.complaint(process, why))
    }

    /// The commands of all that are under way.
    fn ask(&self, asked: &[Turn], until: Option<Instant>) -> Result<Commands, String> {
        let mut shared = held(&self.shared);
        let mut process = shared.take().ok_or("it steers no more")?;
        let found = self.answer(&mut process, asked, until)?;
        *shared = Some(process);
        Ok(found)
    }

    fn answer(&self, process: &mut Lockstep, asked: &[Turn], until: Option<Instant>) -> Result<Commands, String> {
        if process.unasked().is_some() {
            return Err("it said a line where nothing was asked: must be one line for each \"control\"".into());
        }
        let mut question = columns(asked);
        question["type"] = "control".into();
        let heard = process.tell(&question).and_then(|()| process.hear(&self.stopped, until));
        commands(&table(&heard.map_err(|why| self.complaint(process, why))?)?, asked.len())
    }
}
