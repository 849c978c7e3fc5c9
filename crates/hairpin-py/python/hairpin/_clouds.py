"""Clouds of an arm's points, as files that the command reads."""

from __future__ import annotations

import os
import re
import tempfile
from collections.abc import Mapping
from decimal import Decimal
from pathlib import Path
from typing import Any

import numpy as np

from hairpin._asked import finite, shown, wrong
from hairpin._errors import InputError
from hairpin._labels import floats_by_name
from hairpin._scenario import Robot, Scenario, sets_of, texts

_PLACES = (("x", "y", "z"), ("x_m", "y_m", "z_m"))
_NAMES = (*_PLACES, *((*place, *turn) for place in _PLACES for turn in (("q1", "q2", "q3", "q4"), ("qw", "qx", "qy", "qz"))))
"""What columns may be called: millimetres are none of them."""
_HEADS = {3: "x_mm,y_mm,z_mm", 7: "x_mm,y_mm,z_mm,q1,q2,q3,q4"}


def cloud_file(cloud: Any) -> Path:
    """The file of a cloud; of points in metres one that goes with Python.

    >>> cloud_file([[0.3, 0, 0.3], [0.35, 0.1, 0.3]]).read_text().splitlines()
    ['x_mm,y_mm,z_mm', '300,0,300', '350,100,300']
    """
    if isinstance(cloud, str | os.PathLike):
        return Path(cloud)
    bound = "an array (n, 3) or (n, 7) of finite numbers"
    points = floats_by_name("cloud", cloud, bound, _NAMES)
    if points.ndim != 2 or points.shape[1] not in _HEADS or not len(points):
        raise wrong("cloud", points, bound if points.size else f"{bound}, of one point or more")
    finite("cloud", points, "a finite number")
    lines = [",".join([*map(_millimetres, row[:3]), *map(repr, row[3:])]) for row in points.tolist()]
    path = Path(tempfile.mkdtemp(dir=texts())) / "cloud.csv"
    path.write_text("\n".join([_HEADS[points.shape[1]], *lines]) + "\n", encoding="utf-8")
    return path


def of_the_cloud(error: InputError, cloud: Any) -> InputError:
    """What the command tells of a key or of a line of its file, of the keyword or the row that stands behind it."""
    keyword = error.field.removeprefix("generate.search.")
    if keyword in ("start", "end", "min_cost") and keyword != error.field:
        return InputError(f"`{keyword}` = {error.value}: must be {error.bound}", keyword, error.value, error.bound)
    if isinstance(cloud, str | os.PathLike) or not error.field.startswith("task.points") or error.place is None:
        return error
    # Behind the header.
    row = error.place[0] - 2
    if row < 0:
        return error
    told = shown(np.asarray(cloud)[row].tolist())
    why = re.sub(r"line (\d+)", lambda line: f"row {int(line[1]) - 2}", error.bound).removeprefix(f"row {row}: ")
    return InputError(f"`cloud[{row}]` = {told}: {why}", f"cloud[{row}]", told, why)


def _millimetres(metres: float) -> str:
    """The same decimals, three places on: 0.1 m are 100 mm, not 100.00000000000001."""
    text = format(Decimal(repr(metres)).scaleb(3), "f")
    return text.rstrip("0").rstrip(".") if "." in text else text


def cell_of(cell: Robot | Scenario | str | None) -> str:
    """An arm or the scenario around it, as jobs know it."""
    if cell is None:
        raise InputError("`cell`: must be an arm, or a scenario around it", "cell", "", "an arm, or a scenario around it")
    if not isinstance(cell, str | Robot | Scenario):
        raise wrong("cell", cell, "an arm, or a scenario around it")
    return cell if isinstance(cell, str) else cell.path()


def sets_of_cell(cell: Any, values: Mapping[str, Any] | None) -> list[tuple[str, str]]:
    """Keys of the cell's scenario with other values."""
    return (cell.sets() if isinstance(cell, Scenario) else []) + sets_of(values)
