//! A witness searched afterwards for waypoints that something else found: yes, no, or unknown.
//!
//! Hull-feasible waypoints are a guess about dynamics; a certificate is the polynomial flight itself. "No" is only said
//! of what no dynamics could do: distances, times, walls.
//!
//! The test is one-sided in both directions: `Yes` is a construction, `No` a violated necessary condition, and between
//! the two lies what this one family of polynomials does not decide.

use nalgebra::{Point3, Vector3};

use super::limits::{Infeasible, Limit};
use super::steering::{LegEnd, LegJudge, LegTiming};
use crate::math::minimum_snap::minimum_snap;
use crate::trajectory::Profile;

/// Rounds of slowing down after which the answer is unknown.
const ROUNDS: usize = 100;
/// A leg that fails gets this much more time, or its ends that much less speed.
const SLOWER: f64 = 1.12;

/// What is known of a waypoint list.
///
/// Of the authors' trajectories that are "valid by construction" a third need more than full thrust: `Unknown` and `No`
/// are what that looks like here.
///
/// ```text
/// No        a necessary condition fails: place, distance or time, with the number
/// Yes       every leg proven between samples, total time within the limit
/// Unknown   neither: the leg refused last, its limit and margin
/// ```
#[derive(Debug, Clone, PartialEq)]
pub enum Certificate {
    /// A control witness: level at every waypoint, at rest at both ends, all limits proven.
    Yes(Profile),
    /// Nothing can fly it within the limits.
    No(Impossible),
    /// No witness was found: the leg that failed last, and why.
    Unknown {
        /// Number of the leg.
        leg: usize,
        /// Its evidence.
        why: Infeasible,
    },
}

/// Why nothing can fly a waypoint list.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Impossible {
    /// A waypoint is not in the free space.
    Waypoint {
        /// Number of the waypoint.
        waypoint: usize,
        /// The wall or obstacle.
        why: Infeasible,
    },
    /// A leg's straight line is too long for the speed limit in the longest time it may take.
    Distance {
        /// Number of the leg.
        leg: usize,
        /// The mean speed that it needs, m/s, above the limit.
        needed: f64,
    },
    /// From rest, all straight lines together are too long for the time there is, however hard the robot accelerates.
    Duration {
        /// The least time that they take, s.
        needed: f64,
        /// The time there is, s.
        allowed: f64,
    },
}

/// Searches a witness for `waypoints` (m) flown in order, from rest to rest, in `longest_flight` (s; infinite: no
/// limit) at most.
///
/// Waypoint velocities are those of the minimum-snap curve for the current leg times (in [`LegTiming`]'s range). A leg
/// that is refused gets more time, and when it has all it may get, less velocity at its ends; the whole is then tried
/// again, so that leg times and velocities settle together. A witness that takes too long as a whole is none.
///
/// At most a hundred rounds, each judging every leg; deterministic.
///
/// Slowing down is by 1.12 a round, of a leg's time first and then of its ends' speeds, below a tenth of which they are
/// at rest. Lists of fewer than two waypoints have no legs, and are certified empty where their point is in the free
/// space.
///
/// `waypoints` in m, world frame; `timing` gives the range of leg times in s, its ladder is not used. A round costs a
/// minimum-snap solve and a judgement for each leg.
pub fn certify(judge: &LegJudge, waypoints: &[Point3<f64>], timing: &LegTiming, longest_flight: f64) -> Certificate {
    let (shortest, longest) = timing.range();
    if let Some(impossible) = impossible(judge, waypoints, longest, longest_flight) {
        return Certificate::No(impossible);
    }
    let mut times: Vec<f64> =
        waypoints.windows(2).map(|w| first_guess(judge, (w[1] - w[0]).norm()).clamp(shortest, longest)).collect();
    let mut share = vec![1.0; waypoints.len()];
    let mut failed = None;
    for _ in 0..ROUNDS {
        let ends = ends(judge, waypoints, &times, &share);
        let judged: Vec<_> =
            times.iter().enumerate().map(|(k, time)| judge.judge(&ends[k], &ends[k + 1], *time)).collect();
        failed = judged.iter().enumerate().find_map(|(leg, result)| result.as_ref().err().map(|why| (leg, *why)));
        if failed.is_none() {
            return within(Profile { legs: judged.into_iter().flatten().collect() }, longest_flight);
        }
        let mut moved = false;
        for (leg, _) in judged.iter().enumerate().filter(|(_, result)| result.is_err()) {
            moved |= slow_down(leg, &mut times, &mut share, longest);
        }
        if !moved {
            break;
        }
    }
    // Without legs nothing fails, so there is always a last failure here.
    failed.map_or_else(|| Certificate::Yes(Profile::default()), |(leg, why)| Certificate::Unknown { leg, why })
}

