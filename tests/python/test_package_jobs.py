"""The Python package against the command: the same results and bytes; interruption; errors with their parts."""

import json
import os
import signal
import subprocess
import sys
import threading
import time
from pathlib import Path

import numpy as np
import pytest

hairpin = pytest.importorskip("hairpin", reason="the package is built by tests/run")
BIN = os.environ["HAIRPIN_BIN"]
SMALL = {"generate.search.cases": 2, "execute.repeat": 1, "execute.baseline": 0}
# What depends on clock, threads or place.
FREE = ("report.html", "junit.xml", ".hairpin")


def sets(values):
    return [word for key, value in values.items() for word in ("--set", f"{key}={value}")]


def command(*words, code=None):
    done = subprocess.run([BIN, *map(str, words)], capture_output=True, text=True, timeout=120)
    assert code is None or done.returncode == code, done.stderr
    return done


def contents(folder):
    files = [path for path in sorted(Path(folder).rglob("*")) if path.is_file()]
    return {
        str(path.relative_to(folder)): path.read_bytes()
        for path in files
        if path.name not in FREE and not path.name.startswith("timing")
    }


@pytest.fixture(scope="module")
def violating(tmp_path_factory):
    folder = tmp_path_factory.mktemp("violating") / "out"
    return hairpin.stress("demo-quadrotor", out=folder, seed=3, values={**SMALL, "spec.deviation.max_m": 0.5})


def test_stress_has_the_bytes_and_the_answer_of_the_command(tmp_path, violating):
    values = {**SMALL, "spec.deviation.max_m": 0.5}
    done = command("stress", "demo-quadrotor", "--out", tmp_path / "out", "--seed", 3, "--json", *sets(values))
    assert contents(tmp_path / "out") == contents(violating.folder)
    said = json.loads(done.stdout)
    for answer in (said, violating.summary):
        answer.pop("paths", None)
    assert said == {key: value for key, value in violating.summary.items()} and done.returncode == violating.exit_code == 1


def test_parts_are_the_commands_parts(tmp_path):
    ours, theirs = tmp_path / "ours", tmp_path / "theirs"
    campaign = hairpin.generate("demo-quadrotor", out=ours, values=SMALL)
    assert [case.status for case in campaign] == ["generated", "generated"]
    command("generate", "demo-quadrotor", "--out", theirs, *sets(SMALL), code=0)
    assert contents(ours) == contents(theirs)
    judged = campaign.execute().judge({"spec.deviation.max_m": 50.0})
    command("execute", theirs, code=0)
    command("judge", theirs, "--set", "spec.deviation.max_m=50.0", code=0)
    assert contents(ours) == contents(theirs) and judged.exit_code == 0
    checked = judged.verify()
    assert checked and checked.checked == 2 and checked.failed == 0 and checked.nothing is None and checked.edited == ()


def test_nothing_to_verify_is_not_verified(tmp_path):
    unwitnessed = {**SMALL, "generate.reach": "hull", "generate.timing.step_s": 1.0}
    checked = hairpin.generate("demo-quadrotor", out=tmp_path / "a", values=unwitnessed).verify()
    assert (checked.checked, checked.failed, checked.exit_code) == (0, 0, 0)
    assert not checked and "claims a witness" in checked.nothing


def test_a_scenario_that_was_edited_is_told_and_its_cases_are_not_exported(tmp_path):
    campaign = hairpin.generate("demo-quadrotor", out=tmp_path / "a", values=SMALL)
    file = tmp_path / "a" / "scenario.toml"
    file.write_text(file.read_text().replace("accept_m = 1.0", "accept_m = 2.0"))
    assert campaign.verify().edited == ("`execute.accept_m`",)
    said = command("export", tmp_path / "a", "--to", "waypoints", code=2)
    assert "`execute.accept_m`" in said.stderr


def test_a_violation_is_shrunk_compared_and_told(violating, tmp_path):
    worst = violating.worst
    assert worst.status == "fail" and worst.violations[0].value > worst.violations[0].limit == 0.5
    small = violating.shrink(budget=4)
    assert len(small.waypoints_m) < len(small.waypoints_before_m) and small.repro.is_file() and "still" in str(small)
    assert command("replay", small.repro).returncode == 1
    same = hairpin.compare(violating, violating.folder)
    assert same and not same.newly_failing and not same.regression
    with pytest.raises(hairpin.InputError, match="0009"):
        violating["0009"]


