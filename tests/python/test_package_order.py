"""The worst of a campaign in Python is the worst of the command: by the largest share of a limit that is broken, and robots before executors."""

import os
import pickle
import re
import subprocess

import numpy as np
import pytest

hairpin = pytest.importorskip("hairpin", reason="the package is built by tests/run")
BIN = os.environ["HAIRPIN_BIN"]
VALUES = {"generate.search.cases": 4, "execute.repeat": 1, "execute.baseline": 0, "spec.deviation.max_m": 0.5}


def table_of(folder):
    """Cases as the command's table has them."""
    done = subprocess.run([BIN, "judge", folder], capture_output=True, text=True)
    return re.findall(r"^(\d{4})  ", done.stdout + done.stderr, re.MULTILINE), done.stdout


@pytest.fixture(scope="module")
def slow(tmp_path_factory):
    out = tmp_path_factory.mktemp("slow") / "out"
    return hairpin.stress("demo-quadrotor", out=out, seed=3, values={**VALUES, "spec.total_time.max_s": 1.0})


def test_the_worst_breaks_a_limit_by_the_largest_share(slow):
    order, verdict = table_of(slow.folder)
    by_deviation = sorted(slow, key=lambda case: -case.max_deviation_m)
    assert len(order) == 4 and order != [case.id for case in by_deviation]
    assert [case.id for case in slow.failing] == order and slow.worst.id == order[0] == slow.summary["worst"]["case"]
    assert f"case {order[0]}," in verdict and f"case {order[0]}," in slow.verdict
    shown = slow._repr_html_()
    assert re.findall(r"<tr><td>(\d{4})", shown) == order and f"case {order[0]} from above" in shown
    assert f'"asked":"{order[0]}"'.replace('"', "&quot;") in slow.show()._repr_html_()
    assert slow.shrink(budget=1).case == order[0]
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("Agg")
    assert slow.plot().get_title().startswith(order[0])


def test_executors_that_failed_say_nothing_of_the_robot(slow, tmp_path):
    def falls(mission):
        if mission["case"] in ("0000", "0003"):
            raise OSError("rotor lost")
        way = np.asarray(mission["waypoints_m"])
        legs = np.linspace(0.0, len(way) - 1.0, 40 * len(way))
        places = np.stack([np.interp(legs, np.arange(len(way)), axis) for axis in way.T], axis=1)
        aside = 0.6 * int(mission["case"]) * np.sin(np.pi * legs) ** 2
        return {"t_s": 4.0 * legs, "p_m": places + aside[:, np.newaxis] * [0.0, 0.0, 1.0]}

    judged = slow.execute(executor=falls, out=tmp_path / "out").judge()
    order, _ = table_of(judged.folder)
    assert [judged[case].status for case in order] == ["fail", "fail", "executor-failed", "executor-failed"]
    assert judged.worst.id == order[0] == judged.summary["worst"]["case"] and [case.id for case in judged.failing] == order[:2]
    assert re.findall(r"<tr><td>(\d{4})", judged._repr_html_()) == order


def test_what_is_not_judged_is_in_the_order_of_its_numbers(tmp_path):
    planned = hairpin.generate("demo-quadrotor", out=tmp_path / "out", values=VALUES)
    assert planned.worst.id == "0000" and planned.failing == ()


def test_answers_are_the_same_once_they_were_pickled(slow):
    again = pickle.loads(pickle.dumps(slow))
    assert again.worst.id == slow.worst.id and again.verdict == slow.verdict and len(again.failing) == 4
    with pytest.raises(TypeError, match="pickle"):
        pickle.dumps(slow.table())