/// A witness that ends in time.
///
/// Total time in s; a witness that is too slow is evidence of nothing, for a faster one was not looked for.
fn within(profile: Profile, longest_flight: f64) -> Certificate {
    let margin = longest_flight - profile.duration();
    match profile.legs.last() {
        Some(last) if margin < 0.0 => Certificate::Unknown {
            leg: profile.legs.len() - 1,
            why: Infeasible::Violates { limit: Limit::Duration, part: 0, at: last.duration, margin },
        },
        _ => Certificate::Yes(profile),
    }
}

/// Gives a leg more time, or its ends less velocity; whether anything changed.
///
/// Times first, in steps of 1.12 up to `longest` (s); speeds after, of both ends of the leg.
fn slow_down(leg: usize, times: &mut [f64], share: &mut [f64], longest: f64) -> bool {
    if times[leg] < longest {
        times[leg] = (times[leg] * SLOWER).min(longest);
        return true;
    }
    let moved = share[leg].max(share[leg + 1]) > 0.0;
    for end in &mut share[leg..=leg + 1] {
        *end = if *end > 0.1 { *end / SLOWER } else { 0.0 };
    }
    moved
}

/// The level states at the waypoints, with minimum-snap velocities times `share`; at rest where the curve cannot be
/// solved for.
///
/// `times` in s, one a leg; `share` in 0 … 1, one a waypoint. Velocities are cut to the judge's top speed.
fn ends(judge: &LegJudge, waypoints: &[Point3<f64>], times: &[f64], share: &[f64]) -> Vec<LegEnd> {
    let curve = minimum_snap(waypoints, times).unwrap_or_default();
    let velocity = |k: usize| {
        let interior = k > 0 && k + 1 < waypoints.len();
        let v = curve.get(k).filter(|_| interior).map(|c| Vector3::new(c[0][1], c[1][1], c[2][1]));
        let v = v.unwrap_or_else(Vector3::zeros) * share[k];
        v * (judge.top_speed() / v.norm()).min(1.0)
    };
    waypoints.iter().enumerate().map(|(k, p)| judge.end(*p, velocity(k))).collect()
}

/// A time in which a leg of this length might be flown, s: a rest-to-rest leg peaks at 7.5 L/T², tried at half of g.
///
/// Half of the time that this peak would take: too short rather than too long, as times only grow from here.
fn first_guess(judge: &LegJudge, length: f64) -> f64 {
    (2.0 * length / judge.top_speed()).max((7.5 * length / 4.9).sqrt() * 0.5)
}

