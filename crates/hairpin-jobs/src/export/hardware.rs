//! What files for hardware have in common: where home is, what was looked at before, and what has to be said of them.

use hairpin::campaign::kind::Room;
use hairpin::campaign::{Case, CaseResult, Evidence};
use hairpin_formats::home::Home;
use hairpin_formats::placement::Placement;

use super::preflight::{Cleared, look_at, obstacle_met, refuse};
use crate::Problem;
use crate::work::Work;

/// What is told wherever something for hardware is written.
pub(super) const PURPOSE: &str = "stressful by design: a test generator wrote it, and it is no safety certificate";

/// The cases of a campaign that are cleared for hardware.
#[derive(Debug)]
pub(super) struct Hardware {
    /// Where they may be.
    pub(super) room: Room,
    /// What was found of the cases in their order.
    pub(super) cleared: Vec<Cleared>,
    /// What their runs came to.
    pub(super) results: Vec<CaseResult>,
}

impl Hardware {
    /// Looks at `cases`.
    ///
    /// # Errors
    /// Robots that are no vehicles; a case that leaves the keep-in margin, unless `accept` has it.
    pub(super) fn clear(work: &Work, cases: &[&Case], accept: bool, word: &str) -> Result<Self, Problem> {
        let room = room(work, word)?;
        let cleared = cases.iter().map(|case| look_at(work, &room, case)).collect::<Result<Vec<_>, _>>()?;
        if !accept {
            refuse(&cleared)?;
        }
        Ok(Self { room, cleared, results: work.folder.read_results()? })
    }

    /// What its user has to know of them.
    pub(super) fn told(&self) -> Vec<String> {
        let looked_at = self.cleared.iter().flat_map(|case| &case.told).cloned();
        let accepted = self.cleared.iter().flat_map(|case| &case.beyond);
        let accepted = accepted.map(|sentence| format!("accepted (--accept-excursion): {sentence}"));
        looked_at.chain(accepted).collect()
    }

    /// What of a case's worst run no autopilot knows.
    pub(super) fn obstacle_met(&self, case: &Case) -> Option<String> {
        obstacle_met(self.results.iter().find(|result| result.case == case.number))
    }
}

/// Where the campaign's vehicle may be.
///
/// # Errors
/// It has none.
pub(super) fn room(work: &Work, word: &str) -> Result<Room, Problem> {
    let none = || {
        Problem::input(format!("--to {word}: {} is no vehicle that flies, drives or sails", work.setup.robot_name()))
    };
    work.setup.room().ok_or_else(none)
}

/// The home of a case.
///
/// # Errors
/// A place that the map's plane cannot show.
pub(super) fn home<'a>(world: &'a Placement, cleared: &Cleared, case: &Case) -> Result<Home<'a>, Problem> {
    Home::new(world, &cleared.way.home).map_err(|why| Problem::input(format!("case {}: {why}", case.id())))
}

/// What is said of a case in a file for hardware, by key; `way` is who goes where, in a sentence.
pub(super) fn note(work: &Work, case: &Case, cleared: &Cleared, way: String) -> Vec<(&'static str, String)> {
    let caveat = work.setup.caveat();
    let robot = work.setup.robot_name();
    let mut note = vec![
        ("generator", format!("hairpin {}", env!("CARGO_PKG_VERSION"))),
        ("case", case.id()),
        ("seed", case.seed.to_string()),
        ("robot", if caveat.is_empty() { robot.to_owned() } else { format!("{robot}: {caveat}") }),
        ("evidence", format!("{} for hairpin's plan", case.claim())),
        ("way", way),
        ("purpose", PURPOSE.into()),
    ];
    note.extend((!cleared.told.is_empty()).then(|| ("preflight", cleared.told.join("; "))));
    note.extend((!cleared.beyond.is_empty()).then(|| ("accepted_excursion", cleared.beyond.join("; "))));
    note
}

/// Whether a case has a plan with accelerations.
pub(super) fn is_witnessed(case: &Case) -> bool {
    case.evidence == Evidence::Witnessed && case.witness.is_some()
}
