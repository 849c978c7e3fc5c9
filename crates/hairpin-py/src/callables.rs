//! Callables of Python's that score legs, measure runs or steer them, asked in this process. What is comfortable about
//! them, arrays and one fresh object a run, is made in Python, `hairpin._callables`; here they are asked and answer.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

use hairpin::campaign::convoy::{Commands, Convoy, Turn, columns, commands};
use hairpin::campaign::user_controller::{Turns, UserSteering};
use hairpin::campaign::user_score::LegFacts;
use hairpin::campaign::user_target::RunFacts;
use hairpin::campaign::{CallersCode, LegScorer, RunMeter, UserCode};
use pyo3::prelude::*;
use pyo3::types::PyBytes;
use serde_json::{Value, json};

use crate::plain::{object, value};

/// Numbers of a leg in the table that a score is asked with.
const OF_A_LEG: usize = 20;

/// What of a job's code is callables of Python's.
#[pyclass(frozen, module = "hairpin._native")]
pub(crate) struct Code {
    score: Option<Py<PyAny>>,
    target: Option<Py<PyAny>>,
    controller: Option<Py<PyAny>>,
}

#[pymethods]
impl Code {
    #[new]
    #[pyo3(signature = (score = None, target = None, controller = None))]
    fn new(score: Option<Py<PyAny>>, target: Option<Py<PyAny>>, controller: Option<Py<PyAny>>) -> Self {
        Self { score, target, controller }
    }
}

impl Code {
    /// As jobs know it.
    pub(crate) fn callers(&self) -> CallersCode {
        Python::attach(|py| {
            let asked = |callable: &Option<Py<PyAny>>| callable.as_ref().map(|callable| callable.clone_ref(py));
            CallersCode {
                score: asked(&self.score).map(|callable| Arc::new(Asked::new(callable)) as Arc<dyn LegScorer>),
                target: asked(&self.target).map(|callable| Arc::new(Asked::new(callable)) as Arc<dyn RunMeter>),
                controller: asked(&self.controller).map(|callable| {
                    let make = move |period: f64| {
                        let callable = Python::attach(|py| callable.clone_ref(py));
                        Arc::new(Steersman::new(callable, period)) as Arc<dyn UserSteering>
                    };
                    Arc::new(make) as Arc<_>
                }),
            }
        })
    }
}

/// A callable, and what became of asking it.
struct Asked {
    callable: Py<PyAny>,
    trouble: Mutex<Option<String>>,
    stopped: AtomicBool,
}

impl Asked {
    fn new(callable: Py<PyAny>) -> Self {
        Self { callable, trouble: Mutex::default(), stopped: AtomicBool::new(false) }
    }

    /// Its answer; `None` from when there is trouble on, and once nobody waits any more.
    fn ask<T>(&self, question: impl FnOnce(Python<'_>, &Py<PyAny>) -> PyResult<T>) -> Option<T> {
        if self.stopped.load(Ordering::Relaxed) || self.trouble().is_some() {
            return None;
        }
        let answer = Python::attach(|py| question(py, &self.callable).map_err(|error| error.to_string()));
        answer.map_err(|why| self.trouble.lock().unwrap_or_else(PoisonError::into_inner).get_or_insert(why).len()).ok()
    }
}

impl UserCode for Asked {
    fn trouble(&self) -> Option<String> {
        self.trouble.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }

    fn try_out(&self) -> Result<(), String> {
        self.trouble().map_or(Ok(()), Err)
    }

    fn stop(&self) {
        self.stopped.store(true, Ordering::Relaxed);
    }
}

/// The numbers of a leg in the order of the table: `hairpin._callables` names them.
fn row(leg: &LegFacts) -> [f64; OF_A_LEG] {
    let LegFacts { v_in_m_s, v_out_m_s, turn_rad, length_m, climb_m, slope_in, ground, duration_s, .. } = *leg;
    let numbers = [v_in_m_s, v_out_m_s, turn_rad, length_m, climb_m, slope_in, ground, duration_s];
    let places = [leg.from_m, leg.to_m, leg.start_m, leg.end_m];
    let mut row = [0.0; OF_A_LEG];
    for (cell, number) in row.iter_mut().zip(numbers.iter().chain(places.as_flattened())) {
        *cell = *number;
    }
    row
}

impl LegScorer for Asked {
    fn own_and_left(&self, legs: &[LegFacts]) -> Vec<[f64; 2]> {
        let table: Vec<u8> = legs.iter().flat_map(row).flat_map(f64::to_ne_bytes).collect();
        let answer = self.ask(|py, callable| {
            let answer = callable.call1(py, (PyBytes::new(py, &table),))?;
            answer.extract::<Vec<[f64; 2]>>(py)
        });
        answer.filter(|parts| parts.len() == legs.len()).unwrap_or_else(|| vec![[f64::NAN; 2]; legs.len()])
    }
}

impl RunMeter for Asked {
    fn measure(&self, run: &RunFacts) -> f64 {
        let facts = json!(run);
        let answer = self.ask(|py, callable| callable.call1(py, (object(py, &facts)?,))?.extract::<Option<f64>>(py));
        answer.flatten().unwrap_or(f64::NAN)
    }
}

/// Who steers: a callable that makes a run's own of its mission, or one that takes all runs that are under way.
struct Steersman {
    asked: Asked,
    period: f64,
    takes_many: bool,
    convoy: Convoy,
}

impl Steersman {
    fn new(callable: Py<PyAny>, period: f64) -> Self {
        let marked = Python::attach(|py| callable.bind(py).hasattr("hairpin_vectorised"));
        Self { asked: Asked::new(callable), period, takes_many: marked.unwrap_or(false), convoy: Convoy::default() }
    }

