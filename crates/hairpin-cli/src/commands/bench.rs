//! `hairpin bench`: the speeds that hairpin promises, measured here and now on one core, beside their targets.

use hairpin_jobs::{Problem, Watch};
use hairpin_lab::bench::{
    BenchSettings, CommandsSettings, WORST, list_commands, measure, measure_commands, measure_worst, write_questions,
};

use super::findings::tell;
use crate::args::{Bench, BenchCommands, Whole};

/// Runs the command: 0 when it has measured, whatever came out (a busy machine is no violation).
pub(crate) fn run(bench: &Bench, watch: &dyn Watch) -> Result<u8, Problem> {
    let name = bench.name.as_deref();
    let found = match (&bench.whole, &bench.write) {
        (Some(Whole::Commands(asked)), _) if asked.list => Ok(list_commands()),
        (Some(Whole::Commands(asked)), _) => measure_commands(&of_flags(asked), watch),
        _ if name == Some(WORST) => measure_worst(bench.queries, watch),
        (_, Some(folder)) => write_questions(name, bench.questions, folder),
        _ => measure(&BenchSettings { name: bench.name.clone(), minutes: bench.minutes }, watch),
    }?;
    Ok(tell(&found, bench.json()))
}

fn of_flags(asked: &BenchCommands) -> CommandsSettings {
    CommandsSettings {
        rows: asked.rows.clone(),
        repeats: asked.repeats,
        inputs: asked.inputs.clone(),
        scratch: asked.scratch.clone(),
    }
}

#[cfg(test)]
mod tests {
    use clap::Parser;
    use hairpin_lab::bench::list_commands;

    use crate::args::Arguments;

    #[test]
    fn what_benches_type_is_what_can_be_typed() {
        let found = list_commands();
        let rows = found.object["rows"].as_array().unwrap();
        assert!(rows.len() > 20);
        for row in rows {
            let lines = ["first", "commands"].iter().flat_map(|key| row[key].as_array().unwrap());
            for line in lines.map(|line| line.as_str().unwrap()) {
                let parsed = Arguments::try_parse_from(line.split_whitespace());
                assert!(parsed.is_ok_and(|parsed| parsed.command.json()), "{line}");
            }
        }
    }
}
