//! Measures on tracks whose answers are known, and the spec.

use nalgebra::{Isometry3, Point3, Unit, UnitQuaternion, Vector3};

use super::*;
use crate::trajectory::{ATTITUDE_UNKNOWN, Channel, Ended, Flight, Track};

/// A track through `positions` at `times` with named channels.
fn track(times: Vec<f64>, positions: &[[f64; 3]], channels: &[(&str, Vec<f64>)]) -> Track {
    let poses = positions.iter().map(|p| Isometry3::translation(p[0], p[1], p[2])).collect();
    let channels = channels.iter().map(|(name, values)| Channel { name: (*name).into(), values: values.clone() });
    Track::new(times, poses, channels.collect()).unwrap()
}

fn seconds(n: usize) -> Vec<f64> {
    (0..n).map(|i| i as f64).collect()
}

fn square() -> Vec<Point3<f64>> {
    [[0.0, 0.0, 0.0], [10.0, 0.0, 0.0], [10.0, 10.0, 0.0]].map(Point3::from).to_vec()
}

#[test]
fn deviation_is_from_the_leg_flown_and_not_in_corners() {
    // 2 m beside leg 0 at the middle; then past the corner; then 1 m beside leg 1.
    let positions = [[0.0, 0.0, 0.0], [5.0, -2.0, 0.0], [10.5, 0.0, 0.0], [11.0, 5.0, 0.0], [10.0, 10.0, 0.0]];
    let track = track(seconds(5), &positions, &[("leg", vec![0.0, 0.0, 1.0, 1.0, 1.0])]);
    let settings = Settings { corner: 1.0, ..Settings::default() };
    let m = measure(&track, &square(), &settings).unwrap();
    assert_eq!((m.max_deviation, m.t_worst, m.leg_worst), (2.0, 1.0, 0));
    assert_eq!((m.legs[0].max_deviation, m.legs[1].max_deviation), (2.0, 1.0));
    assert_eq!(m.mean_deviation, 1.5); // two samples of 1 s count
    assert_eq!((m.legs[0].time, m.legs[1].time, m.total_time), (1.5, 2.5, 4.0));
    assert_eq!(m.leg_source, LegSource::Executor);
    // At waypoint 1: carried 1 m in +x beyond leg 1's segment. At waypoint 2: nothing.
    assert_eq!(m.overshoots, vec![1.0, 0.0]);
    assert_eq!(m.t_overshoot, 3.0);
    let all = measure(&track, &square(), &Settings::default()).unwrap();
    assert_eq!(all.mean_deviation, (2.0 + 0.5 + 1.0) / 4.0);
}

#[test]
fn what_no_sample_measures_is_open_and_what_is_beyond_numbers_is_refused() {
    let limits = Limits { deviation: Some(1.0), acceleration: Some(1.0), ..Limits::default() };
    // All within the corners, and of two places no acceleration is known.
    let near = track(seconds(2), &[[0.0; 3], [10.0, 0.0, 0.0]], &[]);
    let m = measure(&near, &square(), &Settings { corner: 30.0, ..Settings::default() }).unwrap();
    assert_eq!(
        (m.deviation(), m.acceleration(), limits.unmeasured(&m)),
        (None, None, vec!["deviation", "acceleration"])
    );
    assert_eq!(
        limits.open(&m).as_deref(),
        Some("nothing that `spec` limits was measured: no deviation, no acceleration")
    );
    let m = measure(&near, &square(), &Settings::default()).unwrap();
    assert_eq!((m.deviation(), limits.unmeasured(&m)), (Some(0.0), vec!["acceleration"]));
    let refused = |track: &Track, settings: &Settings| measure(track, &square(), settings).unwrap_err().to_string();
    let soon = track(vec![0.0, 1e-160, 1.0], &[[0.0; 3], [5.0, 0.0, 0.0], [10.0, 0.0, 0.0]], &[]);
    assert!(refused(&soon, &Settings::default()).starts_with("max_acceleration_m_s2 = inf: must be finite"));
    let far = track(seconds(3), &[[0.0; 3], [1e300, -1e300, 0.0], [10.0, 0.0, 0.0]], &[]);
    assert!(refused(&far, &Settings::default()).starts_with("max_deviation_m = inf: must be finite"));
    let unknown = |p: &Point3<f64>| if p.x > 5.0 { f64::NAN } else { 1.0 };
    let settings = Settings { clearance: Some(&unknown), ..Settings::default() };
    assert!(refused(&near, &settings).starts_with("clearance = NaN at sample 1"));
    // In an obstacle, however deep, is not without one.
    let inside = |p: &Point3<f64>| if p.x > 5.0 { f64::NEG_INFINITY } else { f64::INFINITY };
    let m = measure(&near, &square(), &Settings { clearance: Some(&inside), ..Settings::default() }).unwrap();
    assert_eq!((m.min_clearance, m.t_clearance), (Some(f64::NEG_INFINITY), 1.0));
}

