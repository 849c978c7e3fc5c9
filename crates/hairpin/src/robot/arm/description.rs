//! An arm as a file has it: mm, degrees and kg in the names, what is missing derived and marked `estimated`.
//!
//! Either seven lengths ([`OpwDescription`]) or six joints ([`ChainDescription`], as URDF has them); never both, so
//! that an arm has one geometry.

use std::collections::BTreeMap;

use nalgebra::{Isometry3, Matrix3, Translation3, Vector3};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use thiserror::Error;

use super::body::{self, Capsule, Hull, Link, Mass, Outline, body_name};
use super::chain::{Chain, Joint};
use super::coupling::Coupling;
use super::opw::Opw;
use super::{AXES, Arm, JointLimit, Joints, Kinematics};
use crate::math::rotation::{quaternion_from_euler, unit_quaternion};
use crate::robot::estimated::{EstimatedNumber, OWN_NUMBERS, estimated_keys};

/// The `kind` of an arm's file.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum ArmKind {
    /// Six joints and a flange.
    Arm,
}

/// Why a file's numbers are no arm, tool or work object.
#[derive(Debug, Clone, PartialEq, Error)]
#[error("{field} = {value}: must be {bound}")]
pub struct ArmError {
    /// Key of the file, such as `opw.c2_mm`.
    pub field: String,
    /// The offending value.
    pub value: String,
    /// What it must be.
    pub bound: String,
}

/// An arm's file. Needed: `name`, `joints`, and either `opw` or `chain`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ArmDescription {
    /// Always `arm`.
    pub kind: ArmKind,
    /// Name in reports.
    pub name: String,
    /// Where the numbers come from.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub source: String,
    /// What must be said wherever the robot is named ("a stand-in for ...").
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub caveat: String,
    /// Dimensions of an arm with an ortho-parallel basis and a spherical wrist.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub opw: Option<OpwDescription>,
    /// Any other six joints, one after the other.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub chain: Option<ChainDescription>,
    /// What the joints may do.
    pub joints: JointsDescription,
    /// What the six joints are called by ROS, from the base on; `joint_1` … `joint_6` if not given.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub joint_names: Vec<String>,
    /// What the links take up; a link of which nothing is given gets a capsule along the dimensions, a stand-in.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub capsules: Vec<CapsuleDescription>,
    /// What they take up beside capsules: convex hulls of points.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub hulls: Vec<HullDescription>,
    /// Links of which not all is given, which get their stand-in as well: 0 the base, k what axis k moves.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub stand_ins: Vec<usize>,
    /// Links that take up nothing: they get no stand-in.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub no_body: Vec<usize>,
    /// Pairs of bodies that are not held against each other: 0 the base, 1 to 6 the links, 7 the tool.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub exclude: Vec<[usize; 2]>,
    /// What else is estimated, in words.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub estimates: Vec<String>,
    /// Masses of links, of all six that move or of none.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub masses: Vec<MassDescription>,
    /// Keys of this file whose numbers were estimated from logs: `joints.lag_s[0]` … `joints.lag_s[5]`.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub estimated: BTreeMap<String, EstimatedNumber>,
}

/// Brandstötter's parameters.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct OpwDescription {
    /// Shoulder before axis 1.
    pub a1_mm: f64,
    /// Forearm's axis before the elbow; ABB's arms have it above: negative.
    pub a2_mm: f64,
    /// Sideways offset of the arm's plane; 0 if not given.
    #[serde(default)]
    pub b_mm: f64,
    /// Shoulder above the base.
    pub c1_mm: f64,
    /// Upper arm.
    pub c2_mm: f64,
    /// Forearm.
    pub c3_mm: f64,
    /// Wrist centre to flange.
    pub c4_mm: f64,
    /// The parameters' angles are sign * angle - offset; 0 if not given.
    #[serde(default)]
    pub offsets_deg: [f64; AXES],
    /// 1 or -1 an axis; 1 if not given.
    #[serde(default = "positive")]
    pub signs: [i8; AXES],
}

