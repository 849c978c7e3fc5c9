"""How every job is called: what runs, who waits, and what became of callables."""

from __future__ import annotations

import logging
import pickle
from collections.abc import Callable
from dataclasses import dataclass, field
from types import SimpleNamespace
from typing import Any

from hairpin import _native
from hairpin._asked import flag, function, whole, word, wrong
from hairpin._errors import ExecutorError

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
    flying: list[BaseException] = field(default_factory=list)
    """What an executor raised last."""
    executor: Callable[..., Any] | None = None
    served: str = ""
    """The name by which the executor is asked, which the folder's scenario has."""

    def __getstate__(self) -> dict[str, Any]:
        """An executor that is of this process alone stays in it: who has the copy cannot ask it."""
        try:
            pickle.dumps(self.executor)
        except (pickle.PicklingError, AttributeError, TypeError):
            return {**self.__dict__, "executor": None, "served": ""}
        return dict(self.__dict__)

    def code(self) -> _native.Code:
        return _native.Code(self.score, self.target, self.controller)

    def why(self, error: BaseException) -> BaseException:
        """``error``, with what a callable raised as its cause."""
        # Who fails runs may have failed many, and its last one is told; a search ends with the first that its score raises.
        causes = [*self.raised, *self.flying][::-1] if isinstance(error, ExecutorError) else self.raised
        if causes and error.__cause__ is None:
            error.__cause__ = causes[0]
        return error


def waiting(threads: int | None = None, progress: Progress | None = None) -> Any:
    """Who waits: ``threads`` of the machine's, ``progress(what, done, of)`` some twenty times a second."""
    if threads is not None:
        threads = whole("threads", threads, *_native.THREADS)
    if progress is not None:
        function("progress", progress, "a function of what, done, of")
    return SimpleNamespace(threads=threads, progress=progress, warn=_LOG.warning)


def means(brought: Brought | None, portable: bool, allow_commands: bool) -> Any:
    """What runs, and by which kernels."""
    code = (brought or Brought()).code()
    return SimpleNamespace(portable=flag("portable", portable), allow_commands=flag("allow_commands", allow_commands), code=code)


def replaces(if_there: str, out: Any) -> bool:
    """Whether what is in the folder ``out`` is replaced."""
    replace = word("if_there", if_there, ("refuse", "replace")) == "replace"
    if replace and out is None:
        raise wrong("if_there", if_there, "given with `out` alone")
    return replace
