//! Vehicles that are not as their file says, flown in gusts, logged by an estimator.

use nalgebra::{Isometry3, Point3, Vector3};
use serde_json::{Value, json};

use super::super::Flown;
use crate::campaign::kind::{Adjustable, Fittable};
use crate::campaign::{Case, CaseNumber, Scenario, Setup, execute_run};
use crate::math::random::{Stream, named_seed, standard_normals, stream, unit};
use crate::trajectory::{Channel, Track};

/// A cage and a robot of `data/robots/quadrotor`.
pub(super) fn scenario(robot: &str, controller: &str) -> Setup {
    let path = format!("{}/../../data/robots/quadrotor/{robot}.toml", env!("CARGO_MANIFEST_DIR"));
    let robot: Value = toml::from_str(&std::fs::read_to_string(path).unwrap()).unwrap();
    let scenario: Scenario = serde_json::from_value(json!({
        "hairpin": 1, "robot": robot, "world": { "size_m": [40.0, 40.0, 40.0] },
        "task": { "start_m": [3.0, 3.0, 3.0], "end_m": [15.0, 15.0, 15.0], "length": 10 },
        "execute": { "controller": controller }, "spec": "none",
    }))
    .unwrap();
    Setup::new(scenario).unwrap()
}

/// The numbers of a vehicle.
pub(super) struct Truth {
    numbers: Vec<Adjustable>,
    values: Vec<f64>,
}

impl Truth {
    /// As `of` says of each number and a share of 0 to 1.
    pub(super) fn draw(setup: &Setup, seed: u64, of: &dyn Fn(&Adjustable, f64) -> f64) -> Self {
        let Fittable { numbers, .. } = setup.kind().fittable().unwrap();
        let mut random = stream(named_seed(seed, "truth", 0));
        let values = numbers.iter().map(|number| of(number, unit(&mut random))).collect();
        Self { numbers, values }
    }

    /// Of flights: thrust, drag and bandwidth within 30 % of the file's, a lag of 0.6 to 1.6 of it, a latency of up to
    /// 0.12 s.
    pub(super) fn of_flights(number: &Adjustable, share: f64) -> f64 {
        match number.field {
            "latency_s" => 0.12 * share,
            "rotor_time_constant_s" => number.value * (0.6 + share),
            "thrust_to_weight" => 1.0 + (number.value - 1.0) * (0.7 + 0.6 * share),
            _ => number.value * (0.7 + 0.6 * share),
        }
    }

    pub(super) fn of(&self, field: &str) -> f64 {
        self.values[self.numbers.iter().position(|number| number.field == field).unwrap()]
    }

    /// The setup of the vehicle, with what disturbs it.
    pub(super) fn setup(&self, setup: &Setup, disturbed: &[(&str, Value)]) -> Setup {
        let mut draws = setup.kind().fittable().unwrap().spelt;
        let keys = self.numbers.iter().zip(&self.values);
        draws.extend(
            keys.flat_map(|(number, value)| number.keys.iter().map(move |(key, of)| (key.clone(), json!(value * of)))),
        );
        draws.extend(disturbed.iter().map(|(key, value)| ((*key).to_owned(), value.clone())));
        setup.drawn(&draws).unwrap()
    }
}

/// Waypoints of a mission of about 20 s: legs of 4 to 9 m, well within the cage.
fn mission(random: &mut Stream) -> Vec<Point3<f64>> {
    let mut points = vec![Point3::from(Vector3::from([0, 1, 2].map(|_| 12.0 + 16.0 * unit(random))))];
    while points.len() < 8 {
        let way = Vector3::from(standard_normals::<3>(random)).normalize() * (4.0 + 5.0 * unit(random));
        let next = points[points.len() - 1] + way;
        if next.iter().all(|c| (6.0..34.0).contains(c)) {
            points.push(next);
        }
    }
    points
}

/// `count` logs of the vehicle `truth`, each of a mission of its own: positions alone, 20 a second, off by an
/// estimator's slow drift of 2 cm and by 1 cm from sample to sample; with the speeds of the rotors too, if these are
/// asked for.
pub(super) fn flown(setup: &Setup, truth: &Truth, seed: u64, (count, rotors): (usize, bool)) -> Vec<Flown> {
    let gusts = json!({ "std_m_s": 0.5, "correlation_s": 2.0 });
    let vehicle = truth.setup(setup, &[("world.gusts", gusts), ("execute.noise", json!(true))]);
    let mut random = stream(named_seed(seed, "missions", 0));
    let fly = |number: usize| {
        let case = Case::bare(CaseNumber(number), named_seed(seed, "gusts", number as u64), mission(&mut random));
        let flight = execute_run(&vehicle, &case, 0).outcome.unwrap();
        let mut noise = stream(named_seed(seed, "estimator", number as u64));
        let (every, keep) = (5, (-0.05f64 / 0.5).exp());
        let mut drift = Vector3::from(standard_normals::<3>(&mut noise)) * 0.02;
        let (mut times, mut poses) = (Vec::new(), Vec::new());
        for i in (0..flight.track.len()).step_by(every) {
            drift =
                drift * keep + Vector3::from(standard_normals::<3>(&mut noise)) * (0.02 * (1.0 - keep * keep).sqrt());
            let white = Vector3::from(standard_normals::<3>(&mut noise)) * 0.01;
            times.push(flight.track.times()[i]);
            poses.push(Isometry3::from_parts(
                (flight.track.position(i).coords + drift + white).into(),
                Default::default(),
            ));
        }
        let unknown = Channel { name: crate::trajectory::ATTITUDE_UNKNOWN.into(), values: vec![1.0; times.len()] };
        let mut channels = vec![unknown];
        let speeds = flight.track.channels().iter().filter(|channel| rotors && channel.name.starts_with("rotor"));
        channels.extend(speeds.map(|Channel { name, values }| {
            let values = values.iter().step_by(every).copied().collect();
            Channel { name: name.clone(), values }
        }));
        let track = Track::new(times, poses, channels).unwrap();
        Flown { log: format!("log {number}"), mission: case.id(), case, track }
    };
    (0..count).map(fly).collect()
}
