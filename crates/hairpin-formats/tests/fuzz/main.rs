//! Every reader, fed with what was valid before it was spoiled: no panic, no memory beyond a bound, an answer in time.
//! Two thousand inputs each here, a hundred thousand by `just fuzz`. What was found stays under `found/`.

mod mutate;
#[allow(dead_code)]
#[path = "../formats/out_campaign/mod.rs"]
mod out_campaign;
mod samples;

use std::collections::BTreeSet;
use std::path::Path;

use hairpin::campaign::bounds::FARTHEST_M;
use hairpin::campaign::{Case, Run};
use hairpin_formats::executor::FromExecutor;
use hairpin_formats::library;
use hairpin_formats::parquet::part_writer::write_one;
use hairpin_formats::parquet::{cases, profile, results, runs, track};
use hairpin_formats::repro::Repro;
use hairpin_formats::scenario::{arm_for, read_setup, rover_for, setup_for};
use hairpin_formats::steering::{parse as parse_queries, read_start_table, start_table_bytes};
use hairpin_formats::terrain::{Georeference, Sidecars, read_keep_outs, read_terrain};
use hairpin_formats::{arcs, cloud, controller_log, costs, logs, mesh, missions, rapid, rotor_speeds, urdf, waypoints};
use mutate::{fuzz, stand};
use out_campaign::campaign;
use samples::{AUX, PRJ, collada, fixtures, meshes, modules, numpy, picture, srdf, texts, urdf as urdf_sample};

const GIVEN: Georeference = Georeference {
    cell_m: Some(1.0),
    height_m: Some([0.0, 10.0]),
    origin_m: None,
    columns: None,
    epsg: None,
    unit: None,
    height_unit: None,
    offset_m: None,
    assume_heights: true,
    holes: hairpin::world::terrain::HoleRule::Fill,
};

/// What a file says of itself is not given.
fn terrain(bytes: &[u8], name: &str) {
    let says_itself = matches!(name.rsplit('.').next(), Some("tif" | "asc"));
    let given = match name.rsplit('.').next() {
        _ if says_itself => Georeference { cell_m: None, height_m: None, ..GIVEN },
        Some("npy") => Georeference { height_m: None, ..GIVEN },
        _ => GIVEN,
    };
    drop(read_terrain(bytes, name, &Sidecars::default(), &given));
}

fn lossy(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

/// Has `read` read a file of the spoiled bytes.
fn fuzz_file(name: &str, samples: &[Vec<u8>], read: impl Fn(&Path)) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(name);
    fuzz(name, samples, |bytes| {
        std::fs::write(&path, bytes).unwrap();
        read(&path);
    });
}

/// The bytes of a file that `write` writes.
fn written(write: impl FnOnce(&Path)) -> Vec<u8> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("sample");
    write(&path);
    std::fs::read(&path).unwrap()
}

#[test]
fn geotiff() {
    fuzz("a.tif", &fixtures("terrain", &["tif"]), |bytes| terrain(bytes, "a.tif"));
}

#[test]
fn ascii_grids() {
    fuzz("a.asc", &fixtures("terrain", &["asc"]), |bytes| terrain(bytes, "a.asc"));
}

#[test]
fn numpy_arrays() {
    fuzz("a.npy", &numpy(), |bytes| terrain(bytes, "a.npy"));
}

#[test]
fn pictures_and_raw_rasters() {
    fuzz("a.png", &[picture()], |bytes| terrain(bytes, "a.png"));
    fuzz("a.raw", &[vec![7; 128]], |bytes| terrain(bytes, "a.raw"));
}

#[test]
fn what_lies_beside_rasters() {
    let grid = b"ncols 2\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 1\n1 1\n1 1\n";
    let beside = |prj: Option<&[u8]>, aux: Option<&[u8]>| Sidecars::of(prj.map(lossy), aux.map(lossy));
    fuzz("a.prj", &texts(&[PRJ]), |bytes| {
        drop(read_terrain(grid, "a.asc", &beside(Some(bytes), None), &Georeference::default()));
    });
    fuzz("a.aux.xml", &texts(&[AUX]), |bytes| {
        drop(read_terrain(grid, "a.asc", &beside(None, Some(bytes)), &Georeference::default()));
    });
}

#[test]
fn triangle_meshes() {
    let (stl, obj) = meshes();
    fuzz("a.stl", &stl, |bytes| drop(mesh::read_mesh(bytes, "a.stl")));
    fuzz("a.obj", &obj, |bytes| drop(mesh::read_mesh(bytes, "a.obj")));
    fuzz("a.dae", &collada(), |bytes| drop(mesh::read_mesh(bytes, "a.dae")));
    fuzz("a.obj", &obj, |bytes| drop(mesh::read_mesh_of_hulls(bytes, "a.obj")));
}

