//! From a drive scenario's numbers to the vehicle and the ground they describe.

use std::sync::Arc;

use crate::campaign::attachments::Attachments;
use crate::campaign::bounds::LEAST_RADIUS_M;
use crate::campaign::kind::Kind;
use crate::campaign::own_controller::AnyController;
use crate::campaign::scenario::{
    DriveScenario, GeneratorName, GroundDescription, Mistake, NoData, ProfileName, RobotSource, TerrainSection,
};
use crate::feasibility::reach::drive::{DriveSettings as ReachSettings, DriveSite, Pace, Slopes};
use crate::feasibility::steering::shooting::{Curvatures, Precision, flat, rough};
use crate::math::simd::Simd;
use crate::robot::rover::{Rover, Suspension};
use crate::simulation::OwnController;
use crate::trajectory::Direction;
use crate::trajectory::drive::Planar;
use crate::world::terrain::generate::{Recipe, generate};
use crate::world::terrain::{ElevationMap, HoleRule, KeepOuts, MapError};

use super::Site;
use super::held::rollable;

/// Curvature that is none, 1/m: what is left to wheels that go as fast as they can.
///
/// It takes the place of a bound of 0, which rims at their full speed would leave.
const STRAIGHT: f64 = 1e-6;

/// Steepest ground that counts as level for a vehicle without a suspension, rad.
///
/// Along it a metre of the map is longer than one of the plane by 5·10⁻⁵: a centimetre in 200 m.
pub const LEVEL_GROUND: f64 = 0.01;

/// A resolved scenario of drives and what it describes.
///
/// What [`Setup::own`](crate::campaign::setup::Setup::own) gives for rovers, cars and differential drives.
#[derive(Debug, Clone)]
pub struct DriveSetup {
    /// Every key, the robot's table inline.
    pub scenario: Arc<DriveScenario>,
    /// What its files hold.
    pub attachments: Arc<Attachments>,
    /// The vehicle.
    /// As it is driven: with latency, lags and scales.
    pub rover: Arc<Rover>,
    /// The vehicle as plans have it ([`Response::as_planned`](crate::robot::rover::Response::as_planned)).
    /// Without latency, and as if its wheels answered as commanded, so that legs follow each other.
    pub planner: Arc<Rover>,
    /// The ground.
    pub map: Arc<ElevationMap>,
    /// Whether the map has slopes, and the vehicle no suspension that would say how it stands on them.
    pub(super) leaves_slopes_out: bool,
    /// Where nothing may drive.
    /// Of the scenario and of a case's environment.
    pub keep_out: Arc<KeepOuts>,
    /// A controller of the caller's own in the place of the scenario's.
    pub controller: Option<OwnController<Rover>>,
    /// Version of the kernels.
    pub simd: Simd,
}

impl DriveSetup {
    /// Commanded speed, m/s.
    ///
    /// The scenario's or else the robot's default, and no more than the robot's limit.
    pub fn speed(&self) -> f64 {
        commanded(&self.scenario, &self.rover)
    }

    /// No plan may be faster, m/s: the smaller of `generate.limits.speed_m_s` and the robot's limit.
    pub fn most_speed(&self) -> f64 {
        self.scenario.generate.limits.speed_m_s.unwrap_or(f64::INFINITY).min(self.rover.limits.speed)
    }

    /// Commanded rate of turns in place, rad/s: the outermost wheel goes at [`Self::speed`].
    ///
    /// v / r with r the distance of the outermost wheel from the origin, at least [`LEAST_RADIUS_M`].
    pub fn turn_rate(&self) -> f64 {
        let aside = self.rover.rims.map_or(0.0, |rims| 0.5 * rims.track);
        self.speed() / self.rover.suspension.outer_radius().max(aside).max(LEAST_RADIUS_M)
    }

    /// How speeds follow each other along a drive.
    ///
    /// Trapezoids where the acceleration is bounded and nothing else is asked for; else constant.
    ///
    /// Accelerations in m/s²; speeds through waypoints in m/s, [`Self::speed`] where no range is given.
    pub fn pace(&self) -> Pace {
        let given = &self.scenario.generate.speed;
        let acceleration = given.acceleration_m_s2.unwrap_or(self.rover.planned_acceleration(self.speed()));
        let slopes = Slopes { waypoints: given.waypoint_m_s.unwrap_or([self.speed(); 2]), acceleration };
        match given.profile {
            Some(ProfileName::Constant) => Pace::Constant,
            Some(ProfileName::Ramp) => Pace::Ramp(slopes),
            Some(ProfileName::Trapezoid) => Pace::Trapezoid(slopes),
            None if acceleration.is_finite() => Pace::Trapezoid(slopes),
            None => Pace::Constant,
        }
    }

    /// Least and greatest direction of travel in the body, rad.
    pub fn directions(&self) -> [f64; 2] {
        self.scenario.generate.direction_deg.bounds().map(f64::to_radians)
    }

