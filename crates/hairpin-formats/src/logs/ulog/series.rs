//! What was subscribed to, and the motions that come of it.

use std::collections::BTreeMap;

use super::super::attitude::Attitudes;
use super::super::log::{LoggedMotion, Source};
use super::formats::{Size, Slot};
use super::heard::Heard;
use super::mission::Topic;
use super::odometry::Odometry;
use super::position::Positions;
use super::selector::{self, Selector};
use super::topic::Finder;
use crate::frames::Geodetic;

/// One subscription.
#[derive(Debug)]
pub(super) struct Series {
    pub(super) name: String,
    pub(super) instance: u8,
    pub(super) size: Size,
    pub(super) stamp: Slot,
    pub(super) heard: Heard,
    pub(super) what: What,
}

#[derive(Debug)]
pub(super) enum What {
    Positions(Source, Box<Positions>),
    Odometry(Source, Box<Odometry>),
    Attitudes {
        slots: [Slot; 4],
        sample: Option<Slot>,
        read: Attitudes,
    },
    Flown(Topic),
    /// Which instance of the estimates it flew by.
    Chosen(Selector),
    /// Says nothing of motion.
    Other,
}

impl What {
    /// What a topic of this name is read for.
    pub(super) fn of(name: &str, finder: &Finder) -> Result<Self, String> {
        Ok(match name {
            "vehicle_local_position" => Self::Positions(Source::Estimate, Positions::of(finder)?.into()),
            "vehicle_local_position_groundtruth" => Self::Positions(Source::GroundTruth, Positions::of(finder)?.into()),
            "vehicle_mocap_odometry" => Self::Odometry(Source::MotionCapture, Odometry::of(finder)?.into()),
            "vehicle_visual_odometry" => Self::Odometry(Source::Input, Odometry::of(finder)?.into()),
            "vehicle_attitude" | "vehicle_attitude_groundtruth" => {
                let slots = finder.array("q", [""; 4]).ok_or_else(|| format!("`{name}` has no field `q`"))?;
                Self::Attitudes { slots, sample: finder.slot("timestamp_sample"), read: Attitudes::default() }
            }
            selector::TOPIC => Selector::of(finder).map_or(Self::Other, Self::Chosen),
            _ => Topic::of(name, finder)?.map_or(Self::Other, Self::Flown),
        })
    }
}

impl Series {
    pub(super) fn source(&self) -> Option<Source> {
        match &self.what {
            What::Positions(source, _) | What::Odometry(source, _) => Some(*source),
            _ => None,
        }
    }

    pub(super) fn is_empty(&self) -> bool {
        match &self.what {
            What::Positions(_, positions) => positions.is_empty(),
            What::Odometry(_, odometry) => odometry.is_empty(),
            _ => true,
        }
    }

    pub(super) fn reference(&self) -> Option<Geodetic> {
        match &self.what {
            What::Positions(_, positions) => positions.reference(),
            _ => None,
        }
    }

    /// The topic's name, with its instance where it is not the first.
    fn told(&self) -> String {
        if self.instance == 0 { self.name.clone() } else { format!("{}[{}]", self.name, self.instance) }
    }
}

/// Positions with the attitudes of their own source and instance beside them.
pub(super) fn motions(series: Vec<Series>, origin: Option<Geodetic>, notes: &mut Vec<String>) -> Vec<LoggedMotion> {
    let mut attitudes = BTreeMap::new();
    let (mut moved, mut chosen) = (Vec::new(), Vec::new());
    // Why nothing is to be judged by what hangs on a selector or a mission's state that is there twice.
    let (mut unchosen, mut unflown) = (None, None);
    for series in series {
        let name = series.told();
        let unfit = series.heard.unfit().filter(|_| !matches!(series.what, What::Other));
        notes.extend(unfit.iter().map(|why| format!("{name}: {why}")));
        let key = (series.name, series.instance);
        match series.what {
            What::Attitudes { read, .. } if !read.is_empty() => drop(attitudes.insert(key, (read, unfit))),
            What::Positions(source, positions) if !positions.is_empty() => {
                let (motion, told) = positions.motion(&name, source, origin);
                notes.extend(told);
                moved.push((LoggedMotion { unfit: unfit.or(motion.unfit), ..motion }, key.1));
            }
            What::Chosen(selector) if key.1 == 0 => {
                chosen = selector.into_chosen();
                unchosen = unfit.map(|why| format!("{name}: {why}"));
            }
            What::Flown(_) if key.1 == 0 => unflown = unflown.or(unfit.map(|why| format!("{name}: {why}"))),
            What::Odometry(source, odometry) => {
                if origin.is_some() && !odometry.is_empty() {
                    notes.push(format!("{name}: about a point of its own, which is nowhere on Earth"));
                }
                let (motion, told) = odometry.motion(&name, source);
                notes.extend(told);
                moved.extend(motion.map(|motion| (LoggedMotion { unfit: unfit.or(motion.unfit), ..motion }, key.1)));
            }
            _ => {}
        }
    }
    for (motion, instance) in &mut moved {
        let own = unchosen.as_ref().filter(|_| motion.source == Source::Estimate).or(unflown.as_ref());
        motion.unfit = motion.unfit.take().or_else(|| own.cloned());
        let topic = match motion.source {
            Source::GroundTruth => "vehicle_attitude_groundtruth",
            Source::Estimate if motion.name.starts_with("vehicle_local") => "vehicle_attitude",
            _ => continue,
        };
        let beside = [*instance, 0].iter().find_map(|instance| attitudes.get(&(topic.to_owned(), *instance)));
        if let Some((beside, unfit)) = beside {
            let turns = beside.at(motion.samples.iter().map(|sample| sample.t_s));
            motion.samples.iter_mut().zip(turns).for_each(|(sample, turn)| sample.attitude = turn);
            motion.unfit = motion.unfit.take().or_else(|| unfit.as_ref().map(|why| format!("{topic}: {why}")));
        } else {
            notes.push(format!("{}: no `{topic}` beside it", motion.name));
        }
    }
    selector::settle(&chosen, &mut moved, notes);
    moved.into_iter().map(|(motion, _)| motion).collect()
}
