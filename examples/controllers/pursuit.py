"""Pursuit of the planned motion on the ground: `execute.controller = "python:pursuit.py"`."""
import math

AHEAD = 0.6  # m: steered to this far beyond where the plan is now
CATCH_UP = 0.5  # 1/s


def control(t_s, state, reference):
    (x, y, _), (plan_x, plan_y, _), yaw = state["p_m"], reference["p_m"], reference["yaw_rad"]
    planned = reference["v_m_s"][0] * math.cos(yaw) + reference["v_m_s"][1] * math.sin(yaw)
    behind = (plan_x - x) * math.cos(yaw) + (plan_y - y) * math.sin(yaw)
    speed = planned + CATCH_UP * behind
    reach = math.copysign(AHEAD, speed)
    east, north = plan_x + reach * math.cos(yaw) - x, plan_y + reach * math.sin(yaw) - y
    left = math.cos(state["yaw_rad"]) * north - math.sin(state["yaw_rad"]) * east
    return {"v_m_s": speed, "curvature_1_m": 2.0 * left / max(east**2 + north**2, 0.1)}
