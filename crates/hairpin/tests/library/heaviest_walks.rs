//! Paths that may come back to points: against all paths there are, and their proofs against forgers.

use rand::RngExt;

use hairpin::math::random::{Stream, stream};
use hairpin::search::heaviest::{
    Arcs, ArcsMistake, Ends, HeaviestSettings, Outcome, WalkMistake, WalkProof, WalkSettings, WalkStep, heaviest,
    heaviest_walk,
};
use hairpin::verification::{SplitClaim, WalkClaim, WalkStepClaim, verify_walk};

fn graph(random: &mut Stream, points: usize, density: f64, largest: i64) -> Arcs {
    let costs: Vec<Option<i64>> =
        (0..points * points).map(|_| random.random_bool(density).then(|| random.random_range(0..=largest))).collect();
    Arcs::new(points, &costs).unwrap()
}

fn ends(random: &mut Stream, points: usize) -> Ends {
    let mut end = || random.random_bool(0.5).then(|| random.random_range(0..points));
    Ends { start: end(), end: end() }
}

fn settings(ends: Ends, visits: usize) -> WalkSettings {
    WalkSettings { ends, visits, min_cost: None, programs: 1, most_nodes: None, proof: true }
}

/// Costs of all paths, every one walked.
fn all(arcs: &Arcs, ends: Ends, visits: usize) -> Vec<i64> {
    fn on(
        arcs: &Arcs,
        ends: Ends,
        left: &mut [usize],
        used: &mut Vec<(usize, usize)>,
        at: usize,
        cost: i64,
        found: &mut Vec<i64>,
    ) {
        if ends.end.is_none_or(|end| end == at) {
            found.push(cost);
        }
        for to in 0..arcs.points() {
            let Some(more) = arcs.cost(at, to).filter(|_| left[to] > 0 && !used.contains(&(at, to))) else { continue };
            left[to] -= 1;
            used.push((at, to));
            on(arcs, ends, left, used, to, cost + more, found);
            used.pop();
            left[to] += 1;
        }
    }
    let mut found = Vec::new();
    for start in (0..arcs.points()).filter(|start| ends.start.is_none_or(|fixed| fixed == *start)) {
        let mut left = vec![visits; arcs.points()];
        left[start] -= 1;
        on(arcs, ends, &mut left, &mut Vec::new(), start, 0, &mut found);
    }
    found
}

fn claim(arcs: &Arcs, settings: &WalkSettings, cost: i64, path: &[usize], proof: &WalkProof) -> WalkClaim {
    let n = arcs.points();
    let step = |step: &WalkStep| WalkStepClaim {
        prices: step.prices.clone(),
        split: step.split.clone().map(|split| SplitClaim {
            points: split.points,
            without: split.without,
            ways: split.ways,
        }),
    };
    WalkClaim {
        points: n,
        costs: (0..n * n).map(|index| arcs.cost(index / n, index % n)).collect(),
        start: settings.ends.start,
        end: settings.ends.end,
        visits: proof.visits,
        path: path.to_vec(),
        cost,
        steps: proof.steps.iter().map(step).collect(),
    }
}

/// Small instances of all kinds.
fn drawn(seed: u64) -> (Arcs, WalkSettings) {
    let mut random = stream(seed);
    let points = random.random_range(1..=5);
    let density = [1.0, 0.7, 0.4, 0.2][seed as usize % 4];
    let arcs = graph(&mut random, points, density, [1000, 3, 0][seed as usize / 4 % 3]);
    let most = if points == 5 && density > 0.5 { 2 } else { 3 };
    let ends = ends(&mut random, points);
    (arcs, settings(ends, random.random_range(1..=most)))
}

