//! How a vehicle stands on the ground, for the proof: Newton's method.
//!
//! Nothing is shared with the robot's own suspension: linear systems are solved by a general decomposition, and where
//! the ground's own derivatives swing from cell to cell they are differences.
//!
//! F(q) = 0 by steps with the Jacobian where they begin, as long as they shrink; then by Newton with derivatives and
//! with central differences of 1e-4 to 1e-2 m, halved steps, and the same order of falls as the claim's own, typed
//! again.

use nalgebra::Vector3;

use super::posed::{Stand, Unknowns, gaps, linearised, newton, seen_from_above, turn};
use crate::world::terrain::{NoGround, Terrain};

/// A pose at rest, kept from one place to the next.
#[derive(Debug, Clone, Copy)]
pub(super) struct Rest {
    unknowns: Unknowns,
}

/// Share of the ground's slope below the body, and height over it (m), from which a rest is looked for, in turn.
const GUESSES: [(f64, f64); 14] = [
    (1.0, 0.2),
    (0.0, 0.2),
    (0.5, 0.2),
    (1.0, 0.0),
    (0.0, 0.0),
    (1.0, 0.5),
    (0.0, 0.5),
    (0.5, 0.0),
    (0.5, 0.5),
    (-0.5, 0.2),
    (0.25, 0.3),
    (0.75, 0.3),
    (0.25, 0.1),
    (0.75, 0.1),
];
/// Joints, and the angles by which they are folded before the rest of a body that falls is looked for from where it
/// stood, in turn.
const FALLS: [(usize, f64); 12] = [
    (3, 0.6),
    (3, -0.6),
    (4, 0.6),
    (4, -0.6),
    (5, 0.6),
    (5, -0.6),
    (3, 0.3),
    (3, -0.3),
    (4, 0.3),
    (4, -0.3),
    (5, 0.3),
    (5, -0.3),
];
/// How a rest is looked for.
pub(super) struct Asked {
    /// What is left of it may be this, m and rad, as the last steps tell; over borders of cells it may be some times
    /// that.
    pub(super) closed: f64,
    /// Jacobians before the search is given up.
    pub(super) jacobians: usize,
}

/// As exactly as differences of rests are asked for, and as long as leads out of corners.
pub(super) const EXACTLY: Asked = Asked { closed: 1e-9, jacobians: 60 };
/// Steps with the first Jacobian.
const CHORDS: usize = 8;
/// Attempts in a row that may not, and then that may, open the gaps.
const LEAPS: usize = 5;
/// Halvings of a step that makes the gaps no smaller.
const HALVINGS: usize = 10;
/// Widths of the ground's difference quotients, m, in the order they are tried; 0: its own derivatives.
const DIFFERENCES: [f64; 4] = [0.0, 1e-4, 1e-3, 1e-2];
/// Rests that differ by more lead nowhere, m and rad.
const NEIGHBOURS: f64 = 0.1;
/// Longest step, m and rad: slopes mean nothing a wheel's width away.
const FARTHEST: f64 = 0.3;

/// Why there is no rest.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum NoRest {
    /// A wheel's place has no ground.
    Ground(NoGround),
    /// Newton came to no rest from any guess, or to one with a link on its head.
    NotFound,
}

impl Rest {
    /// z of the body's origin in the world, m.
    pub(super) fn height(&self) -> f64 {
        self.unknowns[0]
    }

    /// φ, rad, left side up.
    pub(super) fn roll(&self) -> f64 {
        self.unknowns[1]
    }

    /// θ, rad, nose down.
    pub(super) fn pitch(&self) -> f64 {
        self.unknowns[2]
    }

    /// x and y of the wheels' centres in the body's own axes, m.
    pub(super) fn wheels(&self, stand: &Stand) -> [[f64; 2]; 6] {
        seen_from_above(stand, &self.unknowns)
    }

    /// What two rests lead to at `share` of the way from the first to the last beyond it; the last, where they are no
    /// neighbours.
    pub(super) fn foreseen(first: &Self, last: &Self, share: f64) -> Self {
        let change = last.unknowns - first.unknowns;
        if change.amax() > NEIGHBOURS {
            return *last;
        }
        Self { unknowns: last.unknowns + share * change }
    }

    /// The largest difference of heights (m) and angles (rad).
    pub(super) fn apart(&self, other: &Self) -> f64 {
        (self.unknowns - other.unknowns).amax()
    }

