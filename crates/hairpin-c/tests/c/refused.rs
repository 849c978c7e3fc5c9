//! NULL and nonsense are refused by code, with a sentence; a panic ends at the door.

use std::ffi::c_void;
use std::mem::MaybeUninit;
use std::ptr::{dangling, null, null_mut};

use hairpin_c::drive::{Drive, State};
use hairpin_c::follow::{Moment, hairpin_follow};
use hairpin_c::judge::hairpin_judge;
use hairpin_c::map::{Grid, hairpin_map_free, hairpin_map_new};
use hairpin_c::max_load::{MaxLoadSettings, hairpin_max_load, hairpin_max_load_defaults};
use hairpin_c::refusal::{HAIRPIN_INVALID, HAIRPIN_NULL, HAIRPIN_OK};
use hairpin_c::rover::{hairpin_rover_free, hairpin_rover_from_toml, hairpin_rover_new};
use hairpin_c::settings::{SteerSettings, hairpin_steer_defaults};
use hairpin_c::steer::{hairpin_steer, hairpin_steer_free, hairpin_steer_new};
use hairpin_c::track::{JudgeSettings, Sample, hairpin_judge_defaults};

use crate::called::{Steerer, nothing, said};

/// Compiled again, for what no entry lets a test do: panic.
#[allow(dead_code, unreachable_pub)]
#[path = "../../src/refusal.rs"]
mod refusal;

const PLAIN: &str = "kind = \"rover\"\nname = \"own\"\n[limits]\ncurvature_1_m = 1.0\n";

#[track_caller]
fn refused((code, sentence): (i32, String), wanted: i32, words: &str) {
    assert!(code == wanted && sentence.contains(words), "{code} {sentence}");
}

#[test]
fn a_panic_ends_at_the_door() {
    let mut error = refusal::Error { code: 0, message: [1; refusal::HAIRPIN_MESSAGE] };
    let hook = std::panic::take_hook();
    std::panic::set_hook(Box::new(|_| {}));
    let long = "e\u{301}".repeat(300);
    // SAFETY: `error` may be written.
    let code = unsafe { refusal::enter(&mut error, || panic!("{long}")) };
    std::panic::set_hook(hook);
    assert_eq!((code, error.code), (refusal::HAIRPIN_INTERNAL, refusal::HAIRPIN_INTERNAL));
    let message = crate::called::name(&error.message);
    assert!(message.starts_with("a mistake of hairpin's own: e") && message.len() <= 255, "{message}");
    // SAFETY: NULL is nowhere.
    assert_eq!(unsafe { refusal::enter(null_mut(), || Ok(())) }, refusal::HAIRPIN_OK);
}

