//! Moves of URScript, tools and what they weigh.

use hairpin::trajectory::program::{Bound, JointTarget, Motion, Move, NO_EXTERNAL, PoseTarget, Speed, Tool, Zone};
use nalgebra::{Matrix3, Rotation3, SymmetricEigen, UnitQuaternion, Vector3};

use super::arguments::{Arguments, Value};
use super::read::Reader;
use crate::listing::{Class, Doubt, Unmodelled};

impl Reader<'_> {
    pub(super) fn set_tcp(&mut self, line: usize, inside: &str) -> Result<(), String> {
        let arguments = Arguments::of(inside, &["pose", "tcp_name"])?;
        let Some(Value::Pose(tcp)) = arguments.get("pose") else { return Err("expected a pose, p[…]".into()) };
        self.carry(Tool { tcp: *tcp, declare: true, ..Tool::flange() });
        self.fresh = true;
        self.reading.mark(line, Class::Understood, "");
        Ok(())
    }

    /// What the tool that was set just now weighs.
    pub(super) fn weigh(&mut self, line: usize, inside: &str) -> Result<(), String> {
        let arguments = Arguments::of(inside, &["m", "cog", "inertia"])?;
        let mass = arguments.number("m")?.ok_or("expected a mass")?;
        let centre = match arguments.get("cog") {
            Some(Value::List(centre)) => <[f64; 3]>::try_from(centre.as_slice()).ok(),
            _ => None,
        };
        let centre = centre.ok_or("expected a centre of gravity, [x, y, z]")?;
        let (axes, moments) = match arguments.get("inertia") {
            None => (UnitQuaternion::identity(), [0.0; 3]),
            Some(Value::List(six)) => principal(six)?,
            Some(_) => return Err("expected moments of inertia, [Ixx, Iyy, Izz, Ixy, Ixz, Iyz]".into()),
        };
        if let Some(tool) = self.carried.take() {
            let centre_of_gravity = Vector3::from(centre);
            self.carry(Tool { mass, centre_of_gravity, axes_of_inertia: axes, inertia: moments, ..tool });
        }
        self.reading.mark(line, Class::Understood, "");
        Ok(())
    }

    fn carry(&mut self, tool: Tool) {
        (self.carried, self.tool) = (Some(tool), None);
    }

    /// The index of the tool that is set; one that moves had before is that one.
    fn tool(&mut self) -> usize {
        let tools = &mut self.reading.program.tools;
        let carried = self.carried.get_or_insert_with(Tool::flange);
        let index = self.tool.unwrap_or_else(|| {
            let named = |name: &str| Tool { name: name.into(), ..carried.clone() };
            tools.iter().position(|tool| *tool == named(&tool.name)).unwrap_or_else(|| {
                let is_flange = *carried == Tool::flange();
                tools.push(if is_flange { carried.clone() } else { named(&format!("tool{}", tools.len() + 1)) });
                tools.len() - 1
            })
        });
        self.tool = Some(index);
        index
    }

    pub(super) fn go(&mut self, line: usize, name: &str, inside: &str) -> Result<(), String> {
        let known: &[&str] = match name {
            "movec" => &["pose_via", "pose_to", "a", "v", "r", "mode"],
            "movej" => &["q", "a", "v", "t", "r"],
            _ => &["pose", "a", "v", "t", "r"],
        };
        let arguments = Arguments::of(inside, known)?;
        let mut doubts: Vec<Doubt> = Vec::new();
        let pose = |name: &str| match arguments.get(name) {
            Some(Value::Pose(pose)) => Ok(PoseTarget::unnamed(*pose)),
            _ => Err("expected a pose, p[…]".to_owned()),
        };
        let motion = match (name, arguments.get("q")) {
            ("movej", Some(Value::List(joints))) => {
                let six = <[f64; 6]>::try_from(joints.as_slice());
                let joints = six.map_err(|_| format!("expected 6 angles, found {}", joints.len()))?;
                Motion::AbsoluteJoint(JointTarget { name: None, joints, external: NO_EXTERNAL })
            }
            ("movej", _) => Motion::Joint(pose("q").map_err(|_| "expected [6 angles] or a pose, p[…]".to_owned())?),
            ("movec", _) => Motion::Circular { via: pose("pose_via")?, to: pose("pose_to")? },
            _ => Motion::Linear(pose("pose")?),
        };
        // A time of 0 is none, and where one is given speed and acceleration may be 0: nobody looks at them.
        let duration = arguments.number("t")?.filter(|t| *t != 0.0);
        let rate =
            |name: &str| Ok::<_, String>(arguments.number(name)?.filter(|rate| *rate != 0.0 || duration.is_none()));
        let (acceleration, speed) = (rate("a")?, rate("v")?);
        let radius = arguments.number("r")?.unwrap_or(0.0);
        if arguments.number("mode")?.is_some_and(|mode| mode != 0.0) {
            doubts.push((Some(Unmodelled::Interpolation), "mode 1: the orientation turns with the arc".into()));
        }
        if self.carried.is_none() {
            doubts.push((None, "the tool's centre point is not set in this file".into()));
        }
        // The speed of joint moves is the leading axis', none of the tool's.
        let in_joints = name == "movej";
        let rates: &[(&'static str, Option<f64>, Bound)] = if in_joints {
            &[("a", acceleration, Bound::JOINT_ACCELERATION), ("v", speed, Bound::URSCRIPT_JOINT_SPEED)]
        } else {
            // One that is not above 0 no move of any language may have, and it is told of the move.
            let fast = speed.filter(|speed| *speed > 0.0);
            &[("a", acceleration, Bound::ACCELERATION), ("v", fast, Bound::URSCRIPT_SPEED)]
        };
        for (field, value, bound) in rates {
            value.iter().for_each(|value| self.reading.hold(line, field, *value, *bound));
        }
        let tool = self.tool();
        // One radius is one number: what is wrong with it is told once.
        let others = radius.max(0.0);
        let zone = Zone {
            name: None,
            fine: false,
            tcp: radius,
            path_orientation: others,
            path_external: others,
            ..Zone::stop()
        };
        let zone = if radius == 0.0 { Zone::stop() } else { zone };
        // What is above its bound was told with the argument.
        let speed =
            speed_of(speed.filter(|speed| !in_joints && (*speed <= 0.0 || Bound::URSCRIPT_SPEED.holds(*speed))));
        let m = Move { tool, duration, configuration_demanded: false, ..Move::new(motion, speed, zone) };
        self.reading.go(line, m, doubts);
        Ok(())
    }
}

