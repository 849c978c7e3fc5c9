//! The search `worst`: one pool of executions for all cases, over whatever kind of robot.
//!
//! Puts a [`Field`] before [`crate::search::worst`]: plans are those of the kind's solver, executions those of
//! [`Trials`], stresses those of [`targets`]. One pool serves all cases, or, where `[vary]` shapes the plan, one pool
//! each.

use std::sync::{Mutex, PoisonError};

use nalgebra::Point3;
use rayon::prelude::*;

use super::graphs::Graphs;
use super::known::Known;
use super::targets::{Margins, column, targets};
use crate::campaign::answers::{Answers, Executed};
use crate::campaign::counted::Counted;
use crate::campaign::curve::Curve;
use crate::campaign::failures::Failures;
use crate::campaign::graph::{Plan, fingerprint, met};
use crate::campaign::scenario::{UNMEASURED, shapes_the_plan};
use crate::campaign::trial::{Sought, Trials, executed_case};
use crate::campaign::{Batch, Case, Setup, Stop, Tally, Witness};
use crate::math::random::{Stream, named_seed};
use crate::search::in_loop::Trial;
use crate::search::worst::{Field, Ran, Worst, WorstSettings, worst};

/// Runs that the one of the search is chosen among, and random trajectories that they are compared by.
///
/// At most: a scenario with fewer repeats has fewer.
const RUNS: usize = 4;
const SAMPLE: u64 = 6;
/// Number of the first of these: no search draws so many.
/// So that what decides the run is no draw of the search.
const OF_CHOICE: u64 = 1 << 30;

/// A plan, and the graph that it or the first of its ancestors was drawn from.
///
/// The graph goes along with every change: its seeds and its waypoints are where elsewhere-moves come from.
#[derive(Clone)]
pub(super) struct Drawn {
    pub(super) graph: u64,
    pub(super) plan: Plan,
}

/// The plans of one setup.
struct Plans<'a> {
    graphs: &'a Graphs<'a>,
    /// Who executes.
    executor: &'a Counted<'a>,
    stop: &'a Stop<'a>,
    /// Of the first draw: cases that vary draw from graphs of their own.
    first: u64,
    sought: Vec<Sought>,
    /// The run that each is executed as.
    ///
    /// 0 is the nominal run.
    run: usize,
    /// What was executed before the search was stopped.
    known: &'a Answers,
    /// The same with what is executed now.
    all: Mutex<Answers>,
}

impl Field for Plans<'_> {
    type Plan = Drawn;

    fn draw(&self, number: u64) -> Result<Drawn, Option<String>> {
        let graph = self.first + number;
        self.graphs.draw(graph, self.stop).map(|plan| Drawn { graph, plan })
    }

    fn seeds(&self) -> Vec<Drawn> {
        let seeds = self.graphs.solver.seeds(self.stop).into_iter();
        seeds.map(|plan| Drawn { graph: self.first, plan }).collect()
    }

    fn points<'p>(&self, drawn: &'p Drawn) -> &'p [Point3<f64>] {
        &drawn.plan.waypoints
    }

    /// 128 bits of waypoints (of arms of the program), leg times and the velocities with which legs begin: what is told
    /// apart is executed, what is not is one trajectory.
    fn fingerprint(&self, drawn: &Drawn) -> [u8; 16] {
        let Plan { waypoints, witness, leg_times, .. } = &drawn.plan;
        // One way may be planned at other speeds, and velocities at waypoints are another plan to who reads them.
        let times = leg_times.iter().map(|time| Point3::new(*time, 0.0, 0.0));
        let passed = witness.iter().filter_map(Witness::profile).flat_map(|profile| &profile.legs);
        let velocities = passed.map(|leg| leg.derivative(0.0, 1).into());
        fingerprint(met(waypoints, witness.as_ref().and_then(Witness::program)).chain(times).chain(velocities))
    }

    fn moves(&self) -> bool {
        self.graphs.solver.moves() && self.graphs.setup.scenario.search().moves_waypoints()
    }

    fn over(&self, drawn: &Drawn, points: &[Point3<f64>]) -> Option<Drawn> {
        Some(Drawn { plan: self.graphs.solver.over(drawn.graph, &drawn.plan, points)?, ..*drawn })
    }

    fn elsewhere(&self, drawn: &Drawn, random: &mut Stream) -> Option<Point3<f64>> {
        self.graphs.solver.elsewhere(drawn.graph, random)
    }

    fn crossed(&self, drawn: &Drawn, other: &Drawn, leg: usize, random: &mut Stream) -> Option<Drawn> {
        let plan = self.graphs.solver.crossed(drawn.graph, &drawn.plan, &other.plan, leg, random)?;
        Some(Drawn { plan, ..*drawn })
    }

    fn altered(&self, drawn: &Drawn, leg: usize, random: &mut Stream) -> Option<Drawn> {
        Some(Drawn { plan: self.graphs.solver.altered(&drawn.plan, leg, random)?, ..*drawn })
    }

    fn run(&self, drawn: &Drawn, least: &[f64]) -> Option<Ran> {
        self.trials(drawn.graph).execute_for((&drawn.plan, self.run), &self.sought, least)
    }

    /// Both `None`s are told apart: not begun, and failed. What is known from before costs no execution.
    fn run_all(
        &self,
        plans: &[&Drawn],
        least: &[f64],
        stopped: &(dyn Fn() -> bool + Sync),
    ) -> Vec<Option<Option<Ran>>> {
        let names: Vec<[u8; 16]> = plans.iter().map(|drawn| self.fingerprint(drawn)).collect();
        let ran = self.carried_out((&names, self.sought.len()), &|place| {
            if let Some(known) = self.known.of(&names[place]) {
                return Some(known.clone());
            }
            let ran = (!stopped()).then(|| self.run(plans[place], least))?;
            // Who was stopped has failed at nothing.
            (ran.is_some() || !(self.stop.cancelled)()).then_some(ran)
        });
        let mut all = self.all.lock().unwrap_or_else(PoisonError::into_inner);
        for (name, ran) in names.into_iter().zip(&ran) {
            ran.iter().for_each(|ran| all.take(name, ran.clone()));
        }
        ran
    }
}

