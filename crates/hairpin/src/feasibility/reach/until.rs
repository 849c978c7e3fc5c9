//! A reach set for as long as somebody waits for it.

use std::cell::Cell;

use nalgebra::Point3;

use super::{Entry, Leg, Reach};

/// The legs of another set until `over` says that nobody waits any longer, and none from then on: whatever searches it
/// runs dry. What was found then says nothing of the graph, so that who asks must ask [`Until::cut`] as well.
///
/// Between two looks at `over` lies one look at the inner set: 10⁻⁵ s of a translated hull, up to a second where every
/// leg is a boundary-value problem on a map.
///
/// ```
/// use hairpin::feasibility::reach::{Everywhere, Reach, StepNode, StepReach, StepSettings, Until};
/// use nalgebra::Point3;
///
/// let points = [Point3::new(0.0, 0.0, 1.0), Point3::new(1.0, 0.0, 1.0)];
/// let inner = StepReach::new(&Everywhere, &points, StepSettings::default());
/// let (start, mut legs) = (StepNode { previous: 0, current: 0 }, Vec::new());
/// let until = Until::new(&inner, &|| true);
/// until.legs(&start, &points, &mut legs);
/// assert!(legs.is_empty() && until.cut());
/// ```
pub struct Until<'a, N> {
    inner: &'a dyn Reach<N>,
    over: &'a dyn Fn() -> bool,
    cut: Cell<bool>,
}

impl<'a, N> Until<'a, N> {
    /// The legs of `inner` until `over`.
    ///
    /// `over` is asked once a look, and never again after it said yes.
    pub fn new(inner: &'a dyn Reach<N>, over: &'a dyn Fn() -> bool) -> Self {
        Self { inner, over, cut: Cell::new(false) }
    }

    /// Whether legs were kept back.
    ///
    /// False where the last look came before the end: then all that was seen is the inner set's.
    pub fn cut(&self) -> bool {
        self.cut.get()
    }

    fn goes_on(&self) -> bool {
        if !self.cut.get() {
            self.cut.set((self.over)());
        }
        !self.cut.get()
    }
}

impl<N> Reach<N> for Until<'_, N> {
    fn legs(&self, from: &N, candidates: &[Point3<f64>], out: &mut Vec<Leg<N>>) {
        if self.goes_on() {
            self.inner.legs(from, candidates, out);
        }
    }

    fn possible(&self, from: &N, candidates: &[Point3<f64>], out: &mut Vec<Leg<N>>) {
        if self.goes_on() {
            self.inner.possible(from, candidates, out);
        }
    }

    fn proven(&self, from: &N, to: &N, duration: f64) -> Option<f64> {
        if self.goes_on() { self.inner.proven(from, to, duration) } else { None }
    }

    fn leg(&self, from: &N, to: &N, candidates: &[Point3<f64>]) -> Option<Leg<N>>
    where
        N: PartialEq,
    {
        if self.goes_on() { self.inner.leg(from, to, candidates) } else { None }
    }

    fn is_known_at_once(&self) -> bool {
        self.inner.is_known_at_once()
    }

    fn entry(&self, from: &N) -> Option<Entry> {
        self.inner.entry(from)
    }
}
