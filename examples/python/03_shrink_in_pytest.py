"""In a notebook, ten lines: an own robot, an own controller, its worst flight, shrunk, asserted in a pytest.

`pytest examples/python/03_shrink_in_pytest.py` runs the last lines; python runs the others.
"""

import tempfile

import hairpin

ROBOT = hairpin.Robot("crazyflie")
FEW = {"generate.search.cases": 2, "execute.baseline": 0, "spec.deviation.max_m": 0.05}


def slow(t_s, state, reference):
    target = reference["waypoints_m"][min(reference["next"], len(reference["waypoints_m"]) - 1)]
    return {"v_m_s": [0.5 * (goal - at) for goal, at in zip(target, state["p_m"])]}


def test_slow_keeps_within_five_metres(hairpin_stress):
    hairpin_stress(slow, hairpin.Scenario("demo-quadrotor"), values={**FEW, "spec.deviation.max_m": 5.0})


if __name__ == "__main__":
    found = hairpin.stress(
        hairpin.Scenario("demo-quadrotor", robot=ROBOT), controller=slow, out=tempfile.mkdtemp() + "/out", values=FEW
    )
    print(found.verdict)
    print(found.worst.id, found.worst.max_deviation_m)
    print(found.shrink(budget=20))
