//! Flights through waypoints that somebody else chose, at speeds that he demands.
//!
//! ```text
//! a leg of length L at v takes     L/v between waypoints that are passed (with v at most),
//!                                  2 L/v from or to rest,   35/16 L/v from rest to rest (its peak is v)
//! p[t₀, t₁, t₂] = ½ p̈ somewhere:   2 ‖v₂ − v₁‖ / (T₁ + T₂) ≤ max ‖p̈‖, v₁ and v₂ mean velocities
//! ```
//!
//! The second line is necessary for any flight that meets three waypoints at given times, whatever its shape: it is
//! what says no. A leg that is refused says so of its own shape alone.
//!
//! Where the second line comes from: a flight that is at p₀, p₁, p₂ at t₀, t₁, t₂ has, on each axis, an instant at
//! which half of its acceleration is the second divided difference of these; for the vector the bound is by the mean
//! value along the difference's own direction. T₁ and T₂ are the legs' times, v₁ and v₂ their chords over those.

use nalgebra::{Point3, Vector3};

use super::limits::{Infeasible, Limit};
use super::steering::{LegEnd, LegJudge};
use crate::math::minimum_snap::minimum_snap;
use crate::trajectory::{Profile, ProfileLeg};

/// A waypoint next to a leg that is refused is passed this much more slowly, and from a tenth of its speed on not at
/// all.
const SLOWER: f64 = 1.12;
/// A free leg's times are tried in steps of this ratio,
const STRETCH: f64 = 1.2;
/// from this share of the first guess
const SHORTEST: f64 = 0.6;
/// to so many first guesses: in more, a leg that passes its ends at speed turns loops. One from rest to rest may take
/// the longest.
const LONGEST: f64 = 4.0;
/// The first guess of a leg that has next to no length, s: from none no ladder leads on.
const LEAST_TIME: f64 = 1e-3;
/// A rest-to-rest septic's peak speed by its mean one.
const PEAK: f64 = 35.0 / 16.0;
/// Halvings of a leg's least time.
const HALVINGS: u32 = 24;

/// A flight from rest to rest through `waypoints` (m) whose leg k is held at `speeds[k]` (m/s) where that is given; no
/// leg takes longer than `longest` (s).
///
/// Velocities at waypoints point along the minimum-snap curve through them. A leg without a demand takes the first time
/// of a geometric ladder in which it may be flown between its ends, one with a demand its own. Where a leg is refused,
/// its waypoints are passed more slowly, at last at rest: bodies that are level there bend a leg between two
/// directions, and the less the slower they are. So a leg without a demand is refused only if it is refused straight
/// and from rest to rest.
///
/// `speeds` has one entry a leg, m/s > 0; at least two waypoints. Times demanded are checked against `longest` before
/// anything is judged. Each round slows every waypoint beside a refused leg by 1.12 and judges again only what changed,
/// so that the work is bounded by some twenty rounds a waypoint. What is answered is proven leg by leg; that it is the
/// fastest is not claimed.
///
/// # Errors
/// The legs that are refused in the end, with their evidence.
pub fn hold(
    judge: &LegJudge,
    waypoints: &[Point3<f64>],
    speeds: &[Option<f64>],
    longest: f64,
) -> Result<Profile, Vec<(usize, Infeasible)>> {
    let lengths: Vec<f64> = waypoints.windows(2).map(|pair| (pair[1] - pair[0]).norm()).collect();
    let demanded: Vec<Option<f64>> = lengths
        .iter()
        .enumerate()
        .map(|(leg, length)| Some(paced(*length, speeds[leg]?, [leg == 0, leg + 1 == lengths.len()])))
        .collect();
    if let Some((leg, time)) =
        demanded.iter().enumerate().find_map(|(leg, time)| time.filter(|t| *t > longest).map(|t| (leg, t)))
    {
        return Err(vec![(
            leg,
            Infeasible::Violates { limit: Limit::Duration, part: 0, at: 0.0, margin: longest - time },
        )]);
    }
    let guessed: Vec<f64> = demanded
        .iter()
        .zip(&lengths)
        .map(|(time, length)| time.unwrap_or_else(|| first_guess(judge, *length).min(longest)))
        .collect();
    let passed = velocities(judge, waypoints, speeds, &guessed);
    let mut flight = Held { judge, waypoints, demanded, guessed, longest, passed, legs: vec![None; lengths.len()] };
    loop {
        flight.judge_what_is_open();
        if !flight.slow_beside_what_is_refused() {
            return flight.end();
        }
    }
}

