//! What may hide between the samples of a program's run: who flies it samples as he likes, and five poses of a flight
//! keep any limit.
//!
//! Bounded as what hides in a log is ([`look_closely`], [`most_anywhere`]). Our own simulators sample as their
//! integration goes, and nothing is asked of them.

use std::borrow::Cow;

use nalgebra::Point3;

use super::Setup;
use super::missed::radii;
use crate::judgement::{
    JudgementError, Limits, Measures, Reference, Resolution, SEEN_WITHIN_S, Settings, Swiftness, beyond, is_seen,
    longest_mean, look_closely, measure, most_anywhere, repeats, told, told_outward,
};
use crate::trajectory::Track;

/// Measures a track and, where a program of the user's told it, what may hide between its samples: the largest
/// deviation and overshoot, the smallest clearance, and how long its accelerations are means over; and how near it came
/// to each waypoint.
///
/// Poses that repeat a place while it moves on ([`repeats`]) are none.
///
/// Of what nothing bounds how suddenly it turns (drives, boats) the straight line between two samples is looked along:
/// the robot came from one to the other. A model's top speed is no bound of another simulator's.
pub(super) fn sampled(
    setup: &Setup,
    track: &Track,
    waypoints: &[Point3<f64>],
    settings: &Settings,
) -> Result<Measures, JudgementError> {
    // Programs of arms are looked at move by move.
    if setup.program().is_none() || setup.has_programs() {
        return measure(track, waypoints, settings);
    }
    let resolution = Resolution::of(track);
    let settings = &Settings { resolution, ..*settings };
    let apart = |i: usize, j: usize| (track.position(j) - track.position(i)).norm();
    let stale = repeats(track.times(), &apart, resolution.place.all);
    let new: Vec<usize> = (0..track.len()).filter(|&i| !stale[i]).collect();
    let track = &if new.len() < track.len() { Cow::Owned(track.only(&new)) } else { Cow::Borrowed(track) };
    let mut measures = measure(track, waypoints, settings)?;
    measures.waypoints_within = radii(track, waypoints);
    let acceleration = setup.swiftness().acceleration;
    let swiftness = Swiftness { speed: None, acceleration: Some(acceleration.unwrap_or(0.0)) };
    let close = look_closely(track, waypoints, settings, &swiftness, 0.0)?;
    // What rounding has moved the poses by is hidden as well.
    let moved = measures.place_unresolved.unwrap_or(0.0);
    let most = close.iter().filter_map(|close| close.until_next).reduce(f64::max).map(|most| most + moved);
    measures.most_between = most.filter(|most| most.is_finite());
    let overshoot = match settings.reference {
        // Where on a path a robot belongs between two samples nobody knows: as far as at these, and what it bulges.
        Reference::Path(_) => {
            let steps = track.times().windows(2).map(|pair| swiftness.bulge(pair[1] - pair[0], 0.0));
            measures.max_overshoot() + steps.fold(0.0, f64::max)
        }
        _ => most_anywhere(track, &close, settings, &swiftness, &|p, leg, around| beyond(waypoints, p, leg, around))
            .max(0.0),
    };
    measures.overshoot_between = Some(overshoot + moved).filter(|most| most.is_finite());
    let nearest = |clearance: &dyn Fn(&Point3<f64>) -> f64| {
        -most_anywhere(track, &close, settings, &swiftness, &|p, _, _| -clearance(p))
    };
    measures.clearance_between =
        settings.clearance.map(|clearance| nearest(clearance) - moved).filter(|least| least.is_finite());
    measures.edge_between = nearest_edge(setup, track, &swiftness).map(|within| {
        // As far as it is exact, so that it changes by no more than the way.
        nearest(&|p: &Point3<f64>| setup.edge_distance(p, within).min(within))
    });
    let is_mean = measures.acceleration().is_some() || acceleration.is_none();
    measures.acceleration_over = is_mean.then(|| longest_mean(track, settings));
    Ok(measures)
}

