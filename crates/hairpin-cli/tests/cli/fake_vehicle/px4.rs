//! A PX4 that flies a mission in a world which stands somewhere on Earth, and its ULog.

use nalgebra::{Matrix3, Point3, Rotation3, UnitQuaternion, Vector3};

use super::Row;
use super::write_ulog::{ATTITUDE, POSITION, Position, SETPOINT, STATE, Ulog, attitude, setpoint};

/// Radius of the sphere that PX4 projects from (`CONSTANTS_RADIUS_OF_EARTH`), m.
const SPHERE_M: f64 = 6_371_000.0;
/// The first row's stamp since boot, s.
const BOOT: f64 = 100.0;
/// It stands at the first waypoint so long, s.
const HOVER: f64 = 3.0;
/// The vehicle's own origin, north and east of the world's, m, and how much higher its barometer has it.
const HOME: [f64; 3] = [12.0, 7.0, 0.7];

/// What goes wrong, at a time of the run, s.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Happens {
    /// The pilot sends it home.
    Return(f64),
    /// A failsafe does.
    Failsafe(f64),
    /// The estimate jumps, north, east, down, m, and says so.
    Reset(f64, [f32; 3]),
    /// The same, and nobody says so.
    Jump(f64, [f32; 3]),
    /// The logger loses what lies between.
    Lost(f64, f64),
}

/// The vehicle.
pub(crate) struct Px4<'a> {
    /// What it flies.
    pub(crate) rows: &'a [Row],
    pub(crate) waypoints: &'a [Point3<f64>],
    /// Where the world stands: latitude, longitude, altitude, heading of its x.
    pub(crate) origin: [f64; 4],
    /// Standard deviations that the estimate claims, m.
    pub(crate) accuracy: [f32; 2],
    pub(crate) happens: &'a [Happens],
}

/// Metres a degree of latitude and of longitude at a latitude, on the ellipsoid.
fn per_degree(lat: f64) -> [f64; 2] {
    let (a, e2) = (6_378_137.0, 6.694_379_990_14e-3);
    let w = 1.0 - e2 * lat.to_radians().sin().powi(2);
    [a * (1.0 - e2) / w.powf(1.5), a / w.sqrt() * lat.to_radians().cos()].map(|m| m.to_radians())
}

/// PX4's `map_projection_project`: north and east of `about` on its sphere, m.
fn project([lat0, lon0]: [f64; 2], [lat, lon]: [f64; 2]) -> [f64; 2] {
    let ((sin0, cos0), (sin, cos)) = (lat0.to_radians().sin_cos(), lat.to_radians().sin_cos());
    let (sin_d, cos_d) = (lon - lon0).to_radians().sin_cos();
    let c = (sin0 * sin + cos0 * cos * cos_d).clamp(-1.0, 1.0).acos();
    let k = if c > 0.0 { c / c.sin() } else { 1.0 };
    [k * (cos0 * sin - sin0 * cos * cos_d) * SPHERE_M, k * cos * sin_d * SPHERE_M]
}