/// What no controller can do within the limits, whatever its inputs: a waypoint that the world does not allow, a leg
/// longer than the fastest goes in its longest time, and a flight that takes longer than is allowed even if it gains
/// speed at full acceleration all along.
///
/// Necessary conditions only, each true of every flight from rest. Drag and attitude are left out, which errs towards
/// possible.
fn impossible(judge: &LegJudge, waypoints: &[Point3<f64>], longest: f64, longest_flight: f64) -> Option<Impossible> {
    let max_speed = judge.limits().max_speed;
    let outside = waypoints
        .iter()
        .enumerate()
        .find_map(|(waypoint, p)| judge.space().allows(p, 0.0).err().map(|why| Impossible::Waypoint { waypoint, why }));
    let lengths = || waypoints.windows(2).map(|w| (w[1] - w[0]).norm());
    let too_far = || {
        lengths().enumerate().find_map(|(leg, length)| {
            let needed = length / longest;
            (needed > max_speed).then_some(Impossible::Distance { leg, needed })
        })
    };
    let too_long = || {
        let needed = least_time(lengths().sum(), judge.most_acceleration(), max_speed);
        let allowed = longest_flight.min(longest * lengths().count() as f64);
        (needed > allowed).then_some(Impossible::Duration { needed, allowed })
    };
    outside.or_else(too_far).or_else(too_long)
}

/// The least time, s, in which a path of `length` (m) is flown from rest where the speed grows by `acceleration` (m/s²)
/// at most, up to `max_speed` (m/s): √(2L/a) below that speed, L/v + v/2a beyond.
///
/// The end's rest is not asked for, so that it errs low. `acceleration` and `max_speed` > 0; an infinite speed leaves
/// the first form.
fn least_time(length: f64, acceleration: f64, max_speed: f64) -> f64 {
    if 2.0 * length * acceleration <= max_speed * max_speed {
        (2.0 * length / acceleration).sqrt()
    } else {
        length / max_speed + 0.5 * max_speed / acceleration
    }
}

#[cfg(feature = "unit-tests")]
mod tests {
    use super::*;
    use crate::feasibility::limits::Limits;
    use crate::feasibility::steering::ProofSettings;
    use crate::feasibility::steering::tests::flightgoggles;
    use crate::math::random::stream;
    use crate::world::World;
    use rand::RngExt;

    const ENDLESS: f64 = f64::INFINITY;

    fn judge() -> LegJudge {
        let world = World::new(Vector3::repeat(30.0), 1.0, Vec::new()).unwrap();
        let limits = Limits { max_speed: 8.0, max_tilt: 0.7 };
        LegJudge::new(&flightgoggles(), &world, limits, ProofSettings::default()).unwrap()
    }

    #[test]
    fn random_lists_get_witnesses_that_pass_through_every_waypoint() {
        let judge = judge();
        let mut certified = 0;
        for seed in 0..60 {
            let mut random = stream(seed);
            let mut p = Vector3::repeat(15.0);
            let waypoints: Vec<_> = (0..8)
                .map(|_| {
                    let step = Vector3::from_fn(|_, _| random.random_range(-4.0..4.0));
                    p = (p + step).sup(&Vector3::repeat(4.0)).inf(&Vector3::repeat(26.0));
                    Point3::from(p)
                })
                .collect();
            let Certificate::Yes(profile) = certify(&judge, &waypoints, &LegTiming::ladder(0.3, 20.0), ENDLESS) else {
                continue;
            };
            certified += 1;
            assert_eq!(profile.legs.len(), 7);
            for (k, leg) in profile.legs.iter().enumerate() {
                assert_eq!(judge.prove(leg), Ok(()), "seed {seed}, leg {k}");
                assert!((leg.position(leg.duration) - waypoints[k + 1]).norm() < 1e-8, "seed {seed}, leg {k}");
                let next = profile.legs.get(k + 1).map_or(Vector3::zeros(), |next| next.derivative(0.0, 1));
                assert!((leg.derivative(leg.duration, 1) - next).norm() < 1e-8, "seed {seed}, leg {k}");
            }
        }
        // There is always time enough here; what is lost would be the search's fault.
        assert_eq!(certified, 60);
    }

