//! The path with sharp corners, on the time table of the blended one: what `from = "sharp"` means.

use super::order::Zone;
use super::plan::Plan;
use super::settings::PlanSettings;
use crate::simulation::SimulationError;
use crate::trajectory::{PlannedMove, PlannedPath, Track};

impl Plan<'_> {
    /// The path through every target. A point's time is that of the blended plan at the same share of its move's time.
    ///
    /// Between passings of targets k and k + 1: t = t_k + (τ − τ_k)/(τ_{k+1} − τ_k) · (t_{k+1} − t_k), τ of the sharp
    /// plan without waits, t of this one. Where this plan stops early, so does it.
    ///
    /// # Errors
    /// None that [`Plan::new`] has not had.
    pub fn sharp_path(&self) -> Result<PlannedPath, SimulationError> {
        let mut orders = self.orders.to_vec();
        for order in &mut orders {
            order.zone = Zone::Fine;
        }
        let sharp = Plan::new(self.arm, self.start(), &orders, &PlanSettings { settle: 0.0, ..self.settings })?;
        let path = sharp.path();
        // Time runs linearly within each move, from one passing to the next.
        let own: Vec<f64> = std::iter::once(0.0).chain(sharp.passed().iter().copied()).collect();
        let given: Vec<f64> = std::iter::once(0.0).chain(self.passed().iter().copied()).collect();
        let known = own.len().min(given.len());
        let mut number = 0;
        let (mut times, mut kept, mut ways) = (Vec::new(), Vec::new(), Vec::new());
        let mut node_at = Vec::with_capacity(path.track().len());
        for (i, (time, pose)) in path.track().times().iter().zip(path.track().poses()).enumerate() {
            while number + 2 < known && *time > own[number + 1] {
                number += 1;
            }
            let share = (time - own[number]) / (own[(number + 1).min(known - 1)] - own[number]).max(1e-12);
            let mapped = given[number] + share * (given[(number + 1).min(known - 1)] - given[number]);
            if times.last().is_none_or(|last| mapped > *last) {
                if !times.is_empty() {
                    ways.push(path.track().way(i - 1).copied());
                }
                times.push(mapped);
                kept.push(*pose);
            }
            node_at.push(times.len() - 1);
        }
        let moves = path.moves().iter().map(|m| PlannedMove { end: node_at[m.end], ..m.clone() }).collect();
        let track = Track::new(times, kept, Vec::new()).expect("times rise");
        Ok(PlannedPath::new(track.along(ways), moves))
    }
}
