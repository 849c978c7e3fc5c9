//! Every witness integrated by independent code, and the planned motions that are kept held to the witnesses.

use std::collections::BTreeSet;
use std::path::Path;

use hairpin::campaign::arm::ArmSetup;
use hairpin::campaign::arm::{GraphAgain, graph_of};
use hairpin::campaign::{self, Case, CaseNumber, PlannedRows, Setup, Tally};
use hairpin::verification::Finding;
use rayon::prelude::*;

use crate::Problem;
use crate::optimum::{self, Optimum};
use crate::work::{Work, open_to_read};

/// What the check of a campaign came to.
#[derive(Debug)]
pub struct Verified {
    /// What came of each case.
    pub answers: Vec<Answer>,
    /// Of arms whose first program claims to be the heaviest.
    pub optimum: Option<Optimum>,
    /// Of arms, the moves of the graph that no program uses as well.
    pub graph: Option<GraphAgain>,
    /// Cases with something placed around them that were checked, and those of them that are clear of it.
    pub surrounded: [usize; 2],
    /// What of the robot the claims rest on that is not known, or leave out.
    pub unknown: Option<&'static str>,
    /// Why there was nothing to verify, in a sentence's part; `None` where something was.
    pub nothing: Option<String>,
    /// What of the folder's scenario was edited since hairpin wrote it: what is proven is proven of what it is now.
    pub edited: Vec<String>,
}

/// What came of one case.
#[derive(Debug, Clone, PartialEq)]
pub enum Answer {
    /// It claims no witness.
    NothingClaimed,
    /// It was checked.
    Checked {
        /// Number of the case.
        case: CaseNumber,
        /// Whether it has a witness.
        witness: bool,
        /// Whether the rows of its planned motion were held to the witness: where the folder has them, and the witness
        /// holds.
        planned: bool,
        /// The largest end error over its legs, m; `None` where no witness could be read.
        position_m: Option<f64>,
        /// What does not hold.
        findings: Vec<String>,
    },
}

impl Answer {
    /// Whether all that was checked holds.
    fn fine(&self) -> bool {
        matches!(self, Self::Checked { findings, .. } if findings.is_empty())
    }

    fn is_checked(&self) -> bool {
        matches!(self, Self::Checked { .. })
    }

    /// Whether it was checked and has a witness.
    pub fn is_witnessed(&self) -> bool {
        matches!(self, Self::Checked { witness: true, .. })
    }
}

/// Verifies every case of the campaign in `folder`.
///
/// # Errors
/// The folder is no campaign's, or its scenario, cases or tally are broken; a broken witness is a finding.
pub fn verify(folder: &Path) -> Result<Verified, Problem> {
    let work = open_to_read(folder)?;
    let cases = work.folder.read_cases_without_profiles()?;
    // A folder's cases are missions, or were searched for; without a tally a search has not yet come to one.
    let tally = if work.folder.has_tally() { work.folder.read_tally()? } else { Tally::default() };
    let hold = if tally.missions.is_empty() { campaign::verify } else { campaign::verify_mission };
    let answers: Vec<Answer> = cases.par_iter().map(|case| check(&work, case, hold)).collect();
    let optimum = work.setup.own::<ArmSetup>().and_then(|arm| optimum::verify(&work, arm, &cases));
    let graph = work
        .setup
        .own::<ArmSetup>()
        .and_then(|arm| graph_of(arm).ok().map(|graph| arm.graph_again(&graph)))
        .filter(|graph| graph.moves > 0);
    let around = answers.iter().zip(&cases).filter(|(answer, case)| case.environment.is_some() && answer.is_checked());
    let clear = around.clone().filter(|(answer, _)| answer.fine()).count();
    let surrounded = [around.count(), clear];
    let unknown = work.setup.unknown_shapes();
    let is_nothing = optimum.is_none() && graph.is_none() && !answers.iter().any(Answer::is_checked);
    let nothing = is_nothing.then(|| nothing(&work.setup, &cases));
    let edited = work.folder.edited(&work.setup)?;
    Ok(Verified { answers, optimum, graph, surrounded, unknown, nothing, edited })
}

/// Why nothing of `cases` is verified.
fn nothing(setup: &Setup, cases: &[Case]) -> String {
    let words: BTreeSet<&str> = cases.iter().map(|case| case.evidence.word()).collect();
    match cases.len() {
        0 => "the folder has no case".into(),
        count => format!(
            "none of {count} cases claims a witness: evidence {}, generate.reach = \"{}\"",
            words.into_iter().collect::<Vec<_>>().join(", "),
            setup.scenario.reach()
        ),
    }
}

