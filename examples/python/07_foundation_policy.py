"""A published learned policy for quadrotors (foundation-policy, PyPI) against a classical cascade on the same missions in MuJoCo.

Needs `pip install mujoco==4.0.0 foundation-policy==1.0.2`; without them it says so.
"""

import importlib.util
import sys
import tempfile
from pathlib import Path

import hairpin

EXECUTORS = Path(__file__).parents[1] / "executors"
VALUES = {"generate.search.cases": 2, "execute.repeat": 1, "execute.baseline": 0}


def by(name):
    return f"{sys.executable} {EXECUTORS / name}"


if any(importlib.util.find_spec(name) is None for name in ("mujoco", "foundation_policy")):
    print("pip install mujoco==4.0.0 foundation-policy==1.0.2")
else:
    place = tempfile.mkdtemp()
    scenario = hairpin.Scenario("demo-quadrotor", robot="x500", values=VALUES)
    classical = hairpin.stress(scenario, executor=by("mujoco_executor.py"), out=f"{place}/classical")
    learned = classical.execute(executor=by("foundation_policy_executor.py"), out=f"{place}/learned").judge()
    for name, campaign in (("cascade", classical), ("policy", learned)):
        print(f"{name}: {campaign.verdict}")
    print(classical.compare(learned).verdict)
