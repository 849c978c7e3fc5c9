//! What logs of drives show of the vehicle, in numbers.
//!
//! ```text
//! Δψ_i = Δs_i Σ_j b_j κ̄_j(t_i) + …      how the vehicle turns after what its controller would have said:
//! Δs_i = Σ_j c_j v̄_j(t_i) Δt + d climb   κ̄_j, v̄_j means of commands τ_j before, weighed by a triangle
//! Δl_i = e side |Δs_i|                   how it slides where the ground is steep
//! ```
//!
//! Every 0.1 s, all legs alike, by least squares: delays and lags are in the course of b and c over τ, scales in their
//! sums. Commands come from the log's own poses, which are off, and answer to the vehicle, so that b and c are biased;
//! those of simulated logs are so too, which is all that they are compared with ([`crate::math::imitation`]). Then how
//! large the residuals are and what memory they have, the commands' own memory, how much samples scatter, and how long
//! the drives take.
//!
//! The order of the signs, 36 numbers:
//!
//! ```text
//!  0 … 10   b_j, turning                       11 … 13   colour of its residuals (lags 1, 2)
//! 14 … 20   c_j, speeds     21   d, climb      22 … 24   colour of its residuals
//! 25        e, sliding                         26 … 28   colour of its residuals
//! 29 … 32   colour of the commanded curvature (lags 2, 5, 10)
//! 33, 34    ln of scatter, of x and y (m²) and of ψ (rad²)      35   ln of all durations (s)
//! ```

use nalgebra::{DMatrix, DVector};

use crate::campaign::kind::GroundLog;
use crate::math::power::square;
use crate::simulation::ground::{DriveCommand, Moment};
use crate::world::terrain::{ElevationMap, Terrain};

/// Time between looks at a log, and half of the time around each that a line is laid through, s.
///
/// A line is laid through 0.16 s, so that neighbouring looks share samples and their differences are a little
/// correlated; simulated logs are looked at in the same way.
const PERIOD: f64 = 0.1;
const AROUND: f64 = 0.08;
/// Corners of the triangles, s before a look: of curvatures and of speeds.
///
/// The first top is at the look itself, and its triangle reaches 0.1 s (of speeds 0.15 s) beyond it. Tops lie denser at
/// short delays.
const TURNS: [f64; 12] = [-0.1, 0.0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.65, 0.8, 1.0, 1.3, 1.7];
const SPEEDS: [f64; 8] = [-0.15, 0.0, 0.15, 0.3, 0.5, 0.75, 1.1, 1.6];
/// Looks at the begin that are left out, and how many a log must have.
///
/// 5 looks are half a second, 40 are four seconds.
const BEGIN: usize = 5;
const LEAST: usize = 40;
/// Least squares are damped by this share of each column's square.
///
/// Columns are neighbours in time and nearly alike; without damping their coefficients would take each other's part.
const RIDGE: f64 = 1e-3;

/// Where in [`signs`] turning stands, where speeds do, and where scatter does.
pub(super) const LAYOUT: [std::ops::Range<usize>; 3] = {
    let (turns, speeds) = (TURNS.len() - 1, SPEEDS.len() - 1);
    let from = turns + COLOUR;
    let scatter = from + speeds + 1 + COLOUR + 1 + COLOUR + 4;
    [0..turns, from..from + speeds, scatter..scatter + 2]
};
/// Numbers of [`colour`] with two lags.
const COLOUR: usize = 3;

/// A log at even times.
pub(super) struct Looked {
    /// x and y, m, and ψ, rad, at each look.
    places: Vec<[f64; 3]>,
    /// Ahead and to the left, m, and turned, rad, from each look to the next.
    moved: Vec<[f64; 3]>,
}

/// A row of least squares, and what it is to make.
///
/// The row's entries are one triangle's mean each; the value is what moved between two looks.
type Row = (Vec<f64>, f64);

/// What a log adds to the signs of all.
pub(super) struct Part {
    /// To Δψ (rad): κ̄_j Δs + ω̄_j Δt.
    turning: Vec<Row>,
    /// To Δs (m): v̄_j Δt, and the climb along the heading times |Δs|.
    going: Vec<Row>,
    /// To Δl (m, to the left): the slope across the heading times |Δs|.
    sliding: Vec<Row>,
    /// Commands at each look, 1/m.
    curvatures: Vec<f64>,
    /// Mean squares of third differences of x and y, and of ψ.
    scatter: [f64; 2],
    /// s.
    lasts: f64,
}

