//! Many queries on flat and on rough ground: solved, replayed, and held against stored solutions.

use std::time::Instant;

use hairpin::campaign::drive::{drive_piece, flat_claim, replay_flat};
use hairpin::campaign::states::States;
use hairpin::feasibility::steering::shooting::solve::{Choices, Outcome, solve};
use hairpin::robot::rover::Rover;
use hairpin::trajectory::drive::Planar;
use hairpin::verification::trace_drive;
use hairpin_formats::steering::Status;
use hairpin_jobs::Problem;
use hairpin_jobs::steer::{Rows, Vehicle};

use super::check::{Check, Test, percent};
use super::store;
use super::subject::{Subject, asked, flat_queries};
use crate::drives::{MET, keeps};

/// States of a path closer than this are the same, m and rad.
const SAME: f64 = 1e-6;
/// The source's bound of the share of queries on rough ground, %.
const ROUGH_SHARE: f64 = 99.0;
/// The source's bound of the mean time on rough ground, ms.
pub(crate) const MEAN_MS: f64 = 100.0;

/// What came of many queries.
#[derive(Debug, Clone, Default)]
pub(super) struct Tally {
    pub(super) asked: usize,
    /// Controls and a path of states came back.
    pub(super) paths: usize,
    /// No drive came back, but what stands in the way.
    pub(super) told: usize,
    /// The replay meets the goal within [`MET`] and keeps the bounds.
    pub(super) met: usize,
    /// Time of solving each, on the wall's clock, s.
    pub(super) seconds: Vec<f64>,
    /// Largest errors of those that are met: m, rad, 1/m.
    pub(super) worst: [f64; 3],
}

impl Tally {
    fn count(&mut self, errors: [f64; 3], kept: bool) {
        if kept && errors.iter().all(|error| *error <= MET) {
            self.met += 1;
            for (worst, error) in self.worst.iter_mut().zip(errors) {
                *worst = worst.max(error);
            }
        }
    }

    pub(super) fn share(&self) -> f64 {
        percent(self.met, self.asked)
    }

    pub(super) fn mean_ms(&self) -> f64 {
        1e3 * self.seconds.iter().sum::<f64>() / self.asked.max(1) as f64
    }

    /// The time that at least 99 of a hundred queries keep: the ⌈0.99 n⌉-th of n by size.
    pub(super) fn p99_ms(&self) -> f64 {
        let mut seconds = self.seconds.clone();
        seconds.sort_by(f64::total_cmp);
        let rank = (99 * seconds.len()).div_ceil(100);
        1e3 * rank.checked_sub(1).map_or(f64::NAN, |index| seconds[index])
    }

    /// Both, as they are told.
    pub(super) fn times(&self) -> String {
        format!("{:.3} ms in the mean (p99 {:.3} ms)", self.mean_ms(), self.p99_ms())
    }
}

/// How long the queries of one family took, on the wall's clock.
#[derive(Debug, Clone)]
pub(crate) struct Times {
    /// Vehicle and ground.
    pub(crate) of: &'static str,
    /// s, a query each.
    pub(crate) seconds: Vec<f64>,
}

/// R1 … R3.
pub(super) fn flat(subject: &Subject) -> Result<([Test; 3], Times), Problem> {
    let bounds = subject.bounds();
    let (mut tally, mut agree) = (Tally::default(), 0);
    for (query, reversals) in flat_queries(&bounds, subject.queries, 31) {
        tally.asked += 1;
        let choices = Choices { reversals, ..Choices::default() };
        let begun = Instant::now();
        let solution = solve(&query, &bounds, &choices, || false);
        tally.seconds.push(begun.elapsed().as_secs_f64());
        let replay = replay_flat(&query, 0.0, &solution.segments);
        let [x, y, yaw] = replay.error;
        let kept = solution.outcome == Outcome::Solved && keeps(&replay, &bounds);
        tally.count([libm::hypot(x, y), yaw.abs(), replay.error_curvature.abs()], kept);
        // The path, as it is drawn, against the end of the controls, as they are replayed.
        let pieces: Vec<_> = solution.segments.iter().map(drive_piece).collect();
        let path: Vec<[f64; 3]> =
            trace_drive(&pieces, &flat_claim(&query, 0.0)).into_iter().flat_map(|(_, poses)| poses).collect();
        if let (Some(first), Some(last)) = (path.first(), path.last()) {
            tally.paths += usize::from(path.iter().flatten().all(|value| value.is_finite()));
            let goal = &query.goal;
            let near = libm::hypot(last[0] - goal.x - x, last[1] - goal.y - y) < SAME;
            agree += usize::from(near && first.iter().all(|value| value.abs() < SAME));
        }
    }
    let stored = store::compare(subject, store::FLAT)?;
    let &Tally { asked, paths, met, worst, .. } = &tally;
    let interface = Check::new(
        format!("{paths} of {asked} with controls and a path of states, {:.2} % converged", tally.share()),
        "all",
        paths == asked,
    );
    let convergence = Check::new(
        format!(
            "{met} of {asked} ({:.2} %) by replay, {:.1} µs each (p99 {:.1} µs); largest errors {:.1e} m, {:.1e} rad, {:.1e} 1/m",
            tally.share(),
            1e3 * tally.mean_ms(),
            1e3 * tally.p99_ms(),
            worst[0],
            worst[1],
            worst[2]
        ),
        "100 %",
        met == asked,
    );
    let right = Check::new(
        format!("{agree} of {asked} paths go from the start to where the controls end; {}", stored.words()),
        "all, and none worse",
        agree == asked && stored.good(),
    );
    let tests = [
        Test::new("R1", "R-1", "flat ground: the interface, and how many converge", interface),
        Test::new(
            "R2",
            "R-3",
            "flat ground: ends of smooth curves, and goals anywhere with reversals, converge",
            convergence,
        ),
        Test::new(
            "R3",
            "R-8",
            "flat ground: controls and path are the right ones, and as good as the stored ones",
            right,
        ),
    ];
    Ok((tests, Times { of: "generic, flat ground", seconds: tally.seconds }))
}

