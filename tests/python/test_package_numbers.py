"""`steer` and `max_load` of the package against the command, and against what they must be."""

import collections
import copy
import csv
import dataclasses
import itertools
import json
import os
import pickle
import subprocess

import numpy as np
import pytest

hairpin = pytest.importorskip("hairpin", reason="the package is built by tests/run")
from hairpin._clouds import cloud_file  # noqa: E402
from hairpin._judging import _listed  # noqa: E402
from hairpin._labels import row_by_name  # noqa: E402

BIN = os.environ["HAIRPIN_BIN"]


def questions(count, seed=5):
    random = np.random.default_rng(seed)
    low, high = [1.0, -3.0, -1.5, -0.5, -0.5], [8.0, 3.0, 1.5, 0.5, 0.5]
    return random.uniform(low, high, (count, 5))


def test_one_drive_meets_its_goal_by_its_own_curvature():
    drive = hairpin.steer("generic", x=4.0, y=1.0, yaw=0.5, k0=0.1, kf=-0.2)
    assert drive and drive.status == "ok" and drive.limit is None
    s = np.linspace(0.0, drive.length_m, 4001)
    kappa = drive.curvature(s)
    assert kappa[0] == pytest.approx(0.1) and kappa[-1] == pytest.approx(-0.2, abs=1e-6)
    middle = 0.5 * (kappa[1:] + kappa[:-1])
    step = s[1] - s[0]
    yaw = np.concatenate([[0.0], np.cumsum(middle) * step])
    at = 0.5 * (yaw[1:] + yaw[:-1])
    assert np.cos(at).sum() * step == pytest.approx(4.0, abs=1e-3)
    assert np.sin(at).sum() * step == pytest.approx(1.0, abs=1e-3)
    assert yaw[-1] == pytest.approx(0.5, abs=1e-3)
    assert np.isnan(drive.curvature(drive.length_m + 1.0)) and drive.curvature.shape == (len(drive.segments), 6)


def test_a_drive_is_the_same_once_it_was_pickled_or_copied():
    drive = hairpin.steer("generic", x=4.0, y=1.0, yaw=0.5, k0=0.1, kf=-0.2)
    many = hairpin.steer("generic", queries=questions(3))
    places = np.linspace(0.0, drive.length_m, 7)
    again = [pickle.loads(pickle.dumps(drive, protocol)) for protocol in range(pickle.HIGHEST_PROTOCOL + 1)]
    for one in (*again, copy.copy(drive), copy.deepcopy(drive)):
        np.testing.assert_array_equal(one.curvature(places), drive.curvature(places))
        assert type(one.curvature) is hairpin.Curvature and np.isfinite(one.curvature(places)).all()
    np.testing.assert_array_equal(pickle.loads(pickle.dumps(many))[1].curvature(0.5), many[1].curvature(0.5))
    # What is only a part of the numbers is no drive's curvature.
    assert type(drive.curvature[:1]) is np.ndarray and np.array_equal([*drive.curvature], np.asarray(drive.curvature))
    with pytest.raises(TypeError, match="no drive's"):
        np.sum(drive.curvature, axis=0)(1.0)


