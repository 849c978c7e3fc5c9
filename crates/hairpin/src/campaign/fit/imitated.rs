//! Fits by imitation: logs of loops that swing are simulated with noise, again and again, and compared by signs.
//!
//! ```text
//! log ─▶ GroundLog ─▶ signs s
//! θ, noise ─▶ runs of all missions, drawn ─▶ sampled when the log was, off by a drift and by scatter ─▶ signs s_k
//! s, s_k ─▶ math::imitation ─▶ θ̂, noise, covariance ─▶ 95 % interval ─▶ Reading
//! ```
//!
//! Five numbers of noise are fitted with those of the robot, as logarithms: of the poses that the controller sees, of
//! the log's scatter in place and heading, and of its drift in both. None of them is told.

use rayon::prelude::*;

use super::FitError;
use super::answer::Reading;
use super::found::{Disturbance, Found, NO_EFFECT, enough, reading, told, written};
use super::outputs::has;
use super::simulate::Loops;
use crate::campaign::kind::{GroundLog, Imitator, Output};
use crate::judgement::{SIGMA_95, student_quantile};
use crate::math::imitation::Imitation;
use crate::math::output_error::{Parameter, Side};
use crate::math::random::{named_seed, standard_normals, stream};
use crate::trajectory::Track;

/// Numbers of noise, their bounds and their step, as logarithms.
const NOISES: usize = 5;
/// Of each, in ln: 6e-6 … 20 of its unit (m, rad, or the usual noise of poses).
const NOISE: Parameter = Parameter { low: -12.0, high: 3.0, step: 0.15 };
/// What the controller sees is off by so much at first, of the usual noise.
const SEEN: f64 = 0.5;
/// How long a log's drift lasts, s.
///
/// The time after which its correlation is 1/e.
const DRIFT: f64 = 0.7;
/// Where the signs are farther off than this many times what chance makes them, the simulation shows another vehicle.
///
/// A ratio of D to its degrees of freedom; 1 is what chance makes.
const UNLIKE: f64 = 10.0;

/// On the logs `which`, which `imitator` is of.
///
/// ```text
/// θ = (numbers, ln of noise)      half interval = t_{ν, 95 %} √C_kk      ν the freedom of C
/// ```
///
/// An end beyond a bound is open.
///
/// # Errors
/// Too few stretches, a log without headings, one in which the vehicle hardly moves, no simulation that comes to an
/// end, numbers without any effect, or that it was stopped.
pub(super) fn found(
    loops: &Loops,
    imitator: &dyn Imitator,
    given: &[f64],
    which: &[usize],
    stopped: &(dyn Fn() -> bool + Sync),
) -> Result<Found, FitError> {
    let numbers = given.len();
    let stretches = stretches(loops, which);
    enough(loops, stretches)?;
    let observed = observed(loops, imitator, which)?;
    let noise = noise_at_first(imitator, &observed);
    let starts: Vec<Vec<f64>> =
        imitator.starts(&observed, given).into_iter().map(|start| [&start[..], &noise].concat()).collect();
    let signs = |theta: &[f64], draw: u64| if stopped() { None } else { signs(loops, imitator, which, theta, draw) };
    let imitation = Imitation { signs: &signs, observed, parameters: parameters(loops) };
    let over = || if stopped() { FitError::Stopped } else { FitError::Unfinished };
    let all: Vec<usize> = (0..numbers + NOISES).collect();
    let nearest = imitation.nearest(&starts, &all).ok_or_else(over)?;
    let by = |own: usize| match loops.numbers.get(own) {
        Some(number) => 0.25 * nearest[own].abs().max(number.step),
        None => 0.25,
    };
    let imitated = imitation.told(&nearest, &all, &by, NO_EFFECT).ok_or_else(over)?;
    let free: Vec<usize> = imitated.free.iter().copied().filter(|own| *own < numbers).collect();
    if free.is_empty() {
        return Err(FitError::NoEffect);
    }
    let best = imitated.theta;
    let t = student_quantile(imitated.freedom, SIGMA_95);
    let mut readings = vec![(Reading::NoEffect, None); numbers];
    for (k, &own) in free.iter().enumerate() {
        let half = t * imitated.covariance[(k, k)].sqrt();
        let Parameter { low, high, .. } = imitation.parameters[own];
        let end = |at: f64| if at > low && at < high { Side::Closed(at) } else { Side::Open(at.clamp(low, high)) };
        readings[own] = reading(&loops.numbers[own], best[own], [end(best[own] - half), end(best[own] + half)]);
        if imitated.misfit > UNLIKE {
            readings[own].0 = Reading::Unlike;
        }
    }
    let told = told(&free, &readings);
    let written = written(given, &told, &best);
    if stopped() {
        return Err(FitError::Stopped);
    }
    let covariance = imitated.covariance.view((0, 0), (free.len(), free.len())).into_owned();
    let disturbance = Disturbance::Noisy(best[numbers..].to_vec());
    let best = best[..numbers].to_vec();
    Ok(Found { free, told, best, covariance, inflation: imitated.misfit, readings, written, stretches, disturbance })
}

/// All numbers that act, from the logs `which` alone.
///
/// Noise is held as it was found. `None` where that does not come to an end.
pub(super) fn refitted(loops: &Loops, found: &Found, noise: &[f64], which: &[usize]) -> Option<Vec<f64>> {
    let imitator = loops.imitator(which).ok().flatten()?;
    let observed = observed(loops, &*imitator, which).ok()?;
    let signs = |theta: &[f64], draw: u64| signs(loops, &*imitator, which, theta, draw);
    let imitation = Imitation { signs: &signs, observed, parameters: parameters(loops) };
    let start = [&found.best[..], noise].concat();
    imitation.nearest(&[start], &found.free).map(|theta| theta[..found.best.len()].to_vec())
}

