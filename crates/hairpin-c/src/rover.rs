//! Vehicles: two numbers, or the text of a robot file.

use std::ffi::c_char;
use std::fmt::Display;
use std::str;
use std::sync::Arc;

use hairpin::campaign::scenario::GroundDescription;
use hairpin::robot::rover::{Rover, RoverDescription};
use serde::de::DeserializeOwned;

use crate::memory::{free, given, handle, many, put, result};
use crate::refusal::{Code, Error, HAIRPIN_INVALID, Refused, enter};

/// A vehicle. Nothing changes it, so that any number of threads may use it.
pub struct RoverHandle {
    pub(crate) rover: Arc<Rover>,
}

/// What a vehicle may do.
#[repr(C)]
pub struct Limits {
    /// Largest curvature, 1/m.
    pub curvature_1_m: f64,
    /// Largest change of curvature, 1/m^2.
    pub curvature_rate_1_m2: f64,
    /// Largest speed, m/s; infinite where there is none.
    pub speed_m_s: f64,
    /// Speed where none is given, m/s.
    pub default_speed_m_s: f64,
    /// Largest angle of the body from the vertical, rad; infinite where there is none.
    pub tilt_rad: f64,
    /// 1 where it turns in place.
    pub turns_in_place: i32,
}

/// The plainest vehicle, with the bounds that every other one has too.
const PLAIN: &str = "kind = \"rover\"\nname = \"plain\"\n[limits]\ncurvature_1_m = 1.0\n";

fn of_text<T: DeserializeOwned>(text: &str) -> Result<T, Refused> {
    toml::from_str(text).map_err(|error| Refused::invalid(error.message()))
}

/// The `kind` of a robot file.
fn kind(text: &str) -> Result<String, Refused> {
    let table: toml::Table = of_text(text)?;
    let kind = table.get("kind").and_then(toml::Value::as_str);
    kind.map(str::to_owned).ok_or_else(|| Refused::invalid("`kind` is missing"))
}

/// The vehicle of a file's text.
fn read(text: &str) -> Result<Rover, Refused> {
    let description = match kind(text)?.as_str() {
        "rover" => GroundDescription::Rover(Box::new(of_text(text)?)),
        "car" => GroundDescription::Car(of_text(text)?),
        "differential-drive" => GroundDescription::DifferentialDrive(of_text(text)?),
        other => {
            let kinds = GroundDescription::KINDS.join(", ");
            let sentence = format_args!("`kind` = {other:?}: must be one of {kinds}");
            return Err(Refused::new(HAIRPIN_INVALID, sentence));
        }
    };
    description.build().map_err(refused)
}

fn refused(error: impl Display) -> Refused {
    Refused::invalid(error)
}

/// Makes a point in the plane that follows its curvature at once, as the generator's source has its generic vehicle.
///
/// @param max_curvature_1_m largest curvature, 1e-4 to 1e3 1/m
/// @param max_curvature_rate_1_m2 largest change of curvature, 1e-4 to 1e6 1/m^2
/// @param rover the vehicle, to be given back to hairpin_rover_free
/// @param error NULL, or where the call says why it did nothing
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hairpin_rover_new(
    max_curvature_1_m: f64,
    max_curvature_rate_1_m2: f64,
    rover: *mut *mut RoverHandle,
    error: *mut Error,
) -> Code {
    // SAFETY: NULL or to be written, as the header has it.
    unsafe {
        enter(error, || {
            let place = result(rover, "rover")?;
            let mut description: RoverDescription = of_text(PLAIN)?;
            description.limits.curvature_1_m = max_curvature_1_m;
            description.limits.curvature_rate_1_m2 = Some(max_curvature_rate_1_m2);
            let rover = Arc::new(description.build().map_err(refused)?);
            handle(place, RoverHandle { rover })
        })
    }
}

/// Makes the vehicle of a robot file: a rover, a car or a differential drive, as data/robots has them.
///
/// @param text the file's text in UTF-8; it need not end with NUL
/// @param length its bytes
/// @param rover the vehicle, to be given back to hairpin_rover_free
/// @param error NULL, or where the call says why it did nothing
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hairpin_rover_from_toml(
    text: *const c_char,
    length: usize,
    rover: *mut *mut RoverHandle,
    error: *mut Error,
) -> Code {
    // SAFETY: `text` has as many bytes, the others are NULL or to be written, as the header has it.
    unsafe {
        enter(error, || {
            let place = result(rover, "rover")?;
            let text = str::from_utf8(many(text.cast::<u8>(), length, "text")?).map_err(refused)?;
            handle(place, RoverHandle { rover: Arc::new(read(text)?) })
        })
    }
}

/// Tells what a vehicle may do.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hairpin_rover_limits(
    rover: *const RoverHandle,
    limits: *mut Limits,
    error: *mut Error,
) -> Code {
    // SAFETY: `rover` is a vehicle, the others are NULL or to be written, as the header has it.
    unsafe {
        enter(error, || {
            let (rover, place) = (&given(rover, "rover")?.rover, result(limits, "limits")?);
            let of = &rover.limits;
            put(
                place,
                Limits {
                    curvature_1_m: of.curvature,
                    curvature_rate_1_m2: of.curvature_rate,
                    speed_m_s: of.speed,
                    default_speed_m_s: rover.default_speed,
                    tilt_rad: of.tilt,
                    turns_in_place: of.turns_in_place.into(),
                },
            )
        })
    }
}

/// Gives a vehicle back; what was made with it goes on. NULL is nothing.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hairpin_rover_free(rover: *mut RoverHandle) {
    // SAFETY: as above.
    unsafe { free(rover) }
}