/// How far (m) a motion between two samples goes at most, where the world's edge may be as near to one.
fn nearest_edge(setup: &Setup, track: &Track, swiftness: &Swiftness) -> Option<f64> {
    let step = |i: usize| {
        let chord = (track.position(i + 1) - track.position(i)).norm();
        chord + swiftness.bulge(track.times()[i + 1] - track.times()[i], chord)
    };
    let most = (0..track.len().saturating_sub(1)).map(step).fold(0.0, f64::max);
    let is_near = |i: usize| setup.edge_distance(&track.position(i), most) < most;
    (most.is_finite() && (0..track.len()).any(is_near)).then_some(most)
}

/// Why the samples do not decide that `limits` are kept which they keep: what may hide between them, and how many would
/// decide.
///
/// What runs into an obstacle violates whatever is limited, so that where there are limits one that may have been met
/// leaves all of them open.
pub(super) fn hidden(setup: &Setup, measures: &Measures, limits: &Limits) -> Option<String> {
    let rate = |margin: f64| {
        let rate = setup.swiftness().rate(margin);
        rate.map_or(String::new(), |rate| format!("; {} poses a second decide", rate.ceil()))
    };
    let open = |name: &str, value: f64, limit: f64, most: f64| {
        let (seen, rate) = (told(value, Some(limit), "m"), rate((limit - value).abs()));
        let most = told_outward(most, limit, "m", most < value);
        format!("{name}{seen} m at its poses, but {most} m may hide between two of them{rate}")
    };
    let digits = |name: &str, value: f64, limit: f64, is_lower: bool| {
        let moved = measures.place_unresolved.filter(|moved| (value - limit).abs() <= *moved)?;
        let side = match (value > limit, is_lower) {
            (true, false) => ">",
            (false, false) => "≤",
            (_, true) if value < limit => "<",
            (_, true) => "≥",
        };
        let (seen, limit) = (told(value, Some(limit), "m"), told(limit, Some(value), "m"));
        let moved = told_outward(moved, 0.0, "m", false);
        Some(format!(
            "{name}{seen} {side} {limit} m, but its positions are told in steps that move them by up to {moved} m; more \
             digits decide"
        ))
    };
    let above = |name: &str, limit: Option<f64>, value: f64, most: Option<f64>| {
        let between = |limit: f64| {
            let most = most.filter(|most| value <= limit && *most > limit)?;
            Some(open(name, value, limit, most))
        };
        limit.and_then(|limit| digits(name, value, limit, false).or_else(|| between(limit)))
    };
    let below = |limit: Option<f64>| {
        let (value, limit) = (measures.min_clearance?, limit?);
        let between = || {
            let least = measures.clearance_between.filter(|least| value >= limit && *least < limit)?;
            Some(open("clearance ", value, limit, least))
        };
        digits("clearance ", value, limit, true).or_else(between)
    };
    let contact = || {
        let met = below(Some(0.0).filter(|_| limits.contact && limits.are_given()))?;
        Some(format!("it may have met an obstacle: {met}"))
    };
    let edge = || {
        let least = measures.edge_between.filter(|least| *least < 0.0 && limits.are_given())?;
        let beyond = told_outward(-least, 0.0, "m", false);
        Some(format!(
            "it may have left the world: between two of its poses it may be {beyond} m beyond the edge; more poses a \
             second decide"
        ))
    };
    // What nothing bounds is not known by what it does twice a second.
    let unseen = || {
        let span =
            measures.acceleration_over.filter(|span| setup.swiftness().acceleration.is_none() && !is_seen(*span))?;
        let kept = [
            limits.deviation.filter(|limit| measures.max_deviation <= *limit),
            limits.overshoot.filter(|limit| measures.max_overshoot() <= *limit),
            limits.clearance.filter(|limit| measures.min_clearance.is_some_and(|least| least >= *limit)),
        ];
        kept.into_iter().flatten().next()?;
        Some(format!(
            "its poses are as much as {:.2} s apart, and nothing bounds what it does between them; {} poses a second \
             decide",
            0.5 * span,
            (2.0 / SEEN_WITHIN_S).ceil()
        ))
    };
    let mean = || {
        measures.acceleration()?;
        let span = measures.acceleration_over.filter(|span| !is_seen(*span))?;
        let limit = limits.acceleration.filter(|limit| measures.max_acceleration <= *limit)?;
        let (seen, rate) = (told(measures.max_acceleration, Some(limit), "m/s²"), (2.0 / SEEN_WITHIN_S).ceil());
        Some(format!(
            "acceleration {seen} m/s² is a mean over as much as {span:.2} s, and what is shorter was not seen; {rate} poses \
             a second decide"
        ))
    };
    let rounded = || {
        let (value, limit) = (measures.acceleration()?, limits.acceleration?);
        let unresolved = measures.acceleration_unresolved.filter(|unresolved| unresolved.decides(value, limit))?;
        let side = if value > limit { ">" } else { "≤" };
        let (seen, limit) = (told(value, Some(limit), "m/s²"), told(limit, Some(value), "m/s²"));
        let why = unresolved.in_words(measures.acceleration_source);
        Some(format!("acceleration {seen} {side} {limit} m/s², but its {why}; more digits decide"))
    };
    let all = [
        above("", limits.deviation, measures.max_deviation, measures.most_between),
        above("overshoot ", limits.overshoot, measures.max_overshoot(), measures.overshoot_between),
        below(limits.clearance).or_else(contact),
        edge(),
        unseen(),
        rounded(),
        mean(),
    ];
    let all: Vec<String> = all.into_iter().flatten().collect();
    (!all.is_empty()).then(|| all.join("; "))
}

