"""The jobs: each the command of the same name, with the same settings, results and bytes."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any

from hairpin import _native
from hairpin._asked import flag, place, place_or_none, real, seconds, text, whole, word, wrong
from hairpin._bridge import serving
from hairpin._call import Brought, Progress, means, replaces, waiting
from hairpin._callables import ControllerLike, bring
from hairpin._campaign import Campaign
from hairpin._many import AT_ONCE, takes_many
from hairpin._results import Comparison, Shrunk, Verification
from hairpin._scenario import Scenario, Source, scenario, sets_of, toml_value


_IF_THERE = ("refuse", "resume", "replace")
_BUDGET = "a number of seconds > 0, 1e9 at most"


def stress(
    source: Source,
    *,
    out: str | os.PathLike[str] | None = None,
    seed: int | None = None,
    values: Mapping[str, Any] | None = None,
    controller: ControllerLike | str | None = None,
    score: Callable[..., Any] | str | None = None,
    target: Callable[..., Any] | str | None = None,
    executor: Callable[..., Any] | str | None = None,
    missions: str | os.PathLike[str] | None = None,
    repro: str | os.PathLike[str] | None = None,
    if_there: str = "refuse",
    time_limit_s: float | None = None,
    budget_s: float | None = None,
    portable: bool = False,
    allow_commands: bool = False,
    threads: int | None = None,
    progress: Progress | None = None,
) -> Campaign:
    """The main job: generate, execute, judge, report.

    Args:
        source: a :class:`Scenario`, :class:`Robot`, shipped name, file, TOML text or dictionary.
        out: campaign folder; ``out/NAME`` of the scenario if not given.
        seed: root seed.
        values: dotted keys with other values, ``{"execute.repeat": 5}``.
        controller: steers flights, drives, boats and arms in this process, see :class:`Controller`; or a word of
            `execute.controller`. A run that it fails is EXECUTOR FAILED.
        score: scores legs: of a dictionary a number; :func:`vectorised` of many legs at once; or a word of `score`.
        target: measures a run for the search: of a dictionary (``t_s`` (n,), ``p_m`` (n, 3), ``q_wxyz`` (n, 4), ``channels``,
            ``waypoints_m``, ``reached_s``, ``ended``) a number, more is worse, or ``None``; or a word of `generate.search.target`.
        executor: carries missions out: a command, or a callable as :func:`hairpin.execute` says.
        missions: missions made elsewhere, a file or folder, in place of the search's cases.
        repro: folder of saved cases that are run first.
        if_there: ``refuse``, ``resume`` or ``replace`` a campaign that is in the folder.
        time_limit_s: seconds after which the search stops and keeps what it has.
        budget_s: seconds for the whole campaign; what it cut is told, and no pass.
        portable: one level of kernels that all machines have.
        allow_commands: what a stranger's folder asks to run may.
        threads: as many as the machine has if not given.
        progress: called with what, done, of, in the thread that called.

    Raises:
        InputError: a mistake in the scenario, with ``field``, ``value`` and ``bound``; a folder that holds something else.
        ExecutorError: the executor ended.
        KeyboardInterrupt: Ctrl-C; what is done is kept, ``if_there="resume"`` goes on.

    The same seeds give the same bytes as the command, for scenarios without callables.

    >>> import hairpin, tempfile
    >>> place = tempfile.mkdtemp()
    >>> found = hairpin.stress("demo-quadrotor", out=f"{place}/out", values={"generate.search.cases": 2, "execute.baseline": 0})
    >>> len(found), found.exit_code in (0, 1)
    (2, True)
    """
    asked = scenario(source)
    brought = bring(controller, score, target, _score_key(asked) if score is not None else "")
    with serving(executor, brought) as command:
        begun = _begun(asked, out, seed, values, brought, (command, executor), if_there, time_limit_s, budget_s)
        given = (place_or_none("missions", missions), place_or_none("repro", repro))
        said = _called(
            brought,
            lambda: _native.stress(
                begun, given, means(brought, portable, allow_commands), waiting(threads, progress)
            ),
        )
    return Campaign(said["paths"]["folder"], brought=brought, said=said)


def generate(
    source: Source,
    *,
    out: str | os.PathLike[str] | None = None,
    seed: int | None = None,
    values: Mapping[str, Any] | None = None,
    controller: ControllerLike | str | None = None,
    score: Callable[..., Any] | str | None = None,
    target: Callable[..., Any] | str | None = None,
    executor: Callable[..., Any] | str | None = None,
    if_there: str = "refuse",
    time_limit_s: float | None = None,
    portable: bool = False,
    allow_commands: bool = False,
    threads: int | None = None,
    progress: Progress | None = None,
) -> Campaign:
    """The cases alone; arguments and errors as of :func:`stress`.

    The campaign's `exit_code` is 0, or 3 where nothing is feasible, which its `verdict` then says.

    >>> import hairpin, tempfile
    >>> found = hairpin.generate("demo-quadrotor", out=tempfile.mkdtemp() + "/out", values={"generate.search.cases": 2})
    >>> [case.status for case in found]
    ['generated', 'generated']
    """
    asked = scenario(source)
    brought = bring(controller, score, target, _score_key(asked) if score is not None else "")
    with serving(executor, brought) as command:
        begun = _begun(asked, out, seed, values, brought, (command, executor), if_there, time_limit_s)
        said = _called(
            brought, lambda: _native.generate(begun, means(brought, portable, allow_commands), waiting(threads, progress))
        )
    return Campaign(said["folder"], brought=brought, said=said)


def execute(
    campaign: Campaign | str | os.PathLike[str],
    *,
    values: Mapping[str, Any] | None = None,
    controller: ControllerLike | str | None = None,
    executor: Callable[..., Any] | str | None = None,
    missions: str | os.PathLike[str] | None = None,
    repro: str | os.PathLike[str] | None = None,
    out: str | os.PathLike[str] | None = None,
    if_there: str = "refuse",
    resume: bool = False,
    portable: bool = False,
    allow_commands: bool = False,
    threads: int | None = None,
    progress: Progress | None = None,
) -> Campaign:
    """Executes the cases of a folder, or missions made elsewhere.

    Args:
        campaign: a folder, or its :class:`Campaign`.
        values: dotted keys of `execute`, `vary` and `spec` with other values.
        controller: as of :func:`stress`.
        executor: a command; or a callable that carries a mission out. It gets a dictionary with ``case``, ``run``, ``seed``,
            ``robot``, ``world``, ``waypoints_m``, ``accept_m``, ``time_limit_s``, ``timed`` as the executor protocol has it, and gives
            ``t_s`` (n,), ``p_m`` (n, 3), and if it knows them ``q_wxyz`` (n, 4), ``v_m_s`` (n, 3), ``leg`` (n,), ``ended`` (``done``,
            ``time`` or ``crash``; the protocol's ``reason`` as well; left out it is ``done``, which holds where it
            came to its last waypoint alone, and the report's assumptions say so). Other keys are refused. It is asked from several threads; with :func:`vectorised` it gets a list of the missions that are
            under way, 16 at most if `execute.processes` does not say, and gives as many. See also :func:`dynamics`, :func:`adversary`.
        missions: a mission or a folder of them, which take the place of the cases.
        repro: folder of saved cases that are run first.
        out: a folder of its own for the runs, with the same cases.
        if_there: of `out`: ``refuse`` or ``replace``.
        resume: runs that are there stay.

    Raises:
        As :func:`stress`.
    """
    own = campaign._brought if isinstance(campaign, Campaign) else None
    folder = Path(folder_of(campaign))
    if flag("resume", resume) and (missions is not None or if_there == "replace"):
        raise wrong("resume", resume, f"left out beside {'`missions`' if missions is not None else '`if_there`'}")
    brought = bring(controller)
    if controller is None and executor is None and own is not None:
        # A copy: the folder that is executed has a name of its own for the executor.
        brought, executor = replace(own), own.executor
    with serving(executor, brought) as command:
        sets = sets_of(values) + [one for one in brought.sets if one[0].startswith("execute.")] + _command(command)
        sets += _side_by_side(executor, os.fspath(folder / "scenario.toml"), sets)
        flights = SimpleNamespace(
            folder=folder,
            out=place_or_none("out", out),
            replaces=replaces(if_there, out),
            sets=sets,
            missions=place_or_none("missions", missions),
            repro=place_or_none("repro", repro),
            resume=resume,
        )
        said = _called(
            brought, lambda: _native.execute(flights, means(brought, portable, allow_commands), waiting(threads, progress))
        )
    failed = said["executor_failed"]
    said["exit_code"] = 4 if failed else 0
    said["verdict"] = (
        f"EXECUTOR FAILED {failed}/{said['runs']} runs ({said['trouble'] or ''})"
        if failed
        else f"EXECUTED {said['runs']} runs of {said['cases']} cases"
    )
    return Campaign(said["folder"], brought=brought, said=said)


def verify(
    campaign: Campaign | str | os.PathLike[str], *, threads: int | None = None, progress: Progress | None = None
) -> Verification:
    """Integrates every witness of a folder by independent code. True where all hold; false where there was nothing to verify.

    Raises:
        InputError: the folder is no campaign's.
    """
    return opened(campaign).verify(threads=threads, progress=progress)


def shrink(campaign: Campaign | str | os.PathLike[str], case: str | int | None = None, **settings: Any) -> Shrunk:
    """Reduces a violating case of a judged folder to the shortest feasible one that still violates.

    Args:
        campaign: a folder, or its :class:`Campaign`.
        case: id or number; the worst if not given.
        settings: ``budget`` executions at most (200), ``time_limit_s``, ``out`` a file, ``portable``, ``allow_commands``, ``threads``,
            ``progress``.

    Raises:
        InputError: no such case, or one that does not violate.
    """
    return opened(campaign).shrink(case, **settings)


@dataclass(frozen=True)
class Explanation:
    """Why nothing, or little, is feasible: the verdict, reasons in words, and all that `explain --json` says."""

    verdict: str
    exit_code: int
    reasons: tuple[str, ...]
    detail: dict[str, Any]

    def __bool__(self) -> bool:
        return self.exit_code == 0


def explain(
    source: Source,
    *,
    values: Mapping[str, Any] | None = None,
    graphs: int = 8,
    time_limit_s: float | None = None,
    score: Callable[..., Any] | str | None = None,
    portable: bool = False,
    allow_commands: bool = False,
    threads: int | None = None,
    progress: Progress | None = None,
) -> Explanation:
    """Why nothing is feasible, and the smallest change that helps. Nothing is written.

    Args:
        source, values, score: as of :func:`stress`.
        graphs: graphs that are sampled and searched; with every change the same ones.
        time_limit_s: seconds after which no further change is tried; 60 if not given, of arms 3.
    """
    asked = scenario(source)
    brought = bring(score=score, score_key=_score_key(asked) if score is not None else "")
    sets = asked.sets() + sets_of(values) + brought.sets
    effort = (whole("graphs", graphs, *_native.GRAPHS), seconds("time_limit_s", time_limit_s))
    found = _called(
        brought,
        lambda: _native.explain(
            (asked.path(), sets), effort, means(brought, portable, allow_commands), waiting(threads, progress)
        ),
    )
    return Explanation(found["verdict"], found["exit_code"], tuple(found["reasons"]), found)


def compare(
    a: Campaign | str | os.PathLike[str], b: Campaign | str | os.PathLike[str], *, tolerance_m: float = 1e-6
) -> Comparison:
    """Two judged folders, paired by case and seed: `a` before, `b` after. True where nothing is newly failing.

    Args:
        tolerance_m: deviations that differ by no more are unchanged, m; as the command's.

    Raises:
        InputError: folders that are not judged, of other kinds of robots, or without a case in common.
    """
    within = real("tolerance_m", tolerance_m, "a finite number >= 0", least=0.0)
    found = _native.compare((folder_of(a, "a"), folder_of(b, "b")), within, waiting())
    failing, passing = (tuple(str(case) for case in found[name]) for name in ("newly_failing", "newly_passing"))
    return Comparison(found["verdict"], failing, passing, found["regression"], found["inconclusive"], found)


@dataclass(frozen=True)
class Model:
    """A score that was learned: its file, the key of a scenario that takes it as ``learned:FILE``, and its quality (R², error) by
    cross-validation and on trajectories that took no part."""

    path: Path
    score_key: str
    unit: str
    trajectories: int
    legs: int
    validation: dict[str, Any]
    held_out: dict[str, Any]

    @property
    def word(self) -> str:
        """What `score` takes."""
        return f"learned:{self.path}"


def learn(
    campaigns: Campaign | str | os.PathLike[str] | Iterable[Campaign | str | os.PathLike[str]],
    out: str | os.PathLike[str] = "score-model.json",
    *,
    stress: str = "max-deviation",
    threads: int | None = None,
    progress: Progress | None = None,
) -> Model:
    """Learns per-leg stress from executed legs of one robot and controller, as a polynomial of what a search sees of a leg.

    Args:
        campaigns: a folder, or several as if they were one.
        out: the model's file.
        stress: ``max-deviation``, ``mean-deviation``, ``overshoot``, ….

    Raises:
        InputError: too little to learn from; folders of different robots or controllers.
    """
    many = list(campaigns) if isinstance(campaigns, Iterable) and not isinstance(campaigns, Campaign | str | bytes) else [campaigns]
    if not many:
        raise wrong("campaigns", many, "a campaign, or several")
    folders: list[str | os.PathLike[str]] = [folder_of(one, "campaigns") for one in many]
    found = _native.learn((folders, place("out", out)), text("stress", stress), waiting(threads, progress))
    names = ("score_key", "unit", "trajectories", "legs", "validation", "held_out")
    return Model(Path(found["model"]), **{name: found[name] for name in names})


def _stress_with_texts(source: Source, *, out: Path, texts: Mapping[str, str], executor: str | None) -> Campaign:
    """A whole campaign in place of the one in `out`, as the command line has it: values are TOML texts."""
    asked = scenario(source)
    begun = SimpleNamespace(
        scenario=asked.path(),
        out=os.fspath(out),
        sets=[*asked.sets(), *texts.items(), *_command(executor)],
        if_there="replace",
        time_limit_s=None,
        budget_s=None,
    )
    said = _native.stress(begun, (None, None), means(None, False, False), waiting())
    return Campaign(said["paths"]["folder"], said=said)


def open_campaign(folder: Campaign | str | os.PathLike[str]) -> Campaign:
    """The campaign of a folder that is there."""
    return opened(folder, "folder")


def opened(campaign: Any, name: str = "campaign") -> Campaign:
    """The campaign that is given, or that is in the folder that is."""
    return campaign if isinstance(campaign, Campaign) else Campaign(folder_of(campaign, name))


def _begun(
    asked: Scenario,
    out: str | os.PathLike[str] | None,
    seed: int | None,
    values: Mapping[str, Any] | None,
    brought: Brought,
    executes: tuple[str | None, Callable[..., Any] | str | None],
    if_there: str,
    time_limit_s: float | None,
    budget_s: float | None = None,
) -> Any:
    sets = asked.sets() + sets_of(values)
    if seed is not None:
        sets.append(("seed", toml_value(whole("seed", seed, 0, _native.LARGEST_SEED))))
    sets += brought.sets + _command(executes[0])
    sets += _side_by_side(executes[1], asked.path(), sets)
    return SimpleNamespace(
        scenario=asked.path(),
        out=place_or_none("out", out),
        sets=sets,
        if_there=word("if_there", if_there, _IF_THERE),
        time_limit_s=seconds("time_limit_s", time_limit_s),
        budget_s=None if budget_s is None else real("budget_s", budget_s, _BUDGET, above=0.0, most=_native.LONGEST),
    )


def _command(command: str | None) -> list[tuple[str, str]]:
    return [] if command is None else [("execute.command", toml_value(command))]


def _side_by_side(executor: Any, scenario: str, sets: list[tuple[str, str]]) -> list[tuple[str, str]]:
    """As many missions as an executor that takes many is asked with at most, where the scenario does not say."""
    if not takes_many(executor) or _native.facts(scenario, sets)[1] is not None:
        return []
    return [("execute.processes", str(AT_ONCE))]


def _called(brought: Brought, call: Callable[[], Any]) -> Any:
    try:
        return call()
    except (Exception, KeyboardInterrupt) as error:
        raise brought.why(error)


def _score_key(asked: Scenario) -> str:
    """Arms have their score elsewhere."""
    return _native.facts(asked.path(), asked.sets())[0]


def folder_of(campaign: Any, name: str = "campaign") -> str:
    """The folder that a campaign is in, or that is named in its place."""
    return place(name, campaign.folder if isinstance(campaign, Campaign) else campaign, "a campaign or its folder")
