//! From a track to its measures. The judge is given poses in time, the waypoints that were asked for, and a distance
//! to obstacles as a closure; so it judges a real log as it does our own simulator, also against obstacles that were
//! not there.

use nalgebra::{Point3, Vector3};

use super::carried_on::counts_beyond;
use super::deviation::{Off, deviations, legs_along, legs_flown};
use super::resolution::{AccelerationSource, SEEN_WITHIN_S, Unresolved};
use super::settings::{JudgementError, Reference, Settings};
use super::{LegMeasures, Measures};
use crate::math::segment::nearest_point;
use crate::trajectory::{ATTITUDE_UNKNOWN, Track};

/// Measures `track` against the polyline through `waypoints`.
///
/// With position p_i, time t_i and leg l(i) of sample i, waypoints w_k, and direction u_k of leg k:
/// - deviation d_i = ‖p_i − segment(w_l, w_l+1)‖ (or [`super::Reference`]); its mean is weighted by time,
///   h_i = (t_i+1 − t_i−1)/2, over the samples that count (see [`Settings::corner`]);
/// - overshoot at waypoint k = max over samples of (p_i − q_i)·u_k−1, at least 0, with q_i = w_k while leg k−1 is
///   flown, and q_i = the point of leg k's segment nearest to p_i while leg k is flown; against a path
///   ([`super::Reference::Path`]) q_i = its place for p_i in both cases: how far the robot is carried on in the
///   direction in
///   which it came, beyond where it should be. Samples count while ‖q_i − w_k‖ ≤ 5 (p_i − q_i)·u_k−1, while the robot,
///   seen from the waypoint, is still carried on: who rests there, turns and strays farther along the next leg, strays.
///   Going straight on is no overshoot;
/// - acceleration ‖v_i+1 − v_i−1‖/(t_i+1 − t_i−1) with the channels `vx_m_s`, `vy_m_s`, `vz_m_s` (one-sided at the
///   ends), or the second divided difference of positions where they are missing; speed rate: |‖v_i+1‖ − ‖v_i−1‖| over
///   the same time. Of what is told in steps rows farther apart are looked at too ([`Settings::resolution`]);
/// - tip-over margin: least value of the channel `tip_over_margin_deg`;
/// - tilt: 2 asin √(q_x² + q_y²), the angle between the body's upward axis and the world's; not of tracks with joints,
///   whose pose is a tool's;
/// - saturation: mean over time of the channel `saturated`;
/// - joint effort: Σ_i h_i Σ_k q̈_k², q̈ the second divided difference of the channels `q1_rad`, `q2_rad` …: with a
///   recording's noise of σ it has about 6σ²/Δ⁴ a second and joint too much.
///
/// The leg comes from the channel `leg`; the number of waypoints less one, "all reached", counts as the last leg.
/// Without the channel samples are assigned to legs monotonically along the path, and the result says so. Maxima are
/// over samples: nothing is assumed of the motion between them.
///
/// Units are SI, angles in degrees. Linear in the samples where the executor told legs; samples × 256 pieces where they
/// are assigned.
///
/// ```
/// use hairpin::judgement::{Settings, measure};
/// use hairpin::trajectory::{Channel, Track};
/// use nalgebra::{Isometry3, Point3};
///
/// // Along x from 0 to 10 m, 0.2 m beside the leg half-way.
/// let poses = (0..=10).map(|i| Isometry3::translation(f64::from(i), if i == 5 { 0.2 } else { 0.0 }, 1.0)).collect();
/// let leg = Channel { name: "leg".into(), values: vec![0.0; 11] };
/// let track = Track::new((0..=10).map(f64::from).collect(), poses, vec![leg])?;
/// let waypoints = [Point3::new(0.0, 0.0, 1.0), Point3::new(10.0, 0.0, 1.0)];
/// let measures = measure(&track, &waypoints, &Settings::default())?;
/// assert!((measures.max_deviation - 0.2).abs() < 1e-12 && measures.t_worst == 5.0);
/// assert!((measures.mean_deviation - 0.02).abs() < 1e-12 && measures.total_time == 10.0);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`JudgementError`].
pub fn measure(track: &Track, waypoints: &[Point3<f64>], settings: &Settings) -> Result<Measures, JudgementError> {
    check(track, waypoints, settings)?;
    let positions: Vec<Point3<f64>> = (0..track.len()).map(|i| track.position(i)).collect();
    let weights = time_weights(track.times(), settings);
    let (legs, leg_source) = legs_flown(track, waypoints, &positions, &weights)?;
    let off = deviations(&positions, &weights, waypoints, &legs, settings)?;

    let mut measures = Measures {
        leg_source,
        total_time: track.times()[track.len() - 1] - track.times()[0],
        legs: vec![LegMeasures::default(); waypoints.len() - 1],
        place_unresolved: Some(settings.resolution.place.moved).filter(|moved| *moved > 0.0),
        ..Measures::default()
    };
    measure_deviation(&mut measures, track.times(), &weights, &legs, &off);
    measure_overshoot(&mut measures, track.times(), &positions, waypoints, &legs, &off);
    measure_acceleration(&mut measures, track, &positions, &legs, settings);
    measure_clearance(&mut measures, track.times(), &positions, &legs, settings)?;
    if let Some(margins) = track.channel("tip_over_margin_deg") {
        measure_tip_over(&mut measures, track.times(), margins, &legs);
    }
    if track.channel(ATTITUDE_UNKNOWN).is_none() && track.channel("q1_rad").is_none() {
        measure_tilt(&mut measures, track, &legs);
    }
    if let Some(saturated) = track.channel("saturated") {
        let mean = |leg: Option<usize>| {
            let own = (0..legs.len()).filter(|&i| leg.is_none_or(|leg| legs[i] == leg));
            weighted_mean(own.map(|i| (weights[i], saturated[i])))
        };
        measures.saturation_share = mean(None);
        for leg in 0..measures.legs.len() {
            measures.legs[leg].saturation_share = mean(Some(leg));
        }
    }
    measure_effort(&mut measures, track, &weights, &legs, settings);
    measured(measures)
}