    /// Bounds of the commands' curvature: the scenario's or the robot's at the commanded speed, whichever is smaller.
    ///
    /// 1/m and 1/m²; infinite where neither bounds. What the wheels may do is taken of it.
    pub fn bounds(&self) -> Curvatures {
        self.bounds_at(self.speed())
    }

    /// [`Self::bounds`] at `speed`, m/s.
    pub(super) fn bounds_at(&self, speed: f64) -> Curvatures {
        let acceleration = match self.pace() {
            Pace::Constant => 0.0,
            Pace::Ramp(slopes) | Pace::Trapezoid(slopes) => slopes.acceleration,
        };
        let (given, own) = (&self.scenario.generate.limits, self.rover.limits_at(speed, acceleration));
        let bounds = Curvatures {
            most: given.curvature_1_m.unwrap_or(f64::INFINITY).min(own.curvature.max(STRAIGHT)),
            most_rate: given.curvature_rate_1_m2.unwrap_or(f64::INFINITY).min(own.curvature_rate),
        };
        rollable(&bounds, &self.planner, speed, acceleration)
    }

    /// How fast the wheels turn straight ahead at `speed` (m/s), and how fast they may, rad/s, where that is less.
    pub(super) fn wheels_beyond(&self, speed: f64) -> Option<[f64; 2]> {
        let (turns, most) = (speed / self.planner.suspension.wheels(&[0.0; 3]).2, self.planner.wheels.speed);
        (turns > most).then_some([turns, most])
    }

    /// Largest tilt of a plan, rad.
    ///
    /// The scenario's or the robot's, whichever is smaller.
    pub fn tilt(&self) -> f64 {
        self.scenario.generate.limits.tilt_deg.map_or(f64::INFINITY, f64::to_radians).min(self.rover.limits.tilt)
    }

    /// Where drives begin.
    pub(super) fn start(&self) -> Planar {
        let start = &self.scenario.task.start;
        Planar { x: start.x_m, y: start.y_m, yaw: start.yaw_deg.to_radians(), curvature: start.curvature_1_m }
    }

    /// Radius of the circle about its origin that holds the vehicle, m.
    ///
    /// Keep-outs are grown by it.
    pub fn radius(&self) -> f64 {
        DriveSite::new(&self.planner, &self.map, &self.keep_out).radius
    }

    /// How exactly legs are solved on the ground.
    ///
    /// Iterations, and the precision of where a leg ends: m, rad and 1/m, as `generate.solver` has them.
    pub(super) fn leg_solver(&self) -> rough::Settings {
        let solver = &self.scenario.generate.solver;
        rough::Settings {
            iterations: solver.iterations as u32,
            precision: Precision { position: solver.position_m, yaw: solver.yaw_rad, curvature: solver.curvature_1_m },
            ..rough::Settings::default()
        }
    }

    /// The flat solver that shapes them.
    ///
    /// As the reach set has it for the planner, but for the number of starts and the version of the kernels.
    pub(super) fn flat_solver(&self) -> flat::Settings<'static> {
        let starts = self.scenario.generate.solver.starts as u32;
        flat::Settings { starts, simd: self.simd, ..ReachSettings::of(&self.planner).flat }
    }

    /// The vehicle on its ground at the commanded speed, travelling in `direction` of its body.
    ///
    /// With the planner's vehicle.
    ///
    /// Its speed is the constant one; speeds of a drive's legs follow from [`Self::pace`].
    pub fn site(&self, direction: Direction) -> Site<'_> {
        Site { rover: &self.planner, map: &self.map, speed: self.speed().into(), direction }
    }
}

impl DriveSetup {
    /// The vehicle of `keys`, and as plans have it: those of `known`, if they are described alike.
    ///
    /// In that order: `rover`, `planner`. The first one's bound of curvature is cut to what the commanded speed leaves
    /// without a change of speed; what the acceleration of a plan takes of κ′ besides is taken in [`Self::bounds`].
    ///
    /// # Errors
    /// The robot's key that is out of bounds; a name that was not resolved before.
    pub(super) fn rovers(keys: &DriveScenario, known: Option<&Self>) -> Result<[Arc<Rover>; 2], Mistake> {
        let kinematics = keys.generate.kinematics;
        if let Some(known) = known
            && (&known.scenario.robot, known.scenario.generate.kinematics) == (&keys.robot, kinematics)
            && known.scenario.generate.limits.speed_m_s == keys.generate.limits.speed_m_s
        {
            return Ok([known.rover.clone(), known.planner.clone()]);
        }
        let mut rover = Rover { kinematics, ..rover_of(&keys.robot)? };
        // What it can bend at the speed that is commanded; what is left for steering depends on the plan.
        rover.limits.curvature = rover.limits_at(commanded(keys, &rover), 0.0).curvature;
        let planner = planner_of(&rover);
        Ok([rover, planner].map(Arc::new))
    }

