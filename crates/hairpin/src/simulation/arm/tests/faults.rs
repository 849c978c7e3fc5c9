//! Every fault leaves its own mark, and noise repeats with its seed.

use super::*;

fn program(arm: &Arm) -> (Joints, Vec<Order>) {
    let start = stand(arm, 0.3, -0.1, 0.2);
    let orders = vec![
        line(0.3, 0.1, 0.2, 0.3, Zone::Fine),
        line(0.4, 0.1, 0.25, 0.3, Zone::Radius(0.01)),
        line(0.4, -0.1, 0.25, 0.3, Zone::Fine),
        joints(start),
    ];
    (start, orders)
}

fn both(faults: &[Fault]) -> (Track, Track) {
    let arm = arm();
    let (start, orders) = program(&arm);
    let plan = Plan::new(&arm, &start, &orders, &PlanSettings::default()).unwrap();
    let run = |faults| plan.execute(&RunSettings::default(), faults, 1).unwrap().recording;
    (run(&[]), run(faults))
}

#[test]
fn a_delayed_start_shifts_time() {
    let (plain, late) = both(&[Fault::DelayedStart { order: 0, delay: 0.05 }]);
    for i in 0..plain.len() {
        assert!((late.position(i + 5) - plain.position(i)).norm() < 1e-9, "{i}");
    }
    // From the second stop on only.
    let (plain, late) = both(&[Fault::DelayedStart { order: 1, delay: 0.05 }]);
    for (i, number) in plain.channel("move").unwrap().iter().enumerate() {
        let shift = if *number >= 1.0 { 5 } else { 0 };
        assert!((late.position(i + shift) - plain.position(i)).norm() < 1e-4, "{i}");
    }
}

#[test]
fn a_wrong_tool_is_a_constant_offset_in_the_tool() {
    let shift = Vector3::new(0.001, -0.002, 0.003);
    let (plain, off) = both(&[Fault::ToolOffset(Isometry3::from_parts(shift.into(), UnitQuaternion::identity()))]);
    for (a, b) in plain.poses().iter().zip(off.poses()) {
        assert!((a.inverse_transform_point(&Point3::from(b.translation.vector)) - Point3::from(shift)).norm() < 1e-12);
    }
}

#[test]
fn play_holds_a_link_back_by_half_its_width() {
    let width = 2e-3;
    let (plain, loose) = both(&[Fault::Backlash { axis: 1, width }]);
    let angle = |track: &Track, i: usize, k: usize| track.channel(&format!("q{k}_rad")).unwrap()[i];
    let (mut least, mut most) = (0.0f64, 0.0f64);
    for i in 0..plain.len() {
        let behind = angle(&plain, i, 1) - angle(&loose, i, 1);
        (least, most) = (least.min(behind), most.max(behind));
        assert_eq!(angle(&plain, i, 2), angle(&loose, i, 2));
    }
    // Axis 1 turns one way, then the other.
    assert!((most - 0.5 * width).abs() < 1e-9 && (least + 0.5 * width).abs() < 1e-9, "{least} {most}");
}

