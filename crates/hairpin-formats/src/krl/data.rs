//! Positions and frames as KRL spells them.

use std::collections::BTreeMap;

use hairpin::math::rotation::quaternion_from_euler;
use hairpin::trajectory::program::{External, Tool};
use nalgebra::{Isometry3, Quaternion, Translation3, UnitQuaternion};

/// Components of an aggregate at most.
const MOST_COMPONENTS: usize = 64;

/// A position.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Position {
    /// A pose in `$BASE`, m; whether status or turn say which posture.
    Pose { pose: Isometry3<f64>, external: External, posture: bool },
    /// A posture, rad.
    Axes { joints: [f64; 6], external: External },
}

/// `{X 1,Y 2,Z 3,A 4,B 5,C 6,S 2,T 10,E1 0}` or `{A1 0,…}`, with or without its type before it.
pub(super) fn position(text: &str) -> Result<Position, String> {
    let mut all = components(text)?;
    let mut external = [None; 6];
    for (axis, name) in external.iter_mut().zip(["E1", "E2", "E3", "E4", "E5", "E6"]) {
        // An axis that is not there is 0 as well: what stays at 0 moves nothing.
        *axis = all.remove(name).filter(|value| *value != 0.0);
    }
    let posture = [all.remove("S"), all.remove("T")].iter().any(Option::is_some);
    let position = if all.contains_key("A1") {
        let joints = take(&mut all, ["A1", "A2", "A3", "A4", "A5", "A6"])?.map(f64::to_radians);
        Position::Axes { joints, external }
    } else {
        Position::Pose { pose: taken(&mut all)?, external, posture }
    };
    rest(&all)?;
    Ok(position)
}

/// `{X 1,Y 2,Z 3,A 4,B 5,C 6}`, m.
pub(super) fn frame(text: &str) -> Result<Isometry3<f64>, String> {
    if text.trim().eq_ignore_ascii_case("$NULLFRAME") {
        return Ok(Isometry3::identity());
    }
    let mut all = components(text)?;
    let frame = taken(&mut all)?;
    rest(&all)?;
    Ok(frame)
}

/// `{M 2.5,CM {X 1,Y 2,Z 3,A 0,B 0,C 0},J {X 0,Y 0,Z 0}}` as the load of the flange's tool.
pub(super) fn load(text: &str) -> Result<Tool, String> {
    let part = |name: &str| {
        let (before, rest) = text.split_once(&format!("{name} {{")).ok_or_else(|| format!("{name} is missing"))?;
        let (inside, after) = rest.split_once('}').ok_or_else(|| format!("{name} has no end"))?;
        Ok::<_, String>((before, format!("{{{inside}}}"), after))
    };
    let (before, centre, between) = part("CM")?;
    let (_, moments, after) = part("J")?;
    let mass = before.trim().strip_prefix('{').and_then(|mass| mass.trim().strip_prefix("M "));
    let mass = mass.and_then(|mass| number(mass.trim_end().trim_end_matches(',').trim()));
    let is_whole = between.trim_start().starts_with(',') && between.contains("J {") && after.trim() == "}";
    let mass = mass.filter(|mass| *mass > 0.0 && is_whole).ok_or("is not `{M …,CM {…},J {…}}` of a mass")?;
    let (centre, mut moments) = (frame(&centre)?, components(&moments)?);
    let inertia = take(&mut moments, ["X", "Y", "Z"])?;
    rest(&moments)?;
    Ok(Tool {
        mass,
        centre_of_gravity: centre.translation.vector,
        axes_of_inertia: centre.rotation,
        inertia,
        ..Tool::flange()
    })
}

fn taken(all: &mut BTreeMap<String, f64>) -> Result<Isometry3<f64>, String> {
    let [x, y, z, a, b, c] = take(all, ["X", "Y", "Z", "A", "B", "C"])?;
    let q = quaternion_from_euler(c.to_radians(), b.to_radians(), a.to_radians());
    let turn = UnitQuaternion::new_normalize(Quaternion::new(q[0], q[1], q[2], q[3]));
    Ok(Isometry3::from_parts(Translation3::new(x / 1000.0, y / 1000.0, z / 1000.0), turn))
}

fn take<const N: usize>(all: &mut BTreeMap<String, f64>, names: [&str; N]) -> Result<[f64; N], String> {
    let mut numbers = [0.0; N];
    for (number, name) in numbers.iter_mut().zip(names) {
        *number = all.remove(name).ok_or_else(|| format!("{name} is missing: what is left out stays as it was"))?;
    }
    Ok(numbers)
}

fn rest(all: &BTreeMap<String, f64>) -> Result<(), String> {
    all.keys().next().map_or(Ok(()), |name| Err(format!("`{}` is no component that is known", name.escape_default())))
}

fn components(text: &str) -> Result<BTreeMap<String, f64>, String> {
    let inside = text.trim().strip_prefix('{').and_then(|text| text.strip_suffix('}'));
    let inside = inside.ok_or("expected `{…}`")?;
    let inside = inside.split_once(':').map_or(inside, |(_, inside)| inside);
    let mut all = BTreeMap::new();
    for part in inside.split(',') {
        let (name, value) = part.trim().split_once(char::is_whitespace).unwrap_or((part.trim(), ""));
        let value = number(value.trim()).ok_or_else(|| format!("`{}` has no number", name.escape_default()))?;
        if all.insert(name.to_ascii_uppercase(), value).is_some() || all.len() > MOST_COMPONENTS {
            return Err(format!(
                "`{}` stands there twice, or with more than {MOST_COMPONENTS} others",
                name.escape_default()
            ));
        }
    }
    Ok(all)
}

/// A decimal number, or a binary one as `'B0110'`.
pub(super) fn number(text: &str) -> Option<f64> {
    if let Some(digits) = text.strip_prefix("'B").and_then(|text| text.strip_suffix('\'')) {
        return i64::from_str_radix(digits, 2).ok().map(|value| value as f64);
    }
    // Rust would take `inf` and `nan`.
    let spelt = text.chars().all(|c| c.is_ascii_digit() || "+-.eE".contains(c));
    text.parse::<f64>().ok().filter(|value| spelt && value.is_finite())
}
