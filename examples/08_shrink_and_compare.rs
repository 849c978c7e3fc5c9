//! A violation in its shortest form, and the next version beside it: `cargo run --example 08_shrink_and_compare`.

use std::error::Error;

use hairpin::campaign::report::worst_first;
use hairpin_jobs::Unwatched;
use hairpin_jobs::compare::compare;
use hairpin_jobs::execute::{ExecuteSettings, execute};
use hairpin_jobs::judge::judge;
use hairpin_jobs::shrink::{ShrinkSettings, Shrinking};
use hairpin_jobs::stress::stress;
use hairpin_jobs::work::CampaignSettings;

fn main() -> Result<(), Box<dyn Error>> {
    let place = tempfile::tempdir()?;
    let (before, after) = (place.path().join("before"), place.path().join("after"));
    let set = |key: &str, value: &str| (key.to_owned(), value.to_owned());
    let settings = CampaignSettings {
        scenario: "demo-quadrotor".into(),
        out: Some(before.clone()),
        sets: vec![
            set("generate.search.cases", "4"),
            set("execute.repeat", "1"),
            set("execute.baseline", "0"),
            set("spec.deviation.max_m", "1.0"),
        ],
        ..CampaignSettings::default()
    };
    let stressed = stress(&settings, None, &Unwatched)?;
    println!("before: {}", stressed.verdict.sentence);

    let worst = worst_first(&stressed.judgement.results)[0].case;
    drop(stressed); // It holds the folder.
    let shrink = ShrinkSettings { folder: before.clone(), case: worst, budget: 30, ..ShrinkSettings::default() };
    let shrunk = Shrinking::open(shrink)?.search(&Unwatched)?;
    println!("case {worst} in {} runs: {}", shrunk.runs, shrunk.target.file_name().unwrap_or_default().display());

    // The same cases by another controller, in a folder of their own.
    let sets = vec![set("execute.controller", "\"anafi\"")];
    let other = ExecuteSettings { folder: before.clone(), out: Some(after.clone()), sets, ..Default::default() };
    execute(&other, &Unwatched)?;
    println!("after: {}", judge(&after, &[])?.judgement.verdict.sentence);
    let all = compare(&before, &after, 0.0)?.comparison;
    println!("better {}, worse {}, newly failing {}", all.better, all.worse, all.newly_failing.len());
    Ok(())
}
