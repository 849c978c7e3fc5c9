//! The ways to generate that are compared.

use hairpin::search::{Aggregate, Score};

use super::super::cell::{self, Set, text};
use super::kinds::WayKind;
use super::size::{Graphs, Size};

/// A way to generate: its name, the kind that it counts among, and what finds its cases.
pub(super) struct Way {
    pub(super) name: String,
    pub(super) kind: WayKind,
    pub(super) finds: Finds,
    pub(super) learned: bool,
}

/// What finds the cases of a way.
pub(super) enum Finds {
    /// The scenario with these keys.
    Keys(Vec<Set>),
    /// The optimum in every graph of one of the scores by hand, by its place among them, or of the learned one.
    Optimum { score: usize, aggregate: Aggregate },
}

/// The names of the scores by hand.
pub(super) fn by_hand() -> Vec<&'static str> {
    Score::by_hand().collect()
}

/// The ways of `size` in `graphs`, the two baselines first.
pub(super) fn ways(size: &Size, graphs: &Graphs) -> Vec<Way> {
    let way = |name: &str, kind, method: &str, sets: &[Set]| {
        let mut all = vec![("generate.search.method", text(method))];
        all.extend_from_slice(sets);
        if kind != WayKind::Baseline {
            all.push(sampling(graphs));
        }
        let learned = matches!(kind, WayKind::InLoopLearned | WayKind::MovedLearned);
        Way { name: name.to_owned(), kind, finds: Finds::Keys(all), learned }
    };
    let mut ways = vec![
        way("uniform", WayKind::Baseline, "uniform", &[]),
        way("random beam", WayKind::Baseline, "beam", &[("generate.score", text("random"))]),
    ];
    for (word, aggregate) in [("sum", Aggregate::Sum), ("max", Aggregate::Max)] {
        let optimum = |name: &str, kind, score| {
            let finds = Finds::Optimum { score, aggregate };
            Way { name: format!("{name}, {word}"), kind, finds, learned: kind == WayKind::Learned }
        };
        let by_hand = by_hand().into_iter().enumerate();
        ways.extend(by_hand.map(|(score, name)| optimum(name, WayKind::ByHand, score)));
        ways.push(optimum("learned", WayKind::Learned, 0));
    }
    let in_loop = |name: &str, executions: u64, kinds: [WayKind; 2], sets: &[Set]| {
        let mut all = vec![("generate.search.executions", executions.to_string())];
        all.extend_from_slice(sets);
        let name = format!("{name}, {executions}");
        [way(&name, kinds[0], "in-loop", &all), way(&format!("{name}, from the learned"), kinds[1], "in-loop", &all)]
    };
    ways.extend(in_loop("in the loop", size.executions, [WayKind::InLoop, WayKind::InLoopLearned], &[]));
    let moved = [
        ("generate.search.move_waypoints", "true".into()),
        ("generate.search.confirm", size.confirm_moved.to_string()),
    ];
    let kinds = [WayKind::Moved, WayKind::MovedLearned];
    ways.extend(in_loop("in the loop and moved", size.executions_moved, kinds, &moved));
    ways.retain(|way| way.kind == WayKind::Baseline || size.kinds.contains(&way.kind));
    ways
}

/// How waypoints are spread that are searched and learned from.
pub(super) fn sampling(graphs: &Graphs) -> Set {
    ("generate.search.sampling", text(&graphs.sampling))
}

/// The keys of all cells of a feasible set and a controller.
pub(super) fn base(size: &Size, graphs: &Graphs, controller: &str) -> Vec<Set> {
    vec![
        ("seed", size.seed.to_string()),
        ("task.length", size.length.to_string()),
        ("generate.reach", text(&graphs.reach)),
        cell::resolution(&graphs.reach),
        ("generate.search.cases", size.graphs.to_string()),
        ("generate.search.waypoints", graphs.waypoints.to_string()),
        ("execute.controller", text(controller)),
        ("execute.segment_times", text("sqrt-length")),
        ("spec.deviation.from", text(&size.from)),
    ]
}
