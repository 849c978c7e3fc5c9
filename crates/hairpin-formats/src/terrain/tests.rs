use hairpin::world::terrain::{MapError, Terrain};
use tiff::encoder::{TiffEncoder, colortype};
use tiff::tags::Tag;

use super::{Sidecars, read_terrain as read_file, *};

/// Without anything beside it.
fn read_terrain(bytes: &[u8], name: &str, georeference: &Georeference) -> Result<ElevationMap, TerrainError> {
    read_file(bytes, name, &Sidecars::default(), georeference).map(|file| file.map)
}

/// 3 columns × 2 rows; north row 1 2 3, south row 4 5 6.
const HEIGHTS: [f32; 6] = [1.0, 2.0, 3.0, 4.0, 5.0, 6.0];

fn geotiff(heights: &[f32], raster_type: u16, no_data: &str) -> Vec<u8> {
    keyed(heights, &[(1025, raster_type)], no_data)
}

/// With these keys and their codes.
fn keyed(heights: &[f32], keys: &[(u16, u16)], no_data: &str) -> Vec<u8> {
    let head = [1, 1, 0, keys.len() as u16];
    let directory: Vec<u16> = head.into_iter().chain(keys.iter().flat_map(|(key, code)| [*key, 0, 1, *code])).collect();
    let mut bytes = std::io::Cursor::new(Vec::new());
    let mut encoder = TiffEncoder::new(&mut bytes).expect("an encoder");
    let mut image = encoder.new_image::<colortype::Gray32Float>(3, 2).expect("an image");
    let tags = image.encoder();
    tags.write_tag(Tag::ModelPixelScaleTag, &[0.5, 0.5, 0.0][..]).expect("a tag");
    tags.write_tag(Tag::ModelTiepointTag, &[0.0, 0.0, 0.0, 10.0, 20.0, 0.0][..]).expect("a tag");
    tags.write_tag(Tag::GeoKeyDirectoryTag, &directory[..]).expect("a tag");
    tags.write_tag(Tag::GdalNodata, no_data).expect("a tag");
    image.write_data(heights).expect("data");
    bytes.into_inner()
}

fn at(map: &ElevationMap, x: f64, y: f64) -> f64 {
    map.patch(x, y).expect("ground").height
}

#[test]
fn geotiff_rows_run_from_the_north_and_corner_or_centre_is_told_apart() {
    let area = read_terrain(&geotiff(&HEIGHTS, 1, "-9999"), "a.tif", &Georeference::default()).expect("a map");
    assert_eq!(area.extent(), ([10.25, 19.25], [11.25, 19.75]));
    assert_eq!((at(&area, 10.25, 19.75), at(&area, 11.25, 19.25)), (1.0, 6.0));
    let point = read_terrain(&geotiff(&HEIGHTS, 2, "-9999"), "a.TIFF", &Georeference::default()).expect("a map");
    assert_eq!(point.extent(), ([10.0, 19.5], [11.0, 20.0]));
    assert_eq!(at(&point, 10.0, 20.0), 1.0);
}

#[test]
fn no_data_is_found_by_its_tag_and_by_its_size() {
    for (value, tag) in [(-9999.0, "-9999"), (-3.4e38, "0"), (f32::NAN, "nan")] {
        let mut heights = HEIGHTS;
        heights[1] = value;
        let error = read_terrain(&geotiff(&heights, 1, tag), "a.tif", &Georeference::default()).expect_err("a hole");
        assert_eq!(error, TerrainError::Map(MapError::Holes { count: 1, row: 0, column: 1 }));
    }
}

