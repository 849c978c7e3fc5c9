//! Drives through places that somebody else chose, who says nothing of headings: which each is passed with is chosen
//! from a few by a dynamic program over the legs between them.
//!
//! ```text
//! J(k, ψ′) = min over ψ of J(k − 1, ψ) + T(ψ, ψ′)      ψ, ψ′ of up to three headings a place, T the leg's own time, s
//! ```
//!
//! Times are those of single legs: how speeds follow each other is settled only for the chain that is chosen, so that
//! it need not be the quickest drive.

use super::draft::DriveDraft;
use super::judge::{Commands, Ends, judge};
use super::settings::{DriveSettings, DriveSite};
use super::tally::LegRefusal;
use crate::trajectory::drive::Planar;
use crate::trajectory::{Direction, Drive, Passing};

/// Headings that a place may be passed in.
const HEADINGS: usize = 3;

/// A leg that was solved on the way.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ThroughLeg {
    /// Time that it takes with no legs before and after it, s.
    pub duration: f64,
    /// The greatest curvature of its commands, 1/m.
    pub curvature: f64,
}

/// What becomes of the legs between places.
#[derive(Debug, Clone)]
pub struct Through {
    /// Leg by leg.
    pub legs: Vec<Result<ThroughLeg, LegRefusal>>,
    /// The whole drive, where every leg is one and their speeds settle; `None` as well where legs differ in the speed
    /// that is commanded.
    pub drive: Option<Drive>,
}

/// A heading of a place, and how it was come to.
///
/// World frame: yaw in rad. `from` is the index in the column before.
struct Reached {
    yaw: f64,
    /// Seconds from the beginning of the chain.
    cost: f64,
    /// The heading before, and the commands from there.
    from: Option<(usize, Commands)>,
}

/// The legs between `places` (m), in order: each place is passed with straight wheels, in the direction of the leg that
/// leads to it, of the one that leads on, or between both; the quickest chain of these is taken. `settings` are those
/// of each leg; at places of `stops` the speed is 0.
///
/// Where no heading leads on, the chain begins anew, so that every leg has an answer of its own. At most 9 legs are
/// solved for each pair of places.
///
/// The refusal of a leg is that of the heading that came farthest, in the order of [`LegRefusal`]. Curvatures are
/// looked at in 17 places of each segment.
pub fn through(
    site: &DriveSite,
    settings: &dyn Fn(usize) -> DriveSettings,
    places: &[[f64; 2]],
    stops: &[usize],
) -> Through {
    let last = places.len().saturating_sub(1);
    let rests = |index: usize| index == 0 || index == last || stops.contains(&index);
    let mut legs = Vec::with_capacity(last);
    let mut table: Vec<Vec<Reached>> = vec![begun(places, 0)];
    let mut whole = true;
    for leg in 0..last {
        let of_leg = settings(leg);
        let wish = |index: usize| if rests(index) { 0.0 } else { of_leg.speed };
        let direction = Direction { start: of_leg.direction_at(leg), end: of_leg.direction_at(leg + 1) };
        let mut farthest = None;
        let (mut best, mut found): (Option<(f64, ThroughLeg)>, Vec<Reached>) = (None, Vec::new());
        for yaw in headings(places, leg + 1) {
            let to = standing(places[leg + 1], yaw);
            let mut reached: Option<Reached> = None;
            for (index, before) in table[leg].iter().enumerate() {
                let from = standing(places[leg], before.yaw);
                let ends = Ends {
                    from: &from,
                    to: &to,
                    distance: libm::hypot(to.x - from.x, to.y - from.y),
                    speeds: [wish(leg), wish(leg + 1)],
                    direction,
                    random: 0.0,
                };
                match judge(site, &of_leg, &ends, &mut 0) {
                    Ok(solved) => {
                        let cost = before.cost + solved.duration;
                        if best.is_none_or(|(least, _)| cost < least) {
                            let sampled = solved.segments.iter().map(|segment| {
                                let at = |k: u32| segment.curvature_at(segment.length_m() * f64::from(k) / 16.0).abs();
                                (0..=16).map(at).fold(0.0, f64::max)
                            });
                            let curvature = sampled.fold(0.0, f64::max);
                            best = Some((cost, ThroughLeg { duration: solved.duration, curvature }));
                        }
                        if reached.as_ref().is_none_or(|known| cost < known.cost) {
                            reached = Some(Reached { yaw, cost, from: Some((index, solved.commands())) });
                        }
                    }
                    Err(why) => farthest = farthest.max(Some(why)),
                }
            }
            found.extend(reached);
        }
        legs.push(best.map(|(_, solved)| solved).ok_or(farthest.unwrap_or(LegRefusal::Unsolved)));
        if found.is_empty() {
            whole = false;
            found = begun(places, leg + 1);
        }
        table.push(found);
    }
    let speeds: Vec<f64> = (0..last).map(|leg| settings(leg).speed).collect();
    let alike = speeds.windows(2).all(|pair| pair[0] == pair[1]);
    let drive = if whole && alike && last > 0 { joined(site, &settings(0), places, table, &rests) } else { None };
    Through { legs, drive }
}

