//! Proof that a leg keeps the thrusters' limits and the speed at every instant: enclosures of all that is demanded,
//! halved until they decide.
//!
//! As for flights: upper(f) within the limit is a proof on a whole interval of time, a violation at a centre is a
//! refusal with evidence, anything else is halved. Accepting is proven up to rounding, for which room is left; refusing
//! may be conservative by the shortest interval.

use wide::f64x4;

use super::demand::{BoatDemand, BoatMotion, ForceMap, Turning};
use super::limits::{BoatInfeasible, BoatLimit, BoatLimits};
use crate::feasibility::steering::ProofSettings;
use crate::feasibility::steering::halving::prove_by_halving;
use crate::math::interval::{Enclosure, Smooth};
use crate::math::polynomial::derivatives;
use crate::robot::boat::Boat;
use crate::trajectory::ProfileLeg;

/// Room for rounding, as a share of each limit.
const ROUNDING: f64 = 1e-9;
/// The limits of forces and speed as numbers to compare with.
#[derive(Debug, Clone)]
pub(super) struct ForceLimits {
    max_speed: f64,
    /// Least and largest X, Y, N.
    forces: [[f64; 2]; 3],
    settings: ProofSettings,
}

/// A signed margin, whose it is, and what rounding may take from it.
type Margin<N> = (BoatLimit, N, f64);

impl ForceLimits {
    /// Thrusts times the share that plans may use.
    pub(super) fn new(boat: &Boat, limits: &BoatLimits) -> Self {
        let share = limits.thrust_share;
        Self {
            max_speed: limits.max_speed,
            forces: boat.thrust.bounds().map(|[low, high]| [share * low, share * high]),
            settings: ProofSettings::default(),
        }
    }

    /// Signed margins of everything that is demanded.
    #[inline(always)]
    fn margins<N: Turning>(&self, demand: &BoatDemand<N>) -> [Margin<N>; 7] {
        let above = |limit, i: usize| {
            let [low, _] = self.forces[i];
            (limit, demand.forces[i] - N::constant(low), -low * ROUNDING)
        };
        let below = |limit, i: usize| {
            let [_, high] = self.forces[i];
            (limit, N::constant(high) - demand.forces[i], high * ROUNDING)
        };
        // No cap is as good as one that nothing afloat comes to.
        let cap = self.max_speed.min(1e6);
        [
            (BoatLimit::Speed, N::constant(cap) - demand.speed, cap.min(1e3) * ROUNDING),
            above(BoatLimit::Surge, 0),
            below(BoatLimit::Surge, 0),
            above(BoatLimit::Sway, 1),
            below(BoatLimit::Sway, 1),
            above(BoatLimit::Yaw, 2),
            below(BoatLimit::Yaw, 2),
        ]
    }

    /// The first of four instants that violates a limit.
    #[inline]
    pub(super) fn violation(&self, demand: &BoatDemand<f64x4>) -> Option<(usize, BoatLimit, f64)> {
        self.margins(demand).into_iter().find_map(|(limit, margin, _)| {
            let bits = margin.simd_lt(f64x4::ZERO).to_bitmask();
            let lane = bits.trailing_zeros() as usize;
            (bits != 0).then(|| (lane, limit, margin.to_array()[lane]))
        })
    }

    /// Proves forces and speed on the whole leg.
    ///
    /// # Errors
    /// A violation at an instant, or an interval that the budget does not let it decide.
    pub(super) fn prove(&self, map: &ForceMap, leg: &ProfileLeg) -> Result<(), BoatInfeasible> {
        let refuse = |tau: f64| {
            let (limit, margin) = self.worst(map, leg, tau);
            Err(BoatInfeasible::at(limit, tau, margin))
        };
        prove_by_halving(leg.duration, &self.settings, |batch| self.evaluate(map, leg, batch)).or_else(refuse)
    }

    /// Bit masks of the intervals on which every limit is proven, and of those whose centre violates one.
    fn evaluate(&self, map: &ForceMap, leg: &ProfileLeg, batch: &[(f64, f64); 4]) -> (u32, u32) {
        let tau = f64x4::new(batch.map(|(centre, _)| centre));
        let half = f64x4::new(batch.map(|(_, half)| half));
        let d = leg.coefficients.map(|c| derivatives(&c, tau));
        let of = |axis: usize, order: usize| Enclosure::taylor(&d[axis][order..], half);
        let motion = motion(of);
        let (mut proven, mut violated) = (f64x4::ZERO.simd_eq(f64x4::ZERO), f64x4::ZERO);
        for (_, margin, room) in self.margins(&map.demand(&motion)) {
            // Comparisons with NaN are false, so that what is undefined is never proven.
            proven &= margin.lower().simd_ge(f64x4::splat(room));
            violated |= margin.middle.simd_lt(f64x4::ZERO);
        }
        (proven.to_bitmask(), violated.to_bitmask())
    }

    /// The least margin at one instant, as a share of what its limit is.
    fn worst(&self, map: &ForceMap, leg: &ProfileLeg, tau: f64) -> (BoatLimit, f64) {
        let at = |axis: usize, order: usize| leg.derivative(tau, order)[axis];
        let margins = self.margins(&map.demand(&motion(at)));
        let share = |(_, margin, room): &Margin<f64>| if margin.is_nan() { f64::NEG_INFINITY } else { margin / room };
        let worst = margins.into_iter().min_by(|a, b| share(a).total_cmp(&share(b)));
        worst.map_or((BoatLimit::Speed, f64::NEG_INFINITY), |(limit, margin, _)| (limit, margin))
    }
}

/// A motion from the derivatives of x, y and ψ.
#[inline(always)]
pub(super) fn motion<N: Smooth>(of: impl Fn(usize, usize) -> N) -> BoatMotion<N> {
    BoatMotion {
        velocity: [of(0, 1), of(1, 1)],
        acceleration: [of(0, 2), of(1, 2)],
        heading: of(2, 0),
        rate: of(2, 1),
        turning: of(2, 2),
    }
}
