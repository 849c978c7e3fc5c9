//! The worst of a default run beside the worst of ten times all its executions by chance.

use hairpin::campaign::generate::Space;
use hairpin::math::random::named_seed;
use hairpin_jobs::{Problem, Watch};

use super::field::{Field, setup};
use super::record::{PairRecord, RunRecord};
use super::run::{searched, worst_of};
use super::size::{Cell, Size};
use super::ways::Way;

/// The pair of the run under `seed`; `None` where one side found nothing. A run that was `measured` before is not made
/// again.
pub(super) fn pair(
    cell: &Cell,
    size: &Size,
    seed: u64,
    measured: Option<&RunRecord>,
    watch: &dyn Watch,
) -> Result<Option<PairRecord>, Problem> {
    let base = setup(cell, named_seed(seed, "chance", 0), &[])?;
    let field = Field { setup: &base, stress: cell.stress, fresh: size.fresh };
    let known = measured.and_then(|run| run.ways.iter().find(|way| way.way == Way::Worst));
    let (kept, executions) = match known {
        Some(way) => (way.kept.clone(), way.executions),
        None => {
            let found = searched(cell, size, seed, Way::Worst, watch)?;
            (field.all_kept(&found.cases, watch)?, found.executions)
        }
    };
    let Some(worst) = worst_of(&kept).cloned() else { return Ok(None) };
    let space = Space::of(&base).map_err(Problem::input)?;
    let drawn = field.drawn(&space, 0, (size.chance * executions) as usize, watch)?;
    let Some(place) = drawn.most(0, drawn.stresses.len()) else { return Ok(None) };
    let case = space.draw(drawn.graphs[place], 0).map_err(Problem::input)?;
    Ok(Some(PairRecord { worst, chance: field.kept(&case) }))
}
