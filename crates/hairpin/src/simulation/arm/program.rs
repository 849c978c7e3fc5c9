//! The moves of a program as an arm executes them: frames multiplied out, names for reports.

use super::order::{Order, Speed, Target, Zone};
use crate::robot::arm::{AXES, Configuration};
use crate::simulation::SimulationError;
use crate::trajectory::program::{Motion, Move, PoseTarget, Program};

impl Order {
    /// The moves of `program`, one order each. A move is called after its targets, `p17→p09`; a target without a name
    /// after its number.
    ///
    /// # Errors
    /// `program` for what [`Program::problems`] finds; `tool` or `work_object` where an arm alone cannot execute it: a
    /// tool that stands in the cell, a work object that the arm holds or that is moved; `configuration` where its cfx
    /// is none of 0 … 7.
    pub fn all_of(program: &Program) -> Result<Vec<Self>, SimulationError> {
        if let Some(problem) = program.problems().into_iter().next() {
            return Err(SimulationError::new("program", problem.to_string(), "one that a controller executes"));
        }
        let mut from = "start".to_owned();
        let mut orders = Vec::with_capacity(program.moves.len());
        for (index, one) in program.moves.iter().enumerate() {
            let to = one.motion.name().map_or_else(|| format!("#{index}"), str::to_owned);
            orders.push(order(program, one, format!("{from}→{to}"))?);
            from = to;
        }
        Ok(orders)
    }
}

/// base_from_tcp = base_from_object · target; of a zone only the radius of the tool's point is kept.
fn order(program: &Program, one: &Move, name: String) -> Result<Order, SimulationError> {
    let (tool, object) = (&program.tools[one.tool], &program.work_objects[one.work_object]);
    if !tool.held {
        return Err(SimulationError::new("tool", tool.name.clone(), "held by the arm"));
    }
    if object.held || object.moved_by.is_some() {
        return Err(SimulationError::new("work_object", object.name.clone(), "at rest in the cell"));
    }
    let base = object.base_from_object();
    let wanted = |to: &PoseTarget| match to.configuration {
        Some(numbers) if one.configuration_demanded => configuration(numbers).map(Some),
        _ => Ok(None),
    };
    let target = match &one.motion {
        Motion::AbsoluteJoint(to) => Target::Joints(to.joints),
        Motion::Joint(to) => Target::Joint(base * to.pose, wanted(to)?),
        Motion::Linear(to) => Target::Line(base * to.pose, wanted(to)?),
        Motion::Circular { via, to } => {
            Target::Arc(base * nalgebra::Point3::from(via.pose.translation.vector), base * to.pose, wanted(to)?)
        }
    };
    Ok(Order {
        name,
        target,
        speed: Speed { tcp: one.speed.tcp, turn: one.speed.orientation },
        duration: one.duration,
        zone: if one.zone.fine { Zone::Fine } else { Zone::Radius(one.zone.tcp) },
        tool: tool.tcp,
    })
}

/// \[cf1, cf4, cf6, cfx\] as a program has them.
fn configuration(numbers: [i32; 4]) -> Result<Configuration, SimulationError> {
    let [cf1, cf4, cf6, cfx] = numbers;
    match u8::try_from(cfx) {
        Ok(cfx) if cfx < 8 => Ok(Configuration { cf1, cf4, cf6, cfx }),
        _ => Err(SimulationError::new("configuration", format!("cfx {cfx}"), "0 to 7")),
    }
}

const _: () = assert!(AXES == 6, "programs have six axes");
