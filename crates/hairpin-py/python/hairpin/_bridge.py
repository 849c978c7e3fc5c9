"""Executors that are callables of this process: hairpin starts a program for each mission that is under way, which passes the
lines of the executor protocol on to this process and back. So whoever executes is told as every program is, and is none of ours."""

from __future__ import annotations

import contextlib
import json
import os
import shlex
import socket
import sys
import threading
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np

from hairpin._asked import entry, finite, floats, function, unmasked, whole, word, wrong
from hairpin._call import Brought
from hairpin._labels import floats_by_name
from hairpin._many import Together, takes_many
from hairpin._scenario import texts

PLACE = "HAIRPIN_PYTHON_EXECUTOR"
"""Where the process is heard."""
_OWNER = "HAIRPIN_PYTHON_EXECUTOR_OWNER"


_executors: dict[str, Callable[..., Any]] = {}
_free = threading.Condition()
"""Of what is served: held where it changes, and told of names that are free again."""

_KEYS = ("t_s", "p_m", "q_wxyz", "v_m_s", "leg", "ended", "reason", "type", "case", "run")
"""What is understood of a flight: arrays, how it ended, and what the protocol says beside them."""
_ENDS = ("done", "time", "crash")
_NAMES = {
    "p_m": (("x", "y", "z"), ("x_m", "y_m", "z_m")),
    "q_wxyz": (("w", "x", "y", "z"), ("qw", "qx", "qy", "qz"), ("q_w", "q_x", "q_y", "q_z")),
    "v_m_s": (("x", "y", "z"), ("vx", "vy", "vz"), ("vx_m_s", "vy_m_s", "vz_m_s"), ("v_x", "v_y", "v_z")),
}
"""What columns may be called, where they have names."""


@contextlib.contextmanager
def serving(executor: Callable[..., Any] | str | None, brought: Brought | None = None) -> Iterator[str | None]:
    """The command that executes; while it is in use the callable is served, and what it last raised kept.

    What is ``brought`` keeps a callable and its name, for jobs that go on from a folder whose scenario names it.
    """
    if executor is None or isinstance(executor, str):
        yield executor
        return
    function("executor", executor, "a command or a function of a mission")
    kept = brought or Brought()
    kept.executor = executor
    with _named(executor, kept) as name:
        # Of the package it needs nothing, whose import takes longer than many a mission.
        yield shlex.join([sys.executable, "-IS", str(Path(__file__).with_name("_relay.py")), name])


@contextlib.contextmanager
def serving_again(brought: Brought | None) -> Iterator[None]:
    """While it is in use the callable that executed is served by the name that the folder's scenario has."""
    if brought is None or brought.executor is None:
        yield
        return
    with _named(brought.executor, brought, brought.served):
        yield


@contextlib.contextmanager
def _named(executor: Callable[..., Any], brought: Brought, known: str = "") -> Iterator[str]:
    """The name by which an executor is asked for as long as this lasts: the one that is known, or one that is free."""
    given = getattr(executor, "__name__", type(executor).__name__)
    plain = "".join(c if c.isalnum() or c in "_-." else "_" for c in given) or "executor"
    brought.flying.clear()
    serves = _keeping(Together(executor) if takes_many(executor) else executor, brought.flying)
    with _free:
        if PLACE not in os.environ or os.environ.get(_OWNER) != str(os.getpid()):
            _begin_to_listen()
        # Another one of this name may be at work, in a thread of its own.
        _free.wait_for(lambda: known not in _executors)
        names = (plain if number == 1 else f"{plain}-{number}" for number in range(1, 1 << 16))
        name = known or next(name for name in names if name not in _executors)
        _executors[name], brought.served = serves, name
    try:
        yield name
    finally:
        with _free:
            del _executors[name]
            _free.notify_all()


def _keeping(executor: Callable[..., Any], raised: list[BaseException]) -> Callable[..., Any]:
    """``executor``, what it raised last being kept for whoever asks why nothing was flown."""

    def fly(mission: dict[str, Any]) -> Any:
        try:
            return executor(mission)
        except BaseException as error:
            raised[:] = [error]
            raise

    return fly


def _begin_to_listen() -> None:
    """For as long as the process lives."""
    place = str(texts() / "executors")
    server = socket.socket(socket.AF_UNIX)
    server.bind(place)
    server.listen(64)
    threading.Thread(target=_listen, args=(server,), daemon=True).start()
    os.environ[PLACE], os.environ[_OWNER] = place, str(os.getpid())


