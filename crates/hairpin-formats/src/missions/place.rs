//! Places of a mission in a world: by where on Earth the world stands or, where that is not told, about the mission's
//! own home.

use std::path::Path;

use hairpin::campaign::Scenario;
use hairpin::world::terrain::{KeepOut, KeepOuts};
use nalgebra::{Point2, Point3};

use super::error::MissionError;
use super::mission::{Fence, Frame, Mission, Outline, Stop, Uncertain, Whose};
use crate::frames::Geodetic;
use crate::placement::Placement;
use crate::qgc::Uploaded;
use crate::qgc::read_plan::{Fence as PlanFence, Outline as PlanOutline};

/// Altitudes of home and world that differ by more are told, m.
const TOLD_M: f64 = 0.01;
/// A fence that is narrower than this, and this share of its length beside, encloses nothing.
const FLAT_M: f64 = 0.01;
const FLAT_SHARE: f64 = 1e-4;

/// A mission of the file `path` in the world of `scenario`, in which nothing lies farther than `farthest` (m) from the
/// origin.
pub(super) fn place(
    (path, format): (&Path, &'static str),
    (uploaded, whose, fences): (Uploaded, Whose, &[PlanFence]),
    scenario: &Scenario,
    farthest: f64,
) -> Result<Mission, MissionError> {
    let refuse = |why: String| MissionError::Placed { path: path.into(), why };
    let Uploaded { home, stations, mut notes, open, .. } = uploaded;
    if stations.len() < 2 {
        return Err(MissionError::TooFew { path: path.into(), found: stations.len() });
    }
    let (world, frame) = match Placement::of(scenario).map_err(refuse)? {
        Some(world) => (world, Frame::Placed),
        None => (Placement::about(&home), Frame::Home(home)),
    };
    let ground = world.geodetic(&Point3::origin()).map_err(refuse)?;
    let above = home.alt_amsl_m - ground.alt_amsl_m;
    if above.abs() > TOLD_M && frame == Frame::Placed {
        notes.push(format!(
            "its home lies {:.2} m {} the world's origin ({:.2} m and {:.2} m above the sea): altitudes are the home's",
            above.abs(),
            if above > 0.0 { "above" } else { "below" },
            home.alt_amsl_m,
            ground.alt_amsl_m
        ));
    }
    let mut waypoints = Vec::with_capacity(stations.len());
    for station in &stations {
        let point =
            world.from_geodetic(&station.place).map_err(|why| refuse(format!("item {}: {why}", station.item)))?;
        if (0..3).any(|axis| !(-farthest..=farthest).contains(&point[axis])) {
            let (far, most) = ((point - Point3::origin()).norm() / 1000.0, farthest / 1000.0);
            return Err(refuse(format!("item {}: {far:.1} km from the world's origin, {most} at most", station.item)));
        }
        waypoints.push(point);
    }
    let last = stations.len() - 1;
    let held = stations.iter().enumerate().skip(1).take(last - 1);
    let stops = held.filter_map(|(waypoint, station)| Some(Stop { waypoint, hold_s: station.hold_s? })).collect();
    Ok(Mission {
        name: path.file_stem().unwrap_or_default().to_string_lossy().into_owned(),
        path: path.into(),
        format,
        sources: stations.iter().map(|station| format!("item {}", station.item)).collect(),
        speeds: stations[1..].iter().map(|station| station.speed).collect(),
        accept: stations.iter().map(|station| station.accept_m).collect(),
        whose,
        waypoints,
        rounded: true,
        frame,
        stops,
        notes,
        uncertain: open.into_iter().map(|open| Uncertain { waypoint: open.station, words: open.words }).collect(),
        fences: fences
            .iter()
            .enumerate()
            .map(|fence| fenced(fence, &world))
            .collect::<Result<_, _>>()
            .map_err(refuse)?,
        environment: None,
    })
}

/// A fence in the world.
///
/// # Errors
/// One that encloses nothing: nobody knows what was meant, and autopilots do not agree on it.
fn fenced((number, fence): (usize, &PlanFence), world: &Placement) -> Result<Fence, String> {
    let level = world.geodetic(&Point3::origin())?.alt_amsl_m;
    let at = |[lat_deg, lon_deg]: [f64; 2]| -> Result<Point2<f64>, String> {
        Ok(world.from_geodetic(&Geodetic { lat_deg, lon_deg, alt_amsl_m: level })?.xy())
    };
    let outline = match &fence.outline {
        PlanOutline::Circle(center, radius) => Outline::Circle(at(*center)?, *radius),
        PlanOutline::Polygon(corners) => {
            Outline::Polygon(corners.iter().map(|corner| at(*corner)).collect::<Result<_, _>>()?)
        }
    };
    let refuse = |what: &str| format!("fence {number} of its geoFence (circles first): {what}");
    if matches!(&outline, Outline::Polygon(corners) if is_flat(corners)) {
        return Err(refuse("its corners lie in a line, must enclose an area"));
    }
    KeepOuts::new(vec![KeepOut { name: String::new(), shape: outline.shape() }])
        .map_err(|why| refuse(&format!("{}, must be {}", why.value, why.bound)))?;
    Ok(Fence { keeps_in: fence.keeps_in, outline })
}

/// Whether corners lie in a line, as those of one latitude nearly do: a parallel is no straight line.
fn is_flat(corners: &[Point2<f64>]) -> bool {
    let Some(first) = corners.first() else { return true };
    let ways = corners.iter().map(|corner| corner - first);
    let Some(longest) = ways.clone().max_by(|a, b| a.norm().total_cmp(&b.norm())) else { return true };
    let length = longest.norm();
    let widest = ways.map(|way| longest.perp(&way).abs()).fold(0.0, f64::max);
    widest <= length * (FLAT_M + FLAT_SHARE * length)
}
