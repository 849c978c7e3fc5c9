//! How to log so that a flight can be judged: at which rate, and what makes the autopilot write it.

/// The rate at which PX4 writes motion capture with `SDLOG_PROFILE` bit 7, 1/s.
const PX4_MOCAP_HZ: f64 = 1000.0 / 30.0;
/// Beyond this no log of positions is written.
const FASTEST_HZ: f64 = 1000.0;

/// What to log at, where samples decide at `rate` a second: of PX4 the topic and the profile that has it.
///
/// The profiles are those of PX4's logged_topics.cpp (1.13 to 1.16): `vehicle_local_position` every 100 ms in the
/// default set (bit 0), at full rate in simulation alone; the high rate set (bit 4) has attitudes and rates, not
/// positions; computer vision and avoidance (bit 7) has `vehicle_mocap_odometry` every 30 ms.
pub(super) fn log_at(rate: Option<f64>, format: &str) -> String {
    let Some(rate) = rate.filter(|rate| *rate <= FASTEST_HZ) else {
        return "no rate of logging decides it: the samples themselves come too near the limit".into();
    };
    let hertz = rate.ceil();
    let at = format!("log positions at {hertz} Hz or faster");
    if format != "PX4 ULog" {
        return at;
    }
    let every = (1000.0 / hertz).floor().max(1.0);
    let mocap = if hertz <= PX4_MOCAP_HZ {
        " or, with motion capture, SDLOG_PROFILE = 129 (bits 0 and 7: vehicle_mocap_odometry at 33 Hz);"
    } else {
        ""
    };
    format!(
        "{at}:{mocap} `vehicle_local_position {every}` in etc/logging/logger_topics.txt on the SD card, beside all other \
         topics (no SDLOG_PROFILE has it faster than 10 Hz, bit 4, high rate, neither)"
    )
}
