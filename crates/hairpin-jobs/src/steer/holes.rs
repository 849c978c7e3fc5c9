//! Ways around what a map has no data of: holes become places to keep out of as drives meet them.
//!
//! Only what ends in missing data is asked again, so that all other answers are those of the map alone. What is found
//! among holes is held against the map as any answer is; where nothing is, the first answer stays.

use std::time::Instant;

use hairpin::feasibility::steering::clear;
use hairpin::world::terrain::{ElevationMap, KeepOut, KeepOutShape, KeepOuts, NoGround};
use hairpin_formats::steering::{Asked, Status};

use super::answered::Answered;
use super::ground;
use super::plane::{Task, hazards};

/// Holes and edges that are gone around one after the other, at most.
const HOLES: usize = 6;
/// How far places beyond the edge of a map reach, m: no drive crosses what it may not touch.
const BEYOND: f64 = 1.0;

/// Answers `asked` on `map`, around holes that end the plain answer.
pub(super) fn answer(task: &Task<'_>, map: &ElevationMap, asked: &Asked) -> Answered {
    let begun = Instant::now();
    let mut first = ground::answer(task, map, asked, begun);
    let mut ended = first.no_ground.filter(|place| !task.there && matches!(place, NoGround::Hole { .. }));
    if ended.is_none() {
        return first;
    }
    let mut places = task.keep_outs.list().to_vec();
    let own = places.len();
    places.extend(edges(task, map, asked));
    for _ in 0..HOLES {
        let Some(place) = ended else { break };
        let (found, at) = match place {
            NoGround::Hole { x, y } => (map.hole([x, y]).into_iter().map(named).collect(), [x, y]),
            NoGround::OffMap { x, y } => (beyond(map), [x, y]),
        };
        // What it met in spite of them is not gone around.
        if places[own..].iter().any(|known| known.shape.distance(at[0], at[1]) <= 0.0) {
            break;
        }
        places.extend(found);
        let Ok(keep_outs) = KeepOuts::new(places.clone()) else { break };
        let task = &Task { keep_outs: &keep_outs, ..*task };
        if !is_clear(task, asked, begun) {
            break;
        }
        let mut again = ground::answer(task, map, asked, begun);
        if let Status::Ok | Status::TimeLimit = again.status {
            let looked = first.stopped.map_or(0, |stopped| stopped.0.iterations);
            again.drive.iter_mut().for_each(|(solution, _)| solution.iterations += looked);
            return again;
        }
        ended = again.no_ground;
    }
    first.solving = begun.elapsed();
    first
}

/// Whether the plane has a way around the places of `task`, or there was no time to find out: without one the ground,
/// which asks for several, has none.
fn is_clear(task: &Task<'_>, asked: &Asked, begun: Instant) -> bool {
    let Task { solver, control, boundary, shaping, .. } = *task;
    let over = || solver.time_limit.is_some_and(|limit| begun.elapsed() >= limit);
    let hazards = task.hazards(asked);
    let (_, near) = clear::generate(boundary, control, &shaping, &solver.choices, &hazards, over, |_| {});
    near.is_none() || over()
}

/// What lies beyond the edges of `map`, if start and goal of `asked` are far enough from it: else nothing is clear.
fn edges(task: &Task<'_>, map: &ElevationMap, asked: &Asked) -> Vec<KeepOut> {
    let Ok(edges) = KeepOuts::new(beyond(map)) else { return Vec::new() };
    let hazards = hazards(task.rover, &edges, asked);
    let goal = &task.boundary.query.goal;
    let far = [[0.0; 2], [goal.x, goal.y]].iter().all(|[x, y]| hazards.room(*x, *y) >= 0.0);
    if far { edges.list().to_vec() } else { Vec::new() }
}

fn named(shape: KeepOutShape) -> KeepOut {
    KeepOut { name: "no ground".into(), shape }
}

/// What lies beyond the edges of `map`.
fn beyond(map: &ElevationMap) -> Vec<KeepOut> {
    let ([west, south], [east, north]) = map.extent();
    let boxed = |[west, south]: [f64; 2], [east, north]: [f64; 2]| KeepOutShape::Polygon {
        points_m: vec![[west, south], [east, south], [east, north], [west, north]],
    };
    let all = [
        boxed([west - BEYOND, south - BEYOND], [west, north + BEYOND]),
        boxed([east, south - BEYOND], [east + BEYOND, north + BEYOND]),
        boxed([west - BEYOND, south - BEYOND], [east + BEYOND, south]),
        boxed([west - BEYOND, north], [east + BEYOND, north + BEYOND]),
    ];
    all.map(named).into()
}