#[test]
fn units_that_are_said_are_known_or_asked_for() {
    let given = |height_unit| Georeference { height_unit, ..Georeference::default() };
    let read = |keys: &[(u16, u16)], height_unit| {
        let plane = [&[(1024, 1), (1025, 1)][..], keys].concat();
        read_terrain(&keyed(&HEIGHTS, &plane, "-9999"), "a.tif", &given(height_unit))
    };
    for (key, code, metres) in [
        (4096, 5703, 1.0),
        (4096, 5702, 1200.0 / 3937.0),
        (4096, 6360, 1200.0 / 3937.0),
        (4096, 8052, 1200.0 / 3937.0),
        (4096, 8228, 0.3048),
        (4096, 5754, 0.304_800_749_1),
        (4099, 9098, 0.201_168),
    ] {
        let map = read(&[(key, code)], None).unwrap_or_else(|error| panic!("{code}: {error}"));
        assert!((at(&map, 11.25, 19.25) - 6.0 * metres).abs() < 1e-6, "{code}");
    }
    for (keys, words) in [
        (&[(4096, 5700)][..], "height_unit: the file says VerticalCS = 5700, which is not known here"),
        (&[(4096, 5103)][..], "height_unit: the file says VerticalCS = 5103"),
        (&[(4096, 9999), (4099, 9001)][..], "height_unit: the file says VerticalCS = 9999"),
        (&[(4099, 32767)][..], "height_unit: the file says VerticalUnits = 32767"),
        (&[(3072, 1)][..], "unit: the file says EPSG:1, which is not known here"),
        (&[(3076, 9999)][..], "unit: the file says ProjLinearUnits = 9999, which is not known here; it must be given"),
    ] {
        let error = read(keys, None).expect_err(words);
        assert!(error.to_string().starts_with(words) && error.key().is_some(), "{error}");
    }
    let told = read(&[(4096, 5700)], Some(hairpin::campaign::scenario::MapUnit::Ft)).expect("it is told");
    assert!((at(&told, 11.25, 19.25) - 6.0 * 0.3048).abs() < 1e-6);
    assert!(read(&[(4096, 5103), (4099, 9003)], None).is_ok(), "a datum, and the unit beside it");
}

#[test]
fn heights_beyond_the_bound_in_a_unit_that_nobody_says_are_asked_for_it() {
    let kilometres = keyed(&[400.0; 6], &[(1024, 1), (1025, 1), (3076, 9036)], "-9999");
    let shown = Georeference { assume_heights: true, ..Georeference::default() };
    for given in [&shown, &Georeference::default()] {
        assert_eq!(read_terrain(&kilometres, "a.tif", given).expect_err("a question"), TerrainError::UnitOfHeights);
    }
    let metres = Georeference { height_unit: Some(hairpin::campaign::scenario::MapUnit::M), ..shown };
    assert_eq!(at(&read_terrain(&kilometres, "a.tif", &metres).expect("a map"), 10_500.0, 19_500.0), 400.0);
}

#[test]
fn depths_and_stretched_planes_come_with_the_command_that_mends_them() {
    for (keys, words) in [
        (&[(4096, 5715)][..], ["depths (VerticalCS = 5715)", "--calc='-A' --outfile=a_heights.tif"]),
        (&[(4096, 6357), (3072, 32632)][..], ["VerticalCS = 6357", "gdal_edit.py -a_srs EPSG:32632 a_heights.tif"]),
        (&[(4096, 5614)][..], ["VerticalCS = 5614", "--calc='-0.3048*A'"]),
        (
            &[(3072, 3857)][..],
            ["a plane that stretches the ground (EPSG:3857)", "gdalwarp -t_srs EPSG:32631 -r bilinear a.tif"],
        ),
    ] {
        let plane = [&[(1024, 1), (1025, 1)][..], keys].concat();
        let error = read_terrain(&keyed(&HEIGHTS, &plane, "-9999"), "a.tif", &Georeference::default());
        let error = error.expect_err(words[0]).to_string();
        assert!(words.iter().all(|word| error.contains(word)), "{error}");
    }
    let by_key = Georeference { epsg: Some(3857), ..Georeference::default() };
    assert!(read_terrain(&geotiff(&HEIGHTS, 1, "0"), "a.tif", &by_key).is_err());
}

