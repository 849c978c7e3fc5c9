"""A campaign's folder as an object: verdict, cases, tables, report, and the jobs that go on from it."""

from __future__ import annotations

import html
import os
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from hairpin import _native
from hairpin._call import Brought, Progress, means, waiting
from hairpin._errors import InputError
from hairpin._scenario import sets_of

Floats = npt.NDArray[np.float64]

_DATA = '<script type="application/json" id="data">'
_ORDER = {"executor-failed": 0, "fail": 1, "inconclusive": 2, "pass": 3, "unjudged": 4, "generated": 5}


@dataclass(frozen=True)
class Violation:
    """A limit that a run breaks: what, the value, the limit (both in the limit's unit), and all of it in words."""

    what: str
    value: float
    limit: float
    told: str


@dataclass(frozen=True)
class Case:
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


@dataclass(frozen=True)
class Shrunk:
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


class Campaign:
    """A campaign's folder. What it shows is what the folder has.

    Args:
        folder: a campaign folder.

    Raises:
        InputError: there is no campaign in it, or it is broken.
    """

    def __init__(
        self, folder: str | os.PathLike[str], *, brought: Brought | None = None, said: Mapping[str, Any] | None = None
    ) -> None:
        self.folder = Path(folder)
        self._brought = brought
        self._said = dict(said or {})
        self._facts: dict[str, Any] = _native.read(self.folder)

    @property
    def verdict(self) -> str | None:
        """The verdict's sentence; ``None`` where this object has not judged it."""
        return self._said.get("verdict")

    @property
    def exit_code(self) -> int | None:
        """What the command would exit with: 0 within spec, 1 violation, 3 nothing feasible, 4 executor failed, 5 inconclusive."""
        return self._said.get("exit_code")

    @property
    def summary(self) -> dict[str, Any]:
        """The object that `--json` gives: verdict, counts, share, baseline, worst, …"""
        return self._said

    @property
    def robot(self) -> str:
        """Name of the robot."""
        return str(self._facts["robot"])

    @property
    def controller(self) -> str | None:
        """Word of the controller that executes; ``None`` where a program does."""
        return self._facts["controller"]

    @cached_property
    def cases(self) -> tuple[Case, ...]:
        """All cases, by number."""
        return tuple(_case(one) for one in self._facts["cases"])

    @property
    def worst(self) -> Case | None:
        """The worst case, as the command orders them; ``None`` without any."""
        return min(self.cases, key=_badness, default=None)

    @property
    def failing(self) -> tuple[Case, ...]:
        """Cases that violate, the worst first."""
        return tuple(sorted((case for case in self.cases if case.status == "fail"), key=_badness))

    def __len__(self) -> int:
        return len(self.cases)

    def __iter__(self) -> Iterator[Case]:
        return iter(self.cases)

    def __getitem__(self, case: str | int) -> Case:
        """A case by its id or number."""
        for one in self.cases:
            if one.id == case or one.number == case:
                return one
        raise InputError(
            f"`case` = {case!r}: must be one of {len(self)} cases from 0000", "case", repr(case), f"one of {len(self)} cases"
        )

    def __repr__(self) -> str:
        return f"Campaign({str(self.folder)!r}: {self.verdict or f'{len(self)} cases'})"

    # Tables.

    def to_arrow(self, table: str = "results", filters: Any = None) -> Any:
        """A table of the folder as a ``pyarrow.Table``: ``results``, ``waypoints``, ``executions``, ``trajectories``, ``profiles``, ….

        ``filters`` are as of ``pyarrow.parquet.read_table``: ``[("case", "==", "0001")]`` reads that case alone. Columns:
        docs/folder.md. Needs pyarrow.
        """
        try:
            import pyarrow.parquet as parquet
        except ImportError as error:
            raise ImportError("tables need pyarrow: pip install hairpin[arrow]") from error
        for place in (self.folder / f"{table}.parquet", self.folder / table):
            if place.exists():
                return parquet.read_table(place, filters=filters)
        there = sorted(
            {path.name for path in self.folder.iterdir() if any(path.glob("*.parquet"))}
            | {path.stem for path in self.folder.glob("*.parquet")}
        )
        raise InputError(f"`table` = {table!r}: must be one of {', '.join(there)}", "table", repr(table), ", ".join(there))

    def to_pandas(self, table: str = "results") -> Any:
        """The same as a ``pandas.DataFrame``. Needs pyarrow and pandas."""
        return self.to_arrow(table).to_pandas()

    def to_polars(self, table: str = "results") -> Any:
        """The same as a ``polars.DataFrame``. Needs pyarrow and polars."""
        import polars

        return polars.from_arrow(self.to_arrow(table))

    def execution(self, case: str | int, run: int | None = None) -> dict[str, Floats]:
        """What was executed: columns of `executions` by name, shape (n,); of the worst run if none is named. Needs pyarrow.

        Rows are those where the motion bends, as the folder keeps them.
        """
        one = self[case]
        wanted = (one.run if run is None else run) or 0
        rows = self.to_arrow("executions", filters=[("case", "==", one.id), ("run", "==", wanted)])
        return {
            name: np.asarray(rows[name].to_numpy(), dtype=np.float64)
            for name in rows.column_names
            if name not in ("case", "run")
            and not str(rows.schema.field(name).type).startswith(("string", "large_string", "dictionary"))
        }

    # Jobs that go on from here.

    def execute(
        self,
        *,
        values: Mapping[str, Any] | None = None,
        controller: Any = None,
        executor: Any = None,
        missions: str | os.PathLike[str] | None = None,
        out: str | os.PathLike[str] | None = None,
        if_there: str = "refuse",
        resume: bool = False,
        portable: bool = False,
        allow_commands: bool = False,
        threads: int | None = None,
        progress: Progress | None = None,
    ) -> Campaign:
        """Executes its cases; see :func:`hairpin.execute`."""
        from hairpin._jobs import execute

        return execute(
            self,
            values=values,
            controller=controller,
            executor=executor,
            missions=missions,
            out=out,
            if_there=if_there,
            resume=resume,
            portable=portable,
            allow_commands=allow_commands,
            threads=threads,
            progress=progress,
        )

    def judge(
        self, values: Mapping[str, Any] | None = None, *, threads: int | None = None, progress: Progress | None = None
    ) -> Campaign:
        """Judges what was executed, with other values for keys of `spec`; see :func:`hairpin.judge`."""
        said = _native.judge(self.folder, sets_of(values), waiting(threads, progress))
        return Campaign(self.folder, brought=self._brought, said=said)

    def judge_by(self, judge: Callable[[Run], float | bool | None]) -> Judged:
        """Judges every run that the folder keeps by a callable of this process, beside the folder's own verdict, which stays.

        Args:
            judge: of a :class:`Run` gives whether it is within what is asked, or by how much (≥ 0 is within), or ``None``: open.

        Needs pyarrow. Nothing is written.
        """
        found: dict[tuple[str, int], float | None] = {}
        for case in self.cases:
            runs = self.to_arrow("executions", filters=[("case", "==", case.id)])["run"].unique().to_pylist()
            for run in sorted(runs):
                answer = judge(Run(case, run, self.execution(case.id, run)))
                found[case.id, run] = (
                    None
                    if answer is None
                    else (float(answer) if not isinstance(answer, bool | np.bool_) else (0.0 if answer else -1.0))
                )
        return Judged(found)

    def verify(self, *, threads: int | None = None, progress: Progress | None = None) -> Verification:
        """Integrates every witness by independent code; see :func:`hairpin.verify`."""
        found = _native.verify(self.folder, waiting(threads, progress))
        return Verification(found["checked"], found["failed"], found["worst"], found["exit_code"])

    def shrink(
        self,
        case: str | int | Case | None = None,
        *,
        budget: int = 200,
        time_limit_s: float | None = None,
        out: str | os.PathLike[str] | None = None,
        portable: bool = False,
        allow_commands: bool = False,
        threads: int | None = None,
        progress: Progress | None = None,
    ) -> Shrunk:
        """Reduces a violating case, the worst if none is named; see :func:`hairpin.shrink`."""
        one = case if isinstance(case, Case) else (self[case] if case is not None else next(iter(self.failing), None))
        if one is None:
            raise InputError("`case`: no case violates, there is nothing to shrink", "case", "", "a case that violates")
        try:
            found = _native.shrink(
                (self.folder, one.number),
                (budget, time_limit_s, None if out is None else os.fspath(out)),
                means(self._brought, portable, allow_commands),
                waiting(threads, progress),
            )
        except Exception as error:
            raise (self._brought.why(error) if self._brought else error)
        return Shrunk(
            case=found["case"],
            waypoints_before_m=np.asarray(found["waypoints_before_m"], dtype=np.float64),
            waypoints_m=np.asarray(found["waypoints_m"], dtype=np.float64),
            violations_before=tuple(found["violations_before"]),
            violations=tuple(found["violations"]),
            evidence=found["evidence"],
            simplified=tuple(found["simplified"]),
            finished=found["finished"],
            runs=found["runs"],
            repro=Path(found["repro"]),
        )

    def compare(self, other: Campaign | str | os.PathLike[str], *, tolerance_m: float = 0.0) -> Comparison:
        """This campaign before, `other` after; see :func:`hairpin.compare`."""
        from hairpin._jobs import compare

        return compare(self, other, tolerance_m=tolerance_m)

    def report(self, *cases: str | int | Case) -> Path:
        """Writes ``report.html`` anew, and gives its place; `cases` are among those that open, and it opens at the first."""
        asked = [(one if isinstance(one, Case) else self[one]).number for one in cases]
        return Path(_native.report(self.folder, asked, waiting()))

    # In a notebook.

    def show(self, case: str | int | Case | None = None, *, height: int = 720) -> Report:
        """The report as a cell shows it, opened at a case; of the worst if none is named."""
        path = self.folder / "report.html"
        if not path.is_file():
            path = self.report()
        one = case if isinstance(case, Case) else (self[case] if case is not None else self.worst)
        if one and f'"id":"{one.id}"' not in path.read_text(encoding="utf-8"):
            self.report(one)
        return Report(path, one.id if one else None, height)

    def plot(self, case: str | int | Case | None = None, ax: Any = None) -> Any:
        """Draws the waypoints and what was executed, from above, with matplotlib; the worst case if none is named."""
        try:
            import matplotlib.pyplot as pyplot
        except ImportError as error:
            raise ImportError("plots need matplotlib: pip install hairpin[plot]") from error
        one = case if isinstance(case, Case) else (self[case] if case is not None else self.worst)
        if one is None:
            raise InputError("`case`: the campaign has none", "case", "", "a case")
        axes = ax if ax is not None else pyplot.figure().add_subplot()
        axes.plot(*one.waypoints_m[:, :2].T, "o--", color="#999999", label="waypoints")
        try:
            flown = self.execution(one.id)
        except (ImportError, InputError):
            flown = {}
        if len(flown.get("x_m", ())):
            axes.plot(flown["x_m"], flown["y_m"], color="#0072b2", label=f"case {one.id}, run {one.run}")
        axes.set(xlabel="x (m)", ylabel="y (m)", aspect="equal", title=_told(one))
        axes.legend()
        return axes

    def _repr_html_(self) -> str:
        rows = sorted(self.cases, key=_badness)[:5]
        cells = "".join(
            f"<tr><td>{one.id}</td><td>{html.escape(one.status)}</td><td>{_metres(one.max_deviation_m)}</td>"
            f"<td>{_metres(one.t_worst_s)}</td><td>{len(one.waypoints_m)}</td><td>{html.escape(one.evidence)}</td></tr>"
            for one in rows
        )
        head = "".join(f"<th>{name}</th>" for name in ("case", "status", "max deviation (m)", "t (s)", "waypoints", "evidence"))
        told = html.escape(self.verdict or f"{len(self)} cases in {self.folder}")
        picture = _picture(rows[0]) if rows else ""
        return f"<div><p>{told}</p><div style='display:flex;gap:1em'><table><tr>{head}</tr>{cells}</table>{picture}</div></div>"


