"""Boundary-value drives of ground vehicles: one, or as many as an array has rows, in one call."""

from __future__ import annotations

import operator
import os
from collections.abc import Iterator
from dataclasses import dataclass, field
from types import SimpleNamespace
from typing import Any, overload

import numpy as np
import numpy.typing as npt

from hairpin import _native
from hairpin._asked import Floats, flag, floats, place_or_none, real, vector, wrong
from hairpin._call import Progress, waiting
from hairpin._errors import InputError
from hairpin._labels import floats_by_name, row_by_name
from hairpin._same import Same, same
from hairpin._scenario import Robot, described

STATUSES = ("ok", "infeasible", "not_converged", "time_limit", "invalid")
"""What comes of a question, as the command has it; `status_code` of many counts them from 0."""

_KINDS = ("arc", "turn")
_COLUMNS = ("x", "y", "yaw", "k0", "kf")
_ON_MAP = ("sx", "sy", "syaw", *_COLUMNS)


class Curvature(np.ndarray):
    """Curvature along a drive: coefficients, shape (segments, 6), 1/m^(i+1) of s^i, s from 0 in each segment; called with the
    way from the drive's start in m it gives 1/m, NaN beyond the drive's end.

    >>> import hairpin
    >>> drive = hairpin.steer("generic", x=2.0, y=0.0, yaw=0.0)
    >>> drive.curvature.shape, float(drive.curvature(1.0))
    ((1, 6), 0.0)
    """

    lengths: Floats

    def __array_finalize__(self, other: Any) -> None:
        self.lengths = getattr(other, "lengths", np.empty(0))

    def __getitem__(self, key: Any) -> Any:
        # A part of the numbers is no drive's curvature: it knows not where it begins.
        return np.asarray(self)[key]

    def __reduce__(self) -> tuple[Any, ...]:
        return _curvature, (np.array(self), self.lengths)

    def __reduce_ex__(self, protocol: Any) -> tuple[Any, ...]:
        return self.__reduce__()

    def __call__(self, s_m: npt.ArrayLike) -> Any:
        if self.shape != (len(self.lengths), 6):
            raise TypeError(f"coefficients of shape {self.shape} are no drive's of {len(self.lengths)} segments")
        way = floats("s_m", s_m, "numbers, m")
        ends = np.cumsum(self.lengths)
        place = np.minimum(np.searchsorted(ends, way, side="left"), max(len(ends) - 1, 0))
        outside = (way < 0.0) | (len(ends) == 0) | (way > (ends[-1] if len(ends) else 0.0) + 1e-12)
        if not len(ends):
            return np.full(way.shape, np.nan)
        local = way - np.concatenate([[0.0], ends])[place]
        rows = np.asarray(self)[place]
        found = sum(rows[..., power] * local**power for power in range(6))
        return np.where(outside, np.nan, found)


def _curvature(coefficients: Floats, lengths: Floats) -> Curvature:
    made = coefficients.view(Curvature)
    made.lengths = lengths
    return made


@dataclass(frozen=True, eq=False)
class Segment(Same):
    """A piece of a drive.

    Attributes:
        kind: ``arc`` or ``turn`` (in place).
        direction: 1 forward, -1 in reverse, 0 of a turn.
        length_m: m, 0 of a turn.
        turn_rad: angle turned in place, rad, left positive; 0 of an arc.
        curvature: six coefficients, 1/m^(i+1) of s^i, left positive.
    """

    kind: str
    direction: int
    length_m: float
    turn_rad: float
    curvature: Floats


@dataclass(frozen=True, eq=False)
class Drive(Same):
    """The answer to one question.

    Attributes:
        status: one of ``ok``, ``infeasible``, ``not_converged``, ``time_limit``.
        length_m: length of the way, m; NaN without a drive.
        curvature: coefficients, shape (segments, 6), and callable, see :class:`Curvature`.
        segments: its pieces.
        limit: the limit that stands in the way (``curvature_1_m``, …) or ``None``.
        excess: what it is exceeded by, in its unit; NaN where that is no number.
        errors: x (m), y (m), yaw (rad) and curvature (1/m) by which an integration of its own misses the goal, shape (4,).
        max_curvature_1_m: largest |curvature|, 1/m.
        iterations: steps of the solver.
        time_us: what solving alone took, µs.
    """

    status: str
    length_m: float
    curvature: Curvature
    segments: tuple[Segment, ...]
    limit: str | None
    excess: float
    errors: Floats
    max_curvature_1_m: float
    iterations: int
    time_us: float = field(compare=False)

    def __bool__(self) -> bool:
        return self.status == "ok"