/// `measures`, if all of them are numbers: of what is too far apart, or too near in time, some are not.
fn measured(measures: Measures) -> Result<Measures, JudgementError> {
    let all = [
        ("max_deviation_m", measures.max_deviation),
        ("mean_deviation_m", measures.mean_deviation),
        ("max_overshoot_m", measures.max_overshoot()),
        ("max_acceleration_m_s2", measures.max_acceleration),
        ("max_speed_rate_m_s2", measures.max_speed_rate),
        ("total_time_s", measures.total_time),
        ("joint_effort_rad2_s3", measures.joint_effort.unwrap_or_default()),
    ];
    match all.into_iter().find(|(_, value)| !value.is_finite()) {
        Some((what, value)) => Err(JudgementError::Overflow { what, value }),
        None => Ok(measures),
    }
}

/// What is no number any more is larger than any: it must not be passed over where a maximum is taken.
fn beyond_numbers(value: f64) -> f64 {
    if value.is_nan() { f64::INFINITY } else { value }
}

/// Distance of every sample from the reference, m, as [`measure`] judges it; `None` inside [`Settings::corner`].
///
/// # Errors
/// [`JudgementError`].
///
/// For figures and for kept rows: one entry a sample, `None` also of nothing that a path leaves out.
pub fn deviation_of_samples(
    track: &Track,
    waypoints: &[Point3<f64>],
    settings: &Settings,
) -> Result<Vec<Option<f64>>, JudgementError> {
    check(track, waypoints, settings)?;
    let positions: Vec<Point3<f64>> = (0..track.len()).map(|i| track.position(i)).collect();
    let weights = time_weights(track.times(), settings);
    let (legs, _) = legs_flown(track, waypoints, &positions, &weights)?;
    Ok(deviations(&positions, &weights, waypoints, &legs, settings)?.into_iter().map(|off| off.distance).collect())
}

/// The leg that every sample belongs to, as [`measure`] has it; of a track that tells none, beside a path that does,
/// the leg of the place on the path that it belongs to: a path need not lead straight from waypoint to waypoint.
///
/// # Errors
/// [`JudgementError`].
///
/// From 0; as many as samples.
pub fn legs_of_samples(
    track: &Track,
    waypoints: &[Point3<f64>],
    settings: &Settings,
) -> Result<Vec<usize>, JudgementError> {
    check(track, waypoints, settings)?;
    let positions: Vec<Point3<f64>> = (0..track.len()).map(|i| track.position(i)).collect();
    let weights = time_weights(track.times(), settings);
    if let (None, Reference::Path(path)) = (track.channel("leg"), settings.reference)
        && let Some(legs) = legs_along(&positions, &weights, path, waypoints.len() - 2)?
    {
        return Ok(legs);
    }
    Ok(legs_flown(track, waypoints, &positions, &weights)?.0)
}

