"""Boundary-value drives of ground vehicles: one, or as many as an array has rows, in one call."""

from __future__ import annotations

import os
from collections.abc import Iterator
from dataclasses import dataclass
from types import SimpleNamespace
from typing import Any, overload

import numpy as np
import numpy.typing as npt

from hairpin import _native
from hairpin._call import Progress, waiting
from hairpin._errors import InputError
from hairpin._scenario import Robot

Floats = npt.NDArray[np.float64]

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

    def __call__(self, s_m: npt.ArrayLike) -> Any:
        way = np.asarray(s_m, dtype=np.float64)
        ends = np.cumsum(self.lengths)
        place = np.minimum(np.searchsorted(ends, way, side="left"), max(len(ends) - 1, 0))
        outside = (way < 0.0) | (len(ends) == 0) | (way > (ends[-1] if len(ends) else 0.0) + 1e-12)
        if not len(ends):
            return np.full(way.shape, np.nan)
        local = way - np.concatenate([[0.0], ends])[place]
        rows = np.asarray(self)[place]
        found = sum(rows[..., power] * local**power for power in range(6))
        return np.where(outside, np.nan, found)


@dataclass(frozen=True)
class Segment:
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


@dataclass(frozen=True)
class Drive:
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
    time_us: float

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

    def __len__(self) -> int:
        return len(self.status_code)

    def __getitem__(self, index: int) -> Drive:
        place = range(len(self))[index]
        rows = self.segments[self._starts[place] : self._starts[place + 1]]
        segments = tuple(Segment(_KINDS[int(row[1])], int(row[2]), float(row[3]), float(row[4]), row[5:].copy()) for row in rows)
        curvature = rows[:, 5:].copy().view(Curvature)
        curvature.lengths = rows[:, 3].copy()
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
    k0: float = ...,
    kf: float = ...,
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
    k0: float = 0.0,
    kf: float = 0.0,
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
            on the map sx, sy (m), syaw (rad). A row that is no question has the status ``invalid``.
        x, y, yaw: the goal as the start sees it: ahead (m), to the left (m), turned left (rad). Of one question.
        k0, kf: curvature at start and goal, 1/m, left positive.
        start: x, y (m) and yaw (rad) of the start on the map.
        free_end: the curvature at the goal may be anything where the controls do not need it.
        terrain: elevation map; the plane without one.
        keep_out: file of places to keep out of.
        reversals: the direction of travel may change.
        turns: the vehicle may turn in place.
        direction: of travel in the body, rad, left positive (crab).
        max_curvature: 1/m, where it is to be less than the vehicle's.
        tolerance_m: distance from the goal that counts as there.
        time_limit_ms: time for each question; 0 gives the solver's start value.
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
    robot = rover if isinstance(rover, Robot) else Robot(rover)
    limit_s = None if time_limit_ms is None else _number("time_limit_ms", time_limit_ms, "a number ≥ 0") * 1e-3
    for name, path in (("terrain", terrain), ("keep_out", keep_out)):
        if path is not None and not os.path.isfile(path):
            raise InputError(
                f"`{name}` = {os.fspath(path)!r}: must be a file that is there", name, os.fspath(path), "a file that is there"
            )
    common = SimpleNamespace(
        direction=_number("direction", direction, "a finite number"),
        max_curvature=None if max_curvature is None else _number("max_curvature", max_curvature, "a number > 0"),
        tolerance_m=None if tolerance_m is None else _number("tolerance_m", tolerance_m, "a number ≥ 0"),
        free_end=free_end,
    )
    one = {"x": x, "y": y, "yaw": yaw}
    if queries is None:
        missing = [name for name, value in one.items() if value is None]
        if missing:
            raise InputError(f"`{missing[0]}`: must be given, or `queries`", missing[0], "None", "given, or `queries`")
        begin = (0.0, 0.0, 0.0) if start is None else start
        if len(begin) != 3:
            raise InputError(f"`start` = {begin!r}: must be x, y, yaw", "start", repr(begin), "x, y, yaw")
        values = [*begin, x, y, yaw, k0, kf]
        table = np.array([[_number(name, value, "a finite number") for name, value in zip(_ON_MAP, values, strict=True)]])
    else:
        given = next((name for name, value in {**one, "start": start}.items() if value is not None), None)
        if given is not None:
            raise InputError(f"`{given}`: must be left out where `queries` asks", given, "given", "left out where `queries` asks")
        table = _table(queries)
    try:
        vehicle = _native.Vehicle(robot.path(), (_path(terrain), _path(keep_out)), (reversals, turns), limit_s)
    except InputError as error:
        if not error.field:
            error.field, error.value = "rover", robot.path()
        raise
    on_map = start is not None or (queries is not None and np.shape(queries)[-1] == len(_ON_MAP))
    drives = Drives(*vehicle.answer(np.ascontiguousarray(table).tobytes(), on_map, common, waiting(threads, progress)))
    if queries is not None:
        return drives
    drive = drives[0]
    if drive.status == "invalid":
        field = drive.limit or "x"
        raise InputError(
            f"`{field}`: must be within what can be planned (1e6 m, 1e6 rad)",
            field,
            "",
            "within what can be planned (1e6 m, 1e6 rad)",
        )
    return drive


def _path(path: str | os.PathLike[str] | None) -> str | None:
    return None if path is None else os.fspath(path)


def _number(name: str, value: Any, bound: str) -> float:
    try:
        number = float(value)
    except (TypeError, ValueError):
        number = float("nan")
    low = {"a number ≥ 0": 0.0, "a number > 0": np.nextafter(0.0, 1.0)}.get(bound, -np.inf)
    if not np.isfinite(number) or number < low:
        raise InputError(f"`{name}` = {value!r}: must be {bound}", name, repr(value), bound)
    return number


def _table(queries: npt.ArrayLike) -> Floats:
    bound = "an array of numbers, (n, 5) with x, y, yaw, k0, kf, or (n, 8) with sx, sy, syaw before them"
    try:
        table = np.asarray(queries, dtype=np.float64)
    except (TypeError, ValueError):
        raise InputError(f"`queries`: must be {bound}", "queries", type(queries).__name__, bound) from None
    if table.ndim != 2 or table.shape[1] not in (len(_COLUMNS), len(_ON_MAP)):
        raise InputError(f"`queries` of shape {table.shape}: must be {bound}", "queries", str(table.shape), bound)
    if table.shape[1] == len(_ON_MAP):
        return table
    return np.concatenate([np.zeros((len(table), 3)), table], axis=1)