@dataclass(frozen=True)
class Run:
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
class Judged:
    """What a judge of this process says: margins by case and run, ≥ 0 is within, ``None`` is open."""

    margins: dict[tuple[str, int], float | None] = field(default_factory=dict)

    @property
    def failing(self) -> list[tuple[str, int]]:
        """Case and run of those that are not within, the worst first."""
        out = [(margin, key) for key, margin in self.margins.items() if margin is not None and not margin >= 0.0]
        return [key for _, key in sorted(out)]

    @property
    def exit_code(self) -> int:
        """0 all within, 1 one is not, 5 one is open."""
        return 1 if self.failing else (5 if any(margin is None for margin in self.margins.values()) or not self.margins else 0)

    def __bool__(self) -> bool:
        return self.exit_code == 0


@dataclass(frozen=True)
class Verification:
    """What independent integration came to: cases checked, those of which something does not hold, the worst of them."""

    checked: int
    failed: int
    worst: dict[str, Any] | None
    exit_code: int

    def __bool__(self) -> bool:
        return self.exit_code == 0


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


def _case(one: Mapping[str, Any]) -> Case:
    violations = tuple(Violation(found["what"], found["value"], found["limit"], found["told"]) for found in one["violations"])
    waypoints = np.asarray(one["waypoints_m"], dtype=np.float64).reshape(-1, 3)
    names = (
        "seed",
        "evidence",
        "score",
        "status",
        "run",
        "ended",
        "max_deviation_m",
        "mean_deviation_m",
        "t_worst_s",
        "leg_worst",
        "message",
    )
    return Case(id=one["case"], waypoints_m=waypoints, violations=violations, **{name: one[name] for name in names})


