//! `hairpin judge LOG`: what hairpin flew itself, exported and read back as a log, comes to what the campaign came to.

use std::fs;
use std::path::{Path, PathBuf};

use crate::commands::{SMALL, json, refused, run};

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
        let found = json(here, &["judge", &csv, "--campaign", "out"]);
        let log = &found["logs"][0];
        assert_eq!(log["case"], case, "{log}");
        assert_eq!((log["legs_by"].as_str(), log["evidence"].as_str()), (Some("count"), Some("flown")));
        let of = |value: &serde_json::Value| value.as_f64().unwrap();
        let (flown, simulated) = (of(&log["measures"]["max_deviation_m"]), of(&log["simulated_max_deviation_m"]));
        assert!((flown - simulated).abs() < 2e-4 && (of(&log["gap_m"])).abs() < 2e-4, "{flown} {simulated}");
        // As poses alone, legs are assigned: nearly the same, and by the same case.
        let tum = exported(&out, &format!("{case}.exec.tum"));
        let found = json(here, &["judge", &tum.to_string_lossy(), "--campaign", "out"]);
        let log = &found["logs"][0];
        assert_eq!((&log["case"], log["legs_by"].as_str()), (&case.into(), Some("assigned")), "{log}");
        let assigned = of(&log["measures"]["max_deviation_m"]);
        assert!(assigned <= flown + 1e-3 && assigned > 0.5 * flown, "{assigned} {flown}");
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
    let (code, said, error) = run(here, &[&["judge", "logs/0001.csv"][..], &lax].concat());
    assert_eq!(code, 0, "{said}{error}");
    for words in [
        "not aligned, in space or in time",
        "case: matched to case 0001 (mean ",
        "next best ",
        "deviation: max ",
        ", rmse ",
        "gap: flown ",
        "\nPASS 0001 (flown, 0001.csv, source not told without accuracy): ",
        " at most ",
    ] {
        assert!(said.contains(words), "{words}: {said}");
    }
    let scenario = fs::read_to_string(out.join("scenario.toml")).unwrap();
    let strict = ["judge", "logs", "--campaign", "out", "--set", "spec.deviation.max_m=0.001", "--junit", "logs.xml"];
    let (code, said, _) = run(here, &strict);
    assert_eq!(code, 1, "{said}");
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
    let (code, said, _) =
        run(here, &["judge", "log.csv", "--campaign", "out", "--case", "0001", "--set", "spec.deviation.max_m=50"]);
    assert_eq!(code, 0, "{said}");
    // The one mission alone, by a robot's name.
    let arguments =
        ["judge", "log.csv", "--mission", "twice/a.csv", "--robot", "anafi", "--set", "spec.deviation.max_m=50"];
    let (code, said, error) = run(here, &arguments);
    assert!(code == 0 && said.contains("PASS a (flown, log.csv") && error.contains("no --world"), "{said}{error}");
}
