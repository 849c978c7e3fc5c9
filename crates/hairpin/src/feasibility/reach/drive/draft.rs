//! A drive of which some legs are still to be solved: how each waypoint is passed is changed, and only the legs beside
//! it are solved again.

use super::judge::{Commands, Ends, judge, judge_by, refitted};
use super::pace::Pace;
use super::settings::{DriveSettings, DriveSite};
use super::watch::stands;
use super::ways::{Way, ways};
use crate::math::random::{Stream, unit};
use crate::trajectory::drive::Segment;
use crate::trajectory::{Direction, Drive, DriveLeg, Passing, SpeedProfile};

/// Rounds in which commands and their speeds are made to agree.
const ROUNDS: usize = 5;

/// Waypoints as they are passed, in order, and the legs between them as far as they are solved.
///
/// A leg is known as long as how both of its ends are passed stays the same: whoever changes a waypoint has two legs
/// solved, not all. Speeds are settled anew over the whole drive, which solves nothing unless the steering lags.
#[derive(Debug, Clone)]
pub struct DriveDraft {
    passings: Vec<Passing>,
    /// Speeds wished for at the waypoints, m/s; what the first and the last wish for does not count.
    wishes: Vec<f64>,
    /// `None`: to be solved.
    legs: Vec<Option<Commands>>,
}

impl DriveDraft {
    /// Waypoints that are passed as `passings` say, nothing solved yet; speeds are wished for by their numbers and the
    /// settings' seed.
    pub fn new(passings: &[Passing], settings: &DriveSettings) -> Self {
        let wishes = (0..passings.len()).map(|index| settings.wish(index)).collect();
        Self::with_legs(passings.to_vec(), wishes, vec![None; passings.len().saturating_sub(1)])
    }

    /// With `legs` known, one fewer than waypoints.
    pub(super) fn with_legs(passings: Vec<Passing>, wishes: Vec<f64>, legs: Vec<Option<Commands>>) -> Self {
        Self { passings, wishes, legs }
    }

    /// All of `drive`, every leg solved.
    ///
    /// A waypoint wishes for the speed that it is passed with. One that is passed slower than the settings let any wish
    /// (before a turn in place, or where there is no room) wishes as a new one does.
    pub fn of(drive: &Drive, settings: &DriveSettings) -> Self {
        let passings: Vec<Passing> = (0..=drive.legs.len()).filter_map(|index| drive.passing(index)).collect();
        let least = settings.pace.wishes(settings.speed)[0];
        let passed = |index: usize| drive.legs.get(index).map(|leg| leg.speed.start()).filter(|speed| *speed >= least);
        let wishes = (0..passings.len()).map(|k| passed(k).unwrap_or_else(|| settings.wish(k))).collect();
        let known = |leg: &DriveLeg| {
            Some(Commands { way: Way::of(settings, &leg.segments), segments: leg.segments.as_slice().into() })
        };
        Self::with_legs(passings, wishes, drive.legs.iter().map(known).collect())
    }

    /// The first waypoints of this one, `first` of them, and of `other` those that come after as many; the leg that
    /// joins both is to be solved. `None` where one of both has none.
    pub fn spliced(&self, other: &Self, first: usize) -> Option<Self> {
        if first == 0 || first > self.passings.len() || first >= other.passings.len() {
            return None;
        }
        let join = |a: &[Passing], b: &[Passing]| [a, b].concat();
        let wishes = [&self.wishes[..first], &other.wishes[first..]].concat();
        let legs = self.legs[..first - 1].iter().cloned().chain([None]).chain(other.legs[first..].iter().cloned());
        Some(Self::with_legs(join(&self.passings[..first], &other.passings[first..]), wishes, legs.collect()))
    }

    /// How many waypoints there are.
    pub fn waypoints(&self) -> usize {
        self.passings.len()
    }

    /// How waypoint `index` is passed.
    ///
    /// # Panics
    /// If there is no such waypoint.
    pub fn passing(&self, index: usize) -> Passing {
        self.passings[index]
    }

    /// Passes waypoint `index` in another way; the legs beside it are to be solved, unless it is no other way.
    ///
    /// # Panics
    /// If there is no such waypoint.
    pub fn pass(&mut self, index: usize, passing: Passing) {
        if self.passings[index] == passing {
            return;
        }
        self.passings[index] = passing;
        for leg in [index.checked_sub(1), Some(index)].into_iter().flatten() {
            if let Some(known) = self.legs.get_mut(leg) {
                *known = None;
            }
        }
    }

    /// Wishes for another speed at waypoint `index`, m/s.
    ///
    /// # Panics
    /// If there is no such waypoint.
    pub fn wish(&mut self, index: usize, speed: f64) {
        self.wishes[index] = speed;
    }

