//! What may hide between samples: a log has the robot's place ten times a second, half a metre apart at 5 m/s, and a
//! limit that no sample breaks may still have been broken. How far depends on how fast the robot can be and become.

use nalgebra::{Point3, Vector3};

use super::carried_on::counts_beyond;
use super::deviation::{Off, deviations, legs_flown};
use super::measure::{check, time_weights};
use super::settings::{JudgementError, Reference, Settings};
use super::swiftness::Swiftness;
use crate::math::segment::{nearest_point, point_distance};
use crate::trajectory::Track;

/// A sample, and the motion from it to the next one.
///
/// `off` points from the reference to the robot.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Close {
    /// The leg that it is on.
    pub leg: usize,
    /// From its place on the reference to the sample, m; `None` in a corner, where overshoot judges.
    pub off: Option<Vector3<f64>>,
    /// Distance from the reference that no moment until the next sample exceeds, m; `None` of the last sample, before a
    /// break, and in a corner.
    pub until_next: Option<f64>,
}

/// Every sample, and what may hide after it.
///
/// Between samples p₀, p₁, h s apart, with distances d₀, d₁ from a straight reference, at the share s of the time the
/// distance is at most the least of
///
/// ```text
/// (1 − s) d₀ + s d₁ + ½ a h² s (1 − s)        ‖p̈‖ ≤ a; the distance from a convex set is convex along the chord
/// max(d₀, d₁) + ½ √((v h)² − c²)              ‖ṗ‖ ≤ v, c = ‖p₁ − p₀‖
/// ½ (d₀ + d₁ + v h)                           ‖ṗ‖ ≤ v
/// max_s d(H(s)) + (a + κ) h²/16               with logged velocities, only where the others do not decide
/// ```
///
/// H is the cubic through both positions and velocities, κ the largest ‖Ḧ‖: p − H vanishes with its derivative at both
/// ends, and such a function with a second derivative of at most b is at most b h²/16. The first is the tightest that
/// two distances and an acceleration allow: its largest value is d₀ or d₁ where |d₁ − d₀| ≥ ½ a h², else
/// ½ (d₀ + d₁) + a h²/8 + (d₁ − d₀)²/(2 a h²), and a constant acceleration away from the reference attains it.
///
/// Where the leg changes between two samples it changes where that costs least. Against a path the reference is the
/// chord of the two samples' places on it, and what the path itself bends away from that chord is added. `enough` (m)
/// is what needs no closer look.
///
/// # Errors
/// [`JudgementError`], as of [`super::measure()`].
///
/// One entry a sample. Cost: four closed forms an interval; the last, with 1-Lipschitz halving, only where these
/// exceed `enough`.
pub fn look_closely(
    track: &Track,
    waypoints: &[Point3<f64>],
    settings: &Settings,
    swiftness: &Swiftness,
    enough: f64,
) -> Result<Vec<Close>, JudgementError> {
    check(track, waypoints, settings)?;
    let positions: Vec<Point3<f64>> = (0..track.len()).map(|i| track.position(i)).collect();
    let weights = time_weights(track.times(), settings);
    let (legs, _) = legs_flown(track, waypoints, &positions, &weights)?;
    let off = deviations(&positions, &weights, waypoints, &legs, settings)?;
    let velocities = ["vx_m_s", "vy_m_s", "vz_m_s"].map(|name| track.channel(name));
    let velocity = |i: usize| match velocities {
        [Some(x), Some(y), Some(z)] => Some(Vector3::new(x[i], y[i], z[i])),
        _ => None,
    };
    let looking = Looking { waypoints, settings, swiftness, enough };
    let close = |i: usize| {
        let own = off[i].distance.map(|_| positions[i] - looking.place(&positions[i], legs[i], &off[i]));
        let (_, next) = settings.neighbours(i, track.len());
        let until_next = (next > i).then(|| {
            let end = |k: usize| End { p: positions[k], v: velocity(k), leg: legs[k], off: &off[k] };
            looking.between(&end(i), &end(next), track.times()[next] - track.times()[i])
        });
        Close { leg: legs[i], off: own, until_next: until_next.flatten() }
    };
    Ok((0..track.len()).map(close).collect())
}

