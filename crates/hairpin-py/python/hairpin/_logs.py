"""Logs of robots that really moved, judged against what they were to fly."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from types import SimpleNamespace
from typing import Any

from hairpin import _native
from hairpin._asked import place, place_or_none, real, text, vector, whole
from hairpin._call import Progress, waiting
from hairpin._errors import InputError
from hairpin._labels import row_by_name
from hairpin._scenario import sets_of


_AXES = (("x", "y", "z"), ("x_m", "y_m", "z_m"))


@dataclass(frozen=True)
class Cut:
    """What of a log is not judged: from when (s, of the log), why, how much (s), and whether all behind it is gone too."""

    t_s: float
    what: str
    lost_s: float
    to_the_end: bool


@dataclass(frozen=True)
class JudgedLog:
    """A log and what it came to.

    Attributes:
        file: the log.
        verdict: its sentence.
        exit_code: 0 within spec, 1 violation, 5 inconclusive or invalid; of a folder also what could not be read.
        status: ``pass``, ``fail``, ``inconclusive``, ``invalid`` or ``unjudged``.
        case: the case or mission that it is of; ``None`` where it was refused.
        measures: ``max_deviation_m``, ``t_worst_s``, ``leg_worst``, …; ``None`` where nothing is left to measure.
        violations: sentences, the gravest first.
        cuts: what was cut out, in the order of time.
        detail: all that `judge LOG --json` says of it: source, frame, who tells the legs, notes, ….
    """

    file: Path
    verdict: str
    exit_code: int
    status: str
    case: str | None
    measures: dict[str, Any] | None
    violations: tuple[str, ...]
    cuts: tuple[Cut, ...]
    detail: dict[str, Any]

    def __bool__(self) -> bool:
        return self.exit_code == 0


@dataclass(frozen=True)
class JudgedLogs:
    """Logs and what they came to; true where all are within spec.

    Attributes:
        verdict: the sentence: of a folder the line with counts.
        exit_code: as the command's.
        logs: one a file, in the order of their names.
        counts: ``logs``, ``pass``, ``fail``, ``inconclusive``, ``invalid``, ``unjudged``.
        lines: what the command says: header and sentence of each log.
    """

    verdict: str
    exit_code: int
    logs: tuple[JudgedLog, ...]
    counts: dict[str, int]
    lines: tuple[str, ...]

    def __bool__(self) -> bool:
        return self.exit_code == 0

    def __str__(self) -> str:
        return "\n".join(self.lines)


def judge_log(
    log: str | os.PathLike[str],
    values: Mapping[str, Any] | None,
    *,
    campaign: str | os.PathLike[str] | None,
    mission: str | os.PathLike[str] | None,
    robot: str | None,
    world: str | None,
    case: str | int | None,
    source: str | None,
    turn_deg: float,
    offset_m: Sequence[float],
    altitude: str,
    from_s: float | None,
    to_s: float | None,
    page: str | os.PathLike[str] | None,
    threads: int | None,
    progress: Progress | None,
) -> JudgedLogs:
    """What :func:`hairpin.judge` does where a campaign or a mission is given beside the log."""
    _check(campaign is not None, mission is not None, robot is not None, case is not None, altitude)
    logs = SimpleNamespace(
        path=place("what", log, "a log, a file or folder"),
        campaign=campaign,
        mission=place("mission", mission) if mission is not None else "",
        robot=place_or_none("robot", robot),
        world=place_or_none("world", world),
        case=case if case is None or isinstance(case, str) else f"{whole('case', case, 0):04}",
        source=None if source is None else text("source", source),
        turn_deg=real("turn_deg", turn_deg),
        offset_m=vector("offset_m", row_by_name("offset_m", offset_m, _AXES), "three finite numbers", 3),
        amsl=altitude == "amsl",
        from_s=None if from_s is None else real("from_s", from_s),
        to_s=None if to_s is None else real("to_s", to_s),
        page=place_or_none("page", page),
    )
    found = _native.judge_log(logs, sets_of(values), waiting(threads, progress))
    return JudgedLogs(
        verdict=found["verdict"],
        exit_code=found["exit_code"],
        logs=tuple(_log(one) for one in found["logs"]),
        counts=found["counts"],
        lines=tuple(found["lines"]),
    )


def _check(campaign: bool, mission: bool, robot: bool, case: bool, altitude: str) -> None:
    """What does not go together."""
    for wrong, field, bound in (
        (campaign and mission, "mission", "left out where there is a campaign"),
        (robot and not mission, "robot", "given with a mission alone"),
        (case and not campaign, "case", "given with a campaign alone"),
        (altitude not in ("relative", "amsl"), "altitude", "relative or amsl"),
    ):
        if wrong:
            raise InputError(f"`{field}`: must be {bound}", field, altitude if field == "altitude" else "", bound)


def _log(one: Mapping[str, Any]) -> JudgedLog:
    measures = one.get("measures")
    return JudgedLog(
        file=Path(one["file"]),
        verdict=one["verdict"],
        exit_code=one["exit_code"],
        status=one["status"],
        case=one.get("case"),
        measures=measures,
        violations=tuple(measures["violations"]) if measures else (),
        cuts=tuple(Cut(cut["t_s"], cut["what"], cut["lost_s"], cut["to_the_end"]) for cut in one.get("cuts", ())),
        detail=dict(one),
    )
