//! An arm's moves followed by equations of their own: every one that a program uses, sampled densely, against the arm's bounds and the cell.
//!
//! Shares nothing with what proved them: places of links by products of the joints' frames, straight moves by Gauss-Newton steps on the geometric Jacobian from
//! sample to sample, distances of points on the bodies' axes from solids by formulas of their own. What is proven to keep a distance everywhere keeps it at every
//! sample, so that no true claim is refused; a false one is found where samples see it.

use nalgebra::{Isometry3, Matrix6, Point3, Vector3, Vector6};

use crate::math::rotation::{from_rotation_vector, rotation_vector};

/// One joint: q turns the link about `axis` where `parent_from_joint` puts it.
#[derive(Debug, Clone, PartialEq)]
pub struct ArmJointClaim {
    /// At angle 0.
    pub parent_from_joint: Isometry3<f64>,
    /// Of length 1.
    pub axis: Vector3<f64>,
    /// Least and largest angle, rad.
    pub bounds: [f64; 2],
}

/// All points within `radius` of a segment, in the frame of a link.
#[derive(Debug, Clone, PartialEq)]
pub struct ArmBodyClaim {
    /// 1 to 6: what joint k moves; the tool is in 6.
    pub link: usize,
    /// As findings call it.
    pub name: String,
    /// Whether it is the tool.
    pub tool: bool,
    /// Both ends of the segment, m.
    pub axis: [Point3<f64>; 2],
    /// m.
    pub radius: f64,
}

/// What must not be touched, in the base frame, m.
pub struct ArmSolidClaim<'a> {
    /// As findings call it.
    pub name: &'a str,
    /// Whether only the tool has to keep off.
    pub tool_only: bool,
    /// Its points.
    pub form: ArmSolidForm<'a>,
}

/// Forms of solids.
pub enum ArmSolidForm<'a> {
    /// Centre and radius.
    Ball(Point3<f64>, f64),
    /// Centre and half the edge lengths.
    Box(Point3<f64>, Vector3<f64>),
    /// Both ends of the axis and the radius.
    Capsule([Point3<f64>; 2], f64),
    /// The same with flat ends.
    Cylinder([Point3<f64>; 2], f64),
    /// All p with normal·p ≤ offset.
    HalfSpace(Vector3<f64>, f64),
    /// The inside of closed triangles.
    Triangles(Vec<[Point3<f64>; 3]>),
    /// Where this is true; distances from it are not known.
    Where(&'a dyn Fn(&Point3<f64>) -> bool),
}

/// A move from where the one before it ended.
#[derive(Debug, Clone, PartialEq)]
pub enum ArmMoveClaim {
    /// All joints in step, to these angles (rad), at which the tool is at the pose if one is given.
    Joints([f64; 6], Option<Isometry3<f64>>),
    /// The tool straight to the pose, turning about one axis.
    Straight(Isometry3<f64>),
}

/// An arm, its cell, and a program.
pub struct ArmMovesClaim<'a> {
    /// From the base on.
    pub joints: &'a [ArmJointClaim; 6],
    /// `link6_from_tcp`.
    pub tool: Isometry3<f64>,
    /// Links and tool.
    pub bodies: &'a [ArmBodyClaim],
    /// The cell.
    pub solids: &'a [ArmSolidClaim<'a>],
    /// What bodies keep from solids, m.
    pub clearance: f64,
    /// Where the program starts, rad.
    pub start: [f64; 6],
    /// Its moves.
    pub moves: &'a [ArmMoveClaim],
}

/// Something that does not hold on a move.
#[derive(Debug, Clone, PartialEq)]
pub struct ArmMoveFinding {
    /// The move, from 0.
    pub index: usize,
    /// Share of it.
    pub at: f64,
    /// What, in words.
    pub what: String,
}

/// Samples of a straight move are this near, m and rad; of a joint move this, rad.
const STEP: [f64; 3] = [2e-3, 0.01, 0.01];
/// Points on a body's axis are this near, m.
const ALONG: f64 = 5e-3;
/// Room for rounding, m and rad.
const ROUNDING: f64 = 1e-6;

