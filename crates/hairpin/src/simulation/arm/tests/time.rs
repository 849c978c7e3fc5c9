//! When: trapezoids and S-curves in closed form, limits on dense samples, lags.

use super::*;
use crate::math::random::stream;
use crate::simulation::arm::execute::tests_only::set_points;
use crate::simulation::arm::servo::Servo;

/// A straight move of `way` m at `speed`, slow enough for the joints' limits not to matter.
fn straight(way: f64, speed: f64) -> (Joints, Vec<Order>) {
    let arm = arm();
    (stand(&arm, 0.3, -0.5 * way, 0.25), vec![line(0.3, 0.5 * way, 0.25, speed, Zone::Fine)])
}

#[test]
fn trapezoids_take_the_time_of_their_closed_form() {
    let arm = arm();
    for (way, speed, push) in [(0.3, 0.2, 1.0), (0.2, 0.1, 0.5), (0.1, 5.0, 1.0), (0.02, 1.0, 2.0)] {
        let (start, orders) = straight(way, speed);
        let settings = PlanSettings { acceleration: push, ..PlanSettings::default() };
        let plan = Plan::new(&arm, &start, &orders, &settings).unwrap();
        let expected = if way > speed * speed / push { way / speed + speed / push } else { 2.0 * (way / push).sqrt() };
        // A triangle's peak lies between nodes.
        assert!((plan.duration() - expected).abs() < 2e-3 * expected, "{way} {speed}: {} {expected}", plan.duration());
        let smooth = PlanSettings { shape: Shape::SCurve(0.05), ..settings };
        let smooth = Plan::new(&arm, &start, &orders, &smooth).unwrap();
        assert!((smooth.duration() - plan.duration() - 0.05).abs() < 1e-12);
    }
}

#[test]
fn s_curves_bound_jerk_and_keep_the_path() {
    let arm = arm();
    let (start, orders) = straight(0.3, 0.2);
    let (push, window) = (1.0, 0.05);
    let settings = PlanSettings { acceleration: push, shape: Shape::SCurve(window), ..PlanSettings::default() };
    let plan = Plan::new(&arm, &start, &orders, &settings).unwrap();
    let (step, law) = (1e-3, &plan.timed[0].law);
    let s = |i: usize| law.at(i as f64 * step).s;
    for i in 3..(plan.duration() / step) as usize {
        let jerk = (s(i) - 3.0 * s(i - 1) + 3.0 * s(i - 2) - s(i - 3)) / step.powi(3);
        assert!(jerk.abs() < 1.001 * push / window, "{i}: {jerk}");
        let speed = (s(i) - s(i - 1)) / step;
        assert!(speed < 0.2 + 1e-9);
    }
    let (from, to) = (Point3::new(0.3, -0.15, 0.25), Point3::new(0.3, 0.15, 0.25));
    for p in places(&plan.execute(&exact(), &[], 1).unwrap().recording) {
        assert!(from_segment(&p, &from, &to) < 1e-6);
    }
}

#[test]
fn timed_moves_take_their_time() {
    let arm = arm();
    let (start, mut orders) = straight(0.2, 1.0);
    orders[0].duration = Some(4.0);
    let settings = PlanSettings { acceleration: 1e4, ..PlanSettings::default() };
    let plan = Plan::new(&arm, &start, &orders, &settings).unwrap();
    assert!((plan.duration() - 4.0).abs() < 0.05, "{}", plan.duration());
}

#[test]
fn joint_moves_are_as_fast_as_the_slowest_joint() {
    let arm = arm();
    let start = stand(&arm, 0.3, 0.0, 0.25);
    let mut end = start;
    end[0] += 1.0;
    end[5] -= 0.4;
    let orders = [joints(end)];
    let plan = Plan::new(&arm, &start, &orders, &PlanSettings::default()).unwrap();
    let limit = &arm.limits[0];
    let expected = 1.0 / limit.speed + limit.speed / limit.acceleration;
    // A share of the limits is kept back.
    assert!((expected..1.03 * expected).contains(&plan.duration()), "{} {expected}", plan.duration());
}