fn parameters(loops: &Loops) -> Vec<Parameter> {
    loops.parameters().chain(std::iter::repeat_n(NOISE, NOISES)).collect()
}

/// As good as independent stretches of the logs `which`.
///
/// Σ over logs of floor(samples · period/stretch).
fn stretches(loops: &Loops, which: &[usize]) -> usize {
    let sampling = &loops.rule.sampling;
    let of = |at: &usize| (loops.compared[*at].samples.len() as f64 * sampling.period / sampling.stretch).floor();
    which.iter().map(of).sum::<f64>() as usize
}

/// The signs of the logs `which`.
fn observed(loops: &Loops, imitator: &dyn Imitator, which: &[usize]) -> Result<Vec<f64>, FitError> {
    let log = |at: &usize| {
        let flown = loops.flown[*at];
        if !has(&flown.track, Output::Axis(0, 0)) {
            return Err(FitError::Outputs { log: flown.log.clone(), what: "headings, which a vehicle on wheels" });
        }
        Ok(logged(&flown.track))
    };
    let logs = which.iter().map(log).collect::<Result<Vec<_>, _>>()?;
    imitator.signs(&logs).ok_or(FitError::NotFittable("in some log the vehicle hardly moves".into()))
}

/// Places and headings of a track, which counts from its begin.
///
/// Times in s from 0; x and y in m; ψ in rad, unwrapped: neighbours differ by half a turn at most.
fn logged(track: &Track) -> GroundLog {
    let mut before = 0.0;
    let place = |i: usize| {
        let (at, pose) = (track.position(i), &track.poses()[i]);
        let ahead = pose.rotation * nalgebra::Vector3::x();
        let yaw = libm::atan2(ahead.y, ahead.x);
        let turns = libm::rint((yaw - before) / std::f64::consts::TAU);
        before = yaw - turns * std::f64::consts::TAU;
        [at.x, at.y, before]
    };
    let places = (0..track.len()).map(place).collect();
    GroundLog { times: track.times().iter().map(|t| t - track.times()[0]).collect(), places }
}

/// Scatter as the log's signs have it, and drift as large.
///
/// Standard deviations as logarithms: ½ ln of the variance, cut to the bounds.
fn noise_at_first(imitator: &dyn Imitator, observed: &[f64]) -> [f64; NOISES] {
    let [place, turn] = imitator.scatter(observed).map(|variance| 0.5 * libm::log(variance));
    [libm::log(SEEN), place, turn, place, turn].map(|ln| ln.clamp(NOISE.low, NOISE.high))
}

/// The signs of draw `draw` of the logs `which` with `theta`, noise and all.
///
/// All of chance is drawn from `draw` and the log's number, so that draws are common to all θ. `None` where a run
/// fails.
fn signs(loops: &Loops, imitator: &dyn Imitator, which: &[usize], theta: &[f64], draw: u64) -> Option<Vec<f64>> {
    let (numbers, noise) = theta.split_at(theta.len() - NOISES);
    let setup = loops.with(numbers).ok()?;
    let noise: Vec<f64> = noise.iter().map(|ln| libm::exp(*ln)).collect();
    let log = |own: usize| {
        let seed = named_seed(draw, "imitated", own as u64);
        let track = loops.imitate(&setup, imitator, (which, own), (seed, noise[0]))?;
        Some(seen(&logged(&track), loops.flown[which[own]].track.times(), (&noise[1..], draw, own as u64)))
    };
    imitator.signs(&(0..which.len()).into_par_iter().map(log).collect::<Option<Vec<_>>>()?)
}

/// `driven` when the log was sampled, and as often after it, off as localisations are: by `noise`, scatter and drift,
/// of draw `draw`.
///
/// ```text
/// y = place(t) + scatter ε + slow d,   d ← d e^{−Δt/0.7 s} + √(1 − e^{−2Δt/0.7 s}) ε′,   ε, ε′ ~ N(0, 1)
/// ```
///
/// Δt the log's mean period, d stationary from the first sample on. A run that lasts longer than the log is sampled on
/// at that period.
fn seen(driven: &GroundLog, stamps: &[f64], (noise, draw, own): (&[f64], u64, u64)) -> GroundLog {
    let (begin, end) = (stamps[0], driven.times.last().copied().unwrap_or_default());
    let lasts = stamps[stamps.len() - 1] - begin;
    let period = lasts / (stamps.len() - 1) as f64;
    let after = (1..).map(|k| lasts + f64::from(k) * period).take_while(|t| *t <= end);
    let times: Vec<f64> = stamps.iter().map(|t| t - begin).take_while(|t| *t <= end).chain(after).collect();
    let mut random = stream(named_seed(draw, "seen", own));
    let (keep, mut drift) = (libm::exp(-period / DRIFT), standard_normals::<3>(&mut random));
    let fresh = (1.0 - keep * keep).sqrt();
    let places = times.iter().map(|t| {
        let there = driven.between(*t);
        let (pushed, scattered) = (standard_normals::<3>(&mut random), standard_normals::<3>(&mut random));
        [0, 1, 2].map(|k| {
            drift[k] = drift[k] * keep + pushed[k] * fresh;
            let [scatter, slow] = if k < 2 { [noise[0], noise[2]] } else { [noise[1], noise[3]] };
            there[k] + scatter * scattered[k] + slow * drift[k]
        })
    });
    let places = places.collect();
    GroundLog { times, places }
}
