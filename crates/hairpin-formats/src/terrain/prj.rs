//! The `.prj` beside a raster: well-known text of a coordinate system, as ESRI or OGC write it (OGC 01-009, and 18-010
//! for its newer words).

use super::error::TerrainError;
use super::projection::{self, Projection};
use super::reference::{Model, Reference};
use super::unit::Unit;
use super::vertical::{Depth, Vertical, is_depth, system};

/// Brackets within brackets, at most: coordinate systems have six.
const DEEPEST: usize = 32;

/// One `WORD["name", …]`.
struct Node<'t> {
    word: &'t str,
    /// The texts and numbers in it, quotes taken off.
    values: Vec<&'t str>,
    nodes: Vec<Self>,
}

/// What a text says of the plane.
pub(super) fn read(text: &str) -> Result<Reference, TerrainError> {
    let broken = || TerrainError::Broken("its .prj is no well-known text of a coordinate system".into());
    let mut rest = text.trim_start_matches('\u{feff}').trim();
    let root = node(&mut rest, 0).ok_or_else(broken)?;
    let plane = of(&root).ok_or_else(broken)?;
    rest = rest.trim_start_matches(|c: char| c.is_whitespace() || c == ',');
    if rest.is_empty() {
        return Ok(plane);
    }
    // ESRI has the system of heights behind that of the plane.
    let heights = node(&mut rest, 0).filter(|node| node.is(&VERTICAL) && rest.trim().is_empty()).ok_or_else(broken)?;
    Ok(heights.heights_of(plane))
}

const VERTICAL: [&str; 3] = ["VERT_CS", "VERTCS", "VERTCRS"];

fn of(root: &Node<'_>) -> Option<Reference> {
    let name = root.values.first().copied().unwrap_or_default().to_owned();
    let spheroid = root.find(&["SPHEROID", "ELLIPSOID"]);
    let radius = spheroid.and_then(|spheroid| spheroid.values.get(1)?.parse().ok());
    let said = Reference { epsg: root.epsg(), name, radius, ..Reference::default() };
    match root.word.to_ascii_uppercase().as_str() {
        "GEOGCS" | "GEOGCRS" | "GEODCRS" => {
            let unit = root.nodes.iter().rev().find(|node| node.is(&["UNIT", "ANGLEUNIT"]));
            let radians = unit.and_then(|unit| unit.values.get(1)?.parse::<f64>().ok()).unwrap_or(1f64.to_radians());
            Some(Reference { model: Model::Geographic, degrees: radians.to_degrees(), ..said })
        }
        "GEOCCS" => Some(Reference { model: Model::Geocentric, ..said }),
        "PROJCS" | "PROJCRS" => {
            let unit = root.nodes.iter().rev().find(|node| node.is(&["UNIT", "LENGTHUNIT"]));
            // Newer text has the unit in its axes where they share one.
            let unit = unit.or_else(|| root.find(&["LENGTHUNIT"]));
            let epsg = said.epsg.or_else(|| code_of_name(&said.name));
            let plane = in_unit(unit, said);
            let projection = root.projection(plane.unit.as_ref().map_or(1.0, |unit| unit.metres));
            Some(Reference { model: Model::Projected, epsg, projection, ..plane })
        }
        // A yard's own plane.
        "LOCAL_CS" | "ENGCRS" | "ENGINEERINGCRS" => {
            let unit = root.find(&["UNIT", "LENGTHUNIT"]);
            Some(Reference { model: Model::Local, epsg: None, ..in_unit(unit, said) })
        }
        // A plane with heights: what it says of the plane comes first.
        "COMPD_CS" | "COMPOUNDCRS" => {
            let plane = root.nodes.iter().find_map(of)?;
            let vertical = root.nodes.iter().find(|node| node.is(&VERTICAL));
            Some(match vertical {
                Some(vertical) => vertical.heights_of(plane),
                None => plane,
            })
        }
        _ => None,
    }
}