/// The first thing on each move that does not hold; the moves after one that cannot be followed are not looked at.
pub fn verify_arm_moves(claim: &ArmMovesClaim) -> Vec<ArmMoveFinding> {
    let mut findings = Vec::new();
    let boxes: Vec<Option<ArmSolidForm>> = claim.solids.iter().map(|solid| box_around(&solid.form)).collect();
    let mut at = claim.start;
    for (index, one) in claim.moves.iter().enumerate() {
        let begun = at;
        let (start, found) = (place(claim, &at), |at: f64, what: String| ArmMoveFinding { index, at, what });
        let count = samples(claim, &at, one);
        let mut wrong = None;
        for sample in 0..=count {
            let share = sample as f64 / count as f64;
            match one {
                ArmMoveClaim::Joints(end, _) => at = std::array::from_fn(|k| begun[k] + share * (end[k] - begun[k])),
                ArmMoveClaim::Straight(to) => match reach(claim, &at, &between(&start, to, share)) {
                    Some(q) => at = q,
                    None => {
                        findings.push(found(share, "the tool cannot be led on".into()));
                        return findings;
                    }
                },
            }
            wrong = wrong.or_else(|| wrong_at(claim, &boxes, &at).map(|what| found(share, what)));
        }
        if let ArmMoveClaim::Joints(_, Some(pose)) = one {
            let (off, turn) = apart(&place(claim, &at), pose);
            if off > ROUNDING || turn > ROUNDING {
                wrong = wrong
                    .or(Some(found(1.0, format!("the tool arrives {off:.2e} m and {turn:.2e} rad off its target"))));
            }
        }
        findings.extend(wrong);
    }
    findings
}

fn samples(claim: &ArmMovesClaim, from: &[f64; 6], one: &ArmMoveClaim) -> usize {
    let steps = match one {
        ArmMoveClaim::Joints(end, _) => (0..6).map(|k| (end[k] - from[k]).abs()).fold(0.0, f64::max) / STEP[2],
        ArmMoveClaim::Straight(to) => {
            let (off, turn) = apart(&place(claim, from), to);
            (off / STEP[0]).max(turn / STEP[1])
        }
    };
    (steps.ceil() as usize).clamp(1, 100_000)
}

/// Distance and angle between two poses.
fn apart(a: &Isometry3<f64>, b: &Isometry3<f64>) -> (f64, f64) {
    ((a.translation.vector - b.translation.vector).norm(), rotation_vector(&(a.rotation.inverse() * b.rotation)).norm())
}

fn between(from: &Isometry3<f64>, to: &Isometry3<f64>, share: f64) -> Isometry3<f64> {
    let turn = rotation_vector(&(from.rotation.inverse() * to.rotation)) * share;
    let point = from.translation.vector + (to.translation.vector - from.translation.vector) * share;
    Isometry3::from_parts(point.into(), from.rotation * from_rotation_vector(&turn))
}

/// `base_from_link` of the base and the six links.
fn links(claim: &ArmMovesClaim, q: &[f64; 6]) -> [Isometry3<f64>; 7] {
    let mut frames = [Isometry3::identity(); 7];
    for (k, joint) in claim.joints.iter().enumerate() {
        frames[k + 1] = frames[k] * joint.parent_from_joint * from_rotation_vector(&(joint.axis * q[k]));
    }
    frames
}

fn place(claim: &ArmMovesClaim, q: &[f64; 6]) -> Isometry3<f64> {
    links(claim, q)[6] * claim.tool
}

