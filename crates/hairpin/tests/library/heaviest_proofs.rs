//! Proofs of heaviest paths hold for another program, and break when anything of them is changed.

use hairpin::math::random::{named_seed, stream, unit};
use hairpin::search::heaviest::{Arcs, Ends, Heaviest, HeaviestSettings, Method, Next, PricedCut, Workspace, heaviest};
use hairpin::verification::{CutClaim, HeaviestClaim, NextClaim, StepClaim, TreeClaim, verify_heaviest};

/// A random table: sparse to dense, directed or not.
fn table(seed: u64, n: usize, density: f64, directed: bool) -> Arcs {
    let mut random = stream(seed);
    let mut costs = vec![None; n * n];
    for i in 0..n {
        for j in 0..n {
            if (i < j || directed && i != j) && unit(&mut random) < density {
                costs[i * n + j] = Some((unit(&mut random) * 1000.0) as i64);
                if !directed {
                    costs[j * n + i] = costs[i * n + j];
                }
            }
        }
    }
    Arcs::new(n, &costs).unwrap()
}

fn claim(arcs: &Arcs, found: &Heaviest) -> HeaviestClaim {
    let n = arcs.points();
    let next = |next: &Next| match *next {
        Next::Closed => NextClaim::Closed,
        Next::Again(step) => NextClaim::Again(step),
        Next::Branch { choice, out, into } => NextClaim::Branch { choice, out, into },
    };
    let cut = |cut: &PricedCut| {
        let PricedCut { points, except, price } = cut.clone();
        CutClaim { points, except, price }
    };
    let tree = found.proof.as_ref().map(|proof| TreeClaim {
        scale: proof.scale,
        directed: proof.directed,
        steps: proof
            .steps
            .iter()
            .map(|step| StepClaim {
                multipliers: step.multipliers.clone(),
                cuts: step.cuts.iter().map(cut).collect(),
                out: step.out.clone(),
                into: step.into.clone(),
                next: next(&step.next),
            })
            .collect(),
    });
    let (cost, path) = found.paths[0].clone();
    let costs = (0..n * n).map(|index| arcs.cost(index / n, index % n)).collect();
    HeaviestClaim { points: n, costs, start: None, end: None, path, cost, tree }
}

fn proven(arcs: &Arcs) -> HeaviestClaim {
    let settings =
        HeaviestSettings { method: Method::Branch, proof: true, ends: Ends::default(), ..Default::default() };
    claim(arcs, &heaviest(arcs, &settings, &|| false).unwrap())
}

#[test]
fn every_proof_holds_and_a_second_search_agrees() {
    for seed in 0..200 {
        let arcs = table(seed, 2 + seed as usize % 11, [0.2, 0.4, 0.7, 1.0][seed as usize % 4], seed % 3 == 0);
        let mut claim = proven(&arcs);
        assert_eq!(verify_heaviest(&claim), [], "seed {seed}");
        claim.tree = None;
        assert_eq!(verify_heaviest(&claim), [], "seed {seed}");
    }
}

#[test]
fn a_proof_with_a_leaf_or_a_multiplier_changed_fails() {
    let mut branched = 0;
    for seed in 0..12 {
        let claim = proven(&table(seed, 24, 0.5, seed % 2 == 0));
        assert_eq!(verify_heaviest(&claim), [], "seed {seed}");
        let steps = claim.tree.as_ref().unwrap().steps.len();
        let changed = |change: &dyn Fn(&mut TreeClaim)| {
            let mut claim = claim.clone();
            change(claim.tree.as_mut().unwrap());
            verify_heaviest(&claim)
        };
        assert!(!changed(&|tree| drop(tree.steps.pop())).is_empty(), "seed {seed}: the last step is missing");
        assert!(!changed(&|tree| tree.steps.push(tree.steps[0].clone())).is_empty(), "seed {seed}: a step too many");
        // All leaves' bounds fall with large multipliers changed by more than what is left below the threshold.
        let large = changed(&|tree| tree.steps.iter_mut().for_each(|step| step.multipliers[0] += 1 << 45));
        assert!(!large.is_empty(), "seed {seed}: multipliers");
        for number in 0..steps {
            if matches!(claim.tree.as_ref().unwrap().steps[number].next, NextClaim::Branch { .. }) {
                branched += 1;
                let closed = changed(&|tree| tree.steps[number].next = NextClaim::Closed);
                assert!(!closed.is_empty(), "seed {seed}: step {number} closed without its leaves");
            }
        }
    }
    assert!(branched > 0, "no proof had a branch to take away");
}

