//! The proof of a heaviest path as a file, and its check against the graph by independent code.

use std::path::Path;

use hairpin_formats::folder::refuse_own;
use hairpin_formats::{atomic, bounds};
use serde_json::Value;

use super::{Graph, MaxLoad};
use crate::Problem;
use crate::certificate::{self, Checked};

impl MaxLoad {
    /// Writes the proof of an answer that is proven.
    ///
    /// # Errors
    /// It is not; the file cannot be written.
    pub fn write_certificate(&self, out: &Path) -> Result<(), Problem> {
        let points = self.graph.arcs.points();
        let Some(object) = certificate::object(points, self.ends, &self.found, self.walk.as_ref()) else {
            return Err(Problem::input(format!("{}: not written, the answer is not proven", out.display())));
        };
        refuse_own(out)?;
        Ok(atomic::write(out, certificate::sealed(object).as_bytes())?)
    }
}

/// Checks the certificate in `file` against the table of costs in `graph`, which comes back as well.
///
/// # Errors
/// A file that cannot be read, or is none of its kind.
pub fn verify_certificate(graph: &Path, file: &Path) -> Result<(Graph, Checked), Problem> {
    let graph = Graph::read(graph)?;
    let broken = |what: &str| Problem::of_file(file, what);
    let text = bounds::read_json_text(file).map_err(|cause| broken(&format!("cannot be read: {cause}")))?;
    let object: Value = serde_json::from_str(&text).map_err(|error| broken(&format!("is no JSON: {error}")))?;
    let n = graph.arcs.points();
    let costs = (0..n * n).map(|index| graph.arcs.cost(index / n, index % n)).collect();
    let checked = certificate::check(&object, costs, None);
    let checked = checked.ok_or_else(|| broken("is no certificate of a heaviest path, or a field is missing"))?;
    Ok((graph, checked))
}
