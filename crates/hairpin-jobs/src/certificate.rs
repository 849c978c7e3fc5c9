//! Proofs of heaviest paths as JSON objects, and their check by independent code: files of `max-load`, and what a
//! campaign of arms keeps.
//!
//! `{"kind","points","start","end","path","cost","scale","directed","steps","sha256"}`: costs in whole numbers (a
//! table's times the power of ten that makes them whole); a step is `[multipliers, out, into, next]`, next `[]`
//! (closed), `[step]` or `[choice, step with it out, step with it in]`; where it prices cuts, `[[price, except,
//! points], …]` is its fifth part. Where points may come several times `visits` stands in the place of scale and
//! directed, and a step is `[prices]`, whose bound closes it, or `[prices, points, without, [[from, to, step], …]]`: a
//! path meets none of the points (step `without`, `null` where it must), or one of the arcs leads it out of them, to
//! number `points` where it ends. sha256 is of the object without it. Where moves may pass points, `passed` stands in
//! the place of scale, directed and steps: the points of the path that are passed; it is searched again.

use hairpin::search::heaviest::{Ends, Heaviest, Next, Step, WalkProof, WalkStep};
use hairpin::verification::{
    CutClaim, HeaviestClaim, NextClaim, SplitClaim, StepClaim, TreeClaim, TriplesClaim, WalkClaim, WalkStepClaim,
    verify_heaviest, verify_triples, verify_walk,
};
use hairpin_formats::checksum;
use serde_json::{Value, json};

const PATH: &str = "hairpin heaviest path 1";
const WALK: &str = "hairpin heaviest walk 1";
const WITH_ARCS: &str = "hairpin heaviest path with arcs 1";

/// Arcs \[from, via, to\] with their costs.
pub(crate) type Arcs = Vec<([usize; 3], i64)>;

/// What a check came to.
pub struct Checked {
    /// Cost of the path, in the graph's whole units.
    pub cost: i64,
    /// How often a point may come.
    pub visits: usize,
    /// Steps of the tree; `None` where the path was searched again.
    pub steps: Option<usize>,
    /// What does not hold.
    pub findings: Vec<String>,
}

/// The proof of an answer; `None` of one that is not proven.
pub(crate) fn object(points: usize, ends: Ends, found: &Heaviest, walk: Option<&WalkProof>) -> Option<Value> {
    let (cost, path) = found.paths.first().filter(|_| found.proven)?;
    let mut object =
        json!({ "kind": PATH, "points": points, "start": ends.start, "end": ends.end, "path": path, "cost": cost });
    if let Some(walk) = walk {
        object["kind"] = WALK.into();
        object["visits"] = walk.visits.into();
        object["steps"] = walk.steps.iter().map(walk_step).collect();
        return Some(object);
    }
    if let Some(passed) = found.passed.first() {
        object["kind"] = WITH_ARCS.into();
        object["passed"] = json!(passed);
        return Some(object);
    }
    let proof = found.proof.as_ref();
    object["scale"] = json!(proof.map(|proof| proof.scale));
    object["directed"] = json!(proof.map(|proof| proof.directed));
    object["steps"] = json!(proof.map(|proof| proof.steps.iter().map(path_step).collect::<Value>()));
    Some(object)
}

/// Puts the object's own SHA-256 into it.
pub(crate) fn sealed(mut object: Value) -> String {
    object["sha256"] = checksum::sha256(object.to_string()).into();
    object.to_string()
}

/// Checks an object against the costs of a graph and its arcs, if it has any; `None` where it is no certificate of such
/// a graph.
pub(crate) fn check(object: &Value, costs: Vec<Option<i64>>, arcs: Option<Arcs>) -> Option<Checked> {
    let mut bare = object.clone();
    let stated = bare.as_object_mut()?.shift_remove("sha256");
    let mut checked = match object["kind"].as_str()? {
        PATH if arcs.is_none() => {
            let claim = path_claim(object, costs)?;
            let found = verify_heaviest(&claim).into_iter();
            let findings =
                found.map(|found| found.step.map_or(found.what.clone(), |step| format!("step {step}: {}", found.what)));
            let steps = claim.tree.as_ref().map(|tree| tree.steps.len());
            Checked { cost: claim.cost, visits: 1, steps, findings: findings.collect() }
        }
        WALK if arcs.is_none() => {
            let claim = walk_claim(object, costs)?;
            let findings = verify_walk(&claim);
            Checked { cost: claim.cost, visits: claim.visits, steps: Some(claim.steps.len()), findings }
        }
        WITH_ARCS => {
            let claim = arcs_claim(object, costs, arcs?)?;
            Checked { cost: claim.cost, visits: 1, steps: None, findings: verify_triples(&claim) }
        }
        _ => return None,
    };
    if stated != Some(checksum::sha256(bare.to_string()).into()) {
        checked.findings.push("it was changed: its SHA-256 is another".into());
    }
    Some(checked)
}