/// A flight whose waypoints are passed more and more slowly, round by round.
struct Held<'a> {
    judge: &'a LegJudge,
    waypoints: &'a [Point3<f64>],
    /// By leg, s: the time that its demand gives,
    demanded: Vec<Option<f64>>,
    /// and the one from which a free leg is tried.
    guessed: Vec<f64>,
    longest: f64,
    /// By waypoint, m/s, at first;
    passed: Vec<Passed>,
    /// `None`: not judged since an end of it changed.
    legs: Vec<Option<Result<ProfileLeg, Infeasible>>>,
}

/// How a waypoint is passed: with this share of a velocity (m/s).
struct Passed {
    velocity: Vector3<f64>,
    share: f64,
}

impl Passed {
    fn now(&self) -> Vector3<f64> {
        self.velocity * self.share
    }

    /// From a tenth on at rest.
    ///
    /// SLOWER⁻ⁿ of the velocity, and 0 after the first share at or below a tenth.
    fn slower(&mut self) {
        self.share = if self.share > 0.1 { self.share / SLOWER } else { 0.0 };
    }
}

impl Held<'_> {
    fn judge_what_is_open(&mut self) {
        for leg in 0..self.legs.len() {
            if self.legs[leg].is_none() {
                self.legs[leg] = Some(self.judged(leg));
            }
        }
    }

    /// A leg with a demand has one time, a free one those of the ladder.
    fn judged(&self, leg: usize) -> Result<ProfileLeg, Infeasible> {
        let [from, to] = [leg, leg + 1].map(|k| self.judge.end(self.waypoints[k], self.passed[k].now()));
        if let Some(time) = self.demanded[leg] {
            return self.judge.judge(&from, &to, time);
        }
        let guess = self.guessed[leg];
        let at_rest = self.passed[leg..=leg + 1].iter().all(|end| end.now() == Vector3::zeros());
        let longest = if at_rest { self.longest } else { self.longest.min(LONGEST * guess) };
        in_free_time(self.judge, [&from, &to], guess, longest)
    }

    /// Whether a waypoint of a refused leg could still be slowed; the legs beside it are open again.
    fn slow_beside_what_is_refused(&mut self) -> bool {
        let refused = (0..self.legs.len()).filter(|leg| matches!(self.legs[*leg], Some(Err(_))));
        let mut beside: Vec<usize> = refused.flat_map(|leg| [leg, leg + 1]).collect();
        beside.dedup();
        beside.retain(|k| self.passed[*k].share > 0.0 && self.passed[*k].velocity != Vector3::zeros());
        for k in &beside {
            self.passed[*k].slower();
            self.legs[k - 1] = None;
            self.legs[*k] = None;
        }
        !beside.is_empty()
    }

    fn end(self) -> Result<Profile, Vec<(usize, Infeasible)>> {
        let refused: Vec<(usize, Infeasible)> =
            self.legs.iter().enumerate().filter_map(|(leg, one)| Some((leg, *one.as_ref()?.as_ref().err()?))).collect();
        let flown = self.legs.into_iter().flatten().flatten().collect();
        if refused.is_empty() { Ok(Profile { legs: flown }) } else { Err(refused) }
    }
}

/// The leg between `ends` in the first time of the ladder from the guess (s) on in which it may be flown.
///
/// 0.6 of the guess first, then by 1.2 each time, `longest` last. Times are not monotone in feasibility, so what is
/// taken is the first that is proven.
///
/// # Errors
/// The evidence against the longest.
fn in_free_time(
    judge: &LegJudge,
    [from, to]: [&LegEnd; 2],
    guess: f64,
    longest: f64,
) -> Result<ProfileLeg, Infeasible> {
    let mut time = (SHORTEST * guess).min(longest);
    loop {
        match judge.judge(from, to, time) {
            Err(_) if time < longest => time = (time * STRETCH).min(longest),
            answer => return answer,
        }
    }
}