impl Verified {
    /// Whether anything does not hold.
    pub fn has_findings(&self) -> bool {
        self.failed().next().is_some()
            || self.optimum.as_ref().is_some_and(|optimum| !optimum.findings.is_empty())
            || self.graph.as_ref().is_some_and(|graph| !graph.findings.is_empty())
    }

    /// Cases of which something does not hold.
    pub fn failed(&self) -> impl Iterator<Item = &Answer> {
        self.answers.iter().filter(|answer| answer.is_checked() && !answer.fine())
    }

    /// Cases that were checked.
    pub fn checked(&self) -> usize {
        self.answers.iter().filter(|answer| answer.is_checked()).count()
    }

    /// Cases whose witness could not be read, which no number is known of.
    pub fn unread(&self) -> usize {
        self.answers.iter().filter(|answer| matches!(answer, Answer::Checked { position_m: None, .. })).count()
    }

    /// The largest end error over the legs of all witnesses that could be read, m.
    pub fn largest_m(&self) -> Option<f64> {
        let of = |answer: &Answer| match answer {
            Answer::Checked { witness: true, position_m, .. } => *position_m,
            _ => None,
        };
        self.answers.iter().filter_map(of).max_by(f64::total_cmp)
    }

    /// Cases with a witness, and those of them that hold.
    pub fn witnesses(&self) -> [usize; 2] {
        let witnesses = self.answers.iter().filter(|answer| answer.is_witnessed());
        [witnesses.clone().count(), witnesses.filter(|answer| answer.fine()).count()]
    }

    /// Planned motions whose rows were held to a witness, and those of them that are its motion.
    pub fn planned(&self) -> [usize; 2] {
        let planned = self.answers.iter().filter(|answer| matches!(answer, Answer::Checked { planned: true, .. }));
        [planned.clone().count(), planned.filter(|answer| answer.fine()).count()]
    }

    /// The worst case that was checked: one with findings before one without, then the one that ends farthest from its
    /// waypoints.
    pub fn worst(&self) -> Option<&Answer> {
        let mut worst: Option<((bool, f64), &Answer)> = None;
        for answer in &self.answers {
            let Answer::Checked { position_m, findings, .. } = answer else { continue };
            let rank = (!findings.is_empty(), position_m.unwrap_or(f64::INFINITY));
            if worst.as_ref().is_none_or(|(before, _)| *before < rank) {
                worst = Some((rank, answer));
            }
        }
        worst.map(|(_, answer)| answer)
    }
}

/// `hold` proves a case against the scenario.
fn check(work: &Work, case: &Case, hold: fn(&Setup, &Case) -> campaign::Verified) -> Answer {
    let finding = |what: String| Answer::Checked {
        case: case.number,
        witness: true,
        planned: false,
        position_m: None,
        findings: vec![what],
    };
    let mut case = case.clone();
    if let Err(error) = work.folder.read_witness(&mut case) {
        return finding(error.to_string());
    }
    let claims = case.evidence.is_of_a_witness();
    let witness = case.witness.is_some();
    if case.environment.is_none() && !witness && !claims {
        return Answer::NothingClaimed;
    }
    let verified = hold(&work.setup, &case);
    match verified.proof {
        Some(proof) if witness || !claims => {
            let mut findings: Vec<String> = proof.findings.iter().map(words).collect();
            // Rows are held to what was proven.
            let planned = if witness && findings.is_empty() { of_rows(work, &case) } else { None };
            findings.extend(planned.iter().flatten().cloned());
            Answer::Checked {
                case: case.number,
                witness,
                planned: planned.is_some(),
                position_m: (!proof.findings.iter().any(is_no_number)).then_some(proof.position.value),
                findings,
            }
        }
        _ => finding("its profile is missing".into()),
    }
}

/// What does not hold of the rows of its planned motion; `None` in a folder that keeps none.
fn of_rows(work: &Work, case: &Case) -> Option<Vec<String>> {
    match work.folder.read_planned_rows(case.number) {
        Ok(kept) => kept.map(|(rows, period)| {
            let kept = PlannedRows { rows: &rows, period };
            campaign::verify_planned(&work.setup, case, &kept).iter().map(words).collect()
        }),
        Err(error) => Some(vec![error.to_string()]),
    }
}

/// Whether what was written is no number, so that nothing was flown by it.
fn is_no_number(finding: &Finding) -> bool {
    finding.value.is_nan() && finding.bound == f64::MAX
}

fn words(finding: &Finding) -> String {
    let Finding { field, value, bound, unit, at, leg } = finding;
    // What is refused in words alone has neither.
    let numbers = match bound.is_nan() {
        true => String::new(),
        false if is_no_number(finding) => " holds a number that cannot be".to_owned(),
        false => format!(" = {value:.6e} {unit}, bound {bound:.6e} {unit}"),
    };
    format!("{field}{numbers}, leg {leg}→{}, t = {at:.3} s", leg + 1)
}

