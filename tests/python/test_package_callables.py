"""Callables of the process: scores, targets, controllers, executors and judges; what goes wrong in them; who can go on."""

import os
import pickle
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest

hairpin = pytest.importorskip("hairpin", reason="the package is built by tests/run")
from hairpin._bridge import _answers  # noqa: E402
from hairpin._callables import source  # noqa: E402

BIN = os.environ["HAIRPIN_BIN"]
PD = Path(__file__).parents[2] / "examples/controllers/pd.py"
SMALL = {"generate.search.cases": 2, "execute.repeat": 1, "execute.baseline": 0}
GAIN = 2.0


def pd_file():
    space = {"__name__": "pd", "__file__": str(PD)}
    exec(compile(PD.read_text(), str(PD), "exec"), space)
    return space["control"]


def gentle(t_s, state, reference):
    target = reference["waypoints_m"][min(reference["next"], len(reference["waypoints_m"]) - 1)]
    return {
        "a_m_s2": [
            GAIN * np.clip(goal - place, -2.0, 2.0) - 2.5 * speed
            for goal, place, speed in zip(target, state["p_m"], state["v_m_s"], strict=True)
        ]
    }


class Counting:
    """Counts its turns; each run has one of its own."""

    def __init__(self):
        self.turns, self.most = 0, 0

    def reset(self, mission):
        assert self.turns == 0 and len(mission["waypoints_m"]) > 1 and mission["robot"]["mass_kg"] > 0

    def control(self, t_s, state, reference):
        self.turns += 1
        return gentle(t_s, state, reference)


@pytest.fixture(scope="module")
def cases(tmp_path_factory):
    return hairpin.generate("demo-quadrotor", out=tmp_path_factory.mktemp("cases") / "out", values=SMALL)


def deviations(campaign):
    return [case.max_deviation_m for case in campaign]


def test_a_callable_flies_as_its_file_does(cases, tmp_path):
    ours = cases.execute(controller=pd_file(), out=tmp_path / "callable").judge()
    file = cases.execute(controller=f"python:{PD}", out=tmp_path / "file").judge()
    assert deviations(ours) == deviations(file)
    assert all(case.status in ("pass", "fail") for case in ours)


def test_classes_have_an_object_for_each_run(cases, tmp_path):
    own = cases.execute(controller=Counting, out=tmp_path / "class").judge()
    plain = cases.execute(controller=gentle, out=tmp_path / "function").judge()
    copied = cases.execute(controller=Counting(), out=tmp_path / "object").judge()
    assert deviations(own) == deviations(plain) == deviations(copied)


def test_the_command_goes_on_where_the_source_stands_alone(cases, tmp_path):
    own = cases.execute(controller=gentle, out=tmp_path / "out").judge()
    assert (tmp_path / "out/gentle.py").is_file()
    # Files are run by the `python3` that is found first, which need not be one with NumPy.
    ours = {**os.environ, "PATH": os.pathsep.join([str(Path(sys.executable).parent), os.environ["PATH"]])}
    done = subprocess.run([BIN, "execute", tmp_path / "out"], capture_output=True, text=True, env=ours)
    assert done.returncode == 0, done.stderr
    assert deviations(hairpin.judge(tmp_path / "out")) == deviations(own)


def test_what_closes_over_something_is_kept_as_its_name(cases, tmp_path):
    gain = 2.0

    def closed(t_s, state, reference):
        return gentle(t_s, state, {**reference, "gain": gain})

    assert source(closed) is None and source(gentle) is not None and "GAIN = 2.0" in source(gentle)
    own = cases.execute(controller=closed, out=tmp_path / "out").judge()
    assert all(case.status in ("pass", "fail") for case in own)
    done = subprocess.run([BIN, "execute", tmp_path / "out", "--allow-commands"], capture_output=True, text=True)
    assert done.returncode != 0 and "go on from there" in done.stderr + done.stdout


turning = lambda t_s, state, reference: {"v_m_s": [0.1 * factorial(3), 0.0, 0.0]}  # noqa: E731
factorial = lambda n: 1 if n < 2 else n * factorial(n - 1)  # noqa: E731
flat = lambda leg: 1.0  # noqa: E731
NEVER, RANDOM = float("nan"), np.random.default_rng(1)
draw = RANDOM.normal


