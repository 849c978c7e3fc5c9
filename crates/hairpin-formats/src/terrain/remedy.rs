//! The commands of GDAL that make a map readable.

/// A command of GDAL's.
pub(super) struct Remedy;

impl Remedy {
    /// Projects a file in degrees onto the plane of its centre's UTM zone, or of the pole; of another body, onto a
    /// plane that touches it there.
    pub(super) fn project(file: &str, [lon, lat]: [f64; 2], radius: Option<f64>) -> String {
        let lon = (lon + 180.0).rem_euclid(360.0) - 180.0;
        let target = match radius {
            Some(radius) if !(6.2e6..6.5e6).contains(&radius) => {
                format!("'+proj=stere +lat_0={lat:.4} +lon_0={lon:.4} +R={radius} +units=m'")
            }
            _ => format!("EPSG:{}", utm_zone(lon, lat)),
        };
        let out = beside(file, "projected");
        format!("gdalwarp -t_srs {target} -r bilinear {} {out}", quoted(file))
    }

    /// Rewrites a file with what every reader knows.
    pub(super) fn rewrite(file: &str, options: &str) -> String {
        format!("gdal_translate {options}{} {}", quoted(file), beside(file, "plain"))
    }

    /// Takes one page of a file of several, from 1.
    pub(super) fn page(file: &str, page: usize) -> String {
        let source = quoted(&format!("GTIFF_DIR:{page}:{file}"));
        format!("gdal_translate {source} {}", beside(file, "plain"))
    }

    /// Makes heights in metres of depths of which one is so many `metres`, in the plane of the code, if it has one.
    pub(super) fn rise(file: &str, metres: f64, epsg: Option<u32>) -> String {
        let out = beside(file, "heights");
        let factor = if metres == 1.0 { String::new() } else { format!("{metres}*") };
        let plane = epsg.map_or("PLANE".to_owned(), |code| format!("EPSG:{code}"));
        let file = quoted(file);
        format!("gdal_calc.py -A {file} --calc='-{factor}A' --outfile={out} && gdal_edit.py -a_srs {plane} {out}")
    }

    /// Turns a raster upright.
    pub(super) fn warp(file: &str) -> String {
        format!("gdalwarp -r bilinear {} {}", quoted(file), beside(file, "upright"))
    }
}

/// The EPSG code of the UTM zone, or of the polar stereographic plane, at a place, in degrees.
fn utm_zone(lon: f64, lat: f64) -> u32 {
    let north = lat >= 0.0;
    if !(-80.0..=84.0).contains(&lat) {
        return if north { 32661 } else { 32761 };
    }
    let zone = (((lon + 180.0) / 6.0).floor() as u32 + 1).clamp(1, 60);
    if north { 32600 + zone } else { 32700 + zone }
}

fn beside(file: &str, what: &str) -> String {
    let stem = match file.rfind('.') {
        Some(dot) if !file[dot..].contains(['/', '\\']) => &file[..dot],
        _ => file,
    };
    quoted(&format!("{stem}_{what}.tif"))
}

fn quoted(file: &str) -> String {
    shlex::try_quote(file).map_or_else(|_| "FILE".to_owned(), |quoted| quoted.into_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn zones_are_those_of_the_place() {
        for (lon, lat, code) in [
            (8.54, 47.4, 32632),
            (-70.3, -24.0, 32719),
            (180.0, 10.0, 32660),
            (-180.0, 10.0, 32601),
            (0.0, 0.0, 32631),
            (10.0, 85.0, 32661),
            (10.0, -85.0, 32761),
        ] {
            assert_eq!(utm_zone(lon, lat), code);
        }
        let east = Remedy::project("a map.tif", [351.0, -5.0], None);
        assert_eq!(east, "gdalwarp -t_srs EPSG:32729 -r bilinear 'a map.tif' 'a map_projected.tif'");
        assert!(
            Remedy::project("m.tif", [0.0, 4.0], Some(3_396_190.0)).contains("+lat_0=4.0000 +lon_0=0.0000 +R=3396190")
        );
        assert_eq!(
            Remedy::rise("d.tif", 0.3048, Some(32632)),
            "gdal_calc.py -A d.tif --calc='-0.3048*A' --outfile=d_heights.tif && \
             gdal_edit.py -a_srs EPSG:32632 d_heights.tif"
        );
        assert_eq!(Remedy::page("a map.tif", 2), "gdal_translate 'GTIFF_DIR:2:a map.tif' 'a map_plain.tif'");
        assert_eq!(Remedy::rewrite("x/a.b/m", "-b 1 "), "gdal_translate -b 1 x/a.b/m x/a.b/m_plain.tif");
    }
}
