//! QGroundControl's `.plan`: JSON with a mission, a fence and rally points, all three of which its loader wants.

use super::mission::{Item, Mission, degrees, number};
use crate::frames::Geodetic;

/// What the files' names end with.
pub const ENDING: &str = ".plan";

/// The text of a mission. What is to be said of it stands under `hairpin`, which QGroundControl passes over.
pub fn text(mission: &Mission) -> String {
    let Mission { autopilot, vehicle, home, fence, speed, .. } = mission;
    let note: Vec<String> =
        mission.note.iter().map(|(key, value)| format!("        {}: {}", quoted(key), quoted(value))).collect();
    let items: Vec<String> =
        mission.items().iter().enumerate().map(|(index, item)| simple_item(index + 1, item)).collect();
    let [cruise, hover] = ["cruiseSpeed", "hoverSpeed"]
        .map(|key| speed.map_or(String::new(), |speed| format!("        \"{key}\": {},\n", number(speed))));
    format!(
        r#"{{
    "fileType": "Plan",
    "hairpin": {{
{note}
    }},
    "geoFence": {{
        "circles": [],
        "polygons": [{polygon}],
        "version": 2
    }},
    "groundStation": "QGroundControl",
    "mission": {{
{cruise}        "firmwareType": {firmware},
        "globalPlanAltitudeMode": 1,
{hover}        "items": [
{items}
        ],
        "plannedHomePosition": [{lat}, {lon}, {alt}],
        "vehicleType": {kind},
        "version": 2
    }},
    "rallyPoints": {{
        "points": [],
        "version": 2
    }},
    "version": 1
}}
"#,
        note = note.join(",\n"),
        polygon = polygon(fence),
        firmware = autopilot.firmware(),
        items = items.join(",\n"),
        lat = degrees(home.lat_deg),
        lon = degrees(home.lon_deg),
        alt = number(home.alt_amsl_m),
        kind = vehicle.kind(),
    )
}

/// The fence, if it has corners.
fn polygon(fence: &[Geodetic]) -> String {
    if fence.is_empty() {
        return String::new();
    }
    let corner = |place: &Geodetic| format!("[{}, {}]", degrees(place.lat_deg), degrees(place.lon_deg));
    let corners: Vec<String> = fence.iter().map(corner).collect();
    format!(r#"{{ "inclusion": true, "polygon": [{}], "version": 1 }}"#, corners.join(", "))
}

fn simple_item(jump: usize, Item { command, frame, numbers, place }: &Item) -> String {
    let mut params: Vec<String> = numbers.iter().map(|value| value.map_or("null".into(), number)).collect();
    // All three keys of the altitude or none: those of a command without a place have no meaning.
    let altitude = match place {
        Some([lat, lon, height]) => {
            params.extend([degrees(*lat), degrees(*lon), number(*height)]);
            format!(
                "\"AMSLAltAboveTerrain\": null,\n                \"Altitude\": {},\n                \"AltitudeMode\": 1,\n                ",
                number(*height)
            )
        }
        None => {
            params.extend(["0", "0", "0"].map(str::to_owned));
            String::new()
        }
    };
    format!(
        r#"            {{
                {altitude}"autoContinue": true,
                "command": {command},
                "doJumpId": {jump},
                "frame": {frame},
                "params": [{}],
                "type": "SimpleItem"
            }}"#,
        params.join(", ")
    )
}

/// A string of JSON.
fn quoted(text: &str) -> String {
    serde_json::Value::from(text).to_string()
}