/// Joint angles near `q` with the tool at `pose`.
fn reach(claim: &ArmMovesClaim, q: &[f64; 6], pose: &Isometry3<f64>) -> Option<[f64; 6]> {
    let mut q = *q;
    for _ in 0..30 {
        let frames = links(claim, &q);
        let tool = frames[6] * claim.tool;
        let shift = pose.translation.vector - tool.translation.vector;
        let turn = rotation_vector(&(pose.rotation * tool.rotation.inverse()));
        if shift.norm() < 1e-10 && turn.norm() < 1e-10 {
            return Some(q);
        }
        let mut jacobian = Matrix6::zeros();
        for (k, joint) in claim.joints.iter().enumerate() {
            let frame = frames[k + 1];
            let axis = frame.rotation * joint.axis;
            let arm = tool.translation.vector - frame.translation.vector;
            jacobian.fixed_view_mut::<3, 1>(0, k).copy_from(&axis.cross(&arm));
            jacobian.fixed_view_mut::<3, 1>(3, k).copy_from(&axis);
        }
        let wanted = Vector6::new(shift.x, shift.y, shift.z, turn.x, turn.y, turn.z);
        let step = jacobian.lu().solve(&wanted)?;
        // A step that large has lost the way.
        if step.norm().is_nan() || step.norm() > 1.0 {
            return None;
        }
        (0..6).for_each(|k| q[k] += step[k]);
    }
    None
}

/// What is wrong with a posture.
fn wrong_at(claim: &ArmMovesClaim, boxes: &[Option<ArmSolidForm>], q: &[f64; 6]) -> Option<String> {
    for (k, joint) in claim.joints.iter().enumerate() {
        if q[k] < joint.bounds[0] - ROUNDING || q[k] > joint.bounds[1] + ROUNDING {
            return Some(format!("axis {} is at {:.3}°, beyond its bound", k + 1, q[k].to_degrees()));
        }
    }
    let frames = links(claim, q);
    for body in claim.bodies {
        let [a, b] = body.axis.map(|end| frames[body.link] * end);
        let count = ((b - a).norm() / ALONG).ceil().max(1.0);
        let points: Vec<Point3<f64>> = (0..=count as usize).map(|i| a + (b - a) * (i as f64 / count)).collect();
        for (solid, hull) in claim.solids.iter().zip(boxes).filter(|(solid, _)| body.tool || !solid.tool_only) {
            let room = body.radius + claim.clearance;
            // Triangles are many: where their box is far, they are.
            if hull.as_ref().is_some_and(|hull| points.iter().all(|p| distance(hull, p) > room)) {
                continue;
            }
            let least = points.iter().map(|p| distance(&solid.form, p)).fold(f64::INFINITY, f64::min);
            if least < room - ROUNDING {
                let (left, asked) = (1e3 * (least - body.radius), 1e3 * claim.clearance);
                return Some(format!("{} keeps {left:.2} mm from {}, not {asked:.2} mm", body.name, solid.name));
            }
        }
    }
    None
}

/// The box around triangles.
fn box_around(form: &ArmSolidForm) -> Option<ArmSolidForm<'static>> {
    let ArmSolidForm::Triangles(triangles) = form else { return None };
    let mut corners = triangles.iter().flatten();
    let first = *corners.next()?;
    let (low, high) = corners.fold((first, first), |(low, high), corner| (low.inf(corner), high.sup(corner)));
    Some(ArmSolidForm::Box(nalgebra::center(&low, &high), (high - low) * 0.5))
}

/// Distance of a point from a solid, m; inside at most 0.
fn distance(form: &ArmSolidForm, p: &Point3<f64>) -> f64 {
    match form {
        ArmSolidForm::Ball(center, radius) => (p - center).norm() - radius,
        ArmSolidForm::Box(center, half) => {
            let d = (p - center).abs() - half;
            d.map(|part| part.max(0.0)).norm() + d.max().min(0.0)
        }
        ArmSolidForm::Capsule(axis, radius) => (p - nearest_on(axis, p)).norm() - radius,
        ArmSolidForm::Cylinder([a, b], radius) => {
            let along = (b - a).normalize();
            let height = (p - a).dot(&along);
            let aside = (p - a - along * height).norm() - radius;
            let beyond = (-height).max(height - (b - a).norm());
            Vector3::new(aside.max(0.0), beyond.max(0.0), 0.0).norm() + aside.max(beyond).min(0.0)
        }
        ArmSolidForm::HalfSpace(normal, offset) => (normal.dot(&p.coords) - offset) / normal.norm(),
        ArmSolidForm::Triangles(triangles) => {
            let far =
                triangles.iter().map(|triangle| (p - nearest_in(triangle, p)).norm()).fold(f64::INFINITY, f64::min);
            // The solid angle of a closed surface, seen from inside, is the whole sphere's.
            let seen: f64 = triangles.iter().map(|triangle| solid_angle(triangle, p)).sum();
            if seen.abs() > std::f64::consts::TAU { -far } else { far }
        }
        ArmSolidForm::Where(holds) => {
            if holds(p) {
                0.0
            } else {
                f64::INFINITY
            }
        }
    }
}

