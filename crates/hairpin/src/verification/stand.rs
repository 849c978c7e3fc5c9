//! How a vehicle stands on the ground, for the proof: a chain of rotations, contacts, and Newton's method with
//! differences.
//!
//! Nothing is shared with the robot's own suspension: wheels are placed by matrices, derivatives are differences, the
//! linear systems are solved by a general decomposition.
//!
//! F(q) = 0 by Newton with central differences of width 1e-6 to 1e-2, an inverse Jacobian borrowed from the
//! neighbouring rest as long as it helps, halved steps, and the same order of falls as the claim's own, typed again.

use std::sync::Arc;

use nalgebra::{Matrix3, SMatrix, SVector, Vector3};

use crate::world::terrain::{NoGround, Terrain};

/// What rests on the ground, m, in the body frame (x forward, y left, z up).
///
/// `Level` needs no ground and knows no tilt.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Stand {
    /// A point that stays level.
    Level,
    /// Wheels on a rigid body: front left, front right, rear left, rear right.
    FourWheel {
        /// Their centres.
        wheels: [Vector3<f64>; 4],
        /// Their radius.
        radius: f64,
    },
    /// Rocker-bogie: the left side, the right one mirrored, rockers equal and opposite.
    RockerBogie {
        /// Pivot on the body.
        pivot: Vector3<f64>,
        /// The rocker's wheel from the pivot.
        rocker_wheel: Vector3<f64>,
        /// The bogie's joint from the pivot.
        bogie_joint: Vector3<f64>,
        /// The bogie's wheels from the joint.
        bogie_wheels: [Vector3<f64>; 2],
        /// Radius of the wheels.
        radius: f64,
    },
}

/// Heights and angles that are looked for: (z, φ, θ) and, with a rocker-bogie, (rocker, left bogie, right bogie).
type Unknowns = SVector<f64, 6>;
/// Gaps of the wheels, m; those there are not stay zero.
type Gaps = SVector<f64, 6>;

/// A pose at rest, kept from one place to the next.
#[derive(Debug, Clone)]
pub(super) struct Rest {
    unknowns: Unknowns,
    /// The inverse Jacobian it was found with; good for its neighbours, and one with theirs: rests are copied often.
    inverse: Option<Arc<SMatrix<f64, 6, 6>>>,
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
/// Steps shorter than this end the search, m and rad.
const CLOSED: f64 = 1e-9;
/// Steps with the neighbour's Jacobian, and Jacobians, before the search is given up.
const BORROWED: usize = 8;
const JACOBIANS: usize = 60;
/// Attempts in a row that may not, and then that may, open the gaps.
const LEAPS: usize = 5;
/// Halvings of a step that makes the gaps no smaller.
const HALVINGS: usize = 10;
/// Widths of the difference quotients, m and rad, in the order they are tried.
const DIFFERENCES: [f64; 4] = [1e-6, 1e-4, 1e-3, 1e-2];
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

    /// The same without the inverse, which is then its own again.
    pub(super) fn afresh(&self) -> Self {
        Self { unknowns: self.unknowns, inverse: None }
    }

