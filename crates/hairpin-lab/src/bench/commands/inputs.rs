//! The inputs that are made, each by its name: a fixed rule and a fixed seed.

use std::fmt::Write;

use hairpin::feasibility::steering::shooting::query::{Goal, Query};
use hairpin::math::random::named_seed;
use hairpin::search::heaviest::{Arcs, Workspace};
use hairpin::trajectory::drive::Planar;
use hairpin_jobs::Problem;

use super::super::ground::craters;
use super::super::questions::{nth_seed, published, table};
use super::super::steer::{feasible, hard, many_hard};

/// Queries on the ground, as they are frozen.
pub(super) const ROUGH: &str = "rough.csv";
/// Cells along an edge of the wide map.
const WIDE: usize = 4000;
/// Edge of a cell, m.
const CELL: f64 = 0.1;
/// Copies of the small map along an edge of the wide one, to which queries are moved by turns.
const COPIES: usize = 5;

/// The bytes of the input `name`; `frozen` gives those of another one.
///
/// # Errors
/// There is no such input.
pub(super) fn make(name: &str, frozen: impl Fn(&str) -> Result<Vec<u8>, Problem>) -> Result<Vec<u8>, Problem> {
    match name {
        "curves.csv" => Ok(queries(&feasible()).into_bytes()),
        "anywhere.csv" => Ok(queries(&hard()).into_bytes()),
        "anywhere-100000.csv" => Ok(queries(&many_hard(100_000)).into_bytes()),
        "ground.npy" => small_map(),
        "wide.npy" => wide_map(WIDE),
        "wide.csv" => Ok(spread(&rough(&frozen(ROUGH)?)?).into_bytes()),
        _ => costs(name).unwrap_or_else(|| Err(Problem::input(format!("there is no input `{name}`")))),
    }
}

/// As `steer --queries` reads them; numbers read back to the same bits.
fn queries(all: &[Query]) -> String {
    let mut text = "id,x,y,yaw,k0,kf\n".to_owned();
    for (id, Query { start_curvature, goal: Goal { x, y, yaw, curvature } }) in all.iter().enumerate() {
        let _ = writeln!(text, "{id},{x:?},{y:?},{yaw:?},{start_curvature:?},{curvature:?}");
    }
    text
}

/// A query on the ground, by the columns of its file behind `id`.
#[derive(Clone, Copy)]
pub(super) struct Rough {
    start: [f64; 3],
    goal: [f64; 3],
    curvatures: [f64; 2],
}

/// The queries of a file of [`ROUGH`]'s columns.
pub(super) fn rough(bytes: &[u8]) -> Result<Vec<Rough>, Problem> {
    let text = std::str::from_utf8(bytes).map_err(Problem::input)?;
    let row = |line: &str| {
        let numbers: Result<Vec<f64>, _> = line.split(',').map(str::parse).collect();
        match numbers.as_deref() {
            Ok([_, sx, sy, syaw, x, y, yaw, k0, kf]) => {
                Ok(Rough { start: [*sx, *sy, *syaw], goal: [*x, *y, *yaw], curvatures: [*k0, *kf] })
            }
            _ => Err(Problem::input(format!("{ROUGH}: `{line}` is no id,sx,sy,syaw,x,y,yaw,k0,kf"))),
        }
    };
    text.lines().skip(1).map(row).collect()
}

impl Rough {
    /// Start and goal on the map.
    pub(super) fn on_the_map(&self) -> (Planar, Planar) {
        let ([sx, sy, syaw], [x, y, yaw], [k0, kf]) = (self.start, self.goal, self.curvatures);
        let (sin, cos) = libm::sincos(syaw);
        let goal = Planar { x: sx + cos * x - sin * y, y: sy + sin * x + cos * y, yaw: syaw + yaw, curvature: kf };
        (Planar { x: sx, y: sy, yaw: syaw, curvature: k0 }, goal)
    }
}

/// The same queries, moved by turns to the copies of the small map that lie on the wide one as it is.
fn spread(all: &[Rough]) -> String {
    let period = CELL * period(WIDE / 10) as f64;
    let mut text = "id,sx,sy,syaw,x,y,yaw,k0,kf\n".to_owned();
    for (id, Rough { start: [sx, sy, syaw], goal: [x, y, yaw], curvatures: [k0, kf] }) in all.iter().enumerate() {
        let [sx, sy] = [(sx, id % COPIES), (sy, id / COPIES % COPIES)].map(|(at, copy)| at + period * copy as f64);
        let _ = writeln!(text, "{id},{sx:?},{sy:?},{syaw:?},{x:?},{y:?},{yaw:?},{k0:?},{kf:?}");
    }
    text
}

/// Cells after which a map of `cells` along an edge, mirrored at its edges again and again, comes again.
fn period(cells: usize) -> usize {
    2 * (cells - 1)
}

fn small_map() -> Result<Vec<u8>, Problem> {
    let map = craters()?;
    Ok(numpy(map.grid().rows, |row, column| map.cell_height(row, column)))
}

