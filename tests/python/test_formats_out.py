"""What a campaign folder holds, read by the formats' own reference readers: pyarrow, evo, junitparser.

The folder is $HAIRPIN_CAMPAIGN, or is made by the binary $HAIRPIN_BIN (a small campaign, then TUM, CSV and waypoints).
"""

import csv
import json
import os
import shutil
import subprocess
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import pyarrow as pa
import pyarrow.parquet as pq
import pytest

CONTRACT = (
    "case,seed,status,evidence,length,score,max_deviation_m,mean_deviation_m,t_worst_s,leg_worst,"
    "max_acceleration_m_s2,total_time_s,min_clearance_m,saturation_share,ended"
).split(",")
POSE = "t_s,leg,x_m,y_m,z_m,qw,qx,qy,qz,vx_m_s,vy_m_s,vz_m_s".split(",")
SMALL = ["--set", "generate.search.cases=3", "--set", "execute.repeat=2", "--seed", "10"]
# Attributes that Jenkins' xUnit schema has for each element; one more and it drops the whole file.
JENKINS = {
    "testsuites": {"name", "time", "tests", "failures", "errors"},
    "testsuite": {"name", "tests", "failures", "errors", "skipped", "time", "timestamp"},
    "testcase": {"name", "classname", "time"},
    "properties": set(),
    "property": {"name", "value"},
    "failure": {"type", "message"},
    "error": {"type", "message"},
    "skipped": {"type", "message"},
}


def run(*arguments, cwd=None):
    done = subprocess.run([os.environ["HAIRPIN_BIN"], *map(str, arguments)], cwd=cwd, capture_output=True, text=True)
    assert done.returncode in (0, 1), f"{arguments}: exit {done.returncode}\n{done.stdout}\n{done.stderr}"
    return done


@pytest.fixture(scope="session")
def campaign(tmp_path_factory):
    if given := os.environ.get("HAIRPIN_CAMPAIGN"):
        return Path(given)
    if "HAIRPIN_BIN" not in os.environ:
        pytest.skip("neither HAIRPIN_CAMPAIGN nor HAIRPIN_BIN is set")
    place = tmp_path_factory.mktemp("campaign")
    run("new", "quadrotor", cwd=place)
    out = place / "out"
    run("stress", place / "quadrotor.toml", "--out", out, *SMALL)
    run("export", out, "--to", "tum,csv,waypoints")
    return out


def table(path):
    return pq.read_table(path)


def files(campaign, folder, ending="*.parquet"):
    found = sorted((campaign / folder).glob(ending))
    assert found, f"no {folder}/{ending}"
    return found


def test_results_begin_with_the_contract(campaign):
    results = table(campaign / "results.parquet")
    assert results.column_names[: len(CONTRACT)] == CONTRACT
    assert results.schema.field("seed").type == pa.uint64()
    assert results.schema.field("case").type == pa.string()
    cases = results["case"].to_pylist()
    assert cases == [f"{number:04}" for number in range(len(cases))]
    assert set(results["status"].to_pylist()) <= {"pass", "fail", "executor-failed", "inconclusive"}
    assert set(results["evidence"].to_pylist()) <= {"witnessed", "hull-feasible", "unchecked"}


def test_every_table_is_packed_and_says_its_schema(campaign):
    for path in campaign.rglob("*.parquet"):
        opened = pq.ParquetFile(path)
        notes = opened.schema_arrow.metadata or {}
        notes = {**notes, **(opened.metadata.metadata or {})}
        assert notes[b"hairpin.schema"] and int(notes[b"hairpin.schema_version"]) >= 1, path
        for group in range(opened.num_row_groups):
            for column in range(opened.metadata.num_columns):
                assert opened.metadata.row_group(group).column(column).compression in ("SNAPPY", "ZSTD"), path


def test_trajectories_and_executions_share_their_columns(campaign):
    for name, keys in (("trajectories", ["case"]), ("executions", ["case", "run"])):
        tracks = table(campaign / name)  # one path reads all parts
        assert tracks.column_names[: len(keys + POSE)] == keys + POSE, name
        assert tracks.schema.field("t_s").type == pa.float64()
        rows = tracks.to_pylist()
        assert rows == sorted(rows, key=lambda row: [row[key] for key in [*keys, "t_s"]]), name
        for before, row in zip(rows, rows[1:]):
            if [before[key] for key in keys] == [row[key] for key in keys]:
                assert before["t_s"] < row["t_s"], row
        for row in rows:
            assert abs(sum(row[q] ** 2 for q in ("qw", "qx", "qy", "qz")) - 1) < 1e-4, row


