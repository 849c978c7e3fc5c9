//! A recorded violation, flown again.

use std::path::{Path, PathBuf};

use hairpin::campaign::{self, Case, CaseNumber, CaseResult, Setup, Status};
use hairpin::math::simd::Simd;
use hairpin_formats::folder::CampaignFolder;
use hairpin_formats::repro::{Expected, Repro};
use hairpin_formats::scenario::{self, check_asked};

use crate::consent::{Consent, Wish};
use crate::execute::fly_told;
use crate::missions::{self, FENCE, MissionsTold, read_told};
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
    let told = campaign.as_ref().map(read_told).transpose()?.flatten();
    if let Some(campaign) = campaign.filter(|_| repro.flown_by.is_none()) {
        // As of earlier versions, whose repro files do not say it.
        repro.flown_by = campaign.read_executor()?;
    }
    fly(repro, (&setup, &case), told.as_ref(), watch)
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
    work.folder.read_witness(found)?;
    let result = work.folder.read_results()?.into_iter().find(|result| result.case == case);
    let result = result.filter(|result| result.measures.is_some());
    let result = result.ok_or_else(|| refuse("nothing was measured of it: hairpin execute, then hairpin judge"))?;
    let repro = Repro { flown_by: work.folder.read_executor()?, ..Repro::of(&work.setup, found, &result) };
    let setup = work.setup.changed(repro.scenario.clone())?.with_simd(simd).answered_by(&consent.code)?;
    let case = repro.case().map_err(|why| refuse(&why))?;
    consent.ask(folder, &Wish::of_execution(&setup))?;
    fly(repro, (&setup, &case), read_told(&work.folder)?.as_ref(), watch)
}

/// Flies it, and judges it by the spec and, where its campaign has `told` of missions, by its own.
fn fly(
    repro: Repro,
    (setup, case): (&Setup, &Case),
    told: Option<&MissionsTold>,
    watch: &dyn Watch,
) -> Result<ReplayedRepro, Problem> {
    let (flown, now) = fly_told(&[(setup, case, repro.run)], watch)?;
    let another = another_than(repro.flown_by.as_ref(), now.as_ref());
    let mut result = campaign::judge(setup, case, &flown)?;
    missions::hold(told, (setup, case), || Ok(flown), &mut result)?;
    if told.is_none()
        && result.status == Status::Pass
        && repro.expected.violations.iter().any(|one| one.starts_with(FENCE))
    {
        result.status = Status::Inconclusive;
        result.message = Some("it broke a fence of its mission, which its campaign's folder keeps".into());
    }
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
    use serde_json::json;

    use super::*;
    use crate::Unwatched;
    use crate::execute::{ExecuteSettings, execute};
    use crate::judge::judge;
    use crate::shrink::{ShrinkSettings, Shrinking};
    use crate::testing::{executed, generated, program, violating};

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

    /// A mission's fences are its campaign's, not the scenario's that a repro file has.
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
        let alone = place.path().join("alone.json");
        std::fs::copy(&file, &alone).unwrap();
        let untold = flown(&alone);
        assert!(untold.result.status == Status::Inconclusive && !untold.reproduces(), "{untold:?}");
        let refused = Shrinking::open(ShrinkSettings { folder, ..ShrinkSettings::default() }).map(|_| ());
        assert!(refused.unwrap_err().to_string().contains("its mission's fence"));
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
