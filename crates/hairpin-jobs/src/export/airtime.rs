//! How long a flight of the day takes, from take-off to landing: as its `.plan` flies it, by the speeds in it.

use hairpin::campaign::Case;
use hairpin_formats::qgc::mission::Autopilot;
use nalgebra::Point3;

use super::speeds::HOMEWARD;
use super::way::Way;

/// Speed of take-off where nobody said otherwise, m/s: `MPC_TKO_SPEED` of PX4; an ArduPilot's is faster.
const UP: f64 = 1.5;
/// Speed of coming down, m/s, `MPC_Z_V_AUTO_DN` or `WPNAV_SPEED_DN`, to the height (m) above the ground that landing
/// begins at.
const DOWN: f64 = 1.5;
const LANDING_FROM: f64 = 10.0;
/// Speed of landing, m/s: `MPC_LAND_SPEED` of PX4, `LAND_SPEED` of ArduPilot.
const LANDING: [f64; 2] = [0.7, 0.5];

/// The parts of a flight, s each.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct AirTime {
    climb: f64,
    mission: f64,
    home: f64,
    landing: f64,
}

impl AirTime {
    /// Of `case`, whose legs go at `speeds`, and whose worst run took `flown` s until it ended, however it did; at
    /// `share` of the speeds.
    ///
    /// The mission is the longest of that, of its plan, and of its legs at their speeds: who crashed was not done.
    pub(super) fn of(
        (case, way): (&Case, &Way),
        (speeds, flown): (&[Option<f64>], f64),
        (share, autopilot): (f64, Autopilot),
    ) -> Self {
        let lengths = case.waypoints.windows(2).map(|leg| (leg[1] - leg[0]).norm());
        let at_speeds: f64 = lengths.zip(speeds).filter_map(|(length, speed)| Some(length / (*speed)?)).sum();
        let planned: f64 = case.leg_times.iter().sum();
        let mission = planned.max(at_speeds).max(flown) / share;
        let (Some(start), Some(end), Some(land)) = (case.waypoints.first(), case.waypoints.last(), way.land) else {
            return Self { climb: 0.0, mission, home: 0.0, landing: 0.0 };
        };
        let homeward =
            speeds.iter().rev().find_map(|speed| *speed).map_or(HOMEWARD, |speed| HOMEWARD.min(share * speed));
        let chain: Vec<Point3<f64>> = std::iter::once(*end).chain(way.back.iter().copied()).collect();
        let back: f64 = chain.windows(2).map(|leg| (leg[1] - leg[0]).norm()).sum();
        let above = (way.back.last().unwrap_or(end).z - land.z).max(0.0);
        let low = above.min(LANDING_FROM);
        let landing = LANDING[usize::from(autopilot == Autopilot::ArduPilot)];
        Self {
            climb: (start.z - way.home.z).max(0.0) / UP,
            mission,
            home: back / homeward,
            landing: (above - low) / DOWN + low / landing,
        }
    }

    /// All of it, s.
    pub(super) fn total(&self) -> f64 {
        self.climb + self.mission + self.home + self.landing
    }

    /// Its parts in words; the mission alone of what does not fly.
    pub(super) fn words(&self, flies: bool) -> String {
        let Self { climb, mission, home, landing } = self;
        if !flies {
            return format!("{mission:.0} s; the way to the start and back is not counted");
        }
        format!(
            "{:.0} s as the .plan flies it: climb {climb:.0} s, mission {mission:.0} s, way home {home:.0} s, landing \
             {landing:.0} s",
            self.total()
        )
    }
}

#[cfg(test)]
mod tests {
    use hairpin::campaign::CaseNumber;

    use super::*;

    #[test]
    fn a_long_way_home_counts_as_it_is_flown() {
        let places = [[5.0, 5.0, 50.0], [405.0, 5.0, 50.0]].map(Point3::from);
        let mut case = Case::bare(CaseNumber(0), 1, places.to_vec());
        let home = Point3::new(5.0, 5.0, 0.0);
        let way = Way { home, back: vec![Point3::new(5.0, 5.0, 50.0)], land: Some(home), blocked: None };
        let time = |case: &Case, way: &Way, flown, share, autopilot| {
            AirTime::of((case, way), (&[Some(4.0)], flown), (share, autopilot))
        };
        // 50 m up, 400 m at 4 m/s, 400 m home at 2 m/s, 40 m down and 10 m of landing.
        let whole = time(&case, &way, 3.0, 1.0, Autopilot::Px4);
        let landing = 40.0 / 1.5 + 10.0 / 0.7;
        assert_eq!(whole, AirTime { climb: 50.0 / 1.5, mission: 100.0, home: 200.0, landing });
        assert!(whole.words(true).starts_with("374 s") && whole.words(false).starts_with("100 s"));
        assert!(time(&case, &way, 3.0, 1.0, Autopilot::ArduPilot).total() > whole.total() + 5.0);
        // Slowly: 1.2 m/s are slower than the way home is otherwise.
        let slow = time(&case, &way, 3.0, 0.3, Autopilot::Px4);
        assert!((slow.mission - 100.0 / 0.3).abs() < 1e-9 && (slow.home - 400.0 / 1.2).abs() < 1e-9, "{slow:?}");
        // A run that crashed after 3 s had planned 130 s; one that came home took 140 s.
        case.leg_times = vec![130.0];
        assert_eq!(time(&case, &way, 3.0, 1.0, Autopilot::Px4).mission, 130.0);
        assert_eq!(time(&case, &way, 140.0, 1.0, Autopilot::Px4).mission, 140.0);
        // What does not fly has its mission.
        let ground = Way { back: Vec::new(), land: None, ..way };
        assert_eq!(time(&case, &ground, 3.0, 1.0, Autopilot::Px4).total(), 130.0);
    }
}
