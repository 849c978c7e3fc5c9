"""Scores, targets and controllers that are callables of this process, as jobs ask them, and the file that stands for each in
a campaign's folder, so that the command can go on with it where its source stands alone."""

from __future__ import annotations

import copy
import tempfile
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any, Protocol, Union

import numpy as np
import numpy.typing as npt

from hairpin._asked import floats, function, unmasked, wrong
from hairpin._call import Brought
from hairpin._many import takes_many
from hairpin._scenario import texts, toml_value
from hairpin._sources import source

_NUMBERS = ("v_in_m_s", "v_out_m_s", "turn_rad", "length_m", "climb_m", "slope_in", "ground", "duration_s")
_PLACES = ("from_m", "to_m", "start_m", "end_m")
_LARGEST, _FINITE = 1e100, "a finite number, 1e100 at most in size"
"""Sums over a trajectory stay finite: as of files."""
_OF_A_LEG = len(_NUMBERS) + 3 * len(_PLACES)


class Controller(Protocol):
    """What steers a run. Keys of `state`, `reference` and the answer of each kind of robot: docs/own-controllers.md.

    A function does where nothing is kept between turns. Of a class each run has an object of its own, and of an object a copy.
    """

    def control(self, t_s: float, state: dict[str, Any], reference: dict[str, Any]) -> Mapping[str, Any]:
        """The command at ``t_s`` s."""


ControllerLike = Union[Callable[[float, dict[str, Any], dict[str, Any]], Mapping[str, Any]], Controller, type[Controller]]
"""A function ``control(t_s, state, reference)``, an object with such a method, or its class."""


def bring(
    controller: ControllerLike | str | None = None,
    score: Callable[..., Any] | str | None = None,
    target: Callable[..., Any] | str | None = None,
    score_key: str = "generate.search.score",
) -> Brought:
    """Callables as jobs take them. A text is a word or file of the scenario's."""
    brought = Brought()
    kinds: tuple[tuple[str, Any, Callable[[Any, list[BaseException]], Any], str], ...] = (
        ("execute.controller", controller, _steering, "controller"),
        (score_key, score, _scoring, "score"),
        ("generate.search.target", target, _measuring, "target"),
    )
    for key, given, make, what in kinds:
        if given is None:
            continue
        if isinstance(given, str):
            brought.sets.append((key, toml_value(given)))
            continue
        if what == "controller" and not callable(getattr(given, "control", given)):
            raise wrong(what, given, "a function, an object with `control`, or its class")
        if what == "target" and takes_many(given):
            raise wrong(what, given, "a function of one run: targets have no vectorised form")
        if what == "controller" and takes_many(given):
            make = _steering_many
        if what != "controller":
            function(what, given, "a function")
        setattr(brought, what, make(given, brought.raised))
        brought.sets.append((key, toml_value(f"python:{_kept(given, what)}")))
    return brought


def _steering(given: Any, raised: list[BaseException]) -> Callable[[dict[str, Any]], Any]:
    """Makes a run's own function of its mission."""

    def begin(mission: dict[str, Any]) -> Any:
        try:
            if isinstance(given, type):
                own = given()
            elif hasattr(given, "control"):
                own = copy.deepcopy(given)
            else:
                own = None
            reset = getattr(given if own is None else own, "reset", None)
            if callable(reset):
                reset(mission)
            control = given if own is None else own.control
        except BaseException as error:
            raised.append(error)
            raise

        def turn(t_s: float, state: dict[str, Any], reference: dict[str, Any]) -> Any:
            try:
                return control(t_s, state, reference)
            except BaseException as error:
                raised.append(error)
                raise

        return turn

    return begin


class _steering_many:
    """Steers all runs that are under way by a function that takes many."""

    hairpin_vectorised = True

    def __init__(self, given: Callable[..., Any], raised: list[BaseException]) -> None:
        self._given, self._raised, self._missions = given, raised, dict[int, dict[str, Any]]()

    def join(self, run: int, mission: dict[str, Any]) -> None:
        self._missions[run] = mission

    def turn(self, asked: dict[str, Any]) -> dict[str, Any]:
        try:
            self._missions = {run: self._missions[run] for run in asked["runs"]}
            tables: list[dict[str, Any]] = [{key: _column(values) for key, values in asked[of].items()} for of in ("state", "reference")]
            state, reference = tables
            reference["mission"] = list(self._missions.values())
            answer = self._given(_column(asked["t_s"]), state, reference)
            if not isinstance(answer, Mapping):
                raise TypeError(f"{answer!r} is no dictionary, of control for {len(self._missions)} runs")
            return {key: _rows(key, values) for key, values in answer.items()}
        except BaseException as error:
            self._raised.append(error)
            raise


