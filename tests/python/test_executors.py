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
# The default search in its loop, small, beside missions by chance: a dozen executions are enough with any seed that was tried.
SEARCHED = ['generate.search={ method = "worst", waypoints = 60, cases = 1, executions = 12 }', "execute.baseline=3"]
# One mission: JAX compiles for seconds in each process, and an identified Crazyflie tracks its own reference within 3 cm but on hops.
FLOWN = ['generate.search={ method = "uniform", waypoints = 60, cases = 1 }', "execute.baseline=0"]


@pytest.mark.parametrize("name", FLY)
def test_the_default_search_stresses_another_simulator(name, tmp_path):
    command = f"{shlex.quote(sys.executable)} {shlex.quote(str(EXECUTORS / name))}"
    out, searched = tmp_path / "campaign", name != "drone_models_executor.py"
    sets = [f'robot="{FLY[name]}"', *(SEARCHED if searched else FLOWN), "execute.repeat=1", "task.length=3", "task.end_m=[7, 6, 5]",
            "execute.timeout_s=240", "spec.deviation.max_m=8"]
    arguments = [HAIRPIN, "stress", "demo-quadrotor", "--executor", command, "--out", str(out), "--seed", "3", "--threads", "1", "--json"]
    for one in sets:
        arguments += ["--set", one]
    done = subprocess.run(arguments, capture_output=True, text=True)
    assert done.stdout, done.stderr
    answer = json.loads(done.stdout)
    logs = [path.read_text() for path in out.glob("executor-*.log")]
    assert done.returncode == 0, (answer, logs, done.stderr)
    assert answer["counts"]["cases"] == answer["counts"]["pass"] == 1
    if searched:
        assert "; random feasible ones" in answer["verdict"] and answer["stress_percent"] > 0, answer
    subprocess.run([HAIRPIN, "export", str(out), "--to", "csv"], check=True, capture_output=True)
    # Of what was flown only the rows are kept where it bends: an export has all samples again.
    flight = pv.read_csv(out / "export" / "0000-0.csv").to_pydict()
    times, legs = flight["t"], flight["leg"]
    assert len(times) > 200 and times[0] == 0 and all(b > a for a, b in zip(times, times[1:]))
    assert legs[-1] == 1 and all(b >= a for a, b in zip(legs, legs[1:]))
    assert abs(flight["x_m"][-1] - 7) + abs(flight["y_m"][-1] - 6) + abs(flight["z_m"][-1] - 5) < 1.0
    # A tracking controller in calm air neither stands still nor is perfect.
    assert 0.01 < answer["worst"]["max_deviation_m"] < 8


# Overshoots where the path turns back, and waits there for ever to have passed the waypoint: a public bug of an autopilot.
STALLS = '''
import json, math, sys
say = lambda **message: print(json.dumps(message), flush=True)
minus = lambda a, b: [u - v for u, v in zip(a, b)]
for line in sys.stdin:
    message = json.loads(line)
    if message["type"] == "hello":
        say(type="ready", protocol=2, name="stalls", deterministic=True)
    elif message["type"] == "reset":
        of = {"case": message["case"], "run": message["run"]}
        say(type="ready", **of)
    elif message["type"] == "mission":
        points, rows, leg, stuck, t = message["waypoints_m"], [], 0, False, 0.0
        p = points[0]
        while t <= message["time_limit_s"] and leg < len(points) - 1:
            rows.append([t, *p, 1, 0, 0, 0, None, None, None, leg])
            goal, t = points[leg + 1], t + 0.05
            away = math.dist(p, goal)
            into, out = minus(goal, points[leg]), minus(points[min(leg + 2, len(points) - 1)], goal)
            if not stuck and away > 0.1:
                p = [a + 0.1 / away * (b - a) for a, b in zip(p, goal)]
            elif not stuck and sum(a * b for a, b in zip(into, out)) < 0.0:
                stuck, p = True, [a + 0.5 * b / math.hypot(*into) for a, b in zip(goal, into)]
            elif not stuck:
                leg += 1
        say(type="poses", poses=rows, **of)
        say(type="end", reason="time" if leg < len(points) - 1 else "done", **of)
    elif message["type"] == "bye":
        break
'''


def test_who_stops_short_of_a_waypoint_for_good_has_stalled_and_shrinks(tmp_path):
    program, out = tmp_path / "stalls.py", tmp_path / "campaign"
    program.write_text(STALLS)
    sets = ['generate.search={ method = "uniform", waypoints = 60, cases = 1 }', "execute.repeat=1", "task.length=6", "task.end_m=[9, 7, 6]",
            "spec.deviation.max_m=3", "execute.baseline=0"]
    arguments = [HAIRPIN, "stress", "demo-quadrotor", "--executor", shlex.join([sys.executable, str(program)]), "--out", str(out), "--json"]
    done = subprocess.run(arguments + [word for one in sets for word in ("--set", one)], capture_output=True, text=True)
    answer = json.loads(done.stdout)
    assert done.returncode == 1 and "of 6 waypoints" in answer["verdict"] and "stood still after" in answer["verdict"], answer
    done = subprocess.run([HAIRPIN, "shrink", str(out), "--case", "0000", "--budget", "30", "--json"], capture_output=True, text=True)
    shrunk = json.loads(done.stdout)
    # A turn back takes three waypoints; of those the second is overshot.
    assert done.returncode == 0, (shrunk, done.stderr)
    assert shrunk["what"] == "stalled" and 3 <= shrunk["waypoints"] < shrunk["waypoints_before"] == 6, shrunk
