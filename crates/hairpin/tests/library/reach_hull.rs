//! The convex hull of the end points against another library's, which is an oracle here only.

use hairpin::feasibility::reach::{Hull, HullSettings, NoPolytope, Polytope};
use hairpin::math::random::{Stream, named_seed, stream};
use hairpin::math::simd::Simd;
use hairpin::robot::quadrotor::{Quadrotor, QuadrotorDescription};
use nalgebra::{Rotation3, Vector3};
use parry3d_f64::math::Vector;
use parry3d_f64::transformation::try_convex_hull;
use rand::RngExt;

fn shipped(name: &str) -> Quadrotor {
    let path = format!("{}/../../data/robots/quadrotor/{name}.toml", env!("CARGO_MANIFEST_DIR"));
    let text = std::fs::read_to_string(&path).expect("shipped robots are in data/robots/quadrotor");
    toml::from_str::<QuadrotorDescription>(&text).expect(name).build().expect(name)
}

const SHIPPED: [&str; 7] = ["flightgoggles", "paper-flightgoggles", "anafi", "anafi-real", "crazyflie", "x500", "iris"];

fn direction(rng: &mut Stream) -> Vector3<f64> {
    loop {
        let v = Vector3::from_fn(|_, _| rng.random_range(-1.0..1.0f64));
        if (0.01..1.0).contains(&v.norm_squared()) {
            return v.normalize();
        }
    }
}

/// The oracle's triangles.
fn oracle(points: &[Vector3<f64>]) -> Vec<[Vector3<f64>; 3]> {
    let mut distinct = points.to_vec();
    distinct.sort_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)).then(a.z.total_cmp(&b.z)));
    distinct.dedup();
    let candidates: Vec<Vector> = distinct.iter().map(|p| Vector::new(p.x, p.y, p.z)).collect();
    let (vertices, triangles) = try_convex_hull(&candidates).expect("the oracle's hull");
    let at = |i: u32| Vector3::new(vertices[i as usize].x, vertices[i as usize].y, vertices[i as usize].z);
    triangles.iter().map(|t| t.map(at)).collect()
}

/// Volume, support and the way to the border in random directions are the oracle's; every point is contained.
fn agree(points: &[Vector3<f64>], what: &str) {
    let hull = Polytope::hull(Simd::default(), points).unwrap_or_else(|error| panic!("{what}: {error}"));
    assert!(points.iter().all(|point| hull.contains(point)), "{what}: a point is outside");
    let triangles = oracle(points);
    let centre = hull.vertices().iter().sum::<Vector3<f64>>() / hull.vertices().len() as f64;
    let pyramid = |[a, b, c]: &[Vector3<f64>; 3]| (a - centre).dot(&(b - centre).cross(&(c - centre))).abs() / 6.0;
    let volume: f64 = triangles.iter().map(pyramid).sum();
    assert!((hull.volume() / volume - 1.0).abs() < 1e-6, "{what}: {} m³, not {volume} m³", hull.volume());
    let extent = (hull.bounding_box().1 - hull.bounding_box().0).norm();
    let mut rng = stream(named_seed(1, what, 0));
    for _ in 0..1000 {
        let n = direction(&mut rng);
        let support = triangles.iter().flatten().map(|v| n.dot(v)).fold(f64::NEG_INFINITY, f64::max);
        assert!((hull.support(&n) - support).abs() < 1e-3_f64.min(1e-6 * extent), "{what}: support along {n:?}");
        // The half-spaces: the oracle's triangle in the way of the ray is where they end.
        let ends = hull.planes().map(|(m, b)| (m.dot(&n), b - m.dot(&centre))).filter(|(along, _)| *along > 0.0);
        let end = ends.map(|(along, b)| b / along).fold(f64::INFINITY, f64::min);
        let border = triangles.iter().filter_map(|t| hit(&centre, &n, t)).fold(0.0, f64::max);
        assert!((end - border).abs() < 1e-3_f64.min(1e-5 * extent), "{what}: {end} m, not {border} m along {n:?}");
    }
}

