//! What can be typed. No meaning here: that is in `commands`.

mod bench;
mod calibrate;
mod check;
mod check_executor;
mod cluster;
mod commands;
mod compare;
mod experiment;
mod explain;
mod fit;
mod import;
mod init;
mod judge;
mod junit;
mod keys;
mod learn;
mod man;
mod max_load;
mod numbers;
mod pipeline;
mod requirements;
mod resources;
mod select;
mod shrink;
mod steer;
mod terrain;

use std::path::PathBuf;

use clap::builder::PossibleValuesParser;
use clap::{Args, Parser, Subcommand, ValueEnum};
use hairpin_formats::template::{self, KINDS};

pub(crate) use bench::{Bench, BenchCommands, Whole};
pub(crate) use calibrate::Calibrate;
pub(crate) use check::Check;
pub(crate) use check_executor::CheckExecutor;
pub(crate) use cluster::{Merge, Plan, RunShard};
pub(crate) use commands::Commands;
pub(crate) use compare::{Compare, FailOn};
pub(crate) use experiment::Experiment;
pub(crate) use explain::Explain;
pub(crate) use fit::Fit;
pub(crate) use import::Import;
pub(crate) use init::{Ci, Init, Initial, Server};
pub(crate) use judge::{AltitudeName, Judge};
pub(crate) use keys::Keys;
pub(crate) use learn::Learn;
pub(crate) use man::Man;
pub(crate) use max_load::{MaxLoad, SearchMethod};
pub(crate) use pipeline::{
    Autopilot, Campaign, Execute, Export, Format, Generate, Keep, Kept, Replay, ReportArguments, Stress, Verify,
};
pub(crate) use requirements::Requirements;
pub(crate) use resources::{Kernels, Threads};
pub(crate) use select::{Select, SelectBy};
pub(crate) use shrink::Shrink;
pub(crate) use steer::{KeepOutFlags, StartTable, Steer, SteerFrame};
pub(crate) use terrain::{MapFlags, MapUnit, NoData, Show, ShowTerrain, Shown};

/// Finds the trajectories a robot handles worst, and proves that they are ones it could have flown.
///
/// A test generator: what it writes is stressful by design and is no safety certificate.
#[derive(Debug, Parser)]
#[command(name = "hairpin", version, propagate_version = true, arg_required_else_help = true, after_help = EXIT_CODES)]
pub(crate) struct Arguments {
    #[command(subcommand)]
    pub(crate) command: Command,
    /// Tell what is done, on stderr; twice: with what.
    #[arg(short, long, global = true, action = clap::ArgAction::Count)]
    pub(crate) verbose: u8,
}

const EXIT_CODES: &str = "\
Exit codes: 0 within spec, 1 violation or finding, 2 wrong input, 3 nothing feasible, 4 executor failed, \
5 inconclusive; and beside verdicts 70 a mistake of hairpin's own, 74 a result that could not be \
written, 130 interrupted (--resume goes on). `hairpin help exit-codes` explains each";

#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    /// A small campaign with result and report within 10 s; writes ./hairpin-demo
    Demo(Demo),
    /// Write a commented scenario file that runs as it is into the current folder
    New(New),
    /// Generate, execute, judge, report: the main job
    Stress(Stress),
    /// Find feasible and stressful trajectories: the first part of `stress`
    Generate(Generate),
    /// Fly the trajectories of a campaign folder: the second part
    Execute(Execute),
    /// Judge the flights of a campaign folder: the third part; or logs of real ones: judge LOG|FOLDER --campaign OUT
    Judge(Box<Judge>),
    /// Learn a score from the flights of campaign folders: learn OUT --out MODEL, then score = "learned:MODEL"
    Learn(Learn),
    /// Integrate every control witness of a campaign by independent code, and hold its planned motions to them
    Verify(Verify),
    /// Fly a violating case again, from its repro file
    Replay(Replay),
    /// Choose K of a campaign's cases for stress, diversity or coverage: a campaign folder of its own
    Select(Select),
    /// Propose limits for [spec]: those that 5 % of random feasible cases break
    Calibrate(Calibrate),
    /// Estimate a robot's numbers from logs of its flights, drives or programs, and tell what they do not show
    Fit(Fit),
    /// Check whether a robot can do a mission made elsewhere: check MISSION --robot R
    Check(Check),
    /// Check that a program speaks the executor protocol: what was said, and a sentence for each mistake
    CheckExecutor(CheckExecutor),
    /// Tell why nothing (or little) is feasible, and the smallest change that helps
    Explain(Explain),
    /// Reduce a violating case to the shortest feasible one that still violates
    Shrink(Shrink),
    /// Compare two judged campaigns over the same cases: better, worse, newly failing
    Compare(Compare),
    /// Divide a campaign for several machines: plan SCENARIO --out DIR, then run-shard and merge
    Plan(Box<Plan>),
    /// Make one machine's share of a plan: run-shard 3/8 DIR, or --shard from-env DIR
    RunShard(RunShard),
    /// Put together what shards have made: the same campaign as from one machine
    Merge(Merge),
    /// Write a campaign's trajectories for other programs
    Export(Export),
    /// Read a program from elsewhere and check it by line: import CELL.mod --check
    Import(Import),
    /// Write a build server's workflow: init ci github, gitlab or jenkins
    Init(Init),
    /// Write a campaign's report.html
    Report(ReportArguments),
    /// Fly a rotor-speed profile open loop: poses in time as CSV
    Simulate(Simulate),
    /// Solve boundary-value drives of a ground vehicle: one (--to), or a file of them (--queries)
    Steer(Box<Steer>),
    /// Find the path through a graph that costs most: --graph COSTS.csv
    MaxLoad(Box<MaxLoad>),
    /// Make a table of start values for a vehicle, for steer --start-table
    StartTable(StartTable),
    /// Measure what hairpin promises of its speed, on one core; bench commands: whole commands beside their kernels
    Bench(Bench),
    /// Run an experiment of the papers, or one that they left open: table as CSV, figure as SVG
    Experiment(Experiment),
    /// Check the requirements of a generator one by one: requirements rover
    Requirements(Requirements),
    /// Tell what a file holds: show terrain FILE
    Show(Show),
    /// Print the JSON Schema of scenario or robot files, for editors
    Schema(Schema),
    /// Print a shell's completions
    Completions(Completions),
    /// Write man pages
    Man(Man),
}

