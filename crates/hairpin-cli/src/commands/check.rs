//! `hairpin check`: whether a robot can do a mission made elsewhere.

use hairpin::campaign::{Broken, PassedLeg};
use hairpin_jobs::check::{CheckSettings, Checked, certainty_word, check, frame_in_words};
use hairpin_jobs::{Problem, Watch};
use serde_json::{Value, json};

use crate::args::Check;
use crate::{console, settings};

/// Runs the command: 0 where the mission is feasible, 1 where it is proven not to be, 5 where that was not found out.
pub(crate) fn run(asked: &Check, watch: &dyn Watch) -> Result<u8, Problem> {
    let settings = CheckSettings {
        mission: asked.mission.clone(),
        robot: asked.robot.clone(),
        world: asked.world.clone(),
        sets: settings::split(&asked.sets)?,
        simd: settings::simd(&asked.kernels),
    };
    let checked = check(&settings, watch)?;
    if asked.json {
        console::say(&object(&checked).to_string());
    } else {
        tell(&checked);
    }
    Ok(checked.verdict.exit_code)
}

fn tell(checked: &Checked) {
    let mission = &checked.mission;
    let header = ["leg", "to", "length m", "asked m/s", "alone s", "witness s", "top m/s", "nearest limit", "answer"];
    let rows = checked.passage.legs.iter().enumerate().map(|(leg, one)| row(checked, leg, one));
    let header = header.map(str::to_owned).to_vec();
    console::say_lines(&console::table(&std::iter::once(header).chain(rows).collect::<Vec<_>>()));
    console::say("");
    console::say(&format!("mission: {}, {}", mission.format, frame_in_words(mission)));
    console::say(&format!("robot: {}; {}; claimed of {}", checked.robot, checked.world, checked.passage.model));
    for stop in &mission.stops {
        let hold =
            if stop.hold_s.is_finite() { format!("for {} s", stop.hold_s) } else { "until told to go on".into() };
        console::say(&format!("it rests at {} {hold}", mission.told(stop.waypoint)));
    }
    mission.notes.iter().for_each(|note| console::say(note));
    // A feasible one's sentence has it.
    checked.heights.iter().filter(|_| checked.feasible != Some(true)).for_each(|note| console::say(note));
    mission.uncertain.iter().for_each(|one| console::say(&one.words));
    if let Some(broken) = &checked.passage.broken {
        console::say(&format!("{}: {}: {}", mission.told(broken.waypoint), broken.limit, broken.words));
    }
    for broken in checked.passage.legs.iter().filter_map(|leg| leg.broken.as_ref()) {
        let sure = certainty_word(broken.certainty);
        console::say(&format!("{}: {} ({sure}): {}", mission.told(broken.waypoint), broken.limit, broken.words));
    }
    console::say(&checked.verdict.sentence);
}

fn row(checked: &Checked, leg: usize, one: &PassedLeg) -> Vec<String> {
    let number = |value: Option<f64>| value.map_or("–".into(), |value| format!("{value:.2}"));
    let nearest = one.nearest.map_or("–".into(), |(limit, ..)| limit.to_owned());
    let source = checked.mission.sources.get(leg + 1).cloned().unwrap_or_default();
    let answer = match &one.broken {
        Some(broken) => format!("{} {}", broken.limit, certainty_word(broken.certainty)),
        None => "ok".into(),
    };
    vec![
        format!("{leg}→{}", leg + 1),
        source,
        format!("{:.2}", one.length),
        number(checked.mission.speeds[leg]),
        number(one.fastest),
        number(one.time),
        number(one.top_speed),
        nearest,
        answer,
    ]
}

/// The contract's keys first, and what else is known.
fn object(checked: &Checked) -> Value {
    let Checked { mission, passage, broken, .. } = checked;
    let one = |broken: &Broken| {
        json!({
            "waypoint": broken.waypoint, "leg": broken.leg, "limit": broken.limit, "excess": broken.excess,
            "unit": broken.unit, "evidence": certainty_word(broken.certainty), "words": broken.words,
            "source": mission.sources.get(broken.waypoint),
        })
    };
    let leg = |(number, leg): (usize, &PassedLeg)| {
        json!({
            "leg": number, "length_m": leg.length, "demanded_m_s": mission.speeds[number],
            "fastest_alone_s": leg.fastest, "witness_s": leg.time, "top_speed_m_s": leg.top_speed,
            "nearest": leg.nearest.map(|(limit, margin, unit)| json!({ "limit": limit, "margin": margin, "unit": unit })),
            "broken": leg.broken.as_ref().map(one),
        })
    };
    let stops = mission.stops.iter().map(|stop| {
        let hold = Some(stop.hold_s).filter(|hold| hold.is_finite());
        json!({ "waypoint": stop.waypoint, "hold_s": hold })
    });
    json!({
        "feasible": checked.feasible,
        "waypoint": broken.as_ref().map(|broken| broken.waypoint),
        "limit": broken.as_ref().map(|broken| broken.limit),
        "excess": broken.as_ref().and_then(|broken| broken.excess),
        "unit": broken.as_ref().map(|broken| broken.unit),
        "evidence": broken.as_ref().map_or("witnessed", |broken| certainty_word(broken.certainty)),
        "broken": broken.as_ref().map(one),
        "estimated": passage.estimated,
        "verdict": checked.verdict.sentence,
        "exit_code": checked.verdict.exit_code,
        "robot": checked.robot,
        "world": checked.world,
        "model": passage.model,
        "mission": {
            "file": mission.path, "format": mission.format, "waypoints": mission.waypoints.len(),
            "frame": frame_in_words(mission), "stops": stops.collect::<Vec<_>>(),
        },
        "hold_s": Some(mission.hold()).filter(|hold| hold.is_finite()),
        "time_s": passage.witness.as_ref().map(|witness| witness.leg_times.iter().sum::<f64>()),
        "legs": passage.legs.iter().enumerate().map(leg).collect::<Vec<_>>(),
        "notes": mission.notes.iter().chain(&checked.heights).collect::<Vec<_>>(),
        "uncertain": mission.uncertain.iter().map(|one| json!({ "waypoint": one.waypoint, "words": one.words })).collect::<Vec<_>>(),
    })
}
