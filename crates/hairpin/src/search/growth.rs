//! How partial trajectories of the beam get their scores as they grow: leg by leg, or as a whole.
//!
//! What a sum over legs cannot say: that the second leg undoes the first, that a controller is still swinging. Such a
//! score is of a whole partial trajectory, may be dear, and may have to be refused.
//!
//! The beam calls [`Growth::start`] once, then for each expansion [`Growth::meet`] and as many times
//! [`Growth::extend`], and after each iteration [`Growth::goes_on`].

use super::objective::{Aggregate, LegView, Objective};

/// A partial trajectory to be extended.
///
/// Borrowed from the beam's tree for the time of one expansion.
#[derive(Debug)]
pub struct Parent<'a, M> {
    /// Its score.
    /// As [`Growth::extend`] gave it when it was made.
    pub score: f64,
    /// Its memory.
    /// Of the partial trajectory as a whole, not of its last leg.
    pub memory: &'a M,
    /// Number of its waypoints.
    /// Both its start and its last counted: 1 for the start alone, whose next leg is number 0.
    pub length: usize,
}

/// What scores partial trajectories over nodes `N`. An [`Objective`] does it leg by leg ([`ByLegs`]); what knows a
/// score only of the whole, as executions do, or cannot score all, implements this.
///
/// Order is fixed: [`Growth::meet`] with all legs of a parent, then [`Growth::extend`] for each in the same order; a
/// growth may thereby deal a budget out over them.
///
/// Called on one thread and in an order that settings and graph alone decide, so that an implementation may keep state
/// (a budget, a random stream) and still give the same result in every run.
pub trait Growth<N> {
    /// What is carried along a partial trajectory.
    type Memory: Clone;

    /// Whether a trajectory is complete as soon as it has its length, or once it is the best of the frontier, as in the
    /// paper.
    const AT_ONCE: bool = false;

    /// Score and memory of the trajectory that only stands at its start.
    ///
    /// [`ByLegs`] begins with [`Aggregate::neutral`]: 0 for a sum, −∞ for a maximum.
    fn start(&mut self, node: &N) -> (f64, Self::Memory);

    /// Takes note of all legs that may extend `parent`; they are then scored in this order.
    ///
    /// `legs` are those that remain after revisits and dead ends were left out, in the order in which
    /// [`Growth::extend`] will be called. Does nothing by default.
    fn meet<'l>(&mut self, parent: &Parent<Self::Memory>, legs: impl Iterator<Item = LegView<'l>>) {
        let _ = (parent, legs);
    }

    /// Score and memory of `parent` extended by `leg` to the node `to`; larger is more stressful, NaN does not occur.
    /// `None`: not to be kept.
    fn extend(&mut self, parent: &Parent<Self::Memory>, leg: &LegView<'_>, to: &N) -> Option<(f64, Self::Memory)>;

    /// Whether a graph is searched on, of which `found` trajectories are complete and `wanted` were asked for.
    ///
    /// `wanted` is at least 1. `false` ends the graph as complete where `found` ≥ `wanted`, else as capped.
    fn goes_on(&self, found: usize, wanted: usize) -> bool {
        found < wanted
    }

    /// What each leg is worth at least, as far as is known: 0 or below, and it never rises.
    ///
    /// Partial trajectories of unequal length are compared by what they score above it. A sum of legs that are worth
    /// less than nothing falls as it grows, and the frontier's best would be the shortest: every shorter trajectory
    /// there is would be expanded before one is complete.
    fn least(&self) -> f64 {
        0.0
    }
}

/// The scores of legs, added up.
///
/// What [`super::beam()`] uses. It keeps every leg and never ends by itself.
#[derive(Debug)]
pub struct ByLegs<'a, O> {
    objective: &'a O,
    aggregate: Aggregate,
    least: f64,
}

/// What is taken off a leg that is worth less than all before it, as a multiple of its score: so many records at most
/// change the order of a frontier that may be long.
///
/// In magnitude the least grows by an eighth or more with each record: some twenty records for a power of ten.
const BELOW: f64 = 1.125;

impl<'a, O> ByLegs<'a, O> {
    /// Scores of legs by `objective`, which add up as `aggregate` says.
    pub fn new(objective: &'a O, aggregate: Aggregate) -> Self {
        Self { objective, aggregate, least: 0.0 }
    }
}

impl<N, O: Objective> Growth<N> for ByLegs<'_, O> {
    type Memory = O::Memory;

    fn start(&mut self, _: &N) -> (f64, O::Memory) {
        (self.aggregate.neutral(), self.objective.start())
    }

    fn extend(&mut self, parent: &Parent<O::Memory>, leg: &LegView<'_>, _: &N) -> Option<(f64, O::Memory)> {
        let (score, memory) = self.objective.extend(parent.memory, leg);
        // A maximum never falls as it grows, and what is worthless stays so.
        if self.aggregate == Aggregate::Sum && score < self.least && score.is_finite() {
            self.least = BELOW * score;
        }
        Some((self.aggregate.add(parent.score, score), memory))
    }

    fn least(&self) -> f64 {
        self.least
    }
}

