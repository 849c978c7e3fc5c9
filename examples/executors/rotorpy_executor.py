"""Flies hairpin's missions in rotorpy (PyPI, version 3), with rotorpy's own SE(3) controller.

    hairpin stress quadrotor.toml --executor 'python3 examples/executors/rotorpy_executor.py'

The mission's timed reference is tracked where it has one (witness trajectories); otherwise the waypoints are flown to one
after the other, each through a smooth motion from rest to rest. Poses are sent at 100 Hz.

What rotorpy cannot express is left out, and said once on stderr: aerodynamic moments, noise densities, gusts, obstacles.
"""
import bisect
import json
import math
import os
import sys

import numpy as np
from rotorpy.controllers.quadrotor_control import SE3Control
from rotorpy.vehicles.multirotor import Multirotor

STEP_S = 0.01
CRUISE_M_S = 2.0
LINGER_S = 2.0  # flown on at the last waypoint: a run is judged there too


def log(text):
    print(text, file=sys.stderr, flush=True)


def say(**message):
    try:
        print(json.dumps(message, allow_nan=False), flush=True)
    except BrokenPipeError:  # nobody listens any more: what is left to say goes nowhere
        os.dup2(os.open(os.devnull, os.O_WRONLY), 1)
        sys.exit()


def quad_params(robot):
    """rotorpy's parameters from the mission's robot.

    Both take x forward, y left, z up and thrust kf w^2. hairpin's spin +1 (clockwise from above) has its reaction moment
    along +z, as rotorpy's rotor direction +1 has. Quadratic drag is isotropic in hairpin; linear drag has no counterpart
    (rotorpy's rotor drag grows with rotor speed) and is given at hover speed, spread over the four rotors.
    """
    kf = robot["thrust_coefficient_n_s2"]
    hover = math.sqrt(robot["mass_kg"] * robot.get("gravity_m_s2", 9.81) / (4 * kf))
    linear = robot.get("drag_linear_n_s_m", 0.0) / (4 * hover)
    quadratic = robot.get("drag_quadratic_n_s2_m2", 0.0)
    inertia = robot["inertia_kg_m2"]
    return {
        "mass": robot["mass_kg"],
        "Ixx": inertia[0], "Iyy": inertia[1], "Izz": inertia[2], "Ixy": 0.0, "Ixz": 0.0, "Iyz": 0.0,
        "num_rotors": len(robot["rotors"]),
        "rotor_pos": {f"r{i}": np.array([r["x_m"], r["y_m"], 0.0]) for i, r in enumerate(robot["rotors"])},
        "rotor_directions": np.array([float(r["spin"]) for r in robot["rotors"]]),
        "rI": np.zeros(3),
        "c_Dx": quadratic, "c_Dy": quadratic, "c_Dz": quadratic,
        "k_eta": kf, "k_m": robot["moment_coefficient_n_m_s2"],
        "k_d": linear, "k_z": linear, "k_h": 0.0, "k_flap": 0.0,
        # rotorpy has no rotor without lag; a shorter one only makes its equations stiff.
        "tau_m": max(robot.get("rotor_time_constant_s", 0.0), 1e-3),
        "rotor_speed_min": robot["rotor_speed_rad_s"][0], "rotor_speed_max": robot["rotor_speed_rad_s"][1],
        "motor_noise_std": 0.0,
    }


class Timed:
    """The mission's timed reference: linear between samples, at rest before and after."""

    def __init__(self, mission):
        timed = mission["timed"]
        self.t = [s["t_s"] for s in timed]
        self.p = np.array([s["p_m"] for s in timed])
        self.v = np.array([s["v_m_s"] for s in timed])
        self.a = np.gradient(self.v, self.t, axis=0)
        self.end = self.t[-1]
        # The leg changes where the reference passes the waypoint between.
        self.changes, first = [], 0
        for waypoint in mission["waypoints_m"][1:-1]:
            first += int(np.argmin(np.linalg.norm(self.p[first:] - waypoint, axis=1)))
            self.changes.append(self.t[first])

    def at(self, t):
        if t >= self.end:
            return self.p[-1], np.zeros(3), np.zeros(3)
        i = max(bisect.bisect_right(self.t, t) - 1, 0)
        u = (t - self.t[i]) / (self.t[i + 1] - self.t[i])
        return tuple((1 - u) * c[i] + u * c[i + 1] for c in (self.p, self.v, self.a))

    def leg(self, t):
        return bisect.bisect_right(self.changes, t)


