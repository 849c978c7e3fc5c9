"""Flies hairpin's missions by a learned policy: `foundation-policy` (PyPI), in MuJoCo.

    hairpin stress quadrotor.toml --executor 'python3 examples/executors/foundation_policy_executor.py'

One network for all quadrotors, which adapts to the body as it flies (Eschmann, Albani and Loianno 2025). It was trained to
hold a point; here the point is the next waypoint, no farther ahead than half a metre. The plant is that of mujoco_executor.py.
"""
from importlib.metadata import version

import numpy as np
from foundation_policy import Raptor
from mujoco_executor import STEP_S, serve

PERIOD_S, AHEAD_M = 0.01, 0.5


class Learned:
    def __init__(self, robot):
        rotors = robot["rotors"]
        # The network's order: front right, back right, back left, front left; y is to the left.
        corners = [(1, -1), (-1, -1), (-1, 1), (1, 1)]
        self.order = [max(range(4), key=lambda i: rotors[i]["x_m"] * x + rotors[i]["y_m"] * y) for x, y in corners]
        self.slowest, self.fastest = robot["rotor_speed_rad_s"]
        self.coefficient = robot["thrust_coefficient_n_s2"]
        self.policy, self.turns, self.action = Raptor(), 0, np.zeros(4)
        self.policy.reset()

    def rotors(self, position, velocity, body, rates, target):
        if self.turns % round(PERIOD_S / STEP_S) == 0:
            error = position - target
            error *= min(1.0, AHEAD_M / max(np.linalg.norm(error), 1e-9))
            seen = np.array([[*error, *body.flatten(), *velocity, *rates, *self.action]], dtype=np.float32)
            self.action = np.clip(self.policy.evaluate_step(seen)[0], -1.0, 1.0)
        self.turns += 1
        speeds = self.slowest + 0.5 * (self.action + 1.0) * (self.fastest - self.slowest)
        thrusts = np.empty(4)
        thrusts[self.order] = self.coefficient * speeds**2
        return thrusts


if __name__ == "__main__":
    serve("foundation-policy", version("foundation-policy"), Learned)
