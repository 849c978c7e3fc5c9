//! `repro/CASE.json`: one violating run in one file that can be read, sent and flown again.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use hairpin::campaign::bounds::{FARTHEST_ON_EARTH_M, MOST_TURN_RATE, MOST_WAYPOINTS};
use hairpin::campaign::report::violation;
use hairpin::campaign::{Case, CaseResult, Evidence, Scenario, Setup, Witness, vary};
use hairpin::robot::rover::MOST_SPEED;
use hairpin::trajectory::Drive;
use hairpin::trajectory::drive::MOST_SEGMENTS;
use hairpin::trajectory::{Profile, ProfileLeg};
use nalgebra::Point3;
use serde::{Deserialize, Serialize};
use thiserror::Error;

use crate::atomic::{self, WriteError};
use crate::bounds;
use crate::executor::Greeting;
use crate::missions::Demands;
use crate::rapid::{self, Frames};

/// A file that is no repro file.
#[derive(Debug, Error)]
#[error("{}: {what}", path.display())]
pub struct BrokenRepro {
    /// The file.
    pub path: PathBuf,
    /// What is wrong with it.
    pub what: String,
}

/// One run that violates the spec, and all that it takes to fly it again.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Repro {
    /// Version of the format: 1.
    pub hairpin_repro: u32,
    /// The case's name.
    pub case: String,
    /// The run that violated.
    pub run: usize,
    /// The case's seed.
    pub seed: u64,
    /// What was seen.
    pub expected: Expected,
    /// Both ends included.
    pub waypoints_m: Vec<[f64; 3]>,
    /// Planned duration of each leg.
    pub leg_times_s: Vec<f64>,
    /// Evidence word of the trajectory.
    pub evidence: String,
    /// The control witness, one per leg: `duration_s`, and per axis c0 … c7 in m/s^i.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub profile: Option<Vec<Leg>>,
    /// The control witness of a drive, SI.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub drive: Option<Drive>,
    /// What an arm runs, as RAPID.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub program: Option<String>,
    /// What the program of the user's that flew it says of itself.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub flown_by: Option<Greeting>,
    /// What its mission asks beside the spec, where it was made elsewhere.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub mission: Option<Demands>,
    /// What it was made of, where it is smaller than the case was.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub shrunk: Option<ShrunkFrom>,
    /// The resolved scenario.
    pub scenario: Scenario,
}

/// What a shrunk case was made of.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ShrunkFrom {
    /// Waypoints of the case.
    pub waypoints: usize,
    /// Its violations, in words.
    pub violations: Vec<String>,
    /// What was left out of the scenario.
    pub simplified: Vec<String>,
    /// Whether nothing smaller was found; else the search was stopped.
    pub finished: bool,
    /// Executions that it took.
    pub runs: u64,
}

/// What was seen.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Expected {
    /// All violated limits, in words.
    pub violations: Vec<String>,
    /// Largest deviation.
    pub max_deviation_m: f64,
    /// When.
    pub t_worst_s: f64,
    /// The leg.
    pub leg_worst: usize,
    /// Why the run ended.
    pub ended: String,
}

impl Expected {
    /// What was seen of `result`.
    pub fn of(result: &CaseResult) -> Self {
        let measures = result.measures.clone().unwrap_or_default();
        Self {
            violations: result.violations.iter().map(violation).collect(),
            max_deviation_m: measures.max_deviation,
            t_worst_s: measures.t_worst,
            leg_worst: measures.leg_worst,
            ended: result.ended.clone(),
        }
    }

    /// Whether `now` is the same: how it ended, the kinds of what it violates, the leg of the largest deviation, and
    /// that deviation and its time to within `most` m and s. The digits of a sentence are not compared: versions print
    /// them differently.
    pub fn is_within(&self, most: f64, now: &Self) -> bool {
        let is_near = |then: f64, now: f64| (then - now).abs() <= most;
        let kinds = |seen: &Self| seen.violations.iter().map(|told| kind(told)).collect::<BTreeSet<String>>();
        (&self.ended, self.leg_worst, kinds(self)) == (&now.ended, now.leg_worst, kinds(now))
            && is_near(self.max_deviation_m, now.max_deviation_m)
            && is_near(self.t_worst_s, now.t_worst_s)
    }
}

