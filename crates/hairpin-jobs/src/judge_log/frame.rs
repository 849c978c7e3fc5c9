//! From a log's frame to the world's: by places on Earth where both have one, by what the user names, and by nothing
//! else.

use hairpin::math::rotation::from_rotation_vector;
use hairpin_formats::frames::Geodetic;
use hairpin_formats::logs::{LogFrame, Progress, Sample};
use hairpin_formats::placement::Placement;
use nalgebra::{Isometry3, Matrix3, Point3, Rotation3, UnitQuaternion, Vector3};

use crate::Problem;

/// Which altitude of the log is the world's.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Altitude {
    /// Heights above the log's own origin are heights in the world; of a world that is a map of the Earth's, whose
    /// heights are above the sea themselves, as `Amsl`.
    #[default]
    Relative,
    /// Heights above the sea are, as the log's origin and the world's have them.
    Amsl,
}

/// What is done to a log's frame by name.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct FrameSettings {
    /// Turned by this about z first, ° counter-clockwise seen from above.
    pub turn_deg: f64,
    /// Then moved by this, m.
    pub offset_m: [f64; 3],
    /// Which altitude counts.
    pub altitude: Altitude,
}

/// A log's frame, and what was done to it.
#[derive(Debug, Clone, PartialEq)]
pub struct FrameTold {
    /// The log's own, in words.
    pub log: String,
    /// How that became the world's, in words.
    pub how: String,
    /// Whether both say where on Earth they are, so that nothing is assumed but for altitudes.
    pub by_earth: bool,
    /// Whether heights are those of the map's ground, for the log of what drives has none.
    pub heights_by_map: bool,
    /// Altitude of the log's origin above the world's by what both say, m: AMSL less AMSL, however far apart they are.
    pub altitude_difference_m: Option<f64>,
    /// Whether it was added.
    pub altitude_applied: bool,
    /// What was named.
    pub named: FrameSettings,
}

/// From a log's frame to the world's.
pub(crate) struct IntoWorld<'a> {
    how: How<'a>,
    named: Isometry3<f64>,
    /// Subtracted from heights.
    lower: f64,
    /// What is told of it.
    pub(crate) told: FrameTold,
}

enum How<'a> {
    /// Rigidly.
    Rigid(Isometry3<f64>),
    /// Point by point, through the Earth; directions by a turn.
    Plane(Placement, &'a Placement, UnitQuaternion<f64>),
}

impl<'a> IntoWorld<'a> {
    /// From `frame` to the world at `place`.
    ///
    /// # Errors
    /// A log far outside of what the world's plane can show; heights above the sea, where one of both has none.
    pub(crate) fn of(frame: &LogFrame, place: Option<&'a Placement>, named: &FrameSettings) -> Result<Self, Problem> {
        let mut told = FrameTold {
            log: in_words(frame),
            how: String::new(),
            by_earth: false,
            heights_by_map: false,
            altitude_difference_m: None,
            altitude_applied: false,
            named: *named,
        };
        if named.altitude == Altitude::Amsl {
            above_the_sea(frame, place)?;
        }
        let mut lower = 0.0;
        let how = match (frame, place) {
            (LogFrame::Enu(Some(origin)), Some(world)) => {
                let log = Placement::about(origin);
                let (at, turn) = tangent(&log, world)?;
                let is_plane = matches!(world, Placement::Plane(_));
                told.by_earth = true;
                // Not the height over the world's plane, which the Earth falls below with the distance.
                let difference = world.relative_altitude(origin);
                told.altitude_difference_m = Some(difference);
                told.altitude_applied = is_plane || named.altitude == Altitude::Amsl;
                lower = if told.altitude_applied { 0.0 } else { difference };
                let by = if is_plane { "the map's plane" } else { "world.origin" };
                let far = at.coords.xy().norm();
                told.how = format!("brought to the world's by {by}: the log's origin is {far:.2} m from the world's");
                if is_plane {
                    How::Plane(log, world, turn)
                } else {
                    How::Rigid(Isometry3::from_parts(at.coords.into(), turn))
                }
            }
            (LogFrame::Enu(None), Some(Placement::Cage(cage))) => {
                told.how = "turned by the heading of world.origin; its origin is taken for the world's".into();
                How::Rigid(cage.from_enu(&hairpin_formats::frames::EnuFlu(Isometry3::identity())))
            }
            (LogFrame::Enu(Some(_)), None) => {
                told.how = "taken for the world's, which is nowhere on Earth (world.origin)".into();
                How::Rigid(Isometry3::identity())
            }
            _ => {
                told.how = "taken for the world's".into();
                How::Rigid(Isometry3::identity())
            }
        };
        let turn = from_rotation_vector(&(Vector3::z() * named.turn_deg.to_radians()));
        let named = Isometry3::from_parts(Vector3::from(named.offset_m).into(), turn);
        Ok(Self { how, named, lower, told })
    }

