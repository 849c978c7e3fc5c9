"""The heaviest path through a matrix of costs, or the heaviest programs of an arm through a cloud of points."""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import dataclass, field
from types import SimpleNamespace
from typing import Any

import numpy as np
import numpy.typing as npt

from hairpin import _native
from hairpin._asked import entry, floats, place_or_none, real, seconds, text, unmasked, whole, wrong
from hairpin._call import Progress, replaces, waiting
from hairpin._campaign import Campaign
from hairpin._clouds import cell_of, cloud_file, of_the_cloud, sets_of_cell
from hairpin._errors import InputError
from hairpin._labels import square_by_label
from hairpin._scenario import Robot, Scenario

_EXACT = 2**53
_BELOW = f"less than 2^53 = {_EXACT}: from there on floating point leaves whole numbers out"


@dataclass(frozen=True)
class MaxLoad:
    """What was found.

    Attributes:
        path: points in their order, from 0; ``None`` where there is none.
        cost: of the path, in the matrix's unit; ``None`` without one.
        bound: no path costs more; ``None`` where nothing is known.
        gap_percent: 100 (bound − cost)/cost.
        proven: the path is the heaviest, or there is none.
        feasible: whether there is a path; ``None`` where that was not found out in time.
        paths: all that were asked for, the heaviest first, and their costs.
        method: by which it was found.
        time_s: what it took.
        reason: of a cloud: why there is no program.
        unit: of a cloud: of the costs.
        campaign: of a cloud: the programs as a campaign, where a folder was given and there are any.
        detail: of a cloud: all that `max-load --cloud --json` says.
    """

    path: list[int] | None
    cost: float | None
    bound: float | None
    gap_percent: float | None
    proven: bool
    feasible: bool | None
    paths: list[tuple[list[int], float]]
    method: str
    time_s: float = field(compare=False)
    reason: str | None = None
    unit: str | None = None
    campaign: Campaign | None = None
    detail: dict[str, Any] = field(default_factory=dict)


def max_load(
    matrix: npt.ArrayLike | None = None,
    *,
    cloud: npt.ArrayLike | str | os.PathLike[str] | None = None,
    cell: Robot | Scenario | str | None = None,
    values: Mapping[str, Any] | None = None,
    out: str | os.PathLike[str] | None = None,
    if_there: str = "refuse",
    start: int | None = None,
    end: int | None = None,
    min_cost: float | None = None,
    programs: int = 1,
    visits: int = 1,
    method: str = "auto",
    seed: int = 0,
    nodes: int | None = None,
    certificate: str | os.PathLike[str] | None = None,
    time_limit_s: float | None = None,
    threads: int | None = None,
    progress: Progress | None = None,
) -> MaxLoad:
    """The heaviest loop-free path, as the command `max-load` finds it: through a matrix of costs, or of an arm through a cloud.

    Args:
        matrix: costs, shape (n, n), row = from, column = to, ≥ 0; NaN: no arc. The diagonal has no meaning. Decimals become whole
            numbers exactly, all times the same power of ten; for the 17 digits of computed ones there is mostly no room: ``np.round``
            them. Each is below 2⁵³, from where on numbers of floating point leave whole numbers out. Where rows and columns have labels,
            columns are taken in the order of the rows, and points are counted by rows.
        cloud: an arm's points in its base's frame, shape (n, 3), m, or (n, 7) with the tool's orientation as a unit quaternion w, x,
            y, z; or a file as `--cloud` takes it (CSV in mm, a RAPID module). Decimals become those of millimetres exactly.
        cell: with `cloud`: the arm, or the scenario around it.
        values: with `cloud`: dotted keys of the cell's scenario with other values.
        out: with `cloud`: campaign folder for the programs.
        if_there: of `out`: ``refuse`` or ``replace``.
        start, end: fixed ends, from 0.
        min_cost: paths below are not wanted.
        programs: how many different paths, the heaviest first.
        visits: how often a point may come; with more than once no move is used twice.
        method: of a matrix: ``auto``, ``subsets``, ``branch``, ``local`` or ``dfs``.
        seed: of the local search.
        nodes: of a matrix: problems that each of up to 32 parts of branch and bound looks at.
        certificate: of a matrix: file for the proof of the answer.
        time_limit_s: seconds after which the best so far is the answer.
        threads: as many as the machine has if not given.
        progress: called with what, done, of.

    Raises:
        InputError: a matrix that is not square, a cost that is negative, masked or too large (``field`` is ``matrix[i, j]``), an end that
            is no point; a cloud of another shape, a cell that is no arm's; what does not go together.

    Source: docs/heaviest-paths.md.

    >>> import hairpin, numpy as np
    >>> hairpin.max_load(np.array([[np.nan, 1.5, 9], [2, np.nan, 3], [4, 8, np.nan]])).path
    [0, 2, 1]
    """
    wanted = SimpleNamespace(
        start=_end("start", start),
        end=_end("end", end),
        min_cost=None if min_cost is None else _least_cost(min_cost),
        programs=whole("programs", programs, *_native.PROGRAMS),
        visits=whole("visits", visits, *_native.VISITS),
        method=text("method", method, "a word"),
        seed=whole("seed", seed, 0, _native.LARGEST_SEED),
        nodes=None if nodes is None else whole("nodes", nodes, 0),
        certificate=place_or_none("certificate", certificate),
        time_limit_s=seconds("time_limit_s", time_limit_s),
    )
    if certificate is not None and wanted.programs > 1:
        raise wrong("programs", programs, "left out where a certificate is asked for")
    who = waiting(threads, progress)
    if cloud is not None:
        _only_of("matrix", matrix=matrix, nodes=nodes, certificate=certificate, method=None if method == "auto" else method)
        asked = SimpleNamespace(
            cell=cell_of(cell),
            points=cloud_file(cloud),
            sets=sets_of_cell(cell, values),
            out=place_or_none("out", out),
            replaces=replaces(if_there, out),
        )
        try:
            return _of_cloud(_native.max_load_of_cloud(asked, wanted, who))
        except InputError as error:
            raise of_the_cloud(error, cloud) from None
    _only_of("cloud", cell=cell, values=values, out=out, if_there=None if if_there == "refuse" else if_there)
    matrix = square_by_label("matrix", matrix)
    table, points = _table(matrix, start=wanted.start, end=wanted.end)
    try:
        return _of_matrix(_native.max_load(table, points, wanted, who))
    except InputError as error:
        raise _of_the_matrix(error, matrix) from None


