//! The source's test plan, run here and now.

use hairpin_jobs::Problem;

use super::check::{Check, Test};
use super::example::Example;
use super::regression::{self, Times};
use super::subject::RequirementsSettings;
use super::{anytime, dynamics, footprint, interfaces, reliability, suspension};
use crate::memory::resident;

/// A requirement in own words, with the tests that cover it.
pub(crate) type Requirement = (&'static str, &'static str, &'static [&'static str]);

const REQUIREMENTS: [Requirement; 17] = [
    ("R-1", "controls and a path of states from boundary states, vehicle and controls", &["R1", "R4"]),
    ("R-2", "an anytime mode", &["R14"]),
    ("R-3", "converges from anywhere on flat ground where a drive is feasible", &["R2"]),
    ("R-4", "within 1 % (0.01 m, rad, 1/m) on rough ground, 99 % of the time", &["R5"]),
    ("R-5", "100 ms in the mean there", &["R6"]),
    ("R-6", "10 MB of memory at most", &["R7"]),
    ("R-7", "starts within 1 s", &["R8"]),
    ("R-8", "takes boundary states and controls, gives controls and path", &["R3"]),
    ("R-9", "takes any vehicle model", &["R9", "R13"]),
    ("R-10", "takes any parameterisation of the controls", &["R12"]),
    ("R-11", "the vehicle stands on an elevation map", &["R10"]),
    ("R-12", "predicts from states, and meets what the vehicle's dynamics make of its commands", &["R11"]),
    ("R-13", "implausible states are detected", &["R16"]),
    ("R-14", "implausible controls are detected", &["R17"]),
    ("R-15", "implausible vehicles are detected", &["R18"]),
    ("R-16", "non-convergence and divergence are detected", &["R19"]),
    ("R-17", "running over the time limit is detected", &["R15"]),
];

/// What a run of the test plan found.
pub(crate) struct Measured {
    /// What the numbers are of.
    pub(crate) notes: Vec<String>,
    pub(crate) requirements: Vec<(Requirement, Check)>,
    pub(crate) tests: Vec<Test>,
    /// How long queries took.
    pub(crate) times: Vec<Times>,
    pub(super) example: Example,
}

impl Measured {
    /// Runs the test plan. To be called before anything else, so that the process holds nothing yet.
    pub(crate) fn now(settings: &RequirementsSettings) -> Result<Self, Problem> {
        let before = resident("RssAnon:");
        let (subject, footprint) = footprint::measured(settings, before)?;
        let (flat, on_flat) = regression::flat(&subject)?;
        let (rough, on_rough) = regression::rough(&subject)?;
        let (compensated, late) = dynamics::compensated(&subject)?;
        let mut tests = Vec::from(flat);
        tests.extend(rough);
        tests.extend(footprint);
        tests.push(interfaces::loads(&subject));
        tests.push(suspension::stands(&subject)?);
        tests.push(compensated);
        tests.push(interfaces::switches_controls());
        tests.push(interfaces::switches_vehicles(&subject)?);
        tests.extend(anytime::within(&subject));
        tests.push(reliability::states(&subject)?);
        tests.push(reliability::controls());
        tests.push(reliability::vehicles());
        tests.push(reliability::convergence(&subject));
        let requirements = REQUIREMENTS.iter().map(|requirement| (*requirement, Check::of(requirement.2, &tests)));
        Ok(Self {
            notes: subject.notes(),
            requirements: requirements.collect(),
            tests,
            times: [on_flat].into_iter().chain(on_rough).chain([late]).collect(),
            example: Example::new()?,
        })
    }

    pub(super) fn met(&self) -> bool {
        self.requirements.iter().all(|(_, check)| check.passed)
            && self.tests.iter().all(|test| test.check.passed)
            && self.example.solved()
    }

    /// How many of both there are, and how many passed.
    pub(crate) fn counted(&self) -> String {
        let passed = self.tests.iter().filter(|test| test.check.passed).count();
        let met = self.requirements.iter().filter(|(_, check)| check.passed).count();
        format!("{met} of {} requirements met, {passed} of {} tests passed", self.requirements.len(), self.tests.len())
    }
}
