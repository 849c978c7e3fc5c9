//! Where: lines, arcs, blends, and what cannot be followed.

use super::*;
use crate::math::random::stream;
use crate::simulation::arm::execute::tests_only::set_points;

#[test]
fn blends_are_parabolas_that_begin_a_radius_before_the_corner() {
    let arm = arm();
    let start = stand(&arm, 0.3, -0.1, 0.2);
    let radius = 0.02;
    let orders = [line(0.3, 0.1, 0.2, 0.2, Zone::Radius(radius)), line(0.42, 0.1, 0.2, 0.2, Zone::Fine)];
    let plan = Plan::new(&arm, &start, &orders, &PlanSettings::default()).unwrap();
    let path = plan.path();
    let corner = Point3::new(0.3, 0.1, 0.2);
    // The middle: C + (t₂ − t₁) r/4.
    let middle = path.track().position(path.moves()[0].end);
    let expected = corner + Vector3::new(1.0, -1.0, 0.0) * (0.25 * radius);
    assert!((middle - expected).norm() < 1e-12, "{middle} {expected}");
    assert!(!path.moves()[0].stops && path.moves()[1].stops);
    let run = plan.execute(&exact(), &[], 1).unwrap();
    for p in places(&run.recording) {
        // x = r w², y = −r (1 − w)² from the corner: √x + √−y = √r.
        let (x, y) = (p.x - corner.x, corner.y - p.y);
        if x > 1e-5 && y > 1e-5 {
            assert!((x.sqrt() + y.sqrt() - radius.sqrt()).abs() < 1e-4, "{p}");
        } else {
            assert!(x < radius.max(0.12) + 1e-9 && y < 0.2 + 1e-9);
        }
    }
    // Speed does not fall to zero on the way.
    let speeds = run.recording.channel("speed_m_s").unwrap();
    let (first, last) = (speeds.iter().position(|v| *v > 0.1).unwrap(), speeds.iter().rposition(|v| *v > 0.1).unwrap());
    assert!(speeds[first..=last].iter().all(|v| *v > 0.08));
}

#[test]
fn zones_are_cut_to_half_of_the_moves_beside_them() {
    let arm = arm();
    let start = stand(&arm, 0.3, -0.1, 0.2);
    let zone = Zone::Radius(0.2);
    let orders =
        [line(0.3, 0.1, 0.2, 0.2, zone), line(0.34, 0.1, 0.2, 0.2, zone), line(0.34, -0.1, 0.2, 0.2, Zone::Fine)];
    let plan = Plan::new(&arm, &start, &orders, &PlanSettings::default()).unwrap();
    let middle = plan.path().track().position(plan.path().moves()[0].end);
    // Half of the short move is 20 mm.
    let expected = Point3::new(0.3, 0.1, 0.2) + Vector3::new(1.0, -1.0, 0.0) * (0.25 * 0.02);
    assert!((middle - expected).norm() < 1e-12, "{middle}");
    let sharp = plan.sharp_path().unwrap();
    assert!((sharp.track().position(sharp.moves()[0].end) - Point3::new(0.3, 0.1, 0.2)).norm() < 1e-12);
    assert!((sharp.passes(0) - plan.passed()[0]).abs() < 1e-9 && (sharp.passes(2) - plan.passed()[2]).abs() < 1e-9);
}

#[test]
fn fine_points_are_met_and_stopped_at() {
    let arm = arm();
    let start = stand(&arm, 0.3, -0.1, 0.2);
    let orders = [line(0.3, 0.1, 0.2, 0.5, Zone::Fine), line(0.4, 0.1, 0.2, 0.5, Zone::Fine)];
    let plan = Plan::new(&arm, &start, &orders, &PlanSettings::default()).unwrap();
    let run = plan.execute(&RunSettings::default(), &[], 1).unwrap();
    let nearest = places(&run.recording).iter().map(|p| (p - Point3::new(0.3, 0.1, 0.2)).norm()).fold(1.0, f64::min);
    assert!(nearest < 1e-6, "{nearest}");
    let stopped = run.recording.channel("status").unwrap().iter().filter(|status| **status == 0.0).count();
    assert!(stopped >= 5, "{stopped}");
    let moves = run.recording.channel("move").unwrap();
    assert!(moves.is_sorted() && moves[0] == 0.0 && moves[moves.len() - 1] == 1.0);
}

