//! What can be typed after `hairpin experiment`.

use std::path::PathBuf;

use clap::{Args, ValueEnum};
use serde_json::json;

/// Each prints its table beside what the paper printed, and writes tables as CSV and figures as SVG. EXPERIMENTS.md
/// shows them.
#[derive(Debug, Args)]
pub(crate) struct Experiment {
    /// Which one
    #[arg(value_enum)]
    pub(crate) name: ExperimentName,
    /// At full size (hours) instead of minutes
    #[arg(long)]
    pub(crate) full: bool,
    /// Where tables and figures go; out/NAME if not given. What is there under their names is replaced
    #[arg(long, value_name = "DIR")]
    pub(crate) out: Option<PathBuf>,
    /// Override one size of the experiment's sheet (experiments/NAME.toml), such as `points=[10,12]`; repeatable
    #[arg(long = "set", value_name = "KEY=VALUE")]
    pub(crate) sets: Vec<String>,
    #[command(flatten)]
    pub(crate) sizes: Sizes,
    /// One JSON object on stdout: tables and files
    #[arg(long)]
    pub(crate) json: bool,
}

/// Sizes of the experiment `defaults` that can be typed shortly; each stands for `--set NAME=…`.
#[derive(Debug, Default, Args)]
pub(crate) struct Sizes {
    /// `defaults`: independent runs of a cell
    #[arg(long, value_name = "N")]
    runs: Option<u64>,
    /// `defaults`: cases of a run
    #[arg(long, value_name = "N")]
    cases: Option<u64>,
    /// `defaults`: executions for each case
    #[arg(long, value_name = "N")]
    executions: Option<u64>,
    /// `defaults`: default runs that are held against ten times their executions by chance
    #[arg(long, value_name = "N")]
    pairs: Option<u64>,
    /// `defaults`: cells whose name has TEXT in it, such as `anafi/` or `/minimum-snap`; repeatable
    #[arg(long, value_name = "TEXT")]
    only: Vec<String>,
    /// `defaults`: what seeds are derived from, such as a commit; that of the build, or its version, if not given
    #[arg(long, value_name = "HASH")]
    seed_of: Option<String>,
}

impl Sizes {
    /// As KEY=VALUE.
    pub(crate) fn sets(&self) -> impl Iterator<Item = String> {
        let Self { runs, cases, executions, pairs, only, seed_of } = self;
        let counts = [("runs", runs), ("cases", cases), ("executions", executions), ("pairs", pairs)];
        let counts = counts.into_iter().filter_map(|(key, count)| Some(format!("{key}={}", (*count)?)));
        // Strings and lists of them are in TOML what they are in JSON.
        let only = (!only.is_empty()).then(|| format!("only={}", json!(only)));
        counts.chain(only).chain(seed_of.iter().map(|hash| format!("seed_of={}", json!(hash))))
    }
}

/// All experiments; each has a sheet of the same name.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum ExperimentName {
    /// ISSTA 2020, figure 6: trajectories that each reach set gives in equal time
    Yields,
    /// ISSTA 2020, figure 7: how deviation, acceleration and time of feasible trajectories are spread
    Metrics,
    /// ISSTA 2020, figure 8: the deviation that scores, learning and executions in the loop lift
    Scores,
    /// ISSTA 2020, figures 9 to 11: a learned score on the Anafi's stand-in, tests over a limit, the worst flight
    FollowUp,
    /// A score that was learned here, in another simulator: its program speaks the executor protocol
    Transfer,
    /// RobTest, table I: seconds for the graph, depth-first search and the proof of the optimum
    #[value(name = "robtest-table-1")]
    RobtestTable1,
    /// RobTest, figure 7: the share of the optimum that is known after a time contract
    #[value(name = "robtest-figure-7")]
    RobtestFigure7,
    /// RobTest, threat: obstacles that thin the graph out
    RobtestObstacles,
    /// RobTest, threat: points in clusters
    RobtestClusters,
    /// RobTest, threat: costs that are no distances
    RobtestCosts,
    /// Rough terrain trajectory generator, 2006: its requirements and the tests of its results document
    RoverRequirements,
    /// The default search of each robot and controller beside random trajectories, CMA-ES, and the search in the loop
    Defaults,
}

impl ExperimentName {
    /// The name of its sheet.
    pub(crate) fn sheet(self) -> String {
        self.to_possible_value().map_or(String::new(), |value| value.get_name().to_owned())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_that_are_typed_are_sets() {
        let sizes = Sizes {
            runs: Some(3),
            only: vec!["anafi/".into(), "a\"b".into()],
            seed_of: Some("c0ffee".into()),
            ..Sizes::default()
        };
        let sets: Vec<String> = sizes.sets().collect();
        assert_eq!(sets, ["runs=3", "only=[\"anafi/\",\"a\\\"b\"]", "seed_of=\"c0ffee\""]);
        assert_eq!(Sizes::default().sets().count(), 0);
    }

    #[test]
    fn what_can_be_typed_is_what_the_laboratory_has() {
        let typed = ExperimentName::value_variants().iter().map(|name| name.sheet());
        assert!(typed.eq(hairpin_lab::experiment::names()));
    }
}