fn positive() -> [i8; AXES] {
    [1; AXES]
}

/// Six joints, from the base on.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ChainDescription {
    /// The joints.
    pub joints: Vec<ChainJoint>,
    /// Flange in the last link.
    #[serde(default)]
    pub flange_mm: [f64; 3],
    /// Roll, pitch, yaw of the flange in the last link.
    #[serde(default)]
    pub flange_rpy_deg: [f64; 3],
    /// What the controller counts from, in the base: where poses of programs stand that name no other frame.
    #[serde(default, skip_serializing_if = "is_origin")]
    pub controller_mm: [f64; 3],
    /// Roll, pitch, yaw of what the controller counts from, in the base.
    #[serde(default, skip_serializing_if = "is_origin")]
    pub controller_rpy_deg: [f64; 3],
}

/// A joint where URDF puts it.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ChainJoint {
    /// Origin in the link before.
    pub xyz_mm: [f64; 3],
    /// Roll, pitch, yaw in the link before.
    #[serde(default)]
    pub rpy_deg: [f64; 3],
    /// Axis of rotation in the joint's frame, of any length.
    pub axis: [f64; 3],
}

/// Limits, axes 1 to 6.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct JointsDescription {
    /// Least angles.
    pub lower_deg: [f64; AXES],
    /// Largest angles.
    pub upper_deg: [f64; AXES],
    /// Largest speeds.
    pub speed_deg_s: [f64; AXES],
    /// Largest accelerations; what reaches the largest speed in 0.2 s if not given.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub acceleration_deg_s2: Option<[f64; AXES]>,
    /// Time constants of the servos' lag, in the place of `execute.servo_lag_s`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub lag_s: Option<[f64; AXES]>,
    /// Whether the controller tells axis 3 against the base, rax_3 = θ3 + θ2, as ABB's do of arms with a parallel rod
    /// (IRB 2400, 4400, 6400): joint targets of RAPID are read and written so. Angles and bounds here are the joints'
    /// own.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub j23_coupled: Option<bool>,
}

/// A part of a link.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CapsuleDescription {
    /// 0 for the base, k for the link that axis k moves.
    pub link: usize,
    /// One end of the axis in the link's frame; of arms with `opw` that is not a URDF's (docs/arms.md, link frames).
    pub a_mm: [f64; 3],
    /// The other end.
    pub b_mm: [f64; 3],
    /// Radius.
    pub radius_mm: f64,
    /// How much larger this may be than what it is around; 0 if not given.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub larger_mm: f64,
}

fn is_origin(numbers: &[f64; 3]) -> bool {
    *numbers == [0.0; 3]
}

fn is_zero(number: &f64) -> bool {
    *number == 0.0
}

/// A part of a link: all points within a radius of a convex hull.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct HullDescription {
    /// 0 for the base, k for the link that axis k moves.
    pub link: usize,
    /// Points of the hull in the link's frame; of arms with `opw` that is not a URDF's (docs/arms.md, link frames).
    pub points_mm: Vec<[f64; 3]>,
    /// What the hull is grown by; 0 if not given.
    #[serde(default)]
    pub radius_mm: f64,
    /// How much larger this may be than what it is around; 0 if not given.
    #[serde(default)]
    pub larger_mm: f64,
}

/// Mass of a link.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MassDescription {
    /// k for the link that axis k moves.
    pub link: usize,
    /// Mass.
    pub mass_kg: f64,
    /// Centre of mass in the link's frame; of arms with `opw` that is not a URDF's (docs/arms.md, link frames).
    pub centre_mm: [f64; 3],
    /// Moments of inertia about the centre along the link's axes; a point if not given.
    #[serde(default)]
    pub inertia_kg_m2: [f64; 3],
    /// Products of inertia about the centre, the tensor's xy, xz and yz; 0 if not given.
    #[serde(default, skip_serializing_if = "are_zero")]
    pub products_kg_m2: [f64; 3],
}

