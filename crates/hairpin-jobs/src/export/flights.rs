//! The day card: the few cases that are worth flying today, in their order, with what to expect and when to end them.

use std::cmp::Reverse;
use std::collections::BTreeSet;
use std::path::Path;

use hairpin::campaign::digits::number;
use hairpin::campaign::kind::Room;
use hairpin::campaign::report::{Drawn, leg, shown, violation, worst_first};
use hairpin::campaign::select::{By, Candidate, Choice};
use hairpin::campaign::{Case, CaseNumber, CaseResult, Environment};
use hairpin::judgement::{Limits, Measures};
use hairpin::robot::battery::Battery;
use hairpin_formats::atomic;
use hairpin_formats::placement::Placement;
use hairpin_formats::qgc::mission::Autopilot;
use hairpin_formats::report::{DayCard, FlightCard, day_card_html};

use super::airtime::AirTime;
use super::hardware::{Hardware, PURPOSE, room};
use super::limits::{above_home, return_words};
use super::missions::{remove_slow, write_slow};
use super::preflight::{Cleared, look_at};
use super::speeds::of_legs;
use super::written::Written;
use crate::Problem;
use crate::execute::run_with_motion;
use crate::work::Work;

/// Share of the plan's speeds in the first run of the day.
const SLOW: f64 = 0.3;
/// A flight that deviates so many times as far as its runs predict is not what was predicted.
const BEYOND: f64 = 1.5;

/// `day-card.html` of `count` of `cases`, and `CASE_slow.plan` of the first of them where the world stands on Earth.
pub(super) fn write(
    (work, place): (&Work, &Path),
    cases: &[&Case],
    (count, accept, autopilot): (usize, bool, Autopilot),
) -> Result<Written, Problem> {
    let room = room(work, "day card")?;
    let results = work.folder.read_results()?;
    let mut written = Written::default();
    let mut there: Vec<(&Case, &CaseResult, &Measures, Cleared)> = Vec::new();
    for case in cases {
        let result = results.iter().find(|result| result.case == case.number);
        let Some((result, measures)) = result.and_then(|result| Some((result, result.measures.as_ref()?))) else {
            written.missing.push(format!("case {} is left out: nothing was measured of it", case.id()));
            continue;
        };
        let cleared = look_at(work, &room, case)?;
        match cleared.beyond.first().filter(|_| !accept) {
            Some(beyond) => {
                written.missing.push(format!("left out by preflight (--accept-excursion takes it in): {beyond}"))
            }
            None => there.push((case, result, measures, cleared)),
        }
    }
    if count > there.len() {
        let why = written.missing.first().map_or(String::new(), |why| format!("; {why}"));
        return Err(Problem::input(format!(
            "--flights {count}: must be at most {}, so many of {} cases were executed and judged and stay inside{why}",
            there.len(),
            cases.len()
        )));
    }
    let candidates: Vec<Candidate> =
        there.iter().map(|(case, result, ..)| Candidate::new(case, Some(*result), BTreeSet::new())).collect();
    let mut chosen = Choice::new(&candidates).best(count, By::Diverse);
    // The gentlest first: what goes wrong there goes no further. What ended badly is the last, whatever it deviated.
    let worst: Vec<CaseNumber> = worst_first(&results).iter().map(|result| result.case).collect();
    chosen.sort_by_key(|index| Reverse(worst.iter().position(|case| *case == there[*index].0.number)));
    let (mut flights, mut times) = (Vec::new(), Vec::new());
    for (order, index) in chosen.iter().enumerate() {
        let (case, result, measures, cleared) = &there[*index];
        let speeds = of_legs(work, &room, case)?;
        let time = |share| AirTime::of((case, &cleared.way), (&speeds, measures.total_time), (share, autopilot));
        times.extend((order == 0).then(|| (format!("{} slow", case.id()), time(SLOW).total())));
        times.push((case.id(), time(1.0).total()));
        let run = run_with_motion(work, case, result.run)?;
        let planned = work.folder.read_planned(case.number)?;
        let refuse = |cause| Problem::input(format!("case {}: {cause}", case.id()));
        let shown = shown(&work.setup, case, result, planned, run.as_ref().map(Drawn::from), &[]).map_err(refuse)?;
        let mut rows = rows(work, case, (result, measures, cleared), order)?;
        rows.push(["in the air".into(), time(1.0).words(room.flies)]);
        rows.extend(returning(work, (&room, autopilot), case, cleared)?);
        flights.push(FlightCard { drawing: work.setup.drawing(&case.waypoints), shown, rows });
    }
    let limits = work.setup.scenario.head().terms.limits;
    let card = DayCard {
        title: work.setup.robot_name().to_owned(),
        told: told(work, [count, there.len()], &times),
        abort: abort(&limits, room.margin),
        flights,
    };
    let path = place.join("day-card.html");
    atomic::write(&path, day_card_html(&card).as_bytes())?;
    written.files.push(path);
    // Those of an earlier card's first flight belong to no page of this one.
    remove_slow(place)?;
    let Some((case, .., cleared)) = chosen.first().map(|first| &there[*first]) else { return Ok(written) };
    match Placement::of(&work.setup.scenario) {
        Ok(Some(_)) => {
            let hardware = Hardware { room, cleared: Vec::new(), results: results.clone() };
            let slow = (SLOW, autopilot);
            written.files.extend(write_slow((work, place), case, (&hardware, cleared), slow)?);
            written.told.push(format!(
                "first case {} at {:.0} % of its speeds: {}_slow.plan",
                case.id(),
                100.0 * SLOW,
                case.id()
            ));
        }
        _ => written
            .told
            .push("no slow .plan: the scenario has no `world.origin`; fly the first case slowly by hand first".into()),
    }
    let order: Vec<String> = chosen.iter().map(|index| there[*index].0.id()).collect();
    written.told.push(format!("in the order of the day: {}", order.join(", ")));
    Ok(written)
}

