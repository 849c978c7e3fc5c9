use hairpin::campaign::{Case, Setup, judge, Run, execute_run};
use nalgebra::Point3;
use std::time::Instant;
fn open(name: &str, sets: &[(&str, &str)]) -> Setup {
    let sets: Vec<(String, String)> = sets.iter().map(|(k, v)| (k.to_string(), v.to_string())).collect();
    hairpin_formats::scenario::setup_for(name, &sets).unwrap_or_else(|report| panic!("{report}"))
}
fn main() {
    let wind = ("vary.\"world.wind_m_s\"", "{ uniform = [[-3, -3, 0], [3, 3, 0]] }");
    let mass = ("vary.\"robot.mass_kg\"", "{ normal = [0.8, 0.01], min = 0.75, max = 0.85 }");
    let who = ("vary.\"execute.controller\"", "{ choice = [\"minimum-snap\", \"geometric\"] }");
    let repeat = ("execute.repeat", "1001");
    for (name, scenario, sets) in [
        ("flight: wind", "quadrotor", vec![("vary", "{}"), repeat, wind]),
        ("flight: wind, mass, controller", "quadrotor", vec![("vary", "{}"), repeat, wind, mass, who]),
        ("rover, 40 m of generated craters: latency", "demo-rover", vec![("vary", "{}"), repeat, ("vary.\"execute.latency_s\"", "{ uniform = [0, 0.2] }")]),
        ("arm, 40 drawn points: servo lag", "arm", vec![("vary", "{}"), repeat, ("task.points", "{ count = 40 }"), ("vary.\"execute.servo_lag_s\"", "{ uniform = [0.004, 0.006] }")]),
    ] {
        let began = Instant::now();
        let setup = open(scenario, &sets);
        let opened = began.elapsed();
        let waypoints: Vec<Point3<f64>> = (0..10).map(|k| Point3::new(3.0 + k as f64, 3.0, 3.0)).collect();
        let case = Case::bare(1, 7, waypoints);
        let runs = if scenario == "arm" { 100 } else { 1000 };
        let mut best = f64::INFINITY;
        for _ in 0..3 {
            let began = Instant::now();
            for run in 1..=runs { std::hint::black_box(hairpin::campaign::mission(&setup, &case, run).expect("a mission")); }
            best = best.min(began.elapsed().as_secs_f64());
        }
        println!("{name}: opened in {:.1} ms, {runs} missions in {:.1} ms", 1e3 * opened.as_secs_f64(), 1e3 * best);
    }
    let _ = (judge as fn(&Setup, &Case, &[Run]) -> _, execute_run as fn(&Setup, &Case, usize) -> _);
}
