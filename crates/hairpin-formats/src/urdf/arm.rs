//! The arm's file that a URDF comes to: joints and limits, bodies, masses, and what of them is estimated.

use std::collections::BTreeMap;
use std::ops::Range;

use hairpin::math::rotation::euler_from_quaternion;
use hairpin::robot::arm::{
    ArmDescription, ArmKind, CapsuleDescription, ChainDescription, ChainJoint, HullDescription, JointsDescription,
};
use nalgebra::{Isometry3, Vector3};
use roxmltree::Node;

use super::element::{UrdfError, at, at_attribute, child, number, told};
use super::mass::Masses;
use super::shapes::{Reader, Shape};
use super::stand::{Held, Stand};
use super::tip::{AXES, Way};
use super::tree::{Joint, Moves, Tree, UNBOUNDED};

/// Speed of a joint whose limit is not given, rad/s.
const USUAL_SPEED: f64 = std::f64::consts::PI;
/// Bounds that differ by less are the same but for their digits, rad.
const SAME: f64 = 1e-6;
/// Bodies, at most: each is held against every other.
const MOST_BODIES: usize = 2000;
/// Sentences about shapes, at most.
const MOST_SAID: usize = 40;

/// An arm, and where in the text its keys come from.
#[derive(Debug, Clone, PartialEq)]
pub struct UrdfArm {
    /// Its file.
    pub description: ArmDescription,
    /// Bytes of the URDF, by dotted key of the file.
    pub places: BTreeMap<String, Range<usize>>,
}

/// What has been gathered.
#[derive(Default)]
pub(super) struct Built {
    joints: Vec<ChainJoint>,
    names: Vec<String>,
    limits: Vec<[f64; 3]>,
    capsules: Vec<CapsuleDescription>,
    hulls: Vec<HullDescription>,
    stand_ins: Vec<usize>,
    masses: Masses,
    said: Vec<String>,
    places: BTreeMap<String, Range<usize>>,
}

impl Built {
    /// The joints between base and flange, and where the flange is on the last link.
    pub(super) fn chain(&mut self, tree: &Tree, way: &Way) -> Result<Isometry3<f64>, UrdfError> {
        let mut shift = Isometry3::identity();
        for joint in way.joints.iter().map(|joint| &tree.joints[*joint]) {
            shift *= joint.origin;
            if joint.moves == Moves::Turns {
                self.axis(joint, &shift)?;
                shift = Isometry3::identity();
            }
        }
        Ok(shift)
    }

    fn axis(&mut self, joint: &Joint, origin: &Isometry3<f64>) -> Result<(), UrdfError> {
        let index = self.joints.len();
        let axis = joint.axis()?.into_inner().into();
        self.joints.push(ChainJoint { xyz_mm: mm(&origin.translation.vector), rpy_deg: euler(origin), axis });
        self.names.push(joint.name.into());
        let bounds = self.limit(joint)?;
        self.limits.push(bounds);
        self.softer(joint, [bounds[0], bounds[1]])?;
        let limit = child(&joint.node, "limit").unwrap_or(joint.node);
        self.place(&format!("chain.joints[{index}]"), &joint.node);
        for (key, name) in [("lower_deg", "lower"), ("upper_deg", "upper"), ("speed_deg_s", "velocity")] {
            let span = limit.attribute_node(name).map_or(limit.range(), |attribute| attribute.range());
            self.places.insert(format!("joints.{key}[{index}]"), span);
        }
        Ok(())
    }

    /// Bounds (rad) and largest speed (rad/s) of a joint that turns.
    fn limit(&mut self, joint: &Joint) -> Result<[f64; 3], UrdfError> {
        let unbounded = joint.node.attribute("type") == Some("continuous");
        let limit = child(&joint.node, "limit");
        let (lower, upper) = match (&limit, unbounded) {
            (_, true) => (-UNBOUNDED.to_radians(), UNBOUNDED.to_radians()),
            (None, false) => return Err(at(&joint.node, &format!("joint {} turns and needs <limit>", joint.told()))),
            (Some(limit), false) => {
                let or = |name: &str| limit.attribute(name).map_or(Ok(0.0), |_| number(limit, name));
                (or("lower")?, or("upper")?)
            }
        };
        let given = limit.filter(|limit| !unbounded || limit.attribute("velocity").is_some());
        let speed = given.map(|limit| number(&limit, "velocity")).transpose()?;
        if let Some(limit) = limit {
            if lower == 0.0 && upper == 0.0 {
                let what = format!(
                    "joint {}: lower and upper are 0, as SolidWorks' exporter leaves them: the joint could not turn; \
                     write its limits here (rad, and rad/s in velocity)",
                    joint.told()
                );
                return Err(at(&limit, &what));
            }
            if lower.abs().max(upper.abs()) > UNBOUNDED.to_radians() {
                let what = format!(
                    "joint {}: lower = {lower}, upper = {upper}: URDF has radians, {:.0} at most; are these degrees?",
                    joint.told(),
                    UNBOUNDED.to_radians()
                );
                return Err(at(&limit, &what));
            }
            if lower >= upper {
                let what = format!("joint {}: lower = {lower} is not below upper = {upper}", joint.told());
                return Err(at(&limit, &what));
            }
            if speed.is_some_and(|speed| speed <= 0.0) {
                let what = format!("joint {}: velocity must be > 0, rad/s", joint.told());
                return Err(at_attribute(&limit, "velocity", &what));
            }
        }
        if let Some(fast) = speed.filter(|speed| *speed > UNBOUNDED.to_radians()) {
            let (joint, most) = (joint.told(), UNBOUNDED.to_radians());
            self.said.push(format!("speed of joint {joint}: {fast} rad/s, no arm's ({most:.0} at most): in degrees?"));
        }
        if speed.is_none() {
            let degrees = USUAL_SPEED.to_degrees();
            self.said.push(format!("speed of joint {}, which has no <limit>: {degrees:.0}°/s", joint.told()));
        }
        Ok([lower, upper, speed.unwrap_or(USUAL_SPEED)])
    }