/// With the unit of x and y, where there is one.
fn in_unit(node: Option<&Node<'_>>, plane: Reference) -> Reference {
    let Some(node) = node else { return plane };
    let unit = node.values.get(1).and_then(|metres| Unit::of_length(metres.parse().ok()?));
    let unknown = || format!("a unit of length \"{}\" in its .prj", node.values.first().copied().unwrap_or_default());
    let unknown_unit = unit.is_none().then(unknown);
    Reference { unit, unknown_unit, ..plane }
}

/// ESRI's texts have no codes, but names.
fn code_of_name(name: &str) -> Option<u32> {
    let name = name.replace(' ', "_").to_ascii_lowercase();
    match name.as_str() {
        "wgs_1984_web_mercator_auxiliary_sphere" => return Some(3857),
        "etrs_1989_laea" => return Some(3035),
        _ => {}
    }
    let (datum, zone) = name.split_once("_utm_zone_")?;
    let (number, hemisphere) = zone.split_at_checked(zone.len().checked_sub(1)?)?;
    let number: u32 = number.parse().ok().filter(|zone| (1..=60).contains(zone))?;
    match (datum, hemisphere) {
        ("wgs_1984", "n") => Some(32600 + number),
        ("wgs_1984", "s") => Some(32700 + number),
        ("etrs_1989", "n") if (28..=38).contains(&number) => Some(25800 + number),
        ("nad_1983", "n") if (1..=23).contains(&number) => Some(26900 + number),
        _ => None,
    }
}

impl<'t> Node<'t> {
    fn is(&self, words: &[&str]) -> bool {
        words.iter().any(|word| self.word.eq_ignore_ascii_case(word))
    }