#[test]
fn the_second_definition_takes_the_nearer_of_two_legs() {
    // Leg 1 was announced early, still 3 m before the corner on leg 0.
    let positions = [[0.0, 0.0, 0.0], [7.0, 0.0, 0.0], [10.0, 4.0, 0.0]];
    let track = track(seconds(3), &positions, &[("leg", vec![0.0, 1.0, 1.0])]);
    let by = |reference| measure(&track, &square(), &Settings { reference, ..Settings::default() }).unwrap();
    assert_eq!(by(Reference::Leg).max_deviation, 3.0);
    assert_eq!(by(Reference::NearestLeg).max_deviation, 0.0);
}

/// The path leads round: half of its first leg lies nearer to the straight line of the second.
#[test]
fn legs_of_a_track_beside_a_path_are_those_of_the_path() {
    let waypoints = [[0.0; 3], [10.0, 0.0, 0.0], [5.0, 10.0, 0.0]].map(Point3::from);
    let way = [[0.0; 3], [5.0, 8.0, 0.0], [10.0, 0.0, 0.0], [20.0, 5.0, 0.0], [5.0, 10.0, 0.0]];
    let path = track(seconds(5), &way, &[("leg", vec![0.0, 0.0, 1.0, 1.0, 1.0])]);
    let positions = [[0.0; 3], [2.5, 4.0, 0.0], [5.0, 8.0, 0.0], [7.5, 4.0, 0.0], [15.0, 2.5, 0.0], [5.0, 10.0, 0.0]];
    let flown = track(seconds(6), &positions, &[]);
    let by = |reference: Reference<'_>| {
        legs_of_samples(&flown, &waypoints, &Settings { reference, ..Settings::default() }).unwrap()
    };
    assert_eq!(by(Reference::Path(&path)), [0, 0, 0, 0, 1, 1]);
    assert_eq!(by(Reference::Leg)[3], 1);
    // A path that tells no leg, or one that there is not, leaves them to the straight lines.
    for channels in [vec![], vec![("leg", vec![0.0, 0.0, 1.0, 3.0, 3.0])]] {
        assert_eq!(by(Reference::Path(&track(seconds(5), &way, &channels))), by(Reference::Leg));
    }
}

#[test]
fn going_straight_on_is_no_overshoot_but_reversing_late_is() {
    let straight = [[0.0; 3], [10.0, 0.0, 0.0], [20.0, 0.0, 0.0]].map(Point3::from);
    let positions = [[0.0; 3], [11.0, 0.0, 0.0], [20.5, 0.0, 0.0]];
    let flown = track(seconds(3), &positions, &[("leg", vec![0.0, 1.0, 1.0])]);
    assert_eq!(measure(&flown, &straight, &Settings::default()).unwrap().overshoots, vec![0.0, 0.5]);
    let back = [[0.0; 3], [10.0, 0.0, 0.0], [0.0, 0.0, 0.0]].map(Point3::from);
    let positions = [[0.0; 3], [13.0, 0.0, 0.0], [5.0, 0.0, 0.0], [-1.0, 0.0, 0.0]];
    let flown = track(seconds(4), &positions, &[("leg", vec![0.0, 1.0, 1.0, 1.0])]);
    assert_eq!(measure(&flown, &back, &Settings::default()).unwrap().overshoots, vec![3.0, 1.0]);
}