pub(super) fn check(track: &Track, waypoints: &[Point3<f64>], settings: &Settings) -> Result<(), JudgementError> {
    if track.is_empty() {
        return Err(JudgementError::NoSamples);
    }
    if waypoints.len() < 2 {
        return Err(JudgementError::Waypoints { found: waypoints.len() });
    }
    if let Some(index) = waypoints.iter().position(|w| !w.iter().all(|c| c.is_finite())) {
        let value = format!("{:?}", waypoints[index].coords.as_slice());
        return Err(JudgementError::NotFinite { field: format!("waypoints[{index}]"), value, bound: "" });
    }
    if !(settings.corner >= 0.0 && settings.corner.is_finite()) {
        let value = settings.corner.to_string();
        return Err(JudgementError::NotFinite { field: "corner_m".into(), value, bound: " and ≥ 0" });
    }
    Ok(())
}

/// The time each sample stands for, s: half of each neighbouring interval. One sample alone counts 1.
pub(super) fn time_weights(times: &[f64], settings: &Settings) -> Vec<f64> {
    if times.len() == 1 {
        return vec![1.0];
    }
    let half = |(before, after): (usize, usize)| 0.5 * (times[after] - times[before]);
    (0..times.len()).map(|i| half(settings.neighbours(i, times.len()))).collect()
}

/// Greatest and mean distance off the path (m), the mean weighted by the time that each sample stands for; samples
/// whose distance is not known count for neither.
fn measure_deviation(measures: &mut Measures, times: &[f64], weights: &[f64], legs: &[usize], off: &[Off]) {
    let mut worst = -1.0;
    for (i, (&leg, off)) in legs.iter().zip(off).enumerate() {
        if times.len() > 1 {
            measures.legs[leg].time += weights[i];
        }
        let Some(deviation) = off.distance.map(beyond_numbers) else { continue };
        measures.legs[leg].max_deviation = measures.legs[leg].max_deviation.max(deviation);
        if deviation > worst {
            worst = deviation;
            (measures.max_deviation, measures.t_worst, measures.leg_worst) = (deviation, times[i], leg);
        }
    }
    let mean = |leg: Option<usize>| {
        let own = (0..legs.len()).filter(|&i| leg.is_none_or(|leg| legs[i] == leg));
        weighted_mean(own.filter_map(|i| Some((weights[i], off[i].distance?)))).unwrap_or(0.0)
    };
    measures.missing.deviation = off.iter().all(|off| off.distance.is_none());
    measures.mean_deviation = mean(None);
    for leg in 0..measures.legs.len() {
        measures.legs[leg].mean_deviation = mean(Some(leg));
    }
}

/// How far the track got beyond its place, in a leg's direction, (p − p₀)·d (m): for the sample's own leg and, in its
/// direction, for the one before. p₀ is the sample's place on the path, else the leg's end (for the leg before: its
/// nearest point). Where that is farther from the leg's end than it is carried on nearby, it is off, not carried on.
fn measure_overshoot(
    measures: &mut Measures,
    times: &[f64],
    positions: &[Point3<f64>],
    waypoints: &[Point3<f64>],
    legs: &[usize],
    off: &[Off],
) {
    let direction = |leg: usize| (waypoints[leg + 1] - waypoints[leg]).try_normalize(0.0).unwrap_or(Vector3::zeros());
    let mut worst = 0.0;
    for (i, (p, &leg)) in positions.iter().zip(legs).enumerate() {
        let mut note = |incoming: usize, from: &Point3<f64>| {
            let beyond = beyond_numbers((p - from).dot(&direction(incoming)));
            if !counts_beyond(beyond, (from - waypoints[incoming + 1]).norm(), 0.0) {
                return;
            }
            let found = &mut measures.legs[incoming].overshoot;
            *found = found.max(beyond);
            if beyond > worst {
                worst = beyond;
                measures.t_overshoot = times[i];
            }
        };
        note(leg, &off[i].place.unwrap_or(waypoints[leg + 1]));
        if leg > 0 {
            let on_leg = || nearest_point(p, &waypoints[leg], &waypoints[leg + 1]);
            note(leg - 1, &off[i].place.unwrap_or_else(on_leg));
        }
    }
    measures.overshoots = measures.legs.iter().map(|leg| leg.overshoot).collect();
}

