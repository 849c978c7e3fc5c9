//! What a ground vehicle may do on its legs, and how hard legs are looked for.

use std::f64::consts::FRAC_PI_2;

use super::pace::Pace;
use super::stress::GroundScore;
use crate::feasibility::steering::clear::footprint;
use crate::feasibility::steering::shooting::rough::{Course, Steps};
use crate::feasibility::steering::shooting::{Control, Curvatures, families, flat, rough};
use crate::math::random::hashed_unit;
use crate::robot::rover::Rover;
use crate::trajectory::drive::Gear;
use crate::trajectory::{Direction, SpeedProfile};
use crate::world::terrain::{ElevationMap, KeepOuts};

/// A vehicle on a map, and where it must not go.
///
/// `radius` is the circle about the body's origin that holds wheels and underside in every heading.
#[derive(Debug, Clone, Copy)]
pub struct DriveSite<'a> {
    /// The vehicle. Without a suspension it drives in the plane, over whatever the map says.
    pub rover: &'a Rover,
    /// What it drives on.
    pub map: &'a ElevationMap,
    /// Where it must not go.
    pub keep_outs: &'a KeepOuts,
    /// Distance that its origin keeps from them, m.
    pub radius: f64,
}

impl<'a> DriveSite<'a> {
    /// `rover` keeps all of itself out of `keep_outs`, whichever way it turns.
    ///
    /// `radius` is the vehicle's footprint.
    pub fn new(rover: &'a Rover, map: &'a ElevationMap, keep_outs: &'a KeepOuts) -> Self {
        Self { rover, map, keep_outs, radius: footprint(rover) }
    }
}

/// Which ways of driving a leg may use; they are tried in this order and the first that keeps all limits is the leg.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Manoeuvres {
    /// Forward.
    pub forward: bool,
    /// Whole legs in reverse; with `forward`, changes of gear on the way as well.
    pub reverse: bool,
    /// Turns on the spot before and after a straight line.
    pub turn_in_place: bool,
}

/// What a drive keeps to all along.
///
/// Looked at along the predicted motion every 3 cm or 0.03 rad at most, and again in a tenth of that where tilt or
/// joints came near a limit.
///
/// Tilt and joints are held with 0.002 rad of room for what lies between looks.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DriveLimits {
    /// Largest angle between the body's z axis and the vertical, rad; infinite: none.
    pub tilt: f64,
    /// Largest |rocker or bogie angle|, rad; infinite: none.
    pub joint: f64,
    /// Least height of the body's underside over the ground, m; −∞: none.
    pub clearance: f64,
    /// Whether the wheels keep what they may do.
    pub wheels: bool,
}

/// How a roadmap of drives is drawn and solved.
#[derive(Debug, Clone, PartialEq)]
pub struct DriveSettings {
    /// Least and greatest distance between the waypoints of a leg, as the crow flies, m.
    pub leg_m: [f64; 2],
    /// Headings per waypoint, M; 0 is taken as 1.
    pub headings: usize,
    /// Longest drive of a leg by the distance between its waypoints; what must be longer is refused unsolved.
    pub detour: f64,
    /// Commanded speed, m/s, > 0.
    pub speed: f64,
    /// Commanded rate of turns in place, rad/s, > 0.
    pub turn_rate: f64,
    /// Least and greatest direction of travel in the body, rad: 0 along x, left positive. Each waypoint has one of its
    /// own, drawn evenly, and along a leg it turns evenly from one to the other.
    pub directions: [f64; 2],
    /// Which ways of driving there are.
    pub manoeuvres: Manoeuvres,
    /// What paths may bend.
    pub bounds: Curvatures,
    /// What the body keeps to.
    pub limits: DriveLimits,
    /// How speeds follow each other. Without [`Pace::Constant`], a drive begins and ends at rest.
    pub pace: Pace,
    /// The controls of legs in one gear. Arcs need turns in place: their headings are as they come.
    pub control: Control,
    /// How exactly goals are met on the ground.
    pub solver: rough::Settings,
    /// The flat solver's choices. Its precision should be far finer than the one on the ground.
    pub flat: flat::Settings<'static>,
    /// The choices of the families of controls that have a search of their own.
    pub families: families::Settings,
    /// What makes a leg stressful.
    pub score: GroundScore,
    /// Seed of the headings.
    pub seed: u64,
}

/// Stream of the waypoints' directions beside that of pairs of waypoints.
const DIRECTIONS: u64 = u64::MAX - 1;
/// Precision of the flat solver where drives are shaped for the ground, m, rad, 1/m.
const FLAT: f64 = 1e-5;

impl DriveSettings {
    /// Those of `rover`: its speed, its bounds and limits, forward drives between 2 m and 6 m, scored by slope and
    /// slip.
    pub fn of(rover: &Rover) -> Self {
        let limits = &rover.limits;
        let mut flat = flat::Settings::default();
        flat.precision = flat.precision.share(FLAT / flat.precision.position);
        Self {
            leg_m: [2.0, 6.0],
            headings: 4,
            detour: 1.5,
            speed: rover.default_speed,
            turn_rate: rover.default_speed * limits.curvature,
            directions: [0.0; 2],
            manoeuvres: Manoeuvres { forward: true, reverse: false, turn_in_place: false },
            bounds: Curvatures { most: limits.curvature, most_rate: limits.curvature_rate },
            limits: DriveLimits { tilt: limits.tilt, joint: limits.joint, clearance: f64::NEG_INFINITY, wheels: true },
            pace: Pace::Constant,
            control: Control::default(),
            solver: rough::Settings::default(),
            flat,
            families: families::Settings::default(),
            score: GroundScore::default(),
            seed: 0,
        }
    }

    /// The tilt that scores 1, rad: the limit, or on end where there is none.
    pub(super) fn full_tilt(&self) -> f64 {
        self.limits.tilt.min(FRAC_PI_2)
    }

    /// Whether waypoints this far apart (m) may have a leg.
    pub(super) fn is_a_leg(&self, distance: f64) -> bool {
        (self.leg_m[0]..=self.leg_m[1]).contains(&distance)
    }

    /// The speed that waypoint `index` wishes for, m/s.
    pub(super) fn wish(&self, index: usize) -> f64 {
        self.pace.wish(self.speed, self.seed, index)
    }

    /// The gear that drives prefer.
    pub(super) fn gear(&self) -> Gear {
        if self.manoeuvres.forward || !self.manoeuvres.reverse { Gear::Forward } else { Gear::Reverse }
    }

    /// The direction in which waypoint `index` is passed, rad.
    pub(super) fn direction_at(&self, index: usize) -> f64 {
        let [low, high] = self.directions;
        low + (high - low) * hashed_unit(self.seed, &[DIRECTIONS, index as u64])
    }

    /// What the predictor is asked: looks at most `steps` apart, and closer where commands change fast or the steering
    /// lags.
    pub(super) fn course<'a>(
        &self,
        site: &DriveSite<'a>,
        steps: Steps,
        speed: SpeedProfile,
        direction: Direction,
    ) -> Course<'a, ElevationMap> {
        let lag = site.rover.response.steering_time_constant * speed.top();
        let steps = steps.for_rate(self.bounds.most_rate).for_lag(lag);
        Course { rover: site.rover, terrain: site.map, speed, direction, steps }
    }
}
