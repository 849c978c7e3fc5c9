//! The speeds of a drive as they were written: do they fit together, and could the vehicle keep them?
//!
//! Between two knots v² is linear, so that acceleration is constant, (v₁² − v₀²)/2Δs, and a stretch takes 2Δs/(v₀ +
//! v₁): no other integral is needed.
//!
//! ```text
//! a = (v₁² − v₀²)/(2 Δs),   Δt = 2 Δs/(v₀ + v₁),   t = Σ Δt + Σ |turn|/ω
//! ```
//!
//! Checked in this order, of which the first two end the check where they fail: speeds are numbers from 0 to the
//! highest; metres do not fall; the first speed is the last one of the leg before (10⁻⁹ m/s); stops; accelerations;
//! the duration, to 10⁻⁶ (1 + duration) s.

use super::drive::DrivePiece;
use super::finding::Collector;

/// The speeds of one leg, and what they are held to.
#[derive(Debug, Clone, Copy)]
pub(super) struct PaceClaim<'a> {
    /// The leg's commands.
    pub(super) pieces: &'a [DrivePiece],
    /// Metres of the leg, rising from 0, with the speed there, m/s; v² is linear between.
    pub(super) knots: &'a [[f64; 2]],
    /// Pieces and knots of the leg before; `None`: there is none.
    pub(super) before: Option<(&'a [DrivePiece], &'a [[f64; 2]])>,
    /// Whether no leg follows.
    pub(super) last: bool,
    /// The highest speed, m/s.
    pub(super) speed: f64,
    /// Rate of turns in place, rad/s.
    pub(super) turn_rate: f64,
    /// Seconds that the leg is said to take.
    pub(super) duration: f64,
    /// m/s²; infinite where nothing stops.
    pub(super) most_acceleration: f64,
}

/// Shares that a comparison of sums may be off by.
const ROUNDING: f64 = 1e-6;
/// Speeds below this are none, m/s: √(2 a · rounding of metres).
const STILL: f64 = 1e-4;

/// Puts into `found` every speed that is none, too high, or does not join, stops that are none, accelerations beyond
/// the bound, and a duration that the speeds do not give.
pub(super) fn check_speeds(claim: &PaceClaim, found: &mut Collector) {
    let knots = claim.knots;
    let sound = |[s, v]: &[f64; 2]| s.is_finite() && (0.0..=claim.speed * (1.0 + ROUNDING)).contains(v);
    if let Some([_, bad]) = knots.iter().find(|knot| !sound(knot)) {
        return found.unless(false, "speed", *bad, claim.speed, "m/s");
    }
    let (Some(first), Some(last)) = (knots.first(), knots.last()) else {
        return found.unless(false, "speed", f64::NAN, claim.speed, "m/s");
    };
    if let Some(pair) = knots.windows(2).find(|pair| pair[1][0] < pair[0][0] - 1e-9) {
        return found.unless(false, "speed.metres", pair[1][0], pair[0][0], "m");
    }
    let total: f64 = claim.pieces.iter().map(DrivePiece::length).sum();
    let near = ROUNDING * (1.0 + total);
    for (metres, bound, beyond) in [(first[0], 0.0, first[0] < -near), (last[0], total, last[0] > total + near)] {
        found.unless(!beyond, "speed.metres", metres, bound, "m");
    }
    if let Some((_, before)) = claim.before {
        let jump = (first[1] - before.last().map_or(f64::NAN, |knot| knot[1])).abs();
        found.above("speed_jump", jump, 1e-9, "m/s");
    }
    if claim.most_acceleration.is_finite() {
        check_stops(claim, first[1], last[1], found);
        for pair in knots.windows(2) {
            let ([s, v], [t, w]) = (pair[0], pair[1]);
            let off = (w * w - v * v).abs() - 2.0 * claim.most_acceleration * (1.0 + ROUNDING) * (t - s);
            // Knots at one place are one knot, but for rounding.
            let fast = off > STILL * STILL;
            let acceleration = (w * w - v * v).abs() / (2.0 * (t - s));
            found.unless(!fast, "acceleration", acceleration, claim.most_acceleration, "m/s²");
        }
    }
    let taken = seconds(claim, total);
    let longer = (taken - claim.duration).abs().total_cmp(&(ROUNDING * (1.0 + claim.duration))).is_gt();
    found.unless(!longer, "duration", claim.duration, taken, "s");
}