def test_a_case_or_run_is_a_row_group_that_its_statistics_name(campaign):
    for name, keys in (("trajectories", ["case"]), ("profiles", ["case"]), ("executions", ["case", "run"])):
        for path in files(campaign, name):
            opened = pq.ParquetFile(path)
            seen = []
            for group in range(opened.num_row_groups):
                columns = opened.metadata.row_group(group)
                found = [columns.column(place).statistics for place in range(len(keys))]
                assert [column.min for column in found] == [column.max for column in found], path
                seen.append([column.min for column in found])
                rows = opened.read_row_group(group, columns=keys).to_pylist()
                assert all([row[key] for key in keys] == seen[-1] for row in rows)
            assert seen == sorted(seen) and len(seen) == len({*map(tuple, seen)}), path


def test_rows_between_are_the_cubic_of_those_that_are_there(campaign):
    """Between rows the position is Hermite's cubic: what is exported at the control period is within a tenth of a millimetre."""
    exported = sorted(campaign.glob("export/0000-0.csv"))
    if not exported:
        pytest.skip("nothing exported to CSV")
    [part, *_] = files(campaign, "executions")
    notes = pq.ParquetFile(part).metadata.metadata
    assert json.loads(notes[b"hairpin.tolerances"])["position_m"] == 1e-4
    rows = pq.read_table(campaign / "executions", filters=[("case", "=", "0000"), ("run", "=", 0)]).to_pylist()
    with open(exported[0], newline="") as file:
        samples = [{key: float(value) for key, value in row.items()} for row in csv.DictReader(file)]
    assert len(rows) < len(samples) / 3
    assert abs(samples[1]["t"] - samples[0]["t"] - float(notes[b"hairpin.sample_s"])) < 1e-9
    place = 0
    axes = [name for name in samples[0] if name in ("x", "y", "z", "x_m", "y_m", "z_m")]
    for sample in samples:
        while place + 2 < len(rows) and rows[place + 1]["t_s"] <= sample["t"]:
            place += 1
        a, b = rows[place], rows[place + 1]
        span = b["t_s"] - a["t_s"]
        u = (sample["t"] - a["t_s"]) / span
        for axis in axes:
            name = axis[0]
            p, q = a[f"{name}_m"], b[f"{name}_m"]
            v, w = a[f"v{name}_m_s"] * span, b[f"v{name}_m_s"] * span
            cubic = (2 * u**3 - 3 * u**2 + 1) * p + (u**3 - 2 * u**2 + u) * v + (3 * u**2 - 2 * u**3) * q + (u**3 - u**2) * w
            assert abs(cubic - sample[axis]) < 1e-4, (sample, axis)


def test_what_was_measured_of_the_worst_run_is_its_case_s_result(campaign):
    results = {row["case"]: row for row in table(campaign / "results.parquet").to_pylist()}
    runs = table(campaign / "runs").to_pylist()
    for row in runs:
        if results[row["case"]]["run"] == row["run"]:
            for name in ("max_deviation_m", "mean_deviation_m", "t_worst_s", "leg_worst", "saturation_share"):
                assert row[name] == results[row["case"]][name], (row["case"], name)


def test_polars_and_duckdb_read_all_with_one_path(campaign):
    expected = table(campaign / "executions").num_rows
    for library, read in (
        ("pandas", lambda it: len(it.read_parquet(campaign / "executions"))),
        ("polars", lambda it: it.read_parquet(str(campaign / "executions" / "*.parquet")).height),
        ("duckdb", lambda it: it.sql(f"select count(*) from '{campaign}/executions/*.parquet'").fetchone()[0]),
    ):
        try:
            module = __import__(library)
        except ImportError:
            continue  # not among what the tests install
        assert read(module) == expected, library


