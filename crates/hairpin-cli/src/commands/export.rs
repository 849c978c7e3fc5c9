//! `hairpin export`: a campaign's trajectories as files that other programs open.

use hairpin::campaign::CaseNumber;
use hairpin_formats::qgc::mission as qgc;
use hairpin_jobs::Problem;
use hairpin_jobs::export::{self, ExportSettings, Language, MissionFile, Which, Written};
use serde_json::json;

use crate::args::{Autopilot, Export, Format};
use crate::console;
use crate::exit::DONE;

/// Runs the command: 0 when everything is written that there is to write.
pub(crate) fn run(asked: &Export) -> Result<u8, Problem> {
    let campaign = export::Export::open(&ExportSettings {
        folder: asked.folder.clone(),
        which: which(asked),
        autopilot: match asked.autopilot {
            Autopilot::Px4 => qgc::Autopilot::Px4,
            Autopilot::Ardupilot => qgc::Autopilot::ArduPilot,
        },
        accept_excursion: asked.accept_excursion,
    })?;
    let mut formats = Vec::new();
    let mut all = Written::default();
    let mut take = |written: Written, (word, programs): (&str, &str)| {
        let count = written.files.len();
        formats.push(json!({ "format": word, "files": count, "opened_by": programs }));
        let told: Vec<String> = written.told.into_iter().filter(|line| !all.told.contains(line)).collect();
        if !asked.json {
            written.files.iter().for_each(|path| console::say(&path.display().to_string()));
            told.iter().for_each(|line| console::say(line));
            console::warn(&format!("{count} files {word}, opened by {programs}"));
        }
        all.files.extend(written.files);
        all.level.extend(written.level);
        all.missing.extend(written.missing);
        all.told.extend(told);
    };
    for format in &asked.to {
        take(campaign.write(of_job(*format))?, of_format(*format));
    }
    if let Some(count) = asked.flights {
        take(campaign.write_day_card(count as usize)?, ("day-card", "browsers, to be printed: a page a flight"));
    }
    if let Some(first) = all.level.first() {
        console::warn(&format!(
            "Warning: the attitude is unknown in {} files, such as {}: its columns say level",
            all.level.len(),
            first.display()
        ));
    }
    for why in &all.missing {
        console::warn(&format!("Warning: {why}"));
    }
    if asked.json {
        let object = json!({
            "exit_code": DONE, "formats": formats, "files": all.files, "attitude_unknown": all.level,
            "missing": all.missing, "told": all.told,
        });
        console::say(&object.to_string());
    }
    Ok(DONE)
}

/// The cases that were asked for.
fn which(asked: &Export) -> Which {
    match asked.worst {
        Some(count) => Which::Worst(count as usize),
        None if asked.case.is_empty() => Which::All,
        None => Which::Named(asked.case.iter().copied().map(CaseNumber).collect()),
    }
}

/// The format as the job knows it.
fn of_job(format: Format) -> export::Format {
    match format {
        Format::Waypoints => export::Format::Waypoints,
        Format::Geodetic => export::Format::Geodetic,
        Format::Csv => export::Format::Csv,
        Format::Rapid => export::Format::Program(Language::Rapid),
        Format::Urscript => export::Format::Program(Language::Urscript),
        Format::Krl => export::Format::Program(Language::Krl),
        Format::JointTrajectory => export::Format::Program(Language::JointTrajectory),
        Format::ArcClock => export::Format::ArcClock,
        Format::Tum => export::Format::Tum,
        Format::Mcap => export::Format::Mcap,
        Format::McapRos2 => export::Format::McapRos2,
        Format::Plan => export::Format::Mission(MissionFile::Plan),
        Format::Wpl => export::Format::Mission(MissionFile::Wpl),
        Format::Setpoints => export::Format::Setpoints,
        Format::Poly4d => export::Format::Poly4d,
    }
}

/// The format's word, and who opens its files.
fn of_format(format: Format) -> (&'static str, &'static str) {
    match format {
        Format::Waypoints => ("waypoints", "`hairpin execute OUT --missions DIR` and spreadsheets"),
        Format::Geodetic => ("geodetic", "spreadsheets and geographic information systems"),
        Format::Rapid => ("rapid", "RobotStudio and ABB controllers: load CASE.pgf or CASE.mod, run CASE_slow first"),
        Format::Urscript => ("urscript", "Universal Robots controllers and URSim"),
        Format::Krl => ("krl", "KUKA controllers and OfficeLite"),
        Format::JointTrajectory => ("joint-trajectory", "ROS 2: `ros2 topic pub` and joint_trajectory_controller"),
        Format::ArcClock => {
            ("arc-clock", "ABB controllers: run clock_arcs, then `hairpin import arc_ms.log` makes arc_ms.csv")
        }
        Format::Csv => ("csv", "spreadsheets, pandas, PlotJuggler"),
        Format::Tum => ("tum", "evo: `evo_ape tum CASE.ref.tum CASE.exec.tum`, never with --align"),
        Format::Mcap => ("mcap", "Foxglove"),
        Format::McapRos2 => ("mcap-ros2", "`ros2 bag play -s mcap`, RViz, PlotJuggler, rosbags"),
        Format::Plan => {
            ("plan", "QGroundControl: Plan, File, Open; then Parameters, Tools, Load from file: CASE.params")
        }
        Format::Wpl => ("wpl", "Mission Planner, MAVProxy, pymavlink; CASE.params by QGroundControl"),
        Format::Setpoints => ("setpoints", "a companion computer that streams SET_POSITION_TARGET_LOCAL_NED"),
        Format::Poly4d => {
            ("poly4d", "cflib scripts and Crazyswarm: CASE.poly4d.csv; the trajectory memory: CASE.poly4d.bin")
        }
    }
}
