//! What of a program's run no robot of its kind does: looked for while all of its rows are there, and taken from what
//! was found then once they may have been left out.

use crate::campaign::attitude::{by_largest, fallen, overturned, upside_down};
use crate::campaign::implausible::{Implausible, Overturned};
use crate::campaign::impossible::of_program;
use crate::campaign::{Case, FullRate, Setup};
use crate::judgement::{Limits, Measures};
use crate::trajectory::Flight;

/// Why nothing is decided by what was measured of a run that nobody looked at.
const UNSEEN: &str = "nobody looked whether its motion is one of its robot (places that leap, attitudes upside down all the \
                      way), as it was executed by an earlier version of hairpin, and its rows were not kept; `hairpin \
                      execute OUT --out DIR` flies it anew";

/// What was found in a run, and whether its rows were looked at.
pub(super) struct Looked {
    found: Implausible,
    is_whole: bool,
}

/// What is found in the rows of a run; `None` of our own simulators, which are not asked, and where they were left out.
pub(in crate::campaign) fn look(setup: &Setup, case: &Case, flight: &Flight) -> Option<Implausible> {
    let is_asked = setup.program().is_some() && flight.track.has_places();
    is_asked.then(|| Implausible { speed: of_program(setup, case, flight), attitude: overturned(setup, &flight.track) })
}

/// Why the run of a program says nothing of its robot: what was found when it landed, or else in the rows that stand.
pub(super) fn unlike(setup: &Setup, case: &Case, flight: &Flight, known: Option<&FullRate>) -> Option<String> {
    setup.program()?;
    let found = known.and_then(|known| known.implausible).or_else(|| look(setup, case, flight));
    match found {
        Some(found) => in_words(setup, found),
        None => of_program(setup, case, flight).map(|speed| speed.in_words()),
    }
}

/// What of it leaves a run open: what fell over on its way is judged.
fn in_words(setup: &Setup, found: Implausible) -> Option<String> {
    let too_fast = found.speed.map(|speed| speed.in_words());
    too_fast.or_else(|| upside_down(setup, found.attitude).map(|found| found.in_words()))
}

impl Looked {
    /// What was found when the run landed, or else in the rows that stand; where there are none, what the rest tells.
    pub(super) fn at(
        setup: &Setup,
        case: &Case,
        (flight, known): (&Flight, Option<&FullRate>),
        measures: &Measures,
    ) -> Self {
        if setup.program().is_none() {
            return Self { found: Implausible::default(), is_whole: true };
        }
        let found = known.and_then(|known| known.implausible).or_else(|| look(setup, case, flight));
        let rest = || Implausible { speed: of_program(setup, case, flight), attitude: by_largest(setup, measures) };
        Self { is_whole: found.is_some(), found: found.unwrap_or_else(rest) }
    }

    /// That it fell over.
    pub(super) fn fell(&self, setup: &Setup) -> Option<Overturned> {
        fallen(setup, self.found.attitude)
    }

    /// Why such a run decides nothing, where anything is asked.
    pub(super) fn open(&self, setup: &Setup, limits: &Limits) -> Option<String> {
        in_words(setup, self.found).filter(|_| limits.are_given())
    }

    /// Why a run that keeps all limits does not, where anything is asked: nobody looked.
    pub(super) fn unseen(&self, limits: &Limits) -> Option<String> {
        (!self.is_whole && limits.are_given()).then(|| UNSEEN.to_owned())
    }
}