def test_tables_reach_arrow_numpy_and_pandas(violating):
    table = violating.to_arrow()
    assert table.num_rows == 2 and table.column_names[:3] == ["case", "seed", "status"]
    np.testing.assert_allclose(max(table["max_deviation_m"].to_pylist()), violating.worst.max_deviation_m)
    import pyarrow.parquet as parquet

    for name in ("results", "waypoints", "executions", "trajectories", "runs"):
        ours, place = violating.to_arrow(name), violating.folder / name
        theirs = parquet.read_table(place if place.is_dir() else place.with_suffix(".parquet"))
        assert ours.schema.equals(theirs.schema) and ours.equals(theirs), name
        for column, values in violating.table(name).to_numpy().items():
            same = [np.nan if value is None else value for value in theirs[column].to_pylist()]
            np.testing.assert_equal([np.nan if value is None else value for value in values.tolist()], same, column)
    one = violating.to_arrow("executions", filters=[("case", "==", "0001")])
    assert set(one["case"].to_pylist()) == {"0001"}
    assert len(violating.table("executions", case=1, run=0).to_numpy()["t_s"]) == one.num_rows
    for ask in (lambda: violating.table("executions", case=1, run=7), lambda: violating.execution(1, 7)):
        with pytest.raises(hairpin.InputError, match="case 0001: 0") as found:
            ask()
        assert found.value.field == "run"
    with pytest.raises(hairpin.InputError, match="one that is there: 0"):
        violating.table("runs", run=7)
    with pytest.raises(hairpin.InputError, match="executions") as found:
        violating.table("../x")
    assert found.value.field == "table"


def test_tables_need_no_pyarrow(violating):
    pytest.importorskip("nanoarrow")
    code = (
        "import sys, hairpin, nanoarrow\n"
        "found = hairpin.Campaign(sys.argv[1])\n"
        "table = nanoarrow.ArrayStream(found.table('results'))\n"
        "columns = [name for name in table.schema.fields]\n"
        "rows = list(nanoarrow.ArrayStream(found.table('executions')).read_all().iter_py())\n"
        "assert len(rows) > 20 and rows[0]['case'] == '0000', rows[:1]\n"
        "assert len(found.execution('0000')['t_s']) > 10 and found.judge_by(lambda run: True)\n"
        "assert '<svg' in found._repr_html_() and nanoarrow.c_schema(found.table('results')).n_children == len(columns)\n"
        "assert 'pyarrow' not in sys.modules\n"
    )
    done = subprocess.run([sys.executable, "-c", code, violating.folder], capture_output=True, text=True, timeout=60)
    assert done.returncode == 0, done.stderr


def test_cells_show_the_flight_that_was_flown(violating):
    flown = violating.execution(violating.worst.id)
    assert len(flown["t_s"]) > 10 and np.all(np.diff(flown["t_s"]) > 0)
    judged = violating.judge_by(lambda run: 100.0 - run.p_m[:, 2].max())
    assert judged and len(judged.margins) == 2
    shown, worst = violating._repr_html_(), violating.worst
    assert "FAIL 2/2" in shown and "<svg" in shown and len(shown) < 20_000
    assert f"{worst.max_deviation_m:.2f} m at {worst.t_worst_s:.1f} s" in shown and 'class="worst"' in shown
    flight = next(line for line in shown.split("<polyline") if "#0072b2" in line)
    assert flight.count(",") > 2 * len(worst.waypoints_m)
    planned = hairpin.generate("demo-quadrotor", out=violating.folder.parent / "planned", values=SMALL)._repr_html_()
    assert "<svg" in planned and "#0072b2" not in planned
    cell = violating.show(violating.worst)._repr_html_()
    assert cell.startswith("<iframe") and "srcdoc=" in cell and f"&quot;asked&quot;:&quot;{violating.worst.id}&quot;" in cell


def test_plots_are_drawn(violating):
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("Agg")
    axes = violating.plot()
    assert axes.get_xlabel() == "x (m)" and len(axes.lines) == 2


