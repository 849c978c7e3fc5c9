//! `hairpin judge LOG`: what hairpin flew itself, exported and read back as a log, comes to what the campaign came to.

use std::fs;
use std::path::{Path, PathBuf};

use serde_json::{Value, json};

use crate::commands::{self, SMALL, refused, run};

/// What the script of a page draws.
fn page_data(page: &Path) -> Value {
    let text = fs::read_to_string(page).unwrap();
    let (_, data) = text.split_once("id=\"data\">").unwrap();
    serde_json::from_str(data.split_once("</script>").unwrap().0).unwrap()
}

/// The first number of a column of a page: offset, scale, and base64 of 16-bit numbers.
fn first(column: &Value) -> f64 {
    let digit = |c: u8| {
        u32::from(match c {
            b'A'..=b'Z' => c - b'A',
            b'a'..=b'z' => c - b'a' + 26,
            b'0'..=b'9' => c - b'0' + 52,
            b'+' => 62,
            _ => 63,
        })
    };
    let bits = column[2].as_str().unwrap().bytes().take(3).fold(0, |bits, c| bits << 6 | digit(c));
    let low_first = (bits >> 10 & 255) + 256 * (bits >> 2 & 255);
    column[0].as_f64().unwrap() + column[1].as_f64().unwrap() * f64::from(low_first)
}

/// A file that `export` wrote, wherever it keeps them.
fn exported(out: &Path, name: &str) -> PathBuf {
    [out.join(name), out.join("export").join(name)].into_iter().find(|path| path.is_file()).expect(name)
}

fn campaign(here: &Path) -> PathBuf {
    let (code, out, error) = run(here, &[&SMALL[..], &["--out", "out"]].concat());
    assert!(code <= 1, "{out}{error}");
    let (code, _, error) = run(here, &["export", "out", "--to", "csv,tum"]);
    assert_eq!(code, 0, "{error}");
    here.join("out")
}

#[test]
fn an_exported_flight_is_judged_as_the_campaign_judged_it() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    let out = campaign(here);
    for case in ["0000", "0001", "0002", "0003"] {
        let csv = exported(&out, &format!("{case}-0.csv"));
        let csv = csv.to_string_lossy();
        let found = commands::json(here, &["judge", &csv, "--campaign", "out"]);
        let log = &found["logs"][0];
        assert_eq!(log["case"], case, "{log}");
        assert_eq!((log["legs_by"].as_str(), log["evidence"].as_str()), (Some("count"), Some("flown")));
        let of = |value: &serde_json::Value| value.as_f64().unwrap();
        let (flown, simulated) = (of(&log["measures"]["max_deviation_m"]), of(&log["simulated_max_deviation_m"]));
        assert!((flown - simulated).abs() < 2e-4 && (of(&log["gap_m"])).abs() < 2e-4, "{flown} {simulated}");
        // As poses alone, legs are assigned: nearly the same, and by the same case.
        let tum = exported(&out, &format!("{case}.exec.tum"));
        let found = commands::json(here, &["judge", &tum.to_string_lossy(), "--campaign", "out"]);
        let log = &found["logs"][0];
        assert_eq!((&log["case"], log["legs_by"].as_str()), (&case.into(), Some("assigned")), "{log}");
        let assigned = of(&log["measures"]["max_deviation_m"]);
        assert!(assigned <= flown + 1e-3 && assigned > 0.5 * flown, "{assigned} {flown}");
        // The same motion has no gap to itself: the simulation's legs are assigned as the log's are.
        assert!(of(&log["gap_m"]).abs() < 1e-3, "{log}");
        assert_eq!(log["aligned"], false);
    }
}