/// Rests at waypoint 1, turns back, and is 0.4 m to the side 5 m along the next leg: that is deviation. Who comes at
/// speed and swings out is carried on.
#[test]
fn who_rests_at_a_waypoint_and_strays_later_is_not_carried_on() {
    let waypoints = [[0.0; 3], [10.0, 0.0, 0.0], [1.0, -4.0, 0.0]].map(Point3::from);
    let smooth = |s: f64| s * s * s * (10.0 - 15.0 * s + 6.0 * s * s);
    let flown = |aside: f64, carried: f64| {
        let (mut positions, mut legs) = (Vec::new(), Vec::new());
        for k in 0..800_u32 {
            let (leg, s) = (k / 400, f64::from(k % 400) / 400.0);
            let [a, b] = [leg, leg + 1].map(|at| waypoints[at as usize]);
            let bump = 64.0 * (s * (1.0 - s)).powi(3);
            let across =
                if leg == 1 { aside * bump * Vector3::new(-4.0, 9.0, 0.0).normalize() } else { Vector3::zeros() };
            // Soon after the corner, while the next leg has hardly begun.
            let on = if leg == 1 { carried * libm::exp(-((s - 0.1) / 0.03).powi(2)) } else { 0.0 };
            let place = a + (b - a) * smooth(s) + across + Vector3::new(on, 0.0, 0.0);
            positions.push([place.x, place.y, place.z]);
            legs.push(f64::from(leg));
        }
        let times = (0..800).map(|i| 0.02 * f64::from(i)).collect();
        measure(&track(times, &positions, &[("leg", legs)]), &waypoints, &Settings::default()).unwrap()
    };
    let strays = flown(-0.4, 0.0);
    assert!(strays.max_overshoot() < 0.01 && (strays.max_deviation - 0.4).abs() < 1e-3, "{:?}", strays.overshoots);
    let carried = flown(0.0, 0.8);
    assert!((0.6..0.85).contains(&carried.overshoots[0]), "{:?}", carried.overshoots);
    // What is between two samples is held to the same.
    let far = Point3::new(5.8, -2.27, 0.0);
    let around = |within: f64| between::Around { places: std::slice::from_ref(&far), within };
    assert!(beyond(&waypoints, &far, 1, around(0.05)) < 0.0 && beyond(&waypoints, &far, 1, around(2.0)) > 0.1);
}

/// 0.9 m/s² in the numbers of a file with three decimals, 250 rows a second: differences of neighbours are 88 m/s².
#[test]
fn rounding_is_no_acceleration() {
    let flown = |rate: f64, decimals: i32, sway: f64, velocities: bool| {
        let round = |x: f64| (x * 10_f64.powi(decimals)).round() / 10_f64.powi(decimals);
        let (omega, count) = (4.0 * std::f64::consts::PI, (8.0 * rate) as usize);
        let times: Vec<f64> = (0..=count).map(|i| i as f64 / rate).collect();
        let place = |t: &f64| {
            let [x, y, z] = [10.0 - 10.0 * (0.3 * t).cos(), 0.1 * t, sway * (omega * t).sin()];
            if velocities { [x, y, z] } else { [x, y, z].map(round) }
        };
        let positions: Vec<_> = times.iter().map(place).collect();
        let speed = |axis: usize| -> Vec<f64> {
            let of = |t: &f64| [3.0 * (0.3 * t).sin(), 0.1, sway * omega * (omega * t).cos()][axis];
            times.iter().map(of).map(round).collect()
        };
        let channels: Vec<(&str, Vec<f64>)> =
            if velocities { vec![("vx_m_s", speed(0)), ("vy_m_s", speed(1)), ("vz_m_s", speed(2))] } else { vec![] };
        let track = track(times, &positions, &channels);
        let settings = Settings { resolution: Resolution::of(&track), ..Settings::default() };
        let way = [[0.0; 3], [20.0, 0.8, 0.0]].map(Point3::from);
        let blind = measure(&track, &way, &Settings::default()).unwrap();
        let found = measure(&track, &way, &settings).unwrap();
        let broken = |limit: f64| {
            let flight =
                Flight { track: track.clone(), ended: Ended::Done, left_world: None, reached: vec![Some(0.0); 2] };
            let limits = Limits { acceleration: Some(limit), ..Limits::default() };
            !violations(&found, &flight, &limits).is_empty()
        };
        let [low, high] = [2.0, 0.85].map(broken);
        (found.acceleration_unresolved.unwrap(), found.max_acceleration, blind.max_acceleration, low, high)
    };
    for (rate, decimals, velocities) in
        [(50.0, 3, false), (100.0, 3, false), (250.0, 3, false), (250.0, 4, false), (250.0, 2, true)]
    {
        let (unresolved, most, blind, low, high) = flown(rate, decimals, 0.0, velocities);
        assert!(blind > 2.0 || velocities, "{rate} {decimals}: {blind}");
        assert!((most - 0.9).abs() < 0.1 && unresolved.by < 0.12, "{rate} {decimals}: {most} {unresolved:?}");
        assert!(!low && !unresolved.decides(most, 2.0) && (high || unresolved.decides(most, 0.85)));
    }
    // A sway of 7.9 m/s² is seen in the same numbers.
    for velocities in [false, true] {
        let (unresolved, most, _, low, _) = flown(250.0, 3, 0.05, velocities);
        assert!(low && most - unresolved.by > 5.0 && most + unresolved.by > 7.0, "{most} {unresolved:?}");
    }
    // A centimetre 0.25 s apart can make half a metre a second squared: a limit within that is open.
    let (unresolved, most, ..) = flown(50.0, 2, 0.0, false);
    assert!(unresolved.decides(most, 0.95) && unresolved.by > 0.4, "{most} {unresolved:?}");
    assert!(
        unresolved.in_words(AccelerationSource::Position).starts_with("positions are told in steps of 0.01 m: 0.2")
    );
}

