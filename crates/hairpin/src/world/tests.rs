//! Distances against closed forms and brute force, validation, sampling.

use nalgebra::{Point3, Vector3};
use rand::RngExt;

use super::*;
use crate::math::random::{Stream, stream};

fn point(random: &mut Stream, low: f64, high: f64) -> Point3<f64> {
    Point3::from([(); 3].map(|_| random.random_range(low..high)))
}

/// The twelve triangles of a box, outward.
fn box_mesh(center: Point3<f64>, half: Vector3<f64>) -> (Vec<[f64; 3]>, Vec<[u32; 3]>) {
    let corner = |i: usize| {
        let sign = |bit: usize| if i >> bit & 1 == 1 { 1.0 } else { -1.0 };
        (center + half.component_mul(&Vector3::new(sign(0), sign(1), sign(2)))).coords.into()
    };
    let quads = [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
    let triangles = quads.iter().flat_map(|q| [[q[0], q[1], q[2]], [q[0], q[2], q[3]]]).collect();
    ((0..8).map(corner).collect(), triangles)
}

/// An octahedron, each face split `depth` times, with radii drawn between 1 and 2: star-shaped, not convex.
fn star(random: &mut Stream, center: Point3<f64>, depth: usize) -> (Vec<[f64; 3]>, Vec<[u32; 3]>) {
    let axes = [Vector3::x(), -Vector3::x(), Vector3::y(), -Vector3::y(), Vector3::z(), -Vector3::z()];
    let mut directions: Vec<Vector3<f64>> = axes.to_vec();
    let mut triangles: Vec<[u32; 3]> =
        vec![[0, 2, 4], [2, 1, 4], [1, 3, 4], [3, 0, 4], [2, 0, 5], [1, 2, 5], [3, 1, 5], [0, 3, 5]];
    for _ in 0..depth {
        let mut split = Vec::new();
        for [a, b, c] in triangles {
            let mut middle = |i: u32, j: u32| {
                let m = (directions[i as usize] + directions[j as usize]).normalize();
                let known = directions.iter().position(|d| (d - m).norm() < 1e-9);
                known.unwrap_or_else(|| {
                    directions.push(m);
                    directions.len() - 1
                }) as u32
            };
            let (ab, bc, ca) = (middle(a, b), middle(b, c), middle(c, a));
            split.extend([[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]);
        }
        triangles = split;
    }
    let vertices = directions.iter().map(|d| (center + d * random.random_range(1.0..2.0)).coords.into()).collect();
    (vertices, triangles)
}

/// Distance to a triangle by dense sampling of it: never below the truth, above it by less than `longest edge / n`.
fn sampled_distance(p: &Point3<f64>, vertices: &[[f64; 3]], triangles: &[[u32; 3]], n: usize) -> f64 {
    let mut least = f64::INFINITY;
    for triangle in triangles {
        let [a, b, c] = triangle.map(|i| Point3::from(vertices[i as usize]));
        for i in 0..=n {
            for j in 0..=n - i {
                let q = a + (b - a) * (i as f64 / n as f64) + (c - a) * (j as f64 / n as f64);
                least = least.min((p - q).norm());
            }
        }
    }
    least
}

/// Inside by parity of the crossings of a ray in a general direction.
fn inside_by_parity(p: &Point3<f64>, vertices: &[[f64; 3]], triangles: &[[u32; 3]]) -> bool {
    let direction = Vector3::new(0.312_571, 0.518_237, 0.796_113);
    let crossings = triangles.iter().filter(|triangle| {
        let [a, b, c] = triangle.map(|i| Point3::from(vertices[i as usize]));
        let (e1, e2) = (b - a, c - a);
        let h = direction.cross(&e2);
        let det = e1.dot(&h);
        let u = (p - a).dot(&h) / det;
        let q = (p - a).cross(&e1);
        let v = direction.dot(&q) / det;
        u >= 0.0 && v >= 0.0 && u + v <= 1.0 && e2.dot(&q) / det > 0.0
    });
    crossings.count() % 2 == 1
}

fn shapes(random: &mut Stream) -> Vec<Shape> {
    let center = point(random, -2.0, 2.0);
    let half = point(random, 0.2, 2.0).coords;
    let (vertices, triangles) = star(random, center, 2);
    let cloud: Vec<[f64; 3]> = (0..30).map(|_| point(random, -3.0, 3.0).coords.into()).collect();
    vec![
        Shape::sphere(center.coords.into(), random.random_range(0.1..2.0)).unwrap(),
        Shape::cuboid(center.coords.into(), (half * 2.0).into()).unwrap(),
        Shape::capsule(center.coords.into(), point(random, -2.0, 2.0).coords.into(), 0.5).unwrap(),
        Shape::hull(&cloud).unwrap(),
        Shape::mesh(&vertices, &triangles).unwrap(),
    ]
}

#[test]
fn segment_distance_is_the_least_of_the_points_distances() {
    for seed in 0..60 {
        let mut random = stream(seed);
        for shape in shapes(&mut random) {
            let (a, mut b) = (point(&mut random, -5.0, 5.0), point(&mut random, -5.0, 5.0));
            match seed % 6 {
                0 => b = a,
                1 => b = Point3::new(a.x, b.y, a.z), // parallel to the box's faces
                _ => {}
            }
            let found = shape.segment_distance(&a, &b);
            let n = 2000;
            let at = |i: usize| shape.signed_distance(&(a + (b - a) * (i as f64 / n as f64)));
            let sampled = (0..=n).map(at).fold(f64::INFINITY, f64::min);
            let spacing = 0.5 * (b - a).norm() / n as f64 + 1e-9;
            let solid = matches!(shape, Shape::Hull(_) | Shape::Mesh(_));
            if solid && sampled <= 0.0 {
                assert!(found <= 0.0 && found >= sampled - spacing, "seed {seed}, {shape:?}: {found} {sampled}");
            } else {
                assert!(found <= sampled + 1e-9, "seed {seed}, {shape:?}: {found} > {sampled}");
                assert!(found >= sampled - spacing, "seed {seed}, {shape:?}: {found} << {sampled}");
            }
        }
    }
}

#[test]
fn a_box_is_the_same_as_box_hull_and_mesh() {
    for seed in 0..40 {
        let mut random = stream(seed);
        let (center, half) = (point(&mut random, -2.0, 2.0), point(&mut random, 0.3, 2.0).coords);
        let (vertices, triangles) = box_mesh(center, half);
        let inside_out: Vec<[u32; 3]> = triangles.iter().map(|&[a, b, c]| [a, c, b]).collect();
        let same = [
            Shape::hull(&vertices).unwrap(),
            Shape::mesh(&vertices, &triangles).unwrap(),
            Shape::mesh(&vertices, &inside_out).unwrap(),
        ];
        let exact = Shape::cuboid(center.coords.into(), (half * 2.0).into()).unwrap();
        for _ in 0..50 {
            let p = point(&mut random, -4.0, 4.0);
            for shape in &same {
                let (found, expected) = (shape.signed_distance(&p), exact.signed_distance(&p));
                assert!((found - expected).abs() < 1e-9, "seed {seed}, {shape:?} at {p}: {found} {expected}");
            }
        }
    }
}

#[test]
fn meshes_have_the_right_distance_and_the_right_side() {
    let mut inside = 0;
    for seed in 0..12 {
        let mut random = stream(seed);
        let (vertices, triangles) = star(&mut random, Point3::origin(), 1);
        let shape = Shape::mesh(&vertices, &triangles).unwrap();
        for _ in 0..60 {
            let p = point(&mut random, -2.0, 2.0);
            let found = shape.signed_distance(&p);
            let sampled = sampled_distance(&p, &vertices, &triangles, 40);
            assert!(found.abs() <= sampled + 1e-9 && found.abs() > sampled - 0.1, "seed {seed}: {found} {sampled}");
            assert_eq!(found < 0.0, inside_by_parity(&p, &vertices, &triangles), "seed {seed}, {p}");
            inside += usize::from(found < 0.0);
        }
    }
    assert!((100..620).contains(&inside), "{inside} of 720 inside");
}

#[test]
fn closed_forms_against_dense_sampling() {
    for seed in 0..30 {
        let mut random = stream(seed);
        let (center, half) = (point(&mut random, -1.0, 1.0), point(&mut random, 0.3, 1.0).coords);
        let (vertices, triangles) = box_mesh(center, half);
        let shape = Shape::cuboid(center.coords.into(), (half * 2.0).into()).unwrap();
        let p = point(&mut random, -3.0, 3.0);
        let sampled = sampled_distance(&p, &vertices, &triangles, 60);
        let found = shape.signed_distance(&p);
        assert!(found.abs() <= sampled + 1e-9 && found.abs() > sampled - 0.06, "seed {seed}: {found} {sampled}");
        assert_eq!(found < 0.0, (p - center).abs().iter().zip(half.iter()).all(|(c, h)| c < h));
        // A capsule is the union of the balls along its axis.
        let (a, b, radius) = (point(&mut random, -2.0, 2.0), point(&mut random, -2.0, 2.0), 0.4);
        let capsule = Shape::capsule(a.coords.into(), b.coords.into(), radius).unwrap();
        let balls = (0..=2000).map(|i| (p - (a + (b - a) * (i as f64 / 2000.0))).norm() - radius);
        let balls = balls.fold(f64::INFINITY, f64::min);
        assert!((capsule.signed_distance(&p) - balls).abs() < 2e-3, "seed {seed}");
    }
}

#[test]
fn many_obstacles_are_asked_as_if_one_by_one() {
    let mut random = stream(5);
    let obstacles: Vec<Obstacle> = (0..12)
        .flat_map(|_| shapes(&mut random))
        .enumerate()
        .map(|(i, shape)| Obstacle { name: i.to_string(), shape })
        .collect();
    let world = World::new(Vector3::repeat(30.0), 0.0, obstacles).unwrap();
    for _ in 0..300 {
        let (a, b) = (point(&mut random, 0.0, 5.0), point(&mut random, 0.0, 5.0));
        let one_by_one =
            |f: &dyn Fn(&Shape) -> f64| world.obstacles().iter().map(|o| f(&o.shape)).fold(f64::INFINITY, f64::min);
        let nearest = one_by_one(&|shape| shape.signed_distance(&a));
        assert_eq!(world.obstacle_distance(&a), nearest);
        assert_eq!(world.segment_distance(&a, &b), one_by_one(&|shape| shape.segment_distance(&a, &b)));
        for clearance in [0.0, 0.3] {
            assert_eq!(world.is_free(&a, clearance), nearest >= clearance);
        }
    }
}

#[test]
fn refuses_what_is_no_solid_by_key() {
    let field = |result: Result<Shape, WorldError>| result.unwrap_err().within("obstacles[2]").field;
    assert_eq!(field(Shape::sphere([0.0; 3], 0.0)), "obstacles[2].sphere.radius_m");
    assert_eq!(field(Shape::sphere([0.0, f64::NAN, 0.0], 1.0)), "obstacles[2].sphere.center_m");
    assert_eq!(field(Shape::cuboid([0.0; 3], [1.0, -1.0, 1.0])), "obstacles[2].box.size_m");
    assert_eq!(field(Shape::cuboid([0.0; 3], [1.0, f64::NAN, 1.0])), "obstacles[2].box.size_m");
    assert_eq!(field(Shape::capsule([0.0; 3], [f64::INFINITY; 3], 1.0)), "obstacles[2].capsule.b_m");
    let square = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 1.0, 0.0], [0.5, 0.5, 0.0]];
    assert_eq!(field(Shape::hull(&square)), "obstacles[2].hull.points_m");
    assert_eq!(field(Shape::hull(&square[..2])), "obstacles[2].hull.points_m");
    assert_eq!(field(Shape::hull(&[[1.0; 3]; 9])), "obstacles[2].hull.points_m");
    assert_eq!(field(Shape::hull(&[[0.0; 3], [f64::NAN; 3]])), "obstacles[2].hull.points_m[1]");
    let (vertices, triangles) = box_mesh(Point3::origin(), Vector3::repeat(1.0));
    let open = Shape::mesh(&vertices, &triangles[1..]).unwrap_err();
    assert!(open.value.starts_with("open at edge") && open.bound.starts_with("a closed surface"), "{open}");
    let mut turned = triangles.clone();
    turned[3].swap(0, 1);
    assert!(Shape::mesh(&vertices, &turned).unwrap_err().value.contains("wound against"));
    assert!(Shape::mesh(&vertices, &[[0, 1, 8]]).unwrap_err().bound.contains("below 8"));
    assert!(Shape::mesh(&vertices, &[]).is_err());
    assert!(Shape::mesh(&[[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]], &[[0, 1, 2], [0, 2, 1]]).is_err());
    let bad = Shape::Sphere { center: Point3::origin(), radius: f64::NAN };
    let error = World::new(Vector3::repeat(9.0), 0.0, vec![Obstacle { name: String::new(), shape: bad }]).unwrap_err();
    assert_eq!(error.field, "obstacles[0].sphere.radius_m");
}

