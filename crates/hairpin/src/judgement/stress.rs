//! Stress: the one scalar of an execution that a search or a model is about, of a whole run and of each of its legs.
//!
//! One number a run, larger being worse for the robot: what searches that execute look for, and what random cases are
//! compared by. What is worst when it is least (clearance, tip-over margin) is turned.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{LegMeasures, Measures};

/// What is called stressful in execution; larger is worse.
///
/// All of [`Measures`] that a search may maximise. Of a run it is the judge's own number; of a leg that leg's, of which
/// the run's is the largest, the sum or the mean, as the measure is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Stress {
    /// Largest deviation from the reference, m.
    #[default]
    MaxDeviation,
    /// Mean deviation over time, m.
    MeanDeviation,
    /// Largest ‖dv/dt‖, m/s².
    MaxAcceleration,
    /// Time taken, s.
    Time,
    /// Largest overshoot at a waypoint, m.
    Overshoot,
    /// Share of actuator time at a limit, 0 … 1.
    Saturation,
    /// Least distance from obstacles, with its sign turned, m.
    Clearance,
    /// Of what stands on the ground the least angle by which it would have had to lean further to tip over, with its
    /// sign turned; of what flies the largest angle of its upward axis from the world's; degrees.
    Tilt,
    /// ∫ Σ q̈² dt over the joints of an arm, rad²/s³.
    JointEffort,
    /// How late the latest arrival at a waypoint is, by its planned time, s; of what has such times, the programs of
    /// arms.
    Lateness,
}

impl Stress {
    /// All of them.
    pub const ALL: [Stress; 10] = [
        Stress::MaxDeviation,
        Stress::MeanDeviation,
        Stress::MaxAcceleration,
        Stress::Time,
        Stress::Overshoot,
        Stress::Saturation,
        Stress::Clearance,
        Stress::Tilt,
        Stress::JointEffort,
        Stress::Lateness,
    ];

    /// The word in scenarios, files and on the command line.
    pub fn word(self) -> &'static str {
        match self {
            Stress::MaxDeviation => "max-deviation",
            Stress::MeanDeviation => "mean-deviation",
            Stress::MaxAcceleration => "max-acceleration",
            Stress::Time => "time",
            Stress::Overshoot => "overshoot",
            Stress::Saturation => "saturation",
            Stress::Clearance => "clearance",
            Stress::Tilt => "tilt",
            Stress::JointEffort => "joint-effort",
            Stress::Lateness => "lateness",
        }
    }

    /// The stress that `word` names.
    pub fn from_word(word: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|stress| stress.word() == word)
    }

    /// Unit of its values; empty for shares.
    pub fn unit(self) -> &'static str {
        match self {
            Stress::MaxDeviation | Stress::MeanDeviation | Stress::Overshoot | Stress::Clearance => "m",
            Stress::MaxAcceleration => "m/s²",
            Stress::Time | Stress::Lateness => "s",
            Stress::Saturation => "",
            Stress::Tilt => "°",
            Stress::JointEffort => "rad²/s³",
        }
    }

    /// Of a run; `None` where it was not measured.
    pub fn of(self, measures: &Measures) -> Option<f64> {
        match self {
            Stress::MaxDeviation => measures.deviation(),
            Stress::MeanDeviation => measures.deviation().map(|_| measures.mean_deviation),
            Stress::MaxAcceleration => measures.acceleration(),
            Stress::Time => Some(measures.total_time),
            Stress::Overshoot => Some(measures.max_overshoot()),
            Stress::Saturation => measures.saturation_share,
            Stress::Clearance => measures.min_clearance.map(|clearance| -clearance),
            Stress::Tilt => measures.min_tip_over_margin.map(|margin| -margin).or(measures.max_tilt),
            Stress::JointEffort => measures.joint_effort,
            Stress::Lateness => measures.latest.map(|latest| latest.by),
        }
    }

    /// Whether what was measured has its sign turned in it: of these less is worse.
    pub fn is_turned(self, measures: &Measures) -> bool {
        match self {
            Stress::Clearance => true,
            Stress::Tilt => measures.min_tip_over_margin.is_some(),
            _ => false,
        }
    }

    /// With its unit, as columns are named: `max_deviation_m`.
    pub fn column(self) -> String {
        let unit = match self.unit() {
            "" => "",
            "°" => "_deg",
            "m/s²" => "_m_s2",
            "s" => "_s",
            "rad²/s³" => "_rad2_s3",
            _ => "_m",
        };
        self.word().replace('-', "_") + unit
    }

    /// Of one leg of a run; `None` where it was not measured.
    pub fn of_leg(self, leg: &LegMeasures) -> Option<f64> {
        match self {
            Stress::MaxDeviation => Some(leg.max_deviation),
            Stress::MeanDeviation => Some(leg.mean_deviation),
            Stress::MaxAcceleration => Some(leg.max_acceleration),
            Stress::Time => Some(leg.time),
            Stress::Overshoot => Some(leg.overshoot),
            Stress::Saturation => leg.saturation_share,
            Stress::Clearance => leg.min_clearance.map(|clearance| -clearance),
            Stress::Tilt => leg.min_tip_over_margin.map(|margin| -margin).or(leg.max_tilt),
            Stress::JointEffort => leg.joint_effort,
            Stress::Lateness => leg.lateness,
        }
    }

    /// The leg that a run owes its stress to, the first of equals; `None` where no leg was measured.
    ///
    /// Where a search in the loop changes a trajectory, and where a report points.
    pub fn worst_leg(self, measures: &Measures) -> Option<usize> {
        if self == Stress::Lateness {
            return measures.latest.map(|latest| latest.leg);
        }
        let mut worst: Option<(usize, f64)> = None;
        for (number, leg) in measures.legs.iter().enumerate() {
            let Some(value) = self.of_leg(leg).filter(|value| !value.is_nan()) else { continue };
            if worst.is_none_or(|(_, most)| value > most) {
                worst = Some((number, value));
            }
        }
        worst.map(|(number, _)| number)
    }
}

