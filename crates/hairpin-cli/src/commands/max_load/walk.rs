//! `--visits N`: paths that may come back to points.

use std::time::Instant;

use hairpin::search::heaviest::{Ends, WalkSettings, heaviest_walk};

use super::graph::Graph;
use super::{answer, certificate, code};
use crate::args::{MaxLoad, SearchMethod};
use crate::interrupt::{self, Deadline};
use crate::problem::Problem;

/// Searches, answers, and writes the certificate that was asked for.
pub(super) fn run(asked: &MaxLoad, graph: &Graph) -> Result<u8, Problem> {
    if !matches!(asked.method, SearchMethod::Auto | SearchMethod::Branch) {
        return Err(Problem::input("--visits: only --method branch lets points come several times"));
    }
    let settings = WalkSettings {
        ends: Ends { start: asked.start, end: asked.end },
        visits: asked.visits.into(),
        min_cost: asked.min_cost.as_deref().map(|text| graph.at_least(text)).transpose()?,
        programs: asked.programs.into(),
        most_nodes: asked.nodes,
        proof: asked.certificate.is_some(),
    };
    let (begun, deadline) = (Instant::now(), Deadline::after(asked.time_limit));
    let found = heaviest_walk(&graph.arcs, &settings, &|| interrupt::asked() || deadline.passed());
    let (found, proof) = found.map_err(Problem::input)?;
    answer::tell(asked, graph, &found, begun.elapsed());
    if let Some(out) = &asked.certificate {
        certificate::write(out, graph, settings.ends, &found, proof.as_ref())?;
    }
    Ok(code(&found))
}
