//! Projections that a file defines itself, as PROJ writes them: by the numbers of GeoTIFF's methods, or by the names
//! of well-known text.

/// A projection by its method and its parameters, angles in degrees and lengths in metres.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct Projection {
    pub(super) method: Option<&'static str>,
    pub(super) lat_0: Option<f64>,
    pub(super) lon_0: Option<f64>,
    pub(super) parallels: [Option<f64>; 2],
    pub(super) scale: Option<f64>,
    pub(super) false_origin: [Option<f64>; 2],
    /// Words of the ellipsoid, as PROJ has them; WGS 84 where there are none.
    pub(super) body: String,
}

/// Methods by GeoTIFF's numbers (OGC 19-008r4, annex C).
const METHODS: [(u16, &str); 14] = [
    (1, "tmerc"),
    (7, "merc"),
    (8, "lcc"),
    (9, "lcc"),
    (10, "laea"),
    (11, "aea"),
    (12, "aeqd"),
    (14, "stere"),
    (15, "stere"),
    (16, "sterea"),
    (17, "eqc"),
    (18, "cass"),
    (24, "sinu"),
    (28, "cea"),
];

/// Methods by words in their names, the first that has them all.
const NAMES: [(&[&str], Option<&str>); 21] = [
    // Its axes lie askew, and where its centre is is told in several ways.
    (&["oblique", "mercator"], None),
    (&["hotine"], None),
    (&["south", "orient"], None),
    (&["transverse", "mercator"], Some("tmerc")),
    (&["gauss", "kruger"], Some("tmerc")),
    (&["mercator"], Some("merc")),
    (&["lambert", "azimuthal"], Some("laea")),
    (&["lambert", "cylindrical"], Some("cea")),
    (&["cylindrical", "equal", "area"], Some("cea")),
    (&["lambert", "conic"], Some("lcc")),
    (&["albers"], Some("aea")),
    (&["azimuthal", "equidistant"], Some("aeqd")),
    (&["double", "stereographic"], Some("sterea")),
    (&["oblique", "stereographic"], Some("sterea")),
    (&["stereographic"], Some("stere")),
    (&["equirectangular"], Some("eqc")),
    (&["plate", "carree"], Some("eqc")),
    (&["equidistant", "cylindrical"], Some("eqc")),
    (&["cassini"], Some("cass")),
    (&["sinusoidal"], Some("sinu")),
    (&["mollweide"], Some("moll")),
];

/// The method of this number.
pub(super) fn of_number(number: u16) -> Option<&'static str> {
    METHODS.iter().find(|(known, _)| *known == number).map(|(_, method)| *method)
}

/// The method of this name.
pub(super) fn of_name(name: &str) -> Option<&'static str> {
    let name = name.to_ascii_lowercase();
    NAMES.iter().find(|(words, _)| words.iter().all(|word| name.contains(word))).and_then(|(_, method)| *method)
}

impl Projection {
    /// As PROJ has it; `None` where its method is not known, or it lacks what that needs.
    pub(super) fn text(&self) -> Option<String> {
        let method = self.method?;
        let [first, second] = self.parallels;
        let is_polar = method == "stere" && (first.is_some() || self.lat_0.is_some_and(|lat| lat.abs() > 60.0));
        let (mut lat_0, mut lat_ts, mut parallels) = (self.lat_0, None, [None; 2]);
        match method {
            "lcc" => parallels = [first.or(self.lat_0), second],
            "aea" => parallels = [first, second.or(first)],
            "merc" | "eqc" | "cea" => lat_ts = first,
            "stere" if is_polar => {
                // The parallel that is true is told as one, or as the latitude of the origin.
                let told = first.or(self.lat_0)?;
                (lat_0, lat_ts) =
                    (Some(90f64.copysign(told)), Some(told).filter(|_| self.scale.is_none_or(|k| k == 1.0)));
            }
            _ => {}
        }
        if matches!(method, "aea" | "lcc") {
            parallels[0]?;
        }
        let mut words = format!("+proj={method}");
        for (key, value) in [
            ("lat_0", lat_0),
            ("lon_0", self.lon_0),
            ("lat_ts", lat_ts),
            ("lat_1", parallels[0]),
            ("lat_2", parallels[1]),
            ("k_0", self.scale.filter(|k| *k > 0.0)),
            ("x_0", self.false_origin[0]),
            ("y_0", self.false_origin[1]),
        ] {
            if let Some(value) = value {
                words.push_str(&format!(" +{key}={value}"));
            }
        }
        let body = if self.body.is_empty() { "+ellps=WGS84" } else { &self.body };
        Some(format!("{words} {body} +units=m"))
    }
}

/// The words of an ellipsoid's axes, m: the semi-major one, and the flattening's inverse, 0 of a sphere.
pub(super) fn body(radius: f64, inverse_flattening: f64) -> String {
    let flat = inverse_flattening > 0.0;
    let minor = if flat { radius * (1.0 - 1.0 / inverse_flattening) } else { radius };
    format!("+a={radius} +b={minor}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn methods_are_told_by_their_names() {
        for (name, method) in [
            ("Transverse_Mercator", Some("tmerc")),
            ("Mercator_1SP", Some("merc")),
            ("Lambert Conic Conformal (2SP)", Some("lcc")),
            ("Lambert_Azimuthal_Equal_Area", Some("laea")),
            ("Lambert Cylindrical Equal Area", Some("cea")),
            ("Hotine_Oblique_Mercator", None),
            ("Plate_Carree", Some("eqc")),
            ("Polar Stereographic (variant B)", Some("stere")),
            ("Unheard Of", None),
        ] {
            assert_eq!(of_name(name), method, "{name}");
        }
        assert_eq!((of_number(17), of_number(27), of_number(99)), (Some("eqc"), None, None));
    }

    #[test]
    fn projections_are_written_as_proj_has_them() {
        let polar = Projection {
            method: Some("stere"),
            lat_0: Some(-71.0),
            lon_0: Some(0.0),
            body: body(6_378_137.0, 298.257_223_563),
            ..Projection::default()
        };
        let text = polar.text().unwrap();
        assert!(text.starts_with("+proj=stere +lat_0=-90 +lon_0=0 +lat_ts=-71 +a=6378137 +b=6356752.314"), "{text}");
        let conic = Projection { method: Some("lcc"), ..Projection::default() };
        assert_eq!((conic.text(), Projection::default().text()), (None, None));
    }
}