class Drives:
    """The answers to n questions, as arrays; ``drives[i]`` is one :class:`Drive`.

    Attributes:
        status_code: index into ``hairpin.STATUSES``, shape (n,).
        length_m: m, shape (n,), NaN without a drive.
        errors: x, y (m), yaw (rad), curvature (1/m) missed, shape (n, 4).
        max_curvature_1_m: 1/m, shape (n,).
        excess: of the limit in the way, shape (n,), NaN where there is none.
        iterations: of the solver, shape (n,).
        time_us: of solving alone, µs, shape (n,).
        segments: all pieces, shape (m, 11): question, kind (0 arc, 1 turn), direction, length_m, turn_rad, a0 … a5.
    """

    def __init__(self, answers: bytes, segments: bytes, limits: list[str]) -> None:
        rows = np.frombuffer(answers, dtype=np.float64).reshape(-1, 11)
        self.status_code: npt.NDArray[np.int8] = rows[:, 0].astype(np.int8)
        self.iterations: npt.NDArray[np.int64] = rows[:, 1].astype(np.int64)
        self.time_us: Floats = rows[:, 2]
        self.length_m: Floats = rows[:, 3]
        self.errors: Floats = rows[:, 4:8]
        self.max_curvature_1_m: Floats = rows[:, 8]
        self.excess: Floats = rows[:, 10]
        self.segments: Floats = np.frombuffer(segments, dtype=np.float64).reshape(-1, 11)
        self._limits, self._limit = limits, rows[:, 9].astype(np.int64)
        self._starts = np.searchsorted(self.segments[:, 0], np.arange(len(rows) + 1))

    @property
    def status(self) -> npt.NDArray[np.str_]:
        """Words of ``hairpin.STATUSES``, shape (n,)."""
        return np.asarray(STATUSES)[self.status_code]

    @property
    def limit(self) -> npt.NDArray[np.str_]:
        """Names of the limits in the way, shape (n,), empty where there is none."""
        return np.asarray([*self._limits, ""])[self._limit]

    @property
    def ok(self) -> npt.NDArray[np.bool_]:
        """Which have a drive that keeps every limit, shape (n,)."""
        return self.status_code == 0

    def __eq__(self, other: object) -> bool:
        if other.__class__ is not self.__class__:
            return NotImplemented
        names = ("status_code", "iterations", "length_m", "errors", "max_curvature_1_m", "excess", "segments", "limit")
        return all(same(getattr(self, name), getattr(other, name)) for name in names)

    __hash__ = None  # type: ignore[assignment]

    def __len__(self) -> int:
        return len(self.status_code)

    def __getitem__(self, index: int) -> Drive:
        place = range(len(self))[operator.index(index)]
        rows = self.segments[self._starts[place] : self._starts[place + 1]]
        segments = tuple(Segment(_KINDS[int(row[1])], int(row[2]), float(row[3]), float(row[4]), row[5:].copy()) for row in rows)
        curvature = _curvature(rows[:, 5:].copy(), rows[:, 3].copy())
        limit = self._limits[self._limit[place]] if self._limit[place] >= 0 else None
        return Drive(
            status=STATUSES[self.status_code[place]],
            length_m=float(self.length_m[place]),
            curvature=curvature,
            segments=segments,
            limit=limit,
            excess=float(self.excess[place]),
            errors=self.errors[place].copy(),
            max_curvature_1_m=float(self.max_curvature_1_m[place]),
            iterations=int(self.iterations[place]),
            time_us=float(self.time_us[place]),
        )

    def __iter__(self) -> Iterator[Drive]:
        return (self[place] for place in range(len(self)))

    def __repr__(self) -> str:
        counts = np.bincount(self.status_code, minlength=len(STATUSES))
        told = ", ".join(f"{count} {word}" for count, word in zip(counts, STATUSES, strict=True) if count)
        return f"Drives({told or 'none'})"