#[test]
fn vehicles_and_maps_that_are_none_are_refused() {
    let mut rover = null_mut();
    let mut map = null_mut();
    let grid = Grid { columns: 2, rows: 2, first_center_m: [0.0; 2], cell_m: [1.0; 2] };
    let heights = [0.0_f32, 0.0, 0.0, f32::NAN];
    // SAFETY: every pointer leads to what its type says, or must be refused before it is read.
    unsafe {
        refused(said(|e| hairpin_rover_new(1.0, 1.0, null_mut(), e)), HAIRPIN_NULL, "`rover` is NULL");
        for (most, rate, words) in [(f64::NAN, 1.0, "curvature_1_m"), (-1.0, 1.0, "curvature_1_m"), (1.0, 1e9, "rate")]
        {
            refused(said(|e| hairpin_rover_new(most, rate, &mut rover, e)), HAIRPIN_INVALID, words);
        }
        let text = |text: &str| (text.as_ptr().cast(), text.len());
        for (file, words) in [
            ("", "`kind` is missing"),
            ("kind = \"quadrotor\"", "must be one of rover, car"),
            ("kind = \"rover\"\nname = \"x\"\nwheels = 3", "invalid type"),
            ("kind = ", "value"),
            (&PLAIN.replace("1.0", "-1.0"), "limits.curvature_1_m"),
        ] {
            let (start, length) = text(file);
            refused(said(|e| hairpin_rover_from_toml(start, length, &mut rover, e)), HAIRPIN_INVALID, words);
        }
        refused(said(|e| hairpin_rover_from_toml(null(), 5, &mut rover, e)), HAIRPIN_NULL, "`text` is NULL");
        let bytes = [0xff_u8, 0xfe];
        let call = |e| hairpin_rover_from_toml(bytes.as_ptr().cast(), 2, &mut rover, e);
        refused(said(call), HAIRPIN_INVALID, "utf-8");
        assert!(rover.is_null());

        refused(said(|e| hairpin_map_new(null(), heights.as_ptr(), 0, &mut map, e)), HAIRPIN_NULL, "`grid`");
        refused(said(|e| hairpin_map_new(&grid, null(), 0, &mut map, e)), HAIRPIN_NULL, "`heights_m`");
        refused(said(|e| hairpin_map_new(&grid, heights.as_ptr(), 9, &mut map, e)), HAIRPIN_INVALID, "`holes` = 9");
        refused(said(|e| hairpin_map_new(&grid, heights.as_ptr(), 0, &mut map, e)), HAIRPIN_INVALID, "without data");
        let odd = heights.as_ptr().cast::<u8>().add(1).cast();
        refused(said(|e| hairpin_map_new(&grid, odd, 0, &mut map, e)), HAIRPIN_INVALID, "a multiple of 4");
        // A size that was negative in C.
        let negative = Grid { columns: usize::MAX, ..grid };
        refused(said(|e| hairpin_map_new(&negative, heights.as_ptr(), 0, &mut map, e)), HAIRPIN_INVALID, "memory");
        assert!(map.is_null());
        // Nothing is given back without harm, and no message is wanted by everyone.
        hairpin_rover_free(null_mut());
        hairpin_map_free(null_mut());
        hairpin_steer_free(null_mut());
        assert_eq!(hairpin_rover_new(f64::NAN, 1.0, &mut rover, null_mut()), HAIRPIN_INVALID);
    }
}