/// The largest value of a function that changes by no more than the way (it is 1-Lipschitz) along the straight line
/// between two samples, and `bulge` m around it. It is halved until no part can exceed `enough`, or one is known to.
///
/// An upper bound, at most ten halvings from the least; exact enough that what is decided by `enough` is decided
/// rightly, and what is not is told as a doubt.
pub fn most_between(
    value: &dyn Fn(&Point3<f64>) -> f64,
    ends: [(Point3<f64>, f64); 2],
    bulge: f64,
    enough: f64,
) -> f64 {
    let decided = |bound: f64, at_ends: f64| bound <= enough - bulge || at_ends > enough - bulge;
    halved(value, ends, 10, &decided) + bulge
}

/// The largest value, at and between all samples, of a function of places, legs and what is around the place that
/// changes by no more than the way; −∞ of no sample. Where the leg changes between two samples it changes where that is
/// least.
///
/// An upper bound, within a millimetre of what the samples and [`Swiftness::bulge`] allow. Only intervals that may have
/// the largest value are halved.
pub fn most_anywhere(
    track: &Track,
    close: &[Close],
    settings: &Settings,
    swiftness: &Swiftness,
    of: &dyn Fn(&Point3<f64>, usize, Around<'_>) -> f64,
) -> f64 {
    let at = |i: usize| {
        let p = track.position(i);
        of(&p, close[i].leg, Around { places: &[p], within: 0.0 })
    };
    let values: Vec<f64> = (0..track.len()).map(at).collect();
    let pairs = (0..track.len()).filter_map(|i| {
        let (_, next) = settings.neighbours(i, track.len());
        let chord = (track.position(next) - track.position(i)).norm();
        (next > i).then(|| (i, next, swiftness.bulge(track.times()[next] - track.times()[i], chord)))
    });
    let pairs: Vec<(usize, usize, f64)> = pairs.collect();
    // One leg alone may have less than both ends have on legs of their own.
    let is_one = |i: usize, next: usize| close[i].leg == close[next].leg;
    let least = pairs.iter().filter(|(i, next, _)| is_one(*i, *next));
    let least = least.map(|(i, next, bulge)| values[*i].max(values[*next]) + bulge);
    let least = values.iter().copied().chain(least).fold(f64::NEG_INFINITY, f64::max);
    let mut most = least;
    for (i, next, bulge) in pairs {
        let ends = [i, next].map(|k| track.position(k));
        let around = Around { places: &ends, within: 0.5 * (ends[1] - ends[0]).norm() + bulge };
        let on = |leg: usize| {
            let near = |bound: f64, at_ends: f64| bound <= at_ends.max(least - bulge) + 1e-3;
            halved(&|p| of(p, leg, around), ends.map(|p| (p, of(&p, leg, around))), 10, &near) + bulge
        };
        most = most.max(where_least([close[i].leg, close[next].leg], on));
    }
    most
}

/// A bound for an interval that begins on one of both legs and ends on the other: the leg changes where that costs
/// least.
pub(crate) fn where_least([from, to]: [usize; 2], bound: impl Fn(usize) -> f64) -> f64 {
    if from == to { bound(from) } else { bound(from).min(bound(to)) }
}

/// Places that a motion is never farther from than `within`, m: those of a sample, or of both ends of an interval.
#[derive(Debug, Clone, Copy)]
pub struct Around<'a> {
    /// The places.
    pub places: &'a [Point3<f64>],
    /// m.
    pub within: f64,
}

