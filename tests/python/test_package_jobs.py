"""The Python package against the command: the same results and bytes; interruption; errors with their parts."""

import os
import signal
import subprocess
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
    import json

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
    assert checked and checked.checked == 2 and checked.failed == 0


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


def test_tables_plots_and_cells(violating):
    table = violating.to_arrow()
    assert table.num_rows == 2 and table.column_names[:3] == ["case", "seed", "status"]
    np.testing.assert_allclose(max(table["max_deviation_m"].to_pylist()), violating.worst.max_deviation_m)
    flown = violating.execution(violating.worst.id)
    assert len(flown["t_s"]) > 10 and np.all(np.diff(flown["t_s"]) > 0)
    judged = violating.judge_by(lambda run: 100.0 - run.p_m[:, 2].max())
    assert judged and len(judged.margins) == 2
    shown = violating._repr_html_()
    assert "FAIL 2/2" in shown and "<svg" in shown
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

    with pytest.raises(KeyboardInterrupt) as stopped:
        hairpin.stress("demo-quadrotor", out=tmp_path / "out", values=values, threads=1, progress=progress)
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
