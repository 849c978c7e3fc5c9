//! The answer, for people and for machines.

use hairpin::search::heaviest::{Heaviest, Outcome};
use hairpin_jobs::max_load::{Graph, MaxLoad as Answer};
use serde_json::{Value, json};

use crate::args::MaxLoad;
use crate::console;
use crate::exit::{DONE, INCONCLUSIVE, NOTHING_FEASIBLE};

/// 3 if there is no path, 5 if none was found in time.
pub(super) fn code(found: &Heaviest) -> u8 {
    match found.outcome {
        Outcome::Found => DONE,
        Outcome::Infeasible | Outcome::BelowMinCost => NOTHING_FEASIBLE,
        Outcome::NotFound => INCONCLUSIVE,
    }
}

pub(super) fn tell(asked: &MaxLoad, answer: &Answer) {
    if asked.json {
        console::say(&object(asked, answer).to_string());
        return;
    }
    let Answer { graph, found, time, .. } = answer;
    let points = graph.arcs.points();
    if graph.scale() > 1 {
        console::warn(&format!("costs are searched as whole numbers: × {}", graph.scale()));
    }
    let Some((cost, _)) = found.paths.first() else {
        console::say(&format!("NOTHING FEASIBLE: {}", reason(asked, graph, found)));
        return;
    };
    let bound = found.bound.map_or_else(|| "unknown".to_owned(), |bound| graph.text(bound));
    let evidence = match found.gap_percent() {
        _ if found.proven => format!("optimal: {}", proven_over(asked.visits)),
        Some(gap) => format!("gap {gap:.4} % below the bound {bound}"),
        None => format!("bound {bound}"),
    };
    console::say(&format!(
        "cost {}, {evidence}; {:.3} s by {}, {points} points, density {:.2}",
        graph.text(*cost),
        time.as_secs_f64(),
        found.method.name(),
        graph.arcs.density()
    ));
    for (number, (cost, path)) in found.paths.iter().enumerate() {
        let before =
            if found.paths.len() > 1 { format!("{}. {}: ", number + 1, graph.text(*cost)) } else { String::new() };
        let left_out = (0..points).filter(|point| !path.contains(point)).count();
        let after = if left_out > 0 { format!("   ({left_out} of {points} points left out)") } else { String::new() };
        console::say(&format!("{before}{}{after}", words(path)));
    }
}

/// Over what an answer is proven.
pub(super) fn proven_over(visits: u16) -> String {
    match visits {
        1 => "proven over all loop-free paths".into(),
        _ => format!("proven over all paths that come to no point more than {visits} times and use no move twice"),
    }
}

fn words(path: &[usize]) -> String {
    path.iter().map(usize::to_string).collect::<Vec<_>>().join(" → ")
}

/// Why there is no path.
fn reason(asked: &MaxLoad, graph: &Graph, found: &Heaviest) -> String {
    let bound = found.bound.map_or_else(String::new, |bound| graph.text(bound));
    let least = asked.min_cost.as_deref().unwrap_or_default();
    match found.outcome {
        Outcome::Found => String::new(),
        Outcome::Infeasible => {
            let end = |point: Option<usize>| point.map_or_else(|| "any".to_owned(), |point| point.to_string());
            format!("no walk leads from point {} to point {}", end(asked.start), end(asked.end))
        }
        Outcome::BelowMinCost => format!("no path costs {least} or more; none more than {bound}"),
        Outcome::NotFound => format!("no path of cost {least} found yet; none costs more than {bound}"),
    }
}

fn object(asked: &MaxLoad, Answer { graph, found, time, .. }: &Answer) -> Value {
    let best = found.paths.first();
    let value = |cost: i64| graph.value(cost);
    let mut object = json!({
        "path": best.map(|(_, path)| path),
        "cost": best.map(|(cost, _)| value(*cost)),
        "bound": found.bound.map(value),
        "gap_percent": found.gap_percent().filter(|gap| gap.is_finite()),
        "proven": found.proven,
        "time_s": time.as_secs_f64(),
        "method": found.method.name(),
        "points": graph.arcs.points(),
        "density": graph.arcs.density(),
        "scale": graph.scale(),
        "nodes": found.nodes,
        "exit_code": code(found),
    });
    if asked.programs > 1 {
        let paths = found.paths.iter().map(|(cost, path)| json!({ "path": path, "cost": value(*cost) }));
        object["paths"] = paths.collect();
    }
    if best.is_none() {
        object["reason"] = reason(asked, graph, found).into();
    }
    object
}
