//! How drives are looked for: what may be driven, how exactly, how long, and what is to become small.

use std::path::Path;
use std::time::Duration;

use hairpin::campaign::scenario::{KeepOutSection, keep_outs};
use hairpin::feasibility::steering::shooting::Precision;
use hairpin::feasibility::steering::shooting::flat::Cost;
use hairpin::feasibility::steering::shooting::rough::{GroundCost, Settings};
use hairpin::feasibility::steering::shooting::solve::Choices;
use hairpin::world::terrain::KeepOuts;
use hairpin_formats::bounds::{self, MOST_TEXT_BYTES};
use hairpin_formats::steering::Asked;
use hairpin_formats::terrain::read_keep_outs;

use super::SteerSettings;
use crate::Problem;

/// What the questions of a run are answered with.
#[derive(Debug, Clone, Copy)]
pub(super) struct Solver<'t> {
    /// In the plane.
    pub(super) choices: Choices<'t>,
    /// On the ground.
    pub(super) ground: Settings,
    pub(super) time_limit: Option<Duration>,
}

impl Solver<'_> {
    /// Forward arcs with `time_limit` for each question.
    pub(super) fn plain(time_limit: Option<Duration>) -> Self {
        Self { choices: Choices::default(), ground: Settings::default(), time_limit }
    }

    pub(super) fn new(settings: &SteerSettings) -> Result<Self, Problem> {
        let mut solver = Self::plain(settings.time_limit);
        let Self { choices, ground, .. } = &mut solver;
        (choices.reversals, choices.turns) = (settings.reversals, settings.turns);
        ground.cost = cost(settings)?;
        choices.flat.cost = match ground.cost {
            GroundCost::Curvature => Cost::Curvature,
            GroundCost::Rate => Cost::Rate,
            _ => Cost::Any,
        };
        choices.families.cost = choices.flat.cost;
        let effort = &settings.effort;
        let usual = Precision::default();
        ground.precision = Precision {
            position: usual.position,
            yaw: effort.tolerance_yaw.unwrap_or(usual.yaw),
            curvature: effort.tolerance_curvature.unwrap_or(usual.curvature),
        };
        if let Some(iterations) = effort.iterations {
            (choices.flat.iterations, choices.families.iterations) = (iterations, iterations);
            ground.iterations = iterations;
        }
        (choices.flat.step_scale, choices.families.step_scale) = (effort.step_scale, effort.step_scale);
        ground.step_scale = effort.step_scale;
        Ok(solver)
    }

    /// What may be driven with fewer of the changes of gear and turns in place that are allowed, most of them first.
    pub(super) fn plainer(&self) -> Vec<Choices<'_>> {
        let Choices { reversals, turns, .. } = self.choices;
        let fewer = [(true, false), (false, true), (false, false)];
        let fewer =
            fewer.into_iter().filter(|(r, t)| (reversals || !r) && (turns || !t) && (*r, *t) != (reversals, turns));
        fewer.map(|(reversals, turns)| Choices { reversals, turns, ..self.choices }).collect()
    }

    /// How exactly `asked` is to be met.
    pub(super) fn precision(&self, asked: &Asked) -> Precision {
        let precision = self.ground.precision;
        Precision { position: asked.tolerance_m.unwrap_or(precision.position), ..precision }
    }
}

/// The cost asked for, where there is something to lower it with.
fn cost(settings: &SteerSettings) -> Result<GroundCost, Problem> {
    let (cost, control) = (settings.cost, settings.pace.control);
    if cost == GroundCost::Any {
        return Ok(cost);
    }
    if control.parameters() <= control.conditions() {
        return Err(Problem::input(format!(
            "--cost: --control {} has 0 parameters to spare for it: {} for {} conditions; quintic, time-polynomial, \
             velocity-polynomial and knots have some",
            control.name(),
            control.parameters(),
            control.conditions()
        )));
    }
    if settings.terrain.is_none() && !matches!(cost, GroundCost::Curvature | GroundCost::Rate) {
        return Err(Problem::input("--cost: in the plane nothing tilts, slips or climbs; give --terrain"));
    }
    Ok(cost)
}

/// The places of the file, then the others, on a map whose x and y are relative to `offset`.
pub(super) fn places(settings: &SteerSettings, offset: [f64; 2]) -> Result<KeepOuts, Problem> {
    let mut sections = settings.keep_out.as_deref().map_or(Ok(Vec::new()), file)?;
    sections.extend_from_slice(&settings.places);
    let place = |p: &mut [f64; 2]| *p = [p[0] - offset[0], p[1] - offset[1]];
    for section in &mut sections {
        section.circle.iter_mut().for_each(|circle| place(&mut circle.center_m));
        section.polygon.iter_mut().flat_map(|polygon| &mut polygon.points_m).for_each(place);
    }
    keep_outs(&sections).map_err(|mistake| Problem::input(mistake.to_string()))
}

fn file(path: &Path) -> Result<Vec<KeepOutSection>, Problem> {
    let text = bounds::read_text(path, MOST_TEXT_BYTES).map_err(|error| Problem::of_file(path, error))?;
    read_keep_outs(&text).map_err(|error| Problem::of_file(path, error))
}