#[test]
fn arcs_stay_on_their_circle_and_turn_evenly() {
    let arm = arm();
    let (centre, radius) = (Point3::new(0.35, 0.0, 0.2), 0.08);
    let at = |angle: f64| centre + Vector3::new(-angle.cos(), angle.sin(), 0.0) * radius;
    for angle in [1.0, 3.0, 4.1] {
        let (from, via, to) = (at(0.0), at(0.4 * angle), at(angle));
        let start = stand(&arm, from.x, from.y, from.z);
        let turned = UnitQuaternion::from_axis_angle(&Vector3::z_axis(), 0.6) * down();
        let end = Isometry3::from_parts(to.coords.into(), turned);
        let orders = [order(Target::Arc(via, end, None), 0.3, Zone::Fine)];
        let plan = Plan::new(&arm, &start, &orders, &PlanSettings::default()).unwrap();
        assert_eq!(plan.stop(), None);
        let run = plan.execute(&exact(), &[], 1).unwrap();
        let mut longest = 0.0f64;
        for (p, pose) in places(&run.recording).iter().zip(run.recording.poses()) {
            assert!(((p - centre).norm() - radius).abs() < 1e-6 && (p.z - 0.2).abs() < 1e-6, "{p}");
            // Orientation goes with the share of the arc.
            let along = (p - from).norm() / (2.0 * radius);
            let share = 2.0 * along.min(1.0).asin() / angle;
            if angle < 3.1 {
                assert!((pose.rotation.angle_to(&down()) - 0.6 * share).abs() < 1e-4);
            }
            longest = longest.max(share);
        }
        let way: f64 = places(&run.recording).windows(2).map(|pair| (pair[1] - pair[0]).norm()).sum();
        assert!((way - radius * angle).abs() < 1e-3 * radius * angle && longest > 0.3, "{way}");
        let passes = places(&run.recording).iter().map(|p| (p - via).norm()).fold(1.0, f64::min);
        assert!(passes < 0.002, "{passes}");
    }
}

/// Where Newton's steps from where a chain stands lead to nothing within its bounds, a move in joints ends in the
/// posture that the search for points finds.
#[test]
fn a_chain_comes_in_joints_to_what_one_seed_does_not_find() {
    let arm = Arm { kinematics: Kinematics::Chain, ..arm() };
    let (home, mut random, mut tried) = ([0.0, 0.0, 0.0, 0.0, 0.5, 0.0], stream(9), 0);
    while tried < 20 {
        let q: Joints = std::array::from_fn(|k| {
            let limit = &arm.limits[k];
            limit.lower + (limit.upper - limit.lower) * unit(&mut random)
        });
        let flange = arm.forward(&q);
        let first = arm.chain.inverse_near(&flange, &home);
        if first.is_some_and(|found| !arm.turns_of(&found.joints).is_empty()) {
            continue;
        }
        let found = arm.inverse(&flange, &home).into_iter().find(|q| arm.outside_limits(q).is_none());
        let Some(found) = found else { continue };
        tried += 1;
        let orders = [order(Target::Joint(flange, Some(arm.configuration(&found))), 0.5, Zone::Fine)];
        let plan = Plan::new(&arm, &home, &orders, &PlanSettings::default()).unwrap();
        assert_eq!(plan.stop(), None, "{q:?}");
    }
}

#[test]
fn what_cannot_be_followed_stops_with_its_reason() {
    let arm = arm();
    let start = stand(&arm, 0.3, 0.0, 0.25);
    let of = |orders: &[Order]| *Plan::new(&arm, &start, orders, &PlanSettings::default()).unwrap().stop().unwrap();
    let far = of(&[line(0.9, 0.0, 0.25, 0.5, Zone::Fine)]);
    assert!(
        matches!(far.reason, Reason::OutOfReach | Reason::Singular(_)) && far.share > 0.2 && far.share < 0.6,
        "{far:?}"
    );
    assert!(far.time > 0.1);
    assert_eq!(of(&[order(Target::Joint(pose(0.9, 0.0, 0.25), None), 0.5, Zone::Fine)]).reason, Reason::OutOfReach);
    let mut over = start;
    over[3] = 163.1f64.to_radians();
    let limit = of(&[joints(over)]);
    assert!(
        limit.reason.to_string().starts_with("axis 4 at 16") && limit.reason.to_string().ends_with("> 160.0°"),
        "{}",
        limit.reason
    );
    assert!((limit.share * 163.1 - 160.0).abs() < 3.0, "{limit:?}");
    // Through axis 1: the wrist's centre would pass over the base.
    let through = of(&[line(-0.3, 0.0, 0.25, 0.5, Zone::Fine)]);
    assert!(matches!(through.reason, Reason::Singular(_) | Reason::JointLimit { .. }), "{through:?}");
    let in_line = of(&[order(Target::Arc(Point3::new(0.3, 0.05, 0.25), pose(0.3, 0.1, 0.25), None), 0.5, Zone::Fine)]);
    assert_eq!(in_line.reason, Reason::NoArc);
    let other = crate::robot::arm::Configuration { cf1: 0, cf4: 0, cf6: 0, cfx: 4 };
    let wrong = of(&[order(Target::Line(pose(0.3, 0.1, 0.25), Some(other)), 0.5, Zone::Fine)]);
    assert!(matches!(wrong.reason, Reason::Configuration { wanted, .. } if wanted == other), "{wrong:?}");
}