#[test]
fn a_slow_axis_turns_no_faster_and_arrives_late() {
    let arm = arm();
    let start = stand(&arm, 0.3, 0.0, 0.25);
    let mut end = start;
    end[0] += 1.2;
    let orders = [joints(end)];
    let plan = Plan::new(&arm, &start, &orders, &PlanSettings::default()).unwrap();
    let share = 0.5;
    let settings = RunSettings { noise: Noise::default(), ..RunSettings::default() };
    let slowed = |share| plan.execute(&settings, &[Fault::SlowAxis { axis: 1, share }], 1).unwrap();
    let run = slowed(share);
    let angles = run.recording.channel("q1_rad").unwrap();
    let most = share * arm.limits[0].speed;
    let fastest = angles.windows(2).map(|pair| (pair[1] - pair[0]) / 0.01).fold(0.0, f64::max);
    assert!((fastest - most).abs() < 1e-9, "{fastest} {most}");
    // It is followed beyond the plan's end until it is there.
    let planned = plan.execute(&settings, &[], 1).unwrap();
    assert!(run.arrived && (angles[angles.len() - 1] - end[0]).abs() < 2e-3, "{}", angles[angles.len() - 1]);
    let lasted = |run: &Run| *run.recording.times().last().unwrap();
    assert!(planned.arrived && lasted(&run) > lasted(&planned) + 0.1, "{} {}", lasted(&run), lasted(&planned));
    // Not for ever, and what is given up on the way has not arrived.
    let creeping = slowed(0.05);
    assert!(!creeping.arrived && lasted(&creeping) < 4.5 * lasted(&planned), "{}", lasted(&creeping));
}

#[test]
fn an_extra_lag_holds_one_axis_back() {
    let arm = arm();
    let start = stand(&arm, 0.3, 0.0, 0.25);
    let mut end = start;
    end[0] += 1.5;
    let mut orders = vec![joints(end)];
    orders[0].speed.tcp = 0.3;
    let plan = Plan::new(&arm, &start, &orders, &PlanSettings::default()).unwrap();
    let extra = 0.04;
    let run = |faults: &[Fault]| plan.execute(&RunSettings::default(), faults, 1).unwrap().recording;
    let (plain, lagging) = (run(&[]), run(&[Fault::ExtraLag { axis: 1, lag: extra }]));
    let q = |track: &Track, i: usize| track.channel("q1_rad").unwrap()[i];
    let middle = plain.len() / 2;
    let rate = (q(&plain, middle + 1) - q(&plain, middle)) / 0.01;
    assert!((q(&plain, middle) - q(&lagging, middle) - rate * extra).abs() < 1e-6 * rate);
}

#[test]
fn noise_repeats_with_its_seed() {
    let arm = arm();
    let (start, orders) = program(&arm);
    let plan = Plan::new(&arm, &start, &orders, &PlanSettings::default()).unwrap();
    let noise = Noise { position: 2e-5, orientation: 1e-4, joints: 1e-5, pause: 0.01 };
    let settings = RunSettings { noise, ..RunSettings::default() };
    let run = |seed| plan.execute(&settings, &[], seed).unwrap().recording;
    assert_eq!(run(3), run(3));
    assert_ne!(run(3), run(4));
    let still =
        plan.execute(&RunSettings { noise: Noise { pause: 0.0, ..noise }, ..settings }, &[], 3).unwrap().recording;
    let exact = plan.execute(&RunSettings::default(), &[], 3).unwrap().recording;
    let n = exact.len() as f64;
    let squares: f64 = (0..exact.len()).map(|i| (still.position(i) - exact.position(i)).norm_squared()).sum();
    let spread = (squares / (3.0 * n)).sqrt();
    assert!((spread - 2e-5).abs() < 4.0 * 2e-5 / (6.0 * n).sqrt(), "{spread}");
    // Pauses move the later moves on by no more than their sum.
    let longer = run(5).len() - exact.len();
    assert!((1..=4).contains(&longer), "{longer}");
}

#[test]
fn loads_are_counted() {
    let arm = arm();
    let (start, orders) = program(&arm);
    let plan = Plan::new(&arm, &start, &orders, &PlanSettings::default()).unwrap();
    let load = plan.load(0.002);
    assert_eq!(load.len(), 4);
    // A joint move solves nothing, lines at every node.
    assert!(load[3].inverse_iterations == 0 && load[0].inverse_iterations >= 20);
    let steps: u64 = load.iter().map(|load| load.interpolation_steps).sum();
    assert!((steps as f64 - plan.duration() / 0.002).abs() <= 4.0);
    assert_eq!(load[0].total(), load[0].interpolation_steps + load[0].inverse_iterations);
}
