//! The rows that are asked for, measured one after the other.

use std::path::PathBuf;
use std::thread::available_parallelism;
use std::time::{Duration, Instant};

use hairpin_jobs::{Problem, Watch};
use serde_json::{Value, json};

use super::super::row::Target;
use super::line::Measured;
use super::row::{Figure, Row, Seen};
use super::scratch::{Frozen, Scratch};
use super::{campaigns, cores, drives, programs};
use crate::clock::{self, median};
use crate::findings::{Findings, Words};

/// What is measured, and where.
#[derive(Debug, Clone, PartialEq)]
pub struct CommandsSettings {
    /// Only rows whose names begin with one of these; without any, all that are not long.
    pub rows: Vec<String>,
    /// How often each command runs; the median counts.
    pub repeats: u32,
    /// The frozen inputs: `bench/commands` of a checkout.
    pub inputs: PathBuf,
    /// Where the folder lies in which commands run; where the system has such folders if not given.
    pub scratch: Option<PathBuf>,
}

/// A row that has taken so long is not repeated any more.
const LONG_ENOUGH: Duration = Duration::from_secs(60);

/// Every row, in the order of the table.
fn all() -> Vec<Row> {
    [drives::rows(), campaigns::rows(), programs::rows(), cores::rows()].into_iter().flatten().collect()
}

/// Every row with what it is and what is typed for it, without measuring.
pub fn list_commands() -> Findings {
    let mut table = vec![["row", "what", "command"].map(str::to_owned).to_vec()];
    let mut objects = Vec::new();
    for Row { name, about, long, cores, inputs, first, lines, .. } in all() {
        let about = if long { format!("{about}; takes long") } else { about };
        let typed: Vec<&str> = lines.iter().map(|line| line.typed.as_str()).collect();
        let first: Vec<&str> = first.iter().map(|line| line.typed.as_str()).collect();
        objects.push(json!({
            "row": name, "what": about, "long": long, "cores": cores, "inputs": inputs, "first": first, "commands": typed,
        }));
        table.push(vec![name, about, typed.first().map_or(String::new(), |typed| (*typed).to_owned())]);
    }
    Findings::new(vec![Words::Table(table)], json!({ "rows": objects, "exit_code": 0 }))
}

/// Measures what `settings` ask for. Whatever comes out is no violation: the machine may be busy.
///
/// # Errors
/// No row whose name begins so; inputs that are not there or no longer what was frozen; a command that fails; `watch`
/// was stopped.
pub fn measure_commands(settings: &CommandsSettings, watch: &dyn Watch) -> Result<Findings, Problem> {
    let all = all();
    let named = |row: &Row| settings.rows.iter().any(|name| row.name.starts_with(name.as_str()));
    let asked: Vec<&Row> = all.iter().filter(|row| settings.rows.is_empty() || named(row)).collect();
    if asked.is_empty() {
        let names: Vec<&str> = all.iter().map(|row| row.name.as_str()).collect();
        return Err(Problem::input(format!("no row begins with that name; there are {}", names.join(", "))));
    }
    let scratch = Scratch::new(Frozen::of(&settings.inputs)?, settings.scratch.as_deref())?;
    clock::warn_of_debug_build(watch);
    let there = available_parallelism().map_or(1, usize::from);
    let (mut told, mut left_out) = (Told::new(), Vec::new());
    for row in asked {
        if row.long && !named(row) {
            left_out.push((row.name.clone(), "takes more than two minutes: name it".to_owned()));
        } else if row.cores > there {
            left_out.push((row.name.clone(), format!("needs {} cores, there are {there}", row.cores)));
        } else {
            tracing::info!("{}", row.name);
            let (lines, runs) = run(row, settings.repeats, &scratch, watch)?;
            told.add(row, &lines, runs, (row.tell)(&Seen { lines: &lines, scratch: &scratch })?);
        }
    }
    Ok(told.findings(&left_out))
}

/// Runs a row's commands as often as asked; each one's median, and how often that was.
fn run(row: &Row, repeats: u32, scratch: &Scratch, watch: &dyn Watch) -> Result<(Vec<Measured>, usize), Problem> {
    for input in &row.inputs {
        scratch.provide(input)?;
    }
    for line in &row.first {
        if line.makes.is_none_or(|made| !scratch.path().join(made).exists()) {
            line.run(scratch.path(), watch)?;
        }
    }
    let begun = Instant::now();
    let mut passes: Vec<Vec<Measured>> = Vec::new();
    while passes.len() < repeats as usize && (passes.is_empty() || begun.elapsed() < LONG_ENOUGH) {
        passes.push(row.lines.iter().map(|line| line.run(scratch.path(), watch)).collect::<Result<_, _>>()?);
    }
    let runs = passes.len();
    let median_of = |line: usize, value: fn(&Measured) -> f64| median(passes.iter().map(|pass| value(&pass[line])));
    let medians = (0..row.lines.len()).filter_map(|line| {
        let last = passes.last()?[line].clone();
        let most = passes.iter().filter_map(|pass| pass[line].peak_mb).reduce(f64::max);
        let (cpu_s, wall_s) = (median_of(line, |run| run.cpu_s), median_of(line, |run| run.wall_s));
        Some(Measured { cpu_s, wall_s, peak_mb: most, ..last })
    });
    Ok((medians.collect(), runs))
}

/// What was measured so far, as tables and as objects.
struct Told {
    figures: Vec<Vec<String>>,
    commands: Vec<Vec<String>>,
    objects: Vec<Value>,
}

