//! The heaviest programs of an arm through a cloud of points.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::{Duration, Instant};

use hairpin::campaign::arm::ArmSetup;
use hairpin::campaign::arm::{ArmGraph, graph_until};
use hairpin::campaign::{Setup, Stop, Tally};
use hairpin::search::heaviest::Heaviest;
use hairpin_formats::scenario::{arm_setup_for, setup_for, shadowed};

use crate::generate::{check_plans, keep_cases};
use crate::sets::Set;
use crate::spelling::check_names;
use crate::work::{IfThere, make, saying_what_is_asked};
use crate::{Deadline, Problem, Watch, optimum};

/// What is searched in a cloud.
#[derive(Debug, Clone, Default)]
pub struct CloudSettings {
    /// Arm, or cell: a shipped arm's name, a robot file, or a scenario.
    pub cell: String,
    /// Points: x_mm,y_mm,z_mm, or a RAPID module's robtargets; the cell's own if not given.
    pub points: Option<PathBuf>,
    /// Keys of the cell's scenario with other values.
    pub sets: Vec<Set>,
    /// What is wanted of programs, beside what those say.
    pub programs: Programs,
    /// Seconds after which the best so far is the answer.
    pub time_limit_s: Option<f64>,
}

/// What is wanted of an arm's programs.
#[derive(Debug, Clone)]
pub struct Programs {
    /// First point, from 0; any if not given.
    pub start: Option<usize>,
    /// Last point, from 0; any if not given.
    pub end: Option<usize>,
    /// Programs below this cost are not wanted.
    pub min_cost: Option<String>,
    /// How many different ones, the heaviest first.
    pub programs: usize,
    /// How often a point may come.
    pub visits: usize,
    /// Seed of the local search.
    pub seed: u64,
}

impl Default for Programs {
    fn default() -> Self {
        Self { start: None, end: None, min_cost: None, programs: 1, visits: 1, seed: 0 }
    }
}

impl Programs {
    /// As keys of the scenario.
    fn sets(&self) -> Vec<Set> {
        let Self { start, end, min_cost, programs, visits, seed } = self;
        let keys = [
            ("generate.search.start", start.map(|row| row.to_string())),
            ("generate.search.end", end.map(|row| row.to_string())),
            ("generate.search.min_cost", min_cost.clone()),
            ("generate.search.programs", Some(programs.to_string())),
            ("generate.search.visits", (*visits > 1).then(|| visits.to_string())),
            ("seed", (*seed > 0).then(|| seed.to_string())),
        ];
        keys.into_iter().filter_map(|(key, value)| Some((key.to_owned(), value?))).collect()
    }
}

/// What was found in a cloud.
pub struct CloudSearch {
    /// The arm in its cell.
    pub setup: Setup,
    /// Its graph.
    pub graph: Arc<ArmGraph>,
    /// The heaviest programs.
    pub found: Heaviest,
    /// Why there is no program, in a sentence's part; `None` where there is one.
    pub why_none: Option<String>,
    /// What it took.
    pub time: Duration,
    deadline: Deadline,
    begun: Instant,
}

/// What a graph that was stopped leaves open.
const UNKNOWN: &str = "whether the rest has a program was not found out";

/// What came of a cloud.
pub enum CloudAnswer {
    /// Its graph was searched.
    Searched(Box<CloudSearch>),
    /// No program, because no point or no move is possible, or nobody waited to see.
    Nothing {
        /// Why.
        reason: String,
        /// Why that is not found out, where it rests on estimates alone or was stopped.
        open: Option<String>,
        /// What it took, s.
        time: Duration,
    },
}

/// Builds the graph of a cloud and searches its heaviest programs; stopped, it gives the best so far.
///
/// # Errors
/// A cell or a cloud with mistakes; a cell that is no arm's.
pub fn search_cloud(settings: &CloudSettings, watch: &dyn Watch) -> Result<CloudAnswer, Problem> {
    let CloudSettings { cell, points, sets, programs, time_limit_s } = settings;
    shadowed(cell).iter().for_each(|note| watch.warn(note));
    let sets: Vec<Set> = sets.iter().cloned().chain(programs.sets()).collect();
    let setup = match points {
        Some(points) => arm_setup_for(cell, points, &sets)?,
        None => setup_for(cell, &sets)?,
    };
    let Some(arm) = setup.own::<ArmSetup>() else { return Err(Problem::input(format!("`{cell}` is no arm"))) };
    check_names(&setup)?;
    let (begun, deadline) = (Instant::now(), Deadline::after(*time_limit_s));
    let searched = with_stop(watch, deadline, begun, |stop| {
        let graph = graph_until(arm, stop)?;
        let found = arm.heaviest(&graph, stop)?;
        let why_none = found.paths.is_empty().then(|| arm.why_none(&graph, &found));
        Ok((graph, found, why_none))
    });
    let time = begun.elapsed();
    Ok(match searched {
        Ok((graph, found, why_none)) => {
            CloudAnswer::Searched(Box::new(CloudSearch { setup, graph, found, why_none, time, deadline, begun }))
        }
        Err(reason) => {
            let stopped = watch.stopped() || deadline.passed();
            // A graph that was stopped proves nothing, and another one of estimates would take as long.
            let open = if stopped { Some(UNKNOWN.into()) } else { arm.open_for_estimates() };
            CloudAnswer::Nothing { reason, open, time }
        }
    })
}

