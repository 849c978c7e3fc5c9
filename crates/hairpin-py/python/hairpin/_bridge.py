"""Executors that are callables of this process: hairpin starts a program for each mission that is under way, which passes the
lines of the executor protocol on to this process and back. So whoever executes is told as every program is, and is none of ours."""

from __future__ import annotations

import contextlib
import json
import os
import shlex
import socket
import sys
import tempfile
import threading
from collections.abc import Callable, Iterator, Mapping
from typing import Any

import numpy as np

from hairpin._errors import InputError

PLACE = "HAIRPIN_PYTHON_EXECUTOR"
"""Where the process is heard."""


@contextlib.contextmanager
def serving(executor: Callable[..., Any] | str | None) -> Iterator[str | None]:
    """The command that executes; while it is in use the callable is served."""
    if executor is None or isinstance(executor, str):
        yield executor
        return
    if not callable(executor):
        bound = "a command or a function of a mission"
        raise InputError(f"`executor` = {executor!r}: must be {bound}", "executor", repr(executor), bound)
    name = "".join(c if c.isalnum() or c in "_-." else "_" for c in getattr(executor, "__name__", type(executor).__name__))
    with tempfile.TemporaryDirectory(prefix="hairpin-") as folder:
        place = os.path.join(folder, "executor")
        server = socket.socket(socket.AF_UNIX)
        server.bind(place)
        server.listen(64)
        listening = threading.Thread(target=_listen, args=(server, executor, name), daemon=True)
        listening.start()
        before = os.environ.get(PLACE)
        os.environ[PLACE] = place
        try:
            yield f"{shlex.quote(sys.executable)} -m hairpin._bridge {name}"
        finally:
            if before is None:
                del os.environ[PLACE]
            else:
                os.environ[PLACE] = before
            # Closing alone does not end a call that waits.
            with contextlib.suppress(OSError):
                server.shutdown(socket.SHUT_RDWR)
            server.close()


def _listen(server: socket.socket, executor: Callable[..., Any], name: str) -> None:
    while True:
        try:
            connection, _ = server.accept()
        except OSError:
            return
        threading.Thread(target=_serve, args=(connection, executor, name), daemon=True).start()


def _serve(connection: socket.socket, executor: Callable[..., Any], name: str) -> None:
    """One program's missions."""
    with connection, connection.makefile("r", encoding="utf-8") as asked, connection.makefile("w", encoding="utf-8") as said:
        with contextlib.suppress(OSError, ValueError):
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
            yield from _told(executor(message))
        except Exception as error:  # It is the user's code: what it raises is why there is no run.
            yield {"type": "error", "message": f"{type(error).__name__}: {error}"}


def _told(flown: Mapping[str, Any]) -> Iterator[dict[str, Any]]:
    t_s, p_m = np.asarray(flown["t_s"], dtype=np.float64), np.asarray(flown["p_m"], dtype=np.float64)
    if t_s.ndim != 1 or p_m.shape != (len(t_s), 3) or not len(t_s):
        raise ValueError(f"t_s of shape {t_s.shape} and p_m of shape {p_m.shape}: must be (n,) and (n, 3)")
    poses = [{"type": "pose", "t_s": t, "p_m": p} for t, p in zip(t_s.tolist(), p_m.tolist(), strict=True)]
    for key, shape in (("q_wxyz", (len(t_s), 4)), ("v_m_s", (len(t_s), 3)), ("leg", (len(t_s),))):
        if flown.get(key) is None:
            continue
        values = np.asarray(flown[key])
        if values.shape != shape:
            raise ValueError(f"{key} of shape {values.shape}: must be {shape}")
        for pose, value in zip(poses, values.tolist(), strict=True):
            pose[key] = value
    yield from poses
    yield {"type": "end", "reason": flown.get("ended", "done")}


def main() -> int:
    """The program that hairpin starts."""
    place = os.environ.get(PLACE)
    if not place:
        print(f"{sys.argv[-1]} lives in a Python process: go on from there, with the same executor", file=sys.stderr)
        return 1
    connection = socket.socket(socket.AF_UNIX)
    try:
        connection.connect(place)
    except OSError:
        print(f"{sys.argv[-1]} lives in a Python process that does not listen any more", file=sys.stderr)
        return 1

    def pass_on() -> None:
        with contextlib.suppress(OSError):
            while piece := os.read(0, 1 << 16):
                connection.sendall(piece)
            connection.shutdown(socket.SHUT_WR)

    threading.Thread(target=pass_on, daemon=True).start()
    with contextlib.suppress(OSError):
        while piece := connection.recv(1 << 16):
            while piece:
                piece = piece[os.write(1, piece) :]
    return 0


if __name__ == "__main__":
    sys.exit(main())
