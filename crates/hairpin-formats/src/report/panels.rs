//! Series under deviation and speed: of flights the rotors, of drives curvature, attitude and joints, of arms joints.

use hairpin::trajectory::Track;
use serde_json::{Value, json};

/// Panels as the page has them, and the channels that they and the robot's figure need.
pub(super) fn panels(track: &Track) -> (Vec<Value>, Vec<String>) {
    const DEGREES: f64 = 180.0 / std::f64::consts::PI;
    let line = |name: &str, channel: &str, scale: f64| (name.to_owned(), channel.to_owned(), scale);
    let numbered = |name: &str, before: &str, after: &str, scale| {
        (1..=12).map(|i| line(&format!("{name} {i}"), &format!("{before}{i}{after}"), scale)).collect::<Vec<_>>()
    };
    let mut angles = vec![line("tip-over margin", "tip_over_margin_deg", 1.0)];
    if track.channel("tip_over_margin_deg").is_some() {
        angles.extend([line("nose up", "nose_up_deg", 1.0), line("left side up", "left_up_deg", 1.0)]);
    }
    let joint = |name: &str| line(&name.replace('_', " "), &format!("joint_{name}_rad"), DEGREES);
    let all = [
        ("rotors rad/s", numbered("rotor", "rotor", "_rad_s", 1.0)),
        ("joints °", numbered("axis", "q", "_rad", DEGREES)),
        (
            "curvature 1/m",
            vec![line("commanded", "commanded_curvature_1_m", 1.0), line("steered", "curvature_1_m", 1.0)],
        ),
        ("angles °", angles),
        ("joints °", ["rocker", "left_bogie", "right_bogie"].map(joint).to_vec()),
        ("slip %", vec![line("slip", "slip", 100.0)]),
        ("thrust N", vec![line("ahead", "surge_n", 1.0), line("to the left", "sway_n", 1.0)]),
    ];
    let known = |channel: &str| track.channel(channel).is_some() || channel.ends_with("_up_deg");
    let (mut panels, mut channels) = (Vec::new(), vec!["speed_m_s".to_owned(), "travel_direction_rad".to_owned()]);
    channels.retain(|channel| known(channel));
    for (title, lines) in all {
        let lines: Vec<_> = lines.into_iter().filter(|(_, channel, _)| known(channel)).collect();
        if lines.is_empty() {
            continue;
        }
        channels.extend(lines.iter().map(|(_, channel, _)| channel.clone()));
        let lines: Vec<Value> = lines
            .iter()
            .map(|(name, channel, scale)| json!({ "name": name, "channel": channel, "scale": scale }))
            .collect();
        panels.push(json!({ "title": title, "lines": lines }));
    }
    (panels, channels)
}
