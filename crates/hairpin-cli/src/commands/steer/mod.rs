//! `hairpin steer`: boundary-value drives, one from the command line or many from a file.

mod answered;
mod batch;
mod exported;
mod ground;
mod means;
mod pace;
mod plane;
mod question;
mod remedy;
mod single;
mod start_table;
mod told;
mod vehicle;

use crate::args::Steer;
use crate::folder;
use crate::problem::Problem;
pub(super) use pace::Rows;
pub(super) use question::seen_from;
pub(crate) use start_table::make as make_table;
pub(super) use vehicle::Vehicle;

/// Runs the command: 0 when everything was answered; one question alone is 3 when it is infeasible, 5 when it is open.
pub(crate) fn run(steer: &Steer) -> Result<u8, Problem> {
    folder::take_threads(&steer.threads);
    let vehicle = Vehicle::new(steer)?;
    match (&steer.queries, &steer.to) {
        (Some(queries), _) => batch::run(steer, &vehicle, queries),
        (None, Some(to)) => single::run(steer, &vehicle, to),
        (None, None) => Err(Problem::input("give a goal, --to X,Y,YAW, or a file of them, --queries Q.csv")),
    }
}