#[test]
fn questions_that_are_none_are_refused() {
    let usual = hairpin_steer_defaults();
    let here = State { x_m: 0.0, y_m: 0.0, yaw_rad: 0.0, curvature_1_m: 0.0 };
    let (steer, mut rover, mut other) = (Steerer::new(PLAIN, None, &usual), null_mut(), null_mut());
    let mut drive = steer.ask(&here, &State { x_m: 3.0, ..here });
    let (mut count, mut moments) = (7, [const { MaybeUninit::<Moment>::uninit() }; 4]);
    // SAFETY: every pointer leads to what its type says, or must be refused before it is read.
    unsafe {
        assert_eq!(hairpin_rover_new(1.0, 1.0, &mut rover, null_mut()), HAIRPIN_OK);
        for (settings, words) in [
            (SteerSettings { tolerance_m: f64::NAN, ..usual }, "`tolerance_m` = NaN"),
            (SteerSettings { tolerance_yaw_rad: -0.1, ..usual }, "`tolerance_yaw_rad` = -0.1"),
            (SteerSettings { speed_m_s: f64::INFINITY, ..usual }, "`speed_m_s` = inf"),
            (SteerSettings { control: 7, ..usual }, "`control` = 7"),
            (SteerSettings { direction_rad: f64::NAN, ..usual }, "`direction_rad` = NaN"),
        ] {
            refused(said(|e| hairpin_steer_new(rover, null(), &settings, &mut other, e)), HAIRPIN_INVALID, words);
        }
        refused(said(|e| hairpin_steer_new(null(), null(), &usual, &mut other, e)), HAIRPIN_NULL, "`rover`");
        let odd = dangling::<u8>().cast();
        refused(said(|e| hairpin_steer_new(odd, null(), &usual, &mut other, e)), HAIRPIN_INVALID, "must be a multiple");
        hairpin_rover_free(rover);

        let mut ask = |start: &State, goal: &State| said(|e| hairpin_steer(steer.handle(), start, goal, &mut drive, e));
        refused(ask(&here, &State { x_m: f64::NAN, ..here }), HAIRPIN_INVALID, "x = NaN");
        refused(ask(&here, &State { yaw_rad: f64::INFINITY, ..here }), HAIRPIN_INVALID, "yaw = inf");
        refused(ask(&here, &State { curvature_1_m: f64::NAN, ..here }), HAIRPIN_INVALID, "`goal.curvature_1_m`");
        refused(ask(&State { x_m: 1e7, ..here }, &State { x_m: 1e7, ..here }), HAIRPIN_INVALID, "`start.x_m`");
        let call = |e| hairpin_steer(steer.handle(), nothing(), &here, &mut drive, e);
        refused(said(call), HAIRPIN_NULL, "`start` is NULL");
        let call = |e| hairpin_steer(steer.handle(), &here, &here, null_mut(), e);
        refused(said(call), HAIRPIN_NULL, "`drive` is NULL");

        // A drive that nobody found.
        let place = moments.as_mut_ptr().cast();
        let mut follow = |drive: &Drive, step: f64| {
            said(|e| hairpin_follow(steer.handle(), &here, drive, step, place, 4, &mut count, e))
        };
        refused(follow(&Drive { count: 41, ..drive }, 0.1), HAIRPIN_INVALID, "one too many");
        let mut odd = drive;
        odd.segments[0].length_m = f64::NAN;
        refused(follow(&odd, 0.1), HAIRPIN_INVALID, "is not finite");
        refused(follow(&drive, 0.0), HAIRPIN_INVALID, "`time_step_s` = 0");
        // Three metres at 1 m/s: as many moments there would be.
        refused(follow(&drive, 1e-9), HAIRPIN_INVALID, "`time_step_s` = 1e-9: must be at least 3");
        // Too little room: nothing is written but how many there are.
        refused(follow(&drive, 0.1), 3, "room for 4 values of `moments`: 31 are needed");
        assert_eq!(count, 31);
    }
}

/// A distance from the second metre on alone.
unsafe extern "C" fn unknown(_: *mut c_void, place: *const f64) -> f64 {
    // SAFETY: three numbers.
    if unsafe { *place } > 0.5 { f64::NAN } else { 1.0 }
}

