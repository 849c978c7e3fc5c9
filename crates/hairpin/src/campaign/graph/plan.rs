//! A trajectory that a graph gave.

use nalgebra::Point3;
use rand::RngExt;

use crate::campaign::{Case, CaseNumber, Environment, Evidence, SeenLeg, Witness};
use crate::math::random::{Stream, case_seed};
use crate::search::Found;
use crate::trajectory::Profile;
use crate::trajectory::program::{Motion, Program};

/// A trajectory that a graph gave.
///
/// A case without number and seed: what searches hand around, and what changes of plans are made of.
#[derive(Debug, Clone)]
pub(in crate::campaign) struct Plan {
    /// m, both ends included.
    pub(in crate::campaign) waypoints: Vec<Point3<f64>>,
    /// s, one per leg.
    pub(in crate::campaign) leg_times: Vec<f64>,
    /// What the search saw of each leg; empty where no search chose them.
    pub(in crate::campaign) seen: Vec<SeenLeg>,
    /// In the score's own unit; of what was executed for it the stress.
    pub(in crate::campaign) score: f64,
    /// No trajectory of the graph scores higher, where a search has proven it.
    pub(in crate::campaign) bound: Option<f64>,
    /// By the reach set that has its legs.
    pub(in crate::campaign) evidence: Evidence,
    /// `yes`, `no` or `unknown`, where a witness was searched afterwards.
    pub(in crate::campaign) certified: Option<&'static str>,
    /// The commands, where the reach set has these.
    pub(in crate::campaign) witness: Option<Witness>,
    /// What was found beside the waypoints.
    pub(in crate::campaign) environment: Option<Environment>,
}

impl Plan {
    /// What was found among `points`, on `evidence`.
    pub(in crate::campaign) fn new<N>(found: &Found<N>, points: &[Point3<f64>], evidence: Evidence) -> Self {
        Self {
            waypoints: found.waypoints.iter().map(|&index| points[index as usize]).collect(),
            leg_times: found.leg_times.clone(),
            seen: Vec::new(),
            score: found.score,
            bound: None,
            evidence,
            certified: None,
            witness: None,
            environment: None,
        }
    }

    /// Over `waypoints`, which `profile` passes.
    pub(in crate::campaign) fn witnessed(waypoints: Vec<Point3<f64>>, profile: Profile) -> Self {
        Self {
            leg_times: profile.legs.iter().map(|leg| leg.duration).collect(),
            waypoints,
            seen: Vec::new(),
            score: 0.0,
            bound: None,
            evidence: Evidence::Witnessed,
            certified: None,
            witness: Some(profile.into()),
            environment: None,
        }
    }

    /// Waypoints up to the first one of leg `leg`, and those of `other` after as many; `None` where one of both has
    /// none.
    ///
    /// Nothing is asked of feasibility: the joined list may have no plan.
    pub(in crate::campaign) fn spliced(&self, other: &Self, leg: usize) -> Option<Vec<Point3<f64>>> {
        Some([self.waypoints.get(..=leg)?, other.waypoints.get(leg + 1..)?].concat())
    }

    /// What `case` was made of.
    pub(in crate::campaign) fn of(case: &Case) -> Self {
        let Case {
            number: _, seed: _, graph: _, waypoints, leg_times, seen, score, bound, evidence, certified, ..
        } = case.clone();
        let (witness, environment) = (case.witness.clone(), case.environment.clone());
        Self { waypoints, leg_times, seen, score, bound, evidence, certified, witness, environment }
    }

    /// Case `number` of a campaign under the root seed, found in graph number `graph`.
    pub(in crate::campaign) fn case(self, root: u64, graph: u64, number: usize) -> Case {
        let case = CaseNumber(number);
        Case {
            number: case,
            seed: case_seed(root, number as u64),
            graph,
            waypoints: self.waypoints,
            leg_times: self.leg_times,
            seen: self.seen,
            score: self.score,
            bound: self.bound,
            evidence: self.evidence,
            certified: self.certified,
            witness: self.witness.map(|witness| witness.of_case(case)),
            environment: self.environment,
        }
    }
}

/// One of the free waypoints of a graph: neither its start nor its end.
///
/// Uniform; a graph has at least one free waypoint.
pub(in crate::campaign) fn between(points: &[Point3<f64>], random: &mut Stream) -> Point3<f64> {
    points[random.random_range(1..points.len() - 1)]
}

/// 128 bits of BLAKE3 over the coordinates: equal waypoint lists are one trajectory.
pub(in crate::campaign) fn fingerprint(waypoints: impl IntoIterator<Item = Point3<f64>>) -> [u8; 16] {
    let mut hasher = blake3::Hasher::new();
    for waypoint in waypoints {
        for coordinate in waypoint.iter() {
            hasher.update(&coordinate.to_le_bytes());
        }
    }
    let mut short = [0; 16];
    short.copy_from_slice(&hasher.finalize().as_bytes()[..16]);
    short
}

/// What tells one case from another: its waypoints, and the points that the arcs of its program pass between them.
pub(in crate::campaign) fn met<'a>(
    waypoints: &'a [Point3<f64>],
    program: Option<&'a Program>,
) -> impl Iterator<Item = Point3<f64>> + 'a {
    let passed = program.into_iter().flat_map(|program| &program.moves).filter_map(|one| match &one.motion {
        Motion::Circular { via, .. } => Some(via.pose.translation.vector.into()),
        _ => None,
    });
    waypoints.iter().copied().chain(passed)
}
