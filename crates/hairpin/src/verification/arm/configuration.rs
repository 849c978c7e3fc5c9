//! Which of several postures an arm is in, and how far from a singularity, told by where its axes lie.
//!
//! Signs of places in space, where the claim has those of angles in closed form:
//!
//! ```text
//! before   = (across × up) · (c − base)             wrist's centre c before (> 0) or behind axis 1
//! elbow    = across · (upper × fore)/(|upper| |fore|)   sine of the bend of the elbow
//! bend     = (e₄ × e₆) · e₅                          sine of axis 5's angle
//! cfx      = 4 [before < 0] + 2 [elbow < 0] + [bend < 0]
//! ```

use std::f64::consts::{FRAC_PI_2, FRAC_PI_4};

use nalgebra::{Point3, Vector3};

use super::Arm;
use super::claim::ArmBuild;
use super::wrist::Wrist;

/// An angle this near (rad) to the border of two quadrants is in both.
const BORDER: f64 = 1e-6;
/// Angles this little (rad) below a border are told as beyond it, for they were rounded.
const ROUNDED: f64 = 1e-9;

/// What places of axes tell of an arm with a spherical wrist; signs are those of its own directions, lengths m.
struct Seen {
    /// Of the wrist's centre before axis 1.
    before: f64,
    /// Sine of the angle from the upper arm to the line from elbow to wrist.
    elbow: f64,
    /// Sine of axis 5's angle.
    bend: f64,
    /// Of upper arm and that line together.
    length: f64,
}

impl Arm<'_> {
    /// Upper arm and forearm are seen along axis 2, so that an offset sideways does not count.
    ///
    /// Joint k's line is (a point, its direction), carried by the joints before it; `signs` turn directions to those
    /// that angles count by. `elbow` is no number where a link seen along axis 2 has no length.
    fn seen(&self, wrist: &Wrist, signs: &[f64; 6], q: &[f64; 6]) -> Seen {
        let carried = self.screws.carried(q);
        let line = |k: usize| carried.line(&self.screws, k);
        let centre = carried.point(3, &wrist.centre);
        let ([(base, up), (shoulder, across), (elbow, _)], [fourth, fifth, sixth]) =
            ([0, 1, 2].map(line), [3, 4, 5].map(|k| line(k).1));
        let (up, across) = (up * signs[0], across * signs[1]);
        let flat = |from: &Point3<f64>, to: &Point3<f64>| -> Vector3<f64> {
            let way = to - from;
            way - across * across.dot(&way)
        };
        let (upper, fore) = (flat(&shoulder, &elbow), flat(&elbow, &centre));
        let lengths = upper.norm() * fore.norm();
        Seen {
            before: across.cross(&up).dot(&(centre - base)),
            elbow: across.dot(&upper.cross(&fore)) / lengths,
            bend: (fourth * signs[3]).cross(&(sixth * signs[5])).dot(&fifth),
            length: upper.norm() + fore.norm(),
        }
    }

    /// 4 for the wrist behind axis 1, 2 for it behind the upper arm, 1 for a negative axis 5; of other builds only that
    /// last.
    pub(super) fn cfx(&self, q: &[f64; 6]) -> i32 {
        let bits = |behind: bool, below: bool, negative: bool| {
            4 * i32::from(behind) + 2 * i32::from(below) + i32::from(negative)
        };
        match (&self.wrist, self.claim.build) {
            (Some(wrist), ArmBuild::SphericalWrist(signs)) => {
                let Seen { before, elbow, bend, .. } = self.seen(wrist, &signs, q);
                bits(before < 0.0, elbow < 0.0, bend < 0.0)
            }
            _ => bits(false, false, q[4] < 0.0),
        }
    }

    /// What is wrong with the configuration of `q` where `wanted` is asked for.
    ///
    /// `wanted` is \[cf1, cf4, cf6, cfx\]; `None` where all four agree. An angle within [`BORDER`] of a quadrant's
    /// border may be told as either.
    pub(super) fn other_than(&self, q: &[f64; 6], wanted: &[i32; 4]) -> Option<String> {
        let cfx = self.cfx(q);
        let inside = |axis: usize, quadrant: i32| (q[axis] - middle_of(quadrant)).abs() <= FRAC_PI_4 + BORDER;
        let [cf1, cf4, cf6, asked] = *wanted;
        let same = cfx == asked && inside(0, cf1) && inside(3, cf4) && inside(5, cf6);
        (!same).then(|| {
            let quadrant = |axis: usize| ((q[axis] + ROUNDED) / FRAC_PI_2).floor() as i32;
            let found = [quadrant(0), quadrant(3), quadrant(5), cfx];
            format!("configuration {}, the target's is {}", written(&found), written(wanted))
        })
    }

    /// The nearest singularity and how far it is: |sin| of axis 5 and of the elbow, distance of the wrist before axis 1
    /// over the arm's length; of other builds 1/‖J⁻¹‖ of the flange, lengths over what adds up from axis 1 to
    /// the flange.
    ///
    /// A pure number, 0 in a singularity: the same three measures that the claim keeps above its bound.
    pub(super) fn margin(&self, q: &[f64; 6]) -> (&'static str, f64) {
        if let (Some(wrist), ArmBuild::SphericalWrist(signs)) = (&self.wrist, self.claim.build) {
            let Seen { before, elbow, bend, length } = self.seen(wrist, &signs, q);
            let all = [("wrist", bend.abs()), ("elbow", elbow.abs()), ("shoulder", before.abs() / length)];
            let nearer = |a: (&'static str, f64), b: (&'static str, f64)| if b.1 < a.1 { b } else { a };
            return all.into_iter().fold(all[0], nearer);
        }
        let carried = self.screws.carried(q);
        let flange = carried.link(&self.screws, 6) * self.claim.flange;
        // From the first axis on: what the arm stands on is no length of it.
        let ((foot, axis), second) = (self.screws.lines[0], self.screws.lines[1].0);
        let lengths = self.claim.joints[2..].iter().map(|joint| joint.parent_from_joint.translation.vector.norm());
        let reach =
            axis.cross(&(second - foot)).norm() + lengths.sum::<f64>() + self.claim.flange.translation.vector.norm();
        let mut jacobian = carried.jacobian(&self.screws, &flange.translation.vector);
        jacobian.fixed_view_mut::<3, 6>(0, 0).scale_mut(1.0 / reach);
        ("chain", jacobian.try_inverse().map_or(0.0, |inverse| 1.0 / inverse.norm()))
    }
}

/// The angle in the middle of a quadrant, rad.
pub(super) fn middle_of(quadrant: i32) -> f64 {
    (f64::from(quadrant) + 0.5) * FRAC_PI_2
}

fn written([cf1, cf4, cf6, cfx]: &[i32; 4]) -> String {
    format!("[{cf1},{cf4},{cf6},{cfx}]")
}
