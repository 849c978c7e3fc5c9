"""A controller that takes all runs under way at once flies as one that takes each, from a file and as a callable."""
import json
import os
import subprocess
import sys
from pathlib import Path

import pyarrow.parquet as pq
import pytest

CONTROLLERS = Path(__file__).parents[2] / "examples/controllers"
HAIRPIN = os.environ.get("HAIRPIN_BIN", str(Path(__file__).parents[2] / "target/debug/hairpin"))
# The Python that has NumPy is the one that runs this.
PLACES = {**os.environ, "PATH": f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}"}
SETS = ['generate.search={ method = "uniform", waypoints = 60, cases = 4 }', "execute.repeat=2", "execute.baseline=0", "spec.deviation.max_m=50",
        "execute.control_rate_hz=25"]


def stress(out, controller, threads):
    words = [HAIRPIN, "stress", "demo-quadrotor", "--out", str(out), "--threads", str(threads), "--json"]
    sets = [*SETS, f'execute.controller="python:{controller}"']
    done = subprocess.run(words + [word for one in sets for word in ("--set", one)], capture_output=True, text=True, env=PLACES)
    return done.returncode, done.stdout + done.stderr


def deviations(out):
    rows = pq.read_table(out / "results.parquet", columns=["case", "max_deviation_m"]).to_pylist()
    return [row["max_deviation_m"] for row in sorted(rows, key=lambda row: row["case"])]


def test_rows_are_steered_as_runs_are_by_themselves(tmp_path):
    for name, threads in (("pd", 2), ("pd_many", 1), ("pd_many", 5)):
        code, told = stress(tmp_path / f"{name}-{threads}", CONTROLLERS / f"{name}.py", threads)
        assert code == 0, told
    alone, one, five = (deviations(tmp_path / name) for name in ("pd-2", "pd_many-1", "pd_many-5"))
    assert one == five and len(one) == 4 and one == pytest.approx(alone, abs=1e-9)


def test_a_callable_does_what_its_file_does(tmp_path):
    hairpin = pytest.importorskip("hairpin", reason="the package is built by tests/run")
    space = {"__name__": "pd_many"}
    exec((CONTROLLERS / "pd_many.py").read_text(), space)
    values = {"generate.search": {"method": "uniform", "waypoints": 60, "cases": 4}, "execute.repeat": 2, "execute.baseline": 0,
              "spec.deviation.max_m": 50, "execute.control_rate_hz": 25}
    found = hairpin.stress("demo-quadrotor", controller=hairpin.vectorised(space["control"]), out=tmp_path / "own", values=values, threads=3)
    assert stress(tmp_path / "file", CONTROLLERS / "pd_many.py", 3)[0] == 0
    assert [case.max_deviation_m for case in found] == deviations(tmp_path / "file")


@pytest.mark.parametrize("fault, words, failed", [
    ("answer['a_m_s2'][[m['waypoints_m'][1][0] > m['waypoints_m'][1][1] for m in reference['mission']]] = np.nan", "not finite", "some"),
    ("raise ValueError('no thrust left')", "ValueError: no thrust left", "all"),
    ("answer['a_m_s2'] = answer['a_m_s2'][1:]", "a row for each of", "all"),
])
def test_what_is_wrong_with_a_row_costs_its_run(tmp_path, fault, words, failed):
    text = (CONTROLLERS / "pd_many.py").read_text().replace("control(", "good(").replace("control.", "good.")
    sick = f"{text}\ndef control(t_s, state, reference):\n    answer = good(t_s, state, reference)\n    {fault}\n    return answer\n\n" \
           "control.hairpin_vectorised = True\n"
    (tmp_path / "sick.py").write_text(sick)
    code, told = stress(tmp_path / "out", tmp_path / "sick.py", 4)
    assert code == 4 and words in told and "EXECUTOR FAILED" in told, told
    kept = [one is not None for one in deviations(tmp_path / "out")]
    assert any(kept) == (failed == "some") and not all(kept), (kept, told)
    assert json.loads(told[told.index("{") : told.rindex("}") + 1])["counts"]["cases"] == 4
