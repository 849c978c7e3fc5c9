//! The lengths of legs, and coordinates that can be read.

use super::Job;
use super::route::Route;

/// Halvings of a leg's length, 3 % of it at the end.
const HALVINGS: usize = 5;
/// A leg is not made shorter than this, m.
const SHORTEST: f64 = 0.25;
/// Coordinates are tried rounded to these, m.
const ROUNDED: [f64; 3] = [1.0, 0.1, 0.01];

impl Job<'_> {
    /// Makes every leg as short as bisection finds it to violate still, the last one first; what follows it moves
    /// along. Then rounds the coordinates as far as that goes.
    ///
    /// Up to 5 runs per leg and 3 for the coordinates. An arm's points stay where they are.
    ///
    /// Bisection takes shorter legs to violate less; where that is not so, it ends at a length that violates, and not
    /// at the least.
    pub(super) fn shorten(&mut self) {
        if !self.route.moves() {
            return;
        }
        for leg in (0..self.route.stops.len() - 1).rev() {
            let whole = self.route.clone();
            let length = (whole.stops[leg + 1].at - whole.stops[leg].at).norm();
            // Shares of the length that violate, and that do not.
            let (mut long, mut short) = (1.0, (SHORTEST / length).min(1.0));
            for _ in 0..HALVINGS {
                let share = 0.5 * (long + short);
                if self.stopped || (long - short) * length < SHORTEST {
                    break;
                }
                match self.holds(None, &with_leg(&whole, leg, share)) {
                    None => return,
                    Some(true) => long = share,
                    Some(false) => short = share,
                }
            }
        }
        for unit in ROUNDED {
            let rounded = rounded(&self.route, unit);
            if self.stopped || rounded == self.route {
                return;
            }
            if apart(&rounded) && self.holds(None, &rounded) == Some(true) {
                return;
            }
        }
    }
}

/// `route` with leg number `leg` of `share` of its length.
///
/// All waypoints behind the leg are moved by −(1 − share) of it: later legs keep length and direction.
fn with_leg(route: &Route, leg: usize, share: f64) -> Route {
    let mut shorter = route.clone();
    let back = (route.stops[leg + 1].at - route.stops[leg].at) * (1.0 - share);
    for stop in &mut shorter.stops[leg + 1..] {
        stop.at -= back;
    }
    shorter
}

/// Every coordinate to the nearest multiple of `unit`, m.
fn rounded(route: &Route, unit: f64) -> Route {
    let mut rounded = route.clone();
    // By division, so that a tenth is the nearest number to it.
    let per_unit = (1.0 / unit).round();
    for stop in &mut rounded.stops {
        stop.at = stop.at.map(|x| (x * per_unit).round() / per_unit);
    }
    rounded
}

/// Whether no leg is shorter than 0.25 m.
fn apart(route: &Route) -> bool {
    route.stops.windows(2).all(|pair| (pair[1].at - pair[0].at).norm() >= SHORTEST)
}
