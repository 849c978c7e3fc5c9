//! A simulator of one's own in the search's loop, in place of hairpin's: `cargo run --example 06_own_simulator`.

use std::error::Error;

use hairpin::campaign::generate::Known;
use hairpin::campaign::{Case, Executor, Mission, Setup, Stop, generate};
use hairpin::trajectory::{Channel, Ended, Flight, Track};
use hairpin_formats::scenario::setup_for;
use nalgebra::{Isometry3, Translation3, Vector3};

/// A mass that a spring pulls to the next waypoint.
struct Springs;

impl Executor for Springs {
    fn fly(&self, _nominal: &Setup, _case: &Case, mission: &Mission) -> Result<Flight, String> {
        let (dt, mut velocity, mut next) = (0.01, Vector3::zeros(), 1);
        let mut position = mission.waypoints[0];
        let (mut times, mut poses, mut legs, mut reached) = (Vec::new(), Vec::new(), Vec::new(), vec![Some(0.0)]);
        while next < mission.waypoints.len() && dt * times.len() as f64 <= mission.time_limit {
            let now = dt * times.len() as f64;
            times.push(now);
            poses.push(Isometry3::from(Translation3::from(position)));
            legs.push((next - 1) as f64);
            let pull: Vector3<f64> = (mission.waypoints[next] - position).cap_magnitude(6.0);
            velocity += (pull - velocity * 1.2) * dt;
            position += velocity * dt;
            if (mission.waypoints[next] - position).norm() < mission.accept {
                reached.push(Some(now));
                next += 1;
            }
        }
        let ended = if next == mission.waypoints.len() { Ended::Done } else { Ended::Time };
        reached.resize(mission.waypoints.len(), None);
        let leg = Channel { name: "leg".into(), values: legs };
        let track = Track::new(times, poses, vec![leg]).map_err(|mistake| mistake.to_string())?;
        Ok(Flight { track, ended, left_world: None, reached })
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let worst = "{ method = \"worst\", executions = 120, cases = 3 }";
    let sets = [("generate.search".to_owned(), worst.to_owned()), ("execute.repeat".to_owned(), "1".to_owned())];
    let setup = setup_for("demo-quadrotor", &sets)?;
    let mut cases = Vec::new();
    let mut keep = |found: &[Case], _: &_| cases.extend_from_slice(found);
    let tally = generate(&setup, &Known::default(), &Springs, &Stop::never(), &mut keep);
    for case in &cases {
        println!("case {}: {:.2} m off its legs", case.id(), case.score);
    }
    let executions: u64 = tally.curves.iter().map(|curve| curve.executions).sum();
    println!("the worst of {executions} executions of the springs");
    Ok(())
}
