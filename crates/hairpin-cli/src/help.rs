//! Help beyond the sentences: options in groups, two examples of each verb, and the five ways in.

use clap::{Arg, ArgAction, Command, CommandFactory};

use crate::args::Arguments;

/// What `hairpin` alone says.
pub(crate) const WAYS_IN: &str = "\
hairpin finds the trajectories a robot handles worst, and proves that they are ones it could have flown.

Five ways in:
  a drone              hairpin new quadrotor && hairpin stress quadrotor.toml
  a rover              hairpin new rover && hairpin stress rover.toml
  a car                hairpin new car && hairpin stress car.toml
  an arm               hairpin new arm && hairpin stress arm.toml
  your own simulator   hairpin new quadrotor && hairpin stress quadrotor.toml --executor 'python3 my_simulator.py'

In ten seconds, without a file: hairpin demo
All commands: hairpin --help; one of them: hairpin help stress; exit codes: hairpin help exit-codes";

/// The whole command line, with groups and examples.
pub(crate) fn command() -> Command {
    // Clap's own two would stand in no group.
    let own =
        |name: &'static str, short: char| Arg::new(name).long(name).short(short).global(true).help_heading("Help");
    let help = own("help", 'h').action(ArgAction::Help).help("Print help: a line for each option, or with --help all");
    let version = own("version", 'V').action(ArgAction::Version).help("Print the version");
    let command = Arguments::command().disable_help_flag(true).disable_version_flag(true).args([help, version]);
    let command = command.mut_arg("verbose", |arg| grouped(arg, ""));
    below(&command).into_iter().fold(command, |all, verb| all.mut_subcommand(&verb, |known| of_verb(known, &verb)))
}

/// Names of the commands below `command`.
fn below(command: &Command) -> Vec<String> {
    command.get_subcommands().map(|verb| verb.get_name().to_owned()).collect()
}

/// A verb, and what is below it, with the verb's groups and examples.
fn of_verb(command: Command, verb: &str) -> Command {
    let command = command.mut_args(|arg| grouped(arg, verb));
    let command =
        below(&command).into_iter().fold(command, |all, part| all.mut_subcommand(part, |known| of_verb(known, verb)));
    match examples(verb) {
        Some(examples) => command.after_help(format!("Examples:\n  {}", examples.join("\n  "))),
        None => command,
    }
}

fn grouped(arg: Arg, verb: &str) -> Arg {
    if arg.is_positional() {
        return arg;
    }
    let id = arg.get_id().as_str().to_owned();
    let own = OF_VERBS.iter().filter(|(of, ..)| *of == verb).find(|(_, _, ids)| ids.contains(&id.as_str()));
    let any = || GROUPS.iter().find(|(_, ids)| ids.contains(&id.as_str())).map(|(heading, _)| *heading);
    match own.map(|(_, heading, _)| *heading).or_else(any) {
        Some(heading) => arg.help_heading(heading),
        None => arg,
    }
}

/// Headings of options that many verbs have.
const GROUPS: &[(&str, &[&str])] = &[
    ("Files", &["out", "force", "resume", "repro", "missions", "junit", "keep", "page", "picture"]),
    ("Scenario", &["sets", "seed", "executor"]),
    ("Time and machine", &["threads", "portable", "time_limit", "budget", "allow_commands"]),
    ("Output", &["json", "verbose"]),
    (
        "Map",
        &[
            "terrain_cell_m",
            "terrain_height_m",
            "terrain_origin_m",
            "terrain_columns",
            "terrain_epsg",
            "terrain_unit",
            "terrain_height_unit",
        ],
    ),
];

