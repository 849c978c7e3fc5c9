//! What a vehicle does under a list of mission items: where it is sent, how fast, where it waits, and what of the list
//! is not followed here.

use hairpin::campaign::bounds::{FARTHEST_M, MOST_WAYPOINTS};

use super::item::{Frame, Item, Wrong};
use super::uploaded::{Ending, Open, Station, Uploaded};
use super::words::{self, Effect};
use crate::frames::Geodetic;

/// Waypoints nearer than this are one place, m.
const ONE_PLACE_M: f64 = 0.01;
/// The fastest that a mission may ask for, m/s: faster is another unit.
const FASTEST_M_S: f64 = 1000.0;
/// The longest wait, s.
const LONGEST_S: f64 = 1e6;

/// What is known while items are followed.
struct Following {
    mission: Uploaded,
    speed: Option<f64>,
    /// Whether altitudes matter: on the ground they do not.
    flies: bool,
    took_off: bool,
    /// The item that ended it.
    over: Option<String>,
    /// The condition that what comes before the next place waits for.
    waits: Option<usize>,
    yaws: usize,
}

/// Follows `items` from `home`; altitudes of a vehicle that does not fly are not looked at.
///
/// # Errors
/// What no autopilot would take, or what nobody could follow.
pub(super) fn follow(items: &[Item], home: Geodetic, flies: bool) -> Result<Uploaded, Wrong> {
    let mission = Uploaded { home, stations: Vec::new(), ending: Ending::Stays, notes: Vec::new(), open: Vec::new() };
    let mut following = Following { mission, speed: None, flies, took_off: false, over: None, waits: None, yaws: 0 };
    for item in items {
        following.item(item)?;
    }
    Ok(following.told())
}

impl Following {
    fn item(&mut self, item: &Item) -> Result<(), Wrong> {
        if let Some(over) = &self.over {
            if item.command <= 95 || item.command == 177 {
                let words = format!("item {} (command {}) comes after {over}", item.number, item.command);
                self.open(words);
            }
            return Ok(());
        }
        // Conditions hold back what is done until the next place.
        if item.command <= 95 {
            self.waits = None;
        }
        match item.command {
            16 => {
                let hold = self.hold(item, 1)?;
                let hold = if item.goes_on { hold } else { Some(f64::INFINITY) };
                self.go(item, hold)
            }
            17 => {
                self.go(item, None)?;
                self.over = Some(format!("item {}, where the vehicle stays", item.number));
                Ok(())
            }
            19 => {
                let hold = self.hold(item, 1)?;
                self.go(item, Some(hold.unwrap_or(0.0)))
            }
            20 => {
                self.mission.ending = Ending::Returns;
                self.over = Some(format!("the way home (item {})", item.number));
                Ok(())
            }
            21 => self.land(item),
            22 => self.take_off(item),
            93 => self.wait(item),
            177 => Err(Wrong::new(
                format!("{}command", item.at),
                "177 (jump)",
                "no jump: what is flown twice stands there twice, or is a mission of its own",
            )),
            178 => self.change_speed(item),
            other => {
                self.pass_over(item, words::of(other));
                Ok(())
            }
        }
    }

    /// An item that is not followed.
    fn pass_over(&mut self, item: &Item, (name, effect): (&str, Effect)) {
        let words = format!("item {} (command {}, {name})", item.number, item.command);
        match effect {
            Effect::Harmless => self.mission.notes.push(format!("{words} is passed over")),
            Effect::Delays => {
                self.waits = Some(item.number);
                self.mission.notes.push(format!("{words} is passed over: what waits for it does not move"));
            }
            Effect::Moves => self.open(format!("{words} changes the motion and is not followed")),
        }
    }

    fn open(&mut self, words: String) {
        let station = self.mission.stations.len().saturating_sub(1);
        self.mission.open.push(Open { station, words });
    }

    /// A time of parameter `number`.
    fn hold(&self, item: &Item, number: usize) -> Result<Option<f64>, Wrong> {
        match item.given(number) {
            Some(s) if !(0.0..=LONGEST_S).contains(&s) => Err(item.wrong(number, "a time from 0 to 1000000 s")),
            Some(s) => Ok(Some(s).filter(|s| *s > 0.0)),
            None => Ok(None),
        }
    }

