//! A robot's numbers from logs of its missions.

mod flown;
mod once;

use std::path::{Path, PathBuf};

use hairpin::campaign::fit::{self, Estimate, Fit, FitError, Flown};
use hairpin::campaign::{Setup, vary};
use hairpin::math::simd::Simd;
use hairpin_formats::atomic;
use hairpin_formats::fitted_robot::{self, FittedNumber, four_digits};
use hairpin_formats::folder::refuse_own;
use hairpin_formats::scenario::{setup_for, shadowed};
use rayon::prelude::*;
use serde_json::Value;

use crate::judge_log::arm_of;
use crate::sets::Set;
use crate::work::{PLACE, open_with, same_as_made};
use crate::{Problem, Watch};
use flown::{Missions, flown};
use once::{Read, is_one, same_samples};

/// What is fitted to what.
#[derive(Debug, Clone, Default)]
pub struct FitSettings {
    /// Files of logs.
    pub logs: Vec<PathBuf>,
    /// Robot file, or the name of a shipped robot.
    pub robot: String,
    /// The robot file that is written.
    pub out: PathBuf,
    /// The waypoints that all logs are flights of.
    pub mission: Option<PathBuf>,
    /// The campaign whose cases the logs are named after.
    pub campaign: Option<PathBuf>,
    /// Keys of the scenario with other values.
    pub sets: Vec<Set>,
    /// Share of the logs that is kept from the fit, to try it on; each is by a fit to the others if not given.
    pub hold_out: Option<f64>,
    /// Version of the kernels.
    pub simd: Simd,
}

/// What came of it.
pub struct Fitted {
    /// Numbers, intervals, gap.
    pub fit: Fit,
    /// Who flew, as it was given.
    pub setup: Setup,
    /// Logs that were fitted to or tried, and their length in all, s.
    pub logs: usize,
    /// s.
    pub logged_s: f64,
    /// Lines of `[execute]`.
    pub execute: Vec<String>,
    /// The robot's file.
    pub text: String,
}

/// Fits, and writes the robot's file.
///
/// # Errors
/// Neither a mission nor a campaign; a robot, campaign, mission or log that cannot be read; a log that is no flight of
/// its mission, or is the recording of one before it; too little in all of them; it was asked to stop.
pub fn fit(settings: &FitSettings, watch: &dyn Watch) -> Result<Fitted, Problem> {
    refuse_own(&settings.out)?;
    shadowed(&settings.robot).iter().for_each(|note| watch.warn(note));
    let (setup, missions) = missions(settings, watch)?;
    let setup = setup.with_simd(settings.simd);
    let logs: Vec<Read> =
        settings.logs.iter().map(|log| flown(log, &missions, &setup, watch)).collect::<Result<_, _>>()?;
    refuse_twice(&settings.logs, &logs, arm_of(&setup).is_some())?;
    let logs: Vec<Flown> = logs.into_iter().map(|read| read.flown).collect();
    let held_out = settings.hold_out.map_or(0, |share| (share * logs.len() as f64).ceil() as usize);
    if held_out > 0 && held_out >= logs.len() {
        let of = logs.len();
        return Err(Problem::input(format!(
            "--holdout leaves nothing to fit to: {held_out} of {of} logs; give more logs"
        )));
    }
    let found = fit::fit(&in_numbers(&setup)?, &logs, &fit::FitSettings { held_out }, &|| watch.stopped());
    let found = found.map_err(|error| match error {
        FitError::Stopped => Problem::Interrupted("stopped: nothing is written".into()),
        error => Problem::input(error),
    })?;
    let logged_s = logs.iter().filter_map(|log| log.track.times().last()).sum();
    let from = format!("{} logs", logs.len() - held_out);
    let text = robot_file(&setup, &found, settings, &from)?;
    atomic::write(&settings.out, text.as_bytes())?;
    let execute = found.keys.iter().filter_map(|(key, value)| Some((key.strip_prefix("execute.")?, value)));
    let execute = execute.map(|(key, value)| format!("{key} = {}", four_digits(*value))).collect();
    Ok(Fitted { fit: found, setup, logs: logs.len(), logged_s, execute, text })
}