fn are_zero(numbers: &[f64; 3]) -> bool {
    *numbers == [0.0; 3]
}

impl MassDescription {
    /// The tensor of inertia about the centre, kg m².
    ///
    /// Rows (xx, xy, xz), (xy, yy, yz), (xz, yz, zz): products enter with the sign that they are given with, so that
    /// a file has −∫ xy dm, as URDF does.
    pub fn tensor(&self) -> Matrix3<f64> {
        let ([xx, yy, zz], [xy, xz, yz]) = (self.inertia_kg_m2, self.products_kg_m2);
        Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz)
    }
}

/// What is no more than this (m) larger than a shape is taken for it.
const AS_GIVEN: f64 = 1e-3;
/// Capsules and hulls, at most: each is held against every other.
const MOST_BODIES: usize = 4000;
/// Points of one hull, at most.
const MOST_POINTS: usize = 256;

/// Keys of the servos' lags.
const LAGS: [&str; AXES] =
    ["joints.lag_s[0]", "joints.lag_s[1]", "joints.lag_s[2]", "joints.lag_s[3]", "joints.lag_s[4]", "joints.lag_s[5]"];

/// Time to the largest speed where a file gives no accelerations, s.
const RISE_TIME: f64 = 0.2;

impl ArmDescription {
    /// Checks every number and builds the arm.
    ///
    /// # Errors
    /// The first key whose value is out of bounds, with the bound.
    pub fn build(&self) -> Result<Arm, ArmError> {
        if self.name.trim().is_empty() {
            return Err(wrong("name", "\"\"", "a name for reports"));
        }
        let mut estimated = Vec::new();
        let mut base_from_controller = Isometry3::identity();
        let (chain, kinematics, stand_ins) = match (&self.opw, &self.chain) {
            (Some(opw), None) => {
                let opw = opw.build()?;
                (opw.chain(), Kinematics::Opw(opw), body::of_opw(&opw))
            }
            (None, Some(chain)) => {
                let (at, turned) = (&chain.controller_mm, &chain.controller_rpy_deg);
                base_from_controller = frame(["chain.controller_mm", "chain.controller_rpy_deg"], at, turned)?;
                let chain = chain.build()?;
                let stand_ins = body::of_chain(&chain);
                (chain, Kinematics::Chain, stand_ins)
            }
            (both, _) => {
                let given = if both.is_some() { "given beside chain" } else { "missing, and so is chain" };
                return Err(wrong("opw", given, "given, or chain, not both"));
            }
        };
        let links = self.links(stand_ins, &mut estimated)?;
        let limits = self.joints.build(&mut estimated)?;
        estimated.extend(self.estimates.iter().cloned());
        let keys = estimated_keys(&self.estimated, &LAGS.map(|key| (key, self.joints.lag_s.is_some())));
        let keys = keys.map_err(|key| wrong("estimated", key, OWN_NUMBERS))?;
        estimated.extend(keys.into_iter().map(str::to_owned));
        Ok(Arm {
            name: self.name.clone(),
            caveat: self.caveat.clone(),
            source: self.source.clone(),
            up: Vector3::z(),
            base_from_controller,
            chain,
            kinematics,
            limits,
            coupling: Coupling::of(self.joints.j23_coupled, &self.name),
            lags: self.joints.lags()?,
            joint_names: self.joint_names()?,
            links,
            excluded: self.excluded()?,
            estimated,
        })
    }

    fn joint_names(&self) -> Result<[String; AXES], ArmError> {
        if self.joint_names.is_empty() {
            return Ok(std::array::from_fn(|axis| format!("joint_{}", axis + 1)));
        }
        let names = &self.joint_names;
        let twice = (1..names.len()).any(|index| names[..index].contains(&names[index]));
        match <[String; AXES]>::try_from(names.clone()) {
            Ok(six) if !twice && six.iter().all(|name| !name.trim().is_empty()) => Ok(six),
            _ => Err(wrong("joint_names", format!("{names:?}"), "six names, each another")),
        }
    }

