"""Equality of results that hold arrays."""

from __future__ import annotations

from dataclasses import fields
from typing import Any, ClassVar

import numpy as np


class Same:
    """A dataclass whose instances are equal where all fields are: arrays entry by entry, NaN where the other is NaN.

    Fields that are what the clock said do not count. Arrays can be written to, so that there is no hash: what is to be a key is its ``id``, or a tuple of plain fields.
    """

    __hash__: ClassVar[None]  # type: ignore[assignment]

    def __eq__(self, other: object) -> bool:
        if other.__class__ is not self.__class__:
            return NotImplemented
        told = [one.name for one in fields(self) if one.compare]  # type: ignore[arg-type]
        return all(same(getattr(self, name), getattr(other, name)) for name in told)


def same(a: Any, b: Any) -> bool:
    """Whether two values are the same, entry by entry."""
    if isinstance(a, np.ndarray) and isinstance(b, np.ndarray):
        return a.dtype.kind == b.dtype.kind and np.array_equal(a, b, equal_nan=a.dtype.kind in "fc")
    if (isinstance(a, tuple) and isinstance(b, tuple)) or (isinstance(a, list) and isinstance(b, list)):
        return len(a) == len(b) and all(map(same, a, b))
    if isinstance(a, dict) and isinstance(b, dict):
        return a.keys() == b.keys() and all(same(a[key], b[key]) for key in a)
    both_nan = isinstance(a, float) and isinstance(b, float) and a != a and b != b
    return both_nan or bool(a == b)
