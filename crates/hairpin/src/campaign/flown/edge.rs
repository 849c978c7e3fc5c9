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

/// What may lie beyond the edge between two samples.
struct Beyond {
    /// The first of them.
    from: usize,
    /// How far it may, m; infinite where nothing bounds it.
    most: f64,
    /// How far from the edge the first of them is, m.
    near: f64,
}

impl Looked<'_> {
    /// Whether it may have left its world, which no sample shows for certain: within what the log knows of its place,
    /// or between two samples.
    pub(super) fn edge(&self, setup: &Setup) -> Option<Doubt> {
        self.edge_at_samples(setup).or_else(|| self.edge_between(setup))
    }

    fn edge_doubt(&self, i: usize, edge: f64, why: Why) -> Doubt {
        Doubt { value: violation("edge", edge, 0.0, self.log.flight.track.times()[i], self.close[i].leg), why }
    }

    fn edge_at_samples(&self, setup: &Setup) -> Option<Doubt> {
        let track = &self.log.flight.track;
        let may_be_out =
            |i: usize, sigma: [f64; 2]| ways(sigma).any(|way| setup.is_outside(&(track.position(i) + way)));
        let near = |i: usize| {
            let [across, up] = self.log.sigma(i);
            let edge = setup.edge_distance(&track.position(i), across.max(up));
            may_be_out(i, [across, up]).then_some((i, edge))
        };
        let (i, edge) = (0..track.len()).filter_map(near).min_by(|a, b| a.1.total_cmp(&b.1))?;
        // Which of the two it is: up and down alone keep it inside, or do not.
        let [across, up] = self.log.sigma(i);
        let (which, sigma) = if may_be_out(i, [across, 0.0]) { ("eph", across) } else { ("epv", up) };
        Some(self.edge_doubt(i, edge, Why::Accuracy { which, sigma }))
    }

    fn edge_between(&self, setup: &Setup) -> Option<Doubt> {
        let (mut worst, mut rate) = (None::<Beyond>, Some(0.0_f64));
        for i in 0..self.log.flight.track.len() {
            let Some((beyond, at_ends)) = self.beyond(setup, i) else { continue };
            if beyond.most.is_infinite() {
                (worst, rate) = (Some(beyond), None);
                break;
            }
            rate = rate.and_then(|rate| Some(rate.max(self.rate(-at_ends)?)));
            if worst.as_ref().is_none_or(|before| beyond.most > before.most) {
                worst = Some(beyond);
            }
        }
        let Beyond { from, most, near } = worst?;
        Some(self.edge_doubt(from, near, Why::Between { most: -most, rate_hz: rate }))
    }

    /// What may lie beyond the edge after sample `i`, and how far (m) at most with its ends off by as much as they
    /// know; `None` where nothing does.
    fn beyond(&self, setup: &Setup, i: usize) -> Option<(Beyond, f64)> {
        let track = &self.log.flight.track;
        let (_, bulge) = self.after(i)?;
        let ends = [track.position(i), track.position(i + 1)];
        if bulge.is_infinite() {
            let near = setup.edge_distance(&ends[0], 0.0);
            return near.is_finite().then_some((Beyond { from: i, most: f64::INFINITY, near }, -near));
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
        (most > 0.0).then_some((Beyond { from: i, most, near }, at_ends))
    }
}
