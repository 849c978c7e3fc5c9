"""The program that hairpin starts for an executor that is a callable: it passes lines on to the process that has it, and back."""

from __future__ import annotations

import contextlib
import os
import socket
import sys
import threading

PLACE = "HAIRPIN_PYTHON_EXECUTOR"


def main() -> int:
    """Passes on until one side ends."""
    name, place = sys.argv[-1], os.environ.get(PLACE)
    connection = socket.socket(socket.AF_UNIX)
    try:
        connection.connect(place or "")
        connection.sendall(f"{name}\n".encode())
    except OSError:
        return _gone(name)

    def pass_on() -> None:
        with contextlib.suppress(OSError):
            while piece := os.read(0, 1 << 16):
                connection.sendall(piece)
            connection.shutdown(socket.SHUT_WR)

    threading.Thread(target=pass_on, daemon=True).start()
    heard = False
    with contextlib.suppress(OSError):
        while piece := connection.recv(1 << 16):
            heard = True
            while piece:
                piece = piece[os.write(1, piece) :]
    return 0 if heard else _gone(name)


def _gone(name: str) -> int:
    with contextlib.suppress(OSError):
        print(f"the executor {name} lives in a Python process: go on from there, with the same executor", file=sys.stderr, flush=True)
    return 1


if __name__ == "__main__":
    # A thread may still wait for a line.
    os._exit(main())
