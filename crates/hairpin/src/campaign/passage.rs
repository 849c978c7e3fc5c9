//! Waypoints that somebody else chose: what is asked of the legs between them, and what a claim says of each.
//!
//! The answer is about the claim alone: that a robot can fly, drive or sail what is asked, not that a controller
//! will.

use nalgebra::Point3;

use super::case::Witness;

/// What is asked.
///
/// `speeds` has one entry for each leg, that is one fewer than waypoints.
#[derive(Debug, Clone, Copy)]
pub struct Demands<'a> {
    /// Both ends included, m.
    pub waypoints: &'a [Point3<f64>],
    /// The speed that each leg is to be held at, m/s, where one is demanded.
    pub speeds: &'a [Option<f64>],
    /// Waypoints between the ends where it comes to rest, rising.
    pub stops: &'a [usize],
    /// How long it waits at all of them together, s; infinite where it is told to go on.
    pub hold: f64,
}

impl Demands<'_> {
    /// The speed that leg `leg` is to be held at, m/s.
    pub fn speed(&self, leg: usize) -> Option<f64> {
        self.speeds.get(leg).copied().flatten()
    }

    /// Whether it is at rest at waypoint `number`.
    pub fn rests(&self, number: usize) -> bool {
        number == 0 || number + 1 == self.waypoints.len() || self.stops.contains(&number)
    }

    /// First and last waypoints of what lies between rests, in order.
    ///
    /// The first begins at 0, the last ends at the last waypoint; each ends where the next begins.
    pub fn sections(&self) -> Vec<[usize; 2]> {
        let last = self.waypoints.len().saturating_sub(1);
        let ends: Vec<usize> = (0..=last).filter(|number| self.rests(*number)).collect();
        ends.windows(2).map(|pair| [pair[0], pair[1]]).collect()
    }
}

/// How sure it is that a limit breaks.
///
/// Only the first may be told as impossible.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Certainty {
    /// Nothing that the model allows does what is asked.
    Proven,
    /// No way of doing it was found, which is no proof.
    NotFound,
}

/// A limit that breaks.
///
/// At most one a leg is told, what is proven before what was not found.
#[derive(Debug, Clone, PartialEq)]
pub struct Broken {
    /// The waypoint that is not come to as asked.
    pub waypoint: usize,
    /// The leg, by its number; `None` where the waypoint itself is the trouble.
    pub leg: Option<usize>,
    /// The limit's name: `speed`, `thrust`, `tilt`, `rotor speed`, `curvature`, `slope`, `clearance`, `cage`, ….
    pub limit: &'static str,
    /// The unit of `excess`.
    pub unit: &'static str,
    /// By how much, > 0, where that is known.
    pub excess: Option<f64>,
    /// How sure that is.
    pub certainty: Certainty,
    /// What breaks, in a sentence's part.
    pub words: String,
}

/// What is known of one leg.
///
/// Numbers of the leg alone (`fastest`, `nearest`) are there also where the mission as a whole has no witness.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct PassedLeg {
    /// Straight length, m.
    pub length: f64,
    /// Time that it takes in the witness, s; `None` without one.
    pub time: Option<f64>,
    /// The greatest speed on it there, m/s.
    pub top_speed: Option<f64>,
    /// The shortest time found for this leg alone, s.
    pub fastest: Option<f64>,
    /// The limit that came nearest, what is left of it, and its unit.
    pub nearest: Option<(&'static str, f64, &'static str)>,
    /// What breaks on it.
    pub broken: Option<Broken>,
}

/// What a claim says of what is asked.
///
/// Whole where `witness` is there; then nothing is broken.
#[derive(Debug, Clone, PartialEq)]
pub struct Passage {
    /// Leg by leg.
    pub legs: Vec<PassedLeg>,
    /// What does all that is asked; `None` where nothing is known to.
    pub witness: Option<Passed>,
    /// What breaks and lies on no leg alone.
    pub broken: Option<Broken>,
    /// Keys of the robot's file that were not given but derived, or told by logs, and that what breaks rests on.
    pub estimated: Vec<String>,
    /// What the answer is about, in a sentence: model, limits, and what is left out.
    pub model: String,
    /// Whether it goes on water, whose height is everywhere the same: those of what is asked are not looked at.
    pub afloat: bool,
}

/// A witness over waypoints that somebody else chose.
#[derive(Debug, Clone, PartialEq)]
pub struct Passed {
    /// The waypoints as they are passed: of drives on the ground.
    pub waypoints: Vec<Point3<f64>>,
    /// Duration of each leg, s.
    pub leg_times: Vec<f64>,
    /// The commands.
    pub witness: Witness,
}

impl Passage {
    /// The first limit that breaks; of one waypoint what is proven goes first.
    pub fn first(&self) -> Option<&Broken> {
        let all = self.legs.iter().filter_map(|leg| leg.broken.as_ref()).chain(&self.broken);
        all.min_by_key(|broken| (broken.waypoint, broken.certainty == Certainty::NotFound))
    }

    /// The first that is proven to break.
    pub fn proven(&self) -> Option<&Broken> {
        let all = self.legs.iter().filter_map(|leg| leg.broken.as_ref()).chain(&self.broken);
        all.filter(|broken| broken.certainty == Certainty::Proven).min_by_key(|broken| broken.waypoint)
    }
}