#[cfg(feature = "unit-tests")]
mod tests {
    use nalgebra::Point3;

    use super::super::beam::Ended;
    use super::super::in_loop::{Execute, Executed, PartialSettings, Ran, Rank};
    use super::super::open_end::OpenEnd;
    use super::super::score::Score;
    use super::super::small::{Octahedron, START, enumerate, enumerate_open, points};
    use super::super::task::{Found, Task};
    use super::super::{BeamOutcome, BeamSettings, beam_grown};
    use crate::search::Aggregate;

    const SMALL: Octahedron = Octahedron::WIDE;
    const LENGTH: usize = 6;

    /// How sharply two long legs meet, largest so far: no score of single legs tells it.
    fn hidden(points: &[Point3<f64>], waypoints: &[u32]) -> f64 {
        let at = |k: usize| points[waypoints[k] as usize];
        let corner = |k: usize| {
            (at(k) - at(k - 1)).norm() * (at(k + 1) - at(k)).norm() - (at(k) - at(k - 1)).dot(&(at(k + 1) - at(k)))
        };
        (1..waypoints.len() - 1).map(corner).fold(0.0, f64::max)
    }

    /// Executes by looking; its state is what was executed.
    struct Looking<'a> {
        points: &'a [Point3<f64>],
        resumes: bool,
        legs: u64,
        wholes: Vec<Vec<u32>>,
        /// Trajectories through this waypoint cannot be executed.
        broken: Option<u32>,
        /// Those through this one crash there.
        crashes: Option<u32>,
    }

    impl<'a> Looking<'a> {
        fn new(points: &'a [Point3<f64>], resumes: bool) -> Self {
            Self { points, resumes, legs: 0, wholes: Vec::new(), broken: None, crashes: None }
        }
    }

    impl<N> Execute<N> for &mut Looking<'_> {
        type State = Vec<u32>;

        fn execute(
            &mut self,
            partial: &Found<N>,
            from: Option<(&Vec<u32>, usize)>,
            whole: bool,
        ) -> Result<Ran<Vec<u32>>, u64> {
            let (waypoints, done) = (&partial.waypoints, partial.waypoints.len() - 1);
            assert_eq!((partial.nodes.len(), partial.leg_times.len()), (done + 1, done));
            let before = from.map_or(0, |(state, before)| {
                assert!(self.resumes && *state == waypoints[..=before], "{state:?} does not lead to {waypoints:?}");
                before
            });
            assert!(before < done);
            let legs = (done - before) as u64;
            self.legs += legs;
            if self.broken.is_some_and(|broken| waypoints.contains(&broken)) {
                return Err(legs);
            }
            assert_eq!(whole, waypoints.len() == LENGTH);
            if whole {
                self.wholes.push(waypoints.clone());
            }
            let fails = self.crashes.is_some_and(|crash| waypoints.contains(&crash));
            let state = self.resumes.then(|| waypoints.clone());
            Ok(Ran { stress: hidden(self.points, waypoints), fails, state, legs })
        }
    }

    fn settings(executions: u64, resumes: bool) -> PartialSettings {
        PartialSettings { length: LENGTH, free_end: false, executions, wanted: 1, width: 5, resumes, seed: 3 }
    }

    /// What the beam found, and the largest stress after each execution.
    fn search(
        looking: &mut Looking,
        settings: PartialSettings,
    ) -> (BeamOutcome<crate::feasibility::reach::StepNode>, Vec<f64>) {
        let points = looking.points;
        let task = Task { start: START, candidates: points, reach: &SMALL };
        let beam = BeamSettings { length: LENGTH, per_graph: settings.wanted, keep: None, ..BeamSettings::default() };
        let score = Score::Random { seed: 1 };
        let mut executed = Executed::new(settings, &score, looking);
        let outcome = beam_grown(&task, &mut executed, |node, steps| SMALL.may_arrive(points, node, steps), &beam);
        (outcome, executed.into_best_so_far())
    }

    #[test]
    fn every_budget_is_kept_and_ends_in_an_executed_trajectory_and_a_large_one_in_the_most_stressful() {
        let mut tested = 0;
        for seed in 0..40 {
            let points = points(seed, 11, 11.0);
            let task = Task { start: START, candidates: &points, reach: &SMALL };
            let all = enumerate(&task, &Score::Random { seed }, (LENGTH, false, Aggregate::Sum));
            if !(20..2_000).contains(&all.len()) {
                continue;
            }
            let most = all.iter().map(|(waypoints, _)| hidden(&points, waypoints)).fold(0.0, f64::max);
            for resumes in [true, false] {
                let mut so_far = 0.0;
                for executions in [1, 2, 7, 40, 100_000] {
                    let mut looking = Looking::new(&points, resumes);
                    let (outcome, curve) = search(&mut looking, settings(executions, resumes));
                    let what = format!("seed {seed}, {executions}, {resumes}");
                    assert!(looking.legs <= executions * (LENGTH as u64 - 1), "{what}: {} legs", looking.legs);
                    let best = &outcome.found[0];
                    assert_eq!(best.score, hidden(&points, &best.waypoints), "{what}");
                    for found in &outcome.found {
                        assert!(looking.wholes.contains(&found.waypoints), "{what}");
                        assert!(all.iter().any(|(known, _)| *known == found.waypoints), "{what}");
                    }
                    assert_eq!(curve.len() as u64, looking.legs.div_ceil(LENGTH as u64 - 1), "{what}");
                    assert!(curve.is_sorted() && curve.last() == Some(&best.score), "{what}: {curve:?}");
                    so_far = best.score;
                }
                assert_eq!(so_far, most, "seed {seed}: with executions enough all are executed");
            }
            tested += 1;
        }
        assert!(tested >= 8, "{tested}");
    }

    #[test]
    fn executions_are_kept_back_for_all_that_are_wanted_and_failures_count() {
        let points = points(3, 11, 11.0);
        let mut looking = Looking::new(&points, true);
        let (outcome, _) = search(&mut looking, PartialSettings { wanted: 4, ..settings(4, true) });
        assert!(outcome.found.len() >= 4 && outcome.ended == Ended::Complete, "{outcome:?}");
        assert!(looking.wholes.len() >= 4 && looking.legs <= 20);

        let broken = outcome.found[0].waypoints[2];
        let mut looking = Looking { broken: Some(broken), ..Looking::new(&points, true) };
        let (outcome, _) = search(&mut looking, settings(100, true));
        assert!(outcome.unkept > 0 && outcome.found.iter().all(|found| !found.waypoints.contains(&broken)));
        assert!(!outcome.found.is_empty() && looking.legs <= 500, "{}", looking.legs);
    }

    #[test]
    fn what_crashes_leads_and_the_executions_left_go_to_others() {
        let points = points(3, 11, 11.0);
        let settings = |resumes| PartialSettings { wanted: 2, ..settings(100, resumes) };
        for resumes in [true, false] {
            let (home, largest) = search(&mut Looking::new(&points, resumes), settings(resumes));
            let through = |found: &Found<_>, waypoint: u32| found.waypoints.contains(&waypoint);
            let crash =
                (1..11).rev().find(|crash| !through(&home.found[0], *crash)).expect("it passes no more than six");
            let mut looking = Looking { crashes: Some(crash), ..Looking::new(&points, resumes) };
            let (mut outcome, curve) = search(&mut looking, settings(resumes));
            let of = |found: &Found<_>| Rank::of_score(found.score);
            let crashed = outcome.found.iter().take_while(|found| of(found).fails).count();
            assert!(crashed >= 2 && crashed < outcome.found.len(), "{crashed} of {}", outcome.found.len());
            for (place, found) in outcome.found.iter().enumerate() {
                assert_eq!(through(found, crash), place < crashed);
                assert_eq!(of(found).stress, hidden(&points, &found.waypoints));
            }
            assert!(curve.is_sorted() && largest.is_sorted() && looking.legs <= 500, "{}", looking.legs);
            outcome.found.sort_by(|a, b| of(b).stress.total_cmp(&of(a).stress));
            assert_eq!(curve.last(), Some(&of(&outcome.found[0]).stress), "the curve is of stress");
        }
    }

    #[test]
    fn an_end_that_is_free_costs_nothing() {
        let points = points(5, 9, 11.0);
        let task = Task { start: START, candidates: &points, reach: &SMALL };
        let all = enumerate_open(&task, &Score::Random { seed: 0 }, (LENGTH, false, Aggregate::Sum));
        let most = all.iter().map(|(waypoints, _)| hidden(&points, waypoints)).fold(0.0, f64::max);
        let open = OpenEnd::new(SMALL, &points);
        let objective = Score::Random { seed: 1 };
        let score = open.score(&objective, Aggregate::Sum);
        for executions in [1, 100_000] {
            let mut looking = Looking::new(&points, false);
            let settings = PartialSettings { length: LENGTH + 1, free_end: true, ..settings(executions, false) };
            let beam = BeamSettings { length: LENGTH + 1, keep: None, lookahead: 0, ..BeamSettings::default() };
            let mut executed = Executed::new(settings, &score, &mut looking);
            let outcome = beam_grown(&open.task(START), &mut executed, OpenEnd::<Octahedron>::may_arrive, &beam);
            let legs = executed.legs_executed();
            assert!(legs <= executions * (LENGTH as u64 - 1), "{legs}");
            let best = open.closed(outcome.found[0].clone());
            assert_eq!(best.score, hidden(&points, &best.waypoints));
            assert!(executions == 1 || best.score == most, "{} {most}", best.score);
            assert_eq!(looking.legs, legs);
        }
    }
}
