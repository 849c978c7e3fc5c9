//! A recorded violation, flown again.

use std::path::{Path, PathBuf};

use hairpin::campaign::{self, Case, CaseNumber, CaseResult, Setup, Status};
use hairpin::math::simd::Simd;
use hairpin_formats::folder::CampaignFolder;
use hairpin_formats::missions::Demands;
use hairpin_formats::repro::{Expected, Repro};
use hairpin_formats::scenario::{self, check_asked};

use crate::consent::{Consent, Wish};
use crate::execute::fly_told;
use crate::missions::{self, read_told};
use crate::program::another_than;
use crate::work::{open_to_read, same_as_made};
use crate::{Problem, Watch};

/// Our own simulator repeats a run to the bit, at any SIMD level; executors of the users' need not.
/// In m and s.
const SAME: f64 = 1e-6;

/// A saved violation beside what it comes to now.
#[derive(Debug)]
pub struct ReplayedRepro {
    /// What was saved.
    pub repro: Repro,
    /// What it comes to.
    pub result: CaseResult,
    /// Whether it violates, ends and deviates as it did.
    pub same: bool,
    /// That another program flew it now than before, by what they say of themselves: a sentence.
    pub another: Option<String>,
}

impl ReplayedRepro {
    /// Whether it violates as it did, or as then does not.
    pub fn reproduces(&self) -> bool {
        self.same && (self.result.status == Status::Fail || self.was_fine() && self.result.message.is_none())
    }

    /// Whether there was no violation: a case that was kept within spec may be flown again as well.
    pub fn was_fine(&self) -> bool {
        self.repro.expected.violations.is_empty()
    }
}

/// Flies the run of the repro file `file` again, by the kernels `simd`.
///
/// # Errors
/// A file that is none, that limits nothing, or that asks to run what its user has not allowed; recordings, which
/// cannot be made again; it was asked to stop.
pub fn replay(file: &Path, simd: Simd, consent: &Consent, watch: &dyn Watch) -> Result<ReplayedRepro, Problem> {
    let mut repro = Repro::read(file).map_err(Problem::input)?;
    let resolved = scenario::attach(repro.scenario.clone(), file.parent().unwrap_or(Path::new("")))?;
    let setup = Setup::new(resolved).map_err(|mistake| Problem::of_file(file, format!("scenario.{mistake}")))?;
    check_asked(&setup.scenario, file)?;
    let setup = setup.with_simd(simd).answered_by(&consent.code)?;
    let case = repro.case().map_err(|why| Problem::of_file(file, why))?;
    let folder = campaign_of(file);
    consent.ask(&folder, &Wish::of_execution(&setup))?;
    let campaign = CampaignFolder::open(&folder).ok();
    if let Some(campaign) = campaign {
        // As of earlier versions, whose repro files do not say it.
        if repro.flown_by.is_none() {
            repro.flown_by = campaign.read_executor()?;
        }
        if repro.mission.is_none() {
            repro.mission = asked_of(&campaign, case.number)?;
        }
    }
    fly(repro, (&setup, &case), watch)
}