    /// Where `item` is, its altitude above sea level. Without latitude and longitude it is `here`.
    fn place(&self, item: &Item, here: Option<Geodetic>) -> Result<Geodetic, Wrong> {
        let [lat_deg, lon_deg] = match ([item.given(5), item.given(6)], here) {
            ([Some(lat), Some(lon)], _) if here.is_none() || lat != 0.0 || lon != 0.0 => [lat, lon],
            (_, Some(here)) => [here.lat_deg, here.lon_deg],
            ([None, _], None) => return Err(item.wrong(5, "a latitude, from -90 to 90°")),
            (_, None) => return Err(item.wrong(6, "a longitude, from -180 to 180°")),
        };
        if lat_deg.abs() > 90.0 {
            return Err(item.wrong(5, "a latitude, from -90 to 90°"));
        }
        if lon_deg.abs() > 180.0 {
            return Err(item.wrong(6, "a longitude, from -180 to 180°"));
        }
        let home = self.mission.home.alt_amsl_m;
        let above = match item.frame {
            _ if !self.flies => return Ok(Geodetic { lat_deg, lon_deg, alt_amsl_m: home }),
            Frame::Global => 0.0,
            Frame::Relative => home,
            Frame::Terrain => {
                let must = "0 (above sea level) or 3 (above home): flights know no terrain here";
                return Err(Wrong::new(format!("{}frame", item.at), "10 (above terrain)", must));
            }
            Frame::Mission => {
                return Err(Wrong::new(
                    format!("{}frame", item.at),
                    "2 (no place)",
                    "0 or 3 for a command with a place",
                ));
            }
        };
        let altitude = item.given(7).map(|z| z + above).filter(|z| z.abs() <= FARTHEST_M);
        let alt_amsl_m = altitude.ok_or_else(|| item.wrong(7, "an altitude within 20000 m of the sea"))?;
        Ok(Geodetic { lat_deg, lon_deg, alt_amsl_m })
    }

    fn go(&mut self, item: &Item, hold_s: Option<f64>) -> Result<(), Wrong> {
        let place = self.place(item, None)?;
        self.yaws += usize::from(item.given(4).is_some_and(|yaw| yaw != 0.0));
        // Of a wait it is the radius of circles, which what hovers does not fly.
        let beside = item.given(3).filter(|beside| *beside != 0.0 && item.command == 16);
        let accept_m = item.given(2).filter(|radius| *radius > 0.0);
        let next = Station { item: item.number, place, speed: self.speed, hold_s, accept_m };
        let first = self.took_off && self.mission.stations.len() == 1;
        match self.mission.stations.last_mut() {
            // Planners put the first waypoint where the take-off ends.
            Some(last) if is_one_place(&last.place, &place) && first => {
                self.mission.notes.push(format!("item {} is where the take-off ends", item.number));
                *last = next;
            }
            // A waypoint, and a wait at its place: one stop, as long as both hold.
            Some(last) if is_one_place(&last.place, &place) => {
                let words = format!("item {} is the place of item {} again", item.number, last.item);
                let held = last.hold_s.into_iter().chain(hold_s).reduce(|a, b| a + b);
                (last.hold_s, last.accept_m) = (held, accept_m.or(last.accept_m));
                match held {
                    Some(_) => self.mission.notes.push(format!("{words}: it is held there")),
                    None => self.open(format!("{words}, without a hold: whether it stops there is the autopilot's")),
                }
            }
            _ => self.add(item, next)?,
        }
        if let Some(beside) = beside {
            let words = format!("item {} passes {} m beside its place (params[2])", item.number, beside.abs());
            self.open(format!("{words}, which is not followed"));
        }
        Ok(())
    }

    fn add(&mut self, item: &Item, station: Station) -> Result<(), Wrong> {
        if self.mission.stations.len() == MOST_WAYPOINTS {
            let must = format!("at most {MOST_WAYPOINTS} waypoints");
            return Err(Wrong::new(item.at.trim_end_matches(['.', ',', ' ']), "one more", must));
        }
        self.mission.stations.push(station);
        Ok(())
    }

    /// hairpin begins where a take-off ends: at rest, above the place.
    fn take_off(&mut self, item: &Item) -> Result<(), Wrong> {
        if !self.mission.stations.is_empty() {
            self.open(format!("item {} takes off again, which is not followed", item.number));
            return Ok(());
        }
        let place = self.place(item, Some(self.mission.home))?;
        self.took_off = true;
        let up = place.alt_amsl_m - self.mission.home.alt_amsl_m;
        self.mission.notes.push(format!(
            "item {} takes off to {up:.2} m above home: what is judged begins there, at rest",
            item.number
        ));
        let station = Station { item: item.number, place, speed: self.speed, hold_s: None, accept_m: None };
        self.add(item, station)
    }

