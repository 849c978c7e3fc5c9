//! What scenarios of all kinds have in common, under one name each.

use std::collections::BTreeMap;

use super::{
    ArmScenario, Distribution, DriveExecute, DriveScenario, ExecuteSection, FlightScenario, Origin, Scenario,
    SearchSection,
};
use crate::campaign::user_score::UserScore;

/// A point counts as reached within this distance of an arm's tool, m.
const ARRIVED: f64 = 1e-3;

/// Who executes a campaign's trajectories, and how often: what flights and drives have in common.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Executor<'a> {
    /// A program that speaks the executor protocol; `None`: our own simulator.
    pub command: Option<&'a str>,
    /// Runs per case.
    pub repeat: u64,
    /// Wall-clock limit per mission of `command`, s.
    pub timeout: f64,
    /// Workers of `command`.
    pub workers: Option<u64>,
    /// A waypoint counts as reached inside this radius, m.
    pub accept: f64,
    /// Further runs of every violation, with other noise.
    pub reruns: u64,
}

impl Scenario {
    /// The scenario of a flight.
    pub fn flight(&self) -> Option<&FlightScenario> {
        match self {
            Self::Flight(scenario) => Some(scenario),
            Self::Drive(_) | Self::Arm(_) => None,
        }
    }

    /// The scenario of a drive.
    pub fn drive(&self) -> Option<&DriveScenario> {
        match self {
            Self::Drive(scenario) => Some(scenario),
            Self::Flight(_) | Self::Arm(_) => None,
        }
    }

    /// The scenario of an arm.
    pub fn arm(&self) -> Option<&ArmScenario> {
        match self {
            Self::Arm(scenario) => Some(scenario),
            Self::Flight(_) | Self::Drive(_) => None,
        }
    }

    /// The score of the user's own, if that is what it scores by.
    pub fn user_score(&self) -> Option<&UserScore> {
        match self {
            Self::Flight(scenario) => scenario.generate.user_score.as_ref(),
            Self::Drive(scenario) => scenario.generate.search.user_score.as_ref(),
            Self::Arm(_) => None,
        }
    }

    /// Names and contents of the files that a resolved scenario keeps in its campaign's folder: its map, its cloud, its
    /// costs, its baseline, its model.
    pub fn files(&self) -> Vec<(&str, &[u8])> {
        let kept = match self {
            Self::Flight(scenario) => scenario.files(),
            Self::Drive(scenario) => scenario.files(),
            Self::Arm(scenario) => scenario.files(),
        };
        kept.into_iter().filter_map(|(file, bytes)| file.zip(bytes)).collect()
    }

    /// Root seed of the campaign.
    pub fn seed(&self) -> u64 {
        match self {
            Self::Flight(scenario) => scenario.seed,
            Self::Drive(scenario) => scenario.seed,
            Self::Arm(scenario) => scenario.seed,
        }
    }

    /// Waypoints of a trajectory, both ends included; `None` where they are as many as load the robot most.
    pub fn length(&self) -> Option<u64> {
        match self {
            Self::Flight(scenario) => Some(scenario.task.length),
            Self::Drive(scenario) => Some(scenario.task.length),
            Self::Arm(_) => None,
        }
    }

    /// How graphs are searched.
    pub fn search(&self) -> SearchSection {
        match self {
            Self::Flight(scenario) => scenario.generate.search.clone(),
            Self::Drive(scenario) => scenario.generate.search.section(),
            Self::Arm(scenario) => scenario.generate.search.section(scenario.task.count()),
        }
    }

    /// The score's name.
    pub fn score(&self) -> &str {
        match self {
            Self::Flight(scenario) => &scenario.generate.score,
            Self::Drive(scenario) => &scenario.generate.search.score,
            Self::Arm(scenario) => scenario.generate.cost.word(),
        }
    }

