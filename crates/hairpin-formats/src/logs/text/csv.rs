//! Logs as CSV: hairpin's own (`t,x_m,y_m,z_m,qw,qx,qy,qz` and channels), and others whose header says what it means.

use hairpin::math::rotation::from_rotation_vector;
use nalgebra::{Point3, Vector3};

use super::super::accuracy::both;
use super::super::error::Fault;
use super::super::log::{Clock, Joints, LogFrame, Logged, LoggedMotion, Progress, Sample, ToldTo};
use super::super::planned::source;
use super::super::samples::Budget;
use super::checks::{FARTHEST_M, after, attitude, step};
use super::columns::{Column, Columns};
use crate::delimited::{Cut, Row, Table};
use crate::quote;

/// More than a hundred turns is another unit, rad.
const MOST_RAD: f64 = 700.0;
const FINITE: &str = "a finite number";
const DEVIATION: &str = "a finite number, 0 or more";

pub(in super::super) fn read_csv(text: &str, name: &str) -> Result<Logged, Fault> {
    // A byte order mark and blank lines before the header are the table's to skip; `#` before the header is EuRoC's.
    let table = Table::of(text, Cut::told_by(text));
    let columns = Columns::of(&table.names)?;
    let width = table.names.len();
    let mut reading = Reading::of(columns)?;
    for row in table.rows {
        if row.len() != width {
            return Err(Fault::line(row.line, format!("{} values, the header has {width}", row.len())));
        }
        reading.push(&row)?;
    }
    Ok(reading.logged(name))
}

struct Reading {
    columns: Columns,
    time: Column,
    position: Option<[Column; 3]>,
    flat: bool,
    no_heights: Option<String>,
    quaternion: Option<[Column; 4]>,
    velocity: Option<[Column; 3]>,
    budget: Budget,
    before: Option<f64>,
    samples: Vec<Sample>,
    told_to_m: Option<f64>,
    joints: Vec<Vec<f64>>,
    times: Vec<f64>,
    progress: Vec<Progress>,
    notes: Vec<String>,
}

fn all<const N: usize>(columns: &[Option<Column>; N]) -> Option<[Column; N]> {
    let found: Vec<Column> = columns.iter().flatten().cloned().collect();
    found.try_into().ok()
}

impl Reading {
    fn of(columns: Columns) -> Result<Self, Fault> {
        let missing = |what: &str| Fault::line(1, format!("no column of {what}"));
        let time =
            columns.time.clone().ok_or_else(|| missing("time: `t` in seconds, `t_s`, `timestamp_us` and the like"))?;
        let mut notes = Vec::new();
        let flat = columns.position[2].is_none() && columns.position[0].is_some();
        let mut position = columns.position.clone();
        if flat {
            // Read as x and y alone; what is put in the place of z is not read.
            position[2] = position[0].clone();
            notes.push("no column of z: at 0 m, unless it drives on a map".into());
        }
        let not_read = columns.others.join(", ");
        let not_read = quote::shortened(&not_read);
        let beside =
            if not_read.is_empty() { String::new() } else { format!("; columns that are not read: {not_read}") };
        let no_heights = flat.then(|| format!("no column of z{beside}"));
        let position = all(&position);
        if position.is_none() && (columns.joints.is_empty() || columns.position.iter().any(Option::is_some)) {
            return Err(missing("each of x, y (and z): `x_m`, `y_m`, `z_m`"));
        }
        let quaternion = all(&columns.quaternion);
        if quaternion.is_none() && columns.quaternion.iter().any(Option::is_some) {
            return Err(missing("each of qw, qx, qy, qz"));
        }
        let velocity = all(&columns.velocity);
        if velocity.is_none() && columns.velocity.iter().any(Option::is_some) {
            notes.push("velocities are not read: not all of vx, vy, vz are there".into());
        }
        match &columns.accuracy {
            [Some(one), None] => notes.push(format!("no column of epv: `{}` counts for both", one.name)),
            [None, Some(one)] => notes.push(format!("no column of eph: `{}` counts for both", one.name)),
            _ => {}
        }
        if quaternion.is_none() && columns.yaw.is_some() {
            notes.push("attitude is level, turned by the yaw".into());
        }
        if !columns.others.is_empty() {
            notes.push(format!("columns that are not read: {not_read}"));
        }
        let budget = Budget::default();
        let (samples, joints, times, progress) = Default::default();
        Ok(Self {
            columns,
            time,
            position,
            flat,
            no_heights,
            quaternion,
            velocity,
            budget,
            before: None,
            samples,
            told_to_m: None,
            joints,
            times,
            progress,
            notes,
        })
    }

