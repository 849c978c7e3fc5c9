//! Proof on all of a leg by halving: intervals of time, four at a time, until each is decided.

/// Intervals at most that wait for their turn: with at most 64 at first, and the last of them halved first, more than
/// proofs of 1024 evaluations come to.
const WAITING: usize = 128;

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
    pub shortest: f64,
    /// Intervals evaluated per leg at most.
    pub budget: usize,
}

impl Default for ProofSettings {
    /// 8 intervals at first, 1/16384 of the leg, 1024 evaluations.
    fn default() -> Self {
        Self { first: 8, shortest: 1.0 / 16384.0, budget: 1024 }
    }
}

/// Cuts [0, `duration`] (s) into `settings.first` intervals, and halves what `evaluate` cannot decide.
///
/// `evaluate` takes the centres and half widths of four intervals, of which the last may repeat, and gives the bit
/// masks of those that are proven and of those whose centre violates a limit.
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
    let first = 0.5 * duration / count as f64;
    for (k, interval) in waiting[..count].iter_mut().enumerate() {
        *interval = ((2 * k + 1) as f64 * first, first);
    }
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
