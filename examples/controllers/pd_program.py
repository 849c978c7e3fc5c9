"""The same as a program, in any language: `execute.controller = "command: python3 pd_program.py"`."""
import json
import signal
import sys

signal.signal(signal.SIGPIPE, signal.SIG_DFL)  # once nobody listens any more it ends without a word

STIFFNESS, DAMPING = 2.0, 2.5  # 1/s², 1/s
FASTEST = 4.0  # m/s

for line in sys.stdin:
    asked = json.loads(line)
    if asked["type"] != "control":  # "reset", before each run, with the mission
        continue
    state, reference = asked["state"], asked["reference"]
    waypoints = reference["waypoints_m"]
    target = waypoints[min(reference["next"], len(waypoints) - 1)]
    pull = [STIFFNESS * (goal - place) for goal, place in zip(target, state["p_m"])]
    size = sum(part * part for part in pull) ** 0.5
    scale = min(1.0, FASTEST * DAMPING / max(size, 1e-9))
    command = [scale * part - DAMPING * speed for part, speed in zip(pull, state["v_m_s"])]
    print(json.dumps({"a_m_s2": command}), flush=True)