    /// Each with what is given of it, or its stand-in.
    fn links(
        &self,
        stand_ins: [Vec<Capsule>; AXES + 1],
        estimated: &mut Vec<String>,
    ) -> Result<[Link; AXES + 1], ArmError> {
        let mut links: [Link; AXES + 1] = Default::default();
        self.given(&mut links)?;
        for (link, mass) in links.iter_mut().zip(self.masses()?) {
            link.mass = mass;
        }
        let bare = |link: &Link| link.capsules.is_empty() && link.hulls.is_empty();
        if links.iter().all(bare) && self.no_body.is_empty() && self.stand_ins.is_empty() {
            estimated.push("capsules".into());
        }
        for (key, named) in [("stand_ins", &self.stand_ins), ("no_body", &self.no_body)] {
            if let Some((i, link)) = named.iter().enumerate().find(|(_, link)| **link > AXES) {
                return Err(wrong(&format!("{key}[{i}]"), link, "0 to 6"));
            }
        }
        // One of both cannot be meant, and neither is safe to guess.
        if let Some((i, link)) = self.no_body.iter().enumerate().find(|(_, link)| self.stand_ins.contains(link)) {
            return Err(wrong(&format!("no_body[{i}]"), link, "a link that stand_ins does not name"));
        }
        let all_bare = links.iter().all(bare);
        for (number, (link, stand_in)) in links.iter_mut().zip(stand_ins).enumerate() {
            let without = bare(link) && !self.no_body.contains(&number);
            if without || self.stand_ins.contains(&number) {
                link.capsules.extend(stand_in);
                link.outline = Outline::StandIn;
                // Why, is told by whoever has looked for a shape.
                let told = self.stand_ins.contains(&number) || (all_bare && self.no_body.is_empty());
                if !told {
                    estimated.push(format!("capsules of {}", body_name(number)));
                }
            }
        }
        Ok(links)
    }

    /// Adds what is given to links that are bare.
    fn given(&self, links: &mut [Link; AXES + 1]) -> Result<(), ArmError> {
        let count = self.capsules.len() + self.hulls.len();
        if count > MOST_BODIES {
            return Err(wrong("capsules", format!("{count} capsules and hulls"), format!("{MOST_BODIES} at most")));
        }
        for (i, given) in self.capsules.iter().enumerate() {
            let key = |name: &str| format!("capsules[{i}].{name}");
            let link = links.get_mut(given.link).ok_or_else(|| wrong(&key("link"), given.link, "0 to 6"))?;
            link.capsules.push(Capsule {
                a: (place(&key("a_mm"), &given.a_mm)? * 1e-3).into(),
                b: (place(&key("b_mm"), &given.b_mm)? * 1e-3).into(),
                radius: within(&key("radius_mm"), given.radius_mm, 1e-3, 1e5)? * 1e-3,
            });
            link.outline = larger(&key("larger_mm"), given.larger_mm, link.outline)?;
        }
        for (i, given) in self.hulls.iter().enumerate() {
            let key = |name: &str| format!("hulls[{i}].{name}");
            let link = links.get_mut(given.link).ok_or_else(|| wrong(&key("link"), given.link, "0 to 6"))?;
            let count = given.points_mm.len();
            if !(1..=MOST_POINTS).contains(&count) {
                return Err(wrong(&key("points_mm"), format!("{count} points"), format!("1 to {MOST_POINTS} points")));
            }
            let points = given.points_mm.iter().map(|p| Ok((place(&key("points_mm"), p)? * 1e-3).into()));
            link.hulls.push(Hull {
                points: points.collect::<Result<_, ArmError>>()?,
                radius: within(&key("radius_mm"), given.radius_mm, 0.0, 1e5)? * 1e-3,
            });
            link.outline = larger(&key("larger_mm"), given.larger_mm, link.outline)?;
        }
        Ok(())
    }

