//! How the end of a motion moves with the commands, from one look along it.
//!
//! By variation of the motion x′ = f(x, y, ψ; κ), whose roll and pitch are the suspension's, φ(x, y, ψ) and θ(x, y, ψ):
//!
//! ```text
//! δ′ = (∂f/∂(x, y, ψ) + ∂f/∂φ ∇φ + ∂f/∂θ ∇θ) δ + ∂f/∂κ δκ
//! ```
//!
//! integrated by the midpoint rule in the prediction's own steps. The rates are the source's, for exact kinematics as
//! well: what those add to derivatives would be second derivatives of the pose.
//!
//! More exact than the sweep where the ground matters, and dearer: a product of matrices in every step. For costs,
//! whose steps must leave the end.

use nalgebra::{Matrix3, SMatrix, Vector3};

use super::pieces::{PIECES, UNKNOWNS};
use super::sweep::{Tangent, bent_at, ends_of};
use crate::feasibility::steering::shooting::rough::course::Course;
use crate::feasibility::steering::shooting::rough::outcome::Driven;
use crate::robot::rover::{Rates, rate_slopes, rates};
use crate::trajectory::drive::Segment;

/// How the place reached so far, (x, y, ψ), moves with a change.
///
/// Rows in m, m, rad, by 1/m of each bend and by the stretch.
type Moved = SMatrix<f64, 3, UNKNOWNS>;

/// The variation of a motion along a prediction.
pub(super) struct Variation<'a, 'c, T> {
    course: &'a Course<'c, T>,
    /// Where the pieces end, m.
    ends: [f64; PIECES],
    /// Metres by which the steering is behind.
    behind: f64,
    done: f64,
    moved: Moved,
}

impl<'a, 'c, T> Variation<'a, 'c, T> {
    /// Of `segments`, driven on `course`.
    pub(super) fn new(course: &'a Course<'c, T>, segments: &[Segment]) -> Self {
        let behind = course.rover.response.steering_time_constant * course.speed.top();
        Self { course, ends: ends_of(segments), behind, done: 0.0, moved: Moved::zeros() }
    }

    /// One step of δ′ = A δ + b by the midpoint rule, δ ← δ + h(A(δ + ½h(Aδ + b)) + b), A and b at the step's middle. A
    /// holds the slopes of the rates by roll and pitch times the pose's gradient, and by yaw the turn of the planar
    /// velocity; b the effect of each knot's curvature, and in the last column that of length.
    pub(super) fn add(&mut self, driven: &Driven) {
        // Steps are seen at their middles.
        let h = 2.0 * (driven.s - self.done);
        self.done += h;
        let course = self.course;
        let (slip, sign, curvature) = (&course.rover.slip, driven.step.signum(), driven.at.curvature);
        let direction = libm::sincos(course.direction.at(driven.s, self.ends[PIECES - 1]));
        let (sin, cos) = libm::sincos(driven.at.yaw);
        let planar = |r: &Rates| Vector3::new(cos * r.ahead - sin * r.left, sin * r.ahead + cos * r.left, r.yaw);
        let slopes = rate_slopes(&driven.settled, direction, sign, curvature, slip);
        let here = planar(&rates(&driven.settled, direction, sign, curvature, slip));
        let row = |by: [f64; 3]| nalgebra::RowVector3::from(by);
        let mut by_place: Matrix3<f64> =
            planar(&slopes.roll) * row(driven.gradient.roll()) + planar(&slopes.pitch) * row(driven.gradient.pitch());
        by_place[(0, 2)] -= here.y;
        by_place[(1, 2)] += here.x;
        let mut forced: Moved = planar(&slopes.curvature) * bent_at(&self.ends, driven.s - self.behind).transpose();
        // A stretch drives all of it longer.
        forced.set_column(PIECES, &here);
        let halfway = self.moved + 0.5 * h * (by_place * self.moved + forced);
        self.moved += h * (by_place * halfway + forced);
    }

    /// κ's row is the last bend's share, `behind` metres before the end.
    pub(super) fn tangent(&self) -> Tangent {
        let mut tangent = Tangent::zeros();
        tangent.fixed_rows_mut::<3>(0).copy_from(&self.moved);
        // Stretching leaves the last curvature.
        tangent.set_row(3, &bent_at(&self.ends, self.ends[PIECES - 1] - self.behind).transpose());
        tangent
    }
}

