"""Pure pursuit of the planned motion on the ground: `execute.controller = "python:pursuit.py"`."""
import math

AHEAD = 0.6  # m


def control(t_s, state, reference):
    x, y, _ = state["p_m"]
    speed = math.hypot(*reference["v_m_s"][:2])
    # A point ahead of where the plan is now, seen from the body.
    goal = [place + AHEAD * rate / max(speed, 1e-6) for place, rate in zip(reference["p_m"], reference["v_m_s"])]
    east, north = goal[0] - x, goal[1] - y
    cos, sin = math.cos(state["yaw_rad"]), math.sin(state["yaw_rad"])
    left, distance = cos * north - sin * east, math.hypot(east, north)
    return {"v_m_s": speed, "curvature_1_m": 2.0 * left / max(distance, 0.1) ** 2}