impl Plans<'_> {
    fn trials(&self, graph: u64) -> Trials<'_> {
        Trials { executor: self.executor, ..self.graphs.trials(graph) }
    }

    /// What whoever executes has of a batch, of which `execute` carries one out, measured by so many targets. What
    /// cannot be an execution's, as files of a stranger's may have it, counts as failed.
    fn carried_out(
        &self,
        (names, targets): (&[[u8; 16]], usize),
        execute: &(dyn Fn(usize) -> Option<Option<Ran>> + Sync),
    ) -> Vec<Option<Option<Ran>>> {
        let most = 1 + self.graphs.setup.scenario.search().confirm;
        let sound = |trial: &Trial| trial.executions <= most && u32::try_from(trial.worst_leg).is_ok();
        let fits = |ran: &Ran| ran.trials.len() == targets && ran.trials.iter().all(sound);
        let execute = |place: usize| Some(execute(place)?.as_ref().map(Executed::from));
        let is_known = |name: &[u8; 16]| self.known.of(name).is_some();
        let answers = self.executor.carry_out_but(&Batch { names, execute: &execute }, &is_known);
        answers.into_iter().map(|answer| Some(answer?.map(Ran::from).filter(fits))).collect()
    }

    /// Chooses the run that trajectories are executed as: the nominal one where nothing is drawn for runs, else of the
    /// first four that of which a few random trajectories bear most, by the first target; the executions that this
    /// took.
    ///
    /// What is executed nominally alone says little where what is drawn decides. All trajectories are executed under
    /// the same draws, so that they are compared by what they are; a twentieth of the executions at most goes to the
    /// choice, and where that is too few the first run with draws is taken.
    fn choose_run(&mut self, executions: u64) -> u64 {
        let setup = self.graphs.setup;
        let runs = (setup.scenario.executor().repeat as usize).min(RUNS);
        if runs < 2 || setup.scenario.vary().keys().all(|key| shapes_the_plan(key)) {
            return 0;
        }
        self.run = 1;
        let most = (executions / (20 * runs as u64)).min(SAMPLE);
        let drawn = (0..most).into_par_iter().filter_map(|number| self.draw(OF_CHOICE + number).ok());
        let drawn: Vec<Drawn> = drawn.collect();
        let pairs: Vec<(usize, &Drawn)> =
            (0..runs).flat_map(|run| drawn.iter().map(move |drawn| (run, drawn))).collect();
        let names: Vec<[u8; 16]> = pairs.iter().map(|(_, drawn)| self.fingerprint(drawn)).collect();
        let ran = self.carried_out((&names, 1), &|place| {
            let (run, Drawn { graph, plan }) = pairs[place];
            Some(self.trials(*graph).execute_for((plan, run), &self.sought[..1], &[f64::INFINITY]))
        });
        let stress = |ran: Option<Option<Ran>>| ran.flatten().map_or(f64::NAN, |ran| ran.trials[0].stress);
        let stresses: Vec<(usize, f64)> = pairs.iter().zip(ran).map(|((run, _), ran)| (*run, stress(ran))).collect();
        let mean = |run: usize| {
            let of_run =
                || stresses.iter().filter(|(of, stress)| *of == run && stress.is_finite()).map(|(_, stress)| stress);
            of_run().sum::<f64>() / of_run().count().max(1) as f64
        };
        if !drawn.is_empty() {
            self.run = (0..runs).max_by(|a, b| mean(*a).total_cmp(&mean(*b)).then(b.cmp(a))).unwrap_or(1);
        }
        stresses.len() as u64
    }
}

/// What one pool of executions found.
///
/// `curve` counts every execution, those of the choice of the run included.
pub(super) struct Pool {
    /// The most stressful first.
    pub(super) plans: Vec<Drawn>,
    pub(super) curve: Curve,
    pub(super) drawn: u64,
    /// The run that each was executed as.
    pub(super) run: usize,
    /// On the search's own scale, 0 … about 1.
    pub(super) apart: f64,
    pub(super) nothing: Option<String>,
    /// What was executed, for a search that goes on.
    pub(super) answers: Answers,
    /// Executions that failed: of the choice of the run, which whoever goes on makes anew, and of the search.
    failed: [Failures; 2],
}

