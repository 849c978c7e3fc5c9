//! A track from wherever it comes, judged against waypoints: `cargo run --example 04_judge_a_track`.

use std::error::Error;

use hairpin::judgement::{Reference, Settings, Statistics, deviation_of_samples, measure};
use hairpin::trajectory::{Channel, Track};
use nalgebra::{Isometry3, Point3};

fn main() -> Result<(), Box<dyn Error>> {
    let waypoints = [Point3::new(0.0, 0.0, 2.0), Point3::new(10.0, 0.0, 2.0), Point3::new(10.0, 10.0, 2.0)];
    // Along both legs at 1 m/s, carried 0.8 m beyond the corner and back.
    let place = |t: f64| match t {
        t if t <= 10.0 => [t, 0.0],
        t if t <= 12.0 => [10.0 + 0.8 * ((t - 10.0) * std::f64::consts::FRAC_PI_2).sin(), t - 10.0],
        t => [10.0, t - 10.0],
    };
    let times: Vec<f64> = (0..=200).map(|i| f64::from(i) / 10.0).collect();
    let poses = times.iter().map(|t| Isometry3::translation(place(*t)[0], place(*t)[1], 2.0)).collect();
    let leg = Channel { name: "leg".into(), values: times.iter().map(|t| f64::from(*t > 10.0)).collect() };
    let track = Track::new(times, poses, vec![leg])?;

    for (name, reference) in [("leg", Reference::Leg), ("nearest leg", Reference::NearestLeg)] {
        let settings = Settings { reference, ..Settings::default() };
        let measures = measure(&track, &waypoints, &settings)?;
        let (most, at, leg) = (measures.max_deviation, measures.t_worst, measures.leg_worst);
        let overshoot = measures.max_overshoot();
        println!("from the {name}: worst {most:.2} m at {at:.1} s on leg {leg}, overshoot {overshoot:.2} m");
        let off: Vec<f64> = deviation_of_samples(&track, &waypoints, &settings)?.into_iter().flatten().collect();
        if let Some(told) = Statistics::of(&off) {
            let Statistics { max, mean, median, min, rmse, sse, std } = told;
            print!("  max {max:.3} mean {mean:.3} median {median:.3} min {min:.3} ");
            println!("rmse {rmse:.3} sse {sse:.3} std {std:.3}");
        }
    }
    Ok(())
}