    fn find(&self, words: &[&str]) -> Option<&Node<'t>> {
        self.nodes.iter().find_map(|node| if node.is(words) { Some(node) } else { node.find(words) })
    }

    /// `plane` with what this system says of heights.
    fn heights_of(&self, plane: Reference) -> Reference {
        let known = self.epsg().and_then(|code| u16::try_from(code).ok()).map(system);
        let (by_code, falls_by_code) = match known {
            Some(Vertical::Up(unit)) => (Some(unit), false),
            Some(Vertical::Down(unit)) => (Some(unit), true),
            _ => (None, false),
        };
        let written = self.find(&["UNIT", "LENGTHUNIT"]);
        let unit = match written {
            Some(unit) => unit.values.get(1).and_then(|metres| Unit::of_length(metres.parse().ok()?)),
            None => by_code,
        };
        let name = self.values.first().copied().unwrap_or_default();
        let falls = falls_by_code || is_depth(name) || self.nodes.iter().any(Node::points_down);
        let metres = unit.as_ref().map_or(1.0, |unit| unit.metres);
        let depth = falls.then(|| Depth { said: format!("\"{name}\" in its .prj"), metres });
        let unknown = || format!("heights of \"{name}\" in its .prj, without a length of their unit");
        let unknown_heights = unit.is_none().then(unknown);
        Reference { height_unit: unit, unknown_heights, depth, ..plane }
    }

    /// The projection of a plane whose unit is so many `metres`, as PROJ has it.
    fn projection(&self, metres: f64) -> Option<String> {
        let method = self.find(&["PROJECTION", "METHOD"])?.values.first().copied()?;
        let mut found = Projection { method: projection::of_name(method), ..Projection::default() };
        let spheroid = self.find(&["SPHEROID", "ELLIPSOID"]);
        let number = |node: &Node<'_>, place: usize| node.values.get(place)?.parse::<f64>().ok();
        if let Some((radius, flattening)) = spheroid.and_then(|of| Some((number(of, 1)?, number(of, 2)?))) {
            found.body = projection::body(radius, flattening);
        }
        for node in self.all(&["PARAMETER"]) {
            let (Some(name), Some(value)) = (node.values.first(), number(node, 1)) else { continue };
            let name = name.to_ascii_lowercase().replace('_', " ");
            let has = |words: &[&str]| words.iter().all(|word| name.contains(word));
            let slot = match () {
                () if has(&["standard parallel", "2"]) || has(&["2nd standard"]) => &mut found.parallels[1],
                () if has(&["standard parallel"]) => &mut found.parallels[0],
                () if has(&["scale"]) => &mut found.scale,
                () if has(&["easting"]) => &mut found.false_origin[0],
                () if has(&["northing"]) => &mut found.false_origin[1],
                () if has(&["latitude"]) || has(&["parallel"]) => &mut found.lat_0,
                () if has(&["longitude"]) || has(&["meridian"]) => &mut found.lon_0,
                // One that is not known may be what the rest depends on.
                () => return None,
            };
            let is_length = name.contains("easting") || name.contains("northing");
            *slot = Some(if is_length { value * metres } else { value });
        }
        found.text()
    }

    /// All nodes of these words within.
    fn all(&self, words: &[&str]) -> Vec<&Node<'t>> {
        let mut found = Vec::new();
        for node in &self.nodes {
            found.extend(Some(node).filter(|node| node.is(words)));
            found.extend(node.all(words));
        }
        found
    }

    /// Whether it is the axis of a depth, or Esri's direction of one.
    fn points_down(&self) -> bool {
        let down = |value: &&str| value.eq_ignore_ascii_case("down");
        let falls = |value: &&str| value.parse().is_ok_and(|direction: f64| direction < 0.0);
        let is_direction = self.values.first().is_some_and(|name| name.eq_ignore_ascii_case("direction"));
        self.is(&["AXIS"]) && self.values.iter().any(down)
            || self.is(&["PARAMETER"]) && is_direction && self.values.get(1).is_some_and(falls)
    }

    fn epsg(&self) -> Option<u32> {
        let authority = self.nodes.iter().rev().find(|node| node.is(&["AUTHORITY", "ID"]))?;
        let [name, code, ..] = authority.values[..] else { return None };
        code.parse().ok().filter(|_| name.eq_ignore_ascii_case("EPSG"))
    }
}

