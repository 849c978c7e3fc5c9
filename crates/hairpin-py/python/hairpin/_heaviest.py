"""The heaviest path through a matrix of costs."""

from __future__ import annotations

from dataclasses import dataclass
from types import SimpleNamespace

import numpy as np
import numpy.typing as npt

from hairpin import _native
from hairpin._call import Progress, waiting
from hairpin._errors import InputError


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
    """

    path: list[int] | None
    cost: float | None
    bound: float | None
    gap_percent: float | None
    proven: bool
    feasible: bool | None
    paths: list[tuple[list[int], float]]
    method: str
    time_s: float


def max_load(
    matrix: npt.ArrayLike,
    *,
    start: int | None = None,
    end: int | None = None,
    min_cost: float | None = None,
    programs: int = 1,
    visits: int = 1,
    method: str = "auto",
    seed: int = 0,
    time_limit_s: float | None = None,
    threads: int | None = None,
    progress: Progress | None = None,
) -> MaxLoad:
    """The heaviest loop-free path, as the command `max-load --graph` finds it.

    Args:
        matrix: costs, shape (n, n), row = from, column = to, ≥ 0; NaN: no arc. The diagonal has no meaning. Decimals become whole
            numbers exactly, all times the same power of ten.
        start, end: fixed ends, from 0.
        min_cost: paths below are not wanted.
        programs: how many different paths, the heaviest first.
        visits: how often a point may come; with more than once no move is used twice.
        method: ``auto``, ``subsets``, ``branch``, ``local`` or ``dfs``.
        seed: of the local search.
        time_limit_s: seconds after which the best so far is the answer.
        threads: as many as the machine has if not given.
        progress: called with what, done, of.

    Raises:
        InputError: a matrix that is not square, a negative cost (``field`` is ``matrix[i, j]``), an end that is no point.

    Source: docs/heaviest-paths.md.

    >>> import hairpin, numpy as np
    >>> hairpin.max_load(np.array([[np.nan, 1.5, 9], [2, np.nan, 3], [4, 8, np.nan]])).path
    [0, 2, 1]
    """
    bound = "a square array of numbers"
    try:
        costs = np.ascontiguousarray(matrix, dtype=np.float64)
    except (TypeError, ValueError):
        raise InputError(f"`matrix`: must be {bound}", "matrix", type(matrix).__name__, bound) from None
    if costs.ndim != 2 or costs.shape[0] != costs.shape[1] or costs.shape[0] == 0:
        raise InputError(f"`matrix` of shape {costs.shape}: must be {bound}", "matrix", str(costs.shape), bound)
    costs = costs.copy()
    np.fill_diagonal(costs, np.nan)
    for name, point in (("start", start), ("end", end)):
        if point is not None and not 0 <= point < len(costs):
            raise InputError(
                f"`{name}` = {point}: must be from 0 to {len(costs) - 1}", name, str(point), f"from 0 to {len(costs) - 1}"
            )
    for name, least, value in (("programs", 1, programs), ("visits", 1, visits), ("seed", 0, seed)):
        if value < least:
            raise InputError(f"`{name}` = {value}: must be at least {least}", name, str(value), f"at least {least}")
    if min_cost is not None and not 0 <= min_cost < np.inf:
        raise InputError(f"`min_cost` = {min_cost}: must be a number ≥ 0", "min_cost", str(min_cost), "a number ≥ 0")
    wanted = SimpleNamespace(
        start=start,
        end=end,
        min_cost=min_cost,
        programs=programs,
        visits=visits,
        method=method,
        seed=seed,
        time_limit_s=time_limit_s,
    )
    found = _native.max_load(costs.tobytes(), len(costs), wanted, waiting(threads, progress))
    paths = [(one["path"], one["cost"]) for one in found["paths"]]
    return MaxLoad(
        path=paths[0][0] if paths else None,
        cost=paths[0][1] if paths else None,
        bound=found["bound"],
        gap_percent=found["gap_percent"],
        proven=found["proven"],
        feasible=found["feasible"],
        paths=paths,
        method=found["method"],
        time_s=found["time_s"],
    )
