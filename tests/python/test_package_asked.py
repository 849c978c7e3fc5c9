"""What callers hand over: numbers out of bounds, masked arrays, words and places that are none, each refused with its parts."""

import os
import subprocess

import numpy as np
import pytest

hairpin = pytest.importorskip("hairpin", reason="the package is built by tests/run")
from hairpin._scenario import toml_value  # noqa: E402

BIN = os.environ["HAIRPIN_BIN"]
NAN = float("nan")
PAIR = [[0, 1], [1, 0]]
GOAL = {"x": 3.0, "y": 1.0, "yaw": 0.5}


def refused(call, *given, **settings):
    with pytest.raises(hairpin.InputError) as found:
        call(*given, **settings)
    error = found.value
    assert str(error) == f"`{error.field}` = {error.value}: must be {error.bound}", error
    return error.field, error.value, error.bound


def masked(values, *at):
    array = np.ma.array(values, dtype=float, mask=False)
    array[at] = np.ma.masked
    return array


@pytest.mark.parametrize(
    ("words", "call", "keyword", "bound"),
    [
        (("verify", "x", "--threads", 1025), lambda **given: hairpin.max_load(PAIR, **given), "threads", "in 1..=1024"),
        (("verify", "x", "--threads", 0), lambda **given: hairpin.max_load(PAIR, **given), "threads", "in 1..=1024"),
        (("explain", "x", "--graphs", 10001), lambda **given: hairpin.explain("demo-quadrotor", **given), "graphs", "in 1..=10000"),
        (("max-load", "irb120", "--visits", 17), lambda **given: hairpin.max_load(PAIR, **given), "visits", "in 1..=16"),
        (("max-load", "irb120", "--programs", 1001), lambda **given: hairpin.max_load(PAIR, **given), "programs", "in 1..=1000"),
        (
            ("max-load", "irb120", "--seed", 2**63),
            lambda **given: hairpin.max_load(PAIR, **given),
            "seed",
            f"in 0..={2**63 - 1}",
        ),
        (
            ("compare", "a", "b", "--tolerance-m", NAN),
            lambda **given: hairpin.compare("a", "b", **given),
            "tolerance_m",
            "a finite number >= 0",
        ),
        (
            ("steer", "generic", "--to", "1,0,0", "--tolerance-m", 0),
            lambda **given: hairpin.steer("generic", **GOAL, **given),
            "tolerance_m",
            "a finite number > 0",
        ),
        (
            ("steer", "generic", "--to", "1,0,0", "--time-limit-ms", 1e10),
            lambda **given: hairpin.steer("generic", **GOAL, **given),
            "time_limit_ms",
            "a number of milliseconds, 0 … 1e9",
        ),
        (("judge", "x", "--from", NAN), lambda **given: hairpin.judge("x", mission="m", **given), "from_s", "a finite number"),
        (("judge", "x", "--to", NAN), lambda **given: hairpin.judge("x", mission="m", **given), "to_s", "a finite number"),
        (("judge", "x", "--turn", NAN), lambda **given: hairpin.judge("x", mission="m", **given), "turn_deg", "a finite number"),
    ],
)
def test_bounds_and_words_are_the_commands(words, call, keyword, bound):
    done = subprocess.run([BIN, *map(str, words)], capture_output=True, text=True)
    assert done.returncode == 2 and bound in done.stderr, done.stderr
    value = words[-1]
    field, told, what = refused(call, **{keyword: value})
    assert (field, told) == (keyword, repr(value)) and what.endswith(bound)


@pytest.mark.parametrize("seconds", [NAN, -1, float("inf"), "5", True])
def test_time_limits_are_numbers_of_seconds(seconds, tmp_path):
    out = tmp_path / "out"
    done = subprocess.run([BIN, "explain", "x", "--time-limit", "nan"], capture_output=True, text=True)
    assert "must be a number of seconds ≥ 0" in done.stderr
    for call in (
        lambda **given: hairpin.stress("demo-quadrotor", out=out, **given),
        lambda **given: hairpin.generate("demo-quadrotor", out=out, **given),
        lambda **given: hairpin.explain("demo-quadrotor", **given),
        lambda **given: hairpin.max_load(PAIR, **given),
    ):
        assert refused(call, time_limit_s=seconds) == ("time_limit_s", repr(seconds), "a number of seconds ≥ 0")
    for budget in (seconds, 0, 2e9):
        field, value, bound = refused(hairpin.stress, "demo-quadrotor", out=out, budget_s=budget)
        assert (field, value) == ("budget_s", repr(budget)) and "> 0" in bound and "1e9" in bound
    assert not out.exists()


