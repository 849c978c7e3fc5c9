//! What a round has chosen is executed, and taken over in order.

use super::{Campaign, Origin, Todo};
use crate::campaign::answers::{Answer, Executed};
use crate::campaign::graph::{Plan, fingerprint};
use crate::campaign::learn::LegSample;
use crate::campaign::trial::Trials;
use crate::campaign::{Batch, Executor, RoundTally};
use crate::search::in_loop::{Rank, Trial};

/// What an execution came to, and the legs that its stress was measured on.
type Learned = (Rank, Vec<LegSample>);

impl Campaign<'_> {
    /// Executes `todo` in part `part` of round `number`; stresses are added to `sums`, by origin.
    ///
    /// `sums` holds (Σ stress, count) for [`Origin`] in its order. What failed counts as an execution and is never
    /// tried again; what was not begun is neither.
    pub(super) fn execute(
        &mut self,
        (number, part): (u64, u64),
        todo: Vec<Todo>,
        told: &mut RoundTally,
        sums: &mut [(f64, u64); 3],
    ) {
        let results = self.carried_out((number, part), &todo);
        self.executed += results.len() as u64;
        for (Todo { graph, plan, origin }, result) in todo.into_iter().zip(results) {
            let Some(result) = result else { continue };
            told.executions += 1;
            told.drawn += u64::from(origin == Origin::Drawn);
            told.by_hand += u64::from(origin == Origin::ByHand);
            let graph = &mut self.graphs[graph];
            graph.known.insert(fingerprint(plan.waypoints.iter().copied()));
            graph.curve.push(result.as_ref().map(|(rank, _)| rank.stress));
            let Some((rank, samples)) = result else {
                told.failed += 1;
                continue;
            };
            if rank.stress.is_finite() {
                let (sum, count) = &mut sums[origin as usize];
                (*sum, *count) = (*sum + rank.stress, *count + 1);
            }
            self.samples.extend(samples);
            let place = graph.kept.partition_point(|(kept, _)| *kept >= rank);
            graph.kept.insert(place, (rank, Plan { score: rank.told(), bound: None, ..plan }));
            graph.kept.truncate(self.search.per_graph as usize);
        }
    }

    /// What each of `todo` came to: its stress, and those of its legs to learn from. What is not begun in time does not
    /// count.
    ///
    /// One entry for each of `todo`: `None` not begun, `Some(None)` came to no run or, where nothing fails, to no
    /// finite stress. Names are fingerprints of the waypoints, by which an executor may know an earlier answer.
    fn carried_out(&self, (number, part): (u64, u64), todo: &[Todo]) -> Vec<Option<Option<Learned>>> {
        let names: Vec<[u8; 16]> = todo.iter().map(|todo| fingerprint(todo.plan.waypoints.iter().copied())).collect();
        let trials =
            |todo: &Todo| Trials { executor: self.executor, ..self.sampled.trials(self.graphs[todo.graph].number) };
        let execute = |place: usize| {
            let todo = &todo[place];
            let answer = |(Trial { stress, fails, worst_leg, executions }, behaviour)| Executed {
                trials: vec![(stress, worst_leg, executions)],
                behaviour,
                fails,
            };
            self.begins(number, part).then(|| trials(todo).execute_legs(&todo.plan).map(answer))
        };
        let answers = self.executor.carry_out(&Batch { names: &names, execute: &execute });
        let learned = |place: usize, answer: Answer| {
            let Executed { trials: stresses, behaviour, fails } = answer?;
            let (stress, ..) = stresses.first().copied()?;
            let rank = Rank::of(fails, Some(stress));
            if rank.stress.is_nan() {
                return None;
            }
            let trajectory = self.executed as usize + place;
            Some((rank, trials(&todo[place]).learned(&todo[place].plan, &behaviour, trajectory)))
        };
        answers.into_iter().enumerate().map(|(place, answer)| answer.map(|answer| learned(place, answer))).collect()
    }
}
