//! Controllers of the user's on our plants: a Python function, or a program that answers line by line.
//!
//! ```text
//! > {"type":"reset","mission":{"waypoints_m":[[x,y,z],…],"accept_m":1.0,"robot":{"name":…},"planned_s":27.1}}
//! < {}
//! > {"type":"control","t_s":0.01,"state":{"p_m":[…],"v_m_s":[…],"q_wxyz":[…],"w_rad_s":[…]},
//!    "reference":{"waypoints_m":[…],"next":1,"p_m":[…],"v_m_s":[…],"a_m_s2":[…],"yaw_rad":0.0}}
//! < {"v_m_s":[…]}
//! ```
//!
//! SI, world frame, in lockstep: the plant waits. The last four of `reference` are of the planned motion at that time,
//! null where there is none. A program may leave `reset` unanswered.
//!
//! Keys of states, references and commands of each kind of robot: docs/own-controllers.md. A Python function that takes
//! many runs at once steers all that are under way in one process ([`Together`]).
//!
//! Whatever goes wrong at a turn ends that run, and its process with it; the next run has a new one.

mod together;

use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, OnceLock};
use std::time::{Duration, Instant};

use hairpin::campaign::UserCode;
use hairpin::campaign::user_controller::{Turns, UserSteering};
use serde::Serialize;
use serde_json::{Map, Value, json};

use self::together::{Crew, Fleet, QUOTED, Together, table};
use crate::executor::{Command, excerpt};
use crate::lockstep::{Lockstep, Silence};
use crate::scenario::{driver, held};

/// So many runs in a row that were left without an answer are the end: what hangs costs three times its limit.
const MOST_LATE: usize = 3;

/// What answers.
#[derive(Debug, Clone)]
pub(crate) enum Source {
    /// A Python file.
    Python {
        /// The file.
        path: PathBuf,
        /// No others beside it.
        alone: bool,
    },
    /// A program.
    Command(Command),
}

/// Whoever steers, for all runs of a campaign: processes, one for each run that is under way.
pub(crate) struct Steersman {
    source: Source,
    name: String,
    /// Wall-clock limit of a run.
    limit: Duration,
    /// Time between two turns, s.
    period: f64,
    /// Processes that steer nothing just now.
    idle: Mutex<Vec<Lockstep>>,
    /// Whether one process steers all runs, which it says itself.
    takes_many: OnceLock<bool>,
    fleet: Arc<Fleet>,
    late: AtomicUsize,
    trouble: Mutex<Option<String>>,
    stopped: AtomicBool,
}

impl Steersman {
    /// Called `name` in reports, with `period` s from turn to turn and `limit` for a run.
    pub(crate) fn new(source: Source, name: &str, period: f64, limit: Duration) -> Self {
        let (idle, takes_many, fleet, late, trouble, stopped) = Default::default();
        Self { source, name: name.to_owned(), limit, period, idle, takes_many, fleet, late, trouble, stopped }
    }

    /// Whether it is told the waypoints once a run; a program is told them every time.
    fn remembers(&self) -> bool {
        matches!(self.source, Source::Python { .. })
    }

    /// A process for a run.
    ///
    /// # Errors
    /// Why there is none.
    fn process(&self) -> Result<Lockstep, String> {
        if let Some(trouble) = self.trouble() {
            return Err(trouble);
        }
        // Of a run that has ended nothing is left to be said: who says more would be heard as another run's.
        let mut idle = std::iter::from_fn(|| held(&self.idle).pop());
        match idle.find_map(|mut process| process.unasked().is_none().then_some(process)) {
            Some(process) => Ok(process),
            None => self.start(),
        }
    }

    /// Takes one back whose run has ended.
    fn give_back(&self, process: Lockstep) {
        self.late.store(0, Ordering::Relaxed);
        held(&self.idle).push(process);
    }

    /// Why `process`, which goes, did not answer.
    fn complaint(&self, process: &Lockstep, why: Silence) -> String {
        let seconds = self.limit.as_secs_f64();
        match why {
            Silence::Stopped => "stopped".into(),
            Silence::Endless => "it answered a line that does not end".into(),
            Silence::Gone => match process.last_words() {
                last if last.is_empty() => "it ended without an answer".into(),
                last => last,
            },
            Silence::Late => {
                if self.late.fetch_add(1, Ordering::Relaxed) + 1 >= MOST_LATE {
                    let why = format!("it left {MOST_LATE} runs in a row unfinished (execute.timeout_s = {seconds})");
                    held(&self.trouble).get_or_insert(why);
                }
                format!("its run was not over after {seconds} s on the clock (execute.timeout_s)")
            }
        }
    }

