//! What the files of a campaign folder are called.

pub(crate) const SCENARIO: &str = "scenario.toml";
pub(super) const GENERATION: &str = "generation.json";
pub(super) const RESULTS: &str = "results.parquet";
pub(super) const WAYPOINTS: &str = "waypoints.parquet";
pub(super) const RUNS: &str = "runs";
/// The table of runs of earlier versions.
pub(super) const ALL_RUNS: &str = "runs.parquet";
pub(super) const INFLUENCE: &str = "influence.json";
/// The proof that an arm's first program is the heaviest.
pub const OPTIMUM: &str = "optimum.json";
/// The costs of an arm's graph.
pub const GRAPH: &str = "graph.csv";
/// Why moves are not in it.
pub const REASONS: &str = "reasons.csv";
/// The arcs of an arm's graph.
pub const ARCS: &str = "arcs.csv";
/// What every run of an arm did on every move.
pub const MOVES: &str = "moves.json";
/// The same of earlier releases, which this campaign is held against.
pub const BASELINE: &str = "baseline.json";
/// Random feasible cases that were run alike.
pub const BY_CHANCE: &str = "baseline.parquet";
/// What a search found where the cases are missions made elsewhere, run alike.
pub const SEARCHED: &str = "searched.parquet";
/// What is told of these missions.
pub const MISSIONS: &str = "missions.json";
/// How the largest stress of a search that executes rose.
pub const BEST_SO_FAR: &str = "best-so-far.tsv";
/// How a campaign was divided for several machines.
pub const PLAN: &str = "plan.json";
/// The folder of what these made.
pub(super) const PARTS: &str = "parts";
/// What one of them says of itself.
pub const PART: &str = "part.json";
/// What the executions of a search came to that was stopped.
pub(super) const EXECUTED: &str = "executed.tsv";
pub(super) const COVERAGE: [&str; 2] = ["coverage.json", "coverage.tsv"];

/// What the program of the user's that executed says of itself.
pub(super) const EXECUTOR: &str = "executor.json";
/// Why a program of the user's gave no flight.
pub(super) const LOG: &str = "executor-CASE-RUN.log";
/// What hairpin has made of a folder: the names that are its own.
pub(super) const LIST: &str = ".hairpin";

/// Every name that a campaign's folder gives, `CASE` and `RUN` standing for numbers. The files that a scenario names
/// come in addition, by the names of their copies. Those of files for each case and run are of earlier versions.
pub(super) const OURS: &[&str] = &[
    SCENARIO,
    GENERATION,
    RESULTS,
    WAYPOINTS,
    ALL_RUNS,
    INFLUENCE,
    OPTIMUM,
    GRAPH,
    REASONS,
    ARCS,
    MOVES,
    BY_CHANCE,
    SEARCHED,
    MISSIONS,
    BEST_SO_FAR,
    PLAN,
    EXECUTED,
    COVERAGE[0],
    COVERAGE[1],
    hairpin::campaign::learn::NAME,
    "junit.xml",
    "report.html",
    EXECUTOR,
    LOG,
    "trajectories/part-PART.parquet",
    "profiles/part-PART.parquet",
    "programs/part-PART.parquet",
    "executions/part-PART.parquet",
    "runs/part-PART.parquet",
    "reruns/part-PART.parquet",
    "rerun-runs/part-PART.parquet",
    "trajectories/CASE.parquet",
    "profiles/CASE.parquet",
    "programs/CASE.mod",
    "executions/CASE-RUN.parquet",
    "reruns/CASE-RUN.parquet",
    "missions/CASE.csv",
    "missions/CASE.geodetic.csv",
    "missions/CASE.environment.json",
    "repro/CASE.json",
    "repro/CASE-shrunk.json",
    "repro/CASE-shrink.state",
    "arc_clock.mod",
];

/// The folder of what is exported.
pub(super) const EXPORT: &str = "export";

/// How the names of exports end that have a case's number before them.
const ENDINGS: &[&str] =
    &["planned.csv", "ref.tum", "exec.tum", "joint_trajectory.json", "mod", "pgf", "script", "src", "dat"];

