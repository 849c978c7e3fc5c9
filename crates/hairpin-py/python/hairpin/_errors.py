"""Why a call gave no result. Each kind has the exit code that the command gives for it."""

from __future__ import annotations


class InputError(ValueError):
    """Wrong input: exit code 2 of the command.

    Attributes:
        field: what is wrong, by its name (a key such as ``execute.repeat``, a keyword such as ``x``); empty where the sentence is all.
        value: what was given, as text.
        bound: what it must be.
        place: line and column, from 1, of the text or table that it stands in; ``None`` where it stands in none.
    """

    exit_code = 2

    def __init__(
        self, message: str, field: str = "", value: str = "", bound: str = "", place: tuple[int, int] | None = None
    ) -> None:
        super().__init__(message)
        self.field = field
        self.value = value
        self.bound = bound
        self.place = place


class ExecutorError(RuntimeError):
    """A program or callable of the user's failed before anything could be told of its runs: exit code 4."""

    exit_code = 4


class WriteError(OSError):
    """A result could not be written, no space or an I/O error: exit code 74."""

    exit_code = 74


class Interrupted(KeyboardInterrupt):
    """A job was stopped; what is done is kept, and the same call with ``if_there="resume"`` goes on: exit code 130."""

    exit_code = 130
