//! The height of a return that an autopilot begins by itself: a failsafe knows no obstacles, and may begin anywhere.

use nalgebra::Point3;

use crate::campaign::kind::Returning;
use crate::world::{Shape, World};

/// The least height at which no straight return meets an obstacle.
///
/// Of heights of returning these are tried: the least, and those just over each obstacle. Level ways are swept over all
/// of the mission, so that what stands beside it, between it and home, or hangs above it counts as it stands.
pub(super) fn height(world: &World, radius: f64, returning: &Returning) -> Result<f64, &'static str> {
    let Returning { way, home, heights: [least, most], apart } = *returning;
    let kept = radius + apart;
    let shapes: Vec<&Shape> = world.obstacles().iter().map(|obstacle| &obstacle.shape).collect();
    let just_over = shapes.iter().map(|shape| shape.bounds().max.z + kept + apart);
    let mut heights: Vec<f64> =
        std::iter::once(least).chain(just_over).filter(|height| (least..=most).contains(height)).collect();
    heights.sort_by(f64::total_cmp);
    let is_level_clear = |height: &f64| {
        // What is lower than the way all over is not near to it; that those are passed over keeps the strides long.
        let high: Vec<&Shape> = shapes.iter().filter(|shape| shape.bounds().max.z + kept >= *height).copied().collect();
        swept(way, apart, |place| {
            let over = |at: &Point3<f64>| Point3::new(at.x, at.y, height.max(place.z));
            distance(&high, &over(place), &over(&home)) - kept
        })
    };
    let Some(height) = heights.into_iter().find(is_level_clear) else {
        return Err("obstacles stand between the mission and home at every height below the ceiling");
    };
    // The lowest climbs least: where something is above the mission there, it is at every height.
    let rises = |place: &Point3<f64>, to: f64| distance(&shapes, place, &Point3::new(place.x, place.y, to)) - kept;
    if !swept(way, apart, |place| rises(place, height.max(place.z))) {
        return Err("an obstacle is above the mission, where a return climbs");
    }
    let highest = way.iter().map(|place| place.z).fold(height, f64::max);
    if rises(&home, highest) <= 0.0 {
        return Err("an obstacle is above home, where a return comes down");
    }
    Ok(height)
}

fn distance(shapes: &[&Shape], from: &Point3<f64>, to: &Point3<f64>) -> f64 {
    shapes.iter().map(|shape| shape.segment_distance(from, to)).fold(f64::INFINITY, f64::min)
}

/// Whether `spare` is above 0 at each place of a chain: it changes by no more than the way to the next place. Strides
/// of half of `least` at the smallest.
fn swept(way: &[Point3<f64>], least: f64, spare: impl Fn(&Point3<f64>) -> f64) -> bool {
    let is_clear = |from: &Point3<f64>, to: &Point3<f64>| {
        let leg = to - from;
        let length = leg.norm();
        let mut gone = 0.0;
        while gone < length {
            let free = spare(&(from + leg * (gone / length)));
            if free <= 0.5 * least || free.is_nan() {
                return false;
            }
            gone += free;
        }
        true
    };
    way.windows(2).all(|pair| is_clear(&pair[0], &pair[1])) && way.last().is_none_or(|end| spare(end) > 0.0)
}

#[cfg(feature = "unit-tests")]
mod tests {
    use nalgebra::Vector3;

    use super::*;
    use crate::math::random::{stream, unit};
    use crate::world::Obstacle;

    const RADIUS: f64 = 0.3;
    const APART: f64 = 0.01;

    fn world(shapes: &[Shape]) -> World {
        let named = |shape: &Shape| Obstacle { name: "mast".into(), shape: shape.clone() };
        World::new(Vector3::new(60.0, 60.0, 30.0), 2.0, shapes.iter().map(named).collect()).unwrap()
    }

