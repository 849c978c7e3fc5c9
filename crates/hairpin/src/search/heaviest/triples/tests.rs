//! Ways that must agree: enumeration, subsets, and what annealing finds under the bound.

use rand::Rng;

use super::*;
use crate::math::random::{Stream, stream, unit};
use crate::search::heaviest::{Arcs, Ends, HeaviestSettings, Method, Outcome, heaviest};

fn below(bound: u64, random: &mut Stream) -> u64 {
    random.next_u64() % bound
}

/// A random question of up to `most` points: sparse to dense arcs and triples, directed or not, fixed ends or free
/// ones.
fn question(seed: u64, most: u64) -> (Arcs, Triples, Ends) {
    let mut random = stream(seed);
    let n = 1 + below(most, &mut random) as usize;
    let (arcs, bends) =
        ([0.2, 0.5, 1.0][below(3, &mut random) as usize], [0.0, 0.2, 0.9][below(3, &mut random) as usize]);
    let (top, directed) = ([2, 10, 1_000_000][below(3, &mut random) as usize], unit(&mut random) < 0.5);
    let mut costs = vec![None; n * n];
    let mut moves = Vec::new();
    for i in 0..n {
        for j in (0..n).filter(|&j| if directed { j != i } else { j > i }) {
            let both = |from: usize, to: usize| if directed { vec![(from, to)] } else { vec![(from, to), (to, from)] };
            if unit(&mut random) < arcs {
                let cost = below(top, &mut random) as i64;
                both(i, j).into_iter().for_each(|(from, to)| costs[from * n + to] = Some(cost));
            }
            for via in (0..n).filter(|&via| via != i && via != j) {
                if unit(&mut random) < bends {
                    let cost = below(3 * top, &mut random) as i64;
                    moves.extend(both(i, j).into_iter().map(|(from, to)| ([from, via, to], cost)));
                }
            }
        }
    }
    let mut end = || (unit(&mut random) < 0.3).then(|| below(n as u64, &mut random) as usize);
    let ends = Ends { start: end(), end: end() };
    (Arcs::new(n, &costs).unwrap(), Triples::new(n, &moves).unwrap(), ends)
}

/// Every order of points that has a way, with the most that it costs over all its cuts into arcs and triples.
fn enumerate(arcs: &Arcs, triples: &Triples, ends: Ends) -> Vec<(i64, Vec<usize>)> {
    fn cuts(arcs: &Arcs, triples: &Triples, order: &[usize]) -> Option<i64> {
        let [first, rest @ ..] = order else { return None };
        if rest.is_empty() {
            return Some(0);
        }
        let straight = arcs.cost(*first, rest[0]).and_then(|cost| Some(cost + cuts(arcs, triples, rest)?));
        let through = (rest.len() > 1)
            .then(|| triples.cost(*first, rest[0], rest[1]))
            .flatten()
            .and_then(|cost| Some(cost + cuts(arcs, triples, &rest[1..])?));
        straight.max(through)
    }
    fn go(n: usize, order: &mut Vec<usize>, see: &mut dyn FnMut(&[usize])) {
        see(order);
        for next in 0..n {
            if !order.contains(&next) {
                order.push(next);
                go(n, order, see);
                order.pop();
            }
        }
    }
    let mut all = Vec::new();
    for start in (0..arcs.points()).filter(|start| ends.start.is_none_or(|fixed| fixed == *start)) {
        go(arcs.points(), &mut vec![start], &mut |order| {
            if ends.end.is_none_or(|end| Some(&end) == order.last())
                && let Some(cost) = cuts(arcs, triples, order)
            {
                all.push((cost, order.to_vec()));
            }
        });
    }
    let turns = arcs.symmetric() && triples.symmetric() && ends == Ends::default();
    all.retain(|(_, order)| !turns || order.first() <= order.last());
    all.sort_by_key(|(cost, _)| std::cmp::Reverse(*cost));
    all
}

#[test]
fn subsets_rank_paths_as_enumeration_does_and_the_bound_holds() {
    let (mut through, mut none) = (0, 0);
    for seed in 0..1500 {
        let (arcs, triples, ends) = question(seed, 6);
        let all = enumerate(&arcs, &triples, ends);
        let settings = HeaviestSettings { ends, programs: 7, ..HeaviestSettings::default() };
        let found = heaviest_with_triples(&arcs, &triples, &settings, &|| false).unwrap();
        assert!(found.proven && found.method == Method::Subsets);
        let costs = |paths: &[(i64, Vec<usize>)]| paths.iter().take(7).map(|(cost, _)| *cost).collect::<Vec<_>>();
        assert_eq!(costs(&found.paths), costs(&all), "{seed}");
        assert_eq!(found.outcome == Outcome::Infeasible, all.is_empty(), "{seed}");
        let mut orders: Vec<&Vec<usize>> = found.paths.iter().map(|(_, order)| order).collect();
        orders.sort();
        orders.dedup();
        assert_eq!(orders.len(), found.paths.len(), "{seed}: one order twice");
        for (cost, order) in &found.paths {
            let (on, passed) = triples.best_on(&arcs, order).unwrap();
            assert!(on == *cost && all.contains(&(*cost, order.clone())), "{seed}");
            through += usize::from(!passed.is_empty());
        }
        none += usize::from(all.is_empty());
        let mut prices = walks::Prices::new(problem::Question { arcs: &arcs, triples: &triples, ends });
        prices.step(1.0, 0, &|| false);
        let most = prices.bound();
        assert!(all.first().is_none_or(|(cost, _)| *cost <= most), "{seed}: {most} is no bound");
    }
    assert!(through > 1000 && none > 10, "{through} {none}");
}

