//! What a mission asks of how it is carried out, beside its places, held against how it is.
//!
//! | asked | carried out |
//! | --- | --- |
//! | acceptance radius of a waypoint | `execute.accept_m`, one for all |
//! | speed of a leg | the controller's own, or a plan's that holds it, where who executes keeps to plans |

use hairpin::campaign::Setup;

use super::leg::Leg;

/// Speeds of missions are often written in cm/s, and rounded to these.
const ROUNDING_M_S: f64 = 0.006;
/// Radii are written to hundredths of a millimetre.
const ROUNDING_M: f64 = 1e-4;

/// What `leg` asks that is not done, with the keys that do it, where there are any; empty where all is.
pub(super) fn unmet(setup: &Setup, leg: &Leg) -> Vec<String> {
    radius(setup, leg).into_iter().chain(speeds(setup, leg)).collect()
}

/// Whether its speeds are held by the plan that its check found, which who executes keeps to.
pub(super) fn takes_speeds_of_plan(setup: &Setup, leg: &Leg) -> bool {
    let by_plan = setup.room().is_some_and(|room| room.timed && room.speed.is_none());
    by_plan && !demanded(leg).is_empty() && is_held(leg)
}

/// Whether a plan was found that holds its speeds.
fn is_held(leg: &Leg) -> bool {
    let witness = leg.checked.as_ref().and_then(|checked| checked.passage.witness.as_ref());
    witness.is_some_and(|passed| passed.waypoints.len() == leg.waypoints.len())
}

/// The radii of the waypoints that are gone to, where one differs from what counts here.
fn radius(setup: &Setup, leg: &Leg) -> Option<String> {
    let own = setup.scenario.executor().accept;
    let [first, last] = leg.ends;
    let named = |waypoint: usize| Some((waypoint, leg.mission.accept.get(waypoint).copied().flatten()?));
    let named: Vec<(usize, f64)> = (first + 1..=last).filter_map(named).collect();
    let (waypoint, asked) = named.iter().find(|(_, asked)| (asked - own).abs() > ROUNDING_M)?;
    let alike = named.iter().all(|(_, other)| (other - asked).abs() <= ROUNDING_M);
    let remedy = match alike {
        true => format!("--set execute.accept_m={asked} executes it so"),
        false => "its waypoints have several, and one counts for all of them here".into(),
    };
    let told = leg.mission.told(*waypoint);
    Some(format!("{told} is reached within {asked} m by the mission (params[1]), and {own} m count: {remedy}"))
}

/// The speeds that are demanded of legs.
fn demanded(leg: &Leg) -> Vec<f64> {
    let [first, last] = leg.ends;
    leg.mission.speeds.get(first..last).unwrap_or_default().iter().copied().flatten().collect()
}

/// The speeds that are demanded, where they are not what is executed.
fn speeds(setup: &Setup, leg: &Leg) -> Option<String> {
    let asked = demanded(leg);
    let room = setup.room()?;
    let off = |own: f64| asked.iter().find(|speed| (*speed - own).abs() > ROUNDING_M_S);
    let (speed, how) = match room.speed {
        Some(own) => (off(own)?, format!("it is executed at {own} m/s")),
        None if room.timed && is_held(leg) => return None,
        None if room.timed => (asked.first()?, "no plan that holds them was found".into()),
        None => (asked.first()?, "who executes it goes at a pace of its own".into()),
    };
    let alike = asked.iter().all(|other| (other - speed).abs() <= ROUNDING_M_S);
    let remedy = match (room.flies, is_held(leg), alike) {
        (true, true, _) => "; --set 'execute.controller=\"geometric\"' keeps to the plan that holds them".into(),
        (true, false, true) => format!(
            "; --set 'execute.controller=\"fixed-velocity\"' --set execute.fixed_velocity_m_s={speed} executes it so"
        ),
        _ => String::new(),
    };
    Some(format!("the mission demands {speed} m/s (command 178), and {how}{remedy}"))
}

