"""The pytest plugin, seen from outside; examples, docstrings and stubs of the package."""

import doctest
import importlib
import importlib.metadata
import os
import pkgutil
import subprocess
import sys
from pathlib import Path

import pytest

hairpin = pytest.importorskip("hairpin", reason="the package is built by tests/run")
ROOT = Path(__file__).parents[2]
EXAMPLES = sorted((ROOT / "examples/python").glob("[0-9]*.py"))
SHIPPED = ROOT / "data/scenarios/demo-quadrotor.toml"
SMALL = ("--hairpin-set", "generate.search.cases=2", "--hairpin-set", "execute.repeat=1", "--hairpin-set", "execute.baseline=0")


def run(place, *words):
    """pytest in a folder of its own, with the plugin, installed or not."""
    installed = any(entry.value == "hairpin.pytest_plugin" for entry in importlib.metadata.entry_points(group="pytest11"))
    plugin = [] if installed else ["-p", "hairpin.pytest_plugin"]
    done = subprocess.run(
        [sys.executable, "-m", "pytest", *plugin, "-q", "-rA", *map(str, words)],
        cwd=place,
        capture_output=True,
        text=True,
        timeout=120,
    )
    return done.returncode, done.stdout + done.stderr


@pytest.fixture
def place(tmp_path):
    (tmp_path / "scenario.toml").write_text(SHIPPED.read_text())
    (tmp_path / "test_other.py").write_text("def test_other():\n    pass\n")
    return tmp_path


def test_each_case_is_a_test(place):
    code, said = run(place, "--hairpin", "scenario.toml", *SMALL, "--hairpin-set", "spec.deviation.max_m=50")
    assert code == 0 and "scenario.toml::0000" in said and "scenario.toml::0001" in said and "2 passed" in said, said


def test_a_failure_has_both_numbers_and_the_repro(place):
    one_of_two = (*SMALL, "--hairpin-set", "spec.deviation.max_m=4.5")
    code, said = run(place, "--hairpin", "scenario.toml", *one_of_two)
    assert (
        code == 1
        and "1 failed, 1 passed" in said
        and "4.73 m > 4.50 m" in said
        and "hairpin replay" in said
        and "repro/0001.json" in said
    ), said
    code, said = run(place, "--hairpin", "scenario.toml", *one_of_two, "--lf")
    assert code == 1 and "1 failed" in said and "passed" not in said and "scenario.toml::0000" not in said, said
    both = (*SMALL, "--hairpin-set", "spec.deviation.max_m=0.5")
    code, said = run(place, "--hairpin", "scenario.toml", *both, "-x", "-k", "000")
    assert code == 1 and "1 failed" in said and "0001" not in said.split("short test summary")[-1], said
    code, said = run(place, "--hairpin", "scenario.toml", *both, "-k", "0001")
    assert code == 1 and "1 failed, 1 deselected" in said, said


def test_scenarios_and_tests_go_together_and_mistakes_are_told(place):
    code, said = run(place, "test_other.py", "--hairpin", "scenario.toml", *SMALL, "--hairpin-set", "spec.deviation.max_m=50")
    assert code == 0 and "3 passed" in said, said
    code, said = run(place, "--hairpin", "nothing.toml")
    assert code == 4 and "nothing.toml" in said
    code, said = run(place, "--hairpin", "scenario.toml", "--hairpin-set", "execute.repeat=0")
    assert code == 2 and "execute.repeat" in said


def two(place):
    """Two scenarios of one name: what the first asks no flight keeps, the second asks next to nothing."""
    for name, most in (("a", "0.5"), ("b", "50")):
        (place / name).mkdir()
        (place / name / "sc.toml").write_text(SHIPPED.read_text().replace("max_m = 4.5", f"max_m = {most}"))
    return "--hairpin", "a/sc.toml", "--hairpin", "b/sc.toml", *SMALL


