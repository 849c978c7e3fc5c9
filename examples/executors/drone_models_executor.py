"""Flies hairpin's missions as an identified Crazyflie: `drone-models` with the Mellinger controller of `drone-controllers` (PyPI).

    hairpin stress quadrotor.toml --set 'robot="crazyflie"' --executor 'python3 examples/executors/drone_models_executor.py'

The body is the package's own cf2x_L250 whatever robot the mission names, so that the mission's timed reference, which another
body can fly, is not tracked: waypoints are flown to one after the other, from rest to rest at 0.8 m/s in the mean. Wind, noise
and obstacles are not simulated, and said so once on stderr.
"""
import json
import math
import os
import sys

answers = os.fdopen(os.dup(1), "w")
os.dup2(2, 1)  # what libraries print is not for hairpin
os.environ["SCIPY_ARRAY_API"] = "1"  # rotations of JAX's arrays

import jax
import jax.numpy as jnp
import numpy as np
from drone_controllers import mellinger_attitude2force_torque, mellinger_state2attitude
from drone_controllers import parametrize as controller
from drone_controllers.mellinger.control import force_torque2rotor_vel
from drone_models import available_models
from drone_models import parametrize as plant
from scipy.spatial.transform import Rotation

jax.config.update("jax_enable_x64", True)
# Body and attitude are stepped at 500 Hz, positions are controlled and written at 100 Hz.
DRONE, STEP_S, OUTER, LINGER_S, MEAN_M_S, CHUNK = "cf2x_L250", 0.002, 5, 2.0, 0.8, 100
TURN_S = OUTER * STEP_S
dynamics = plant(available_models["first_principles"], DRONE, xp=jnp)
position_loop = controller(mellinger_state2attitude, DRONE)
attitude_loop = controller(mellinger_attitude2force_torque, DRONE)
mixer = controller(force_torque2rotor_vel, DRONE)


def say(**message):
    try:
        print(json.dumps(message, allow_nan=False), file=answers, flush=True)
    except BrokenPipeError:  # nobody listens any more: what is left to say goes nowhere
        os.dup2(os.open(os.devnull, os.O_WRONLY), answers.fileno())
        sys.exit()


class Reference:
    """Position, velocity and acceleration over time, and the leg: from waypoint to waypoint, from rest to rest."""

    def __init__(self, points):
        self.points, self.spans = points, np.diff(points, axis=0)
        self.durations = np.maximum(np.linalg.norm(self.spans, axis=1) / MEAN_M_S, 0.5)
        self.begins = np.array([0.0, *np.cumsum(self.durations)])

    def legs(self, t):
        return np.minimum(np.searchsorted(self.begins, t, side="right"), len(self.spans)) - 1

    def at(self, t):
        """A row of 13 for each time: what the position loop is asked for, yaw and rates 0."""
        leg = self.legs(t)
        span, duration = self.spans[leg], self.durations[leg, None]
        s = np.minimum((t - self.begins[leg])[:, None] / duration, 1.0)
        position = self.points[leg] + span * s**3 * (10 - 15 * s + 6 * s**2)
        velocity = span / duration * 30 * s**2 * (1 - s) ** 2
        acceleration = span / duration**2 * 60 * s * (1 - s) * (1 - 2 * s)
        return np.concatenate([position, velocity, acceleration, np.zeros((len(t), 4))], axis=1)


def turn(state, wanted):
    """One turn of the position loop and the steps up to the next; what is written is the state before it."""
    pos, quat, vel, rates, rotors, before, error, turn_error = state
    row = jnp.concatenate([pos, quat[3:], quat[:3], vel])
    attitude, error = position_loop(pos, quat, vel, rates, wanted, (error,), ctrl_freq=1 / TURN_S)
    for _ in range(OUTER):
        force, torque, turn_error = attitude_loop(pos, quat, vel, rates, attitude, prev_ang_vel=before, ctrl_errors=(turn_error,),
                                                  ctrl_freq=1 / STEP_S)
        before = rates
        moved, _, *changes = dynamics(pos, quat, vel, rates, mixer(force, torque), rotors)
        # The package's own derivative of the quaternion is not to be integrated, as its docs say.
        quat = (Rotation.from_quat(quat) * Rotation.from_rotvec(STEP_S * rates)).as_quat()
        pos = pos + STEP_S * moved
        vel, rates, rotors = (value + STEP_S * rate for value, rate in zip((vel, rates, rotors), changes))
    return (pos, quat, vel, rates, rotors, before, error, turn_error), row


turns = jax.jit(lambda state, wanted: jax.lax.scan(turn, state, wanted))


def hover(start):
    still = jnp.zeros(3)
    rotors = mixer(jnp.atleast_1d(dynamics.keywords["mass"] * 9.81), still)
    return jnp.array(start), jnp.array([0.0, 0.0, 0.0, 1.0]), still, still, rotors, still, still, still


def fly(mission):
    points = np.array(mission["waypoints_m"], dtype=float)
    reference, name = Reference(points), {"case": mission["case"], "run": mission["run"]}
    state, reached, reason, first = hover(points[0]), None, None, 0
    while reason is None:
        times = TURN_S * np.arange(first, first + CHUNK)
        state, rows = turns(state, reference.at(times))
        poses = []
        for t, row, leg in zip(times.tolist(), np.asarray(rows).tolist(), reference.legs(times).tolist()):
            poses.append([t, *row, leg])
            if reached is None and t >= reference.begins[-1] and math.dist(points[-1], row[:3]) <= mission["accept_m"]:
                reached = t
            reason = "done" if reached is not None and t >= reached + LINGER_S else None
            reason = reason or ("crash" if row[2] < 0.0 else "time" if t + TURN_S > mission["time_limit_s"] else None)
            if reason:
                break
        say(type="poses", poses=poses, **name)
        first += CHUNK
    say(type="end", reason=reason, **name)


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
