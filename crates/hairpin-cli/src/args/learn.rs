//! `hairpin learn`.

use std::path::PathBuf;

use clap::Args;
use clap::builder::{PossibleValuesParser, TypedValueParser};
use hairpin::judgement::Stress;

/// Learns per-leg stress from the executed legs of campaigns of one robot and one controller, as a polynomial of what
/// the searches saw of them. Degree and penalty are chosen by 10-fold cross-validation over trajectories; the quality
/// told is that on trajectories that took no part.
#[derive(Debug, Args)]
pub(crate) struct Learn {
    /// Campaign folders; several are learned from as if they were one
    #[arg(value_name = "OUT", required = true)]
    pub(crate) folders: Vec<PathBuf>,
    /// The model file
    #[arg(long, value_name = "MODEL", default_value = "score-model.json")]
    pub(crate) out: PathBuf,
    /// What is learned
    #[arg(long, value_name = "STRESS", default_value = Stress::MaxDeviation.word(), value_parser = stress())]
    pub(crate) stress: Stress,
    /// One JSON object on stdout
    #[arg(long)]
    pub(crate) json: bool,
}

/// The words of [`Stress`].
fn stress() -> impl TypedValueParser<Value = Stress> {
    PossibleValuesParser::new(Stress::ALL.map(Stress::word))
        .try_map(|word| Stress::from_word(&word).ok_or("no stress is called so"))
}