def even(n):
    return n == 0 or odd(n - 1)


def odd(n):
    return n != 0 and even(n - 1)


def mutual(t_s, state, reference):
    return {"v_m_s": [0.5 if even(4) else 0.0, 0.0, 0.0]}


renamed = mutual


def by_another_name(t_s, state, reference):
    return renamed(t_s, state, reference)


class Maker:
    def part(self):
        return Part()


@dataclass
class Part(Maker):
    speed: float = 0.5

    def control(self, t_s, state, reference):
        return {"v_m_s": [self.part().speed, 0.0, 0.0]}


def control(t_s, state, reference):
    return mutual(t_s, state, reference)


def behind_control(t_s, state, reference):
    return control(t_s, state, reference)


def never(t_s, state, reference):
    return {"v_m_s": [NEVER, 0.0, 0.0]}


def drawn(t_s, state, reference):
    return {"v_m_s": [draw(), 0.0, 0.0]}


def counted(t_s, state, reference):
    counted.turns += 1
    return {"v_m_s": [counted.turns, 0.0, 0.0]}


counted.turns = 0


@hairpin.vectorised
def score(legs):
    return 2.0 * legs["turn_rad"]


def run_alone(text):
    space = {"__name__": "kept"}
    exec(compile(text, "kept", "exec"), space)
    return space


def test_kept_files_answer_as_what_they_are_of():
    for controller in (turning, mutual, by_another_name, Part, control):
        ours = controller().control if isinstance(controller, type) else controller
        kept = run_alone(source(controller))["control"]
        assert kept(0.0, {}, {}) == ours(0.0, {}, {}), source(controller)
    # One question, whose answer is another function of the same name in the file.
    assert run_alone(source(score, "score"))["score"]({"turn_rad": 0.5}) == 1.0
    assert run_alone(source(flat, "score"))["score"]({}) == 1.0


def test_what_a_source_does_not_say_is_kept_as_a_name():
    gain = 2.0

    class Closed:
        def control(self, t_s, state, reference):
            return {"v_m_s": [gain, 0.0, 0.0]}

    pair = (lambda t_s, state, reference: {"v_m_s": [0.0, 0.0, 0.0]}, lambda t_s, state, reference: {"v_m_s": [1.0, 0.0, 0.0]})
    for controller in (never, drawn, counted, behind_control, Closed, pair[1]):
        assert source(controller) is None, controller


def test_lambdas_with_a_name_and_functions_that_use_each_other_are_flown(cases, tmp_path):
    for number, controller in enumerate((turning, mutual)):
        own = cases.execute(controller=controller, out=tmp_path / str(number)).judge()
        assert all(case.status in ("pass", "fail", "inconclusive") for case in own), own.verdict
    assert hairpin.generate("demo-quadrotor", score=flat, out=tmp_path / "score", values=SMALL).cases[0].score > 0.0


def test_a_run_that_raises_is_its_own_failure(cases, tmp_path):
    def falls(t_s, state, reference):
        if t_s > 0.5:
            raise LookupError("no such gain")
        return gentle(t_s, state, reference)

    flown = cases.execute(controller=falls, out=tmp_path / "out")
    assert flown.exit_code == 4 and "no such gain" in flown.verdict
    judged = flown.judge()
    assert judged.exit_code == 4 and "LookupError: no such gain" in judged.worst.message
    for answer, told in (
        (lambda *_: {"a_m_s2": [np.nan, 0, 0]}, "finite"),
        (lambda *_: 3.0, "dictionary"),
        (lambda *_: {"b": [0, 0, 0]}, "must be"),
    ):
        wrong = cases.execute(controller=answer, out=tmp_path / told)
        assert wrong.exit_code == 4 and told in wrong.verdict


@hairpin.vectorised
def sharp_many(legs):
    return legs["v_in_m_s"] * legs["turn_rad"]


def sharp(leg):
    return leg["v_in_m_s"] * leg["turn_rad"]


def test_vectorised_scores_find_what_single_ones_and_files_do(tmp_path):
    file = tmp_path / "sharp.py"
    file.write_text("def score(leg):\n    return leg['v_in_m_s'] * leg['turn_rad']\n")
    found = [
        hairpin.generate("demo-quadrotor", score=score, out=tmp_path / str(n), values=SMALL)
        for n, score in enumerate((sharp_many, sharp, f"python:{file}"))
    ]
    ways = [[case.waypoints_m.tolist() for case in campaign] for campaign in found]
    assert ways[0] == ways[1] == ways[2] and found[0].cases[0].score > 0.0


