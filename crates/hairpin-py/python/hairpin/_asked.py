"""What callers hand over: a number, switch, word, place or array that is none is refused with its keyword, its value and what it must
be. What the command bounds has the command's bounds and words."""

from __future__ import annotations

import math
import operator
import os
import reprlib
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from hairpin._errors import InputError

Floats = npt.NDArray[np.float64]

LARGEST_WHOLE = 2**63 - 1
_SHOWN = reprlib.Repr()
_SHOWN.maxstring = _SHOWN.maxother = 120
_NUMBERS = "biuf"


def wrong(name: str, value: Any, bound: str) -> InputError:
    """The mistake that ``value`` is."""
    told = value if isinstance(value, _Told) else shown(value)
    return InputError(f"`{name}` = {told}: must be {bound}", name, told, bound)


def shown(value: Any) -> str:
    """A value as it stands in a sentence."""
    if isinstance(value, np.ma.MaskedArray) and not value.ndim:
        return str(MASKED) if np.ma.is_masked(value) else repr(value.item())
    if isinstance(value, np.ndarray):
        return f"an array of shape {value.shape}" if value.ndim else repr(value.item())
    return _SHOWN.repr(value.item() if isinstance(value, np.generic) else value)


class _Told(str):
    """A word that stands for a value."""


MASKED = _Told("masked")


def real(
    name: str, value: Any, bound: str = "a finite number", *, least: float = -math.inf, above: float = -math.inf, most: float = math.inf
) -> float:
    """A finite number, from ``least`` or more than ``above`` to ``most``."""
    number = _float(value)
    if not (math.isfinite(number) and least <= number <= most and number > above):
        raise wrong(name, value, bound)
    return number


def _float(value: Any) -> float:
    """A number as such; NaN of what is none."""
    dimensions: int = getattr(value, "ndim", 0)
    if isinstance(value, bool | np.bool_ | str | bytes | np.ma.MaskedArray) or dimensions:
        return math.nan
    try:
        return float(value)
    except (TypeError, ValueError, OverflowError):
        return math.nan


def scalar(name: str, value: Any, bound: str) -> float | bool:
    """A number or truth by itself, NaN and what is infinite too; of an array without dimensions its entry."""
    if isinstance(value, bool | np.bool_):
        return bool(value)
    unmasked(name, value, bound)
    try:
        if hasattr(value, "ndim"):
            # float() takes words for what they say, truths for 0 and 1, and of complex numbers a part.
            entry_of = np.asarray(value)
            if entry_of.ndim or entry_of.dtype.kind not in _NUMBERS:
                raise TypeError(entry_of)
            return bool(entry_of) if entry_of.dtype.kind == "b" else float(entry_of)
        if not hasattr(type(value), "__float__") or isinstance(value, str | bytes | Sequence):
            raise TypeError(value)
        return float(value)
    except Exception:  # It is the caller's object that is asked.
        raise wrong(name, value, bound) from None


def seconds(name: str, value: Any) -> float | None:
    """A time limit; none is ``None``."""
    return None if value is None else real(name, value, "a number of seconds ≥ 0", least=0.0)


def whole(name: str, value: Any, least: int, most: int = LARGEST_WHOLE) -> int:
    """A whole number from ``least`` to ``most``."""
    number = None if isinstance(value, bool | np.bool_) or not hasattr(value, "__index__") else _index(value)
    if number is None or not least <= number <= most:
        bounded = most < LARGEST_WHOLE or (number is not None and number > most)
        raise wrong(name, value, f"a whole number in {least}..={most}" if bounded else f"a whole number ≥ {least}")
    return number


def _index(value: Any) -> int | None:
    try:
        return operator.index(value)
    except TypeError:  # Arrays have `__index__`, whatever their shape.
        return None


def flag(name: str, value: Any) -> bool:
    """A switch."""
    if not isinstance(value, bool | np.bool_):
        raise wrong(name, value, "True or False")
    return bool(value)


def text(name: str, value: Any, bound: str = "a text") -> str:
    """A text."""
    if not isinstance(value, str):
        raise wrong(name, value, bound)
    return value


def word(name: str, value: Any, known: Sequence[str]) -> str:
    """One of the words that are known."""
    if value not in known or not isinstance(value, str):
        raise wrong(name, value, f"one of {', '.join(known)}" if len(known) > 2 else " or ".join(known))
    return value


def place(name: str, value: Any, bound: str = "a path") -> str:
    """A path, or a name that stands for one."""
    if not isinstance(value, str | os.PathLike) or not isinstance(os.fspath(value), str):
        raise wrong(name, value, bound)
    return os.fspath(value)


def place_or_none(name: str, value: Any) -> str | None:
    """A path, where one is given."""
    return None if value is None else place(name, value)


def function(name: str, value: Any, bound: str) -> Callable[..., Any]:
    """Something that can be called."""
    if not callable(value):
        raise wrong(name, value, bound)
    made: Callable[..., Any] = value
    return made


def vector(name: str, value: Any, bound: str, length: int) -> list[float]:
    """So many finite numbers."""
    numbers = floats(name, value, bound)
    if numbers.shape != (length,):
        raise wrong(name, value, bound)
    finite(name, numbers, bound)
    return [float(number) for number in numbers]


def floats(name: str, value: Any, bound: str) -> Floats:
    """An array of numbers, of whatever shape; entries that are masked are none."""
    if type(value) is np.ndarray and value.dtype == np.float64:
        return value
    unmasked(name, value, "a number")
    try:
        given = np.asarray(value)
        if given.dtype.kind not in _NUMBERS + "O":
            raise TypeError(given.dtype)
        return given.astype(np.float64)
    except (TypeError, ValueError, OverflowError):
        raise wrong(name, value, bound) from None


def unmasked(name: str, value: Any, bound: str) -> None:
    """Refuses a masked entry: who masks it says that it counts for nothing, and arrays of numbers alone forget that."""
    at = _masked_at(value)
    if at is not None:
        raise wrong(entry(name, at), MASKED, bound)


def finite(name: str, numbers: Floats, bound: str) -> None:
    """Refuses an entry that is no finite number."""
    bad = np.argwhere(~np.isfinite(numbers))
    if len(bad):
        at = tuple(bad[0].tolist())
        raise wrong(entry(name, at), float(numbers[at]), bound)


def entry(name: str, at: tuple[int, ...]) -> str:
    """An entry of an array, by its place."""
    return f"{name}[{', '.join(map(str, at))}]" if at else name


def _masked_at(value: Any) -> tuple[int, ...] | None:
    """Where the first masked entry is, of an array or of lists of such."""
    if isinstance(value, np.ma.MaskedArray):
        found = np.argwhere(np.ma.getmaskarray(value))
        return tuple(found[0].tolist()) if len(found) else None
    if isinstance(value, list | tuple):
        for number, one in enumerate(value):
            inner = _masked_at(one) if isinstance(one, list | tuple | np.ma.MaskedArray) else None
            if inner is not None:
                return (number, *inner)
    return None