fn nearest_on([a, b]: &[Point3<f64>; 2], p: &Point3<f64>) -> Point3<f64> {
    let way = b - a;
    let square = way.norm_squared();
    let share = if square > 0.0 { ((p - a).dot(&way) / square).clamp(0.0, 1.0) } else { 0.0 };
    a + way * share
}

/// The foot on the plane where it lies inside, else the nearest point of an edge.
fn nearest_in(triangle: &[Point3<f64>; 3], p: &Point3<f64>) -> Point3<f64> {
    let [a, b, c] = triangle;
    let normal = (b - a).cross(&(c - a));
    let square = normal.norm_squared();
    if square > 0.0 {
        let foot = p - normal * ((p - a).dot(&normal) / square);
        let inside = |u: &Point3<f64>, v: &Point3<f64>| (v - u).cross(&(foot - u)).dot(&normal) >= 0.0;
        if inside(a, b) && inside(b, c) && inside(c, a) {
            return foot;
        }
    }
    let edges = [[*a, *b], [*b, *c], [*c, *a]].map(|edge| nearest_on(&edge, p));
    let far = |q: &Point3<f64>| (p - q).norm_squared();
    edges.into_iter().min_by(|q, r| far(q).total_cmp(&far(r))).unwrap_or(*a)
}

