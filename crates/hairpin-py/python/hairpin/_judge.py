"""Verdicts: on what a campaign's folder has, and on logs."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from typing import Any, overload

import numpy as np

from hairpin._asked import wrong
from hairpin._call import Progress
from hairpin._campaign import Campaign
from hairpin._errors import InputError
from hairpin._jobs import folder_of, opened
from hairpin._logs import JudgedLogs, judge_log
from hairpin._scenario import Robot, World

_NOT_MOVED = (0.0, 0.0, 0.0)


@overload
def judge(
    what: Campaign | str | os.PathLike[str],
    values: Mapping[str, Any] | None = None,
    *,
    threads: int | None = None,
    progress: Progress | None = None,
) -> Campaign: ...
@overload
def judge(
    what: str | os.PathLike[str],
    values: Mapping[str, Any] | None = None,
    *,
    campaign: Campaign | str | os.PathLike[str] | None = None,
    mission: str | os.PathLike[str] | None = None,
    robot: Robot | str | None = None,
    world: World | str | None = None,
    case: str | int | None = None,
    source: str | None = None,
    turn_deg: float = 0.0,
    offset_m: Sequence[float] = _NOT_MOVED,
    altitude: str = "relative",
    from_s: float | None = None,
    to_s: float | None = None,
    page: str | os.PathLike[str] | None = None,
    threads: int | None = None,
    progress: Progress | None = None,
) -> JudgedLogs: ...
@overload
def judge(
    what: None = None,
    values: Mapping[str, Any] | None = None,
    *,
    campaign: Campaign | str | os.PathLike[str],
    threads: int | None = None,
    progress: Progress | None = None,
) -> Campaign: ...
def judge(
    what: Campaign | str | os.PathLike[str] | None = None,
    values: Mapping[str, Any] | None = None,
    *,
    campaign: Campaign | str | os.PathLike[str] | None = None,
    mission: str | os.PathLike[str] | None = None,
    robot: Robot | str | None = None,
    world: World | str | None = None,
    case: str | int | None = None,
    source: str | None = None,
    turn_deg: float = 0.0,
    offset_m: Sequence[float] = _NOT_MOVED,
    altitude: str = "relative",
    from_s: float | None = None,
    to_s: float | None = None,
    page: str | os.PathLike[str] | None = None,
    threads: int | None = None,
    progress: Progress | None = None,
) -> Campaign | JudgedLogs:
    """Judges an executed folder; or, with `campaign` or `mission`, a log of a robot that really moved, or a folder of logs.

    Args:
        what: a campaign's folder; a log (ULog, ArduPilot .bin, MCAP, TUM, CSV), or a folder of them.
        values: other values for keys of `spec`: a campaign's folder keeps them, of logs they count for this judgement.
        campaign: judges the log against the cases of this one.
        mission: judges the log against these waypoints (CSV: ``x_m,y_m,z_m``).
        robot: with `mission`: who flew it.
        world: in this world; its obstacles need not have been there.
        case: with `campaign`: the case that was flown, instead of finding it out.
        source: the topic that poses or joints are from, instead of the best ranked.
        turn_deg: turns the log's frame about z first, ° counter-clockwise.
        offset_m: then moves it, m, shape (3,).
        altitude: ``relative`` to the log's own origin, or ``amsl``.
        from_s, to_s: the part that is judged, s of the log.
        page: writes a page with what was planned, simulated and flown over each other.

    Gives a :class:`Campaign`, or :class:`JudgedLogs` with the words and numbers of `judge LOG`.

    Raises:
        InputError: keys of other tables, cases that were not executed; a log that cannot be read, fits no case, or does not begin
            where its mission does: nothing is aligned.
    """
    if what is None:
        if campaign is None:
            raise InputError("`what`: must be a campaign's folder or a log", "what", "", "a campaign's folder or a log")
        what, campaign = campaign, None
    log = {"world": world, "source": source, "from_s": from_s, "to_s": to_s, "page": page, "robot": robot, "case": case}
    frame = {"turn_deg": np.array_equal(turn_deg, 0.0), "offset_m": np.array_equal(offset_m, _NOT_MOVED), "altitude": altitude == "relative"}
    named = [name for name, given in log.items() if given is not None] + [name for name, usual in frame.items() if not usual]
    if campaign is None and mission is None:
        if named:
            bound = "given with a log, and with it `campaign` or `mission`"
            raise InputError(f"`{named[0]}`: must be {bound}", named[0], "", bound)
        return opened(what, "what").judge(values, threads=threads, progress=progress)
    if isinstance(what, Campaign):
        raise wrong("what", what, "a log, a file or folder")
    return judge_log(
        what,
        values,
        campaign=None if campaign is None else folder_of(campaign),
        mission=mission,
        robot=robot.path() if isinstance(robot, Robot) else robot,
        world=world.path() if isinstance(world, World) else world,
        case=case,
        source=source,
        turn_deg=turn_deg,
        offset_m=offset_m,
        altitude=altitude,
        from_s=from_s,
        to_s=to_s,
        page=page,
        threads=threads,
        progress=progress,
    )
