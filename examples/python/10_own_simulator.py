"""A simulator of one's own in the search's loop, in place of hairpin's: the twin of 06_own_simulator.rs."""

import tempfile

import numpy as np

import hairpin


def springs(mission):
    """A mass that a spring pulls to the next waypoint."""
    waypoints = np.asarray(mission["waypoints_m"])
    dt, position, velocity, to = 0.01, waypoints[0].copy(), np.zeros(3), 1
    t_s, p_m, leg = [], [], []
    while to < len(waypoints) and len(t_s) * dt <= mission["time_limit_s"]:
        t_s.append(len(t_s) * dt)
        p_m.append(position.copy())
        leg.append(to - 1)
        pull = waypoints[to] - position
        pull *= min(1.0, 6.0 / max(np.linalg.norm(pull), 1e-9))
        velocity += (pull - 1.2 * velocity) * dt
        position += velocity * dt
        to += bool(np.linalg.norm(waypoints[to] - position) < mission["accept_m"])
    return {"t_s": t_s, "p_m": p_m, "leg": leg, "ended": "done" if to == len(waypoints) else "time"}


values = {
    "generate.search": {"method": "worst", "executions": 12, "cases": 2},
    "execute.repeat": 1,
    "execute.baseline": 4,
}
found = hairpin.stress("demo-quadrotor", executor=springs, out=tempfile.mkdtemp() + "/out", values=values)
print(found.verdict)
for case in found:
    print(f"case {case.id}: {case.max_deviation_m:.2f} m off its legs")