/// How far (m) `p`, on leg `leg`, is beyond its place in the directions of that leg and, where anything `around` it is
/// still carried on, the one before ([`super::measure()`]); it changes by no more than the way.
///
/// The same `around` of all places that are compared.
pub fn beyond(waypoints: &[Point3<f64>], p: &Point3<f64>, leg: usize, around: Around<'_>) -> f64 {
    let way = |leg: usize| waypoints[leg + 1] - waypoints[leg];
    let from = |leg: usize, p: &Point3<f64>, place: &Point3<f64>| {
        way(leg).try_normalize(0.0).map_or(0.0, |direction| (p - place).dot(&direction))
    };
    let own = from(leg, p, &waypoints[leg + 1]);
    let Some(last) = leg.checked_sub(1) else { return own };
    let on = |p: &Point3<f64>| nearest_point(p, &waypoints[leg], &waypoints[leg + 1]);
    let carried = |p: &Point3<f64>| {
        let place = on(p);
        counts_beyond(from(last, p, &place), (place - waypoints[leg]).norm(), around.within)
    };
    if around.places.iter().any(carried) { own.max(from(last, p, &on(p))) } else { own }
}

/// The longest time that an acceleration of `track` is a mean over, s; 0 where there is none.
///
/// Both intervals around a sample, at a track's ends and before breaks one.
pub fn longest_mean(track: &Track, settings: &Settings) -> f64 {
    let over = |i: usize| {
        let (before, after) = settings.neighbours(i, track.len());
        track.times()[after] - track.times()[before]
    };
    (0..track.len()).map(over).fold(0.0, f64::max)
}

/// An upper bound of a function that changes by no more than the way, between two places with their values: half the
/// sum of both and of the way, of halves until `is_settled` takes their bound with the larger value at their ends.
fn halved(
    value: &dyn Fn(&Point3<f64>) -> f64,
    ends: [(Point3<f64>, f64); 2],
    halvings: u32,
    is_settled: &dyn Fn(f64, f64) -> bool,
) -> f64 {
    let [(a, at_a), (b, at_b)] = ends;
    let bound = 0.5 * (at_a + at_b + (b - a).norm());
    if halvings == 0 || is_settled(bound, at_a.max(at_b)) {
        return bound;
    }
    let middle = a + 0.5 * (b - a);
    let middle = (middle, value(&middle));
    let halves = [[ends[0], middle], [middle, ends[1]]];
    halves.map(|half| halved(value, half, halvings - 1, is_settled)).into_iter().fold(f64::NEG_INFINITY, f64::max)
}

struct End<'a> {
    p: Point3<f64>,
    v: Option<Vector3<f64>>,
    leg: usize,
    off: &'a Off,
}

/// A straight reference, and how far (m) the path that it stands for bends away from it.
struct Straight {
    from: Point3<f64>,
    to: Point3<f64>,
    bends: f64,
}

struct Looking<'a> {
    waypoints: &'a [Point3<f64>],
    settings: &'a Settings<'a>,
    swiftness: &'a Swiftness,
    enough: f64,
}

