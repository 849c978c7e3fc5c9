//! Links as capsules, and their masses where they are known.

use nalgebra::{Point3, Vector3};

use super::chain::Chain;
use super::joints::{AXES, Joints};
use super::opw::Opw;

/// All points within `radius` of the segment a–b, in the link's frame, m.
///
/// Distances to capsules are those to their axes less the radius: a link's shape is where its drawing fits inside.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Capsule {
    /// One end of the axis.
    pub a: Point3<f64>,
    /// The other end; equal to `a` for a ball.
    pub b: Point3<f64>,
    /// Radius.
    pub radius: f64,
}

/// Mass of a link in its frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Mass {
    /// kg.
    pub mass: f64,
    /// Centre of mass, m.
    pub centre: Point3<f64>,
    /// Principal moments about the centre along the link's axes, kg m².
    pub inertia: Vector3<f64>,
}

/// One link.
///
/// Index 0 is the base; link k is what axis k moves, in its own frame (`base_from_link` of [`super::Chain::frames`]).
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Link {
    /// What it takes up.
    pub capsules: Vec<Capsule>,
    /// Its mass, where the file gives one.
    pub mass: Option<Mass>,
}

/// Radii of stand-in capsules as shares of upper arm + forearm: base, shoulder, upper arm, elbow, forearm, wrist,
/// flange. Measured off the outlines of small arms; a file's own capsules replace them.
const SHARES: [f64; AXES + 1] = [0.15, 0.14, 0.11, 0.10, 0.08, 0.07, 0.055];

/// Stand-in capsules along the dimensions of an arm.
pub(super) fn of_opw(opw: &Opw) -> [Vec<Capsule>; AXES + 1] {
    let length = opw.c2 + opw.c3;
    let radius: [f64; AXES + 1] = SHARES.map(|share| share * length);
    let capsule = |a: [f64; 3], b: [f64; 3], link: usize| Capsule { a: a.into(), b: b.into(), radius: radius[link] };
    let foot = radius[0].min(0.5 * opw.c1);
    let tip = (opw.c4 - radius[6]).max(0.0);
    // At angles of 0 in the paper's count every link frame stands upright.
    [
        vec![capsule([0.0, 0.0, foot], [0.0, 0.0, (0.6 * opw.c1).max(foot)], 0)],
        vec![capsule([0.0, 0.0, opw.c1], [opw.a1, opw.b, opw.c1], 1)],
        vec![capsule([0.0; 3], [0.0, 0.0, opw.c2], 2)],
        vec![capsule([0.0; 3], [opw.a2, 0.0, 0.0], 3), capsule([opw.a2, 0.0, 0.0], [opw.a2, 0.0, 0.4 * opw.c3], 3)],
        vec![capsule([0.0, 0.0, 0.4 * opw.c3], [0.0, 0.0, opw.c3], 4)],
        vec![capsule([0.0; 3], [0.0; 3], 5)],
        vec![capsule([0.0; 3], [0.0, 0.0, tip], 6)],
    ]
}

/// Stand-in capsules from joint to joint, a twelfth of the reach thick at the base and a twenty-fourth at the flange.
pub(super) fn of_chain(chain: &Chain) -> [Vec<Capsule>; AXES + 1] {
    let reach = chain.reach();
    std::array::from_fn(|link| {
        let next = chain.joints.get(link).map_or(&chain.flange, |joint| &joint.origin);
        let radius = reach / (12.0 + 2.0 * link as f64);
        let end: Point3<f64> = next.translation.vector.into();
        vec![Capsule { a: Point3::origin(), b: end, radius }]
    })
}

impl Chain {
    /// Upper bounds of how far a point of link `link` moves when every joint k turns by at most `turns[k]` (rad) from
    /// where `axes` were taken: joints are turned from the tip inwards; each moves the point by at most its angle times
    /// the distance from its axis, and that distance has grown by no more than what the joints beyond have moved the
    /// point.
    ///
    /// Σ over k, from the tip: `turns[k]` · (distance from axis k + what the joints beyond have added), since an arc is
    /// no longer than angle times radius. `points` are those of the link whose hull it is: a capsule's two ends bound
    /// its axis.
    pub fn displacement(
        axes: &[(Point3<f64>, Vector3<f64>); AXES],
        link: usize,
        points: &[Point3<f64>],
        turns: &Joints,
    ) -> f64 {
        let mut most = 0.0;
        for (turn, (origin, axis)) in turns[..link].iter().zip(axes).rev() {
            let distance = points.iter().map(|p| axis.cross(&(p - origin)).norm()).fold(0.0, f64::max);
            most += turn * (distance + most);
        }
        most
    }
}
