//! Which joints are which axes.

use super::names::axes;

fn names(names: &[&str]) -> Vec<String> {
    names.iter().map(ToString::to_string).collect()
}

#[test]
fn joints_are_axes_by_name_or_by_number_and_never_by_place() {
    let own: [String; 6] = ["pan", "lift", "elbow", "w1", "w2", "w3"].map(str::to_owned);
    let (places, told) = axes(&names(&["elbow", "finger", "w3", "lift", "pan", "w2", "w1"]), &own).unwrap();
    assert_eq!(places, [4, 3, 0, 6, 5, 2]);
    assert!(told.by_name && told.others == ["finger"], "{told:?}");
    assert_eq!(told.order, ["elbow", "w3", "lift", "pan", "w2", "w1"]);
    let (places, told) =
        axes(&names(&["l_joint_2", "l_joint_1", "l_joint_3", "l_joint_6", "l_joint_4", "l_joint_5"]), &own).unwrap();
    assert_eq!((places, told.by_name), ([1, 0, 2, 4, 5, 3], false));
    // Two arms, five joints, six without numbers.
    let two: Vec<String> =
        ["l_", "r_"].iter().flat_map(|side| (1..=6).map(move |joint| format!("{side}{joint}"))).collect();
    for wrong in [two, names(&["j1", "j2", "j3", "j4", "j5"]), names(&["a", "b", "c", "d", "e", "f"])] {
        let told = axes(&wrong, &own).unwrap_err();
        assert!(told.contains(&format!("its joints are {}", wrong[0])) && told.contains("pan, lift"), "{told}");
    }
}