#[cfg(feature = "unit-tests")]
mod tests {
    use super::*;
    use crate::judgement::Late;

    #[test]
    fn words_name_one_stress_each_and_legs_and_runs_agree() {
        let leg = |x: f64| LegMeasures {
            max_deviation: x,
            time: 2.0 * x,
            saturation_share: None,
            min_tip_over_margin: Some(30.0 - x),
            ..LegMeasures::default()
        };
        let legs = vec![leg(1.0), leg(3.0), leg(3.0), leg(2.0)];
        let measures = Measures { max_deviation: 3.0, min_tip_over_margin: Some(27.0), legs, ..Measures::default() };
        for stress in Stress::ALL {
            assert_eq!(Stress::from_word(stress.word()), Some(stress));
        }
        assert_eq!(Stress::from_word("deviation"), None);
        let columns = [Stress::MaxDeviation, Stress::Tilt, Stress::Saturation, Stress::JointEffort].map(Stress::column);
        assert_eq!(columns, ["max_deviation_m", "tilt_deg", "saturation", "joint_effort_rad2_s3"]);
        assert_eq!(Stress::MaxDeviation.worst_leg(&measures), Some(1), "the first of equals");
        assert_eq!(Stress::Tilt.of(&measures), Some(-27.0));
        assert_eq!(Stress::Tilt.worst_leg(&measures), Some(1));
        assert_eq!(Stress::Saturation.worst_leg(&measures), None);
        assert_eq!(Stress::Time.of_leg(&measures.legs[3]), Some(4.0));
        let late = |by| LegMeasures { lateness: Some(by), ..LegMeasures::default() };
        let legs = vec![late(0.01), LegMeasures::default(), late(0.03)];
        let latest = Some(Late { by: 0.03, at: 4.0, leg: 2 });
        let measures = Measures { latest, legs, ..Measures::default() };
        assert_eq!((Stress::Lateness.of(&measures), Stress::Lateness.worst_leg(&measures)), (Some(0.03), Some(2)));
        assert_eq!(Stress::Lateness.of_leg(&measures.legs[0]), Some(0.01));
        assert_eq!(Stress::Lateness.of(&Measures::default()), None, "without planned times nothing is late");
    }
}