/// The vehicle stands where it begins and ends, where the gear changes, and before and after turns in place.
///
/// A leg joins the one before without a stop only where both have the same gear there. Speeds below [`STILL`] are
/// rest: √ of a rounding error of v² is far larger than that error.
fn check_stops(claim: &PaceClaim, first: f64, last: f64, found: &mut Collector) {
    let gear = |piece: Option<&DrivePiece>| match piece {
        Some(DrivePiece::Arc { direction, .. }) => Some(*direction),
        _ => None,
    };
    let mut stands = |speed: f64| {
        let moves = speed > STILL;
        found.unless(!moves, "stop", speed, 0.0, "m/s");
    };
    let begins = gear(claim.pieces.first());
    if begins.is_none() || claim.before.is_none_or(|(pieces, _)| gear(pieces.last()) != begins) {
        stands(first);
    }
    if claim.last || gear(claim.pieces.last()).is_none() {
        stands(last);
    }
    let mut driven = 0.0;
    for pair in claim.pieces.windows(2) {
        driven += pair[0].length();
        if gear(Some(&pair[0])) != gear(Some(&pair[1])) {
            stands(speed_at(claim.knots, driven));
        }
    }
}

/// The slowest of the speeds `s` metres after the leg's beginning, m/s, as far as rounding tells places apart.
///
/// Two knots at one place, as at a stop, give the slower of both; between knots v² is interpolated; before the first
/// and beyond the last their speeds. `s` within 10⁻⁹ (1 + s) m of a knot is that knot's.
fn speed_at(knots: &[[f64; 2]], s: f64) -> f64 {
    let near = 1e-9 * (1.0 + s);
    let there = knots.iter().filter(|knot| (knot[0] - s).abs() <= near).map(|knot| knot[1]);
    let between = knots.windows(2).filter(|pair| pair[0][0] + near < s && s < pair[1][0] - near).map(|pair| {
        let share = (s - pair[0][0]) / (pair[1][0] - pair[0][0]);
        (pair[0][1] * pair[0][1] * (1.0 - share) + pair[1][1] * pair[1][1] * share).sqrt()
    });
    let slowest = there.chain(between).fold(f64::INFINITY, f64::min);
    match slowest.is_finite() {
        true => slowest,
        false if s < knots[0][0] => knots[0][1],
        false => knots[knots.len() - 1][1],
    }
}

/// ∫ ds/v over `total` metres, and the turns' time.
///
/// (what lies before the first knot)/v_first + Σ 2Δs/(v₀ + v₁) + (what lies beyond the last)/v_last + Σ |turn|/turn
/// rate.
fn seconds(claim: &PaceClaim, total: f64) -> f64 {
    let knots = claim.knots;
    let (begin, end) = (knots[0], knots[knots.len() - 1]);
    let driving: f64 = (knots.windows(2))
        .filter(|pair| pair[1][0] > pair[0][0])
        .map(|pair| 2.0 * (pair[1][0] - pair[0][0]) / (pair[0][1] + pair[1][1]))
        .sum();
    let steady = |metres: f64, speed: f64| if metres > 1e-9 * (1.0 + total) { metres / speed } else { 0.0 };
    let rest = steady(begin[0], begin[1]) + steady(total - end[0], end[1]);
    let turns = claim.pieces.iter().map(|piece| match piece {
        DrivePiece::Turn { angle_rad } => angle_rad.abs(),
        DrivePiece::Arc { .. } => 0.0,
    });
    driving + rest + turns.sum::<f64>() / claim.turn_rate
}