#[cfg(test)]
mod tests {
    use std::path::PathBuf;

    use hairpin::trajectory::{Channel, Track};
    use hairpin_formats::folder::CampaignFolder;
    use hairpin_formats::parquet::track;
    use nalgebra::Translation3;
    use tempfile::TempDir;

    use super::*;
    use crate::Unwatched;
    use crate::generate::generate;
    use crate::testing::generated;
    use crate::work::CampaignSettings;

    #[test]
    fn what_has_no_number_is_told_in_words() {
        let finding = Finding { field: "it stops".into(), value: f64::NAN, bound: f64::NAN, unit: "", leg: 1, at: 0.5 };
        assert_eq!(words(&finding), "it stops, leg 1→2, t = 0.500 s");
        let finding = Finding { field: "end".into(), value: 2.0, bound: 1.0, unit: "m", ..finding };
        assert_eq!(words(&finding), "end = 2.000000e0 m, bound 1.000000e0 m, leg 1→2, t = 0.500 s");
        let finding = Finding { field: "legs[1]".into(), value: f64::NAN, bound: f64::MAX, unit: "", ..finding };
        assert_eq!(words(&finding), "legs[1] holds a number that cannot be, leg 1→2, t = 0.500 s");
    }

    #[test]
    fn witnesses_hold_and_broken_ones_are_findings() {
        let (_place, folder) = generated();
        let verified = verify(&folder).unwrap();
        assert_eq!((verified.witnesses(), verified.has_findings()), ([2, 2], false));
        assert!(verified.unread() == 0 && verified.largest_m().is_some_and(|error| error < 1e-3), "{verified:?}");
        std::fs::write(folder.join("profiles/part-00000.parquet"), "broken").unwrap();
        let broken = verify(&folder).unwrap();
        assert_eq!((broken.checked(), broken.failed().count(), broken.witnesses()), (2, 2, [2, 0]));
        assert_eq!(broken.worst(), broken.failed().next());
        assert_eq!((broken.unread(), broken.largest_m()), (2, None), "no end error is known of what cannot be read");
        assert_eq!(broken.planned(), [0, 0], "rows are held to what holds");
        std::fs::remove_dir_all(folder.join("profiles")).unwrap();
        let lost = verify(&folder).unwrap();
        assert_eq!((lost.checked(), lost.failed().count()), (2, 2));
        // Nothing else is flown in its place either.
        let refused = open_to_read(&folder).unwrap().folder.read_cases().unwrap_err().to_string();
        assert!(refused.contains("profiles: case 0000 is witnessed and has no witness"), "{refused}");
    }

    #[test]
    fn where_nothing_is_claimed_nothing_is_verified() {
        let place = tempfile::tempdir().unwrap();
        let hull = crate::testing::small_hull(place.path());
        let folder = made(&place, &hull, &[]);
        let verified = verify(&folder).unwrap();
        let told = "none of 3 cases claims a witness: evidence hull-feasible, generate.reach = \"hull\"";
        assert_eq!((verified.checked(), verified.nothing.as_deref()), (0, Some(told)));
        CampaignFolder::open_to_write(&folder).unwrap().write_new_cases(&[], 0).unwrap();
        assert_eq!(verify(&folder).unwrap().nothing.as_deref(), Some("the folder has no case"));
        let (_place, folder) = generated();
        assert_eq!(verify(&folder).unwrap().nothing, None);
    }

    /// The task in the folder's scenario is changed: who was searched for by another is none of it.
    #[test]
    fn what_was_searched_for_is_held_to_the_task_and_missions_are_not() {
        let (_place, folder) = generated();
        let file = folder.join("scenario.toml");
        let text = std::fs::read_to_string(&file).unwrap();
        let length = text.lines().find(|line| line.starts_with("length = ")).unwrap();
        std::fs::write(&file, text.replace(length, "length = 4")).unwrap();
        let searched = verify(&folder).unwrap();
        assert_eq!(searched.failed().count(), 2);
        let told = |answer: &Answer| matches!(answer, Answer::Checked { findings, .. } if findings[0].starts_with("task.length = "));
        assert!(searched.failed().all(told), "{searched:?}");
        let missions = vec!["a".into(), "b".into()];
        let kept = CampaignFolder::open_to_write(&folder).unwrap();
        kept.write_tally(&Tally { missions, ..kept.read_tally().unwrap() }).unwrap();
        drop(kept);
        let given = verify(&folder).unwrap();
        assert_eq!((given.witnesses(), given.has_findings()), ([2, 2], false), "{given:?}");
        std::fs::remove_file(folder.join("generation.json")).unwrap();
        assert_eq!(verify(&folder).unwrap().failed().count(), 2, "what no tally says was given was searched for");
    }

