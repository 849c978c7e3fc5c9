//! What only scores and results ask for of legs, kept in few bytes a leg.
//!
//! Most of a leg does not depend on where its node was entered from, and the rest not on how fast it is left: both are
//! kept once for many legs, to the bit.

use crate::feasibility::reach::{Leg, LegFeatures};

/// Of every leg, in their order.
#[derive(Debug, Clone, Default)]
pub(super) struct Details {
    onward: Vec<Onward>,
    turns: Vec<Turn>,
    /// Of every leg its entries in these two.
    legs: Vec<[u32; 2]>,
}

/// Duration, v_in, v_out, length, climb, ground: as bits, so that equal ones are one and the same number.
///
/// s, m/s, m/s, m, m and what the reach set says of the ground, in this order.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Onward([u64; 6]);

/// turn, slope_in.
///
/// rad and the sine of an elevation.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Turn([u64; 2]);

impl Onward {
    fn of<N>(leg: &Leg<N>) -> Self {
        let LegFeatures { v_in, v_out, length, climb, ground, .. } = leg.features;
        Self([leg.duration, v_in, v_out, length, climb, ground].map(f64::to_bits))
    }
}

impl Turn {
    fn of<N>(leg: &Leg<N>) -> Self {
        Self([leg.features.turn, leg.features.slope_in].map(f64::to_bits))
    }
}

impl Details {
    /// Whether leg number `at` and `leg` differ at most in what they turn from.
    pub(super) fn is_onward<N>(&self, at: usize, leg: &Leg<N>) -> bool {
        self.onward[self.legs[at][0] as usize] == Onward::of(leg)
    }

    /// Adds a leg that shares nothing but its turn with those before.
    pub(super) fn push<N>(&mut self, leg: &Leg<N>) {
        self.onward.push(Onward::of(leg));
        self.push_leg(self.onward.len() as u32 - 1, leg);
    }

    /// Adds a leg that [`Self::is_onward`] of leg number `at`.
    pub(super) fn push_like<N>(&mut self, at: usize, leg: &Leg<N>) {
        self.push_leg(self.legs[at][0], leg);
    }

    /// Legs to the states of one waypoint follow on one another: only the last turn is compared.
    fn push_leg<N>(&mut self, onward: u32, leg: &Leg<N>) {
        let turn = Turn::of(leg);
        if self.turns.last() != Some(&turn) {
            self.turns.push(turn);
        }
        self.legs.push([onward, self.turns.len() as u32 - 1]);
    }

    /// Puts leg number `from` in the place of leg number `to`.
    pub(super) fn put(&mut self, to: usize, from: usize) {
        self.legs[to] = self.legs[from];
    }

    pub(super) fn truncate(&mut self, legs: usize) {
        self.legs.truncate(legs);
    }

    /// s.
    pub(super) fn duration(&self, leg: usize) -> f64 {
        f64::from_bits(self.onward[self.legs[leg][0] as usize].0[0])
    }

    /// Duration, s, and what scores see.
    pub(super) fn of(&self, leg: usize) -> (f64, LegFeatures) {
        let [onward, turn] = self.legs[leg];
        let [duration, v_in, v_out, length, climb, ground] = self.onward[onward as usize].0.map(f64::from_bits);
        let [turn, slope_in] = self.turns[turn as usize].0.map(f64::from_bits);
        (duration, LegFeatures { v_in, v_out, turn, length, climb, slope_in, ground })
    }
}
