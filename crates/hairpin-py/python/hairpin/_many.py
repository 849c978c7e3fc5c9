"""What takes many at once: the mark of it, and how missions that are under way become one question."""

from __future__ import annotations

import threading
from collections.abc import Callable, Mapping
from typing import Any, TypeVar

from hairpin._asked import wrong

AT_ONCE = 16
"""Missions that an executor that takes many is asked with at most, where nothing else is said."""
_SETTLED_S = 0.005
"""A question is asked once no further mission has come for so long: those that were answered together come together."""

_Marked = TypeVar("_Marked", bound=Callable[..., Any])


def vectorised(function: _Marked) -> _Marked:
    """Marks what takes many at once: a score, a controller, an executor or a judge; of many it gives as many answers.

    A score gets all legs as a dictionary of arrays, numbers (n,) and places (n, 3), and gives (n,) or (n, 2): the second column is
    what a leg leaves to the next (docs/stress.md). A controller gets all runs that are under way: the same keys as of one, with a row
    for each run (docs/own-controllers.md). An executor gets a list of missions, the derivative of :func:`dynamics` and the step of
    :func:`adversary` rows of states, a judge a list of runs.

    >>> @vectorised
    ... def score(legs):
    ...     return legs["v_in_m_s"] * legs["turn_rad"]
    """
    try:
        function.hairpin_vectorised = True  # type: ignore[attr-defined]
    except AttributeError:
        raise wrong("function", function, "a function, or an object that takes attributes") from None
    return function


def takes_many(given: Any) -> bool:
    """Whether it is marked by :func:`vectorised`."""
    return bool(getattr(given, "hairpin_vectorised", False))


class Together:
    """An executor that takes many, asked mission by mission from several threads.

    Whoever comes while none is under way waits until no more come, and asks for all; what comes meanwhile is the next question.
    """

    def __init__(self, executor: Callable[[list[dict[str, Any]]], Any]) -> None:
        self._executor = executor
        self._turn = threading.Lock()
        self._come = threading.Condition()
        self._waiting: list[_Mission] = []

    def __call__(self, mission: dict[str, Any]) -> Mapping[str, Any]:
        mine = _Mission(mission)
        with self._come:
            self._waiting.append(mine)
            self._come.notify_all()
        with self._turn:
            if mine.answer is None:
                self._ask(self._settled())
        if isinstance(mine.answer, Mapping):
            return mine.answer
        raise mine.answer or RuntimeError("the executor gave no flight")

    def _settled(self) -> list[_Mission]:
        """All that wait, once no more come."""
        with self._come:
            while self._come.wait(_SETTLED_S):
                pass
            asked, self._waiting = self._waiting, []
        return asked

    def _ask(self, asked: list[_Mission]) -> None:
        try:
            answers = list(self._executor([one.mission for one in asked]))
            if len(answers) != len(asked):
                raise ValueError(f"{len(answers)} flights of {len(asked)} missions")
        except BaseException as error:  # `sys.exit` too: who waits for an answer must have one.
            if len(asked) == 1:
                asked[0].answer = error
                return
            # One that cannot be carried out is found by itself, and costs no other.
            for one in asked:
                self._ask([one])
            return
        for one, answer in zip(asked, answers, strict=True):
            one.answer = answer if isinstance(answer, Mapping) else TypeError(f"{answer!r} is no dictionary, of the executor")


class _Mission:
    """A mission, and once it was asked its flight or why there is none."""

    def __init__(self, mission: dict[str, Any]) -> None:
        self.mission = mission
        self.answer: Mapping[str, Any] | BaseException | None = None
