//! A whole campaign from code, watched: `cargo run --example 07_campaign`.

use std::error::Error;
use std::sync::atomic::{AtomicUsize, Ordering};

use hairpin_jobs::stress::stress;
use hairpin_jobs::work::CampaignSettings;
use hairpin_jobs::{Seen, Watch};

/// Counts what lands; a graphical program would draw it, and stop where its user asks to.
#[derive(Default)]
struct Counting {
    flown: AtomicUsize,
    violations: AtomicUsize,
}

impl Watch for Counting {
    fn seen(&self, run: Seen) {
        self.flown.fetch_add(1, Ordering::Relaxed);
        self.violations.fetch_add(usize::from(run.violates), Ordering::Relaxed);
    }

    fn warn(&self, line: &str) {
        eprintln!("{line}");
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let place = tempfile::tempdir()?;
    let set = |key: &str, value: &str| (key.to_owned(), value.to_owned());
    let settings = CampaignSettings {
        scenario: "demo-quadrotor".into(),
        out: Some(place.path().join("out")),
        sets: vec![set("generate.search.cases", "4"), set("execute.repeat", "2"), set("execute.baseline", "0")],
        budget_s: Some(60.0),
        ..CampaignSettings::default()
    };
    let watch = Counting::default();
    let stressed = stress(&settings, None, &watch)?;
    println!("{}", stressed.verdict.sentence);
    println!("exit code {}; the report is {} bytes", stressed.verdict.exit_code, {
        std::fs::metadata(stressed.work.folder.path().join("report.html"))?.len()
    });
    let (flown, violations) = (watch.flown.into_inner(), watch.violations.into_inner());
    println!("{flown} runs landed, {violations} of them violate");
    for result in &stressed.judgement.results {
        let most = result.measures.as_ref().map_or(f64::NAN, |measures| measures.max_deviation);
        println!("case {}: {}, {most:.2} m", result.case, result.status.word());
    }
    Ok(())
}