#[test]
fn without_leg_channel_the_assignment_is_monotone_along_the_path() {
    // There and back twice over the same segment, 0.3 m beside it, then a crossing of the first leg.
    let waypoints = [[0.0; 3], [8.0, 0.0, 0.0], [0.0; 3], [8.0, 0.0, 0.0], [4.0, 5.0, 0.0], [4.0, -5.0, 0.0]];
    let waypoints = waypoints.map(Point3::from);
    let (mut positions, mut truth) = (Vec::new(), Vec::new());
    for (leg, ends) in waypoints.windows(2).enumerate() {
        for k in 0..20 {
            let p = ends[0] + (ends[1] - ends[0]) * ((k as f64 + 0.5) / 20.0) + Vector3::z() * 0.3;
            positions.push([p.x, p.y, p.z]);
            truth.push(leg as f64);
        }
    }
    let told = track(seconds(100), &positions, &[("leg", truth)]);
    let expected = measure(&told, &waypoints, &Settings::default()).unwrap();
    let found = measure(&track(seconds(100), &positions, &[]), &waypoints, &Settings::default()).unwrap();
    assert_eq!(found.leg_source, LegSource::Assigned);
    assert!((found.max_deviation - 0.3).abs() < 1e-12);
    for (leg, (found, expected)) in found.legs.iter().zip(&expected.legs).enumerate() {
        assert!((found.time - expected.time).abs() < 1.01, "leg {leg}: {} s, {} s", found.time, expected.time);
    }
}

#[test]
fn a_crossing_is_not_a_shortcut() {
    // Cutting from leg 0 over to where leg 2 crosses it: nearest-leg assignment would see no deviation at the crossing.
    let waypoints = [[0.0; 3], [10.0, 0.0, 0.0], [5.0, 8.0, 0.0], [5.0, -8.0, 0.0]].map(Point3::from);
    let positions: Vec<[f64; 3]> = (0..=50).map(|k| [0.2 * k as f64, 0.0, 0.0]).collect();
    let found = measure(&track(seconds(51), &positions, &[]), &waypoints, &Settings::default()).unwrap();
    assert!(found.max_deviation < 1e-12 && found.legs[0].time > 48.0, "{:?}", found.legs);
}

#[test]
fn a_programmed_path_is_followed_in_order() {
    // A figure of eight; the flight is 0.2 m above it and 0.5 m off at one place.
    let eight = |s: f64| [4.0 * s.sin(), 3.0 * (2.0 * s).sin(), 2.0];
    let place = |k: usize, n: usize| eight(std::f64::consts::TAU * k as f64 / n as f64);
    let path = track(seconds(3001), &(0..=3000).map(|k| place(k, 3000)).collect::<Vec<_>>(), &[]);
    let mut positions: Vec<[f64; 3]> = (0..=400).map(|k| place(k, 400)).collect();
    positions.iter_mut().for_each(|p| p[2] += 0.2);
    positions[130][2] += 0.3;
    let flown = track(seconds(401), &positions, &[]);
    let settings = Settings { reference: Reference::Path(&path), ..Settings::default() };
    let found = measure(&flown, &[place(0, 8), place(2, 8), place(8, 8)].map(Point3::from), &settings).unwrap();
    assert!((found.max_deviation - 0.5).abs() < 1e-3 && found.t_worst == 130.0, "{found:?}");
    assert!((found.mean_deviation - 0.2).abs() < 2e-3, "{}", found.mean_deviation);
    // What curves as it was programmed overshoots nothing, however far beyond straight legs that is.
    let exact = track(seconds(401), &(0..=400).map(|k| place(k, 400)).collect::<Vec<_>>(), &[]);
    let corners = [place(0, 8), place(2, 8), place(8, 8)].map(Point3::from);
    let along = measure(&exact, &corners, &settings).unwrap().max_overshoot();
    let straight = measure(&exact, &corners, &Settings::default()).unwrap().max_overshoot();
    assert!(along < 1e-3 && straight > 1.0, "{along} {straight}");
}

