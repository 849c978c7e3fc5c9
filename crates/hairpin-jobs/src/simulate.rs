//! A rotor-speed profile through the plant, open loop, so that other programs can check our physics.

use std::path::Path;

use hairpin::campaign::flight::FlightSetup;
use hairpin::robot::quadrotor::Quadrotor;
use hairpin::simulation::{Motion, Plant, PlantState, Stepper};
use hairpin::trajectory::{Channel, Track};
use hairpin_formats::scenario::setup_for;
use nalgebra::{Vector3, Vector4};

use crate::Problem;
use crate::sets::Set;

const COLUMNS: [&str; 5] = ["t_s", "rotor1_rad_s", "rotor2_rad_s", "rotor3_rad_s", "rotor4_rad_s"];
/// Longest step of the plant, s.
const STEP_S: f64 = 5e-4;
/// Longest profile, s: a slip of the unit must not run for hours.
const LONGEST_S: f64 = 3600.0;

/// One row: from `t` on the rotors are asked for `speeds`.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Row {
    t: f64,
    speeds: Vector4<f64>,
}

/// Flies the rotor-speed profile in a file (t_s,rotor1_rad_s … rotor4_rad_s): one pose per row. `robot` is a shipped
/// name, a robot file, or a scenario that has one; `sets` are keys of its scenario with other values.
///
/// # Errors
/// A robot without rotors; a file that cannot be read, or is no profile of this robot.
pub fn simulate(robot: &str, sets: &[Set], rotor_speeds: &Path) -> Result<Track, Problem> {
    let setup = setup_for(robot, sets)?;
    let Some(FlightSetup { robot, .. }) = setup.flight() else {
        return Err(Problem::input(format!("`{}` has no rotors: simulate flies quadrotors", setup.robot_name())));
    };
    fly(robot, &read(rotor_speeds, robot)?)
}

/// From level and rest at the origin, rotors at the first row's speeds; one pose per row.
fn fly(robot: &Quadrotor, rows: &[Row]) -> Result<Track, Problem> {
    let plant = Plant::new(robot);
    let start = Plant::at_rest(&Vector3::zeros(), &rows[0].speeds);
    let (mut states, mut motion) = (vec![start], Motion::new(&plant, &start));
    for pair in rows.windows(2) {
        let duration = pair[1].t - pair[0].t;
        let steps = (duration / STEP_S).ceil().max(1.0);
        let stepper = Stepper::new(&plant, duration / steps);
        for _ in 0..steps as usize {
            stepper.advance(&plant, &mut motion, &pair[0].speeds);
        }
        states.push(motion.state());
    }
    let column = |index: usize| states.iter().map(|state: &PlantState| state[index]).collect();
    let names = Plant::CHANNELS.iter().zip(7..);
    let channels = names.map(|(name, i)| Channel { name: (*name).into(), values: column(i) });
    let poses = states.iter().map(Plant::pose).collect();
    Track::new(rows.iter().map(|row| row.t).collect(), poses, channels.collect()).map_err(Problem::input)
}

fn read(path: &Path, robot: &Quadrotor) -> Result<Vec<Row>, Problem> {
    let text = std::fs::read_to_string(path);
    let text = text.map_err(|error| Problem::of_file(path, format!("cannot be read: {error}")))?;
    parse(&text, robot.rotor_speed).map_err(|why| Problem::of_file(path, why))
}

fn parse(text: &str, limits: (f64, f64)) -> Result<Vec<Row>, String> {
    let mut lines = text.lines().enumerate().filter(|(_, line)| !line.trim().is_empty());
    let header: Vec<&str> = lines.next().map_or(Vec::new(), |(_, line)| line.split(',').map(str::trim).collect());
    if header != COLUMNS {
        return Err(format!("line 1: the columns must be {}", COLUMNS.join(",")));
    }
    let mut rows: Vec<Row> = Vec::new();
    for (index, line) in lines {
        let number = index + 1;
        let cells: Vec<&str> = line.split(',').map(str::trim).collect();
        if cells.len() != COLUMNS.len() {
            return Err(format!("line {number}: {} values, must be {}", cells.len(), COLUMNS.len()));
        }
        let mut values = [0.0; 5];
        for ((value, cell), column) in values.iter_mut().zip(&cells).zip(COLUMNS) {
            let finite = cell.parse().ok().filter(|value: &f64| value.is_finite());
            *value = finite.ok_or_else(|| format!("line {number}: {column} = {cell:?}: must be a finite number"))?;
        }
        let [t, ..] = values;
        if let Some(i) = (1..5).find(|&i| values[i] < limits.0 || values[i] > limits.1) {
            let (low, high) = limits;
            return Err(format!("line {number}: {} = {}: must be {low} … {high}, the robot's", COLUMNS[i], values[i]));
        }
        match rows.last() {
            None if t != 0.0 => return Err(format!("line {number}: t_s = {t}: must be 0 in the first row")),
            Some(before) if t <= before.t => {
                return Err(format!("line {number}: t_s = {t} does not follow {}: must rise strictly", before.t));
            }
            _ if t > LONGEST_S => return Err(format!("line {number}: t_s = {t}: must be ≤ {LONGEST_S}")),
            _ => rows.push(Row { t, speeds: Vector4::from_column_slice(&values[1..]) }),
        }
    }
    if rows.len() < 2 {
        return Err("must have at least two rows: the last one ends the flight".into());
    }
    Ok(rows)
}

#[cfg(test)]
mod tests {
    use super::*;

    const HEADER: &str = "t_s,rotor1_rad_s,rotor2_rad_s,rotor3_rad_s,rotor4_rad_s\n";

    #[test]
    fn mistakes_are_told_with_line_and_column() {
        for (rows, told) in [
            ("0,1,1,1,1\n", "at least two rows"),
            ("0,1,1,1,1\n0,1,1,1,1\n", "line 3: t_s = 0 does not follow 0"),
            ("1,1,1,1,1\n", "line 2: t_s = 1: must be 0"),
            ("0,1,1,x,1\n", "line 2: rotor3_rad_s = \"x\""),
            ("0,1,1,NaN,1\n", "must be a finite number"),
            ("0,1,1,1\n", "line 2: 4 values"),
            ("0,1,1,1,9000\n", "rotor4_rad_s = 9000: must be 0 … 2200"),
        ] {
            let found = parse(&format!("{HEADER}{rows}"), (0.0, 2200.0)).unwrap_err();
            assert!(found.contains(told), "{found}");
        }
        assert!(parse("", (0.0, 1.0)).unwrap_err().contains("columns"));
    }

    #[test]
    fn without_thrust_it_falls_as_galileo_says() {
        let sets = [("robot.drag_quadratic_n_s2_m2".to_owned(), "0".to_owned())];
        let setup = setup_for("flightgoggles", &sets).unwrap();
        let rows = parse(&format!("{HEADER}0,0,0,0,0\n2,0,0,0,0\n"), (0.0, 2200.0)).unwrap();
        let robot = setup.flight().unwrap().robot;
        let track = fly(robot, &rows).unwrap();
        assert!((track.position(1).z + 0.5 * robot.gravity * 4.0).abs() < 1e-9);
        assert!((track.channel("vz_m_s").unwrap()[1] + robot.gravity * 2.0).abs() < 1e-9);
    }
}