def test_vectorised_scores_are_asked_for_legs_that_there_are_and_give_numbers(tmp_path):
    asked = []

    @hairpin.vectorised
    def counted(legs):
        asked.append(len(legs["turn_rad"]))
        return legs["turn_rad"]

    values = {**SMALL, "generate.search.method": "exact", "generate.search.waypoints": 40}
    hairpin.generate("demo-quadrotor", score=counted, out=tmp_path / "counted", values=values)
    assert min(asked) > 0 and max(asked) > 1
    for place, answer in enumerate((lambda legs: legs["turn_rad"] > 1.0, lambda legs: [True] * len(legs["turn_rad"]))):
        with pytest.raises(hairpin.InputError, match="neither 0 nor 1"):
            hairpin.generate("demo-quadrotor", score=hairpin.vectorised(answer), out=tmp_path / str(place), values=SMALL)


@pytest.mark.parametrize("method", ["worst", "adaptive"])
def test_a_score_that_the_search_does_not_read_is_refused(method, tmp_path):
    values = {**SMALL, "generate.search.method": method}
    with pytest.raises(hairpin.InputError) as found:
        hairpin.generate("quadrotor", score=sharp, out=tmp_path / "out", values=values)
    assert found.value.field == "generate.score" and not (tmp_path / "out").exists()


def test_a_score_that_raises_stops_the_search_with_its_cause(tmp_path):
    def broken(leg):
        raise KeyError("speed")

    with pytest.raises(hairpin.InputError) as found:
        hairpin.generate("demo-quadrotor", score=broken, out=tmp_path / "out", values=SMALL)
    assert "score" in found.value.field and isinstance(found.value.__cause__, KeyError)
    with pytest.raises(hairpin.InputError, match="finite"):
        hairpin.generate("demo-quadrotor", score=lambda leg: float("nan"), out=tmp_path / "out", values=SMALL, if_there="replace")


LOOPED = {**SMALL, "generate.search": {"method": "worst", "executions": 6, "cases": 2}, "execute.baseline": 0}


@pytest.mark.parametrize("what", ["executor", "controller"])
def test_who_fails_every_execution_of_a_search_is_its_cause(what, tmp_path):
    def broken(*asked):
        raise ZeroDivisionError("boom")

    with pytest.raises(hairpin.ExecutorError, match="none of .* came to a flight.*boom") as found:
        hairpin.stress("demo-quadrotor", **{what: broken}, out=tmp_path / "out", values=LOOPED)
    assert isinstance(found.value.__cause__, ZeroDivisionError)


def test_targets_measure_runs(tmp_path):
    seen = []

    def high(run):
        seen.append(run["p_m"].shape)
        return run["p_m"][:, 2].max()

    values = {**SMALL, "generate.search": {"method": "worst", "executions": 20, "cases": 2}}
    found = hairpin.stress("demo-quadrotor", target=high, out=tmp_path / "out", values=values)
    assert len(found) == 2 and seen and seen[0][1] == 3


def straight(mission):
    points, speed, step = np.asarray(mission["waypoints_m"], dtype=float), 2.0, 0.05
    rows, legs = [], []
    for leg, (a, b) in enumerate(zip(points, points[1:])):
        samples = max(1, int(np.ceil(np.linalg.norm(b - a) / speed / step)))
        rows += [a + (b - a) * k / samples for k in range(samples)]
        legs += [leg] * samples
    rows.append(points[-1])
    legs.append(len(points) - 2)
    return {
        "t_s": np.arange(len(rows)) * step,
        "p_m": np.array(rows),
        "q_wxyz": np.tile([1.0, 0, 0, 0], (len(rows), 1)),
        "leg": legs,
    }