/// A drive that crosses itself, reverses out of a cusp along nearly the same ground, and turns in place, as poses 2 cm
/// apart.
fn drive_path() -> Vec<[f64; 3]> {
    let mut places = vec![];
    let mut at = [0.0, 0.0, 0.0_f64];
    let mut go = |metres: f64, curvature: f64, sign: f64| {
        for _ in 0..(metres / 0.02).round() as usize {
            at[2] += 0.02 * sign * curvature;
            at = [at[0] + 0.02 * sign * at[2].cos(), at[1] + 0.02 * sign * at[2].sin(), at[2]];
            places.push(at);
        }
    };
    go(3.0, 0.0, 1.0);
    go(0.75 * std::f64::consts::TAU, 1.0, 1.0); // three quarters of a circle, and over its own first line
    go(2.0, 0.0, 1.0);
    go(2.0, 0.05, -1.0); // back over it
    // A turn in place: poses that do not move.
    let still = places[places.len() - 1];
    places.extend([still; 40]);
    for k in 1..100 {
        places.push([still[0] - 0.02 * f64::from(k), still[1], 0.0]);
    }
    places
}

#[test]
fn drives_are_judged_in_the_order_of_their_path() {
    let path = drive_path();
    let n = path.len();
    let places = |off: &dyn Fn(usize) -> f64| -> Vec<[f64; 3]> {
        (0..n).map(|i| [path[i][0], path[i][1], 0.05 + off(i)]).collect()
    };
    let planned = track(seconds(n), &places(&|_| -0.05), &[]);
    let waypoints = [path[0], path[n - 1]].map(|p| Point3::new(p[0], p[1], 0.0));
    let judged = |positions: &[[f64; 3]]| {
        let settings = Settings { reference: Reference::Path(&planned), ..Settings::default() };
        measure(&track(seconds(positions.len()), positions, &[]), &waypoints, &settings).unwrap()
    };
    // 5 cm off all along, 30 cm at one sample of each part: in the crossing, at the cusp, in the turn, at the end.
    let cusp = (3.0_f64 / 0.02) as usize + 235 + 100;
    for worst in [150 + 235 + 50, cusp, n - 99 - 20, n - 1] {
        let found = judged(&places(&|i| if i == worst { 0.25 } else { 0.0 }));
        assert!((found.max_deviation - 0.3).abs() < 1e-3, "{worst}: {}", found.max_deviation);
        assert_eq!(found.t_worst, worst as f64);
        assert!((found.mean_deviation - 0.05).abs() < 2e-3, "{}", found.mean_deviation);
    }
    // Cutting over at the crossing leaves out the loop and is never far from the path.
    let loopless: Vec<[f64; 3]> = (0..n).filter(|i| !(100..385).contains(i)).map(|i| places(&|_| 0.0)[i]).collect();
    assert!(judged(&loopless).max_deviation < 0.06);
    // Staying at the cusp is none either: that the rest was not driven is for `unfinished` to say.
    let mut stays = places(&|_| 0.0);
    let there = stays[cusp];
    stays[cusp..].fill(there);
    assert!((judged(&stays).max_deviation - 0.05).abs() < 1e-3);
    // Going backwards along the path is.
    let mut reversed = places(&|_| 0.0);
    reversed[..150].reverse();
    assert!(judged(&reversed).max_deviation > 1.0);
}

#[test]
fn the_tip_over_margin_is_the_least_and_a_lower_limit() {
    let positions = [[0.0; 3], [5.0, 0.0, 0.0], [10.0, 5.0, 0.0]];
    let channels = [("leg", vec![0.0, 0.0, 1.0]), ("tip_over_margin_deg", vec![30.0, 7.2, 9.0])];
    let flown = track(seconds(3), &positions, &channels);
    let m = measure(&flown, &square(), &Settings::default()).unwrap();
    assert_eq!((m.min_tip_over_margin, m.t_tip_over_margin), (Some(7.2), 1.0));
    assert_eq!(m.legs.iter().map(|l| l.min_tip_over_margin).collect::<Vec<_>>(), [Some(7.2), Some(9.0)]);
    assert_eq!((m.saturation_share, m.min_clearance), (None, None));
    let flight = |ended| Flight { track: flown.clone(), ended, left_world: None, reached: vec![Some(0.0); 3] };
    let limits = |margin| Limits { tip_over_margin: Some(margin), ..Limits::default() };
    let found = violations(&m, &flight(Ended::Done), &limits(10.0));
    let violation =
        Violation { what: "tip-over-margin".into(), value: 7.2, limit: 10.0, unit: "°".into(), at: 1.0, leg: 0 };
    assert_eq!(found, [violation]);
    assert!(violations(&m, &flight(Ended::Done), &limits(7.0)).is_empty());
    let ends = [Ended::TipOver, Ended::BellyContact, Ended::Stuck, Ended::OffMap];
    for (ended, word) in ends.into_iter().zip(["tip-over", "belly-contact", "stuck", "off-map"]) {
        let found = violations(&m, &flight(ended), &limits(10.0));
        assert_eq!(found.iter().map(|v| v.what.as_str()).collect::<Vec<_>>(), [word, "tip-over-margin"]);
        assert!(found[0].is_crash() && found[0].event().is_some() && found[1].event().is_none());
    }
    let unknown = track(seconds(3), &positions, &[]);
    assert_eq!(measure(&unknown, &square(), &Settings::default()).unwrap().min_tip_over_margin, None);
}

