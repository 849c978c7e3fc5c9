"""The smallest useful executor: a point that flies from waypoint to waypoint at 2 m/s. Python's library is enough.

    hairpin stress quadrotor.toml --executor 'python3 examples/executors/minimal_executor.py'
"""
import json
import math
import os
import sys


def say(**message):
    try:
        print(json.dumps(message), flush=True)
    except BrokenPipeError:  # nobody listens any more: what is left to say goes nowhere
        os.dup2(os.open(os.devnull, os.O_WRONLY), 1)
        sys.exit()


def fly(mission, speed=2.0, step=0.02):
    points, t, i = mission["waypoints_m"], 0.0, 0
    for leg, (a, b) in enumerate(zip(points, points[1:])):
        samples = max(1, math.ceil(math.dist(a, b) / speed / step))
        velocity = [(v - u) / (samples * step) for u, v in zip(a, b)]
        for k in range(samples):
            if t > mission["time_limit_s"]:
                return say(type="end", reason="time")
            position = [u + v * k * step for u, v in zip(a, velocity)]
            say(type="pose", t_s=t, p_m=position, q_wxyz=[1, 0, 0, 0], v_m_s=velocity, leg=leg)
            i += 1
            t = i * step
    say(type="pose", t_s=t, p_m=points[-1], q_wxyz=[1, 0, 0, 0], v_m_s=[0, 0, 0], leg=len(points) - 2)
    say(type="end", reason="done")


for line in sys.stdin:
    message = json.loads(line)
    if message["type"] == "hello":
        say(type="ready", protocol=1, name="minimal executor")
    elif message["type"] == "mission":
        fly(message)
    elif message["type"] == "bye":
        break