/// Flies the worst run of a case of the judged campaign in `folder` again, by the kernels `simd`.
///
/// # Errors
/// There is no such case, or nothing was measured of it; the scenario was edited since; else as [`replay`].
pub fn replay_case(
    (folder, case): (&Path, CaseNumber),
    simd: Simd,
    consent: &Consent,
    watch: &dyn Watch,
) -> Result<ReplayedRepro, Problem> {
    let work = open_to_read(folder)?;
    check_asked(&work.setup.scenario, &work.folder.file("scenario.toml"))?;
    same_as_made(&work.folder, &work.setup, &[])?;
    let refuse = |why: &str| Problem::input(format!("--case {case}: {why}"));
    let mut found = work.folder.read_cases_without_profiles()?.into_iter().find(|one| one.number == case);
    let found = found.as_mut().ok_or_else(|| refuse("the campaign has no such case"))?;
    if let Some(why) = campaign::foreign_seed(&work.setup, found) {
        return Err(Problem::of_file(&work.folder.file("results.parquet"), format!("case {case}: {why}")));
    }
    work.folder.read_witness(found)?;
    let result = work.folder.read_results()?.into_iter().find(|result| result.case == case);
    let result = result.filter(|result| result.measures.is_some());
    let result = result.ok_or_else(|| refuse("nothing was measured of it: hairpin execute, then hairpin judge"))?;
    let (flown_by, mission) = (work.folder.read_executor()?, asked_of(&work.folder, case)?);
    let repro = Repro { flown_by, mission, ..Repro::of(&work.setup, found, &result) };
    let setup = work.setup.changed(repro.scenario.clone())?.with_simd(simd).answered_by(&consent.code)?;
    let case = repro.case().map_err(|why| refuse(&why))?;
    consent.ask(folder, &Wish::of_execution(&setup))?;
    fly(repro, (&setup, &case), watch)
}

/// What the mission of `case` asks beside the spec, as `campaign` keeps it.
fn asked_of(campaign: &CampaignFolder, case: CaseNumber) -> Result<Option<Demands>, Problem> {
    Ok(read_told(campaign)?.and_then(|told| told.asked_of(case).cloned()))
}

/// Flies it, and judges it by the spec and by what its mission asks.
fn fly(repro: Repro, (setup, case): (&Setup, &Case), watch: &dyn Watch) -> Result<ReplayedRepro, Problem> {
    let (flown, now) = fly_told(&[(setup, case, repro.run)], watch)?;
    let another = another_than(repro.flown_by.as_ref(), now.as_ref());
    let mut result = campaign::judge(setup, case, &flown)?;
    missions::hold(repro.mission.as_ref(), (setup, case), || Ok(flown), &mut result)?;
    missions::doubt_lost_fence(&repro, &mut result);
    let same = result.measures.is_some() && repro.expected.is_within(SAME, &Expected::of(&result));
    Ok(ReplayedRepro { repro, result, same, another })
}

/// The campaign's folder that a repro file lies in, or else the file's own.
fn campaign_of(file: &Path) -> PathBuf {
    let folder = file.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let folder = folder.canonicalize().unwrap_or_else(|_| folder.to_owned());
    let above =
        folder.parent().filter(|_| folder.ends_with("repro")).filter(|above| CampaignFolder::open(above).is_ok());
    above.map_or_else(|| folder.clone(), Path::to_owned)
}

#[cfg(test)]
mod tests {
    use hairpin::campaign::select::By;
    use serde_json::json;

    use super::*;
    use crate::Unwatched;
    use crate::execute::{ExecuteSettings, execute, run_with_motion};
    use crate::judge::judge;
    use crate::judge_log::{Against, LogSettings, judge_log};
    use crate::missions::FENCE;
    use crate::select::{SelectSettings, select};
    use crate::shrink::{ShrinkSettings, Shrinking};
    use crate::testing::{executed, generated, program, violating};
    use crate::work::IfThere;