impl Told {
    fn new() -> Self {
        let figures = ["row", "what", "measured", "unit", "kernel", "ratio", "target", "met"];
        let commands = ["row", "CPU s", "wall s", "runs", "MB", "files", "peak MB", "exit", "command"];
        let header = |names: &[&str]| vec![names.iter().map(|name| (*name).to_owned()).collect()];
        Self { figures: header(&figures), commands: header(&commands), objects: Vec::new() }
    }

    fn add(&mut self, row: &Row, lines: &[Measured], runs: usize, figures: Vec<Figure>) {
        let mut commands = Vec::new();
        for (line, run) in row.lines.iter().zip(lines) {
            self.commands.push(vec![
                row.name.clone(),
                shown(run.cpu_s),
                shown(run.wall_s),
                runs.to_string(),
                or_none(run.size.map(|size| size.megabytes())),
                run.size.map_or_else(none, |size| size.files.to_string()),
                or_none(run.peak_mb),
                run.exit_code.to_string(),
                line.typed.clone(),
            ]);
            commands.push(json!({
                "command": line.typed,
                "cpu_s": run.cpu_s,
                "wall_s": run.wall_s,
                "runs": runs,
                "bytes": run.size.map(|size| size.bytes),
                "files": run.size.map(|size| size.files),
                "peak_mb": run.peak_mb,
                "exit_code": run.exit_code,
            }));
        }
        let objects: Vec<Value> = figures.iter().map(object).collect();
        self.figures.extend(figures.iter().map(|figure| cells(&row.name, figure)));
        self.objects.push(json!({ "row": row.name, "what": row.about, "commands": commands, "figures": objects }));
    }

    fn findings(self, left_out: &[(String, String)]) -> Findings {
        let conditions = format!("median of the runs, {} of the command's process; kernels in this one", clock::NAME);
        let mut words = vec![Words::Table(self.figures), Words::Table(self.commands), Words::Text(conditions)];
        words.extend(Words::lines(left_out.iter().map(|(name, why)| format!("left out: {name}, {why}"))));
        let left_out: Vec<Value> = left_out.iter().map(|(name, why)| json!({ "row": name, "why": why })).collect();
        let object = json!({ "clock": clock::NAME, "rows": self.objects, "left_out": left_out, "exit_code": 0 });
        Findings::new(words, object)
    }
}

fn met(figure: &Figure) -> Option<bool> {
    figure.target.map(|target| target.met(figure.value))
}

fn cells(row: &str, figure: &Figure) -> Vec<String> {
    let target = figure.target.map_or_else(none, |target| match target {
        Target::AtLeast(bound) => format!("≥ {}", shown(bound)),
        Target::AtMost(bound) => format!("≤ {}", shown(bound)),
    });
    let word = met(figure).map_or_else(none, |met| if met { "yes" } else { "NO" }.to_owned());
    let (kernel, ratio) = (or_none(figure.kernel), or_none(figure.ratio()));
    vec![row.into(), figure.what.into(), shown(figure.value), figure.unit.into(), kernel, ratio, target, word]
}

fn object(figure: &Figure) -> Value {
    json!({
        "figure": figure.what,
        "measured": figure.value,
        "unit": figure.unit,
        "kernel": figure.kernel,
        "ratio": figure.ratio(),
        "target": figure.target.map(Target::words),
        "met": met(figure),
    })
}

fn none() -> String {
    "–".into()
}

fn or_none(value: Option<f64>) -> String {
    value.map_or_else(none, shown)
}

/// Three digits, or all that stand before the point.
fn shown(value: f64) -> String {
    let decimals = (0..3).find(|decimals| value.abs() >= f64::from(10_u32.pow(2 - decimals))).unwrap_or(3);
    let text = format!("{value:.*}", decimals as usize);
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;
    use std::path::Path;

    use super::super::scratch::SUMS;
    use super::*;

    #[test]
    fn every_file_that_is_typed_is_an_input_or_made() {
        let folder = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../../bench/commands"));
        let sums = std::fs::read_to_string(folder.join(SUMS)).unwrap();
        let made: BTreeSet<&str> = sums.lines().filter_map(|line| Some(line.split_once("  ")?.1)).collect();
        let mut read = BTreeSet::new();
        for row in all() {
            for input in &row.inputs {
                assert!(folder.join(input).is_file() != made.contains(input.as_str()), "{}: {input}", row.name);
                read.insert(input.clone());
            }
            for line in row.first.iter().chain(&row.lines) {
                let given = |word: &&str| [".csv", ".npy", ".toml"].iter().any(|end| word.ends_with(end));
                for word in line.words().filter(given) {
                    let known = row.inputs.iter().any(|input| input == word) || line.makes == Some(word);
                    assert!(known, "{}: {word}", row.name);
                }
            }
        }
        let frozen = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap());
        let frozen = frozen.filter(|name| name != SUMS && name != "README.md");
        let all: BTreeSet<String> = frozen.chain(made.iter().map(|name| (*name).to_owned())).collect();
        assert_eq!(all, read, "what is frozen is what is read");
    }

    #[test]
    fn numbers_have_three_digits() {
        let texts = [0.0, 0.01234, 0.5, 1.05, 15.0, 43.27, 999.6, 12_345.6].map(shown);
        assert_eq!(texts, ["0", "0.012", "0.5", "1.05", "15", "43.3", "1000", "12346"]);
    }

    #[test]
    fn rates_and_times_have_their_ratios_the_same_way_round() {
        let slow = Figure::new("a query", "µs", 30.0).beside(10.0).at_most(15.0);
        let rate = Figure::new("trajectories", "1/s", 100.0).beside(300.0).at_least(240.0);
        assert_eq!((slow.ratio(), met(&slow)), (Some(3.0), Some(false)));
        assert_eq!((rate.ratio(), met(&rate)), (Some(3.0), Some(false)));
    }
}