#[test]
fn what_the_path_claims_is_checked() {
    let claim = proven(&table(5, 12, 0.8, false));
    let wrong = |change: &dyn Fn(&mut HeaviestClaim)| {
        let mut claim = claim.clone();
        change(&mut claim);
        assert!(!verify_heaviest(&claim).is_empty(), "{:?}", claim.path);
    };
    wrong(&|claim| claim.cost += 1);
    wrong(&|claim| claim.cost -= 1);
    wrong(&|claim| claim.path.swap(1, 2));
    wrong(&|claim| claim.path.push(claim.path[0]));
    wrong(&|claim| claim.path.clear());
    wrong(&|claim| claim.start = Some(claim.path[1]));
    // A lighter path of its own right, with the proof of the heaviest.
    wrong(&|claim| {
        claim.path.truncate(2);
        claim.cost = claim.costs[claim.path[0] * 12 + claim.path[1]].unwrap();
    });
}

#[test]
fn with_sixteen_points_both_ways_give_the_heaviest_path_and_a_claim_that_holds() {
    let mut by_branching = 0;
    for seed in 0..40 {
        let arcs = table(seed, 16, [0.2, 0.4, 0.7, 1.0][seed as usize % 4], seed % 3 == 0);
        // Without a single node branching proves nothing, and the other way is taken.
        let most_nodes = (seed % 4 == 3).then_some(0);
        let by = |method, proof| {
            heaviest(&arcs, &HeaviestSettings { method, proof, most_nodes, ..Default::default() }, &|| false)
        };
        let (quick, sure) = (by(Method::Auto, true).unwrap(), by(Method::Subsets, false).unwrap());
        assert!(quick.proven, "seed {seed}");
        assert_eq!((quick.paths[0].0, quick.bound), (sure.paths[0].0, sure.bound), "seed {seed}");
        assert_eq!(quick.proof.is_some(), quick.method == Method::Branch, "seed {seed}");
        assert_eq!(verify_heaviest(&claim(&arcs, &quick)), [], "seed {seed}");
        by_branching += usize::from(quick.method == Method::Branch);
    }
    assert!((1..40).contains(&by_branching), "{by_branching} of 40 by branching: one way is not tried");
}

/// Points in narrow clusters, where a single tree says little: with subgradients alone thousands of splits left the
/// first two open.
#[test]
fn clusters_are_proven_with_few_splits_and_the_proof_holds() {
    for index in [1, 8, 5] {
        let seed = named_seed(1, "robtest", 30_000 + index);
        let workspace = Workspace::PUBLISHED;
        let arcs = workspace.arcs(&workspace.clustered(30, 4, 0.01, seed)).unwrap();
        let settings = HeaviestSettings { proof: true, most_nodes: Some(20), ..Default::default() };
        let found = heaviest(&arcs, &settings, &|| false).unwrap();
        assert!(found.proven, "{index}: {:?}", found.gap_percent());
        assert_eq!(verify_heaviest(&claim(&arcs, &found)), [], "{index}");
    }
}

/// Clusters of which two reach each other only past others: trees alone take half of one and half of another path for
/// more than either.
#[test]
fn what_cuts_prove_holds_and_fails_with_a_cut_changed() {
    let workspace = Workspace::PUBLISHED;
    let arcs = workspace.arcs(&workspace.clustered(50, 4, 0.01, named_seed(77, "bench points", 0))).unwrap();
    let settings = HeaviestSettings { proof: true, most_nodes: Some(20), ..Default::default() };
    let found = heaviest(&arcs, &settings, &|| false).unwrap();
    assert!(found.proven, "{:?}", found.gap_percent());
    let claim = claim(&arcs, &found);
    assert_eq!(verify_heaviest(&claim), []);
    let step = claim.tree.as_ref().unwrap().steps.iter().rposition(|step| !step.cuts.is_empty());
    let step = step.expect("the proof needs a cut");
    let wrong = |change: &dyn Fn(&mut CutClaim)| {
        let mut claim = claim.clone();
        change(&mut claim.tree.as_mut().unwrap().steps[step].cuts[0]);
        assert!(!verify_heaviest(&claim).is_empty());
    };
    wrong(&|cut| cut.price = -1);
    wrong(&|cut| cut.points.push(50));
    wrong(&|cut| cut.points.push(cut.points[0]));
    wrong(&|cut| cut.points.retain(|point| *point != cut.except));
    wrong(&|cut| cut.price += 1 << 45);
}
