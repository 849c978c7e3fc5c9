//! Joints that follow axes of the arm.

use super::*;

#[test]
fn a_sixth_axis_that_something_follows_is_asked_for() {
    let cable = with(&joint("cable", "revolute", "link_4", "cable", &format!("{LIMIT}<mimic joint='joint_6'/>")));
    assert!(told(&cable).ends_with("such as tip = \"tool0\""), "{}", told(&cable));
    let tip = UrdfOptions { tip: Some("tool0".into()), ..UrdfOptions::default() };
    assert_eq!(read_urdf(&cable, &tip, &nowhere).unwrap().description.chain, arm(&irb120()).0.chain);
}

#[test]
fn they_are_as_far_about_as_their_masters_drive_them() {
    let ball = "<collision><geometry><sphere radius='0.02'/></geometry></collision>";
    let follower = |kind: &str, mimic: &str, more: &str| {
        let text = with(&(joint("a", kind, "link_1", "a", &format!("{LIMIT}{mimic}")) + more));
        text.replace("<link name='a'/>", &format!("<link name='a'>{ball}</link>"))
    };
    let radius = |text: &str| read(text).unwrap().description.capsules[0].radius_mm;
    // A quarter of 165°, in m: the bounds of what follows are not those of what it does.
    let slid = follower("prismatic", "<mimic joint='joint_1' multiplier='0.25'/>", "");
    let far = 0.25 * 165f64.to_radians();
    assert!((radius(&slid) - (20.0 + 1e3 * far)).abs() < 1e-9, "{}", radius(&slid));
    let said = read(&slid).unwrap().description.estimates;
    assert!(said.iter().any(|said| said.ends_with("(`a`) anywhere about its joint")), "{said:?}");
    // Through another one, with offsets.
    let master = joint("m", "prismatic", "link_1", "m", "<mimic joint='joint_1' multiplier='-0.5' offset='0.1'/>");
    let through = follower("prismatic", "<mimic joint='m' multiplier='0.5' offset='0.2'/>", &master);
    assert!((radius(&through) - (270.0 + 1e3 * far)).abs() < 1e-9, "{}", radius(&through));
    for (mimic, why) in [("<mimic joint='gone'/>", "no joint is called so"), ("<mimic joint='a'/>", "follows itself")] {
        let error = told(&follower("revolute", mimic, ""));
        assert!(error.starts_with("line 17: joint `a` follows") && error.contains(why), "{error}");
    }
    let floating = told(&follower("floating", "<mimic joint='joint_1'/>", ""));
    assert!(floating.contains("joint `a` floats and follows an axis"), "{floating}");
}