impl Looking<'_> {
    fn leg(&self, leg: usize) -> Straight {
        Straight { from: self.waypoints[leg], to: self.waypoints[leg + 1], bends: 0.0 }
    }

    /// The point of the reference that a sample is measured from.
    fn place(&self, p: &Point3<f64>, leg: usize, off: &Off) -> Point3<f64> {
        let on = |leg: usize| nearest_point(p, &self.waypoints[leg], &self.waypoints[leg + 1]);
        match (off.place, self.settings.reference) {
            (Some(place), _) => place,
            (None, Reference::NearestLeg) => {
                let (own, before) = (on(leg), on(leg.saturating_sub(1)));
                if (p - before).norm() < (p - own).norm() { before } else { own }
            }
            (None, _) => on(leg),
        }
    }

    /// `None` where both samples are in one corner.
    fn between(&self, a: &End, b: &End, span: f64) -> Option<f64> {
        let bulge = self.swiftness.bulge(span, (b.p - a.p).norm());
        let from = if a.off.distance.is_none() { self.leaves(a, b, bulge) } else { 0.0 };
        let to = if b.off.distance.is_none() { 1.0 - self.leaves(b, a, bulge) } else { 1.0 };
        if from >= to {
            return None;
        }
        let legs = match self.settings.reference {
            Reference::Path(path) => return Some(self.off((a, b), span, &chord(a, b, path), [from, to])),
            Reference::Leg => [a.leg, b.leg, a.leg, b.leg],
            Reference::NearestLeg => [a.leg, b.leg, a.leg.saturating_sub(1), b.leg.saturating_sub(1)],
        };
        let mut least = f64::INFINITY;
        for (place, &leg) in legs.iter().enumerate() {
            if !legs[..place].contains(&leg) {
                least = least.min(self.off((a, b), span, &self.leg(leg), [from, to]));
            }
        }
        Some(least)
    }

    /// The share of the chord after which `a`, which is in a corner, has surely left it on the way to `b`.
    fn leaves(&self, a: &End, b: &End, bulge: f64) -> f64 {
        let (way, radius) = (b.p - a.p, (self.settings.corner - bulge).max(0.0));
        let corners = [self.waypoints[a.leg], self.waypoints[a.leg + 1]];
        let left = corners.into_iter().filter(|w| (a.p - w).norm() < radius).map(|w| {
            let (from, square) = (a.p - w, way.norm_squared());
            let ahead = from.dot(&way);
            let root = (ahead * ahead - square * (from.norm_squared() - radius * radius)).max(0.0).sqrt();
            if square > 0.0 { ((root - ahead) / square).clamp(0.0, 1.0) } else { 1.0 }
        });
        left.fold(0.0, f64::max)
    }

    /// The farthest from `straight` on the part `share` of the way.
    fn off(&self, (a, b): (&End, &End), span: f64, straight: &Straight, share: [f64; 2]) -> f64 {
        let distance = |p: &Point3<f64>| point_distance(p, &straight.from, &straight.to);
        let (at_a, at_b) = (distance(&a.p), distance(&b.p));
        let on_chord = |s: f64| at_a + (at_b - at_a) * s;
        let ends = on_chord(share[0]).max(on_chord(share[1]));
        let (chord, swift) = ((b.p - a.p).norm(), self.swiftness);
        let arch = swift.acceleration.map_or(f64::INFINITY, |most| {
            let rise = 0.5 * most * span * span;
            let top = if rise > 0.0 { 0.5 + (at_b - at_a) / (2.0 * rise) } else { 0.0 };
            let top = top.clamp(share[0], share[1]);
            ends.max(on_chord(top) + rise * top * (1.0 - top))
        });
        let ellipse = ends + swift.by_speed(span, chord);
        let way = swift.speed.filter(|speed| speed * span >= chord).map_or(f64::INFINITY, |speed| speed * span);
        let least = arch.min(ellipse).min(0.5 * (at_a + at_b + way)) + straight.bends;
        match (a.v, b.v, swift.acceleration) {
            (Some(v_a), Some(v_b), Some(most)) if least > self.enough => {
                least.min(on_cubic([(a.p, v_a), (b.p, v_b)], span, most, &distance) + straight.bends)
            }
            _ => least,
        }
    }
}

/// The chord between the places of two samples on a path.
fn chord(a: &End, b: &End, path: &Track) -> Straight {
    let (from, to) = (a.off.place.unwrap_or(a.p), b.off.place.unwrap_or(b.p));
    let (first, last) = (a.off.segment.min(b.off.segment), a.off.segment.max(b.off.segment));
    let bends = (first + 1..=last).map(|i| point_distance(&path.position(i), &from, &to)).fold(0.0, f64::max);
    Straight { from, to, bends }
}

/// Parts that the cubic is looked at in.
const PARTS: usize = 8;