/// The small map, mirrored at its edges until it fills one of `side` cells along an edge.
fn wide_map(side: usize) -> Result<Vec<u8>, Problem> {
    let map = craters()?;
    let cells = map.grid().rows;
    let within = |at: usize| {
        let at = at % period(cells);
        at.min(period(cells) - at)
    };
    Ok(numpy(side, |row, column| map.cell_height(within(row), within(column))))
}

/// A NumPy array (format 1.0) of heights as `f32`, rows from the north; `height` is asked with rows from the south.
fn numpy(side: usize, height: impl Fn(usize, usize) -> f32) -> Vec<u8> {
    let header = format!("{{'descr': '<f4', 'fortran_order': False, 'shape': ({side}, {side}), }}");
    // Magic, version and length are 10 bytes; all of it is a multiple of 64, and ends a line.
    let length = (10 + header.len() + 1).next_multiple_of(64) - 10;
    let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
    bytes.extend((length as u16).to_le_bytes());
    bytes.extend(format!("{header:<0$}\n", length - 1).into_bytes());
    for row in (0..side).rev() {
        bytes.extend((0..side).flat_map(|column| height(row, column).to_le_bytes()));
    }
    bytes
}

/// A table of costs for `max-load --graph`: `proof-POINTS-INDEX.csv` and `dense-POINTS-INDEX.csv` of the published
/// kind, `clusters-POINTS-INDEX.csv` of four clusters of 10 mm.
fn costs(name: &str) -> Option<Result<Vec<u8>, Problem>> {
    let mut parts = name.strip_suffix(".csv")?.split('-');
    let (kind, points, index) = (parts.next()?, parts.next()?.parse().ok()?, parts.next()?.parse().ok()?);
    let arcs = match kind {
        "proof" | "dense" => published(points, nth_seed(index)).map(|question| question.arcs),
        "clusters" => clusters(points, index),
        _ => return None,
    };
    Some(arcs.map(|arcs| table(&arcs).into_bytes()))
}

/// As the experiment `robtest-clusters` draws them.
fn clusters(points: usize, index: u64) -> Result<Arcs, Problem> {
    let seed = named_seed(1, "robtest", 1000 * points as u64 + index);
    let workspace = Workspace::PUBLISHED;
    workspace.arcs(&workspace.clustered(points, 4, 0.01, seed)).map_err(Problem::input)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn arrays_are_as_numpy_has_them() {
        let bytes = numpy(2, |row, column| (10 * row + column) as f32);
        assert_eq!((bytes.len(), &bytes[..8]), (128 + 16, &b"\x93NUMPY\x01\x00"[..]));
        assert_eq!(u16::from_le_bytes([bytes[8], bytes[9]]), 118);
        assert_eq!(bytes[127], b'\n');
        // The northern row comes first.
        let heights: Vec<f32> =
            bytes[128..].chunks(4).map(|cell| f32::from_le_bytes(cell.try_into().unwrap())).collect();
        assert_eq!(heights, [10.0, 11.0, 0.0, 1.0]);
    }

    #[test]
    fn moved_queries_stand_on_the_same_ground() {
        let map = craters().unwrap();
        let cells = map.grid().rows;
        assert_eq!((cells, WIDE), (400, 10 * cells));
        let one = Rough { start: [20.05, 10.05, 0.5], goal: [1.0, 0.0, 0.0], curvatures: [0.0; 2] };
        let text = spread(&[one; 26]);
        let moved = rough(text.as_bytes()).unwrap();
        // Two copies along an edge are as good as all.
        let side = 3 * cells;
        let (wide, small) = (wide_map(side).unwrap(), small_map().unwrap());
        let height = |bytes: &[u8], side: usize, [x, y]: [f64; 2]| {
            let cell = |at: f64| (at / CELL - 0.5).round() as usize;
            let at = 128 + 4 * ((side - 1 - cell(y)) * side + cell(x));
            f32::from_le_bytes(bytes[at..at + 4].try_into().unwrap())
        };
        let here = height(&small, cells, [20.05, 10.05]);
        for query in [moved[0], moved[1], moved[6], moved[25]] {
            assert_eq!(height(&wide, side, [query.start[0], query.start[1]]), here);
        }
        assert!((moved[24].start[0] - 20.05 - 4.0 * 79.8).abs() < 1e-9);
        assert_eq!(moved[25].start, one.start);
    }

    #[test]
    fn goals_are_seen_from_their_starts() {
        let turned =
            Rough { start: [1.0, 2.0, std::f64::consts::FRAC_PI_2], goal: [3.0, 1.0, 0.5], curvatures: [0.1, 0.2] };
        let (start, goal) = turned.on_the_map();
        assert_eq!((start.x, start.y, start.curvature), (1.0, 2.0, 0.1));
        assert!((goal.x - 0.0).abs() < 1e-12 && (goal.y - 5.0).abs() < 1e-12);
        assert!((goal.yaw - std::f64::consts::FRAC_PI_2 - 0.5).abs() < 1e-12 && goal.curvature == 0.2);
    }
}