/// What is to be expected of a case.
fn rows(
    work: &Work,
    case: &Case,
    (result, measures, cleared): (&CaseResult, &Measures, &Cleared),
    order: usize,
) -> Result<Vec<[String; 2]>, Problem> {
    let line = |label: &str, value: String| [label.to_owned(), value];
    let facts = work.folder.facts_of(case.number)?;
    let deviations: Vec<f64> =
        facts.iter().filter_map(|run| Some(run.full_rate.as_ref()?.measures.max_deviation)).collect();
    let over = match (deviations.iter().copied().reduce(f64::min), deviations.iter().copied().reduce(f64::max)) {
        (Some(least), Some(most)) => format!("{least:.2} to {most:.2} m over {} runs", deviations.len()),
        _ => format!("{:.2} m in its worst run", measures.max_deviation),
    };
    let planned: f64 = case.leg_times.iter().sum();
    let mut rows = vec![
        line(
            "worst moment",
            format!("t = {:.1} s, leg {}: deviation {over}", measures.t_worst, leg(measures.leg_worst)),
        ),
        line(
            "predicted",
            match result.violations.is_empty() {
                true => "within the limits".into(),
                false => result.violations.iter().map(violation).collect::<Vec<_>>().join("; "),
            },
        ),
        line(
            "duration",
            format!(
                "{} s planned, {} s {}",
                number(Some(planned)),
                number(Some(measures.total_time)),
                match result.ended.as_str() {
                    "done" => "in its worst run".into(),
                    ended => format!("until its worst run ended ({ended})"),
                }
            ),
        ),
        line(
            "watch",
            format!("acceleration up to {} m/s²; {}", number(Some(measures.max_acceleration)), saturation(measures)),
        ),
        line("evidence", format!("{} for hairpin's plan; seed {}", case.claim(), case.seed)),
        line(
            "home",
            format!(
                "below waypoint 0: ({:.2}, {:.2}, {:.2}) m of the world",
                cleared.way.home.x, cleared.way.home.y, cleared.way.home.z
            ),
        ),
    ];
    if order == 0 {
        rows.insert(
            0,
            line(
                "first run",
                format!("slow: {:.0} % of the plan's speeds ({}_slow.plan), then as planned", 100.0 * SLOW, case.id()),
            ),
        );
    }
    rows.extend(case.environment.as_ref().map(|around| line("meets", Environment::words(around).join("; "))));
    rows.extend((!cleared.beyond.is_empty()).then(|| line("accepted", cleared.beyond.join("; "))));
    rows.extend((!cleared.told.is_empty()).then(|| line("preflight", cleared.told.join("; "))));
    Ok(rows)
}

fn saturation(measures: &Measures) -> String {
    measures.saturation_share.map_or("saturation was not told".into(), |share| {
        format!("a rotor at its limit {:.0} % of the time", 100.0 * share)
    })
}

/// What is true of all flights.
fn told(work: &Work, [count, of]: [usize; 2], flights: &[(String, f64)]) -> Vec<String> {
    let caveat = work.setup.caveat();
    let mut told = vec![
        format!(
            "{count} of {of} cases that stay inside, chosen for stress and for distance from each other; {}",
            By::Diverse.guarantee()
        ),
        "flown from the gentlest to the most stressful, those last whose runs ended badly; the next one only after the last \
         one went as predicted"
            .into(),
        carried(work.setup.battery(), flights),
        format!("{PURPOSE}; predicted for {}", work.setup.robot_name()),
    ];
    told.extend((!caveat.is_empty()).then(|| caveat.to_owned()));
    told
}

/// How a failsafe may come home.
fn returning(
    work: &Work,
    (room, autopilot): (&Room, Autopilot),
    case: &Case,
    cleared: &Cleared,
) -> Result<Option<[String; 2]>, Problem> {
    let height = cleared.way.return_height(&work.setup, room, case)?;
    let above_home = height.map(|height| height.map(|height| above_home(height, room, &cleared.way)));
    Ok(above_home.map(|height| ["failsafe return".into(), return_words(autopilot, height)]))
}

