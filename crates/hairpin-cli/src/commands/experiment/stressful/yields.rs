//! Figure 6: distinct trajectories that each reach set gives in equal processor time, over their length; and, which the paper could
//! not tell, the share of them that has a control witness.

use hairpin::campaign::{self, Known, Stop};
use hairpin_formats::experiment::Sheet;
use hairpin_formats::figure::{Axis, Figure, Marks, Point, Scale, Series, Table};
use serde::Deserialize;

use super::super::{Outcome, go_on};
use super::cell::{self, FLIGHT_GOGGLES};
use crate::commands::bench::clock::{Stopwatch, alone};
use crate::interrupt;
use crate::problem::Problem;

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

/// Trajectories per reach set and length, beside the paper's.
pub(in super::super) fn yields(sheet: &Sheet) -> Result<Outcome, Problem> {
    let (size, printed): (Size, Printed) = (sheet.size()?, sheet.printed()?);
    let mut table = Table::new(&[
        "reach",
        "length",
        "trajectories",
        "per_minute",
        "graphs",
        "witnessed_percent",
        "certified",
        "paper_trajectories",
    ]);
    let mut curves: Vec<(String, Vec<Point>)> = Vec::new();
    for reach in &size.reach {
        let mut curve = Vec::new();
        for &length in &size.lengths {
            go_on()?;
            let sets = |cases: u64, certify: bool| {
                vec![
                    ("seed", size.seed.to_string()),
                    ("task.length", length.to_string()),
                    ("generate.reach", format!("\"{reach}\"")),
                    ("generate.resolution", "5".to_owned()),
                    ("generate.score", "\"random\"".to_owned()),
                    ("generate.search.cases", cases.to_string()),
                    ("generate.certify", certify.to_string()),
                ]
            };
            let setup = cell::setup(FLIGHT_GOGGLES, &timed(reach, sets(MANY, false)), None)?;
            let (mut count, mut graphs, mut spent) = (0_u64, 0, 0.0);
            alone(|| {
                let watch = Stopwatch::start();
                let over = || interrupt::asked() || watch.passed(size.seconds);
                let stop = Stop { cancelled: &over, ..Stop::never() };
                let tally =
                    campaign::generate(&setup, &Known::default(), &stop, &mut |new, _| count += new.len() as u64);
                (graphs, spent) = (tally.graphs, watch.spent());
            });
            go_on()?;
            let per_minute = count as f64 * 60.0 / spent;
            let wanted = count.min(size.certified);
            let witnessed = match reach.as_str() {
                "witness" if count > 0 => Some((100.0, wanted)),
                _ if wanted == 0 => None,
                _ => {
                    let cases = cell::cases(&cell::setup(FLIGHT_GOGGLES, &timed(reach, sets(wanted, true)), None)?)?;
                    let yes = cases.iter().filter(|case| case.certified == Some("yes")).count();
                    Some((100.0 * yes as f64 / cases.len() as f64, cases.len() as u64))
                }
            };
            let paper = printed.rows.iter().find(|row| row.reach == *reach && row.length == length);
            table.push(vec![
                reach.as_str().into(),
                (length as usize).into(),
                (count as usize).into(),
                per_minute.into(),
                (graphs as usize).into(),
                witnessed.map(|(share, _)| share).into(),
                witnessed.map_or(0, |(_, of)| of as usize).into(),
                paper.map(|row| row.trajectories).into(),
            ]);
            if count > 0 {
                curve.push(Point::new(length as f64, per_minute));
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
            "The paper's counts are those of {} h, in which each trajectory was charged 9 s per waypoint.",
            printed.hours
        ),
    ];
    Ok(Outcome { tables: vec![("yields", table)], figures: vec![("yields".into(), figure)], notes })
}

/// Witness legs choose their time; the others have the paper's step.
fn timed(reach: &str, mut sets: Vec<(&'static str, String)>) -> Vec<(&'static str, String)> {
    if reach == "witness" {
        sets.push(("generate.timing.leg_time_s", "[0.8, 4.0]".into()));
    }
    sets
}