#[test]
fn tilt_is_the_angle_of_the_upward_axis_and_neither_heading_nor_a_tool_s() {
    // Yawed by any angle, then leaned by a known one about a level axis.
    let (yaws, leans) = ([0.3, 2.0, -1.2, 0.5], [10.0_f64, 35.0, 20.0, 179.0]);
    let flown = |channels: &[(&str, Vec<f64>)]| {
        let poses = yaws.iter().zip(leans).enumerate().map(|(i, (yaw, lean))| {
            let about = UnitQuaternion::from_axis_angle(&Vector3::z_axis(), *yaw)
                * UnitQuaternion::from_axis_angle(
                    &Unit::new_normalize(Vector3::new(0.6, -0.8, 0.0)),
                    lean.to_radians(),
                );
            Isometry3::from_parts([i as f64, 0.0, 0.0].into(), about)
        });
        let channels = channels.iter().map(|(name, values)| Channel { name: (*name).into(), values: values.clone() });
        let leg = Channel { name: "leg".into(), values: vec![0.0, 0.0, 1.0, 1.0] };
        Track::new(seconds(4), poses.collect(), channels.chain([leg]).collect()).unwrap()
    };
    let told = |channels: &[(&str, Vec<f64>)]| measure(&flown(channels), &square(), &Settings::default()).unwrap();
    let m = told(&[]);
    assert!((m.max_tilt.unwrap() - 179.0).abs() < 1e-9 && m.t_tilt == 3.0, "{:?}", m.max_tilt);
    let legs: Vec<f64> = m.legs.iter().map(|leg| leg.max_tilt.unwrap()).collect();
    assert!((legs[0] - 35.0).abs() < 1e-12 && (legs[1] - 179.0).abs() < 1e-9, "{legs:?}");
    assert_eq!((Stress::Tilt.of(&m), Stress::Tilt.worst_leg(&m)), (m.max_tilt, Some(1)));
    // What stands on the ground is told by how near it is to toppling.
    let m = told(&[("tip_over_margin_deg", vec![30.0, 7.2, 9.0, 8.0])]);
    assert_eq!((Stress::Tilt.of(&m), Stress::Tilt.worst_leg(&m)), (Some(-7.2), Some(0)));
    for no_body in ["q1_rad", ATTITUDE_UNKNOWN] {
        let m = told(&[(no_body, vec![1.0; 4])]);
        assert_eq!((m.max_tilt, m.legs[0].max_tilt, Stress::Tilt.of(&m)), (None, None, None), "{no_body}");
    }
}

#[test]
fn joint_effort_is_the_integral_of_squared_joint_accelerations() {
    // q1 = t², q2 = 3 sin t: ∫ q̈² dt is 4 T and 9 (T/2 − sin 2T/4); sampled unevenly.
    let (end, count) = (6.0_f64, 1201);
    let times: Vec<f64> =
        (0..count).map(|i| end * (f64::from(i) + 0.3 * f64::from(i % 2)) / f64::from(count - 1)).collect();
    let positions: Vec<[f64; 3]> = times.iter().map(|t| [t / 0.6, 0.0, 0.0]).collect();
    let of = |q: fn(f64) -> f64| times.iter().map(|t| q(*t)).collect::<Vec<f64>>();
    let leg = of(|t| f64::from(u8::from(t >= 3.0)));
    let channels = [("leg", leg), ("q1_rad", of(|t| t * t)), ("q2_rad", of(|t| 3.0 * t.sin()))];
    let m = measure(&track(times.clone(), &positions, &channels), &square(), &Settings::default()).unwrap();
    let until = |t: f64| 4.0 * t + 9.0 * (0.5 * t - 0.25 * (2.0 * t).sin());
    let (first, all) = (until(3.0), until(end));
    let [found, second] = [0, 1].map(|leg| m.legs[leg].joint_effort.unwrap());
    assert!((found / first - 1.0).abs() < 5e-3, "{found}, not {first}");
    assert!((second / (all - first) - 1.0).abs() < 5e-3, "{second}, not {}", all - first);
    assert!((m.joint_effort.unwrap() - found - second).abs() < 1e-9);
    let flown = track(seconds(3), &[[0.0; 3]; 3], &[]);
    assert_eq!(measure(&flown, &square(), &Settings::default()).unwrap().joint_effort, None);
}

