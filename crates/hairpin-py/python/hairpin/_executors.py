"""Executors made of less: a robot's own dynamics under a controller, and the step of an environment under a policy. Both are only
executed: nothing of them is planned or proven, so cases that come from elsewhere are ``unchecked``."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
import numpy.typing as npt

Floats = npt.NDArray[np.float64]
Executor = Callable[[dict[str, Any]], dict[str, Any]]


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
        step_s: time between two controls and two poses, s.
        substeps: integration steps in each.

    Returns:
        an executor for :func:`stress` and :func:`execute`.

    A waypoint is reached within ``accept_m`` of it. What is reported is what was integrated: it is executed only, and a case that
    no reach set of hairpin's planned has the evidence ``unchecked``.

    >>> import numpy as np, hairpin
    >>> point = hairpin.dynamics(lambda t, x, u: u, lambda t, x, to: to["target_m"] - x, lambda mission: mission["waypoints_m"][0], lambda x: x)
    >>> flown = point({"waypoints_m": [[0, 0, 0], [1, 0, 0]], "accept_m": 0.1, "time_limit_s": 10.0})
    >>> flown["ended"], bool(abs(flown["p_m"][-1][0] - 1.0) < 0.1)
    ('done', True)
    """
    if not step_s > 0 or substeps < 1:
        from hairpin._errors import InputError

        field, value = ("step_s", step_s) if not step_s > 0 else ("substeps", substeps)
        raise InputError(f"`{field}` = {value}: must be more than 0", field, str(value), "more than 0")

    def fly(mission: dict[str, Any]) -> dict[str, Any]:
        state = np.array(start(mission), dtype=np.float64)
        size = step_s / substeps

        def advance(t: float, to: dict[str, Any]) -> dict[str, Floats]:
            nonlocal state
            if t > 0.0:
                before = t - step_s
                u = np.asarray(control(before, state, to), dtype=np.float64)
                for number in range(substeps):
                    state = _runge_kutta(derivative, before + number * size, state, u, size)
            return _posed(pose(state))

        return _carried_out(mission, advance, step_s)

    fly.__name__ = getattr(derivative, "__name__", "dynamics").strip("<>") or "dynamics"
    return fly


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
        step_s: time of a step, s.

    Returns:
        an executor for :func:`stress` and :func:`execute`; the environment's physics are its own, and nothing of them is proven.

    Numbered examples: examples/python/06_learned_policy.py.
    """

    def fly(mission: dict[str, Any]) -> dict[str, Any]:
        state = reset(mission)

        def advance(t: float, to: dict[str, Any]) -> dict[str, Floats]:
            nonlocal state
            if t > 0.0:
                state = env_step(state, policy(state, to))
            return _posed(pose(state))

        return _carried_out(mission, advance, step_s)

    fly.__name__ = getattr(policy, "__name__", "policy").strip("<>") or "policy"
    return fly


def _runge_kutta(derivative: Callable[..., npt.ArrayLike], t: float, x: Floats, u: Floats, h: float) -> Floats:
    def f(at: float, state: Floats) -> Floats:
        return np.asarray(derivative(at, state, u), dtype=np.float64)

    k1 = f(t, x)
    k2 = f(t + 0.5 * h, x + 0.5 * h * k1)
    k3 = f(t + 0.5 * h, x + 0.5 * h * k2)
    k4 = f(t + h, x + h * k3)
    return x + h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4)


def _posed(found: Any) -> dict[str, Floats]:
    table = found if isinstance(found, Mapping) else {"p_m": found}
    return {key: np.array(value, dtype=np.float64) for key, value in table.items()}


def _carried_out(
    mission: dict[str, Any], advance: Callable[[float, dict[str, Any]], dict[str, Floats]], step_s: float
) -> dict[str, Any]:
    """Steps until the last waypoint is reached, or the time is over."""
    waypoints = np.asarray(mission["waypoints_m"], dtype=np.float64)
    accept, limit = float(mission["accept_m"]), float(mission["time_limit_s"])
    at, rows, times, legs, ended = 1, [], [], [], "time"
    number = 0
    while number * step_s <= limit:
        t = number * step_s
        target = waypoints[min(at, len(waypoints) - 1)]
        row = advance(t, {"waypoints_m": waypoints, "next": at, "target_m": target})
        if not np.isfinite(row["p_m"]).all():
            ended = "crash"
            break
        rows.append(row)
        times.append(t)
        legs.append(min(at, len(waypoints) - 1) - 1)
        while at < len(waypoints) and float(np.linalg.norm(row["p_m"] - waypoints[at])) <= accept:
            at += 1
        if at >= len(waypoints):
            ended = "done"
            break
        number += 1
    flown: dict[str, Any] = {"t_s": np.array(times), "leg": np.array(legs), "ended": ended}
    for key in rows[0] if rows else ():
        flown[key] = np.stack([row[key] for row in rows])
    return flown
