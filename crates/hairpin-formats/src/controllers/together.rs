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

use std::sync::atomic::AtomicBool;
use std::sync::{Arc, Mutex};
use std::time::Instant;

use hairpin::campaign::convoy::{Commands, Convoy, Turn, columns, commands};
use hairpin::campaign::user_controller::Turns;
use serde_json::{Map, Value, json};

use crate::executor::excerpt;
use crate::lockstep::{Lockstep, Silence};
use crate::scenario::held;

/// Longest piece of an answer that is quoted, characters.
pub(super) const QUOTED: usize = 120;

/// Whose runs they are.
pub(super) trait Crew: Send + Sync {
    /// A new process.
    ///
    /// # Errors
    /// Why there is none.
    fn process(&self) -> Result<Lockstep, String>;

    /// Why `process`, which goes, did not answer.
    fn complaint(&self, process: &Lockstep, why: Silence) -> String;

    /// Whether nobody waits for an answer any more.
    fn stopped(&self) -> &AtomicBool;

    /// A run has ended well.
    fn came_home(&self);
}

/// All runs that are under way, and the process that steers them.
#[derive(Default)]
pub(super) struct Fleet {
    convoy: Convoy,
    shared: Mutex<Option<Lockstep>>,
}

/// See the file's first line.
pub(super) struct Together {
    crew: Arc<dyn Crew>,
    fleet: Arc<Fleet>,
    run: u64,
    /// It has to be over by then.
    until: Option<Instant>,
}

impl Together {
    /// # Errors
    /// Why there is no process.
    pub(super) fn begin(
        crew: Arc<dyn Crew>,
        fleet: Arc<Fleet>,
        mission: &Value,
        until: Option<Instant>,
    ) -> Result<Self, String> {
        let run = fleet.convoy.join(|run| fleet.welcome(&*crew, run, mission))?;
        Ok(Self { crew, fleet, run, until })
    }
}

impl Turns for Together {
    fn turn(&mut self, t_s: f64, state: &Value, reference: &Value) -> Result<Value, String> {
        let turn = Turn { run: self.run, t_s, state: state.clone(), reference: reference.clone() };
        self.fleet.convoy.turn(turn, |asked| self.fleet.ask(&*self.crew, asked, self.until))
    }

    fn finish(self: Box<Self>) {
        self.crew.came_home();
    }
}

impl Drop for Together {
    fn drop(&mut self) {
        self.fleet.convoy.leave();
    }
}

impl Fleet {
    /// Tells the process of a run that sets out.
    fn welcome(&self, crew: &dyn Crew, run: u64, mission: &Value) -> Result<(), String> {
        let mut shared = held(&self.shared);
        let process = match &mut *shared {
            Some(process) => process,
            none => none.insert(crew.process()?),
        };
        let told = process.tell(&json!({ "type": "join", "run": run, "mission": mission }));
        told.map_err(|why| crew.complaint(process, why))
    }

    /// The commands of all that are under way.
    fn ask(&self, crew: &dyn Crew, asked: &[Turn], until: Option<Instant>) -> Result<Commands, String> {
        let mut shared = held(&self.shared);
        let mut process = shared.take().ok_or("it steers no more")?;
        let found = answer(crew, &mut process, asked, until)?;
        *shared = Some(process);
        Ok(found)
    }
}

fn answer(crew: &dyn Crew, process: &mut Lockstep, asked: &[Turn], until: Option<Instant>) -> Result<Commands, String> {
    if process.unasked().is_some() {
        return Err("it said a line where nothing was asked: must be one line for each \"control\"".into());
    }
    let mut question = columns(asked);
    question["type"] = "control".into();
    let heard = process.tell(&question).and_then(|()| process.hear(crew.stopped(), until));
    commands(&table(&heard.map_err(|why| crew.complaint(process, why))?)?, asked.len())
}

/// What a line says.
///
/// # Errors
/// That it is no table.
pub(super) fn table(line: &[u8]) -> Result<Map<String, Value>, String> {
    serde_json::from_slice(line).map_err(|error| {
        let said = excerpt(&String::from_utf8_lossy(line), QUOTED);
        format!("it answered `{said}`: must be a line of JSON, a table of finite numbers ({error})")
    })
}
