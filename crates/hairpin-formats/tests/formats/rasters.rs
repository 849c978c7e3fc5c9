//! What elevation maps say of themselves is read: units, planes, scales, masks, orientation; what is not read comes
//! with the command that makes it readable.

use std::path::{Path, PathBuf};

use hairpin::campaign::scenario::MapUnit;
use hairpin::world::terrain::{HoleRule, Terrain};
use hairpin_formats::terrain::{Georeference, MapFile, Sidecars, Source, TerrainError, read_terrain};

fn path(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/fixtures/terrain").join(name)
}

fn read(name: &str, given: &Georeference) -> Result<MapFile, TerrainError> {
    let path = path(name);
    read_terrain(&std::fs::read(&path).expect("a fixture"), name, &Sidecars::beside(&path), given)
}

fn plain(name: &str) -> MapFile {
    read(name, &Georeference::default()).unwrap_or_else(|error| panic!("{name}: {error}"))
}

fn refused(name: &str) -> String {
    read(name, &Georeference::default()).expect_err(name).to_string()
}

/// The hill of all fixtures at a row from the north and a column.
fn hill(row: usize, column: usize) -> f64 {
    let (x, y) = (0.5 * column as f64, 0.5 * row as f64);
    0.3 * (x / 3.0).sin() + 0.2 * (y / 2.0).cos() + 100.0
}

/// Every cell is the hill's, times `metres`, to `precise`.
fn assert_hill(name: &str, file: &MapFile, metres: f64, precise: f64) {
    let map = &file.map;
    let (rows, columns) = (map.grid().rows, map.grid().columns);
    assert_eq!((columns, rows), (24, 20), "{name}");
    for row in 0..rows {
        for column in 0..columns {
            let height = f64::from(map.cell_height(rows - 1 - row, column));
            let wanted = metres * hill(row, column);
            assert!(height.is_nan() || (height - wanted).abs() < precise, "{name}: {height} at ({row}, {column})");
        }
    }
}

#[test]
fn plain_packed_tiled_and_turned_files_hold_one_hill() {
    for name in ["metres.tif", "zstd.tif", "tiled.tif", "south_up.tif", "no_reference.tif"] {
        let file = plain(name);
        assert_hill(name, &file, 1.0, 1e-5);
        assert_eq!(file.map.extent(), ([0.25, 0.25], [11.75, 9.75]), "{name}");
        let code = (name != "no_reference.tif").then_some(32632);
        assert_eq!((file.told.epsg, file.told.layout.south_up), (code, name == "south_up.tif"), "{name}");
        assert_eq!(file.told.offset_m, [0.0, 0.0]);
        let from = if code.is_some() { Source::File } else { Source::Taken };
        assert_eq!((file.told.unit.name.as_str(), file.told.unit_from), ("m", from), "{name}");
    }
    let point = plain("point.tif");
    assert_hill("point.tif", &point, 1.0, 1e-5);
    assert!(point.told.layout.at_centers);
    // GDAL's corner is half a cell from the centre that the file names: the same cells as ever.
    assert_eq!(point.map.extent(), ([0.25, 0.25], [11.75, 9.75]));
}

#[test]
fn scale_and_offset_make_heights_of_values() {
    let file = plain("scale_offset.tif");
    assert_hill("scale_offset.tif", &file, 1.0, 6e-4);
    assert_eq!((file.told.layout.scale, file.told.layout.offset), (0.001, 100.0));
    let heights = (0..480).map(|i| file.map.cell_height(i / 24, i % 24));
    let (low, high) = heights.fold((f32::MAX, f32::MIN), |(low, high), h| (low.min(h), high.max(h)));
    assert!(low >= 99.6 && high <= 100.51, "{low} … {high}");
}

#[test]
fn no_data_in_any_spelling_and_masks_are_holes() {
    let keep_out = Georeference { holes: HoleRule::KeepOut, ..Georeference::default() };
    for (name, holes, masked) in
        [("nan.tif", 3, false), ("mask.tif", 4, true), ("mask_of_deflate.tif", 4, true), ("gdal_nan.asc", 1, false)]
    {
        assert!(matches!(read(name, &Georeference::default()), Err(TerrainError::Map(_))), "{name}");
        let file = read(name, &keep_out).unwrap_or_else(|error| panic!("{name}: {error}"));
        assert_eq!((file.map.holes(), file.told.layout.masked), (holes, masked), "{name}");
    }
    let mask = read("mask.tif", &keep_out).unwrap().map;
    let holed: Vec<usize> = (0..24).filter(|column| mask.cell_height(20 - 1 - 5, *column).is_nan()).collect();
    assert_eq!(holed, [6, 7, 8, 9]);
    let nan = read("gdal_nan.asc", &keep_out).unwrap().map;
    assert!(nan.cell_height(2, 2).is_nan() && nan.cell_height(1, 2) == 1.2);
}