#[cfg(feature = "unit-tests")]
mod tests {
    use super::super::pieces::{Change, changed, divided};
    use super::*;
    use crate::feasibility::steering::shooting::rough::course::Steps;
    use crate::feasibility::steering::shooting::rough::predict::predict;
    use crate::robot::rover::{Rover, RoverDescription, Slip};
    use crate::trajectory::Direction;
    use crate::trajectory::drive::{Gear, Planar, SegmentList};
    use crate::world::terrain::generate::{Recipe, generate};
    use crate::world::terrain::{Flat, Function, Patch, Terrain};

    fn shipped(name: &str) -> Rover {
        let path = format!("{}/../../data/robots/rover/{name}.toml", env!("CARGO_MANIFEST_DIR"));
        let text = std::fs::read_to_string(path).expect("a shipped rover");
        toml::from_str::<RoverDescription>(&text).expect("its keys").build().expect("its numbers")
    }

    /// Largest differences of tangents from central differences of predictions: of curvatures and of the stretch.
    fn worst<T: Terrain>(rover: &Rover, terrain: &T, direction: Direction, from: &Planar, gear: Gear) -> [f64; 2] {
        let steps = Steps { length: 0.004, angle: 0.002, least: 50 };
        let course = Course { rover, terrain, speed: 0.3.into(), direction, steps };
        let mut drive = SegmentList::default();
        drive.add(Segment::clothoid(2.0, 0.1, 0.8, gear));
        drive.add(Segment::clothoid(1.0, 0.8, -0.1, gear));
        let drive = divided(&drive).expect("pieces");
        let mut variation = Variation::new(&course, &drive);
        predict(&course, from, &drive, |driven| variation.add(driven)).expect("a way");
        let tangent = variation.tangent();
        let mut worst = [0.0_f64; 2];
        for unknown in 0..UNKNOWNS {
            let moved = |size: f64| {
                let mut change = Change::zeros();
                change[unknown] = size;
                let mut other = drive;
                changed(&mut other, &change);
                let end = predict(&course, from, &other, |_| {}).expect("a way").end;
                [end.x, end.y, end.yaw, end.curvature]
            };
            let size = 1e-3;
            for (row, (more, less)) in moved(size).into_iter().zip(moved(-size)).enumerate() {
                let off = ((more - less) / (2.0 * size) - tangent[(row, unknown)]).abs();
                let worst = &mut worst[usize::from(unknown == PIECES)];
                *worst = worst.max(off);
            }
        }
        worst
    }

    #[test]
    fn in_the_plane_tangents_are_the_differences_of_predictions() {
        let from = Planar { x: 3.0, y: -2.0, yaw: 0.7, curvature: 0.1 };
        for gear in [Gear::Forward, Gear::Reverse] {
            let [bends, stretch] = worst(&shipped("generic"), &Flat, 0.0.into(), &from, gear);
            assert!(bends < 2e-4 && stretch < 2e-4, "{gear:?}: {bends}, {stretch}");
        }
    }

    #[test]
    fn on_rough_ground_they_are_with_the_suspension_slip_and_a_direction_that_turns() {
        let hills = Function(|x: f64, y: f64| {
            let ((sx, cx), (sy, cy)) = ((1.3 * x).sin_cos(), (0.9 * y + 0.4).sin_cos());
            Patch {
                height: 0.3 * sx * cy,
                slope: [0.39 * cx * cy, -0.27 * sx * sy],
                bend: [-0.507 * sx * cy, -0.351 * cx * sy, -0.243 * sx * cy],
            }
        });
        let recipe = Recipe { size_m: 20.0, relief_m: 0.5, rock_cover: 0.0, seed: 3, ..Recipe::default() };
        let yard = generate(&recipe).expect("a yard");
        for name in ["rocky8", "rocky7"] {
            let slip = Slip { at_20_deg: 0.3, side_at_20_deg: 0.15 };
            let rover = Rover { slip, ..shipped(name) };
            for direction in [Direction { start: 0.0, end: 0.0 }, Direction { start: 0.3, end: -0.2 }] {
                for gear in [Gear::Forward, Gear::Reverse] {
                    let from = Planar { x: 9.0, y: 10.0, yaw: 0.7, curvature: 0.1 };
                    let smooth = worst(&rover, &hills, direction, &from, gear);
                    let rough = worst(&rover, &yard, direction, &from, gear);
                    println!("{name} {gear:?} {direction:?}: smooth {smooth:.5?}, rough {rough:.5?}");
                    // A map's gradient of the pose jumps at the borders of its cells.
                    assert!(smooth.iter().all(|off| *off < 1e-4), "{name} {gear:?}: {smooth:?}");
                    assert!(rough.iter().all(|off| *off < 5e-3), "{name} {gear:?}: {rough:?}");
                }
            }
        }
    }
}
