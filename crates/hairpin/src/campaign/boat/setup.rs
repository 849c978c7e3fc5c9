//! From a boat scenario's numbers to the boat and the waters they describe.

use std::sync::Arc;

use super::keys::{BoatScenario, WatersSection};
use crate::campaign::attachments::Attachments;
use crate::campaign::kind::{Given, Kind};
use crate::campaign::own_controller::AnyController;
use crate::campaign::scenario::{Mistake, RobotSource};
use crate::feasibility::boat::{BoatJudge, BoatLimits, BoatWaters};
use crate::feasibility::steering::LegTiming;
use crate::math::simd::Simd;
use crate::robot::boat::{Boat, BoatDescription};
use crate::simulation::OwnController;
use crate::world::terrain::KeepOuts;

/// A resolved scenario of boats and what it describes.
///
/// What [`Setup::own`](crate::campaign::setup::Setup::own) gives for boats. Draws share what they leave as it is.
#[derive(Debug, Clone)]
pub struct BoatSetup {
    /// Every key, the robot's table inline.
    pub scenario: Arc<BoatScenario>,
    /// What its files hold.
    pub attachments: Arc<Attachments>,
    /// The boat.
    ///
    /// As it is planned and sailed; a draw of `[vary]` has one of its own.
    pub boat: Arc<Boat>,
    /// Where it must not come.
    pub keep_out: Arc<KeepOuts>,
    /// A controller of the caller's own in the place of the scenario's.
    pub controller: Option<OwnController<Boat>>,
    /// Version of the kernels; nothing of boats has two.
    pub simd: Simd,
}

impl BoatSetup {
    /// The boat of `keys`: that of `known`, if it is described alike.
    ///
    /// # Errors
    /// As [`boat_of`].
    pub(super) fn boat(keys: &BoatScenario, known: Option<&Self>) -> Result<Arc<Boat>, Mistake> {
        match known {
            Some(known) if known.scenario.robot == keys.robot => Ok(known.boat.clone()),
            _ => boat_of(&keys.robot).map(Arc::new),
        }
    }

    /// The places to keep out of, likewise.
    ///
    /// # Errors
    /// The keep-out that is no place, by its key.
    pub(super) fn keep_out(keys: &BoatScenario, known: Option<&Self>) -> Result<Arc<KeepOuts>, Mistake> {
        match known {
            Some(known) if known.scenario.world.keep_out == keys.world.keep_out => Ok(known.keep_out.clone()),
            _ => keys.world.keep_outs().map(Arc::new),
        }
    }

    /// Controller and kernels stay those of the setup that is known.
    ///
    /// Nothing is checked here.
    pub(super) fn of(given: Given<'_, Self>, boat: Arc<Boat>, keep_out: Arc<KeepOuts>) -> Self {
        let Given { keys, files, known } = given;
        let controller = known.and_then(|known| known.controller.clone());
        let simd = known.map_or_else(Simd::default, |known| known.simd);
        Self { scenario: keys.clone(), attachments: files.clone(), boat, keep_out, controller, simd }
    }

    /// The waters as claims have them.
    ///
    /// From (0, 0) to `size` (m), the south-western corner first; the current in m/s, east and north. A copy of the
    /// keep-outs.
    pub(super) fn waters(&self) -> BoatWaters {
        let WatersSection { size_m, keep_in_margin_m, .. } = self.scenario.world;
        let (keep_outs, current) = (self.keep_out.as_ref().clone(), self.scenario.world.current());
        BoatWaters { size: size_m, keep_in: keep_in_margin_m, keep_outs, current }
    }

    /// The judge of legs under the scenario's limits.
    ///
    /// Without a cap on speed ∞, without a share of thrust all of it.
    pub(super) fn judge(&self) -> BoatJudge {
        let given = &self.scenario.generate.limits;
        let limits = BoatLimits {
            max_speed: given.max_speed_m_s.unwrap_or(f64::INFINITY),
            thrust_share: given.thrust_share.unwrap_or(1.0),
        };
        BoatJudge::new(&self.boat, &self.waters(), limits)
    }

    /// How long legs may take.
    ///
    /// A geometric ladder from the shortest to the longest leg time, s, with neighbours at most a fifth apart.
    pub(super) fn timing(&self) -> LegTiming {
        let [shortest, longest] = self.scenario.generate.leg_time_s;
        LegTiming::ladder(shortest, longest)
    }

    /// Longest planned duration of a trajectory, s.
    /// ∞ where none is given.
    pub(super) fn longest(&self) -> f64 {
        self.scenario.generate.limits.max_time_s.unwrap_or(f64::INFINITY)
    }
}

impl Kind for BoatSetup {
    fn with(&self, simd: Simd, controller: Option<&AnyController>) -> Option<Arc<dyn Kind>> {
        let controller = match controller {
            Some(own) => Some(own.of::<Boat>()?),
            None => None,
        };
        Some(Arc::new(Self { simd, controller, ..self.clone() }))
    }
}

/// The boat of a resolved source.
///
/// # Errors
/// The robot's key that is out of bounds; a name that was not resolved before.
fn boat_of(source: &RobotSource<BoatDescription>) -> Result<Boat, Mistake> {
    let wrong = |key: String, value, bound| Mistake { key: format!("robot.{key}"), value, bound };
    source.resolved()?.build().map_err(|error| wrong(error.field, error.value, error.bound))
}