#[test]
fn a_stopped_run_is_recorded_until_the_stop() {
    let arm = arm();
    let start = stand(&arm, 0.3, 0.0, 0.25);
    let orders = [line(0.3, 0.1, 0.25, 0.5, Zone::Radius(0.01)), line(0.9, 0.1, 0.25, 0.5, Zone::Fine), joints(start)];
    let plan = Plan::new(&arm, &start, &orders, &PlanSettings::default()).unwrap();
    let stop = *plan.stop().unwrap();
    assert_eq!((stop.order, plan.passed().len()), (1, 1));
    let run = plan.execute(&RunSettings::default(), &[], 1).unwrap();
    let status = run.recording.channel("status").unwrap();
    assert_eq!(status[status.len() - 1], 2.0);
    let speeds = run.recording.channel("speed_m_s").unwrap();
    assert!(speeds[speeds.len() - 1] < 0.01);
    assert!(run.recording.times()[run.recording.len() - 1] >= stop.time);
}

#[test]
fn configurations_choose_the_solution_and_the_turn() {
    let arm = arm();
    let start = stand(&arm, 0.3, 0.0, 0.25);
    let to = pose(0.35, 0.1, 0.2);
    let mut tried = 0;
    for q in arm.inverse(&to, &start).into_iter().flat_map(|q| arm.turns_of(&q)) {
        let wanted = arm.configuration(&q);
        let orders = [order(Target::Joint(to, Some(wanted)), f64::INFINITY, Zone::Fine)];
        let plan = Plan::new(&arm, &start, &orders, &PlanSettings::default()).unwrap();
        assert_eq!(plan.stop(), None);
        let run = plan.execute(&exact(), &[], 1).unwrap();
        let last = run.recording.len() - 1;
        for (k, angle) in q.iter().enumerate() {
            assert!((run.recording.channel(&format!("q{}_rad", k + 1)).unwrap()[last] - angle).abs() < 1e-9);
        }
        tried += 1;
    }
    assert!(tried >= 3, "{tried}");
}

#[test]
fn motion_is_continuous_through_every_kind_of_blend() {
    let arm = arm();
    for seed in 100..120u64 {
        let (start, mut orders) = random_program(&arm, &mut stream(seed), 5);
        for order in &mut orders {
            order.zone = Zone::Radius(0.03);
        }
        let plan = Plan::new(&arm, &start, &orders, &PlanSettings::default()).unwrap();
        let step = 1e-3;
        for pair in set_points(&plan, step).windows(2) {
            for (k, limit) in arm.limits.iter().enumerate() {
                assert!((pair[1][k] - pair[0][k]).abs() <= limit.speed * step + 1e-9, "seed {seed}");
            }
        }
    }
}

#[test]
fn orders_without_a_way_are_passed_at_once() {
    let arm = arm();
    let start = stand(&arm, 0.3, 0.0, 0.25);
    let orders = [
        joints(start),
        line(0.3, 0.1, 0.25, 0.5, Zone::Radius(0.02)),
        line(0.3, 0.1, 0.25, 0.5, Zone::Fine),
        joints(start),
    ];
    let plan = Plan::new(&arm, &start, &orders, &PlanSettings::default()).unwrap();
    assert_eq!(plan.stop(), None);
    assert_eq!(plan.passed().len(), 4);
    assert!(plan.passed()[0] == 0.0 && plan.passed().is_sorted());
    assert_eq!(plan.path().moves().len(), 4);
    let still = [joints(start)];
    let still = Plan::new(&arm, &start, &still, &PlanSettings::default()).unwrap();
    assert_eq!(still.duration(), 0.0);
    assert!(!still.execute(&RunSettings::default(), &[], 1).unwrap().recording.is_empty());
}

#[test]
fn numbers_out_of_bounds_are_refused() {
    let arm = arm();
    let start = stand(&arm, 0.3, 0.0, 0.25);
    let plan =
        |order: Order| Plan::new(&arm, &start, &[order], &PlanSettings::default()).map(|_| ()).unwrap_err().field();
    assert_eq!(plan(line(0.3, 0.1, 0.25, 0.0, Zone::Fine)), "speed.tcp");
    assert_eq!(plan(line(0.3, 0.1, 0.25, 0.5, Zone::Radius(f64::NAN))), "zone");
    assert_eq!(plan(line(f64::NAN, 0.1, 0.25, 0.5, Zone::Fine)), "target");
    let orders = [line(0.3, 0.1, 0.25, 0.5, Zone::Fine)];
    assert_eq!(Plan::new(&arm, &[4.0; 6], &orders, &PlanSettings::default()).unwrap_err().field(), "start");
    assert_eq!(Plan::new(&arm, &start, &[], &PlanSettings::default()).unwrap_err().field(), "orders");
    let plan = Plan::new(&arm, &start, &orders, &PlanSettings::default()).unwrap();
    let run =
        |settings: RunSettings, fault: Fault| plan.execute(&settings, &[fault], 1).map(|_| ()).unwrap_err().field();
    let slow = |axis, share| Fault::SlowAxis { axis, share };
    assert_eq!(run(RunSettings::default(), slow(7, 0.5)), "fault.axis");
    assert_eq!(run(RunSettings::default(), slow(1, 0.0)), "fault.share");
    assert_eq!(run(RunSettings { sample: 0.0, ..RunSettings::default() }, slow(1, 0.5)), "sample");
}