#[test]
fn words_and_codes_of_logs() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    let out = campaign(here);
    fs::create_dir(here.join("logs")).unwrap();
    for case in ["0001", "0002"] {
        fs::copy(exported(&out, &format!("{case}-0.csv")), here.join(format!("logs/{case}.csv"))).unwrap();
    }
    let lax = ["--campaign", "out", "--set", "spec.deviation.max_m=50"];
    let (code, said, error) = run(here, &[&["judge", "logs/0001.csv", "--page", "log.html"][..], &lax].concat());
    assert_eq!(code, 0, "{said}{error}");
    // Its page: planned, simulated, flown. Runs are on the page's data as they are on a report's.
    let page = page_data(&here.join("log.html"));
    assert_eq!((&page["beside"], &page["ids"], &page["metrics"]), (&"simulated".into(), &json!(["0001"]), &json!([])));
    let case = &page["cases"][0];
    assert!(case["planned"]["t"].is_array() && case["flown"]["d"].is_array(), "{case}");
    assert_eq!(case["runs"].as_array().unwrap().len(), 1, "the run of the campaign: {case}");
    let text = fs::read_to_string(here.join("log.html")).unwrap();
    for words in ["<h2>Log <span", "largest deviation, simulated", "its plan: ", "first judged moment", "<td>–</td>"]
    {
        assert!(text.contains(words), "{words}");
    }
    assert!(!text.contains("id=\"commands\""), "a log has no case to replay");
    for words in [
        "not aligned, in space or in time",
        "case: matched to case 0001 (mean ",
        "next best ",
        "deviation: max ",
        ", rmse ",
        "gap: flown ",
        "\nPASS 0001 (flown, 0001.csv, neither source nor accuracy told): ",
        " at most ",
    ] {
        assert!(said.contains(words), "{words}: {said}");
    }
    let scenario = fs::read_to_string(out.join("scenario.toml")).unwrap();
    let strict = ["judge", "logs", "--campaign", "out", "--set", "spec.deviation.max_m=0.001", "--junit", "logs.xml"];
    let (code, said, _) = run(here, &[&strict[..], &["--page", "logs.html"]].concat());
    assert_eq!(code, 1, "{said}");
    let page = page_data(&here.join("logs.html"));
    assert_eq!(page["status"], json!(["fail", "fail"]));
    let mut names: Vec<&str> = page["ids"].as_array().unwrap().iter().map(|name| name.as_str().unwrap()).collect();
    names.sort_unstable();
    assert_eq!(names, ["0001.csv", "0002.csv"]);
    assert!(page["metrics"][0]["random"].is_array(), "the same cases in simulation: {}", page["metrics"][0]);
    let junit = fs::read_to_string(here.join("logs.xml")).unwrap();
    assert!(junit.contains("tests=\"2\" failures=\"2\"") && junit.contains("FAIL 0001 (flown, 0001.csv"), "{junit}");
    assert!(said.lines().last().unwrap().starts_with("FAIL 2/2 (flown, logs, 2 logs): 2 in violation"), "{said}");
    assert!(said.contains("FAIL 0001 (flown, 0001.csv") && said.contains("FAIL 0002 (flown, 0002.csv"), "{said}");
    // What was set here is not written there.
    assert_eq!(fs::read_to_string(out.join("scenario.toml")).unwrap(), scenario);

    // Another frame is another log.
    let text = fs::read_to_string(here.join("logs/0001.csv")).unwrap();
    let (header, rows) = text.split_once('\n').unwrap();
    let at = |name: &str| header.split(',').position(|column| column == name).unwrap();
    let [x, y] = [at("x_m"), at("y_m")];
    let turned = rows.lines().map(|row| {
        let mut cells: Vec<String> = row.split(',').map(str::to_owned).collect();
        let (east, north) = (cells[x].clone(), cells[y].parse::<f64>().unwrap());
        (cells[x], cells[y]) = ((-north).to_string(), east);
        cells.join(",") + "\n"
    });
    fs::write(here.join("turned.csv"), format!("{header}\n{}", turned.collect::<String>())).unwrap();
    let words = ["turned.csv", "does not begin where its mission does", "accepted", "--offset", "--turn DEG"];
    refused(here, &["judge", "turned.csv", "--campaign", "out", "--case", "0001"], &words);
    let back = [&["judge", "turned.csv", "--case", "0001", "--turn", "-90"][..], &lax].concat();
    let (code, said, error) = run(here, &back);
    assert!(code == 0 && said.contains("turned by -90° (--turn)"), "{said}{error}");

    // What is missing is asked for.
    refused(here, &["judge", "logs/0001.csv"], &["--campaign OUT", "--mission M"]);
    refused(here, &["judge", "out", "--campaign", "out"], &["a campaign's folder"]);
    refused(here, &["judge", "out", "--page", "p.html"], &["hairpin report out"]);
    refused(here, &["judge", "logs/0001.csv", "--campaign", "out", "--case", "0017"], &["no such case"]);
    refused(here, &["judge", "logs/0001.csv", "--campaign", "out", "--set", "task.length=3"], &["only spec"]);
    refused(here, &["judge", "none.csv", "--campaign", "out"], &["none.csv"]);
    refused(here, &["judge", "logs/0001.csv", "--campaign", "out", "--offset", "1,2"], &["three finite numbers"]);

    // An obstacle that was not there, on the way.
    let row: Vec<&str> = rows.lines().nth(rows.lines().count() / 2).unwrap().split(',').collect();
    let world = format!(
        "size_m = [100, 100, 100]\n[[obstacles]]\nname = \"new\"\nsphere = {{ center_m = [{}, {}, {}], radius_m = 0.2 }}\n",
        row[x],
        row[y],
        row[at("z_m")]
    );
    fs::write(here.join("w.toml"), world).unwrap();
    let strict = ["--set", "spec.clearance.min_m=0.1", "--world", "w.toml"];
    let (code, said, error) = run(here, &[&["judge", "logs/0001.csv"][..], &lax, &strict].concat());
    assert!(code == 1 && said.contains("FAIL 0001") && said.contains("clearance -"), "{said}{error}");
}