#[test]
fn a_mesh_without_shared_vertices_is_closed_too() {
    // As STL has it: three vertices of its own for every triangle.
    let (vertices, triangles) = box_mesh(Point3::origin(), Vector3::repeat(1.0));
    let soup: Vec<[f64; 3]> = triangles.iter().flatten().map(|&i| vertices[i as usize]).collect();
    let own: Vec<[u32; 3]> = (0..triangles.len() as u32).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    let shape = Shape::mesh(&soup, &own).unwrap();
    assert!((shape.signed_distance(&Point3::origin()) + 1.0).abs() < 1e-12);
}

#[test]
fn samples_are_free_and_repeat() {
    let obstacle = Obstacle { name: "mast".into(), shape: Shape::cuboid([12.0, 8.0, 5.0], [2.0, 2.0, 10.0]).unwrap() };
    let world = World::new(Vector3::repeat(30.0), 2.0, vec![obstacle]).unwrap();
    for sampling in [Sampling::Uniform, Sampling::Clustered, Sampling::Sobol] {
        let points = sample_free(&world, 500, 3.0, sampling, 7).unwrap();
        assert_eq!(points.len(), 500);
        assert!(points.iter().all(|p| world.is_free(p, 3.0)));
        assert_eq!(points, sample_free(&world, 500, 3.0, sampling, 7).unwrap());
        assert_ne!(points, sample_free(&world, 500, 3.0, sampling, 8).unwrap());
    }
}

