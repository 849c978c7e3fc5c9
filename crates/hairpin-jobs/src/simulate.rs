//! A rotor-speed profile through the plant, open loop, so that other programs can check our physics.

use std::path::Path;

use hairpin::campaign::flight::FlightSetup;
use hairpin::robot::quadrotor::Quadrotor;
use hairpin::simulation::{Motion, Plant, PlantState, Stepper};
use hairpin::trajectory::{Channel, Track, TrackError};
use hairpin_formats::bounds;
use hairpin_formats::rotor_speeds::{self, RotorSpeeds};
use hairpin_formats::scenario::setup_for;
use nalgebra::{Vector3, Vector4};

use crate::Problem;
use crate::sets::Set;

/// Longest step of the plant, s.
const STEP_S: f64 = 5e-4;
/// Flies the rotor-speed profile in a file (t_s,rotor1_rad_s … rotor4_rad_s): one pose per row. `robot` is a shipped
/// name, a robot file, or a scenario that has one; `sets` are keys of its scenario with other values.
///
/// # Errors
/// A robot without rotors; a file that cannot be read, or is no profile of this robot.
pub fn simulate(robot: &str, sets: &[Set], rotor_speeds: &Path) -> Result<Track, Problem> {
    let setup = setup_for(robot, sets)?;
    let Some(FlightSetup { robot, .. }) = setup.own::<FlightSetup>() else {
        return Err(Problem::input(format!("`{}` has no rotors: simulate flies quadrotors", setup.robot_name())));
    };
    let track = fly(robot, &read(rotor_speeds, robot)?);
    track.map_err(|why| Problem::of_file(rotor_speeds, format!("its speeds lead nowhere: {why}")))
}

/// From level and rest at the origin, rotors at the first row's speeds; one pose per row.
fn fly(robot: &Quadrotor, rows: &[RotorSpeeds]) -> Result<Track, TrackError> {
    let plant = Plant::new(robot);
    let start = Plant::at_rest(&Vector3::zeros(), &rows[0].speeds.into());
    let (mut states, mut motion) = (vec![start], Motion::new(&plant, &start));
    for pair in rows.windows(2) {
        let (duration, speeds) = (pair[1].t - pair[0].t, Vector4::from(pair[0].speeds));
        let steps = (duration / STEP_S).ceil().max(1.0);
        let stepper = Stepper::new(&plant, duration / steps);
        for _ in 0..steps as usize {
            stepper.advance(&plant, &mut motion, &speeds);
        }
        states.push(motion.state());
    }
    let column = |index: usize| states.iter().map(|state: &PlantState| state[index]).collect();
    let names = Plant::CHANNELS.iter().zip(7..);
    let channels = names.map(|(name, i)| Channel { name: (*name).into(), values: column(i) });
    let poses = states.iter().map(Plant::pose).collect();
    Track::new(rows.iter().map(|row| row.t).collect(), poses, channels.collect())
}

fn read(path: &Path, robot: &Quadrotor) -> Result<Vec<RotorSpeeds>, Problem> {
    let text = bounds::read_table(path).and_then(|bytes| {
        String::from_utf8(bytes)
            .map_err(|_| std::io::Error::new(std::io::ErrorKind::InvalidData, "it is no UTF-8 text"))
    });
    let text = text.map_err(|error| Problem::of_file(path, format!("cannot be read: {error}")))?;
    rotor_speeds::parse(&text, robot.rotor_speed).map_err(|why| Problem::of_file(path, why))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn without_thrust_it_falls_as_galileo_says() {
        let sets = [("robot.drag_quadratic_n_s2_m2".to_owned(), "0".to_owned())];
        let setup = setup_for("flightgoggles", &sets).unwrap();
        let rows = [0.0, 2.0].map(|t| RotorSpeeds { t, speeds: [0.0; 4] });
        let robot = &setup.own::<FlightSetup>().unwrap().robot;
        let track = fly(robot, &rows).unwrap();
        assert!((track.position(1).z + 0.5 * robot.gravity * 4.0).abs() < 1e-9);
        assert!((track.channel("vz_m_s").unwrap()[1] + robot.gravity * 2.0).abs() < 1e-9);
    }
}
