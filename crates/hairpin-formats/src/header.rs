//! What stands before a judgement: in which frame, from which origin, what is counted. Nothing here is left to guess.

use hairpin::campaign::kind::{FrameWords, Handed};
use hairpin::campaign::scenario::{Origin, Projected};
use hairpin::campaign::{Case, CaseResult, Setup, Tally};
use hairpin::judgement::LegSource;
use serde::Serialize;

use crate::frames::Geodetic;
use crate::placement::Placement;

/// The header of a judgement, in words by [`Header::lines`] and as it stands under `frame` in JSON.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Header {
    /// The cage's origin and heading on Earth; `null` where the scenario does not place it.
    pub origin: Option<Origin>,
    /// The plane of the Earth that the map lies in, where that places it: EPSG code and what is taken off coordinates.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub plane: Option<PlaneWords>,
    /// What the map's plane is called, where its projection is not known.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub unknown_plane: Option<String>,
    /// Where on Earth the first waypoint is.
    pub start: Option<Geodetic>,
    /// What positions and z are relative to: `cage origin` or `map origin`, never a vehicle's local origin or home.
    pub relative_to: &'static str,
    /// Waypoints of a trajectory.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub length: Option<u64>,
    /// Always `waypoints`, both ends included.
    pub length_counts: &'static str,
    /// Always false: tracks are compared as they are.
    pub aligned: bool,
    /// From where the leg being flown is known.
    pub leg_source: LegSources,
    #[serde(skip)]
    frame: FrameWords,
}

/// A plane of the Earth.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct PlaneWords {
    /// Its EPSG code.
    pub epsg: u32,
    /// Easting and northing of x = y = 0.
    pub offset_m: [f64; 2],
}

/// Judged cases by where the leg being flown is known from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
pub struct LegSources {
    /// The executor told it.
    pub executor: usize,
    /// Monotone assignment along the path.
    pub assigned: usize,
}

impl Header {
    /// The header of `results`, of `cases` that were found as `tally` says.
    ///
    /// Missions made elsewhere have as many waypoints as they have, whatever the scenario's task: their length is told
    /// where they have one in common.
    pub fn of(setup: &Setup, (cases, results): (&[Case], &[CaseResult]), tally: &Tally) -> Self {
        let (scenario, Handed { frame, start, .. }) = (&setup.scenario, setup.handed());
        let from = |source: LegSource| {
            results.iter().filter(|r| r.measures.as_ref().is_some_and(|m| m.leg_source == source)).count()
        };
        let mut lengths = cases.iter().map(|case| case.waypoints.len() as u64);
        let in_common = lengths.next().filter(|first| lengths.all(|other| other == *first));
        // A plane that cannot be computed is told where something is to be exported in degrees.
        let world = Placement::of(scenario).ok().flatten();
        let plane = scenario.projected().filter(|_| matches!(world, Some(Placement::Plane(_))));
        Self {
            origin: scenario.origin(),
            plane: plane.map(|Projected { epsg, offset }| PlaneWords { epsg, offset_m: offset }),
            unknown_plane: scenario.unknown_plane().map(str::to_owned),
            start: world.and_then(|world| world.geodetic(&start).ok()),
            relative_to: frame.relative_to,
            frame,
            length: if tally.missions.is_empty() { scenario.length() } else { in_common },
            length_counts: "waypoints",
            aligned: false,
            leg_source: LegSources { executor: from(LegSource::Executor), assigned: from(LegSource::Assigned) },
        }
    }

    /// Label and value.
    pub fn lines(&self) -> Vec<[String; 2]> {
        let line = |label: &str, value: String| [label.to_owned(), value];
        let mut lines = Vec::new();
        let FrameWords { world, axes, nowhere, .. } = self.frame;
        if let Some(nowhere) = nowhere {
            lines.push(line("frame", nowhere.into()));
            self.told_for_all(&mut lines);
            return lines;
        }
        let placed = |start: &Geodetic| {
            line("start", format!("{:.7}°, {:.7}°, {:.2} m AMSL", start.lat_deg, start.lon_deg, start.alt_amsl_m))
        };
        match (&self.origin, &self.plane, &self.start) {
            (None, Some(PlaneWords { epsg, offset_m: [east, north] }), Some(start)) => {
                lines.push(line("frame", format!("{world}: {axes}, z up, m, in the plane of EPSG:{epsg}")));
                lines.push(line(self.relative_to, format!("easting {east} m, northing {north} m, height 0")));
                lines.push(placed(start));
                lines.push(line("altitude", "z is the map's own height, taken as above mean sea level".into()));
            }
            (Some(origin), _, Some(start)) => {
                lines.push(line(
                    "frame",
                    format!("{world}: x heads {}° by compass, y to its left, z up, m", origin.x_axis_heading_deg),
                ));
                lines.push(line(
                    self.relative_to,
                    format!("{:.7}°, {:.7}° WGS 84, {} m AMSL", origin.lat_deg, origin.lon_deg, origin.alt_amsl_m),
                ));
                lines.push(placed(start));
                lines.push(line(
                    "altitude",
                    format!(
                        "z is relative to the {}; AMSL is {} m more; ellipsoid and geoid are not told apart",
                        self.relative_to, origin.alt_amsl_m
                    ),
                ));
            }
            _ => {
                lines.push(line("frame", format!("{world}: {axes}, z up, m; not placed on Earth (no world.origin)")));
                lines.push(line("altitude", format!("z is relative to the {}; AMSL is not known", self.relative_to)));
            }
        }
        if let Some(name) = &self.unknown_plane {
            let what = format!("{name}, whose projection is not known here: its metres are taken for the ground's");
            lines.push(line("plane", what));
        }
        lines.push(line(
            "origins",
            format!(
                "the {} is neither a vehicle's local origin nor its home: differences are the executor's",
                self.relative_to
            ),
        ));
        self.told_for_all(&mut lines);
        lines
    }

    /// In a line what must be known of every result: the frame, that nothing was aligned, and who told the legs.
    pub fn line(&self) -> String {
        let lines = self.lines();
        let of = |wanted: &str| lines.iter().find(|[label, _]| label == wanted).map_or("", |[_, value]| value.as_str());
        let frame = of("frame").split(';').next().unwrap_or_default();
        let plane = self.unknown_plane.as_ref().map_or(String::new(), |_| format!("; plane: {}", of("plane")));
        format!("frame: {frame}{plane}; {}; leg being flown: {}", of("alignment"), of("leg being flown"))
    }

    /// What counts, whatever the robot.
    fn told_for_all(&self, lines: &mut Vec<[String; 2]>) {
        let line = |label: &str, value: String| [label.to_owned(), value];
        if let Some(length) = self.length {
            lines.push(line("length", format!("{length} counts waypoints, both ends included")));
        }
        lines.push(line("alignment", "not aligned".into()));
        let LegSources { executor, assigned } = self.leg_source;
        lines.push(line(
            "leg being flown",
            match (executor, assigned) {
                (_, 0) => "told by the executor".into(),
                (0, _) => "by monotone assignment along the path".into(),
                _ => format!("told by the executor in {executor} cases, by monotone assignment in {assigned}"),
            },
        ));
    }
}