/// Moves in joints, arcs, blends and lines of all speeds, with a tool that stands out.
fn bent_programs() -> (Arm, Vec<(Joints, Vec<Order>)>) {
    let arm = arm();
    let (mut random, mut programs, mut tries) = (stream(77), Vec::new(), 0);
    while programs.len() < 12 {
        tries += 1;
        assert!(tries < 5000, "{} programs that can be followed", programs.len());
        let (start, mut orders) = random_program(&arm, &mut random, 6);
        for (k, order) in orders.iter_mut().enumerate() {
            if let (0, Target::Line(..) | Target::Joint(..)) = (k % 2, &order.target) {
                let turned: Joints =
                    std::array::from_fn(|k| 0.8 * (unit(&mut random) - 0.5) + [0.0, 0.1, 0.2, 0.0, 0.9, 0.0][k]);
                order.target = Target::Joints(turned);
            }
            order.tool = Isometry3::translation(0.05, -0.03, 0.12);
        }
        if Plan::new(&arm, &start, &orders, &PlanSettings::default()).is_ok_and(|plan| plan.stop().is_none()) {
            programs.push((start, orders));
        }
    }
    (arm, programs)
}

/// Every place that set points lead to lies within a micrometre of the path, blended and sharp alike; the chords
/// between its poses are off by hundreds.
#[test]
fn paths_are_arcs_and_not_chords() {
    let (arm, programs) = bent_programs();
    let mut chords = 0.0f64;
    for (start, orders) in programs {
        let plan = Plan::new(&arm, &start, &orders, &PlanSettings::default()).unwrap();
        let run = plan.execute(&exact(), &[], 1).unwrap().recording;
        let fine = orders.iter().all(|order| order.zone == Zone::Fine);
        let paths = [Some(plan.path()), fine.then(|| plan.sharp_path().unwrap())];
        for path in paths.iter().flatten() {
            let track = path.track();
            for p in places(&run) {
                let all = |of: &dyn Fn(usize) -> f64| (0..track.len() - 1).map(of).fold(f64::INFINITY, f64::min);
                let off = all(&|i| (track.nearest(i, &p) - p).norm());
                assert!(off < 1e-6, "{off} m at {p}");
                chords = chords.max(all(&|i| from_segment(&p, &track.position(i), &track.position(i + 1))));
            }
        }
    }
    assert!(chords > 1e-4, "chords would be up to {chords} m off");
}

/// Rows tell the tool's own velocity, and the motion between them is the plan's to a tenth of a millimetre.
#[test]
fn rows_of_the_motion_hold_between_them() {
    let (arm, programs) = bent_programs();
    for (start, orders) in programs {
        for shape in [Shape::Trapezoid, Shape::SCurve(0.04)] {
            let settings = PlanSettings { shape, ..PlanSettings::default() };
            let plan = Plan::new(&arm, &start, &orders, &settings).unwrap();
            let motion = plan.motion();
            let fine = RunSettings { sample: 0.001, interpolation: 0.001, ..exact() };
            let run = plan.execute(&fine, &[], 1).unwrap().recording;
            let place = |t: f64| motion.track().at(t).unwrap();
            for i in 1..run.len() - 1 {
                let t = run.times()[i];
                let (pose, velocity) = place(t);
                let off = (pose.translation.vector - run.position(i).coords).norm();
                assert!(off < 5e-5, "{off} m at {t} s");
                assert!(pose.rotation.angle_to(&run.poses()[i].rotation) < 1e-3, "at {t} s");
                let mean = (run.position(i + 1) - run.position(i - 1)) / 0.002;
                let off = (Vector3::from_row_slice(&velocity) - mean).norm();
                assert!(off < 0.02, "{off} m/s at {t} s");
            }
            assert_eq!(motion.moves().len(), plan.path().moves().len());
            for (m, passed) in motion.moves().iter().zip(plan.passed()) {
                assert!((motion.track().times()[m.end] - passed).abs() < 1e-9);
            }
        }
    }
}
