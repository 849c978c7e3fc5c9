//! Whether a program speaks the executor protocol: greeted, sent on missions, ended amid one, handed one that cannot be
//! flown, asked twice for the same; with all that was said, and a sentence for each mistake.

mod checked;
mod compared;
mod flown;
mod session;
mod speed;
mod step;
mod steps;

use hairpin::campaign::generate::{ByChance, Purpose};
use hairpin::campaign::{Mission, Setup, mission};
use hairpin::math::simd::Simd;
use hairpin_formats::scenario::{kept_in, setup_for, shadowed};

use crate::baseline::drawn;
use crate::consent::{Consent, Wish};
use crate::execute::command_of;
use crate::sets::{Set, executor};
use crate::{Problem, Watch};
pub use checked::Checked;
pub use compared::Difference;
use session::{Session, WHAT};
pub use speed::Speed;
pub use step::{Finding, Step};

/// Whose mission is flown where no scenario is given: a flight of four waypoints.
const DEFAULT: (&str, [(&str, &str); 2]) = ("demo-quadrotor", [("task.length", "4"), ("execute.repeat", "1")]);

/// What is checked, and on what.
#[derive(Debug, Clone, Default)]
pub struct CheckExecutorSettings {
    /// The program's command line.
    pub command: String,
    /// Scenario whose robot and missions it gets; a small flight of a quadrotor if not given.
    pub scenario: Option<String>,
    /// Keys of the scenario with other values.
    pub sets: Vec<Set>,
    /// Version of the kernels.
    pub simd: Simd,
    /// What of a folder may run.
    pub consent: Consent,
}

/// Runs the program through all steps. Nothing is written.
///
/// # Errors
/// A command that is none; a scenario with mistakes, or without a mission; one of a campaign's folder that asks to run
/// what its user has not allowed; it was asked to stop.
pub fn check_executor(settings: &CheckExecutorSettings, watch: &dyn Watch) -> Result<Checked, Problem> {
    let setup = setup_of(settings, watch)?;
    let Some((command, limits)) = command_of(&setup)? else {
        return Err(Problem::input("arms run programs of their own: there is no executor to check"));
    };
    let mission = a_mission(&setup, settings, watch)?;
    let session = Session::new(&command, limits, watch);
    let checked = session.run(&mission);
    if watch.stopped() {
        return Err(Problem::Interrupted("stopped".into()));
    }
    Ok(checked)
}

/// The scenario as the program executes it.
fn setup_of(settings: &CheckExecutorSettings, watch: &dyn Watch) -> Result<Setup, Problem> {
    let set = |(key, value): (&str, &str)| (key.to_owned(), value.to_owned());
    let (name, mut sets) = match &settings.scenario {
        Some(scenario) => (scenario.as_str(), Vec::new()),
        None => (DEFAULT.0, DEFAULT.1.map(set).to_vec()),
    };
    sets.extend(settings.sets.iter().cloned());
    sets.push(executor(&settings.command));
    shadowed(name).iter().for_each(|note| watch.warn(note));
    let setup = setup_for(name, &sets)?.with_simd(settings.simd);
    let (kept, wishes) = (kept_in(name), Wish::of_campaign(&setup));
    settings.consent.ask_of_scenario((name, kept.as_deref()), &wishes, &sets, watch)?;
    Ok(setup)
}

/// A random feasible one.
fn a_mission(setup: &Setup, settings: &CheckExecutorSettings, watch: &dyn Watch) -> Result<Mission, Problem> {
    let ByChance { cases, reason } = drawn(setup, (Purpose::Limits, 1), WHAT, watch)?;
    let Some(case) = cases.first() else {
        let name = settings.scenario.as_deref().unwrap_or(DEFAULT.0);
        let why = reason.unwrap_or_default();
        return Err(Problem::input(format!("{name} has no mission to fly ({why}): hairpin explain says more")));
    };
    Ok(mission(setup, case, 0)?)
}

#[cfg(test)]
mod tests;