/// A URDF whose meshes are not there.
fn read_arm(text: &str) -> Result<urdf::UrdfArm, urdf::UrdfError> {
    urdf::read_urdf(text, &urdf::UrdfOptions::default(), &|name| Err(urdf::NoMesh::Missing(name.into())))
}

#[test]
fn robots() {
    fuzz("a.srdf", &srdf(), |bytes| drop(urdf::read_srdf(&lossy(bytes))));
    fuzz("a.urdf", &urdf_sample(), |bytes| drop(read_arm(&lossy(bytes))));
    let kind = |text: &str| text.parse::<toml::Table>().ok()?.get("kind")?.as_str().map(str::to_owned);
    let of = |wanted: &str| {
        let all = library::robots().filter(|robot| kind(robot.text).as_deref() == Some(wanted));
        all.map(|robot| robot.text.as_bytes().to_vec()).collect::<Vec<_>>()
    };
    let path_of = |path: &Path| path.to_str().unwrap().to_owned();
    fuzz_file("rover.toml", &of("rover"), |path| drop(rover_for(&path_of(path))));
    fuzz_file("arm.toml", &of("arm"), |path| drop(arm_for(&path_of(path))));
}

#[test]
fn scenarios() {
    let all = ["quadrotor", "arm", "car", "boat"];
    let shipped: Vec<_> = library::scenarios()
        .filter(|scenario| all.contains(&scenario.name))
        .map(|scenario| scenario.text.as_bytes().to_vec())
        .collect();
    assert_eq!(shipped.len(), all.len());
    fuzz("scenario.toml", &shipped, |bytes| drop(read_setup(&lossy(bytes), "a.toml", Path::new("/nowhere"), &[])));
}

#[test]
fn keep_outs() {
    let text = "keep_out = [\n  { name = \"lander\", circle = { center_m = [21.0, 18.5], radius_m = 0.6 } },\n  \
                { polygon = { points_m = [[0, 0], [2.0, 0.0], [2.0, 2.0]] } },\n]\n";
    fuzz("keep_out.toml", &texts(&[text]), |bytes| drop(read_keep_outs(&lossy(bytes))));
}

#[test]
fn rapid_programs() {
    fuzz("a.mod", &modules(), |bytes| drop(rapid::read(bytes, &rapid::Options::default())));
}

#[test]
fn logs() {
    let clock = "arc_ms;3\n0;1;120.5\n1;2;80\n0;1;121\n";
    fuzz("arcs.log", &texts(&[clock]), |bytes| drop(rapid::read_log(bytes)));
    let csv = "t_s,x_mm,y_mm,z_mm,qw,qx,qy,qz,move\n0,300,0,300,1,0,0,0,0\n0.1,301,0,300,1,0,0,0,0\n0.2,302,0,300,1,0,0,0,1\n";
    let other = "time;x;y;z\n0,0;0,3;0;0,3\n0,1;0,31;0;0,3\n";
    fuzz_file("controller.csv", &texts(&[csv, other]), |path| drop(controller_log::read(path, None)));
    let speeds = "t_s,rotor1_rad_s,rotor2_rad_s,rotor3_rad_s,rotor4_rad_s\n0,500,500,500,500\n0.1,510,500,500,500\n";
    fuzz("rotors.csv", &texts(&[speeds]), |bytes| drop(rotor_speeds::parse(&lossy(bytes), (0.0, 1000.0))));
    let answer = r#"{"type":"pose","t_s":0.01,"p_m":[1,2,3],"q_wxyz":[1,0,0,0],"v_m_s":[0,0,0],"leg":0}"#;
    let end = r#"{"type":"end","reason":"done"}"#;
    let rows = r#"{"type":"poses","case":"0000","run":0,"poses":[[0,1,2,3,1,0,0,0,null,5,6,0]]}"#;
    fuzz("executor.json", &texts(&[answer, end, rows]), |bytes| drop(lossy(bytes).parse::<FromExecutor>()));
}

#[test]
fn logs_of_robots() {
    let tum = "# t x y z qx qy qz qw\n0 1 2 3 0 0 0 1\n0.1 1.5 2 3 0 0.6 0 0.8\n";
    let csv = "t,x_m,y_m,z_m,qw,qx,qy,qz,leg,vx_m_s,vy_m_s,vz_m_s,q1_rad\n0,1,2,3,1,0,0,0,0,1,0,0,0.5\n0.1,1,2,3,1,0,0,0,1,1,0,0,0.5\n";
    let samples = [fixtures("logs", &["bin", "mcap", "ulg"]), texts(&[tum, csv])].concat();
    // Formats are told by content, so one name serves all.
    fuzz_file("a.log", &samples, |path| drop(logs::read(path)));
}

