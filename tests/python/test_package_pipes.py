"""Who listens no more is told nothing more, without a word of it: executors, the programs that drive Python files, progress."""

import contextlib
import json
import os
import subprocess
import sys
import threading
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
HELLO = '{"type":"hello","hairpin":2}\n'
WAY = [[0.0, 0.0, 0.0], [900.0, 0.0, 0.0]]
MISSION = {"type": "mission", "case": "0000", "run": 0, "seed": 1, "waypoints_m": WAY, "accept_m": 0.1, "time_limit_s": 1e4, "limits": {},
           "accept": {"radius_m": 0.1, "height_m": 0.1}, "robot": {}, "world": {}, "timed": []}
RESET = {"type": "reset", "case": "0000", "run": 0}


def unheard(words, asked, stderr=subprocess.PIPE):
    """What a program says on stderr whose first answer is read and none after it, and its exit code."""
    program = subprocess.Popen(words, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=stderr, text=True)
    with contextlib.suppress(BrokenPipeError):
        program.stdin.write(asked[0])
        program.stdin.flush()
        program.stdout.readline()
        program.stdout.close()
        program.stdin.write("".join(asked[1:]))
        program.stdin.close()
    said = program.stderr.read() if program.stderr else ""
    return said, program.wait(timeout=60)


@pytest.mark.parametrize("name", ["minimal_executor.py", "skeleton.py"])
def test_executors_end_without_a_word(name):
    asked = [HELLO, json.dumps(RESET) + "\n", json.dumps(MISSION) + "\n"]
    said, code = unheard([sys.executable, ROOT / "examples/executors" / name], asked)
    assert (said, code) == ("", 0)


@pytest.mark.parametrize("name", ["rotorpy_executor", "mujoco_executor", "mavlink_flight", "drone_models_executor", "crazyflie_firmware"])
def test_executors_in_other_simulators_say_things_as_these_do(name):
    text = (ROOT / "examples/executors" / f"{name}.py").read_text()
    say = text[text.index("def say(") :].split("\n\n")[0]
    reads, writes = os.pipe()
    os.close(reads)
    words = [sys.executable, "-c", f"import json, os, sys\nanswers = sys.stdout\n{say}\nsay(type='ready')\nprint('heard', file=sys.stderr)"]
    done = subprocess.run(words, stdout=writes, stderr=subprocess.PIPE, text=True)
    os.close(writes)
    assert (done.stderr, done.returncode) == ("", 0)


def test_controllers_that_are_programs_end_without_a_word():
    turn = {"type": "control", "t_s": 0.0, "state": {"p_m": WAY[0], "v_m_s": WAY[0]}, "reference": {"waypoints_m": WAY, "next": 1}}
    said, code = unheard([sys.executable, ROOT / "examples/controllers/pd_program.py"], [json.dumps(turn) + "\n"] * 20000)
    assert said == "" and code != 1


@pytest.mark.parametrize("what", ["controller", "score"])
def test_python_files_are_driven_without_a_word(what, tmp_path):
    (tmp_path / "own.py").write_text("def control(t_s, state, reference):\n    return {}\n\ndef score(leg):\n    return 1.0\n")
    driver = ROOT / "crates/hairpin-formats/src/scenario/user.py"
    legs = json.dumps([{}] * 1000) + "\n"
    asked = [json.dumps({"type": "reset", "mission": {"waypoints_m": WAY}}) + "\n"] * 20000 if what == "controller" else ["", *[legs] * 200]
    said, code = unheard([sys.executable, driver, tmp_path / "own.py", "alone", what], asked)
    assert (said, code) == ("", 0)


def test_callables_that_nobody_listens_to_end_without_a_word():
    hairpin = pytest.importorskip("hairpin", reason="the package is built by tests/run")
    from hairpin import _bridge

    begun, gone, raised = threading.Event(), threading.Event(), []

    def flies(mission):
        begun.set()
        gone.wait(30)
        return {"t_s": [0.0, 1.0], "p_m": WAY}

    before, threading.excepthook = threading.excepthook, lambda found: raised.append(found.exc_value)
    try:
        with _bridge.serving(flies) as command:
            import shlex

            relay = subprocess.Popen(shlex.split(command), stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
            relay.stdin.write(HELLO + json.dumps(MISSION) + "\n")
            relay.stdin.flush()
            assert begun.wait(30)
            serving = [thread for thread in threading.enumerate() if "_serve" in thread.name]
            relay.kill()
            relay.wait()
            gone.set()
            for thread in serving:
                thread.join(30)
            assert serving and raised == []
            said, code = unheard(shlex.split(command), [HELLO, json.dumps(MISSION) + "\n"])
            assert (said, code) == ("", 0)
    finally:
        threading.excepthook = before
    assert hairpin


def test_a_relay_that_nobody_answers_says_so_once(tmp_path):
    relay = ROOT / "crates/hairpin-py/python/hairpin/_relay.py"
    words = [sys.executable, "-IS", relay, "mine"]
    told = subprocess.run(words, capture_output=True, text=True, env={**os.environ, "HAIRPIN_PYTHON_EXECUTOR": str(tmp_path / "none")})
    assert told.returncode == 1 and told.stderr.startswith("the executor mine lives in a Python process")


def test_progress_that_nobody_sees_stops_nothing(monkeypatch):
    hairpin = pytest.importorskip("hairpin", reason="the package is built by tests/run")
    show = hairpin.live()
    reads, writes = os.pipe()
    os.close(reads)
    stream = os.fdopen(writes, "w")
    for gone in (stream, None):
        monkeypatch.setattr(sys, "stderr", gone)
        show("execute", 1, 4)
    monkeypatch.undo()
    with contextlib.suppress(BrokenPipeError):
        stream.close()
