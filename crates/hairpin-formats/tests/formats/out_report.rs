//! The report of a campaign of 24 cases: small enough, closed to the outside, and readable without its script.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

use crate::out_campaign::stress::{self, judged, scenario};
use hairpin::campaign::report::{COLUMNS, cells_in, length};
use hairpin::campaign::{Case, CaseNumber, Run, Setup, Status};
use hairpin_formats::folder::{CampaignFolder, Existing, Landed};
use hairpin_formats::parquet::track;
use hairpin_formats::report::{self, Motions};

fn written(place: &Path) -> (CampaignFolder, Setup) {
    let setup = Setup::new(scenario()).unwrap();
    let campaign = judged(&setup, 24);
    let folder = CampaignFolder::create(place, Existing::Replace).unwrap();
    folder.write_scenario("hairpin = 1\n").unwrap();
    folder.write_cases(&campaign.cases).unwrap();
    folder.write_tally(&campaign.tally).unwrap();
    let mut planned = Vec::new();
    for case in &campaign.cases {
        planned.push((case.number, track::planned(case.number, &stress::planned(case)).unwrap()));
    }
    folder.write_planned(planned).unwrap();
    let writer = folder.write_runs(1, campaign.runs.iter().map(|run| (run.case, run.run)));
    for run in &campaign.runs {
        writer.land(Landed::of(run, &BTreeSet::new()).unwrap()).unwrap();
    }
    writer.finish().unwrap();
    folder.write_results(&campaign.cases, &campaign.results).unwrap();
    (folder, setup)
}

/// What the folder has.
struct Kept<'a>(&'a CampaignFolder);

impl Motions for Kept<'_> {
    fn run(&self, case: &Case, run: usize, _: usize) -> Result<Option<Run>, String> {
        self.0.read_run(case.number, run).map_err(|error| error.to_string())
    }

    fn kept(&self, case: CaseNumber) -> Result<Vec<Run>, String> {
        self.0.read_runs(case).map_err(|error| error.to_string())
    }
}

/// Nothing.
struct Lost;

impl Motions for Lost {
    fn run(&self, _: &Case, _: usize, _: usize) -> Result<Option<Run>, String> {
        Ok(None)
    }

    fn kept(&self, _: CaseNumber) -> Result<Vec<Run>, String> {
        Ok(Vec::new())
    }
}

fn html(place: &Path) -> String {
    let (folder, setup) = written(place);
    let assumptions = vec![
        "anafi is a stand-in for the real drone's closed controller".to_owned(),
        "rotor lag is outside the claim <drag & wind are in it>".to_owned(),
    ];
    let verdict = stress::verdict(&folder.read_results().unwrap());
    let data = report::from_folder(&folder, &setup, verdict, assumptions, &Kept(&folder), &[]).unwrap();
    report::write(&folder.file("report.html"), &data).unwrap();
    fs::read_to_string(folder.file("report.html")).unwrap()
}

#[test]
fn a_report_of_two_dozen_cases_is_below_three_megabytes_and_reads_without_script() {
    let place = tempfile::tempdir().unwrap();
    let html = html(place.path());
    // Kept for a look, and for tests/browser.
    fs::write(Path::new(env!("CARGO_TARGET_TMPDIR")).join("report.html"), &html).unwrap();
    assert!(html.len() < 3_000_000, "{} bytes", html.len());

    let page = &html[..html.find("<script").unwrap()];
    assert!(page.contains(">FAIL 4/24") && page.contains("limit 0.50 m"));
    assert_eq!(page.matches("<tr class=\"shown\" data-case=").count(), 24);
    assert_eq!(page.matches("<svg class=\"views\"").count(), 20);
    assert_eq!(page.matches("<figure class=\"case\" data-case=\"0012\">").count(), 1);
    assert!(COLUMNS.iter().all(|column| page.contains(&format!(">{column}<"))));
    assert!(page.contains("no safety certificate") || html.contains("no safety certificate"));
    assert!(page.contains("not aligned") && page.contains("&lt;drag &amp; wind"));
    let setup = Setup::new(scenario()).unwrap();
    for result in judged(&setup, 24).results {
        let cells = cells_in(&length(&setup), &result);
        assert!(cells.iter().all(|cell| page.contains(&format!(">{cell}<"))), "{cells:?}");
    }
}

#[test]
fn nothing_but_its_own_scripts_runs() {
    let place = tempfile::tempdir().unwrap();
    let html = html(place.path());
    let policy =
        html.split("Content-Security-Policy\" content=\"").nth(1).and_then(|rest| rest.split('"').next()).unwrap();
    assert!(policy.starts_with("default-src 'none'; script-src 'sha256-") && !policy.contains("unsafe"), "{policy}");
    assert!(policy.contains("; style-src 'sha256-"), "{policy}");
    for outside in ["src=\"http", "href=\"http", "<link", "<iframe", "@import"] {
        assert!(!html[..html.find("<script>").unwrap()].contains(outside), "{outside}");
    }
    // Nothing in the data can end its element.
    let data = html.split("id=\"data\">").nth(1).unwrap();
    let json = &data[..data.find("</script>").unwrap()];
    assert!(!json.contains('<'));
    let value: serde_json::Value = serde_json::from_str(json).unwrap();
    assert_eq!(value["cases"].as_array().unwrap().len(), 24);
    assert_eq!(value["limit"], 0.5);
}

#[test]
fn the_worst_come_first_and_the_same_campaign_is_the_same_report() {
    let (first, second) = (tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap());
    assert_eq!(html(first.path()), html(second.path()));
    let (folder, setup) = written(first.path().join("again").as_path());
    let verdict = stress::verdict(&folder.read_results().unwrap());
    let data = report::from_folder(&folder, &setup, verdict, vec![], &Lost, &[]).unwrap();
    let fails = data.results.iter().filter(|result| result.status == Status::Fail).count();
    assert!(fails > 0 && data.results[..fails].iter().all(|result| result.status == Status::Fail));
    let deviation = |i: usize| data.results[i].measures.as_ref().unwrap().max_deviation;
    assert!((1..fails).all(|i| deviation(i) <= deviation(i - 1)));
    for shown in &data.shown {
        // What is drawn is what was judged.
        let (Some(measures), Some(statistics)) = (&shown.result.measures, shown.statistics) else { continue };
        assert!((statistics.max - measures.max_deviation).abs() < 1e-12);
    }
    assert!(data.shown.iter().enumerate().all(|(i, shown)| shown.result.case == data.results[i].case));
}
