"""A robot that hairpin knows nothing of, as its differential equation: executed only, on missions of a quadrotor's cage."""

import tempfile

import numpy as np

import hairpin

DRAG = 0.4  # 1/s


def blimp(t, x, u):
    """Position and velocity; the control is an acceleration."""
    return np.concatenate([x[3:], u - DRAG * x[3:]])


def control(t, x, to):
    return np.clip(1.5 * (to["target_m"] - x[:3]) - 2.0 * x[3:], -2.0, 2.0)


executor = hairpin.dynamics(
    blimp,
    control,
    start=lambda mission: [*mission["waypoints_m"][0], 0.0, 0.0, 0.0],
    pose=lambda x: {"p_m": x[:3], "v_m_s": x[3:], "q_wxyz": [1.0, 0.0, 0.0, 0.0]},
    step_s=0.05,
)
values = {"generate.reach": "none", "generate.search.method": "uniform", "generate.search.cases": 3, "execute.baseline": 0}
found = hairpin.stress("demo-quadrotor", executor=executor, out=tempfile.mkdtemp() + "/out", values=values)
print(found.verdict)
print(found.worst.evidence, f"{found.worst.max_deviation_m:.2f} m")
