"""The executor of the Crazyflie firmware's bindings, with a stand-in for them (stand_ins/cffirmware.py): the bindings have to be built by
the user, and are where the firmware is."""
import math
import os
import sys
import tomllib
from pathlib import Path

import numpy as np
import pytest
from talk import Talk

ROOT = Path(__file__).resolve().parents[2]
PROGRAM = ROOT / "examples" / "executors" / "crazyflie_firmware.py"
ROBOT = tomllib.loads(next((ROOT / "data" / "robots").glob("*/crazyflie.toml")).read_text())
POINTS, YAW, LEG_S = [[3.0, 3.0, 3.0], [5.0, 3.0, 3.5], [5.0, 6.0, 4.0]], 0.4, 4.0


def timed():
    """From waypoint to waypoint, each leg from rest to rest."""
    rows = []
    for leg, (a, b) in enumerate(zip(np.array(POINTS), np.array(POINTS)[1:])):
        for s in np.arange(0.0, 1.0, 0.01):
            share, speed = s**3 * (10 - 15 * s + 6 * s * s), 30 * s * s * (1 - s) ** 2 / LEG_S
            rows.append({"t_s": (leg + s) * LEG_S, "p_m": list(a + share * (b - a)), "v_m_s": list(speed * (b - a))})
    return rows + [{"t_s": (len(POINTS) - 1) * LEG_S, "p_m": POINTS[-1], "v_m_s": [0.0, 0.0, 0.0]}]


MISSION = {"robot": ROBOT, "world": {}, "waypoints_m": POINTS, "yaw_rad": [YAW] * 3, "limits": {}, "accept_m": 0.3,
           "accept": {"radius_m": 0.3, "height_m": 0.3}, "time_limit_s": 30.0, "timed": timed()}


def fly(*options, **changes):
    environment = dict(os.environ, PYTHONPATH=str(Path(__file__).with_name("stand_ins")))
    with Talk([sys.executable, str(PROGRAM), *options], environment) as talk:
        flown = talk.fly(**{**MISSION, **changes})
        assert talk.end() == 0
    return flown


@pytest.mark.parametrize("controller", ["mellinger", "pid"])
@pytest.mark.parametrize("mode, within", [("go_to", 0.3), ("positions", None), ("full_state", 0.1)])
def test_each_mode_flies_a_mission(mode, within, controller):
    answer, rows = fly("--mode", mode, "--controller", controller)
    assert answer["type"] == "end" and answer["reason"] == "done", answer
    t, p, q, leg = rows[:, 0], rows[:, 1:4], rows[:, 4:8], rows[:, 11]
    assert t[0] == 0.0 and (np.diff(t) > 0.0).all() and (np.diff(leg) >= 0).all() and leg[-1] == 1
    for point in POINTS:
        assert np.linalg.norm(p - point, axis=1).min() < 0.31
    w, x, y, z = q[-1]
    assert abs(math.atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z)) - YAW) < 0.05
    if within:
        reference = np.array([row["p_m"] for row in MISSION["timed"]])
        stamps = [row["t_s"] for row in MISSION["timed"]]
        planned = np.column_stack([np.interp(t, stamps, reference[:, axis]) for axis in range(3)])
        assert np.linalg.norm(p - planned, axis=1).max() < within


def test_what_it_cannot_fly_is_said():
    assert "needs a timed motion" in fly("--mode", "full_state", timed=[])[0]["message"]
    other = {**ROBOT, "rotors": [{**rotor, "spin": -rotor["spin"]} for rotor in ROBOT["rotors"]]}
    assert "crazyflie is no X of four rotors that turn as a Crazyflie's do" in fly("--mode", "positions", robot=other)[0]["message"]
    assert fly(waypoints_m=[])[0]["message"] == "a mission without waypoints"
