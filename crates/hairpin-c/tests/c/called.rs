//! The entries as C calls them, with what they answer in memory of the test's.

use std::ffi::CStr;
use std::mem::MaybeUninit;
use std::ptr::{null, null_mut};

use hairpin_c::clear::{KeepOutPlace, hairpin_steer_clear};
use hairpin_c::drive::{Drive, State};
use hairpin_c::map::{Grid, HAIRPIN_HOLES_REFUSED, MapHandle, hairpin_map_free, hairpin_map_new};
use hairpin_c::refusal::{Code, Error, HAIRPIN_OK};
use hairpin_c::rover::{RoverHandle, hairpin_rover_free, hairpin_rover_from_toml};
use hairpin_c::settings::SteerSettings;
use hairpin_c::steer::{SteerHandle, hairpin_steer, hairpin_steer_free, hairpin_steer_new};

/// What `call` answers, and the sentence that it leaves.
pub(crate) fn said(call: impl FnOnce(*mut Error) -> Code) -> (Code, String) {
    let mut error = MaybeUninit::<Error>::uninit();
    let code = call(error.as_mut_ptr());
    // SAFETY: every call writes it.
    let error = unsafe { error.assume_init() };
    assert_eq!(error.code, code);
    // SAFETY: a message ends with NUL.
    let message = unsafe { CStr::from_ptr(error.message.as_ptr()) };
    (code, message.to_str().expect("UTF-8").to_owned())
}

fn done(call: impl FnOnce(*mut Error) -> Code) {
    assert_eq!(said(call), (HAIRPIN_OK, String::new()));
}

/// What finds drives, with the vehicle of a file's text; vehicle and map are given back before it is asked.
pub(crate) struct Steerer(*mut SteerHandle);

impl Steerer {
    pub(crate) fn new(rover: &str, map: Option<(&Grid, &[f32])>, settings: &SteerSettings) -> Self {
        let (mut vehicle, mut ground, mut steer): (*mut RoverHandle, *mut MapHandle, *mut SteerHandle) =
            (null_mut(), null_mut(), null_mut());
        // SAFETY: every pointer leads to what its type says.
        unsafe {
            done(|error| hairpin_rover_from_toml(rover.as_ptr().cast(), rover.len(), &mut vehicle, error));
            if let Some((grid, heights)) = map {
                done(|error| hairpin_map_new(grid, heights.as_ptr(), HAIRPIN_HOLES_REFUSED, &mut ground, error));
            }
            done(|error| hairpin_steer_new(vehicle, ground, settings, &mut steer, error));
            hairpin_rover_free(vehicle);
            hairpin_map_free(ground);
        }
        Self(steer)
    }

    pub(crate) fn handle(&self) -> *const SteerHandle {
        self.0
    }

    pub(crate) fn ask(&self, start: &State, goal: &State) -> Drive {
        let mut drive = MaybeUninit::uninit();
        // SAFETY: every pointer leads to what its type says, and the answer is written where the code says so.
        unsafe {
            assert_eq!(hairpin_steer(self.0, start, goal, drive.as_mut_ptr(), null_mut()), HAIRPIN_OK);
            drive.assume_init()
        }
    }
}

impl Steerer {
    pub(crate) fn ask_clear_of(&self, places: &[KeepOutPlace], start: &State, goal: &State) -> Drive {
        let mut drive = MaybeUninit::uninit();
        // SAFETY: every pointer leads to what its type says, and the answer is written where the code says so.
        unsafe {
            let (from, count) = (places.as_ptr(), places.len());
            let code = hairpin_steer_clear(self.0, start, goal, from, count, drive.as_mut_ptr(), null_mut());
            assert_eq!(code, HAIRPIN_OK);
            drive.assume_init()
        }
    }
}

impl Drop for Steerer {
    fn drop(&mut self) {
        // SAFETY: it is the handle's last use.
        unsafe { hairpin_steer_free(self.0) }
    }
}

/// A name or sentence in memory of C's.
pub(crate) fn name(of: &[std::ffi::c_char]) -> String {
    let letters = of.iter().take_while(|letter| **letter != 0).map(|letter| *letter as u8);
    String::from_utf8(letters.collect()).expect("UTF-8")
}

/// NULL for what is read.
pub(crate) fn nothing<T>() -> *const T {
    null()
}