    /// Says where a `<safety_controller>` has narrower bounds (rad) than the joint: whoever obeys it stops there, and
    /// what is planned goes by `<limit>`.
    fn softer(&mut self, joint: &Joint, [lower, upper]: [f64; 2]) -> Result<(), UrdfError> {
        for soft in joint.node.children().filter(|node| node.has_tag_name("safety_controller")) {
            let or = |name: &str, usual: f64| soft.attribute(name).map_or(Ok(usual), |_| number(&soft, name));
            let (from, to) = (or("soft_lower_limit", lower)?, or("soft_upper_limit", upper)?);
            if from > lower + SAME || to < upper - SAME {
                self.say(format!(
                    "bounds of joint {}: its <safety_controller> has {:.1}° to {:.1}°, narrower than they are, and is not kept",
                    joint.told(),
                    from.to_degrees(),
                    to.to_degrees()
                ));
            }
        }
        Ok(())
    }

    /// Bodies of all links, each with the arm's link that carries it; those of `known` get no stand-in.
    pub(super) fn bodies(
        &mut self,
        tree: &Tree,
        stands: &[(&str, Stand)],
        known: &[usize],
        reader: &mut Reader,
    ) -> Result<(), UrdfError> {
        let mut with_body = [false; AXES + 1];
        let mut names: [Vec<&str>; AXES + 1] = Default::default();
        for (name, stand) in stands {
            if stand.on_way {
                names[stand.of].push(name);
            }
            let Some(link) = tree.links.get(name) else { continue };
            if self.capsules.len() + self.hulls.len() > MOST_BODIES {
                return Err(at(link, &format!("the links before this one have more than {MOST_BODIES} bodies")));
            }
            let shapes = reader.of(link)?;
            with_body[stand.of] |= !shapes.all.is_empty();
            for shape in &shapes.all {
                self.body(stand, shape, link);
            }
            let named = format!("link {} (`{}`)", stand.of, told(name));
            if stand.held != Held::Firmly && !shapes.all.is_empty() {
                let how = if stand.held == Held::AtRest { "held at rest" } else { "anywhere about its joint" };
                self.say(format!("{named} {how}"));
            }
            if let Some(why) = shapes.missing.first().filter(|_| !known.contains(&stand.of)) {
                let more = if shapes.missing.len() > 1 { " and others" } else { "" };
                self.say(format!("{named} is a stand-in: {why}{more}"));
                with_body[stand.of] = true;
                if stand.on_way {
                    self.stand_in(stand.of);
                } else {
                    self.ball(stand);
                }
            }
            if let Some(inertial) = child(link, "inertial").filter(|_| stand.of > 0) {
                self.mass(name, stand, &inertial)?;
            }
        }
        let bare = |link: usize| !with_body[link] && !known.contains(&link);
        for (link, names) in names.iter().enumerate().filter(|(link, _)| bare(*link)) {
            let named: Vec<String> = names.iter().take(3).map(|name| format!("`{}`", told(name))).collect();
            self.say(format!("link {link} ({}) is a stand-in: no <collision>", named.join(", ")));
            self.stand_in(link);
        }
        std::mem::take(&mut self.masses.said).into_iter().for_each(|sentence| self.say(sentence));
        if let Some(link) = self.masses.of_all_or_none() {
            let named: Vec<String> = names[link].iter().take(3).map(|name| format!("`{}`", told(name))).collect();
            self.say(format!(
                "joint effort is of accelerations, not of torques: link {link} ({}) has no <inertial>",
                named.join(", ")
            ));
        }
        self.stand_ins.sort_unstable();
        Ok(())
    }