#[test]
fn sobol_is_more_even_than_uniform() {
    let world = World::new(Vector3::repeat(8.0), 0.0, vec![]).unwrap();
    let spread = |sampling| {
        let mut cells = [0i32; 64];
        for p in sample_free(&world, 1024, 0.0, sampling, 3).unwrap() {
            let cell = p.coords.map(|c| (c / 2.0) as usize);
            cells[cell.x + 4 * cell.y + 16 * cell.z] += 1;
        }
        cells.iter().map(|count| (count - 16).pow(2)).sum::<i32>()
    };
    assert!(spread(Sampling::Sobol) * 4 < spread(Sampling::Uniform));
}

#[test]
fn clusters_have_short_legs_that_uniform_points_hardly_have() {
    let world = World::new(Vector3::repeat(30.0), 0.0, vec![]).unwrap();
    let spacing = 30.0 / 250f64.cbrt();
    let close = |sampling| {
        let points = sample_free(&world, 250, 0.0, sampling, 5).unwrap();
        let nearest = |at: usize| {
            let others = points.iter().enumerate().filter(|(other, _)| *other != at);
            others.map(|(_, other)| (other - points[at]).norm()).fold(f64::INFINITY, f64::min)
        };
        (0..points.len()).filter(|at| nearest(*at) < 0.4 * spacing).count()
    };
    // Uniform: 1 − exp(−4π/3 · 0.4³) = 24 %. Clusters: of the half that lies about others ln(4)/ln(10) = 60 %, and
    // those that they lie about.
    let (uniform, clustered) = (close(Sampling::Uniform), close(Sampling::Clustered));
    assert!((40..=80).contains(&uniform) && (120..=190).contains(&clustered), "{uniform} and {clustered} of 250");
}

#[test]
fn too_little_space_is_told_with_its_share() {
    let block = Obstacle { name: String::new(), shape: Shape::cuboid([5.0; 3], [9.9999; 3]).unwrap() };
    let world = World::new(Vector3::repeat(10.0), 0.0, vec![block]).unwrap();
    let error = sample_free(&world, 100, 0.0, Sampling::Uniform, 1).unwrap_err();
    assert!(
        matches!(error, SamplingError::NoSpace { wanted: 100, draws: 110_000, share, .. } if share < 0.001),
        "{error}"
    );
    let error = sample_free(&World::new(Vector3::repeat(10.0), 0.0, vec![]).unwrap(), 70_000, 0.0, Sampling::Sobol, 1);
    assert!(matches!(error, Err(SamplingError::SobolEnds { found: 65_536, .. })), "{error:?}");
}
