//! From a scenario's numbers to the things they describe: a scenario is checked by building it. Kinds of robots are
//! chosen by the one `match` here.
//!
//! ```text
//! Resolved (keys, files) ─▶ every bound ─▶ robot and world ─▶ `[vary]` at its ends, each built once ─▶ Setup
//! ```
//!
//! Draws go the short way: their keys were checked at the ends of what they are drawn from, so that only the robot
//! and its world are built, and what no drawn key describes is shared.

use std::any::Any;
use std::borrow::Cow;
use std::sync::Arc;

use nalgebra::{Point3, Vector3};
use serde_json::Value;

use super::attachments::{Attachments, Resolved};
use super::case::Case;
use super::check::check_vary;
use super::kind::{Build, Drawing, Footing, Given, Handed, Kind, PassedOver, Programs, Returning, RobotWords, Room};
use super::own_controller::AnyController;
use super::scenario::{
    Environment, Executor, Mistake, Scenario, TARGET_KEY, TIMEOUT_S, kinds_of_robots, shapes_the_plan,
};
use super::user_code::UserCode;
use super::user_score::LegScorer;
use super::user_target::RunMeter;
use super::vary;
use crate::judgement::Swiftness;
use crate::math::simd::Simd;
use crate::robot::battery::Battery;
use crate::trajectory::Track;
use crate::trajectory::program::Program;

mod steered;

/// A resolved scenario and what it describes. What draws leave as it is they share.
///
/// Cheap to clone: all that is large lies behind `Arc`. Every job takes one, and none changes it.
#[derive(Debug, Clone)]
pub struct Setup {
    /// Every key, the robot's table inline.
    /// What stands in the folder's scenario.toml: enough to build the same again.
    pub scenario: Scenario,
    /// What its files hold.
    pub attachments: Arc<Attachments>,
    /// Version of the kernels that generate and execute.
    /// One level for all of a campaign; results of levels differ in no bit, and folders say which one it was.
    pub simd: Simd,
    kind: Arc<dyn Kind>,
    own_controller: Option<AnyController>,
    /// What the program of the user's that executed calls itself.
    program: Option<Arc<str>>,
}

/// Which keys are looked at.
#[derive(Debug, Clone, Copy)]
enum Look {
    /// All that have a bound.
    All,
    /// Those that the robot and its world are made of: all were looked at before some were drawn.
    Built,
}

/// One arm of a `match` for each kind of robots.
macro_rules! built {
    ($($Kind:ident($($Keys:ident)::+) of $words:expr, built by $($Setup:ident)::+;)+) => {
        /// What `scenario` describes; what `known` has alike is shared with it.
        fn built(
            scenario: &Scenario,
            files: &Arc<Attachments>,
            known: Option<&dyn Kind>,
            look: Look,
        ) -> Result<Arc<dyn Kind>, Vec<Mistake>> {
            match scenario {
                $(Scenario::$Kind(keys) => made::<crate::campaign::$($Setup)::+>(keys, files, known, look),)+
            }
        }
    };
}

kinds_of_robots!(built);

fn made<S: Build>(
    keys: &Arc<S::Keys>,
    files: &Arc<Attachments>,
    known: Option<&dyn Kind>,
    look: Look,
) -> Result<Arc<dyn Kind>, Vec<Mistake>> {
    let given = Given::<S> { keys, files, known: known.and_then(<dyn Kind>::own) };
    let made = match look {
        Look::All => S::check(given)?,
        Look::Built => S::build(given).map_err(|mistake| vec![mistake])?,
    };
    Ok(Arc::new(made))
}