/// Accelerations |Δv|/Δt (m/s²): over two intervals where the track tells velocities, at its two ends over one; else of
/// the velocities between three positions. Beside it the rate of the speed alone, |Δ|v||/Δt, which bends leave out.
///
/// Of what is told in steps ([`Resolution`](super::Resolution)) rows that are farther apart are looked at as well, up
/// to [`SEEN_WITHIN_S`] from the first to the last: each is a mean of the acceleration between them, so that none
/// exceeds the largest. What counts is the one that exceeds most for certain.
fn measure_acceleration(
    measures: &mut Measures,
    track: &Track,
    positions: &[Point3<f64>],
    legs: &[usize],
    settings: &Settings,
) {
    let times = track.times();
    let columns = ["vx_m_s", "vy_m_s", "vz_m_s"].map(|name| track.channel(name));
    let velocities: Option<Vec<Vector3<f64>>> = match columns {
        [Some(x), Some(y), Some(z)] => Some((0..x.len()).map(|i| Vector3::new(x[i], y[i], z[i])).collect()),
        _ => None,
    };
    measures.acceleration_source =
        if velocities.is_some() { AccelerationSource::Velocity } else { AccelerationSource::Position };
    measures.missing.acceleration = true;
    let step = settings.resolution.of_source(measures.acceleration_source);
    let differing = Differing { times, positions, velocities: velocities.as_deref(), step: step.all };
    // What is exceeded for certain; of what is told exactly that is the measure itself.
    let begin = if step.all > 0.0 { f64::NEG_INFINITY } else { 0.0 };
    let (mut certain, mut rate_certain) = (begin, begin);
    let mut of_legs = vec![begin; measures.legs.len()];
    for (i, &leg) in legs.iter().enumerate() {
        let mut reach = 1;
        while let Some(Differs { acceleration, rate, by, over, whole }) = differing.at(i, reach, settings) {
            if reach > 1 && whole > SEEN_WITHIN_S {
                break;
            }
            measures.missing.acceleration = false;
            if acceleration - by > of_legs[leg] {
                (of_legs[leg], measures.legs[leg].max_acceleration) = (acceleration - by, acceleration);
            }
            if rate - by > rate_certain {
                (rate_certain, measures.max_speed_rate) = (rate - by, rate);
            }
            if acceleration - by > certain {
                (certain, measures.max_acceleration, measures.t_acceleration) =
                    (acceleration - by, acceleration, times[i]);
                measures.acceleration_unresolved = (by > 0.0).then_some(Unresolved { by, step: step.each, over });
            }
            if step.all == 0.0 {
                break;
            }
            reach += reach.div_ceil(3);
        }
    }
    for leg in &mut measures.legs {
        leg.max_acceleration = leg.max_acceleration.min(measures.max_acceleration);
    }
}

/// Rows that accelerations are differences of.
struct Differing<'a> {
    times: &'a [f64],
    positions: &'a [Point3<f64>],
    velocities: Option<&'a [Vector3<f64>]>,
    /// In which the numbers are told, the length of its vector.
    step: f64,
}

/// A difference, m/s².
struct Differs {
    acceleration: f64,
    rate: f64,
    /// What rounding may make of it.
    by: f64,
    /// The time between its rows, and from its first to its last, s.
    over: f64,
    whole: f64,
}

impl Differing<'_> {
    /// Of sample `i` and those that are `reach` before and after it; `None` where they are not all in one piece.
    fn at(&self, i: usize, reach: usize, settings: &Settings) -> Option<Differs> {
        let later = settings.breaks.partition_point(|first| *first <= i);
        let begins = later.checked_sub(1).map_or(0, |before| settings.breaks[before]);
        let ends = settings.breaks.get(later).map_or(self.times.len(), |first| self.times.len().min(*first));
        let (before, after) = (i.saturating_sub(reach).max(begins), (i + reach).min(ends - 1));
        let whole = self.times[after] - self.times[before];
        let is_whole = before + reach == i && after == i + reach;
        let (change, rate, span, by, over) = match self.velocities {
            Some(v) if after > before && (is_whole || reach == 1) => {
                let rate = (v[after].norm() - v[before].norm()).abs();
                (v[after] - v[before], rate, whole, self.made_of(1.0 / whole), whole)
            }
            None if is_whole => {
                let (first, second) = (self.times[i] - self.times[before], self.times[after] - self.times[i]);
                let came = (self.positions[i] - self.positions[before]) / first;
                let goes = (self.positions[after] - self.positions[i]) / second;
                let by = self.made_of(2.0 / (first * second));
                (goes - came, (goes.norm() - came.norm()).abs(), 0.5 * whole, by, 0.5 * whole)
            }
            _ => return None,
        };
        let acceleration = beyond_numbers(change.norm() / span);
        Some(Differs { acceleration, rate: beyond_numbers(rate / span), by, over, whole })
    }

    fn made_of(&self, factor: f64) -> f64 {
        if self.step > 0.0 { self.step * factor } else { 0.0 }
    }
}

