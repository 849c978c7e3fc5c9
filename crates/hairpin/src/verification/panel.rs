//! A stride on the ground by Simpson's rule, whole and in halves, over places that are foreseen and looked at once.

use super::stand::NoRest;
use super::stride::{Look, Pose, Stretch, Taken, Tried, foreseen, surprises, turned};
use crate::world::terrain::Terrain;

/// ∫₀^(h/2) and ∫₀^h of what is `values` at 0, h/2 and h, by the parabola through them: h/24 (5, 8, −1), h/6 (1, 4, 1).
fn panel(h: f64, values: [f64; 3]) -> [f64; 2] {
    let [first, middle, last] = values;
    [h / 24.0 * (5.0 * first + 8.0 * middle - last), h / 6.0 * (first + 4.0 * middle + last)]
}

/// `start` and what `rates`, a quarter of `h` apart, lead to after each quarter, by one panel for each half.
fn summed(start: f64, h: f64, rates: [f64; 5]) -> [f64; 5] {
    let [quarter, half] = panel(0.5 * h, [rates[0], rates[1], rates[2]]);
    let [beyond, end] = panel(0.5 * h, [rates[2], rates[3], rates[4]]);
    [start, start + quarter, start + half, start + half + beyond, start + half + end]
}

impl<T: Terrain> Stretch<'_, T> {
    /// Four looks a quarter of `h` apart, the last where the next stride begins, and panels through their rates.
    ///
    /// Each is foreseen by the line through the last two rates, and led on from by the mean of both its ends. The rates
    /// depend on the place but little: by what they change over a quarter, times the share of it that the look was
    /// beside its place, which counts as left out. Headings do not depend on themselves and are summed first.
    ///
    /// ```text
    /// S₁ = h/6 (f₀ + 4 f₂ + f₄),   S₂ = h/12 (f₀ + 4 f₁ + 2 f₂ + 4 f₃ + f₄),   off = |S₂ − S₁|/3 + Σ |fᵢ − fᵢ₋₁| δᵢ
    /// ```
    ///
    /// A kink of the rates goes with h², of which halves leave a quarter: hence a third, where smooth rates would have
    /// a fifteenth.
    pub(super) fn by_panels(&self, (s, from): (f64, Pose), h: f64, looks: &mut Vec<Look>) -> Result<Tried, NoRest> {
        let d = 0.25 * h;
        let (mut change, begun) = match &looks[..] {
            [.., before, last] if last.s != before.s => {
                (rise(&before.rates, &last.rates, d / (last.s - before.s)), last)
            }
            [.., last] => ([0.0; 3], last),
            [] => unreachable!("a piece begins with a look"),
        };
        let mut rates = [begun.rates; 5];
        let (mut pose, mut beside) = (from, [0.0; 2]);
        for node in 1..5 {
            let before = rates[node - 1];
            let foreseen = led(&pose, &before, &change, d);
            let (look, surprise) = self.look(looks, s + d * node as f64, foreseen)?;
            if surprise && !self.comes_to(&look, looks, led(&pose, &before, &change.map(|c| 0.5 * c), 0.5 * d))? {
                return Ok(Tried { taken: Vec::new(), ended: false, off: f64::NAN, fell: true });
            }
            rates[node] = look.rates;
            looks.push(look);
            change = rise(&before, &rates[node], 1.0);
            pose = led(&pose, &before, &change, d);
            let miss = (0..3).map(|i| (pose[i] - foreseen[i]).abs()).fold(0.0, f64::max);
            beside[0] += miss * (change[0].abs() + change[1].abs());
            beside[1] += miss * change[2].abs();
        }
        let yaws = summed(from[2], h, rates.map(|rates| rates[2]));
        let ways: [Pose; 5] = std::array::from_fn(|i| turned(&rates[i], yaws[i]));
        let [xs, ys] = [0, 1].map(|i| summed(from[i], h, ways.map(|way| way[i])));
        let poses: [Pose; 5] = std::array::from_fn(|i| [xs[i], ys[i], yaws[i]]);
        let off: Pose = std::array::from_fn(|i| {
            let [_, whole] = panel(h, [0, 2, 4].map(|node| ways[node][i]));
            (poses[4][i] - from[i] - whole).abs() / 3.0 + beside[i / 2]
        });
        let half = |begun: usize| Taken {
            s: s + d * begun as f64,
            h: 0.5 * h,
            poses: [poses[begun], poses[begun + 1], poses[begun + 2]],
        };
        Ok(Tried { taken: vec![half(0), half(2)], ended: true, off: self.far(s, &off), fell: false })
    }

    /// Whether the body comes to `look` by way of `halfway` from the last of `looks`, without a surprise. What was seen
    /// there is one of them then.
    fn comes_to(&self, look: &Look, looks: &mut Vec<Look>, halfway: Pose) -> Result<bool, NoRest> {
        let last = &looks[looks.len() - 1];
        let (between, surprise) = self.look(looks, 0.5 * (last.s + look.s), halfway)?;
        looks.push(between);
        Ok(!surprise && !surprises(&foreseen(looks, look.s), &look.rest, looks, look.s))
    }
}

/// What rates change by, times `share`.
fn rise(from: &[f64; 3], to: &[f64; 3], share: f64) -> [f64; 3] {
    std::array::from_fn(|i| share * (to[i] - from[i]))
}

/// `pose` led on over `d` at `rates` that change evenly by `change`: the heading halfway is that of the mean rate.
fn led(pose: &Pose, rates: &[f64; 3], change: &[f64; 3], d: f64) -> Pose {
    let mean: [f64; 3] = std::array::from_fn(|i| rates[i] + 0.5 * change[i]);
    let [x, y, turn] = turned(&mean, pose[2] + 0.5 * d * mean[2]);
    [pose[0] + d * x, pose[1] + d * y, pose[2] + d * turn]
}