    fn excluded(&self) -> Result<Vec<[usize; 2]>, ArmError> {
        for (i, [a, b]) in self.exclude.iter().enumerate() {
            if a.max(b) > &(AXES + 1) || a == b {
                return Err(wrong(&format!("exclude[{i}]"), format!("[{a}, {b}]"), "two numbers from 0 to 7"));
            }
        }
        Ok(self.exclude.iter().map(|[a, b]| [*a.min(b), *a.max(b)]).collect())
    }

    /// Of the base (none) and the six links.
    fn masses(&self) -> Result<[Option<Mass>; AXES + 1], ArmError> {
        let mut masses = [None; AXES + 1];
        for (i, given) in self.masses.iter().enumerate() {
            let key = |name: &str| format!("masses[{i}].{name}");
            if !(1..=AXES).contains(&given.link) {
                return Err(wrong(&key("link"), given.link, "1 to 6"));
            }
            if masses[given.link].is_some() {
                return Err(wrong(&key("link"), given.link, "another link than those before"));
            }
            for moment in given.inertia_kg_m2 {
                within(&key("inertia_kg_m2"), moment, 0.0, 1e6)?;
            }
            for product in given.products_kg_m2 {
                within(&key("products_kg_m2"), product, -1e6, 1e6)?;
            }
            masses[given.link] = Some(Mass {
                mass: within(&key("mass_kg"), given.mass_kg, 0.0, 1e5)?,
                centre: (place(&key("centre_mm"), &given.centre_mm)? * 1e-3).into(),
                inertia: given.tensor(),
            });
        }
        let given = masses.iter().flatten().count();
        if given != 0 && given != AXES {
            return Err(wrong("masses", format!("of {given} links"), "of all six links that move, or of none"));
        }
        Ok(masses)
    }
}

impl OpwDescription {
    fn build(&self) -> Result<Opw, ArmError> {
        let length = |key: &str, value: f64, low: f64| Ok(within(&format!("opw.{key}"), value, low, 1e5)? * 1e-3);
        for (axis, sign) in self.signs.iter().enumerate() {
            if sign.abs() != 1 {
                return Err(wrong(&format!("opw.signs[{axis}]"), sign, "1 or -1"));
            }
        }
        let mut offsets: Joints = [0.0; AXES];
        for (axis, offset) in self.offsets_deg.iter().enumerate() {
            offsets[axis] = within(&format!("opw.offsets_deg[{axis}]"), *offset, -360.0, 360.0)?.to_radians();
        }
        Ok(Opw {
            a1: length("a1_mm", self.a1_mm, -1e5)?,
            a2: length("a2_mm", self.a2_mm, -1e5)?,
            b: length("b_mm", self.b_mm, -1e5)?,
            c1: length("c1_mm", self.c1_mm, 0.0)?,
            c2: length("c2_mm", self.c2_mm, 1e-2)?,
            c3: length("c3_mm", self.c3_mm, 1e-2)?,
            c4: length("c4_mm", self.c4_mm, 0.0)?,
            offsets,
            signs: self.signs.map(f64::from),
        })
    }
}

impl ChainDescription {
    fn build(&self) -> Result<Chain, ArmError> {
        let given = self.joints.len();
        if given != AXES {
            return Err(wrong("chain.joints", format!("{given} joints"), "six"));
        }
        let mut joints = [Joint { origin: Isometry3::identity(), axis: Vector3::z() }; AXES];
        for (i, (joint, given)) in joints.iter_mut().zip(&self.joints).enumerate() {
            let key = |name: &str| format!("chain.joints[{i}].{name}");
            let axis = place(&key("axis"), &given.axis)?;
            joint.origin = frame([&key("xyz_mm"), &key("rpy_deg")], &given.xyz_mm, &given.rpy_deg)?;
            joint.axis = axis
                .try_normalize(1e-9)
                .ok_or_else(|| wrong(&key("axis"), format!("{:?}", given.axis), "a direction"))?;
        }
        let flange = frame(["chain.flange_mm", "chain.flange_rpy_deg"], &self.flange_mm, &self.flange_rpy_deg)?;
        let chain = Chain { joints, flange };
        within("chain, reach from the first axis in m", chain.reach(), 1e-3, 1e3)?;
        Ok(chain)
    }
}

