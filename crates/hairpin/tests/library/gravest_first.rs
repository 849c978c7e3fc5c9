//! What fails stands before what strays farther, whichever search executes it.

use hairpin::campaign::generate::Known;
use hairpin::campaign::{Case, Executor, Mission, OwnSimulator, Run, Setup, execute_run, generate, judge};
use hairpin::trajectory::{Ended, Flight, Track};
use serde_json::{Value, json};

use crate::campaigns::{ENDLESS, asked, run, setup};

/// Our own simulator, in which some fall down before they have strayed.
struct Falling;

impl Falling {
    /// One trajectory in three, by where all of its waypoints lie.
    fn falls(case: &Case) -> bool {
        case.waypoints.iter().fold(0, |hash: u64, point| hash.rotate_left(7) ^ point.x.to_bits()).is_multiple_of(3)
    }
}

impl Executor for Falling {
    fn fly(&self, nominal: &Setup, case: &Case, mission: &Mission) -> Result<Flight, String> {
        let flight = OwnSimulator.fly(nominal, case, mission)?;
        if !Self::falls(case) {
            return Ok(flight);
        }
        let few = flight.track.len().min(20);
        let (times, poses) = (flight.track.times()[..few].to_vec(), flight.track.poses()[..few].to_vec());
        let track = Track::new(times, poses, Vec::new()).map_err(|error| error.to_string())?;
        let reached = (0..flight.reached.len()).map(|number| (number == 0).then_some(0.0)).collect();
        Ok(Flight { track, ended: Ended::Crash, reached, ..flight })
    }
}

fn with(method: &str, score: &str, more: Value) -> Setup {
    let mut wanted = asked("hull", method, 2);
    wanted["score"] = json!(score);
    // So many that every graph has trajectories of both kinds.
    wanted["search"]["waypoints"] = json!(150);
    let search = wanted["search"].as_object_mut().expect("a table");
    search.extend(more.as_object().expect("a table").clone());
    setup("flightgoggles", 5, wanted)
}

fn searches() -> [(&'static str, Setup); 4] {
    [
        ("in-loop", with("in-loop", "high-velocity-90", json!({ "executions": 30 }))),
        ("in-loop, moved", with("in-loop", "high-velocity-90", json!({ "executions": 60, "move_waypoints": true }))),
        ("adaptive", with("adaptive", "high-velocity-90", json!({ "executions": 60, "rounds": 2 }))),
        ("executed", with("beam", "executed", json!({ "executions": 30 }))),
    ]
}

#[test]
fn a_crash_is_kept_before_what_strays_farther() {
    for (what, setup) in searches() {
        let mut cases = Vec::new();
        let tally = generate(&setup, &Known::default(), &Falling, &ENDLESS, &mut |new, _| cases.extend_from_slice(new));
        assert_eq!(cases.len(), 2, "{what}: {:?}", tally.nothing);
        for case in &cases {
            let curve = tally.curves.iter().find(|curve| curve.graph == case.graph).expect("its graph's");
            let (_, most) = curve.rises.last().expect("something was measured");
            let told = format!("{what}: {} of {} executions, the largest {most}", case.score, curve.executions);
            assert!(Falling::falls(case), "{told}: what came home is kept");
            assert!(case.score < 0.5 * most, "{told}");
        }
    }
}

#[test]
fn where_nothing_fails_the_largest_stress_is_kept() {
    for (what, setup) in searches() {
        let (cases, tally) = run(&setup, &Known::default());
        assert_eq!(cases.len(), 2, "{what}: {:?}", tally.nothing);
        for case in &cases {
            let curve = tally.curves.iter().find(|curve| curve.graph == case.graph).expect("its graph's");
            assert_eq!(Some(case.score), curve.rises.last().map(|(_, most)| *most), "{what}");
            let run: Run = execute_run(&setup, case, 0);
            let result = judge(&setup, case, &[run]).expect("a result");
            assert_eq!(result.measures.map(|measures| measures.max_deviation), Some(case.score), "{what}");
        }
    }
}