    fn say(&mut self, sentence: String) {
        match self.said.len() {
            MOST_SAID => self.said.push("… and more".into()),
            said if said < MOST_SAID => self.said.push(sentence),
            _ => {}
        }
    }

    fn stand_in(&mut self, link: usize) {
        if !self.stand_ins.contains(&link) {
            self.stand_ins.push(link);
        }
    }

    fn body(&mut self, stand: &Stand, shape: &Shape, node: &Node) {
        let placed = shape.placed(&stand.pose);
        let shape = match stand.held {
            Held::Firmly => placed,
            Held::AtRest => Shape { larger: shape.larger.max(shape.size()), ..placed },
            Held::About(orbit) => orbit.around(shape),
        };
        let (radius_mm, larger_mm) = (shape.radius * 1e3, shape.larger * 1e3);
        match shape.points[..] {
            [ref a, ref rest @ ..] if rest.len() <= 1 && radius_mm > 1e-3 => {
                let b = rest.first().unwrap_or(a);
                self.place(&format!("capsules[{}]", self.capsules.len()), node);
                let (a_mm, b_mm) = (mm(&a.coords), mm(&b.coords));
                self.capsules.push(CapsuleDescription { link: stand.of, a_mm, b_mm, radius_mm, larger_mm });
            }
            _ => {
                self.place(&format!("hulls[{}]", self.hulls.len()), node);
                let points_mm = shape.points.iter().map(|p| mm(&p.coords)).collect();
                self.hulls.push(HullDescription { link: stand.of, points_mm, radius_mm, larger_mm });
            }
        }
    }

    /// Of something that hangs on a link, as thick as that link's own stand-in.
    fn ball(&mut self, stand: &Stand) {
        let reach: f64 = self.joints.iter().map(|joint| Vector3::from(joint.xyz_mm).norm()).sum();
        let (center, far) = match stand.held {
            Held::About(orbit) => (orbit.center().coords, orbit.far()),
            Held::Firmly | Held::AtRest => (stand.pose.translation.vector, 0.0),
        };
        let at = mm(&center);
        let radius_mm = (reach / (12.0 + 2.0 * stand.of as f64)).max(1.0) + far * 1e3;
        self.capsules.push(CapsuleDescription {
            link: stand.of,
            a_mm: at,
            b_mm: at,
            radius_mm,
            larger_mm: 2.0 * radius_mm,
        });
    }

    fn place(&mut self, key: &str, node: &Node) {
        self.places.insert(key.to_owned(), node.range());
    }

    fn mass(&mut self, name: &str, stand: &Stand, inertial: &Node) -> Result<(), UrdfError> {
        if let Some(index) = self.masses.add(name, stand, inertial)? {
            self.place(&format!("masses[{index}]"), inertial);
        }
        Ok(())
    }

    /// The arm's file.
    pub(super) fn finish(
        self,
        name: &str,
        [flange, controller]: [&Isometry3<f64>; 2],
        exclude: Vec<[usize; 2]>,
    ) -> UrdfArm {
        let limit = |which: usize| std::array::from_fn(|axis| self.limits[axis][which].to_degrees());
        let description = ArmDescription {
            kind: ArmKind::Arm,
            name: if name.trim().is_empty() { "arm".into() } else { told(name) },
            source: "URDF".into(),
            caveat: String::new(),
            opw: None,
            chain: Some(ChainDescription {
                joints: self.joints,
                flange_mm: mm(&flange.translation.vector),
                flange_rpy_deg: euler(flange),
                controller_mm: mm(&controller.translation.vector),
                controller_rpy_deg: euler(controller),
            }),
            joints: JointsDescription {
                lower_deg: limit(0),
                upper_deg: limit(1),
                speed_deg_s: limit(2),
                acceleration_deg_s2: None,
                lag_s: None,
                j23_coupled: None,
            },
            // Without names, or with names that two share, they are numbered.
            joint_names: if self.names.iter().any(|name| name.trim().is_empty()) { Vec::new() } else { self.names },
            capsules: self.capsules,
            hulls: self.hulls,
            stand_ins: self.stand_ins,
            no_body: Vec::new(),
            exclude,
            estimates: self.said,
            masses: self.masses.all,
            estimated: Default::default(),
        };
        UrdfArm { description, places: self.places }
    }
}

fn mm(v: &Vector3<f64>) -> [f64; 3] {
    (v * 1e3).into()
}

/// Roll, pitch, yaw, degrees.
fn euler(pose: &Isometry3<f64>) -> [f64; 3] {
    let q = pose.rotation;
    euler_from_quaternion(&[q.w, q.i, q.j, q.k]).map(f64::to_degrees)
}
