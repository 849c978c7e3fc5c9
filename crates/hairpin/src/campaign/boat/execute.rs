//! Sails missions in our own simulator.

use super::BoatSetup;
use crate::campaign::Case;
use crate::campaign::kind::{Act, Order, Same};
use crate::campaign::placement::Placement;
use crate::simulation::SimulationError;
use crate::simulation::boat::{
    BoatConditions, BoatController, BoatControllerKind, BoatSortie, SailSettings, sail, sail_with,
};
use crate::trajectory::{Flight, Track};
use crate::world::terrain::KeepOuts;

impl Act for BoatSetup {
    /// Plans know `nominal`'s boat; this setup's is the one that sails. The current acts on both; force and noise on
    /// this run alone.
    ///
    /// Without a scenario's word the controller is `line-of-sight`. Leaving the waters ends a run only with
    /// `execute.walls` and where the order has obstacles at all.
    fn run(&self, nominal: Same, case: &Case, order: &Order) -> Result<Flight, SimulationError> {
        let nominal: &Self = nominal.setup();
        let execute = &self.scenario.execute;
        let nothing = KeepOuts::default();
        let sortie = BoatSortie {
            boat: &self.boat,
            nominal: &nominal.boat,
            size: self.scenario.world.size_m,
            keep_outs: if order.obstacles { &self.keep_out } else { &nothing },
            waypoints: order.waypoints,
            profile: case.profile(),
        };
        let conditions = BoatConditions {
            current: self.scenario.world.current(),
            external_force: execute.external_force_n.unwrap_or_default(),
            noise: execute.noise,
        };
        let settings = SailSettings {
            accept: order.accept,
            time_limit: order.time_limit,
            walls: execute.walls && order.obstacles,
            ..SailSettings::default()
        };
        if let Some(own) = &self.controller {
            return sail_with(&sortie, own, &conditions, &settings, order.seed);
        }
        let kind = execute.controller_in_force().unwrap_or(BoatControllerKind::LineOfSight);
        let controller = BoatController { kind, speed: execute.speed_m_s };
        sail(&sortie, &controller, &conditions, &settings, order.seed)
    }

    /// Nothing is placed in the way of boats.
    fn place(&self, _: &Case, _: &Track) -> Option<Placement> {
        None
    }
}
