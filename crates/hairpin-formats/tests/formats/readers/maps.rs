//! Elevation maps: fixtures by their names, grids and what stands beside them by their text.

use std::path::Path;

use hairpin::world::terrain::HoleRule;
use hairpin_formats::terrain::{Georeference, MapFile, Sidecars, TerrainError, read_terrain};

use super::{Answer, Sample};

/// Heights, where they lie, and what the file says of them; cells without data are kept out of.
fn said(read: Result<MapFile, TerrainError>) -> Answer {
    match read {
        Ok(MapFile { map, told }) => {
            let grid = map.grid();
            let heights = (0..grid.rows * grid.columns).map(|i| map.cell_height(i / grid.columns, i % grid.columns));
            let heights: Vec<String> = heights.map(|height| format!("{height:.2}")).collect();
            Answer::Read(format!("{:?} {heights:?} {:?} {:?}", map.extent(), told.epsg, told.offset_m))
        }
        Err(error) => Answer::Refused(error.to_string()),
    }
}

fn given() -> Georeference {
    Georeference { holes: HoleRule::KeepOut, ..Georeference::default() }
}

fn of_fixture(name: &str) -> Answer {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/fixtures/terrain").join(name);
    said(read_terrain(&std::fs::read(&path).expect("a fixture"), name, &Sidecars::beside(&path), &given()))
}

fn of_grid(text: &str) -> Answer {
    said(read_terrain(text.as_bytes(), "a.asc", &Sidecars::of(None, None), &given()))
}

/// A grid beside which a `.prj` of this text lies.
fn of_prj(text: &str) -> Answer {
    let prj = (!text.is_empty()).then(|| text.to_owned());
    said(read_terrain(GRID.as_bytes(), "a.asc", &Sidecars::of(prj, None), &given()))
}

/// A grid beside which an `.aux.xml` of this text lies.
fn of_aux(text: &str) -> Answer {
    let aux = (!text.is_empty()).then(|| text.to_owned());
    said(read_terrain(GRID.as_bytes(), "a.asc", &Sidecars::of(None, aux), &given()))
}

const GRID: &str = "ncols 3\nnrows 3\nxllcorner 0\nyllcorner 0\ncellsize 0.5\n1 2 3\n4 5 6\n7 8 9\n";
const DEGREES: &str = "GEOGCS[\"GCS_WGS_1984\",DATUM[\"D_WGS_1984\",SPHEROID[\"WGS_1984\",6378137,298.257223563]],\
    PRIMEM[\"Greenwich\",0],UNIT[\"Degree\",0.017453292519943295]]";
const FEET: &str = "PROJCS[\"p\",GEOGCS[\"g\",DATUM[\"d\",SPHEROID[\"s\",6378137,298.257222101]],PRIMEM[\"Greenwich\",0],\
    UNIT[\"Degree\",0.0174532925199433]],PROJECTION[\"Transverse_Mercator\"],UNIT[\"Foot_US\",0.3048006096012192]]";
const MERCATOR: &str = "PROJCS[\"WGS_1984_Web_Mercator_Auxiliary_Sphere\",GEOGCS[\"g\",DATUM[\"d\",\
    SPHEROID[\"s\",6378137,298.257223563]],PRIMEM[\"Greenwich\",0],UNIT[\"Degree\",0.0174532925199433]],\
    PROJECTION[\"Mercator_Auxiliary_Sphere\"],UNIT[\"Meter\",1]]";
const DEPTH: &str = "PROJCS[\"p\",GEOGCS[\"g\",DATUM[\"d\",SPHEROID[\"s\",6378137,298.257222101]],\
    PRIMEM[\"Greenwich\",0],\
    UNIT[\"Degree\",0.0174532925199433]],PROJECTION[\"Transverse_Mercator\"],UNIT[\"Meter\",1]],\
    VERTCS[\"h\",VDATUM[\"v\"],PARAMETER[\"Direction\",-1],UNIT[\"Meter\",1]]";
const FAR_BELOW: &str = "ncols 3\nnrows 3\nxllcorner 0\nyllcorner 0\ncellsize 0.5\n-3.4e38 2 3\n4 5 6\n7 8 9\n";
const SCALE: &str = "<PAMDataset><PAMRasterBand band=\"1\"><Scale>0.1</Scale></PAMRasterBand></PAMDataset>";

fn fixture(row: &'static str, without: &str, with: &str) -> Sample {
    Sample { row, read: of_fixture, without: without.into(), with: with.into() }
}

fn grid(row: &'static str, with: String) -> Sample {
    Sample { row, read: of_grid, without: GRID.into(), with }
}

fn beside(row: &'static str, read: fn(&str) -> Answer, with: &str) -> Sample {
    Sample { row, read, without: String::new(), with: with.into() }
}

pub(crate) fn samples() -> Vec<Sample> {
    vec![
        fixture("geotiff.tiles", "metres.tif", "tiled.tif"),
        fixture("geotiff.zstandard", "metres.tif", "zstd.tif"),
        fixture("geotiff.south-up", "metres.tif", "south_up.tif"),
        fixture("geotiff.epsg", "no_reference.tif", "metres.tif"),
        fixture("geotiff.far", "metres.tif", "utm.tif"),
        fixture("geotiff.point", "metres.tif", "point.tif"),
        fixture("geotiff.no-data", "metres.tif", "nan.tif"),
        fixture("geotiff.mask", "metres.tif", "mask.tif"),
        fixture("geotiff.feet", "metres.tif", "feet_of_both.tif"),
        fixture("geotiff.feet-without-heights", "metres.tif", "feet.tif"),
        fixture("geotiff.degrees", "metres.tif", "degrees.tif"),
        fixture("geotiff.rotated", "metres.tif", "rotated.tif"),
        fixture("geotiff.bands", "metres.tif", "two_bands.tif"),
        fixture("geotiff.pages", "metres.tif", "pages.tif"),
        fixture("geotiff.smaller-first", "metres.tif", "smaller_first.tif"),
        fixture("geotiff.overviews", "metres.tif", "overviews.tif"),
        fixture("geotiff.lerc", "metres.tif", "lerc.tif"),
        grid("grid.dx-dy", GRID.replace("cellsize 0.5", "dx 0.5\ndy 1")),
        grid("grid.no-data", GRID.replace("1 2 3", "NODATA_value nan\nnan 2 3")),
        grid("grid.far-below", FAR_BELOW.into()),
        grid("grid.short", GRID.replace("7 8 9", "7 8")),
        beside("prj.degrees", of_prj, DEGREES),
        beside("prj.feet", of_prj, FEET),
        beside("prj.mercator", of_prj, MERCATOR),
        beside("prj.depth", of_prj, DEPTH),
        beside("aux.scale", of_aux, SCALE),
    ]
}