class Hops:
    """From waypoint to waypoint, each leg a fifth-order motion from rest to rest."""

    def __init__(self, mission):
        self.points = np.array(mission["waypoints_m"])
        lengths = np.linalg.norm(np.diff(self.points, axis=0), axis=1)
        self.times = np.maximum(lengths / CRUISE_M_S * 1.875, 0.5)  # 1.875: peak over mean speed of the motion
        self.starts = np.concatenate([[0.0], np.cumsum(self.times)])
        self.end = float(self.starts[-1])

    def leg(self, t):
        return int(np.clip(np.searchsorted(self.starts, t, side="right") - 1, 0, len(self.times) - 1))

    def at(self, t):
        leg = self.leg(t)
        duration, span = self.times[leg], self.points[leg + 1] - self.points[leg]
        s = min((t - self.starts[leg]) / duration, 1.0)
        position = self.points[leg] + span * s**3 * (10 - 15 * s + 6 * s**2)
        velocity = span / duration * 30 * s**2 * (1 - s) ** 2
        acceleration = span / duration**2 * 60 * s * (1 - s) * (1 - 2 * s)
        return position, velocity, acceleration


def fly(mission):
    params = quad_params(mission["robot"])
    wind = np.array(mission["world"].get("wind_m_s") or [0.0, 0.0, 0.0])
    reference = Timed(mission) if len(mission["timed"]) > 1 else Hops(mission)
    hover = math.sqrt(params["mass"] * 9.81 / (params["num_rotors"] * params["k_eta"]))
    state = {
        "x": np.array(mission["waypoints_m"][0], dtype=float), "v": np.zeros(3), "q": np.array([0.0, 0.0, 0.0, 1.0]),
        "w": np.zeros(3), "wind": wind, "rotor_speeds": np.full(params["num_rotors"], hover),
    }
    vehicle = Multirotor(params, initial_state=state, control_abstraction="cmd_motor_speeds", aero=True,
                         integrator_kwargs={"method": "RK45", "rtol": 1e-4, "atol": 1e-7})
    controller = SE3Control(params)
    end, still, reached = np.array(mission["waypoints_m"][-1]), np.zeros(3), None
    step = 0
    while True:
        t = step * STEP_S
        x, y, z, w = state["q"]
        say(type="pose", t_s=t, p_m=state["x"].tolist(), q_wxyz=[w, x, y, z], v_m_s=state["v"].tolist(),
            leg=reference.leg(t))
        near = np.linalg.norm(state["x"] - end) <= mission["accept_m"]
        if reached is None and t >= reference.end and near:
            reached = t
        if reached is not None and t >= reached + LINGER_S:
            return say(type="end", reason="done")
        if state["x"][2] < 0.0:
            return say(type="end", reason="crash")
        if t + STEP_S > mission["time_limit_s"]:
            return say(type="end", reason="time")
        p, v, a = reference.at(t)
        flat = {"x": p, "x_dot": v, "x_ddot": a, "x_dddot": still, "x_ddddot": still, "yaw": 0.0, "yaw_dot": 0.0}
        state = vehicle.step(state, controller.update(t, state, flat), STEP_S)
        state["wind"] = wind
        step += 1


def main():
    log("rotorpy executor: aerodynamic moments, noise, gusts and obstacles are not simulated")
    for line in sys.stdin:
        message = json.loads(line)
        if message["type"] == "hello":
            say(type="ready", protocol=1, name="rotorpy")
        elif message["type"] == "mission":
            fly(message)
        elif message["type"] == "bye":
            break


if __name__ == "__main__":
    main()