/// All headings of place `index`, from which a chain begins.
fn begun(places: &[[f64; 2]], index: usize) -> Vec<Reached> {
    headings(places, index).into_iter().map(|yaw| Reached { yaw, cost: 0.0, from: None }).collect()
}

/// The drive along the quickest chain of `table`.
///
/// `None` where speeds do not settle.
fn joined(
    site: &DriveSite,
    settings: &DriveSettings,
    places: &[[f64; 2]],
    mut table: Vec<Vec<Reached>>,
    rests: &dyn Fn(usize) -> bool,
) -> Option<Drive> {
    let ends = table.last()?.iter().enumerate();
    let mut at = ends.min_by(|a, b| a.1.cost.total_cmp(&b.1.cost))?.0;
    let (mut passings, mut legs) = (Vec::with_capacity(places.len()), Vec::with_capacity(places.len()));
    for index in (0..places.len()).rev() {
        let reached = table[index].swap_remove(at);
        passings.push(Passing { at: standing(places[index], reached.yaw), direction: settings.direction_at(index) });
        if let Some((before, commands)) = reached.from {
            legs.push(Some(commands));
            at = before;
        }
    }
    passings.reverse();
    legs.reverse();
    let wishes = (0..places.len()).map(|index| if rests(index) { 0.0 } else { settings.speed });
    DriveDraft::with_legs(passings, wishes.collect(), legs).driven(site, settings)
}

fn standing([x, y]: [f64; 2], yaw: f64) -> Planar {
    Planar { x, y, yaw, curvature: 0.0 }
}

/// The headings that place `index` may be passed in, without repetitions; a neighbour that is the same place says none.
///
/// rad: between both legs first, then along the one that arrives and the one that leaves; nothing between where they
/// turn straight back, 0 where all neighbours are the same place.
fn headings(places: &[[f64; 2]], index: usize) -> Vec<f64> {
    let along = |from: usize| {
        let (a, b) = (places[from], places[from + 1]);
        let way = [b[0] - a[0], b[1] - a[1]];
        let length = libm::hypot(way[0], way[1]);
        (length > 0.0).then(|| way.map(|part| part / length))
    };
    let yaw = |[x, y]: [f64; 2]| libm::atan2(y, x);
    let before = index.checked_sub(1).and_then(along);
    let after = (index + 1 < places.len()).then(|| along(index)).flatten();
    match (before, after) {
        (Some(a), Some(b)) => {
            let middle = [a[0] + b[0], a[1] + b[1]];
            // Straight back there is nothing between.
            let between = (libm::hypot(middle[0], middle[1]) > 1e-6).then(|| yaw(middle));
            let mut all = Vec::with_capacity(HEADINGS);
            for one in between.into_iter().chain([yaw(a), yaw(b)]) {
                if all.iter().all(|known: &f64| (known - one).abs() > 1e-9) {
                    all.push(one);
                }
            }
            all
        }
        (Some(a), None) => vec![yaw(a)],
        (None, Some(b)) => vec![yaw(b)],
        (None, None) => vec![0.0],
    }
}

#[cfg(feature = "unit-tests")]
mod tests {
    use super::*;
    use std::f64::consts::{FRAC_PI_2, FRAC_PI_4};

    #[test]
    fn a_corner_is_passed_between_its_legs_or_along_one() {
        let corner = [[0.0, 0.0], [2.0, 0.0], [2.0, 3.0]];
        let near = |found: Vec<f64>, expected: &[f64]| {
            assert_eq!(found.len(), expected.len(), "{found:?}");
            assert!(found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-12), "{found:?}");
        };
        near(headings(&corner, 0), &[0.0]);
        near(headings(&corner, 1), &[FRAC_PI_4, 0.0, FRAC_PI_2]);
        near(headings(&corner, 2), &[FRAC_PI_2]);
        near(headings(&[[0.0, 0.0], [1.0, 0.0], [2.0, 0.0]], 1), &[0.0]);
        assert_eq!(headings(&[[0.0, 0.0], [1.0, 0.0], [0.0, 0.0]], 1).len(), 2);
        let twice = [[0.0, 0.0], [1.0, 0.0], [1.0, 0.0], [1.0, 2.0]];
        near(headings(&twice, 1), &[0.0]);
        near(headings(&twice, 2), &[FRAC_PI_2]);
        near(headings(&[[1.0, 0.0], [1.0, 0.0]], 0), &[0.0]);
    }
}
