//! Figure 6: distinct trajectories that each reach set gives in equal processor time, over their length; and, which the
//! paper could not tell, the share of them that has a control witness.

use hairpin::campaign::flight::FlightSetup;
use hairpin::campaign::{Case, Known, OwnSimulator, Stop, generate};
use hairpin::feasibility::Certificate;
use hairpin::judgement::Statistics;
use hairpin_formats::figure::{Axis, Figure, Marks, Point, Scale, Series, Table};
use hairpin_jobs::{Problem, Watch};
use rayon::prelude::*;
use serde::Deserialize;

use super::cell::{self, FLIGHT_GOGGLES, Set, text};
use crate::clock::{Stopwatch, alone};
use crate::experiment::outcome::Outcome;
use crate::experiment::sheet::Sheet;
use crate::experiment::watched::go_on;

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Size {
    /// Processor seconds that a reach set gets for a length.
    seconds: f64,
    lengths: Vec<u64>,
    reach: Vec<String>,
    /// Trajectories of each that a witness is searched for.
    certified: u64,
    seed: u64,
}

#[derive(Debug, Deserialize)]
struct Printed {
    /// Trajectories in `hours`, by length.
    hours: f64,
    rows: Vec<PrintedRow>,
}

#[derive(Debug, Deserialize)]
struct PrintedRow {
    reach: String,
    length: u64,
    trajectories: f64,
}

/// More trajectories than any reach set finds in the time.
const MANY: u64 = 1_000_000;
/// The step of the sets that have one, s: that of the paper.
const STEP_S: f64 = 1.0;

/// What a reach set gave in its time.
struct Found {
    trajectories: usize,
    graphs: u64,
    per_minute: f64,
}

/// How many of a set's trajectories have a control witness.
struct Witnessed {
    of: usize,
    /// With legs that take as long as they need.
    in_own_time: usize,
    /// With legs that take one step each, as the set has it.
    in_step: usize,
    /// By how much those witnesses that take their own time are slower than one step a leg, in the median.
    slower: Option<f64>,
}

/// Trajectories per reach set and length, beside the paper's.
pub(in super::super) fn yields(sheet: &Sheet, watch: &dyn Watch) -> Result<Outcome, Problem> {
    let (size, printed): (Size, Printed) = (sheet.size()?, sheet.printed()?);
    let mut table = Table::new(&[
        "reach",
        "length",
        "trajectories",
        "per_minute",
        "graphs",
        "certified",
        "witnessed_percent",
        "witnessed_in_step_percent",
        "witness_slower_by",
        "paper_trajectories",
    ]);
    let mut curves: Vec<(String, Vec<Point>)> = Vec::new();
    for reach in &size.reach {
        let mut curve = Vec::new();
        for &length in &size.lengths {
            go_on(watch)?;
            let found = found(&size, reach, length, watch)?;
            let witnessed = witnessed(&size, reach, length, found.trajectories, watch)?;
            let share = |of: fn(&Witnessed) -> usize| {
                witnessed.as_ref().map(|witnessed| 100.0 * of(witnessed) as f64 / witnessed.of as f64)
            };
            let paper = printed.rows.iter().find(|row| row.reach == *reach && row.length == length);
            table.push(vec![
                reach.as_str().into(),
                (length as usize).into(),
                found.trajectories.into(),
                found.per_minute.into(),
                (found.graphs as usize).into(),
                witnessed.as_ref().map_or(0, |witnessed| witnessed.of).into(),
                share(|witnessed| witnessed.in_own_time).into(),
                share(|witnessed| witnessed.in_step).into(),
                witnessed.and_then(|witnessed| witnessed.slower).into(),
                paper.map(|row| row.trajectories).into(),
            ]);
            if found.trajectories > 0 {
                curve.push(Point::new(length as f64, found.per_minute));
            }
        }
        curves.push((reach.clone(), curve));
    }
    let figure = Figure {
        title: "Distinct trajectories per processor minute".into(),
        x: Axis { label: "length, waypoints".into(), scale: Scale::Linear },
        y: Axis { label: "trajectories per minute".into(), scale: Scale::Logarithmic },
        series: curves.into_iter().map(|(name, points)| Series { name, marks: Marks::Line(points) }).collect(),
    };
    let notes = vec![
        format!(
            "{} s of processor time for each row, one thread; one trajectory per sampled graph at most.",
            size.seconds
        ),
        format!(
            "witnessed: a control witness was found with leg times of its own, witness_slower_by times as long as {STEP_S} s a leg in the \
             median; in_step: one with {STEP_S} s a leg, which is what none, sphere and hull claim."
        ),
        format!(
            "The paper's counts are those of {} h, in which each trajectory was charged 9 s per waypoint.",
            printed.hours
        ),
    ];
    Ok(Outcome { tables: vec![("yields", table)], figures: vec![("yields".into(), figure)], notes })
}

