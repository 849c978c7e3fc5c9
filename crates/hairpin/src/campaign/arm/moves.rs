//! What runs did on the moves of their programs, from what was judged, and for the oracle.

use nalgebra::Isometry3;

use crate::campaign::baseline::{CaseMoves, RunMoves, RunUnseen};
use crate::campaign::{Case, RunDeviation};
use crate::judgement::moves::{Measured, MoveMeasures};
use crate::trajectory::program::{Motion, Program};

/// What tells two programs apart: m, °, a quaternion's part, m/s.
const TELLING: f64 = 1e-6;

impl CaseMoves {
    /// The runs of `case`, those that were measured.
    /// `None` where no run was measured.
    pub(super) fn of(case: &Case, program: &Program, runs: &[&RunDeviation]) -> Option<Self> {
        let measured: Vec<(usize, &Measured)> =
            runs.iter().filter_map(|run| Some((run.run, run.moves.as_ref()?))).collect();
        let moves = measured.first()?.1.moves.iter().map(|one| one.name.clone()).collect();
        let run = |(run, measured): &(usize, &Measured)| RunMoves {
            run: *run,
            sample_s: measured.sample,
            offset_s: measured.offset.map(|offset| offset.seconds),
            offset_spread_s: measured.offset.map(|offset| offset.spread),
            offset_removed: measured.offset.is_some_and(|offset| offset.removed),
            duration_s: measured.moves.iter().map(|one| one.duration).collect(),
            deviation_m: measured.moves.iter().map(|one| one.deviation).collect(),
            unseen: measured.unseen.as_ref().map(|unseen| RunUnseen {
                longest_gap_s: unseen.longest.seconds,
                from_s: unseen.longest.from,
                moves: unseen.longest.names.clone(),
                plan_share: unseen.longest.share,
                moves_seen: unseen.seen[0],
                not_excluded_m: unseen.not_excluded,
            }),
        };
        Some(Self { case: case.number, program: digest(program), moves, runs: measured.iter().map(run).collect() })
    }

    /// The runs as the oracle takes them.
    /// What the oracle does not compare (where in a move, planned durations, unseen) is 0 or left out.
    pub(super) fn measured(&self) -> Vec<Measured> {
        let of = |run: &RunMoves| Measured {
            moves: (self.moves.iter().zip(&run.duration_s).zip(&run.deviation_m))
                .map(|((name, duration), deviation)| MoveMeasures {
                    name: name.clone(),
                    deviation: *deviation,
                    deviation_at: 0.0,
                    arrived: None,
                    after: None,
                    by: None,
                    planned: 0.0,
                    duration: *duration,
                    planned_duration: 0.0,
                    approach: None,
                    left: None,
                })
                .collect(),
            offset: run.offset(),
            sample: run.sample_s,
            deviations: Vec::new(),
            legs: Vec::new(),
            unseen: None,
        };
        self.runs.iter().map(of).collect()
    }
}

/// What the controller is told, in a few letters: targets to a micrometre and a millionth of a degree or a quaternion's
/// part, speeds, zones, tools and work objects; no names, and nothing of how the program was found.
///
/// The first 64 bits of BLAKE3 over the rounded numbers, as 16 hex digits: 10⁴ different programs have two alike with
/// probability 3 · 10⁻¹². Values on both sides of a rounding's half are told apart, however near they are.
fn digest(program: &Program) -> String {
    let mut told: Vec<f64> = Vec::new();
    program.tools.iter().for_each(|tool| tell_pose(&mut told, &tool.tcp));
    program.work_objects.iter().for_each(|object| tell_pose(&mut told, &object.base_from_object()));
    for one in &program.moves {
        told.push(match &one.motion {
            Motion::AbsoluteJoint(_) => 0.0,
            Motion::Joint(_) => 1.0,
            Motion::Linear(_) => 2.0,
            Motion::Circular { .. } => 3.0,
        });
        if let Motion::AbsoluteJoint(to) = &one.motion {
            told.extend(to.joints.map(|angle| angle.to_degrees() / TELLING));
        }
        for target in one.motion.poses() {
            tell_pose(&mut told, &target.pose);
            told.extend(target.configuration.unwrap_or([9; 4]).map(f64::from));
        }
        let (speed, zone) = (&one.speed, &one.zone);
        told.extend(
            [speed.tcp, speed.orientation, one.duration.unwrap_or(-1.0), zone.tcp].map(|value| value / TELLING),
        );
        told.extend([f64::from(u8::from(zone.fine)), one.tool as f64, one.work_object as f64]);
    }
    let mut hasher = blake3::Hasher::new();
    for value in told {
        // Adding 0 makes −0 and 0 one.
        hasher.update(&(value.round() + 0.0).to_bits().to_le_bytes());
    }
    hasher.finalize().to_hex()[..16].to_owned()
}

/// Seven numbers in units of [`TELLING`]: position (m), then i, j, k, w of the quaternion, with that sign which makes
/// its last part that is not 0 positive.
fn tell_pose(told: &mut Vec<f64>, pose: &Isometry3<f64>) {
    told.extend(pose.translation.vector.iter().map(|part| part / TELLING));
    let q = pose.rotation.coords;
    // q and −q are one orientation.
    let leading = q.iter().rev().find(|part| part.abs() > TELLING).map_or(1.0, |part| part.signum());
    told.extend(q.iter().map(|part| leading * part / TELLING));
}