#[test]
fn limits_hold_by_independent_differentiation() {
    let arm = arm();
    let shapes = [Shape::Trapezoid, Shape::SCurve(0.04)];
    let mut completed = 0;
    for seed in 0..40u64 {
        let (start, orders) = random_program(&arm, &mut stream(seed), 6);
        let settings = PlanSettings { shape: shapes[seed as usize % 2], ..PlanSettings::default() };
        let plan = Plan::new(&arm, &start, &orders, &settings).unwrap();
        completed += usize::from(plan.stop().is_none());
        let step = 2.5e-4;
        let q = set_points(&plan, step);
        for i in 1..q.len() - 1 {
            for (k, limit) in arm.limits.iter().enumerate() {
                let speed = (q[i + 1][k] - q[i - 1][k]) / (2.0 * step);
                let push = (q[i + 1][k] - 2.0 * q[i][k] + q[i - 1][k]) / (step * step);
                assert!(speed.abs() <= limit.speed, "seed {seed}, axis {}, t = {}: {speed}", k + 1, i as f64 * step);
                assert!(
                    push.abs() <= 1.01 * limit.acceleration,
                    "seed {seed}, axis {}, t = {}: {push} of {}",
                    k + 1,
                    i as f64 * step,
                    limit.acceleration
                );
            }
            let tip = |i: usize| arm.forward(&q[i]).translation.vector;
            let fastest = orders.iter().map(|order| order.speed.tcp).fold(0.0, f64::max);
            assert!((tip(i + 1) - tip(i - 1)).norm() / (2.0 * step) < 1.001 * fastest, "seed {seed}");
        }
    }
    assert!(completed > 15, "only {completed} programs could be followed");
}

#[test]
fn servos_lag_as_their_equation_says() {
    let (lag, step, rate) = (0.02, 0.002, 0.7);
    let mut servo = Servo::new(lag, step, 10.0, 0.0);
    for i in 1..200 {
        let t = i as f64 * step;
        let angle = servo.follow(rate * (t - step), rate * t);
        let expected = rate * t - rate * lag * (1.0 - (-t / lag).exp());
        assert!((angle - expected).abs() < 1e-13, "{t}: {angle} {expected}");
    }
    let mut slow = Servo::new(lag, step, 0.5 * rate, 0.0);
    for i in 1..200 {
        let t = i as f64 * step;
        assert!(slow.follow(rate * (t - step), rate * t) <= 0.5 * rate * t + 1e-12);
    }
}

#[test]
fn the_tool_lags_behind_by_speed_times_time_constant() {
    let arm = arm();
    let (speed, lag) = (0.1, 0.03);
    let (start, orders) = straight(0.3, speed);
    let plan =
        Plan::new(&arm, &start, &orders, &PlanSettings { acceleration: 1.0, ..PlanSettings::default() }).unwrap();
    let settings = RunSettings { lags: [lag; 6], ..RunSettings::default() };
    let (late, on_time) = (plan.execute(&settings, &[], 1).unwrap(), plan.execute(&exact(), &[], 1).unwrap());
    let (from, to) = (Point3::new(0.3, -0.15, 0.25), Point3::new(0.3, 0.15, 0.25));
    for (i, t) in late.recording.times().iter().enumerate().filter(|(_, t)| (0.5..2.8).contains(*t)) {
        let behind = on_time.recording.position(i.min(on_time.recording.len() - 1)).y - late.recording.position(i).y;
        assert!((behind - speed * lag).abs() < 0.01 * speed * lag, "t = {t}: {behind}");
        // Joints that lag alike leave the line only where it bends them.
        let aside = from_segment(&late.recording.position(i), &from, &to);
        assert!(aside < 1e-4, "t = {t}: {aside}");
    }
    let end = late.recording.len() - 1;
    assert!((late.recording.position(end) - to).norm() < 1e-5);
}

#[test]
fn speed_is_that_of_the_tool() {
    let arm = arm();
    let (start, orders) = straight(0.3, 0.2);
    let plan = Plan::new(&arm, &start, &orders, &PlanSettings::default()).unwrap();
    let run = plan.execute(&exact(), &[], 1).unwrap();
    let speeds = run.recording.channel("speed_m_s").unwrap();
    let middle = speeds.len() / 2;
    assert!((speeds[middle] - 0.2).abs() < 1e-6, "{}", speeds[middle]);
    let status = run.recording.channel("status").unwrap();
    assert_eq!((status[middle], status[status.len() - 1]), (1.0, 0.0));
}
