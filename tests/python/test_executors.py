"""Whole campaigns flown by the shipped executors: the protocol from end to end, in other simulators with other controllers."""
import json
import os
import shlex
import subprocess
import sys
from pathlib import Path

import pyarrow.csv as pv
import pytest

ROOT = Path(__file__).resolve().parents[2]
HAIRPIN = os.environ.get("HAIRPIN_BIN", str(ROOT / "target" / "debug" / "hairpin"))
EXECUTORS = ROOT / "examples" / "executors"
# A robot that each flies well.
FLY = {
    "rotorpy_executor.py": "flightgoggles",
    "mujoco_executor.py": "flightgoggles",
    "drone_models_executor.py": "crazyflie",
    "foundation_policy_executor.py": "x500",
}


@pytest.mark.parametrize("name", FLY)
def test_another_simulator_flies_a_campaign(name, tmp_path):
    command = f"{shlex.quote(sys.executable)} {shlex.quote(str(EXECUTORS / name))}"
    out = tmp_path / "campaign"
    sets = [f'robot="{FLY[name]}"', 'generate.search={ method = "uniform", waypoints = 60, cases = 1 }', "execute.repeat=1",
            "task.length=4", "task.end_m=[9, 7, 6]", "execute.timeout_s=240", "spec.deviation.max_m=3", "execute.baseline=0"]
    arguments = [HAIRPIN, "stress", "demo-quadrotor", "--executor", command, "--out", str(out), "--json"]
    for one in sets:
        arguments += ["--set", one]
    done = subprocess.run(arguments, capture_output=True, text=True)
    assert done.stdout, done.stderr
    answer = json.loads(done.stdout)
    logs = [path.read_text() for path in out.glob("executor-*.log")]
    assert done.returncode == 0, (answer, logs, done.stderr)
    assert answer["counts"]["cases"] == answer["counts"]["pass"] == 1
    subprocess.run([HAIRPIN, "export", str(out), "--to", "csv"], check=True, capture_output=True)
    # Of what was flown only the rows are kept where it bends: an export has all samples again.
    flight = pv.read_csv(out / "0000-0.csv").to_pydict()
    times, legs = flight["t"], flight["leg"]
    assert len(times) > 200 and times[0] == 0 and all(b > a for a, b in zip(times, times[1:]))
    assert legs[0] == 0 and legs[-1] == 2 and all(b >= a for a, b in zip(legs, legs[1:]))
    assert abs(flight["x_m"][-1] - 9) + abs(flight["y_m"][-1] - 7) + abs(flight["z_m"][-1] - 6) < 1.0
    # A tracking controller in calm air neither stands still nor is perfect.
    assert 0.01 < answer["worst"]["max_deviation_m"] < 3