@pytest.mark.parametrize(
    ("call", "given", "field", "value"),
    [
        (hairpin.max_load, {"matrix": PAIR, "threads": "4"}, "threads", "'4'"),
        (hairpin.max_load, {"matrix": PAIR, "progress": 4}, "progress", "4"),
        (hairpin.max_load, {"matrix": PAIR, "start": 1.0}, "start", "1.0"),
        (hairpin.max_load, {"matrix": PAIR, "nodes": 1.5}, "nodes", "1.5"),
        (hairpin.max_load, {"matrix": PAIR, "min_cost": "a"}, "min_cost", "'a'"),
        (hairpin.max_load, {"matrix": PAIR, "method": 5}, "method", "5"),
        (hairpin.max_load, {"matrix": PAIR, "certificate": 5}, "certificate", "5"),
        (hairpin.max_load, {"matrix": PAIR, "certificate": "x", "programs": 2}, "programs", "2"),
        (hairpin.max_load, {"matrix": [[0, "1"], [1, 0]]}, "matrix", "[[0, '1'], [1, 0]]"),
        (hairpin.max_load, {"matrix": np.array([[0, 1j], [1, 0]])}, "matrix", "an array of shape (2, 2)"),
        (hairpin.max_load, {"cloud": "x", "cell": 5}, "cell", "5"),
        (hairpin.max_load, {"cloud": [[0.3, 0.0, NAN]], "cell": "irb120"}, "cloud[0, 2]", "nan"),
        (hairpin.max_load, {"cloud": "x", "cell": "irb120", "if_there": "replace"}, "if_there", "'replace'"),
        (hairpin.steer, {"rover": "generic", "queries": [[1, 0, 0, 0, 0]], "k0": 0.1}, "k0", "0.1"),
        (hairpin.steer, {"rover": "generic", "queries": [[1, 0, 0, 0, 0]], "kf": 0.0}, "kf", "0.0"),
        (hairpin.steer, {"rover": "generic", **GOAL, "free_end": "no"}, "free_end", "'no'"),
        (hairpin.steer, {"rover": "generic", **GOAL, "reversals": 1}, "reversals", "1"),
        (hairpin.steer, {"rover": "generic", **GOAL, "terrain": 5}, "terrain", "5"),
        (hairpin.steer, {"rover": "generic", **GOAL, "start": (1.0, 0.0)}, "start", "(1.0, 0.0)"),
        (hairpin.steer, {"rover": "generic", **GOAL, "start": (1.0, 0.0, NAN)}, "start[2]", "nan"),
        (hairpin.steer, {"rover": "generic", **GOAL, "x": 1e9}, "x", "1000000000.0"),
        (hairpin.steer, {"rover": "generic", **GOAL, "x": "3"}, "x", "'3'"),
        (hairpin.steer, {"rover": "generic", **GOAL, "x": np.ma.masked}, "x", "masked"),
        (hairpin.steer, {"rover": 5, **GOAL}, "rover", "5"),
        (hairpin.judge, {"what": "x", "mission": "m", "offset_m": (0.0, NAN, 0.0)}, "offset_m[1]", "nan"),
        (hairpin.judge, {"what": "x", "campaign": "c", "case": -1}, "case", "-1"),
        (hairpin.judge, {"what": "x", "mission": "m", "source": 5}, "source", "5"),
        (hairpin.judge, {"what": 5}, "what", "5"),
        (hairpin.stress, {"source": 5}, "source", "5"),
        (hairpin.stress, {"source": "demo-quadrotor", "seed": 1.5}, "seed", "1.5"),
        (hairpin.stress, {"source": "demo-quadrotor", "out": 5}, "out", "5"),
        (hairpin.stress, {"source": "demo-quadrotor", "values": 5}, "values", "5"),
        (hairpin.stress, {"source": "demo-quadrotor", "values": {"execute.repeat": None}}, "execute.repeat", "None"),
        (hairpin.stress, {"source": "demo-quadrotor", "values": {"a": [0, {"b": b"x"}]}}, "a[1].b", "b'x'"),
        (hairpin.stress, {"source": "demo-quadrotor", "portable": "no"}, "portable", "'no'"),
        (hairpin.stress, {"source": "demo-quadrotor", "allow_commands": 1}, "allow_commands", "1"),
        (hairpin.stress, {"source": "demo-quadrotor", "missions": 5}, "missions", "5"),
        (hairpin.stress, {"source": "demo-quadrotor", "executor": 5}, "executor", "5"),
        (hairpin.stress, {"source": "demo-quadrotor", "target": 5}, "target", "5"),
        (hairpin.execute, {"campaign": 5}, "campaign", "5"),
        (hairpin.execute, {"campaign": "x", "resume": True, "missions": "m"}, "resume", "True"),
        (hairpin.execute, {"campaign": "x", "if_there": "replace"}, "if_there", "'replace'"),
        (hairpin.verify, {"campaign": 5}, "campaign", "5"),
        (hairpin.compare, {"a": "x", "b": 5}, "b", "5"),
        (hairpin.learn, {"campaigns": 5}, "campaigns", "5"),
        (hairpin.learn, {"campaigns": ["x"], "stress": 5}, "stress", "5"),
        (hairpin.open_campaign, {"folder": 5}, "folder", "5"),
        (hairpin.Table, {"folder": "x", "name": "results", "run": -1}, "run", "-1"),
        (hairpin.Robot, {"source": 5}, "source", "5"),
        (hairpin.Scenario, {"source": "demo-quadrotor", "robot": 5}, "robot", "5"),
    ],
)
def test_what_is_of_another_kind_is_refused_by_its_name(call, given, field, value, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert refused(call, **given)[:2] == (field, value)
    assert not list(tmp_path.iterdir())


def test_masked_entries_are_no_numbers(tmp_path):
    for matrix in (masked([[0, 1, 2], [3, 0, 4], [5, 6, 0]], 1, 2), [[0, 1, 2], masked([3, 0, 4], 2), [5, 6, 0]]):
        assert refused(hairpin.max_load, matrix) == ("matrix[1, 2]", "masked", "a number, or NaN for no arc")
    cloud = masked([[0.3, 0.0, 0.3], [0.35, 0.1, 0.3]], 1, 1)
    assert refused(hairpin.max_load, cloud=cloud, cell="irb120")[:2] == ("cloud[1, 1]", "masked")
    assert refused(hairpin.steer, "generic", queries=masked(np.ones((3, 5)), 2, 0))[:2] == ("queries[2, 0]", "masked")
    assert refused(hairpin.steer, "generic", **GOAL, start=masked([1, 2, 0], 1))[:2] == ("start[1]", "masked")
    assert refused(hairpin.judge, "x", mission="m", offset_m=masked([1, 2, 3], 2))[:2] == ("offset_m[2]", "masked")
    values = {"task.end_m": masked([1, 2, 3], 0)}
    assert refused(hairpin.generate, "demo-quadrotor", out=tmp_path / "out", values=values)[:2] == ("task.end_m[0]", "masked")
    drive = hairpin.steer("generic", **GOAL)
    assert refused(drive.curvature, masked([0.0, 1.0], 1))[:2] == ("s_m[1]", "masked")
    # Nothing is masked of these.
    assert hairpin.max_load(np.ma.array(PAIR)).cost == 1 and hairpin.steer("generic", queries=np.ma.ones((2, 5))).ok.shape == (2,)


def test_masked_answers_of_callables_count_for_nothing(tmp_path):
    values = {"generate.search": {"method": "uniform", "waypoints": 40, "cases": 2}, "execute.repeat": 1, "execute.baseline": 0}
    cases = hairpin.generate("demo-quadrotor", out=tmp_path / "cases", values=values)

    def flight(key, *at):
        def fly(mission):
            way = np.asarray(mission["waypoints_m"])
            told = {"t_s": 1.0 * np.arange(len(way)), "p_m": way, "v_m_s": 0.0 * way, "leg": np.maximum(np.arange(len(way)) - 1, 0)}
            return {**told, key: masked(told[key], *at) if at else np.full_like(told[key], np.nan)}

        return fly

    for number, (key, *at) in enumerate((("p_m", 1, 2), ("t_s", 1), ("v_m_s", 0, 0), ("leg", 1), ("p_m",))):
        flown = cases.execute(executor=flight(key, *at), out=tmp_path / str(number))
        entry = f"`{key}[{', '.join(map(str, at or (0, 0)))}]` = {'masked' if at else 'nan'}"
        assert flown.exit_code == 4 and entry in flown.verdict, flown.verdict
    for number, (key, value, told) in enumerate(
        (("leg", 0.5, "`leg[0]` = 0.5: must be a whole number ≥ 0"), ("leg", -1, "`leg[0]` = -1"), ("ended", "never", "one of done, time, crash"))
    ):

        def fly(mission):
            way = np.asarray(mission["waypoints_m"])
            return {"t_s": 1.0 * np.arange(len(way)), "p_m": way, key: value if key == "ended" else [value] * len(way)}

        flown = cases.execute(executor=fly, out=tmp_path / f"words-{number}")
        assert flown.exit_code == 4 and told in flown.verdict, flown.verdict
    ground = hairpin.dynamics(lambda t, x, u: u, lambda t, x, to: masked([0, 0, 0], 1), lambda mission: np.zeros(3), lambda x: x)
    mission = {"waypoints_m": [[0, 0, 0], [1, 0, 0]], "accept_m": 0.1, "time_limit_s": 9.0}
    assert refused(ground, mission)[:2] == ("control[1]", "masked")
    seen = hairpin.adversary(lambda s, a: s, reset=lambda m: 0, policy=lambda s, to: 0, pose=lambda s: masked([0, 0, 0], 2), step_s=0.1)
    assert refused(seen, mission)[:2] == ("p_m[2]", "masked")
    score = hairpin.vectorised(lambda legs: masked(legs["turn_rad"], 0))
    with pytest.raises(hairpin.InputError, match="masked"):
        hairpin.generate("demo-quadrotor", score=score, out=tmp_path / "score", values=values | {"generate.search.method": "beam"})
    for number, rows in enumerate((np.ma.masked_all, lambda shape: np.zeros(shape) * 1j, lambda shape: np.full(shape, "0"))):
        steers = hairpin.vectorised(lambda t_s, state, reference: {"a_m_s2": rows((len(t_s), 3))})
        assert cases.execute(controller=steers, out=tmp_path / f"controller-{number}").exit_code == 4
    flown = cases.execute(out=tmp_path / "own")
    assert flown.judge_by(hairpin.vectorised(lambda runs: np.ma.masked_all(len(runs)))).exit_code == 5


@pytest.mark.parametrize("answer", [NAN, float("inf"), 1e101, np.ma.masked, "5", True, np.complex128(5)])
def test_scores_and_targets_are_bounded_as_those_of_files(answer, tmp_path):
    searched = {"score": {"generate.search.cases": 2}, "target": {"generate.search": {"method": "worst", "executions": 12, "cases": 2}}}
    for what, values in searched.items():
        with pytest.raises(hairpin.InputError, match="1e100|masked"):
            hairpin.generate("demo-quadrotor", out=tmp_path / what, values=values, **{what: lambda given: answer})


def test_whole_numbers_that_floating_point_leaves_out_are_refused():
    for matrix, value in (
        ([[0, 2**53 + 1], [1, 0]], "9007199254740993"),
        ([[0, 2**53], [1.5, 0]], "9007199254740992"),
        (np.array([[0, 2**62], [1, 0]]), "4611686018427387904"),
        ([[0.0, 1e300], [1.0, 0.0]], "1e+300"),
    ):
        field, told, bound = refused(hairpin.max_load, matrix)
        assert (field, told) == ("matrix[0, 1]", value) and "9007199254740992" in bound
    assert refused(hairpin.max_load, PAIR, min_cost=2**53)[:2] == ("min_cost", "9007199254740992")
    most = 2**53 - 1
    found = hairpin.max_load([[2**60, most], [1, 0]])
    assert found.proven and found.cost == most and isinstance(found.cost, int)


def test_mistakes_that_the_job_finds_are_told_of_what_was_handed_over(tmp_path):
    costs = np.random.default_rng(1).uniform(0.0, 100.0, (5, 5))
    for matrix, at, told in (
        (costs, (0, 1), "at most 4.1175768021673106 for sums over 5 points"),
        ([[0, 1], [1e-300, 0]], (0, 1), "within 64 bits times 10^300"),
        ([[0, 1e-17], [9e15, 0]], (1, 0), "within 64 bits times 10^17"),
        ([[0, 2**53 - 1], [1, 0]], (0, 1), "at most 4503599627370495"),
    ):
        field, value, bound = refused(hairpin.max_load, matrix, visits=16 if "45035" in told else 1)
        assert (field, value) == (f"matrix[{at[0]}, {at[1]}]", repr(np.asarray(matrix, dtype=object)[at])) and told in bound
    for given, field, value in (({"min_cost": 1e-300}, "min_cost", "0.00"), ({"visits": 2, "method": "dfs"}, "visits", "")):
        with pytest.raises(hairpin.InputError) as found:
            hairpin.max_load(PAIR, **given)
        assert found.value.field == field and found.value.value.startswith(value) and found.value.bound
    same, far = [[0.3, 0.0, 0.3], [0.3, 0.0, 0.3]], [[0.3, 0.0, 0.3], [0.35, 0.0, 0.3]]
    for cloud, given, field, value in ((same, {}, "cloud[1]", "[0.3, 0.0, 0.3]"), (far, {"start": 7}, "start", "7")):
        with pytest.raises(hairpin.InputError) as found:
            hairpin.max_load(cloud=cloud, cell="irb120", **given)
        assert (found.value.field, found.value.value) == (field, value) and "/tmp" not in str(found.value)
    with pytest.raises(hairpin.InputError, match="row 0 again"):
        hairpin.max_load(cloud=same, cell="irb120")
    with pytest.raises(hairpin.InputError) as found:
        hairpin.learn([])
    assert found.value.field == "campaigns"
    assert refused(hairpin.vectorised, 5)[:2] == ("function", "5")


def test_a_single_point_has_a_path_and_none_is_no_matrix(tmp_path):
    (tmp_path / "one.csv").write_text("5\n")
    done = subprocess.run([BIN, "max-load", "--graph", tmp_path / "one.csv"], capture_output=True, text=True)
    found = hairpin.max_load([[5.0]])
    assert done.stdout.startswith("cost 0, optimal") and (found.path, found.cost, found.proven) == ([0], 0, True)
    assert "one point or more" in refused(hairpin.max_load, np.zeros((0, 0)))[2]
    assert "one point or more" in refused(hairpin.max_load, cloud=np.zeros((0, 3)), cell="irb120")[2]


def test_a_step_takes_time():
    def nothing(*given):
        return 0

    for step_s in (0, -1.0, NAN, float("inf"), "x"):
        told = ("step_s", repr(step_s), "a number of seconds > 0")
        assert refused(hairpin.adversary, nothing, reset=nothing, policy=nothing, pose=nothing, step_s=step_s) == told
        assert refused(hairpin.dynamics, nothing, nothing, nothing, nothing, step_s=step_s) == told
    assert refused(hairpin.dynamics, nothing, nothing, nothing, nothing, substeps=1.5)[:2] == ("substeps", "1.5")
    assert refused(hairpin.dynamics, nothing, 5, nothing, nothing)[:2] == ("control", "5")
    slow = hairpin.adversary(nothing, reset=nothing, policy=nothing, pose=lambda state: [0.0, 0.0, 0.0], step_s=1e-300)
    field, _, bound = refused(slow, {"waypoints_m": [[0, 0, 0], [1, 0, 0]], "accept_m": 0.1, "time_limit_s": 10.0})
    assert field == "step_s" and bound == "at least 1e-06, for 1e+07 steps in 10 s"


def test_bounds_are_what_a_value_must_be(tmp_path):
    with pytest.raises(hairpin.InputError) as found:
        hairpin.generate("demo-quadrotor", out=tmp_path / "out", values={"spec.deviation.max_m": NAN})
    assert (found.value.field, found.value.value, found.value.bound) == ("spec.deviation.max_m", "nan", "a finite number")


def test_texts_are_tomls():
    assert toml_value("a🚁\x7fé\n") == '"a🚁\\u007fé\\n"'
    with pytest.raises(TypeError, match="mass_kg"):
        hairpin.Robot("anafi", mass_kg=3.0)