/// What the battery lasts for: which flights, in their order, each charge carries, and which none does.
fn carried(battery: Option<Battery>, flights: &[(String, f64)]) -> String {
    let Some(battery) = battery else {
        return "the robot's file says nothing of its battery (`battery.endurance_s`): compare the durations with what it lasts".into();
    };
    let times: Vec<f64> = flights.iter().map(|(_, time)| *time).collect();
    let charges = battery.charges(&times);
    let on = |charge: Option<usize>| {
        let of = flights.iter().zip(&charges).filter(|(_, on)| **on == charge);
        of.map(|((case, _), _)| case.as_str()).collect::<Vec<_>>().join(", ")
    };
    let count = charges.iter().flatten().max().map_or(0, |last| last + 1);
    let on_charges = (0..count).map(|charge| format!("charge {}: {}", charge + 1, on(Some(charge))));
    let too_long =
        charges.contains(&None).then(|| format!("longer than a charge, not to be flown as they are: {}", on(None)));
    format!(
        "battery: {:.0} s a charge ({:.0} % of {:.0} s kept back), each flight from take-off to landing as its page has it; {}",
        battery.usable(),
        100.0 * battery.reserve,
        battery.endurance,
        on_charges.chain(too_long).collect::<Vec<_>>().join("; ")
    )
}

/// When a flight is ended.
fn abort(limits: &Limits, margin: f64) -> Vec<String> {
    let mut abort = vec![
        format!("it comes nearer than {margin} m to a wall, or leaves the fence"),
        format!("it deviates {BEYOND} times as far as its runs predict, or not where they do"),
        "position is estimated without its source, the link is lost, or the battery is at its reserve".into(),
    ];
    abort.extend(limits.deviation.map(|most| format!("it deviates more than {most} m where this page predicts less")));
    abort.extend(limits.clearance.map(|least| format!("it comes nearer than {least} m to an obstacle")));
    abort
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::violating;
    use crate::work::open_to_read;
    use hairpin_formats::folder::CampaignFolder;

    /// The one that deviates least hits a wall at once; a card of another day was there before.
    #[test]
    fn what_ended_badly_is_flown_last() {
        let (_place, folder) = violating();
        let kept = CampaignFolder::open_to_write(&folder).unwrap();
        let cases = kept.read_cases().unwrap();
        let mut results = kept.read_results().unwrap();
        let deviation = |result: &CaseResult| result.measures.as_ref().unwrap().max_deviation;
        results.sort_by(|a, b| deviation(a).total_cmp(&deviation(b)));
        let [gentle, other] = [0, 1].map(|place| results[place].case.to_string());
        results[0].ended = "wall".into();
        let mut crash = results[0].violations[0].clone();
        (crash.what, crash.value, crash.limit, crash.unit) = ("crash".into(), 0.5, 0.0, "s".into());
        results[0].violations.insert(0, crash);
        results[0].measures.as_mut().unwrap().total_time = 0.5;
        results.sort_by_key(|result| result.case);
        kept.write_results(&cases, &results).unwrap();
        let place = kept.export_folder().unwrap();
        drop(kept);
        let [stale, own] = ["0099_slow.plan", "my_slow.plan"].map(|name| place.join(name));
        std::fs::write(&stale, "").unwrap();
        std::fs::write(&own, "").unwrap();
        let work = open_to_read(&folder).unwrap();
        let written = write((&work, &place), &cases.iter().collect::<Vec<_>>(), (2, true, Autopilot::Px4)).unwrap();
        let order = format!("in the order of the day: {other}, {gentle}");
        assert!(written.told.contains(&order), "{order}: {:?}", written.told);
        let page = std::fs::read_to_string(place.join("day-card.html")).unwrap();
        for words in ["until its worst run ended (wall)", "as the .plan flies it: climb ", "failsafe return"] {
            assert!(page.contains(words), "{words}");
        }
        assert!(!stale.exists() && own.exists(), "what another wrote stays");
    }

    #[test]
    fn a_page_says_what_a_charge_carries() {
        let flights = [("0002 slow", 160.0), ("0002", 90.0), ("0007", 100.0), ("0001", 560.0)];
        let flights = flights.map(|(case, time)| (case.to_owned(), time));
        let told = carried(Some(Battery { endurance: 400.0, reserve: 0.25 }), &flights);
        let wanted = "battery: 300 s a charge (25 % of 400 s kept back), each flight from take-off to landing as its page has it; \
                      charge 1: 0002 slow, 0002; charge 2: 0007; longer than a charge, not to be flown as they are: 0001";
        assert_eq!(told, wanted);
        assert!(carried(None, &flights).contains("says nothing of its battery"));
    }
}
