//! Witness legs of the shipped `quadrotor` scenario: candidates judged, and accepted ones proven between samples.

use hairpin::feasibility::Limits;
use hairpin::feasibility::steering::{LegEnd, LegJudge, ProofSettings};
use hairpin::math::random::stream;
use hairpin_formats::scenario::setup_for;
use hairpin_jobs::Problem;
use nalgebra::{Point3, Vector3};
use rand::RngExt;

use super::flyer::flyer;
use super::row::Row;
use crate::clock::median_rate;

pub(super) fn rows() -> Vec<Row> {
    vec![
        Row::at_least("witness-legs-judged", "1/s", 300_000.0, |_| judged()),
        Row::at_least("witness-legs-proven", "1/s", 30_000.0, |_| proven()),
    ]
}

struct Legs {
    judge: LegJudge,
    candidates: Vec<(LegEnd, LegEnd, f64)>,
}

impl Legs {
    /// Random pairs of waypoint states no farther apart than the speed limit allows, with a leg time of the ladder's
    /// range.
    fn new(count: usize) -> Result<Self, Problem> {
        let setup = setup_for("quadrotor", &[])?;
        let setup = flyer(&setup)?;
        let given = setup.scenario.generate.limits;
        let max_speed = given.max_speed_m_s.unwrap_or(setup.robot.max_speed);
        let limits = Limits { max_speed, max_tilt: given.max_tilt_deg.unwrap_or(90.0).to_radians() };
        let judge = LegJudge::new(&setup.robot, &setup.world, limits, ProofSettings::default());
        let judge = judge.map_err(Problem::input)?;
        let [shortest, longest] = setup.scenario.generate.timing_in_force().leg_time_s.unwrap_or([0.8, 4.0]);
        let (margin, size) = (setup.world.keep_in_margin(), setup.world.size());
        let mut random = stream(1);
        let mut candidates = Vec::with_capacity(count);
        while candidates.len() < count {
            let mut end = || {
                let p = Point3::from(Vector3::from_fn(|i, _| random.random_range(margin..size[i] - margin)));
                let v = Vector3::from_fn(|_, _| random.random_range(-1.0..1.0));
                judge.end(p, v.normalize() * random.random_range(0.0..max_speed))
            };
            let (from, to) = (end(), end());
            let duration = shortest * (longest / shortest).powf(random.random_range(0.0..1.0));
            if (to.position - from.position).norm() <= max_speed * duration {
                candidates.push((from, to, duration));
            }
        }
        Ok(Self { judge, candidates })
    }
}

fn judged() -> Result<f64, Problem> {
    let Legs { judge, candidates } = Legs::new(20_000)?;
    Ok(median_rate(9, || {
        let accepted = candidates.iter().filter(|(from, to, t)| judge.judge(from, to, *t).is_ok()).count();
        std::hint::black_box(accepted);
        candidates.len() as u64
    }))
}

fn proven() -> Result<f64, Problem> {
    let Legs { judge, candidates } = Legs::new(400_000)?;
    let legs: Vec<_> = candidates.iter().filter_map(|(from, to, t)| judge.judge(from, to, *t).ok()).collect();
    if legs.is_empty() {
        return Err(Problem::input("no candidate leg of the bench is accepted"));
    }
    Ok(median_rate(9, || legs.iter().filter(|leg| judge.prove(leg).is_ok()).count() as u64))
}
