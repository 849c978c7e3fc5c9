//! Rotor speeds over time as CSV, `t_s,rotor1_rad_s` … `rotor4_rad_s`: what a quadrotor is flown by, open loop.

use crate::delimited::{Cut, Rows};

const COLUMNS: [&str; 5] = ["t_s", "rotor1_rad_s", "rotor2_rad_s", "rotor3_rad_s", "rotor4_rad_s"];
/// Longest profile, s: a slip of the unit must not run for hours.
const LONGEST_S: f64 = 3600.0;

/// From `t` (s) on the rotors are asked for `speeds` (rad/s).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RotorSpeeds {
    /// s, from 0.
    pub t: f64,
    /// rad/s.
    pub speeds: [f64; 4],
}

/// The profile of a text, within the robot's `limits`, rad/s. Blank lines count and are skipped.
///
/// # Errors
/// The first thing wrong, with its line.
pub fn parse(text: &str, limits: (f64, f64)) -> Result<Vec<RotorSpeeds>, String> {
    let mut lines = Rows::of(text, Cut::told_by(text));
    if !lines.next().is_some_and(|header| header.cells().eq(COLUMNS)) {
        return Err(format!("line 1: the columns must be {}", COLUMNS.join(",")));
    }
    let mut rows: Vec<RotorSpeeds> = Vec::new();
    for row in lines {
        let number = row.line;
        if row.len() != COLUMNS.len() {
            return Err(format!("line {number}: {} values, must be {}", row.len(), COLUMNS.len()));
        }
        let mut values = [0.0; 5];
        for ((value, cell), column) in values.iter_mut().zip(row.cells()).zip(COLUMNS) {
            let finite = cell.parse().ok().filter(|value: &f64| value.is_finite());
            *value = finite.ok_or_else(|| format!("line {number}: {column} = {cell:?}: must be a finite number"))?;
        }
        let [t, speeds @ ..] = values;
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
            _ => rows.push(RotorSpeeds { t, speeds }),
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
    fn rows_are_read() {
        let rows = parse(&format!("{HEADER}0,1,2,3,4\n\n 2.5, 5,6,7,8\n"), (0.0, 2200.0)).unwrap();
        assert_eq!(rows[1], RotorSpeeds { t: 2.5, speeds: [5.0, 6.0, 7.0, 8.0] });
    }
}
