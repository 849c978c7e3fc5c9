"""What jobs come to, as plain objects."""

from __future__ import annotations

import html
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from hairpin._same import Same

Floats = npt.NDArray[np.float64]

_DATA = '<script type="application/json" id="data">'


@dataclass(frozen=True)
class Violation:
    """A limit that a run breaks: what, the value, the limit (both in the limit's unit), and all of it in words."""

    what: str
    value: float
    limit: float
    told: str


@dataclass(frozen=True, eq=False)
class Case(Same):
    """A case and, once judged, its worst run.

    Attributes:
        id: ``0000`` and on.
        seed: its own.
        waypoints_m: shape (n, 3), m, world frame, both ends included.
        evidence: ``witnessed``, ``hull-feasible``, ``unchecked``, …, as truth has it.
        score: of the search.
        status: ``pass``, ``fail``, ``inconclusive``, ``executor-failed``, ``unjudged``, or ``generated``.
        run: number of the worst run.
        ended: why that ended.
        max_deviation_m, mean_deviation_m: from the reference, m.
        t_worst_s: time of the largest deviation.
        leg_worst: leg of it, from 0.
        violations: the gravest first.
        message: why it was not carried out.
    """

    id: str
    seed: int
    waypoints_m: Floats
    evidence: str
    score: float
    status: str
    run: int | None
    ended: str | None
    max_deviation_m: float | None
    mean_deviation_m: float | None
    t_worst_s: float | None
    leg_worst: int | None
    violations: tuple[Violation, ...]
    message: str | None

    @property
    def number(self) -> int:
        return int(self.id)


@dataclass(frozen=True, eq=False)
class Shrunk(Same):
    """A case reduced to the shortest feasible one that still violates.

    Attributes:
        case: its id.
        waypoints_before_m, waypoints_m: shape (n, 3), m.
        violations_before, violations: sentences, the gravest first.
        evidence: of the smaller case.
        simplified: what else was taken away.
        finished: nothing smaller was found within the budget; else the same call goes on.
        runs: executions in all.
        repro: file that `hairpin replay` runs.
    """

    case: str
    waypoints_before_m: Floats
    waypoints_m: Floats
    violations_before: tuple[str, ...]
    violations: tuple[str, ...]
    evidence: str
    simplified: tuple[str, ...]
    finished: bool
    runs: int
    repro: Path

    def __str__(self) -> str:
        still = self.violations[0] if self.violations else ""
        rest = "" if self.finished else "; stopped, the same call goes on"
        return f"{len(self.waypoints_before_m)} waypoints -> {len(self.waypoints_m)}, still {still} ({self.runs} runs){rest}"

    __repr__ = __str__


@dataclass(frozen=True, eq=False)
class Run(Same):
    """A run as a judge of this process sees it: its case, its number, and columns of `executions`, shape (n,)."""

    case: Case
    number: int
    columns: dict[str, Floats]

    @property
    def t_s(self) -> Floats:
        """Stamps, shape (n,)."""
        return self.columns["t_s"]

    @property
    def p_m(self) -> Floats:
        """Places, shape (n, 3), m, world frame."""
        return np.stack([self.columns[name] for name in ("x_m", "y_m", "z_m")], axis=1)


@dataclass(frozen=True)
class Verification:
    """What independent integration came to: cases checked, those of which something does not hold, the worst of them.

    Attributes:
        nothing: why there was nothing to verify; ``None`` where something was. The exit code is 0 all the same, as the command's is.
        edited: what of the folder's `scenario.toml` was changed since the campaign was made: what is proven is of what it is now.
    """

    checked: int
    failed: int
    worst: dict[str, Any] | None
    exit_code: int
    nothing: str | None = None
    edited: tuple[str, ...] = ()

    def __bool__(self) -> bool:
        return self.exit_code == 0 and self.nothing is None


@dataclass(frozen=True)
class Comparison:
    """Two campaigns paired by case and seed.

    Attributes:
        verdict: a sentence.
        newly_failing, newly_passing: case ids.
        regression: whether a metric is worse.
        inconclusive: no pair could be compared.
        detail: all that `compare --json` says.
    """

    verdict: str
    newly_failing: tuple[str, ...]
    newly_passing: tuple[str, ...]
    regression: bool
    inconclusive: bool
    detail: dict[str, Any]

    def __bool__(self) -> bool:
        return not self.newly_failing and not self.inconclusive


@dataclass(frozen=True)
class Report:
    """A report as a cell of a notebook shows it, without a server."""

    path: Path
    case: str | None
    height: int

    def _repr_html_(self) -> str:
        text = self.path.read_text(encoding="utf-8")
        if self.case is not None:
            # The page's data are no script, so that its policy holds.
            text = text.replace(_DATA + "{", f'{_DATA}{{"asked":"{self.case}",', 1)
        page = html.escape(text, quote=True)
        name = f"case {self.case}" if self.case else "report"
        return f'<iframe title="{name}" sandbox="allow-scripts" style="width:100%;height:{self.height}px;border:0" srcdoc="{page}"></iframe>'