    /// What two rests lead to at `share` of the way from the first to the last beyond it; the last, where they are no
    /// neighbours.
    pub(super) fn foreseen(first: &Self, last: &Self, share: f64) -> Self {
        let change = last.unknowns - first.unknowns;
        if change.amax() > NEIGHBOURS {
            return last.clone();
        }
        Self { unknowns: last.unknowns + share * change, inverse: last.inverse.clone() }
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
            return Ok(Self { unknowns: Unknowns::zeros(), inverse: None });
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
            let mut rest = Self { unknowns, inverse: None };
            match rest.follow(stand, terrain, place) {
                Ok(()) => return Ok(rest),
                Err(why) => refused = why,
            }
        }
        Err(refused)
    }

    /// Brings the body to rest at `place`, near the rest it had before; where it falls over an edge, wherever it comes
    /// to rest.
    pub(super) fn carry_on<T: Terrain>(&mut self, stand: &Stand, terrain: &T, place: [f64; 3]) -> Result<(), NoRest> {
        let before = self.unknowns;
        if self.follow(stand, terrain, place).is_ok() {
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
            let mut fallen = Self { unknowns: before, inverse: None };
            fallen.unknowns[joint] += angle;
            if fallen.follow(stand, terrain, place).is_ok() {
                *self = fallen;
                return Ok(());
            }
        }
        Err(refused)
    }

    /// Brings the body to rest at `place`, from the rest it had before; no link of it on its head.
    pub(super) fn follow<T: Terrain>(&mut self, stand: &Stand, terrain: &T, place: [f64; 3]) -> Result<(), NoRest> {
        self.approach(stand, terrain, place)?;
        let upright = self.unknowns.rows(3, 3).iter().all(|joint| joint.abs() <= std::f64::consts::FRAC_PI_2);
        if upright { Ok(()) } else { Err(NoRest::NotFound) }
    }

    /// Newton's method for F(q) = 0 from where the last place came to rest: q ← q − J⁺ F(q).
    ///
    /// First the neighbour's J⁺ is used again and learns from each step by Broyden's update, as long as each is at most
    /// half of the one before (not on four wheels, whose gaps end at a least that depends on it). Then a J of its own
    /// is taken at each iteration, by central differences, and the step, at most [`FARTHEST`], is halved until ‖F‖
    /// falls; every other [`LEAPS`] iterations take it whole, which leads out of corners. At rest where a step is below
    /// [`CLOSED`] (m and rad).
    fn approach<T: Terrain>(&mut self, stand: &Stand, terrain: &T, place: [f64; 3]) -> Result<(), NoRest> {
        if *stand == Stand::Level {
            return Ok(());
        }
        let gaps_at = |unknowns: &Unknowns| gaps(stand, terrain, place, unknowns).map_err(NoRest::Ground);
        // A neighbour's Jacobian closes gaps as its own does; where gaps remain it is another least that it leads to.
        if let Some(inverse) = self.inverse.as_ref().filter(|_| !matches!(stand, Stand::FourWheel { .. })) {
            let (mut inverse, mut unknowns, mut last) = (**inverse, self.unknowns, f64::INFINITY);
            let mut gaps = gaps_at(&unknowns)?;
            for _ in 0..BORROWED {
                let step = inverse * gaps;
                let length = step.amax();
                if !(length <= 0.5 * last && length <= FARTHEST) {
                    break;
                }
                unknowns -= step;
                // What is left is the share of this step that this one was of the last.
                if length < CLOSED || length * length < CLOSED * last {
                    (self.unknowns, self.inverse) = (unknowns, Some(Arc::new(inverse)));
                    return Ok(());
                }
                let there = gaps_at(&unknowns)?;
                inverse = broyden(&inverse, &step, &(gaps - there));
                (gaps, last) = (there, length);
            }
        }
        let mut found = gaps_at(&self.unknowns)?;
        for attempt in 0..JACOBIANS {
            // Steps that must close the gaps can end in a corner of them; every other attempt may leap out of it.
            let halvings = if (attempt / LEAPS).is_multiple_of(2) { HALVINGS } else { 0 };
            // The ground's offset surface has kinks at the borders of cells. Differences over some way straddle them,
            // and converge where those of one side swing from piece to piece.
            let width = DIFFERENCES[attempt * DIFFERENCES.len() / JACOBIANS];
            let jacobian = jacobian(stand, terrain, place, &self.unknowns, width).map_err(NoRest::Ground)?;
            let Some(inverse) = pseudo_inverse(stand, &jacobian) else { continue };
            let mut step = inverse * found;
            let length = step.amax();
            step *= FARTHEST / length.max(FARTHEST);
            self.inverse = Some(Arc::new(inverse));
            if length < CLOSED {
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
}

/// Signed distances of the wheels' centres over the ground's offset surface h + r √(1 + |∇h|²).
fn gaps<T: Terrain>(stand: &Stand, terrain: &T, place: [f64; 3], unknowns: &Unknowns) -> Result<Gaps, NoGround> {
    let world_from_body = turn(2, place[2]) * turn(1, unknowns[2]) * turn(0, unknowns[1]);
    let origin = Vector3::new(place[0], place[1], unknowns[0]);
    let (wheels, count, radius) = wheels(stand, unknowns);
    let mut gaps = Gaps::zeros();
    for (gap, wheel) in gaps.iter_mut().zip(&wheels[..count]) {
        let center = origin + world_from_body * wheel;
        let (height, [east, north]) = terrain.tangent(center.x, center.y)?;
        *gap = center.z - height - radius * (1.0 + east * east + north * north).sqrt();
    }
    Ok(gaps)
}

/// A turn by `angle` about the axis x (0), y (1) or z (2).
pub(super) fn turn(axis: usize, angle: f64) -> Matrix3<f64> {
    let (sin, cos) = libm::sincos(angle);
    let (next, last) = ((axis + 1) % 3, (axis + 2) % 3);
    let mut matrix = Matrix3::identity();
    (matrix[(next, next)], matrix[(last, last)]) = (cos, cos);
    (matrix[(next, last)], matrix[(last, next)]) = (-sin, sin);
    matrix
}

/// Centres of the wheels in the body frame, how many there are, and their radius.
fn wheels(stand: &Stand, unknowns: &Unknowns) -> ([Vector3<f64>; 6], usize, f64) {
    let mut places = [Vector3::zeros(); 6];
    match stand {
        Stand::Level => (places, 0, 0.0),
        Stand::FourWheel { wheels, radius } => {
            places[..4].copy_from_slice(wheels);
            (places, 4, *radius)
        }
        Stand::RockerBogie { pivot, rocker_wheel, bogie_joint, bogie_wheels, radius } => {
            let left = turn(1, unknowns[3]);
            let sides = [(1.0, left, unknowns[4]), (-1.0, left.transpose(), unknowns[5])];
            for (places, (side, at_rocker, bogie)) in places.chunks_exact_mut(3).zip(sides) {
                let mirrored = |v: &Vector3<f64>| Vector3::new(v.x, side * v.y, v.z);
                let at_bogie = at_rocker * turn(1, bogie);
                places[0] = mirrored(pivot) + at_rocker * mirrored(rocker_wheel);
                let joint = mirrored(pivot) + at_rocker * mirrored(bogie_joint);
                places[1] = joint + at_bogie * mirrored(&bogie_wheels[0]);
                places[2] = joint + at_bogie * mirrored(&bogie_wheels[1]);
            }
            (places, 6, *radius)
        }
    }
}

/// ∂F/∂q by central differences, whose error is O(width²) where the ground is smooth; columns of unknowns that the
/// stand does not have are 0.
fn jacobian<T: Terrain>(
    stand: &Stand,
    terrain: &T,
    place: [f64; 3],
    unknowns: &Unknowns,
    width: f64,
) -> Result<SMatrix<f64, 6, 6>, NoGround> {
    let mut jacobian = SMatrix::<f64, 6, 6>::zeros();
    let count = if matches!(stand, Stand::RockerBogie { .. }) { 6 } else { 3 };
    for i in 0..count {
        let (mut ahead, mut behind) = (*unknowns, *unknowns);
        ahead[i] += width;
        behind[i] -= width;
        let difference = gaps(stand, terrain, place, &ahead)? - gaps(stand, terrain, place, &behind)?;
        jacobian.set_column(i, &(difference / (2.0 * width)));
    }
    Ok(jacobian)
}

/// The inverse that also leads by `step` where the gaps changed by `closed`: B + (s − B y) sᵀB/(sᵀB y). Broyden 1965.
fn broyden(inverse: &SMatrix<f64, 6, 6>, step: &Unknowns, closed: &Gaps) -> SMatrix<f64, 6, 6> {
    let (led, across) = (inverse * closed, inverse.tr_mul(step));
    let along = across.dot(closed);
    if along == 0.0 { *inverse } else { inverse + (step - led) * across.transpose() / along }
}

/// (JᵀJ)⁻¹Jᵀ over the unknowns there are: the inverse, or what brings four gaps to their least squares.
fn pseudo_inverse(stand: &Stand, jacobian: &SMatrix<f64, 6, 6>) -> Option<SMatrix<f64, 6, 6>> {
    if matches!(stand, Stand::RockerBogie { .. }) {
        return jacobian.try_inverse();
    }
    let thin = jacobian.fixed_view::<6, 3>(0, 0);
    let inverse = (thin.transpose() * thin).try_inverse()? * thin.transpose();
    let mut whole = SMatrix::<f64, 6, 6>::zeros();
    whole.fixed_view_mut::<3, 6>(0, 0).copy_from(&inverse);
    Some(whole)
}

/// Largest |angle| of rocker and bogies, rad; 0 without joints.
pub(super) fn joint(rest: &Rest) -> f64 {
    rest.unknowns.iter().skip(3).fold(0.0, |most, angle| most.max(angle.abs()))
}

/// Angle of the body's z axis from the vertical, rad.
pub(super) fn tilt(rest: &Rest) -> f64 {
    libm::acos((libm::cos(rest.roll()) * libm::cos(rest.pitch())).clamp(-1.0, 1.0))
}