#[test]
fn tables_and_tracks_that_are_none_are_refused() {
    let usual = hairpin_max_load_defaults();
    let (costs, mut answer) = ([-1_i64, 3, -5, -1], MaybeUninit::uninit());
    let sample = |t_s: f64, x: f64| Sample {
        t_s,
        position_m: [x, 0.0, 0.0],
        attitude_wxyz: [0.0; 4],
        velocity_m_s: [0.0; 3],
        leg: 9,
    };
    let track = [sample(0.0, 0.0), sample(1.0, 1.0)];
    let (waypoints, mut measures, mut violated) = ([0.0, 0.0, 0.0, 1.0, 0.0, 0.0], MaybeUninit::uninit(), 0);
    // SAFETY: every pointer leads to what its type says, or must be refused before it is read.
    unsafe {
        let mut load = |costs: *const i64, points: usize, settings: &MaxLoadSettings| {
            let (paths, order) = (null_mut(), null_mut());
            said(|e| hairpin_max_load(costs, points, settings, paths, 0, order, 0, answer.as_mut_ptr(), e))
        };
        refused(load(null(), 2, &usual), HAIRPIN_NULL, "`costs` is NULL");
        refused(load(costs.as_ptr(), 0, &usual), HAIRPIN_INVALID, "no point");
        refused(load(costs.as_ptr(), usize::MAX, &usual), HAIRPIN_INVALID, "more than memory can hold");
        refused(load(costs.as_ptr(), 2, &usual), HAIRPIN_INVALID, "cost -5 of the arc 1→0");
        let good = [-1_i64, 3, 2, -1];
        for (settings, words) in [
            (MaxLoadSettings { start: 2, ..usual }, "start is point 2"),
            (MaxLoadSettings { end: -2, ..usual }, "`end` = -2"),
            (MaxLoadSettings { visits: 99, ..usual }, "99 visits"),
            (MaxLoadSettings { time_limit_s: f64::NAN, ..usual }, "`time_limit_s` = NaN"),
            (MaxLoadSettings { threads: 1 << 20, ..usual }, "`threads`"),
        ] {
            refused(load(good.as_ptr(), 2, &settings), HAIRPIN_INVALID, words);
        }
        refused(load(good.as_ptr(), 2, &usual), 3, "room for 0 paths: there are 1");

        let settings = hairpin_judge_defaults();
        let mut judge = |waypoints: &[f64], track: &[Sample], settings| {
            let (from, points) = (waypoints.as_ptr(), waypoints.len() / 3);
            let (legs, off, found) = (null_mut(), null_mut(), null_mut());
            let (measures, violated) = (measures.as_mut_ptr(), &raw mut violated);
            said(|e| {
                hairpin_judge(
                    from,
                    points,
                    track.as_ptr(),
                    track.len(),
                    settings,
                    measures,
                    legs,
                    off,
                    found,
                    0,
                    violated,
                    e,
                )
            })
        };
        refused(judge(&waypoints[..3], &track, &settings), HAIRPIN_INVALID, "1 waypoints: must be at least 2");
        refused(judge(&waypoints, &[], &settings), HAIRPIN_INVALID, "no sample");
        refused(judge(&waypoints, &[track[1], track[0]], &settings), HAIRPIN_INVALID, "times must rise");
        refused(judge(&waypoints, &[sample(0.0, f64::NAN)], &settings), HAIRPIN_INVALID, "x_m[0] = NaN");
        let of = |change: fn(&mut JudgeSettings)| {
            let mut settings = hairpin_judge_defaults();
            change(&mut settings);
            settings
        };
        for (settings, words) in [
            (of(|s| s.told = 8), "`told` = 8"),
            (of(|s| s.told = 1), "attitude_wxyz` has length 0"),
            (of(|s| s.told = 4), "leg = 9 at sample 0"),
            (of(|s| s.reference = 7), "`reference` = 7"),
            (of(|s| s.ended = -1), "`ended` = -1"),
            (of(|s| s.corner_m = -1.0), "corner_m"),
            (of(|s| s.max_deviation_m = -0.5), "`max_deviation_m` = -0.5"),
            (of(|s| s.max_late_s = 1.0), "must stand with `planned_s`"),
            (of(|s| s.min_clearance_m = 0.5), "`min_clearance_m` = 0.5: must stand with `clearance`"),
            (of(|s| s.clearance = Some(unknown)), "clearance = NaN at sample 1"),
        ] {
            refused(judge(&waypoints, &track, &settings), HAIRPIN_INVALID, words);
        }
        let soon = [sample(0.0, 0.0), sample(1e-160, 1.0)];
        refused(judge(&waypoints, &soon, &settings), HAIRPIN_INVALID, "`samples[1].t_s` is 1e-160 s after");
        let far = [sample(0.0, 0.0), sample(1.0, 1e300)];
        refused(judge(&waypoints, &far, &settings), HAIRPIN_INVALID, "max_deviation_m = inf: must be finite");
        refused(judge(&waypoints, &track, &of(|s| s.reference = 2)), HAIRPIN_INVALID, "programmed path has 0");
        assert_eq!(judge(&waypoints, &track, null()).0, HAIRPIN_OK);
    }
}