#[test]
fn a_plane_is_looked_at_in_its_corners_and_one_that_is_not_known_is_told() {
    let asc = |low: &str, cell: &str| {
        let rows = "1 2 3\n".repeat(3);
        format!("ncols 3\nnrows 3\nxllcenter {low}\nyllcenter {low}\ncellsize {cell}\n{rows}").into_bytes()
    };
    let read = |bytes: &[u8], plane: &str| {
        read_file(bytes, "a.asc", &Sidecars::of(Some(plane.into()), None), &Georeference::default())
    };
    // About 9° from the equator a metre along it is cos 9° of one; at the middle it is one.
    let world = r#"PROJCS["World",UNIT["metre",1],AUTHORITY["EPSG","4087"]]"#;
    let error = read(&asc("-1000000", "1000000"), world).expect_err("a corner").to_string();
    assert!(error.contains("1.012 long along x") && error.contains("at a corner of the map"), "{error}");
    assert_eq!(read(&asc("-1000", "1000"), world).expect("a map").told.unknown_plane, None);

    let unknown = |plane: &str| read(&asc("0", "1"), plane).expect("a map").told.unknown_plane;
    let bonne = r#"PROJCS["Bonne of the yard",PROJECTION["Nobody_s"],UNIT["metre",1]]"#;
    assert_eq!(unknown(bonne).as_deref(), Some("Bonne of the yard"));
    assert_eq!(unknown(r#"PROJCS["",PROJECTION["Nobody_s"],UNIT["metre",1]]"#).as_deref(), Some("without a name"));
    assert_eq!(unknown(r#"LOCAL_CS["the yard",UNIT["metre",1]]"#), None);
    let nothing = read_file(&asc("0", "1"), "a.asc", &Sidecars::default(), &Georeference::default());
    assert_eq!(nothing.expect("a map").told.unknown_plane, None);
}

#[test]
fn pictures_where_white_is_zero_are_refused() {
    let mut bytes = geotiff(&HEIGHTS, 1, "-9999");
    set_tag(&mut bytes, 262, 0);
    let error = read_terrain(&bytes, "a.tif", &Georeference::default()).expect_err("white is zero").to_string();
    assert!(error.contains("white is zero") && error.contains("PHOTOMETRIC=MINISBLACK a.tif a_plain.tif"), "{error}");
}

#[test]
fn kinds_of_rasters_and_orders_of_bits_that_are_not_known_are_refused() {
    for kind in [3, 32767] {
        let error = read_terrain(&geotiff(&HEIGHTS, kind, "-9999"), "a.tif", &Georeference::default());
        let error = error.expect_err("neither areas nor points").to_string();
        assert!(error.contains(&format!("GTRasterType is {kind}")), "{error}");
    }
    let mut bytes = std::io::Cursor::new(Vec::new());
    let mut encoder = TiffEncoder::new(&mut bytes).expect("an encoder");
    let mut image = encoder.new_image::<colortype::Gray32Float>(3, 2).expect("an image");
    image.encoder().write_tag(Tag::FillOrder, 2_u16).expect("a tag");
    image.write_data(&HEIGHTS).expect("data");
    let error = read_terrain(&bytes.into_inner(), "a.tif", &Georeference::default()).expect_err("reversed bits");
    assert!(error.to_string().contains("FillOrder is 2"), "{error}");
}

#[test]
fn another_place_beside_a_file_than_in_it_is_refused() {
    let file = geotiff(&HEIGHTS, 1, "-9999");
    let read = |numbers: &str| {
        let aux = format!("<PAMDataset><GeoTransform> {numbers}</GeoTransform></PAMDataset>");
        read_file(&file, "a.tif", &Sidecars::of(None, Some(aux)), &Georeference::default())
    };
    assert!(read("1.0e+01, 5.0e-01, 0, 2.0e+01, 0, -5.0e-01").is_ok(), "its own");
    for other in ["10, 0.5, 0, 21, 0, -0.5", "10, 0.5, 0.1, 20, 0, -0.5", "10, 0.6, 0, 20, 0, -0.5", "10, 0.5", "", "?"]
    {
        let error = read(other).expect_err(other).to_string();
        assert!(error.contains("10, 0.5, 0, 20, 0, -0.5") && error.contains(other), "{error}");
    }
}

#[test]
fn steps_of_heights_in_the_georeference_are_refused() {
    let plain = geotiff(&HEIGHTS, 1, "-9999");
    let scale: Vec<u8> = [0.5_f64, 0.5, 0.0].iter().flat_map(|number| number.to_le_bytes()).collect();
    let place = plain.windows(scale.len()).position(|bytes| bytes == scale).expect("the pixel scale") + 16;
    let read = |step: f64| {
        let mut bytes = plain.clone();
        bytes[place..place + 8].copy_from_slice(&step.to_le_bytes());
        read_terrain(&bytes, "a.tif", &Georeference::default())
    };
    assert!(read(0.0).is_ok() && read(1.0).is_ok());
    let error = read(0.1).expect_err("a step of heights").to_string();
    assert!(error.contains("a step or an origin of heights") && error.contains("gdal_translate a.tif"), "{error}");
}

/// What a tag has, or where.
fn tag_value(bytes: &[u8], tag: u16) -> u32 {
    let number = |at: usize, size: usize| bytes[at..at + size].iter().rev().fold(0, |all, b| all << 8 | u32::from(*b));
    let directory = number(4, 4) as usize;
    let entries = (0..number(directory, 2) as usize).map(|entry| directory + 2 + 12 * entry);
    let found = entries.into_iter().find(|at| number(*at, 2) == u32::from(tag));
    number(found.expect("the tag") + 8, 4)
}

/// The directory's entries are 12 bytes each.
fn set_tag(bytes: &mut [u8], tag: u16, value: u32) {
    let directory = u32::from_le_bytes(bytes[4..8].try_into().expect("four bytes")) as usize;
    let entries = u16::from_le_bytes(bytes[directory..directory + 2].try_into().expect("two bytes"));
    for entry in 0..usize::from(entries) {
        let at = directory + 2 + 12 * entry;
        if bytes[at..at + 2] == tag.to_le_bytes() {
            bytes[at + 8..at + 12].copy_from_slice(&value.to_le_bytes());
        }
    }
}

/// A GeoTIFF of three rows of three heights, a strip each, of which these are not in the file.
fn sparse(missing: &[usize], no_data: Option<&str>) -> Vec<u8> {
    let mut bytes = std::io::Cursor::new(Vec::new());
    let mut encoder = TiffEncoder::new(&mut bytes).expect("an encoder");
    let mut image = encoder.new_image::<colortype::Gray16>(3, 3).expect("an image");
    image.rows_per_strip(1).expect("rows");
    let tags = image.encoder();
    tags.write_tag(Tag::ModelPixelScaleTag, &[0.5, 0.5, 0.0][..]).expect("a tag");
    tags.write_tag(Tag::ModelTiepointTag, &[0.0, 0.0, 0.0, 10.0, 20.0, 0.0][..]).expect("a tag");
    if let Some(no_data) = no_data {
        tags.write_tag(Tag::GdalNodata, no_data).expect("a tag");
    }
    image.write_data(&[1, 2, 3, 4, 5, 6, 7, 8, 9]).expect("data");
    let mut bytes = bytes.into_inner();
    for tag in [Tag::StripOffsets, Tag::StripByteCounts] {
        let list = tag_value(&bytes, tag.to_u16()) as usize;
        for strip in missing {
            bytes[list + 4 * strip..][..4].fill(0);
        }
    }
    bytes
}

#[test]
fn strips_that_are_not_in_the_file_are_no_data_and_not_its_header() {
    let read = |bytes: &[u8]| read_terrain(bytes, "a.tif", &Georeference::default());
    let whole = read(&sparse(&[], Some("-9999"))).expect("a map");
    assert_eq!((at(&whole, 10.25, 19.75), at(&whole, 11.25, 18.75)), (1.0, 9.0));
    let holes = read(&sparse(&[1], Some("0"))).expect_err("holes");
    assert_eq!(holes, TerrainError::Map(MapError::Holes { count: 3, row: 1, column: 0 }));
    // Where no value means no data they are 0.
    let zero = read(&sparse(&[0], None)).expect("a map");
    assert_eq!([at(&zero, 10.25, 19.75), at(&zero, 10.25, 19.25), at(&zero, 11.25, 18.75)], [0.0, 4.0, 9.0]);
    let mut lies = sparse(&[], Some("-9999"));
    let list = tag_value(&lies, Tag::StripOffsets.to_u16()) as usize;
    lies[list + 8..][..4].fill(0);
    let error = read(&lies).expect_err("a strip in the header").to_string();
    assert!(error.contains("strip 2, of 6 bytes, at byte 0 of the file"), "{error}");
}

#[test]
fn a_header_that_promises_more_than_the_file_holds_is_refused_before_memory_is_taken() {
    let promising = |cells: u32| {
        let mut bytes = geotiff(&HEIGHTS, 1, "0");
        for width_or_height in [256, 257] {
            set_tag(&mut bytes, width_or_height, cells);
        }
        read_terrain(&bytes, "a.tif", &Georeference::default()).expect_err("a lie")
    };
    assert_eq!(promising(50_000), TerrainError::TooLarge { columns: 50_000, rows: 50_000 });
    // 356 bytes hold no more than so many cells, however they are packed.
    let error = promising(9_900);
    assert!(error.to_string().contains("9900 x 9900 cells") || error.to_string().contains("GDAL"), "{error}");
}

#[test]
fn ascii_grids_by_corner_and_by_centre() {
    let grid = "ncols 3\nnrows 2\nxllcorner 10\nyllcorner 19\ncellsize 0.5\nNODATA_value -1\n1 2 3\n4 5 6\n";
    let map = read_terrain(grid.as_bytes(), "a.asc", &Georeference::default()).expect("a map");
    assert_eq!(map.extent(), ([10.25, 19.25], [11.25, 19.75]));
    assert_eq!((at(&map, 10.25, 19.75), at(&map, 11.25, 19.25)), (1.0, 6.0));
    let centred = grid.replace("corner", "center");
    let map = read_terrain(centred.as_bytes(), "a.asc", &Georeference::default()).expect("a map");
    assert_eq!(map.extent(), ([10.0, 19.0], [11.0, 19.5]));
    for (from, to, said) in [
        ("4 5 6", "4 5 x", "line 8: \"x\" is no height"),
        ("4 5 6", "4 5 6 7", "more than 3 x 2"),
        ("4 5 6", "4 5", "5 heights for 2 rows of 3"),
        ("ncols 3", "ncols -3", "line 1: ncols"),
        ("ncols 3", "ncols 4000000000000", "4000000000000 x 2 cells"),
        ("cellsize 0.5", "cellsize 0", "cell width = 0"),
        ("nrows 2\n", "", "nrows is missing"),
        ("4 5 6", "4 -1 6", "1 cells without data"),
        ("4 5 6", "4 -3.4e38 6", "1 cells without data"),
        ("4 5 6", "4 5 6\nNODATA_value 4", "line 9: \"NODATA_value\" after the first height"),
        ("4 5 6", "cellsize 0.3\n4 5 6", "line 8: \"cellsize\" after the first height"),
        ("nrows 2", "nrows 2\nNROWS 1", "line 3: nrows = \"1\" is given again"),
        ("NODATA_value -1", "NODATA_value -1\nnodata 1", "line 7: nodata = \"1\" is given again"),
        ("cellsize 0.5", "cellsize 0.5 0.2", "line 5: cellsize = \"0.5\" is followed by \"0.2\""),
        ("ncols 3", "ncols 3 m", "line 1: ncols = \"3\" is followed by \"m\""),
        ("ncols 3", "# by hand\nncols 3", "line 1: \"#\" is no word"),
    ] {
        let broken = grid.replace(from, to);
        let error = read_terrain(broken.as_bytes(), "a.asc", &Georeference::default()).expect_err(said);
        assert!(error.to_string().contains(said), "{error}");
    }
    let marked = ["\u{feff}", grid].concat();
    assert!(read_terrain(marked.as_bytes(), "a.asc", &Georeference::default()).is_ok(), "a mark of the encoding");
}

#[test]
fn sixteen_bits_are_scaled_between_the_given_heights() {
    let values = [0_u16, 32_768, 65_535, 65_535, 0, 13_107];
    let given = Georeference {
        cell_m: Some(2.0),
        height_m: Some([-10.0, 10.0]),
        origin_m: Some([5.0, 6.0]),
        columns: Some(3),
        ..Georeference::default()
    };
    let raw: Vec<u8> = values.iter().flat_map(|v| v.to_le_bytes()).collect();
    let mut png = Vec::new();
    let mut encoder = png::Encoder::new(&mut png, 3, 2);
    encoder.set_color(png::ColorType::Grayscale);
    encoder.set_depth(png::BitDepth::Sixteen);
    let big_endian: Vec<u8> = values.iter().flat_map(|v| v.to_be_bytes()).collect();
    encoder.write_header().expect("a header").write_image_data(&big_endian).expect("data");
    let mut transparent = Vec::new();
    let mut encoder = png::Encoder::new(&mut transparent, 3, 2);
    encoder.set_color(png::ColorType::Grayscale);
    encoder.set_depth(png::BitDepth::Sixteen);
    encoder.set_trns(vec![0x80, 0]);
    encoder.write_header().expect("a header").write_image_data(&big_endian).expect("data");
    let of_png = Georeference { columns: None, ..given };
    let error = read_terrain(&transparent, "a.png", &of_png).expect_err("a transparent cell");
    assert_eq!(error, TerrainError::Map(MapError::Holes { count: 1, row: 0, column: 1 }));
    let told = read_terrain(&png, "a.png", &given).expect_err("it says its own").to_string();
    assert!(told.starts_with("columns: "), "{told}");
    for (bytes, name, given) in [(&raw, "a.bin", given), (&png, "a.png", of_png)] {
        let map = read_terrain(bytes, name, &given).expect("a map");
        assert_eq!(map.extent(), ([5.0, 6.0], [9.0, 8.0]), "{name}");
        assert_eq!((at(&map, 5.0, 8.0), at(&map, 9.0, 8.0), at(&map, 9.0, 6.0)), (-10.0, 10.0, -6.0), "{name}");
    }
    let refused =
        |georeference: Georeference| read_terrain(&raw, "a.raw", &georeference).expect_err("a gap").to_string();
    assert!(refused(Georeference { cell_m: None, ..given }).starts_with("cell_m: the file does not say it"));
    assert!(refused(Georeference { height_m: None, ..given }).starts_with("height_m: "));
    assert!(refused(Georeference { height_m: Some([1.0, 1.0]), ..given }).contains("the lower first"));
    assert!(refused(Georeference { columns: None, ..given }).contains("12 bytes are no rows"));
}

#[test]
fn numpy_arrays_in_either_order_and_precision() {
    let given = Georeference { cell_m: Some(1.0), ..Georeference::default() };
    let array = |descr: &str, fortran: bool, data: &[u8]| {
        let order = if fortran { "True" } else { "False" };
        let mut header = format!("{{'descr': '{descr}', 'fortran_order': {order}, 'shape': (2, 3), }}");
        while (header.len() + 11) % 64 != 0 {
            header.push(' ');
        }
        header.push('\n');
        let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
        bytes.extend((header.len() as u16).to_le_bytes());
        bytes.extend(header.as_bytes());
        bytes.extend(data);
        bytes
    };
    let c32: Vec<u8> = HEIGHTS.iter().flat_map(|h| h.to_le_bytes()).collect();
    let f64s: Vec<u8> = [1.0_f64, 4.0, 2.0, 5.0, 3.0, 6.0].iter().flat_map(|h| h.to_le_bytes()).collect();
    for bytes in [array("<f4", false, &c32), array("<f8", true, &f64s)] {
        let map = read_terrain(&bytes, "a.npy", &given).expect("a map");
        assert_eq!((at(&map, 0.0, 1.0), at(&map, 2.0, 1.0), at(&map, 0.0, 0.0)), (1.0, 3.0, 4.0));
    }
    let mut far: Vec<u8> = c32.clone();
    far[..4].copy_from_slice(&(-3.4e38_f32).to_le_bytes());
    let error = read_terrain(&array("<f4", false, &far), "a.npy", &given).expect_err("a hole");
    assert_eq!(error, TerrainError::Map(MapError::Holes { count: 1, row: 0, column: 0 }));
    let error = read_terrain(&array("<i4", false, &c32), "a.npy", &given).expect_err("integers");
    assert!(error.to_string().contains("float32 or float64"), "{error}");
    let error = read_terrain(&array("<f4", false, &c32[..8]), "a.npy", &given).expect_err("cut short");
    assert!(error.to_string().contains("no readable NumPy array"), "{error}");
    let longer = [&c32[..], &[0; 4]].concat();
    let error = read_terrain(&array("<f4", false, &longer), "a.npy", &given).expect_err("bytes behind it");
    assert!(error.to_string().contains("2 x 3 heights, 24 bytes; 28 follow"), "{error}");
    let mut high = c32.clone();
    high[4..8].copy_from_slice(&3.396e6_f32.to_le_bytes());
    let error = read_terrain(&array("<f4", false, &high), "a.npy", &given).expect_err("a radius").to_string();
    assert!(
        error.starts_with("height = 3396000 m in row 0 from the north, column 1: must be within ±100000"),
        "{error}"
    );
}

#[test]
fn what_says_itself_where_it_lies_is_not_told() {
    let given = Georeference { cell_m: Some(1.0), ..Georeference::default() };
    let error = read_terrain(&geotiff(&HEIGHTS, 1, "0"), "a.tif", &given).expect_err("said twice");
    assert_eq!(error, TerrainError::Unwanted { key: "cell_m" });
    for name in ["a.xyz", "a", ""] {
        assert_eq!(read_terrain(&[], name, &given).expect_err("no format"), TerrainError::Format);
    }
    for name in ["a.tif", "a.asc", "a.png", "a.npy"] {
        let given = Georeference {
            cell_m: if name == "a.tif" || name == "a.asc" { None } else { Some(1.0) },
            ..Georeference::default()
        };
        for garbage in [&b""[..], b"garbage", &[0xff; 300]] {
            let refused = read_terrain(garbage, name, &given);
            assert!(matches!(refused, Err(TerrainError::Broken(_) | TerrainError::Convert { .. })), "{name}");
        }
    }
}
