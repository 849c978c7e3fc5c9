"""Scenarios, robots and worlds as objects: a name that is shipped, a file, TOML text or a dictionary."""

from __future__ import annotations

import atexit
import json
import math
import os
import shutil
import tempfile
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, Union

import numpy as np

from hairpin._asked import entry, place, unmasked, wrong

Source = Union[str, "os.PathLike[str]", Mapping[str, Any], "Scenario", "Robot"]

_VALUE = "a number, text, list or table"

_texts: Path | None = None


def toml_value(value: Any, key: str = "value") -> str:
    """A value as TOML has it, of ``key``.

    >>> toml_value({"max_m": 0.5, "names": ["a", "b"]})
    '{ "max_m" = 0.5, "names" = ["a", "b"] }'
    """
    unmasked(key, value if isinstance(value, np.ma.MaskedArray) else None, _VALUE)
    if hasattr(value, "tolist"):
        value = value.tolist()
    if isinstance(value, Robot | World):
        value = value.value()
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, int):
        return str(value)
    if isinstance(value, float):
        if math.isfinite(value):
            return repr(value)
        return "nan" if math.isnan(value) else ("inf" if value > 0 else "-inf")
    if isinstance(value, str | os.PathLike):
        return _quoted(place(key, value, _VALUE))
    if isinstance(value, Mapping):
        pairs = ", ".join(
            f"{_quoted(str(name))} = {toml_value(item, f'{key}.{name}')}" for name, item in value.items() if item is not None
        )
        return f"{{ {pairs} }}" if pairs else "{}"
    if isinstance(value, Sequence) and not isinstance(value, bytes | bytearray | memoryview):
        return f"[{', '.join(toml_value(item, entry(key, (number,))) for number, item in enumerate(value))}]"
    raise wrong(key, value, _VALUE)


def _quoted(text: str) -> str:
    """JSON's strings are TOML's, but that TOML has no halves of characters, and wants its last control character escaped."""
    return json.dumps(text, ensure_ascii=False).replace("\x7f", "\\u007f")


def to_toml(table: Mapping[str, Any]) -> str:
    """A dictionary as a TOML text, a key a line.

    >>> print(to_toml({"hairpin": 1, "spec": {"deviation": {"max_m": 0.5}}}), end="")
    "hairpin" = 1
    "spec" = { "deviation" = { "max_m" = 0.5 } }
    """
    return "".join(f"{_quoted(str(key))} = {toml_value(value, str(key))}\n" for key, value in table.items() if value is not None)


def sets_of(values: Mapping[str, Any] | None) -> list[tuple[str, str]]:
    """Dotted keys and values as `--set` has them.

    >>> sets_of({"execute.repeat": 5, "spec.deviation.max_m": 0.5})
    [('execute.repeat', '5'), ('spec.deviation.max_m', '0.5')]
    """
    return [(key, toml_value(value, key)) for key, value in _dotted(values).items()]


def _dotted(values: Any) -> Mapping[str, Any]:
    """Values by their keys; nothing of ``None``."""
    table = {} if values is None else values
    if not isinstance(table, Mapping) or not all(isinstance(key, str) for key in table):
        raise wrong("values", values, "a dictionary whose keys are texts")
    return table


def described(name: str, source: Any) -> Any:
    """A source of what a file describes."""
    if not isinstance(source, Mapping):
        place(name, source, "a name, a path, TOML text or a dictionary")
    return source


class _Described:
    """Something that a file describes: by name, path, TOML text or dictionary."""

    _what = "scenario"

    def __init__(self, source: str | os.PathLike[str] | Mapping[str, Any]) -> None:
        self._source: str | os.PathLike[str] | Mapping[str, Any] = described("source", source)

    def __repr__(self) -> str:
        source = self._source
        shown = "…" if isinstance(source, Mapping) or (isinstance(source, str) and "\n" in source) else os.fspath(source)
        return f"{type(self).__name__}({shown!r})"

    def text(self) -> str | None:
        """Its TOML text, where it is one or a dictionary; ``None`` of a name or a file."""
        if isinstance(self._source, Mapping):
            return to_toml(self._source)
        if isinstance(self._source, str) and ("\n" in self._source or " = " in self._source):
            return self._source
        return None

    def path(self) -> str:
        """A name or path that jobs know it by; a text lies in a file of its own until Python ends."""
        text = self.text()
        if text is None:
            return os.fspath(self._source)  # type: ignore[arg-type]
        return str(_file_of(text, self._what))