def test_mistakes_have_their_parts(tmp_path):
    with pytest.raises(hairpin.InputError) as found:
        hairpin.stress("demo-quadrotor", out=tmp_path / "out", values={"execute.repeat": 0})
    assert isinstance(found.value, ValueError)
    assert (found.value.field, found.value.value) == ("execute.repeat", "0") and "1" in found.value.bound
    with pytest.raises(hairpin.InputError) as found:
        hairpin.stress("nothing.toml")
    assert "nothing.toml" in str(found.value)
    with pytest.raises(hairpin.InputError) as found:
        hairpin.stress("demo-quadrotor", if_there="perhaps")
    assert found.value.field == "if_there"
    with pytest.raises(hairpin.InputError, match="threads"):
        hairpin.generate("demo-quadrotor", out=tmp_path / "out", threads=0)


def test_scenarios_are_texts_tables_and_files(tmp_path):
    from hairpin._scenario import to_toml

    shipped = (Path(__file__).parents[2] / "data/scenarios/demo-quadrotor.toml").read_text()
    tables = {**__import__("tomllib").loads(shipped)} if __import__("sys").version_info >= (3, 11) else None
    found = []
    for number, source in enumerate([shipped, tables, hairpin.Scenario("demo-quadrotor", robot=hairpin.Robot("flightgoggles"))]):
        if source is not None:
            campaign = hairpin.generate(source, out=tmp_path / str(number), values=SMALL)
            found.append([case.waypoints_m.tolist() for case in campaign])
    assert found and all(one == found[0] for one in found)
    assert to_toml({"a": True, "b": {"c": [1.0, None and 0 or 2]}}) == '"a" = true\n"b" = { "c" = [1.0, 2] }\n'


def test_explain_and_learn(tmp_path):
    why = hairpin.explain("demo-quadrotor", graphs=1)
    assert why and why.exit_code == 0 and why.detail["verdict"] == why.verdict
    with pytest.raises(hairpin.InputError) as found:
        hairpin.learn(tmp_path, stress="beauty")
    assert found.value.field == "stress"


def test_ctrl_c_keeps_what_is_done_and_resume_goes_on(tmp_path):
    values = {"generate.search.cases": 4, "execute.repeat": 12, "execute.baseline": 0}
    seen = []

    def progress(what, done, of):
        if what == "execute" and not seen:
            seen.append(what)
            os.kill(os.getpid(), signal.SIGINT)

    # What a shell starts in the background ignores Ctrl-C from the start, and so do these tests there.
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    try:
        with pytest.raises(KeyboardInterrupt) as stopped:
            hairpin.stress("demo-quadrotor", out=tmp_path / "out", values=values, threads=1, progress=progress)
    finally:
        signal.signal(signal.SIGINT, before)
    assert seen and any("resume" in note for note in getattr(stopped.value, "__notes__", ["resume"]))
    left = hairpin.Campaign(tmp_path / "out")
    assert len(left) == 4 and left.to_arrow("runs").num_rows < 48
    done = hairpin.stress("demo-quadrotor", out=tmp_path / "out", values=values, if_there="resume")
    whole = hairpin.stress("demo-quadrotor", out=tmp_path / "whole", values=values)
    assert contents(done.folder) == contents(whole.folder)


def test_what_a_callback_raises_stops_the_job(tmp_path):
    def progress(what, done, of):
        raise RuntimeError("enough")

    with pytest.raises(RuntimeError, match="enough"):
        hairpin.generate("demo-quadrotor", out=tmp_path / "out", values={"generate.search.cases": 500}, progress=progress)


def test_the_interpreter_is_free_while_a_job_works(tmp_path):
    counted = []
    over = threading.Event()

    def count():
        while not over.is_set():
            counted.append(time.monotonic())
            time.sleep(0.005)

    other = threading.Thread(target=count)
    other.start()
    begun = time.monotonic()
    hairpin.stress("demo-quadrotor", out=tmp_path / "out", values={**SMALL, "generate.search.cases": 4})
    ended = time.monotonic()
    over.set()
    other.join()
    during = [at for at in counted if begun < at < ended]
    assert len(during) > 2 and max(np.diff(during)) < 0.5 * (ended - begun) + 0.2


