//! Numbers and data as RAPID spells them.

use hairpin::trajectory::program::{
    DECIMALS, External, JointTarget, PoseTarget, QUATERNION_DECIMALS, Speed, Tool, WorkObject, Zone,
};
use nalgebra::{Isometry3, UnitQuaternion, Vector3};

use crate::banner::plain;
use crate::decimal::decimal;

fn list(numbers: impl IntoIterator<Item = String>) -> String {
    format!("[{}]", numbers.into_iter().collect::<Vec<_>>().join(","))
}

fn number(value: f64) -> String {
    decimal(value, DECIMALS)
}

fn millimetres(vector: &Vector3<f64>) -> String {
    list(vector.iter().map(|m| number(m * 1000.0)))
}

fn orient(q: &UnitQuaternion<f64>) -> String {
    list([q.w, q.i, q.j, q.k].map(|component| decimal(component, QUATERNION_DECIMALS)))
}

fn external(axes: &External) -> String {
    list(axes.iter().map(|axis| axis.map_or_else(|| "9E9".into(), number)))
}

fn pose(pose: &Isometry3<f64>) -> String {
    list([millimetres(&pose.translation.vector), orient(&pose.rotation)])
}

/// A `robtarget`. An unknown configuration is written as zeros.
pub(super) fn robtarget(target: &PoseTarget) -> String {
    let configuration = target.configuration.unwrap_or_default();
    list([
        millimetres(&target.pose.translation.vector),
        orient(&target.pose.rotation),
        list(configuration.iter().map(i32::to_string)),
        external(&target.external),
    ])
}

/// A `jointtarget`.
pub(super) fn jointtarget(target: &JointTarget) -> String {
    list([list(target.joints.iter().map(|q| number(q.to_degrees()))), external(&target.external)])
}

/// A `speeddata`; `vmax` is no number and must be written by its name.
pub(super) fn speeddata(speed: &Speed) -> String {
    list([
        number(speed.tcp * 1000.0),
        number(speed.orientation.to_degrees()),
        number(speed.linear_external * 1000.0),
        number(speed.rotating_external.to_degrees()),
    ])
}

/// A `zonedata`.
pub(super) fn zonedata(zone: &Zone) -> String {
    let lengths = [zone.tcp, zone.path_orientation, zone.path_external].map(|m| number(m * 1000.0));
    let rest = [
        number(zone.orientation.to_degrees()),
        number(zone.linear_external * 1000.0),
        number(zone.rotating_external.to_degrees()),
    ];
    list([truth(zone.fine)].into_iter().chain(lengths).chain(rest))
}

/// A `tooldata`.
pub(super) fn tooldata(tool: &Tool) -> String {
    let load = list(
        [number(tool.mass), millimetres(&tool.centre_of_gravity), orient(&tool.axes_of_inertia)]
            .into_iter()
            .chain(tool.inertia.map(number)),
    );
    list([truth(tool.held), pose(&tool.tcp), load])
}

/// A `wobjdata`.
pub(super) fn wobjdata(object: &WorkObject) -> String {
    let unit = object.moved_by.as_deref().unwrap_or_default();
    list([
        truth(object.held),
        truth(object.moved_by.is_none()),
        format!("\"{}\"", plain(unit).replace('\\', "\\\\").replace('"', "\"\"")),
        pose(&object.user),
        pose(&object.object),
    ])
}

/// One number as an optional argument has it.
pub(super) fn seconds(value: f64) -> String {
    number(value)
}

fn truth(value: bool) -> String {
    if value { "TRUE".into() } else { "FALSE".into() }
}