def test_executors_are_told_as_programs_are(cases, tmp_path):
    flown = cases.execute(executor=straight, out=tmp_path / "out").judge()
    assert flown.exit_code == 0 and max(deviations(flown)) < 1e-6
    assert "straight" in flown.verdict

    def breaks(mission):
        raise OSError("rotor lost")

    failed = cases.execute(executor=breaks, out=tmp_path / "failed")
    assert failed.exit_code == 4 and "rotor lost" in failed.verdict
    done = subprocess.run([BIN, "execute", tmp_path / "out", "--allow-commands"], capture_output=True, text=True)
    assert done.returncode == 4 and "lives in a Python process" in done.stdout + done.stderr + "".join(
        log.read_text() for log in (tmp_path / "out").glob("*.log")
    )


def test_flights_may_be_told_in_the_words_of_the_protocol():
    mission = {"type": "mission", "case": "0003", "run": 1, "waypoints_m": [[0, 0, 0], [1, 0, 0]]}
    flown = {"t_s": [0.0, 1.0], "p_m": [[0, 0, 0], [1, 0, 0]]}

    def answers(**given):
        return list(_answers(mission, lambda asked: {**flown, **given}, "own"))

    for given in ({"reason": "crash"}, {"ended": "crash"}, {"ended": "crash", "reason": "crash", "type": "end", "case": "0003", "run": 1}):
        assert answers(**given)[-1] == {"type": "end", "reason": "crash"}
    assert answers(ended="done")[-1] == {"type": "end", "reason": "done"}
    # What is left out is taken for done, and told as left out.
    assert answers()[-1] == answers(reason=None)[-1] == {"type": "end", "reason": "done", "assumed": True}
    for given, told in (
        ({"reason": "stalled"}, "`reason` = 'stalled'"),
        ({"reason": "crash", "ended": "done"}, "`reason` = 'crash'"),
        ({"crashed": True}, "`key of the flight` = 'crashed'"),
        ({"v_m_s2": [0, 0]}, "`key of the flight` = 'v_m_s2'"),
        ({"case": "0004"}, "`case` = '0004': must be the mission's, '0003'"),
        ({"type": "error", "message": "rotor lost"}, "rotor lost"),
        ({"t_s": None}, "`t_s` = None"),
    ):
        assert [one["type"] for one in answers(**given)] == ["error"] and told in answers(**given)[0]["message"], given


def test_columns_of_a_flight_that_have_names_go_by_them():
    pandas = pytest.importorskip("pandas")
    places = pandas.DataFrame([[1.0, 0.0, 2.0], [1.0, 5.0, 2.0]], columns=["y", "x", "z"])
    mission = {"type": "mission", "case": "0000", "run": 0}

    def first(p_m):
        return next(iter(_answers(mission, lambda asked: {"t_s": [0.0, 1.0], "p_m": p_m}, "own")))

    assert first(places)["p_m"] == [0.0, 1.0, 2.0] and first(places.to_numpy())["p_m"] == [1.0, 0.0, 2.0]
    assert "p_m.columns" in first(places.rename(columns={"z": "down"}))["message"]


def test_a_pose_with_keys_that_are_not_understood_is_refused():
    mission = {"waypoints_m": [[0, 0, 0], [1, 0, 0]], "accept_m": 0.1, "time_limit_s": 9.0}
    for pose, told in (({"p_m": [0, 0, 0], "v": [0, 0, 0]}, "'v'"), ({"q_wxyz": [1, 0, 0, 0]}, "q_wxyz")):
        seen = hairpin.adversary(lambda s, a: s, reset=lambda m: 0, policy=lambda s, to: 0, pose=lambda s, pose=pose: pose, step_s=0.1)
        with pytest.raises(hairpin.InputError, match=told):
            seen(mission)


def test_own_dynamics_meet_a_closed_form():
    # x'' = 1 from rest: x(t) = t²/2, exactly what a Runge-Kutta step of order 4 gives.
    falls = hairpin.dynamics(
        lambda t, x, u: [x[1], u[0]],
        lambda t, x, to: [1.0],
        start=lambda mission: [0.0, 0.0],
        pose=lambda x: [x[0], 0.0, 0.0],
        step_s=0.1,
    )
    flown = falls({"waypoints_m": [[0, 0, 0], [2, 0, 0]], "accept_m": 0.05, "time_limit_s": 9.0})
    np.testing.assert_allclose(flown["p_m"][:, 0], 0.5 * flown["t_s"] ** 2, atol=1e-12)
    assert flown["ended"] == "done" and flown["t_s"][-1] == pytest.approx(2.0, abs=0.051)


