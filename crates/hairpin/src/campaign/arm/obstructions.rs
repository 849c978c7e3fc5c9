//! What stands in an arm's way, in sentences: at home, at points, and on the moves between them.

use std::collections::BTreeMap;

use nalgebra::Isometry3;

use super::ArmSetup;
use super::arm_graph::ArmGraph;
use super::graph::{joint_settings, whole_graph};
use super::losses::stage_of;
use super::points::places;
use crate::campaign::Stop;
use crate::campaign::scenario::ArmMode;
use crate::feasibility::reachability::Refusal;
use crate::feasibility::reachability::joint::{
    Bodies, Cost, FollowSettings, Motion, Station as Stand, Worth, follow, joint,
};
use crate::robot::arm::Joints;
use crate::world::cell::Cell;

/// Places that are looked at where none fits.
const PLACES: usize = 200;
/// Reasons that are told of points and of moves, and names of points with one reason.
const MOST: usize = 8;

/// All that meets where the arm stands.
pub(super) struct Meetings {
    /// Pairs of bodies.
    pub(super) pairs: Vec<[usize; 2]>,
    refusals: Vec<Refusal>,
}

impl Meetings {
    /// At the posture that programs begin at.
    ///
    /// A check names the first pair that meets alone: each pair found is excluded and the posture looked at again,
    /// then each part of the cell by itself. Between the arm's own bodies no clearance is asked, towards the cell
    /// the scenario's. In Cartesian mode nothing meets.
    pub(super) fn at_home(setup: &ArmSetup) -> Self {
        let station = &setup.station;
        let mut found = Self { pairs: Vec::new(), refusals: Vec::new() };
        if setup.scenario.generate.mode == ArmMode::Cartesian {
            return found;
        }
        // One pair hides the next.
        let (mut arm, nothing) = (station.arm.clone(), Cell::default());
        while let Some(refusal) = Bodies::new(&arm, &station.tool, &nothing, 0.0).standing(&station.home, 0.0) {
            let Refusal::SelfCollides { links, .. } = refusal else { break };
            arm.excluded.push(links);
            found.pairs.push(links);
            found.refusals.push(refusal);
        }
        let clearance = joint_settings(station, &setup.scenario).clearance;
        for (index, part) in station.cell.parts.iter().enumerate() {
            let alone = Cell { parts: vec![part.clone()] };
            let refusal = Bodies::new(&arm, &station.tool, &alone, clearance).standing(&station.home, 0.0);
            if let Some(Refusal::Collides { link, at, undecided, .. }) = refusal {
                found.refusals.push(Refusal::Collides { link, part: index, at, undecided });
            }
        }
        found
    }
}

impl ArmSetup {
    /// What meets at home, each in a sentence's part.
    pub(super) fn home_meets(&self) -> Vec<String> {
        Meetings::at_home(self).refusals.iter().map(|refusal| self.told(refusal)).collect()
    }

    /// A refusal without its place on a move, and what it rests on.
    fn told(&self, refusal: &Refusal) -> String {
        let words = refusal.in_words(&self.part_names()).to_string();
        let words =
            words.rsplit_once(" at ").filter(|(_, share)| share.ends_with("of the move")).map_or(&*words, |(w, _)| w);
        match Worth::of(&self.station.arm, &self.station.tool, refusal).in_words(&self.station.arm) {
            Some(estimated) => format!("{words} ({estimated})"),
            None => words.to_owned(),
        }
    }

    /// What refuses it, alike for all moves that it refuses.
    fn alike(&self, refusal: &Refusal) -> String {
        match refusal {
            Refusal::Collides { .. } | Refusal::SelfCollides { .. } | Refusal::ToolMeets { .. } => self.told(refusal),
            _ => {
                let (stage, limit) = stage_of(refusal, &self.part_names());
                format!("{}: {limit}", stage.word())
            }
        }
    }
}

/// All that is in the way.
///
/// In sentences: what meets what at home, points that the arm cannot stand at, where neither tells anything the ways
/// from home and back, then the moves; the most frequent reason of each first. Builds the graph again.
pub(super) fn in_the_way(setup: &ArmSetup) -> Vec<String> {
    let mut said: Vec<String> = setup.home_meets().into_iter().map(|meets| format!("at home {meets}")).collect();
    match whole_graph(setup, &Stop::never()) {
        Ok(graph) => {
            said.extend(of_points(setup, &graph));
            if said.is_empty() {
                said.extend(of_ways(setup, &graph));
            }
            said.extend(of_moves(setup, &graph));
        }
        Err(_) if said.is_empty() => said.extend(of_places(setup)),
        Err(_) => {}
    }
    said
}