#[test]
fn accelerations_by_velocity_and_by_position() {
    // A circle: ‖a‖ = ω² r, and the speed does not change.
    let (radius, omega, step) = (2.0, 1.5, 0.01);
    let at = |i: usize| omega * step * i as f64;
    let times: Vec<f64> = (0..400).map(|i| step * i as f64).collect();
    let positions: Vec<[f64; 3]> = (0..400).map(|i| [radius * at(i).cos(), radius * at(i).sin(), 0.0]).collect();
    let waypoints = square();
    let vx = (0..400).map(|i| -radius * omega * at(i).sin()).collect();
    let vy = (0..400).map(|i| radius * omega * at(i).cos()).collect();
    let channels = [("vx_m_s", vx), ("vy_m_s", vy), ("vz_m_s", vec![0.0; 400])];
    for (channels, source) in [(&channels[..], AccelerationSource::Velocity), (&[][..], AccelerationSource::Position)] {
        let m = measure(&track(times.clone(), &positions, channels), &waypoints, &Settings::default()).unwrap();
        assert_eq!(m.acceleration_source, source);
        assert!((m.max_acceleration - omega * omega * radius).abs() < 1e-3, "{source:?}: {}", m.max_acceleration);
        assert!(m.max_speed_rate < 1e-6, "{source:?}: {}", m.max_speed_rate);
    }
    // Braking straight: both definitions agree, also on uneven stamps.
    let times = vec![0.0, 0.1, 0.3, 0.35];
    let positions: Vec<[f64; 3]> = times.iter().map(|t| [5.0 * t - 2.0 * t * t, 0.0, 0.0]).collect();
    let vx: Vec<f64> = times.iter().map(|t| 5.0 - 4.0 * t).collect();
    let channels = [("vx_m_s", vx), ("vy_m_s", vec![0.0; 4]), ("vz_m_s", vec![0.0; 4])];
    let m = measure(&track(times, &positions, &channels), &waypoints, &Settings::default()).unwrap();
    assert!((m.max_acceleration - 4.0).abs() < 1e-9 && (m.max_speed_rate - 4.0).abs() < 1e-9);
}

#[test]
fn clearance_and_saturation() {
    let positions = [[0.0; 3], [5.0, 0.0, 0.0], [10.0, 5.0, 0.0]];
    let channels = [("leg", vec![0.0, 0.0, 1.0]), ("saturated", vec![1.0, 0.5, 0.0])];
    let flown = track(vec![0.0, 1.0, 4.0], &positions, &channels);
    let mast = |p: &Point3<f64>| (p - Point3::new(5.0, 3.0, 0.0)).norm() - 1.0;
    let settings = Settings { clearance: Some(&mast), ..Settings::default() };
    let m = measure(&flown, &square(), &settings).unwrap();
    assert_eq!((m.min_clearance, m.t_clearance), (Some(2.0), 1.0));
    assert_eq!(m.legs[1].min_clearance, Some((25.0f64 + 4.0).sqrt() - 1.0));
    assert_eq!(m.saturation_share, Some((0.5 + 0.5 * 2.0) / 4.0));
    assert_eq!(m.legs[1].saturation_share, Some(0.0));
    let open = |_: &Point3<f64>| f64::INFINITY;
    let none = measure(&flown, &square(), &Settings { clearance: Some(&open), ..Settings::default() }).unwrap();
    assert_eq!(none.min_clearance, None);
}

#[test]
fn bad_input_is_told_not_suffered() {
    let one = track(vec![0.0], &[[1.0, 1.0, 0.0]], &[]);
    let m = measure(&one, &square(), &Settings::default()).unwrap();
    assert_eq!((m.max_deviation, m.mean_deviation, m.total_time, m.max_acceleration), (1.0, 1.0, 0.0, 0.0));
    assert_eq!(measure(&one, &square()[..1], &Settings::default()), Err(JudgementError::Waypoints { found: 1 }));
    assert_eq!(measure(&Track::default(), &square(), &Settings::default()), Err(JudgementError::NoSamples));
    for bad in [-1.0, 0.5, 3.0, 1e300] {
        let told = track(vec![0.0], &[[0.0; 3]], &[("leg", vec![bad])]);
        assert!(matches!(measure(&told, &square(), &Settings::default()), Err(JudgementError::Leg { last: 1, .. })));
    }
    let nan = [Point3::origin(), Point3::new(f64::NAN, 0.0, 0.0)];
    let error = measure(&one, &nan, &Settings::default()).unwrap_err();
    assert!(error.to_string().starts_with("waypoints[1] = [NaN"), "{error}");
    let still = [Point3::origin(); 3];
    assert_eq!(measure(&one, &still, &Settings::default()).unwrap().overshoots, vec![0.0, 0.0]);
    assert!(measure(&one, &square(), &Settings { corner: f64::NAN, ..Settings::default() }).is_err());
}

