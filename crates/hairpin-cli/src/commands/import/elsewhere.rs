//! Logs and missions from elsewhere: what they hold, and the command that judges them.

use std::path::Path;

use hairpin_formats::missions::Mission;
use hairpin_formats::quote::shell_word;
use hairpin_jobs::check::frame_in_words;
use hairpin_jobs::import::{ReadLog, ReadMotion};
use hairpin_jobs::judge_log::Cut;
use serde_json::{Value, json};

use crate::console;
use crate::exit::{DONE, FINDING, INCONCLUSIVE};

/// Tells of a log: 1 where a part of it would not be judged.
pub(super) fn tell_log(file: &Path, log: &ReadLog, as_json: bool) -> u8 {
    let code = if log.has_findings() { FINDING } else { DONE };
    if as_json {
        console::say(&log_object(file, log, code).to_string());
        return code;
    }
    let logged = &log.logged;
    console::say(&format!("{}: {}; stamps {}; frame {}", file.display(), logged.format, log.clock, log.frame));
    log.motions.iter().for_each(tell_motion);
    for joints in &logged.joints {
        let times = &joints.times_s;
        let span = [times.first(), times.last()].map(|t| t.copied().unwrap_or(0.0));
        console::say(&format!(
            "joints {}: {} samples, t = {:.1} … {:.1} s: {}",
            joints.name,
            times.len(),
            span[0],
            span[1],
            joints.joints.join(", ")
        ));
    }
    if let (Some(first), Some(last)) = (logged.progress.first(), logged.progress.last()) {
        console::say(&format!("mission: from item {} to item {} at t = {:.1} s", first.item, last.item, last.t_s));
    }
    logged.events.iter().for_each(|event| console::say(&format!("t = {:.1} s: {}", event.t_s, event.words)));
    logged.notes.iter().for_each(|note| console::say(note));
    let against = if log.motions.is_empty() { "--campaign OUT" } else { "--mission MISSION --robot ROBOT" };
    go_on(&format!("hairpin judge {} {against}", shell_word(&file.to_string_lossy())));
    code
}

fn tell_motion(motion: &ReadMotion) {
    let source = &motion.source;
    let [from, to] = motion.span_s;
    let (topic, words, samples, rate) = (&source.topic, source.words, source.samples, source.rate_hz);
    console::say(&format!("motion {topic}: {words}, {samples} samples at {rate:.1} Hz, t = {from:.1} … {to:.1} s"));
    Cut::all_in_words(&motion.cuts).iter().for_each(|cut| console::say(&format!("  {cut}")));
}

fn log_object(file: &Path, log: &ReadLog, code: u8) -> Value {
    let motion = |motion: &ReadMotion| {
        let cuts = motion.cuts.iter().map(
            |cut| json!({ "t_s": cut.t_s, "words": cut.words, "lost_s": cut.lost_s, "to_the_end": cut.to_the_end }),
        );
        let source = &motion.source;
        json!({
            "topic": source.topic, "source": source.words, "samples": source.samples, "rate_hz": source.rate_hz,
            "accuracy": source.has_accuracy, "from_s": motion.span_s[0], "to_s": motion.span_s[1],
            "findings": cuts.collect::<Vec<_>>(),
        })
    };
    let logged = &log.logged;
    let joints = logged
        .joints
        .iter()
        .map(|joints| json!({ "topic": joints.name, "joints": joints.joints, "samples": joints.times_s.len() }));
    let progress = logged.progress.iter().map(|at| json!({ "t_s": at.t_s, "item": at.item }));
    let events = logged.events.iter().map(|event| json!({ "t_s": event.t_s, "words": event.words }));
    json!({
        "kind": "log", "file": file, "format": logged.format, "clock": log.clock, "frame": log.frame,
        "motions": log.motions.iter().map(motion).collect::<Vec<_>>(),
        "joints": joints.collect::<Vec<_>>(), "progress": progress.collect::<Vec<_>>(),
        "events": events.collect::<Vec<_>>(), "notes": logged.notes, "exit_code": code,
    })
}

/// Tells of a mission: 5 where something of it changes the motion and is not followed.
pub(super) fn tell_mission(mission: &Mission, as_json: bool) -> u8 {
    let code = if mission.uncertain.is_empty() { DONE } else { INCONCLUSIVE };
    let length: f64 = mission.waypoints.windows(2).map(|pair| (pair[1] - pair[0]).norm()).sum();
    let (file, waypoints) = (mission.path.display(), mission.waypoints.len());
    if as_json {
        let uncertain = mission.uncertain.iter().map(|one| json!({ "waypoint": one.waypoint, "words": one.words }));
        let places = mission.waypoints.iter().map(|place| [place.x, place.y, place.z]);
        let object = json!({
            "kind": "mission", "file": mission.path, "format": mission.format, "waypoints": waypoints,
            "length_m": length, "frame": frame_in_words(mission), "waypoints_m": places.collect::<Vec<_>>(),
            "sources": mission.sources, "speeds_m_s": mission.speeds, "fences": mission.fences.len(),
            "stops": mission.stops.iter().map(|stop| stop.waypoint).collect::<Vec<_>>(),
            "notes": mission.notes, "uncertain": uncertain.collect::<Vec<_>>(), "exit_code": code,
        });
        console::say(&object.to_string());
        return code;
    }
    console::say(&format!(
        "{file}: {}, {waypoints} waypoints, {length:.1} m; {}",
        mission.format,
        frame_in_words(mission)
    ));
    let demanded: Vec<f64> = mission.speeds.iter().copied().flatten().collect();
    if !demanded.is_empty() {
        let (low, high) = demanded.iter().fold((f64::INFINITY, 0f64), |(low, high), v| (low.min(*v), high.max(*v)));
        let (legs, of) = (demanded.len(), mission.speeds.len());
        console::say(&format!("speeds are demanded on {legs} of {of} legs: {low:.2} to {high:.2} m/s"));
    }
    mission.stops.iter().for_each(|stop| console::say(&format!("it rests at {}", mission.told(stop.waypoint))));
    if !mission.fences.is_empty() {
        console::say(&format!("fences: {}", mission.fences.len()));
    }
    mission.notes.iter().for_each(|note| console::say(note));
    mission.uncertain.iter().for_each(|one| console::say(&format!("not followed: {}", one.words)));
    go_on(&format!("hairpin check {} --robot ROBOT", shell_word(&mission.path.to_string_lossy())));
    code
}

fn go_on(command: &str) {
    console::warn(&format!("next: {command}"));
}