#[cfg(feature = "unit-tests")]
mod tests {
    use nalgebra::Isometry3;
    use serde_json::json;

    use super::*;
    use crate::campaign::Scenario;
    use crate::campaign::testing::quadrotor;
    use crate::judgement::violations;
    use crate::trajectory::{Channel, Ended, Flight};

    fn setup(command: Option<&str>) -> Setup {
        among(command, json!([]))
    }

    fn among(command: Option<&str>, obstacles: serde_json::Value) -> Setup {
        let scenario: Scenario = serde_json::from_value(json!({
            "hairpin": 1, "robot": quadrotor(), "world": { "size_m": [30.0, 30.0, 30.0], "obstacles": obstacles },
            "task": { "start_m": [3.0, 3.0, 3.0], "end_m": [23.0, 3.0, 3.0], "length": 2 },
            "execute": command.map_or_else(|| json!({}), |command| json!({ "command": command })),
        }))
        .unwrap();
        Setup::new(scenario).unwrap()
    }

    /// Along a leg of 20 m in 10 s, a pose every `step` s: as good as it gets, where one looks.
    fn judged(setup: &Setup, step: f64, limit: f64) -> (Measures, Option<String>) {
        judged_by(setup, step, &Limits { deviation: Some(limit), ..Limits::default() })
    }

    fn judged_by(setup: &Setup, step: f64, limits: &Limits) -> (Measures, Option<String>) {
        let count = (10.0 / step).round() as usize;
        let times: Vec<f64> = (0..=count).map(|i| i as f64 * step).collect();
        let poses = times.iter().map(|t| Isometry3::translation(3.0 + 2.0 * t, 3.0, 3.0)).collect();
        let leg = Channel { name: "leg".into(), values: vec![0.0; times.len()] };
        let track = Track::new(times, poses, vec![leg]).unwrap();
        let way = [Point3::new(3.0, 3.0, 3.0), Point3::new(23.0, 3.0, 3.0)];
        let clearance = setup.kind().clearance();
        let settings = Settings { clearance: clearance.as_deref(), ..Settings::default() };
        let measures = sampled(setup, &track, &way, &settings).unwrap();
        let hidden = hidden(setup, &measures, limits);
        (measures, hidden)
    }

