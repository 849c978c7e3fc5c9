//! What a log holds, before anything is judged by it.

use std::path::Path;

use hairpin::judgement::Swiftness;
use hairpin_formats::controller_log;
use hairpin_formats::logs::{self, EventKind, LogFrame, Logged};
use hairpin_formats::quote::shell_word;

use crate::Problem;
use crate::judge_log::{Cut, SourceTold, Unsound, clock_words, cut, due_alone};

/// A log that was read.
#[derive(Debug)]
pub struct ReadLog {
    /// As read.
    pub logged: Logged,
    /// Whose stamps the times are.
    pub clock: &'static str,
    /// The frame of positions.
    pub frame: String,
    /// Its motions: the one that is judged unless another is asked for goes first.
    pub motions: Vec<ReadMotion>,
}

/// A motion in a log.
#[derive(Debug)]
pub struct ReadMotion {
    /// Where it is from.
    pub source: SourceTold,
    /// From when to when, s.
    pub span_s: [f64; 2],
    /// What of it is no motion, or was not recorded, up to the first jump that it announces: after that nothing would
    /// be judged. Jumps that it does not announce show only beside a robot, whose speed says what none is.
    pub cuts: Vec<Cut>,
}

impl ReadLog {
    /// # Errors
    /// As of [`logs::read`].
    pub(super) fn of(file: &Path) -> Result<Self, Problem> {
        let logged = logs::read(file).map_err(|error| match controller_log::is_headed(file) {
            true => Problem::input(format!("{error}. {}", arms(file))),
            false => Problem::input(error),
        })?;
        let anything = Swiftness { speed: None, acceleration: None };
        let due = due_alone(&logged);
        let mut motions: Vec<_> = logged.motions.iter().collect();
        motions.sort_by_key(|motion| (motion.samples.len() < 2, motion.source));
        let motions = motions.into_iter().map(|motion| ReadMotion {
            source: SourceTold::of(&logged, motion),
            span_s: [motion.samples.first(), motion.samples.last()].map(|end| end.map_or(0.0, |sample| sample.t_s)),
            cuts: cut(
                &motion.samples,
                Unsound { resets: &motion.resets, invalid: &motion.invalid, dropouts: &logged.dropouts },
                due,
                &anything,
            )
            .cuts,
        });
        let motions = motions.collect();
        let frame = match &logged.frame {
            LogFrame::Untold => "not told".into(),
            LogFrame::Enu(None) => "east, north, up".into(),
            LogFrame::Enu(Some(at)) => {
                format!("east, north, up about {:.7}°, {:.7}°, {:.2} m AMSL", at.lat_deg, at.lon_deg, at.alt_amsl_m)
            }
            LogFrame::Named(name) => format!("`{}`", name.escape_default()),
        };
        Ok(Self { clock: clock_words(logged.clock), frame, motions, logged })
    }

    /// Whether something is found that a judgement would cut out or end at.
    pub fn has_findings(&self) -> bool {
        let ends = |kind| matches!(kind, EventKind::Failsafe | EventKind::Geofence);
        let unfit = |name: &str| self.logged.motions.iter().any(|own| own.name == name && own.unfit.is_some());
        self.motions.first().is_some_and(|judged| !judged.cuts.is_empty() || unfit(&judged.source.topic))
            || self.logged.events.iter().any(|event| ends(event.kind))
    }
}

/// Who reads the log of an arm, whose units and decimal commas are its own, and whose places may need its joints.
fn arms(file: &Path) -> String {
    let name = file.display().to_string();
    let file = shell_word(&name);
    format!(
        "Its columns are those of an arm's log: hairpin judge {file} --campaign OUT reads it, by the arm and the \
         program of a campaign"
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn who_reads_an_arms_log_is_told() {
        let place = tempfile::tempdir().unwrap();
        let refused = |name: &str, text: &str| {
            let file = place.path().join(name);
            std::fs::write(&file, text).unwrap();
            ReadLog::of(&file).unwrap_err().to_string()
        };
        let degrees =
            "t_s,axis_1_deg,axis_2_deg,axis_3_deg,axis_4_deg,axis_5_deg,axis_6_deg\n0,1,2,3,4,5,6\n1,1,2,3,4,5,7\n";
        let commas = "t_s;q1_rad;q2_rad;q3_rad;q4_rad;q5_rad;q6_rad\n0;0,1;0;0;0;0,5;0\n1;0,2;0;0;0;0,5;0\n";
        for (name, text) in [("degrees.csv", degrees), ("commas.csv", commas)] {
            let told = refused(name, text);
            assert!(told.contains(&format!("{name} --campaign OUT reads it")), "{told}");
        }
        let none = refused("none.csv", "t_s,a\n0,1\n1,2\n");
        assert!(!none.contains("--campaign"), "{none}");
    }
}
