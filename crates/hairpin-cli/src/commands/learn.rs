//! `hairpin learn`: a score from executed legs.

use hairpin::campaign::Case;
use hairpin::campaign::samples::{learn, learn_moves, leg_samples, move_samples};
use hairpin::math::ridge::NoFit;
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
    let place = asked.folder.display();
    let what = if work.setup.arm().is_some() { "move" } else { "leg" };
    let found = |samples: usize| {
        let missing = match samples {
            0 if table.is_empty() => format!("nothing was executed: hairpin execute {place}"),
            0 if work.setup.arm().is_none() && cases.iter().all(|case| case.seen.is_empty()) => {
                "no search saw the legs of its cases, as of missions made elsewhere".to_owned()
            }
            0 => format!("{} was measured on none of them", stress.word()),
            _ => return Ok(()),
        };
        Err(Problem::input(format!("{place}: no {what} to learn from: {missing}")))
    };
    let runs = |case: &Case| work.folder.read_runs(case.number, &table);
    let learned = if work.setup.arm().is_some() {
        let of_case = |case: &Case| Ok(move_samples(&work.setup, case, &runs(case)?, stress));
        let samples = cases.par_iter().map(of_case).collect::<Result<Vec<_>, Problem>>()?.concat();
        found(samples.len())?;
        learn_moves(&work.setup, stress, &samples)
    } else {
        let of_case = |case: &Case| Ok(leg_samples(&work.setup, case, &runs(case)?, stress));
        let samples = cases.par_iter().map(of_case).collect::<Result<Vec<_>, Problem>>()?.concat();
        found(samples.len())?;
        learn(&work.setup, stress, &samples)
    };
    let model = learned.map_err(|error| match error {
        NoFit::Groups { groups, needed } => Problem::input(format!(
            "{place}: {groups} trajectories with executed {what}s; {needed} are needed in all: every fifth is held out, and ten folds \
             are made of the others"
        )),
        error => Problem::input(format!("{place}: {error}")),
    })?;
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
        let error = |rmse: f64| told_error(rmse, &model.unit, work.setup.arm().is_some());
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
            "cross-validation: R² {:.3}, error {}; {} trajectories held out: R² {:.3}, error {}, rank correlation of their largest \
             {rank}",
            validation.r2,
            error(validation.rmse),
            held_out.trajectories,
            held_out.r2,
            error(held_out.rmse),
        ));
        let key = work.setup.scenario.score_key();
        console::say(&format!("use it: {key} = \"learned:{}\"", asked.out.display()));
    }
    Ok(0)
}

/// An error with three significant digits and its unit; of arms, whose users count in mm, in mm.
fn told_error(rmse: f64, unit: &str, arm: bool) -> String {
    let (error, unit) = if arm && unit == "m" { (1e3 * rmse, "mm") } else { (rmse, unit) };
    let decimals = if error > 0.0 { (2.0 - libm::log10(error).floor()).clamp(0.0, 12.0) as usize } else { 0 };
    format!("{error:.decimals$} {unit}").trim_end().to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn errors_have_digits_that_say_something() {
        for (rmse, unit, arm, told) in [
            (0.4123, "m", false, "0.412 m"),
            (0.000_214, "m", true, "0.214 mm"),
            (0.000_214, "m", false, "0.000214 m"),
            (1234.5, "rad²/s³", true, "1234 rad²/s³"),
            (0.012, "", false, "0.0120"),
            (0.0, "s", false, "0 s"),
        ] {
            assert_eq!(told_error(rmse, unit, arm), told);
        }
    }
}
