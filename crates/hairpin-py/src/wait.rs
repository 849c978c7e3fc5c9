//! A job under way, and whoever waits for it in Python: the interpreter is free meanwhile, what raises in a callback or
//! at Ctrl-C stops the job, which keeps what is done.

use std::panic::resume_unwind;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{RecvTimeoutError, sync_channel};
use std::sync::{Mutex, PoisonError};
use std::thread;
use std::time::Duration;

use hairpin_jobs::{Problem, Watch};
use pyo3::prelude::*;

use crate::problem::raised;

/// Between two looks at signals and at how far the job is.
const TICK: Duration = Duration::from_millis(50);

/// Who waits, as jobs know him.
#[derive(Default)]
struct Caller {
    stopped: AtomicBool,
    heard: Mutex<Heard>,
}

/// What a job said since somebody looked.
#[derive(Default)]
struct Heard {
    progress: Option<(&'static str, usize, usize)>,
    warnings: Vec<String>,
}

impl Caller {
    fn hear(&self, say: impl FnOnce(&mut Heard)) {
        say(&mut self.heard.lock().unwrap_or_else(PoisonError::into_inner));
    }

    fn take(&self) -> Heard {
        std::mem::take(&mut *self.heard.lock().unwrap_or_else(PoisonError::into_inner))
    }
}

impl Watch for Caller {
    fn stopped(&self) -> bool {
        self.stopped.load(Ordering::Relaxed)
    }

    fn progress(&self, what: &'static str, done: usize, of: usize) {
        self.hear(|heard| match &mut heard.progress {
            // Threads tell out of order.
            Some((before, most, all)) if *before == what => (*most, *all) = (done.max(*most), of),
            other => *other = Some((what, done, of)),
        });
    }

    fn warn(&self, line: &str) {
        self.hear(|heard| heard.warnings.push(line.to_owned()));
    }
}

/// Who sees how far a job is, and by how many threads it is done.
#[derive(FromPyObject)]
pub(crate) struct Waiting {
    /// Threads; as many as the machine has if not given.
    threads: Option<usize>,
    /// Called with what is done, how much of it, and of how much; `None`: nobody.
    progress: Option<Py<PyAny>>,
    /// Called with every line beside the result.
    warn: Py<PyAny>,
}

impl Waiting {
    fn tell(&self, py: Python<'_>, heard: Heard) -> PyResult<()> {
        for line in heard.warnings {
            self.warn.call1(py, (line,))?;
        }
        if let (Some(progress), Some(at)) = (&self.progress, heard.progress) {
            progress.call1(py, at)?;
        }
        Ok(())
    }

    /// Does `job` while the interpreter is free.
    ///
    /// # Errors
    /// The job's own; what a callback raised; Ctrl-C.
    pub(crate) fn wait<T: Send>(
        &self,
        py: Python<'_>,
        job: impl FnOnce(&dyn Watch) -> Result<T, Problem> + Send,
    ) -> PyResult<T> {
        let caller = Caller::default();
        let (came, interrupted) = py.detach(|| {
            thread::scope(|scope| {
                // Closes with the job, however that ends.
                let (at_work, over) = sync_channel::<()>(0);
                let (caller, threads) = (&caller, self.threads);
                let working = scope.spawn(move || {
                    let _at_work = at_work;
                    by_threads(threads, || job(caller))
                });
                let mut interrupted: Option<PyErr> = None;
                while over.recv_timeout(TICK) == Err(RecvTimeoutError::Timeout) {
                    let looked = Python::attach(|py| {
                        py.check_signals()?;
                        self.tell(py, caller.take())
                    });
                    if let Err(error) = looked {
                        caller.stopped.store(true, Ordering::Relaxed);
                        interrupted.get_or_insert(error);
                    }
                }
                (working.join().unwrap_or_else(|panic| resume_unwind(panic)), interrupted)
            })
        });
        let told = self.tell(py, caller.take());
        if let Some(error) = interrupted {
            if let Err(problem) = came {
                // Where what is done lies, and how to go on.
                let _ = error.value(py).call_method1("add_note", (problem.to_string(),));
            }
            return Err(error);
        }
        let came = came.map_err(|problem| raised(py, &problem))?;
        told.map(|()| came)
    }
}

/// Does `job` by so many threads.
fn by_threads<T: Send>(threads: Option<usize>, job: impl FnOnce() -> Result<T, Problem> + Send) -> Result<T, Problem> {
    let Some(count) = threads else { return job() };
    let pool = rayon::ThreadPoolBuilder::new().num_threads(count).build();
    pool.map_err(|error| Problem::input(format!("`threads` = {count}: {error}")))?.install(job)
}
