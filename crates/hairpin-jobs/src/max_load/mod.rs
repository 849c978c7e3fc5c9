//! The heaviest path through a graph, or through a cloud of an arm's points.

mod cloud;
mod graph;
mod proof;

use std::path::PathBuf;
use std::time::{Duration, Instant};

use hairpin::search::heaviest::{
    Ends, Heaviest, HeaviestSettings, Method, WalkProof, WalkSettings, heaviest, heaviest_walk,
};

use crate::{Deadline, Problem, Watch};
pub use cloud::{CloudAnswer, CloudSearch, CloudSettings, Programs, search_cloud};
pub use graph::Graph;
pub use proof::verify_certificate;

/// What is searched in a graph.
#[derive(Debug, Clone, Default)]
pub struct MaxLoadSettings {
    /// Table of costs: N lines of N numbers, row = from.
    pub graph: PathBuf,
    /// Paths below this cost are not wanted; in the unit of the table.
    pub min_cost: Option<String>,
    /// How often a point may come; with more than once no move is used twice.
    pub visits: usize,
    /// Seconds after which the best so far is the answer.
    pub time_limit_s: Option<f64>,
    /// Ends, programs, method and effort; its `min_cost` is that above.
    pub search: HeaviestSettings,
}

/// What was found in a graph.
pub struct MaxLoad {
    /// The graph.
    pub graph: Graph,
    /// The heaviest paths.
    pub found: Heaviest,
    /// What proves it where points may come several times.
    walk: Option<WalkProof>,
    ends: Ends,
    /// What it took.
    pub time: Duration,
}

/// Searches the heaviest path of a graph; stopped, it gives the best so far. Its time begins before the graph is read.
///
/// # Errors
/// A graph that cannot be read; settings that do not fit it or each other.
pub fn max_load(settings: &MaxLoadSettings, watch: &dyn Watch) -> Result<MaxLoad, Problem> {
    let (begun, deadline) = (Instant::now(), Deadline::after(settings.time_limit_s));
    let graph = Graph::read(&settings.graph)?;
    let walks = settings.visits > 1;
    if walks && !matches!(settings.search.method, Method::Auto | Method::Branch) {
        return Err(Problem::input("--visits: only --method branch lets points come several times"));
    }
    let min_cost = settings.min_cost.as_deref().map(|text| graph.at_least(text)).transpose()?;
    let search = HeaviestSettings { min_cost, ..settings.search.clone() };
    let stop = || watch.stopped() || deadline.passed();
    let (found, walk) = if walks {
        let HeaviestSettings { ends, programs, most_nodes, proof, .. } = search;
        let settings = WalkSettings { ends, visits: settings.visits, min_cost, programs, most_nodes, proof };
        heaviest_walk(&graph.arcs, &settings, &stop).map_err(|mistake| graph.refused(&mistake))?
    } else {
        (heaviest(&graph.arcs, &search, &stop).map_err(Problem::input)?, None)
    };
    Ok(MaxLoad { graph, found, walk, ends: search.ends, time: begun.elapsed() })
}

#[cfg(test)]
mod tests {
    use hairpin::search::heaviest::Outcome;

    use super::*;
    use crate::Unwatched;

    #[test]
    fn the_heaviest_path_is_found_proven_and_verified() {
        let place = tempfile::tempdir().unwrap();
        let (graph, certificate) = (place.path().join("costs.csv"), place.path().join("proof.json"));
        std::fs::write(&graph, ",1.5,9\n2,,3\n4,8,\n").unwrap();
        let search = HeaviestSettings { method: Method::Branch, proof: true, ..HeaviestSettings::default() };
        let settings = MaxLoadSettings { graph: graph.clone(), search, ..MaxLoadSettings::default() };
        let answer = max_load(&settings, &Unwatched).unwrap();
        assert_eq!((answer.found.outcome, &answer.found.paths[0].1), (Outcome::Found, &vec![0, 2, 1]));
        assert_eq!(answer.graph.text(answer.found.paths[0].0), "17.0");
        answer.write_certificate(&certificate).unwrap();
        let (_, checked) = verify_certificate(&graph, &certificate).unwrap();
        assert_eq!((checked.findings, checked.cost), (Vec::<String>::new(), 170));
        std::fs::write(&graph, ",1.5,9\n2,,3\n4,18,\n").unwrap();
        assert!(!verify_certificate(&graph, &certificate).unwrap().1.findings.is_empty());
    }
}