def test_profiles_are_continuous_polynomials_through_the_waypoints(campaign):
    points = table(campaign / "waypoints.parquet").to_pylist()
    for path in sorted((campaign / "profiles").glob("*.parquet")):
        for row in table(path).to_pylist():
            own = [point for point in points if point["case"] == row["case"]]
            start, end = own[row["leg"]], own[row["leg"] + 1]
            key = f"{row['axis']}_m"
            value = sum(row[f"c{i}"] * row["duration_s"] ** i for i in range(8))
            assert abs(row["c0"] - start[key]) < 1e-6 and abs(value - end[key]) < 1e-6, (path, row)


@pytest.mark.parametrize("compression", ["none", "zstd", "gzip", "lz4"])
def test_verify_takes_profiles_of_another_writer(campaign, tmp_path, compression):
    if "HAIRPIN_BIN" not in os.environ or not list((campaign / "profiles").glob("*.parquet")):
        pytest.skip("needs HAIRPIN_BIN and a campaign with witnesses")
    copy = tmp_path / "copy"
    shutil.copytree(campaign, copy)
    for path in files(copy, "profiles"):
        rewritten = table(path).replace_schema_metadata(None)
        leg = rewritten.column_names.index("leg")
        rewritten = rewritten.set_column(leg, "leg", rewritten["leg"].cast(pa.int32()))
        axis = rewritten.column_names.index("axis")
        rewritten = rewritten.set_column(axis, "axis", rewritten["axis"].dictionary_encode())
        pq.write_table(rewritten, path, compression=compression, row_group_size=5)
    answer = json.loads(run("verify", copy, "--json").stdout)
    assert answer["checked"] > 0 and answer["failed"] == 0, answer


def test_junit_is_read_and_keeps_to_jenkins_schema(campaign):
    from junitparser import JUnitXml

    path = campaign / "junit.xml"
    suites = JUnitXml.fromfile(str(path))
    cases = [case for suite in suites for case in suite]
    results = table(campaign / "results.parquet")
    assert len(cases) >= results.num_rows
    failed = sum(status == "fail" for status in results["status"].to_pylist())
    assert sum(suite.failures for suite in suites) == failed
    for element in ElementTree.parse(path).iter():
        assert set(element.attrib) <= JENKINS[element.tag], element.tag
        if element.tag == "testcase":
            assert not element.findall("properties")
        if element.tag == "failure":
            assert element.get("type") == "SpecViolation" and " at t=" in element.get("message")


def test_evo_reads_the_tum_pair_on_the_same_stamps(campaign):
    from evo.core import metrics, sync
    from evo.tools import file_interface

    references = sorted(campaign.rglob("*.ref.tum"))
    if not references:
        pytest.skip("nothing exported to TUM")
    for path in references:
        reference = file_interface.read_tum_trajectory_file(str(path))
        executed = file_interface.read_tum_trajectory_file(str(path).replace(".ref.", ".exec."))
        assert reference.check()[0] and executed.check()[0], path
        assert (reference.timestamps == executed.timestamps).all(), path
        pair = sync.associate_trajectories(reference, executed, max_diff=1e-9)
        assert pair[0].num_poses == reference.num_poses
        error = metrics.APE(metrics.PoseRelation.translation_part)
        error.process_data(pair)
        assert error.get_all_statistics()["max"] >= 0


def test_csv_is_numeric_with_t_first(campaign):
    found = [path for path in campaign.rglob("*.csv") if "-" in path.name or ".planned." in path.name or ".setpoints." in path.name]
    if not found:
        pytest.skip("nothing exported to CSV")
    for path in found:
        with open(path, newline="") as file:
            rows = list(csv.reader(file))
        assert rows[0][0] == "t", path
        times = [float(row[0]) for row in rows[1:]]
        assert all(a < b for a, b in zip(times, times[1:])), path
        assert all(len(row) == len(rows[0]) and [float(cell) for cell in row] for row in rows[1:]), path


def test_exported_waypoints_are_those_of_the_table(campaign):
    found = [path for path in sorted((campaign / "export").glob("*.csv")) if path.stem.isdigit()]
    if not found:
        pytest.skip("no waypoints exported")
    points = table(campaign / "waypoints.parquet").to_pylist()
    for path in found:
        with open(path, newline="") as file:
            rows = list(csv.DictReader(file))
        assert list(rows[0]) == ["x_m", "y_m", "z_m"]
        own = [[row[key] for key in ("x_m", "y_m", "z_m")] for row in points if row["case"] == path.stem]
        assert [[float(row[key]) for key in ("x_m", "y_m", "z_m")] for row in rows] == own, path
