//! Logs against missions of ground stations, whose places are degrees.

use super::*;

const HOME: Geodetic = Geodetic { lat_deg: 38.03355, lon_deg: -78.50797, alt_amsl_m: 180.0 };

/// The corners as a plan about [`HOME`], with its fences' circles and whose it is.
fn plan(circles: &str, more: &str) -> String {
    let about = Placement::about(&HOME);
    let item = |(number, p): (usize, Point3<f64>)| {
        let Geodetic { lat_deg, lon_deg, .. } = about.geodetic(&p).unwrap();
        format!(
            r#"{{ "type": "SimpleItem", "command": 16, "frame": 3, "autoContinue": true, "doJumpId": {},
                 "params": [0, 0, 0, null, {lat_deg:.9}, {lon_deg:.9}, {}] }}"#,
            number + 1,
            p.z
        )
    };
    let items: Vec<String> = corners().into_iter().enumerate().map(item).collect();
    format!(
        r#"{{ "fileType": "Plan", "version": 1, "groundStation": "QGroundControl",
             "geoFence": {{ "version": 2, "circles": [{circles}], "polygons": [] }}, "rallyPoints": {{ "version": 2, "points": [] }},
             "mission": {{ "version": 2, {more} "cruiseSpeed": 15, "hoverSpeed": 5,
                          "plannedHomePosition": [{}, {}, {}], "items": [{}] }} }}"#,
        HOME.lat_deg,
        HOME.lon_deg,
        HOME.alt_amsl_m,
        items.join(", ")
    )
}

/// A circle of a fence about `x`, `y`.
fn circle(inclusion: bool, [x, y, radius]: [f64; 3]) -> String {
    let Geodetic { lat_deg, lon_deg, .. } = Placement::about(&HOME).geodetic(&Point3::new(x, y, 0.0)).unwrap();
    format!(
        r#"{{ "version": 1, "inclusion": {inclusion}, "circle": {{ "center": [{lat_deg:.9}, {lon_deg:.9}], "radius": {radius} }} }}"#
    )
}

const PX4: &str = r#""firmwareType": 12, "vehicleType": 2,"#;

/// What is said of a flight of the corners, 0.41 m off, whose log has its origin at home.
fn against_plan(text: &str) -> Result<JudgedLog, String> {
    sampled_against_plan(100.0, text)
}

/// The same, sampled so often in a second.
fn sampled_against_plan(rate_hz: f64, text: &str) -> Result<JudgedLog, String> {
    let logged = Logged { frame: LogFrame::Enu(Some(HOME)), ..log(rate_hz, 0.41) };
    judged_as(&logged, |settings, here| {
        let file = here.join("mine.plan");
        fs::write(&file, text).unwrap();
        settings.against = Against::Mission { file, robot: Some("flightgoggles".into()) };
    })
}

#[test]
fn a_plan_is_a_mission_about_its_own_home() {
    let judged = against_plan(&plan("", PX4)).unwrap();
    let sentence = &judged.verdict.sentence;
    assert!(sentence.starts_with("PASS mine (flown, log_24.ulg") && sentence.contains("0.41 m ≤ 0.50 m"), "{sentence}");
    assert!(judged.found.unwrap().frame.by_earth);
    // Whoever takes off elsewhere is elsewhere: home is a place.
    let away = Geodetic { lat_deg: HOME.lat_deg + 1e-4, ..HOME };
    let logged = Logged { frame: LogFrame::Enu(Some(away)), ..log(100.0, 0.41) };
    let told = judged_as(&logged, |settings, here| {
        let file = here.join("mine.plan");
        fs::write(&file, plan("", PX4)).unwrap();
        settings.against = Against::Mission { file, robot: Some("flightgoggles".into()) };
    });
    assert!(told.is_err_and(|told| told.contains("it never is within")));
}

#[test]
fn a_log_is_held_against_the_missions_own_fences() {
    let said = |circles: &[String], whose: &str| {
        against_plan(&plan(&circles.join(", "), whose))
            .map(|judged| (judged.verdict.exit_code, judged.verdict.sentence))
    };
    let wide = circle(true, [14.0, 14.0, 60.0]);
    assert_eq!(said(std::slice::from_ref(&wide), PX4).unwrap().0, 0);
    let (code, sentence) = said(&[wide.clone(), circle(false, [14.0, 4.0, 2.0])], PX4).unwrap();
    assert!(code == 1 && sentence.contains("fence ") && sentence.contains("leg 0→1"), "{sentence}");
    let (code, sentence) = said(&[circle(true, [4.0, 4.0, 25.0])], PX4).unwrap();
    assert!(code == 1 && sentence.contains("fence ") && sentence.contains("leg 1→2"), "{sentence}");
    // Beside its way by less than what may hide between two samples.
    let beside = plan(&circle(false, [14.0, 4.0 + 0.41 + 2.0 + 0.002, 2.0]), PX4);
    assert_eq!(against_plan(&beside).unwrap().verdict.exit_code, 0);
    let judged = sampled_against_plan(20.0, &beside).unwrap();
    let sentence = judged.verdict.sentence;
    assert!(judged.verdict.exit_code == 5 && sentence.contains("m may hide between two of them"), "{sentence}");
    assert!(sentence.contains("fence 0.00"), "{sentence}");
    let several = [wide, circle(true, [4.0, 4.0, 5.0])];
    let (code, sentence) = said(&several, r#""firmwareType": 0, "vehicleType": 2,"#).unwrap();
    assert!(code == 5 && sentence.contains("ArduPilot (firmwareType 3) demands to be in all"), "{sentence}");
    assert_eq!(said(&several, PX4).unwrap().0, 0, "it is in one of them");
    assert_eq!(said(&several, r#""firmwareType": 3, "vehicleType": 2,"#).unwrap().0, 1);
}

#[test]
fn what_is_no_mission_of_the_robot_or_is_not_followed_is_refused() {
    let told = against_plan(&plan("", r#""firmwareType": 12, "vehicleType": 10,"#)).map(drop).unwrap_err();
    assert!(told.contains("mission.vehicleType: 10"), "{told}");
    let spline = plan("", PX4).replacen("\"command\": 16", "\"command\": 82", 1);
    let told = against_plan(&spline).map(drop).unwrap_err();
    assert!(told.contains("what would be judged is not the mission"), "{told}");
}
