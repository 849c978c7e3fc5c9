//! What the flight of a mission shows of its program.

use hairpin::campaign::Mission;
use hairpin::campaign::missed::all_missed;
use hairpin::trajectory::{ATTITUDE_UNKNOWN, Ended, Flight};

use super::step::Step;

/// Fewer poses a second than this miss what happens between them.
const SPARSE_HZ: f64 = 10.0;

/// What a flight shows of its program.
pub(super) fn tell(step: &mut Step, mission: &Mission, flight: &Flight, seconds: f64) {
    let (poses, last) = (flight.track.len(), flight.track.times().last().copied().unwrap_or_default());
    let (reached, of) = (flight.reached.iter().flatten().count(), mission.waypoints.len());
    let ended = flight.ended.word();
    step.fact(format!(
        "{poses} poses over {last:.2} s in {seconds:.2} s, {reached} of {of} waypoints reached, ended \"{ended}\""
    ));
    let end = mission.waypoints.last();
    let nearest = end.map(|end| {
        let away = |pose: usize| (flight.track.position(pose) - end).norm();
        (0..poses).map(away).fold(f64::INFINITY, f64::min)
    });
    match (flight.ended, flight.reached.last(), nearest) {
        (Ended::Done, Some(None), Some(nearest)) => step.mistake(format!(
            "says \"done\" and comes no nearer than {nearest:.2} m to the last waypoint (accept_m = {}), or not on its last leg: it counts as unfinished, \
             which is a violation",
            mission.accept
        )),
        (Ended::Done, ..) => {}
        (Ended::Time, Some(None), _) if comes_late(mission, flight) => step.mistake(format!(
            "comes to the last waypoint only after time_limit_s = {}, at which a mission ends as \"time\": it counts as unfinished, which is a violation",
            mission.time_limit
        )),
        _ => step.remark(format!("ended \"{ended}\" and not \"done\": on a small mission this is worth a look")),
    }
    if flight.ended == Ended::Done {
        let allowed = mission.setup.scenario.deviation_limit().unwrap_or(0.0);
        for missed in all_missed(&mission.setup, flight, &mission.waypoints) {
            let what = format!("says \"done\", but {}", missed.in_words());
            if missed.nearest_m > allowed {
                step.mistake(format!("{what}: what skips one is INCONCLUSIVE"));
            } else {
                step.remark(format!(
                    "{what}: it is judged as passed, for the limit of the deviation is {allowed} m here; was it left out?"
                ));
            }
        }
    }
    if let Some(at) = flight.left_world {
        step.remark(format!(
            "leaves the world at t = {at:.2} s, which is a violation: are its places in the world's frame?"
        ));
    }
    if poses as f64 > 1.0 && (poses as f64) < SPARSE_HZ * last {
        step.remark(format!(
            "{:.1} poses a second: what happens between them is not seen; send 50 or 100",
            poses as f64 / last
        ));
    }
    let has = |name: &str| flight.track.channel(name).is_some();
    if has(ATTITUDE_UNKNOWN) {
        step.remark("no \"q_wxyz\", or not in all poses: attitudes count as unknown");
    }
    if !has("vx_m_s") {
        step.remark("no \"v_m_s\", or not in all poses: velocities are differentiated from places");
    }
    if !has("leg") {
        step.remark("no \"leg\": hairpin assigns poses to legs along the path");
    }
}

/// Whether it is at the last waypoint at some pose after the time limit.
fn comes_late(mission: &Mission, flight: &Flight) -> bool {
    let Some(end) = mission.waypoints.last() else { return false };
    let is_there = |pose: usize| (flight.track.position(pose) - end).norm() <= mission.accept;
    let times = flight.track.times();
    (0..times.len()).any(|pose| times[pose] > mission.time_limit && is_there(pose))
}