    #[test]
    fn a_violation_comes_again() {
        let (_place, folder) = violating();
        let file = folder.join("repro/0000.json");
        let again = replay(&file, Simd::Widest, &Consent::default(), &Unwatched).unwrap();
        assert!(again.reproduces(), "{again:?}");
        let by_case = |case| replay_case((&folder, CaseNumber(case)), Simd::Widest, &Consent::default(), &Unwatched);
        let same = by_case(0).unwrap();
        assert!(same.reproduces() && same.result == again.result, "{same:?}");
        assert!(by_case(7).unwrap_err().to_string().contains("no such case"));
        // What the file expects is what is compared, and one that limits nothing expects nothing.
        let saved = Repro::read(&file).unwrap();
        let edited = |change: &dyn Fn(&mut Expected)| {
            let mut repro = saved.clone();
            change(&mut repro.expected);
            let place = folder.join("repro/edited.json");
            repro.write(&place).unwrap();
            replay(&place, Simd::Widest, &Consent::default(), &Unwatched).unwrap()
        };
        assert!(edited(&|_| ()).reproduces());
        assert!(!edited(&|expected| expected.violations.clear()).reproduces());
        assert!(!edited(&|expected| expected.ended = "time".into()).reproduces());
        assert!(!edited(&|expected| expected.leg_worst += 1).reproduces());
        let mut without: serde_json::Value = serde_json::from_slice(&std::fs::read(&file).unwrap()).unwrap();
        without["scenario"].as_object_mut().unwrap().remove("spec").unwrap();
        let unlimited = folder.join("repro/unlimited.json");
        std::fs::write(&unlimited, without.to_string()).unwrap();
        let refused = replay(&unlimited, Simd::Widest, &Consent::default(), &Unwatched).unwrap_err().to_string();
        assert!(refused.contains("unlimited.json") && refused.contains("spec.deviation.max_m"), "{refused}");
        let other = std::fs::read_to_string(&file).unwrap().replacen("\"hairpin_repro\": 1", "\"hairpin_repro\": 2", 1);
        std::fs::write(&file, other).unwrap();
        let refused = replay(&file, Simd::Portable, &Consent::default(), &Unwatched).unwrap_err();
        assert!(refused.to_string().contains("hairpin_repro = 2"), "{refused}");
    }

    /// A mission's fences are none of the scenario's.
    #[test]
    fn what_broke_a_fence_does_so_again() {
        let (place, folder) = executed();
        let opened = CampaignFolder::open(&folder).unwrap();
        let way = opened.read_cases().unwrap()[0].waypoints[1];
        let fence = json!({ "keeps_in": false, "circle_m": [way.x, way.y, 1.0] });
        opened.write_missions(&json!({ "missions": [{ "fences": { "firmware": null, "fences": [fence] } }] })).unwrap();
        judge(&folder, &[("spec.deviation.max_m".to_owned(), "500".to_owned())]).unwrap();
        let file = folder.join("repro/0000.json");
        let flown = |file: &Path| replay(file, Simd::Widest, &Consent::default(), &Unwatched).unwrap();
        let by_case = replay_case((&folder, CaseNumber(0)), Simd::Widest, &Consent::default(), &Unwatched).unwrap();
        for again in [flown(&file), by_case] {
            assert!(again.reproduces() && again.result.violations[0].what == FENCE, "{again:?}");
        }
        // What its mission asks goes along with the file; one of an earlier version does not know it.
        let alone = place.path().join("alone.json");
        std::fs::copy(&file, &alone).unwrap();
        assert!(flown(&alone).reproduces());
        let saved = Repro::read(&file).unwrap();
        Repro { mission: None, ..saved }.write(&alone).unwrap();
        let untold = flown(&alone);
        assert!(untold.result.status == Status::Inconclusive && !untold.reproduces(), "{untold:?}");
        let refused = Shrinking::open(ShrinkSettings { folder, ..ShrinkSettings::default() }).map(|_| ());
        assert!(refused.unwrap_err().to_string().contains("its mission's fence"));
    }

