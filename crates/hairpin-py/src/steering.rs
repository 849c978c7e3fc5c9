//! Boundary-value drives, as many as are asked for in one call: a table of numbers in, two tables out.

use std::path::PathBuf;
use std::time::Duration;

use hairpin_formats::steering::{Asked, Frame, Piece, Status};
use hairpin_formats::terrain::Georeference;
use hairpin_jobs::Unwatched;
use hairpin_jobs::steer::{Answered, SteerSettings, Vehicle as Solver, pieces};
use pyo3::prelude::*;
use pyo3::types::PyBytes;
use rayon::prelude::*;

use crate::problem::raised;
use crate::wait::Waiting;

/// Columns of a question: the start on the map, the goal from there, the curvatures at both ends.
const ASKED: [&str; 8] = ["sx", "sy", "syaw", "x", "y", "yaw", "k0", "kf"];
/// Numbers of an answer: `hairpin._steering` names them.
const ANSWERED: usize = 11;
/// Numbers of a segment.
const OF_A_SEGMENT: usize = 11;
/// Questions that a thread takes at a time.
const AT_ONCE: usize = 64;

/// A vehicle that is asked for drives.
#[pyclass(frozen, module = "hairpin._native")]
pub(crate) struct Vehicle(Solver);

/// What all questions of a call have in common.
#[derive(FromPyObject)]
pub(crate) struct Common {
    direction: f64,
    max_curvature: Option<f64>,
    tolerance_m: Option<f64>,
    free_end: bool,
}

/// Answers, their segments, and the names of limits, of which answers have numbers.
type Tables<'py> = (Bound<'py, PyBytes>, Bound<'py, PyBytes>, Vec<&'static str>);

#[pymethods]
impl Vehicle {
    #[new]
    fn new(
        py: Python<'_>,
        rover: String,
        files: (Option<PathBuf>, Option<PathBuf>),
        may: (bool, bool),
        time_limit_s: Option<f64>,
    ) -> PyResult<Self> {
        let ((terrain, keep_out), (reversals, turns)) = (files, may);
        let settings = SteerSettings {
            rover,
            terrain: terrain.map(|path| (path, Georeference::default())),
            keep_out,
            reversals,
            turns,
            time_limit: time_limit_s.and_then(|seconds| Duration::try_from_secs_f64(seconds).ok()),
            ..SteerSettings::default()
        };
        let made = py.detach(|| Solver::new(&settings, &Unwatched));
        made.map(Self).map_err(|problem| raised(py, &problem))
    }

    /// Answers the questions of a table of numbers with eight columns.
    fn answer<'py>(
        &self,
        py: Python<'py>,
        table: &[u8],
        on_map: bool,
        common: Common,
        waiting: Waiting,
    ) -> PyResult<Tables<'py>> {
        let questions = numbers(table);
        let answers = waiting.wait(py, |watch| {
            let blocks = questions.par_chunks(ASKED.len() * AT_ONCE).map(|block| {
                let mut rows = Rows::default();
                for question in block.chunks_exact(ASKED.len()) {
                    if watch.stopped() {
                        break;
                    }
                    self.one(question, on_map, &common, &mut rows);
                }
                rows
            });
            Ok(blocks.collect::<Vec<_>>())
        })?;
        let (mut all, mut before) = (Rows::default(), 0);
        for mut rows in answers {
            // Segments count questions, of all blocks.
            rows.segments.chunks_exact_mut(OF_A_SEGMENT).for_each(|segment| segment[0] += before as f64);
            before += rows.answers.len() / ANSWERED;
            let places: Vec<f64> = rows.limits.iter().map(|limit| all.limit(limit)).collect();
            for answer in rows.answers.chunks_exact_mut(ANSWERED) {
                if answer[9] >= 0.0 {
                    answer[9] = places[answer[9] as usize];
                }
            }
            all.answers.append(&mut rows.answers);
            all.segments.append(&mut rows.segments);
        }
        Ok((bytes(py, &all.answers)?, bytes(py, &all.segments)?, all.limits))
    }

    /// The vehicle's name, and what its curvature and its change per metre may be.
    #[getter]
    fn facts(&self) -> (String, f64, f64) {
        let rover = &self.0.rover;
        (rover.name.clone(), rover.limits.curvature, rover.limits.curvature_rate)
    }
}

impl Vehicle {
    fn one(&self, question: &[f64], on_map: bool, common: &Common, rows: &mut Rows) {
        let &[sx, sy, syaw, x, y, yaw, k0, kf] = question else { return };
        if let Some(wrong) = question.iter().position(|number| !number.is_finite()) {
            let limit = rows.limit(ASKED[wrong]);
            rows.answers.extend([Status::Invalid as usize as f64, 0.0, 0.0, f64::NAN, f64::NAN, f64::NAN]);
            rows.answers.extend([f64::NAN, f64::NAN, f64::NAN, limit, f64::NAN]);
            return;
        }
        let asked = Asked {
            start: on_map.then_some([sx, sy, syaw]),
            goal: [x, y, yaw],
            k0,
            kf,
            free_end: common.free_end,
            v0: None,
            vf: None,
            direction: common.direction,
            direction_end: None,
            frame: Frame::Enu,
            max_curvature: common.max_curvature,
            tolerance_m: common.tolerance_m,
        };
        let Answered { status, drive, solving, limit, .. } = self.0.answer(&asked);
        let (limit, excess) = match limit {
            Some((name, excess)) => (rows.limit(name), excess.unwrap_or(f64::NAN)),
            None => (-1.0, f64::NAN),
        };
        let mut of_drive = [f64::NAN; 6];
        let mut iterations = 0.0;
        let question = (rows.answers.len() / ANSWERED) as f64;
        if let Some((solution, replay)) = &drive {
            let [ex, ey, eyaw] = replay.error;
            of_drive = [replay.length, ex, ey, eyaw, replay.error_curvature, replay.max_curvature];
            iterations = f64::from(solution.iterations);
            for piece in pieces(solution, k0) {
                rows.segments.push(question);
                rows.segments.extend(match piece {
                    Piece::Arc { length_m, curvature: [a0, a1, a2, a3, a4, a5], direction } => {
                        [0.0, f64::from(direction), length_m, 0.0, a0, a1, a2, a3, a4, a5]
                    }
                    Piece::Turn { angle_rad } => [1.0, 0.0, 0.0, angle_rad, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
                });
            }
        }
        rows.answers.extend([status as usize as f64, iterations, solving.as_secs_f64() * 1e6]);
        rows.answers.extend(of_drive);
        rows.answers.extend([limit, excess]);
    }
}

/// Answers under way.
#[derive(Default)]
struct Rows {
    answers: Vec<f64>,
    segments: Vec<f64>,
    limits: Vec<&'static str>,
}

impl Rows {
    /// The number of a limit's name.
    fn limit(&mut self, name: &'static str) -> f64 {
        let place = self.limits.iter().position(|known| *known == name);
        place.unwrap_or_else(|| {
            self.limits.push(name);
            self.limits.len() - 1
        }) as f64
    }
}

fn numbers(table: &[u8]) -> Vec<f64> {
    table.as_chunks().0.iter().map(|bytes| f64::from_ne_bytes(*bytes)).collect()
}

fn bytes<'py>(py: Python<'py>, numbers: &[f64]) -> PyResult<Bound<'py, PyBytes>> {
    PyBytes::new_with(py, size_of_val(numbers), |room| {
        room.as_chunks_mut().0.iter_mut().zip(numbers).for_each(|(bytes, number)| *bytes = number.to_ne_bytes());
        Ok(())
    })
}
