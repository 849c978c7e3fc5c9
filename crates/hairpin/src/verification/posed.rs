//! How a vehicle is built, for the proof: its wheels' centres by a chain of rotations, their gaps over the ground, and
//! how these change.
//!
//! Nothing is shared with the robot's own suspension: wheels are placed by frames that are turned about their own axes,
//! and move about those, whatever joint it is.

use nalgebra::{Matrix3, SMatrix, SVector, Vector3};

use crate::world::terrain::{NoGround, Patch, Terrain};

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

impl Stand {
    /// x and y of the wheels' centres with all joints at 0, m, and how many there are.
    pub(super) fn wheels(&self) -> ([[f64; 2]; 6], usize) {
        (seen_from_above(self, &Unknowns::zeros()), Posed::new(self, 0.0, &Unknowns::zeros()).count)
    }

    /// Of the wheels, m; 0 without any.
    pub(super) fn radius(&self) -> f64 {
        match self {
            Self::Level => 0.0,
            Self::FourWheel { radius, .. } | Self::RockerBogie { radius, .. } => *radius,
        }
    }
}

/// x and y of the wheels' centres in the body's own axes, its joints as `unknowns` have them, m.
pub(super) fn seen_from_above(stand: &Stand, unknowns: &Unknowns) -> [[f64; 2]; 6] {
    let mut level = *unknowns;
    level.fixed_rows_mut::<3>(0).fill(0.0);
    Posed::new(stand, 0.0, &level).arms.map(|arm| [arm.x, arm.y])
}

/// Heights and angles that are looked for: (z, φ, θ) and, with a rocker-bogie, (rocker, left bogie, right bogie).
pub(super) type Unknowns = SVector<f64, 6>;
/// Gaps of the wheels, m; those there are not stay zero.
pub(super) type Gaps = SVector<f64, 6>;

/// Signed distances of the wheels' centres over the ground's offset surface.
pub(super) fn gaps<T: Terrain>(
    stand: &Stand,
    terrain: &T,
    place: [f64; 3],
    unknowns: &Unknowns,
) -> Result<Gaps, NoGround> {
    let posed = Posed::new(stand, place[2], unknowns);
    let mut gaps = Gaps::zeros();
    for (gap, arm) in gaps.iter_mut().zip(&posed.arms[..posed.count]) {
        *gap = unknowns[0] + arm.z - offset(terrain, posed.radius, place[0] + arm.x, place[1] + arm.y)?;
    }
    Ok(gaps)
}