    /// What a mission asks goes along wherever its cases go: into a copy, a choice, a log of them, and saved cases.
    #[test]
    fn a_fence_holds_wherever_its_case_goes() {
        let (place, folder) = executed();
        let opened = CampaignFolder::open(&folder).unwrap();
        let way = opened.read_cases().unwrap()[0].waypoints[1];
        let fence = json!({ "keeps_in": false, "circle_m": [way.x, way.y, 1.0] });
        opened.write_missions(&json!({ "missions": [{ "fences": { "firmware": null, "fences": [fence] } }] })).unwrap();
        let wide = ("spec.deviation.max_m".to_owned(), "500".to_owned());
        judge(&folder, &[wide]).unwrap();
        let violations = |folder: &Path| {
            let results = CampaignFolder::open(folder).unwrap().read_results().unwrap();
            results[0].violations.iter().map(|one| one.what.clone()).collect::<Vec<String>>()
        };
        assert_eq!(violations(&folder), [FENCE]);
        let copied = place.path().join("copied");
        let settings = ExecuteSettings { folder: folder.clone(), out: Some(copied.clone()), ..Default::default() };
        execute(&settings, &Unwatched).unwrap();
        judge(&copied, &[]).unwrap();
        assert_eq!(violations(&copied), [FENCE]);
        let chosen = place.path().join("chosen");
        let settings = SelectSettings {
            folder: folder.clone(),
            cases: 2,
            by: By::Stress,
            out: chosen.clone(),
            if_there: IfThere::Refuse,
            consent: Consent::default(),
        };
        select(&settings, &Unwatched).unwrap();
        assert_eq!(violations(&chosen), [FENCE]);
        // What was saved of it is run again before a campaign's own cases.
        let again = ExecuteSettings {
            folder: copied,
            out: Some(place.path().join("again")),
            repro: Some(folder.join("repro")),
            ..Default::default()
        };
        let replayed = execute(&again, &Unwatched).unwrap().replayed;
        assert_eq!((replayed.len(), replayed[0].result.status), (1, Status::Fail));
        // A log of the same flight.
        let work = open_to_read(&folder).unwrap();
        let case = &work.folder.read_cases().unwrap()[0];
        let flight = run_with_motion(&work, case, 0).unwrap().unwrap().outcome.unwrap();
        let log = place.path().join("log.csv");
        let rows = flight.track.times().iter().zip(flight.track.poses()).map(|(t, pose)| {
            let p = pose.translation;
            format!("{t},{},{},{}\n", p.x, p.y, p.z)
        });
        std::fs::write(&log, ["t_s,x_m,y_m,z_m\n".to_owned()].into_iter().chain(rows).collect::<String>()).unwrap();
        let settings = LogSettings::new(log, Against::Campaign(folder));
        let judged = judge_log(&settings, &Unwatched).unwrap().logs.remove(0);
        assert!(judged.verdict.exit_code == 1 && judged.verdict.sentence.contains(" fence "), "{:?}", judged.verdict);
    }

    /// What another program makes of it says nothing of the one that violated.
    #[test]
    fn a_violation_that_another_program_flies_is_told_as_such() {
        let (place, folder) = generated();
        let file = place.path().join("sim.py");
        let sets = vec![program(&file, "name=\"sim 1\", version=1")];
        let settings = ExecuteSettings { folder: folder.clone(), sets, ..ExecuteSettings::default() };
        execute(&settings, &Unwatched).unwrap();
        judge(&folder, &[("spec.total_time.max_s".to_owned(), "0.01".to_owned())]).unwrap();
        let allowing = Consent { allow_commands: true, ..Consent::default() };
        let moved = place.path().join("moved.json");
        std::fs::copy(folder.join("repro/0000.json"), &moved).unwrap();
        let told = || {
            let by_file = |file: &Path| replay(file, Simd::Widest, &allowing, &Unwatched).unwrap();
            let by_case = replay_case((&folder, CaseNumber(0)), Simd::Widest, &allowing, &Unwatched).unwrap();
            [by_file(&folder.join("repro/0000.json")), by_file(&moved), by_case].map(|again| again.another)
        };
        assert_eq!(told(), [None, None, None]);
        program(&file, "name=\"sim 2\"");
        let expected = "another program flew it now: `sim 2` without a version; before it was `sim 1`, version `1`";
        assert_eq!(told(), [(); 3].map(|()| Some(expected.to_owned())));
    }

    #[test]
    fn a_case_within_spec_comes_again() {
        let (_place, folder) = executed();
        judge(&folder, &[("spec.deviation.max_m".to_owned(), "500".to_owned())]).unwrap();
        let again = replay_case((&folder, CaseNumber(0)), Simd::Widest, &Consent::default(), &Unwatched).unwrap();
        assert_eq!(again.result.status, Status::Pass, "{again:?}");
        assert!(again.was_fine() && again.same && again.reproduces(), "{again:?}");
    }
}