/// How those end that earlier versions did not have.
const NEWER_ENDINGS: &[&str] =
    &["setpoints.csv", "setpoints.json", "poly4d.csv", "poly4d.bin", "poly4d.json", "mcap", "ros2.mcap"];

/// How those end that are missions: a user may have changed them for `execute --missions`, so they stay as long as the
/// campaign is the same.
const MISSION_ENDINGS: &[&str] = &["csv", "geodetic.csv", "environment.json", "plan", "params", "waypoints"];

/// What earlier versions exported into the folder itself.
pub(super) fn earlier_exports() -> impl Iterator<Item = String> {
    let more = ["CASE-RUN.csv", "CASE_slow.mod"].map(str::to_owned);
    ENDINGS.iter().map(|ending| format!("CASE.{ending}")).chain(more)
}

/// What is exported and goes with the runs that it was made of, below the folder.
pub(super) fn exports_of_runs() -> impl Iterator<Item = String> {
    let newer = NEWER_ENDINGS.iter().map(|ending| format!("CASE.{ending}"));
    let whole = ["CASE_slow.plan", "CASE_slow.params", "arc_clock.mod", "day-card.html"].map(str::to_owned);
    earlier_exports().chain(newer).chain(whole).map(|name| format!("{EXPORT}/{name}"))
}

/// All that is exported, below the folder.
pub(super) fn exports() -> impl Iterator<Item = String> {
    exports_of_runs().chain(MISSION_ENDINGS.iter().map(|ending| format!("{EXPORT}/CASE.{ending}")))
}

/// Whether a file of this name is what `export` makes of a motion, not of waypoints.
pub(crate) fn is_of_a_motion(name: &str) -> bool {
    ["CASE-RUN.csv", "CASE.planned.csv", "CASE.setpoints.csv", "CASE.poly4d.csv"]
        .iter()
        .any(|pattern| stands_for(pattern, name))
}

/// Whether what hairpin writes into a campaign's folder, and nobody else does, is in this one.
pub(crate) fn is_written_to(folder: &std::path::Path) -> bool {
    [LIST, GENERATION, RESULTS].iter().any(|name| folder.join(name).exists())
}

/// Whether `name` is one that `pattern` stands for: `PART` is a number of five digits or more, `CASE` one of four,
/// `RUN` one of any.
pub(super) fn stands_for(pattern: &str, name: &str) -> bool {
    for (word, least) in [("PART", 5), ("CASE", 4), ("RUN", 1)] {
        if let Some(rest) = pattern.strip_prefix(word) {
            let digits = name.bytes().take_while(u8::is_ascii_digit).count();
            return digits >= least && stands_for(rest, &name[digits..]);
        }
    }
    let (mut pattern, mut name) = (pattern.chars(), name.chars());
    match (pattern.next(), name.next()) {
        (None, None) => true,
        (Some(expected), Some(found)) => expected == found && stands_for(pattern.as_str(), name.as_str()),
        _ => false,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_our_own_exports_go() {
        let is_export = |name: &str| exports().any(|pattern| stands_for(&pattern, &format!("export/{name}")));
        for name in [
            "0000.ref.tum",
            "0012.exec.tum",
            "10000.planned.csv",
            "0000-0.csv",
            "0117-12.csv",
            "0003.mod",
            "0003_slow.mod",
            "0003.csv",
            "0003.plan",
            "0003_slow.plan",
        ] {
            assert!(is_export(name), "{name}");
        }
        for name in ["mine.csv", "000.csv", "000-0.csv", "0000-.csv", "0000-a.csv", "a0000.ref.tum", "0000.tum", ""] {
            assert!(!is_export(name), "{name}");
        }
        assert!(is_of_a_motion("0000-0.csv") && is_of_a_motion("0001.setpoints.csv"));
        assert!(!is_of_a_motion("0000.csv") && !is_of_a_motion("0000.geodetic.csv"));
    }
}