def test_many_are_what_the_command_answers(tmp_path):
    asked = questions(200)
    asked[17, 2] = np.nan
    table = tmp_path / "q.csv"
    with open(table, "w") as file:
        print("id,x,y,yaw,k0,kf", file=file)
        for number, row in enumerate(asked):
            print(number, *(repr(float(value)) for value in row), sep=",", file=file)
    done = subprocess.run(
        [BIN, "steer", "generic", "--queries", table, "--out", tmp_path / "r.csv", "--json"], capture_output=True, text=True
    )
    assert done.returncode == 0, done.stderr
    drives = hairpin.steer("generic", queries=asked)
    rows = list(csv.DictReader(open(tmp_path / "r.csv")))
    assert len(drives) == 200 and drives.status[17] == "invalid" and drives.limit[17] == "yaw"
    for number, of_query in itertools.groupby(rows, key=lambda row: int(row["id"])):
        of_query = list(of_query)
        drive = drives[number]
        assert [row["status"] for row in of_query] == [drive.status] * len(of_query)
        assert (of_query[0]["limit"] or None) == drive.limit
        if drive.segments:
            theirs = [[float(row[f"a{power}"] or 0.0) for power in range(6)] for row in of_query]
            np.testing.assert_allclose(np.asarray(drive.curvature), theirs, rtol=1e-9, atol=1e-12)
            np.testing.assert_allclose(
                [s.length_m for s in drive.segments], [float(row["length_m"] or 0.0) for row in of_query], rtol=1e-9
            )
    assert len({drive.status for drive in drives}) > 1
    one = hairpin.steer("generic", **dict(zip(("x", "y", "yaw", "k0", "kf"), asked[0], strict=True)))
    assert (one.status, one.length_m) == (drives[0].status, drives[0].length_m) or one.status == "infeasible"


@pytest.mark.parametrize(
    ("given", "field"),
    [
        ({"x": float("nan"), "y": 0.0, "yaw": 0.0}, "x"),
        ({"x": 1.0, "y": 0.0, "yaw": 0.0, "kf": float("inf")}, "kf"),
        ({"x": 1.0, "y": 0.0}, "yaw"),
        ({"queries": np.zeros((3, 4))}, "queries"),
        ({"queries": "abc"}, "queries"),
        ({"x": 1.0, "y": 0.0, "yaw": 0.0, "max_curvature": 0.0}, "max_curvature"),
        ({"x": 1e9, "y": 0.0, "yaw": 0.0}, "x"),
        ({"x": 1.0, "y": 0.0, "yaw": 0.0, "terrain": "nowhere.tif"}, "terrain"),
    ],
)
def test_bad_input_of_steer_names_its_field(given, field):
    with pytest.raises(ValueError) as found:
        hairpin.steer("generic", **given)
    assert found.value.field == field and isinstance(found.value, hairpin.InputError)


def test_an_unknown_rover_is_named():
    with pytest.raises(ValueError) as found:
        hairpin.steer("no-such-rover", x=1.0, y=0.0, yaw=0.0)
    assert found.value.field and "no-such-rover" in str(found.value)


def test_no_question_is_no_answer():
    drives = hairpin.steer("generic", queries=np.zeros((0, 5)))
    assert len(drives) == 0 and drives.status.shape == (0,) and list(drives) == []


def heaviest(matrix):
    """Over all orders of all subsets."""
    points = range(len(matrix))
    best = None
    for size in points:
        for path in itertools.permutations(points, size + 1):
            arcs = [matrix[a, b] for a, b in zip(path, path[1:])]
            if not np.isnan(arcs).any():
                best = max(best or 0.0, float(np.sum(arcs)))
    return best


def test_the_heaviest_path_is_that_of_enumeration_and_of_the_command(tmp_path):
    random = np.random.default_rng(11)
    for number in range(5):
        matrix = np.round(random.uniform(0.0, 10.0, (6, 6)), 2)
        matrix[random.uniform(size=(6, 6)) < 0.4] = np.nan
        found = hairpin.max_load(matrix)
        assert found.proven and found.cost == pytest.approx(heaviest(matrix), abs=1e-9)
        assert len(set(found.path)) == len(found.path)
        np.fill_diagonal(matrix, np.nan)
        table = tmp_path / f"{number}.csv"
        table.write_text("".join(",".join("" if np.isnan(x) else repr(float(x)) for x in row) + "\n" for row in matrix))
        done = subprocess.run([BIN, "max-load", "--graph", table, "--json"], capture_output=True, text=True)
        said = json.loads(done.stdout)
        assert (said["path"], said["cost"], said["method"]) == (found.path, found.cost, found.method)


