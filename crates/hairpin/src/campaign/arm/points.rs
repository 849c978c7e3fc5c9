//! The cloud: poses of the tool in the base frame, read, listed or drawn.

use std::collections::HashSet;
use std::f64::consts::TAU;

use nalgebra::{Isometry3, Translation3, UnitQuaternion, Vector3};

use crate::campaign::attachments::{Attachments, CloudPoint};
use crate::campaign::scenario::{ArmScenario, ArmTask, DrawnPoints, Mistake, PointsFrame, PointsSource, frame_of};
use crate::math::random::{Stream, named_seed, stream, unit};
use crate::robot::arm::{ArmError, WorkObject, unit_quaternion_of};

/// A point of the cloud.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CellPoint {
    /// `base_from_tcp`.
    pub pose: Isometry3<f64>,
    /// cf1, cf4, cf6, cfx, where the cloud says them.
    pub configuration: Option<[i32; 4]>,
}

/// Draws per point that is asked for: in a cell where fewer than one in so many fits, the cell is at fault.
pub(super) const DRAWS: usize = 20_000;

/// How many points there are; 0 where they are in a file that was not read.
pub(super) fn count(task: &ArmTask, files: &Attachments) -> u64 {
    task.count(files.cloud(&task.points).map_or(0, |cloud| cloud.len() as u64))
}

/// The points of a resolved scenario. `fits` says whether the arm can stand at a drawn pose, and `reach` is the ball
/// (centre and radius, m, base frame) that it can stand in.
///
/// # Errors
/// The key of a point that is no point, or places for some of the drawn ones only.
pub(super) fn points_of(
    scenario: &ArmScenario,
    files: &Attachments,
    work_object: &WorkObject,
    reach: (Vector3<f64>, f64),
    fits: impl Fn(&Isometry3<f64>) -> bool,
) -> Result<Vec<CellPoint>, Mistake> {
    let task = &scenario.task;
    let (base_from_points, usual) = frame_of_points(scenario, work_object)?;
    let point = |index: usize, given: &CloudPoint| {
        let key = format!("task.points[{index}]");
        let finite = given.mm.iter().all(|mm| mm.is_finite() && mm.abs() <= FARTHEST_MM);
        if !finite {
            let bound = format!("three numbers of mm, at most {FARTHEST_MM} from the origin");
            return Err(Mistake { key, value: format!("{:?}", given.mm), bound });
        }
        let turn = given.q1_q4.map_or(Ok(usual), |q| unit_quaternion_of("q1_q4", q)).map_err(|e| wrong(&key, e))?;
        let pose = base_from_points * at(Vector3::from(given.mm) * 1e-3, turn);
        Ok(CellPoint { pose, configuration: given.configuration })
    };
    match &task.points {
        PointsSource::File(_) => {
            let cloud = files.cloud(&task.points).unwrap_or_default();
            cloud.iter().enumerate().map(|(index, given)| point(index, given)).collect()
        }
        PointsSource::List(list) => {
            let mut seen = HashSet::new();
            // Adding zero makes −0 the 0 that it equals.
            let mut again = |mm: &[f64; 3]| !seen.insert(mm.map(|x| (x + 0.0).to_bits()));
            if let Some((index, mm)) = list.iter().enumerate().find(|(_, mm)| again(mm)) {
                let bound = "a point that the list has not before: programs tell points apart by where they are";
                let key = format!("task.points[{index}]");
                return Err(Mistake { key, value: format!("{mm:?}"), bound: bound.into() });
            }
            let bare = |mm: &[f64; 3]| CloudPoint { mm: *mm, q1_q4: None, configuration: None };
            list.iter().enumerate().map(|(index, mm)| point(index, &bare(mm))).collect()
        }
        PointsSource::Drawn(drawn) => draw(scenario.seed, drawn, base_from_points.rotation * usual, reach, fits),
    }
}

fn wrong(key: &str, error: ArmError) -> Mistake {
    Mistake { key: key.into(), value: error.value, bound: error.bound }
}