fn node<'t>(rest: &mut &'t str, depth: usize) -> Option<Node<'t>> {
    if depth > DEEPEST {
        return None;
    }
    let open = rest.find(['[', '('])?;
    let word = rest[..open].trim();
    if word.is_empty() || !word.chars().all(|c| c.is_ascii_alphanumeric() || c == '_') {
        return None;
    }
    *rest = &rest[open + 1..];
    let mut node_of = Node { word, values: Vec::new(), nodes: Vec::new() };
    loop {
        *rest = rest.trim_start_matches(|c: char| c.is_whitespace() || c == ',');
        match rest.chars().next()? {
            ']' | ')' => {
                *rest = &rest[1..];
                return Some(node_of);
            }
            '"' => {
                let end = rest[1..].find('"')? + 1;
                node_of.values.push(&rest[1..end]);
                *rest = &rest[end + 1..];
            }
            _ => {
                let end = rest.find([',', '[', '(', ']', ')'])?;
                if rest[end..].starts_with(['[', '(']) {
                    node_of.nodes.push(node(rest, depth + 1)?);
                } else {
                    node_of.values.push(rest[..end].trim());
                    *rest = &rest[end..];
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const DEGREES: &str = r#"GEOGCS["GCS_WGS_1984",DATUM["D_WGS_1984",SPHEROID["WGS_1984",6378137.0,298.257223563]],PRIMEM["Greenwich",0.0],UNIT["Degree",0.0174532925199433]]"#;

    #[test]
    fn planes_and_degrees_are_told_apart() {
        let utm = format!(
            r#"PROJCS["WGS_1984_UTM_Zone_32N",{DEGREES},PROJECTION["Transverse_Mercator"],PARAMETER["False_Easting",500000.0],UNIT["Meter",1.0]]"#
        );
        let read_utm = read(&utm).unwrap();
        assert_eq!((read_utm.model, read_utm.epsg), (Model::Projected, Some(32632)));
        assert!(read_utm.unit.unwrap().is_metre());
        let feet =
            utm.replace(r#"UNIT["Meter",1.0]"#, r#"UNIT["Foot_US",0.3048006096012192],AUTHORITY["EPSG","2263"]"#);
        let feet = read(&feet).unwrap();
        assert_eq!((feet.epsg, feet.unit.unwrap().name.as_str()), (Some(2263), "US survey ft"));
        let degrees = read(DEGREES).unwrap();
        assert_eq!((degrees.model, degrees.radius), (Model::Geographic, Some(6_378_137.0)));
        assert!((degrees.degrees - 1.0).abs() < 1e-12);
        let both = format!(r#"COMPD_CS["both",{utm},VERT_CS["heights",VERT_DATUM["d",2005],UNIT["foot",0.3048]]]"#);
        let both = read(&both).unwrap();
        assert_eq!((both.epsg, both.height_unit.unwrap().name.as_str()), (Some(32632), "ft"));
        let esri = format!(
            r#"{utm},VERTCS["NAVD_1988_Foot_US",VDATUM["North_American_Vertical_Datum_1988"],PARAMETER["Direction",1.0],UNIT["Foot_US",0.3048006096012192]]"#
        );
        assert_eq!(read(&esri).unwrap().height_unit.unwrap().name, "US survey ft");
        assert!(read(&format!("{utm},{DEGREES}")).is_err(), "two systems of the plane");
        let up = read(&format!(r#"{utm},VERT_CS["MSL",VERT_DATUM["m",2005],UNIT["metre",1],AXIS["Up",UP]]"#)).unwrap();
        assert_eq!((up.depth, up.unknown_heights, up.height_unit), (None, None, Some(Unit::metre())));
        for (heights, metres) in [
            (r#"VERT_CS["MSL",VERT_DATUM["m",2005],UNIT["metre",1],AXIS["Depth",DOWN]]"#, 1.0),
            (r#"VERTCS["MSL_Depth",VDATUM["m"],PARAMETER["Direction",1.0],UNIT["Foot",0.3048]]"#, 0.3048),
            (r#"VERTCS["MSL",VDATUM["m"],PARAMETER["Direction",-1.0],UNIT["Meter",1.0]]"#, 1.0),
            (r#"VERTCRS["d",VDATUM["m"],CS[vertical,1],AXIS["(D)",down,LENGTHUNIT["metre",1]],ID["EPSG",5715]]"#, 1.0),
        ] {
            assert_eq!(read(&format!("{utm},{heights}")).unwrap().depth.unwrap().metres, metres, "{heights}");
        }
        let unsaid = read(&format!(r#"{utm},VERT_CS["h",VERT_DATUM["d",2005]]"#)).unwrap();
        assert!(unsaid.unknown_heights.is_some());
        let yard = read(r#"LOCAL_CS["yard",UNIT["foot",0.3048]]"#).unwrap();
        assert_eq!((yard.epsg, yard.unit.unwrap().name.as_str()), (None, "ft"));
        let newer = r#"PROJCRS["WGS 84 / UTM zone 19S",CS[Cartesian,2],AXIS["(E)",east,LENGTHUNIT["metre",1]],ID["EPSG",32719]]"#;
        assert_eq!(read(newer).unwrap().epsg, Some(32719));
    }

    #[test]
    fn other_texts_are_refused() {
        let deep = "A[".repeat(100_000);
        for text in ["", "[", "GEOGCS[", "hello", "Projection UTM\nZone 32", "VERT_CS[\"x\"]", deep.as_str()] {
            assert!(read(text).is_err(), "{:?}", text.get(..20));
        }
    }
}
