//! Files and topics whose names say that they are no recordings: what was planned, or what autopilots are told.

use super::log::Source;

/// Words between a name's dots that say so, of our own exports and of others' copies of them (`0000.planned (1).csv`).
const PLANNED: [&str; 4] = ["planned", "plan", "setpoints", "poly4d"];

/// Whether a file is called after what was planned: `0000.planned.csv`, `monday.plan.csv`, and `0000.ref.tum` of our
/// own exports. Others call the truth that they measured a reference.
pub fn is_planned(name: &str) -> bool {
    let name = name.to_ascii_lowercase();
    let parts: Vec<&str> = name.split('.').collect();
    let [case, between @ .., _] = &parts[..] else { return false };
    let is_number = |word: &str| word.len() >= 4 && word.bytes().all(|byte| byte.is_ascii_digit());
    let first = |part: &str| part.split(' ').next().is_some_and(|word| PLANNED.contains(&word));
    // `0000_planned.csv`: of a case's number and a word alone.
    let renamed = case.split_once(['_', '-', ' ']).is_some_and(|(case, word)| is_number(case) && first(word));
    between.iter().any(|part| first(part)) || renamed || (is_number(case) && name.ends_with(".ref.tum"))
}

/// Who says where it was, by the file's name.
pub(super) fn source(name: &str) -> Source {
    if is_planned(name) { Source::Asked } else { Source::Untold }
}

/// Words in names of topics that are no motions but what motions are to be.
const ASKED: &str = "carrot clicked cmd command commanded commands demand demanded des desired expected fake forecast \
                     future goal goals ideal initial intended lookahead mpc mppi next nmpc nominal plan planned planner \
                     planning plans pred predicted prediction predictions preds ref reference requested rollout \
                     setpoint setpoints sp target targets tgt traj trajectories trajectory trajs wanted waypoint \
                     waypoints waypt waypts wp wps wpt wpts";
/// What is written together with them: `goalpose`, `jointcmd`.
const BODIES: [&str; 8] = ["pose", "position", "odometry", "odom", "path", "states", "state", "joint"];
/// Words of two, which are none of them alone, and of which the second may go on: `set_points`, `look_ahead`, `way_pt`.
const PAIRS: [[&str; 2]; 6] =
    [["set", "point"], ["set", "pose"], ["set", "position"], ["way", "point"], ["way", "pt"], ["look", "ahead"]];

/// Whether the name of a topic says that it was asked for: `/firefly/command/pose`, `/goal_pose`, `/targetPose2`,
/// `/set_point`, `/way_point`, `/look_ahead_point`, and what PX4 is told (`/fmu/in/…`).
pub(super) fn is_asked(name: &str) -> bool {
    let is = |word: &str| ASKED.split(' ').any(|asked| asked == word);
    let is_beside =
        |word: &str, body: &str| word.strip_suffix(body).is_some_and(is) || word.strip_prefix(body).is_some_and(is);
    let is_pair = |pair: &[String]| {
        PAIRS.iter().any(|[first, then]| pair[0] == *first && pair[1].starts_with(then)) || pair == ["fmu", "in"]
    };
    let words = words(name);
    words.iter().any(|word| is(word) || BODIES.iter().any(|body| is_beside(word, body)))
        || words.windows(2).any(is_pair)
}

/// The words of a name, in small letters: between other signs, between letters and digits, and where a large letter
/// begins one (`goalPose`, `CMDPose`).
fn words(name: &str) -> Vec<String> {
    let mut words = vec![String::new()];
    let characters: Vec<char> = name.chars().collect();
    for (i, c) in characters.iter().enumerate() {
        let before = i.checked_sub(1).map_or('/', |before| characters[before]);
        let then_small = characters.get(i + 1).is_some_and(|next| next.is_lowercase());
        let begins = c.is_numeric() != before.is_numeric()
            || c.is_uppercase() && (before.is_lowercase() || before.is_uppercase() && then_small);
        if begins || !c.is_alphanumeric() {
            words.push(String::new());
        }
        if let Some(word) = words.last_mut().filter(|_| c.is_alphanumeric()) {
            word.extend(c.to_lowercase());
        }
    }
    words.retain(|word| !word.is_empty());
    words
}

#[cfg(test)]
mod tests {
    use super::{is_asked, is_planned};

    #[test]
    fn what_is_asked_for_is_told_by_its_words() {
        for name in [
            "/way_point",
            "/wayPoint",
            "/way__point",
            "/robot/way_points",
            "/look_ahead/pose",
            "/lookAheadPoint",
            "/lookahead_point",
            "/set_pose",
            "/gazebo/set_position",
            "/next_pose",
            "/intended_pose",
            "/pred_odom",
            "/mpc/pose",
            "/trajectory_point",
            "/traj_pose",
            "/goal_pose",
            "/fmu/in/vehicle_visual_odometry",
        ] {
            assert!(is_asked(name), "{name}");
        }
        for name in [
            "/odom",
            "/odometry/filtered",
            "/pose",
            "/amcl_pose",
            "/tf_pose",
            "/robot_pose_ekf/odom_combined",
            "/mavros/local_position/pose",
            "/mavros/global_position/local",
            "/mocap/drone1/pose",
            "/vrpn_client_node/uav1/pose",
            "/vicon/body/body",
            "/qualisys/cf1/pose",
            "/crazyflie/pose",
            "/gps/fix",
            "/ground_truth/state",
            "/Odometry",
            "/vins_estimator/odometry",
            "/orb_slam3/camera_pose",
            "/wayfarer/odom",
            "/nextbot/odom",
            "/joint_states",
            "/dataset/pose",
        ] {
            assert!(!is_asked(name), "{name}");
        }
    }

    #[test]
    fn plans_are_told_by_their_names() {
        for name in [
            "0000.planned.csv",
            "12345.ref.tum",
            "0000.Planned.CSV",
            "0000.setpoints.csv",
            "m.plan.tum",
            "0000.planned (1).csv",
            "0000_planned.csv",
            "0000-plan (2).csv",
        ] {
            assert!(is_planned(name), "{name}");
        }
        for name in ["0000-0.csv", "0000.exec.tum", "mocap.ref.tum", "planned.csv", "plan.tum", "a.csv", "0000", ""] {
            assert!(!is_planned(name), "{name}");
        }
    }
}