/// Headings of options as one verb means them.
const OF_VERBS: &[(&str, &str, &[&str])] = &[
    ("steer", "Start and goal", &["from", "to", "frame", "v0", "vf", "direction", "direction_end"]),
    ("steer", "Many at once", &["queries", "out", "resume"]),
    ("steer", "Vehicle and controls", &["control", "cruise", "acceleration", "max_curvature", "reversals", "turns"]),
    ("steer", "Ground", &["terrain", "kinematics", "no_data", "max_steps", "time_step_s"]),
    ("steer", "Obstacles", &["keep_out", "keep_out_circle", "keep_out_polygon"]),
    (
        "steer",
        "Solver",
        &[
            "cost",
            "tolerance_m",
            "tolerance_yaw_rad",
            "tolerance_curvature_1_m",
            "tolerance_speed_m_s",
            "iterations",
            "step_scale",
            "start_table",
            "time_limit_ms",
        ],
    ),
    ("steer", "Output", &["plot", "path", "wheels", "json"]),
    ("plan", "Parts", &["cases", "parts"]),
    ("run-shard", "Shard", &["shard", "shards"]),
    ("judge", "Logs", &["campaign", "mission", "robot", "world", "case", "source", "from", "to", "page"]),
    ("judge", "Frame of logs", &["turn", "offset", "altitude"]),
    ("max-load", "Question", &["graph", "cloud", "start", "end", "min_cost", "visits", "programs"]),
    ("max-load", "Search", &["method", "nodes", "seed"]),
    ("max-load", "Proof", &["certificate", "verify"]),
    ("import", "Cell", &["robot", "cell", "tip", "packages", "srdf"]),
    ("experiment", "Sizes of defaults", &["runs", "cases", "executions", "pairs", "only", "seed_of"]),
    ("execute", "Runs", &["executor", "logs", "rerun_violations", "keep"]),
    ("export", "Cases", &["case", "worst", "flights"]),
    ("export", "Format", &["to", "autopilot", "accept_excursion"]),
    ("learn", "Score", &["stress"]),
    ("replay", "Case", &["case"]),
    ("select", "Choice", &["cases", "by"]),
    ("schema", "Robots", &["kind"]),
    ("calibrate", "Share", &["share", "cases"]),
    ("fit", "Logs", &["robot", "mission", "campaign", "holdout"]),
    ("check", "Mission", &["robot", "world"]),
    ("check-executor", "Conversation", &["scenario", "timeout"]),
    ("explain", "Search", &["graphs"]),
    ("shrink", "Case", &["case"]),
    ("compare", "What fails", &["fail_on", "tolerance_m"]),
    ("merge", "Parts", &["remove_parts"]),
    ("import", "Program", &["check", "procedure", "lines"]),
    ("init", "Workflow", &["scenario", "source"]),
    ("report", "Page", &["case", "open"]),
    ("simulate", "Flight", &["rotor_speeds"]),
    ("bench", "Sizes", &["queries", "minutes", "write", "questions", "list", "repeats", "inputs", "scratch"]),
    ("experiment", "Size", &["full"]),
    ("requirements", "Map and questions", &["terrain", "rocks", "queries", "write_regression"]),
];

/// Two examples of a verb, each of which can be typed as it is.
pub(crate) fn examples(verb: &str) -> Option<[&'static str; 2]> {
    EXAMPLES.iter().find(|(of, _)| *of == verb).map(|(_, examples)| *examples)
}