    /// Ground that is generated is made once, and shared by all draws that do not change it.
    ///
    /// # Errors
    /// The key that is out of bounds; a file that was not read before.
    pub(super) fn map(
        keys: &DriveScenario,
        files: &Attachments,
        known: Option<&Self>,
    ) -> Result<Arc<ElevationMap>, Mistake> {
        let terrain = &keys.world.terrain;
        match known {
            Some(known) if (&known.scenario.world.terrain, known.scenario.seed) == (terrain, keys.seed) => {
                Ok(known.map.clone())
            }
            _ => map_of(terrain, keys.seed, files),
        }
    }

    /// Whether `rover` has no suspension, and `map` slopes; of a map that is known it is known.
    pub(super) fn slopes_left_out(rover: &Rover, map: &Arc<ElevationMap>, known: Option<&Self>) -> bool {
        if rover.suspension != Suspension::Level {
            return false;
        }
        let same = |known: &&Self| Arc::ptr_eq(&known.map, map) && known.rover.suspension == Suspension::Level;
        known.filter(same).map_or_else(|| map.is_steeper_than(LEVEL_GROUND), |known| known.leaves_slopes_out)
    }

    /// The keep-outs of `keys`, likewise.
    ///
    /// # Errors
    /// The keep-out that is no place: without a shape or with two, or of numbers that are none.
    pub(super) fn keep_out(keys: &DriveScenario, known: Option<&Self>) -> Result<Arc<KeepOuts>, Mistake> {
        match known {
            Some(known) if known.scenario.world.keep_out == keys.world.keep_out => Ok(known.keep_out.clone()),
            _ => keys.world.keep_outs().map(Arc::new),
        }
    }
}

impl Kind for DriveSetup {
    /// `None` for a controller that steers another kind of robot. The map and the robots are shared, not copied.
    fn with(&self, simd: Simd, controller: Option<&AnyController>) -> Option<Arc<dyn Kind>> {
        let controller = match controller {
            Some(own) => Some(own.of::<Rover>()?),
            None => None,
        };
        Some(Arc::new(Self { simd, controller, ..self.clone() }))
    }
}

/// The vehicle of a resolved source.
///
/// # Errors
/// The robot's key that is out of bounds; a name that was not resolved before.
fn rover_of(source: &RobotSource<GroundDescription>) -> Result<Rover, Mistake> {
    source.resolved()?.build().map_err(|wrong| Mistake {
        key: format!("robot.{}", wrong.field),
        value: wrong.value,
        bound: wrong.bound,
    })
}

/// The scenario's speed or else the robot's default, and no more than the robot's limit, m/s.
fn commanded(keys: &DriveScenario, rover: &Rover) -> f64 {
    keys.generate.limits.speed_m_s.unwrap_or(rover.default_speed).min(rover.limits.speed)
}

/// `rover` as plans have it.
///
/// Only its response differs; mass, limits and suspension are the same, so that both stand alike on the same ground.
fn planner_of(rover: &Rover) -> Rover {
    Rover { response: rover.response.as_planned(), ..rover.clone() }
}

/// The ground of a section; `seed` is the scenario's.
///
/// A generator's seed is the scenario's where the section has none of its own.
///
/// # Errors
/// The key that is out of bounds; a file that was not read before.
///
/// What a recipe leaves open has the recipe's own default. `flat` is ground without relief, rocks and craters,
/// `fractal` ground without craters.
fn map_of(terrain: &TerrainSection, seed: u64, files: &Attachments) -> Result<Arc<ElevationMap>, Mistake> {
    if let Some(map) = files.map(terrain) {
        return Ok(map.clone());
    }
    let Some(generator) = terrain.generator else {
        return Err(Mistake {
            key: "world.terrain".into(),
            value: terrain.file.clone().map_or_else(|| "{}".into(), |file| format!("\"{file}\"")),
            bound: "a file that was read first, or a generator".into(),
        });
    };
    let seed = terrain.seed.unwrap_or(seed);
    let mut recipe = Recipe { seed, ..Recipe::default() };
    recipe.size_m = terrain.size_m.unwrap_or(recipe.size_m);
    recipe.cell_m = terrain.cell_m.unwrap_or(recipe.cell_m);
    recipe.relief_m = terrain.relief_m.unwrap_or(recipe.relief_m);
    recipe.rock_cover = terrain.rock_cover.unwrap_or(recipe.rock_cover);
    match generator {
        GeneratorName::Craters => {}
        GeneratorName::Fractal => recipe.least_crater_m = f64::INFINITY,
        GeneratorName::Flat => {
            (recipe.least_crater_m, recipe.relief_m, recipe.rock_cover) = (f64::INFINITY, 0.0, 0.0);
        }
    }
    generate(&recipe).map(Arc::new).map_err(|error| match error {
        MapError::Grid { field, value, bound } => {
            Mistake { key: format!("world.terrain.{field}"), value, bound: bound.into() }
        }
        other => Mistake { key: "world.terrain".into(), value: other.to_string(), bound: "a map".into() },
    })
}

impl From<NoData> for HoleRule {
    fn from(rule: NoData) -> Self {
        match rule {
            NoData::Error => Self::Error,
            NoData::KeepOut => Self::KeepOut,
            NoData::Fill => Self::Fill,
        }
    }
}