/// The time of a leg of `length` (m) that is held at `speed` (m/s), s; which of its ends are at rest.
///
/// From the mean speed of the leg: length over time is `speed` between waypoints that are passed, half of it from or to
/// rest, 16/35 of it from rest to rest, whose peak is then `speed`.
fn paced(length: f64, speed: f64, at_rest: [bool; 2]) -> f64 {
    let factor = match at_rest {
        [false, false] => 1.0,
        [true, true] => PEAK,
        _ => 2.0,
    };
    factor * length / speed
}

/// A time in which a leg of this length might be flown, s.
///
/// The larger of 2L/v, half of the time in which the rest-to-rest leg peaks at 4.9 m/s² (7.5 L/T²), and 1 ms: too short
/// rather than too long, as ladders only lengthen it.
fn first_guess(judge: &LegJudge, length: f64) -> f64 {
    (2.0 * length / judge.top_speed()).max((7.5 * length / 4.9).sqrt() * 0.5).max(LEAST_TIME)
}

/// The velocities at the waypoints, m/s: along the minimum-snap curve for these times, with the least speed that is
/// demanded beside them.
///
/// One for each waypoint; 0 at both ends of the flight. Without a demand the curve's own velocity, cut to the top
/// speed; with one on either side its direction at the smaller of both speeds.
fn velocities(judge: &LegJudge, waypoints: &[Point3<f64>], speeds: &[Option<f64>], times: &[f64]) -> Vec<Passed> {
    let curve = minimum_snap(waypoints, times).unwrap_or_default();
    let last = waypoints.len() - 1;
    let velocity = |k: usize| {
        if k == 0 || k == last {
            return Vector3::zeros();
        }
        let along = curve.get(k).map_or_else(Vector3::zeros, |c| Vector3::new(c[0][1], c[1][1], c[2][1]));
        let demanded = [speeds[k - 1], speeds[k]].into_iter().flatten().reduce(f64::min);
        match demanded {
            None => along * (judge.top_speed() / along.norm().max(f64::MIN_POSITIVE)).min(1.0),
            Some(speed) => {
                let straight = || (waypoints[k + 1] - waypoints[k - 1]).try_normalize(1e-9);
                along.try_normalize(1e-6).or_else(straight).unwrap_or_else(Vector3::x) * speed
            }
        }
    };
    (0..waypoints.len()).map(|k| Passed { velocity: velocity(k), share: 1.0 }).collect()
}

/// By how much more than any flight within the limits has the acceleration must be, m/s², that turns from leg to leg at
/// waypoint 1 of the three of `points` while the mean speeds are `speeds` (m/s); `None`: not shown to be more.
///
/// Drag may help to turn: what it takes at the speed limit is added to what thrust does. Without a speed limit nothing
/// is shown.
///
/// From 2 ‖v₂ − v₁‖/(T₁ + T₂) ≤ max ‖p̈‖ ≤ [`LegJudge::most_acceleration`] + ‖D(v_max)‖/m. A margin of 10⁻⁹ keeps
/// rounding from saying no. Points that coincide show nothing.
pub fn turns_too_hard(judge: &LegJudge, points: [&Point3<f64>; 3], speeds: [f64; 2]) -> Option<f64> {
    let cap = judge.limits().max_speed;
    let [way_in, way_out] = [points[1] - points[0], points[2] - points[1]];
    let times = [way_in.norm() / speeds[0], way_out.norm() / speeds[1]];
    let needed = 2.0 * (way_out / times[1] - way_in / times[0]).norm() / (times[0] + times[1]);
    let [drag, ..] = judge.flatness().level(&(Vector3::x() * cap));
    let most = judge.most_acceleration() + drag.norm();
    (cap.is_finite() && needed > most * (1.0 + 1e-9)).then_some(needed - most)
}

