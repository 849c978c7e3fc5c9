//! Kinds of data and what they are made of.

/// A kind of data that is understood.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum DataKind {
    Num,
    Dnum,
    Bool,
    Text,
    Pos,
    Orient,
    Pose,
    ConfData,
    ExtJoint,
    RobJoint,
    RobTarget,
    JointTarget,
    LoadData,
    ToolData,
    WobjData,
    SpeedData,
    ZoneData,
}

use DataKind::{
    Bool, ConfData, Dnum, ExtJoint, JointTarget, LoadData, Num, Orient, Pos, Pose, RobJoint, RobTarget, SpeedData,
    Text, ToolData, WobjData, ZoneData,
};

/// Name of a component and its kind.
type Component = (&'static str, DataKind);

const NAMES: [(&str, DataKind); 17] = [
    ("num", Num),
    ("dnum", Dnum),
    ("bool", Bool),
    ("string", Text),
    ("pos", Pos),
    ("orient", Orient),
    ("pose", Pose),
    ("confdata", ConfData),
    ("extjoint", ExtJoint),
    ("robjoint", RobJoint),
    ("robtarget", RobTarget),
    ("jointtarget", JointTarget),
    ("loaddata", LoadData),
    ("tooldata", ToolData),
    ("wobjdata", WobjData),
    ("speeddata", SpeedData),
    ("zonedata", ZoneData),
];

impl DataKind {
    /// The kind of a name in lower case.
    pub(super) fn of(name: &str) -> Option<Self> {
        NAMES.iter().find(|(known, _)| *known == name).map(|(_, kind)| *kind)
    }

    /// Its name.
    pub(super) fn name(self) -> &'static str {
        NAMES.iter().find(|(_, kind)| *kind == self).map_or("", |(name, _)| name)
    }

    /// Its components in order; none for what is not a record.
    pub(super) fn components(self) -> &'static [Component] {
        match self {
            Num | Dnum | Bool | Text => &[],
            Pos => &[("x", Num), ("y", Num), ("z", Num)],
            Orient => &[("q1", Num), ("q2", Num), ("q3", Num), ("q4", Num)],
            Pose => &[("trans", Pos), ("rot", Orient)],
            ConfData => &[("cf1", Num), ("cf4", Num), ("cf6", Num), ("cfx", Num)],
            ExtJoint => {
                &[("eax_a", Num), ("eax_b", Num), ("eax_c", Num), ("eax_d", Num), ("eax_e", Num), ("eax_f", Num)]
            }
            RobJoint => {
                &[("rax_1", Num), ("rax_2", Num), ("rax_3", Num), ("rax_4", Num), ("rax_5", Num), ("rax_6", Num)]
            }
            RobTarget => &[("trans", Pos), ("rot", Orient), ("robconf", ConfData), ("extax", ExtJoint)],
            JointTarget => &[("robax", RobJoint), ("extax", ExtJoint)],
            LoadData => &[("mass", Num), ("cog", Pos), ("aom", Orient), ("ix", Num), ("iy", Num), ("iz", Num)],
            ToolData => &[("robhold", Bool), ("tframe", Pose), ("tload", LoadData)],
            WobjData => &[("robhold", Bool), ("ufprog", Bool), ("ufmec", Text), ("uframe", Pose), ("oframe", Pose)],
            SpeedData => &[("v_tcp", Num), ("v_ori", Num), ("v_leax", Num), ("v_reax", Num)],
            ZoneData => &[
                ("finep", Bool),
                ("pzone_tcp", Num),
                ("pzone_ori", Num),
                ("pzone_eax", Num),
                ("zone_ori", Num),
                ("zone_leax", Num),
                ("zone_reax", Num),
            ],
        }
    }
}
