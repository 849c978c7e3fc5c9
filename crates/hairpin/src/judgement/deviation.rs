//! Which leg each sample belongs to, and how far it is from the reference.
//!
//! "Deviation" is from a reference that was asked for: the leg's segment by default, since what a controller makes of a
//! corner is a matter of overshoot, not of distance from a line nobody commanded.
//!
//! | reference | distance of a sample on leg l | near waypoints |
//! | --- | --- | --- |
//! | leg | to the segment from w_l to w_{l+1} | none within `corner` |
//! | nearest leg | the lesser of that and the segment before | the same |
//! | path | to the place that it is assigned to, in order | judged everywhere |

use nalgebra::Point3;

use super::LegSource;
use super::assign::{Piece, leg_pieces, monotone};
use super::settings::{JudgementError, Reference, Settings};
use crate::math::segment::{nearest_point, point_distance};
use crate::trajectory::Track;

/// The leg of every sample.
///
/// The channel `leg` where there is one: whole numbers from 0 to the number of legs, the last of which ("all
/// reached") counts as the last leg. Else samples are assigned in order along the polyline, weighted by their time.
///
/// # Errors
/// [`JudgementError::Leg`]: a number that is no leg.
pub(super) fn legs_flown(
    track: &Track,
    waypoints: &[Point3<f64>],
    positions: &[Point3<f64>],
    weights: &[f64],
) -> Result<(Vec<usize>, LegSource), JudgementError> {
    let last = waypoints.len() - 2;
    let Some(told) = track.channel("leg") else {
        let pieces = leg_pieces(waypoints);
        let assigned = monotone(positions, weights, &pieces);
        return Ok((assigned.into_iter().map(|piece| pieces[piece].owner).collect(), LegSource::Assigned));
    };
    if let Some((index, &value)) =
        told.iter().enumerate().find(|(_, leg)| leg.fract() != 0.0 || **leg < 0.0 || **leg > (last + 1) as f64)
    {
        return Err(JudgementError::Leg { index, value, last });
    }
    Ok((told.iter().map(|&leg| (leg as usize).min(last)).collect(), LegSource::Executor))
}

/// The leg of the place on `path` that every sample belongs to, never an earlier one than the sample before; `None`
/// where the path tells no legs up to `last`.
pub(super) fn legs_along(
    positions: &[Point3<f64>],
    weights: &[f64],
    path: &Track,
    last: usize,
) -> Result<Option<Vec<usize>>, JudgementError> {
    let is_leg = |leg: &f64| (0.0..=(last + 1) as f64).contains(leg);
    let Some(told) = path.channel("leg").filter(|told| told.iter().all(is_leg)) else { return Ok(None) };
    let mut furthest = 0;
    let legs = path_places(positions, weights, path)?.into_iter().map(|(_, segment)| {
        furthest = furthest.max((told[segment] as usize).min(last));
        furthest
    });
    Ok(Some(legs.collect()))
}

/// How far a sample is from the reference.
pub(super) struct Off {
    /// Distance, m; `None` where overshoot judges instead.
    pub(super) distance: Option<f64>,
    /// Where on the path it belongs, m, if the reference is one.
    pub(super) place: Option<Point3<f64>>,
    /// The path's segment that this lies on.
    pub(super) segment: usize,
}

/// How far every sample is from the reference.
///
/// One entry a sample, in order.
///
/// # Errors
/// [`JudgementError::Path`]: a path of less than two places.
pub(super) fn deviations(
    positions: &[Point3<f64>],
    weights: &[f64],
    waypoints: &[Point3<f64>],
    legs: &[usize],
    settings: &Settings,
) -> Result<Vec<Off>, JudgementError> {
    let from_leg = |p: &Point3<f64>, leg: usize| point_distance(p, &waypoints[leg], &waypoints[leg + 1]);
    let in_corner = |p: &Point3<f64>, leg: usize| {
        (p - waypoints[leg]).norm() < settings.corner || (p - waypoints[leg + 1]).norm() < settings.corner
    };
    let samples = positions.iter().zip(legs);
    let of = |distance| Off { distance, place: None, segment: 0 };
    match settings.reference {
        Reference::Leg => Ok(samples.map(|(p, &l)| of((!in_corner(p, l)).then(|| from_leg(p, l)))).collect()),
        Reference::NearestLeg => {
            let nearest = |p, l: usize| from_leg(p, l).min(from_leg(p, l.saturating_sub(1)));
            Ok(samples.map(|(p, &l)| of((!in_corner(p, l)).then(|| nearest(p, l)))).collect())
        }
        Reference::Path(path) => {
            let places = path_places(positions, weights, path)?.into_iter().zip(positions);
            let of = |((place, segment), p): ((Point3<f64>, usize), &Point3<f64>)| Off {
                distance: Some((p - place).norm()),
                place: Some(place),
                segment,
            };
            Ok(places.map(of).collect())
        }
    }
}

/// Segments of a path that one piece of its assignment may stand for: so many pieces at most.
/// Assigning costs samples × pieces.
const PATH_PIECES: usize = 1024;

/// The place on the path that every sample belongs to by monotone assignment, and the segment that it lies on.
///
/// `weights` in s. Where one piece stands for several segments, the place is the nearest on these and on as many
/// before and after. A path that bends between its places is assigned by its chords; the place is then the nearest of
/// the curve about the chord's.
fn path_places(
    positions: &[Point3<f64>],
    weights: &[f64],
    path: &Track,
) -> Result<Vec<(Point3<f64>, usize)>, JudgementError> {
    if path.len() < 2 {
        return Err(JudgementError::Path { found: path.len() });
    }
    // Long paths are assigned by chords over several segments; the place is then the nearest on the segments of the
    // chord and its neighbours.
    let segments = path.len() - 1;
    let stride = segments.div_ceil(PATH_PIECES);
    let pieces: Vec<Piece> = (0..segments)
        .step_by(stride)
        .map(|i| Piece { from: path.position(i), to: path.position((i + stride).min(segments)), owner: i })
        .collect();
    let margin = if stride > 1 { stride } else { 0 };
    let assigned = monotone(positions, weights, &pieces);
    let place = |(p, piece): (&Point3<f64>, usize)| {
        let first = pieces[piece].owner.saturating_sub(margin);
        let end = (pieces[piece].owner + stride + margin).min(segments);
        let on = |i: usize| (nearest_point(p, &path.position(i), &path.position(i + 1)), i);
        let nearer =
            |a: (Point3<f64>, usize), b: (Point3<f64>, usize)| if (p - b.0).norm() < (p - a.0).norm() { b } else { a };
        let by_chords = (first + 1..end).map(on).fold(on(first), nearer);
        let beside = by_chords.1.saturating_sub(1)..(by_chords.1 + 2).min(segments);
        if beside.clone().all(|i| path.way(i).is_none()) {
            return by_chords;
        }
        let curved = |i: usize| (path.nearest(i, p), i);
        beside.map(curved).fold(curved(by_chords.1), nearer)
    };
    Ok(positions.iter().zip(assigned).map(place).collect())
}