fn path_step(step: &Step) -> Value {
    let next = match step.next {
        Next::Closed => json!([]),
        Next::Again(step) => json!([step]),
        Next::Branch { choice, out, into } => json!([choice, out, into]),
    };
    let mut parts = json!([step.multipliers, step.out, step.into, next]);
    if let (Value::Array(parts), false) = (&mut parts, step.cuts.is_empty()) {
        parts.push(step.cuts.iter().map(|cut| json!([cut.price, cut.except, cut.points])).collect());
    }
    parts
}

fn walk_step(step: &WalkStep) -> Value {
    match &step.split {
        None => json!([step.prices]),
        Some(split) => json!([step.prices, split.points, split.without, split.ways]),
    }
}

fn path_claim(object: &Value, costs: Vec<Option<i64>>) -> Option<HeaviestClaim> {
    let step = |value: &Value| {
        let numbers = |value: &Value| value.as_array()?.iter().map(Value::as_u64).collect::<Option<Vec<_>>>();
        let cut = |cut: &Value| {
            Some(CutClaim { price: cut[0].as_i64()?, except: index(&cut[1])?, points: indices(&cut[2])? })
        };
        let cuts = match value.get(4) {
            Some(cuts) => cuts.as_array()?.iter().map(cut).collect::<Option<_>>()?,
            None => Vec::new(),
        };
        Some(StepClaim {
            multipliers: integers(&value[0])?,
            cuts,
            out: numbers(&value[1])?,
            into: numbers(&value[2])?,
            next: match indices(&value[3])?[..] {
                [] => NextClaim::Closed,
                [step] => NextClaim::Again(step),
                [choice, out, into] => NextClaim::Branch { choice: choice as u64, out, into },
                _ => return None,
            },
        })
    };
    let tree = if object["steps"].is_null() {
        None
    } else {
        let steps = object["steps"].as_array()?.iter().map(step).collect::<Option<Vec<_>>>()?;
        Some(TreeClaim { scale: object["scale"].as_i64()?, directed: object["directed"].as_bool()?, steps })
    };
    Some(HeaviestClaim {
        points: index(&object["points"])?,
        costs,
        start: end(&object["start"])?,
        end: end(&object["end"])?,
        path: indices(&object["path"])?,
        cost: object["cost"].as_i64()?,
        tree,
    })
}

fn walk_claim(object: &Value, costs: Vec<Option<i64>>) -> Option<WalkClaim> {
    let way = |value: &Value| match indices(value)?[..] {
        [from, to, step] => Some((from, to, step)),
        _ => None,
    };
    let step = |value: &Value| {
        let parts = value.as_array()?;
        let prices = integers(parts.first()?)?;
        let split = match parts.get(1..)? {
            [] => None,
            [points, without, ways] => Some(SplitClaim {
                points: indices(points)?,
                without: end(without)?,
                ways: ways.as_array()?.iter().map(way).collect::<Option<_>>()?,
            }),
            _ => return None,
        };
        Some(WalkStepClaim { prices, split })
    };
    Some(WalkClaim {
        points: index(&object["points"])?,
        costs,
        start: end(&object["start"])?,
        end: end(&object["end"])?,
        visits: index(&object["visits"])?,
        path: indices(&object["path"])?,
        cost: object["cost"].as_i64()?,
        steps: object["steps"].as_array()?.iter().map(step).collect::<Option<_>>()?,
    })
}

fn arcs_claim(object: &Value, costs: Vec<Option<i64>>, arcs: Arcs) -> Option<TriplesClaim> {
    Some(TriplesClaim {
        points: index(&object["points"])?,
        costs,
        triples: arcs,
        start: end(&object["start"])?,
        end: end(&object["end"])?,
        path: indices(&object["path"])?,
        passed: indices(&object["passed"])?,
        cost: object["cost"].as_i64()?,
    })
}

fn index(value: &Value) -> Option<usize> {
    usize::try_from(value.as_u64()?).ok()
}

/// A number, or `null` for none.
fn end(value: &Value) -> Option<Option<usize>> {
    if value.is_null() { Some(None) } else { index(value).map(Some) }
}

fn indices(value: &Value) -> Option<Vec<usize>> {
    value.as_array()?.iter().map(index).collect()
}

fn integers(value: &Value) -> Option<Vec<i64>> {
    value.as_array()?.iter().map(Value::as_i64).collect()
}