    /// Vehicles go to the place at the altitude that they have, and down there.
    fn land(&mut self, item: &Item) -> Result<(), Wrong> {
        self.over = Some(format!("the landing (item {})", item.number));
        self.mission.ending = Ending::Lands;
        let Some(last) = self.mission.stations.last() else { return Ok(()) };
        let (here, before) = (last.place, last.item);
        let low = Item { frame: Frame::Global, params: with_altitude(item.params, here.alt_amsl_m), ..item.clone() };
        let place = self.place(&low, Some(here))?;
        if is_one_place(&here, &place) {
            return Ok(());
        }
        self.mission.notes.push(format!(
            "item {} lands elsewhere than item {before}: the way there is flown at the altitude of that",
            item.number
        ));
        let station = Station { item: item.number, place, speed: self.speed, hold_s: None, accept_m: None };
        self.add(item, station)
    }

    fn wait(&mut self, item: &Item) -> Result<(), Wrong> {
        // A negative delay stands for a time of day.
        let hold = item.given(1).filter(|s| *s >= 0.0).map_or(Ok(f64::INFINITY), |s| match s <= LONGEST_S {
            true => Ok(s),
            false => Err(item.wrong(1, "a time from 0 to 1000000 s")),
        })?;
        match self.mission.stations.last_mut() {
            Some(last) => last.hold_s = Some(last.hold_s.unwrap_or(0.0) + hold),
            None => self.mission.notes.push(format!("item {} waits before the first waypoint", item.number)),
        }
        Ok(())
    }

    /// Speeds over ground and through the air are one without wind. −1: as it is, −2: the vehicle's own again.
    fn change_speed(&mut self, item: &Item) -> Result<(), Wrong> {
        if let Some(condition) = self.waits {
            self.open(format!(
                "item {} (command 178) sets the speed when the condition of item {condition} holds, amid a leg, which \
                 is not followed",
                item.number
            ));
            return Ok(());
        }
        match item.given(4).unwrap_or(0.0) {
            0.0 => {}
            1.0 => {
                let words = "sets a speed relative to the one before, which is not followed";
                self.open(format!("item {} (command 178) {words}", item.number));
                return Ok(());
            }
            _ => return Err(item.wrong(4, "0 (the speed itself) or 1 (relative to the one before)")),
        }
        match item.given(1).unwrap_or(1.0) {
            0.0 | 1.0 => {}
            2.0 | 3.0 => {
                let words = format!(
                    "item {} (command 178) sets the speed of climbs or descents alone, which is not followed",
                    item.number
                );
                self.open(words);
                return Ok(());
            }
            _ => return Err(item.wrong(1, "0 or 1 (speed), 2 (of climbs) or 3 (of descents)")),
        }
        // 0 is what some planners leave there.
        if let Some(throttle) = item.given(3).filter(|throttle| *throttle > 0.0) {
            let words = format!("sets a throttle of {throttle} %, which is not followed");
            self.open(format!("item {} (command 178) {words}", item.number));
        }
        match item.given(2) {
            None | Some(-1.0) => {}
            Some(-2.0) => self.speed = None,
            Some(speed) if speed > 0.0 && speed <= FASTEST_M_S => self.speed = Some(speed),
            Some(_) => return Err(item.wrong(2, "a speed above 0 and up to 1000 m/s, -1 (no change) or -2 (default)")),
        }
        Ok(())
    }

    /// The mission, with what is to be said of all of it.
    fn told(mut self) -> Uploaded {
        let notes = &mut self.mission.notes;
        if self.flies && !self.took_off && !self.mission.stations.is_empty() {
            notes.push("no take-off: what is judged begins at the first waypoint, at rest".into());
        }
        if !self.flies && !self.mission.stations.is_empty() {
            notes.push("the way from home to the first waypoint is not looked at; altitudes are the ground's".into());
        }
        if self.yaws > 0 {
            notes.push(format!("{} items ask for a heading, which plans here do not turn to", self.yaws));
        }
        match self.mission.ending {
            Ending::Stays => {}
            Ending::Lands => notes.push("the descent of the landing is not judged".into()),
            Ending::Returns => notes.push("the way home is the autopilot's own and is not judged".into()),
        }
        self.mission
    }
}

/// `params` with another altitude.
fn with_altitude(mut params: [f64; 7], altitude: f64) -> [f64; 7] {
    params[6] = altitude;
    params
}

/// Whether both are one place, on a ball that is the Earth's size.
fn is_one_place(a: &Geodetic, b: &Geodetic) -> bool {
    const PER_DEGREE: f64 = 111_320.0;
    let north = (a.lat_deg - b.lat_deg) * PER_DEGREE;
    let east = (a.lon_deg - b.lon_deg) * PER_DEGREE * libm::cos(a.lat_deg.to_radians());
    let up = a.alt_amsl_m - b.alt_amsl_m;
    north * north + east * east + up * up < ONE_PLACE_M * ONE_PLACE_M
}
