//! Which of our controllers drives.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::trajectory::Direction;
use crate::trajectory::drive::{Gear, Planar, SegmentList};

/// Solves for the commands of one gear that lead the nominal vehicle, lags included but without latency, from a pose
/// and curvature to another, both in the world, while its direction of travel turns evenly; `None`: no answer.
///
/// Curvatures in 1/m, directions in rad; called once a cycle, from the run's own thread.
pub type Resolve<'a> = dyn Fn(&Planar, &Planar, Gear, Direction) -> Option<SegmentList> + Sync + 'a;

/// The controllers of ground vehicles.
///
/// | word | law | source |
/// | --- | --- | --- |
/// | `pure-pursuit` | κ = 2y/D² to a point ahead | Coulter 1992 |
/// | `stanley` | δ = Δχ − atan(e/d) of the leading axle | Thrun et al. 2006 |
/// | `predictive` | boundary-value drive to a point ahead | Howard and Kelly 2007 |
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum GroundControllerKind {
    /// Steers along the circle to a point of the path ahead.
    PurePursuit,
    /// Steers by heading and distance of a leading axle from its path.
    Stanley,
    /// Solves anew to the path ahead, from where the vehicle will be when the answer acts.
    Predictive,
}

impl GroundControllerKind {
    /// The word in scenarios.
    pub fn word(self) -> &'static str {
        match self {
            GroundControllerKind::PurePursuit => "pure-pursuit",
            GroundControllerKind::Stanley => "stanley",
            GroundControllerKind::Predictive => "predictive",
        }
    }
}

/// Which controller drives.
#[derive(Clone, Copy)]
pub enum GroundController<'a> {
    /// [`GroundControllerKind::PurePursuit`].
    PurePursuit,
    /// [`GroundControllerKind::Stanley`].
    Stanley,
    /// [`GroundControllerKind::Predictive`] with its solver.
    Predictive(&'a Resolve<'a>),
}

impl GroundController<'_> {
    /// The word in scenarios.
    pub(in crate::simulation::ground) fn word(&self) -> &'static str {
        match self {
            GroundController::PurePursuit => GroundControllerKind::PurePursuit,
            GroundController::Stanley => GroundControllerKind::Stanley,
            GroundController::Predictive(_) => GroundControllerKind::Predictive,
        }
        .word()
    }
}
