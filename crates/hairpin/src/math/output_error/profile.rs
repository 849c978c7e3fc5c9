//! How far a parameter can be moved before the others cannot make up for it.
//!
//! ```text
//! Q_k(x) = min { Q(θ) : θ_k = x }         interval { x : Q_k(x) − Q(θ̂) ≤ t² C_kk/(H⁻¹)_kk }
//! ```
//!
//! With white residuals the rise is χ²₁; with coloured ones C_kk/(H⁻¹)_kk times it (Kent, Robust properties of
//! likelihood ratio tests, Biometrika 69(1), 1982), and t² takes the place of χ²₁'s quantile as C itself is an estimate
//! of so many degrees of freedom, each parameter's its own ([`fn@super::spread`]).

use nalgebra::{DMatrix, DVector};

use super::descend::{Descent, descend, settle};
use super::objective::{Objective, Parameter};
use super::spread::Spread;

/// An end of an interval.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Side {
    /// Q rises by the limit here.
    Closed(f64),
    /// It does not up to this bound.
    Open(f64),
}

/// Looks at a side at most.
const LOOKS: usize = 7;
/// How near to the limit, as a share of it in units of the deviation, an end is found.
const NEAR: f64 = 0.04;

/// Lower and upper end of the interval of parameter `free[k]` about `at`, where Q rises by `rise`.
///
/// Ends by secants of √(Q_k − Q), which is straight where Q is a parabola, from where the curvature says. None is
/// nearer than that, t √C_kk: where Q is rough, a small step out of the minimum may cost as much as a large one, and
/// says nothing of what others would have been found.
pub fn profile(
    objective: &Objective,
    at: &Descent,
    free: &[usize],
    spread: &Spread,
    (k, rise): (usize, f64),
) -> [Side; 2] {
    let (own, least) = (free[k], (rise * spread.white[(k, k)]).sqrt());
    let Parameter { low, high, .. } = objective.parameters[own];
    [-1.0, 1.0].map(|sign| match end(objective, at, free, spread, (k, rise, sign)) {
        Side::Closed(found) if (found - at.theta[own]).abs() < least => {
            let there = at.theta[own] + sign * least;
            if there > low && there < high { Side::Closed(there) } else { Side::Open(there.clamp(low, high)) }
        }
        found => found,
    })
}

fn end(
    objective: &Objective,
    at: &Descent,
    free: &[usize],
    spread: &Spread,
    (k, rise, sign): (usize, f64, f64),
) -> Side {
    let own = free[k];
    let (bounds, centre) = (objective.parameters[own], at.theta[own]);
    let bound = if sign < 0.0 { bounds.low } else { bounds.high };
    let room = (bound - centre) * sign;
    if room <= 0.0 {
        return Side::Open(bound);
    }
    let others: Vec<usize> = free.iter().copied().filter(|other| *other != own).collect();
    let jacobian = spread.jacobian.clone().remove_column(k);
    let follow = followers(&spread.curvature, k);
    // What was looked at, nearest inside and outside: distance from the centre and √(rise).
    let (mut inside, mut outside) = ((0.0, 0.0), None::<(f64, f64)>);
    let limit = rise.sqrt();
    let mut away = (limit * spread.white[(k, k)].sqrt()).min(room);
    for _ in 0..LOOKS {
        let mut start = at.theta.clone();
        start[own] = centre + sign * away;
        for (index, other) in others.iter().enumerate() {
            start[*other] += follow[index] * sign * away;
        }
        // Derivatives of the centre do until the end is met; there they are taken anew, lest Q be told too high.
        let settled = settle(objective, &start, &others, &jacobian);
        let height = |found: &Descent| (found.q - at.q).max(0.0).sqrt();
        let height = match settled {
            Some(settled) if height(&settled) < (1.0 - NEAR) * limit => height(&settled),
            Some(settled) if height(&settled) > 2.0 * limit => height(&settled),
            Some(settled) => {
                descend(objective, &settled.theta, &others).map_or(height(&settled), |found| height(&found))
            }
            // Nothing is simulated out there.
            None => 3.0 * limit,
        };
        if (height - limit).abs() <= NEAR * limit {
            return Side::Closed(centre + sign * away);
        }
        if height < limit {
            if away >= room {
                return Side::Open(bound);
            }
            inside = (away, height);
        } else {
            outside = Some((away, height));
        }
        away = match outside {
            None if inside.1 > 0.2 * limit => (inside.0 * limit / inside.1 * 1.05).min(4.0 * inside.0).min(room),
            None => (2.5 * away).min(room),
            Some(outer) => {
                let share = (limit - inside.1) / (outer.1 - inside.1);
                inside.0 + (outer.0 - inside.0) * share.clamp(0.1, 0.9)
            }
        };
    }
    match outside {
        // Between the two: the outer one is on the safe side.
        Some((outer, _)) => Side::Closed(centre + sign * outer),
        None => Side::Open(centre + sign * away),
    }
}

/// How the others move with parameter k along the bottom of a parabola: −(H without k)⁻¹ H_k.
fn followers(h: &DMatrix<f64>, k: usize) -> DVector<f64> {
    let rest = h.clone().remove_row(k);
    let column = rest.column(k).into_owned();
    let rest = rest.remove_column(k);
    let size = rest.nrows();
    let ridge = DMatrix::from_diagonal(&(rest.diagonal() * 1e-9));
    let solved = (rest + ridge).cholesky().map(|rest| -rest.solve(&column));
    solved.unwrap_or_else(|| DVector::zeros(size))
}
