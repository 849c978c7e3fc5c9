//! A cubic between two places and its nearest point: what curved paths are between the places that are known of them.
//!
//! With both ends' derivatives by the share u a cubic is off a smooth curve by h⁴/384 of its fourth derivative, where
//! the straight line is off by h²/8 of its second: a few places say what thousands would.

use nalgebra::{Point3, Vector3};

use super::segment::{nearest_parameter, nearest_point};

/// c(u) = a + b u + c u² + d u³, u in [0, 1]; m.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cubic {
    /// By rising power of u.
    powers: [Vector3<f64>; 4],
}

/// Newton's steps at most: from a chord's foot two or three are enough.
const STEPS: usize = 6;
/// A step of u as short as this changes nothing that counts.
const SETTLED: f64 = 1e-7;

impl Cubic {
    /// Hermite's: through `from` and `to` with the derivatives `rates` by u there.
    pub fn between(from: &Point3<f64>, to: &Point3<f64>, rates: [Vector3<f64>; 2]) -> Self {
        let (way, [v, w]) = (to - from, rates);
        Self { powers: [from.coords, v, way * 3.0 - v * 2.0 - w, v + w - way * 2.0] }
    }

    /// Where it is at `u`.
    pub fn at(&self, u: f64) -> Point3<f64> {
        let [a, b, c, d] = &self.powers;
        Point3::from(a + (b + (c + d * u) * u) * u)
    }

    /// How far it is from the straight line between its ends at most, m: an upper bound.
    ///
    /// Off the line are u(1 − u)² v and u²(1 − u) w, v and w being what the rates differ from the way by; neither share
    /// is more than 4/27.
    pub fn bulge(&self) -> f64 {
        let [_, _, c, d] = &self.powers;
        // v − way = −(c + d), w − way = c + 2d.
        4.0 / 27.0 * ((c + d).norm() + (c + d * 2.0).norm())
    }

    /// Its point nearest to `p`, of those about the foot of `p` on the straight line between its ends.
    ///
    /// Newton's steps on (c(u) − p)·c′(u) = 0, Gauss-Newton's where the curve bends away; of all that were looked at
    /// the nearest, so that it is never farther than the truth says by more than a step that is still due.
    pub fn nearest(&self, p: &Point3<f64>) -> Point3<f64> {
        let [_, b, c, d] = &self.powers;
        let mut u = nearest_parameter(p, &self.at(0.0), &self.at(1.0));
        let mut nearest = self.at(u);
        for _ in 0..STEPS {
            let off = self.at(u) - p;
            let slope = b + (c * 2.0 + d * (3.0 * u)) * u;
            let (square, bend) = (slope.norm_squared(), off.dot(&(c * 2.0 + d * (6.0 * u))));
            let curvature = if square + bend > 0.0 { square + bend } else { square };
            if curvature <= 0.0 {
                break;
            }
            let next = (u - off.dot(&slope) / curvature).clamp(0.0, 1.0);
            let there = self.at(next);
            if (there - p).norm_squared() < (nearest - p).norm_squared() {
                nearest = there;
            }
            if (next - u).abs() <= SETTLED {
                break;
            }
            u = next;
        }
        nearest
    }
}

/// The point nearest to `p` of the way from `a` to `b`: of `way`, which joins them, or of the straight line.
pub fn nearest_along(way: Option<&Cubic>, p: &Point3<f64>, a: &Point3<f64>, b: &Point3<f64>) -> Point3<f64> {
    way.map_or_else(|| nearest_point(p, a, b), |way| way.nearest(p))
}

#[cfg(feature = "unit-tests")]
mod tests {
    use super::*;

    /// A twentieth of a turn about the origin, 0.5 m out.
    fn arc() -> (Cubic, impl Fn(f64) -> Point3<f64>) {
        let angle = std::f64::consts::TAU / 20.0;
        let place = move |u: f64| Point3::new(0.5 * libm::cos(angle * u), 0.5 * libm::sin(angle * u), 0.1);
        let rate = move |u: f64| Vector3::new(-libm::sin(angle * u), libm::cos(angle * u), 0.0) * (0.5 * angle);
        (Cubic::between(&place(0.0), &place(1.0), [rate(0.0), rate(1.0)]), place)
    }

    #[test]
    fn it_is_the_arc_where_the_chord_is_millimetres_off() {
        let (cubic, place) = arc();
        let off = |u: f64| (cubic.at(u) - place(u)).norm();
        assert!((0..=100).all(|i| off(f64::from(i) / 100.0) < 2e-5));
        let sagitta = 0.5 * (1.0 - libm::cos(std::f64::consts::TAU / 40.0));
        assert!(sagitta > 6e-3 && (sagitta..1.5 * sagitta).contains(&cubic.bulge()), "{}", cubic.bulge());
    }

    #[test]
    fn nearest_points_are_as_near_as_any_of_many() {
        let (cubic, place) = arc();
        for (u, out, up) in
            [(0.5, 0.01, 0.0), (0.1, -0.02, 0.003), (0.93, 0.2, -0.1), (0.0, 1e-6, 0.0), (1.2, 0.0, 0.0)]
        {
            let on = place(u);
            let p = on + Vector3::new(on.x, on.y, 0.0) * (out / 0.5) + Vector3::z() * up;
            let many = (0..=100_000).map(|i| (cubic.at(f64::from(i) / 1e5) - p).norm()).fold(f64::INFINITY, f64::min);
            let found = (cubic.nearest(&p) - p).norm();
            assert!((found - many).abs() < 1e-8, "{u} {out}: {found} {many}");
        }
        let still = Cubic::between(&Point3::origin(), &Point3::origin(), [Vector3::zeros(); 2]);
        assert_eq!(still.nearest(&Point3::new(1.0, 0.0, 0.0)), Point3::origin());
    }
}