/// Solves `goals` with `rover` on the rough ground and replays every answer, as `hairpin steer` does.
pub(super) fn on_the_ground(subject: &Subject, rover: &Rover, goals: &[(Planar, Planar)]) -> Tally {
    let vehicle = Vehicle::on(rover.clone(), Some(subject.ground.clone()), None);
    let mut tally = Tally { asked: goals.len(), ..Tally::default() };
    for (start, goal) in goals {
        let question = asked(start, goal);
        let answered = vehicle.answer(&question);
        tally.seconds.push(answered.solving.as_secs_f64());
        let Some((_, replay)) = &answered.drive else {
            tally.told += usize::from(answered.limit.is_some());
            continue;
        };
        let path = vehicle.follow(&question, &answered, Rows::Few);
        let finite = |states: States| states.states.iter().all(|state| state.at.x.is_finite());
        tally.paths += usize::from(path.is_some_and(finite));
        let [x, y, yaw] = replay.error;
        let errors = [libm::hypot(x, y), yaw.abs(), replay.error_curvature.abs()];
        tally.count(errors, answered.status == Status::Ok);
    }
    tally
}

/// R4 … R6.
pub(super) fn rough(subject: &Subject) -> Result<([Test; 3], [Times; 2]), Problem> {
    let six = on_the_ground(subject, &subject.rocky8, &subject.goals(&subject.rocky8, subject.queries, 32)?);
    let few = (subject.queries / 4).max(20);
    let point = on_the_ground(subject, &subject.generic, &subject.goals(&subject.generic, few, 33)?);
    let stored = store::compare(subject, store::ROUGH)?;
    let (paths, told, asked) = (six.paths + point.paths, six.told + point.told, six.asked + point.asked);
    let interface = Check::new(
        format!(
            "{paths} of {asked} with controls and a path of states, {told} with what stands in the way; {}",
            stored.words()
        ),
        "all, and none worse",
        paths == asked && stored.good(),
    );
    let converged = |tally: &Tally| format!("{} of {} ({:.2} %)", tally.met, tally.asked, tally.share());
    let convergence = Check::new(
        format!(
            "rocky8 {}, generic {} by replay; largest errors {:.1e} m, {:.1e} rad, {:.1e} 1/m",
            converged(&six),
            converged(&point),
            six.worst[0],
            six.worst[1],
            six.worst[2]
        ),
        format!("≥ {ROUGH_SHARE} %"),
        six.share() >= ROUGH_SHARE && point.share() >= ROUGH_SHARE,
    );
    let time = Check::new(
        format!("rocky8 {}, generic {}", six.times(), point.times()),
        format!("mean < {MEAN_MS} ms"),
        six.mean_ms() < MEAN_MS && point.mean_ms() < MEAN_MS,
    );
    let tests = [
        Test::new("R4", "R-1", "rough ground: the interface, and as good as the stored solutions", interface),
        Test::new(
            "R5",
            "R-4",
            "rough ground: goals that were driven to are met within 0.01 m, rad and 1/m",
            convergence,
        ),
        Test::new("R6", "R-5", "rough ground: time of a query, on the wall's clock", time),
    ];
    let times = [
        Times { of: "rocky8, rough ground", seconds: six.seconds },
        Times { of: "generic, rough ground", seconds: point.seconds },
    ];
    Ok((tests, times))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ninety_nine_of_a_hundred_keep_the_percentile() {
        let of = |count: usize| {
            // From slow to fast: times are told whatever their order.
            let seconds = (1..=count).rev().map(|i| 1e-3 * i as f64).collect();
            Tally { asked: count, seconds, ..Tally::default() }
        };
        for (count, expected) in [(1, 1.0), (99, 99.0), (100, 99.0), (1000, 990.0)] {
            assert!((of(count).p99_ms() - expected).abs() < 1e-9, "{count}: {}", of(count).p99_ms());
        }
        assert!((of(100).mean_ms() - 50.5).abs() < 1e-9 && of(0).p99_ms().is_nan());
    }
}