const EXAMPLES: &[(&str, [&str; 2])] = &[
    ("demo", ["hairpin demo", "hairpin demo rover --out shown"]),
    ("new", ["hairpin new quadrotor", "hairpin new arm --force"]),
    (
        "stress",
        [
            "hairpin stress quadrotor.toml --budget 5m --junit junit.xml",
            "hairpin stress quadrotor.toml --executor 'python3 my_simulator.py' --out out/mine",
        ],
    ),
    (
        "generate",
        ["hairpin generate quadrotor.toml --time-limit 60", "hairpin generate rover.toml --seed 7 --out out/rover-7"],
    ),
    (
        "execute",
        ["hairpin execute out/quadrotor --resume", "hairpin execute out/quadrotor --rerun-violations 20 --keep worst"],
    ),
    (
        "judge",
        [
            "hairpin judge out/quadrotor --set spec.deviation.max_m=0.8",
            "hairpin judge logs --campaign out/quadrotor --junit junit.xml",
        ],
    ),
    ("learn", ["hairpin learn out/quadrotor --out model.json", "hairpin learn out/a out/b --stress mean-deviation"]),
    ("verify", ["hairpin verify out/quadrotor", "hairpin verify out/arm --json"]),
    ("replay", ["hairpin replay out/quadrotor --case 17", "hairpin replay out/quadrotor/repro/0017.json --json"]),
    (
        "select",
        [
            "hairpin select out/quadrotor --cases 10 --out ten",
            "hairpin select out/quadrotor --cases 5 --by stress --out five",
        ],
    ),
    ("calibrate", ["hairpin calibrate quadrotor.toml", "hairpin calibrate quadrotor.toml --share 0.01 --json"]),
    (
        "fit",
        [
            "hairpin fit log_1.ulg log_2.ulg --robot x500 --mission mine.plan --out mine.toml",
            "hairpin fit logs/*.csv --robot x500 --campaign out/quadrotor --out mine.toml",
        ],
    ),
    ("check", ["hairpin check mine.plan --robot anafi", "hairpin check mine.csv --robot my_drone.toml --json"]),
    (
        "check-executor",
        [
            "hairpin check-executor 'python3 my_simulator.py'",
            "hairpin check-executor 'python3 my_simulator.py' --scenario rover.toml --json",
        ],
    ),
    ("explain", ["hairpin explain quadrotor.toml", "hairpin explain quadrotor.toml --set task.length=14"]),
    ("shrink", ["hairpin shrink out/quadrotor --case 17", "hairpin shrink out/quadrotor --case 17 --time-limit 60"]),
    ("compare", ["hairpin compare v1 v2", "hairpin compare v1 v2 --fail-on regression --json"]),
    (
        "plan",
        [
            "hairpin plan quadrotor.toml --out out/wide",
            "hairpin plan quadrotor.toml --cases 10000 --parts 200 --out out/wide",
        ],
    ),
    ("run-shard", ["hairpin run-shard 3/8 out/wide", "hairpin run-shard --shard from-env out/wide --threads 4"]),
    ("merge", ["hairpin merge out/wide", "hairpin merge out/wide --json --remove-parts"]),
    ("export", ["hairpin export out/quadrotor --to csv,mcap --worst 10", "hairpin export out/arm --to rapid --case 3"]),
    ("import", ["hairpin import cell.mod --check --cell arm.toml", "hairpin import cell.mod --lines"]),
    (
        "init",
        [
            "hairpin init ci github --scenario quadrotor.toml",
            "hairpin init ci gitlab --source https://example.org/hairpin.git",
        ],
    ),
    ("report", ["hairpin report out/quadrotor --open", "hairpin report out/quadrotor --json"]),
    (
        "simulate",
        [
            "hairpin simulate flightgoggles --rotor-speeds speeds.csv --out poses.csv",
            "hairpin simulate my_drone.toml --rotor-speeds speeds.csv",
        ],
    ),
    (
        "steer",
        ["hairpin steer generic --to 4,1,0.5 --plot drive.svg", "hairpin steer rocky8 --queries Q.csv --out R.csv"],
    ),
    (
        "max-load",
        ["hairpin max-load --graph costs.csv --json", "hairpin max-load --cloud points.csv irb120 --out out/cloud"],
    ),
    (
        "start-table",
        ["hairpin start-table rocky8 --out rocky8.table", "hairpin start-table my_rover.toml --out mine.table"],
    ),
    ("bench", ["hairpin bench beam", "hairpin bench --json"]),
    ("experiment", ["hairpin experiment yields", "hairpin experiment robtest-table-1 --out tables"]),
    ("requirements", ["hairpin requirements rover", "hairpin requirements rover --json"]),
    ("show", ["hairpin show terrain yard.tif", "hairpin show terrain yard.png --terrain-cell-m 0.1 --json"]),
    ("schema", ["hairpin schema scenario", "hairpin schema --kind boat"]),
    ("completions", ["hairpin completions bash", "hairpin completions zsh"]),
    ("man", ["hairpin man --out man1", "hairpin man --out man1 --json"]),
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_verb_has_two_examples_that_can_be_typed() {
        let known = command();
        for verb in known.get_subcommands().map(Command::get_name).filter(|name| *name != "help") {
            let examples = examples(verb).unwrap_or_else(|| panic!("{verb} has no examples"));
            for example in examples {
                let typed = split(example);
                assert_eq!(typed[1], verb, "{example}");
                if let Err(error) = command().try_get_matches_from(&typed) {
                    assert_eq!(error.exit_code(), 0, "{example}: {error}");
                }
            }
        }
        assert!(EXAMPLES.iter().all(|(verb, _)| known.find_subcommand(verb).is_some()));
    }

    /// `command` and all below it, the words of each.
    fn all<'a>(command: &'a Command, words: &str) -> Vec<(String, &'a Command)> {
        let words = format!("{words} {}", command.get_name()).trim_start().to_owned();
        let parts = command.get_subcommands().filter(|part| part.get_name() != "help");
        let parts: Vec<_> = parts.flat_map(|part| all(part, &words)).collect();
        std::iter::once((words, command)).chain(parts).collect()
    }

    #[test]
    fn what_is_grouped_exists_and_every_option_of_every_verb_is_in_a_group() {
        let mut known = command();
        known.build();
        for (words, command) in all(&known, "") {
            let options = command.get_arguments().filter(|arg| !arg.is_positional());
            let alone = options.filter(|arg| arg.get_help_heading().is_none()).map(|arg| arg.get_id().to_string());
            assert_eq!(alone.collect::<Vec<_>>(), Vec::<String>::new(), "{words}: options in no group");
            let help = command.clone().render_long_help().to_string();
            assert!(!help.contains("\nOptions:"), "{help}");
            assert!(words == "hairpin" || help.contains("\nExamples:\n  hairpin "), "{help}");
        }
        for (verb, heading, grouped) in OF_VERBS {
            let parts = all(known.find_subcommand(verb).unwrap(), "");
            let is_there = |id: &&str| parts.iter().any(|(_, one)| one.get_arguments().any(|arg| arg.get_id() == *id));
            for id in *grouped {
                assert!(is_there(id), "{verb} has no --{id}, of the group {heading}");
            }
        }
    }

    /// As a shell splits what has single quotes.
    fn split(line: &str) -> Vec<String> {
        let mut words = vec![String::new()];
        let mut quoted = false;
        for c in line.chars() {
            match c {
                '\'' => quoted = !quoted,
                ' ' if !quoted => words.push(String::new()),
                c => words.last_mut().unwrap().push(c),
            }
        }
        words
    }
}
