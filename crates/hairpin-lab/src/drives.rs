//! What all measurements of boundary-value drives share: bounds and ground, and when a drive counts as one that meets
//! its goal.

use hairpin::feasibility::steering::shooting::Curvatures;
use hairpin::verification::DriveReplay;
use hairpin::world::terrain::generate::Recipe;

/// Those of `generic` on flat ground.
pub(crate) const BOUNDS: Curvatures = Curvatures { most: 1.0, most_rate: 1.0 };

/// Cratered ground of 40 m.
pub(crate) const CRATERS: Recipe = Recipe {
    size_m: 40.0,
    cell_m: 0.1,
    relief_m: 1.0,
    hurst: 0.7,
    least_crater_m: 2.0,
    crater_area_m2: 40.0,
    rock_cover: 0.0,
    seed: 1,
};

/// Errors within which a goal counts as met: m, rad, 1/m. A hundredth of all drives that are asked for here is longer.
pub(crate) const MET: f64 = 0.01;
/// Share by which rounding may exceed a bound.
const ROUNDING: f64 = 1e-9;

/// Whether a replay that ends with these errors (m, m, rad; 1/m) meets its goal.
pub(crate) fn met([x, y, yaw]: [f64; 3], curvature: f64) -> bool {
    libm::hypot(x, y) <= MET && yaw.abs() <= MET && curvature.abs() <= MET
}

/// Whether a replay keeps `bounds`.
pub(crate) fn keeps(replay: &DriveReplay, bounds: &Curvatures) -> bool {
    replay.max_curvature <= bounds.most * (1.0 + ROUNDING)
        && replay.max_curvature_rate <= bounds.most_rate * (1.0 + ROUNDING)
}