def test_own_dynamics_are_unchecked_where_nothing_is_planned(tmp_path):
    point = hairpin.dynamics(
        lambda t, x, u: u,
        lambda t, x, to: np.clip(to["target_m"] - x, -2.0, 2.0),
        start=lambda mission: mission["waypoints_m"][0],
        pose=lambda x: {"p_m": x, "q_wxyz": [1.0, 0.0, 0.0, 0.0]},
        step_s=0.05,
    )
    values = {**SMALL, "generate.reach": "none", "generate.search.method": "uniform"}
    found = hairpin.stress("demo-quadrotor", executor=point, out=tmp_path / "out", values=values)
    assert {case.evidence for case in found} == {"unchecked"} and found.exit_code in (0, 1)


@hairpin.vectorised
def chase(t_s, state, control):
    return control


def chasing(derivative, *as_places):
    return hairpin.dynamics(
        derivative,
        lambda t, x, to: np.clip(to["target_m"] - x, -2.0, 2.0),
        start=lambda given: [one["waypoints_m"][0] for one in given] if isinstance(given, list) else given["waypoints_m"][0],
        pose=lambda x: {"p_m": x, "q_wxyz": np.broadcast_to([1.0, 0.0, 0.0, 0.0], (*x.shape[:-1], 4)), **dict.fromkeys(as_places, x)},
        step_s=0.05,
    )


def test_many_missions_are_integrated_as_each_by_itself():
    ways = [[[0, 0, 0], [2, 0, 0]], [[1, 1, 1], [1, 4, 1], [5, 4, 1]], [[0, 0, 0], [900, 0, 0]], [[3, 3, 3]]]
    missions = [{"waypoints_m": way, "accept_m": 0.1, "time_limit_s": 20.0} for way in ways]
    many, one = chasing(chase, "v_m_s"), chasing(lambda t, x, u: u, "v_m_s")
    for together, alone in zip(many(missions), map(one, missions), strict=True):
        assert together.keys() == alone.keys() and together["ended"] == alone["ended"]
        for key in ("t_s", "p_m", "q_wxyz", "v_m_s", "leg"):
            np.testing.assert_array_equal(together[key], alone[key], err_msg=key)
    assert [flown["ended"] for flown in many(missions)] == ["done", "done", "time", "done"]
    with pytest.raises(ValueError, match="a row for each of 4 missions"):
        hairpin.dynamics(chase, lambda t, x, to: x, lambda given: np.zeros((3, 3)), lambda x: x)(missions)


def test_executors_that_take_many_fly_as_single_ones(tmp_path):
    sizes = []

    @hairpin.vectorised
    def straight_many(missions):
        sizes.append(len(missions))
        return [straight(mission) for mission in missions]

    values = {"generate.search": {"method": "uniform", "waypoints": 40, "cases": 12}, "execute.repeat": 1, "execute.baseline": 0}
    cases = hairpin.generate("demo-quadrotor", out=tmp_path / "cases", values=values)
    many = cases.execute(executor=straight_many, out=tmp_path / "many").judge()
    alone = cases.execute(executor=straight, out=tmp_path / "alone").judge()
    assert deviations(many) == deviations(alone) and many.exit_code == 0
    assert sum(sizes) == 12 and max(sizes) > 2
    assert "processes = 16" in (tmp_path / "many/scenario.toml").read_text()
    sizes.clear()
    cases.execute(executor=straight_many, out=tmp_path / "two", values={"execute.processes": 2})
    assert sum(sizes) == 12 and max(sizes) <= 2


def test_a_mission_that_cannot_be_carried_out_costs_no_other(tmp_path):
    values = {"generate.search": {"method": "uniform", "waypoints": 40, "cases": 4}, "execute.repeat": 1, "execute.baseline": 0}
    cases = hairpin.generate("demo-quadrotor", out=tmp_path / "cases", values=values)

    @hairpin.vectorised
    def loses_one(missions):
        if any(mission["case"] == "0002" for mission in missions):
            raise OSError("rotor lost")
        return [straight(mission) for mission in missions]

    judged = cases.execute(executor=loses_one, out=tmp_path / "one").judge()
    assert [case.status for case in judged] == ["pass", "pass", "executor-failed", "pass"] and "rotor lost" in judged["0002"].message
    few = cases.execute(executor=hairpin.vectorised(lambda missions: []), out=tmp_path / "few")
    assert few.exit_code == 4 and "0 flights of" in few.verdict


