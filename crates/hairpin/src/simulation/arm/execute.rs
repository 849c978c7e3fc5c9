//! The run: servos follow the plan's set points, faults and all, and a recording comes out.

use nalgebra::{Isometry3, Translation3, Vector3};

use super::faults::{Fault, Play};
use super::follow::Stop;
use super::plan::{Plan, Timed};
use super::servo::Servo;
use super::settings::{Noise, RunSettings};
use super::steered::{ArmState, JointPlan, Steering, Steersman};
use crate::math::random::{Stream, named_seed, standard_normals, stream, unit};
use crate::math::rotation::from_rotation_vector;
use crate::robot::arm::{AXES, Joints};
use crate::simulation::SimulationError;
use crate::trajectory::{Channel, Track};

/// Column `status` of a recording.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Status {
    /// The set points stand still.
    Waiting = 0,
    /// The set points move.
    Moving = 1,
    /// The program ended before its end.
    Stopped = 2,
}

/// What came of a program.
///
/// After the last set point samples go on for eight time constants of the slowest servo, and, where the arm is still on
/// its way then, until it rests: three times as long as the plan more at most.
#[derive(Debug, Clone)]
pub struct Run {
    /// `base_from_tcp` over time, with `speed_m_s` (of the tool's point since the last sample), `q1_rad` … `q6_rad`,
    /// `move` (from 0) and `status` ([`Status`]).
    pub recording: Track,
    /// Where the program ended before its end, and why.
    pub stop: Option<Stop>,
    /// Whether every joint ends within 0.01 rad of where the plan ends, plays and offsets of the tool aside.
    pub arrived: bool,
    /// Set points of the servos.
    pub interpolation_steps: u64,
}

/// Time that is recorded after the last set point has come to rest, in time constants of the slowest servo.
const LINGER: f64 = 8.0;
/// Times the plan's duration that an arm is followed for beyond it while it is still on its way.
const OVERRUN: f64 = 3.0;
/// An arm that turns no faster than this rests, rad/s; one that is nearer to its plan's end than this is no longer on
/// its way, rad.
const RESTS: f64 = 0.01;
const NEAR: f64 = 1e-3;
/// An arm that ends farther than this from where its plan does has not arrived, rad: centimetres at a usual reach,
/// many times what lags leave.
const ARRIVED: f64 = 0.01;

/// What follows the set points.
struct Joint {
    servo: Servo,
    play: Option<Play>,
}

