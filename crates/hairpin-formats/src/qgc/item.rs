//! A mission item as either format has it, and what is wrong with one.

use std::fmt;

use crate::quote;

/// What is wrong in a file: where, what is there, and what must be.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Wrong {
    /// JSON path, or line and field.
    pub at: String,
    /// What is there.
    pub value: String,
    /// What must be.
    pub must: String,
}

impl Wrong {
    /// `value` is cut to what a message holds.
    pub(super) fn new(at: impl Into<String>, value: impl fmt::Display, must: impl Into<String>) -> Self {
        Self { at: at.into(), value: quote::cell(&value.to_string()), must: must.into() }
    }
}

impl fmt::Display for Wrong {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}, must be {}", self.at, self.value, self.must)
    }
}

impl std::error::Error for Wrong {}

/// Frames of MAVLink (`MAV_FRAME`) that places of missions are given in.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Frame {
    /// Altitude above mean sea level: 0 and 5.
    Global,
    /// Of commands without a place: 2.
    Mission,
    /// Altitude above home: 3 and 6.
    Relative,
    /// Altitude above the terrain: 10 and 11.
    Terrain,
}

impl Frame {
    /// The frame of number `number`.
    ///
    /// # Errors
    /// Any other, by name where it has one.
    pub(super) fn of(number: u64, at: &str) -> Result<Self, Wrong> {
        let other = |name: &str| {
            let must = "0 (above sea level), 2 (no place), 3 (above home) or 10 (above terrain): autopilots fly no missions in others";
            Err(Wrong::new(format!("{at}frame"), format!("{number}{name}"), must))
        };
        match number {
            0 | 5 => Ok(Self::Global),
            2 => Ok(Self::Mission),
            3 | 6 => Ok(Self::Relative),
            10 | 11 => Ok(Self::Terrain),
            1 => other(" (local, north east down)"),
            4 => other(" (local, east north up)"),
            7 => other(" (local, from where the vehicle is)"),
            8 | 9 | 12 => other(" (in the body's axes)"),
            _ => other(""),
        }
    }
}

/// A mission item.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Item {
    /// Where it stands, ready to have a key behind it: `mission.items[3].`, or `line 5, `.
    pub(super) at: String,
    /// Its number, as ground stations count: 1 comes after home.
    pub(super) number: usize,
    /// `MAV_CMD`.
    pub(super) command: u64,
    pub(super) frame: Frame,
    /// NaN: left to the vehicle.
    pub(super) params: [f64; 7],
    /// Whether the vehicle goes on by itself.
    pub(super) goes_on: bool,
}

impl Item {
    /// Parameter `number`, from 1, where it is given.
    pub(super) fn given(&self, number: usize) -> Option<f64> {
        Some(self.params[number - 1]).filter(|value| value.is_finite())
    }

    /// What is wrong with parameter `number`, from 1.
    pub(super) fn wrong(&self, number: usize, must: &str) -> Wrong {
        let value = self.given(number).map_or("null".to_owned(), |value| value.to_string());
        Wrong::new(format!("{}params[{}] of command {}", self.at, number - 1, self.command), value, must)
    }
}