impl Looked {
    /// `None` of a log that is too short.
    ///
    /// Places are laid through by lines (`line`); what moved is in the frame of the mean heading of both looks, so
    /// that an arc between them has no part to the left.
    pub(super) fn at(log: &GroundLog) -> Option<Self> {
        let count = (log.times.last()? / PERIOD).floor() as usize;
        if count < LEAST {
            return None;
        }
        let places: Vec<[f64; 3]> = (0..=count).map(|i| line(log, i as f64 * PERIOD)).collect();
        let step = |ends: &[[f64; 3]]| {
            let ([x, y, yaw], [to_x, to_y, to_yaw]) = (ends[0], ends[1]);
            let (sin, cos) = libm::sincos(0.5 * (yaw + to_yaw));
            let (dx, dy) = (to_x - x, to_y - y);
            [cos * dx + sin * dy, cos * dy - sin * dx, to_yaw - yaw]
        };
        let moved = places.windows(2).map(step).collect();
        Some(Self { places, moved })
    }

    /// How it moves at `t`, linear between looks.
    ///
    /// Speed and turn rate are the means from look to look, and constant in between. Past the end the last two looks
    /// are carried on.
    pub(super) fn moment(&self, t: f64) -> Moment {
        let at = ((t / PERIOD) as usize).min(self.moved.len() - 1);
        let (share, [ahead, _, turned]) = (t / PERIOD - at as f64, self.moved[at]);
        let between = |k: usize| self.places[at][k] + share * (self.places[at + 1][k] - self.places[at][k]);
        Moment { place: [0, 1, 2].map(between), speed: ahead / PERIOD, turn_rate: turned / PERIOD }
    }

    /// Its end, s.
    pub(super) fn end(&self) -> f64 {
        self.moved.len() as f64 * PERIOD
    }

    /// What it shows, given what the controller would have said along it; `None` where that is over too soon.
    ///
    /// Cut where the controller says no more: a vehicle that stands at its goal tells nothing. `said` are commands at
    /// even times from 0; off the map the slope counts as 0. Cost: O(looks · triangles · commands in one).
    pub(super) fn part(&self, log: &GroundLog, said: &[(f64, DriveCommand)], map: &ElevationMap) -> Option<Part> {
        let tick = said.get(1)?.0 - said[0].0;
        let of =
            |what: fn(&DriveCommand) -> f64| -> Vec<f64> { said.iter().map(|(_, command)| what(command)).collect() };
        let (curvature, rate, speed) = (of(|c| c.curvature), of(|c| c.turn_rate), of(|c| c.speed));
        let last = speed.iter().zip(&rate).rposition(|(speed, rate)| *speed != 0.0 || *rate != 0.0)?;
        let lasts = last as f64 * tick;
        let count = ((lasts / PERIOD) as usize).min(self.moved.len());
        if count < LEAST {
            return None;
        }
        let (mut turning, mut going, mut sliding, mut curvatures) = (vec![], vec![], vec![], vec![]);
        for i in BEGIN..count {
            let (t, [ahead, left, turned]) = ((i as f64 + 0.5) * PERIOD, self.moved[i]);
            let (bends, rates) = (before(&curvature, tick, t, &TURNS), before(&rate, tick, t, &TURNS));
            turning.push((bends.iter().zip(&rates).map(|(k, w)| k * ahead + w * PERIOD).collect(), turned));
            let [x, y, yaw] = self.places[i];
            let (sin, cos) = libm::sincos(yaw);
            let [east, north] = map.patch(x, y).map_or([0.0; 2], |ground| ground.slope);
            let mut speeds: Vec<f64> = before(&speed, tick, t, &SPEEDS).iter().map(|v| v * PERIOD).collect();
            speeds.push((cos * east + sin * north) * ahead.abs());
            going.push((speeds, ahead));
            sliding.push((vec![(cos * north - sin * east) * ahead.abs()], left));
            curvatures.push(curvature[((i as f64 * PERIOD / tick) as usize).min(curvature.len() - 1)]);
        }
        let samples = &log.places[..log.times.partition_point(|t| *t < lasts)];
        let third = |k: usize| {
            let squares = samples.windows(4).map(|w| square(w[3][k] - 3.0 * w[2][k] + 3.0 * w[1][k] - w[0][k]));
            squares.sum::<f64>() / samples.len().max(1) as f64
        };
        Some(Part { turning, going, sliding, curvatures, scatter: [third(0) + third(1), third(2)], lasts })
    }
}

