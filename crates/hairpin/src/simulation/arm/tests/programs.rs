//! Programs as they are read, executed.

use super::*;
use crate::trajectory::program;
use crate::trajectory::program::{JointTarget, Motion, Move, NO_EXTERNAL, PoseTarget, Program};

fn read() -> (Joints, Program) {
    let arm = arm();
    let tool = program::Tool { tcp: Isometry3::translation(0.0, 0.0, 0.05), held: true, ..program::Tool::flange() };
    let object = program::WorkObject {
        user: Isometry3::translation(0.3, 0.0, 0.1),
        object: Isometry3::translation(0.0, -0.1, 0.05),
        ..program::WorkObject::base()
    };
    let mut read = Program::new("Test", "main", tool, object);
    let at = |x: f64, y: f64, z: f64, name: &str| PoseTarget::unnamed(pose(x, y, z)).named(name);
    let start = stand(&arm, 0.3, 0.0, 0.25);
    let (fast, z10) = (program::Speed::predefined("v1000").unwrap(), program::Zone::predefined("z10").unwrap());
    let fine = program::Zone::stop();
    let home = JointTarget { name: Some("home".into()), joints: start, external: NO_EXTERNAL };
    read.moves.push(Move::new(
        Motion::AbsoluteJoint(home.clone()),
        program::Speed::predefined("vmax").unwrap(),
        fine.clone(),
    ));
    read.moves.push(Move::new(Motion::Linear(at(0.0, 0.1, 0.1, "p10")), fast.clone(), fine.clone()));
    read.moves.push(Move::new(Motion::Linear(at(0.05, 0.2, 0.1, "p20")), fast.clone(), z10));
    let (via, to) = (at(0.1, 0.1, 0.1, "p30"), at(0.05, 0.0, 0.1, "p40"));
    read.moves.push(Move::new(Motion::Circular { via, to }, fast.clone(), fine.clone()));
    read.moves.push(Move::new(Motion::Joint(PoseTarget::unnamed(pose(0.0, 0.1, 0.1))), fast, fine));
    (start, read)
}

#[test]
fn frames_tools_and_names_are_those_of_the_program() {
    let (start, read) = read();
    let orders = Order::all_of(&read).unwrap();
    let names: Vec<&str> = orders.iter().map(|order| order.name.as_str()).collect();
    assert_eq!(names, ["start→home", "home→p10", "p10→p20", "p20→p40", "p40→#4"]);
    let arm = arm();
    let plan = Plan::new(&arm, &start, &orders, &PlanSettings::default()).unwrap();
    assert_eq!(plan.stop(), None);
    // p10 in the base: user frame, object frame, target.
    let path = plan.path();
    assert!((path.track().position(path.moves()[1].end) - Point3::new(0.3, 0.0, 0.25)).norm() < 1e-9);
    let run = plan.execute(&exact(), &[], 1).unwrap();
    let last = run.recording.position(run.recording.len() - 1);
    assert!((last - Point3::new(0.3, 0.0, 0.25)).norm() < 1e-6, "{last}");
}

#[test]
fn what_an_arm_alone_cannot_execute_is_refused() {
    let (_, read) = read();
    let field = |change: &dyn Fn(&mut Program)| {
        let mut changed = read.clone();
        change(&mut changed);
        Order::all_of(&changed).unwrap_err().field()
    };
    assert_eq!(field(&|program| program.tools[0].held = false), "tool");
    assert_eq!(field(&|program| program.work_objects[0].moved_by = Some("STN1".into())), "work_object");
    assert_eq!(field(&|program| program.moves[1].tool = 3), "program");
    let cfx = |program: &mut Program| {
        if let Motion::Linear(to) = &mut program.moves[1].motion {
            to.configuration = Some([0, 0, 0, 9]);
        }
    };
    assert!(["configuration", "program"].contains(&field(&cfx)));
}