/// max d(H(s)) + κ (h/8)²/8 + (a + κ) h²/16: the cubic is seen at nine places, and bends between them.
fn on_cubic(
    [(p_a, v_a), (p_b, v_b)]: [(Point3<f64>, Vector3<f64>); 2],
    span: f64,
    most: f64,
    distance: &impl Fn(&Point3<f64>) -> f64,
) -> f64 {
    let rate = (p_b - p_a) * (6.0 / span);
    let bend = ((rate - 4.0 * v_a - 2.0 * v_b).norm()).max((4.0 * v_b + 2.0 * v_a - rate).norm()) / span;
    let at = |s: f64| {
        let (square, rest) = (s * s, 1.0 - s);
        let to = square * (3.0 - 2.0 * s);
        p_a + (p_b - p_a) * to + v_a * (span * s * rest * rest) - v_b * (span * square * rest)
    };
    let seen = (0..=PARTS).map(|k| distance(&at(k as f64 / PARTS as f64))).fold(0.0, f64::max);
    let part = span / PARTS as f64;
    seen + bend * part * part / 8.0 + (most + bend) * span * span / 16.0
}

#[cfg(feature = "unit-tests")]
mod tests {
    use nalgebra::Isometry3;

    use super::*;
    use crate::math::random::{Stream, unit};
    use crate::trajectory::Channel;

    fn line() -> [Point3<f64>; 2] {
        [Point3::origin(), Point3::new(100.0, 0.0, 0.0)]
    }

    fn track(times: &[f64], points: &[Point3<f64>], velocities: Option<&[Vector3<f64>]>) -> Track {
        let poses = points.iter().map(|p| Isometry3::translation(p.x, p.y, p.z)).collect();
        let column = |name: &str, axis: usize, of: &[Vector3<f64>]| Channel {
            name: name.into(),
            values: of.iter().map(|v| v[axis]).collect(),
        };
        let names = ["vx_m_s", "vy_m_s", "vz_m_s"];
        let mut channels = vec![Channel { name: "leg".into(), values: vec![0.0; times.len()] }];
        let told = velocities.map(|of| (0..3).map(|axis| column(names[axis], axis, of)).collect::<Vec<_>>());
        channels.extend(told.into_iter().flatten());
        Track::new(times.to_vec(), poses, channels).unwrap()
    }

    fn hidden(track: &Track, swiftness: Swiftness) -> f64 {
        let close = look_closely(track, &line(), &Settings::default(), &swiftness, 0.0).unwrap();
        close.iter().filter_map(|close| close.until_next).fold(0.0, f64::max)
    }

    /// Ten times a second at 5 m/s, closed forms: the arch over equal ends, over unequal ones, and none over a steep
    /// one.
    #[test]
    fn bounds_are_the_closed_forms() {
        let (h, a) = (0.1, 20.0);
        let with = |d: [f64; 2], swiftness| {
            let points = [Point3::new(1.0, d[0], 0.0), Point3::new(1.5, d[1], 0.0)];
            hidden(&track(&[0.0, h], &points, None), swiftness)
        };
        let by_acceleration = Swiftness { speed: None, acceleration: Some(a) };
        assert!((with([0.3, 0.3], by_acceleration) - (0.3 + a * h * h / 8.0)).abs() < 1e-12);
        let unequal = 0.5 * (0.30 + 0.34) + a * h * h / 8.0 + 0.04 * 0.04 / (2.0 * a * h * h);
        assert!((with([0.30, 0.34], by_acceleration) - unequal).abs() < 1e-12);
        assert!((with([0.2, 0.5], by_acceleration) - 0.5).abs() < 1e-12);
        let by_speed = Swiftness { speed: Some(6.0), acceleration: None };
        assert!((with([0.3, 0.3], by_speed) - (0.3 + 0.5 * (0.36_f64 - 0.25).sqrt())).abs() < 1e-12);
        assert!(with([0.3, 0.3], Swiftness { speed: Some(4.0), acceleration: None }).is_infinite());
        assert!(with([0.3, 0.3], Swiftness::default()).is_infinite());
    }

