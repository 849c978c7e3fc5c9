//! `hairpin simulate`: a rotor-speed profile through the plant, open loop, so that other programs can check our
//! physics.

use hairpin_formats::csv;
use hairpin_jobs::Problem;
use hairpin_jobs::simulate::simulate;

use crate::args::Simulate;
use crate::exit::DONE;
use crate::{console, settings};

/// Runs the command.
pub(crate) fn run(asked: &Simulate) -> Result<u8, Problem> {
    let track = simulate(&asked.robot, &settings::split(&asked.sets)?, &asked.rotor_speeds)?;
    match &asked.out {
        Some(path) => csv::write(path, &track)?,
        None => console::say_text(&csv::text(&track)),
    }
    Ok(DONE)
}
