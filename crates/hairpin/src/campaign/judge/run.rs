//! One run: what it measured, what it violates, and what it leaves open.
//!
//! Data flow: run → [`Drawn`] → measures of the rows that stand, or of all rows as they were measured → [`Seen`] →
//! violations, and where there are none what speaks against a pass → [`JudgedRun`].

use std::borrow::Cow;
use std::cell::OnceCell;

use super::along::{latest, left_out, proven, with_legs};
use super::looked::Looked;
use crate::campaign::attitude::tipped_over;
use crate::campaign::gravity::Gravity;
use crate::campaign::hidden::{hidden, sampled};
use crate::campaign::missed::missed;
use crate::campaign::scenario::{Asked, DeviationFrom, Terms};
use crate::campaign::{Case, Mistake, Run, Setup};
use crate::judgement::moves::Measured;
use crate::judgement::{self, Clearance, JudgementError, LegSource, Measures, Reference, Settings, Violation};
use crate::trajectory::{Ended, Flight, PlannedPath, Tolerances, Track};

/// A run with what it comes to.
pub(super) struct JudgedRun {
    pub(super) measures: Measures,
    pub(super) violations: Vec<Violation>,
    /// Why what was recorded decides nothing.
    pub(super) open: Option<String>,
    pub(super) ended: String,
    pub(super) left_world: Option<f64>,
    /// What it is compared by where it violates nothing: what the first limit bounds.
    within: f64,
    pub(super) moves: Option<Measured>,
}

impl JudgedRun {
    pub(super) fn gravity(&self) -> Gravity {
        Gravity::of((&self.violations, &self.ended), self.measures.max_deviation, self.within)
    }
}

/// A case's planned motion, once a run asked for it.
#[derive(Default)]
pub(super) struct Planned {
    /// What deviations are measured from.
    reference: OnceCell<Option<Track>>,
    /// Of programs: the path with its zones and where its moves end.
    programmed: OnceCell<Option<PlannedPath>>,
}

/// Measures one run in the world that was drawn for it.
pub(super) fn judge_run(
    setup: &Setup,
    case: &Case,
    plan: &Planned,
    run: &Run,
    flight: &Flight,
) -> Result<Result<JudgedRun, JudgementError>, Mistake> {
    let around = setup.around(case)?;
    let setup = around.as_ref();
    let Drawn { own, terms } = Drawn::of(setup, run)?;
    let programs = setup.kind().programs();
    let programmed = plan.programmed.get_or_init(|| programs?.programmed(case)).as_ref();
    // Rows may have been left out since it was measured so; deviations that are asked for otherwise are measured of
    // those that stand.
    let known = run.full_rate.as_ref().filter(|known| known.is_by(&terms));
    let path = match terms.from {
        DeviationFrom::Path if known.is_none() => {
            plan.reference.get_or_init(|| reference(setup, case, programmed)).as_ref()
        }
        _ => None,
    };
    let mut moves = programs.and_then(|programs| programs.measured(programmed?, &flight.track, path));
    let legs = moves.as_mut().map(|moves| std::mem::take(&mut moves.legs)).unwrap_or_default();
    let measured = match known {
        Some(known) => Ok(known.measures.clone()),
        None => of_rows(&own, &terms, path, (case, flight, &legs)).map(|rows| match &run.full_rate {
            Some(by_others) => by_others.beside(rows),
            None => rows,
        }),
    };
    Ok(measured.map(|mut measures| {
        measures.latest = moves.as_ref().and_then(latest);
        let moves_of = moves.iter().flat_map(|moves| &moves.moves);
        measures.legs.iter_mut().zip(moves_of).for_each(|(leg, one)| leg.lateness = one.late());
        let seen = Seen {
            own: &own,
            terms: &terms,
            flight,
            measures: &measures,
            moves: moves.as_ref(),
            looked: Looked::at(&own, case, (flight, run.full_rate.as_deref()), &measures),
            within: (known.is_none() && run.full_rate.is_some()).then(|| Tolerances::default().position),
        };
        let violations = seen.violations();
        JudgedRun {
            open: seen.open(violations.is_empty()),
            violations: match programs {
                Some(programs) => violations.into_iter().map(|one| programs.in_their_units(one)).collect(),
                None => violations,
            },
            ended: flight.ended.word().into(),
            left_world: flight.left_world,
            within: terms.gauge().of(&measures).unwrap_or(measures.max_deviation),
            measures,
            moves,
        }
    }))
}

/// What depends on the reference of deviations, and so is measured of the rows that stand where that is another one.
const OF_ROWS: [&str; 2] = ["deviation", "overshoot"];

/// The measures of the rows that stand, by legs that the run or its way along the planned path tells.
fn of_rows(
    own: &Setup,
    terms: &Terms,
    path: Option<&Track>,
    (case, flight, legs): (&Case, &Flight, &[usize]),
) -> Result<Measures, JudgementError> {
    let clearance = own.kind().clearance();
    let settings = settings(terms, path, clearance.as_deref());
    match with_legs(&flight.track, legs, case.waypoints.len()) {
        Some(track) => sampled(own, &track, &case.waypoints, &settings)
            .map(|rows| Measures { leg_source: LegSource::Assigned, ..rows }),
        None => sampled(own, &flight.track, &case.waypoints, &settings),
    }
}

/// What there is to judge a run by.
struct Seen<'a> {
    /// As it was drawn for the run.
    own: &'a Setup,
    terms: &'a Terms,
    flight: &'a Flight,
    measures: &'a Measures,
    /// Of programs.
    moves: Option<&'a Measured>,
    /// What no robot of its kind does.
    looked: Looked,
    /// How far its deviations and overshoots may be from those of all rows, m, where they are measured of the rows that
    /// were kept; `None` where all rows were measured.
    within: Option<f64>,
}