/// Degrees become radians here. Accelerations that are missing are speed/0.2 s and marked as estimated.
impl JointsDescription {
    fn build(&self, estimated: &mut Vec<String>) -> Result<[JointLimit; AXES], ArmError> {
        if self.acceleration_deg_s2.is_none() {
            estimated.push("joints.acceleration_deg_s2".into());
        }
        let mut limits = [JointLimit { lower: 0.0, upper: 0.0, speed: 0.0, acceleration: 0.0 }; AXES];
        for (axis, limit) in limits.iter_mut().enumerate() {
            let key = |name: &str| format!("joints.{name}[{axis}]");
            let lower = within(&key("lower_deg"), self.lower_deg[axis], -3600.0, 3600.0)?;
            let upper = within(&key("upper_deg"), self.upper_deg[axis], lower, 3600.0)?;
            let speed = within(&key("speed_deg_s"), self.speed_deg_s[axis], 1e-3, 1e5)?;
            let acceleration = self.acceleration_deg_s2.map_or(speed / RISE_TIME, |given| given[axis]);
            let acceleration = within(&key("acceleration_deg_s2"), acceleration, 1e-3, 1e7)?;
            *limit = JointLimit {
                lower: lower.to_radians(),
                upper: upper.to_radians(),
                speed: speed.to_radians(),
                acceleration: acceleration.to_radians(),
            };
        }
        Ok(limits)
    }

    /// s.
    fn lags(&self) -> Result<Option<Joints>, ArmError> {
        let Some(lags) = self.lag_s else { return Ok(None) };
        for (key, lag) in LAGS.iter().zip(lags) {
            within(key, lag, 0.0, 10.0)?;
        }
        Ok(Some(lags))
    }
}

/// What a link's outline is with a body more, which may be so much larger than what it is around.
///
/// mm in, m kept: the most that any body of the link may be too large; a millimetre or less counts as the shape
/// itself.
fn larger(key: &str, mm: f64, before: Outline) -> Result<Outline, ArmError> {
    let much = within(key, mm, 0.0, 1e5)? * 1e-3;
    Ok(match before {
        Outline::Given if much <= AS_GIVEN => Outline::Given,
        Outline::Given => Outline::Around(much),
        Outline::Around(most) => Outline::Around(most.max(much)),
        Outline::StandIn => Outline::StandIn,
    })
}

/// origin = Trans(mm · 10⁻³) · Rz(yaw) Ry(pitch) Rx(roll), as URDF has roll, pitch and yaw.
fn frame([at, turned]: [&str; 2], mm: &[f64; 3], rpy_deg: &[f64; 3]) -> Result<Isometry3<f64>, ArmError> {
    for angle in rpy_deg {
        within(turned, *angle, -3600.0, 3600.0)?;
    }
    let [roll, pitch, yaw] = rpy_deg.map(f64::to_radians);
    let rotation = unit_quaternion(&quaternion_from_euler(roll, pitch, yaw));
    Ok(Isometry3::from_parts(Translation3::from(place(at, mm)? * 1e-3), rotation))
}

pub(super) fn place(key: &str, at: &[f64; 3]) -> Result<Vector3<f64>, ArmError> {
    for value in at {
        within(key, *value, -1e5, 1e5)?;
    }
    Ok(Vector3::from(*at))
}

/// NaN is within no bounds.
pub(super) fn within(key: &str, value: f64, low: f64, high: f64) -> Result<f64, ArmError> {
    if (low..=high).contains(&value) {
        Ok(value)
    } else {
        Err(wrong(key, value, format!("a number from {low} to {high}")))
    }
}

pub(super) fn wrong(field: &str, value: impl ToString, bound: impl Into<String>) -> ArmError {
    ArmError { field: field.into(), value: value.to_string(), bound: bound.into() }
}
