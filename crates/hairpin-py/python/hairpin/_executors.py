"""Executors made of less: a robot's own dynamics under a controller, and the step of an environment under a policy. Both are only
executed: nothing of them is planned or proven, so cases that come from elsewhere are ``unchecked``."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
import numpy.typing as npt

from hairpin._asked import entry, floats, function, real, whole, wrong
from hairpin._many import takes_many, vectorised

Floats = npt.NDArray[np.float64]
Executor = Callable[[Any], Any]
"""Of a mission gives a flight; if it is marked by :func:`vectorised`, of a list of missions a list of flights."""
Advance = Callable[[float, dict[str, Any], npt.NDArray[np.bool_]], dict[str, Floats]]
"""Of time, where to go and which missions are under way gives poses."""
_OF_A_POSE = {"p_m": 3, "q_wxyz": 4, "v_m_s": 3}
_MOST_STEPS = 10_000_000
"""Of a mission: few enough to be held in memory."""
_DIVERGED = 1e100
"""A state with an entry beyond it has diverged: that numbers overflow from there on is the model's own crash."""


def dynamics(
    derivative: Callable[[float, Floats, Floats], npt.ArrayLike],
    control: Callable[[float, Floats, dict[str, Any]], npt.ArrayLike],
    start: Callable[[dict[str, Any]], npt.ArrayLike],
    pose: Callable[[Floats], Mapping[str, npt.ArrayLike] | npt.ArrayLike],
    *,
    step_s: float = 0.01,
    substeps: int = 1,
) -> Executor:
    """A robot as its differential equation x' = f(t, x, u), executed by Runge and Kutta's method of order 4.

    Args:
        derivative: of t (s), state (n,) and control (m,) gives x', shape (n,).
        control: of t (s), state and where to go gives u, shape (m,), held for a step. Where to go is a dictionary: ``waypoints_m``
            (k, 3), ``next`` (index of the next waypoint, k once all were reached), ``target_m`` (3,).
        start: of the mission gives the first state; it begins at ``waypoints_m[0]``.
        pose: of a state gives its place (3,), or a dictionary with ``p_m`` and, if they are known, ``q_wxyz``, ``v_m_s``.
        step_s: time between two controls and two poses, s, more than 0.
        substeps: integration steps in each, 1 or more.

    Returns:
        an executor for :func:`stress` and :func:`execute`.

    With a derivative that is marked by :func:`vectorised` the missions that are under way are integrated side by side: states, controls
    and places have a row for each, (r, n), (r, m) and (r, 3), ``next`` is (r,), ``target_m`` (r, 3), ``waypoints_m`` a list, and
    ``start`` gets a list of missions. A row stays until the last one is there, and no row may depend on another.

    What is of another shape is refused, and so is what is not finite (control, derivative, pose) where the state is: the
    run is EXECUTOR FAILED, with the function's name and the time. Where the state itself grows beyond 1e100 the model
    diverged, and the run ends as a ``crash``.

    A waypoint is reached within ``accept_m`` of it. What is reported is what was integrated: it is executed only, and a case that
    no reach set of hairpin's planned has the evidence ``unchecked``.

    >>> import numpy as np, hairpin
    >>> point = hairpin.dynamics(lambda t, x, u: u, lambda t, x, to: to["target_m"] - x, lambda mission: mission["waypoints_m"][0], lambda x: x)
    >>> flown = point({"waypoints_m": [[0, 0, 0], [1, 0, 0]], "accept_m": 0.1, "time_limit_s": 10.0})
    >>> flown["ended"], bool(abs(flown["p_m"][-1][0] - 1.0) < 0.1)
    ('done', True)
    """
    step_s, substeps = _step(step_s), whole("substeps", substeps, 1)
    _functions(derivative=derivative, control=control, start=start, pose=pose)

    def begin(missions: Any, rows: int | None) -> Advance:
        state = np.array(_shaped("start", start(missions), "n", rows))
        _finite(("start", state), state, np.ones(rows or 1, dtype=bool), 0.0)
        size, width = step_s / substeps, None

        def advance(t: float, to: dict[str, Any], under_way: npt.NDArray[np.bool_]) -> dict[str, Floats]:
            nonlocal state, width

            def f(at: float, x: Floats) -> Floats:
                return _shaped("derivative", derivative(at, x, u), state.shape[-1], rows)

            if t > 0.0:
                before = t - step_s
                u = _shaped("control", control(before, state, to), "m" if width is None else width, rows)
                width = u.shape[-1]
                _finite(("control", u), state, under_way, before)
                for number in range(substeps):
                    state = _runge_kutta(f, before + number * size, state, size, under_way)
            posed = _posed(pose(state), rows)
            _finite(("p_m", posed["p_m"]), state, under_way, t)
            return posed

        return advance

    return _executor(begin, step_s, takes_many(derivative), derivative, "dynamics")