impl Seen<'_> {
    /// In SI.
    fn violations(&self) -> Vec<Violation> {
        let limits = &self.terms.limits;
        let mut violations = judgement::violations(self.measures, self.flight, limits);
        violations.retain(|one| !OF_ROWS.contains(&one.what.as_str()) || !self.is_open(one.value, one.limit));
        let fell = self.looked.fell(self.own).filter(|_| !self.flight.ended.is_crash());
        violations.splice(..0, fell.map(|fell| tipped_over(&fell, &self.flight.track, self.measures)));
        let Some(moves) = self.moves else { return violations };
        let ours = self.own.kind().programs().is_some_and(|programs| programs.recordings().is_none());
        if ours && limits.unfinished && self.flight.ended == Ended::Done {
            violations.splice(..0, left_out(moves));
        }
        if let Some(unseen) = &moves.unseen {
            proven(&mut violations, unseen.late_proven, moves);
        }
        violations
    }

    /// Whether it is as near to its limit as rows that were left out may have moved it, m.
    fn is_open(&self, value: f64, limit: f64) -> bool {
        self.within.is_some_and(|within| (value - limit).abs() <= within)
    }

    /// What rows that were left out leave open; arms are told in their units.
    fn of_kept_rows(&self) -> Option<String> {
        let (measures, limits) = (self.measures, &self.terms.limits);
        let values = [
            (measures.deviation(), limits.deviation),
            (Some(measures.max_overshoot()).filter(|_| limits.overshoot.is_some()), limits.overshoot),
        ];
        let open = |(what, (value, limit)): (&str, (Option<f64>, Option<f64>))| {
            let (value, limit) = (value?, limit?);
            self.is_open(value, limit).then(|| (what.to_owned(), value, limit))
        };
        let (what, value, limit) = OF_ROWS.into_iter().zip(values).find_map(open)?;
        let side = if value > limit { ">" } else { "≤" };
        let measured = Violation { what: what.clone(), value, limit, unit: "m".into(), at: 0.0, leg: 0 };
        let told = match self.own.kind().programs() {
            Some(programs) => programs.in_their_units(measured),
            None => measured,
        };
        let (value, limit) = told.printed();
        Some(format!(
            "{what} {value} {side} {limit}, but it is measured of the rows that are kept, within {:.1} mm of what was \
             flown; `hairpin execute OUT --out DIR` measures all of them",
            1e3 * self.within?
        ))
    }

    /// Why it decides nothing, whatever it violates or leaves out, the gravest reason first; much of that only where
    /// it `keeps` every limit, as what violates has an answer.
    fn open(&self, keeps: bool) -> Option<String> {
        let Self { own, flight, measures, ref looked, .. } = *self;
        let limits = &self.terms.limits;
        let programs = own.kind().programs();
        let kept = || self.moves.filter(|_| keeps);
        looked
            .open(own, limits)
            .or_else(|| programs.filter(|_| limits.are_given())?.beyond(&flight.track))
            .or_else(|| self.moves?.unseen.as_ref()?.open.clone())
            .or_else(|| kept().filter(|_| limits.unfinished)?.beside(limits.deviation.is_some()))
            .or_else(|| kept().filter(|_| limits.late.is_some())?.unarrived())
            .or_else(|| missed(own, flight, measures, limits).filter(|_| keeps))
            .or_else(|| looked.unseen(limits).filter(|_| keeps))
            .or_else(|| self.of_kept_rows())
            .or_else(|| hidden(own, measures, limits))
            .or_else(|| limits.open(measures))
    }
}

/// What a run is judged by, with what was drawn for it.
pub(in crate::campaign) struct Drawn<'a> {
    /// The scenario that it was flown in.
    pub(in crate::campaign) own: Cow<'a, Setup>,
    pub(in crate::campaign) terms: Terms,
}

impl<'a> Drawn<'a> {
    pub(in crate::campaign) fn of(setup: &'a Setup, run: &Run) -> Result<Self, Mistake> {
        let own = match run.drawn.is_empty() {
            true => Cow::Borrowed(setup),
            false => Cow::Owned(setup.drawn(&run.drawn)?),
        };
        let mut terms = own.scenario.head().terms;
        // Who asks for nothing does not ask for missions that are finished either.
        terms.limits.unfinished = own.scenario.asked() != Asked::Nothing;
        terms.limits.contact = own.program().is_some();
        Ok(Self { own, terms })
    }
}

/// How a run is measured by `terms`, from the `path` where they ask for it. Recordings of ours have no breaks.
pub(in crate::campaign) fn settings<'a>(
    terms: &Terms,
    path: Option<&'a Track>,
    clearance: Option<&'a Clearance<'a>>,
) -> Settings<'a> {
    let reference = match (terms.from, path) {
        (DeviationFrom::Path, Some(path)) => Reference::Path(path),
        (DeviationFrom::NearestLeg, _) => Reference::NearestLeg,
        _ => Reference::Leg,
    };
    Settings { reference, corner: terms.corner, clearance, ..Settings::default() }
}

/// The motion that deviations from the path are measured from.
///
/// `None` where the case has no motion: the judge then says that nothing can be measured from a path.
pub(in crate::campaign) fn reference(setup: &Setup, case: &Case, programmed: Option<&PlannedPath>) -> Option<Track> {
    match setup.kind().programs() {
        Some(programs) => programs.reference(case, programmed),
        None => setup.kind().followed(case).ok(),
    }
}
