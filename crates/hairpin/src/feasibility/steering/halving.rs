//! Proof on all of a leg by halving: intervals of time, four at a time, until each is decided.
//!
//! Shared by the proof of the body's limits and by other rooms of feasibility that look at a function of time: what is
//! evaluated is the caller's. Depth first, the leg's last intervals before its first ones, so that memory is bounded by
//! the depth and not by the number of intervals. Nothing is allocated.

/// Intervals at most that wait for their turn: with at most 64 at first, and the last of them halved first, more than
/// proofs of 1024 evaluations come to.
pub(super) const WAITING: usize = 128;

/// How hard the bound between samples tries.
///
/// A larger budget decides more legs near their limits.
///
/// The worst case costs `budget` evaluations of four intervals; most legs take the first two batches.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ProofSettings {
    /// Equal intervals that a leg is cut into first; 4 … 64.
    pub first: usize,
    /// An undecided interval shorter than this share of the leg ends the proof.
    ///
    /// A pure number in (0, 1): at 1/16384 a leg of 4 s is looked at down to a quarter of a millisecond.
    pub shortest: f64,
    /// Intervals evaluated per leg at most.
    ///
    /// Counted one for each interval, not for each batch; what is spent when it runs out is refused.
    pub budget: usize,
}

impl Default for ProofSettings {
    /// 8 intervals at first, 1/16384 of the leg, 1024 evaluations.
    fn default() -> Self {
        Self { first: 8, shortest: 1.0 / 16384.0, budget: 1024 }
    }
}

impl ProofSettings {
    /// Centres and half widths of the first intervals of [0, `duration`], s.
    #[inline(always)]
    pub(super) fn intervals(&self, duration: f64) -> impl Iterator<Item = (f64, f64)> {
        let half = 0.5 * duration / self.first as f64;
        (0..self.first).map(move |k| ((2 * k + 1) as f64 * half, half))
    }
}

/// Cuts [0, `duration`] (s) into `settings.first` intervals, and halves what `evaluate` cannot decide.
///
/// `evaluate` takes the centres and half widths of four intervals, of which the last may repeat, and gives the bit
/// masks of those that are proven and of those whose centre violates a limit.
///
/// `settings.first` must be 1 … 128. An interval is given up, and its centre returned as `Err`, when its half width is
/// below half of `shortest` · `duration`, when the budget is spent, or when more than 128 would wait: refusing errs on
/// the safe side. Violations of a batch are looked for before anything in it is halved. Intervals join without gaps but
/// for the rounding of their centres, of which the room in the caller's comparisons takes care. `duration` NaN:
/// whatever `evaluate` says of NaN, which should be neither.
///
/// # Errors
/// The centre of an interval that violates, or that the settings do not let it decide.
#[inline(always)]
pub(in crate::feasibility) fn prove_by_halving(
    duration: f64,
    settings: &ProofSettings,
    evaluate: impl Fn(&[(f64, f64); 4]) -> (u32, u32),
) -> Result<(), f64> {
    // Centres and half widths of what is still to be decided.
    let mut waiting = [(0.0, 0.0); WAITING];
    let mut count = settings.first;
    waiting.iter_mut().zip(settings.intervals(duration)).for_each(|(place, interval)| *place = interval);
    let mut evaluated = 0;
    while count > 0 {
        let taken = count.min(4);
        count -= taken;
        let batch: [(f64, f64); 4] = std::array::from_fn(|lane| waiting[count + lane.min(taken - 1)]);
        evaluated += taken;
        let (proven, violated) = evaluate(&batch);
        if let Some(lane) = (0..taken).find(|lane| violated & (1 << lane) != 0) {
            return Err(batch[lane].0);
        }
        for (lane, &(center, half)) in batch.iter().enumerate().take(taken) {
            if proven & (1 << lane) != 0 {
                continue;
            }
            let exhausted = half < 0.5 * settings.shortest * duration || evaluated >= settings.budget;
            if exhausted || count + 2 > WAITING {
                return Err(center);
            }
            waiting[count] = (center - 0.5 * half, 0.5 * half);
            waiting[count + 1] = (center + 0.5 * half, 0.5 * half);
            count += 2;
        }
    }
    Ok(())
}
