//! What a log holds, before anything is judged by it.

use std::path::Path;

use hairpin::judgement::Swiftness;
use hairpin_formats::logs::{self, EventKind, LogFrame, Logged};

use crate::Problem;
use crate::judge_log::{Cut, SourceTold, clock_words, cut, due_alone};

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
        let logged = logs::read(file).map_err(Problem::input)?;
        let anything = Swiftness { speed: None, acceleration: None };
        let due = due_alone(&logged);
        let mut motions: Vec<_> = logged.motions.iter().collect();
        motions.sort_by_key(|motion| (motion.samples.len() < 2, motion.source));
        let motions = motions.into_iter().map(|motion| ReadMotion {
            source: SourceTold::of(&logged, motion),
            span_s: [motion.samples.first(), motion.samples.last()].map(|end| end.map_or(0.0, |sample| sample.t_s)),
            cuts: cut(&motion.samples, (motion, due), &logged.dropouts, &anything).cuts,
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
