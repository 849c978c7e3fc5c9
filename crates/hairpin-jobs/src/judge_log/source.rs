//! Where a log's poses and times are from: chosen by rank, named, and no other is mixed in.

use hairpin_formats::logs::{Clock, Logged, LoggedMotion, Source};

use super::asks::Asks;
use crate::Problem;

/// Where a log's poses and times are from.
#[derive(Debug, Clone, PartialEq)]
pub struct SourceTold {
    /// The log's format.
    pub format: &'static str,
    /// The topic.
    pub topic: String,
    /// Who says where the robot was: `motion capture`, `ground truth`, `EKF2 estimate`, `visual odometry, an input of
    /// EKF2`, `source not told`.
    pub words: &'static str,
    /// Whether it says how accurate it is.
    pub has_accuracy: bool,
    /// Other topics with poses.
    pub others: Vec<String>,
    /// Whose stamps the times are.
    pub clock: &'static str,
    /// Samples.
    pub samples: usize,
    /// Samples a second, by the middle interval.
    pub rate_hz: f64,
}

/// The motion that is judged: the one of the topic asked for, else the only one of the best rank ([`best`]).
///
/// # Errors
/// There is none, none of that name or several, none that is known to be what moved, or that one is at two places at
/// one moment.
pub(super) fn choose<'a>(logged: &'a Logged, asked: Option<&str>) -> Result<(&'a LoggedMotion, SourceTold), Problem> {
    let motion = match asked {
        Some(topic) => {
            let mut all = logged.motions.iter().filter(|motion| motion.name == topic);
            let named = all.next().ok_or_else(|| {
                let names = names(&logged.motions);
                Problem::input(format!("--source {topic}: the log has no poses of that topic; it has {names}"))
            })?;
            if all.next().is_some() {
                return Err(Problem::input(format!(
                    "--source {topic}: the log has several channels of that topic, and nothing tells which of them moved"
                )));
            }
            fit(named).map_err(Problem::input)?
        }
        None => best(logged, &Asks::JUDGE).map_err(Problem::input)?,
    };
    Ok((motion, SourceTold::of(logged, motion)))
}

/// The motion of the best rank: motion capture, ground truth, the vehicle's own estimate, what that takes in, in the
/// log's own order; of
/// topics that do not tell who says so the only one, and no plan, way, goal or command.
///
/// # Errors
/// In a sentence: no motion of two samples; several of which none is known to be what moved, or none that by its type
/// and name did; one that is at two places at one moment.
pub(crate) fn best<'a>(logged: &'a Logged, asks: &Asks) -> Result<&'a LoggedMotion, String> {
    let usable = || logged.motions.iter().filter(|motion| motion.samples.len() >= 2);
    let first = usable().min_by_key(|motion| motion.source).ok_or_else(|| {
        let joints = if logged.joints.is_empty() { "" } else { "; its joints are judged against an arm's campaign" };
        format!("a {} log without two poses{joints}", logged.format)
    })?;
    if first.source > Source::Untold {
        let names = names(usable());
        let topic = asks.topic;
        return Err(format!(
            "nothing in it is known to have moved: {names} may be a plan, a goal or a command; {topic}"
        ));
    }
    if first.source == Source::Untold && usable().filter(|motion| motion.source == first.source).count() > 1 {
        let names = names(usable().filter(|motion| motion.source == first.source));
        return Err(format!("several topics may be what moved: {names}; {}", asks.topic));
    }
    fit(first)
}

/// Refuses a motion that nothing is to be judged by.
fn fit(motion: &LoggedMotion) -> Result<&LoggedMotion, String> {
    motion.unfit.as_ref().map_or(Ok(motion), |why| Err(format!("{}: {why}", motion.name)))
}

fn names<'a>(motions: impl IntoIterator<Item = &'a LoggedMotion>) -> String {
    motions.into_iter().map(|motion| motion.name.as_str()).collect::<Vec<_>>().join(", ")
}

/// Whose stamps times are.
pub(crate) fn clock_words(clock: Clock) -> &'static str {
    match clock {
        Clock::SinceBoot => "since the vehicle's boot",
        Clock::Header => "of the messages' headers",
        Clock::Receive => "of the recorder, when it received the messages",
        Clock::File => "of the file's first column",
    }
}

fn words(source: Source, format: &str) -> &'static str {
    match (source, format) {
        (Source::MotionCapture, _) => "motion capture",
        (Source::GroundTruth, _) => "ground truth",
        (Source::Estimate, "PX4 ULog") => "EKF2 estimate",
        (Source::Estimate, "ArduPilot DataFlash") => "EKF estimate",
        (Source::Estimate, _) => "estimate",
        (Source::Input, "PX4 ULog") => "visual odometry, an input of EKF2",
        (Source::Input, _) => "an input of the estimate",
        (Source::Untold, _) => "source not told",
        (Source::Way, _) => "a whole way, of a plan or a trail",
        (Source::Asked, _) => "by its name a plan, goal or command",
    }
}

impl SourceTold {
    /// Where `motion`, one of `logged`, is from.
    pub(crate) fn of(logged: &Logged, motion: &LoggedMotion) -> Self {
        let others = logged.motions.iter().filter(|other| other.name != motion.name);
        let mut spans: Vec<f64> = motion.samples.windows(2).map(|pair| pair[1].t_s - pair[0].t_s).collect();
        spans.sort_unstable_by(f64::total_cmp);
        let middle = spans.get(spans.len() / 2).copied().unwrap_or(f64::INFINITY);
        Self {
            format: logged.format,
            topic: motion.name.clone(),
            words: words(motion.source, logged.format),
            has_accuracy: motion.samples.iter().any(|sample| sample.accuracy_m.is_some()),
            others: others.map(|other| other.name.clone()).collect(),
            clock: clock_words(logged.clock),
            samples: motion.samples.len(),
            rate_hz: 1.0 / middle,
        }
    }

    /// As it stands in the sentence: an estimate that does not say how good it is is named there.
    pub(super) fn in_sentence(&self) -> String {
        match self.words {
            words if self.has_accuracy => words.into(),
            "source not told" => "neither source nor accuracy told".into(),
            words if words.contains("estimate") || words.contains("an input") => format!("{words} without accuracy"),
            words => words.into(),
        }
    }
}
