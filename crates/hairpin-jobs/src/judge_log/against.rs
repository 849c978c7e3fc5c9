//! What logs are judged against, ready: cases, robot, world, limits, and where on Earth that is.

use std::path::Path;

use hairpin::campaign::{Case, CaseNumber, CaseResult, Scenario, Setup, Witness, vary};
use hairpin::judgement::Swiftness;
use hairpin_formats::missions::{self, Demands, Frame, Mission};
use hairpin_formats::placement::Placement;
use hairpin_formats::scenario::{NamedWorld, check_asked, named_world, setup_for_missions};
use hairpin_formats::waypoints;
use serde_json::{Map, Value};

use super::heights::on_ground;
use super::settings::{Against, LogSettings};
use crate::Problem;
use crate::check::{frame_in_words, read_about_home};
use crate::missions::{MissionsTold, followed, read_told};
use crate::sets::Set;
use crate::work::{PLACE, Work, check_tables, open_to_read, open_to_read_as, same_as_made};

/// Whose clock an arm's logs are on, which is a matter of the logs and not of the campaign.
const LOG_CLOCK: &str = "execute.log_clock";

/// What logs are judged against.
pub(super) struct Ready {
    pub(super) setup: Setup,
    pub(super) cases: Vec<Case>,
    /// Results of the same cases in simulation.
    pub(super) simulated: Vec<CaseResult>,
    /// Where the cases' plans are.
    pub(super) of: Of,
    pub(super) place: Option<Placement>,
    /// Whether the world that it was flown in is known.
    pub(super) in_world: bool,
    pub(super) swiftness: Swiftness,
    /// A waypoint counts as reached within this, m.
    pub(super) accept: f64,
    /// What the cases' missions ask beside the spec, where they were made elsewhere.
    missions: Option<MissionsTold>,
    /// What its user has to know, in sentences.
    pub(super) notes: Vec<String>,
}

/// Where cases are from.
pub(super) enum Of {
    /// As it was run, whatever the limits are now.
    Campaign(Box<Work>),
    /// What the only one is called.
    Mission(String),
}

impl Ready {
    /// What `settings` name.
    ///
    /// # Errors
    /// As of [`super::judge_log`].
    pub(super) fn of(settings: &LogSettings) -> Result<Self, Problem> {
        let (clock, sets): (Vec<Set>, Vec<Set>) = settings.sets.iter().cloned().partition(|(key, _)| key == LOG_CLOCK);
        check_tables(&sets, &["spec"])?;
        let settings = &LogSettings { sets, ..settings.clone() };
        let mut ready = match &settings.against {
            Against::Campaign(folder) => Self::of_campaign(folder, settings)?,
            Against::Mission { file, robot } => Self::of_mission(file, robot.as_deref(), settings)?,
        };
        if ready.setup.has_programs() {
            ready.setup = recorded(&ready.setup, clock.last())?;
            return Ok(ready);
        }
        match clock.first() {
            Some((key, _)) => Err(Problem::input(format!("--set {key}: it is of arms; here only spec can be set"))),
            None => Ok(ready.with_what_is_not_asked()),
        }
    }

    /// What of the spec is of campaigns alone is told.
    fn with_what_is_not_asked(mut self) -> Self {
        if let Some(share) = self.setup.scenario.head().violation_share.filter(|share| *share > 0.0) {
            self.notes.push(format!(
                "spec.violation_share = {share} is of a campaign's cases: of logs each is judged by itself, and one in \
                 violation is one"
            ));
        }
        self
    }

    fn of_campaign(folder: &Path, settings: &LogSettings) -> Result<Self, Problem> {
        let before = open_to_read(folder)?;
        same_as_made(&before.folder, &before.setup, &PLACE)?;
        if before.setup.has_programs() {
            // Before a world's keys are put into an arm's scenario, which has none of them.
            settings.of_an_arm()?;
        }
        let origin = before.setup.scenario.origin();
        let world = settings.world.as_deref().map(|name| world(name, origin.as_ref())).transpose()?;
        let sets: Vec<Set> = world.iter().map(|world| world.set.clone()).chain(settings.sets.iter().cloned()).collect();
        let setup = open_to_read_as(folder, &sets)?.setup;
        let folder = &before.folder;
        let mut cases = folder.read_cases_without_profiles()?;
        if let Some(id) = &settings.case {
            let number: Option<CaseNumber> = id.parse().ok();
            cases.retain(|case| Some(case.number) == number);
            if cases.is_empty() {
                return Err(Problem::input(format!("--case {id}: {} has no such case", folder.path().display())));
            }
        }
        if cases.is_empty() {
            return Err(Problem::of_file(folder.path(), "a campaign without a case"));
        }
        let notes = world.filter(|world| world.is_elsewhere).map(|_| {
            "--world has another origin than the campaign, whose own stays: its obstacles are taken to be in the campaign's frame"
                .to_owned()
        });
        let simulated = folder.read_results()?;
        let missions = read_told(folder)?;
        let notes = notes.into_iter().collect();
        let ready = Self::with(setup, cases, simulated, Of::Campaign(Box::new(before)), (true, notes))?;
        Ok(Self { missions, ..ready })
    }

