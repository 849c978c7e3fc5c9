//! `hairpin export`: a campaign's trajectories as files that other programs open.

use hairpin::campaign::CaseNumber;
use hairpin_jobs::Problem;
use hairpin_jobs::export::{self, Language, Which, Written};
use serde_json::json;

use crate::args::{Export, Format};
use crate::console;
use crate::exit::DONE;

/// Runs the command: 0 when everything is written that there is to write.
pub(crate) fn run(asked: &Export) -> Result<u8, Problem> {
    let campaign = export::Export::open(&asked.folder, &which(asked))?;
    let mut formats = Vec::new();
    let mut all = Written::default();
    for format in &asked.to {
        let written = campaign.write(of_job(*format))?;
        let (count, (word, programs)) = (written.files.len(), of_format(*format));
        formats.push(json!({ "format": word, "files": count, "opened_by": programs }));
        if !asked.json {
            written.files.iter().for_each(|path| console::say(&path.display().to_string()));
            console::warn(&format!("{count} files {word}, opened by {programs}"));
        }
        all.files.extend(written.files);
        all.level.extend(written.level);
        all.missing.extend(written.missing);
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
            "missing": all.missing,
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
    }
}
