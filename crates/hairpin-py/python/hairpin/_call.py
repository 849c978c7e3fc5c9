"""How every job is called: what runs, who waits, and what became of callables."""

from __future__ import annotations

import logging
from collections.abc import Callable
from dataclasses import dataclass, field
from types import SimpleNamespace
from typing import Any

from hairpin import _native
from hairpin._errors import InputError

_LOG = logging.getLogger("hairpin")

Progress = Callable[[str, int, int], object]


@dataclass
class Brought:
    """Callables of this process, by the key that they stand for, and the file that stands there for whoever has not them."""

    score: Callable[[bytes], Any] | None = None
    target: Callable[[dict[str, Any]], Any] | None = None
    controller: Callable[[dict[str, Any]], Any] | None = None
    sets: list[tuple[str, str]] = field(default_factory=list)
    raised: list[BaseException] = field(default_factory=list)

    def code(self) -> _native.Code:
        return _native.Code(self.score, self.target, self.controller)

    def why(self, error: BaseException) -> BaseException:
        """``error``, with what a callable raised as its cause."""
        if self.raised and error.__cause__ is None:
            error.__cause__ = self.raised[0]
        return error


def waiting(threads: int | None = None, progress: Progress | None = None) -> Any:
    """Who waits: ``threads`` of the machine's, ``progress(what, done, of)`` some twenty times a second."""
    if threads is not None and threads < 1:
        raise InputError(f"`threads` = {threads}: must be at least 1", "threads", str(threads), "at least 1")
    return SimpleNamespace(threads=threads, progress=progress, warn=_LOG.warning)


def means(brought: Brought | None, portable: bool, allow_commands: bool) -> Any:
    """What runs, and by which kernels."""
    code = (brought or Brought()).code()
    return SimpleNamespace(portable=portable, allow_commands=allow_commands, code=code)


def replaces(if_there: str) -> bool:
    """Whether what is in a folder is replaced."""
    if if_there not in ("refuse", "replace"):
        bound = "refuse or replace"
        raise InputError(f"`if_there` = {if_there!r}: must be {bound}", "if_there", repr(if_there), bound)
    return if_there == "replace"
