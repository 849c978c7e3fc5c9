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

from hairpin._errors import InputError

Source = Union[str, "os.PathLike[str]", Mapping[str, Any], "Scenario", "Robot"]

_texts: Path | None = None


def toml_value(value: Any) -> str:
    """A value as TOML has it.

    >>> toml_value({"max_m": 0.5, "names": ["a", "b"]})
    '{ "max_m" = 0.5, "names" = ["a", "b"] }'
    """
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
        # JSON's strings are TOML's.
        return json.dumps(os.fspath(value))
    if isinstance(value, Mapping):
        pairs = ", ".join(f"{json.dumps(str(key))} = {toml_value(item)}" for key, item in value.items() if item is not None)
        return f"{{ {pairs} }}" if pairs else "{}"
    if isinstance(value, Sequence):
        return f"[{', '.join(toml_value(item) for item in value)}]"
    raise InputError(f"`{value!r}`: must be a number, text, list or table", "", repr(value), "a number, text, list or table")


def to_toml(table: Mapping[str, Any]) -> str:
    """A dictionary as a TOML text, a key a line.

    >>> print(to_toml({"hairpin": 1, "spec": {"deviation": {"max_m": 0.5}}}), end="")
    "hairpin" = 1
    "spec" = { "deviation" = { "max_m" = 0.5 } }
    """
    return "".join(f"{json.dumps(str(key))} = {toml_value(value)}\n" for key, value in table.items() if value is not None)


def sets_of(values: Mapping[str, Any] | None) -> list[tuple[str, str]]:
    """Dotted keys and values as `--set` has them.

    >>> sets_of({"execute.repeat": 5, "spec.deviation.max_m": 0.5})
    [('execute.repeat', '5'), ('spec.deviation.max_m', '0.5')]
    """
    return [(key, toml_value(value)) for key, value in (values or {}).items()]


class _Described:
    """Something that a file describes: by name, path, TOML text or dictionary."""

    _what = "scenario"

    def __init__(self, source: str | os.PathLike[str] | Mapping[str, Any], **values: Any) -> None:
        self._source = source
        #: Keys with other values, dotted.
        self.values: dict[str, Any] = dict(values)

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
        if robot is not None:
            self.values["robot"] = (robot if isinstance(robot, Robot) else Robot(robot)).value()
        if world is not None:
            self.values["world"] = (world if isinstance(world, World) else World(world)).value()
        self.values.update(values or {})

    def with_(self, values: Mapping[str, Any]) -> Scenario:
        """The same with other values of dotted keys."""
        return Scenario(self._source, values={**self.values, **values})

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