def test_scenarios_of_one_name_have_folders_of_their_own(place):
    both = two(place)
    code, said = run(place, *both, "--hairpin-out", "od")
    assert code == 1 and "2 failed, 2 passed" in said and "od/a-sc/repro" in said, said
    assert sorted(folder.name for folder in (place / "od").iterdir()) == ["a-sc", "b-sc"]
    worst = [max(case.max_deviation_m for case in hairpin.Campaign(place / "od" / name)) for name in ("a-sc", "b-sc")]
    assert worst[0] == worst[1] and (place / "od/a-sc/repro").is_dir() and not (place / "od/b-sc/repro").exists()
    # In the cache, which outlives a run, also where they are given one at a time.
    for only in (both[:2], both[2:4]):
        run(place, *only, *SMALL)
    assert sorted(folder.name for folder in (place / ".pytest_cache/d/hairpin").iterdir()) == ["a-sc", "b-sc"]


@pytest.mark.parametrize(
    ("scenarios", "names"),
    [
        (["/x/sc.toml"], ["sc"]),
        (["/x/a/sc.toml", "/x/b/sc.toml", "/x/b/other.toml"], ["a-sc", "b-sc", "other"]),
        (["/x/a/sc.toml", "/y/a/sc.toml"], ["x-a-sc", "y-a-sc"]),
        (["/x/sc.toml", "/y/SC.toml"], ["x-sc", "y-SC"]),
        (["/x/a/sc.toml", "/x/b/sc.toml", "/x/a-sc.toml"], ["a-sc", "b-sc", "a-sc-2"]),
    ],
)
def test_folders_are_named_apart(scenarios, names):
    from hairpin.pytest_plugin import _names

    files = [Path(name) for name in scenarios]
    assert [_names(files)[file] for file in files] == names
    assert _names(files[:1], Path("/x"))[files[0]] == "-".join(files[0].with_suffix("").parts[2:])


def test_a_case_can_be_run_again_by_its_name(place):
    few = (*SMALL, "--hairpin-set", "spec.deviation.max_m=50")
    code, said = run(place, "--hairpin", "scenario.toml", "scenario.toml::0001", *few)
    assert code == 0 and "1 passed" in said and "scenario.toml::0001" in said, said
    code, said = run(place, "--hairpin", "scenario.toml", "scenario.toml", *few)
    assert code == 0 and "2 passed" in said, said


def test_workers_read_the_campaign_that_was_made_before_them(place):
    pytest.importorskip("xdist")
    both = (*two(place), "--hairpin-out", "od", "test_other.py")
    code, said = run(place, *both, "-n", "2")
    assert code == 1 and "2 failed, 3 passed" in said and "od/a-sc/repro" in said, said
    code, said = run(place, "--hairpin", "scenario.toml", "--hairpin-set", "execute.repeat=0", "-n", "2")
    assert code != 0 and "execute.repeat" in said and "Different tests" not in said, said


def test_calls_of_the_fixture_have_folders_of_their_own_and_what_asks_for_nothing_is_skipped(place):
    (place / "test_own.py").write_text(
        "VALUES = {'generate.search.cases': 1, 'execute.repeat': 1, 'execute.baseline': 0, 'spec.deviation.max_m': 90.0}\n"
        "def test_twice(hairpin_stress):\n"
        "    first, second = [hairpin_stress(values=VALUES, seed=seed) for seed in (1, 2)]\n"
        "    assert first.folder != second.folder\n"
        "def test_of_nothing(hairpin_stress):\n"
        "    hairpin_stress(values={key: value for key, value in VALUES.items() if 'spec' not in key} | {'spec': 'none'})\n"
    )
    code, said = run(place, "test_own.py")
    assert code == 0 and "1 passed, 1 skipped" in said and "nothing is asked of it" in said, said


def test_the_fixture_fails_with_the_shrunk_case(place):
    (place / "test_own.py").write_text(
        "VALUES = {'generate.search.cases': 1, 'execute.repeat': 1, 'execute.baseline': 0, 'spec.deviation.max_m': 0.5}\n"
        "def slow(t_s, state, reference):\n"
        "    target = reference['waypoints_m'][min(reference['next'], len(reference['waypoints_m']) - 1)]\n"
        "    return {'v_m_s': [goal - at for goal, at in zip(target, state['p_m'])]}\n"
        "def test_fails(hairpin_stress):\n"
        "    hairpin_stress(slow, values=VALUES, shrink_budget=3)\n"
        "def test_holds(hairpin_stress):\n"
        "    assert len(hairpin_stress(slow, values={**VALUES, 'spec.deviation.max_m': 90.0})) == 1\n"
    )
    code, said = run(place, "test_own.py")
    assert code == 1 and "1 failed, 1 passed" in said and "waypoints ->" in said and "hairpin replay" in said, said


