"""A learned policy against a classical controller on the same missions, compared: what stresses them are the missions.

The policy here is a small one of NumPy, fitted below to imitate a controller with half of its gains on noisy samples. A published
one for quadrotors (foundation-policy, PyPI) flies by examples/executors/foundation_policy_executor.py, which `executor=` takes.
"""

import tempfile

import numpy as np

import hairpin

STEP_S = 0.05


def env_step(state, action):
    """A point mass with drag: place and velocity, three accelerations."""
    place, velocity = state
    velocity = velocity + STEP_S * (np.clip(action, -6.0, 6.0) - 0.2 * velocity)
    return place + STEP_S * velocity, velocity


def seen(state, to):
    gap = to["target_m"] - state[0]
    gap = gap * min(1.0, 3.0 / max(float(np.linalg.norm(gap)), 1e-9))
    return np.concatenate([gap, state[1]])


def classical(state, to):
    gap, velocity = np.split(seen(state, to), 2)
    return 2.0 * gap - 2.2 * velocity


def learned():
    """One hidden layer of random features, its last one fitted by least squares."""
    random = np.random.default_rng(3)
    inside, bias = random.normal(0.0, 0.5, (6, 64)), random.normal(0.0, 1.0, 64)
    samples = random.uniform(-3.0, 3.0, (2000, 6))
    wanted = 1.2 * samples[:, :3] - 1.6 * samples[:, 3:] + random.normal(0.0, 0.3, (2000, 3))
    outside, *_ = np.linalg.lstsq(np.tanh(samples @ inside + bias), wanted, rcond=None)
    return lambda state, to: np.tanh(seen(state, to) @ inside + bias) @ outside


def executor(policy):
    return hairpin.adversary(
        env_step,
        reset=lambda mission: (np.asarray(mission["waypoints_m"][0], dtype=float), np.zeros(3)),
        policy=policy,
        pose=lambda state: {"p_m": state[0], "v_m_s": state[1], "q_wxyz": [1.0, 0.0, 0.0, 0.0]},
        step_s=STEP_S,
    )


place = tempfile.mkdtemp()
values = {"generate.search.cases": 3, "execute.repeat": 1, "execute.baseline": 0}
a = hairpin.stress("demo-quadrotor", executor=executor(classical), out=f"{place}/classical", values=values)
b = a.execute(executor=executor(learned()), out=f"{place}/learned").judge()
for name, campaign in (("classical", a), ("learned", b)):
    print(f"{name}: worst {campaign.worst.max_deviation_m:.2f} m, case {campaign.worst.id}")
print(a.compare(b).verdict)
