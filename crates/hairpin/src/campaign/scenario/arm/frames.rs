//! Frames as scenarios of arms give them: the tool and the work object of programs, and where things stand.

use nalgebra::{Isometry3, Translation3, Vector3};

use super::{ArmScenario, FrameSection};
use crate::campaign::scenario::Mistake;
use crate::robot::arm::{ArmError, Tool, WorkObject, unit_quaternion_of};
use crate::trajectory::program;

impl ArmScenario {
    /// The tool on the flange.
    ///
    /// # Errors
    /// The key of `world.tool` whose value makes none.
    pub(in crate::campaign) fn tool(&self) -> Result<Tool, Mistake> {
        let tool = &self.world.tool;
        Tool::new(&tool.name, tool.tcp_mm, tool.q1_q4, tool.radius_mm, tool.mass_kg, tool.cog_mm)
            .map_err(|error| mistake("world.tool", error))
    }

    /// What poses are given in, seen from the arm's base.
    ///
    /// # Errors
    /// The key of `world.wobj` or `world.base_frame` whose value makes none.
    pub(in crate::campaign) fn work_object(&self) -> Result<WorkObject, Mistake> {
        let object = &self.world.wobj;
        let (user, frame) = ((object.uframe_mm, object.uframe_q1_q4), (object.oframe_mm, object.oframe_q1_q4));
        let object = WorkObject::new(&object.name, user, frame).map_err(|error| mistake("world.wobj", error))?;
        // User frames stand in the world; the arm's programs are in its base.
        Ok(WorkObject { user: self.world_from_base()?.inverse() * object.user, ..object })
    }

    /// Where the arm's base stands.
    ///
    /// # Errors
    /// The key of `world.base_frame` whose value makes none.
    pub(in crate::campaign) fn world_from_base(&self) -> Result<Isometry3<f64>, Mistake> {
        frame_of("world.base_frame", &self.world.base_frame)
    }

    /// The same as programs have them.
    pub(in crate::campaign) fn in_programs(
        &self,
        tool: &Tool,
        object: &WorkObject,
    ) -> (program::Tool, program::WorkObject) {
        let flange = program::Tool::flange();
        // A controller refuses a load without mass.
        let loaded = tool.mass > 0.0;
        let tool = program::Tool {
            name: tool.name.clone(),
            declare: self.world.tool.declare,
            tcp: tool.tcp,
            mass: if loaded { tool.mass } else { flange.mass },
            centre_of_gravity: if loaded { tool.centre_of_mass.coords } else { flange.centre_of_gravity },
            ..flange
        };
        let object = program::WorkObject {
            name: object.name.clone(),
            declare: self.world.wobj.declare,
            user: object.user,
            object: object.object,
            ..program::WorkObject::base()
        };
        (tool, object)
    }
}

/// `parent_from_frame` of a section.
///
/// # Errors
/// `key.mm`, `key.q1_q4`.
pub(in crate::campaign) fn frame_of(key: &str, section: &FrameSection) -> Result<Isometry3<f64>, Mistake> {
    let turn = unit_quaternion_of("q1_q4", section.q1_q4).map_err(|error| mistake(key, error))?;
    Ok(Isometry3::from_parts(Translation3::from(Vector3::from(section.mm) * 1e-3), turn))
}

/// What is wrong with a table of the scenario, in its own words.
pub(in crate::campaign) fn mistake(table: &str, error: ArmError) -> Mistake {
    Mistake { key: format!("{table}.{}", error.field), value: error.value, bound: error.bound }
}
