//! Whether a log left its world: for certain, or as far as its samples and what they know of their place tell.

use nalgebra::{Point3, Vector3};

use super::doubts::{Doubt, Looked, Why, violation};
use super::log::Log;
use crate::campaign::Setup;
use crate::judgement::most_between;

/// From a place to itself and to its six neighbours at one standard deviation along the axes, across and up.
fn ways([across, up]: [f64; 2]) -> impl Iterator<Item = Vector3<f64>> {
    let along = [Vector3::x() * across, Vector3::y() * across, Vector3::z() * up];
    let off = along.into_iter().filter(|way| way.norm() > 0.0).flat_map(|way| [way, -way]);
    std::iter::once(Vector3::zeros()).chain(off)
}

/// When it was first outside its world for certain: with all that lies within its accuracy, nearly ([`ways`]), s.
pub(super) fn left_world(setup: &Setup, log: &Log) -> Option<f64> {
    let track = &log.flight.track;
    let outside = |i: &usize| ways(log.sigma(*i)).all(|way| setup.is_outside(&(track.position(*i) + way)));
    (0..track.len()).find(outside).map(|i| track.times()[i])
}

impl Looked<'_> {
    /// Whether it may have left its world, which no sample shows for certain: within what the log knows of its place,
    /// or between two samples. What is told is the least distance of all samples, wherever it is in doubt.
    pub(super) fn edge(&self, setup: &Setup) -> Option<Doubt> {
        let why = self.edge_at_samples(setup).or_else(|| self.edge_between(setup))?;
        let (i, edge) = self.nearest_edge(setup)?;
        let at = self.log.flight.track.times()[i];
        Some(Doubt { value: violation("edge", edge, 0.0, at, self.close[i].leg), why })
    }

    /// The first sample that is as near to the world's edge as any, and how near, m; `None` where the world has no end.
    ///
    /// The distance falls by no more than the way moved, so that samples near one that is far from the edge are not
    /// looked at; it is asked for within twice the least one known, beyond which holes of a map need not be looked for.
    fn nearest_edge(&self, setup: &Setup) -> Option<(usize, f64)> {
        let track = &self.log.flight.track;
        let exact = |p: &Point3<f64>| {
            let mut within = 1.0;
            loop {
                let edge = setup.edge_distance(p, within);
                if edge < within || !edge.is_finite() {
                    return edge;
                }
                within *= 2.0;
            }
        };
        let (mut least, mut looked) = ((0, exact(&track.position(0))), track.position(0));
        if least.1.is_infinite() {
            return None;
        }
        let mut edge_there = least.1;
        for i in 1..track.len() {
            let p = track.position(i);
            if edge_there - (p - looked).norm() >= least.1 {
                continue;
            }
            let edge = setup.edge_distance(&p, 2.0 * least.1.max(0.5));
            (looked, edge_there) = (p, edge);
            if edge < least.1 {
                least = (i, edge);
            }
        }
        Some(least)
    }

    /// Why a sample may be outside: of those that may, the one nearest to the edge.
    fn edge_at_samples(&self, setup: &Setup) -> Option<Why> {
        let track = &self.log.flight.track;
        let may_be_out =
            |i: usize, sigma: [f64; 2]| ways(sigma).any(|way| setup.is_outside(&(track.position(i) + way)));
        let near = |i: usize| {
            let [across, up] = self.log.sigma(i);
            let edge = setup.edge_distance(&track.position(i), across.max(up));
            may_be_out(i, [across, up]).then_some((i, edge))
        };
        let (i, _) = (0..track.len()).filter_map(near).min_by(|a, b| a.1.total_cmp(&b.1))?;
        // Which of the two it is: up and down alone keep it inside, or do not.
        let [across, up] = self.log.sigma(i);
        let (which, sigma) = if may_be_out(i, [across, 0.0]) { ("eph", across) } else { ("epv", up) };
        Some(Why::Accuracy { which, sigma })
    }

    /// Why it may have been outside between two samples: as far as it may, and by samples that would tell.
    fn edge_between(&self, setup: &Setup) -> Option<Why> {
        let (mut most, mut rate) = (f64::NEG_INFINITY, Some(0.0_f64));
        for i in 0..self.log.flight.track.len() {
            let Some((beyond, at_ends)) = self.beyond(setup, i) else { continue };
            most = most.max(beyond);
            rate = rate.and_then(|rate| Some(rate.max(self.swiftness.rate(-at_ends)?)));
        }
        (most > 0.0).then_some(Why::Between { most: -most, rate_hz: rate })
    }

    /// How far (m) it may have been beyond the edge after sample `i`, infinite where nothing bounds it, and how far at
    /// most with its ends off by as much as they know; `None` where it was not.
    fn beyond(&self, setup: &Setup, i: usize) -> Option<(f64, f64)> {
        let track = &self.log.flight.track;
        let (_, bulge) = self.after(i)?;
        let ends = [track.position(i), track.position(i + 1)];
        if bulge.is_infinite() {
            let near = setup.edge_distance(&ends[0], 0.0);
            return near.is_finite().then_some((f64::INFINITY, -near));
        }
        let accuracy = [0, 1].map(|axis| self.log.sigma(i)[axis].max(self.log.sigma(i + 1)[axis]));
        let reach = (ends[1] - ends[0]).norm() + bulge + accuracy[0].max(accuracy[1]);
        let near = setup.edge_distance(&ends[0], reach);
        if near >= reach {
            return None;
        }
        let (mut most, mut at_ends) = (f64::NEG_INFINITY, -near);
        for way in ways(accuracy) {
            let beyond = |p: &Point3<f64>| -setup.edge_distance(&(p + way), reach);
            let own = ends.map(|p| (p, beyond(&p)));
            at_ends = at_ends.max(own[0].1).max(own[1].1);
            most = most.max(most_between(&beyond, own, bulge, 0.0));
        }
        (most > 0.0).then_some((most, at_ends))
    }
}
