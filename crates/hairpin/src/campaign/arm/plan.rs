//! The planned motion of a program: its path with its zones, in the time that the virtual controller plans for it.

use super::ArmSetup;
use super::execute::program_of;
use crate::campaign::scenario::ArmMode;
use crate::campaign::{Case, PlanError};
use crate::robot::arm::{AXES, Joints};
use crate::simulation::SimulationError;
use crate::simulation::arm::{Plan, RunSettings};
use crate::trajectory::{Channel, PlannedPath, Track};

impl ArmSetup {
    /// The path of the program of `case`, blends and all, and where its moves end.
    ///
    /// # Errors
    /// A program that cannot be planned.
    pub(super) fn planned_path(&self, case: &Case) -> Result<PlannedPath, SimulationError> {
        self.of_plan(case, |plan| plan.path())
    }

    /// The same as a motion: with velocities, on rows that the motion between them holds for.
    ///
    /// # Errors
    /// As [`Self::planned_path`].
    fn planned_motion(&self, case: &Case) -> Result<PlannedPath, SimulationError> {
        self.of_plan(case, |plan| plan.motion())
    }

    fn of_plan<T>(&self, case: &Case, of: impl FnOnce(&Plan<'_>) -> T) -> Result<T, SimulationError> {
        let orders = self.orders(program_of(case)?)?;
        let plan = Plan::new(&self.station.arm, &self.station.home, &orders, &self.plan_settings())?;
        match plan.stop() {
            Some(stop) => Err(SimulationError::new(
                "program",
                format!("{} at {:.0} % of {}", stop.reason, 100.0 * stop.share, orders[stop.order].name),
                match self.scenario.generate.mode {
                    ArmMode::Joint => "one that the arm can follow",
                    ArmMode::Cartesian => {
                        "one that the arm can follow, which generate.mode = \"cartesian\" does not look at and \"joint\" does"
                    }
                },
            )),
            None => Ok(of(&plan)),
        }
    }

    /// Times (s) and joint angles (rad) of the planned motion of the program of `case`, every `sample` s: no lag, no
    /// noise.
    ///
    /// # Errors
    /// A program that cannot be planned, or that the arm cannot follow to its end.
    pub fn planned_joints(&self, case: &Case, sample: f64) -> Result<(Vec<f64>, Vec<Joints>), SimulationError> {
        self.planned_path(case)?;
        let orders = self.orders(program_of(case)?)?;
        let plan = Plan::new(&self.station.arm, &self.station.home, &orders, &self.plan_settings())?;
        let usual = RunSettings::default();
        let settings =
            RunSettings { sample, interpolation: usual.interpolation.min(sample), lags: [0.0; AXES], ..usual };
        let recording = plan.execute(&settings, &[], 0)?.recording;
        let columns: Vec<&[f64]> = (1..=AXES).filter_map(|axis| recording.channel(&format!("q{axis}_rad"))).collect();
        let joints = |i: usize| std::array::from_fn(|axis| columns.get(axis).map_or(f64::NAN, |column| column[i]));
        Ok((recording.times().to_vec(), (0..recording.len()).map(joints).collect()))
    }
}

/// How often the joints of a plan are computed for its picture, s.
const DRAWN: f64 = 0.02;

/// `planned` with `q1_rad` … `q6_rad` at its stamps; as it is where the arm cannot follow its program to the end.
pub(super) fn posed(setup: &ArmSetup, case: &Case, planned: Track) -> Track {
    let Ok((times, joints)) = setup.planned_joints(case, DRAWN) else { return planned };
    let at = |t: f64, axis: usize| {
        let after = times.partition_point(|time| *time < t).clamp(1, times.len() - 1);
        let (a, b) = (joints[after - 1][axis], joints[after][axis]);
        let share = (t - times[after - 1]) / (times[after] - times[after - 1]);
        a + share.clamp(0.0, 1.0) * (b - a)
    };
    if times.len() < 2 {
        return planned;
    }
    let turned = (0..AXES).map(|axis| Channel {
        name: format!("q{}_rad", axis + 1),
        values: planned.times().iter().map(|t| at(*t, axis)).collect(),
    });
    let channels = planned.channels().iter().cloned().chain(turned).collect();
    Track::new(planned.times().to_vec(), planned.poses().to_vec(), channels).unwrap_or(planned)
}

/// The planned motion with the channels `leg`, `vx_m_s`, `vy_m_s`, `vz_m_s`, which are the tool's own by its joints'.
///
/// # Errors
/// A program that cannot be planned, as a folder that was edited may hold.
pub(super) fn track(setup: &ArmSetup, case: &Case) -> Result<Track, PlanError> {
    let planned = setup.planned_motion(case)?;
    let motion = planned.track();
    let leg = |i: usize| planned.moves().partition_point(|m| m.end < i).min(planned.moves().len().saturating_sub(1));
    let legs = Channel { name: "leg".into(), values: (0..motion.len()).map(|i| leg(i) as f64).collect() };
    let channels = std::iter::once(legs).chain(motion.channels().iter().cloned()).collect();
    Ok(Track::new(motion.times().to_vec(), motion.poses().to_vec(), channels)?)
}
