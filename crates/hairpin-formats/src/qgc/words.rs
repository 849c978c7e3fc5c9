//! What commands of missions are called, and whether they change how a vehicle moves.

/// What a command that is not followed does to the motion.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Effect {
    /// Nothing that is judged.
    Harmless,
    /// Nothing by itself: it holds back what follows, up to the next place.
    Delays,
    /// It moves otherwise than without it.
    Moves,
}

use Effect::{Delays, Harmless, Moves};

/// Commands by number: name, effect. What is followed is not among them.
const COMMANDS: &[(u64, &str, Effect)] = &[
    (18, "loiter for turns", Moves),
    (30, "continue and change altitude", Moves),
    (31, "loiter to an altitude", Moves),
    (34, "orbit", Moves),
    (80, "region of interest", Harmless),
    (82, "spline waypoint", Moves),
    (83, "vertical altitude wait", Moves),
    (84, "take-off of a plane that hovers", Moves),
    (85, "landing of a plane that hovers", Moves),
    (92, "guided mode", Moves),
    (94, "payload place", Moves),
    (112, "delay of the next command", Delays),
    (114, "distance before the next command", Delays),
    (115, "yaw", Delays),
    (176, "flight mode", Moves),
    (179, "home is moved", Moves),
    (181, "relay", Harmless),
    (182, "relay, repeated", Harmless),
    (183, "servo", Harmless),
    (184, "servo, repeated", Harmless),
    (189, "landing sequence begins", Harmless),
    (192, "reposition", Moves),
    (193, "pause", Moves),
    (194, "reverse", Moves),
    (195, "region of interest", Harmless),
    (196, "region of interest, next waypoint", Harmless),
    (197, "no region of interest", Harmless),
    (200, "camera control", Harmless),
    (201, "region of interest", Harmless),
    (202, "camera configuration", Harmless),
    (203, "camera shutter", Harmless),
    (204, "mount configuration", Harmless),
    (205, "mount control", Harmless),
    (206, "camera trigger by distance", Harmless),
    (207, "fence on or off", Harmless),
    (208, "parachute", Moves),
    (211, "gripper", Moves),
    (214, "camera trigger by time", Harmless),
    (218, "auxiliary function", Moves),
    (220, "mount control", Harmless),
    (222, "limits of guided mode", Moves),
    (530, "camera mode", Harmless),
    (531, "camera zoom", Harmless),
    (532, "camera focus", Harmless),
    (1000, "gimbal", Harmless),
    (1001, "gimbal", Harmless),
    (2000, "image capture", Harmless),
    (2001, "image capture ends", Harmless),
    (2003, "camera trigger", Harmless),
    (2500, "video", Harmless),
    (2501, "video ends", Harmless),
];

/// What a command is called and does. What is not known may do anything.
pub(super) fn of(command: u64) -> (&'static str, Effect) {
    let known = COMMANDS.iter().find(|(number, ..)| *number == command);
    known.map_or(("not known here", Moves), |(_, name, effect)| (name, *effect))
}