    /// Whether the body stands within its limits where waypoint `index` is passed: necessary, and cheap to ask.
    ///
    /// # Panics
    /// If there is no such waypoint.
    pub fn stands(&self, site: &DriveSite, settings: &DriveSettings, index: usize) -> bool {
        stands(site, settings, &self.passings[index].at).is_ok()
    }

    /// Solves leg number `leg` by a way of driving that is drawn evenly from all others than its own; `None` where it
    /// is no leg that way, or there is no other.
    pub fn drive_otherwise(
        &mut self,
        site: &DriveSite,
        settings: &DriveSettings,
        leg: usize,
        random: &mut Stream,
    ) -> Option<()> {
        let own = self.legs.get(leg)?.as_ref().map(|known| known.way);
        let others: Vec<Way> = ways(settings).filter(|way| Some(*way) != own).collect();
        let way = *others.get((unit(random) * others.len() as f64) as usize)?;
        let solved = judge_by(site, settings, &self.ends(leg), way).ok()?;
        self.legs[leg] = Some(solved.commands());
        Some(())
    }

    /// The drive, with its speeds, from rest to rest unless the pace is constant. `None` where a leg that was to be
    /// solved is none, or commands and speeds do not settle, which lags of the steering can do.
    ///
    /// At most five rounds of fitting commands to speeds.
    pub fn driven(mut self, site: &DriveSite, settings: &DriveSettings) -> Option<Drive> {
        for leg in 0..self.legs.len() {
            if self.legs[leg].is_some() {
                continue;
            }
            let ends = self.ends(leg);
            let solved = settings.is_a_leg(ends.distance).then(|| judge(site, settings, &ends, &mut 0).ok())??;
            self.legs[leg] = Some(solved.commands());
        }
        let mut legs: Vec<Commands> = self.legs.iter_mut().map(Option::take).collect::<Option<_>>()?;
        let profiles = self.settled(site, settings, &mut legs)?;
        let leg = |(index, (commands, speed)): (usize, (Commands, SpeedProfile))| {
            let [from, to] = [self.passings[index], self.passings[index + 1]];
            DriveLeg {
                from: from.at,
                to: to.at,
                segments: commands.segments.into_vec(),
                speed,
                direction: Direction { start: from.direction, end: to.direction },
            }
        };
        let legs = legs.into_iter().zip(profiles).enumerate().map(leg).collect();
        Some(Drive { legs, speed: settings.speed, turn_rate: settings.turn_rate })
    }

    /// The speeds of `legs`, whose commands are fitted to them where the steering lags: other commands stop elsewhere,
    /// and so it goes on until nothing changes. `None` if that does not come to an end.
    fn settled(&self, site: &DriveSite, settings: &DriveSettings, legs: &mut [Commands]) -> Option<Vec<SpeedProfile>> {
        for _ in 0..ROUNDS {
            let profiles = self.profiles(site, settings, legs);
            if !site.rover.response.lags() || settings.pace == Pace::Constant {
                return Some(profiles);
            }
            let mut changed = false;
            for (leg, (Commands { way, segments }, profile)) in legs.iter_mut().zip(&profiles).enumerate() {
                let other = refitted(site, settings, &self.ends(leg), *way, segments, profile).ok()?;
                changed |= other.is_some();
                *segments = other.unwrap_or_else(|| std::mem::take(segments));
            }
            if !changed {
                return Some(profiles);
            }
        }
        None
    }

    /// The speeds of legs that follow each other from rest to rest.
    fn profiles(&self, site: &DriveSite, settings: &DriveSettings, legs: &[Commands]) -> Vec<SpeedProfile> {
        let last = self.wishes.len().saturating_sub(1);
        let at_rest = |index: usize| index == 0 || index == last;
        let wishes = self.wishes.iter().enumerate().map(|(k, wish)| if at_rest(k) { 0.0 } else { *wish });
        let wishes: Vec<f64> = wishes.collect();
        let segments: Vec<&[Segment]> = legs.iter().map(|leg| leg.segments.as_ref()).collect();
        settings.pace.over(settings.speed, &wishes, &segments, &site.rover.response)
    }

    /// What leg number `leg` joins. Nobody asks for its stress, and so the term `random` is none.
    fn ends(&self, leg: usize) -> Ends<'_> {
        let [from, to] = [&self.passings[leg], &self.passings[leg + 1]];
        Ends {
            from: &from.at,
            to: &to.at,
            distance: libm::hypot(to.at.x - from.at.x, to.at.y - from.at.y),
            speeds: [self.wishes[leg], self.wishes[leg + 1]],
            direction: Direction { start: from.direction, end: to.direction },
            random: 0.0,
        }
    }
}