#[test]
fn tables_of_text() {
    let points = "x_mm,y_mm,z_mm,q1,q2,q3,q4,cf1,cf4,cf6,cfx\n300,0,300,1,0,0,0,0,0,0,0\n310,5,300,,,,,,,,\n";
    fuzz("cloud.csv", &texts(&[points]), |bytes| drop(cloud::parse(&lossy(bytes))));
    fuzz_file("costs.csv", &texts(&["0,1.5,2\n3,0,\n1,2e2,0\n"]), |path| drop(costs::read(path)));
    let triples = "from,via,to,cost,reason\n0,1,2,3.5,\n1,2,0,,too far\n";
    fuzz_file("arcs.csv", &texts(&[triples]), |path| drop(arcs::read(path, 3)));
    let queries =
        "id,sx,sy,syaw,x,y,yaw,k0,kf,v0,direction,frame\na,0,0,0,1,2,0.5,-0.1,0.2,,0.1,ned\nb,1,1,1,4,0,0,0,0,,,\n";
    fuzz("queries.csv", &texts(&[queries]), |bytes| drop(parse_queries(bytes)));
    let scenario = &setup_for("demo-quadrotor", &[]).unwrap().scenario;
    let metres = "x_m,y_m,z_m\n1,2,3\n4,5,6\n";
    let degrees = "lat_deg,lon_deg,alt_amsl_m,relative_alt_m\n38.0335,-78.5079,181,1\n38.0336,-78.5079,182,2\n";
    fuzz_file("waypoints.csv", &texts(&[metres, degrees]), |path| drop(waypoints::read(path, scenario, FARTHEST_M)));
}

#[test]
fn missions_of_ground_stations() {
    let scenario = &setup_for("demo-quadrotor", &[]).unwrap().scenario;
    let read = |path: &Path| drop(missions::read(path, scenario, FARTHEST_M));
    fuzz_file("a.plan", &texts(&[include_str!("../fixtures/missions/cage.plan")]), read);
    fuzz_file("a.waypoints", &texts(&[include_str!("../fixtures/missions/cage.waypoints")]), read);
}

#[test]
fn start_tables() {
    use hairpin::trajectory::start_table::{ENTRIES, NONE, StartTable};
    let entries = (0..ENTRIES).map(|i| if i % 3 == 0 { NONE } else { [1.5, -2.0, 0.25, 3.0, i as f32 * 1e-4] });
    let table = StartTable::new(0.7, entries.collect()).unwrap();
    fuzz("start.table", &[start_table_bytes(&table)], |bytes| drop(read_start_table(bytes)));
}

#[test]
fn repro_files() {
    let (setup, campaign) = (setup_for("demo-quadrotor", &[]).unwrap(), campaign());
    let repro = Repro::of(&setup, &campaign.cases[0], &campaign.results[0]);
    let sample = written(|path| repro.write(path).unwrap());
    fuzz_file("repro.json", &[sample], |path| {
        if let Ok(repro) = Repro::read(path) {
            drop(repro.case());
        }
    });
}

fn write_profile(path: &Path, case: &Case) {
    write_one(path, "profile", profile::piece(case.number, case.profile().unwrap()).unwrap()).unwrap();
}

fn write_run(path: &Path, run: &Run) {
    write_one(path, "execution", runs::piece(run, &BTreeSet::new()).unwrap().unwrap()).unwrap();
}

/// One reader after the other on every table: another's columns are missing.
fn tables(path: &Path) {
    drop(cases::read(path));
    drop(profile::read(path));
    drop(results::read(path));
    drop(runs::read_run(path));
    drop(track::read(path));
}

#[test]
fn parquet_tables() {
    let campaign = campaign();
    let samples = [
        written(|path| cases::write(path, &campaign.cases).unwrap()),
        written(|path| write_profile(path, &campaign.cases[0])),
        written(|path| results::write(path, &campaign.cases, &campaign.results).unwrap()),
        written(|path| write_run(path, &campaign.runs[0])),
    ];
    // A decoder that panics is caught, and told as a broken file; here its message would be noise.
    std::panic::set_hook(Box::new(|_| ()));
    fuzz_file("a.parquet", &samples, tables);
}