#[cfg(feature = "unit-tests")]
mod tests {
    use super::*;

    fn arc(length_m: f64, direction: f64) -> DrivePiece {
        DrivePiece::Arc { length_m, curvature: [0.0; 6], direction }
    }

    /// 2 m forward and 2 m back, from rest to rest at 0.5 m/s² to 1 m/s: 1 m up, 1 m down, twice.
    fn told(change: impl Fn(&mut PaceClaim, &mut Vec<[f64; 2]>)) -> String {
        let pieces = [arc(2.0, 1.0), arc(2.0, -1.0)];
        let mut knots = vec![[0.0, 0.0], [1.0, 1.0], [2.0, 0.0], [3.0, 1.0], [4.0, 0.0]];
        let sound = PaceClaim {
            pieces: &pieces,
            knots: &[],
            before: None,
            last: true,
            speed: 1.0,
            turn_rate: 0.5,
            duration: 8.0,
            most_acceleration: 0.5,
        };
        let mut claim = sound;
        change(&mut claim, &mut knots);
        let claim = PaceClaim { knots: &knots, ..claim };
        let mut findings = Vec::new();
        check_speeds(&claim, &mut Collector::on_leg(&mut findings, 0, 0.0));
        let fields = findings.iter().filter_map(|finding| finding.field.strip_prefix("legs[0]."));
        fields.collect::<Vec<_>>().join(" ")
    }

    const STRAIGHT: [DrivePiece; 1] = [DrivePiece::Arc { length_m: 2.0, curvature: [0.0; 6], direction: 1.0 }];

    #[test]
    fn speeds_that_fit_are_fine_and_each_flaw_has_its_name() {
        assert_eq!(told(|_, _| {}), "");
        assert_eq!(told(|claim, _| claim.duration = 8.01), "duration");
        assert_eq!(told(|claim, _| claim.most_acceleration = 0.49), "acceleration ".repeat(4).trim_end());
        assert_eq!(told(|_, knots| knots[1][1] = 1.1), "speed");
        assert_eq!(told(|_, knots| knots[1][1] = f64::NAN), "speed");
        assert_eq!(told(|_, knots| knots.clear()), "speed");
        assert_eq!(told(|_, knots| knots[3][0] = 0.5), "speed.metres");
        assert!(told(|_, knots| knots.insert(0, [-1.0, 0.0])).contains("speed.metres"));
        assert!(told(|_, knots| knots.push([4.5, 0.0])).contains("speed.metres"));
        // What lies before the first knot takes time as well.
        let late = |claim: &mut PaceClaim, knots: &mut Vec<[f64; 2]>| {
            (claim.pieces, claim.most_acceleration) = (&STRAIGHT, f64::INFINITY);
            *knots = vec![[1.0, 1.0], [2.0, 1.0]];
        };
        let taken = |seconds: f64| {
            move |claim: &mut PaceClaim, knots: &mut Vec<[f64; 2]>| {
                late(claim, knots);
                claim.duration = seconds;
            }
        };
        assert_eq!([told(taken(2.0)), told(taken(1.0))], ["", "duration"]);
        // Through the change of gear at 0.1 m/s, and on at the end.
        assert!(told(|_, knots| knots[2][1] = 0.1).contains("stop"));
        assert!(told(|_, knots| knots[4][1] = 0.1).contains("stop"));
        assert!(told(|claim, knots| (claim.last, knots[4][1]) = (false, 0.1)).contains("duration"));
        const TURN: [DrivePiece; 1] = [DrivePiece::Turn { angle_rad: 1.0 }];
        assert_eq!(told(|claim, _| claim.before = Some((&TURN, &[[0.0, 0.0]]))), "");
        assert_eq!(told(|claim, _| claim.before = Some((&TURN, &[[0.0, 0.3]]))), "speed_jump");
    }
}