#[test]
fn two_cases_that_are_alike_are_asked_about() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    let out = campaign(here);
    let csv = exported(&out, "0001-0.csv").to_string_lossy().into_owned();
    fs::copy(&csv, here.join("log.csv")).unwrap();
    run(here, &["export", "out", "--to", "waypoints"]);
    fs::create_dir(here.join("twice")).unwrap();
    let mission = [out.join("missions/0001.csv"), out.join("export/0001.csv"), out.join("export/missions/0001.csv")];
    let mission = mission.iter().find(|path| path.is_file()).unwrap();
    for name in ["a.csv", "b.csv"] {
        fs::copy(mission, here.join("twice").join(name)).unwrap();
    }
    let (code, said, error) = run(here, &["execute", "out", "--missions", "twice"]);
    assert_eq!(code, 0, "{said}{error}");
    let both = ["flew case 0000 (mean ", "or 0001 (mean ", "too near each other to tell", "--case ID"];
    refused(here, &["judge", "log.csv", "--campaign", "out"], &both);
    // As everywhere a case may be called by its number alone.
    for case in ["0001", "1"] {
        let arguments = ["judge", "log.csv", "--campaign", "out", "--case", case, "--set", "spec.deviation.max_m=50"];
        let (code, said, _) = run(here, &arguments);
        assert_eq!(code, 0, "{said}");
    }
    // The one mission alone, by a robot's name.
    let arguments =
        ["judge", "log.csv", "--mission", "twice/a.csv", "--robot", "anafi", "--set", "spec.deviation.max_m=50"];
    let (code, said, error) = run(here, &[&arguments[..], &["--page", "a.html"]].concat());
    assert!(code == 0 && said.contains("PASS a (flown, log.csv") && error.contains("no --world"), "{said}{error}");
    // Without a world it is planned and simulated in the open, and drawn where the log is.
    let page = page_data(&here.join("a.html"));
    let (case, begins) = (&page["cases"][0], |motion: &Value| ["x", "y", "z"].map(|axis| first(&motion[axis])));
    assert_eq!((case["runs"].as_array().unwrap().len(), &page["obstacles"]), (1, &json!([])));
    let start = begins(&case["flown"]);
    for motion in [&case["planned"], &case["runs"][0]] {
        let off: f64 = begins(motion).iter().zip(start).map(|(a, b)| (a - b).powi(2)).sum();
        assert!(off.sqrt() < 0.05, "{:?} {start:?}", begins(motion));
    }
}