def test_the_search_flies_many_at_once(tmp_path):
    values = {"execute.baseline": 2, "execute.repeat": 1, "generate.search": {"method": "worst", "waypoints": 60, "executions": 24, "cases": 2}}
    found = [
        hairpin.stress("demo-quadrotor", executor=chasing(f), out=tmp_path / name, values={**values, "generate.reach": "hull"})
        for name, f in (("many", chase), ("alone", lambda t, x, u: u))
    ]
    assert deviations(found[0]) == deviations(found[1]) and len(found[0]) == 2


def test_judges_that_take_many_say_what_single_ones_say(cases, tmp_path):
    flown = cases.execute(executor=straight, out=tmp_path / "out", values={"execute.repeat": 2})
    low = hairpin.vectorised(lambda runs: np.array([4.0 - run.p_m[:, 2].max() for run in runs]))
    assert flown.judge_by(low).margins == flown.judge_by(lambda run: 4.0 - run.p_m[:, 2].max()).margins
    assert len(flown.judge_by(low).margins) == 4
    assert flown.judge_by(hairpin.vectorised(lambda runs: [np.nan] * len(runs))).exit_code == 5
    with pytest.raises(ValueError, match="0 answers of 4 runs"):
        flown.judge_by(hairpin.vectorised(lambda runs: []))
    for strange in ("5", b"5", 5j):
        with pytest.raises(hairpin.InputError, match="`margin` = .*5.*: must be a number, True or False, or None"):
            flown.judge_by(lambda run, answer=strange: answer)
    with pytest.raises(hairpin.InputError, match="no vectorised form"):
        hairpin.stress("demo-quadrotor", target=low, out=tmp_path / "target")


def test_a_run_that_was_failed_or_not_kept_is_no_pass(cases, tmp_path):
    def flies_one(mission):
        if mission["case"] == "0001":
            raise OSError("rotor lost")
        return straight(mission)

    judged = cases.execute(executor=flies_one, out=tmp_path / "failed").judge_by(lambda run: True)
    assert judged.margins == {("0000", 0): 0.0} and judged.failed == (("0001", 0),) and judged.missing == ()
    assert (judged.exit_code, bool(judged), judged.verdict) == (4, False, "EXECUTOR FAILED 1/2 runs")
    gone = {**SMALL, "execute.repeat": 3, "execute.record": "worst"}
    worst = hairpin.stress("demo-quadrotor", out=tmp_path / "worst", values=gone)
    judged = worst.judge_by(lambda run: True)
    assert len(judged.margins) == 2 and len(judged.missing) == 4 and judged.exit_code == 5 and not judged
    assert str(judged).startswith("INCONCLUSIVE 0/6 runs; 4 not there to judge")
    judged = worst.judge_by(lambda run: False)
    assert judged.exit_code == 1 and str(judged).startswith("FAIL 2/6 runs; 4 not there to judge")
    none = worst.execute(values={"execute.record": "none"}, out=tmp_path / "none").judge_by(lambda run: True)
    assert (none.exit_code, none.margins, len(none.missing)) == (5, {}, 6)
    with pytest.raises(hairpin.InputError, match="executions"):
        cases.judge_by(lambda run: True)


def test_runs_that_were_asked_for_and_not_executed_are_missing(cases, tmp_path):
    def enough(what, done, of):
        if done > 1:
            raise RuntimeError("enough")

    with pytest.raises(RuntimeError, match="enough"):
        cases.execute(out=tmp_path / "out", values={"execute.repeat": 20}, threads=1, progress=enough)
    judged = hairpin.open_campaign(tmp_path / "out").judge_by(lambda run: True)
    assert judged.margins and judged.missing and len(judged.margins) + len(judged.missing) == 40
    assert judged.exit_code == 5


