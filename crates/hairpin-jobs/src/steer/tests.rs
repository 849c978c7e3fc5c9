//! Questions answered without a binary.

use std::fs;

use hairpin_formats::steering::Status;

use super::*;
use crate::Unwatched;

fn generic() -> Vehicle {
    Vehicle::new(&SteerSettings { rover: "generic".into(), ..SteerSettings::default() }, &Unwatched).unwrap()
}

#[test]
fn a_question_is_answered_and_summed_up() {
    let vehicle = generic();
    let asked = Question { to: [4.0, 1.0, 0.5, 0.0], ..Question::default() }.asked();
    let answered = vehicle.answer(&asked);
    assert_eq!(answered.status, Status::Ok);
    let summary = vehicle.summary(&asked, &answered);
    assert_eq!(summary.profile.unwrap().kind, "constant");
    assert!(vehicle.remedies(&asked, &answered).nearest.is_none());
}

#[test]
fn frames_ask_the_same_question() {
    let enu = Question { from: Some([1.0, 2.0, 0.3, 0.1]), to: [5.0, 3.0, 0.8, 0.0], ..Question::default() }.asked();
    let quarter = std::f64::consts::FRAC_PI_2;
    let ned = Question {
        from: Some([2.0, 1.0, quarter - 0.3, -0.1]),
        to: [3.0, 5.0, quarter - 0.8, 0.0],
        frame: hairpin_formats::steering::Frame::Ned,
        ..Question::default()
    };
    let goals = enu.goal.into_iter().zip(ned.asked().goal);
    assert!(goals.into_iter().all(|(a, b)| (a - b).abs() < 1e-12));
    let back = goal_in_the_map(&ned.asked(), &[enu.goal[0], enu.goal[1], enu.goal[2], 0.0]);
    assert!(back.into_iter().zip(ned.to).all(|(a, b)| (a - b).abs() < 1e-12), "{back:?}");
}

#[test]
fn a_file_is_answered_in_its_order() {
    let place = tempfile::tempdir().unwrap();
    let path = place.path().join("q.csv");
    fs::write(&path, "id,x,y,yaw,k0,kf\na,4,1,0.5,0,0\nb,x,1,0,0,0\nc,0.1,0,0,0.9,-0.9\n").unwrap();
    let batch = generic().answer_file(&path, &Unwatched).unwrap();
    let ids: Vec<&str> = batch.answers.iter().map(|answer| answer.id.as_str()).collect();
    assert_eq!(ids, ["a", "b", "c"]);
    assert_eq!((batch.count(Status::Ok) >= 1, batch.count(Status::Invalid)), (true, 1));
    assert!(String::from_utf8(batch.table().unwrap()).unwrap().starts_with("id,segment,"));
}