def test_logs_are_judged_with_the_commands_words_and_numbers(violating, tmp_path):
    command("export", violating.folder, "--to", "csv", "--case", "0", code=0)
    log = violating.folder / "export/0000-0.csv"
    ours = hairpin.judge(log, campaign=violating)
    done = command("judge", log, "--campaign", violating.folder, code=1)
    assert str(ours) == done.stdout.rstrip("\n") and not ours and ours.exit_code == 1
    said = json.loads(command("judge", log, "--campaign", violating.folder, "--json", code=1).stdout)
    assert ours.logs[0].detail == said["logs"][0] and ours.counts == said["counts"] and ours.verdict == said["verdict"]
    one = ours.logs[0]
    assert (one.status, one.case) == ("fail", "0000") and f"{one.measures['max_deviation_m']:.2f} m > 0.50 m" in one.verdict
    assert one.violations[0].startswith("deviation")
    assert one.measures["max_deviation_m"] == pytest.approx(violating["0000"].max_deviation_m, abs=2e-4)
    mission = tmp_path / "mission.csv"
    points = [",".join(map(repr, point)) for point in violating["0000"].waypoints_m.tolist()]
    mission.write_text("\n".join(["x_m,y_m,z_m", *points]) + "\n")
    wide = {"spec.deviation.max_m": 50.0}
    words = ("--mission", mission, "--robot", "flightgoggles", "--to", 4.0, "--set", "spec.deviation.max_m=50.0")
    part = hairpin.judge(log, wide, mission=mission, robot="flightgoggles", to_s=4.0)
    assert str(part) == command("judge", log, *words).stdout.rstrip("\n") and part.logs[0].status == "inconclusive"
    for settings, field in (({"robot": "anafi"}, "robot"), ({"case": 0, "mission": mission}, "case"), ({"page": "x"}, "page")):
        with pytest.raises(hairpin.InputError) as found:
            hairpin.judge(log, **settings)
        assert found.value.field == field
    assert hairpin.judge(campaign=violating).exit_code == 1


def test_what_is_cut_out_of_a_log_is_told(violating, tmp_path):
    command("export", violating.folder, "--to", "csv", "--case", "0", code=0)
    head, *rows = (violating.folder / "export/0000-0.csv").read_text().splitlines()
    gap = tmp_path / "gap.csv"
    gap.write_text("\n".join([head, *rows[:100], *rows[200:]]) + "\n")
    found = hairpin.judge(gap, campaign=violating, case=0)
    assert found.logs[0].cuts and found.logs[0].cuts[0].lost_s > 0 and "cut out: " in str(found), str(found)


def test_clouds_have_the_bytes_and_numbers_of_the_command(tmp_path):
    points_m = np.array([[0.3, 0.0, 0.3], [0.3, 0.1, 0.3], [0.35, 0.0, 0.3], [0.4, 0.05, 0.2001]])
    (tmp_path / "cloud.csv").write_text("x_mm,y_mm,z_mm\n300,0,300\n300,100,300\n350,0,300\n400,50,200.1\n")
    ours = hairpin.max_load(cloud=points_m, cell="irb120", out=tmp_path / "ours", programs=2)
    words = ("max-load", "irb120", "--cloud", tmp_path / "cloud.csv", "--out", tmp_path / "theirs", "--programs", 2, "--json")
    said = json.loads(command(*words, code=0).stdout)
    for answer in (said, ours.detail):
        answer.pop("time_s"), answer.pop("folder")
    assert said == ours.detail and ours.proven and ours.path == said["path"] and len(ours.paths) == 2
    assert contents(tmp_path / "ours") == contents(tmp_path / "theirs")
    assert len(ours.campaign) == 2 and ours.unit == said["unit"]
    for settings, field in (
        ({"cloud": np.zeros((3, 2)), "cell": "irb120"}, "cloud"),
        ({"cloud": points_m}, "cell"),
        ({"cloud": points_m, "cell": "irb120", "nodes": 3}, "nodes"),
        ({"matrix": [[0, 1], [1, 0]], "cell": "irb120"}, "cell"),
    ):
        with pytest.raises(hairpin.InputError) as found:
            hairpin.max_load(**settings)
        assert found.value.field == field
    proof = tmp_path / "proof.json"
    hairpin.max_load([[0, 1.5], [2, 0]], method="branch", certificate=proof)
    (tmp_path / "costs.csv").write_text(",1.5\n2,\n")
    command("max-load", "--graph", tmp_path / "costs.csv", "--verify", proof, code=0)