/// Least distance (m) of each leg and of all: +∞ is no obstacle at all, −∞ one that it is in, however deep. Nothing is
/// measured without a closure, and what a closure has no number for is no measure.
fn measure_clearance(
    measures: &mut Measures,
    times: &[f64],
    positions: &[Point3<f64>],
    legs: &[usize],
    settings: &Settings,
) -> Result<(), JudgementError> {
    let Some(distance) = settings.clearance else { return Ok(()) };
    for (i, (p, &leg)) in positions.iter().zip(legs).enumerate() {
        let clearance = distance(p);
        if clearance.is_nan() {
            return Err(JudgementError::Clearance { index: i });
        }
        if clearance == f64::INFINITY {
            continue;
        }
        let least = &mut measures.legs[leg].min_clearance;
        *least = Some(least.map_or(clearance, |least| least.min(clearance)));
        if measures.min_clearance.is_none_or(|least| clearance < least) {
            (measures.min_clearance, measures.t_clearance) = (Some(clearance), times[i]);
        }
    }
    Ok(())
}

/// Least value (°) of each leg and of all, with its time.
fn measure_tip_over(measures: &mut Measures, times: &[f64], margins: &[f64], legs: &[usize]) {
    for (i, (&margin, &leg)) in margins.iter().zip(legs).enumerate() {
        let least = &mut measures.legs[leg].min_tip_over_margin;
        *least = Some(least.map_or(margin, |least| least.min(margin)));
        if measures.min_tip_over_margin.is_none_or(|least| margin < least) {
            (measures.min_tip_over_margin, measures.t_tip_over_margin) = (Some(margin), times[i]);
        }
    }
}

/// The angle between body z and world z, 2 asin √(q_x² + q_y²), in degrees: accurate near upright, where a cosine would
/// round.
fn measure_tilt(measures: &mut Measures, track: &Track, legs: &[usize]) {
    let mut worst = (-1.0, 0.0);
    let mut of_legs = vec![-1.0_f64; measures.legs.len()];
    for ((pose, &time), &leg) in track.poses().iter().zip(track.times()).zip(legs) {
        let q = pose.rotation.quaternion();
        let squared = q.i * q.i + q.j * q.j;
        of_legs[leg] = of_legs[leg].max(squared);
        if squared > worst.0 {
            worst = (squared, time);
        }
    }
    let angle = |squared: f64| (squared >= 0.0).then(|| 2.0 * libm::asin(squared.sqrt().min(1.0)).to_degrees());
    (measures.max_tilt, measures.t_tilt) = (angle(worst.0), worst.1);
    for (leg, squared) in measures.legs.iter_mut().zip(of_legs) {
        leg.max_tilt = angle(squared);
    }
}

/// ∫ Σ_k q̈_k² dt in rad²/s³, second differences at unequal steps weighted by the samples' times; the two end samples
/// have none.
fn measure_effort(measures: &mut Measures, track: &Track, weights: &[f64], legs: &[usize], settings: &Settings) {
    let joints: Vec<&[f64]> = (1..).map_while(|k| track.channel(&format!("q{k}_rad"))).collect();
    if joints.is_empty() {
        return;
    }
    let times = track.times();
    let mut of_legs = vec![0.0; measures.legs.len()];
    for i in 1..times.len().saturating_sub(1) {
        let (earlier, later) = settings.neighbours(i, times.len());
        if earlier == i || later == i {
            continue;
        }
        let (before, after) = (times[i] - times[i - 1], times[i + 1] - times[i]);
        let squared = |q: &&[f64]| {
            let bend = ((q[i + 1] - q[i]) / after - (q[i] - q[i - 1]) / before) / (0.5 * (before + after));
            bend * bend
        };
        of_legs[legs[i]] += weights[i] * joints.iter().map(squared).sum::<f64>();
    }
    measures.joint_effort = Some(of_legs.iter().sum());
    for (leg, effort) in measures.legs.iter_mut().zip(of_legs) {
        leg.joint_effort = Some(effort);
    }
}

/// Σ w x / Σ w; `None` without values.
fn weighted_mean(values: impl Iterator<Item = (f64, f64)>) -> Option<f64> {
    let (mut weight, mut sum) = (0.0, 0.0);
    for (w, x) in values {
        weight += w;
        sum += w * x;
    }
    (weight > 0.0).then(|| sum / weight)
}
