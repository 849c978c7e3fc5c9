//! The worst trajectories that differ: what a search keeps of all that it has executed.
//!
//! Clearing: in the order of stress, each trajectory stands that is far enough from all that stand before it. Those
//! that stand are the answer, the first as many as are asked for, and the parents of what is tried next. Source:
//! Pétrowski, A clearing procedure as a niching method for genetic algorithms, 1996.
//!
//! An archive for each target, and one of what fails. What fails is worse than any stress, and often strays less than
//! what is flown to its end, as it ends early: in one order of both the first would leave no place for the second.

use super::scale::{Placed, Scale, Trace};
use crate::search::in_loop::Trial;

/// What an archive keeps the worst of.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Aim {
    /// What fails, by its stress for the first target.
    Failures,
    /// What a target measures, whether it fails or not: an index into [`Ran::trials`](super::Ran::trials).
    Target(usize),
}

impl Aim {
    /// The one of failures, and those of so many targets.
    pub(super) fn all(targets: usize) -> impl Iterator<Item = Aim> {
        std::iter::once(Aim::Failures).chain((0..targets).map(Aim::Target))
    }

    /// The target that its stresses are of.
    pub(super) fn target(self) -> usize {
        match self {
            Aim::Failures => 0,
            Aim::Target(target) => target,
        }
    }

    /// What an execution comes to for it; `None` where that is nothing.
    pub(super) fn of(self, trials: &[Trial]) -> Option<Trial> {
        let trial = trials[self.target()];
        let counts = trial.fails || self != Aim::Failures;
        (counts && !trial.stress.is_nan()).then_some(trial)
    }
}

/// An executed trajectory.
///
/// `placed` is computed once, as it is compared with every other member each time that standing is settled anew.
#[derive(Debug, Clone)]
pub(super) struct Member<P> {
    pub(super) plan: P,
    pub(super) trial: Trial,
    pub(super) placed: Placed,
    /// Step of its moved waypoints, as a share of its mean leg.
    pub(super) step: f64,
    /// Its number among all that were executed.
    /// It names the member when ranks are asked; it is the index of its first execution.
    pub(super) number: u64,
}

/// Executed trajectories in the order of their stresses, of which some stand.
///
/// Invariant after [`Archive::take`]: `members` falls in stress, `standing` rises, any two standing
/// [`Archive::differ`], and every member before the last standing one that does not stand is nearer than `apart` to
/// one that stands before it.
pub(super) struct Archive<P> {
    pub(super) aim: Aim,
    /// The most stressful first, the first of equals first.
    members: Vec<Member<P>>,
    /// Places of those that stand, rising.
    standing: Vec<usize>,
    scale: Scale,
    /// How far apart those that stand are at least.
    apart: f64,
    /// How many stand at most.
    most: usize,
    /// How many are kept for each that may stand: what steps up where one falls.
    /// 8: a member falls when a more stressful one comes near it, and with it the members that it held down may rise.
    spare: usize,
}

impl<P> Archive<P> {
    /// For `aim`, of `most` trajectories at most that stand `apart` by `scale`.
    ///
    /// `apart` is in the units of [`Scale::apart`]; `most` of 0 is taken as 1.
    pub(super) fn new(aim: Aim, scale: Scale, apart: f64, most: usize) -> Self {
        Self { aim, members: Vec::new(), standing: Vec::new(), scale, apart, most: most.max(1), spare: 8 }
    }

    /// Whether two trajectories are far enough apart to stand both.
    ///
    /// Distance ≥ `apart`, and above 0 also where `apart` is 0: two equal traces are never two cases.
    pub(super) fn differ(&self, one: &Placed, other: &Placed) -> bool {
        let apart = self.scale.apart(one, other);
        apart >= self.apart && apart > 0.0
    }

    /// Takes `new` over; who stands afterwards is [`Self::standing`].
    ///
    /// In the order of `new`, which decides among equal stresses: the earlier one leads. Stresses must be numbers;
    /// `offer` has sorted out those that are not.
    pub(super) fn take(&mut self, new: Vec<Member<P>>) {
        for member in new {
            let place = self.members.partition_point(|known| known.trial.stress >= member.trial.stress);
            self.members.insert(place, member);
        }
        self.clear();
        self.forget();
    }

    /// Those that stand, the most stressful first.
    pub(super) fn standing(&self) -> impl ExactSizeIterator<Item = &Member<P>> {
        self.standing.iter().map(|place| &self.members[*place])
    }

    /// Where what was executed stands on the archive's scale.
    pub(super) fn place(&self, trace: &Trace) -> Placed {
        self.scale.place(trace)
    }

    /// The place of execution number `number` among those that stand.
    ///
    /// 0 is the most stressful. `None` where it fell, was held down by a near one, or was forgotten.
    pub(super) fn rank(&self, number: u64) -> Option<usize> {
        self.standing().position(|member| member.number == number)
    }

