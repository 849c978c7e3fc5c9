"""A spring to the next waypoint and a damper, on hairpin's plant: `execute.controller = "python:pd.py"`."""

STIFFNESS, DAMPING = 2.0, 2.5  # 1/s², 1/s
FASTEST = 4.0  # m/s: the spring pulls no harder than what this speed balances


def control(t_s, state, reference):
    waypoints = reference["waypoints_m"]
    target = waypoints[min(reference["next"], len(waypoints) - 1)]
    pull = [STIFFNESS * (goal - place) for goal, place in zip(target, state["p_m"])]
    size = sum(part * part for part in pull) ** 0.5
    scale = min(1.0, FASTEST * DAMPING / max(size, 1e-9))
    return {"a_m_s2": [scale * part - DAMPING * speed for part, speed in zip(pull, state["v_m_s"])]}
