//! Obstacles and the robot as the page's script draws them: triangles, and what turns each link.

use std::borrow::Cow;

use hairpin::campaign::kind::{FigureLink, RobotFigure, Surface, Turned};
use nalgebra::Point3;
use serde_json::{Value, json};

use super::column::{column, counts, round};
use super::decimated::{Decimated, decimated, fits, shares};

/// Triangles of all obstacles together, and of the robot; meshes beyond that are drawn with fewer.
const TRIANGLES: usize = 20_000;
/// Of fewer a mesh is drawn as its box.
const FEWEST: usize = 12;

/// Meshes as the page draws them, and what is said of those that have fewer triangles there.
pub(super) struct Meshes {
    /// One each.
    pub drawn: Vec<Value>,
    /// Empty where all are drawn as they are.
    pub told: String,
}

/// All meshes of the world, or of the robot, within the bound.
pub(super) fn meshes<'a>(surfaces: impl IntoIterator<Item = &'a Surface>) -> Meshes {
    let surfaces: Vec<&Surface> = surfaces.into_iter().collect();
    let counts: Vec<usize> = surfaces.iter().map(|surface| surface.triangles.len()).collect();
    let (mut drawn, mut told) = (Vec::new(), Vec::new());
    for (surface, share) in surfaces.into_iter().zip(shares(&counts, TRIANGLES)) {
        let (shown, how) = within(surface, share);
        let name = if how.is_empty() { shown.name.clone() } else { format!("{} ({how})", surface.name) };
        drawn.push(mesh(&shown, &name));
        told.extend((!how.is_empty()).then(|| format!("{} shown {how}", surface.name)));
    }
    Meshes { drawn, told: shortened(&told) }
}

fn within(surface: &Surface, share: usize) -> (Cow<'_, Surface>, String) {
    if fits(surface, share) {
        return (Cow::Borrowed(surface), String::new());
    }
    let Decimated { surface: fewer, off } = decimated(surface, share.max(FEWEST));
    if fewer.triangles.is_empty() {
        return (Cow::Owned(bounding_box(surface)), "as its box".into());
    }
    let how = format!("with {} of {} triangles, within {off:.2} m", fewer.triangles.len(), surface.triangles.len());
    (Cow::Owned(fewer), how)
}

/// A page has room for a few of them; the rest are told where a mesh is pointed at.
fn shortened(told: &[String]) -> String {
    let more = if told.len() > 3 {
        format!(" · {} more meshes shown with fewer triangles", told.len() - 3)
    } else {
        String::new()
    };
    told[..told.len().min(3)].join(" · ") + &more
}

fn mesh(drawn: &Surface, name: &str) -> Value {
    json!({
        "name": name,
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
        name: surface.name.clone(),
        vertices: (0..8).map(vertex).collect(),
        triangles: faces.iter().flat_map(|[a, b, c, d]| [[*a, *b, *c], [*a, *c, *d]]).collect(),
    }
}

/// The robot's links.
pub(super) fn robot(figure: &RobotFigure) -> Value {
    let Meshes { drawn, told } = meshes(figure.links.iter().flat_map(|link| &link.surfaces));
    let mut drawn = drawn.into_iter();
    let mut link = |link: &FigureLink| {
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
            "mesh": drawn.by_ref().take(link.surfaces.len()).collect::<Vec<_>>(),
        })
    };
    let told: Vec<&str> = [figure.told.as_str(), &told].into_iter().filter(|told| !told.is_empty()).collect();
    json!({
        "links": figure.links.iter().map(&mut link).collect::<Vec<_>>(),
        "fixed": figure.fixed,
        "radius": round(figure.radius, 4),
        "lift": round(figure.lift, 4),
        "told": told.join(" · "),
    })
}
