//! The problem of jobs, for commands that are no jobs yet.

pub(crate) use hairpin_jobs::Problem;