#[test]
fn violations_come_gravest_first() {
    let positions = [[0.0; 3], [5.0, -2.0, 0.0], [10.0, 0.0, 0.0]];
    let flown = track(seconds(3), &positions, &[("leg", vec![0.0, 0.0, 1.0])]);
    let mast = |p: &Point3<f64>| (p - Point3::new(5.0, -2.5, 0.0)).norm() - 0.4;
    let measures = measure(&flown, &square(), &Settings { clearance: Some(&mast), ..Settings::default() }).unwrap();
    let flight = |ended, left_world| Flight {
        track: flown.clone(),
        ended,
        left_world,
        reached: vec![Some(0.0), Some(2.0), None],
    };
    let limits = Limits { deviation: Some(1.9), clearance: Some(0.3), total_time: Some(1.0), ..Limits::default() };
    let what = |ended, left| {
        let found = violations(&measures, &flight(ended, left), &limits);
        found.into_iter().map(|v| v.what).collect::<Vec<_>>()
    };
    // An executor's "done" does not make up for a last waypoint that was never reached.
    assert_eq!(what(Ended::Done, None), ["unfinished", "total-time", "clearance", "deviation"]);
    assert_eq!(what(Ended::Ground, Some(1.0)), ["crash", "left-world", "total-time", "clearance", "deviation"]);
    assert_eq!(what(Ended::Time, None)[0], "unfinished");
    let found = violations(&measures, &flight(Ended::Time, Some(1.0)), &limits);
    assert_eq!((found[0].what.as_str(), found[0].at, found[0].leg), ("left-world", 1.0, 0));
    assert_eq!((found[1].value, found[1].limit, found[1].leg), (2.0, 3.0, 1));
    // Nine seconds more at the last place, a waypoint short, are no end by time: it stands still.
    let still = |step: f64| {
        let flown: Vec<[f64; 3]> = (0..10).map(|n| [5.0 + step * f64::from(n), -2.0, 0.0]).collect();
        let flown = Flight { track: track(seconds(10), &flown, &[]), ..flight(Ended::Time, None) };
        let found = violations(&measures, &flown, &Limits::default());
        (found[0].what.clone(), found[0].at, found[0].event())
    };
    let words = |words: &str| Some(format!("{words} after 2 of 3 waypoints"));
    assert_eq!(still(0.0), ("stalled".into(), 0.0, words("stood still")));
    assert_eq!(still(0.018), ("stalled".into(), 4.0, words("stood still")));
    assert_eq!((still(0.03).0.as_str(), still(0.03).1), ("unfinished", 9.0));
    let lenient = Limits { unfinished: false, ..Limits::default() };
    assert!(violations(&measures, &flight(Ended::Time, None), &lenient).is_empty());
}

/// A run within spec is told by what came nearest to a limit, whatever that limits.
#[test]
fn what_comes_nearest_to_its_limit_is_found() {
    let legs = vec![LegMeasures { max_acceleration: 4.0, min_clearance: Some(0.6), ..LegMeasures::default() }];
    let measures = Measures {
        max_acceleration: 4.0,
        min_clearance: Some(0.6),
        t_clearance: 2.5,
        total_time: 9.0,
        legs,
        ..Measures::default()
    };
    let told = |limits: Limits| nearest(&measures, &limits).map(|one| (one.what, one.value, one.limit, one.at));
    assert_eq!(told(Limits::default()), None);
    assert_eq!(told(Limits { tip_over_margin: Some(5.0), ..Limits::default() }), None, "it was not measured");
    // 60 % of 15 s, and 80 % of 5 m/s²; a clearance a fifth above its limit.
    let limits = Limits { acceleration: Some(5.0), total_time: Some(15.0), ..Limits::default() };
    assert_eq!(told(limits), Some(("acceleration".into(), 4.0, 5.0, measures.t_acceleration)));
    let limits = Limits { clearance: Some(0.55), ..limits };
    assert_eq!(told(limits), Some(("clearance".into(), 0.6, 0.55, 2.5)));
}