    /// A point of the log's frame.
    ///
    /// # Errors
    /// It is outside of what the world's plane can show.
    pub(super) fn point(&self, p: &Point3<f64>) -> Result<Point3<f64>, Problem> {
        let at = match &self.how {
            How::Rigid(world_from_log) => world_from_log * p,
            How::Plane(log, world, _) => {
                let place = log.geodetic(p).and_then(|place| world.from_geodetic(&place));
                place.map_err(|why| Problem::input(format!("the log's frame: {why}")))?
            }
        };
        Ok(self.named * (at - Vector3::z() * self.lower))
    }

    fn turn(&self) -> UnitQuaternion<f64> {
        let by_place = match &self.how {
            How::Rigid(world_from_log) => world_from_log.rotation,
            How::Plane(_, _, turn) => *turn,
        };
        self.named.rotation * by_place
    }

    /// A sample of the log's.
    ///
    /// # Errors
    /// As of [`Self::point`].
    pub(crate) fn sample(&self, sample: &Sample) -> Result<Sample, Problem> {
        let turn = self.turn();
        Ok(Sample {
            p_m: self.point(&sample.p_m)?,
            attitude: sample.attitude.map(|attitude| turn * attitude),
            v_m_s: sample.v_m_s.map(|v| turn * v),
            ..*sample
        })
    }

    /// A step of the log's mission.
    ///
    /// # Errors
    /// As of [`Self::point`].
    pub(crate) fn progress(&self, step: &Progress) -> Result<Progress, Problem> {
        Ok(Progress { target_m: step.target_m.map(|target| self.point(&target)).transpose()?, ..*step })
    }
}

/// Where the log's origin is in the world, and how its axes lie there: both are turned rigidly about the Earth's
/// centre, a plane of the map's nearly so.
fn tangent(log: &Placement, world: &Placement) -> Result<(Point3<f64>, UnitQuaternion<f64>), Problem> {
    const FAR: f64 = 100.0;
    let refuse = |why: String| Problem::input(format!("the log's origin: {why}"));
    let image = |p: Point3<f64>| log.geodetic(&p).and_then(|place| world.from_geodetic(&place)).map_err(refuse);
    let at = image(Point3::origin())?;
    let mut axes = Matrix3::identity();
    for axis in 0..3 {
        let mut along = Point3::origin();
        along[axis] = FAR;
        axes.set_column(axis, &((image(along)? - at) / FAR));
    }
    Ok((at, UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix(&axes))))
}

/// Whether both a log's origin and the world's are at an altitude above the sea.
fn above_the_sea(frame: &LogFrame, place: Option<&Placement>) -> Result<(), Problem> {
    let why = match (frame, place) {
        (LogFrame::Enu(Some(_)), Some(_)) => return Ok(()),
        (LogFrame::Enu(Some(_)), None) => "the world does not say where on Earth it is (world.origin)",
        _ => "the log does not say where on Earth it is",
    };
    Err(Problem::input(format!(
        "--altitude amsl: {why}, and so nothing is known of heights above the sea; leave it out"
    )))
}

fn in_words(frame: &LogFrame) -> String {
    match frame {
        LogFrame::Untold => "not told by the log".into(),
        LogFrame::Named(name) => format!("`{}`", hairpin_formats::quote::shortened(name)),
        LogFrame::Enu(None) => "east, north, up about a point that the log does not place on Earth".into(),
        LogFrame::Enu(Some(Geodetic { lat_deg, lon_deg, alt_amsl_m })) => {
            format!("east, north, up about {lat_deg:.7}°, {lon_deg:.7}°, {alt_amsl_m:.2} m AMSL")
        }
    }
}

impl FrameTold {
    /// What of altitudes is not applied, or is, in words.
    pub fn altitude(&self) -> Option<String> {
        let difference = self.altitude_difference_m?;
        let side = if difference < 0.0 { "below" } else { "above" };
        let applied = if self.altitude_applied { "applied" } else { "not applied (--altitude amsl applies it)" };
        Some(format!("the log's origin is {:.2} m {side} the world's by AMSL, {applied}", difference.abs()))
    }

    /// What was named, in words.
    pub fn named(&self) -> Option<String> {
        let FrameSettings { turn_deg, offset_m: [x, y, z], .. } = self.named;
        let turned = (turn_deg != 0.0).then(|| format!("turned by {turn_deg}° (--turn)"));
        let moved = ([x, y, z] != [0.0; 3]).then(|| format!("moved by ({x}, {y}, {z}) m (--offset)"));
        let parts: Vec<String> = turned.into_iter().chain(moved).collect();
        (!parts.is_empty()).then(|| parts.join(", "))
    }
}