    /// Motions of bounded acceleration, drawn at random, never go further than any of the bounds says; and the arch is
    /// attained.
    #[test]
    fn no_motion_within_the_limits_gets_past_the_bounds() {
        let mut random = Stream::new(7);
        let (a, steps) = (20.0, 40_usize);
        let mut nearest = f64::INFINITY;
        for draw in 0..300 {
            let mut pick = |scale: f64| Vector3::from_fn(|_, _| scale * (2.0 * unit(&mut random) - 1.0));
            let (mut p, mut v) = (Point3::new(20.0, 0.0, 0.0) + pick(0.5), Vector3::new(5.0, 0.0, 0.0) + pick(2.0));
            // Bang-bang, switched somewhere: what goes furthest.
            let [push, other] = [pick(1.0), pick(1.0)].map(|way| way.normalize() * a);
            let (h, switch) = (0.1 + 0.1 * pick(1.0).x.abs(), 10 + draw % 25);
            let (first, v_first, mut farthest) = (p, v, 0.0_f64);
            for step in 0..steps {
                let (push, dt) = (if step < switch { push } else { other }, h / steps as f64);
                p += v * dt + push * (0.5 * dt * dt);
                v += push * dt;
                farthest = farthest.max(point_distance(&p, &line()[0], &line()[1]));
            }
            let swift = Swiftness { speed: Some(40.0), acceleration: Some(a) };
            for velocities in [None, Some([v_first, v])] {
                let track = track(&[0.0, h], &[first, p], velocities.as_ref().map(|v| v.as_slice()));
                let bound = hidden(&track, swift);
                assert!(farthest <= bound + 1e-9, "draw {draw}: {farthest} > {bound}");
                nearest = nearest.min(bound - farthest);
            }
        }
        assert!(nearest < 0.02, "{nearest}");
    }

    /// With velocities at both ends the bound is half as wide where the motion is gentle.
    #[test]
    fn velocities_halve_what_can_hide() {
        let (h, a) = (0.1, 20.0);
        let (points, v) = ([Point3::new(1.0, 0.3, 0.0), Point3::new(1.5, 0.3, 0.0)], Vector3::new(5.0, 0.0, 0.0));
        let swift = Swiftness { speed: None, acceleration: Some(a) };
        let [without, with] =
            [None, Some([v; 2])].map(|v| hidden(&track(&[0.0, h], &points, v.as_ref().map(|v| v.as_slice())), swift));
        assert!((without - 0.3 - a * h * h / 8.0).abs() < 1e-12 && (with - 0.3 - a * h * h / 16.0).abs() < 1e-12);
    }

    #[test]
    fn corners_and_breaks_hide_nothing() {
        let swift = Swiftness { speed: None, acceleration: Some(20.0) };
        let points = [0.2, 0.6, 1.4, 2.2].map(|x| Point3::new(x, 0.1, 0.0));
        let track = track(&[0.0, 0.1, 0.2, 0.3], &points, None);
        let settings = Settings { corner: 1.0, breaks: &[3], ..Settings::default() };
        let close = look_closely(&track, &line(), &settings, &swift, 0.0).unwrap();
        let until: Vec<bool> = close.iter().map(|close| close.until_next.is_some()).collect();
        assert_eq!(until, [false, true, false, false]);
        // Outside the corner, which it leaves half-way, it can rise no higher than from there on.
        assert!(close[1].until_next.unwrap() <= 0.1 + 20.0 * 0.01 / 8.0 + 1e-12);
    }

    #[test]
    fn halving_finds_what_a_function_comes_to() {
        let hill = |p: &Point3<f64>| -(p - Point3::new(0.5, 0.2, 0.0)).norm();
        let ends = [0.0, 1.0].map(|x| (Point3::new(x, 0.0, 0.0), hill(&Point3::new(x, 0.0, 0.0))));
        let near = most_between(&hill, ends, 0.01, -0.18);
        assert!((-0.19..=-0.18).contains(&near), "{near}");
    }
}