/// The signs of all logs together; `None` where a number is none.
///
/// `None` also without any log, and where normal equations are not positive definite.
pub(super) fn signs(parts: &[Part]) -> Option<Vec<f64>> {
    let mut all = Vec::new();
    regress(parts, |part| &part.turning, &mut all)?;
    regress(parts, |part| &part.going, &mut all)?;
    regress(parts, |part| &part.sliding, &mut all)?;
    colour(&parts.iter().map(|part| part.curvatures.clone()).collect::<Vec<_>>(), &[2, 5, 10], &mut all);
    for k in 0..2 {
        all.push(libm::log(parts.iter().map(|part| part.scatter[k]).sum::<f64>() / parts.len() as f64));
    }
    all.push(libm::log(parts.iter().map(|part| part.lasts).sum()));
    all.iter().all(|sign| sign.is_finite()).then_some(all)
}

/// Variance of a sample's own scatter in `signs`: of x or y, m², and of ψ, rad². Third differences have twenty times
/// it.
pub(super) fn scatter(signs: &[f64]) -> [f64; 2] {
    let [place, turn] = [0, 1].map(|k| libm::exp(signs[LAYOUT[2].start + k]));
    [place / 40.0, turn / 20.0]
}

/// The log at `t` by a line through the samples around, or between two where these are few.
///
/// Weighed alike within ± 0.08 s. A log of even samples at 19 Hz or more always has three there; looks of a slower one
/// may be interpolated.
fn line(log: &GroundLog, t: f64) -> [f64; 3] {
    let GroundLog { times, places } = log;
    let around = times.partition_point(|s| *s < t - AROUND)..times.partition_point(|s| *s <= t + AROUND);
    if around.len() < 3 {
        return log.between(t);
    }
    let count = around.len() as f64;
    let middle = times[around.clone()].iter().sum::<f64>() / count;
    let spread: f64 = times[around.clone()].iter().map(|s| square(s - middle)).sum();
    [0, 1, 2].map(|k| {
        let mean = places[around.clone()].iter().map(|place| place[k]).sum::<f64>() / count;
        let slope: f64 = around.clone().map(|i| (times[i] - middle) * (places[i][k] - mean)).sum();
        mean + slope / spread * (t - middle)
    })
}

/// Means of `said`, one a tick, before `t`, weighed by triangles over the corners τ but the first.
///
/// ```text
/// x̄_j(t) = Σ_k w_j(t − t_k) x_k / Σ_k w_j(t − t_k)      w_j 0 at τ_{j−1}, 1 at τ_j, 0 at τ_{j+1}, linear between
/// ```
///
/// The last triangle falls as it rises. Commands before the first and after the last are those. 0 where a triangle has
/// no tick in it.
fn before(said: &[f64], tick: f64, t: f64, corners: &[f64]) -> Vec<f64> {
    let mean = |j: usize| {
        let (near, top) = (corners[j - 1], corners[j]);
        let far = corners.get(j + 1).copied().unwrap_or(2.0 * top - near);
        let (mut sum, mut weights) = (0.0, 0.0);
        for k in ((t - far) / tick).ceil() as i64..=((t - near) / tick).floor() as i64 {
            let back = t - k as f64 * tick;
            let weight = if back < top { (back - near) / (top - near) } else { (far - back) / (far - top) };
            sum += weight * said[k.clamp(0, said.len() as i64 - 1) as usize];
            weights += weight;
        }
        if weights > 0.0 { sum / weights } else { 0.0 }
    };
    (1..corners.len()).map(mean).collect()
}