    fn of_mission(file: &Path, robot: Option<&str>, settings: &LogSettings) -> Result<Self, Problem> {
        if settings.case.is_some() {
            return Err(Problem::input("--case is of a campaign; --mission is one case"));
        }
        let named = settings.world.as_deref().map(|name| world(name, None)).transpose()?;
        let mut sets = Vec::new();
        let base = match (robot, &settings.world, &named) {
            (Some(robot), ..) => {
                // The shipped scenario that the robot is put into has limits of its own, which nobody asked for here.
                sets.push(("spec".to_owned(), "{}".to_owned()));
                sets.extend(named.iter().map(|world| world.set.clone()));
                robot
            }
            (None, Some(scenario), Some(world)) if world.is_scenario => scenario,
            _ => {
                return Err(Problem::input(
                    "a mission says neither which robot flew it nor in which world: --robot R (a robot's name or file), \
                     --world W (a scenario's with its robot, or beside --robot a world's)",
                ));
            }
        };
        sets.extend(settings.sets.iter().cloned());
        let setup = setup_for_missions(base, &sets)?;
        if setup.has_programs() {
            return Err(Problem::input("an arm runs programs, not missions: --campaign OUT"));
        }
        check_asked(&setup.scenario, file)?;
        let in_world = named.is_some();
        // A table has no home, and the world that a robot's own scenario has is nobody's here.
        if !in_world && waypoints::are_in_degrees(file).map_err(Problem::input)? {
            return Err(Problem::of_file(
                file,
                "its waypoints are in degrees, and without --world there is no world.origin and no map whose plane is \
                 known (world.terrain.epsg) to place them by: --world W",
            ));
        }
        let mut mission = mission(file, &setup, in_world)?;
        let missions = Some(MissionsTold::of_log(&mission));
        if in_world {
            on_ground(&setup, &mut mission.waypoints);
        }
        let mut notes = mission.notes.clone();
        if mission.frame != Frame::World {
            notes.push(format!("the mission's places: {}", frame_in_words(&mission)));
        }
        if !in_world {
            notes.push("no --world: neither obstacles nor the world's bounds are judged".to_owned());
        }
        let about_home = match mission.frame {
            Frame::Home(home) => Some(Placement::about(&home)),
            Frame::World | Frame::Placed => None,
        };
        let case = Case::bare(CaseNumber(0), setup.scenario.seed(), mission.waypoints);
        let ready = Self::with(setup, vec![case], Vec::new(), Of::Mission(mission.name), (in_world, notes))?;
        Ok(Self { place: about_home.or(ready.place), missions, ..ready })
    }

    fn with(
        setup: Setup,
        cases: Vec<Case>,
        simulated: Vec<CaseResult>,
        of: Of,
        (in_world, notes): (bool, Vec<String>),
    ) -> Result<Self, Problem> {
        // Without its world a robot's own scenario says nothing of where that is.
        let placed = |scenario: &Scenario| Placement::of(scenario).map_err(Problem::input);
        let place = if in_world { placed(&setup.scenario)? } else { None };
        let (swiftness, accept) = (setup.swiftness(), setup.scenario.executor().accept);
        Ok(Self { setup, cases, simulated, of, place, in_world, swiftness, accept, missions: None, notes })
    }

    /// What a case is called in sentences.
    pub(super) fn name_of(&self, case: &Case) -> String {
        match &self.of {
            Of::Campaign(_) => case.id(),
            Of::Mission(name) => name.clone(),
        }
    }

    /// What the mission that `case` is asks beside the spec.
    pub(super) fn asked_of(&self, case: &Case) -> Option<&Demands> {
        self.missions.as_ref()?.asked_of(case.number)
    }

    /// A case with its plan, which deviations may be measured from.
    ///
    /// # Errors
    /// The folder's files are broken.
    pub(super) fn whole(&self, case: &Case) -> Result<Case, Problem> {
        let mut whole = case.clone();
        if let Of::Campaign(work) = &self.of {
            let folder = &work.folder;
            folder.read_witness(&mut whole)?;
            let legs = whole.witness.as_ref().and_then(Witness::legs);
            if legs.is_some_and(|legs| legs + 1 != whole.waypoints.len()) {
                let what =
                    format!("case {}: its plan has another number of legs than between its waypoints", case.id());
                return Err(Problem::of_file(folder.path(), what));
            }
        }
        Ok(whole)
    }
}

/// The mission in `file`, for the robot of `setup`: in its world where that is known, else about its own home.
///
/// # Errors
/// It cannot be read, is another class of vehicle's, or has something that changes the motion and is not followed.
fn mission(file: &Path, setup: &Setup, in_world: bool) -> Result<Mission, Problem> {
    let mission = match in_world {
        true => missions::read(file, &setup.scenario, setup.handed().farthest).map_err(Problem::input)?,
        false => read_about_home(setup, file)?,
    };
    followed(setup, &mission)?;
    Ok(mission)
}

/// `setup` of an arm whose runs are logs: nothing was drawn for them, no controller of ours ran them, and what they do
/// not show between two samples is open.
fn recorded(setup: &Setup, clock: Option<&Set>) -> Result<Setup, Problem> {
    let given = |key: &str, value: Value| (key.to_owned(), value);
    let mut keys = vec![
        given("execute.controller", Value::Null),
        given("execute.control_rate_hz", Value::Null),
        given("execute.timeout_s", Value::Null),
        given("execute.faults", Value::Object(Map::new())),
        given("execute.record", "all".into()),
        // Any name: which log is judged is typed.
        given("execute.logs", "*".into()),
    ];
    keys.extend(clock.map(|(key, word)| given(key, word.trim_matches('"').into())));
    Ok(setup.changed(vary::apply(&setup.scenario, &keys)?)?)
}

fn world(name: &str, origin: Option<&hairpin::campaign::scenario::Origin>) -> Result<NamedWorld, Problem> {
    named_world(name, origin).map_err(|why| Problem::input(format!("--world {name}: {why}")))
}