impl Command {
    /// Whether stdout is for machines.
    pub(crate) fn json(&self) -> bool {
        match self {
            Self::Demo(a) => a.json,
            Self::Stress(a) => a.campaign.json,
            Self::Generate(a) => a.campaign.json,
            Self::Execute(a) => a.json,
            Self::Judge(a) => a.json,
            Self::Learn(a) => a.json,
            Self::Verify(a) => a.json,
            Self::Replay(a) => a.json,
            Self::Compare(a) => a.json,
            Self::Shrink(a) => a.json,
            Self::Select(a) => a.json,
            Self::Plan(a) => a.json,
            Self::RunShard(a) => a.json,
            Self::Merge(a) => a.json,
            Self::Explain(a) => a.json,
            Self::Calibrate(a) => a.json,
            Self::Fit(a) => a.json,
            Self::Bench(a) => a.json(),
            Self::Check(a) => a.json,
            Self::CheckExecutor(a) => a.json,
            Self::Steer(a) => a.json,
            Self::MaxLoad(a) => a.json,
            Self::StartTable(a) => a.json,
            Self::Experiment(a) => a.json,
            Self::Requirements(a) => a.json,
            Self::Show(Show { what: Shown::Terrain(a) }) => a.json,
            Self::New(a) => a.json,
            Self::Export(a) => a.json,
            Self::Import(a) => a.json,
            Self::Man(a) => a.json,
            Self::Init(Init { what: Initial::Ci(a) }) => a.json,
            Self::Report(a) => a.json,
            Self::Simulate(_) | Self::Schema(_) | Self::Completions(_) => false,
        }
    }
}

#[derive(Debug, Args)]
pub(crate) struct Demo {
    /// The robot to show
    #[arg(value_parser = PossibleValuesParser::new(KINDS), default_value = KINDS[0])]
    pub(crate) kind: String,
    /// Campaign folder
    #[arg(long, value_name = "DIR", default_value = "hairpin-demo")]
    pub(crate) out: PathBuf,
    /// Replace a campaign in --out (the default folder is always replaced)
    #[arg(long)]
    pub(crate) force: bool,
    /// One JSON object on stdout
    #[arg(long)]
    pub(crate) json: bool,
    #[command(flatten)]
    pub(crate) threads: Threads,
    #[command(flatten)]
    pub(crate) kernels: Kernels,
}

#[derive(Debug, Args)]
pub(crate) struct New {
    /// The robot's kind
    #[arg(value_parser = PossibleValuesParser::new(template::names()))]
    pub(crate) kind: String,
    /// Overwrite the file
    #[arg(long)]
    pub(crate) force: bool,
    /// One JSON object on stdout
    #[arg(long)]
    pub(crate) json: bool,
}

/// The flight begins level and at rest at the origin, rotors at the first row's speeds. Each row's speeds are asked for
/// until the next row's time; the last row ends the flight. One pose per row, world frame, z up.
#[derive(Debug, Args)]
pub(crate) struct Simulate {
    /// Robot: a shipped name, a robot file, or a scenario that has one
    pub(crate) robot: String,
    /// CSV: t_s,rotor1_rad_s,rotor2_rad_s,rotor3_rad_s,rotor4_rad_s
    #[arg(long, value_name = "CSV")]
    pub(crate) rotor_speeds: PathBuf,
    /// Where the poses go; stdout if not given
    #[arg(long, value_name = "CSV")]
    pub(crate) out: Option<PathBuf>,
    /// Override one key, such as robot.drag_quadratic_n_s2_m2=0; repeatable
    #[arg(long = "set", value_name = "KEY=VALUE")]
    pub(crate) sets: Vec<String>,
}

/// What a schema can be of.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum Document {
    /// Scenarios of flights
    Scenario,
    /// Scenarios of drives
    RoverScenario,
    /// Scenarios of arms
    ArmScenario,
    /// Quadrotors
    Robot,
    /// Rovers
    Rover,
    /// Cars
    Car,
    /// Differential drives
    DifferentialDrive,
    /// Arms
    Arm,
}

#[derive(Debug, Args)]
pub(crate) struct Schema {
    /// The kind of file
    #[arg(value_enum, default_value_t = Document::Scenario)]
    pub(crate) document: Document,
    /// Scenarios of robots whose file says this `kind`
    #[arg(long, value_name = "WORD", conflicts_with = "document")]
    pub(crate) kind: Option<String>,
}

#[derive(Debug, Args)]
pub(crate) struct Completions {
    /// The shell
    #[arg(value_enum)]
    pub(crate) shell: clap_complete::Shell,
}
