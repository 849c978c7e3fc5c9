//! A mission as it was followed: where its vehicle is sent, and what of the list is not followed.

use crate::frames::Geodetic;

/// A mission as a vehicle is sent it, its places on Earth.
#[derive(Debug, Clone, PartialEq)]
pub struct Uploaded {
    /// The planned home.
    pub home: Geodetic,
    /// Where the vehicle is sent, in order.
    pub stations: Vec<Station>,
    /// How it ends.
    pub ending: Ending,
    /// What was read and changes nothing that is judged, in words.
    pub notes: Vec<String>,
    /// What changes the motion and is not followed.
    pub open: Vec<Open>,
}

/// A place that a mission sends its vehicle to.
#[derive(Debug, Clone, PartialEq)]
pub struct Station {
    /// Number of the item, as ground stations count.
    pub item: usize,
    /// Where.
    pub place: Geodetic,
    /// The speed demanded on the way there, m/s; `None`: the vehicle's own.
    pub speed: Option<f64>,
    /// Seconds that it waits there, where it does; infinite: until it is told to go on.
    pub hold_s: Option<f64>,
    /// The acceptance radius, m, where the mission has one.
    pub accept_m: Option<f64>,
}

/// How a mission ends, as far as it is followed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Ending {
    /// At its last place.
    Stays,
    /// Down to the ground at its last place.
    Lands,
    /// The way home, which is the autopilot's own.
    Returns,
}

/// An item that changes the motion and is not followed.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Open {
    /// Number of the station that is gone to before it: from there on nothing is certain.
    pub station: usize,
    /// The item, in words.
    pub words: String,
}
