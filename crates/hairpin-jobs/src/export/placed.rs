//! Where on Earth a campaign's world stands, for the files that say it.

use hairpin_formats::placement::Placement;

use crate::Problem;
use crate::work::Work;

/// The place of the world, for the format of that word.
///
/// # Errors
/// Nothing places it: with the line to write.
pub(super) fn placed(work: &Work, word: &str) -> Result<Placement, Problem> {
    let refuse = |why: String| Problem::input(format!("--to {word}: {why}"));
    Placement::of(&work.setup.scenario).map_err(refuse)?.ok_or_else(|| {
        refuse(
            "the scenario has no `world.origin`, such as \
             origin = { lat_deg = 47.3977, lon_deg = 8.5456, alt_amsl_m = 488.0, x_axis_heading_deg = 73.5 }, and no map \
             whose file or `world.terrain.epsg` says in which plane it lies"
                .into(),
        )
    })
}