impl CloudSearch {
    /// Writes the programs that were found, as generation would, into the campaign folder `out`.
    ///
    /// # Errors
    /// A program that the arm cannot follow to its end; the folder holds something else; a file cannot be written.
    pub fn keep(&self, out: &Path, if_there: IfThere, watch: &dyn Watch) -> Result<(), Problem> {
        let Some(arm) = self.setup.own::<ArmSetup>() else { unreachable!("clouds are searched of arms alone") };
        let cases = arm.cases(&self.graph, &self.found);
        check_plans(&self.setup, &cases)?;
        // Programs were asked for, no judgement.
        let work = make(out, saying_what_is_asked(self.setup.clone())?, if_there)?;
        work.folder.write_graph(arm, &self.graph)?;
        with_stop(watch, self.deadline, self.begun, |stop| optimum::keep(&work, arm, &self.graph, &cases, stop))?;
        let solved = u64::from(!cases.is_empty());
        let tally = Tally { complete: true, graphs: 1, units: 1, solved, ..Tally::default() };
        keep_cases(&work, &cases, 0, &tally)
    }
}

/// Does `work`, which stops where `watch` says so or `deadline` is over.
fn with_stop<T>(watch: &dyn Watch, deadline: Deadline, begun: Instant, work: impl FnOnce(&Stop) -> T) -> T {
    work(&Stop {
        cancelled: &|| watch.stopped() || deadline.passed(),
        progress: &|_, _| {},
        clock: &|| begun.elapsed().as_secs_f64(),
    })
}

#[cfg(test)]
mod tests {
    use hairpin::campaign::scenario::Asked;
    use hairpin::search::heaviest::Outcome;

    use super::*;
    use crate::Unwatched;
    use crate::work::open_to_read;

    #[test]
    fn programs_of_a_cloud_become_a_campaign() {
        let place = tempfile::tempdir().unwrap();
        let (points, out) = (place.path().join("points.csv"), place.path().join("out"));
        std::fs::write(&points, "x_mm,y_mm,z_mm\n300,0,300\n300,100,300\n350,0,350\n").unwrap();
        let settings =
            CloudSettings { cell: "irb120".into(), points: Some(points.clone()), ..CloudSettings::default() };
        let CloudAnswer::Searched(searched) = search_cloud(&settings, &Unwatched).unwrap() else {
            panic!("these points can be met")
        };
        assert!(searched.found.proven && searched.graph.points() == 3);
        searched.keep(&out, IfThere::Refuse, &Unwatched).unwrap();
        let cases = open_to_read(&out).unwrap().folder.read_cases().unwrap();
        assert!(cases.len() == 1 && cases[0].program().is_some());
        // The folder's next command reads a scenario that says what it is judged by: nothing.
        let kept = open_to_read(&out).unwrap().setup.scenario;
        assert_eq!(kept.asked(), Asked::Nothing);
        // One point that can be met is no program: no move is loaded.
        std::fs::write(&points, "x_mm,y_mm,z_mm\n300,0,300\n9000,100,300\n9000,0,300\n").unwrap();
        let CloudAnswer::Searched(searched) = search_cloud(&settings, &Unwatched).unwrap() else {
            panic!("one point can be met")
        };
        assert_eq!((searched.found.outcome, searched.found.paths.len()), (Outcome::Infeasible, 0));
        assert_eq!(searched.why_none.unwrap(), "no move from one point of the cloud to another is possible");
        std::fs::write(&points, "x_mm,y_mm,z_mm\n300,0,300\n").unwrap();
        let CloudAnswer::Searched(searched) = search_cloud(&settings, &Unwatched).unwrap() else {
            panic!("it can be met")
        };
        assert_eq!(
            searched.why_none.unwrap(),
            "the cloud has one point, and a program goes from one to another at least"
        );
        std::fs::write(&points, "x_mm,y_mm,z_mm\n9000,0,300\n9000,100,300\n").unwrap();
        assert!(matches!(search_cloud(&settings, &Unwatched).unwrap(), CloudAnswer::Nothing { open: None, .. }));
    }

