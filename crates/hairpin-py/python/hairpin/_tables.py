"""Tables of a campaign's folder, for whatever reads Arrow, and for NumPy."""

from __future__ import annotations

import os
from typing import Any

import numpy as np
import numpy.typing as npt

from hairpin import _native
from hairpin._asked import place, text, whole


class Table:
    """A table of a campaign's folder, read whenever somebody takes it: Polars, DuckDB, nanoarrow, pyarrow and whatever else knows
    Arrow's PyCapsule interface do so without a copy in between, and without pyarrow.

    Args:
        folder: a campaign folder.
        name: ``results``, ``waypoints``, ``runs``, ``executions``, ``trajectories``, ``profiles``, …; columns: docs/folder.md.
        case, run: the rows of that case and that run alone.

    Raises:
        InputError: there is no such table; ``bound`` names those that are.

    ``polars.DataFrame(table)``, ``pyarrow.table(table)``, ``duckdb.sql("from table")``.
    """

    def __init__(self, folder: str | os.PathLike[str], name: str, *, case: int | None = None, run: int | None = None) -> None:
        only = (None if case is None else whole("case", case, 0), None if run is None else whole("run", run, 0))
        self._table = _native.Table(place("folder", folder), text("table", name, "the name of a table"), only)
        #: Its name.
        self.name = name

    def __arrow_c_stream__(self, requested_schema: Any = None) -> Any:
        return self._table.__arrow_c_stream__(requested_schema)

    def __arrow_c_schema__(self) -> Any:
        return self._table.__arrow_c_schema__()

    @property
    def column_names(self) -> list[str]:
        """Names of the columns, in the file's order."""
        return self._table.names

    def to_numpy(self) -> dict[str, npt.NDArray[Any]]:
        """The columns by name, shape (n,): numbers as such, NaN where there is none; texts and lists as objects."""
        return {name: _array(values) for name, values in self._table.columns().items()}

    def __repr__(self) -> str:
        return f"Table({self.name!r}: {', '.join(self.column_names)})"


def _array(values: tuple[str, bytes] | list[Any]) -> npt.NDArray[Any]:
    if isinstance(values, tuple):
        kind, numbers = values
        return np.frombuffer(numbers, dtype=kind).copy()
    kinds = {type(value) for value in values}
    if kinds == {bool}:
        return np.asarray(values)
    if kinds and kinds <= {int, type(None)}:
        # Whole numbers of which some are missing.
        return np.asarray([np.nan if value is None else value for value in values], dtype=np.float64)
    column = np.empty(len(values), dtype=object)
    column[:] = values
    return column