    fn of(shapes: &[Shape], way: &[Point3<f64>]) -> Result<f64, &'static str> {
        let home = Point3::new(way[0].x, way[0].y, 0.0);
        let least = way.iter().map(|place| place.z).fold(0.0, f64::max);
        height(&world(shapes), RADIUS, &Returning { way, home, heights: [least, 28.0], apart: APART })
    }

    #[test]
    fn a_return_from_behind_a_tower_goes_over_it() {
        let way = [[5.0, 5.0, 5.0], [5.0, 47.0, 5.0], [15.0, 47.0, 8.0], [5.0, 47.0, 5.0]].map(Point3::from);
        let tower = |x: f64, top: f64| Shape::cuboid([x, 38.0, 0.5 * top], [8.0, 8.0, top]).unwrap();
        let over = of(&[tower(15.0, 20.0)], &way).unwrap();
        assert!((20.3..20.35).contains(&over), "{over}");
        // Where no return passes by it is not in the way.
        assert_eq!(of(&[tower(25.0, 20.0)], &way), Ok(8.0));
        assert!(of(&[tower(15.0, 27.9)], &way).unwrap_err().contains("between the mission and home"));
        // What hangs from the ceiling is flown under, unless it is above the mission or home.
        let lamp = |x: f64, y: f64| Shape::cuboid([x, y, 20.0], [3.0, 3.0, 20.0]).unwrap();
        assert_eq!(of(&[lamp(9.0, 38.0)], &way), Ok(8.0));
        let beam = |x: f64, y: f64| Shape::cuboid([x, y, 11.0], [3.0, 3.0, 2.0]).unwrap();
        assert_eq!(of(&[beam(5.0, 47.0)], &way), Ok(8.0));
        assert!(of(&[tower(15.0, 20.0), beam(5.0, 47.0)], &way).unwrap_err().contains("above the mission"));
        let short = [[5.0, 5.0, 5.0], [40.0, 5.0, 5.0], [40.0, 40.0, 5.0]].map(Point3::from);
        let far = Shape::cuboid([25.0, 20.0, 8.0], [8.0, 8.0, 16.0]).unwrap();
        assert!(of(std::slice::from_ref(&far), &short).unwrap() > 16.3);
        // Its underside is above the first leg's end only.
        assert!(of(&[far, beam(39.0, 5.0)], &short).unwrap_err().contains("above the mission"));
    }

    /// Whatever is answered: no return from a place between waypoints comes near to anything, sampled densely.
    #[test]
    fn returns_from_everywhere_are_clear_of_obstacles_by_chance() {
        let mut answered = [0; 2];
        for seed in 0..150 {
            let mut random = stream(seed);
            let mut at = |low: f64, high: f64| low + (high - low) * unit(&mut random);
            let way: Vec<Point3<f64>> =
                (0..5).map(|_| Point3::new(at(3.0, 57.0), at(3.0, 57.0), at(2.0, 14.0))).collect();
            let mut shapes = Vec::new();
            for _ in 0..2 {
                let [x, y, z] = [at(3.0, 57.0), at(3.0, 57.0), at(0.0, 22.0)];
                shapes.push(Shape::sphere([x, y, z], at(0.5, 4.0)).unwrap());
                let [x, y, top] = [at(3.0, 57.0), at(3.0, 57.0), at(1.0, 25.0)];
                shapes.push(Shape::cuboid([x, y, 0.5 * top], [at(0.5, 6.0), at(0.5, 6.0), top]).unwrap());
                let [x, y, z] = [at(3.0, 57.0), at(3.0, 57.0), at(0.0, 20.0)];
                shapes.push(Shape::capsule([x, y, z], [at(3.0, 57.0), y, z], 0.5).unwrap());
            }
            let Ok(height) = of(&shapes, &way) else {
                answered[0] += 1;
                continue;
            };
            answered[1] += 1;
            let world = world(&shapes);
            for leg in way.windows(2) {
                for share in 0..=40 {
                    let from = leg[0] + (leg[1] - leg[0]) * (f64::from(share) / 40.0);
                    let over = |p: &Point3<f64>| Point3::new(p.x, p.y, height.max(from.z));
                    let chain = [from, over(&from), over(&way[0]), Point3::new(way[0].x, way[0].y, 0.0)];
                    for piece in chain.windows(2) {
                        let near = world.segment_distance(&piece[0], &piece[1]);
                        assert!(near > RADIUS, "seed {seed}: {near} m at {height} m from {from}");
                    }
                }
            }
        }
        assert!(answered.iter().all(|count| *count > 10), "{answered:?}");
    }
}