    /// Tells of a run that sets out.
    fn welcome(&self, run: u64, mission: &Value) -> Result<(), String> {
        let told =
            Python::attach(|py| self.asked.callable.call_method1(py, "join", (run, object(py, mission)?)).map(|_| ()));
        told.map_err(|error| error.to_string())
    }

    /// The commands of all that are under way.
    fn ask(&self, asked: &[Turn]) -> Result<Commands, String> {
        if self.asked.stopped.load(Ordering::Relaxed) {
            return Err("stopped".into());
        }
        let answer = Python::attach(|py| {
            value(self.asked.callable.call_method1(py, "turn", (object(py, &columns(asked))?,))?.bind(py))
        });
        match answer {
            Ok(Value::Object(keys)) => commands(&keys, asked.len()),
            Ok(other) => Err(format!("{other} is no dictionary")),
            Err(error) => Err(format!("{error}, of control for {} runs", asked.len())),
        }
    }
}

impl UserCode for Steersman {
    fn trouble(&self) -> Option<String> {
        self.asked.trouble()
    }

    fn try_out(&self) -> Result<(), String> {
        self.asked.try_out()
    }

    fn stop(&self) {
        self.asked.stop();
    }
}

impl UserSteering for Steersman {
    fn period(&self) -> f64 {
        self.period
    }

    fn begin(self: Arc<Self>, mission: Value) -> Result<Box<dyn Turns>, String> {
        if self.takes_many {
            let run = self.convoy.join(|run| self.welcome(run, &mission))?;
            return Ok(Box::new(Together { steersman: self, run }));
        }
        let waypoints = mission.get("waypoints_m").cloned().unwrap_or_default();
        let begun = Python::attach(|py| -> PyResult<_> {
            let control = self.asked.callable.call1(py, (object(py, &mission)?,))?;
            Ok((control, object(py, &waypoints)?.unbind()))
        });
        let (control, waypoints) = begun.map_err(|error| error.to_string())?;
        Ok(Box::new(Run { steersman: self, control, waypoints }))
    }
}

/// A run that is under way.
struct Run {
    steersman: Arc<Steersman>,
    control: Py<PyAny>,
    waypoints: Py<PyAny>,
}

impl Turns for Run {
    fn turn(&mut self, t_s: f64, state: &Value, reference: &Value) -> Result<Value, String> {
        if self.steersman.asked.stopped.load(Ordering::Relaxed) {
            return Err("stopped".into());
        }
        let answer = Python::attach(|py| -> PyResult<Value> {
            let reference = object(py, reference)?;
            reference.set_item("waypoints_m", &self.waypoints)?;
            value(self.control.call1(py, (t_s, object(py, state)?, reference))?.bind(py))
        });
        match answer {
            Ok(Value::Object(keys)) => Ok(Value::Object(keys)),
            Ok(other) => Err(format!("{other} is no dictionary, of control(t_s = {t_s})")),
            Err(error) => Err(format!("{error}, of control(t_s = {t_s})")),
        }
    }

    fn finish(self: Box<Self>) {}
}

/// A run that is under way with others.
struct Together {
    steersman: Arc<Steersman>,
    run: u64,
}

impl Turns for Together {
    fn turn(&mut self, t_s: f64, state: &Value, reference: &Value) -> Result<Value, String> {
        let turn = Turn { run: self.run, t_s, state: state.clone(), reference: reference.clone() };
        self.steersman.convoy.turn(turn, |asked| self.steersman.ask(asked))
    }

    fn finish(self: Box<Self>) {}
}

impl Drop for Together {
    fn drop(&mut self) {
        self.steersman.convoy.leave();
    }
}