/// Points that the arm cannot stand at, by reason.
fn of_points(setup: &ArmSetup, graph: &ArmGraph) -> Vec<String> {
    let postures = graph.postures.iter().flatten().enumerate();
    let refused = postures.filter_map(|(row, posture)| Some((row, posture.as_ref().err()?)));
    let mut rows: BTreeMap<String, Vec<String>> = BTreeMap::new();
    for (row, refusal) in refused {
        rows.entry(setup.told(refusal)).or_default().push(setup.point_name(row));
    }
    let mut all: Vec<(String, Vec<String>)> = rows.into_iter().collect();
    all.sort_by_key(|(_, points)| std::cmp::Reverse(points.len()));
    let more = all.len().saturating_sub(MOST);
    let told = all.iter().take(MOST).map(|(why, points)| {
        let others = points.len().saturating_sub(MOST);
        let others = if others > 0 { format!(" and {others} more") } else { String::new() };
        format!("{}{others} cannot be met: {why}", points[..points.len().min(MOST)].join(", "))
    });
    let more = (more > 0).then(|| format!("{more} further reasons of other points"));
    told.chain(more).collect()
}

/// Ways from home to points that the arm can stand at, and back, by reason.
fn of_ways(setup: &ArmSetup, graph: &ArmGraph) -> Vec<String> {
    let (station, Some(postures)) = (&setup.station, &graph.postures) else { return Vec::new() };
    let settings = joint_settings(station, &setup.scenario);
    let bodies = Bodies::new(&station.arm, &station.tool, &station.cell, settings.clearance);
    let way = |start: &Joints, end: &Joints| {
        let motion = Motion::Joint { start: *start, end: *end };
        let asked = FollowSettings { locate: true, ..settings.follow };
        follow(&station.arm, &station.tool, Some(&bodies), &motion, start, &asked, &mut 0).err()
    };
    let mut counts: BTreeMap<String, u64> = BTreeMap::new();
    for (row, q) in postures.iter().enumerate().filter_map(|(row, q)| Some((row, q.as_ref().ok()?))) {
        let ways = [(graph.from_home[row], [&station.home, q]), (graph.to_home[row], [q, &station.home])];
        for refusal in ways.iter().filter(|(free, _)| !free).filter_map(|(_, [start, end])| way(start, end)) {
            *counts.entry(setup.alike(&refusal)).or_default() += 1;
        }
    }
    most(counts, "ways from home or back are refused")
}

/// Moves between points that meet something, by what meets.
fn of_moves(setup: &ArmSetup, graph: &ArmGraph) -> Vec<String> {
    let n = graph.points();
    let stands = |row: usize| graph.postures.as_ref().is_none_or(|postures| postures[row].is_ok());
    let pairs =
        (0..n).filter(|row| stands(*row)).flat_map(|from| (0..n).filter(|row| stands(*row)).map(move |to| (from, to)));
    let mut counts: BTreeMap<String, u64> = BTreeMap::new();
    for refusal in pairs.filter(|(from, to)| from != to).filter_map(|(from, to)| graph.reachability.refusal(from, to)) {
        if refusal.kind() == "collision" || matches!(refusal, Refusal::BeyondReach { .. }) {
            *counts.entry(setup.alike(refusal)).or_default() += 1;
        }
    }
    most(counts, "moves between points are refused")
}

/// What is wrong with places within reach, where none of those to be drawn fits.
///
/// From a stream of its own, so that a place's verdict is that of the graph of one point, moves from and to home
/// included. A sample: what is told are counts of 200, by one reason each, the first that was met.
fn of_places(setup: &ArmSetup) -> Vec<String> {
    let (station, scenario) = (&setup.station, &setup.scenario);
    if scenario.generate.mode == ArmMode::Cartesian {
        return Vec::new();
    }
    let settings = joint_settings(station, scenario);
    let refused = |pose: &Isometry3<f64>| {
        let stand = Stand { pose: *pose, configuration: None };
        let graph = joint(&station.arm, &station.tool, &station.cell, &[stand], &settings, &Cost::Distance);
        let way = graph.from_home[0].or(graph.to_home[0]);
        graph.joints[0].as_ref().err().copied().or(way)
    };
    let mut counts: BTreeMap<String, u64> = BTreeMap::new();
    for refusal in places(scenario, &station.work_object, station.reach(), PLACES).iter().filter_map(refused) {
        *counts.entry(setup.alike(&refusal)).or_default() += 1;
    }
    most(counts, &format!("of {PLACES} places within reach are refused"))
}

/// The most frequent first.
fn most(counts: BTreeMap<String, u64>, what: &str) -> Vec<String> {
    let mut all: Vec<(String, u64)> = counts.into_iter().collect();
    all.sort_by_key(|(_, count)| std::cmp::Reverse(*count));
    all.into_iter().take(MOST).map(|(why, count)| format!("{count} {what}: {why}")).collect()
}
