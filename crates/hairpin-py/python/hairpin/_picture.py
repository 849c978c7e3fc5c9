"""A small picture of a flight, as cells of notebooks show it."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
import numpy.typing as npt

_SIZE, _EDGE = 200, 12
_NEAR_PX = 0.7

Floats = npt.NDArray[np.float64]


def picture(name: str, waypoints_m: Floats, flown: Mapping[str, Floats], worst: tuple[float, float] | None) -> str:
    """An SVG from above: what was asked in grey, what was flown in blue, the worst moment (t in s, deviation in m) in red."""
    track = np.stack([flown["x_m"], flown["y_m"]], axis=1) if len(flown.get("t_s", ())) else np.empty((0, 2))
    shown = np.concatenate([waypoints_m[:, :2], track[np.isfinite(track).all(axis=1)]])
    if not len(shown):
        return ""
    low, span = shown.min(axis=0), max(float(np.ptp(shown, axis=0).max()), 1e-9)
    scale = (_SIZE - 2 * _EDGE) / span

    def px(places: Floats) -> Floats:
        at: Floats = (np.asarray(places) - low) * scale + _EDGE
        at[..., 1] = _SIZE - at[..., 1]
        return at

    asked = px(waypoints_m[:, :2])
    parts = [_line(asked, "#999", 'stroke-dasharray="3 2"')]
    parts += [f'<circle cx="{x:.1f}" cy="{y:.1f}" r="2" fill="#999"/>' for x, y in asked]
    if len(track):
        parts.append(_line(_thinned(px(track)), "#0072b2"))
        parts += _moment(flown, worst, px) if worst is not None else []
    told = f"{name} from above" + (", the worst moment marked" if len(track) and worst is not None else "")
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{_SIZE}" height="{_SIZE}" role="img" aria-label="{told}">'
        f"{''.join(parts)}</svg>"
    )


def _moment(flown: Mapping[str, Floats], worst: tuple[float, float], px: Any) -> list[str]:
    at_s, deviation_m = worst
    x, y = px(np.array([np.interp(at_s, flown["t_s"], flown[axis]) for axis in ("x_m", "y_m")]))
    told = f"{deviation_m:.2f} m at {at_s:.1f} s"
    side, shift = ("end", -8) if x > _SIZE / 2 else ("start", 8)
    return [
        f'<circle class="worst" cx="{x:.1f}" cy="{y:.1f}" r="5" fill="none" stroke="#d55e00" stroke-width="2"/>',
        f'<text x="{x + shift:.1f}" y="{max(y - 6, 10):.1f}" font-size="10" text-anchor="{side}" fill="#d55e00">{told}</text>',
    ]


def _thinned(points: Floats) -> Floats:
    """Without what lies on the same spot of the screen."""
    kept = [0]
    for place in range(1, len(points)):
        if np.hypot(*(points[place] - points[kept[-1]])) >= _NEAR_PX or place == len(points) - 1:
            kept.append(place)
    return points[kept]


def _line(points: Floats, colour: str, more: str = "") -> str:
    places = " ".join(f"{x:.1f},{y:.1f}" for x, y in points)
    return f'<polyline points="{places}" fill="none" stroke="{colour}" stroke-width="1.3" {more}/>'