class Robot(_Described):
    """A robot: a shipped one's name, a robot file (TOML or URDF), TOML text, or a dictionary of its keys.

    Args:
        source: ``"anafi"``, ``"my_drone.toml"``, the text of such a file, or its tables as a dictionary; SI, units in the keys
            (``mass_kg``). Keys of each kind: docs/files.md.

    Raises:
        InputError: where a job reads it; ``field`` is the key that is wrong.
    """

    _what = "robot"

    def value(self) -> Any:
        """As a scenario has it."""
        if isinstance(self._source, Mapping):
            return dict(self._source)
        return self.path() if self.text() is not None else _absolute(os.fspath(self._source))


class World(_Described):
    """A world: a shipped one's name, a file, TOML text or a dictionary of its keys, as `[world]` has them."""

    _what = "world"

    def value(self) -> Any:
        """As a scenario has it."""
        if isinstance(self._source, Mapping):
            return dict(self._source)
        return self.path() if self.text() is not None else _absolute(os.fspath(self._source))


class Scenario(_Described):
    """A scenario: a shipped one's name, a file, TOML text or a dictionary.

    Args:
        source: ``"flightgoggles"``, ``"quadrotor.toml"``, TOML text, or a dictionary of its tables.
        robot: takes the place of its robot.
        world: takes the place of its world.
        values: dotted keys with other values.

    Files that a text or a dictionary names must have whole paths.

    >>> Scenario("demo-quadrotor").with_({"generate.search.cases": 2}).values
    {'generate.search.cases': 2}
    """

    def __init__(
        self,
        source: str | os.PathLike[str] | Mapping[str, Any],
        *,
        robot: Robot | str | Mapping[str, Any] | None = None,
        world: World | str | Mapping[str, Any] | None = None,
        values: Mapping[str, Any] | None = None,
    ) -> None:
        super().__init__(source)
        #: Keys with other values, dotted.
        self.values: dict[str, Any] = {}
        if robot is not None:
            self.values["robot"] = (robot if isinstance(robot, Robot) else Robot(described("robot", robot))).value()
        if world is not None:
            self.values["world"] = (world if isinstance(world, World) else World(described("world", world))).value()
        self.values.update(_dotted(values))

    def with_(self, values: Mapping[str, Any]) -> Scenario:
        """The same with other values of dotted keys."""
        return Scenario(self._source, values={**self.values, **_dotted(values)})

    def sets(self) -> list[tuple[str, str]]:
        """What takes the place of its keys, as jobs take it."""
        return sets_of(self.values)


def scenario(source: Source) -> Scenario:
    """What is given, as a scenario; a robot becomes the shipped scenario of its kind."""
    if isinstance(source, Scenario):
        return source
    if isinstance(source, Robot):
        return Scenario(source.path())
    return Scenario(source)


def _absolute(name: str) -> str:
    return os.path.abspath(name) if os.path.exists(name) else name


def texts() -> Path:
    """A folder for files that jobs read; it goes with Python."""
    global _texts
    if _texts is None:
        _texts = Path(tempfile.mkdtemp(prefix="hairpin-"))
        atexit.register(shutil.rmtree, _texts, ignore_errors=True)
    return _texts


def _file_of(text: str, what: str) -> Path:
    """A file of `text`; the same text is in the same file."""
    folder = texts()
    for number in range(10_000):
        path = folder / (f"{what}.toml" if number == 0 else f"{what}-{number}.toml")
        if not path.exists():
            path.write_text(text, encoding="utf-8")
            return path
        if path.read_text(encoding="utf-8") == text:
            return path
    raise RuntimeError(f"there are too many {what}s in {folder}")