@overload
def steer(
    rover: str | os.PathLike[str] | Robot,
    *,
    queries: None = ...,
    x: float,
    y: float,
    yaw: float,
    k0: float = ...,
    kf: float = ...,
    start: tuple[float, float, float] | None = ...,
    free_end: bool = ...,
    terrain: str | os.PathLike[str] | None = ...,
    keep_out: str | os.PathLike[str] | None = ...,
    reversals: bool = ...,
    turns: bool = ...,
    direction: float = ...,
    max_curvature: float | None = ...,
    tolerance_m: float | None = ...,
    time_limit_ms: float | None = ...,
    threads: int | None = ...,
    progress: Progress | None = ...,
) -> Drive: ...


@overload
def steer(
    rover: str | os.PathLike[str] | Robot,
    *,
    queries: npt.ArrayLike,
    x: None = ...,
    y: None = ...,
    yaw: None = ...,
    k0: None = ...,
    kf: None = ...,
    start: None = ...,
    free_end: bool = ...,
    terrain: str | os.PathLike[str] | None = ...,
    keep_out: str | os.PathLike[str] | None = ...,
    reversals: bool = ...,
    turns: bool = ...,
    direction: float = ...,
    max_curvature: float | None = ...,
    tolerance_m: float | None = ...,
    time_limit_ms: float | None = ...,
    threads: int | None = ...,
    progress: Progress | None = ...,
) -> Drives: ...


def steer(
    rover: str | os.PathLike[str] | Robot,
    *,
    queries: npt.ArrayLike | None = None,
    x: float | None = None,
    y: float | None = None,
    yaw: float | None = None,
    k0: float | None = None,
    kf: float | None = None,
    start: tuple[float, float, float] | None = None,
    free_end: bool = False,
    terrain: str | os.PathLike[str] | None = None,
    keep_out: str | os.PathLike[str] | None = None,
    reversals: bool = False,
    turns: bool = False,
    direction: float = 0.0,
    max_curvature: float | None = None,
    tolerance_m: float | None = None,
    time_limit_ms: float | None = None,
    threads: int | None = None,
    progress: Progress | None = None,
) -> Drive | Drives:
    """Drives a ground vehicle from a pose and curvature to another, as the command `steer` does.

    Args:
        rover: a shipped vehicle's name (``generic``: |κ| ≤ 1 1/m, |κ′| ≤ 1 1/m²), a robot file, or a :class:`Robot`.
        queries: questions, shape (n, 5), columns x, y (m), yaw (rad), k0, kf (1/m), from the origin; or (n, 8), behind the start
            on the map sx, sy (m), syaw (rad). A row that is no question has the status ``invalid``. Columns that have names (of
            pandas, Polars, Arrow, a structured array) are taken by these, in whatever order.
        x, y, yaw: the goal as the start sees it: ahead (m), to the left (m), turned left (rad). Of one question.
        k0, kf: curvature at start and goal, 1/m, left positive; 0 if not given. Of one question.
        start: x, y (m) and yaw (rad) of the start on the map.
        free_end: the curvature at the goal may be anything where the controls do not need it.
        terrain: elevation map; the plane without one.
        keep_out: file of places to keep out of.
        reversals: the direction of travel may change.
        turns: the vehicle may turn in place.
        direction: of travel in the body, rad, left positive (crab).
        max_curvature: 1/m, where it is to be less than the vehicle's.
        tolerance_m: distance from the goal that counts as there, m; 0.01 if not given.
        time_limit_ms: time for each question, 1e9 at most; 0 gives the solver's start value.
        threads: as many as the machine has if not given.
        progress: called with what, done, of; nothing to see while one call answers one question.

    Returns:
        a :class:`Drive`, or of ``queries`` :class:`Drives`.

    Raises:
        InputError: ``field`` is the keyword, or what of the vehicle's file is wrong.

    Source: Kelly and Nagy 2003, Howard and Kelly 2007; README, "Rovers".

    >>> import hairpin, numpy as np
    >>> drive = hairpin.steer("generic", x=3.0, y=1.0, yaw=0.5, k0=0.0, kf=0.0)
    >>> drive.status, bool(drive.length_m > 3.16)
    ('ok', True)
    >>> many = hairpin.steer("generic", queries=np.array([[3.0, 1.0, 0.5, 0.0, 0.0], [0.1, 0.0, 3.0, 0.0, 0.0]]))
    >>> many.status.tolist()[0], len(many)
    ('ok', 2)
    """
    robot = rover if isinstance(rover, Robot) else Robot(described("rover", rover))
    files = (_file("terrain", terrain), _file("keep_out", keep_out))
    may = (flag("reversals", reversals), flag("turns", turns))
    common = SimpleNamespace(
        direction=real("direction", direction),
        max_curvature=_positive("max_curvature", max_curvature),
        tolerance_m=_positive("tolerance_m", tolerance_m),
        free_end=flag("free_end", free_end),
    )
    goal = {"x": x, "y": y, "yaw": yaw}
    one = {**goal, "k0": k0, "kf": kf, "start": start}
    if queries is None:
        missing = next((name for name, value in goal.items() if value is None), None)
        if missing is not None:
            raise wrong(missing, None, "given, or `queries`")
        across = 0
        table = _question(start, {**goal, "k0": 0.0 if k0 is None else k0, "kf": 0.0 if kf is None else kf})
    else:
        given = next((name for name, value in one.items() if value is not None), None)
        if given is not None:
            raise wrong(given, one[given], "left out where `queries` asks")
        table, across = _table(queries)
    try:
        vehicle = _native.Vehicle(robot.path(), files, may, _limit_s(time_limit_ms))
    except InputError as error:
        if not error.field:
            error.field, error.value = "rover", robot.path()
        raise
    on_map = start is not None or (queries is not None and across == len(_ON_MAP))
    drives = Drives(*vehicle.answer(np.ascontiguousarray(table).tobytes(), on_map, common, waiting(threads, progress)))
    if queries is not None:
        return drives
    drive = drives[0]
    if drive.status == "invalid":
        raise _unplannable(drive.limit or "x", one)
    return drive