    #[test]
    fn what_is_not_looked_at_is_no_pass() {
        let program = setup(Some("sim"));
        let most = program.swiftness().acceleration.unwrap();
        let (sparse, why) = judged(&program, 2.5, 0.5);
        assert!((sparse.most_between.unwrap() - most * 2.5 * 2.5 / 8.0).abs() < 1e-9, "{sparse:?}");
        let why = why.unwrap();
        let rate = (most / 4.0).sqrt().ceil();
        assert!(why.starts_with("0.00 m at its poses, but ") && why.contains(" m may hide between two"), "{why}");
        assert!(why.contains(&format!("; {rate} poses a second decide; it may have left the world: ")), "{why}");
        // As many as it says, and fifty a second.
        assert_eq!(judged(&program, 1.0 / rate, 0.5).1, None);
        let (dense, why) = judged(&program, 0.02, 0.5);
        assert!(dense.most_between.unwrap() < 0.01 && why.is_none(), "{dense:?}");
        // A violation is one however it is sampled, and our own simulator is not asked.
        let limits = Limits { deviation: Some(0.5), ..Limits::default() };
        assert_eq!(hidden(&program, &Measures { max_deviation: 0.6, edge_between: None, ..sparse }, &limits), None);
        assert_eq!(judged(&setup(None), 2.5, 0.5).0.most_between, None);
    }

    /// 50 poses a second of which 5 are new.
    #[test]
    fn neither_is_a_pose_told_again() {
        let program = setup(Some("sim"));
        let limits = Limits { deviation: Some(0.5), ..Limits::default() };
        let of = |period: f64| {
            let times: Vec<f64> = (0..=500).map(|i| 0.02 * f64::from(i)).collect();
            let at = |t: &f64| Isometry3::translation(3.0 + 2.0 * (t / period + 1e-9).floor() * period, 3.0, 3.0);
            let leg = Channel { name: "leg".into(), values: vec![0.0; times.len()] };
            let track = Track::new(times.clone(), times.iter().map(at).collect(), vec![leg]).unwrap();
            let way = [Point3::new(3.0, 3.0, 3.0), Point3::new(23.0, 3.0, 3.0)];
            let measures = sampled(&program, &track, &way, &Settings::default()).unwrap();
            (measures.most_between.unwrap(), hidden(&program, &measures, &limits))
        };
        let most = judged(&program, 0.5, 0.5).0.most_between.unwrap();
        let (held, why) = of(0.5);
        assert!((held - most).abs() < 1e-9 && why.unwrap().contains("may hide between two of them"), "{held} {most}");
        assert_eq!(of(0.02).1, None);
    }

    /// Poses in whole decimetres, and beside the leg by what that makes of it.
    #[test]
    fn neither_is_what_rounding_may_have_made() {
        let program = setup(Some("sim"));
        let told = |off: f64, digits: f64, limit: f64| {
            let times: Vec<f64> = (0..=500).map(|i| 0.02 * f64::from(i)).collect();
            let round = |x: f64| (x * digits).round() / digits;
            let at = |t: &f64| {
                let aside = off * (0.1 * std::f64::consts::PI * t).sin();
                Isometry3::translation(round(3.0 + 2.0 * t), round(3.0 + aside), 3.0)
            };
            let leg = Channel { name: "leg".into(), values: vec![0.0; times.len()] };
            let track = Track::new(times.clone(), times.iter().map(at).collect(), vec![leg]).unwrap();
            let way = [Point3::new(3.0, 3.0, 3.0), Point3::new(23.0, 3.0, 3.0)];
            let measures = sampled(&program, &track, &way, &Settings::default()).unwrap();
            let limits = Limits { deviation: Some(limit), ..Limits::default() };
            let flight = Flight { track, ended: Ended::Done, left_world: None, reached: vec![Some(0.0), Some(10.0)] };
            (violations(&measures, &flight, &limits).len(), hidden(&program, &measures, &limits))
        };
        let (broken, why) = told(0.44, 10.0, 0.42);
        let words =
            "0.40 ≤ 0.42 m, but its positions are told in steps that move them by up to 0.09 m; more digits decide";
        assert_eq!((broken, why.as_deref()), (0, Some(words)));
        let (broken, why) = told(0.46, 10.0, 0.48);
        assert!(broken == 0 && why.is_some_and(|why| why.starts_with("0.50 > 0.48 m, but its positions")));
        assert_eq!(told(0.66, 10.0, 0.48), (1, None));
        assert_eq!(told(0.26, 10.0, 0.48), (0, None));
        assert_eq!((told(0.44, 1e5, 0.42), told(0.44, 1e5, 0.46)), ((1, None), (0, None)));
    }