/// Van Oosterom & Strackee 1983.
fn solid_angle(triangle: &[Point3<f64>; 3], p: &Point3<f64>) -> f64 {
    let [a, b, c] = triangle.map(|corner| corner - p);
    let (la, lb, lc) = (a.norm(), b.norm(), c.norm());
    let below = la * lb * lc + a.dot(&b) * lc + b.dot(&c) * la + c.dot(&a) * lb;
    2.0 * libm::atan2(a.dot(&b.cross(&c)), below)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Three joints about z, y, y and three of a wrist about x, y, x, each 0.3 m up or out.
    fn joints() -> [ArmJointClaim; 6] {
        let axes = [Vector3::z(), Vector3::y(), Vector3::y(), Vector3::x(), Vector3::y(), Vector3::x()];
        let shifts = [[0.0, 0.0, 0.3], [0.0; 3], [0.0, 0.0, 0.3], [0.0, 0.0, 0.05], [0.3, 0.0, 0.0], [0.0; 3]];
        std::array::from_fn(|k| ArmJointClaim {
            parent_from_joint: Isometry3::translation(shifts[k][0], shifts[k][1], shifts[k][2]),
            axis: axes[k],
            bounds: [-2.5, 2.5],
        })
    }

    fn check(form: ArmSolidForm, moves: &[ArmMoveClaim]) -> Vec<ArmMoveFinding> {
        let body = |link, name: &str, tool, b: [f64; 3], radius| ArmBodyClaim {
            link,
            name: name.into(),
            tool,
            axis: [Point3::origin(), b.into()],
            radius,
        };
        let bodies = [body(5, "link 5", false, [0.0; 3], 0.05), body(6, "the tool", true, [0.1, 0.0, 0.0], 0.02)];
        let solids = [ArmSolidClaim { name: "block", tool_only: false, form }];
        verify_arm_moves(&ArmMovesClaim {
            joints: &joints(),
            tool: Isometry3::translation(0.1, 0.0, 0.0),
            bodies: &bodies,
            solids: &solids,
            clearance: 0.01,
            start: START,
            moves,
        })
    }

    const START: [f64; 6] = [0.0, 0.2, -0.3, 0.0, 0.5, 0.0];
    const NOWHERE: ArmSolidForm<'static> = ArmSolidForm::HalfSpace(Vector3::new(0.0, 0.0, 1.0), -10.0);

    fn tool_at(q: &[f64; 6]) -> Isometry3<f64> {
        let claim = ArmMovesClaim {
            joints: &joints(),
            tool: Isometry3::translation(0.1, 0.0, 0.0),
            bodies: &[],
            solids: &[],
            clearance: 0.0,
            start: START,
            moves: &[],
        };
        place(&claim, q)
    }

    #[test]
    fn straight_moves_are_followed_and_obstacles_on_them_found() {
        let from = tool_at(&START);
        let mut to = from;
        to.translation.vector += Vector3::new(0.0, 0.25, 0.0);
        let moves = [ArmMoveClaim::Straight(to), ArmMoveClaim::Straight(from), ArmMoveClaim::Joints(START, Some(from))];
        assert_eq!(check(NOWHERE, &moves), []);
        // A ball beside the end of the way: touched where |way| · share comes within both radii and the clearance.
        let center = Point3::from(to.translation.vector) + Vector3::new(0.0, 0.1, 0.0);
        let found = check(ArmSolidForm::Ball(center, 0.1), &moves[..1]);
        let [ArmMoveFinding { index: 0, at, what }] = &found[..] else { panic!("{found:?}") };
        assert!(
            (at - (1.0 - 0.03 / 0.25)).abs() < 0.02 && what.contains("the tool keeps") && what.contains("block"),
            "{found:?}"
        );
        // Out of reach, out of bounds, another target than said.
        let mut far = from;
        far.translation.vector += Vector3::new(2.0, 0.0, 0.0);
        assert!(check(NOWHERE, &[ArmMoveClaim::Straight(far)])[0].what.contains("cannot be led on"));
        let beyond = [2.6, 0.2, -0.3, 0.0, 0.5, 0.0];
        assert!(check(NOWHERE, &[ArmMoveClaim::Joints(beyond, None)])[0].what.contains("axis 1 is at"));
        assert!(check(NOWHERE, &[ArmMoveClaim::Joints(START, Some(to))])[0].what.contains("off its target"));
    }

    #[test]
    fn distances_from_all_forms() {
        let p = Point3::new(0.3, 0.4, 1.2);
        let origin = Point3::origin();
        let up = [origin, Point3::new(0.0, 0.0, 1.0)];
        let corner = [Point3::new(1.0, 0.0, 0.0), Point3::new(0.0, 1.0, 0.0), Point3::new(0.0, 0.0, 1.0)];
        // A tetrahedron, corners counter-clockwise from outside.
        let [x, y, z] = corner;
        let tetrahedron = || ArmSolidForm::Triangles(vec![[x, y, z], [origin, y, x], [origin, z, y], [origin, x, z]]);
        for (form, expected) in [
            (ArmSolidForm::Ball(origin, 0.3), 1.0),
            (ArmSolidForm::Box(origin, Vector3::new(0.3, 0.1, 0.8)), 0.5),
            (ArmSolidForm::Capsule(up, 0.1), 0.29_f64.sqrt() - 0.1),
            (ArmSolidForm::Cylinder(up, 0.5), 0.2),
            (ArmSolidForm::HalfSpace(Vector3::new(0.0, 0.0, 2.0), 1.0), 0.7),
        ] {
            assert!((distance(&form, &p) - expected).abs() < 1e-12, "{expected}");
        }
        let inside = Point3::new(0.1, 0.1, 0.1);
        assert!((distance(&tetrahedron(), &inside) + 0.1).abs() < 1e-12);
        assert!((distance(&tetrahedron(), &Point3::new(0.1, 0.1, -0.2)) - 0.2).abs() < 1e-12);
        assert!((distance(&ArmSolidForm::Box(origin, Vector3::repeat(0.5)), &inside) + 0.4).abs() < 1e-12);
        let low = |p: &Point3<f64>| p.z < 1.0;
        assert!(
            distance(&ArmSolidForm::Where(&low), &inside) == 0.0
                && distance(&ArmSolidForm::Where(&low), &p) == f64::INFINITY
        );
    }
}
