//! Obstacles and the robot as the page's script draws them: triangles, and what turns each link.

use hairpin::campaign::kind::{FigureLink, RobotFigure, Surface, Turned};
use nalgebra::Point3;
use serde_json::{Value, json};

use super::column::{column, counts, round};

/// Triangles of all obstacles together, and of the robot; a mesh beyond that is drawn as its box.
pub(super) const TRIANGLES: usize = 20_000;

/// A mesh, or its box where there are more than `left` triangles, which it takes its own from.
pub(super) fn mesh(surface: &Surface, left: &mut usize) -> Value {
    let boxed;
    let drawn = if surface.triangles.len() <= *left && surface.vertices.len() < 65_535 {
        surface
    } else {
        boxed = bounding_box(surface);
        &boxed
    };
    *left -= drawn.triangles.len().min(*left);
    json!({
        "name": drawn.name,
        "v": column(drawn.vertices.iter().flat_map(|v| [v.x, v.y, v.z])),
        "t": counts(drawn.triangles.iter().flatten().copied()),
    })
}

fn bounding_box(surface: &Surface) -> Surface {
    let corner = |fold: fn(f64, f64) -> f64, start: f64| -> [f64; 3] {
        std::array::from_fn(|i| surface.vertices.iter().map(|v| v[i]).fold(start, fold))
    };
    let (low, high) = (corner(f64::min, f64::INFINITY), corner(f64::max, f64::NEG_INFINITY));
    let vertex = |c: usize| Point3::from(std::array::from_fn(|i| if c >> i & 1 == 1 { high[i] } else { low[i] }));
    let faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    Surface {
        name: format!("{} (its box)", surface.name),
        vertices: (0..8).map(vertex).collect(),
        triangles: faces.iter().flat_map(|[a, b, c, d]| [[*a, *b, *c], [*a, *c, *d]]).collect(),
    }
}

/// The robot's links.
pub(super) fn robot(figure: &RobotFigure) -> Value {
    let mut left = TRIANGLES;
    let link = |link: &FigureLink| {
        let (at, turn, axis) = (link.place.translation.vector, link.place.rotation, link.axis);
        // A wheel that steers has its place where others have an axis and a factor.
        let (by, factor, axis) = match &link.turned {
            Turned::Never => (None, 0.0, [axis.x, axis.y, axis.z]),
            Turned::By { channel, factor } => (Some(channel.as_str()), *factor, [axis.x, axis.y, axis.z]),
            Turned::Steers { at: [x, y] } => (Some("steer"), *x, [0.0, *y, 1.0]),
        };
        let q = [turn.w, turn.i, turn.j, turn.k].map(|part| round(part, 7));
        json!({
            "parent": link.parent.map_or(-1, |parent| parent as i64),
            "p": [round(at.x, 5), round(at.y, 5), round(at.z, 5)],
            "q": q,
            "axis": axis,
            "by": by,
            "factor": link.thrust.as_ref().map_or(factor, |(_, factor)| *factor),
            "look": link.look.word(),
            "standIn": link.stand_in,
            "thrust": link.thrust.as_ref().map(|(channel, _)| channel),
            "mesh": link.surfaces.iter().map(|surface| mesh(surface, &mut left)).collect::<Vec<_>>(),
        })
    };
    json!({
        "links": figure.links.iter().map(link).collect::<Vec<_>>(),
        "fixed": figure.fixed,
        "radius": round(figure.radius, 4),
        "lift": round(figure.lift, 4),
        "told": figure.told,
    })
}
