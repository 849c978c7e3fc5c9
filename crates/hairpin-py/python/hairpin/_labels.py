"""Names that data bring for their rows and columns: where they are told they count, and not the order in which they stand."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from hairpin._asked import Floats, floats, wrong


def columns_of(value: Any) -> list[Any] | None:
    """Names of the columns of a frame, of an Arrow table, of a structured array, or of a list of named tuples; ``None`` where there
    are none, or rising numbers alone."""
    if isinstance(value, np.ndarray):
        return None if value.dtype.names is None else list(value.dtype.names)
    if isinstance(value, list | tuple):
        tuples = [one._fields for one in value if hasattr(one, "_fields")]
        return list(tuples[0]) if tuples and len(tuples) == len(value) and len(set(tuples)) == 1 else None
    found = next((names for name in ("column_names", "columns") if (names := getattr(value, name, None)) is not None), None)
    if found is None or callable(found) or isinstance(found, str):
        return None
    return _told(list(found))


def _told(names: list[Any]) -> list[Any] | None:
    """Names, where somebody told them: numbers that rise, and what Polars calls its columns, are places in an order."""
    if all(isinstance(name, int | np.integer) for name in names):
        return None if all(a < b for a, b in zip(names, names[1:], strict=False)) else names
    return None if names == [f"column_{number}" for number in range(len(names))] else names


def floats_by_name(name: str, value: Any, bound: str, known: Sequence[Sequence[str]]) -> Floats:
    """An array of numbers, whose columns stand in the order of that one of ``known`` that their names are, where they have names."""
    names = columns_of(value)
    if names is None:
        return floats(name, value, bound)
    wanted = next((one for one in known if sorted(one) == sorted(map(str, names))), None)
    if wanted is None:
        told = " or ".join(", ".join(one) for one in known)
        raise wrong(f"{name}.columns", names, f"{told}, in whatever order; an array without names goes by the order")
    if isinstance(value, list | tuple):
        rows = floats(name, [tuple(one) for one in value], bound)
        return rows[:, [names.index(one) for one in wanted]]
    return np.stack([floats(f"{name}.{one}", value[one], bound) for one in wanted], axis=1)


def row_by_name(name: str, value: Any, known: Sequence[Sequence[str]]) -> Any:
    """The same for one row: a series or a named tuple."""
    names = labels_of(value)
    if names is None:
        return value
    wanted = next((one for one in known if sorted(one) == sorted(map(str, names))), None)
    if wanted is None:
        raise wrong(f"{name}.index", names, f"{' or '.join(', '.join(one) for one in known)}, in whatever order")
    entries = list(value)
    return [entries[names.index(one)] for one in wanted]


def labels_of(value: Any) -> list[Any] | None:
    """Labels of a series' or a named tuple's entries; ``None`` where there are none, or rising numbers alone."""
    if isinstance(value, tuple):
        return list(value._fields) if hasattr(value, "_fields") else None
    labels = getattr(getattr(value, "index", None), "tolist", None)
    return None if labels is None or hasattr(value, "columns") else _told(labels())


def square_by_label(name: str, value: Any) -> Any:
    """A square table, whose columns stand in the order of its rows where both have labels."""
    rows = getattr(getattr(value, "index", None), "tolist", None)
    if rows is None or not hasattr(value, "columns"):
        return value
    columns, labels = list(value.columns), rows()
    across, down = ([str(one) for one in of] for of in (columns, labels))
    if across == down or len(across) != len(down):
        return value
    if sorted(across) == sorted(down) and len(set(across)) == len(across):
        return np.asarray(value)[:, [across.index(one) for one in down]]
    if _told(columns) is None or _told(labels) is None:
        # One side has none: it goes by the order.
        return value
    odd = next((one for one in across if one not in down), next((one for one in down if one not in across), across[0]))
    raise wrong(f"{name}.columns", odd, "a label of the rows, each once; an array without labels goes by the order")
