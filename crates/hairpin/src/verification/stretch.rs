//! A piece of a drive on the ground, stride by stride, each as long as what it leaves out allows.

use super::crest::{Followed, SHOWN};
use super::stand::{NoRest, Rest};
use super::stride::{Look, Pose, Stretch, Taken, Tried};
use crate::world::terrain::Terrain;

/// What a drive's strides may leave out of its end's place in all, m, and of its heading times the metres left: a
/// hundredth of what drives are usually held to.
const ACCURACY: f64 = 1e-4;
/// Of what strides before left, one may leave out so many times its own share.
const SPARE: f64 = 2.0;
/// Longest stride, m and rad: what lies between two looks is not seen.
const LONGEST: f64 = 0.1;
/// The shortest is this share of the drive, or this long, m and rad: whatever it leaves out is told.
const SHORTEST: (f64, f64) = (1.0 / 4000.0, 2.5e-4);
/// Plain steps that are tried where the body falls in the shortest stride, as multiples of it.
const PLAIN: [f64; 5] = [1.0, 2.0, 4.0, 8.0, 16.0];

/// A stride that is taken, how long it is, and how long the next one may be, m or rad.
struct Step {
    h: f64,
    tried: Tried,
    next: f64,
}

impl<T: Terrain> Stretch<'_, T> {
    /// Drives on from `at`, where the body rests, to the end of the piece, where `at` is then.
    ///
    /// `pass` is shown places along the way. No rest is told with s.
    pub(super) fn follow(
        &self,
        at: &mut (Pose, Rest),
        followed: &mut Followed,
        pass: &mut Option<&mut dyn FnMut(Pose)>,
    ) -> Result<(), (f64, NoRest)> {
        let length = self.length.abs();
        if !length.is_finite() {
            return Err((0.0, NoRest::NotFound));
        }
        let mut looks = vec![self.seen(0.0, at.1)];
        let mut taken: Vec<Taken> = Vec::new();
        let (mut pose, mut done, mut stride, mut ended) = (at.0, 0.0, LONGEST, false);
        // What the strides before left of their share.
        let mut spare = 0.0_f64;
        while done < length {
            let (from, left) = ((f64::copysign(done, self.length), pose), length - done);
            let Step { h, tried, next } =
                self.step(from, &mut looks, [stride, left, spare]).map_err(|no| (from.0, no))?;
            followed.strides += 1;
            followed.left_out += tried.off;
            spare = (spare + ACCURACY * h / self.extent - tried.off).max(0.0);
            for walked in tried.taken {
                if let Some(pass) = pass {
                    let parts = (SHOWN * walked.h.abs() / self.extent).ceil().max(1.0) as usize;
                    (1..=parts).for_each(|part| pass(walked.pose(part as f64 / parts as f64)));
                }
                pose = walked.poses[2];
                taken.push(walked);
            }
            done = if h >= left { length } else { done + h };
            (stride, ended) = (next, tried.ended);
        }
        // Nobody asks how it stands where the drive ends: what is behind the last look may be an edge.
        if !ended && let Ok((end, _)) = self.look(&looks, self.length, pose) {
            looks.push(end);
        }
        *at = (pose, looks[looks.len() - 1].rest);
        self.add_peaks(&looks, &taken, followed);
        Ok(())
    }

    /// The next stride, `stride` long at most and no longer than what is `left`: halved, or more, until it is near
    /// enough; a plain step where none is short enough for a body that falls.
    ///
    /// ```text
    /// allowed(h) = ACCURACY · h / extent,   next h = h · clamp(0.9 √(allowed/off), …)
    /// ```
    ///
    /// `off` is what the stride is estimated to leave out (m, and rad times metres). It goes with h³ and what is
    /// allowed with h, so that the square root of their ratio is the step's factor: between 0.5 and 2 after a stride
    /// that is taken, between 0.2 and 0.7 after one that is not, a quarter where the body fell. The shortest stride is
    /// taken whatever it leaves out.
    fn step(&self, from: (f64, Pose), looks: &mut Vec<Look>, [stride, left, spare]: [f64; 3]) -> Result<Step, NoRest> {
        let shortest = SHORTEST.1.max(SHORTEST.0 * self.extent);
        let (mut h, known) = (stride.min(left), looks.len());
        loop {
            let share = ACCURACY * h / self.extent;
            let allowed = share + spare.min(SPARE * share);
            let tried = self.attempt(from, h.copysign(self.length), looks).ok();
            // A difference that is not a number is as large as can be; its root is that of third-order terms.
            let longer = tried.as_ref().map_or(0.0, |tried| 0.9 * (allowed / tried.off).sqrt());
            let fell = tried.as_ref().is_none_or(|tried| tried.fell);
            match tried {
                Some(tried) if !fell && (h <= shortest || tried.off <= allowed) => {
                    let next = shortest.max(LONGEST.min(h * bounded(longer, 0.5, 2.0)));
                    return Ok(Step { h, tried, next });
                }
                _ => looks.truncate(known),
            }
            if h <= shortest {
                return self.fall(from, looks, shortest, left);
            }
            h = shortest.max(h * if fell { 0.25 } else { bounded(longer, 0.2, 0.7) });
        }
    }

    /// The first plain step that finds a rest.
    ///
    /// Plain steps of 1, 2, 4, 8 and 16 times the shortest, none longer than what is left; the last refusal where none
    /// finds a rest.
    fn fall(&self, from: (f64, Pose), looks: &mut Vec<Look>, shortest: f64, left: f64) -> Result<Step, NoRest> {
        let mut refused = NoRest::NotFound;
        for times in PLAIN {
            let h = left.min(times * shortest);
            match self.plainly(from, h.copysign(self.length), looks) {
                Ok(tried) => return Ok(Step { h, tried, next: shortest }),
                Err(why) => refused = why,
            }
        }
        Err(refused)
    }
}

/// `x` within bounds; the lower one if it is no number.
fn bounded(x: f64, low: f64, high: f64) -> f64 {
    if x > low { x.min(high) } else { low }
}
