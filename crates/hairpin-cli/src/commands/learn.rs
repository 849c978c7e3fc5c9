//! `hairpin learn`: a score from executed legs.

use hairpin::campaign::learn::{learn, leg_samples};
use hairpin_formats::atomic;
use hairpin_formats::scenario::model_text;
use rayon::prelude::*;
use serde_json::json;

use crate::args::Learn;
use crate::problem::Problem;
use crate::{console, folder};

/// Runs the command: 0 when the model is written, however good it is.
pub(crate) fn run(asked: &Learn) -> Result<u8, Problem> {
    let work = folder::look(&asked.folder)?;
    let stress = asked.stress;
    let cases = work.folder.read_cases()?;
    let table = work.folder.read_runs_table()?;
    let samples: Result<Vec<_>, Problem> = cases
        .par_iter()
        .map(|case| {
            let runs = work.folder.read_runs(case.number, &table)?;
            Ok(leg_samples(&work.setup, case, &runs, stress))
        })
        .collect();
    let samples = samples?.concat();
    let place = asked.folder.display();
    if samples.is_empty() {
        return Err(Problem::input(format!(
            "{place}: no leg to learn from: cases need legs that a search saw, executions, and {} measured on them",
            stress.word()
        )));
    }
    let model = learn(&work.setup, stress, &samples).map_err(|error| Problem::input(format!("{place}: {error}")))?;
    atomic::write(&asked.out, model_text(&model).as_bytes())?;
    let (validation, held_out) = (model.validation, model.held_out);
    if asked.json {
        let answer = json!({
            "model": asked.out,
            "stress": stress.word(),
            "unit": model.unit,
            "trajectories": model.trajectories,
            "legs": model.legs,
            "degree": model.polynomial.degree,
            "penalty": model.polynomial.penalty,
            "validation": validation,
            "held_out": held_out,
            "training_hash": model.training_hash,
            "exit_code": 0,
        });
        console::say(&answer.to_string());
    } else {
        let unit = if model.unit.is_empty() { String::new() } else { format!(" {}", model.unit) };
        let rank = held_out.rank_correlation.map_or("none".into(), |rank| format!("{rank:.2}"));
        console::say(&format!(
            "{}: {} of {} legs of {} trajectories, degree {}, penalty {:e}",
            asked.out.display(),
            stress.word(),
            model.legs,
            model.trajectories,
            model.polynomial.degree,
            model.polynomial.penalty,
        ));
        console::say(&format!(
            "cross-validation: R² {:.3}, error {:.3}{unit}; {} trajectories held out: R² {:.3}, error {:.3}{unit}, rank correlation \
             of their largest {rank}",
            validation.r2, validation.rmse, held_out.trajectories, held_out.r2, held_out.rmse,
        ));
        console::say(&format!("use it: generate.score = \"learned:{}\"", asked.out.display()));
    }
    Ok(0)
}
