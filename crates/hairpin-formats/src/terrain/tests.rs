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
    let mut bytes = std::io::Cursor::new(Vec::new());
    let mut encoder = TiffEncoder::new(&mut bytes).expect("an encoder");
    let mut image = encoder.new_image::<colortype::Gray32Float>(3, 2).expect("an image");
    let tags = image.encoder();
    tags.write_tag(Tag::ModelPixelScaleTag, &[0.5, 0.5, 0.0][..]).expect("a tag");
    tags.write_tag(Tag::ModelTiepointTag, &[0.0, 0.0, 0.0, 10.0, 20.0, 0.0][..]).expect("a tag");
    tags.write_tag(Tag::GeoKeyDirectoryTag, &[1_u16, 1, 0, 1, 1025, 0, 1, raster_type][..]).expect("a tag");
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
fn a_header_that_promises_more_than_the_file_holds_is_refused_before_memory_is_taken() {
    let promising = |cells: u32| {
        let mut bytes = geotiff(&HEIGHTS, 1, "0");
        // The directory's entries are 12 bytes each; width and height are the tags 256 and 257.
        let directory = u32::from_le_bytes(bytes[4..8].try_into().expect("four bytes")) as usize;
        let entries = u16::from_le_bytes(bytes[directory..directory + 2].try_into().expect("two bytes"));
        for entry in 0..usize::from(entries) {
            let at = directory + 2 + 12 * entry;
            if [256_u16, 257].iter().any(|tag| bytes[at..at + 2] == tag.to_le_bytes()) {
                bytes[at + 8..at + 12].copy_from_slice(&cells.to_le_bytes());
            }
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
    ] {
        let broken = grid.replace(from, to);
        let error = read_terrain(broken.as_bytes(), "a.asc", &Georeference::default()).expect_err(said);
        assert!(error.to_string().contains(said), "{error}");
    }
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
    for (bytes, name) in [(&raw, "a.bin"), (&png, "a.png")] {
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
    let error = read_terrain(&array("<i4", false, &c32), "a.npy", &given).expect_err("integers");
    assert!(error.to_string().contains("float32 or float64"), "{error}");
    let error = read_terrain(&array("<f4", false, &c32[..8]), "a.npy", &given).expect_err("cut short");
    assert!(error.to_string().contains("no readable NumPy array"), "{error}");
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