impl Plan<'_> {
    /// Lets the servos follow the plan. The same `seed` gives the same recording.
    ///
    /// Linear in the duration over `interpolation`.
    ///
    /// Per set point q_k follows by its servo, then by its play; the pose recorded is forward(q) · tool · offset, which
    /// noise of an instrument is added to. Three streams of `seed`: pauses, and what is measured, so that faults move
    /// no noise.
    ///
    /// # Errors
    /// Settings or faults out of their bounds.
    pub fn execute(&self, settings: &RunSettings, faults: &[Fault], seed: u64) -> Result<Run, SimulationError> {
        self.execute_by(settings, faults, seed, None)
    }

    /// The same where a controller of the caller's own gives the servos their set points, if one is given: it is told
    /// the plan in time. As reproducible as the controller is.
    ///
    /// ```text
    /// u(t)  set point of the plan at t − pauses − delays, rad (or the caller's)
    /// q_k ← play_k(servo_k(u_k)),   pose = forward(q) · tool · offset
    /// ```
    ///
    /// One set point every sample/n s, n = round(sample/interpolation), at least 1. Samples are at multiples of
    /// `sample`, the first at 0 at rest. A caller's controller sees angles and rates (rad, rad/s, backward
    /// differences) at the beginning of each period.
    ///
    /// # Errors
    /// As [`Self::execute`]; a period out of bounds; [`SimulationError::Controller`].
    pub fn execute_by(
        &self,
        settings: &RunSettings,
        faults: &[Fault],
        seed: u64,
        steering: Option<Steering<'_>>,
    ) -> Result<Run, SimulationError> {
        settings.check()?;
        faults.iter().try_for_each(Fault::check)?;
        let parts = (settings.sample / settings.interpolation).round().max(1.0) as usize;
        let step = settings.sample / parts as f64;
        let begins = self.begins(faults, &settings.noise, seed);
        let offset = faults.iter().fold(Isometry3::identity(), |tool, fault| match fault {
            Fault::ToolOffset(offset) => tool * offset,
            _ => tool,
        });
        let lags: [f64; AXES] = std::array::from_fn(|k| settings.lags[k] + extra(faults, k));
        let mut joints: Vec<Joint> = (0..AXES).map(|k| self.joint(faults, k, lags[k], step)).collect();
        let slowest = lags.into_iter().fold(0.0, f64::max);
        let end = match (self.timed.last(), begins.last()) {
            (Some(last), Some(begin)) => begin + last.law.duration(),
            _ => 0.0,
        };
        let samples = ((end + LINGER * slowest) / settings.sample).ceil() as usize + 1;
        let most = samples + (OVERRUN * end / settings.sample).ceil() as usize;
        let mut column = Columns::with_capacity(samples);
        let mut random = stream(named_seed(seed, "measured", 0));
        let steered = |steering| Steersman::new(self.arm, steering, self.joint_plan(step), step);
        let mut steersman = steering.map(steered).transpose()?;
        let mut cursor = Cursor { section: 0, span: 0 };
        let (mut from, mut measured): (Joints, Joints) = (*self.start(), *self.start());
        let mut rates = [0.0; AXES];
        let mut last = *self.start();
        let mut sample = 0;
        while sample < samples || sample < most && on_its_way(&joints, &last, &rates) {
            if sample > 0 {
                for part in 1..=parts {
                    let t = ((sample - 1) * parts + part) as f64 * step;
                    last = cursor.set_point(&self.timed, &begins, t);
                    let to = match &mut steersman {
                        None => last,
                        Some(steersman) => {
                            let state = ArmState { t: t - step, joints: measured, rates };
                            steersman.set_point(&from, step, state, cursor.order(self) + 1)?
                        }
                    };
                    for (k, joint) in joints.iter_mut().enumerate() {
                        let angle = joint.servo.follow(from[k], to[k]);
                        let angle = joint.play.as_mut().map_or(angle, |play| play.follow(angle));
                        (rates[k], measured[k]) = ((angle - measured[k]) / step, angle);
                    }
                    from = to;
                }
            }
            let time = sample as f64 * settings.sample;
            let (order, status) = cursor.place(self, &begins, time, end);
            let pose = self.arm.forward(&measured) * self.orders[order].tool * offset;
            column.push(time, pose, &measured, order, status, &settings.noise, &mut random);
            sample += 1;
        }
        let interpolation_steps = ((sample - 1) * parts) as u64;
        let arrived = farthest(&joints, &last) <= ARRIVED;
        Ok(Run { recording: column.track(settings.sample), stop: self.stop().copied(), arrived, interpolation_steps })
    }

    /// Set points every `step` s, without pauses and delays: what is planned.
    fn joint_plan(&self, step: f64) -> JointPlan {
        let begins: Vec<f64> = self.timed.iter().map(|timed| timed.begin).collect();
        let mut cursor = Cursor { section: 0, span: 0 };
        let count = (self.duration() / step).ceil() as usize;
        let joints = (0..=count).map(|i| cursor.set_point(&self.timed, &begins, i as f64 * step)).collect();
        JointPlan { period: step, joints }
    }

    /// Joint k, from 0, with the faults that are about it; of several plays the last counts, shares of speed multiply.
    fn joint(&self, faults: &[Fault], k: usize, lag: f64, step: f64) -> Joint {
        let angle = self.start()[k];
        let (mut speed, mut play) = (self.arm.limits[k].speed, None);
        for fault in faults {
            match fault {
                Fault::SlowAxis { axis, share } if *axis == k + 1 => speed *= share,
                Fault::Backlash { axis, width } if *axis == k + 1 => play = Some(Play::new(*width, angle)),
                _ => {}
            }
        }
        Joint { servo: Servo::new(lag, step, speed, angle), play }
    }

    /// When each section begins in this run.
    ///
    /// s, one a section: what the plan says, later by all pauses and delays so far.
    fn begins(&self, faults: &[Fault], noise: &Noise, seed: u64) -> Vec<f64> {
        let mut random = stream(named_seed(seed, "pause", 0));
        let mut late = 0.0;
        let mut pending: Vec<(usize, f64)> = faults
            .iter()
            .filter_map(|fault| match fault {
                Fault::DelayedStart { order, delay } => Some((*order, *delay)),
                _ => None,
            })
            .collect();
        let mut begins = Vec::with_capacity(self.timed.len());
        for (number, Timed { section, begin, .. }) in self.timed.iter().enumerate() {
            // The first move that this section sets out for.
            let first = section.spans.first().map_or(0, |span| span.order);
            if !section.spans.is_empty() {
                pending.retain(|(order, delay)| {
                    let now = *order <= first;
                    late += if now { *delay } else { 0.0 };
                    !now
                });
            }
            if number > 0 {
                late += noise.pause * unit(&mut random);
            }
            begins.push(begin + late);
        }
        begins
    }
}

/// Whether an arm still turns that has not come to where its plan ended, `last` (rad).
fn on_its_way(joints: &[Joint], last: &Joints, rates: &Joints) -> bool {
    farthest(joints, last) > NEAR && rates.iter().any(|rate| rate.abs() > RESTS)
}

/// The largest distance of a servo from `to`, rad.
fn farthest(joints: &[Joint], to: &Joints) -> f64 {
    joints.iter().zip(to).map(|(joint, to)| (joint.servo.at() - to).abs()).fold(0.0, f64::max)
}

/// What faults add to the lag of joint k (from 0), s.
fn extra(faults: &[Fault], k: usize) -> f64 {
    let lags = faults.iter().map(|fault| match fault {
        Fault::ExtraLag { axis, lag } if *axis == k + 1 => *lag,
        _ => 0.0,
    });
    lags.sum()
}

/// Where the set points are; time only goes on.
struct Cursor {
    section: usize,
    span: usize,
}