/// Height of the offset surface h + r √(1 + |∇h|²), m.
fn offset<T: Terrain>(terrain: &T, radius: f64, x: f64, y: f64) -> Result<f64, NoGround> {
    let (height, [east, north]) = terrain.tangent(x, y)?;
    Ok(height + radius * (1.0 + east * east + north * north).sqrt())
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

/// A stand in its pose, from the body's origin in the world's axes.
struct Posed {
    /// Centres of the wheels, how many there are, and their radius.
    arms: [Vector3<f64>; 6],
    count: usize,
    radius: f64,
    /// Axes of roll, of pitch and of the joints.
    axes: [Vector3<f64>; 3],
    /// Pivot and bogie's joint, left and right.
    joints: [[Vector3<f64>; 2]; 2],
}

impl Posed {
    fn new(stand: &Stand, yaw: f64, unknowns: &Unknowns) -> Self {
        let level = spun(&turn(2, yaw), 1, unknowns[2]);
        let body = spun(&level, 0, unknowns[1]);
        let [roll, pitch, joint] = [(level, 0), (level, 1), (body, 1)].map(|(of, axis)| of.column(axis).into_owned());
        let none = Vector3::zeros();
        let (mut arms, mut joints) = ([none; 6], [[none; 2]; 2]);
        let (count, radius) = match stand {
            Stand::Level => (0, 0.0),
            Stand::FourWheel { wheels, radius } => {
                arms.iter_mut().zip(wheels).for_each(|(arm, wheel)| *arm = body * wheel);
                (4, *radius)
            }
            Stand::RockerBogie { pivot, rocker_wheel, bogie_joint, bogie_wheels, radius } => {
                let sides = [(1.0, unknowns[3], unknowns[4]), (-1.0, -unknowns[3], unknowns[5])];
                for (i, (side, rocker, bogie)) in sides.into_iter().enumerate() {
                    let mirrored = |v: &Vector3<f64>| Vector3::new(v.x, side * v.y, v.z);
                    let (at_rocker, hinge) = (spun(&body, 1, rocker), body * mirrored(pivot));
                    let at_bogie = spun(&at_rocker, 1, bogie);
                    let joint = hinge + at_rocker * mirrored(bogie_joint);
                    arms[3 * i] = hinge + at_rocker * mirrored(rocker_wheel);
                    arms[3 * i + 1] = joint + at_bogie * mirrored(&bogie_wheels[0]);
                    arms[3 * i + 2] = joint + at_bogie * mirrored(&bogie_wheels[1]);
                    joints[i] = [hinge, joint];
                }
                (6, *radius)
            }
        };
        Self { arms, count, radius, axes: [roll, pitch, joint], joints }
    }
}

/// `frame` turned by `angle` about its own axis x (0), y (1) or z (2).
fn spun(frame: &Matrix3<f64>, axis: usize, angle: f64) -> Matrix3<f64> {
    let (sin, cos) = libm::sincos(angle);
    let (next, last) = ((axis + 1) % 3, (axis + 2) % 3);
    let (n, l) = (frame.column(next), frame.column(last));
    let mut spun = *frame;
    spun.set_column(next, &(cos * n + sin * l));
    spun.set_column(last, &(cos * l - sin * n));
    spun
}

/// F and ∂F/∂q: wheels move about their joints' axes, ∂p/∂q = axis × arm, over the ground's incline; columns of
/// unknowns that the stand does not have are 0.
pub(super) fn linearised<T: Terrain>(
    stand: &Stand,
    terrain: &T,
    place: [f64; 3],
    unknowns: &Unknowns,
    width: f64,
) -> Result<(Gaps, SMatrix<f64, 6, 6>), NoGround> {
    let posed = Posed::new(stand, place[2], unknowns);
    let (mut gaps, mut jacobian) = (Gaps::zeros(), SMatrix::<f64, 6, 6>::zeros());
    let [roll, pitch, joint] = &posed.axes;
    for (i, arm) in posed.arms[..posed.count].iter().enumerate() {
        let (height, [east, north]) = incline(terrain, posed.radius, [place[0] + arm.x, place[1] + arm.y], width)?;
        gaps[i] = unknowns[0] + arm.z - height;
        let by = |axis: &Vector3<f64>, from: &Vector3<f64>| {
            let moved = axis.cross(&(arm - from));
            moved.z - east * moved.x - north * moved.y
        };
        let origin = Vector3::zeros();
        (jacobian[(i, 0)], jacobian[(i, 1)], jacobian[(i, 2)]) = (1.0, by(roll, &origin), by(pitch, &origin));
        if let Stand::RockerBogie { .. } = stand {
            let (side, [hinge, bogie]) = (i / 3, &posed.joints[i / 3]);
            jacobian[(i, 3)] = if side == 0 { by(joint, hinge) } else { -by(joint, hinge) };
            jacobian[(i, 4 + side)] = if i % 3 == 0 { 0.0 } else { by(joint, bogie) };
        }
    }
    Ok((gaps, jacobian))
}

/// The offset surface's height, and its incline along x and y: by its derivatives ∇h + r ∇²h ∇h/√(1 + |∇h|²), or by
/// central differences of some `width`, whose error is O(width²) where it is smooth.
fn incline<T: Terrain>(terrain: &T, radius: f64, [x, y]: [f64; 2], width: f64) -> Result<(f64, [f64; 2]), NoGround> {
    if width > 0.0 {
        let height = |x: f64, y: f64| offset(terrain, radius, x, y);
        let east = height(x + width, y)? - height(x - width, y)?;
        let north = height(x, y + width)? - height(x, y - width)?;
        return Ok((height(x, y)?, [east, north].map(|rise| rise / (2.0 * width))));
    }
    let Patch { height, slope: [east, north], bend: [xx, xy, yy] } = terrain.patch(x, y)?;
    let stretch = (1.0 + east * east + north * north).sqrt();
    let lean = radius / stretch;
    let incline = [east + lean * (xx * east + xy * north), north + lean * (xy * east + yy * north)];
    Ok((height + radius * stretch, incline))
}

/// The step that closes `gaps` as far as `jacobian` says: J⁻¹ F, or (JᵀJ)⁻¹ JᵀF of four gaps and three unknowns.
pub(super) fn newton(stand: &Stand, jacobian: &SMatrix<f64, 6, 6>, gaps: &Gaps) -> Option<Unknowns> {
    if matches!(stand, Stand::RockerBogie { .. }) {
        return jacobian.lu().solve(gaps);
    }
    let thin = jacobian.fixed_view::<6, 3>(0, 0);
    let step = (thin.transpose() * thin).try_inverse()? * (thin.transpose() * gaps);
    Some(Unknowns::from_fn(|i, _| if i < 3 { step[i] } else { 0.0 }))
}