    /// How many stand.
    pub(super) fn len(&self) -> usize {
        self.standing.len()
    }

    /// The stress of number `count` of those that stand, counted from 1; −∞ where fewer do.
    ///
    /// What an execution has to come to in order to be of use: [`Field::run`](super::Field::run) is told it. −∞ for a
    /// `count` of 0.
    pub(super) fn least(&self, count: usize) -> f64 {
        count
            .checked_sub(1)
            .and_then(|last| self.standing.get(last))
            .map_or(f64::NEG_INFINITY, |place| self.members[*place].trial.stress)
    }

    /// Settles who stands: greedily in the order of stress. O(members · standing) distances.
    fn clear(&mut self) {
        let mut standing: Vec<usize> = Vec::with_capacity(self.most);
        for (place, member) in self.members.iter().enumerate() {
            if standing.len() == self.most {
                break;
            }
            if standing.iter().all(|other| self.differ(&member.placed, &self.members[*other].placed)) {
                standing.push(place);
            }
        }
        self.standing = standing;
    }

    /// Forgets the least stressful of those that do not stand, beyond what may ever step up.
    fn forget(&mut self) {
        let most = self.most * self.spare;
        if self.members.len() <= most {
            return;
        }
        let mut standing = self.standing.iter().copied().peekable();
        let mut places = Vec::with_capacity(self.standing.len());
        let (mut kept, mut place) = (Vec::with_capacity(most + self.most), 0);
        for (at, member) in std::mem::take(&mut self.members).into_iter().enumerate() {
            let stands = standing.next_if_eq(&at).is_some();
            if stands {
                places.push(place);
            }
            if stands || at < most {
                kept.push(member);
                place += 1;
            }
        }
        (self.members, self.standing) = (kept, places);
    }
}

#[cfg(feature = "unit-tests")]
mod tests {
    use nalgebra::Point3;

    use super::*;
    use crate::trajectory::Route;

    fn trace(x: f64) -> Trace {
        Trace { route: Route::along(&[Point3::origin(), Point3::new(x, 0.0, 0.0)]), behaviour: Vec::new() }
    }

    fn scale() -> Scale {
        Scale::of(&[trace(0.0), trace(10.0)])
    }

    fn member(x: f64, stress: f64) -> Member<f64> {
        let trial = Trial { stress, fails: false, worst_leg: 0, executions: 1 };
        Member { plan: x, trial, placed: scale().place(&trace(x)), step: 0.1, number: 0 }
    }

    fn plans(archive: &Archive<f64>) -> Vec<f64> {
        archive.standing().map(|member| member.plan).collect()
    }

    #[test]
    fn near_copies_of_the_worst_do_not_stand_and_step_up_where_it_falls() {
        let mut archive = Archive::new(Aim::Target(0), scale(), 0.2, 3);
        archive.take(vec![member(5.0, 1.0), member(5.5, 2.0), member(9.0, 0.5), member(1.0, 0.1), member(0.0, 0.2)]);
        assert_eq!(plans(&archive), [5.5, 9.0, 0.0]);
        assert_eq!([archive.least(1), archive.least(3), archive.least(4)], [2.0, 0.2, f64::NEG_INFINITY]);
        // One beside two that stand replaces both, and what they kept away steps up.
        archive.take(vec![member(7.3, 3.0)]);
        assert_eq!(plans(&archive), [7.3, 5.0, 0.0]);
    }

    #[test]
    fn an_aim_takes_what_it_measures_and_that_of_failures_what_fails() {
        let trial = |stress, fails| Trial { stress, fails, worst_leg: 0, executions: 1 };
        let of = |trials: &[Trial]| Aim::all(2).map(|aim| aim.of(trials).map(|trial| trial.stress)).collect::<Vec<_>>();
        assert_eq!(of(&[trial(1.0, false), trial(2.0, false)]), [None, Some(1.0), Some(2.0)]);
        assert_eq!(of(&[trial(1.0, true), trial(f64::NAN, true)]), [Some(1.0), Some(1.0), None]);
        let unmeasured = f64::NEG_INFINITY;
        assert_eq!(of(&[trial(unmeasured, true), trial(2.0, true)]), [Some(unmeasured), Some(unmeasured), Some(2.0)]);
    }

    #[test]
    fn what_stands_is_never_forgotten() {
        let mut archive = Archive::new(Aim::Target(0), scale(), 0.2, 2);
        archive.take(vec![member(9.0, 1.0)]);
        archive.take((0..100).map(|i| member(1.0 + 1e-3 * f64::from(i), 2.0 + f64::from(i))).collect());
        assert_eq!((plans(&archive)[1], archive.members.len()), (9.0, 17));
    }
}