/// Whether no log is one that is there already, under whatever name and in whatever format: it would shrink intervals
/// as if it were new, and be tried on a fit to itself. Arms repeat a program to hundredths of a millimetre: of them two
/// are one where they are it to the bit alone.
fn refuse_twice(files: &[PathBuf], logs: &[Read], repeats: bool) -> Result<(), Problem> {
    let is_one = if repeats { same_samples } else { is_one };
    let again = (0..logs.len()).into_par_iter().find_map_first(|i| {
        let why = logs[..i].iter().find_map(|before| is_one(&logs[i], before))?;
        Some((&files[i], why))
    });
    again.map_or(Ok(()), |(file, why)| Err(Problem::of_file(file, format!("{why}; what they say would count twice"))))
}

/// The same with every number of its robot given: what R leaves out was derived from others, and is not derived anew
/// from those that are adjusted.
fn in_numbers(setup: &Setup) -> Result<Setup, Problem> {
    let scenario = vary::apply(&setup.scenario, &[("robot".to_owned(), setup.handed().robot)])?;
    Ok(setup.changed(scenario)?)
}

/// The scenario that says who steers, with the robot that is fitted, and the missions that logs are flights of.
fn missions(settings: &FitSettings, watch: &dyn Watch) -> Result<(Setup, Missions), Problem> {
    let absolute = |path: &Path| std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
    match (&settings.campaign, &settings.mission) {
        (Some(campaign), None) => {
            let file = Path::new(&settings.robot);
            let robot =
                if file.is_file() { absolute(file).to_string_lossy().into_owned() } else { settings.robot.clone() };
            let robot = ("robot".to_owned(), Value::from(robot).to_string());
            let sets: Vec<Set> = std::iter::once(robot).chain(settings.sets.iter().cloned()).collect();
            let work = open_with(campaign, &sets)?;
            // Who steered is a matter of the logs, and what robot it was is named.
            same_as_made(&work.folder, &work.setup, &[&["execute", "vary", "robot"], &PLACE[..]].concat())?;
            let cases = work.folder.read_cases()?;
            Ok((work.setup, Missions::Cases(campaign.clone(), cases)))
        }
        (None, Some(mission)) => {
            let setup = setup_for(&settings.robot, &settings.sets)?;
            if arm_of(&setup).is_some() {
                return Err(Problem::input(
                    "an arm's logs are of programs, not of waypoints: --campaign OUT names the campaign that wrote them",
                ));
            }
            let missions = Missions::of_file(mission, &setup, watch)?;
            Ok((setup, missions))
        }
        _ => Err(Problem::input(
            "what was flown? --mission WAYPOINTS.csv where all logs are flights of one mission, --campaign OUT where they \
             are flights of a campaign's cases",
        )),
    }
}

/// The robot's table with what was told. What R leaves out and nobody told is written as it was derived, where it was:
/// what is derived follows from what was fitted.
fn robot_file(setup: &Setup, found: &Fit, settings: &FitSettings, from: &str) -> Result<String, Problem> {
    let spelt = setup.changed(vary::apply(&setup.scenario, &found.spelt)?)?;
    let robot = spelt.handed().robot;
    let keys = |estimate: &Estimate| {
        let of_robot =
            estimate.number.keys.iter().filter_map(|(key, of)| Some((key.strip_prefix("robot.")?.to_owned(), *of)));
        of_robot.collect::<Vec<_>>()
    };
    let mut numbers = Vec::new();
    for estimate in &found.estimates {
        for (key, of) in keys(estimate) {
            let told = estimate.is_told();
            if told || (found.derives && robot.get(&key).is_none_or(Value::is_null)) {
                let interval = estimate.interval.filter(|_| told).map(|ends| ends.map(|end| end * of));
                numbers.push(FittedNumber { key, value: estimate.value * of, interval });
            }
        }
    }
    let name = settings.out.file_stem().map_or_else(|| "fitted".into(), |stem| stem.to_string_lossy().into_owned());
    let (unit, of) = found.unit;
    let untried = found.untried.filter(|_| found.estimates.iter().any(Estimate::is_told));
    let untried = untried.map_or(String::new(), |who| {
        format!(" Whether such intervals hold was tried on {}, and never with `{who}`, which steered.", found.tried)
    });
    let head = [
        format!(
            "{} with what logs told of it, by `hairpin fit`: numbers marked `estimated` are the tool's, not measurements",
            setup.robot_name()
        ),
        format!(
            "of the robot. Residual {:.3} {unit} over {from}; what was not told is as it was.{untried}",
            of * found.residual_m
        ),
    ];
    fitted_robot::text(&robot, (&name, &head, from), &numbers).map_err(|why| Problem::of_file(&settings.out, why))
}