/// What a sentence of a violation says is violated: its words before the first number, or before its time.
fn kind(told: &str) -> String {
    let told = told.split_once(" at t=").map_or(told, |(before, _)| before);
    let is_number = |word: &str| word.trim_start_matches(['-', '+']).starts_with(|c: char| c.is_ascii_digit());
    told.split(' ').take_while(|word| !is_number(word)).collect::<Vec<_>>().join(" ")
}

/// One leg of the witness.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Leg {
    duration_s: f64,
    coefficients: [[f64; 8]; 3],
}

/// What a case was made by: what it has beside its waypoints is part of its world, and its plan is as it was drawn.
fn scenario_of(setup: &Setup, case: &Case, result: &CaseResult) -> Scenario {
    let around = setup.around(case).map_or_else(|_| setup.scenario.clone(), |setup| setup.scenario.clone());
    vary::settle(&around, &result.drawn).unwrap_or(around)
}

impl Repro {
    /// The worst run of `result`.
    pub fn of(setup: &Setup, case: &Case, result: &CaseResult) -> Self {
        let leg = |leg: &ProfileLeg| Leg { duration_s: leg.duration, coefficients: leg.coefficients };
        Self {
            hairpin_repro: 1,
            case: case.id(),
            run: result.run,
            seed: case.seed,
            expected: Expected::of(result),
            waypoints_m: case.waypoints.iter().map(|p| p.coords.into()).collect(),
            leg_times_s: case.leg_times.clone(),
            evidence: case.evidence.word().into(),
            profile: case.profile().map(|profile| profile.legs.iter().map(leg).collect()),
            drive: case.commands().cloned(),
            program: case.program().and_then(|program| rapid::module(program, &[]).ok()),
            flown_by: None,
            mission: None,
            shrunk: None,
            scenario: scenario_of(setup, case, result),
        }
    }