/// Where the ray from `from` along `n` meets a triangle, borders widened by a hair.
fn hit(from: &Vector3<f64>, n: &Vector3<f64>, [a, b, c]: &[Vector3<f64>; 3]) -> Option<f64> {
    let (u, v) = (b - a, c - a);
    let det = u.dot(&n.cross(&v));
    let s = (from - a).dot(&n.cross(&v)) / det;
    let t = n.dot(&(from - a).cross(&u)) / det;
    let along = v.dot(&(from - a).cross(&u)) / det;
    (s >= -1e-9 && t >= -1e-9 && s + t <= 1.0 + 1e-9).then_some(along)
}

#[test]
fn hulls_of_shipped_robots_are_the_oracle_s() {
    for name in SHIPPED {
        for resolution in [3, 4, 5, 7] {
            let settings = HullSettings { resolution, ..HullSettings::default() };
            let integrated = Hull::new(&shipped(name), &settings).expect(name);
            agree(integrated.samples(), &format!("{name}, {resolution}"));
            let published = Hull::published(&shipped(name), &settings).expect(name);
            agree(published.samples(), &format!("{name} published, {resolution}"));
        }
    }
}

#[test]
fn hulls_of_random_clouds_are_the_oracle_s() {
    for seed in 0..40 {
        let mut rng = stream(named_seed(seed, "clouds", 0));
        let count = rng.random_range(4..500);
        let scale = 10f64.powi(rng.random_range(-2..3));
        let size = Vector3::from_fn(|_, _| scale * rng.random_range(0.05..1.0f64));
        let cloud: Vec<_> = (0..count).map(|_| direction(&mut rng) * rng.random_range(0.0..1.0f64)).collect();
        let cloud: Vec<_> = cloud.iter().map(|p| p.component_mul(&size)).collect();
        agree(&cloud, &format!("cloud {seed}"));
        let sphere: Vec<_> = (0..count).map(|_| direction(&mut rng) * scale).collect();
        agree(&sphere, &format!("sphere {seed}"));
    }
}

#[test]
fn hulls_of_lattices_turned_and_shifted_are_cubes() {
    for seed in 0..40 {
        let mut rng = stream(named_seed(seed, "lattices", 0));
        let turn = Rotation3::new(direction(&mut rng) * rng.random_range(0.0..3.0));
        let shift = direction(&mut rng) * 10f64.powi(rng.random_range(-3..4));
        let mut points = Vec::new();
        for i in 0..216 {
            let point = Vector3::new((i % 6) as f64, (i / 6 % 6) as f64, (i / 36) as f64) * 0.4;
            // Rounding makes these all but coplanar; every third point is there twice.
            points.extend(vec![turn * point + shift; 1 + usize::from(i % 3 == 0)]);
        }
        let cube = Polytope::hull(Simd::default(), &points).unwrap_or_else(|error| panic!("seed {seed}: {error}"));
        assert_eq!(cube.facets(), 6, "seed {seed}");
        assert!((cube.volume() - 8.0).abs() < 1e-6 && points.iter().all(|p| cube.contains(p)), "seed {seed}");
        let corners = [(1.0, 1.0, 1.0), (-1.0, 1.0, 1.0), (1.0, -1.0, 1.0), (1.0, 1.0, -1.0)];
        for corner in corners.map(|(x, y, z)| Vector3::new(x, y, z)) {
            let middle = turn * Vector3::repeat(1.0) + shift;
            assert!(cube.contains(&(middle + turn * corner * (1.0 - 1e-9))), "seed {seed}");
            assert!(!cube.contains(&(middle + turn * corner * (1.0 + 1e-6))), "seed {seed}");
        }
    }
}

/// Noise around every tolerance of the construction: what is near to coplanar at one scale is not at another.
#[test]
fn hulls_hold_their_points_whatever_the_noise() {
    for seed in 0..12 {
        for digits in 4..17 {
            let mut rng = stream(named_seed(seed, "noise", digits));
            let noise = 10f64.powi(-(digits as i32));
            let points: Vec<_> = (0..343)
                .map(|i| Vector3::new((i % 7) as f64, (i / 7 % 7) as f64, (i / 49) as f64) / 3.0)
                .map(|p| p + direction(&mut rng) * noise)
                .collect();
            let hull = Polytope::hull(Simd::default(), &points)
                .unwrap_or_else(|error| panic!("seed {seed}, {noise:e}: {error}"));
            assert!(points.iter().all(|p| hull.contains(p)), "seed {seed}, {noise:e}");
            assert!((hull.volume() - 8.0).abs() < 100.0 * noise + 1e-6, "seed {seed}, {noise:e}: {}", hull.volume());
            for _ in 0..100 {
                let n = direction(&mut rng);
                let support = points.iter().map(|p| n.dot(p)).fold(f64::NEG_INFINITY, f64::max);
                assert!((hull.support(&n) - support).abs() < 1e-6, "seed {seed}, {noise:e}");
                let out = Vector3::repeat(1.0) + n * (1.0 / n.amax() + 10.0 * noise + 1e-5);
                assert!(!hull.contains(&out), "seed {seed}, {noise:e}: holds what lies outside");
            }
        }
    }
}