def test_what_a_judge_says_no_with_is_no(cases, tmp_path):
    flown = cases.execute(executor=straight, out=tmp_path / "out")
    for no in (False, np.False_, np.array(False), np.float32(-1), -1, np.array(-0.5)):
        assert flown.judge_by(lambda run, no=no: no).exit_code == 1, no
        assert flown.judge_by(hairpin.vectorised(lambda runs, no=no: [no] * len(runs))).exit_code == 1, no
    for many in ([False, False], (False, False), np.array([False, False]), np.zeros(2, bool)):
        assert flown.judge_by(hairpin.vectorised(lambda runs, many=many: many)).exit_code == 1, many
    assert flown.judge_by(lambda run: np.array(True)) and flown.judge_by(lambda run: np.ma.masked).exit_code == 5
    stamp = np.datetime64(1, "s")
    for strange in ([False], np.array([False]), {}, {1.0}, b"\0", "1", 1j, np.ones((1, 1)), stamp, object()):
        with pytest.raises(hairpin.InputError) as found:
            flown.judge_by(lambda run, strange=strange: strange)
        error = found.value
        assert error.field == "margin" and error.value and error.bound == "a number, True or False, or None"
    tables = (np.zeros((2, 1), bool), -np.ones((2, 2)))
    for strange in ({0: 1, 1: 1}, {1.0, 2.0}, "11", b"\0\0", *tables, None, iter([1.0, 1.0])):
        with pytest.raises(hairpin.InputError) as found:
            flown.judge_by(hairpin.vectorised(lambda runs, strange=strange: strange))
        assert found.value.field == "judge" and found.value.value and "one for each run" in found.value.bound
    pandas = pytest.importorskip("pandas")
    assert flown.judge_by(hairpin.vectorised(lambda runs: pandas.Series([False] * len(runs)))).exit_code == 1


def test_the_same_campaign_asks_its_executor_again(tmp_path):
    asked = []

    def climbs(mission):
        asked.append(mission["case"])
        flown = straight(mission)
        flown["p_m"][:, 2] += 6.0 * np.sin(np.linspace(0.0, np.pi, len(flown["t_s"])))
        return flown

    search = {"method": "uniform", "waypoints": 40, "cases": 1}
    values = {"generate.search": search, "execute.repeat": 1, "execute.baseline": 0}
    high = lambda mission: climbs(mission)  # noqa: E731
    flown = hairpin.stress("demo-quadrotor", executor=high, out=tmp_path / "out", values=values)
    # One of the same name: each folder's own is asked.
    level = flown.execute(executor=lambda mission: straight(mission), out=tmp_path / "level")
    asked.clear()
    assert flown.exit_code == 1 and flown.shrink(budget=1).violations and asked
    copied = pickle.loads(pickle.dumps(flown))
    assert copied.verdict == flown.verdict and copied.judge().exit_code == 1
    again = flown.execute(out=tmp_path / "again").judge()
    assert again.exit_code == 1 and deviations(again) == deviations(flown)
    asked.clear()
    together = hairpin.vectorised(lambda missions: [straight(one) for one in missions])
    many = level.execute(executor=together, out=tmp_path / "many")
    steered = flown.execute(controller=gentle, out=tmp_path / "steered")
    assert [one.execute().exit_code for one in (level, many, steered)] == [0, 0, 0] and not asked


@pytest.mark.parametrize("left", [SystemExit(3), KeyboardInterrupt("stop"), GeneratorExit("over")], ids=repr)
def test_executors_that_leave_are_told_as_those_that_raise(left, cases, tmp_path):
    def leaves(mission):
        raise left

    for number, executor in enumerate((leaves, hairpin.vectorised(leaves))):
        flown = cases.execute(executor=executor, out=tmp_path / str(number))
        assert flown.exit_code == 4 and f"{type(left).__name__}: {left}" in flown.verdict, flown.verdict


def test_an_executor_that_leaves_is_the_cause_of_a_search_that_found_nothing(tmp_path):
    with pytest.raises(hairpin.ExecutorError, match="SystemExit: 3") as found:
        hairpin.stress("demo-quadrotor", executor=lambda mission: sys.exit(3), out=tmp_path / "out", values=LOOPED)
    assert isinstance(found.value.__cause__, SystemExit)


def test_the_console_command_is_the_command():
    done = subprocess.run([sys.executable, "-m", "hairpin", "--version"], capture_output=True, text=True)
    assert done.returncode == 0 and done.stdout == subprocess.run([BIN, "--version"], capture_output=True, text=True).stdout
    wrong = subprocess.run([sys.executable, "-m", "hairpin", "stress", "nothing.toml"], capture_output=True, text=True)
    assert wrong.returncode == 2 and "nothing.toml" in wrong.stderr
