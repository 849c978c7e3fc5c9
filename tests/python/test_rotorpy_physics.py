"""The same rotor speeds through rotorpy's equations and through ours: two programs that share no line must agree."""
import csv
import math
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from rotorpy.vehicles.multirotor import Multirotor

ROOT = Path(__file__).resolve().parents[2]
HAIRPIN = os.environ.get("HAIRPIN_BIN", str(ROOT / "target" / "debug" / "hairpin"))
sys.path.insert(0, str(ROOT / "examples" / "executors"))
from rotorpy_executor import quad_params  # noqa: E402

STEP_S, DURATION_S, AGREE_M = 0.01, 2.0, 0.01
NAMES = [f"rotor{i}_rad_s" for i in range(1, 5)]

# data/robots/quadrotor/*.toml, typed again: a slip in reading them must show.
ROBOTS = {
    "flightgoggles": dict(
        mass_kg=1.0, inertia_kg_m2=[0.0049, 0.0049, 0.0069], thrust_coefficient_n_s2=1.91e-6,
        moment_coefficient_n_m_s2=2.6e-7, rotor_speed_rad_s=[0, 2200]),
    "crazyflie": dict(
        mass_kg=0.03, inertia_kg_m2=[1.43e-5, 1.43e-5, 2.89e-5], thrust_coefficient_n_s2=2.3e-8,
        moment_coefficient_n_m_s2=7.8e-10, rotor_speed_rad_s=[0, 2500]),
}


def rotors_of(name):
    import tomllib

    with open(ROOT / "data" / "robots" / "quadrotor" / f"{name}.toml", "rb") as file:
        return tomllib.load(file)["rotors"]


def profile(robot, seed):
    """Around hover, each rotor swaying on its own: thrust, roll, pitch and yaw all move, up to a steep tilt."""
    random = np.random.default_rng(seed)
    hover = math.sqrt(robot["mass_kg"] * 9.81 / (4 * robot["thrust_coefficient_n_s2"]))
    times = np.arange(0.0, DURATION_S + STEP_S / 2, STEP_S)
    phase, rate = random.uniform(0, 2 * np.pi, 4), random.uniform(0.5, 2.0, 4)
    sway = 0.01 * np.sin(2 * np.pi * rate[None, :] * times[:, None] + phase[None, :])
    return times, hover * (1.02 + sway)


def by_hairpin(folder, name, times, speeds):
    given, found = folder / "profile.csv", folder / "track.csv"
    with open(given, "w", newline="") as file:
        writer = csv.writer(file)
        writer.writerow(["t_s", *NAMES])
        writer.writerows([[repr(float(v)) for v in (t, *w)] for t, w in zip(times, speeds)])
    off = ["drag_linear_n_s_m", "drag_quadratic_n_s2_m2", "aerodynamic_moment_n_m_s2", "rotor_time_constant_s"]
    command = [HAIRPIN, "simulate", name, "--rotor-speeds", str(given), "--out", str(found)]
    for key in off:
        command += ["--set", f"robot.{key}=0.0"]
    subprocess.run(command, check=True, capture_output=True, text=True)
    with open(found, newline="") as file:
        return [{key: float(value) for key, value in row.items()} for row in csv.DictReader(file)]


def by_rotorpy(robot, times, speeds):
    params = quad_params(robot)
    # Without lag rotor speeds are what is asked for; the state's own speeds are set before each step.
    params["tau_m"] = 1e9
    state = {"x": np.zeros(3), "v": np.zeros(3), "q": np.array([0, 0, 0, 1.0]), "w": np.zeros(3), "wind": np.zeros(3),
             "rotor_speeds": speeds[0].copy()}
    vehicle = Multirotor(params, initial_state=state, control_abstraction="cmd_motor_speeds", aero=False,
                         integrator_kwargs={"method": "RK45", "rtol": 1e-9, "atol": 1e-11})
    states = [state]
    for row in speeds[:-1]:
        state = dict(state, rotor_speeds=row.copy())
        state = vehicle.step(state, {"cmd_motor_speeds": row}, STEP_S)
        states.append(state)
    return states


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("name", ROBOTS)
def test_same_rotor_speeds_same_flight(tmp_path, name, seed):
    robot = dict(ROBOTS[name], rotors=rotors_of(name))
    times, speeds = profile(robot, seed)
    ours, theirs = by_hairpin(tmp_path, name, times, speeds), by_rotorpy(robot, times, speeds)
    assert len(ours) == len(theirs) == len(times)
    distance = [np.linalg.norm([row["x_m"], row["y_m"], row["z_m"]] - state["x"]) for row, state in zip(ours, theirs)]
    flown = np.linalg.norm(theirs[-1]["x"])
    assert flown > 0.1, "the profile must go somewhere, or agreement says nothing"
    assert max(distance) < AGREE_M, f"seed {seed}: {max(distance):.4f} m apart after {flown:.2f} m"
    x, y, z, w = theirs[-1]["q"]
    turned = 2 * math.acos(min(1.0, abs(np.dot([w, x, y, z], [ours[-1][k] for k in ("qw", "qx", "qy", "qz")]))))
    assert turned < math.radians(0.5)
    assert abs(w) < 0.9999, "it must turn, too"
