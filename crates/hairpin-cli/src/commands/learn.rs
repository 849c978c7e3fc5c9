//! `hairpin learn`: a score from executed legs.

use hairpin::campaign::digits::three_digits;
use hairpin_jobs::Problem;
use hairpin_jobs::learn::{Learned, learn};
use serde_json::json;

use crate::args::Learn;
use crate::console;
use crate::exit::DONE;

/// Runs the command: 0 when the model is written, however good it is.
pub(crate) fn run(asked: &Learn) -> Result<u8, Problem> {
    let learned = learn(&asked.folders, &asked.out, asked.stress)?;
    if asked.json {
        let model = &learned.model;
        let answer = json!({
            "model": asked.out,
            "stress": asked.stress.word(),
            "unit": model.unit,
            "trajectories": model.trajectories,
            "legs": model.legs,
            "degree": model.polynomial.degree,
            "penalty": model.polynomial.penalty,
            "validation": model.validation,
            "held_out": model.held_out,
            "training_hash": model.training_hash,
            "exit_code": DONE,
        });
        console::say(&answer.to_string());
    } else {
        in_words(asked, &learned);
    }
    Ok(DONE)
}

fn in_words(asked: &Learn, Learned { model, score_key, arm }: &Learned) {
    let (validation, held_out, out) = (&model.validation, &model.held_out, asked.out.display());
    let error = |rmse: f64| error_text(rmse, &model.unit, *arm);
    let rank = held_out.rank_correlation.map_or("none".into(), |rank| format!("{rank:.2}"));
    console::say(&format!(
        "{out}: {} of {} {} of {} trajectories, degree {}, penalty {:e}",
        asked.stress.word(),
        model.legs,
        if *arm { "moves" } else { "legs" },
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
    // Of the methods that ask a score, the one whose answer is the best there is. Arms read their costs with any.
    let by = if *arm { "" } else { ", with generate.search.method = \"exact\"" };
    console::say(&format!("use it: {score_key} = \"learned:{out}\"{by}"));
}

/// An error with three significant digits and its unit; of arms, whose users count in mm, in mm.
fn error_text(rmse: f64, unit: &str, arm: bool) -> String {
    let (error, unit) = if arm && unit == "m" { (1e3 * rmse, "mm") } else { (rmse, unit) };
    format!("{} {unit}", three_digits(error)).trim_end().to_owned()
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
            assert_eq!(error_text(rmse, unit, arm), told);
        }
    }
}