    /// A plate stands half-way between two of the poses that are a second apart, 1 m from each.
    #[test]
    fn neither_is_what_stands_between_two_poses() {
        let plate = json!([{ "name": "plate", "box": { "center_m": [12.0, 3.0, 3.0], "size_m": [0.02, 0.5, 0.5] } }]);
        let (program, ours) = (among(Some("sim"), plate.clone()), among(None, plate));
        let bulge = program.swiftness().acceleration.unwrap() / 8.0;
        let limits = Limits { clearance: Some(0.1), ..Limits::default() };
        let (sparse, why) = judged_by(&program, 1.0, &limits);
        assert!((sparse.min_clearance.unwrap() - 0.76).abs() < 1e-9, "{sparse:?}");
        // In the middle of the plate, and as far as it may bulge besides.
        let least = sparse.clearance_between.unwrap();
        assert!((-0.002..1e-9).contains(&(least + 0.24 + bulge)), "{least} {bulge}");
        let why = why.unwrap();
        assert!(why.starts_with("clearance 0.76 m at its poses, but -"), "{why}");
        assert!(why.contains(" m may hide between two of them; ") && why.ends_with(" poses a second decide"), "{why}");
        // What is not limited is met all the same.
        let far = Limits { deviation: Some(50.0), contact: true, ..Limits::default() };
        let why = judged_by(&program, 1.0, &far).1.unwrap();
        assert!(why.starts_with("it may have met an obstacle: clearance 0.76 m at its poses, but -"), "{why}");
        assert_eq!(judged_by(&program, 1.0, &Limits { contact: true, ..Limits::default() }).1, None);
        // Whoever looks sees it, and our own simulator is not asked.
        let (dense, why) = judged_by(&program, 0.02, &limits);
        assert!(dense.min_clearance.unwrap() < -0.2 && why.is_none(), "{dense:?}");
        let (own, why) = judged_by(&ours, 1.0, &limits);
        assert_eq!(
            (own.clearance_between, own.overshoot_between, own.acceleration_over, why),
            (None, None, None, None)
        );
    }

    /// 0.4 m beside the wall, on which it may be between poses that are a second apart.
    #[test]
    fn neither_is_the_edge_of_the_world() {
        let along = |step: f64, limits: &Limits| {
            let (program, wall) = (setup(Some("sim")), 0.4);
            let times: Vec<f64> = (0..=(10.0 / step).round() as usize).map(|i| i as f64 * step).collect();
            let poses = times.iter().map(|t| Isometry3::translation(3.0 + 2.0 * t, wall, 3.0)).collect();
            let leg = Channel { name: "leg".into(), values: vec![0.0; times.len()] };
            let track = Track::new(times, poses, vec![leg]).unwrap();
            let way = [Point3::new(3.0, wall, 3.0), Point3::new(23.0, wall, 3.0)];
            let measures = sampled(&program, &track, &way, &Settings::default()).unwrap();
            let bulge = program.swiftness().acceleration.unwrap() * step * step / 8.0;
            (measures.edge_between, wall - bulge, hidden(&program, &measures, limits))
        };
        let limits = Limits { total_time: Some(100.0), ..Limits::default() };
        let (edge, least, why) = along(1.0, &limits);
        assert!((edge.unwrap() - least).abs() < 2e-3 && least < 0.0, "{edge:?} {least}");
        let why = why.unwrap();
        assert!(why.starts_with("it may have left the world: between two of its poses it may be "), "{why}");
        assert_eq!(along(1.0, &Limits::default()).2, None, "nothing is asked");
        assert_eq!(along(0.02, &limits), (None, along(0.02, &limits).1, None), "nowhere near it");
    }

