//! What the world's queries cost: sampling a graph's waypoints, and segment distances to each kind of solid.

use hairpin::world::{Obstacle, Sampling, Shape, World, sample_free};
use nalgebra::{Point3, Vector3};

fn world(shapes: Vec<Shape>) -> World {
    let obstacles = shapes.into_iter().map(|shape| Obstacle { name: String::new(), shape }).collect();
    World::new(Vector3::repeat(30.0), 2.0, obstacles).expect("a world")
}

fn shapes() -> [Shape; 4] {
    let cloud: Vec<[f64; 3]> =
        (0..40).map(|i| [12.0 + f64::from(i * 7 % 5), 8.0 + f64::from(i * 3 % 7), f64::from(i % 9)]).collect();
    [
        Shape::sphere([12.0, 8.0, 5.0], 2.0),
        Shape::cuboid([12.0, 8.0, 5.0], [2.0, 2.0, 10.0]),
        Shape::capsule([12.0, 8.0, 0.0], [12.0, 8.0, 10.0], 0.5),
        Shape::hull(&cloud),
    ]
    .map(|shape| shape.expect("a shape"))
}

#[divan::bench(args = [Sampling::Uniform, Sampling::Sobol])]
fn sample_250_points_no_obstacle(bencher: divan::Bencher, sampling: Sampling) {
    let world = world(vec![]);
    bencher.bench(|| sample_free(&world, 250, 0.25, sampling, divan::black_box(7)));
}

#[divan::bench(args = 0..4)]
fn segment_distance_sphere_box_capsule_hull(bencher: divan::Bencher, kind: usize) {
    let shape = shapes()[kind].clone();
    let (a, b) = (Point3::new(3.0, 3.0, 3.0), Point3::new(20.0, 12.0, 9.0));
    bencher.bench(|| shape.segment_distance(divan::black_box(&a), &b));
}

#[divan::bench]
fn segment_distance_forty_boxes(bencher: divan::Bencher) {
    let boxes = (0..40).map(|i| {
        let (x, y) = (f64::from(i % 7) * 4.0 + 1.0, f64::from(i / 7) * 4.0 + 1.0);
        Shape::cuboid([x, y, 5.0], [1.0, 1.0, 10.0]).expect("a box")
    });
    let world = world(boxes.collect());
    let (a, b) = (Point3::new(3.0, 3.0, 3.0), Point3::new(7.0, 6.0, 9.0));
    bencher.bench(|| world.segment_distance(divan::black_box(&a), &b));
}
