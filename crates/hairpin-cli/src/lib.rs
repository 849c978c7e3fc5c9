//! The command line of hairpin: what was typed becomes the settings of a job, and what came of it words and an exit
//! code.

#![cfg_attr(not(test), deny(clippy::unwrap_used))] // tests may, what meets users' data may not

mod args;
pub mod commands;
mod console;
mod exit;
mod help;
mod interrupt;
mod settings;
mod terminal;

use std::ffi::OsString;
use std::panic::catch_unwind;

use clap::FromArgMatches;

use args::{Arguments, Command};
use exit::{DONE, OUR_MISTAKE, WRONG_INPUT};
use hairpin::campaign::CallersCode;
use hairpin_formats::{foreign, library};
use hairpin_jobs::Problem;
use terminal::Terminal;

/// Runs the command in `arguments`, whose first is the program's name, and gives its exit code. Results go to stdout,
/// everything else to stderr.
pub fn run(arguments: impl IntoIterator<Item = OsString>) -> u8 {
    run_with(arguments, Extra::default())
}

/// What a binary of another crate brings along.
#[derive(Clone, Default)]
pub struct Extra {
    /// Its score, target or controller: it answers wherever a scenario names a file, or of controllers a command, for
    /// one.
    pub code: CallersCode,
    /// Its robots, name and text of a robot's file each: known wherever a shipped one is, by `robot = "NAME"`, and to
    /// `hairpin new NAME` and completions.
    pub robots: Vec<(&'static str, &'static str)>,
}

impl From<CallersCode> for Extra {
    fn from(code: CallersCode) -> Self {
        Self { code, ..Self::default() }
    }
}

/// The same with what the caller brings: a binary of another crate has the whole command line with its own code and
/// robots. Of two calls in one process the first one's count. A robot's name that something shipped has, and a text
/// that is no robot's file, are wrong input (2).
pub fn run_with(arguments: impl IntoIterator<Item = OsString>, extra: impl Into<Extra>) -> u8 {
    let Extra { code, robots } = extra.into();
    settings::bring(code);
    if let Err(sentence) = library::bring(&robots) {
        return exit::tell(&Problem::input(sentence), false);
    }
    apologise_when_panicking();
    let arguments: Vec<OsString> = arguments.into_iter().collect();
    if arguments.get(1..).is_some_and(|typed| typed == ["help", "exit-codes"]) {
        console::say_lines(&exit::explained());
        return exit::all_said(DONE);
    }
    if arguments.len() <= 1 {
        console::warn_in_colour(help::WAYS_IN);
        return WRONG_INPUT;
    }
    let parsed = match parse(&arguments) {
        Ok(parsed) => parsed,
        Err(usage) => return explain(&usage, arguments.iter().any(|argument| argument == "--json")),
    };
    let json = parsed.command.json();
    // A panic has told its sentence already; it must not look like a verdict.
    exit::all_said(match catch_unwind(|| command(parsed)) {
        Ok(Ok(code)) => code,
        Ok(Err(problem)) => exit::tell(&problem, json),
        Err(_) => OUR_MISTAKE,
    })
}

fn parse(arguments: &[OsString]) -> Result<Arguments, clap::Error> {
    let mut command = help::command();
    let matches = command.try_get_matches_from_mut(arguments)?;
    Arguments::from_arg_matches(&matches).map_err(|error| error.format(&mut command))
}

/// Help and version on stdout with 0, wrong usage on stderr with 2, as clap has it; machines get the latter as an
/// object.
fn explain(usage: &clap::Error, json: bool) -> u8 {
    // It fails only where nobody reads on.
    let _ = usage.print();
    if usage.exit_code() == 0 {
        return DONE;
    }
    if json {
        let sentence = on_a_line(&usage.render().to_string());
        console::say(&exit::object(&Problem::input(sentence)).to_string());
    }
    WRONG_INPUT
}