def adversary(
    env_step: Callable[[Any, npt.ArrayLike], Any],
    *,
    reset: Callable[[dict[str, Any]], Any],
    policy: Callable[[Any, dict[str, Any]], npt.ArrayLike],
    pose: Callable[[Any], Mapping[str, npt.ArrayLike] | npt.ArrayLike],
    step_s: float,
) -> Executor:
    """An environment and a policy, learned or not, as who carries missions out: what stresses the policy are the missions.

    Args:
        env_step: of the environment's state and an action gives its next state, ``step_s`` later.
        reset: of a mission gives the first state; it stands at ``waypoints_m[0]``.
        policy: of the state and where to go (``waypoints_m``, ``next``, ``target_m``, see :func:`dynamics`) gives the action.
        pose: of a state gives its place (3,) in m, world frame, or a dictionary with ``p_m``, ``q_wxyz``, ``v_m_s``.
        step_s: time of a step, s, more than 0.

    Returns:
        an executor for :func:`stress` and :func:`execute`; the environment's physics are its own, and nothing of them is proven.

    With a step that is marked by :func:`vectorised` all four work on the missions that are under way, as :func:`dynamics` has it:
    ``reset`` gets a list of them, and the state, whatever it is, holds them all until the last one is there.

    Numbered examples: examples/python/06_learned_policy.py.
    """
    step_s = _step(step_s)
    _functions(env_step=env_step, reset=reset, policy=policy, pose=pose)

    def begin(missions: Any, rows: int | None) -> Advance:
        state = reset(missions)

        def advance(t: float, to: dict[str, Any], under_way: npt.NDArray[np.bool_]) -> dict[str, Floats]:
            nonlocal state
            if t > 0.0:
                state = env_step(state, policy(state, to))
            return _posed(pose(state), rows)

        return advance

    return _executor(begin, step_s, takes_many(env_step), policy, "policy")


def _executor(
    begin: Callable[[Any, int | None], Advance], step_s: float, many: bool, named: Any, otherwise: str
) -> Executor:
    """One of what steps a mission, or many of them at once."""

    def fly_many(missions: list[dict[str, Any]]) -> list[dict[str, Any]]:
        return _carried_out(missions, begin(missions, len(missions)), step_s)

    def fly(mission: dict[str, Any]) -> dict[str, Any]:
        advance = begin(mission, None)

        def alone(t: float, to: dict[str, Any], under_way: npt.NDArray[np.bool_]) -> dict[str, Floats]:
            row = {"waypoints_m": to["waypoints_m"][0], "next": int(to["next"][0]), "target_m": to["target_m"][0]}
            return {key: value[np.newaxis] for key, value in advance(t, row, under_way).items()}

        return _carried_out([mission], alone, step_s)[0]

    made: Executor = vectorised(fly_many) if many else fly
    made.__name__ = getattr(named, "__name__", otherwise).strip("<>") or otherwise
    return made


def _functions(**given: Any) -> None:
    for name, value in given.items():
        function(name, value, "a function")


def _step(step_s: float) -> float:
    return real("step_s", step_s, "a number of seconds > 0", above=0.0)


def _runge_kutta(
    f: Callable[[float, Floats], Floats], t: float, x: Floats, h: float, under_way: npt.NDArray[np.bool_]
) -> Floats:
    asked: list[tuple[float, Floats, Floats]] = []

    def slope(at: float, state: Floats) -> Floats:
        asked.append((at, state, f(at, state)))
        return asked[-1][2]

    k1 = slope(t, x)
    k2 = slope(t + 0.5 * h, x + 0.5 * h * k1)
    k3 = slope(t + 0.5 * h, x + 0.5 * h * k2)
    k4 = slope(t + h, x + h * k3)
    after = x + h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4)
    if not np.isfinite(after).all():
        for at, state, found in asked:
            _finite(("derivative", found), state, under_way, at)
    return after