#[cfg(test)]
mod tests {
    use hairpin::campaign::{Case, CaseNumber, mission};
    use hairpin_formats::scenario::{setup_for, setup_for_missions};
    use nalgebra::Point3;

    use super::super::read;
    use crate::Unwatched;

    const PLAN: &str = include_str!("../../../hairpin-formats/tests/fixtures/missions/cage.plan");

    fn sets(given: &[(&str, &str)]) -> Vec<(String, String)> {
        given.iter().map(|(key, value)| ((*key).to_owned(), (*value).to_owned())).collect()
    }

    fn unmet_of(plan: &str, given: &[(&str, &str)]) -> Vec<String> {
        let place = tempfile::tempdir().unwrap();
        let file = place.path().join("a.plan");
        std::fs::write(&file, plan).unwrap();
        let setup = setup_for("demo-quadrotor", &sets(given)).unwrap();
        read(&setup, &file, &Unwatched).unwrap().into_iter().flat_map(|leg| leg.unmet).collect()
    }

    /// 3 m/s are demanded, and 1 m counts.
    #[test]
    fn a_speed_that_is_not_executed_is_told_with_the_key_that_does_it() {
        let (key, tracks) = ("execute.controller", ("execute.controller", "\"geometric\""));
        let told = unmet_of(PLAN, &[]);
        assert!(told.len() == 1 && told[0].contains("demands 3 m/s") && told[0].contains("geometric"), "{told:?}");
        assert_eq!(unmet_of(PLAN, &[tracks]), Vec::<String>::new());
        let at = |speed| [(key, "\"fixed-velocity\""), ("execute.fixed_velocity_m_s", speed)];
        assert_eq!(unmet_of(PLAN, &at("3.0")), Vec::<String>::new());
        assert!(unmet_of(PLAN, &at("2.0"))[0].contains("executed at 2 m/s"));
        assert!(unmet_of(PLAN, &[(key, "\"px4-mission\"")])[0].contains("executed at 5 m/s"));
        // Nothing is demanded.
        assert_eq!(unmet_of(&PLAN.replace("\"command\": 178", "\"command\": 203"), &[]), Vec::<String>::new());
    }

    #[test]
    fn a_radius_that_does_not_count_is_told_with_the_key_that_does_it() {
        let tracks = ("execute.controller", "\"geometric\"");
        let wide = PLAN.replace("[0, 1, 0, null", "[0, 6, 0, null");
        let told = unmet_of(&wide, &[tracks]);
        assert!(told.len() == 1 && told[0].contains("--set execute.accept_m=6 "), "{told:?}");
        assert!(told[0].contains("(item 3)"), "{told:?}");
        assert_eq!(unmet_of(&wide, &[tracks, ("execute.accept_m", "6.0")]), Vec::<String>::new());
        let several = unmet_of(&PLAN.replacen("[0, 1, 0, null", "[0, 6, 0, null", 1), &[tracks]);
        assert!(several.len() == 1 && several[0].contains("its waypoints have several"), "{several:?}");
    }

    #[test]
    fn a_long_leg_has_the_time_that_it_takes() {
        let of = |far: f64| {
            let given = [("world", "{ size_m = [200, 20, 20] }"), ("execute.controller", "\"px4-mission\"")];
            let setup = setup_for_missions("quadrotor", &sets(&given)).unwrap();
            let ends = vec![Point3::new(5.0, 5.0, 5.0), Point3::new(5.0 + far, 5.0, 5.0)];
            mission(&setup, &Case::bare(CaseNumber(0), 1, ends), 0).unwrap().time_limit
        };
        // 9 s a waypoint; half as long again as 190 m at 5 m/s take.
        assert!((of(20.0) - 18.0).abs() < 1e-9 && (of(190.0) - 57.0).abs() < 1e-9, "{} {}", of(20.0), of(190.0));
    }
}
