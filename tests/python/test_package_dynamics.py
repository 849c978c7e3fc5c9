"""Robots that are differential equations, and environments under a policy: shapes, mistakes, models that diverge."""

import numpy as np
import pytest

hairpin = pytest.importorskip("hairpin", reason="the package is built by tests/run")

SEARCH = {"method": "uniform", "waypoints": 40, "cases": 1}
SMALL = {"generate.search": SEARCH, "execute.repeat": 1, "execute.baseline": 0}
WAY = {"waypoints_m": [[0, 0, 0], [1, 0, 0]], "accept_m": 0.1, "time_limit_s": 2.0}
RIGHT = {
    "derivative": lambda t, x, u: u,
    "control": lambda t, x, to: to["target_m"] - x,
    "start": lambda mission: np.zeros(3),
    "pose": lambda x: x,
}
ROWS = {
    **RIGHT,
    "derivative": hairpin.vectorised(lambda t, x, u: u),
    "start": lambda missions: np.zeros((len(missions), 3)),
}

@pytest.fixture(scope="module")
def cases(tmp_path_factory):
    return hairpin.generate("demo-quadrotor", out=tmp_path_factory.mktemp("cases") / "out", values=SMALL)


@pytest.mark.parametrize(
    ("field", "wrong", "value"),
    [
        ("derivative", lambda t, x, u: 1.0, "1.0"),
        ("derivative", lambda t, x, u: None, "None"),
        ("derivative", lambda t, x, u: u[:1], "an array of shape (1,)"),
        ("derivative", lambda t, x, u: u[np.newaxis], "an array of shape (1, 3)"),
        ("derivative[0]", lambda t, x, u: u * np.nan, "nan"),
        ("derivative[1]", lambda t, x, u: [0.0, np.inf, 0.0], "inf"),
        ("control", lambda *given: None, "None"),
        ("control", lambda *given: 1.0, "1.0"),
        ("control", lambda *given: np.ones((1, 3)), "an array of shape (1, 3)"),
        ("control[2]", lambda *given: [0.0, 0.0, None], "nan"),
        ("control", lambda t, x, to: np.ones(3 if t < 0.05 else 1), "an array of shape (1,)"),
        ("start", lambda mission: 0.0, "0.0"),
        ("start[0]", lambda mission: [np.nan, 0.0, 0.0], "nan"),
        ("p_m", lambda x: x[:2], "an array of shape (2,)"),
        ("p_m[0]", lambda x: x * np.nan, "nan"),
        ("q_wxyz", lambda x: {"p_m": x, "q_wxyz": x}, "an array of shape (3,)"),
    ],
)
def test_what_is_of_another_shape_or_not_finite_is_a_mistake_of_its_function(field, wrong, value):
    which = {"p_m": "pose", "q_wxyz": "pose"}.get(field.partition("[")[0], field.partition("[")[0])
    with pytest.raises(hairpin.InputError) as found:
        hairpin.dynamics(**{**RIGHT, which: wrong})(WAY)
    assert (found.value.field, found.value.value) == (field, value)
    assert ("numbers of shape" if "[" not in field else "a finite number at t = ") in found.value.bound


@pytest.mark.parametrize(
    ("field", "wrong"),
    [
        ("derivative", hairpin.vectorised(lambda t, x, u: u[:, :1])),
        ("derivative", hairpin.vectorised(lambda t, x, u: u[0])),
        ("derivative[1, 0]", hairpin.vectorised(lambda t, x, u: np.where([[False], [True]], np.nan, u))),
        ("control", lambda t, x, to: (to["target_m"] - x)[0]),
        ("control", lambda t, x, to: (to["target_m"] - x)[:1]),
        ("start", lambda missions: np.zeros(3)),
        ("p_m", lambda x: x[:1]),
    ],
)
def test_rows_of_many_missions_are_not_spread(field, wrong):
    which = "pose" if field == "p_m" else field.partition("[")[0]
    with pytest.raises(hairpin.InputError) as found:
        hairpin.dynamics(**{**ROWS, which: wrong})([WAY, WAY])
    assert found.value.field == field and ("each of 2 missions" in found.value.bound or "[1, 0]" in field)


def test_a_model_that_diverges_crashes_and_a_mistake_in_it_is_none_of_the_robots(cases, tmp_path):
    # x' = x² from 1 is 1/(1 - t): beyond all numbers at t = 1 s.
    explodes = {**RIGHT, "derivative": lambda t, x, u: x * x, "start": lambda mission: np.ones(3)}
    far = {**WAY, "waypoints_m": [[1, 1, 1], [-900, 0, 0]]}
    with np.errstate(all="ignore"):
        flown = hairpin.dynamics(**explodes)(far)
        rows = hairpin.dynamics(**{**ROWS, "derivative": hairpin.vectorised(lambda t, x, u: x * x + x)})([far, far])
    assert flown["ended"] == "crash" and 0.9 < flown["t_s"][-1] < 1.1
    assert [one["ended"] for one in rows] == ["time", "time"]
    first = lambda mission: mission["waypoints_m"][0]  # noqa: E731
    none = hairpin.dynamics(**{**RIGHT, "control": lambda *given: None, "start": first})
    judged = cases.execute(executor=none, out=tmp_path / "out").judge()
    assert judged.exit_code == 4 and "`control` = None" in judged.verdict, judged.verdict
    # A row whose last waypoint is reached is over, whatever its function gives from there on.
    ends = {**ROWS, "control": lambda t, x, to: np.where((to["next"] > 1)[:, np.newaxis], np.nan, to["target_m"] - x)}
    near = {**WAY, "waypoints_m": [[0, 0, 0], [0.05, 0, 0]]}
    both = hairpin.dynamics(**ends, step_s=0.1)([near, {**WAY, "time_limit_s": 9.0}])
    assert [one["ended"] for one in both] == ["done", "done"]


def test_an_environments_pose_has_its_shape():
    env = {"reset": lambda mission: 0, "policy": lambda state, to: 0, "step_s": 0.1}
    for pose, field in (([0.0, 0.0], "p_m"), (1.0, "p_m"), ({"p_m": [0] * 3, "v_m_s": [0]}, "v_m_s")):
        with pytest.raises(hairpin.InputError) as found:
            hairpin.adversary(lambda state, action: state, pose=lambda state, pose=pose: pose, **env)(WAY)
        assert found.value.field == field