/// Coefficients of least squares over all logs, and the colour of what is left; 0 of a column without anything in it.
///
/// ```text
/// (XᵀX + λ diag(XᵀX)) c = Xᵀy      λ = 1e-3
/// ```
///
/// by Cholesky. Rows of all logs count alike, whichever log they are of. `None` without rows, or where that fails.
fn regress(parts: &[Part], rows: fn(&Part) -> &[Row], into: &mut Vec<f64>) -> Option<()> {
    let width = rows(parts.first()?).first()?.0.len();
    let (mut normal, mut right) = (DMatrix::zeros(width, width), DVector::zeros(width));
    for (row, value) in parts.iter().flat_map(rows) {
        for (a, x) in row.iter().enumerate() {
            right[a] += x * value;
            row.iter().enumerate().for_each(|(b, y)| normal[(a, b)] += x * y);
        }
    }
    (0..width).for_each(|a| normal[(a, a)] = normal[(a, a)] * (1.0 + RIDGE) + f64::MIN_POSITIVE.sqrt());
    let solved = normal.cholesky()?.solve(&right);
    into.extend(solved.iter());
    let left = |(row, value): &Row| value - row.iter().zip(&solved).map(|(x, c)| x * c).sum::<f64>();
    colour(&parts.iter().map(|part| rows(part).iter().map(left).collect()).collect::<Vec<_>>(), &[1, 2], into);
    Some(())
}

/// ln of the mean square, and correlations at `lags`, within each log.
///
/// ```text
/// ln r₀, r_l / r₀      r_l = mean over all logs of a_i a_{i+l}
/// ```
///
/// Pairs do not reach from one log into the next. Means are not taken off.
fn colour(logs: &[Vec<f64>], lags: &[usize], into: &mut Vec<f64>) {
    let at = |lag: usize| {
        let pairs = logs.iter().flat_map(|log| log.iter().zip(log.iter().skip(lag)));
        let (sum, count) = pairs.fold((0.0, 0.0), |(sum, count), (a, b)| (sum + a * b, count + 1.0));
        sum / count
    };
    let square = at(0);
    into.push(libm::log(square));
    into.extend(lags.iter().map(|lag| at(*lag) / square));
}

#[cfg(feature = "unit-tests")]
mod tests {
    use super::*;
    use crate::world::terrain::{Grid, HoleRule};

    /// A vehicle that goes as it is told 0.3 s later, nine tenths as fast and bent by 0.8 of it: the course of the
    /// coefficients has its middle there, and they add up to that.
    #[test]
    fn delays_and_scales_stand_in_the_signs() {
        let wave = |t: f64| 0.8 * libm::sin(1.3 * t) + 0.5 * libm::sin(3.1 * t + 1.0);
        let pace = |t: f64| 0.5 + 0.2 * libm::sin(0.9 * t);
        let command = |t: f64| DriveCommand { speed: pace(t), curvature: wave(t), ..DriveCommand::default() };
        let said: Vec<(f64, DriveCommand)> =
            (0..3000).map(|k| (0.02 * f64::from(k), command(0.02 * f64::from(k)))).collect();
        let (mut place, mut log) = ([0.0; 3], GroundLog { times: vec![], places: vec![] });
        for k in 0..60_000 {
            let t = 0.001 * f64::from(k);
            if k % 50 == 0 {
                log.times.push(t);
                log.places.push(place);
            }
            let (v, bend) = (0.9 * pace(t - 0.3), 0.8 * wave(t - 0.3));
            let (sin, cos) = libm::sincos(place[2]);
            place = [place[0] + 0.001 * v * cos, place[1] + 0.001 * v * sin, place[2] + 0.001 * v * bend];
        }
        let grid = Grid { columns: 4, rows: 4, first_center: [-300.0; 2], cell: [200.0; 2] };
        let map = ElevationMap::new(grid, &[0.0; 16], HoleRule::Error).unwrap();
        let looked = Looked::at(&log).unwrap();
        let part = looked.part(&log, &said, &map).unwrap();
        let signs = signs(&[part]).unwrap();
        assert_eq!(signs.len(), LAYOUT[2].end + 1);
        for (range, corners, sum) in [(LAYOUT[0].clone(), &TURNS[1..], 0.8), (LAYOUT[1].clone(), &SPEEDS[1..], 0.9)] {
            let own = &signs[range];
            let all: f64 = own.iter().sum();
            let middle = own.iter().zip(corners).map(|(b, tau)| b * tau).sum::<f64>() / all;
            assert!((all - sum).abs() < 0.02 && (middle - 0.3).abs() < 0.03, "{all} {middle} {own:?}");
        }
        assert!(scatter(&signs).iter().all(|variance| *variance < 1e-6));
    }
}