/// The least time, s, in which the straight leg from `a` to `b` (m) is found to be flown from rest to rest, and the
/// limit that a shorter one meets; none in `longest` (s).
///
/// Bisected to 2⁻²⁴ of the bracket.
///
/// Bisection takes feasibility for monotone in the time; the time that is answered has been proven itself. The
/// bracket's upper end grows by 1.5 from the guess.
pub fn fastest(judge: &LegJudge, a: &Point3<f64>, b: &Point3<f64>, longest: f64) -> Option<(f64, Infeasible)> {
    let [from, to] = [a, b].map(|p| judge.end(*p, Vector3::zeros()));
    let refused = |time: f64| judge.judge(&from, &to, time).err();
    let mut high = first_guess(judge, (b - a).norm()).min(longest);
    let mut low = 0.0;
    let mut why = None;
    while let Some(one) = refused(high) {
        if high >= longest {
            return None;
        }
        (low, why, high) = (high, Some(one), (high * 1.5).min(longest));
    }
    for _ in 0..HALVINGS {
        let middle = 0.5 * (low + high);
        match refused(middle) {
            Some(one) => (low, why) = (middle, Some(one)),
            None => high = middle,
        }
    }
    Some((high, why?))
}

#[cfg(feature = "unit-tests")]
mod tests {
    use super::*;
    use crate::feasibility::limits::Limits;
    use crate::feasibility::steering::ProofSettings;
    use crate::feasibility::steering::tests::flightgoggles;
    use crate::world::World;

    fn judge(max_speed: f64) -> LegJudge {
        let world = World::new(Vector3::repeat(200.0), 1.0, Vec::new()).unwrap();
        let limits = Limits { max_speed, max_tilt: 0.7 };
        LegJudge::new(&flightgoggles(), &world, limits, ProofSettings::default()).unwrap()
    }

    fn line(xs: &[f64]) -> Vec<Point3<f64>> {
        xs.iter().map(|x| Point3::new(*x, 50.0, 50.0)).collect()
    }

    #[test]
    fn a_straight_line_is_held_at_its_speed() {
        let judge = judge(8.0);
        let points = line(&[10.0, 40.0, 80.0, 120.0]);
        let flight = hold(&judge, &points, &[Some(5.0); 3], 600.0).unwrap();
        let times: Vec<f64> = flight.legs.iter().map(|leg| leg.duration).collect();
        assert_eq!(times, [12.0, 8.0, 16.0]);
        // The mean between waypoints is 5 m/s, and they are passed with no more: level ends and drag shape the rest.
        for share in [0.0, 1.0] {
            let speed = flight.legs[1].derivative(8.0 * share, 1).norm();
            assert!(speed > 0.0 && speed < 5.0 + 1e-9, "{share}: {speed}");
        }
        assert!(flight.legs.iter().all(|leg| judge.prove(leg).is_ok()));
        // Only what is demanded is held: the others take what they need.
        let free = hold(&judge, &points, &[None, Some(5.0), None], 600.0).unwrap();
        assert_eq!(free.legs[1].duration, 8.0);
        let passed = free.legs[1].derivative(0.0, 1).norm();
        assert!(passed > 0.0 && passed < 5.0 + 1e-9, "{passed}");
    }

    /// A point mass that meets three places at given times, by quadrature of the kernel: the least acceleration is a
    /// constant one, 2 p[t₀, t₁, t₂].
    #[test]
    fn a_turn_is_refused_only_where_no_point_mass_could_make_it() {
        let judge = judge(8.0);
        let corner = [Point3::new(50.0, 50.0, 50.0), Point3::new(58.0, 50.0, 50.0), Point3::new(58.0, 58.0, 50.0)];
        let asked = |speed: f64| turns_too_hard(&judge, [&corner[0], &corner[1], &corner[2]], [speed; 2]);
        let drag = judge.flatness().level(&Vector3::new(8.0, 0.0, 0.0))[0].norm();
        let most = judge.most_acceleration() + drag;
        // ‖v₂ − v₁‖ = √2 v over half of 2 · 8/v: √2 v²/8.
        let needed = |speed: f64| 2f64.sqrt() * speed * speed / 8.0;
        let least = (most * 8.0 / 2f64.sqrt()).sqrt();
        assert_eq!(asked(least * 0.999), None);
        let excess = asked(least * 1.01).unwrap();
        assert!((excess - (needed(least * 1.01) - most)).abs() < 1e-9);
        // The constant acceleration meets the three places, and no less does: its second divided difference is exact.
        let (v, t) = (6.0, 8.0 / 6.0);
        let a = (Vector3::new(0.0, v, 0.0) - Vector3::new(v, 0.0, 0.0)) / t;
        let v0 = Vector3::new(v, 0.0, 0.0) - a * t / 2.0;
        let at = |time: f64| corner[0] + v0 * time + a * (0.5 * time * time);
        assert!((at(t) - corner[1]).norm() < 1e-9 && (at(2.0 * t) - corner[2]).norm() < 1e-9);
        assert!((a.norm() - needed(v)).abs() < 1e-9);
        let unlimited = self::judge(f64::INFINITY);
        assert_eq!(turns_too_hard(&unlimited, [&corner[0], &corner[1], &corner[2]], [100.0; 2]), None);
    }