impl Setup {
    /// Builds robot and world of a resolved scenario, and looks at every key that has a bound, also at the ends of what
    /// `[vary]` may make of it.
    ///
    /// # Errors
    /// Every key whose value is out of bounds, in the order of the file.
    ///
    /// Costs as many constructions as `[vary]` has ends beside one.
    pub fn build(resolved: Resolved) -> Result<Self, Vec<Mistake>> {
        let Resolved { scenario, attachments } = resolved;
        let attachments = attachments.into();
        let (kind, simd) = (built(&scenario, &attachments, None, Look::All)?, Simd::default());
        Self { scenario, attachments, simd, kind, own_controller: None, program: None }.steered()?.checked(&|_| true)
    }

    /// The same for missions that are given: nothing is searched for between the ends of its `[task]`, so that these
    /// need not lie in the world.
    ///
    /// # Errors
    /// As [`Self::build`], but for keys of `[task]`.
    pub fn build_for_missions(resolved: Resolved) -> Result<Self, Vec<Mistake>> {
        let counts = |mistake: &Mistake| !mistake.key.starts_with("task.");
        let Resolved { scenario, attachments } = resolved;
        let (attachments, simd) = (attachments.into(), Simd::default());
        let kind = match built(&scenario, &attachments, None, Look::All) {
            Err(mistakes) if !mistakes.iter().any(counts) => built(&scenario, &attachments, None, Look::Built)?,
            Err(mistakes) => return Err(mistakes.into_iter().filter(counts).collect()),
            Ok(kind) => kind,
        };
        Self { scenario, attachments, simd, kind, own_controller: None, program: None }.steered()?.checked(&counts)
    }

    /// The same, which tells the first mistake alone.
    ///
    /// # Errors
    /// The first key whose value is out of bounds.
    pub fn new(resolved: impl Into<Resolved>) -> Result<Self, Mistake> {
        Self::build(resolved.into()).map_err(first)
    }