    /// The key `task.points` is nothing that its user typed: mistakes are told where they stand in the cloud.
    #[test]
    fn what_is_wrong_with_a_cloud_is_told_in_its_file() {
        let place = tempfile::tempdir().unwrap();
        let points = place.path().join("points.csv");
        let refused = |text: &str| {
            std::fs::write(&points, text).unwrap();
            let settings =
                CloudSettings { cell: "irb120".into(), points: Some(points.clone()), ..CloudSettings::default() };
            match search_cloud(&settings, &Unwatched).map(|_| ()).unwrap_err() {
                Problem::Scenario(report) => report.complaints()[0].clone(),
                other => panic!("{other}"),
            }
        };
        let file = points.to_string_lossy().into_owned();
        let head = "x_mm,y_mm,z_mm";
        for (text, line, words) in [
            (format!("{head}\n300,0,300\n300,0,300\n"), 3, "the point of line 2 again"),
            (format!("{head}\n\n300,0,300\n300,x,300\n"), 4, "`x`"),
            ("x_mm,y_mm\n300,0\n".into(), 1, "z_mm"),
            (format!("{head}\n0.3,0,0.3\n0.31,0,0.3\n"), 1, "in m?"),
            (format!("{head}\n300,0,300\n1e7,0,300\n"), 1, "more than 50 m"),
        ] {
            let told = refused(&text);
            assert_eq!((&told.file, told.line), (&file, line), "{told:?}");
            assert!(told.field == "task.points" && told.bound.contains(words), "{told:?}");
        }
        // A single point has no extent, and is found to be too far by the cell.
        let told = refused(&format!("{head}\n\n5e8,0,300\n"));
        assert_eq!((&told.file, told.line, &*told.field), (&file, 3, "task.points[0]"), "{told:?}");
        std::fs::remove_file(&points).unwrap();
        let settings = CloudSettings { cell: "irb120".into(), points: Some(points), ..CloudSettings::default() };
        let told = search_cloud(&settings, &Unwatched).map(|_| ()).unwrap_err().to_string();
        assert!(told.contains("points.csv` cannot be read") && !told.contains("--set"), "{told}");
    }

    /// What is wrong with a table of costs is told before anything is searched, and a program that cannot be followed
    /// before there is a folder for it. A cell has points of its own.
    #[test]
    fn what_cannot_be_kept_is_refused_before_there_is_a_folder() {
        let place = tempfile::tempdir().unwrap();
        let [cell, table, out] = ["cell.toml", "costs.csv", "out"].map(|name| place.path().join(name));
        let text = "hairpin = 1\nrobot = \"irb120\"\nspec = \"none\"\n[task]\n\
            points = [[300, 0, 300], [300, 100, 300], [-300, 0, 300]]\n";
        std::fs::write(&cell, text).unwrap();
        std::fs::write(&table, ",1\n2,\n").unwrap();
        let cell = cell.to_string_lossy().into_owned();
        let costs = ("generate.cost".into(), format!("{{ table = {:?} }}", table.to_string_lossy()));
        let settings = CloudSettings { cell: cell.clone(), sets: vec![costs], ..CloudSettings::default() };
        let told = search_cloud(&settings, &Unwatched).map(|_| ()).unwrap_err().to_string();
        assert!(told.contains("generate.cost.table") && told.contains("which has 2 lines"), "{told}");
        // Straight through the arm's own base: Cartesian mode does not look at that.
        let through = ("generate.mode".into(), "cartesian".into());
        let settings = CloudSettings { cell, sets: vec![through], ..CloudSettings::default() };
        let CloudAnswer::Searched(searched) = search_cloud(&settings, &Unwatched).unwrap() else {
            panic!("nothing is in the way of the tool")
        };
        let told = searched.keep(&out, IfThere::Refuse, &Unwatched).unwrap_err().to_string();
        assert!(told.starts_with("case 0000: ") && !out.exists(), "{told}");
    }

    /// A graph that was not whole in time is no proof that there is nothing in it.
    #[test]
    fn a_cloud_that_nobody_waits_for_is_not_known_to_have_nothing() {
        let place = tempfile::tempdir().unwrap();
        let points = place.path().join("points.csv");
        std::fs::write(&points, "x_mm,y_mm,z_mm\n300,0,300\n300,100,300\n350,0,350\n").unwrap();
        let settings = CloudSettings {
            cell: "irb120".into(),
            points: Some(points),
            time_limit_s: Some(0.0),
            ..CloudSettings::default()
        };
        let CloudAnswer::Nothing { reason, open, .. } = search_cloud(&settings, &Unwatched).unwrap() else {
            panic!("no move was looked at")
        };
        assert!(open.is_some() && reason == "its graph was stopped after 0 of 6 moves", "{reason}");
    }
}
