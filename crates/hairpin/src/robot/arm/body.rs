//! Links as capsules and hulls, how well these are known, and masses where they are.

use nalgebra::{Matrix3, Point3, Vector3};

use super::chain::Chain;
use super::joints::{AXES, Joints};
use super::opw::Opw;
use crate::math::segment::segment_distance;

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

/// All points within `radius` of the convex hull of `points`, in the link's frame, m.
#[derive(Debug, Clone, PartialEq)]
pub struct Hull {
    /// Corners, one at least.
    pub points: Vec<Point3<f64>>,
    /// What the hull is grown by.
    pub radius: f64,
}

/// Where a link's bodies come from: what rests on them is worth as much.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum Outline {
    /// Given, or nearer to what was given than a millimetre.
    #[default]
    Given,
    /// Around what was given, up to so much (m) larger: clear of it is clear, what meets it may not meet the link.
    Around(f64),
    /// A stand-in along the dimensions: the link's own shape is not known, or not all of it.
    StandIn,
}

impl Outline {
    /// Whether nothing is certain of what meets it.
    pub fn is_estimated(&self) -> bool {
        *self != Self::Given
    }
}

/// 0 the base, 1 to 6 the links, 7 the tool, as findings call them.
pub fn body_name(body: usize) -> String {
    match body {
        0 => "the base".into(),
        7 => "the tool".into(),
        link => format!("link {link}"),
    }
}

/// Mass of a link in its frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Mass {
    /// kg.
    pub mass: f64,
    /// Centre of mass, m.
    pub centre: Point3<f64>,
    /// Tensor of inertia about the centre in the link's axes, kg m².
    pub inertia: Matrix3<f64>,
}

/// One link.
///
/// Index 0 is the base; link k is what axis k moves, in its own frame (`base_from_link` of [`super::Chain::frames`]).
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Link {
    /// What it takes up.
    pub capsules: Vec<Capsule>,
    /// What else it takes up.
    pub hulls: Vec<Hull>,
    /// How well that is known.
    pub outline: Outline,
    /// Its mass, where the file gives one.
    pub mass: Option<Mass>,
}

/// Bodies this many joints apart are held against one another; nearer ones are kept apart by the joints' limits.
pub const APART: usize = 3;

/// Radii of stand-in capsules as shares of upper arm + forearm: base, shoulder, upper arm, elbow, forearm, wrist,
/// flange. Measured off the outlines of small arms; a file's own capsules replace them.
const SHARES: [f64; AXES + 1] = [0.15, 0.14, 0.11, 0.10, 0.08, 0.07, 0.055];

/// Stand-in capsules along the dimensions of an arm.
///
/// Radii are shares of c2 + c3, lengths those of the dimensions, all in m, in the link frames of [`Opw::chain`]. One
/// capsule a link, two of link 3 (to the forearm's axis and along it); that of link 5 is a ball.
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

/// Stand-in capsules from joint to joint, a twelfth of the reach thick at the base and a twenty-fourth at the flange;
/// two that would meet in every posture are as much thinner as it takes for them not to.
///
/// ```text
/// radius_k = reach/(12 + 2k),   k = 0 (base) … 6;     from the link's origin to the next joint's, or to the flange
/// ```
///
/// A pair at least [`APART`] links from each other whose axes come no farther apart than both radii, in any posture
/// looked at, shrinks to 0.9 of that distance in all; pairs are looked at in turn, so that a link may become thinner
/// more than once.
pub(super) fn of_chain(chain: &Chain) -> [Vec<Capsule>; AXES + 1] {
    let reach = chain.reach();
    let mut capsules: [Capsule; AXES + 1] = std::array::from_fn(|link| {
        let next = chain.joints.get(link).map_or(&chain.flange, |joint| &joint.origin);
        let end: Point3<f64> = next.translation.vector.into();
        Capsule { a: Point3::origin(), b: end, radius: reach / (12.0 + 2.0 * link as f64) }
    });
    for low in 0..=AXES - APART {
        for high in low + APART..=AXES {
            let apart = most_apart(chain, &capsules, [low, high]);
            let together = capsules[low].radius + capsules[high].radius;
            // Where even their axes always meet nothing would help.
            if apart < together && apart > THINNEST * together {
                let thinner = SPARED * apart / together;
                capsules[low].radius *= thinner;
                capsules[high].radius *= thinner;
            }
        }
    }
    capsules.map(|capsule| vec![capsule])
}

/// Of this the thinner stand-ins leave a tenth free, and thinner than a third none becomes.
const SPARED: f64 = 0.9;
const THINNEST: f64 = 0.33;
/// Postures of each joint that are looked at.
const POSTURES: usize = 6;

/// The largest distance of the axes of two links' capsules, over postures of the joints between them, m.
///
/// 6^(high − low) postures at most: 216 for links three apart, 46 656 for base and flange; ended by the first in
/// which they are apart enough. A lower bound of the true largest distance.
fn most_apart(chain: &Chain, capsules: &[Capsule; AXES + 1], [low, high]: [usize; 2]) -> f64 {
    // The first of the joints between turns the higher link about a line through the lower one's end, and the last of
    // them its own: their angles count as well, of few postures each.
    let count = POSTURES.pow((high - low) as u32);
    let posture = |mut number: usize| {
        let mut q = [0.0; AXES];
        for angle in &mut q[low..high] {
            *angle = (number % POSTURES) as f64 * std::f64::consts::TAU / POSTURES as f64;
            number /= POSTURES;
        }
        q
    };
    let distance = |q: &Joints| {
        let frames = chain.frames(q);
        let [a, b] = [low, high].map(|link| [frames[link] * capsules[link].a, frames[link] * capsules[link].b]);
        segment_distance(&a[0], &a[1], &b[0], &b[1])
    };
    let enough = capsules[low].radius + capsules[high].radius;
    // One posture in which they are apart is enough.
    let mut most = 0.0_f64;
    for number in 0..count {
        most = most.max(distance(&posture(number)));
        if most >= enough {
            break;
        }
    }
    most
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
    ///
    /// `points`, `axes` in the base frame, m; the sum is over the joints that carry the link, 1 … `link`, from the tip
    /// inwards:
    ///
    /// ```text
    /// D_k = D_(k+1) + Δ_k (d_k + D_(k+1)),   D_(link+1) = 0,   d_k the largest distance of a point from axis k
    /// ```
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