    fn start(&self) -> Result<Lockstep, String> {
        let (mut command, program) = match &self.source {
            Source::Python { path, alone } => (driver(path, *alone, "controller"), "python3".to_owned()),
            Source::Command(command) => (command.into(), command.words().next().unwrap_or_default().to_owned()),
        };
        let mut process = Lockstep::start(&mut command).map_err(|error| {
            let why = format!("`{program}` cannot be started: {error}");
            held(&self.trouble).get_or_insert(why.clone());
            why
        })?;
        if self.remembers() {
            match process.hear(&self.stopped, None) {
                Ok(line) if line == b"ready" || line == b"ready for many" => {
                    self.takes_many.get_or_init(|| line != b"ready");
                }
                Ok(_) => return Err(self.complaint(&process, Silence::Gone)),
                Err(why) => return Err(self.complaint(&process, why)),
            }
        }
        Ok(process)
    }
}

impl Crew for Steersman {
    fn process(&self) -> Result<Lockstep, String> {
        self.process()
    }

    fn complaint(&self, process: &Lockstep, why: Silence) -> String {
        self.complaint(process, why)
    }

    fn stopped(&self) -> &AtomicBool {
        &self.stopped
    }

    fn came_home(&self) {
        self.late.store(0, Ordering::Relaxed);
    }
}

impl UserCode for Steersman {
    fn trouble(&self) -> Option<String> {
        held(&self.trouble).clone()
    }

    fn try_out(&self) -> Result<(), String> {
        let process = self.process().map_err(|why| format!("{}: {why}", self.name))?;
        held(&self.idle).push(process);
        Ok(())
    }

    fn stop(&self) {
        self.stopped.store(true, Ordering::Relaxed);
    }
}

impl UserSteering for Steersman {
    fn period(&self) -> f64 {
        self.period
    }

    fn begin(self: Arc<Self>, mission: Value) -> Result<Box<dyn Turns>, String> {
        let until = Instant::now().checked_add(self.limit);
        if self.takes_many.get() == Some(&true) {
            let fleet = self.fleet.clone();
            return Ok(Box::new(Together::begin(self, fleet, &mission, until)?));
        }
        let process = self.process()?;
        let waypoints = mission.get("waypoints_m").cloned().filter(|_| !self.remembers());
        // A program need not answer; if it does, that comes before its first command.
        let mut run = Run { may_answer: waypoints.is_some(), steersman: self, process, until, waypoints };
        let told = run.process.tell(&json!({ "type": "reset", "mission": mission }));
        told.map_err(|why| run.steersman.complaint(&run.process, why))?;
        if run.steersman.remembers() {
            run.hear()?;
        }
        Ok(Box::new(run))
    }
}

/// A run that is under way.
struct Run {
    steersman: Arc<Steersman>,
    process: Lockstep,
    /// It has to be over by then.
    until: Option<Instant>,
    /// What a program is told every time.
    waypoints: Option<Value>,
    /// Whether `reset` may still be answered.
    may_answer: bool,
}

impl Run {
    /// Its next line, a table, but for `type`, which is not looked at.
    fn hear(&mut self) -> Result<Map<String, Value>, String> {
        let line = self.process.hear(&self.steersman.stopped, self.until);
        let mut keys = table(&line.map_err(|why| self.steersman.complaint(&self.process, why))?)?;
        keys.remove("type");
        Ok(keys)
    }
}

/// What is said at a turn.
#[derive(Serialize)]
#[serde(tag = "type", rename = "control")]
struct Turn<'a> {
    t_s: f64,
    state: &'a Value,
    reference: Bearing<'a>,
}

/// Where to go.
#[derive(Serialize)]
struct Bearing<'a> {
    #[serde(skip_serializing_if = "Option::is_none")]
    waypoints_m: Option<&'a Value>,
    #[serde(flatten)]
    planned: &'a Value,
}

impl Turns for Run {
    fn turn(&mut self, t_s: f64, state: &Value, reference: &Value) -> Result<Value, String> {
        // Taken for the answer to this turn, it would be one turn late, and so would all others.
        let unasked = if self.may_answer { None } else { self.process.unasked() };
        if let Some(line) = unasked {
            let said = excerpt(&String::from_utf8_lossy(&line), QUOTED);
            return Err(format!("it said `{said}` where nothing was asked: must be one line for each \"control\""));
        }
        let reference = Bearing { waypoints_m: self.waypoints.as_ref(), planned: reference };
        let told = self.process.tell(&Turn { t_s, state, reference });
        told.map_err(|why| self.steersman.complaint(&self.process, why))?;
        let answer = self.hear()?;
        // What is said to `reset` has no command in it.
        let says_nothing = !answer.values().any(|value| value.is_number() || value.is_array());
        let is_for_reset = std::mem::take(&mut self.may_answer) && says_nothing;
        Ok(Value::Object(if is_for_reset { self.hear()? } else { answer }))
    }

    fn finish(self: Box<Self>) {
        let Self { steersman, process, .. } = *self;
        steersman.give_back(process);
    }
}