    /// The setup of another scenario with the same files, which is looked at as [`Self::new`] does; kernels and
    /// controller stay these.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub fn changed(&self, scenario: Scenario) -> Result<Self, Mistake> {
        self.check(scenario).map_err(first)
    }

    /// The setup with the values of `draws` in place of the nominal ones.
    ///
    /// # Errors
    /// A key that the scenario has not, a value that is out of its key's bounds in combination with the others.
    ///
    /// `draws` are dotted keys with the values of one run. Kernels and controller stay; large parts that no drawn key
    /// describes are shared.
    pub fn drawn(&self, draws: &[(String, Value)]) -> Result<Self, Mistake> {
        self.of_draw(vary::apply(&self.scenario, draws)?)
    }

    /// The same at another version of the kernels.
    ///
    /// No number changes by it: kernels give the same bits at every level.
    pub fn with_simd(self, simd: Simd) -> Self {
        let kind = self.kind.with(simd, self.own_controller.as_ref()).unwrap_or_else(|| self.kind.clone());
        Self { simd, kind, ..self }
    }

    /// The same executed by a program that calls itself `name`, which is what is told of it; one without a name is told
    /// by its command.
    #[must_use]
    pub fn executed_by(self, name: &str) -> Self {
        Self { program: Some(name).filter(|name| !name.is_empty()).map(Into::into), ..self }
    }

    /// The program of the user's that executes, in words: what it calls itself, where that is known, else its command.
    /// `None` where there is none.
    pub fn program(&self) -> Option<String> {
        let command = self.scenario.executor().command?;
        Some(self.program.as_deref().map_or_else(|| format!("`{command}`"), str::to_owned))
    }

    /// Why run number `run` was not flown, `sentence`, with the program that executes before it, if one does.
    pub fn by_program(&self, run: usize, sentence: &str) -> String {
        let program = self.program().map_or(String::new(), |program| format!("{program}, "));
        format!("{program}run {run}: {sentence}")
    }

    /// The setup of `scenario`, whose keys were checked before `[vary]` drew some of them; kernels and controller stay
    /// these.
    pub(super) fn of_draw(&self, scenario: Scenario) -> Result<Self, Mistake> {
        let kind = built(&scenario, &self.attachments, Some(self.kind()), Look::Built).map_err(first)?;
        Ok(self.with(scenario, kind))
    }

    /// This setup with what `case` has beside its waypoints in its world.
    ///
    /// # Errors
    /// An environment of a folder that was edited, with the key of `[world]` that it breaks.
    ///
    /// Obstacles, wind and force of [`Case::environment`] are put into the scenario's own keys, so that nothing else
    /// knows of them.
    pub fn around(&self, case: &Case) -> Result<Cow<'_, Self>, Mistake> {
        match &case.environment {
            Some(environment) => self.of_draw(self.surrounded_by(environment)).map(Cow::Owned),
            None => Ok(Cow::Borrowed(self)),
        }
    }

    /// Whether an environment made elsewhere can be that of a case.
    ///
    /// # Errors
    /// What it has that acts on no robot of this kind, or the key that it breaks.
    pub fn check_environment(&self, environment: &Environment) -> Result<(), Mistake> {
        if let Some(foreign) = environment.foreign(self.scenario.head().surroundings) {
            return Err(foreign);
        }
        let around = self.surrounded_by(environment);
        let broken = |mistake: &Mistake| {
            mistake.key.starts_with("world.") || mistake.key.starts_with("execute.external_force_n")
        };
        match self.check(around.clone()) {
            Ok(_) => Ok(()),
            Err(mistakes) => match mistakes.into_iter().find(broken) {
                Some(mistake) => Err(mistake),
                None => self.of_draw(around).map(drop),
            },
        }
    }

    /// This setup in a world of `size` (m, from the origin on) with nothing in it, which is held to the bounds of
    /// worlds alone; `None` where its kind of robot has no such world.
    ///
    /// # Errors
    /// A size that no world has.
    pub fn in_the_open(&self, size: &Vector3<f64>) -> Result<Option<Self>, Mistake> {
        let Some(world) = self.kind.open_world(size) else { return Ok(None) };
        self.of_draw(vary::apply(&self.scenario, &[("world".into(), world)])?).map(Some)
    }

    fn surrounded_by(&self, environment: &Environment) -> Scenario {
        let mut around = self.scenario.clone();
        around.surround(environment);
        around
    }

    fn with(&self, scenario: Scenario, kind: Arc<dyn Kind>) -> Self {
        let Self { attachments, own_controller, program, .. } = self.clone();
        Self { scenario, attachments, simd: self.simd, kind, own_controller, program }
    }

    fn check(&self, scenario: Scenario) -> Result<Self, Vec<Mistake>> {
        let kind = built(&scenario, &self.attachments, Some(self.kind()), Look::All)?;
        self.with(scenario, kind).steered()?.checked(&|_| true)
    }

    /// Itself, once `[vary]` was looked at for mistakes that count.
    fn checked(self, counts: &dyn Fn(&Mistake) -> bool) -> Result<Self, Vec<Mistake>> {
        let mistakes_of = |drawn: &Scenario| -> Vec<Mistake> {
            let found = built(drawn, &self.attachments, Some(self.kind()), Look::All).err().unwrap_or_default();
            found.into_iter().filter(counts).collect()
        };
        let mistakes = check_vary(&self.scenario, &mistakes_of);
        if mistakes.is_empty() { Ok(self) } else { Err(mistakes) }
    }

    /// What jobs ask of it, whatever robot it has.
    pub(super) fn kind(&self) -> &dyn Kind {
        &*self.kind
    }

    /// The setup of its kind, if that is `T`: [`FlightSetup`](super::flight::FlightSetup),
    /// [`DriveSetup`](super::drive::DriveSetup), [`ArmSetup`](super::arm::ArmSetup). For what one kind of robot
    /// alone has.
    ///
    /// `None` where the scenario is of another kind.
    pub fn own<T: Any>(&self) -> Option<&T> {
        self.kind().own()
    }

    fn programs(&self) -> Option<&dyn Programs> {
        self.kind.programs()
    }

    /// What executors of the user's are handed of it.
    pub fn handed(&self) -> Handed {
        self.kind.handed()
    }

    /// Whether a place (m, world frame) lies where its robot cannot be: outside of its world.
    pub fn is_outside(&self, place: &Point3<f64>) -> bool {
        self.kind.is_outside(place)
    }

    /// Distance (m) of a place from the nearest one outside of its robot's world, below 0 outside; +∞ where that has no
    /// end. Exact up to `within` m, and never less than that beyond.
    pub fn edge_distance(&self, place: &Point3<f64>, within: f64) -> f64 {
        self.kind.edge_distance(place, within)
    }

    /// Which legs of `track`, a motion over the mission of `case`, were gone backwards, in words.
    pub fn backwards(&self, case: &Case, track: &Track) -> Option<String> {
        self.kind.backwards(case, track)
    }

    /// What stands under its robot; `None` of what does not drive.
    pub fn footing(&self) -> Option<&dyn Footing> {
        self.kind.footing()
    }

    /// How fast its robot can be and become.
    pub fn swiftness(&self) -> Swiftness {
        self.kind.swiftness()
    }

    /// A mean speed, m/s, over `span` s that no robot of its file comes to; `None` where nothing bounds it.
    pub fn ceiling(&self, span: f64) -> Option<f64> {
        self.kind.ceiling(span).filter(|ceiling| ceiling.is_finite())
    }

    /// Why runs of other seeds are the same run, a sentence's part; `None` where they may differ, as by noise, gusts
    /// and code of the user's.
    pub fn repeats(&self) -> Option<&'static str> {
        self.kind.repeats()
    }

    /// Why no run feels what `[vary]` draws for the number `key`, a sentence's part; `None` where one may.
    pub fn unfelt(&self, key: &str) -> Option<&'static str> {
        self.kind.unfelt(key)
    }

    /// Why no run feels anything of what `[vary]` draws for it; `None` where one may, or nothing is drawn for runs.
    pub fn unfelt_draws(&self) -> Option<&'static str> {
        let keys = self.scenario.vary().keys().filter(|key| !shapes_the_plan(key));
        let why = keys.map(|key| self.unfelt(key)).collect::<Option<Vec<_>>>()?;
        why.first().copied()
    }

    /// Keys that are given, and that nobody reads: of the search and, by its name, of its score, then under `execute`.
    /// A score of the user's own is none of them: who brings one means it, and is refused.
    pub fn passed_over(&self) -> Vec<PassedOver> {
        let (search, score) = (self.scenario.search(), self.scenario.score());
        // Of programs of arms these are none of their keys.
        let idle = if self.has_programs() { Vec::new() } else { search.passed_over(score) };
        let of_search = idle.into_iter().map(|(key, value)| PassedOver {
            key: format!("generate.search.{key}"),
            value,
            why: format!("`{}` has no use for it here", search.method.word()),
        });
        let of_score = match self.attachments.own_score(score) {
            None => self.scenario.check_score(score).err(),
            Some(_) => None,
        };
        let of_score = of_score.map(|Mistake { key, value, bound }| PassedOver {
            key,
            value,
            why: format!("it is to be {bound}"),
        });
        of_search.chain(of_score).chain(self.of_no_program()).chain(self.kind.passed_over()).collect()
    }

    /// What is given for a program of the user's, where none is started.
    fn of_no_program(&self) -> impl Iterator<Item = PassedOver> {
        let Executor { command, processes, timeout, .. } = self.scenario.executor();
        let (has_command, has_own) = (command.is_some(), self.own_controller().is_some());
        let timeout = (!has_command && !has_own && timeout.to_bits() != TIMEOUT_S.to_bits())
            .then(|| ("execute.timeout_s", timeout.to_string(), "no program of yours executes"));
        let processes = processes
            .filter(|_| !has_command)
            .map(|count| ("execute.processes", count.to_string(), "no `execute.command` is started"));
        let told = |(key, value, why): (&str, String, &str)| PassedOver { key: key.into(), value, why: why.into() };
        timeout.into_iter().chain(processes).map(told)
    }

    /// Where its vehicle may be; `None` of what is none, as arms are.
    pub fn room(&self) -> Option<Room> {
        self.kind.room()
    }

    /// The least height (m, world frame) at which a return that an autopilot begins anywhere on a mission clears all
    /// obstacles, or why there is none, in a sentence's part; `None` of what does not fly.
    pub fn homeward(&self, returning: &Returning) -> Option<Result<f64, &'static str>> {
        self.kind.homeward(returning)
    }

    /// Distance of its robot, about a place (m, world frame), from what it must not meet, m; infinite where there is
    /// nothing.
    ///
    /// Negative inside of an obstacle.
    pub fn clearance_at(&self, place: &Point3<f64>) -> f64 {
        self.kind.clearance().map_or(f64::INFINITY, |clearance| clearance(place))
    }

    /// What stands around `places`.
    pub fn drawing(&self, places: &[Point3<f64>]) -> Drawing {
        self.kind.drawing(places)
    }

    /// Whether its motion is programs, which are measured move by move.
    pub fn has_programs(&self) -> bool {
        self.programs().is_some()
    }

    /// The logs whose recordings are the runs, where nothing is executed.
    pub fn recordings(&self) -> Option<&str> {
        self.programs().and_then(Programs::recordings)
    }

    /// A program that names whatever programs of it can name, for names to be looked at; `None` without programs.
    pub fn naming_all(&self) -> Option<Program> {
        self.programs().map(Programs::naming_all)
    }

    /// What its programs call by a name that stands for something else on every controller, in a sentence.
    pub fn misnamed(&self) -> Option<String> {
        self.programs().and_then(Programs::misnamed)
    }

    /// The score of the user's own, if that is what legs are scored by.
    pub fn user_score(&self) -> Option<&dyn LegScorer> {
        self.attachments.user_score(self.scenario.score()).map(|user| &*user.read)
    }

    /// What measures runs for the search, where that is the user's own.
    pub fn user_target(&self) -> Option<&dyn RunMeter> {
        self.attachments.user_target(self.scenario.search().target.as_ref()).map(|user| &*user.read)
    }

    /// All code of the user's own that a search asks, by the keys that name it.
    pub fn user_code(&self) -> Vec<(&'static str, &dyn UserCode)> {
        let score = self.user_score().map(|score| (self.scenario.score_key(), score as &dyn UserCode));
        let target = self.user_target().map(|target| (TARGET_KEY, target as &dyn UserCode));
        score.into_iter().chain(target).collect()
    }

    /// The robot's name.
    pub fn robot_name(&self) -> &str {
        self.robot_words().name
    }

    /// What must be said wherever the robot is named; empty if nothing.
    pub fn caveat(&self) -> &str {
        self.robot_words().caveat
    }

    /// Names of the robot's numbers that were derived, not given.
    pub fn estimated(&self) -> Vec<&str> {
        self.robot_words().estimated
    }

    /// How long the robot goes on a charge, where its file says so.
    pub fn battery(&self) -> Option<Battery> {
        self.robot_words().battery
    }

    /// What of its shape a claim rests on that is not known, or leaves out, in a few words.
    pub fn unknown_shapes(&self) -> Option<Cow<'static, str>> {
        self.robot_words().unknown_shapes
    }

    /// Seconds that explaining takes at most where nobody says.
    pub fn patience(&self) -> Option<f64> {
        self.programs().map(|programs| programs.patience())
    }

    fn robot_words(&self) -> RobotWords<'_> {
        self.kind.robot_words()
    }
}

/// The first of what was refused.
fn first(mistakes: Vec<Mistake>) -> Mistake {
    match mistakes.into_iter().next() {
        Some(mistake) => mistake,
        None => unreachable!("what is refused is refused for a reason"),
    }
}

#[cfg(feature = "unit-tests")]
mod tests;