impl Pool {
    /// All executions that failed.
    pub(super) fn failures(&self) -> Failures {
        let [mut all, searched] = self.failed.clone();
        all.add(searched);
        all
    }
}

/// The worst `cases` of `graphs` in so many executions, drawn from graph number `first` on; what is `known` is not
/// executed again.
///
/// `executions` bounds the counts; a time (`SearchSection::seconds`) takes its place where the scenario has one, and
/// the rounds keep the size that `executions` give them. Scores of plans are their stresses, or margins in spreads
/// where there are several targets.
pub(super) fn pool(graphs: &Graphs, cases: usize, [executions, first]: [u64; 2], known: &Answers, stop: &Stop) -> Pool {
    let search = graphs.setup.scenario.search();
    let seed = named_seed(graphs.setup.scenario.seed(), "worst", first);
    let targets = targets(graphs.setup);
    let begun = (stop.clock)();
    let late = || search.seconds.is_some_and(|seconds| (stop.clock)() - begun >= seconds);
    let told = |made: u64| (stop.progress)(made as usize, executions as usize);
    let sought = targets.iter().map(|target| target.sought).collect();
    let executor = &Counted::new(graphs.executor, stop.cancelled);
    let mut plans = Plans { graphs, executor, stop, first, sought, run: 0, known, all: Mutex::new(known.clone()) };
    let tried = plans.choose_run(executions);
    let of_choice = executor.take();
    let per_trial = 1 + search.confirm;
    let sized_for = executions.saturating_sub(tried);
    let settings = WorstSettings {
        cases,
        targets: targets.len(),
        // A time is a budget of its own.
        executions: if search.seconds.is_some() { u64::MAX } else { sized_for },
        sized_for,
        per_trial,
        seed,
    };
    let Worst { found, stresses, first: drawn_first, drawn, apart, nothing } =
        worst(&plans, &settings, &|| (stop.cancelled)() || late(), &told);
    let mut curve = Curve { graph: first, executions: tried, ..Curve::default() };
    let margins = Margins::of(&targets, &stresses[..stresses.len().min(drawn_first as usize)]);
    stresses.iter().for_each(|stresses| curve.push(stresses.as_ref().and_then(|stresses| margins.most(stresses))));
    let run = plans.run;
    let answers = plans.all.into_inner().unwrap_or_else(PoisonError::into_inner);
    let plans = found.into_iter().map(|found| {
        let Drawn { graph, plan } = found.plan;
        let score = margins.told(found.target, found.trial.rank().told());
        let plan = graphs.solver.finished(Plan { score, bound: None, ..plan });
        Drawn { graph, plan }
    });
    Pool { plans: plans.collect(), curve, drawn, run, apart, nothing, answers, failed: [of_choice, executor.take()] }
}

/// The cases that a scenario asks for, from one pool of executions; those of `known`, if it has all of them.
///
/// Interrupted, its cases are its best so far, and the tally keeps what was executed, by fingerprints: going on
/// executes nothing twice and comes to the same answer.
pub(super) fn generate(graphs: &Graphs, known: &Known, stop: &Stop, sink: &mut dyn FnMut(&[Case], &Tally)) -> Tally {
    if known.tally.units > 0 {
        sink(&[], &known.tally);
        return known.tally.clone();
    }
    let setup: &Setup = graphs.setup;
    let search = setup.scenario.search();
    let before = known.tally.answers.as_deref().cloned().unwrap_or_default();
    let executions = [setup.scenario.searched_executions(), 0];
    let found = pool(graphs, search.cases as usize, executions, &before, stop);
    let stopped = (stop.cancelled)();
    let mut failures = known.tally.failures.clone();
    // What the run is chosen by is executed again by whoever goes on, and counted then.
    failures.add(if stopped { found.failed[1].clone() } else { found.failures() });
    let Pool { plans, curve, drawn, run, apart, nothing, answers, .. } = found;
    let nothing = if plans.is_empty() && curve.executions > 0 { Some(UNMEASURED.into()) } else { nothing };
    let mut tally = Tally {
        units: 1,
        graphs: drawn,
        solved: u64::from(!plans.is_empty()),
        expansions: curve.executions,
        complete: plans.len() as u64 >= search.cases,
        stopped,
        drawn,
        run: run as u64,
        sampler: Some(graphs.solver.drawn_how().into()),
        apart: Some(apart),
        failures,
        nothing,
        told_in: Some(column(setup)),
        ..Tally::default()
    };
    tally.complete &= !tally.stopped;
    if tally.stopped {
        tally.answers = Some(Box::new(answers));
    }
    tally.curves.push(curve);
    let case =
        |(number, Drawn { graph, plan }): (usize, Drawn)| executed_case(setup, graphs.executor, plan, (graph, number));
    let cases: Vec<Case> = plans.into_iter().enumerate().map(case).collect();
    sink(&cases, &tally);
    tally
}