def test_no_arc_and_bad_matrices():
    nothing = hairpin.max_load([[np.nan, np.nan], [np.nan, np.nan]], start=0, end=1)
    assert nothing.path is None and nothing.cost is None and nothing.feasible is False
    # The diagonal has no meaning, whatever stands there.
    assert hairpin.max_load([[-1, 1.5], [2, np.inf]]).cost == 2
    for matrix, field in (
        ([[0, -1.0], [1, 0]], "matrix[0, 1]"),
        (np.zeros((2, 3)), "matrix"),
        ([[0, np.inf], [1, 0]], "matrix[0, 1]"),
    ):
        with pytest.raises(ValueError) as found:
            hairpin.max_load(matrix)
        assert found.value.field == field
    for given, field in (({"start": 5}, "start"), ({"method": "luck"}, "method"), ({"min_cost": -1}, "min_cost")):
        with pytest.raises(ValueError) as found:
            hairpin.max_load([[0, 1], [1, 0]], **given)
        assert found.value.field == field


def test_results_with_arrays_are_equal_by_their_fields():
    asked = {"x": 4.0, "y": 1.0, "yaw": 0.5, "k0": 0.1, "kf": -0.2}
    drive, other = (hairpin.steer("generic", **{**asked, "x": x}) for x in (4.0, 5.0))
    again = pickle.loads(pickle.dumps(drive))
    assert drive == again and drive.segments == again.segments and drive != other and drive != "drive"
    assert drive.segments[0] == copy.copy(drive.segments[0]) and drive.segments[0] != other.segments[0]
    nowhere = dataclasses.replace(drive, length_m=np.nan)
    assert nowhere == copy.deepcopy(nowhere) and nowhere != drive
    case = hairpin.Case("0003", 7, np.zeros((2, 3)), "unchecked", np.nan, "generated", *[None] * 6, (), None)
    moved = dataclasses.replace(case, waypoints_m=np.ones((2, 3)))
    shorter = dataclasses.replace(case, waypoints_m=np.zeros((1, 3)))
    assert case == copy.deepcopy(case) and case not in (moved, shorter) and [moved, case].index(case) == 1
    run = hairpin.Run(case, 0, {"t_s": np.array([0.0, np.nan])})
    assert run == copy.deepcopy(run) and run != hairpin.Run(case, 0, {"t_s": np.array([0.0, 1.0])})
    assert run != hairpin.Run(moved, 0, run.columns) and run != hairpin.Run(case, 0, {})
    for one in (drive, drive.segments[0], case, run):
        with pytest.raises(TypeError, match=f"unhashable type: '{type(one).__name__}'"):
            hash(one)


def test_drives_and_campaigns_are_equal_by_what_they_found(tmp_path):
    one, two, other = (hairpin.steer("generic", queries=questions(3, seed)) for seed in (5, 5, 6))
    assert one == two and one == pickle.loads(pickle.dumps(one)) and one != other and one != "drives" and one[0] == two[0]
    with pytest.raises(TypeError, match="unhashable type: 'Drives'"):
        hash(one)
    assert hairpin.max_load([[0, 1], [1, 0]]) == hairpin.max_load([[0, 1], [1, 0]]) != hairpin.max_load([[0, 2], [1, 0]])
    values = {"generate.search.cases": 1}
    made = hairpin.generate("demo-quadrotor", out=tmp_path / "a", values=values)
    again = pickle.loads(pickle.dumps(made))
    assert made == again and hash(made) == hash(again) and {made: 1}[again] == 1
    assert made != hairpin.generate("demo-quadrotor", out=tmp_path / "b", values=values)


