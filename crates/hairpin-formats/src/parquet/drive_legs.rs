//! What is a leg's in the rows of a drive's table: its ends, directions of travel and speeds, in each of its rows.

use hairpin::trajectory::drive::Planar;
use hairpin::trajectory::{Direction, DriveLeg, SpeedProfile};

use super::table::{Table, TableError};

/// A number of a leg's speeds.
type Of = fn(&SpeedProfile) -> f64;
/// The columns of a leg's speeds.
pub(super) const SPEEDS: [(&str, Of); 4] = [
    ("start_speed_m_s", SpeedProfile::start),
    ("cruise_speed_m_s", SpeedProfile::top),
    ("end_speed_m_s", SpeedProfile::end),
    ("acceleration_m_s2", |profile| match profile {
        SpeedProfile::Trapezoid { acceleration, .. } => *acceleration,
        SpeedProfile::Constant { .. } | SpeedProfile::Ramp { .. } => f64::NAN,
    }),
];
const CONSTANT: &str = "constant";
const RAMP: &str = "ramp";
const TRAPEZOID: &str = "trapezoid";

/// The word of a profile in files.
pub(super) fn profile_word(profile: &SpeedProfile) -> &'static str {
    match profile {
        SpeedProfile::Constant { .. } => CONSTANT,
        SpeedProfile::Ramp { .. } => RAMP,
        SpeedProfile::Trapezoid { .. } => TRAPEZOID,
    }
}

/// The speeds of each row's leg.
///
/// Each of their columns says what the profile comes to, those too that its kind does not need.
fn read_speeds(table: &Table) -> Result<Vec<SpeedProfile>, TableError> {
    let words = table.texts("profile")?;
    let [starts, cruises, ends] = [0, 1, 2].map(|i| table.numbers(SPEEDS[i].0));
    let (starts, cruises, ends) = (starts?, cruises?, ends?);
    let accelerations = table.optional_numbers(SPEEDS[3].0)?;
    let profile = |row: usize| {
        let (start, cruise, end) = (starts[row], cruises[row], ends[row]);
        let profile = match words[row].as_str() {
            CONSTANT => SpeedProfile::Constant { speed: cruise },
            RAMP => SpeedProfile::Ramp { start, end },
            TRAPEZOID => {
                SpeedProfile::Trapezoid { start, cruise, end, acceleration: accelerations[row].unwrap_or(f64::NAN) }
            }
            other => return Err(table.refuse("profile", row, format!("`{other}`"), "constant, ramp or trapezoid")),
        };
        let profile =
            profile.checked().map_err(|error| table.refuse("profile", row, error, "speeds that make a profile"))?;
        let told = [Some(start), Some(cruise), Some(end), accelerations[row]];
        for ((name, of), told) in SPEEDS.iter().zip(told) {
            let told = told.unwrap_or(f64::NAN);
            if !is_same(told, of(&profile)) {
                let bound = format!("{}, as the leg's profile, {}, has it", of(&profile), words[row]);
                return Err(table.refuse(name, row, told, bound));
            }
        }
        Ok(profile)
    };
    (0..table.rows()).map(profile).collect()
}

/// Two numbers that are none are the same.
fn is_same(a: f64, b: f64) -> bool {
    a == b || (a.is_nan() && b.is_nan())
}

/// What is a leg's, and stands in each of its rows.
pub(super) struct OfLegs {
    from: Vec<Planar>,
    to: Vec<Planar>,
    directions: Vec<Direction>,
    profiles: Vec<SpeedProfile>,
}

impl OfLegs {
    /// # Errors
    /// Missing columns, values out of bounds, speeds that are not those of the row's profile.
    pub(super) fn read(table: &Table) -> Result<Self, TableError> {
        let end = |end: &str| -> Result<Vec<Planar>, TableError> {
            let [x, y, yaw, curvature] = ["x_m", "y_m", "yaw_rad", "curvature_1_m"].map(|name| format!("{end}_{name}"));
            let (x, y) = (table.numbers(&x)?, table.numbers(&y)?);
            let (yaw, curvature) = (table.numbers(&yaw)?, table.numbers(&curvature)?);
            Ok((0..table.rows()).map(|i| Planar { x: x[i], y: y[i], yaw: yaw[i], curvature: curvature[i] }).collect())
        };
        // Folders of before directions could turn have the first alone.
        let (start, last) =
            (table.numbers("travel_direction_rad")?, table.numbers_or_none("travel_direction_end_rad")?);
        let turned =
            start.iter().zip(&last).map(|(start, end)| Direction { start: *start, end: end.unwrap_or(*start) });
        Ok(Self { from: end("from")?, to: end("to")?, directions: turned.collect(), profiles: read_speeds(table)? })
    }

    /// The leg of `row`, without segments.
    pub(super) fn leg(&self, row: usize) -> DriveLeg {
        let (from, to, speed) = (self.from[row], self.to[row], self.profiles[row]);
        DriveLeg { from, to, segments: Vec::new(), speed, direction: self.directions[row] }
    }

    /// # Errors
    /// The first column in which `row` has not what the `first` row of its leg has.
    pub(super) fn check(&self, table: &Table, row: usize, first: usize) -> Result<(), TableError> {
        let of_leg = |value: &dyn std::fmt::Display| format!("{value}, as in the leg's first row");
        for ((name, value), (_, wanted)) in self.numbers(row).into_iter().zip(self.numbers(first)) {
            if !is_same(value, wanted) {
                return Err(table.refuse(name, row, value, of_leg(&wanted)));
            }
        }
        let [word, wanted] = [row, first].map(|row| profile_word(&self.profiles[row]));
        if word != wanted {
            return Err(table.refuse("profile", row, format!("`{word}`"), of_leg(&wanted)));
        }
        Ok(())
    }

    /// By the names of their columns.
    fn numbers(&self, row: usize) -> [(&'static str, f64); 14] {
        let (from, to, direction, profile) =
            (&self.from[row], &self.to[row], &self.directions[row], &self.profiles[row]);
        let [start, cruise, end, acceleration] = SPEEDS.map(|(name, of)| (name, of(profile)));
        [
            ("from_x_m", from.x),
            ("from_y_m", from.y),
            ("from_yaw_rad", from.yaw),
            ("from_curvature_1_m", from.curvature),
            ("to_x_m", to.x),
            ("to_y_m", to.y),
            ("to_yaw_rad", to.yaw),
            ("to_curvature_1_m", to.curvature),
            ("travel_direction_rad", direction.start),
            ("travel_direction_end_rad", direction.end),
            start,
            cruise,
            end,
            acceleration,
        ]
    }
}