def _shaped(name: str, value: Any, size: int | str, rows: int | None) -> Floats:
    """Numbers of one mission, or a row for each of many: of another shape they would be spread over all."""
    wanted = (size,) if rows is None else (rows, size)
    if type(value) is np.ndarray and value.dtype == np.float64 and value.shape == wanted:
        return value
    many = f"numbers of shape ({rows}, {size}), a row for each of {rows} missions"
    bound = f"numbers of shape ({size},)" if rows is None else many
    numbers = floats(name, value, bound)
    first = () if rows is None else (rows,)
    if numbers.ndim != len(first) + 1 or numbers.shape[:-1] != first or size not in ("m", "n", numbers.shape[-1]):
        raise wrong(name, value, bound)
    return numbers


def _finite(told: tuple[str, Floats], state: Floats, under_way: npt.NDArray[np.bool_], t: float) -> None:
    """Refuses what is not finite of a state that is: it is a mistake of the function, where a state that grows beyond
    all numbers is the model's own crash."""
    name, found = told
    if np.isfinite(found).all():
        return
    alone = found.ndim == 1
    table, states = (found[np.newaxis], state[np.newaxis]) if alone else (found, state)
    held = under_way & (name == "start" or (np.abs(states) <= _DIVERGED).all(axis=1))
    bad = np.argwhere(~np.isfinite(table) & held[:, np.newaxis])
    if len(bad):
        at = tuple(bad[0].tolist())
        bound = f"a finite number at t = {t:g} s, of a finite state"
        raise wrong(entry(name, at[1:] if alone else at), float(table[at]), bound)


def _posed(found: Any, rows: int | None) -> dict[str, Floats]:
    table = found if isinstance(found, Mapping) else {"p_m": found}
    strange = next((key for key in table if key not in _OF_A_POSE), None)
    if strange is not None or "p_m" not in table:
        bound = "a place, or a dictionary with p_m and, if they are known, q_wxyz and v_m_s"
        raise wrong("pose", strange or list(table), bound)
    # A copy: an environment may give the same array again and again.
    return {key: np.array(_shaped(key, value, _OF_A_POSE[key], rows)) for key, value in table.items()}


def _carried_out(
    missions: list[dict[str, Any]], advance: Advance, step_s: float
) -> list[dict[str, Any]]:
    """Steps until of each the last waypoint is reached, or the time is over."""
    ways = [np.asarray(mission["waypoints_m"], dtype=np.float64) for mission in missions]
    accept, limit = (np.array([float(mission[key]) for mission in missions]) for key in ("accept_m", "time_limit_s"))
    if limit.max(initial=0.0) > _MOST_STEPS * step_s:
        raise wrong("step_s", step_s, f"at least {limit.max() / _MOST_STEPS:g}, for {_MOST_STEPS:.0e} steps in {limit.max():g} s")
    counts = np.array([len(way) for way in ways])
    places = np.zeros((len(ways), counts.max(), 3))
    for way, place in zip(ways, places, strict=True):
        place[: len(way)] = way
    every = np.arange(len(ways))
    at, ended = np.ones(len(ways), dtype=np.int64), ["time"] * len(ways)
    samples, under_way = np.zeros(len(ways), dtype=np.int64), np.ones(len(ways), dtype=bool)
    rows: list[dict[str, Floats]] = []
    legs: list[npt.NDArray[np.int64]] = []
    while (under_way := under_way & (len(rows) * step_s <= limit)).any():
        towards = np.minimum(at, counts - 1)
        to = {"waypoints_m": ways, "next": at.copy(), "target_m": places[every, towards]}
        row = advance(len(rows) * step_s, to, under_way)
        lost = under_way & ~np.isfinite(row["p_m"]).all(axis=1)
        under_way &= ~lost
        rows.append(row)
        legs.append(towards - 1)
        samples[under_way] = len(rows)
        while (near := under_way & (at < counts) & _within(row["p_m"], places[every, np.minimum(at, counts - 1)], accept)).any():
            at[near] += 1
        there = under_way & (at >= counts)
        under_way &= ~there
        for which, word in ((lost, "crash"), (there, "done")):
            for run in np.flatnonzero(which):
                ended[run] = word
    times = np.arange(len(rows)) * step_s
    keys = rows[0] if rows else ()
    columns = {key: np.stack([row[key] for row in rows]) for key in keys} | {"leg": np.array(legs)}
    return [
        {"t_s": times[:count], "ended": ended[run]} | {key: column[:count, run] for key, column in columns.items()}
        for run, count in enumerate(samples.tolist())
    ]


def _within(places: Floats, goals: Floats, distances: Floats) -> npt.NDArray[np.bool_]:
    within: npt.NDArray[np.bool_] = np.linalg.norm(places - goals, axis=1) <= distances
    return within