    #[test]
    fn says_no_only_with_a_proof() {
        let judge = judge();
        let (a, b) = (Point3::new(5.0, 5.0, 5.0), Point3::new(15.0, 5.0, 5.0));
        let outside = certify(&judge, &[a, Point3::new(0.5, 5.0, 5.0), b], &LegTiming::ladder(0.5, 9.0), ENDLESS);
        assert!(matches!(
            outside,
            Certificate::No(Impossible::Waypoint {
                waypoint: 1,
                why: Infeasible::Violates { limit: Limit::World, .. }
            })
        ));
        let far = certify(&judge, &[a, b], &LegTiming::Step(1.0), ENDLESS);
        assert!(matches!(far, Certificate::No(Impossible::Distance { leg: 0, .. })));
        // 10 m in 1.5 s is below the speed limit on average, but no level leg does it at this tilt.
        assert!(matches!(
            certify(&judge, &[a, b], &LegTiming::Step(1.5), ENDLESS),
            Certificate::Unknown { leg: 0, .. }
        ));
        assert!(matches!(certify(&judge, &[a, b], &LegTiming::Step(6.0), ENDLESS), Certificate::Yes(_)));
        assert!(matches!(
            certify(&judge, &[a, Point3::new(f64::NAN, 5.0, 5.0)], &LegTiming::Step(1.0), ENDLESS),
            Certificate::No(Impossible::Waypoint { waypoint: 1, .. })
        ));
        assert_eq!(certify(&judge, &[a], &LegTiming::Step(1.0), ENDLESS), Certificate::Yes(Profile::default()));
    }

    #[test]
    fn a_flight_that_ends_too_late_is_none() {
        let judge = judge();
        let waypoints = [5.0, 12.0, 19.0].map(|x| Point3::new(x, 5.0, 5.0));
        let asked = |longest_flight| certify(&judge, &waypoints, &LegTiming::ladder(0.3, 9.0), longest_flight);
        let Certificate::Yes(profile) = asked(ENDLESS) else { panic!("there is time enough") };
        assert_eq!(asked(profile.duration()), Certificate::Yes(profile.clone()));
        let late = asked(0.9 * profile.duration());
        let Certificate::Unknown { leg: 1, why: Infeasible::Violates { limit: Limit::Duration, margin, .. } } = late
        else {
            panic!("{late:?}")
        };
        assert!((margin + 0.1 * profile.duration()).abs() < 1e-9, "{margin}");
        // At 8 m/s, 14 m alone take 1.75 s.
        let Certificate::No(Impossible::Duration { needed, allowed: 1.75 }) = asked(1.75) else {
            panic!("{:?}", asked(1.75))
        };
        assert!(needed > 1.75 && needed < profile.duration(), "{needed}");
    }

    /// Against full thrust at the tilt limit, tried in small steps of time over many tilts.
    #[test]
    fn the_least_time_is_that_of_the_hardest_acceleration() {
        let robot = flightgoggles();
        let (thrust, gravity) = (robot.max_thrust() / robot.mass, robot.gravity);
        let hardest = (0..=700)
            .flat_map(|tilt| [0.0, 0.5, 1.0].map(|share| (f64::from(tilt) * 1e-3, share * thrust)))
            .map(|(tilt, thrust)| (thrust * tilt.sin()).hypot(thrust * tilt.cos() - gravity))
            .fold(0.0, f64::max);
        assert!((judge().most_acceleration() - hardest).abs() < 1e-9, "{hardest}");
        for (length, max_speed) in [(3.0, 8.0), (0.5, 8.0), (40.0, f64::INFINITY), (0.0, 8.0)] {
            let (mut at, mut speed, mut time) = (0.0, 0.0_f64, 0.0);
            while at < length {
                speed = (speed + hardest * 1e-5).min(max_speed);
                at += speed * 1e-5;
                time += 1e-5;
            }
            assert!((least_time(length, hardest, max_speed) - time).abs() < 1e-4, "{length} m, {max_speed} m/s");
        }
    }
}
