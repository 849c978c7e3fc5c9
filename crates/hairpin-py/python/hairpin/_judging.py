"""Judging by a callable of this process: every run whose motion a folder keeps, and which are not there to judge."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from hairpin._asked import function, scalar, wrong
from hairpin._errors import InputError
from hairpin._labels import labels_of
from hairpin._many import takes_many
from hairpin._results import Case, Run
from hairpin._tables import Table

if TYPE_CHECKING:
    from hairpin._campaign import Campaign

_AT_ONCE = 256
"""Runs that a judge that takes many is asked with at most."""
_MARGIN = "a number, True or False, or None"
_ANSWERS = "a list, tuple, array (n,) or series of answers, one for each run"
_FAILED = "executor-failed"


@dataclass(frozen=True)
class Judged:
    """What a judge of this process says of a folder's runs.

    Attributes:
        margins: by case and run, ≥ 0 is within, ``None`` is open.
        failed: case and run of those that an executor or controller failed, of which there is nothing to judge.
        missing: case and run of those that are not there to judge: not executed, or their motion was not kept
            (``execute.record``).
    """

    margins: dict[tuple[str, int], float | None] = field(default_factory=dict)
    failed: tuple[tuple[str, int], ...] = ()
    missing: tuple[tuple[str, int], ...] = ()

    @property
    def failing(self) -> list[tuple[str, int]]:
        """Case and run of those that are not within, the worst first."""
        out = [(margin, key) for key, margin in self.margins.items() if margin is not None and not margin >= 0.0]
        return [key for _, key in sorted(out)]

    @property
    def exit_code(self) -> int:
        """0 all within; else the first that holds: 1 one is not, 4 an executor failed one, 5 one is open or missing."""
        if self.failing:
            return 1
        if self.failed:
            return 4
        return 5 if self._open or self.missing or not self.margins else 0

    @property
    def verdict(self) -> str:
        """A sentence: how many are not within, and how many were not judged."""
        out, within = len(self.failing), len(self.margins) - len(self.failing) - self._open
        of = len(self.margins) + len(self.failed) + len(self.missing)
        lost = len(self.failed)
        counts = {0: ("PASS", within), 1: ("FAIL", out), 4: ("EXECUTOR FAILED", lost), 5: ("INCONCLUSIVE", out)}
        start, count = counts[self.exit_code]
        rest = {
            "open": self._open,
            "failed by the executor, not counted": lost if self.exit_code == 1 else 0,
            "not there to judge (not executed, or not kept: execute.record)": len(self.missing),
        }
        return "; ".join([f"{start} {count}/{of} runs", *(f"{many} {what}" for what, many in rest.items() if many)])

    @property
    def _open(self) -> int:
        return sum(margin is None for margin in self.margins.values())

    def __bool__(self) -> bool:
        return self.exit_code == 0

    def __str__(self) -> str:
        return self.verdict


def judged_by(campaign: Campaign, judge: Callable[[Any], Any]) -> Judged:
    """Every run of a campaign's folder, judged by a callable."""
    function("judge", judge, "a function of a run")
    asked = judge if takes_many(judge) else lambda runs: [judge(run) for run in runs]
    found: dict[tuple[str, int], float | None] = {}
    failed: list[tuple[str, int]] = []
    missing: list[tuple[str, int]] = []
    runs = _runs(campaign, failed, missing)
    while block := list(itertools.islice(runs, _AT_ONCE)):
        answers = _listed(asked(block), len(block))
        found.update({(run.case.id, run.number): margin_of(answer) for run, answer in zip(block, answers, strict=True)})
    return Judged(found, tuple(failed), tuple(missing))


def _runs(campaign: Campaign, failed: list[tuple[str, int]], missing: list[tuple[str, int]]) -> Iterator[Run]:
    """Every run that is kept, read when it is asked for; the others go to those that failed, or that are missing."""
    repeat = campaign._facts["repeat"]
    for case in campaign.cases:
        ended, kept = _ended(campaign, case), _kept(campaign, case)
        if ended is None and kept is None:
            # It says which tables there are.
            campaign.table("executions")
        for run in sorted({*range(repeat), *(ended or ()), *(kept or ())}):
            if (ended or {}).get(run) == _FAILED:
                failed.append((case.id, run))
            elif run in (kept or ()):
                yield Run(case, run, campaign.execution(case.id, run))
            else:
                missing.append((case.id, run))


def _ended(campaign: Campaign, case: Case) -> dict[int, str] | None:
    """How the runs of a case ended; ``None`` where nothing was executed, and of folders older than that table."""
    try:
        rows = Table(campaign.folder, "runs", case=case.number).to_numpy()
    except InputError:
        return None
    return dict(zip(rows["run"].tolist(), rows["ended"].tolist(), strict=True))


def _kept(campaign: Campaign, case: Case) -> set[int] | None:
    """Runs of a case whose motion is there; ``None`` where none of the folder's is."""
    try:
        rows = Table(campaign.folder, "executions", case=case.number).to_numpy()
    except InputError:
        return None
    return set(rows["run"].tolist())


def margin_of(answer: Any) -> float | None:
    """What a judge said of a run as a margin: ``None``, NaN and masked are open; ``True`` is within, ``False`` is not.

    Raises:
        InputError: a word, an array, or what else is no number.
    """
    if answer is None or (isinstance(answer, np.ma.MaskedArray) and not answer.ndim and np.ma.is_masked(answer)):
        return None
    margin = scalar("margin", answer, _MARGIN)
    if isinstance(margin, bool):
        return 0.0 if margin else -1.0
    return None if np.isnan(margin) else margin


def _listed(answers: Any, runs: int) -> list[Any]:
    """Answers in the order of the runs: what has no order, or texts, are none."""
    if not isinstance(answers, list | tuple):
        if not hasattr(answers, "__array__"):
            raise wrong("judge", answers, _ANSWERS)
        labels = labels_of(answers)
        if labels is not None:
            # Sorted, say: whose answer is whose is told by labels of which the runs know nothing.
            raise wrong("judge.index", labels, "numbers that rise, in the order of the runs")
        answers = answers if isinstance(answers, np.ndarray) else np.asarray(answers)
        if answers.ndim != 1:
            raise wrong("judge", answers, _ANSWERS)
    if len(answers) != runs:
        told = f"{len(answers)} answers of {runs} runs"
        raise InputError(f"`judge`: {told}: must be one for each", "judge", told, "one for each run")
    return list(answers)