/// The frame that points are given in, and how those are turned that do not say it.
///
/// base_from_points is the identity (`base`), the work object's frame (`wobj`), or base_from_world (`world`), the
/// inverse of where the base stands in the world. A default orientation that is no quaternion is a mistake whatever
/// the points say.
fn frame_of_points(
    scenario: &ArmScenario,
    work_object: &WorkObject,
) -> Result<(Isometry3<f64>, UnitQuaternion<f64>), Mistake> {
    let given = &scenario.task.points_in;
    let usual = unit_quaternion_of("q1_q4_default", given.q1_q4_default)
        .map_err(|error| wrong("task.points_in.q1_q4_default", error))?;
    let base_from_points = match given.frame {
        PointsFrame::Base => Isometry3::identity(),
        PointsFrame::Wobj => work_object.base_from_object(),
        PointsFrame::World => frame_of("world.base_frame", &scenario.world.base_frame)?.inverse(),
    };
    Ok((base_from_points, usual))
}

/// `count` of the poses that points are drawn from, whether or not the arm can stand there.
///
/// From a stream of their own, `places`: what they tell does not depend on how many points were drawn. Empty where
/// the points have no frame.
pub(super) fn places(
    scenario: &ArmScenario,
    work_object: &WorkObject,
    (centre, radius): (Vector3<f64>, f64),
    count: usize,
) -> Vec<Isometry3<f64>> {
    let Ok((base_from_points, usual)) = frame_of_points(scenario, work_object) else { return Vec::new() };
    let mut random = stream(named_seed(scenario.seed, "places", 0));
    let turn = base_from_points.rotation * usual;
    (0..count).map(|_| at(centre + in_ball(&mut random) * radius, turn)).collect()
}

/// Beyond this no arm reaches, and numbers are likely to be of another unit.
const FARTHEST_MM: f64 = 50_000.0;

fn at(place: Vector3<f64>, turn: UnitQuaternion<f64>) -> Isometry3<f64> {
    Isometry3::from_parts(Translation3::from(place), turn)
}

/// Uniform in the ball, those that fit; none where none of so many draws fits.
///
/// Given up after [`DRAWS`] further places of which none fits: an error where there are some points, an empty list,
/// which the graph then explains, where there is none.
///
/// ```text
/// p = centre + radius · u,  u uniform in the unit ball;  kept where `fits`
/// ```
///
/// By rejection, from the stream `points` of the scenario's seed or of `seed` beside the count: the kept ones are
/// uniform in the part of the ball where the arm can stand. All have one orientation, `turn` in the base frame. Cost
/// is one `fits` a draw, which in joint mode follows moves from and to home.
fn draw(
    seed: u64,
    drawn: &DrawnPoints,
    turn: UnitQuaternion<f64>,
    (centre, radius): (Vector3<f64>, f64),
    fits: impl Fn(&Isometry3<f64>) -> bool,
) -> Result<Vec<CellPoint>, Mistake> {
    let mut random = stream(named_seed(drawn.seed.unwrap_or(seed), "points", 0));
    let mut points = Vec::with_capacity(drawn.count as usize);
    let mut left = DRAWS;
    while (points.len() as u64) < drawn.count {
        let pose = at(centre + in_ball(&mut random) * radius, turn);
        if fits(&pose) {
            points.push(CellPoint { pose, configuration: None });
            left = DRAWS;
        } else if left == 0 && points.is_empty() {
            // Not the count is at fault: the search tells that nothing is feasible, and why.
            return Ok(points);
        } else if left == 0 {
            return Err(Mistake {
                key: "task.points.count".into(),
                value: drawn.count.to_string(),
                bound: format!(
                    "{} at most: {DRAWS} further draws found no place where the arm can stand",
                    points.len()
                ),
            });
        } else {
            left -= 1;
        }
    }
    Ok(points)
}

/// Uniform in the unit ball: r³ and cos θ are uniform.
///
/// r = ∛u₁, cos θ = 2u₂ − 1, φ = 2πu₃.
fn in_ball(random: &mut Stream) -> Vector3<f64> {
    let radius = libm::cbrt(unit(random));
    let height = 2.0 * unit(random) - 1.0;
    let (sin, cos) = libm::sincos(TAU * unit(random));
    let across = (1.0 - height * height).max(0.0).sqrt();
    Vector3::new(across * cos, across * sin, height) * radius
}
