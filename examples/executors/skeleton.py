"""An executor to begin with: replace `Simulator`, keep the rest. Protocol 2, Python's library alone.

    hairpin check-executor 'python3 examples/executors/skeleton.py'
    hairpin stress quadrotor.toml --executor 'python3 examples/executors/skeleton.py'
"""
import json
import math
import os
import sys


# ---- yours: a point with drag that chases the next waypoint -------------------------------------------------------
class Simulator:
    NAME, VERSION, DETERMINISTIC, STEP_S = "python skeleton", "1", True, 0.02
    TIMED = False  # whether it follows mission["timed"], which is left out otherwise

    def __init__(self, mission):
        """At rest at the first waypoint. Draw all noise from mission["seed"], and it is deterministic."""
        self.points, self.accept = mission["waypoints_m"], mission["accept"]
        self.p, self.v, self.leg = list(self.points[0]), [0.0, 0.0, 0.0], 0
        self.top_speed = min(mission["limits"].get("max_speed_m_s", 8.0), 8.0)

    def step(self):
        """Controller and dynamics, one step on. Gives why the flight is over, or None."""
        away = [g - p for g, p in zip(self.points[self.leg + 1], self.p)]
        if math.hypot(away[0], away[1]) <= self.accept["radius_m"] and abs(away[2]) <= self.accept["height_m"]:
            if self.leg == len(self.points) - 2:
                return "done"
            self.leg += 1
        pull = min(1.2, self.top_speed / max(math.hypot(*away), 1e-9))
        for i in range(3):
            self.v[i] += self.STEP_S * 2.0 * (pull * away[i] - self.v[i])
            self.p[i] += self.STEP_S * self.v[i]

    def pose(self):
        """x, y, z (m, world frame, z up), attitude (w first), velocity (m/s), the leg being flown."""
        return [*self.p, 1, 0, 0, 0, *self.v, self.leg]
# ---- the protocol: nothing to change below ------------------------------------------------------------------------


BATCH = 1000  # poses of a line; a line may have 1 MB
# What libraries print to stdout goes to stderr, the protocol alone to stdout.
protocol = os.fdopen(os.dup(1), "w")
os.dup2(2, 1)


def say(**message):
    try:
        print(json.dumps(message, allow_nan=False), file=protocol, flush=True)
    except BrokenPipeError:  # nobody listens any more: what is left to say goes nowhere
        os.dup2(os.open(os.devnull, os.O_WRONLY), protocol.fileno())
        sys.exit()


def fly(mission, of):
    if not mission["waypoints_m"]:
        return say(type="error", message="a mission without waypoints", **of)
    simulator, steps, reason = Simulator(mission), 0, None
    rows = [[0.0, *simulator.pose()]]
    while reason is None:
        steps += 1
        t = steps * Simulator.STEP_S
        reason = "time" if t > mission["time_limit_s"] else simulator.step()
        rows.append([t, *simulator.pose()])
        if len(rows) >= BATCH or reason:
            say(type="poses", poses=rows, **of)
            rows = []
    say(type="end", reason=reason, **of)


def main():
    of = {}
    for line in sys.stdin:
        message = json.loads(line)
        if message["type"] == "hello":
            say(type="ready", protocol=2, name=Simulator.NAME, version=Simulator.VERSION, deterministic=Simulator.DETERMINISTIC,
                timed=Simulator.TIMED)
        elif message["type"] == "reset":
            of = {"case": message["case"], "run": message["run"]}
            say(type="ready", **of)
        elif message["type"] == "mission":
            fly(message, of)
        elif message["type"] == "bye":
            break


if __name__ == "__main__":
    main()