#[test]
fn what_has_no_inside_is_refused() {
    let flat =
        |points: &[Vector3<f64>]| matches!(Polytope::hull(Simd::default(), points), Err(NoPolytope::Flat { .. }));
    let mut rng = stream(named_seed(1, "flat", 0));
    let cloud: Vec<_> = (0..100).map(|_| direction(&mut rng) * 3.0).collect();
    let (n, along) = (direction(&mut rng), direction(&mut rng));
    let plane: Vec<_> = cloud.iter().map(|p| p - n * n.dot(p)).collect();
    let thick: Vec<_> = cloud.iter().map(|p| p - n * (n.dot(p) * (1.0 - 1e-7))).collect();
    let line: Vec<_> = cloud.iter().map(|p| along * along.dot(p)).collect();
    assert!(flat(&plane) && flat(&thick) && flat(&line) && flat(&[Vector3::repeat(2.0); 30]));
    assert!(matches!(Polytope::hull(Simd::default(), &cloud[..3]), Err(NoPolytope::Points { points: 3 })));
    for bad in [f64::NAN, f64::INFINITY] {
        let mut broken = cloud.clone();
        broken[7].y = bad;
        assert!(matches!(Polytope::hull(Simd::default(), &broken), Err(NoPolytope::Points { points: 100 })));
    }
}

/// The hull goes along with a linear map: pressing the cloud flat divides its volume and keeps all corners. (The oracle
/// loses most of such a cloud.)
#[test]
fn thin_clouds_keep_their_corners() {
    for seed in 0..20 {
        let mut rng = stream(named_seed(seed, "thin", 0));
        let cloud: Vec<_> = (0..200).map(|_| direction(&mut rng) * 3.0).collect();
        let n = direction(&mut rng);
        let round = Polytope::hull(Simd::default(), &cloud).expect("a ball");
        for thickness in [1e-1, 1e-2, 1e-3, 1e-4] {
            let press = |p: &Vector3<f64>| p - n * (n.dot(p) * (1.0 - thickness));
            let thin: Vec<_> = cloud.iter().map(press).collect();
            let hull = Polytope::hull(Simd::default(), &thin)
                .unwrap_or_else(|error| panic!("seed {seed}, {thickness}: {error}"));
            assert!(thin.iter().all(|p| hull.contains(p)), "seed {seed}, {thickness}");
            let volume = round.volume() * thickness;
            assert!((hull.volume() / volume - 1.0).abs() < 1e-6, "seed {seed}, {thickness}: {}", hull.volume());
            assert_eq!(hull.vertices().len(), 200, "seed {seed}, {thickness}");
        }
    }
}

/// One Euler step of a second turns by many radians, so that angles alias: the volume jumps with the resolution.
#[test]
fn published_volumes_lie_between_20_000_and_60_000_cubic_metres() {
    let robot = shipped("paper-flightgoggles");
    let volume = |resolution| {
        Hull::published(&robot, &HullSettings { resolution, ..HullSettings::default() })
            .expect("a hull")
            .polytope()
            .volume()
    };
    let volumes: Vec<f64> = (3..=8).map(volume).collect();
    assert!(volumes.iter().all(|v| (20_000.0..60_000.0).contains(v)), "{volumes:?}");
    let expected = [20_156.0, 28_127.0, 43_450.0, 47_269.0, 49_794.0, 45_372.0];
    assert!(volumes.iter().zip(expected).all(|(v, e)| (v - e).abs() < 1.0), "{volumes:?}");
}