def _only_of(whose: str, **given: Any) -> None:
    for name, value in given.items():
        if value is not None:
            bound = f"given with a {whose} alone" if name != whose else "left out where there is a cloud"
            raise InputError(f"`{name}`: must be {bound}", name, "", bound)


def _table(matrix: Any, **ends: int | None) -> tuple[bytes, int]:
    """A matrix as bytes, and its points."""
    bound = "a square array of numbers"
    unmasked("matrix", matrix, "a number, or NaN for no arc")
    costs = np.array(floats("matrix", matrix, bound), order="C")
    if costs.ndim != 2 or costs.shape[0] != costs.shape[1] or costs.shape[0] == 0:
        raise wrong("matrix", costs, bound + (", of one point or more" if not costs.size else ""))
    # It has no meaning; of a single point there is nothing else.
    np.fill_diagonal(costs, 0.0)
    beyond = np.argwhere(np.isfinite(costs) & (costs >= _EXACT))
    if len(beyond):
        at = tuple(beyond[0].tolist())
        raise wrong(entry("matrix", at), np.asarray(matrix, dtype=object)[at], _BELOW)
    for name, point in ends.items():
        if point is not None and point >= len(costs):
            raise wrong(name, point, f"from 0 to {len(costs) - 1}")
    return costs.tobytes(), len(costs)


def _of_the_matrix(error: InputError, matrix: Any) -> InputError:
    """What the command tells of a line and a column, of the matrix: its file is none of the caller's."""
    if error.place is None:
        return error
    at = error.place[0] - 1, error.place[1] - 1
    return wrong(entry("matrix", at), np.asarray(matrix, dtype=object)[at], error.bound)


def _end(name: str, point: Any) -> int | None:
    return None if point is None else whole(name, point, 0)


def _least_cost(cost: Any) -> float:
    least = real("min_cost", cost, "a number ≥ 0", least=0.0)
    if least >= _EXACT:
        raise wrong("min_cost", cost, _BELOW)
    return least


def _of_matrix(found: dict[str, Any]) -> MaxLoad:
    paths = [(one["path"], one["cost"]) for one in found["paths"]]
    names = ("bound", "gap_percent", "proven", "feasible", "method", "time_s")
    best = paths[0] if paths else (None, None)
    return MaxLoad(path=best[0], cost=best[1], paths=paths, **{name: found[name] for name in names})


def _of_cloud(found: dict[str, Any]) -> MaxLoad:
    names = ("path", "cost", "bound", "gap_percent", "proven", "method", "time_s")
    return MaxLoad(
        **{name: found[name] for name in names},
        feasible={0: True, 3: False}.get(found["exit_code"]),
        paths=[(one["path"], one["cost"]) for one in found.get("paths", ())],
        reason=found.get("reason"),
        unit=found.get("unit"),
        campaign=Campaign(found["folder"]) if found.get("folder") else None,
        detail=found,
    )
