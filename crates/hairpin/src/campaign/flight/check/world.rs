//! Bounds of `[world]`.

use crate::campaign::bounds::{FARTHEST_M, LARGEST_M};
use crate::campaign::check::Findings;
use crate::campaign::scenario::{ObstacleSection, WorldSection};

/// Every leg is tested against every obstacle.
const MOST_OBSTACLES: usize = 10_000;
/// Points of one hull or mesh: a few hundred MB of trees at most.
///
/// Also the bound of a mesh's triangles.
const MOST_POINTS: usize = 1_000_000;

/// A world that passes may still be none: shapes are built afterwards.
///
/// Lengths above 0 and at most 10 km, winds and gusts within ± 100 m/s a component. With more obstacles than are
/// allowed none of them is looked at.
pub(super) fn check(world: &WorldSection, found: &mut Findings) {
    if let Some(base) = &world.base {
        found.require(false, "world.base", format!("\"{base}\""), "merged into the world first");
    }
    match world.size_m {
        Some(size) => vector("world.size_m", size, found, |s| s > 0.0 && s <= LARGEST_M, "> 0 and ≤ 10000 m"),
        None => found.require(false, "world.size_m", "missing", "given: the edge lengths of the space, m"),
    }
    if let (Some(margin), Some(size)) = (world.keep_in_margin_m, world.size_m) {
        let most = 0.5 * size.iter().copied().fold(f64::INFINITY, f64::min);
        let bound = format!("≥ 0 and < {most} m, half the smallest side");
        let fine = margin >= 0.0 && (margin < most || most <= 0.0);
        found.require(fine, "world.keep_in_margin_m", margin, &bound);
    }
    if let Some(origin) = &world.origin {
        found.origin(origin);
    }
    if let Some(wind) = world.wind_m_s {
        vector("world.wind_m_s", wind, found, |v| v.abs() <= 100.0, "between -100 and 100 m/s");
    }
    if let Some(gusts) = &world.gusts {
        found.from("world.gusts.std_m_s", gusts.std_m_s, 0.0, 100.0, " m/s");
        found.above("world.gusts.correlation_s", gusts.correlation_s, 0.0, 1000.0, " s");
    }
    if let Some(gust) = &world.discrete_gust {
        let key = "world.discrete_gust.velocity_m_s";
        vector(key, gust.velocity_m_s, found, |v| v.abs() <= 100.0, "between -100 and 100 m/s");
        found.from("world.discrete_gust.start_s", gust.start_s, 0.0, 1e6, " s");
        found.above("world.discrete_gust.duration_s", gust.duration_s, 0.0, 1000.0, " s");
    }
    if world.obstacles.len() > MOST_OBSTACLES {
        found.require(false, "world.obstacles", format!("{} obstacles", world.obstacles.len()), "at most 10 000");
        return;
    }
    for (index, obstacle) in world.obstacles.iter().enumerate() {
        check_obstacle(&format!("world.obstacles[{index}]"), obstacle, found);
    }
}

/// Exactly one shape. A mesh has at least 4 triangles of indices that exist; that it is closed is for whoever builds
/// it.
fn check_obstacle(key: &str, obstacle: &ObstacleSection, found: &mut Findings) {
    let shapes = [
        ("box", obstacle.cuboid.is_some()),
        ("sphere", obstacle.sphere.is_some()),
        ("capsule", obstacle.capsule.is_some()),
        ("hull", obstacle.hull.is_some()),
        ("mesh", obstacle.mesh.is_some()),
    ];
    let given: Vec<&str> = shapes.iter().filter(|(_, is_given)| *is_given).map(|(name, _)| *name).collect();
    let value = if given.is_empty() { "no shape".to_owned() } else { given.join(" and ") };
    found.require(given.len() == 1, key, value, "exactly one of box, sphere, capsule, hull, mesh");
    if let Some(cuboid) = &obstacle.cuboid {
        place(&format!("{key}.box.center_m"), cuboid.center_m, found);
        let bound = "> 0 and ≤ 10000 m";
        vector(&format!("{key}.box.size_m"), cuboid.size_m, found, |s| s > 0.0 && s <= LARGEST_M, bound);
    }
    if let Some(sphere) = &obstacle.sphere {
        place(&format!("{key}.sphere.center_m"), sphere.center_m, found);
        found.above(&format!("{key}.sphere.radius_m"), sphere.radius_m, 0.0, LARGEST_M, " m");
    }
    if let Some(capsule) = &obstacle.capsule {
        place(&format!("{key}.capsule.a_m"), capsule.a_m, found);
        place(&format!("{key}.capsule.b_m"), capsule.b_m, found);
        found.above(&format!("{key}.capsule.radius_m"), capsule.radius_m, 0.0, LARGEST_M, " m");
    }
    if let Some(hull) = &obstacle.hull {
        points(&format!("{key}.hull.points_m"), &hull.points_m, found);
    }
    if let Some(mesh) = &obstacle.mesh {
        let key = format!("{key}.mesh");
        if let Some(file) = &mesh.file {
            found.require(false, &format!("{key}.file"), format!("\"{file}\""), "resolved to its triangles first");
            return;
        }
        if let Some(scale) = mesh.scale {
            found.require(false, &format!("{key}.scale"), scale, "left out where vertices are given: they are in m");
        }
        points(&format!("{key}.vertices_m"), &mesh.vertices_m, found);
        let key = format!("{key}.triangles");
        let count = mesh.triangles.len();
        found.require(count >= 4, &key, format!("{count} triangles"), "at least 4: a closed surface has no fewer");
        found.require(count <= MOST_POINTS, &key, format!("{count} triangles"), "at most 1 000 000");
        let vertices = mesh.vertices_m.len();
        if let Some(at) = mesh.triangles.iter().position(|t| t.iter().any(|&i| i as usize >= vertices)) {
            let bound = format!("three indices below {vertices}, the number of vertices");
            found.require(false, &format!("{key}[{at}]"), format!("{:?}", mesh.triangles[at]), &bound);
        }
    }
}

/// 4 … 1 000 000, each within ±20 km.
fn points(key: &str, points: &[[f64; 3]], found: &mut Findings) {
    let fine = (4..=MOST_POINTS).contains(&points.len());
    found.require(fine, key, format!("{} points", points.len()), "4 … 1 000 000 points");
    if let Some(at) = points.iter().position(|p| p.iter().any(|x| !is_place(*x))) {
        place(&format!("{key}[{at}]"), points[at], found);
    }
}

/// False for NaN.
fn is_place(x: f64) -> bool {
    x.abs() <= FARTHEST_M
}

fn place(key: &str, p: [f64; 3], found: &mut Findings) {
    vector(key, p, found, is_place, "between -20000 and 20000 m");
}

/// Every component of `v` must be `fine`; the first that is not is named.
///
/// The key gets the index: `world.size_m[2]`.
pub(super) fn vector(key: &str, v: [f64; 3], found: &mut Findings, fine: impl Fn(f64) -> bool, bound: &str) {
    if let Some(at) = v.iter().position(|&x| !fine(x)) {
        found.require(false, &format!("{key}[{at}]"), v[at], bound);
    }
}
