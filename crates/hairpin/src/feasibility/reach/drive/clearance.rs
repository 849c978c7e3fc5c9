//! A whole drive held clear of places to keep out of that were not known when its legs were solved: at the closest of
//! the same samples, taken once.

use super::settings::{DriveSettings, DriveSite};
use super::watch::{CLOSER, keeps_out};
use crate::feasibility::steering::shooting::rough::{Driven, predict_while};
use crate::trajectory::Drive;
use crate::world::terrain::KeepOuts;

/// Where the predicted motion of a drive is looked at, in order.
///
/// |p − look| ≤ metres for every place p of the step around a look: what is that much farther from a keep-out than the
/// radius is clear of it between looks as well.
#[derive(Debug, Clone, PartialEq)]
pub struct ClearanceSamples {
    /// x and y, m, and the metres of the step around them.
    samples: Vec<([f64; 2], f64)>,
}

impl ClearanceSamples {
    /// Samples of `drive`, planned without latency, leg after leg from each leg's own start, as closely as legs that
    /// come near to something are looked at when they are solved with `settings`. `None` where the ground does not
    /// carry it.
    pub fn along(site: &DriveSite, settings: &DriveSettings, drive: &Drive) -> Option<Self> {
        let mut samples = Vec::new();
        for leg in &drive.legs {
            samples.push(([leg.from.x, leg.from.y], 0.0));
            let course = settings.course(site, CLOSER, leg.speed, leg.direction);
            let look = |driven: &Driven| {
                let metres = if driven.in_place { 0.0 } else { driven.step.abs() };
                samples.push(([driven.at.x, driven.at.y], metres));
                true
            };
            predict_while(&course, &leg.from, &leg.segments, look).ok()?;
            samples.push(([leg.to.x, leg.to.y], 0.0));
        }
        Some(Self { samples })
    }

    /// Whether they show that the drive keeps `radius` (m) from `keep_outs` everywhere.
    pub fn keep_out_of(&self, keep_outs: &KeepOuts, radius: f64) -> bool {
        self.samples.iter().all(|(at, metres)| keeps_out(keep_outs, radius, *at, *metres))
    }

    /// Their places, x and y, m.
    pub fn places(&self) -> impl ExactSizeIterator<Item = [f64; 2]> + '_ {
        self.samples.iter().map(|(at, _)| *at)
    }

    /// The longest step between two of them, m: what is kept from keep-outs beyond the radius where they show that it
    /// is.
    pub fn longest_step(&self) -> f64 {
        self.samples.iter().map(|(_, metres)| *metres).fold(0.0, f64::max)
    }
}