impl Cursor {
    /// Joint angles planned for `t` s, rad; between sections those where the last one ended.
    fn set_point(&mut self, timed: &[Timed], begins: &[f64], t: f64) -> Joints {
        while self.section + 1 < timed.len() && t >= begins[self.section + 1] {
            (self.section, self.span) = (self.section + 1, 0);
        }
        let Timed { section, law, .. } = &timed[self.section];
        if section.spans.is_empty() {
            return section.joints[0];
        }
        let s = law.at(t - begins[self.section]).s;
        self.span = section.span(s, self.span);
        section.joints_at(self.span, s)
    }

    /// The move that is being executed.
    fn order(&self, plan: &Plan) -> usize {
        let spans = &plan.timed[self.section].section.spans;
        spans.get(self.span).map_or(0, |span| span.order).min(plan.orders.len() - 1)
    }

    /// The move that is being executed, and whether the set points move.
    ///
    /// The section is the one that the set points are in; `end` is when the last law is over, s.
    fn place(&self, plan: &Plan, begins: &[f64], time: f64, end: f64) -> (usize, Status) {
        let law = &plan.timed[self.section].law;
        let since = time - begins[self.section];
        let moving = since >= 0.0 && since < law.duration();
        let order = self.order(plan);
        let status = match (moving, plan.stop()) {
            (true, _) => Status::Moving,
            (false, Some(_)) if time >= end => Status::Stopped,
            _ => Status::Waiting,
        };
        (order, status)
    }
}

/// A recording in the making.
struct Columns {
    times: Vec<f64>,
    poses: Vec<Isometry3<f64>>,
    /// Of the tool's point, before noise.
    places: Vec<Vector3<f64>>,
    joints: [Vec<f64>; AXES],
    orders: Vec<f64>,
    status: Vec<f64>,
}

impl Columns {
    fn with_capacity(samples: usize) -> Self {
        let column = || Vec::with_capacity(samples);
        Self {
            times: column(),
            poses: Vec::with_capacity(samples),
            places: Vec::with_capacity(samples),
            joints: std::array::from_fn(|_| column()),
            orders: column(),
            status: column(),
        }
    }

    #[expect(clippy::too_many_arguments, reason = "one sample's columns")]
    fn push(
        &mut self,
        time: f64,
        pose: Isometry3<f64>,
        joints: &Joints,
        order: usize,
        status: Status,
        noise: &Noise,
        random: &mut Stream,
    ) {
        self.times.push(time);
        self.places.push(pose.translation.vector);
        self.poses.push(measured(&pose, noise, random));
        let shifts = if noise.joints > 0.0 { standard_normals::<AXES>(random) } else { [0.0; AXES] };
        for (k, column) in self.joints.iter_mut().enumerate() {
            column.push(joints[k] + noise.joints * shifts[k]);
        }
        self.orders.push(order as f64);
        self.status.push(f64::from(status as u8));
    }

    /// Speeds by differences of places without noise, m/s.
    ///
    /// The first sample has speed 0. Differences over one sample: a speed that changes within it is seen as its mean.
    fn track(self, sample: f64) -> Track {
        let still = std::iter::once(0.0);
        let speed = still.chain(self.places.windows(2).map(|pair| (pair[1] - pair[0]).norm() / sample)).collect();
        let mut channels = vec![Channel { name: "speed_m_s".into(), values: speed }];
        for (k, values) in self.joints.into_iter().enumerate() {
            channels.push(Channel { name: format!("q{}_rad", k + 1), values });
        }
        channels.push(Channel { name: "move".into(), values: self.orders });
        channels.push(Channel { name: "status".into(), values: self.status });
        Track::new(self.times, self.poses, channels).expect("times rise and all numbers are finite")
    }
}

/// What an instrument says of `pose`.
///
/// p + σ_p n₁,  R · exp(σ_o n₂ as a rotation vector), with n₁, n₂ of three standard normals each: the turn is about
/// axes of the tool. Draws six numbers where either is not 0, none else.
fn measured(pose: &Isometry3<f64>, noise: &Noise, random: &mut Stream) -> Isometry3<f64> {
    if noise.position == 0.0 && noise.orientation == 0.0 {
        return *pose;
    }
    let [x, y, z, a, b, c] = standard_normals::<6>(random);
    let shift = Vector3::new(x, y, z) * noise.position;
    let turn = from_rotation_vector(&(Vector3::new(a, b, c) * noise.orientation));
    Isometry3::from_parts(Translation3::from(pose.translation.vector + shift), pose.rotation * turn)
}

#[cfg(feature = "unit-tests")]
pub(super) mod tests_only {
    use super::{Cursor, Joints, Plan};

    /// Set points every `step` s until the end.
    pub(in crate::simulation::arm) fn set_points(plan: &Plan, step: f64) -> Vec<Joints> {
        let begins: Vec<f64> = plan.timed.iter().map(|timed| timed.begin).collect();
        let mut cursor = Cursor { section: 0, span: 0 };
        (0..=(plan.duration() / step) as usize)
            .map(|i| cursor.set_point(&plan.timed, &begins, i as f64 * step))
            .collect()
    }
}