    /// At rest on the ground below `place` (x, y, ψ), looked for from the slope there, from level, and from in between.
    ///
    /// Unknown are z, φ, θ and with a rocker-bogie the rocker's and both bogies' angles, such that every wheel's gap is
    /// 0; of four wheels the gaps' sum of squares is least.
    pub(super) fn find<T: Terrain>(stand: &Stand, terrain: &T, place: [f64; 3]) -> Result<Self, NoRest> {
        if *stand == Stand::Level {
            return Ok(Self { unknowns: Unknowns::zeros() });
        }
        let ground = terrain.patch(place[0], place[1]).map_err(NoRest::Ground)?;
        let slope = Vector3::new(ground.slope[0], ground.slope[1], 0.0);
        let heading = turn(2, place[2]);
        let pitch = -libm::atan(slope.dot(&(heading * Vector3::x())));
        let roll = libm::atan(slope.dot(&(heading * Vector3::y())));
        let mut refused = NoRest::NotFound;
        for (share, height) in GUESSES {
            let mut unknowns = Unknowns::zeros();
            (unknowns[0], unknowns[1], unknowns[2]) = (ground.height + height, share * roll, share * pitch);
            let mut rest = Self { unknowns };
            match rest.follow(stand, terrain, place, &EXACTLY) {
                Ok(()) => return Ok(rest),
                Err(why) => refused = why,
            }
        }
        Err(refused)
    }

    /// Brings the body to rest at `place`, near the rest it had before; where it falls over an edge, wherever it comes
    /// to rest.
    pub(super) fn carry_on<T: Terrain>(
        &mut self,
        stand: &Stand,
        terrain: &T,
        place: [f64; 3],
        asked: &Asked,
    ) -> Result<(), NoRest> {
        let before = self.unknowns;
        if self.follow(stand, terrain, place, asked).is_ok() {
            return Ok(());
        }
        let refused = match Self::find(stand, terrain, place) {
            Ok(found) => {
                *self = found;
                return Ok(());
            }
            Err(why) => why,
        };
        // Only they have joints to fold.
        let folds = if matches!(stand, Stand::RockerBogie { .. }) { &FALLS[..] } else { &[] };
        for &(joint, angle) in folds {
            let mut fallen = Self { unknowns: before };
            fallen.unknowns[joint] += angle;
            if fallen.follow(stand, terrain, place, asked).is_ok() {
                *self = fallen;
                return Ok(());
            }
        }
        Err(refused)
    }

    /// Brings the body to rest at `place`, from the rest it had before; no link of it on its head.
    pub(super) fn follow<T: Terrain>(
        &mut self,
        stand: &Stand,
        terrain: &T,
        place: [f64; 3],
        asked: &Asked,
    ) -> Result<(), NoRest> {
        self.approach(stand, terrain, place, asked)?;
        let upright = self.unknowns.rows(3, 3).iter().all(|joint| joint.abs() <= std::f64::consts::FRAC_PI_2);
        if upright { Ok(()) } else { Err(NoRest::NotFound) }
    }

    /// Newton's method for F(q) = 0 from where the last place came to rest: q ← q − J⁺ F(q).
    ///
    /// First with the Jacobian where it begins (not on four wheels, whose gaps end at a least that depends on it). Then
    /// a J of its own is taken at each iteration, by the ground's derivatives, later by central differences, and the
    /// step, at most [`FARTHEST`], is halved until ‖F‖ falls; every other [`LEAPS`] iterations take it whole, which
    /// leads out of corners. At rest where a step is below what is asked for.
    fn approach<T: Terrain>(
        &mut self,
        stand: &Stand,
        terrain: &T,
        place: [f64; 3],
        asked: &Asked,
    ) -> Result<(), NoRest> {
        if *stand == Stand::Level {
            return Ok(());
        }
        let gaps_at = |unknowns: &Unknowns| gaps(stand, terrain, place, unknowns).map_err(NoRest::Ground);
        // Where gaps remain it depends on the Jacobian which least they lead to.
        if let Stand::RockerBogie { .. } = stand
            && self.by_chords(stand, terrain, place, asked).map_err(NoRest::Ground)?
        {
            return Ok(());
        }
        let mut found = gaps_at(&self.unknowns)?;
        for attempt in 0..asked.jacobians {
            // Steps that must close the gaps can end in a corner of them; every other attempt may leap out of it.
            let halvings = if (attempt / LEAPS).is_multiple_of(2) { HALVINGS } else { 0 };
            // The ground's offset surface has kinks at the borders of cells. Differences over some way straddle them,
            // and converge where those of one side swing from piece to piece.
            let width = DIFFERENCES[attempt * DIFFERENCES.len() / asked.jacobians];
            let (_, jacobian) = linearised(stand, terrain, place, &self.unknowns, width).map_err(NoRest::Ground)?;
            let Some(mut step) = newton(stand, &jacobian, &found) else { continue };
            let length = step.amax();
            step *= FARTHEST / length.max(FARTHEST);
            if length < asked.closed {
                self.unknowns -= step;
                return Ok(());
            }
            for halving in 0.. {
                let ahead = self.unknowns - step;
                let there = gaps_at(&ahead)?;
                // Where no step helps, the last and shortest is taken for the other side of the kink.
                if there.norm() < found.norm() || halving == halvings {
                    (self.unknowns, found) = (ahead, there);
                    break;
                }
                step *= 0.5;
            }
        }
        Err(NoRest::NotFound)
    }