impl Px4<'_> {
    /// Axes of the world in east, north, up, by the compass.
    fn axes(&self) -> Matrix3<f64> {
        let (sin, cos) = self.origin[3].to_radians().sin_cos();
        Matrix3::from_columns(&[Vector3::new(sin, cos, 0.0), Vector3::new(-cos, sin, 0.0), Vector3::z()])
    }

    /// Latitude and longitude of a place `north` and `east` of the world's origin.
    fn place(&self, [north, east]: [f64; 2]) -> [f64; 2] {
        let lat = self.origin[0] + north / per_degree(self.origin[0])[0];
        [lat, self.origin[1] + east / per_degree(lat)[1]]
    }

    fn on_earth(&self, p: &Point3<f64>) -> [f64; 2] {
        let enu = self.axes() * p.coords;
        self.place([enu.y, enu.x])
    }

    fn home(&self) -> [f64; 3] {
        let [lat, lon] = self.place([HOME[0], HOME[1]]);
        [lat, lon, self.origin[2] + HOME[2]]
    }

    fn sample(&self, row: &Row, t_us: u64) -> (Position, [f32; 4]) {
        let home = self.home();
        let [north, east] = project([home[0], home[1]], self.on_earth(&row.p));
        let ned_from_enu = Matrix3::new(0.0, 1.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, -1.0);
        let v = ned_from_enu * self.axes() * row.v;
        let frd = Matrix3::from_diagonal(&Vector3::new(1.0, -1.0, -1.0));
        let turn = ned_from_enu * self.axes() * row.q.to_rotation_matrix().matrix() * frd;
        let q = UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(turn));
        let mut ned = [north as f32, east as f32, -row.p.z as f32];
        let (mut delta, mut counters) = ([0.0; 4], [0; 3]);
        for happens in self.happens {
            if let Happens::Reset(at, by) | Happens::Jump(at, by) = *happens
                && row.t >= at
            {
                ned.iter_mut().zip(by).for_each(|(p, by)| *p += by);
                if matches!(happens, Happens::Reset(..)) {
                    (delta, counters) = ([by[0], by[1], by[2], 0.0], [1, 1, 0]);
                }
            }
        }
        let v = [v.x as f32, v.y as f32, v.z as f32];
        let position =
            Position { t_us, ned, v, delta, counters, reference: home, accuracy: self.accuracy, ..Position::STILL };
        (position, [q.w as f32, q.i as f32, q.j as f32, q.k as f32])
    }

    /// Its log: take-off, hover, the mission, landing at its end, unless something happens.
    pub(crate) fn ulog(&self) -> Vec<u8> {
        let mut log = Ulog::new();
        let [result, triplet, status, fence, land] = STATE;
        for format in [POSITION, ATTITUDE, result, SETPOINT, triplet, status, fence, land] {
            log.message(b'F', format.as_bytes());
        }
        for (id, format) in (0..).zip([POSITION, ATTITUDE, result, triplet, status, fence, land]) {
            log.subscribe(0, id, format.split_once(':').unwrap().0);
        }
        let micros = |t: f64| ((BOOT + t) * 1e6).round() as u64;
        let state = |log: &mut Ulog, t: f64, mode: u8, failsafe: u8| {
            log.data(4, &[&micros(t).to_le_bytes(), &[mode, 3, failsafe]]);
        };
        let landed = |log: &mut Ulog, t: f64, on: u8| log.data(6, &[&micros(t).to_le_bytes(), &[on]]);
        // Items: take-off, then before each waypoint its speed, then landing.
        let fly_to = |log: &mut Ulog, t: f64, item: u16, p: &Point3<f64>| {
            let to = setpoint(true, self.on_earth(p), (self.home()[2] + p.z) as f32);
            log.data(3, &[&micros(t).to_le_bytes(), &setpoint(false, [0.0, 0.0], 0.0), &to]);
            let number = [item.saturating_sub(1), item].map(u16::to_le_bytes).concat();
            log.data(2, &[&micros(t).to_le_bytes(), &number, &[0]]);
        };
        let (first, last) = (self.rows[0], self.rows[self.rows.len() - 1]);
        let period = self.rows[1].t - first.t;
        let put = |log: &mut Ulog, row: &Row| {
            let (position, q) = self.sample(row, micros(row.t));
            log.data(0, &[&position.bytes()]);
            log.data(1, &[&attitude(micros(row.t), q)]);
        };
        landed(&mut log, first.t - HOVER - 1.0, 1);
        state(&mut log, first.t - HOVER - 1.0, 3, 0);
        landed(&mut log, first.t - HOVER, 0);
        fly_to(&mut log, first.t - HOVER, 0, &self.waypoints[0]);
        let hover = (HOVER / period).floor() as i64;
        for step in -hover..0 {
            put(&mut log, &Row { t: first.t + step as f64 * period, v: Vector3::zeros(), ..first });
        }
        let mut leg = None;
        let (mut was_lost, mut over) = (false, false);
        for row in self.rows {
            if leg != Some(row.leg) && !over {
                leg = Some(row.leg);
                fly_to(&mut log, row.t, 2 * (row.leg as u16 + 1) + 2, &self.waypoints[row.leg + 1]);
            }
            for happens in self.happens {
                let (at, failsafe) = match *happens {
                    Happens::Return(at) => (at, 0),
                    Happens::Failsafe(at) => (at, 1),
                    _ => continue,
                };
                if row.t >= at && !over {
                    state(&mut log, row.t, if failsafe == 0 { 5 } else { 4 }, failsafe);
                    over = true;
                }
            }
            let lost = self.happens.iter().find_map(|happens| match *happens {
                Happens::Lost(from, to) if row.t > from && row.t < to => Some(to - from),
                _ => None,
            });
            match lost {
                Some(span) if !was_lost => log.message(b'O', &((1e3 * span) as u16).to_le_bytes()),
                Some(_) => {}
                None => put(&mut log, row),
            }
            was_lost = lost.is_some();
        }
        if !over {
            let below = Point3::new(last.p.x, last.p.y, 0.0);
            fly_to(&mut log, last.t + period, 2 * self.waypoints.len() as u16 + 2, &below);
            put(&mut log, &Row { t: last.t + period, ..last });
            state(&mut log, last.t + 1.0, 18, 0);
        }
        landed(&mut log, last.t + 9.0, 1);
        log.sync();
        log.0
    }
}