def _column(values: list[Any]) -> npt.NDArray[np.float64] | None:
    """A row for each run: what a run has not is NaN in its row, what none has is None."""
    there = next((value for value in values if value is not None), None)
    gap = [np.nan] * len(there) if isinstance(there, list) else np.nan
    return None if there is None else np.array([gap if value is None else value for value in values])


def _rows(key: str, values: Any) -> list[Any]:
    """A list with None in place of what is masked or not finite, which costs its own run alone."""
    given = np.ma.asarray(values)
    masked, rows = np.ma.getmaskarray(given), floats(key, given.data, "numbers, a row for each run")
    found = rows.astype(object)
    found[~np.isfinite(rows) | masked] = None
    return list(found.tolist())


def _scoring(given: Callable[..., Any], raised: list[BaseException]) -> Callable[[bytes], Any]:
    many, left = takes_many(given), getattr(given, "left", None)

    def score(table: bytes) -> Any:
        legs = np.frombuffer(table, dtype=np.float64).reshape(-1, _OF_A_LEG)
        if not len(legs):
            # Waypoints that no leg leaves.
            return []
        try:
            if many:
                columns = {name: legs[:, place] for place, name in enumerate(_NUMBERS)}
                for place, name in enumerate(_PLACES):
                    first = len(_NUMBERS) + 3 * place
                    columns[name] = legs[:, first : first + 3]
                answer = given(columns)
                if np.ma.asarray(answer).dtype.kind == "b":
                    raise wrong("score", answer, "numbers: a truth is neither 0 nor 1")
                parts = floats("score", answer, _FINITE)
                if parts.ndim == 1:
                    parts = np.stack([parts, np.zeros_like(parts)], axis=1)
                if parts.shape != (len(legs), 2):
                    raise ValueError(f"a vectorised score gives ({len(legs)},) or ({len(legs)}, 2) numbers, not {parts.shape}")
            else:
                rows = []
                for row in legs:
                    leg: dict[str, Any] = dict(zip(_NUMBERS, row.tolist(), strict=False))
                    for place, name in enumerate(_PLACES):
                        first = len(_NUMBERS) + 3 * place
                        leg[name] = row[first : first + 3].tolist()
                    rows.append([_number("score", given(leg)), _number("left", left(leg)) if callable(left) else 0.0])
                parts = np.asarray(rows, dtype=np.float64).reshape(-1, 2)
            beyond = np.argwhere(~(np.abs(parts) <= _LARGEST))
            if len(beyond):
                raise ValueError(f"the score of leg {beyond[0][0]} of {len(legs)} is {float(parts[tuple(beyond[0])])!r}, must be {_FINITE}")
            return parts.tolist()
        except BaseException as error:
            raised.append(error)
            raise

    return score


def _number(what: str, answer: Any) -> float:
    unmasked(what, answer, _FINITE)
    # float() takes words for what they say, truths for 0 and 1, and of complex numbers a part.
    if np.asarray(answer).dtype.kind in "bcSU":
        raise wrong(what, answer, _FINITE)
    return float(answer)


def _measuring(given: Callable[..., Any], raised: list[BaseException]) -> Callable[[dict[str, Any]], Any]:
    def measure(run: dict[str, Any]) -> Any:
        run["t_s"], run["p_m"], run["q_wxyz"] = (np.asarray(run[name], dtype=np.float64) for name in ("t_s", "p_m", "q_wxyz"))
        run["channels"] = {name: np.asarray(values, dtype=np.float64) for name, values in run["channels"].items()}
        run["waypoints_m"] = np.asarray(run["waypoints_m"], dtype=np.float64)
        try:
            found = given(run)
            measured = None if found is None else _number("target", found)
            if measured is not None and not abs(measured) <= _LARGEST:
                raise ValueError(f"the target of a run is {measured!r}, must be {_FINITE}, or None")
            return measured
        except BaseException as error:
            raised.append(error)
            raise

    return measure


def _kept(given: Any, what: str) -> Path:
    """The file that a campaign keeps of a callable."""
    name = given.__name__ if hasattr(given, "__name__") else type(given).__name__
    text = source(given, what) or _stub(given, name, what)
    plain = "".join(c if c.isalnum() or c in "_-" else "_" for c in name)
    plain = plain if plain.isascii() and plain not in ("score", "target") else what
    place = Path(tempfile.mkdtemp(dir=texts())) / f"{plain}.py"
    place.write_text(text, encoding="utf-8")
    return place


def _stub(given: Any, name: str, what: str) -> str:
    return (
        f"# Stands for {name}, a {what} that lives in a Python process: its source does not stand alone.\n"
        f"raise RuntimeError({f'this campaign was begun from Python with its own {what} {name}: go on from there, with the same {what}'!r})\n"
    )