    fn made(place: &TempDir, scenario: &str, sets: &[(&str, &str)]) -> PathBuf {
        let settings = CampaignSettings {
            scenario: scenario.into(),
            out: Some(place.path().join("out")),
            sets: sets.iter().map(|(key, value)| ((*key).into(), (*value).into())).collect(),
            ..CampaignSettings::default()
        };
        generate(&settings, &Unwatched).unwrap().work.folder.path().to_owned()
    }

    /// `track` with the row in its middle `way_m` farther along x, and as much faster as `more_m_s`.
    fn changed(track: &Track, way_m: f64, more_m_s: f64) -> Track {
        let middle = track.len() / 2;
        let mut poses = track.poses().to_vec();
        poses[middle] = Translation3::new(way_m, 0.0, 0.0) * poses[middle];
        let mut channels: Vec<Channel> = track.channels().to_vec();
        for channel in channels.iter_mut().filter(|channel| channel.name == "vx_m_s") {
            channel.values[middle] += more_m_s;
        }
        Track::new(track.times().to_vec(), poses, channels).unwrap()
    }

    /// All planned motions in `folder` hold; the last one no more once one of its rows is elsewhere or at another
    /// speed, and none is missed where none is kept.
    fn rows_are_held_to_their_witness(folder: &Path) {
        let sound = verify(folder).unwrap();
        let [all, _] = sound.witnesses();
        assert!(all > 0 && !sound.has_findings(), "{sound:?}");
        assert_eq!(sound.planned(), [all; 2]);
        let kept = open_to_read(folder).unwrap().folder;
        let last = kept.read_cases_without_profiles().unwrap().last().unwrap().number;
        let (rows, _) = kept.read_planned_rows(last).unwrap().unwrap();
        for (way_m, more_m_s, field) in [(3.0, 0.0, "planned.position"), (0.0, 0.5, "planned.velocity")] {
            let piece = track::planned(last, &changed(&rows, way_m, more_m_s)).unwrap();
            CampaignFolder::open_to_write(folder).unwrap().write_planned(vec![(last, piece)]).unwrap();
            let found = verify(folder).unwrap();
            let failed: Vec<&Answer> = found.failed().collect();
            let [Answer::Checked { case, findings, .. }] = failed[..] else { panic!("{found:?}") };
            assert_eq!(*case, last);
            let told = findings.join("; ");
            assert!(told.contains(field) && told.contains(", bound ") && told.contains(", t = "), "{told}");
            assert_eq!((found.planned(), found.has_findings()), ([all, all - 1], true));
        }
        drop(kept);
        std::fs::remove_dir_all(folder.join("trajectories")).unwrap();
        let without = verify(folder).unwrap();
        assert_eq!((without.planned(), without.witnesses(), without.has_findings()), ([0, 0], [all; 2], false));
    }

    #[test]
    fn planned_motions_of_flights_are_held_to_their_polynomials() {
        let (_place, folder) = generated();
        rows_are_held_to_their_witness(&folder);
    }

    #[test]
    fn planned_motions_of_drives_are_held_to_their_commands() {
        let place = tempfile::tempdir().unwrap();
        let sets = [
            ("task.length", "4"),
            ("generate.manoeuvres", "[\"forward\"]"),
            ("generate.search", "{ score = \"slope+slip\", waypoints = 24, cases = 2 }"),
            ("world.terrain", "{ generator = \"craters\", size_m = 60, cell_m = 0.2 }"),
        ];
        rows_are_held_to_their_witness(&made(&place, "rover", &sets));
    }

    #[test]
    fn planned_motions_of_boats_are_held_to_their_polynomials() {
        let place = tempfile::tempdir().unwrap();
        let text = r#"
hairpin = 1
robot = "cybership-ii"
seed = 5
[world]
size_m = [60, 60]
[task]
start_m = [27, 27]
end_m = [33, 33]
length = 2
[generate]
leg_time_s = [60, 300]
search = { method = "beam", waypoints = 30, cases = 2 }
[execute]
repeat = 1
time_limit_s = 400
[spec]
deviation = { max_m = 0.1 }
"#;
        let file = place.path().join("waters.toml");
        std::fs::write(&file, text).unwrap();
        rows_are_held_to_their_witness(&made(&place, &file.to_string_lossy(), &[]));
    }

    #[test]
    fn planned_motions_of_arms_are_held_to_their_programs() {
        let place = tempfile::tempdir().unwrap();
        let sets = [("task.points.count", "8"), ("generate.search.programs", "2")];
        rows_are_held_to_their_witness(&made(&place, "arm", &sets));
    }
}