    /// Writes it.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn write(&self, path: &Path) -> Result<(), WriteError> {
        atomic::write_json(path, self)
    }

    /// Reads one.
    ///
    /// # Errors
    /// The file cannot be read, or is none.
    pub fn read(path: &Path) -> Result<Self, BrokenRepro> {
        let refuse = |what: String| BrokenRepro { path: path.into(), what };
        let text = bounds::read_json_text(path).map_err(|error| refuse(format!("cannot be read: {error}")))?;
        let repro: Self = serde_json::from_str(&text).map_err(|error| refuse(format!("is no repro file: {error}")))?;
        repro.check().map_err(refuse)?;
        Ok(repro)
    }

    /// These files are there to be edited, so every number has a bound, and so have all that belong together.
    fn check(&self) -> Result<(), String> {
        if self.hairpin_repro != 1 {
            return Err(format!("hairpin_repro = {}: this hairpin reads 1", self.hairpin_repro));
        }
        let waypoints = self.waypoints_m.len();
        if !(2..=MOST_WAYPOINTS).contains(&waypoints) {
            return Err(format!("waypoints_m has {waypoints} waypoints: must be 2 … {MOST_WAYPOINTS}"));
        }
        if let Some(i) = self.waypoints_m.iter().position(|p| !p.iter().all(|x| x.abs() <= FARTHEST_ON_EARTH_M)) {
            return Err(format!(
                "waypoints_m[{i}] = {:?}: must be m, {FARTHEST_ON_EARTH_M} at most",
                self.waypoints_m[i]
            ));
        }
        if let Some(mission) = &self.mission {
            mission.check()?;
        }
        let legs = waypoints - 1;
        if ![0, legs].contains(&self.leg_times_s.len()) {
            return Err(format!("leg_times_s has {} values: must be {legs}", self.leg_times_s.len()));
        }
        let longest = self.scenario.head().longest_leg;
        let is_time = |time: f64| time > 0.0 && time <= longest;
        if let Some(i) = self.leg_times_s.iter().position(|time| !is_time(*time)) {
            let time = self.leg_times_s[i];
            return Err(format!("leg_times_s[{i}] = {time}: must be > 0 and ≤ {longest} s"));
        }
        if let Some(drive) = &self.drive {
            if drive.legs.len() != legs {
                return Err(format!("drive: must have {legs} legs"));
            }
            if let Some(leg) = drive.legs.iter().position(|leg| leg.segments.len() > MOST_SEGMENTS) {
                let segments = drive.legs[leg].segments.len();
                return Err(format!("drive.legs[{leg}] has {segments} segments: must be {MOST_SEGMENTS} at most"));
            }
            for (key, value, most) in
                [("speed", drive.speed, MOST_SPEED), ("turn_rate", drive.turn_rate, MOST_TURN_RATE)]
            {
                if !(value > 0.0 && value <= most) {
                    return Err(format!("drive.{key} = {value}: must be > 0 and ≤ {most}"));
                }
            }
        }
        let Some(profile) = &self.profile else { return Ok(()) };
        if profile.len() != legs {
            return Err(format!("profile: must have {legs} legs"));
        }
        match profile.iter().position(|leg| !is_time(leg.duration_s)) {
            Some(i) => {
                let time = profile[i].duration_s;
                Err(format!("profile[{i}].duration_s = {time}: must be > 0 and ≤ {longest} s"))
            }
            None => Ok(()),
        }
    }

    /// The case to fly.
    ///
    /// # Errors
    /// What is wrong with its name, its evidence or its program.
    pub fn case(&self) -> Result<Case, String> {
        let number = self.case.parse().map_err(|_| format!("case = {:?}: must be a number", self.case))?;
        let evidence = Evidence::from_word(&self.evidence).ok_or_else(|| {
            format!("evidence = {:?}: must be one of {}", self.evidence, Evidence::ALL.map(Evidence::word).join(", "))
        })?;
        let leg = |leg: &Leg| ProfileLeg { duration: leg.duration_s, coefficients: leg.coefficients };
        let program = self.program.as_ref().map(|text| {
            let frames = Frames::of(&self.scenario);
            let module = rapid::read(text.as_bytes(), &frames.options()).map_err(|error| error.to_string());
            let program = module.and_then(|module| module.whole());
            program.and_then(|program| program.checked().map_err(|error| error.to_string()))
        });
        let program = program.transpose().map_err(|error| format!("program: {error}"))?;
        let profile = self.profile.as_ref().map(|legs| Profile { legs: legs.iter().map(leg).collect() });
        let waypoints = self.waypoints_m.iter().map(|p| Point3::from(*p)).collect();
        Ok(Case {
            leg_times: self.leg_times_s.clone(),
            evidence,
            witness: profile
                .map(Witness::from)
                .or(self.drive.clone().map(Witness::from))
                .or(program.map(Witness::from)),
            ..Case::bare(number, self.seed, waypoints)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Of a sentence only what it is about; of the rest all.
    #[test]
    fn what_was_seen_is_the_same_where_all_of_it_is() {
        let seen = Expected {
            violations: vec!["mean deviation 0.31 m > 0.30 m at t=8.64 s".into(), "left the world at t=9.00 s".into()],
            max_deviation_m: 1.5,
            t_worst_s: 8.64,
            leg_worst: 2,
            ended: "done".into(),
        };
        let same = |now: &Expected| seen.is_within(1e-6, now);
        let told = vec!["left the world at t=9.0 s".into(), "mean deviation 310 mm > 300 mm at t=8.6 s".into()];
        assert!(same(&Expected { violations: told, max_deviation_m: 1.500_000_4, ..seen.clone() }));
        let others = [
            Expected { violations: Vec::new(), ..seen.clone() },
            Expected { violations: seen.violations[..1].to_vec(), ..seen.clone() },
            Expected { violations: vec!["crash at t=9.00 s".into()], ..seen.clone() },
            Expected { ended: "time".into(), ..seen.clone() },
            Expected { leg_worst: 3, ..seen.clone() },
            Expected { max_deviation_m: 1.51, ..seen.clone() },
            Expected { t_worst_s: 8.65, ..seen.clone() },
        ];
        for other in others {
            assert!(!same(&other), "{other:?}");
        }
        assert_eq!(kind("met an obstacle: clearance -0.10 m at t=1.00 s"), "met an obstacle: clearance");
    }
}