def _listen(server: socket.socket) -> None:
    while True:
        connection, _ = server.accept()
        threading.Thread(target=_serve, args=(connection,), daemon=True).start()


def _serve(connection: socket.socket) -> None:
    """One program's missions, of the executor that its first line names."""
    # A program may end at any time, and what was left to be said to it is said nowhere, not even where the line is closed.
    with contextlib.suppress(OSError, ValueError):
        with connection, connection.makefile("r", encoding="utf-8") as asked, connection.makefile("w", encoding="utf-8") as said:
            name = asked.readline().strip()
            executor = _executors.get(name)
            if executor is None:
                return
            for line in asked:
                message = json.loads(line)
                for answer in _answers(message, executor, name):
                    said.write(json.dumps(answer) + "\n")
                said.flush()
                if message["type"] == "bye":
                    return


def _answers(message: dict[str, Any], executor: Callable[..., Any], name: str) -> Iterator[dict[str, Any]]:
    if message["type"] == "hello":
        yield {"type": "ready", "protocol": 1, "name": name}
    elif message["type"] == "mission":
        try:
            told = list(_told(executor(message), message))
        except BaseException as error:
            # It is the user's code: what it raises is why there is no run. Ctrl-C ends the job in the thread that asked.
            told = [{"type": "error", "message": f"{type(error).__name__}: {error}"}]
        yield from told


def _told(flown: Any, mission: dict[str, Any]) -> Iterator[dict[str, Any]]:
    if not isinstance(flown, Mapping):
        raise TypeError(f"{flown!r} is no dictionary, of the executor")
    if flown.get("type") == "error":
        raise RuntimeError(str(flown.get("message", "it says no more")))
    strange = next((key for key in flown if key not in _KEYS), None)
    if strange is not None:
        raise wrong("key of the flight", strange, f"one of {', '.join(_KEYS)}")
    word("type", flown.get("type", "end"), ("end", "error"))
    for key in ("case", "run"):
        if key in flown and flown[key] != mission.get(key):
            raise wrong(key, flown[key], f"the mission's, {mission.get(key)!r}")
    missing = next((key for key in ("t_s", "p_m") if flown.get(key) is None), None)
    if missing is not None:
        raise wrong(missing, None, "an array of numbers")
    ended = _end(flown)
    t_s, p_m = (_numbers(key, flown[key]) for key in ("t_s", "p_m"))
    if t_s.ndim != 1 or p_m.shape != (len(t_s), 3) or not len(t_s):
        raise ValueError(f"t_s of shape {t_s.shape} and p_m of shape {p_m.shape}: must be (n,) and (n, 3)")
    poses = [{"type": "pose", "t_s": t, "p_m": p} for t, p in zip(t_s.tolist(), p_m.tolist(), strict=True)]
    for key, shape in (("q_wxyz", (len(t_s), 4)), ("v_m_s", (len(t_s), 3)), ("leg", (len(t_s),))):
        if flown.get(key) is None:
            continue
        values = _legs(flown[key]) if key == "leg" else _numbers(key, flown[key])
        if values.shape != shape:
            raise ValueError(f"{key} of shape {values.shape}: must be {shape}")
        for pose, value in zip(poses, values.tolist(), strict=True):
            pose[key] = value
    yield from poses
    # What is not said is told as not said: the verdict rests on it.
    yield {"type": "end", "reason": ended or "done"} | ({} if ended else {"assumed": True})


def _end(flown: Mapping[str, Any]) -> str | None:
    """Why a flight is over, by our word or by the protocol's; ``None`` where it is left out."""
    told = [word(key, flown[key], _ENDS) for key in ("ended", "reason") if flown.get(key) is not None]
    if len(set(told)) > 1:
        raise wrong("reason", told[1], f"`ended`, which is {told[0]!r}, or left out")
    return told[0] if told else None


def _numbers(key: str, values: Any) -> Any:
    """An array of a flight; of what is masked or no number there is no flight."""
    bound = "an array of numbers"
    numbers = floats_by_name(key, values, bound, _NAMES[key]) if key in _NAMES else floats(key, values, bound)
    finite(key, numbers, "a finite number")
    return numbers


def _legs(values: Any) -> Any:
    """Numbers of legs; ``None`` where a pose is of none."""
    unmasked("leg", values, "a whole number")
    legs = np.array(values, dtype=object)
    for at, leg in np.ndenumerate(legs):
        legs[at] = None if leg is None else whole(entry("leg", at), int(leg) if isinstance(leg, float) and leg.is_integer() else leg, 0)
    return legs