    /// Steps q ← q − J₀⁻¹ F(q) with the Jacobian where they begin, while each is at most half of the one before;
    /// whether they came to rest.
    fn by_chords<T: Terrain>(
        &mut self,
        stand: &Stand,
        terrain: &T,
        place: [f64; 3],
        asked: &Asked,
    ) -> Result<bool, NoGround> {
        let (mut left, jacobian) = linearised(stand, terrain, place, &self.unknowns, 0.0)?;
        let factors = jacobian.lu();
        let (mut unknowns, mut last) = (self.unknowns, None);
        for _ in 0..CHORDS {
            let Some(step) = factors.solve(&left) else { return Ok(false) };
            let length = step.amax();
            if !(last.is_none_or(|last| length <= 0.5 * last) && length <= FARTHEST) {
                return Ok(false);
            }
            unknowns -= step;
            // What is left is the share of this step that this one was of the last.
            if length < asked.closed || last.is_some_and(|last| length * length < asked.closed * last) {
                self.unknowns = unknowns;
                return Ok(true);
            }
            (left, last) = (gaps(stand, terrain, place, &unknowns)?, Some(length));
        }
        Ok(false)
    }
}

/// Largest |angle| of rocker and bogies, rad; 0 without joints.
pub(super) fn joint(rest: &Rest) -> f64 {
    rest.unknowns.iter().skip(3).fold(0.0, |most, angle| most.max(angle.abs()))
}

/// Angle of the body's z axis from the vertical, rad.
pub(super) fn tilt(rest: &Rest) -> f64 {
    libm::acos((libm::cos(rest.roll()) * libm::cos(rest.pitch())).clamp(-1.0, 1.0))
}

#[cfg(feature = "unit-tests")]
mod tests {
    use super::*;
    use crate::world::terrain::generate::{Recipe, generate};

    /// From rests half a decimetre and a tenth of a radian away, which one step alone does not make good.
    #[test]
    fn rests_are_as_exact_as_they_are_asked_for() {
        let stand = Stand::RockerBogie {
            pivot: Vector3::new(0.2415, 0.4, 0.21),
            rocker_wheel: Vector3::new(0.576, 0.0, -0.25),
            bogie_joint: Vector3::new(-0.2416, 0.0, -0.21),
            bogie_wheels: [Vector3::new(0.138, 0.0, -0.04), Vector3::new(-0.138, 0.0, -0.04)],
            radius: 0.13,
        };
        let hills = Recipe { size_m: 20.0, cell_m: 0.1, relief_m: 0.5, hurst: 0.9, ..Recipe::default() };
        let hills = generate(&hills).unwrap();
        let mut most = [0.0_f64; 2];
        for i in 0..100 {
            let at = |share: f64| [5.0 + 0.1 * f64::from(i) + 0.05 * share, 6.0, 0.1 * share];
            let begun = Rest::find(&stand, &hills, at(0.0)).unwrap();
            let off = |closed: f64| -> f64 {
                let mut rest = begun;
                rest.follow(&stand, &hills, at(1.0), &Asked { closed, ..EXACTLY }).unwrap();
                gaps(&stand, &hills, at(1.0), &rest.unknowns).unwrap().amax()
            };
            most = [most[0].max(off(1e-9)), most[1].max(off(1e-5))];
        }
        assert!(most[0] < 1e-8 && most[1] < 1e-4, "{most:?}");
    }
}