    /// The word of the reach set, or of what is proven clear.
    pub fn reach(&self) -> &'static str {
        match self {
            Self::Flight(scenario) => scenario.generate.reach.word(),
            Self::Drive(scenario) => scenario.generate.reach.word(),
            Self::Arm(scenario) => scenario.generate.mode.word(),
        }
    }

    /// Who executes, and how often.
    pub fn executor(&self) -> Executor<'_> {
        match self {
            Self::Flight(scenario) => {
                let ExecuteSection { command, repeat, timeout_s, workers, accept_m, flaky, .. } = &scenario.execute;
                let reruns = flaky.map_or(0, |flaky| flaky.reruns);
                let command = command.as_deref();
                Executor { command, repeat: *repeat, timeout: *timeout_s, workers: *workers, accept: *accept_m, reruns }
            }
            Self::Drive(scenario) => {
                let DriveExecute { command, repeat, timeout_s, workers, accept_m, flaky, .. } = &scenario.execute;
                let reruns = flaky.map_or(0, |flaky| flaky.reruns);
                let command = command.as_deref();
                let repeat = repeat.unwrap_or(if scenario.vary.is_empty() { 1 } else { 2 });
                Executor { command, repeat, timeout: *timeout_s, workers: *workers, accept: *accept_m, reruns }
            }
            Self::Arm(scenario) => {
                let repeat = scenario.execute.repeat;
                let reruns = scenario.execute.flaky.map_or(0, |flaky| flaky.reruns);
                Executor { command: None, repeat, timeout: f64::INFINITY, workers: None, accept: ARRIVED, reruns }
            }
        }
    }

    /// The word of the controller of ours that executes; `None` where a command does.
    pub fn controller(&self) -> Option<&'static str> {
        match self {
            Self::Flight(scenario) => scenario.execute.controller_in_force().map(|controller| controller.word()),
            Self::Drive(scenario) => scenario.execute.controller_in_force().map(|controller| controller.word()),
            Self::Arm(scenario) => scenario.execute.logs.is_none().then_some("virtual controller"),
        }
    }

    /// Where on Earth the world stands.
    pub fn origin(&self) -> Option<Origin> {
        match self {
            Self::Flight(scenario) => scenario.world.origin,
            Self::Drive(scenario) => scenario.world.origin,
            Self::Arm(_) => None,
        }
    }

    /// Distributions, by key.
    pub fn vary(&self) -> &BTreeMap<String, Distribution> {
        match self {
            Self::Flight(scenario) => &scenario.vary,
            Self::Drive(scenario) => &scenario.vary,
            Self::Arm(scenario) => &scenario.vary,
        }
    }

    /// The same scenario with these distributions.
    pub fn with_vary(mut self, vary: BTreeMap<String, Distribution>) -> Self {
        *self.vary_mut() = vary;
        self
    }

    /// The same for changes.
    pub(in crate::campaign) fn vary_mut(&mut self) -> &mut BTreeMap<String, Distribution> {
        match self {
            Self::Flight(scenario) => &mut scenario.vary,
            Self::Drive(scenario) => &mut scenario.vary,
            Self::Arm(scenario) => &mut scenario.vary,
        }
    }

    /// Share of cases that may violate the limits.
    pub fn violation_share(&self) -> Option<f64> {
        match self {
            Self::Flight(scenario) => scenario.spec.violation_share,
            Self::Drive(scenario) => scenario.spec.limits.violation_share,
            Self::Arm(scenario) => scenario.spec.violation_share,
        }
    }

    /// Confidence of the share's interval, where one is given.
    pub fn confidence(&self) -> Option<f64> {
        match self {
            Self::Flight(scenario) => scenario.spec.confidence,
            Self::Drive(scenario) => scenario.spec.limits.confidence,
            Self::Arm(scenario) => scenario.spec.confidence,
        }
    }

    /// Limit of the deviation, m.
    pub fn deviation_limit(&self) -> Option<f64> {
        match self {
            Self::Flight(scenario) => scenario.spec.deviation.map(|limit| limit.max_m),
            Self::Drive(scenario) => scenario.spec.limits.path_deviation_m,
            Self::Arm(scenario) => scenario.spec.path.map(|limit| limit.max_mm * 1e-3),
        }
    }
}
