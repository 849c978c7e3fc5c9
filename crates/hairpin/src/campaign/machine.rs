//! A robot in its world, whatever kind it is of. Robots are chosen by the one `match` here.

use std::sync::Arc;

use super::arm::Station;
use super::attachments::Attachments;
use super::build::Build;
use super::drive::Driver;
use super::flight::Flyer;
use super::scenario::{Mistake, Scenario};

/// A robot in its world.
#[derive(Debug, Clone)]
pub(super) enum Machine {
    Flyer(Flyer),
    Driver(Driver),
    Arm(Arc<Station>),
}

/// Which keys are looked at.
#[derive(Debug, Clone, Copy)]
pub(super) enum Look {
    /// All that have a bound.
    All,
    /// Those that the robot and its world are made of: all were looked at before some were drawn.
    Built,
}

impl Machine {
    /// What a scenario describes; what another one describes alike is shared with its machine.
    ///
    /// # Errors
    /// Keys whose values are out of bounds, in the order of the file.
    pub(super) fn of(
        scenario: &Scenario,
        files: &Attachments,
        known: Option<(&Scenario, &Self)>,
        look: Look,
    ) -> Result<Self, Vec<Mistake>> {
        match (scenario, known) {
            (Scenario::Flight(keys), Some((Scenario::Flight(old), Self::Flyer(flyer)))) => {
                made(&**keys, files, Some((&**old, flyer)), look).map(Self::Flyer)
            }
            (Scenario::Flight(keys), _) => made(&**keys, files, None, look).map(Self::Flyer),
            (Scenario::Drive(keys), Some((Scenario::Drive(old), Self::Driver(driver)))) => {
                made(&**keys, files, Some((&**old, driver)), look).map(Self::Driver)
            }
            (Scenario::Drive(keys), _) => made(&**keys, files, None, look).map(Self::Driver),
            (Scenario::Arm(keys), Some((Scenario::Arm(old), Self::Arm(station)))) => {
                made(&**keys, files, Some((&**old, station)), look).map(Self::Arm)
            }
            (Scenario::Arm(keys), _) => made(&**keys, files, None, look).map(Self::Arm),
        }
    }

    /// The robot's name, and what must be said wherever it is named.
    pub(super) fn names(&self) -> (&str, &str) {
        match self {
            Self::Flyer(Flyer { robot, .. }) => (&robot.name, &robot.caveat),
            Self::Driver(Driver { rover, .. }) => (&rover.name, &rover.caveat),
            Self::Arm(station) => (&station.arm.name, &station.arm.caveat),
        }
    }

    /// Names of the robot's numbers that were derived, not given.
    pub(super) fn estimated(&self) -> Vec<&str> {
        match self {
            Self::Flyer(Flyer { robot, .. }) => robot.estimated.iter().map(String::as_str).collect(),
            Self::Driver(Driver { rover, .. }) => rover.estimated.clone(),
            Self::Arm(station) => station.arm.estimated.clone(),
        }
    }
}

fn made<M: Build>(
    keys: &M::Keys,
    files: &Attachments,
    known: Option<(&M::Keys, &M)>,
    look: Look,
) -> Result<M, Vec<Mistake>> {
    match look {
        Look::All => M::check(keys, files, known),
        Look::Built => M::build(keys, files, known).map_err(|mistake| vec![mistake]),
    }
}
