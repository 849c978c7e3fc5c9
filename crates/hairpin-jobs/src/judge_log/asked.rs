//! What the mission of a case asks beside the spec, of a log of it.

use hairpin::campaign::{Doubt, Flown, Log, Why};
use hairpin_formats::missions::Demands;

use crate::missions::{Beyond, MayBe, Moved, READ_OTHERWISE, look, takes_all_parts};

/// What a log leaves of what is asked.
#[derive(Debug, Default)]
pub(super) struct Asked {
    /// Why it says nothing of a limit that it keeps.
    pub(super) open: Option<String>,
    /// What its reader has to know.
    pub(super) notes: Vec<String>,
}

/// Holds `log` against it: beyond a fence is a violation of `flown`, and what may have been between two samples, or
/// within the log's own accuracy, a doubt.
pub(super) fn hold(asked: &Demands, log: &Log, flown: &mut Flown) -> Asked {
    // How it was executed in simulation is nothing of a log; what else the mission asks nobody looks at.
    let notes = asked.unmet.iter().map(|words| format!("what the mission asks is not looked at: {words}")).collect();
    let (track, times) = (&log.flight.track, log.flight.track.times());
    let swiftness = flown.swiftness;
    let bulge = |i: usize| {
        let goes_on = i + 1 < times.len() && log.breaks.binary_search(&(i + 1)).is_err();
        goes_on.then(|| swiftness.bulge(times[i + 1] - times[i], (track.position(i + 1) - track.position(i)).norm()))
    };
    let moved = log.resolution.place.moved;
    let sigma = |i: usize| log.accuracy.get(i).copied().flatten().map_or(0.0, |[across, _]| across) + moved;
    let seen = look(&asked.fences, &Moved { track, bulge: &bulge, sigma: &sigma });
    let on_leg = |beyond: &Beyond| {
        let before = times.partition_point(|time| *time <= beyond.at).saturating_sub(1);
        beyond.on_leg(track.channel("leg").map_or(0, |leg| leg[before] as usize))
    };
    match (seen.beyond, seen.may_be) {
        (Some(beyond), _) => flown.violations.push(on_leg(&beyond)),
        (None, Some(MayBe { seen, most, sigma })) => {
            let why = match sigma > 0.5 * (most - seen.by) {
                true if moved > sigma - moved => Why::Digits(moved),
                true => Why::Accuracy { which: "eph", sigma: sigma - moved },
                false => Why::Between { most, rate_hz: swiftness.rate(seen.by.abs()) },
            };
            // Of what is within it is told that it is beyond by nothing.
            flown.doubts.push(Doubt { value: on_leg(&Beyond { by: seen.by.max(0.0), ..seen }), why });
        }
        (None, None) => {}
    }
    let open = if seen.otherwise { Some(READ_OTHERWISE.into()) } else { None };
    let limit = flown.limits.total_time.filter(|_| asked.part);
    Asked { open: open.or_else(|| limit.map(takes_all_parts)), notes }
}
