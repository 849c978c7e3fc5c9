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
#[derive(Debug, Clone, Copy)]
struct Onward([u64; 6]);

/// turn, slope_in.
///
/// rad and the sine of an elevation.
#[derive(Debug, Clone, Copy)]
struct Turn([u64; 2]);

impl Onward {
    fn of<N>(leg: &Leg<N>) -> Self {
        let LegFeatures { v_in, v_out, length, climb, ground, .. } = leg.features;
        Self([
            leg.duration.to_bits(),
            v_in.to_bits(),
            v_out.to_bits(),
            length.to_bits(),
            climb.to_bits(),
            ground.to_bits(),
        ])
    }
}

impl Turn {
    fn of<N>(leg: &Leg<N>) -> Self {
        Self([leg.features.turn.to_bits(), leg.features.slope_in.to_bits()])
    }
}

/// Word by word: `==` of arrays calls into the C library, which costs more than so few words.
#[inline]
fn are_same<const K: usize>(a: &[u64; K], b: &[u64; K]) -> bool {
    a.iter().zip(b).fold(0, |differing, (a, b)| differing | (a ^ b)) == 0
}

impl Details {
    /// Whether leg number `at` and `leg` differ at most in what they turn from.
    pub(super) fn is_onward<N>(&self, at: usize, leg: &Leg<N>) -> bool {
        are_same(&self.onward[self.legs[at][0] as usize].0, &Onward::of(leg).0)
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
        if !self.turns.last().is_some_and(|last| are_same(&last.0, &turn.0)) {
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
