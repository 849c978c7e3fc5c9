//! `hairpin select`: a few of many cases, in a campaign folder of their own.

use hairpin::campaign::digits::number;
use hairpin::campaign::select::{By, Measured};
use hairpin_jobs::select::{SelectSettings, Selected, StressUnit, select};
use hairpin_jobs::{Problem, Watch};
use serde_json::json;

use crate::args::{Commands, Select, SelectBy};
use crate::exit::DONE;
use crate::{console, settings};

/// Runs the command: 0 when the folder is written.
pub(crate) fn run(asked: &Select, watch: &dyn Watch) -> Result<u8, Problem> {
    settings::take_threads(&asked.threads);
    let by = match asked.by {
        SelectBy::Stress => By::Stress,
        SelectBy::Diverse => By::Diverse,
        SelectBy::Coverage => By::Coverage,
    };
    let settings = SelectSettings {
        folder: asked.folder.clone(),
        cases: asked.cases as usize,
        by,
        out: asked.out.clone(),
        if_there: settings::if_there(false, asked.force),
        consent: settings::consent(&Commands { allow_commands: false }),
    };
    let selected = select(&settings, watch)?;
    let sentence = sentence(&selected);
    if asked.json {
        let Selected { folder, names, selected, most_stressful, all, cells, .. } = selected;
        let object = json!({
            "verdict": sentence, "exit_code": DONE, "by": by, "guarantee": by.guarantee(), "cases": names,
            "selected": selected, "most_stressful": most_stressful, "all": all, "cells": cells,
            "paths": { "folder": folder },
        });
        console::say(&object.to_string());
    } else {
        in_words(&selected, by);
        console::say(&format!("in the order of choice: {}", selected.names.join(", ")));
        console::say(&sentence);
        console::warn(&format!("folder: {}", selected.folder.display()));
    }
    Ok(DONE)
}

fn sentence(
    Selected { names, of, selected: found, most_stressful: stressful, cells, stress, .. }: &Selected,
) -> String {
    let badly = |one: &Measured| match one.ended_badly {
        0 => String::new(),
        badly => format!(", {badly} ended badly"),
    };
    let (count, told) = (names.len(), |value| with_unit(&in_unit(value, *stress), *stress));
    let met = found.cells.map_or_else(|| "not executed".into(), |met| format!("{met} of {cells} cells"));
    let most = stressful.cells.map_or(String::new(), |met| format!(", {met}"));
    format!(
        "SELECTED {count} of {of} cases: stress {}{}, spread {:.2}, {met}; the {count} most stressful: {}{}, {:.2}{most}",
        told(found.stress),
        badly(found),
        found.spread,
        told(stressful.stress),
        badly(stressful),
        stressful.spread,
    )
}

fn in_unit(value: f64, stress: StressUnit) -> String {
    number(Some(stress.factor * value))
}

/// `words` with the unit behind them, if there is one.
fn with_unit(words: &str, stress: StressUnit) -> String {
    format!("{words} {}", stress.unit).trim_end().to_owned()
}

fn in_words(selected: &Selected, by: By) {
    let measured = [&selected.selected, &selected.most_stressful, &selected.all];
    let stress = selected.stress;
    let header = ["", "cases", "mean stress", "worst", "ended badly", "spread", "nearest pair", "cells"];
    let header = header
        .map(|name| if name == "mean stress" || name == "worst" { with_unit(name, stress) } else { name.into() })
        .to_vec();
    let rows = ["chosen", "most stressful", "all"].iter().zip(measured).map(|(name, one)| {
        vec![
            (*name).to_owned(),
            one.cases.to_string(),
            in_unit(one.stress, stress),
            in_unit(one.worst, stress),
            one.ended_badly.to_string(),
            format!("{:.3}", one.spread),
            format!("{:.3}", one.nearest),
            one.cells.map_or_else(|| "–".into(), |met| met.to_string()),
        ]
    });
    console::say_lines(&console::table(&std::iter::once(header).chain(rows).collect::<Vec<_>>()));
    console::say(&format!("{}; distances are 0 … 1, over waypoints and over behaviour\n", by.guarantee()));
}