    #[test]
    fn what_is_refused_says_on_which_leg() {
        let judge = judge(8.0);
        let corner = [Point3::new(50.0, 50.0, 50.0), Point3::new(56.0, 50.0, 50.0), Point3::new(56.0, 56.0, 50.0)];
        let refused = hold(&judge, &corner, &[Some(7.9); 2], 600.0).unwrap_err();
        assert!(!refused.is_empty() && refused.iter().all(|(leg, _)| *leg < 2), "{refused:?}");
        assert!(hold(&judge, &corner, &[None; 2], 600.0).is_ok());
    }

    /// Straight legs from rest to rest are a flight wherever each is one: a leg without a demand is refused for no bend
    /// of the curve through its waypoints, and takes no longer for it.
    #[test]
    fn a_mission_beside_the_walls_is_flown_without_bending_into_them() {
        let world = World::new(Vector3::repeat(12.0), 1.0, Vec::new()).unwrap();
        let judge =
            LegJudge::new(&flightgoggles(), &world, Limits { max_speed: 5.0, max_tilt: 0.7 }, ProofSettings::default())
                .unwrap();
        let near = 1.0 + 1e-3;
        let square = [[near, near], [11.0, near], [11.0, 11.0], [near, 11.0], [near, near]].map(|[x, y]| {
            let [x, y] = [x, y].map(|c: f64| c.min(12.0 - near));
            Point3::new(x, y, 6.0)
        });
        let straight: f64 = square.windows(2).map(|pair| fastest(&judge, &pair[0], &pair[1], 600.0).unwrap().0).sum();
        let flight = hold(&judge, &square, &[None; 4], 600.0).unwrap();
        let taken: f64 = flight.legs.iter().map(|leg| leg.duration).sum();
        assert!(taken < STRETCH * straight, "{taken} s, straight and at rest {straight} s");
        assert!(flight.legs.iter().all(|leg| judge.prove(leg).is_ok()));
    }

    /// A time of zero leads up no ladder, and a velocity that a share makes subnormal is no rest.
    #[test]
    fn waypoints_next_to_each_other_end_in_a_flight_or_in_a_refusal() {
        let judge = judge(5.0);
        for near in [1e-200, 1e-155, 1e-9, 1e-3] {
            let points = [[0.0, 50.0, 5.0], [near, 50.0, 5.0], [3.0, 59.0, 5.0]]
                .map(|[x, y, z]| Point3::new(x, y, z) + Vector3::new(50.0, 0.0, 0.0));
            let exact = [[0.0, 0.0, 5.0], [near, 0.0, 5.0], [3.0, 9.0, 5.0]].map(Point3::from);
            let flight = hold(&judge, &points, &[None; 2], 600.0).unwrap();
            assert!(flight.legs.iter().all(|leg| judge.prove(leg).is_ok()), "{near}");
            // Beside the world's corner that is refused, and it is told on both legs.
            let refused = hold(&judge, &exact, &[None; 2], 600.0).unwrap_err();
            assert_eq!(refused.iter().map(|(leg, _)| *leg).collect::<Vec<_>>(), [0, 1], "{near}");
        }
    }

    #[test]
    fn the_fastest_is_the_border_between_what_is_flown_and_what_is_not() {
        let judge = judge(3.0);
        let points = line(&[10.0, 30.0]);
        let (time, why) = fastest(&judge, &points[0], &points[1], 600.0).unwrap();
        // 20 m with a peak of 3 m/s: the speed limit decides, drag aside.
        assert!((time - PEAK * 20.0 / 3.0).abs() < 1e-3, "{time}");
        assert_eq!(why.limit(), Limit::Speed);
        assert!(fastest(&judge, &points[0], &points[1], 5.0).is_none());
    }
}