def _unplannable(limit: str, one: dict[str, Any]) -> InputError:
    """What of a question is beyond what can be planned: its start's parts have columns of their own."""
    field = limit if limit in one else "start"
    return wrong(field, one[field], "within what can be planned (1e6 m, 1e6 rad)")


def _file(name: str, path: str | os.PathLike[str] | None) -> str | None:
    found = place_or_none(name, path)
    if found is not None and not os.path.isfile(found):
        raise wrong(name, found, "a file that is there")
    return found


def _positive(name: str, value: float | None) -> float | None:
    return None if value is None else real(name, value, "a finite number > 0", above=0.0)


def _limit_s(limit_ms: float | None) -> float | None:
    if limit_ms is None:
        return None
    return 1e-3 * real("time_limit_ms", limit_ms, "a number of milliseconds, 0 … 1e9", least=0.0, most=_native.LONGEST)


def _question(start: Any, asked: dict[str, Any]) -> Floats:
    given = row_by_name("start", start, (_ON_MAP[3:6], _ON_MAP[:3]))
    begin = [0.0, 0.0, 0.0] if start is None else vector("start", given, "x, y, yaw, three finite numbers", 3)
    return np.array([[*begin, *(real(name, value) for name, value in asked.items())]])


def _table(queries: npt.ArrayLike) -> tuple[Floats, int]:
    """Questions behind their starts, and how many columns were given."""
    bound = "an array of numbers, (n, 5) with x, y, yaw, k0, kf, or (n, 8) with sx, sy, syaw before them"
    table = floats_by_name("queries", queries, bound, (_COLUMNS, _ON_MAP))
    if table.ndim != 2 or table.shape[1] not in (len(_COLUMNS), len(_ON_MAP)):
        raise wrong("queries", table, bound)
    if table.shape[1] == len(_ON_MAP):
        return table, len(_ON_MAP)
    return np.concatenate([np.zeros((len(table), 3)), table], axis=1), len(_COLUMNS)