/// What clap says of wrong usage, on one line: what is wrong, missing or possible, and what may have been meant; not
/// the usage below it.
fn on_a_line(text: &str) -> String {
    let end = ["\n\nUsage:", "\n\nFor more information"].iter().find_map(|below| text.rfind(below));
    let text = &text[..end.unwrap_or(text.len())];
    let mut sentence = String::new();
    for line in text.trim_start_matches("error: ").lines().map(str::trim).filter(|line| !line.is_empty()) {
        sentence += match sentence.chars().last() {
            None => "",
            Some(':') => " ",
            Some(_) if line.starts_with('[') => " ",
            Some(_) => "; ",
        };
        sentence += line;
    }
    sentence
}

fn command(arguments: Arguments) -> Result<u8, Problem> {
    console::chatter(arguments.verbose);
    interrupt::listen();
    let watch = &Terminal::default();
    match arguments.command {
        Command::Demo(demo) => commands::demo::run(&demo, watch),
        Command::New(new) => commands::new::run(&new),
        Command::Stress(stress) => commands::stress::run(&stress, watch),
        Command::Generate(generate) => commands::generate::run(&generate, watch),
        Command::Execute(execute) => commands::execute::run(&execute, watch),
        Command::Judge(judge) => commands::judge::run(&judge, watch),
        Command::Learn(learn) => commands::learn::run(&learn),
        Command::Verify(verify) => commands::verify::run(&verify),
        Command::Replay(replay) => commands::replay::run(&replay, watch),
        Command::Compare(compare) => commands::compare::run(&compare),
        Command::Explain(explain) => commands::explain::run(&explain, watch),
        Command::Calibrate(asked) => commands::calibrate::run(&asked, watch),
        Command::Fit(asked) => commands::fit::run(&asked, watch),
        Command::Check(asked) => commands::check::run(&asked, watch),
        Command::CheckExecutor(asked) => commands::check_executor::run(&asked, watch),
        Command::Select(select) => commands::select::run(&select, watch),
        Command::Shrink(shrink) => commands::shrink::run(&shrink, watch),
        Command::Plan(asked) => commands::cluster::run_plan(&asked, watch),
        Command::RunShard(asked) => commands::cluster::run(&asked, watch),
        Command::Merge(asked) => commands::cluster::run_merge(&asked, watch),
        Command::Export(export) => commands::export::run(&export),
        Command::Import(import) => commands::import::run(&import),
        Command::Init(init) => commands::init::run(&init),
        Command::Report(report) => commands::report::run(&report),
        Command::Simulate(simulate) => commands::simulate::run(&simulate),
        Command::Steer(steer) => commands::steer::run(&steer, watch),
        Command::MaxLoad(asked) => commands::max_load::run(&asked, watch),
        Command::StartTable(table) => commands::steer::make_table(&table),
        Command::Bench(bench) => commands::bench::run(&bench, watch),
        Command::Experiment(experiment) => commands::experiment::run(&experiment, watch),
        Command::Requirements(requirements) => commands::requirements::run(&requirements),
        Command::Show(show) => commands::show::run(&show),
        Command::Schema(schema) => commands::schema::run(&schema),
        Command::Completions(completions) => commands::completions::run(&completions),
        Command::Man(man) => commands::man::run(&man),
    }
}

fn apologise_when_panicking() {
    std::panic::set_hook(Box::new(|panic| {
        // A decoder's, of a broken file: told as wrong input by whoever reads that.
        if foreign::is_called() {
            return;
        }
        let place = panic.location().map_or(String::new(), |at| format!(" ({}:{})", at.file(), at.line()));
        let payload = panic.payload();
        let text = payload.downcast_ref::<String>().map(String::as_str);
        let message = text.or_else(|| payload.downcast_ref().copied()).unwrap_or("no message");
        console::warn(&format!(
            "this is a mistake of hairpin's own, not yours: please report it with the command and its files: {message}{place}"
        ));
    }));
}
