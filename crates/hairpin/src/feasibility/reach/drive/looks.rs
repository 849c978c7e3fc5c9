//! A whole drive held clear of places to keep out of that were not known when its legs were solved: at the closest of
//! the same looks, taken once.

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
pub struct DriveLooks {
    /// x and y, m, and the metres of the step around them.
    looks: Vec<([f64; 2], f64)>,
}

impl DriveLooks {
    /// Looks along `drive`, planned without latency, leg after leg from each leg's own start, as closely as legs that
    /// come near to something are looked at when they are solved with `settings`. `None` where the ground does not
    /// carry it.
    pub fn along(site: &DriveSite, settings: &DriveSettings, drive: &Drive) -> Option<Self> {
        let mut looks = Vec::new();
        for leg in &drive.legs {
            looks.push(([leg.from.x, leg.from.y], 0.0));
            let course = settings.course(site, CLOSER, leg.speed, leg.direction);
            let look = |driven: &Driven| {
                let metres = if driven.in_place { 0.0 } else { driven.step.abs() };
                looks.push(([driven.at.x, driven.at.y], metres));
                true
            };
            predict_while(&course, &leg.from, &leg.segments, look).ok()?;
            looks.push(([leg.to.x, leg.to.y], 0.0));
        }
        Some(Self { looks })
    }

    /// Whether they show that the drive keeps `radius` (m) from `keep_outs` everywhere.
    pub fn keep_out_of(&self, keep_outs: &KeepOuts, radius: f64) -> bool {
        self.looks.iter().all(|(at, metres)| keeps_out(keep_outs, radius, *at, *metres))
    }

    /// Their places, x and y, m.
    pub fn places(&self) -> impl ExactSizeIterator<Item = [f64; 2]> + '_ {
        self.looks.iter().map(|(at, _)| *at)
    }

    /// The longest step between two of them, m: what is kept from keep-outs beyond the radius where they show that it
    /// is.
    pub fn longest_step(&self) -> f64 {
        self.looks.iter().map(|(_, metres)| *metres).fold(0.0, f64::max)
    }
}