#[test]
fn is_the_heaviest_of_all_and_its_proof_holds() {
    for seed in 0..600 {
        let (arcs, settings) = drawn(seed);
        let (found, proof) = heaviest_walk(&arcs, &settings, &|| false).unwrap();
        let best = all(&arcs, settings.ends, settings.visits).into_iter().max();
        assert_eq!(found.paths.first().map(|(cost, _)| *cost), best, "seed {seed}");
        assert!(found.proven && found.bound == best, "seed {seed}: {found:?}");
        let Some((cost, path)) = found.paths.first() else { continue };
        let claim = claim(&arcs, &settings, *cost, path, &proof.unwrap());
        assert_eq!(verify_walk(&claim), Vec::<String>::new(), "seed {seed}");
        if settings.visits == 1 {
            let once = HeaviestSettings { ends: settings.ends, ..HeaviestSettings::default() };
            assert_eq!(heaviest(&arcs, &once, &|| false).unwrap().paths[0].0, *cost, "seed {seed}");
        }
    }
}

#[test]
fn several_are_the_heaviest_ones() {
    for seed in 0..150 {
        let (arcs, mut settings) = drawn(3000 + 12 * (seed / 4) + seed % 4);
        (settings.programs, settings.proof) = (4, false);
        let (found, _) = heaviest_walk(&arcs, &settings, &|| false).unwrap();
        let costs: Vec<i64> = found.paths.iter().map(|(cost, _)| *cost).collect();
        assert!(costs.is_sorted_by(|a, b| a >= b) && found.proven, "seed {seed}");
        for (i, (cost, path)) in found.paths.iter().enumerate() {
            assert_eq!(arcs.total(path), Some(*cost));
            assert!(found.paths[..i].iter().all(|(_, other)| other != path), "seed {seed}");
        }
        // No cost between two neighbours is left out: costs up to 1000 are seldom equal.
        let mut every = all(&arcs, settings.ends, settings.visits);
        every.sort_unstable_by(|a, b| b.cmp(a));
        every.dedup();
        let mut distinct = costs.clone();
        distinct.dedup();
        assert_eq!(distinct[..], every[..distinct.len()], "seed {seed}");
    }
}

#[test]
fn a_forged_proof_is_found() {
    let (mut forged, mut tried) = (0, 0);
    for seed in 0..600 {
        let (arcs, settings) = drawn(seed);
        let (found, proof) = heaviest_walk(&arcs, &settings, &|| false).unwrap();
        let (Some((cost, path)), Some(proof)) = (found.paths.first(), proof) else { continue };
        let good = claim(&arcs, &settings, *cost, path, &proof);
        if *cost > 0 {
            // A lighter path as the heaviest one: its cost is below the optimum that prices prove.
            let lighter = WalkClaim { path: path[..1].to_vec(), cost: 0, end: None, ..good.clone() };
            assert!(!verify_walk(&lighter).is_empty(), "seed {seed}");
        }
        for number in 0..good.steps.len() {
            let Some(split) = good.steps[number].split.clone().filter(|split| !split.ways.is_empty()) else { continue };
            tried += 1;
            // One branch left out; one leaf without a proof.
            let mut fewer = good.clone();
            fewer.steps[number].split = Some(SplitClaim { ways: split.ways[1..].to_vec(), ..split.clone() });
            let mut closed = good.clone();
            closed.steps[number].split = None;
            forged += usize::from(!verify_walk(&fewer).is_empty() && !verify_walk(&closed).is_empty());
        }
    }
    assert!(tried > 10 && forged == tried, "{forged} of {tried}");
}

#[test]
fn what_cannot_be_asked_is_refused() {
    let arcs = Arcs::new(2, &[None, Some(i64::MAX / 200), Some(1), None]).unwrap();
    let asked = |visits, ends| heaviest_walk(&arcs, &settings(ends, visits), &|| false).map(|_| ()).unwrap_err();
    assert_eq!(asked(0, Ends::default()), WalkMistake::Visits { visits: 0 });
    assert!(matches!(asked(2, Ends::default()), WalkMistake::Arcs(ArcsMistake::Overflow { from: 0, to: 1, .. })));
    let beyond = Ends { start: Some(2), end: None };
    assert!(matches!(asked(2, beyond), WalkMistake::Arcs(ArcsMistake::End { field: "start", .. })));
    // Stopped at once: a bound, no claim.
    let mut random = stream(5);
    let arcs = graph(&mut random, 6, 0.8, 100);
    let (found, proof) = heaviest_walk(&arcs, &settings(Ends::default(), 2), &|| true).unwrap();
    assert!(!found.proven && proof.is_none() && found.outcome == Outcome::NotFound);
}
