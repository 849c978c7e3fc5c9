//! What is known while KRL is read.

use std::collections::BTreeMap;

use hairpin::trajectory::program::{Tool, WorkObject};
use nalgebra::Isometry3;

use super::data::Position;
use super::{PREFIX, UNNAMED};
use crate::listing::Reading;

#[derive(Debug, Default)]
pub(super) struct Reader {
    pub(super) reading: Reading,
    /// Positions by name in upper case; what is wrong with those that are none.
    pub(super) positions: BTreeMap<String, Result<Position, String>>,
    /// What the flange carries, in a tool without a point of its own.
    pub(super) load: Option<Tool>,
    /// Index of the tool and of the base that are set.
    pub(super) tool: Option<usize>,
    pub(super) base: Option<usize>,
    /// m/s.
    pub(super) speed: Option<f64>,
    /// °/s.
    pub(super) turning: Option<f64>,
    /// m.
    pub(super) near: Option<f64>,
}

impl Reader {
    pub(super) fn add_tool(&mut self, tcp: Isometry3<f64>) -> usize {
        let tools = &mut self.reading.program.tools;
        let carried = self.load.clone().unwrap_or_else(Tool::flange);
        let named = |name: &str| Tool { name: name.into(), declare: true, tcp, ..carried.clone() };
        tools.iter().position(|tool| *tool == named(&tool.name)).unwrap_or_else(|| {
            tools.push(named(&format!("tool{}", tools.len() + 1)));
            tools.len() - 1
        })
    }

    pub(super) fn add_base(&mut self, user: Isometry3<f64>) -> usize {
        let bases = &mut self.reading.program.work_objects;
        bases.iter().position(|base| base.user == user).unwrap_or_else(|| {
            bases.push(WorkObject {
                name: format!("base{}", bases.len() + 1),
                declare: true,
                user,
                ..WorkObject::base()
            });
            bases.len() - 1
        })
    }
}

/// The name that a position had before it was written.
pub(super) fn named(name: &str) -> Option<String> {
    let begins = |with: &str| name.get(..with.len()).is_some_and(|begin| begin.eq_ignore_ascii_case(with));
    let numbered = begins(UNNAMED) && name[UNNAMED.len()..].bytes().all(|byte| byte.is_ascii_digit());
    match () {
        () if numbered || name.starts_with('{') => None,
        () if begins(PREFIX) && name.len() > PREFIX.len() => Some(name[PREFIX.len()..].into()),
        () => Some(name.into()),
    }
}