#[test]
fn a_map_is_one_full_page_and_overviews_are_none() {
    assert_hill("overviews.tif", &plain("overviews.tif"), 1.0, 1e-5);
    for (name, words) in [
        ("pages.tif", ["several full pages", "gdal_translate GTIFF_DIR:1:pages.tif pages_plain.tif"]),
        (
            "smaller_first.tif",
            ["a smaller copy", "gdal_translate GTIFF_DIR:2:smaller_first.tif smaller_first_plain.tif"],
        ),
    ] {
        let said = refused(name);
        assert!(words.iter().all(|word| said.contains(word)), "{said}");
    }
}

#[test]
fn degrees_are_refused_with_the_zone_of_the_place() {
    let wanted = "gdalwarp -t_srs EPSG:32632 -r bilinear degrees.tif degrees_projected.tif";
    let said = refused("degrees.tif");
    assert!(said.contains("geographic") && said.contains("EPSG:4326") && said.contains(wanted), "{said}");
    // An ASCII grid says no unit; cells of a quarter of a millimetre on such coordinates are no metres.
    let said = refused("degrees.asc");
    assert!(said.contains("degrees") && said.contains("EPSG:32632") && said.contains("degrees.asc"), "{said}");
    let given = Georeference { unit: Some(MapUnit::M), ..Georeference::default() };
    assert!(read("degrees.asc", &given).is_ok());
    let folder = tempfile::tempdir().unwrap();
    let (asc, prj) = (folder.path().join("a.asc"), folder.path().join("a.prj"));
    let grid = "ncols 2\nnrows 2\nxllcorner -71\nyllcorner -31\ncellsize 0.01\n1 1\n1 1\n";
    std::fs::write(&prj, r#"GEOGCS["GCS_WGS_1984",DATUM["D_WGS_1984",SPHEROID["WGS_1984",6378137.0,298.2]],UNIT["Degree",0.0174532925199433]]"#)
        .unwrap();
    let error = read_terrain(grid.as_bytes(), "a.asc", &Sidecars::beside(&asc), &Georeference::default()).unwrap_err();
    assert!(error.to_string().contains("EPSG:32719"), "{error}");
    let given = Georeference { epsg: Some(4326), ..Georeference::default() };
    let error = read("gdal_nan.asc", &given).unwrap_err().to_string();
    assert!(error.contains("EPSG:4326") && error.contains("gdalwarp"), "{error}");
}

#[test]
fn feet_are_converted_and_told_apart() {
    let us_foot = 1200.0 / 3937.0;
    let file = plain("feet_of_both.tif");
    assert_hill("feet_of_both.tif", &file, us_foot, 1e-5);
    assert_eq!((file.told.unit.name.as_str(), file.told.height_unit.name.as_str()), ("US survey ft", "US survey ft"));
    assert_eq!(file.map.grid().cell, [us_foot, us_foot]);
    let west = file.map.extent().0[0] + file.told.offset_m[0];
    assert!((west - 987_654.5 * us_foot).abs() < 1e-6, "{west}");
    let file = plain("feet_of_height.tif");
    assert_hill("feet_of_height.tif", &file, 0.3048, 1e-5);
    assert_eq!((file.told.unit.name.as_str(), file.told.height_unit.name.as_str()), ("m", "ft"));
    // A plane in feet says nothing of heights: that is asked for, with the key that answers it.
    let said = refused("feet.tif");
    assert!(said.starts_with("height_unit") && said.contains("us-ft"), "{said}");
    let given = Georeference { height_unit: Some(MapUnit::M), ..Georeference::default() };
    assert_hill("feet.tif", &read("feet.tif", &given).unwrap(), 1.0, 1e-5);
    let shown = Georeference { assume_heights: true, ..Georeference::default() };
    assert_eq!(read("feet.tif", &shown).unwrap().told.height_unit_from, Source::Taken);
    let other = Georeference { unit: Some(MapUnit::Ft), ..given };
    let error = read("feet.tif", &other).unwrap_err().to_string();
    assert!(error.contains("unit = ft") && error.contains("US survey ft"), "{error}");
}

#[test]
fn planes_of_the_earth_get_an_origin_of_their_own() {
    for name in ["utm.tif", "utm.asc"] {
        let file = plain(name);
        assert_eq!((file.told.epsg, file.told.offset_m), (Some(32632), [465_000.0, 5_248_000.0]), "{name}");
        assert_eq!(file.map.extent(), ([123.5, 447.0], [135.0, 456.5]), "{name}");
        assert_hill(name, &file, 1.0, 1e-3);
    }
    assert_eq!(plain("laea.tif").told.offset_m, [4_321_000.0, 3_209_000.0]);
    let given = Georeference { offset_m: Some([465_123.0, 5_248_400.0]), ..Georeference::default() };
    assert_eq!(read("utm.tif", &given).unwrap().map.extent().0, [0.5, 47.0]);
    let given = Georeference { epsg: Some(32633), ..Georeference::default() };
    let error = read("utm.tif", &given).unwrap_err().to_string();
    assert_eq!(error, "epsg = 32633: the file says 32632");
    let given = Georeference { epsg: Some(25832), ..Georeference::default() };
    assert_eq!(
        read("gdal_nan.asc", &Georeference { holes: HoleRule::KeepOut, ..given }).unwrap().told.epsg,
        Some(25832)
    );
    let given = Georeference { epsg: Some(12), ..Georeference::default() };
    assert!(read("gdal_nan.asc", &given).unwrap_err().to_string().starts_with("epsg = 12"));
}

#[test]
fn cells_need_not_be_square() {
    let file = plain("dx_dy.asc");
    assert_eq!(file.map.grid().cell, [0.5, 0.25]);
    assert_eq!(file.map.extent(), ([0.25, 0.125], [11.75, 4.875]));
    let height = file.map.height(0.25, 4.875).unwrap();
    assert!((height - hill(0, 0)).abs() < 1e-3, "{height}");
}

#[test]
fn what_is_not_read_comes_with_a_command() {
    for (name, why, command) in [
        ("lerc.tif", "LERC", "gdal_translate -co COMPRESS=DEFLATE lerc.tif lerc_plain.tif"),
        ("two_bands.tif", "2 bands", "gdal_translate -b 1 two_bands.tif two_bands_plain.tif"),
        ("rotated.tif", "rotated", "gdalwarp -r bilinear rotated.tif rotated_upright.tif"),
    ] {
        let said = refused(name);
        assert!(said.contains(why) && said.contains(command), "{said}");
    }
    // What GDAL notes beside a file is as good as in it, to whoever reads both.
    let folder = tempfile::tempdir().unwrap();
    let tif = folder.path().join("map.tif");
    let bytes = std::fs::read(path("metres.tif")).unwrap();
    let read = || read_terrain(&bytes, "map.tif", &Sidecars::beside(&tif), &Georeference::default());
    let note = |band: &str| {
        let text = format!("<PAMDataset><PAMRasterBand band=\"1\">{band}</PAMRasterBand></PAMDataset>");
        std::fs::write(folder.path().join("map.tif.aux.xml"), text).unwrap();
    };
    note("<Metadata><MDI key=\"STATISTICS_MEAN\">100</MDI></Metadata>");
    assert!(read().is_ok());
    for band in ["<Scale>0.1</Scale>", "<NoDataValue>0</NoDataValue>", "<UnitType>ft</UnitType>"] {
        note(band);
        let said = read().unwrap_err().to_string();
        assert!(said.contains("gdal_translate map.tif map_plain.tif"), "{said}");
    }
    note("");
    std::fs::write(folder.path().join("map.tif.msk"), "").unwrap();
    assert!(read().unwrap_err().to_string().contains(".msk"));
}

const FEET: &str = r#"PROJCS["p",GEOGCS["g",DATUM["d",SPHEROID["s",6378137,298.257222101]],UNIT["Degree",0.0174532925199433]],PROJECTION["Transverse_Mercator"],UNIT["Foot_US",0.3048006096012192]],VERTCS["h",VDATUM["v"],UNIT["Foot",0.3048]]"#;

/// Keys in metres place pictures and raw files: the unit of the plane that a `.prj` names is not theirs.
#[test]
fn what_keys_place_is_in_metres_whatever_lies_beside_it() {
    let values: Vec<u8> = [0_u16, 32_768, 65_535, 65_535].iter().flat_map(|value| value.to_le_bytes()).collect();
    let given = Georeference { cell_m: Some(2.0), height_m: Some([0.0, 10.0]), ..Georeference::default() };
    let beside = Sidecars::of(Some(FEET.into()), None);
    let map = read_terrain(&values, "a.raw", &beside, &given).unwrap().map;
    assert_eq!((map.extent(), map.cell_height(0, 0)), (([0.0, 0.0], [2.0, 2.0]), 10.0));
}

/// ESRI has the system of heights behind that of the plane, and heights in feet are no metres.
#[test]
fn what_lies_beside_a_map_and_is_not_understood_is_refused() {
    let grid = "ncols 2\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 1\n1 1\n1 1\n";
    let read = |beside: &Sidecars| read_terrain(grid.as_bytes(), "a.asc", beside, &Georeference::default());
    let map = read(&Sidecars::of(Some(FEET.into()), None)).unwrap();
    assert!((map.map.cell_height(0, 0) - 0.3048).abs() < 1e-6 && map.told.unit.name == "US survey ft");
    let folder = tempfile::tempdir().unwrap();
    let asc = folder.path().join("a.asc");
    std::fs::write(folder.path().join("a.asc.aux.xml"), "<PAMDataset>").unwrap();
    let error = read(&Sidecars::beside(&asc)).unwrap_err().to_string();
    assert!(error.contains(".aux.xml") && error.contains("gdal_translate"), "{error}");
    std::fs::remove_file(folder.path().join("a.asc.aux.xml")).unwrap();
    std::fs::write(folder.path().join("a.prj"), b"PROJCS[\"caf\xe9\"").unwrap();
    assert!(read(&Sidecars::beside(&asc)).unwrap_err().to_string().contains(".prj"));
}
