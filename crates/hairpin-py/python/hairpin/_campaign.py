"""A campaign's folder as an object: verdict, cases, tables, report, and the jobs that go on from it."""

from __future__ import annotations

import html
import os
from collections.abc import Callable, Iterator, Mapping
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np

from hairpin import _native
from hairpin._asked import place, place_or_none, seconds, whole, wrong
from hairpin._bridge import serving_again
from hairpin._call import Brought, Progress, means, waiting
from hairpin._errors import InputError
from hairpin._judging import Judged, judged_by
from hairpin._picture import picture
from hairpin._results import Case, Comparison, Floats, Report, Shrunk, Verification, Violation
from hairpin._same import same
from hairpin._scenario import sets_of
from hairpin._tables import Table


class Campaign:
    """A campaign's folder. Its cases are those that the folder had when it was opened; tables, pages and jobs read it anew.

    Args:
        folder: a campaign folder.

    Raises:
        InputError: there is no campaign in it, or it is broken.
    """

    def __init__(
        self, folder: str | os.PathLike[str], *, brought: Brought | None = None, said: Mapping[str, Any] | None = None
    ) -> None:
        self.folder = Path(place("folder", folder))
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
        return next(iter(self._worst_first), None)

    @property
    def failing(self) -> tuple[Case, ...]:
        """Cases that violate, the worst first, as the command orders them: by the largest share of a limit that is broken."""
        return tuple(case for case in self._worst_first if case.status == "fail")

    @cached_property
    def _worst_first(self) -> tuple[Case, ...]:
        """All cases in the order of the command's tables; behind them those that are not judged, by number."""
        places = {number: place for place, number in enumerate(self._facts["worst_first"])}
        return tuple(sorted(self.cases, key=lambda case: (places.get(case.number, len(places)), case.number)))

    def __len__(self) -> int:
        return len(self.cases)

    def __iter__(self) -> Iterator[Case]:
        return iter(self.cases)

    def __getitem__(self, case: str | int) -> Case:
        """A case by its id or number."""
        for one in self.cases:
            if one.id == case or one.number == case:
                return one
        raise wrong("case", case, f"one of {len(self)} cases from 0000")

    def __repr__(self) -> str:
        return f"Campaign({str(self.folder)!r}: {self.verdict or f'{len(self)} cases'})"

    def __eq__(self, other: object) -> bool:
        if other.__class__ is not self.__class__ or not isinstance(other, Campaign):
            return NotImplemented
        return self.folder == other.folder and same(self._said, other._said) and same(self._facts, other._facts)

    def __hash__(self) -> int:
        return hash(self.folder)

    # Tables.

    def table(self, name: str = "results", *, case: str | int | None = None, run: int | None = None) -> Table:
        """A table of the folder: ``results``, ``waypoints``, ``executions``, ``trajectories``, ``profiles``, …, whole or of a case or
        a run of it alone, as a :class:`Table`, which Polars, DuckDB and whatever else reads Arrow take. Columns: docs/folder.md.

        Raises:
            InputError: there is no such table, case or run; a run that is there without rows, as one that failed, has none.
        """
        number = None if case is None else self[case].number
        found = Table(self.folder, name, case=number, run=run)
        if run is not None and name in ("executions", "runs") and not len(found.to_numpy()["run"]):
            self._check_run(number, run)
        return found

    def _check_run(self, case: int | None, run: int) -> None:
        """Whether there is such a run, of the case or of any."""
        try:
            there = set(Table(self.folder, "runs", case=case).to_numpy()["run"].tolist())
        except InputError:
            # Folders from before there was that table.
            there = set(Table(self.folder, "executions", case=case).to_numpy()["run"].tolist())
        if run not in there:
            of = "" if case is None else f" of case {self[case].id}"
            known = ", ".join(str(one) for one in sorted(there)[:10]) + (", …" if len(there) > 10 else "")
            raise wrong("run", run, f"one that is there{of}: {known or 'none'}")

    def to_arrow(self, table: str = "results", filters: Any = None) -> Any:
        """The same as a ``pyarrow.Table``. Needs pyarrow.

        ``filters`` are as of ``pyarrow.parquet.read_table``: ``[("case", "==", "0001")]`` gives that case alone.
        """
        rows = self.table(table)
        try:
            import pyarrow
            import pyarrow.parquet as parquet
        except ImportError as error:
            raise ImportError("pyarrow's tables need pyarrow: pip install hairpin[arrow]; table() does not") from error
        whole = pyarrow.table(rows)
        return whole if filters is None else whole.filter(parquet.filters_to_expression(filters))

    def to_pandas(self, table: str = "results") -> Any:
        """The same as a ``pandas.DataFrame``. Needs pandas."""
        import pandas

        return pandas.DataFrame(self.table(table).to_numpy())

    def to_polars(self, table: str = "results") -> Any:
        """The same as a ``polars.DataFrame``. Needs polars."""
        import polars

        return polars.DataFrame(self.table(table))

    def execution(self, case: str | int, run: int | None = None) -> dict[str, Floats]:
        """What was executed: columns of `executions` by name, shape (n,); of the worst run if none is named.

        Rows are those where the motion bends, as the folder keeps them.
        """
        one = self[case]
        wanted = whole("run", (one.run or 0) if run is None else run, 0)
        rows = Table(self.folder, "executions", case=one.number, run=wanted).to_numpy()
        if run is not None and not len(rows["run"]):
            self._check_run(one.number, wanted)
        numbers = {name: values for name, values in rows.items() if values.dtype != object and name not in ("case", "run")}
        return {name: np.asarray(values, dtype=np.float64) for name, values in numbers.items()}

    # Jobs that go on from here.

    def execute(self, **settings: Any) -> Campaign:
        """Executes its cases; keywords as of :func:`hairpin.execute`."""
        from hairpin._jobs import execute

        return execute(self, **settings)

    def judge(
        self, values: Mapping[str, Any] | None = None, *, threads: int | None = None, progress: Progress | None = None
    ) -> Campaign:
        """Judges what was executed, with other values for keys of `spec`; see :func:`hairpin.judge`."""
        said = _native.judge(self.folder, sets_of(values), waiting(threads, progress))
        return Campaign(self.folder, brought=self._brought, said=said)

    def judge_by(self, judge: Callable[[Any], Any]) -> Judged:
        """Judges every run that the folder keeps by a callable of this process, beside the folder's own verdict, which stays.

        Args:
            judge: of a :class:`Run` gives whether it is within what is asked, or by how much (≥ 0 is within); ``None`` and NaN are open.
                With :func:`vectorised` it gets a list of runs, 256 at most, and gives as many answers.

        Raises:
            InputError: an answer is a word, a list, or what else is no number; a vectorised judge gave what is no list,
                tuple, array (n,) or series, or more or fewer answers than it was asked for.

        Runs that an executor failed (exit code 4), that were not executed, or whose motion was not kept (5) are not
        judged, and are told beside the margins. Nothing is written.
        """
        # Runs are those that are there now, and so are their cases.
        return judged_by(Campaign(self.folder), judge)

    def verify(self, *, threads: int | None = None, progress: Progress | None = None) -> Verification:
        """Integrates every witness by independent code; see :func:`hairpin.verify`."""
        found = _native.verify(self.folder, waiting(threads, progress))
        edited = tuple(found["edited"])
        return Verification(found["checked"], found["failed"], found["worst"], found["exit_code"], found["nothing"], edited)

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
        effort = (whole("budget", budget, 1), seconds("time_limit_s", time_limit_s), place_or_none("out", out))
        try:
            with serving_again(self._brought):
                found = _native.shrink(
                    (self.folder, one.number),
                    effort,
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

    def compare(self, other: Campaign | str | os.PathLike[str], *, tolerance_m: float = 1e-6) -> Comparison:
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
        height = whole("height", height, 1)
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
        except InputError:
            flown = {}
        if len(flown.get("x_m", ())):
            axes.plot(flown["x_m"], flown["y_m"], color="#0072b2", label=f"case {one.id}, run {one.run}")
        axes.set(xlabel="x (m)", ylabel="y (m)", aspect="equal", title=_told(one))
        axes.legend()
        return axes

    def _repr_html_(self) -> str:
        rows = self._worst_first[:5]
        cells = "".join(
            f"<tr><td>{one.id}</td><td>{html.escape(one.status)}</td><td>{_metres(one.max_deviation_m)}</td>"
            f"<td>{_metres(one.t_worst_s)}</td><td>{len(one.waypoints_m)}</td><td>{html.escape(one.evidence)}</td></tr>"
            for one in rows
        )
        head = "".join(f"<th>{name}</th>" for name in ("case", "status", "max deviation (m)", "t (s)", "waypoints", "evidence"))
        told = html.escape(self.verdict or f"{len(self)} cases in {self.folder}")
        drawn = self._picture(rows[0]) if rows else ""
        return f"<div><p>{told}</p><div style='display:flex;gap:1em'><table><tr>{head}</tr>{cells}</table>{drawn}</div></div>"

    def _picture(self, one: Case) -> str:
        """The worst run of a case, as far as its motion was kept."""
        try:
            flown = self.execution(one.id)
        except InputError:
            flown = {}
        at, deviation = one.t_worst_s, one.max_deviation_m
        worst = None if at is None or deviation is None else (at, deviation)
        return picture(f"case {one.id}", one.waypoints_m, flown, worst)


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


def _metres(value: float | None) -> str:
    return "–" if value is None else f"{value:.3f}"


def _told(one: Case) -> str:
    return f"{one.id}: {one.violations[0].told}" if one.violations else f"{one.id}: {one.status}"