def test_a_verdict_is_told_whatever_shrinking_came_to(place):
    (place / "test_own.py").write_text(
        "VALUES = {'generate.search': {'method': 'uniform', 'waypoints': 40, 'cases': 1}, 'execute.repeat': 1,\n"
        "          'execute.baseline': 0, 'spec.deviation.max_m': 0.5}\n"
        "def test_stops(hairpin_stress):\n"
        "    asked = []\n"
        "    def once(mission):\n"
        "        asked.append(mission)\n"
        "        if len(asked) > 1:\n"
        "            raise OSError('rotor lost')\n"
        "        return {'t_s': [0.0, 1.0], 'p_m': [mission['waypoints_m'][0]] * 2, 'ended': 'crash'}\n"
        "    hairpin_stress(values=VALUES, executor=once)\n"
    )
    code, said = run(place, "test_own.py")
    assert code == 1 and "1 failed" in said and "FAIL 1/1" in said and "Traceback" not in said, said
    assert "not shrunk: " in said and "rotor lost" in said and "case 0000: crash" in said, said


def test_settings_that_are_none_are_usage_errors(place):
    code, said = run(place, "--hairpin", "scenario.toml", "--hairpin-set", "foo")
    assert code == 4 and "ERROR: --hairpin-set foo: must be KEY=VALUE" in said and "Traceback" not in said, said


@pytest.mark.parametrize("example", EXAMPLES, ids=lambda path: path.stem)
def test_examples_run(example):
    done = subprocess.run([sys.executable, str(example)], capture_output=True, text=True, timeout=120)
    assert done.returncode == 0 and done.stdout.strip(), done.stderr


def test_the_example_that_is_a_test_runs():
    code, said = run(ROOT, "-p", "no:cacheprovider", "examples/python/03_shrink_in_pytest.py")
    assert code == 0 and "1 passed" in said, said


GUIDES = ["stress", "own-controllers", "campaigns", "rover-generator", "heaviest-paths"]
GUIDES += [f"guide/{robot}" for robot in ("drone", "rover", "car", "arm", "own-simulator")]


@pytest.mark.parametrize("guide", GUIDES)
def test_guides_say_what_runs(guide, tmp_path, monkeypatch, capsys):
    text = (ROOT / "docs" / f"{guide}.md").read_text().split("## From Python")[1]
    code = text.split("```python\n")[1].split("```")[0]
    monkeypatch.chdir(tmp_path)
    exec(compile(code, f"{guide}.md", "exec"), {"__name__": "guide"})
    assert capsys.readouterr().out.strip()


def test_docstrings_tell_what_happens():
    tried = 0
    for found in pkgutil.iter_modules(hairpin.__path__):
        if found.name not in ("_native", "_relay", "__main__"):
            came = doctest.testmod(importlib.import_module(f"hairpin.{found.name}"))
            assert came.failed == 0, found.name
            tried += came.attempted
    assert tried > 20


def test_every_public_name_has_a_docstring():
    assert [
        name
        for name in hairpin.__all__
        if not (getattr(hairpin, name).__doc__ or name in ("STATUSES", "__version__", "ControllerLike", "Progress"))
    ] == []


def test_stubs_are_true():
    pytest.importorskip("mypy")
    path = os.pathsep.join(sys.path)
    done = subprocess.run(
        [
            sys.executable,
            "-m",
            "mypy.stubtest",
            "hairpin",
            "--ignore-disjoint-bases",
            "--mypy-config-file",
            str(ROOT / "pyproject.toml"),
        ],
        capture_output=True,
        text=True,
        cwd=Path(hairpin.__file__).parents[1],
        env={**os.environ, "PYTHONPATH": path, "MYPYPATH": str(Path(hairpin.__file__).parents[1])},
        timeout=170,
    )
    assert done.returncode == 0, done.stdout + done.stderr