/// As fast as the arm can, but for the tool's centre point.
fn speed_of(tcp: Option<f64>) -> Speed {
    let fast = Speed::predefined("vmax").unwrap_or(Speed {
        name: None,
        tcp: f64::INFINITY,
        orientation: 1e3,
        linear_external: 0.0,
        rotating_external: 0.0,
    });
    match tcp {
        Some(tcp) => Speed { name: None, tcp, ..fast },
        None => fast,
    }
}

/// What moments may be below 0 by, as a share of the largest: they are written with so many digits.
const WRITTEN: f64 = 1e-6;

/// `flange_from_axes` and the principal moments of inertia, of Ixx, Iyy, Izz, Ixy, Ixz, Iyz; kg m².
fn principal(six: &[f64]) -> Result<(UnitQuaternion<f64>, [f64; 3]), String> {
    let &[xx, yy, zz, xy, xz, yz] = six else {
        return Err(format!("expected six moments of inertia, found {}", six.len()));
    };
    let tensor = Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz);
    let (axes, moments) = if [xy, xz, yz] == [0.0; 3] {
        (UnitQuaternion::identity(), Vector3::new(xx, yy, zz))
    } else {
        let SymmetricEigen { mut eigenvectors, eigenvalues } = SymmetricEigen::new(tensor);
        if eigenvectors.determinant() < 0.0 {
            eigenvectors.column_mut(2).neg_mut();
        }
        (UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(eigenvectors)), eigenvalues)
    };
    let least = moments.min();
    if least < -WRITTEN * moments.max() {
        return Err(format!("a moment of inertia is {least} kg m², and no body has one below 0"));
    }
    Ok((axes, moments.map(|moment| moment.max(0.0)).into()))
}