    fn push(&mut self, row: &Row) -> Result<(), Fault> {
        self.budget.take()?;
        let t_s = number(row, &self.time, f64::MAX, FINITE)?;
        after(t_s, self.before, row.line)?;
        self.before = Some(t_s);
        if let Some(position) = &self.position {
            let mut p = numbers(row, position, FARTHEST_M, "a finite number within 10 000 km")?;
            if self.flat {
                p[2] = 0.0;
            }
            let steps = position.iter().map(|column| step(row.cell(column.index)) * column.scale);
            self.told_to_m = steps.chain(self.told_to_m).reduce(f64::min);
            let level = match &self.columns.level {
                Some(column) => number(row, column, f64::MAX, FINITE)? != 0.0,
                None => false,
            };
            let attitude = match (&self.quaternion, &self.columns.yaw) {
                (Some(columns), _) => {
                    let [w, x, y, z] = numbers(row, columns, 2.0, "a component of a unit quaternion")?;
                    Some(attitude(w, [x, y, z], row.line)?).filter(|_| !level)
                }
                (None, Some(yaw)) => {
                    let yaw = number(row, yaw, MOST_RAD, "an angle within a hundred turns")?;
                    Some(from_rotation_vector(&(Vector3::z() * yaw)))
                }
                (None, None) => None,
            };
            let v_m_s = match &self.velocity {
                Some(columns) => Some(Vector3::from(numbers(row, columns, FARTHEST_M, FINITE)?)),
                None => None,
            };
            let mut told = [None; 2];
            for (told, column) in told.iter_mut().zip(&self.columns.accuracy) {
                let Some(column) = column else { continue };
                let deviation = number(row, column, f64::MAX, DEVIATION)?;
                *told = Some(deviation).filter(|deviation| *deviation >= 0.0);
                if told.is_none() {
                    return Err(wrong(row, column, DEVIATION));
                }
            }
            let (accuracy_m, _) = both(told);
            self.samples.push(Sample { t_s, p_m: Point3::from(p), attitude, v_m_s, accuracy_m });
        }
        if !self.columns.joints.is_empty() {
            let one = |(_, column): &(u32, Column)| number(row, column, MOST_RAD, "an angle within a hundred turns");
            self.joints.push(self.columns.joints.iter().map(one).collect::<Result<_, _>>()?);
            self.times.push(t_s);
        }
        if let Some(column) = &self.columns.leg {
            let leg = number(row, column, 1e9, "a leg's number, from 0")?;
            if leg < 0.0 || leg.fract() != 0.0 {
                return Err(wrong(row, column, "a leg's number, from 0"));
            }
            // Leg 4 flies to waypoint 5.
            let item = leg as u32 + 1;
            if self.progress.last().is_none_or(|last| last.item != item) {
                self.progress.push(Progress { t_s, item, of: None, target_m: None });
            }
        }
        Ok(())
    }

    fn logged(self, name: &str) -> Logged {
        let motion = LoggedMotion {
            told_to: self.told_to_m.map(ToldTo::Decimal),
            no_heights: self.no_heights,
            ..LoggedMotion::of(name, source(name), self.samples)
        };
        let names = self.columns.joints.iter().map(|(number, _)| format!("joint_{number}")).collect();
        let joints = Joints {
            name: name.into(),
            source: source(name),
            joints: names,
            times_s: self.times,
            positions_rad: self.joints,
            unfit: None,
        };
        Logged {
            format: "CSV",
            clock: Clock::File,
            frame: LogFrame::Untold,
            motions: if motion.samples.is_empty() { Vec::new() } else { vec![motion] },
            joints: if joints.times_s.is_empty() { Vec::new() } else { vec![joints] },
            progress: self.progress,
            events: Vec::new(),
            dropouts: Vec::new(),
            notes: self.notes,
        }
    }
}

fn wrong(row: &Row, column: &Column, bound: &str) -> Fault {
    let cell = quote::cell(row.cell(column.index));
    Fault::line(row.line, format!("column `{}` is `{cell}`, must be {bound}", column.name))
}

fn number(row: &Row, column: &Column, most: f64, bound: &str) -> Result<f64, Fault> {
    let parsed = row.cell(column.index).parse::<f64>().ok().map(|number| number * column.scale);
    parsed.filter(|number| number.is_finite() && number.abs() <= most).ok_or_else(|| wrong(row, column, bound))
}

fn numbers<const N: usize>(row: &Row, columns: &[Column; N], most: f64, bound: &str) -> Result<[f64; N], Fault> {
    let mut numbers = [0.0; N];
    for (slot, column) in numbers.iter_mut().zip(columns) {
        *slot = number(row, column, most, bound)?;
    }
    Ok(numbers)
}