/// The keys of one row. Witness legs choose their time; the others have the paper's step.
fn sets(size: &Size, reach: &str, length: u64, cases: u64) -> Vec<Set> {
    let mut sets = vec![
        ("seed", size.seed.to_string()),
        ("task.length", length.to_string()),
        ("generate.reach", text(reach)),
        ("generate.resolution", "5".to_owned()),
        ("generate.score", text("random")),
        ("generate.search.cases", cases.to_string()),
    ];
    if reach == "witness" {
        sets.push(("generate.timing.leg_time_s", "[0.8, 4.0]".into()));
    }
    sets
}

/// What `reach` gives in the time that it has.
fn found(size: &Size, reach: &str, length: u64, watch: &dyn Watch) -> Result<Found, Problem> {
    let setup = cell::setup(FLIGHT_GOGGLES, &sets(size, reach, length, MANY), None)?;
    let (mut trajectories, mut graphs, mut spent) = (0, 0, 0.0);
    alone(|| {
        let stopwatch = Stopwatch::start();
        let over = || watch.stopped() || stopwatch.passed(size.seconds);
        let stop = Stop { cancelled: &over, ..Stop::never() };
        let tally = generate(&setup, &Known::default(), &OwnSimulator, &stop, &mut |new, _| trajectories += new.len());
        (graphs, spent) = (tally.graphs, stopwatch.spent());
    });
    go_on(watch)?;
    Ok(Found { trajectories, graphs, per_minute: trajectories as f64 * 60.0 / spent })
}

/// What becomes of the first of `trajectories` when witnesses are searched for them; `None` where there are none.
fn witnessed(
    size: &Size,
    reach: &str,
    length: u64,
    trajectories: usize,
    watch: &dyn Watch,
) -> Result<Option<Witnessed>, Problem> {
    let wanted = size.certified.min(trajectories as u64);
    if wanted == 0 {
        return Ok(None);
    }
    let mut sets = sets(size, reach, length, wanted);
    // What `witness` finds has one.
    sets.push(("generate.certify", (reach != "witness").to_string()));
    let setup = cell::setup(FLIGHT_GOGGLES, &sets, None)?;
    let cases = cell::cases(&setup, watch)?;
    let Some(flight) = setup.own::<FlightSetup>() else { return Ok(None) };
    let in_step: Result<Vec<bool>, String> = cases
        .par_iter()
        .map(|case| Ok(matches!(flight.certificate_in_step(&case.waypoints)?, Certificate::Yes(_))))
        .collect();
    let in_step = in_step.map_err(Problem::input)?.into_iter().filter(|yes| *yes).count();
    let slower: Vec<f64> = cases.iter().filter_map(slower).collect();
    Ok(Some(Witnessed {
        of: cases.len(),
        in_own_time: slower.len(),
        in_step,
        slower: Statistics::of(&slower).map(|told| told.median),
    }))
}

/// The witness's duration over one step a leg, where there is a witness.
fn slower(case: &Case) -> Option<f64> {
    let profile = case.profile()?;
    Some(profile.duration() / (STEP_S * profile.legs.len() as f64))
}