#[test]
fn annealing_meets_the_optimum_and_is_the_same_again() {
    let mut missed = 0;
    for seed in 0..20 {
        let (arcs, triples, ends) = question(seed, 9);
        let run = |method| {
            let settings = HeaviestSettings { ends, method, seed, ..HeaviestSettings::default() };
            heaviest_with_triples(&arcs, &triples, &settings, &|| false).unwrap()
        };
        let (exact, local) = (run(Method::Auto), run(Method::Local));
        assert!(seed > 3 || local.paths == run(Method::Local).paths, "{seed}: another answer");
        let cost = |found: &crate::search::heaviest::Heaviest| found.paths.first().map(|(cost, _)| *cost);
        assert!(cost(&local) <= cost(&exact) && cost(&exact).is_none_or(|cost| Some(cost) <= local.bound), "{seed}");
        assert!(!local.proven || cost(&local) == cost(&exact), "{seed}: proven wrongly");
        missed += usize::from(cost(&local) < cost(&exact));
    }
    assert!(missed <= 1, "{missed} of 20 optima missed");
}

#[test]
fn without_triples_it_is_the_heaviest_path_of_arcs() {
    for seed in 0..300 {
        let (arcs, triples, ends) = question(seed, 9);
        let none = Triples::new(arcs.points(), &[]).unwrap();
        let settings = HeaviestSettings { ends, ..HeaviestSettings::default() };
        let straight = heaviest(&arcs, &settings, &|| false).unwrap();
        let same = heaviest_with_triples(&arcs, &none, &settings, &|| false).unwrap();
        assert_eq!((straight.outcome, straight.bound), (same.outcome, same.bound), "{seed}");
        let more = heaviest_with_triples(&arcs, &triples, &settings, &|| false).unwrap();
        assert!(more.bound >= same.bound, "{seed}: triples take nothing away");
    }
}

#[test]
fn what_is_no_question_is_refused_and_what_is_not_wanted_not_told() {
    assert_eq!(Triples::new(501, &[]), Err(TriplesMistake::TooMany { points: 501 }));
    let twice = Triples::new(3, &[([0, 1, 0], 5)]);
    assert!(twice.unwrap_err().to_string().contains("0→1→0"));
    assert!(Triples::new(3, &[([0, 1, 2], -1)]).unwrap_err().to_string().contains("cost -1"));
    let (arcs, triples) = (Arcs::new(3, &[None; 9]).unwrap(), Triples::new(3, &[([0, 1, 2], 5)]).unwrap());
    let ask = |ends: Ends, min_cost: Option<i64>| {
        let settings = HeaviestSettings { ends, min_cost, ..HeaviestSettings::default() };
        heaviest_with_triples(&arcs, &triples, &settings, &|| false)
    };
    let only = ask(Ends { start: Some(0), end: Some(2) }, None).unwrap();
    assert_eq!(only.paths, [(5, vec![0, 1, 2])]);
    assert_eq!(triples.best_on(&arcs, &[0, 1, 2]), Some((5, vec![1])));
    assert_eq!(triples.best_on(&arcs, &[2, 1, 0]), None);
    assert_eq!(ask(Ends { start: Some(2), end: Some(0) }, None).unwrap().outcome, Outcome::Infeasible);
    assert_eq!(ask(Ends::default(), Some(6)).unwrap().outcome, Outcome::BelowMinCost);
    assert!(ask(Ends { start: Some(3), end: None }, None).is_err());
}

#[test]
fn who_is_stopped_has_a_path_and_a_sound_bound() {
    let (arcs, triples, ends) = question(7, 9);
    let ask = |method, stop: &(dyn Fn() -> bool + Sync)| {
        let settings = HeaviestSettings { ends, method, ..HeaviestSettings::default() };
        heaviest_with_triples(&arcs, &triples, &settings, stop).unwrap()
    };
    let exact = ask(Method::Auto, &|| false).bound;
    for looks in [0, 3, 40] {
        let left = std::sync::atomic::AtomicI64::new(looks);
        let over = || left.fetch_sub(1, std::sync::atomic::Ordering::Relaxed) <= 0;
        let found = ask(Method::Local, &over);
        assert!(found.bound >= exact && found.paths.first().map(|(cost, _)| *cost) <= exact, "{found:?} {exact:?}");
        assert!(!found.paths.is_empty() && found.passed.len() == found.paths.len());
    }
}