    /// What nothing bounds is looked at along the straight lines between its poses, and those may not be rare.
    #[test]
    fn a_drive_of_which_little_was_seen_is_no_pass() {
        let scenario: Scenario = serde_json::from_value(json!({
            "hairpin": 1, "spec": "none", "execute": { "command": "sim" },
            "robot": { "kind": "differential-drive", "name": "base", "track_m": 0.45, "radius_m": 0.35,
                "limits": { "wheel_speed_m_s": 1.0, "wheel_acceleration_m_s2": 1.5 } },
            "world": { "terrain": { "generator": "fractal", "size_m": 30, "cell_m": 0.1, "relief_m": 0.0, "seed": 3 } },
            "task": { "start": { "x_m": 15, "y_m": 15, "yaw_deg": 0 }, "length": 6, "leg_m": [1.5, 4] },
            "generate": { "manoeuvres": ["forward"], "search": { "waypoints": 60 } },
        }))
        .unwrap();
        let setup = Setup::new(scenario).unwrap();
        assert_eq!(setup.swiftness().acceleration, None);
        let way = [Point3::new(10.0, 10.0, 0.0), Point3::new(20.0, 10.0, 0.0), Point3::new(20.0, 20.0, 0.0)];
        // Around the corner on the way that the mission has, a pose every `step` s: the corner itself is none of them.
        let seen = |step: f64| {
            let times: Vec<f64> = (0..=(19.0 / step) as usize).map(|i| i as f64 * step).collect();
            let at = |t: &f64| match t - 9.5 {
                before if before < 0.0 => Isometry3::translation(10.5 + t, 10.0, 0.0),
                after => Isometry3::translation(20.0, 10.0 + after, 0.0),
            };
            let leg = Channel { name: "leg".into(), values: times.iter().map(|t| f64::from(*t >= 9.5)).collect() };
            let poses = times.iter().map(at).collect();
            let track = Track::new(times, poses, vec![leg]).unwrap();
            let measures = sampled(&setup, &track, &way, &Settings::default()).unwrap();
            let limits = Limits { deviation: Some(1.0), ..Limits::default() };
            (measures.most_between.unwrap(), hidden(&setup, &measures, &limits))
        };
        let (most, why) = seen(4.0);
        assert!(most > 1.0, "{most}");
        let why = why.unwrap();
        assert!(why.contains(" m may hide between two of them"), "{why}");
        assert!(why.contains("its poses are as much as 4.00 s apart, and nothing bounds"), "{why}");
        assert_eq!(seen(0.25).1, None);
    }

    #[test]
    fn neither_is_how_far_it_is_carried_on_or_how_suddenly_it_turns() {
        let program = setup(Some("sim"));
        let bulge = program.swiftness().acceleration.unwrap() / 8.0;
        let limits = Limits { overshoot: Some(0.5), ..Limits::default() };
        let (sparse, why) = judged_by(&program, 1.0, &limits);
        assert!((0.0..0.002).contains(&(sparse.overshoot_between.unwrap() - bulge)), "{sparse:?}");
        let why = why.unwrap();
        assert!(why.starts_with("overshoot 0.00 m at its poses, but ") && why.contains(" may hide"), "{why}");
        assert_eq!(judged_by(&program, 0.05, &limits).1, None);

        let limits = Limits { acceleration: Some(5.0), ..Limits::default() };
        let (sparse, why) = judged_by(&program, 1.0, &limits);
        assert_eq!(sparse.acceleration_over, Some(2.0));
        let why = why.unwrap();
        assert!(
            why.contains(" m/s² is a mean over as much as 2.00 s") && why.ends_with("; 4 poses a second decide"),
            "{why}"
        );
        // Told in steps of 0.1 m, 0.25 s apart: up to 5.5 m/s².
        let why = judged_by(&program, 0.25, &limits).1.unwrap();
        assert!(
            why == "acceleration 0.00 ≤ 5.00 m/s², but its positions are told in steps of 0.1 m: 0.25 s apart that can \
                    make 5.5 m/s²; more digits decide",
            "{why}"
        );
        let limits = Limits { acceleration: Some(6.0), ..Limits::default() };
        assert_eq!(judged_by(&program, 0.25, &limits).1, None);
    }
}