def test_queries_are_taken_by_the_names_of_their_columns():
    asked = questions(6)
    plain, names, order = hairpin.steer("generic", queries=asked), ["x", "y", "yaw", "k0", "kf"], [1, 0, 2, 4, 3]
    swapped = [names[place] for place in order]
    records = np.zeros(len(asked), dtype=[(name, float) for name in swapped])
    for name, column in zip(names, asked.T, strict=True):
        records[name] = column
    Query = collections.namedtuple("Query", swapped)
    given = [records, [Query(*row) for row in asked[:, order].tolist()]]
    pandas, pyarrow = pytest.importorskip("pandas"), pytest.importorskip("pyarrow")
    given += [pandas.DataFrame(asked[:, order], columns=swapped), pandas.DataFrame(asked), pandas.DataFrame(asked, columns=range(3, 8))]
    given.append(pyarrow.table({name: records[name] for name in swapped}))
    for queries in given:
        assert hairpin.steer("generic", queries=queries) == plain, type(queries)
    assert hairpin.steer("generic", queries=pandas.DataFrame(np.zeros((2, 8)) + 0.5)).ok.shape == (2,)
    for columns in (["x", "y", "yaw", "k0", "k1"], ["x", "y", "yaw", "k0", "k0"], [1, 0, 2, 3, 4]):
        with pytest.raises(hairpin.InputError, match="x, y, yaw, k0, kf") as found:
            hairpin.steer("generic", queries=pandas.DataFrame(asked, columns=columns))
        assert found.value.field == "queries.columns"


def test_matrices_go_by_the_labels_of_their_rows():
    pandas = pytest.importorskip("pandas")
    costs = np.array([[0, 5, 1, 2], [9, 0, 3, 1], [2, 8, 0, 7], [4, 1, 6, 0.5]])
    plain, rows, order = hairpin.max_load(costs), list("abcd"), [2, 0, 3, 1]
    for index, columns in ((rows, [rows[place] for place in order]), (range(4), [str(place) for place in order]), (range(4), order)):
        assert hairpin.max_load(pandas.DataFrame(costs[:, order], index=index, columns=columns)) == plain
    for index, columns in ((rows, rows), (range(4), rows), (rows, range(4)), (range(1, 5), range(4))):
        assert hairpin.max_load(pandas.DataFrame(costs, index=index, columns=columns)) == plain
    with pytest.raises(hairpin.InputError) as found:
        hairpin.max_load(pandas.DataFrame(costs, index=rows, columns=[*"abce"]))
    assert (found.value.field, found.value.value) == ("matrix.columns", "'e'")


def test_clouds_in_millimetres_are_not_taken_for_metres():
    pandas = pytest.importorskip("pandas")
    with pytest.raises(hairpin.InputError) as found:
        hairpin.max_load(cloud=pandas.DataFrame([[300.0, 0.0, 300.0]], columns=["x_mm", "y_mm", "z_mm"]), cell="irb120")
    assert found.value.field == "cloud.columns"
    points = pandas.DataFrame([[0.0, 0.3, 0.4], [0.1, 0.35, 0.5]], columns=["y_m", "x_m", "z_m"])
    assert cloud_file(points).read_text() == cloud_file([[0.3, 0.0, 0.4], [0.35, 0.1, 0.5]]).read_text()


def test_one_row_with_names_goes_by_them():
    pandas = pytest.importorskip("pandas")
    asked, terrain = {"x": 4.0, "y": 1.0, "yaw": 0.5}, (2.0, 3.0, 0.25)
    plain = hairpin.steer("generic", **asked, start=terrain)
    Start = collections.namedtuple("Start", ["yaw", "x", "y"])
    for start in (pandas.Series({"yaw": 0.25, "x": 2.0, "y": 3.0}), Start(0.25, 2.0, 3.0), pandas.Series(terrain)):
        assert row_by_name("start", start, (("x", "y", "yaw"),))[0] == 2.0
        assert hairpin.steer("generic", **asked, start=start) == plain
    with pytest.raises(hairpin.InputError) as found:
        hairpin.steer("generic", **asked, start=pandas.Series({"lat": 2.0, "lon": 3.0, "yaw": 0.25}))
    assert found.value.field == "start.index"
    # Sorted answers are those of other runs.
    with pytest.raises(hairpin.InputError, match="judge.index"):
        _listed(pandas.Series([3.0, 1.0, 2.0]).sort_values(), 3)
    assert _listed(pandas.Series([3.0, 1.0]), 2) == [3.0, 1.0]