/// A megabyte that stands for gigabytes is refused before it is decoded.
#[test]
fn bombs_of_parquet_are_refused() {
    use std::sync::Arc;

    use arrow_array::{ArrayRef, Float64Array, RecordBatch, UInt64Array};
    use parquet::arrow::ArrowWriter;
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("waypoints.parquet");
    let rows = 1_000_000;
    let column = |name: &'static str| (name, Arc::new(Float64Array::from(vec![1.0; rows])) as ArrayRef);
    let cases = ("case", Arc::new(UInt64Array::from(vec![7; rows])) as ArrayRef);
    let batch = RecordBatch::try_from_iter([cases, column("x_m"), column("y_m"), column("z_m")]).unwrap();
    let mut writer = ArrowWriter::try_new(std::fs::File::create(&path).unwrap(), batch.schema(), None).unwrap();
    (0..3).for_each(|_| writer.write(&batch).unwrap());
    writer.close().unwrap();
    assert!(std::fs::metadata(&path).unwrap().len() < 1_000_000);
    let taken = allocation_counter::measure(|| {
        let error = track::read(&path).unwrap_err().to_string();
        assert!(error.contains("3000000 rows of 4 columns are more than its size can hold"), "{error}");
    });
    assert!(taken.bytes_max < 50_000_000, "{}", taken.bytes_max);
}

/// Large inputs that are no one's: refused or read within bounds.
#[test]
fn a_hundred_times_the_usual_is_refused_within_bounds() {
    let obstacle = "{ sphere = { center_m = [1, 1, 1], radius_m = 1 } },";
    let many = format!("hairpin = 1\n[world]\nobstacles = [{}]\n", obstacle.repeat(300_000));
    let read = |bytes: &[u8]| {
        let error = read_setup(&lossy(bytes), "a.toml", Path::new(""), &[]).unwrap_err().render(false);
        assert!(error.contains("values: at most"), "{error}");
    };
    stand(&read, many.as_bytes()).unwrap();
    let brackets = [b"MODULE m\n".as_slice(), &b"(".repeat(8_000_000)].concat();
    let read = |bytes: &[u8]| {
        let module = rapid::read(bytes, &rapid::Options::default());
        assert!(module.is_err() || module.is_ok_and(|module| !module.mistakes.is_empty()));
    };
    // Words are larger than their letters.
    let taken = allocation_counter::measure(|| read(&brackets));
    assert!(taken.bytes_max < 1 << 30, "{}", taken.bytes_max);
    let lines = [b"MODULE m\n".as_slice(), &b"(\n".repeat(1_000_000)].concat();
    stand(&read, &lines).unwrap();
}

/// Files of users are opened in one place, which asks their size and kind first. What else opens files writes them, or
/// reads what a process of ours says.
#[test]
fn files_are_opened_in_one_place() {
    let crates = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let mut open: Vec<_> =
        ["hairpin-formats", "hairpin-jobs", "hairpin-cli"].map(|name| crates.join(name).join("src")).into();
    let mut files = 0;
    while let Some(place) = open.pop() {
        if place.is_dir() {
            open.extend(std::fs::read_dir(place).unwrap().map(|entry| entry.unwrap().path()));
            continue;
        }
        let name = place.to_str().unwrap().replace('\\', "/");
        let allowed = [
            "src/bounds.rs",
            "src/atomic.rs",
            "src/interrupt.rs",
            "src/executor/watchdog.rs",
            "src/consent/marks.rs",
            "/tests.rs",
            "/testing.rs",
            "/tests/",
        ];
        if allowed.iter().any(|allowed| name.contains(allowed)) {
            continue;
        }
        files += 1;
        let text = std::fs::read_to_string(&place).unwrap();
        let text = text.split("#[cfg(test)]").next().unwrap();
        for call in ["fs::read(", "read_to_string(", "File::open(", "from_path("] {
            let found = text.match_indices(call).find(|(at, _)| !text[..*at].ends_with("bounds::"));
            let line = found.map(|(at, _)| text[..at].lines().count());
            assert!(line.is_none(), "{name}:{}: {call} goes around bounds.rs", line.unwrap_or_default());
        }
    }
    assert!(files > 200, "{files}");
}

/// What broke a reader once.
#[test]
fn findings_stay_mended() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/fuzz/found");
    let mut count = 0;
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_name().unwrap().to_str().unwrap().to_owned();
        let read = |bytes: &[u8]| match name.split('.').next().unwrap() {
            "terrain" => terrain(bytes, &name),
            "parquet" => tables(&path),
            "rapid" => drop(rapid::read(bytes, &rapid::Options::default())),
            "urdf" => drop(read_arm(&lossy(bytes))),
            "mesh" => drop(mesh::read_mesh(bytes, &name)),
            "scenario" => drop(read_setup(&lossy(bytes), "a.toml", Path::new("/nowhere"), &[])),
            "queries" => drop(parse_queries(bytes)),
            "cloud" => drop(cloud::parse(&lossy(bytes))),
            other => panic!("{other}: no reader of that name"),
        };
        stand(&read, &std::fs::read(&path).unwrap()).unwrap_or_else(|why| panic!("{name}: {why}"));
        count += 1;
    }
    assert!(count >= 2);
}
