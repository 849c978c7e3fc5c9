//! The heaviest path, or several.

use super::parts::in_parts;
use super::problem::Arcs;
use super::question::{Heaviest, HeaviestMistake, HeaviestSettings, Method, wanted};
use super::several::several;

/// The path of maximal total cost in which no point comes twice; points may be left out.
///
/// `stop` is asked often and from any thread; then the best so far is the answer. The same seed gives the same answer
/// on any number of threads unless `stop` ends it.
///
/// Equations and sources: docs/heaviest-paths.md. Measured on instances of the published kind: `hairpin bench
/// max-load`.
///
/// | asked | answered by |
/// | --- | --- |
/// | `programs` ≤ 1, or any method but `Auto` | that method |
/// | several paths, `Auto` | the heaviest first, then by Lawler's partition |
///
/// No path at all (fixed ends that no walk joins) is an answer, `Infeasible`, and no error.
///
/// # Errors
/// Ends that are no points; a table of subsets that would not fit; several paths from a method that gives one.
pub fn heaviest(
    arcs: &Arcs,
    settings: &HeaviestSettings,
    stop: &(dyn Fn() -> bool + Sync),
) -> Result<Heaviest, HeaviestMistake> {
    if settings.programs <= 1 || settings.method != Method::Auto {
        return in_parts(arcs, settings, stop);
    }
    let first = in_parts(arcs, &HeaviestSettings { programs: 1, ..settings.clone() }, stop)?;
    Ok(wanted(several(arcs, settings, first, stop)?, settings))
}
