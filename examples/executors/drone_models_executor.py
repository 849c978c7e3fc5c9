"""Flies hairpin's missions as an identified Crazyflie: `drone-models` with the Mellinger controller of `drone-controllers` (PyPI).

    hairpin stress quadrotor.toml --set 'robot="crazyflie"' --executor 'python3 examples/executors/drone_models_executor.py'

The body is the package's own cf2x_L250 whatever robot the mission names, so that the mission's timed reference, which another
body can fly, is not tracked: waypoints are flown to one after the other, from rest to rest at 0.8 m/s in the mean. Wind, noise
and obstacles are not simulated, and said so once on stderr.
"""
import bisect
import json
import os
import sys

answers = os.fdopen(os.dup(1), "w")
os.dup2(2, 1)  # what libraries print is not for hairpin

import numpy as np
from drone_controllers import mellinger_attitude2force_torque, mellinger_state2attitude
from drone_controllers import parametrize as controller
from drone_controllers.mellinger.control import force_torque2rotor_vel
from drone_models import available_models
from drone_models import parametrize as plant
from scipy.spatial.transform import Rotation

DRONE, STEP_S, OUTER, SAMPLE, LINGER_S, MEAN_M_S = "cf2x_L250", 0.002, 5, 5, 2.0, 0.8
dynamics = plant(available_models["first_principles"], DRONE)
position_loop = controller(mellinger_state2attitude, DRONE)
attitude_loop = controller(mellinger_attitude2force_torque, DRONE)
mixer = controller(force_torque2rotor_vel, DRONE)


def say(**message):
    print(json.dumps(message, allow_nan=False), file=answers, flush=True)


class Reference:
    """Position, velocity and acceleration over time, and the leg: from waypoint to waypoint, from rest to rest."""

    def __init__(self, points):
        self.points, self.spans = points, np.diff(points, axis=0)
        self.durations = np.maximum(np.linalg.norm(self.spans, axis=1) / MEAN_M_S, 0.5)
        self.begins = [0.0, *np.cumsum(self.durations)]

    def leg(self, t):
        return min(bisect.bisect_right(self.begins, t), len(self.spans)) - 1

    def at(self, t):
        leg = self.leg(t)
        span, duration = self.spans[leg], self.durations[leg]
        s = min((t - self.begins[leg]) / duration, 1.0)
        position = self.points[leg] + span * s**3 * (10 - 15 * s + 6 * s**2)
        velocity = span / duration * 30 * s**2 * (1 - s) ** 2
        acceleration = span / duration**2 * 60 * s * (1 - s) * (1 - 2 * s)
        return np.concatenate([position, velocity, acceleration])


def fly(mission):
    points = np.array(mission["waypoints_m"], dtype=float)
    reference = Reference(points)
    name = {"case": mission["case"], "run": mission["run"]}
    pos, vel, rates, quat = points[0].copy(), np.zeros(3), np.zeros(3), np.array([0.0, 0.0, 0.0, 1.0])
    mass, gravity = dynamics.keywords["mass"], 9.81
    thrust = mass * gravity
    rotors = mixer(np.array([thrust]), np.zeros(3))
    before, errors, turn_errors, attitude, steps, reached, poses = rates, None, None, np.array([0.0, 0.0, 0.0, thrust]), 0, None, []
    while True:
        t = steps * STEP_S
        if reached is None and t >= reference.begins[-1] and np.linalg.norm(points[-1] - pos) <= mission["accept_m"]:
            reached = t
        if steps % SAMPLE == 0:
            x, y, z, w = quat
            poses.append([t, *pos, w, x, y, z, *vel, reference.leg(t)])
        over = "done" if reached is not None and t >= reached + LINGER_S else None
        over = over or ("crash" if pos[2] < 0.0 else "time" if t + STEP_S > mission["time_limit_s"] else None)
        if over or len(poses) == 1000:
            say(type="poses", poses=poses, **name)
            poses = []
        if over:
            return say(type="end", reason=over, **name)
        if steps % OUTER == 0:
            wanted = np.concatenate([reference.at(t), np.zeros(4)])
            attitude, error = position_loop(pos, quat, vel, rates, wanted, errors, ctrl_freq=1 / (OUTER * STEP_S))
            errors = (error,)
        force, torque, error = attitude_loop(pos, quat, vel, rates, attitude, prev_ang_vel=before, ctrl_errors=turn_errors,
                                             ctrl_freq=1 / STEP_S)
        turn_errors, before = (error,), rates
        moved, _, *changes = dynamics(pos, quat, vel, rates, mixer(force, torque), rotors)
        # The package's own derivative of the quaternion is not to be integrated, as its docs say.
        quat = (Rotation.from_quat(quat) * Rotation.from_rotvec(STEP_S * rates)).as_quat()
        pos = pos + STEP_S * moved
        vel, rates, rotors = (value + STEP_S * rate for value, rate in zip((vel, rates, rotors), changes))
        steps += 1


def main():
    print(f"drone-models executor: flies {DRONE}; wind, noise and obstacles are not simulated", file=sys.stderr, flush=True)
    for line in sys.stdin:
        message = json.loads(line)
        if message["type"] == "hello":
            say(type="ready", protocol=2, name=f"drone-models {DRONE}, Mellinger", timed=False)
        elif message["type"] == "reset":
            say(type="ready", case=message["case"], run=message["run"])
        elif message["type"] == "mission":
            fly(message)
        elif message["type"] == "bye":
            break


if __name__ == "__main__":
    main()