def _badness(one: Case) -> tuple[int, float, int]:
    deviation = one.max_deviation_m if one.max_deviation_m is not None else -1.0
    return (_ORDER.get(one.status, 9), -deviation, one.number)


def _metres(value: float | None) -> str:
    return "–" if value is None else f"{value:.3f}"


def _told(one: Case) -> str:
    return f"{one.id}: {one.violations[0].told}" if one.violations else f"{one.id}: {one.status}"


def _picture(one: Case, size: int = 160) -> str:
    """The case's waypoints from above."""
    if not len(one.waypoints_m):
        return ""
    plane = one.waypoints_m[:, :2]
    low, high = plane.min(axis=0), plane.max(axis=0)
    scale = (size - 20) / max(float((high - low).max()), 1e-9)
    points = (plane - low) * scale + 10.0
    points[:, 1] = size - points[:, 1]
    line = " ".join(f"{x:.1f},{y:.1f}" for x, y in points)
    dots = "".join(f'<circle cx="{x:.1f}" cy="{y:.1f}" r="2.5" fill="#0072b2"/>' for x, y in points)
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{size}" height="{size}" role="img" aria-label="case {one.id} from above">'
        f'<polyline points="{line}" fill="none" stroke="#0072b2" stroke-width="1.2"/>{dots}</svg>'
    )
